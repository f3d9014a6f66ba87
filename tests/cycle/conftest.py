"""A cylinder and a way to write diagram files."""

from pathlib import Path

import pytest
from slider_crank import slider_crank

from mechsym.cycle.chamber import Chamber
from mechsym.files import write_csv


@pytest.fixture
def marine() -> Chamber:
    return slider_crank(0.5, 1.55, 0.3, 17.0)


@pytest.fixture
def diagram_file(tmp_path: Path):
    """Write columns (name to values) as a diagram file and give its path."""

    def write(columns: dict, name: str = "diagram.csv") -> str:
        return str(write_csv(tmp_path / name, columns))

    return write
