"""FMUs: what the standard wants, numbers against `simulate`, derivatives, state, sources, and other importers."""

import dataclasses
import importlib.util
import io
import json
import re
import subprocess
import sys
import zipfile
from pathlib import Path

import casadi as ca
import locking
import numpy as np
import pytest
from click.testing import CliRunner

from mechsym import cases
from mechsym.cli import mechsym
from mechsym.jobs.export import ready
from mechsym.out.block import block_of
from mechsym.out.fmi import fmu
from mechsym.simulate import Settings, simulate

fmpy = pytest.importorskip("fmpy", reason="the extra fmu is not installed")
validation = pytest.importorskip("fmpy.validation")

from mechsym.out.fmi.compare import compare, driven  # noqa: E402

VERSIONS = (2, 3)
FIRST, SLOW, HEAVY = "zotov-89", pytest.mark.slow, pytest.mark.heavy
ALL = [pytest.param(name, marks=() if name == FIRST else SLOW) for name in cases.names()]
OTHER = {2: [SLOW, HEAVY], 3: SLOW}  # the same C in the older wrapper
EACH = [pytest.param(n, v, marks=() if n == FIRST else OTHER[v]) for n in cases.names() for v in VERSIONS]


@pytest.mark.parametrize("version", VERSIONS)
@pytest.mark.parametrize("name", ALL)
def test_the_standard_is_kept(unit, name, version):
    assert validation.validate_fmu(str(unit(name, version))) == []


@pytest.mark.slow
@pytest.mark.parametrize("version", VERSIONS)
@pytest.mark.parametrize("name", cases.names())
def test_fmutool_finds_no_error(unit, name, version):
    pytest.importorskip("fmu_manipulation_toolbox", reason="fmu-manipulation-toolbox is not installed")
    command = [
        sys.executable,
        "-m",
        "fmu_manipulation_toolbox.cli.fmutool",
        "-input",
        str(unit(name, version)),
        "-check",
    ]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    said = done.stdout + done.stderr
    assert "seems to be compliant" in said and "No semantic error" in said, said


@pytest.mark.parametrize(("name", "version"), EACH)
def test_numbers_are_those_of_simulate(unit, exported, name, version):
    for found in compare(unit(name, version), exported(name)[0].problem):
        assert found.points == 201
        assert found.largest < 1e-9, f"{found.kind}: {found.largest:.2g}"


@pytest.mark.slow
def test_knots_of_a_table_are_not_stepped_over(tmp_path):
    """Combustion that ends at 40 deg: a first step after the event that is chosen by the slope alone missed 2e-7, a
    hundred times what is allowed."""
    case = cases.load("generator-breathing", {"cycle.duration": "60 deg"})
    run = ready(case)
    (tmp_path / "e.fmu").write_bytes(fmu(block_of(case.name, case.about, run), 2).data)
    for found in compare(tmp_path / "e.fmu", run.problem):
        assert found.largest < 2e-9, f"{found.kind}: {found.largest:.2g}"


def test_an_importer_with_its_own_solver_gets_the_same(unit, exported):
    (found,) = compare(unit("zotov-89", 2), exported("zotov-89")[0].problem, kinds=("cvode",))
    assert found.largest < 1e-7  # CVode at 1e-13 keeps about that much over twenty turns


@pytest.mark.parametrize("version", VERSIONS)
@pytest.mark.parametrize("name", ALL)
def test_directional_derivatives_equal_differences(unit, name, version):
    random = np.random.default_rng(7)
    with driven(unit(name, version), "me") as run:
        # away from the kinks, where a difference would see both sides
        run.event(0.0, run.states() + random.uniform(0.05, 0.1, len(run.state_names)))
        unknown = [*run.rate_references, *run.outputs]
        states = [run.references[n] for n in run.state_names]
        for known in [*states, *run.inputs, *run.parameters]:
            exact = np.array(run.unit.getDirectionalDerivative(unknown, [known], [1.0]))
            (start,) = run.get([known])
            size, (low, high) = max(abs(start), 0.1), _around(run, unknown, known, start)
            scale = np.maximum(np.abs(exact), np.abs(run.get(unknown)) / size)
            assert np.all(np.abs(exact - (high - low) / (2e-6 * size)) <= 1e-6 * scale + 1e-9), known


