"""Built-in cases as the tests of exports run them."""

import os
from pathlib import Path

import pytest

DATA = os.environ.get("MECHSYM_TEST_DATA")


def needed(name):
    """What a built-in case needs besides its name: the start-up amplifies rounding after 10 s, the generator a file."""
    if name == "generator":
        if not DATA:
            pytest.skip("MECHSYM_TEST_DATA is not set: the measured diagrams are not here")
        return {"cycle.file": str(Path(DATA) / "generator-half-load.csv")}
    return {"t_end": "10 s"} if name == "chmielewski" else {}
