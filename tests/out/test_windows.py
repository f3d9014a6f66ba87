"""The Windows library of an FMU: what it gives away, and that it steps under wine as the Linux one does."""

import os
import re
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from mechsym import cases
from mechsym.cli import mechsym
from mechsym.jobs.problem import ready
from mechsym.out.block import block_of
from mechsym.out.fmi import fmu

fmpy = pytest.importorskip("fmpy", reason="the extra fmu is not installed")
pytest.importorskip("ziglang", reason="the extra web is not installed")
pytestmark = [pytest.mark.slow, pytest.mark.heavy]
HERE = Path(__file__).parent
HEADERS = HERE.parents[1] / "mechsym" / "out" / "fmi" / "headers"
WINE = shutil.which("wine64") or shutil.which("wine64", path="/usr/lib/wine") or shutil.which("wine")


TWELVE = ["new", "engine", "twelve", "--kind", "v", "--bore", "90 mm", "--stroke", "80 mm", "--cylinders", "12"]


@pytest.fixture(scope="module", params=["zotov_89", "twelve"])
def unit(request, exported, tmp_path_factory):
    """File of an FMU with both libraries; functions of the twelve cylinders need more than a page of stack."""
    folder = tmp_path_factory.mktemp("windows")
    if request.param == "twelve":
        assert CliRunner().invoke(mechsym, [*TWELVE, "--out", str(folder)]).exit_code == 0
        case = cases.load(str(folder / "twelve.toml"))
        block = block_of(case.name, case.about, ready(case))
    else:
        block = exported("zotov-89")[1]
    made = fmu(block, 2, ("linux64", "win64"))
    assert made.missing == {}
    path = folder / f"{request.param}.fmu"
    path.write_bytes(made.data)
    return path


@pytest.fixture(scope="module")
def library(unit):
    with zipfile.ZipFile(unit) as archive:
        return Path(archive.extract(f"binaries/win64/{unit.stem}.dll", unit.parent))


def test_all_functions_of_the_standard_are_there(library):
    if not (objdump := shutil.which("objdump")):
        pytest.skip("objdump is not installed")
    said = subprocess.run([objdump, "-p", library], capture_output=True, text=True, check=True).stdout
    names = set(re.findall(r"\bfmi2\w+", said))
    types = set(re.findall(r"\bFMI2_Export fmi2\w+TYPE (fmi2\w+)", (HEADERS / "fmi2Functions.h").read_text()))
    assert types and types <= names, sorted(types - names)
    # what Windows has of itself
    needed = {name.lower() for name in re.findall(r"DLL Name: (\S+)", said)}
    assert all(name == "kernel32.dll" or name.startswith(("api-ms-win-crt-", "msvcrt", "ucrtbase")) for name in needed)


def test_steps_are_those_of_linux(unit, library):
    if WINE is None:
        pytest.skip("wine is not installed")
    host = unit.parent / "host.exe"
    source = HERE / "windows_host.c"
    words = [sys.executable, "-m", "ziglang", "cc", "-target", "x86_64-windows-gnu", f"-I{HEADERS}", "-O1"]
    subprocess.run([*words, str(source), "-o", str(host)], check=True)
    described = fmpy.read_model_description(str(unit))
    states = [derivative.variable.derivative for derivative in described.derivatives]
    references = [str(state.valueReference) for state in states]
    steps, step = 50, 0.01
    place = {**os.environ, "WINEPREFIX": str(unit.parent / "wine"), "WINEDEBUG": "-all"}
    run = [WINE, str(host), str(library), described.guid, str(steps), str(step), *references]
    done = subprocess.run(run, capture_output=True, text=True, env=place, check=False, timeout=300)
    assert done.returncode == 0, done.stderr
    found = np.array([[float(word) for word in line.split()] for line in done.stdout.splitlines()])
    truth = fmpy.simulate_fmu(
        str(unit), fmi_type="CoSimulation", stop_time=steps * step, step_size=step, output_interval=step,
        output=[state.name for state in states],
    )  # fmt: skip
    wanted = np.array([[row[state.name] for state in states] for row in truth][1 : steps + 1])
    assert found.shape == wanted.shape
    # corners of twelve pressures: the last digit of a sine moves the steps, which differ by their own error
    near = 1e-9 if unit.stem == "zotov_89" else 1e-8
    assert np.abs(found - wanted).max() <= near * np.abs(wanted).max()