def _around(run, unknown, known, start):
    values = []
    for sign in (-1, 1):
        run.set([known], [start + sign * 1e-6 * max(abs(start), 0.1)])
        values.append(np.array(run.get(unknown)))
    run.set([known], [start])
    return values


@pytest.mark.parametrize("version", VERSIONS)
def test_a_restored_state_goes_on_to_the_last_digit(unit, version):
    with driven(unit("zotov-89", version), "cs") as run:
        run.step(0.0, 0.4)
        kept = run.unit.getFMUState()
        stored = run.unit.serializeFMUState(kept)
        run.step(0.4, 0.5)
        first = run.states()
        run.unit.setFMUState(run.unit.deserializeFMUState(stored))
        run.step(0.4, 0.5)
        np.testing.assert_array_equal(run.states(), first)


@pytest.mark.parametrize("version", VERSIONS)
def test_a_tunable_pressure_does_what_another_case_does(unit, version):
    run = ready(cases.load("zotov-89"))
    detuned = simulate(run.problem, Settings(tolerance=1e-12, check="none"))
    with driven(unit("zotov-89", version), "cs") as own:
        (p0,) = own.get([own.references["p0"]])
        own.set([own.references["p0"]], [1.01 * p0])
        own.step(0.0, 1.0)
        off = own.states()
    at = np.searchsorted(detuned.t, 1.0)
    # one per cent of pressure is five per cent of ripple: far from what the design runs
    assert abs(off[1] - detuned.columns["phid"][at]) > 1e-3 * off[1]


def test_a_stall_ends_the_run_where_simulate_ends_it(tmp_path):
    case = cases.load("zotov-89", {"load.law": "constant", "load.torque": "100 kN*m"})
    run = ready(case)
    wanted = simulate(run.problem, Settings(tolerance=1e-12, check="none"))
    assert wanted.event.name == "stall"
    for version in VERSIONS:
        path = tmp_path / f"stall{version}.fmu"
        path.write_bytes(fmu(block_of(case.name, case.about, run), version).data)
        with driven(path, "cs") as own:
            assert own.step(0.0, 100.0)
            assert own.get([0])[0] == pytest.approx(wanted.event.t, rel=1e-10)
            assert own.states()[1] == 0.0


@pytest.mark.parametrize("version", VERSIONS)
def test_the_time_of_a_switched_torque_can_be_moved(exported, tmp_path, version):
    path = tmp_path / "start.fmu"
    path.write_bytes(fmu(exported("chmielewski")[1], version).data)
    with driven(path, "cs") as run:
        run.set([run.references["drive_time_1"]], [0.25])
        run.step(0.0, 0.25)
        assert np.all(run.states() == 0)
        run.step(0.25, 0.01)
        assert run.states()[1 if version else 0] != 0
    with driven(path, "me") as run:
        assert run.next_event() == 1.0


def test_the_same_model_gives_the_same_file(exported):
    block = exported("zotov-89")[1]
    first, again = fmu(block, 3, ()), fmu(block, 3, ())
    assert first.data == again.data
    assert fmu(exported("chmielewski")[1], 3, ()).token != first.token


def test_sources_are_inside_and_no_path_of_this_machine(unit):
    for version in VERSIONS:
        with zipfile.ZipFile(io.BytesIO(unit("zotov-89", version).read_bytes())) as archive:
            names = archive.namelist()
            assert {f"sources/fmi{version}.c", "sources/core.h", "sources/model.h"} <= set(names)
            assert not any(b"/work" in archive.read(n) or b"/tmp" in archive.read(n) for n in names)


