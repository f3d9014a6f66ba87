"""Generated files are neither stale nor edited by hand. Needs no sympy: both hashes are read from the headers."""

import hashlib
import json
import re
import subprocess
import sys
from pathlib import Path

import pytest

import mechsym
import mechsym.derivations
import mechsym.generated

GENERATED = Path(mechsym.generated.__file__).parent
DERIVATIONS = Path(mechsym.derivations.__file__).parent
CORE = Path(mechsym.__file__).parent / "derive"
MODULES = sorted(p for p in GENERATED.glob("*.py") if p.stem != "__init__")
HEADER_LINES = 4


def digest(text):
    return hashlib.sha256(text.replace("\r\n", "\n").encode()).hexdigest()[:16]


def stamp(path, kind):
    return re.search(rf"# {kind} +sha256: ([0-9a-f]{{16}})", path.read_text())[1]


def test_every_script_has_its_files_and_every_file_its_script():
    scripts = {p.stem for p in DERIVATIONS.glob("*.py")} - {"__init__"}
    assert scripts == {p.stem for p in MODULES} == {p.stem for p in GENERATED.glob("equations/*.json")}


@pytest.mark.parametrize("path", MODULES, ids=lambda p: p.stem)
def test_source_stamp_is_that_of_the_derivation(path):
    sources = [DERIVATIONS / path.name, *sorted(CORE.glob("*.py"))]
    assert stamp(path, "source") == digest("\0".join(p.read_text() for p in sources)), "run `make derive` and commit"


@pytest.mark.parametrize("path", MODULES, ids=lambda p: p.stem)
def test_body_was_not_edited(path):
    body = "".join(path.read_text().splitlines(keepends=True)[HEADER_LINES:])
    assert stamp(path, "body") == digest(body), "generated code is never edited: run `make derive`"


@pytest.mark.parametrize("path", MODULES, ids=lambda p: p.stem)
def test_listing_holds_equations(path):
    listing = json.loads((GENERATED / "equations" / f"{path.stem}.json").read_text())
    assert listing["name"] == path.stem
    assert all(row["mathml"].startswith("<") and row["latex"] for row in listing["equations"])


def test_the_run_time_package_loads_no_sympy():
    code = "import sys, mechsym, mechsym.mechanisms.crosshead, mechsym.cases; sys.exit('sympy' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
