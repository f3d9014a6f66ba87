"""Every case runs along its reference trajectory, with every integrator: a tube around motions that are kept in a file.

The reference is an eighth-order run at the tightest tolerance, kept to twelve digits; the tube is ten thousand
tolerances of the run that is tried wide. `pytest --update` on the heavy tests writes the file anew.
"""

import csv
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mechsym import cases
from mechsym.errors import BadInput, MissingExtra
from mechsym.jobs.problem import problem_of
from mechsym.jobs.run import in_loop, run_in_loop
from mechsym.simulate import Settings, simulate
from mechsym.simulate.settings import BACKENDS

FILE = Path(__file__).parent / "golden" / "runs.csv"
TUBE = 1e4  # tolerances
POINTS = 8
# a torque that is switched on at 1 s; all others go a turn from their speed of operation
SHORT = {"chmielewski": {"simulation.t_end": 1.5, "simulation.window": 0.5}}
TOLERANCES = {"scipy-rk23": 1e-7, "scipy-rk45": 1e-8, "scipy-bdf": 1e-8, "scipy-radau": 1e-8}  # else 1e-10
QUICK = {("chmielewski", "auto"), ("moroianu", "scipy-bdf"), ("zotov-89", "sundials"), ("balandin", "native")}
HEAVY = [pytest.mark.slow, pytest.mark.heavy]


def motion(name, backend, tolerance):
    """Coordinates and velocities at even times; nothing where the backend does not take the case."""
    case = cases.load(name, SHORT.get(name, {"simulation.turns": 1.0}))
    settings = Settings(backend=backend, tolerance=tolerance, check="none")
    try:
        if in_loop(case):
            return at(run_in_loop(case, settings), None)
        problem = problem_of(case)
        end = 1.5 if problem.turns is None else 0.9 * 2 * np.pi / case.need("operation").speed
        times = tuple((end * np.arange(1, POINTS + 1) / POINTS).tolist())
        return at(simulate(replace(problem, output=times), settings), times)
    except (BadInput, MissingExtra) as error:
        assert "backend" in str(error)
        return None


def refuses(name, backend):
    """Gas in the loop goes with one integrator; two know no events, and one of them is an extra."""
    if in_loop(cases.load(name)):
        return backend not in ("auto", "scipy-dop853")
    return backend == "heyoka" or (backend == "sundials" and name != "chmielewski")


def at(result, times):
    """Times and columns of the motion; of a grid that is not chosen, some of its times."""
    assert result.status == "unchecked", result.reason
    if times is None:
        near = np.linspace(0, len(result.t) - 2, POINTS + 1).astype(int)[1:]
        times = result.t[near]
    at_ = np.searchsorted(result.t, np.asarray(times) - 1e-12)
    assert np.allclose(result.t[at_], times, rtol=1e-9)
    names = [name for name, unit in result.units.items() if unit in ("rad", "rad/s")]
    return np.asarray(times), {name: result.columns[name][at_] for name in names}


def stored():
    """Case to times and columns of its reference."""
    found = {}
    with FILE.open(newline="") as file:
        for case, t, column, value in list(csv.reader(file))[1:]:
            found.setdefault(case, {}).setdefault(column, []).append((float(t), float(value)))
    return found


@pytest.mark.parametrize(
    ("name", "backend"),
    [
        pytest.param(name, backend, marks=[] if (name, backend) in QUICK else HEAVY)
        for name in cases.names()
        for backend in BACKENDS
    ],
)
def test_motion_stays_in_the_tube(name, backend):
    tolerance = TOLERANCES.get(backend, 1e-10)
    found = motion(name, backend, tolerance)
    if found is None:
        assert refuses(name, backend)
        return
    times, columns = found
    reference = stored()[name]
    assert set(columns) == set(reference)
    for column, values in columns.items():
        t, wanted = np.array(reference[column]).T
        assert np.allclose(times, t, rtol=1e-9)
        off = np.abs(values - wanted).max() / np.abs(wanted).max()
        assert off < TUBE * tolerance, f"{column} is {off:.1e} of its peak off"


def test_every_case_has_a_reference():
    assert set(stored()) == set(cases.names())


@pytest.mark.slow
@pytest.mark.heavy
def test_the_reference_is_what_the_tightest_run_gives(request):
    rows = [("case", "t [s]", "column", "value [SI]")]
    for name in cases.names():
        times, columns = motion(name, "scipy-dop853", 3e-14)
        rows += [
            (name, f"{t:.12g}", column, f"{value:.12g}")
            for column, values in columns.items()
            for t, value in zip(times, values, strict=True)
        ]
    if request.config.getoption("--update"):
        FILE.parent.mkdir(exist_ok=True)
        with FILE.open("w", newline="") as file:
            csv.writer(file, lineterminator="\n").writerows(rows)
    with FILE.open(newline="") as file:
        kept = [tuple(row) for row in csv.reader(file)]
    assert [row[:3] for row in kept] == [row[:3] for row in rows]
    assert all(
        float(k[3]) == pytest.approx(float(r[3]), rel=1e-9, abs=1e-12) for k, r in zip(kept[1:], rows[1:], strict=True)
    )