@pytest.mark.slow
@pytest.mark.parametrize("version", VERSIONS)
def test_the_shipped_sources_compile_to_the_same_numbers(unit, tmp_path, version):
    import shutil

    if shutil.which("cmake") is None:
        pytest.skip("cmake is not installed")
    path = tmp_path / "again.fmu"
    with zipfile.ZipFile(unit("zotov-89", version)) as old, zipfile.ZipFile(path, "w") as new:
        for name in old.namelist():
            if not name.startswith("binaries"):
                new.writestr(name, old.read(name))
    subprocess.run([sys.executable, "-m", "fmpy", "compile", str(path)], check=True, capture_output=True)
    with driven(path, "cs") as run, driven(unit("zotov-89", version), "cs") as other:
        run.step(0.0, 1.0)
        other.step(0.0, 1.0)
        np.testing.assert_allclose(run.states(), other.states(), rtol=1e-11)


@pytest.mark.slow
@pytest.mark.parametrize("version", VERSIONS)
def test_casadi_reads_it_and_has_the_same_jacobian(unit, exported, version):
    block = exported("zotov-89")[1]
    dae = ca.DaeBuilder("machine", str(unit("zotov-89", version)))
    x = np.array([0.3, 9.0])
    kept = {"x": dae.x(), "u": dae.u()}
    assert kept["x"] == [s.name for s in block.states]
    f = dae.create("f", ["x", "u"], ["ode"])
    jacobian = f.factory("jacobian", ["x", "u"], ["jac:ode:x"])
    found = np.array(jacobian(x, np.zeros(len(kept["u"]))))
    np.testing.assert_allclose(found, _jacobian(block, x), rtol=1e-12, atol=1e-12)


def _jacobian(block, x):
    """By the chain rule: the function by x and by w, and w by x from the polynomials."""
    t, xs, u, p, w, s = (ca.SX.sym(n, block.rates.size1_in(i)) for i, n in enumerate("txupws"))
    rates = block.rates(t, xs, u, p, w, s)
    both = ca.Function("both", [t, xs, u, p, w, s], [ca.jacobian(rates, xs), ca.jacobian(rates, w)])
    values = [c.poly(c.ratio * x[c.state], k) for c in block.curves for k in (0, 1)]
    slopes = np.zeros((len(values), len(x)))
    for i, c in enumerate(block.curves):
        for k in (0, 1):
            slopes[2 * i + k, c.state] = c.ratio * c.poly(c.ratio * x[c.state], k + 1)
    starts = [port.start for port in block.parameters]
    by_x, by_w = both(0, x, np.zeros(len(block.inputs)), starts, values, [])
    return np.array(by_x) + np.array(by_w) @ slopes


def test_the_command_says_what_it_wrote(tmp_path):
    path = tmp_path / "e.fmu"
    done = CliRunner().invoke(mechsym, ["fmu", "zotov-89", "--fmi", "3", "--out", str(path), "--json"])
    assert done.exit_code == 0, done.output
    answer = json.loads(done.output)
    assert answer["written"] == [str(path)] and path.stat().st_size < 300_000
    windows = ["binaries/x86_64-windows/zotov_89.dll"] * (importlib.util.find_spec("ziglang") is not None)
    assert answer["checks"]["binaries"] == ["binaries/x86_64-linux/zotov_89.so", *windows]
    assert len(answer["checks"]["missing"]) == 1 - len(windows)


def test_a_folder_gets_the_file_under_its_usual_name_and_the_text_has_words(tmp_path):
    words = ["fmu", "zotov-89", "--platforms", "none", "--out", str(tmp_path / "units")]
    done = CliRunner().invoke(mechsym, words)
    assert done.exit_code == 0 and f"written: {tmp_path}/units/zotov-89.fmu" in done.output.splitlines()
    assert (tmp_path / "units/zotov-89.fmu").exists() and "_" not in done.output.replace(str(tmp_path), "")


