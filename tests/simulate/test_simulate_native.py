"""The compiled backend against scipy's: real cases, events at kinks, groups of runs, and what it leaves to scipy."""

import dataclasses
import shutil

import numpy as np
import pytest
from simulated import oscillator, shaft

from mechsym import cases
from mechsym.errors import BadInput
from mechsym.jobs.problem import problem_of
from mechsym.simulate import Part, Periodic, Problem, Settings, Steps, simulate, simulate_many
from mechsym.simulate.problem import Kinks, Stop

pytestmark = pytest.mark.skipif(not any(map(shutil.which, ("gcc", "clang", "cc"))), reason="no C compiler")
NATIVE, SCIPY = (Settings(backend=name, tolerance=1e-10, check="none") for name in ("native", "scipy-dop853"))


def square(phi):
    """A torque that jumps at 0 and 2 rad."""
    return np.where(phi % (2 * np.pi) < 2.0, 3.0, -0.5)


SQUARE = Periodic(coordinate="phi", value=square, period=2 * np.pi, kinks=(0.0, 2.0))


def pushed(**changes):
    values = {
        "mechanism": shaft(3.0, unbalance=2.0),
        "parts": (
            Part(name="push", input="M", value=SQUARE),
            Part(name="brake", input="M_r", role="load", value=Steps(times=(1.1, 2.3), values=(0.0, 4.0, 0.2))),
        ),
        "q0": (0.3,),
        "u0": (5.0,),
        "t_end": 9.0,
        "kinks": (Kinks(coordinate="phi", angles=(0.0, 2.0), period=2 * np.pi),),
        "output": 0.02,
    }  # fmt: skip
    return Problem(**(values | changes))


def same(a, b, rtol=1e-8):
    assert a.end == b.end
    assert a.t[-1] == pytest.approx(b.t[-1], rel=1e-9)
    # the end may fall on a wanted time but for the last digit
    count = min(len(a.t), len(b.t)) - 1
    rows = [*range(count), -1]
    assert abs(len(a.t) - len(b.t)) <= 1
    for name in b.columns:
        # a dissipation that is nothing but rounding has no relative error
        scale = max(np.max(np.abs(b.columns[name])), 1e-3)
        np.testing.assert_allclose(a.columns[name][rows] / scale, b.columns[name][rows] / scale, atol=rtol)


def test_jumps_in_time_and_angle():
    same(simulate(pushed(), NATIVE), simulate(pushed(), SCIPY))


@pytest.mark.parametrize("turns", [1.0, 2.0, 2 / (2 * np.pi) - 0.3 / (2 * np.pi) + 3])
def test_turns_that_end_on_a_kink(turns):
    found = simulate(pushed(turns=turns, q0=(0.0,)), NATIVE)
    assert found.end == "turns"
    same(found, simulate(pushed(turns=turns, q0=(0.0,)), SCIPY))


def test_stall_inside_a_run():
    braked = pushed(stops=(Stop(name="stall", of="phid", direction="falling"),), u0=(1.0,), parts=pushed().parts[1:])
    found = simulate(braked, NATIVE)
    assert found.event is not None
    assert abs(found.event.state["phid"]) < 1e-13
    same(found, simulate(braked, SCIPY))


def test_backward_motion_over_kinks():
    back = pushed(u0=(-6.0,))
    same(simulate(back, NATIVE), simulate(back, SCIPY))


@pytest.mark.parametrize("name", ["zotov-89", "zotov-142"])
def test_engine_with_its_hinge(name):
    problem = problem_of(cases.load(name, {"simulation.turns": "3"}))
    same(simulate(problem, NATIVE), simulate(problem, SCIPY), rtol=1e-7)


def test_many_runs_are_the_single_runs():
    problems = [
        pushed(u0=(u,), mechanism=shaft(i), output=o) for u, i, o in [(5, 3, 0.02), (4, 2.5, 0.03), (6, 3, 0.5)]
    ]
    problems += [pushed(parts=(), mechanism=oscillator(), kinks=()), pushed(u0=(3,), turns=1.0)]
    settings = Settings(tolerance=1e-10)
    for found, problem in zip(simulate_many(problems, settings), problems, strict=True):
        alone = simulate(problem, settings)
        assert found.status == alone.status == "converged"
        same(found, alone)


def test_plain_callables_are_left_to_scipy():
    plain = pushed(parts=(Part(name="push", input="M", value=lambda t, q, u: float(square(q[0]))),))
    with pytest.raises(BadInput, match="'push' is a plain Python callable"):
        simulate(plain, NATIVE)
    same(simulate(plain, Settings(check="none")), simulate(plain, SCIPY))
    many = simulate_many([plain, plain], Settings(check="none"))
    same(many[1], simulate(plain, SCIPY))


@pytest.mark.parametrize("hidden", ["no compiler", "a compiler that fails"])
def test_without_a_compiler_scipy_takes_over(hidden, monkeypatch, tmp_path):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.setenv("CC", "no-such-compiler" if hidden == "no compiler" else "false")
    reason = "no C compiler found" if hidden == "no compiler" else "false failed"
    with pytest.raises(BadInput, match=reason):
        simulate(pushed(), NATIVE)
    same(simulate(pushed(), Settings(check="none")), simulate(pushed(), SCIPY))
    for found in simulate_many([pushed(), pushed(u0=(4.0,))], Settings(check="none")):
        assert found.status == "unchecked"


def test_step_limit_is_a_failure():
    found = simulate(pushed(), dataclasses.replace(NATIVE, max_steps=10))
    assert found.status == "failed"
    assert "were not enough" in found.reason
