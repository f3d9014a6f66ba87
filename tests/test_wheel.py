"""What is shipped: the wheel holds everything that is needed at run time, and works where it is installed."""

import re
import shutil
import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
# folders of the source tree that go into the wheel, and where they go
SHIPPED = {"mechsym": "mechsym", "generated": "mechsym/generated", "derivations": "mechsym/derivations"}


def expected():
    for folder, place in SHIPPED.items():
        for file in (ROOT / folder).rglob("*"):
            if file.is_file() and "__pycache__" not in file.parts:
                yield f"{place}/{file.relative_to(ROOT / folder).as_posix()}"


def run(*command, **options):
    done = subprocess.run(command, capture_output=True, text=True, check=False, **options)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    """The wheel, built from a copy so that nothing is left behind in the source tree."""
    source = tmp_path_factory.mktemp("source") / "mechsym"
    kept_out = shutil.ignore_patterns(".*", "build", "dist", "*.egg-info", "__pycache__", "demo", "tests")
    shutil.copytree(ROOT, source, ignore=kept_out)
    out = source.parent / "dist"
    run(sys.executable, "-m", "build", "--wheel", "--no-isolation", "--outdir", out, source)
    return next(out.glob("*.whl"))


@pytest.mark.slow
def test_wheel_holds_every_file_and_nothing_else(wheel):
    names = {n for n in zipfile.ZipFile(wheel).namelist() if ".dist-info/" not in n}
    assert names == set(expected())


@pytest.mark.slow
def test_wheel_runs_where_it_is_installed(wheel, tmp_path):
    home = tmp_path / "venv"
    run(sys.executable, "-m", "venv", "--without-pip", home)
    packages = next((home / "lib").glob("python*")) / "site-packages"
    zipfile.ZipFile(wheel).extractall(packages)
    # numpy and the rest come from the environment of the tests, mechsym from the wheel
    (packages / "dependencies.pth").write_text(str(Path(pytest.__file__).parent.parent) + "\n")
    python = home / "bin" / "python"
    assert str(packages) in run(python, "-c", "import mechsym; print(mechsym.__file__)", cwd=tmp_path)
    assert "zotov-89" in run(python, "-m", "mechsym", "cases", cwd=tmp_path)
    state = run(python, "-m", "mechsym", "eval", "crosshead", "--case", "zotov-89", "--set", "phi=1.0", cwd=tmp_path)
    assert re.search(r"inertia +179\.541596065", state)
    assert "phi" in run(python, "-m", "mechsym", "mechanisms", "--json", cwd=tmp_path)


def test_citation_is_of_this_version():
    version = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["version"]
    citation = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    assert re.search(rf"^version: {re.escape(version)}$", citation, re.M)
    assert "\nlicense: MIT\n" in citation