@pytest.mark.slow
def test_without_the_extra_one_line_names_it(tmp_path):
    code = "import sys; sys.modules['fmpy'] = None; from mechsym.cli import main; main()"
    words = ["fmu", "zotov-89", "--compare", "--platforms", "linux64", "--out", str(tmp_path / "e.fmu")]
    done = subprocess.run([sys.executable, "-c", code, *words], capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert done.stderr.strip() == "mechsym: running an FMU needs the extra fmu: pip install 'mechsym[fmu]'"


HOST = r"""
#include <dlfcn.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "fmi2Functions.h"
static void say(void *e, fmi2String n, fmi2Status s, fmi2String c, fmi2String m, ...)
{
    (void)e, (void)n, (void)s, (void)c;
    puts(m);
}
#define GET(NAME) NAME##TYPE *NAME##_ = (NAME##TYPE *)dlsym(library, #NAME); if (!NAME##_) return 2;
int main(int count, char **words)
{
    void *library = dlopen(words[1], RTLD_NOW);
    if (count < 3 || !library) return 1;
    GET(fmi2Instantiate) GET(fmi2SetupExperiment) GET(fmi2EnterInitializationMode) GET(fmi2ExitInitializationMode)
    GET(fmi2DoStep) GET(fmi2GetReal) GET(fmi2Terminate) GET(fmi2FreeInstance)
    const fmi2CallbackFunctions call = {say, calloc, free, NULL, NULL};
    fmi2Component c = fmi2Instantiate_("host", fmi2CoSimulation, words[2], "", &call, fmi2False, fmi2False);
    if (!c || fmi2SetupExperiment_(c, fmi2True, 1e-13, 0.0, fmi2False, 0.0) || fmi2EnterInitializationMode_(c)
        || fmi2ExitInitializationMode_(c)) return 3;
    for (int i = 0; i < 50; i++)
        if (fmi2DoStep_(c, 0.1 * i, 0.1 * (i + 1) - 0.1 * i, fmi2True)) return 4;
    const fmi2ValueReference states[2] = {1, 2};
    double value[2];
    if (fmi2GetReal_(c, states, 2, value)) return 5;
    printf("%.17g %.17g", value[0], value[1]);
    fmi2Terminate_(c);
    fmi2FreeInstance_(c);
    return 0;
}
"""


@pytest.mark.slow
def test_a_program_in_c_runs_it_without_python(unit, exported, tmp_path):
    with zipfile.ZipFile(unit("zotov-89", 2)) as archive:
        archive.extractall(tmp_path)
    token = re.search(r'guid="([^"]+)"', (tmp_path / "modelDescription.xml").read_text())[1]
    (tmp_path / "host.c").write_text(HOST)
    words = ["gcc", "-std=gnu11", f"-I{tmp_path}/sources", str(tmp_path / "host.c"), "-o", str(tmp_path / "host")]
    subprocess.run([*words, "-ldl", "-lm"], check=True, capture_output=True)
    library = tmp_path / "binaries" / "linux64" / "zotov_89.so"
    found = subprocess.check_output([tmp_path / "host", library, token]).split()
    problem = dataclasses.replace(exported("zotov-89")[0].problem, output=(5.0,), t_end=5.0, turns=None)
    wanted = simulate(problem, Settings(tolerance=1e-13, check="none"))
    truth = [wanted.columns["phi"][-1], wanted.columns["phid"][-1]]
    np.testing.assert_allclose(np.array(found, dtype=float), truth, rtol=1e-10)


EXAMPLES = Path(__file__).parents[2] / "examples" / "mechanisms"


@pytest.mark.slow
def test_a_mechanism_of_ones_own_is_an_fmu_too(tmp_path, monkeypatch):
    for name in ("scotch_yoke.py", "scotch-yoke.toml"):
        (tmp_path / name).write_text((EXAMPLES / name).read_text())
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    for settings in ({}, {"simulation.hinge": "none", "simulation.turns": "3"}):
        case = cases.load("scotch-yoke.toml", settings)
        run = ready(case)
        (tmp_path / "own.fmu").write_bytes(fmu(block_of(case.name, case.about, run), 3).data)
        for found in compare(tmp_path / "own.fmu", run.problem):
            assert found.largest < 1e-9, f"{settings} {found.kind}: {found.largest:.2g}"


ENGINES = {"two-stroke-crosshead": "1", "inline": "6", "v": "2", "opposed": "1", "hypocycloid": "1"}


def new_engine(kind, folder, count=""):
    words = ["--kind", kind, "--bore", "86 mm", "--stroke", "86 mm", "--out", str(folder)]
    words += ["--cylinders", count] if count else []
    done = CliRunner().invoke(mechsym, ["new", "engine", "mine", *words])
    assert done.exit_code == 0, done.output
    return cases.load(str(folder / "mine.toml"))


@pytest.mark.slow
@pytest.mark.heavy
@pytest.mark.parametrize("version", VERSIONS)
@pytest.mark.parametrize("kind", ENGINES)
def test_a_new_engine_is_an_fmu_at_once(tmp_path, kind, version):
    case = new_engine(kind, tmp_path, ENGINES[kind])
    run = ready(case)
    path = tmp_path / "e.fmu"
    path.write_bytes(fmu(block_of(case.name, case.about, run), version).data)
    assert validation.validate_fmu(str(path)) == []
    for found in compare(path, run.problem):
        assert found.largest < 1e-9, f"{found.kind}: {found.largest:.2g}"


@pytest.mark.slow
def test_each_cylinder_of_a_train_has_its_own_gas(tmp_path):
    """The exported force on each piston against its cycle, a table too: 3e-5, and 5 % without the kinks of each."""
    from mechsym.jobs.machine import turn

    case = new_engine("inline", tmp_path, "3")
    run, once = ready(case), turn(case)
    for i in (1, 2, 3):
        gas = next(part.value for part in run.problem.parts if part.input == f"F{i}")
        phi = once.phi % once.period
        found, wanted = gas.value(phi), once.inputs[f"F{i}"]
        # where the exhaust opens the force jumps, and either side is right
        smooth = np.abs(phi[:, None] - np.array(gas.kinks)).min(axis=1) > 1e-9
        assert smooth.sum() > 0.99 * len(phi)
        assert np.max(np.abs(found - wanted)[smooth]) < 1e-4 * np.max(np.abs(wanted))


@pytest.mark.parametrize("version", ["4", "1", "two"])
def test_another_version_of_the_standard_is_refused(tmp_path, version):
    path = tmp_path / "e.fmu"
    done = CliRunner().invoke(mechsym, ["fmu", "zotov-89", "--fmi", version, "--out", str(path)])
    assert done.exit_code == 2 and not path.exists()


def test_a_missing_compiler_is_one_line_and_the_sources_are_written(tmp_path, monkeypatch):
    monkeypatch.setenv("CC", "no-such-compiler")
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    path = tmp_path / "e.fmu"
    words = ["fmu", "zotov-89", "--platforms", "linux64,win64", "--out", str(path)]
    done = CliRunner().invoke(mechsym, words)
    assert done.exit_code == 0, done.output
    said = [line for line in done.output.splitlines() if line.startswith("no binary for ")]
    assert len(said) == 2 and "no-such-compiler" in said[0] and "mechsym[web]" in said[1]
    with zipfile.ZipFile(path) as archive:
        assert not any(n.startswith("binaries") for n in archive.namelist()) and "sources/fmi2.c" in archive.namelist()


@pytest.mark.slow
@pytest.mark.parametrize("held", ["constraint", *(pytest.param(h, marks=HEAVY) for h in ("dead point", "bifurcation"))])
def test_loops_by_constraint_run_as_the_simulation(tmp_path, monkeypatch, held):
    monkeypatch.chdir(tmp_path)
    if held == "constraint":
        for name in ("watt_six_bar.py", "watt-six-bar.toml"):
            Path(name).write_text((EXAMPLES / name).read_text())
        case, more = "watt-six-bar.toml", ("--set", "simulation.t_end=0.4 s")
    else:
        case = "f.toml"
        Path("fourbar.py").write_text(locking.FOURBAR)
        Path(case).write_text(locking.CASE.format(speed=3, start=0.3, torque=0))
        more = ("--set", f"b={0.4 if held == 'bifurcation' else 0.25} m")
    done = CliRunner().invoke(mechsym, ["fmu", case, "--out", "w.fmu", "--compare", "--platforms", "linux64", *more])
    assert done.exit_code == 0, (done.output, done.exception)
