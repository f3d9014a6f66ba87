"""An editable install means the clone, from the folder that holds it too; metadata as registries read them."""

import os
import subprocess
import sys
import tomllib
import zipfile

import pytest


@pytest.fixture(scope="module")
def site(pytestconfig, tmp_path_factory):
    """What an editable install puts beside other packages."""
    folder = tmp_path_factory.mktemp("site")
    code = f"from setuptools import build_meta; print(build_meta.build_editable({str(folder)!r}))"
    built = subprocess.run([sys.executable, "-c", code], cwd=pytestconfig.rootpath, capture_output=True, text=True)
    assert built.returncode == 0, built.stderr
    with zipfile.ZipFile(next(folder.glob("*.whl"))) as wheel:
        wheel.extractall(folder)
    return folder


@pytest.mark.parametrize("name", ["mechsym", "elsewhere"])
def test_the_clone_is_imported_from_any_folder(site, pytestconfig, tmp_path, name):
    (tmp_path / name / "docs").mkdir(parents=True)  # as the clone stands in the folder that holds it
    code = (
        "import site, sys; sys.path.insert(0, ''); site.addsitedir(sys.argv[1]);"
        "import mechsym, mechsym.generated, mechsym.derivations, mechsym.errors; print(mechsym.__file__)"
    )
    # without other site packages, or this environment's own install would answer
    done = subprocess.run(
        [sys.executable, "-S", "-c", code, str(site)], cwd=tmp_path, capture_output=True, text=True,
        env={k: v for k, v in os.environ.items() if k != "PYTHONPATH"},
    )  # fmt: skip
    assert done.stdout.strip() == str(pytestconfig.rootpath / "mechsym" / "__init__.py"), done.stderr


def test_metadata(site):
    text = next(site.glob("*.dist-info/METADATA")).read_text()
    lines = text.splitlines()
    assert "License-Expression: MIT" in lines and "License-File: LICENSE" in lines
    assert "Requires-Dist: sympy==1.14.0" in lines  # no extra: derivation and audit are what the package is for


def test_make_installs_extras_that_exist(pytestconfig):
    extras = tomllib.loads((pytestconfig.rootpath / "pyproject.toml").read_text())["project"]["optional-dependencies"]
    lines = [x for x in (pytestconfig.rootpath / "Makefile").read_text().splitlines() if "-e '.[" in x]
    assert lines
    for line in lines:
        assert set(line.partition("[")[2].partition("]")[0].split(",")) <= set(extras)
