"""A closed form that has no pose beyond an angle: the run ends there with the event `locked`, not as a failure."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from locking import CASE, FOURBAR

from mechsym import cases
from mechsym.cases.settings import settings_of
from mechsym.errors import BadInput
from mechsym.jobs import run
from mechsym.jobs.problem import problem_of
from mechsym.simulate import simulate


def case_of(folder, speed=0.0, start=0.0, torque=0.0, more=""):
    (folder / "fourbar.py").write_text(FOURBAR)
    (folder / "f.toml").write_text(CASE.format(speed=speed, start=start, torque=torque) + more)
    return cases.load(str(folder / "f.toml"))


# rod and rocker in line: a^2 + d^2 - 2 a d cos phi = (b + c)^2
LOCKS = np.arccos((0.2**2 + 0.4**2 - 0.45**2) / (2 * 0.2 * 0.4))


@pytest.mark.parametrize("backend", ["auto", "dop853"])
@pytest.mark.parametrize(("speed", "torque", "sign"), [(3.0, 0.0, 1), (0.0, 0.5, 1), (-3.0, 0.0, -1)])
def test_a_run_ends_where_the_loop_opens(tmp_path, speed, torque, sign, backend):
    case = case_of(tmp_path, speed, 0.3 * sign, torque)
    found = simulate(problem_of(case), settings_of(case))
    assert found.event is not None and found.event.name == "locked" == found.end
    assert found.event.state["phi"] == pytest.approx(sign * LOCKS, abs=1e-5)
    assert 0 < found.t[-1] <= found.event.t < 5
    assert found.status != "failed" and abs(found.energy.residual) < 1e-6


def test_a_start_beyond_is_refused(tmp_path):
    case = case_of(tmp_path, 1.0, 2.5)
    with pytest.raises(BadInput, match=r"the loop is open at the start \(phi = 2.5\)"):
        problem_of(case)


@pytest.mark.slow
def test_the_flywheel_of_a_case_is_on_the_shaft(tmp_path):
    bare, heavy = (
        case_of(tmp_path, 0.0, 0.3, 0.1, more) for more in ("", "[flywheel]\ninertia = 0.5\n")
    )  # fmt: skip
    found = [simulate(problem_of(case), settings_of(case)) for case in (bare, heavy)]
    assert found[1].event.t > 3 * found[0].event.t
    energy = found[1].energy
    assert abs(energy.residual) < 1e-6
    speed = found[1].columns["phid"]
    assert found[1].columns["kinetic_energy"][5] > 0.5 * 0.5 * speed[5] ** 2


@pytest.mark.slow
@pytest.mark.parametrize(("b", "kind"), [(0.25, "dead_point"), (0.4, "bifurcation")])
def test_a_run_of_a_case_goes_on_where_the_closed_form_ends(tmp_path, b, kind):
    # with b = d and a = c the links lie flat at 0 and pi, and the crank turns evenly, which no torque drives
    case = case_of(tmp_path, 3.0, 0.3)
    found = run(replace(case, sections={**case.sections, "parameters": replace(case.need("parameters"), b=b)})).result
    assert (found.status, found.end) == ("converged", "t_end")
    assert len(found.happened.events) >= 4 and {e.kind for e in found.happened.events} == {kind}
    assert abs(found.energy.residual) < 1e-9
    phi, rod, rocker = (found.columns[n] for n in ("phi", "theta_rod", "theta_rocker"))
    loop = 0.2 * np.exp(1j * phi) + b * np.exp(1j * rod) - 0.4 - 0.2 * np.exp(1j * rocker)
    assert np.abs(loop).max() < 1e-12
    if kind == "bifurcation":
        np.testing.assert_allclose(phi, 0.3 + 3.0 * found.t, rtol=0, atol=1e-9)
        np.testing.assert_allclose([e.t for e in found.happened.events],
                                   (np.pi * np.arange(1, 5) - 0.3) / 3, rtol=0, atol=1e-9)  # fmt: skip
    else:
        assert np.abs(phi).max() == pytest.approx(LOCKS, abs=1e-3)


@pytest.mark.slow
@pytest.mark.heavy
def test_a_robot_of_two_freedoms_goes_on_where_its_closed_form_ends(tmp_path):
    """Its rods come to lie in one line: the masses of the closed form grow beyond all bounds there."""
    page = (Path(__file__).parents[2] / "docs" / "own-mechanism.md").read_text()
    (tmp_path / "robot.py").write_text(re.search(r"```python file=robot\.py\n(.*?)```", page, re.DOTALL)[1])
    (tmp_path / "robot.toml").write_text(
        'mechanism = "./robot.py"\n[start]\nleft = "120 deg"\nright = "60 deg"\n'
        '[drive]\ninput = "M_left"\ntorque = 3\n[simulation]\nt_end = "1.5 s"\n'
    )
    found = run(cases.load(str(tmp_path / "robot.toml"))).result
    assert (found.status, found.end) == ("converged", "t_end") and abs(found.energy.residual) < 1e-8
