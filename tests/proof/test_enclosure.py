"""The start-up enclosed: a second checker, runs in doubles, planted faults; what cannot be enclosed is refused."""

import dataclasses
import itertools
import json
import math
import re
import sys
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
import simulated

from mechsym import cases
from mechsym.cli import main
from mechsym.errors import BadInput

flint = pytest.importorskip("flint")

import enclosed_by_picard  # noqa: E402

from mechsym.jobs.problem import problem_of  # noqa: E402
from mechsym.jobs.prove import motion_of  # noqa: E402
from mechsym.mechanisms.record import bind  # noqa: E402
from mechsym.native.tape import read  # noqa: E402
from mechsym.proof import balls  # noqa: E402
from mechsym.proof.balls import arb, ctx, decimal, ratio, upper  # noqa: E402
from mechsym.proof.enclosure import Enclosure, EnclosureMethod, TaylorMotion, point, restored, weights  # noqa: E402
from mechsym.proof.motion import MOST, digits, enclose, method_for, task_of  # noqa: E402
from mechsym.simulate import Settings, simulate  # noqa: E402
from mechsym.simulate.problem import FormulaForce, Part, Problem  # noqa: E402

TORQUE = arb(3) / 2


@pytest.fixture(scope="module")
def task():
    import casadi as ca

    problem = problem_of(cases.load("chmielewski"))
    parameters = problem.mechanism.parameters
    return task_of(problem, bind("crankshaft_flywheel", {name: ca.SX.sym(name) for name in parameters}), parameters)


def motion(task):
    with ctx.workprec(110):
        held = [decimal(1.5), *(decimal(v) for v in task.letters)]
        return TaylorMotion(read(task.function), 4, held)


def wide(state, half_width):
    """A set around a state in the midst of the run."""
    with ctx.workprec(110):
        return dataclasses.replace(point(Fraction(60), [decimal(v) for v in state]), c=np.full(4, half_width))


STATES = ((0.3, 0.1, 90.0, 100.0), (4.0, 4.9, 150.0, 60.0), (8.9, 8.1, 20.0, 120.0), (2.0, 1.0, 230.0, 40.0))


def stepped(task, start, method=None):
    with ctx.workprec(110):
        moving = motion(task)
        return Enclosure(
            moving, method or EnclosureMethod(), weights(moving, point(Fraction(0), [arb(0)] * 4), 2)
        ).step(start, Fraction(1))


def holds(step, corners=2):
    """Whether corners of a step's start end, by the second checker, inside the set that the step claims."""
    signs = list(itertools.product((-1, 1), repeat=4))[:: 16 // corners][:corners]
    with ctx.workprec(enclosed_by_picard.BITS):
        back, h = step.end.B.inv(), ratio(step.length)
        for sign in signs:
            shift = step.start.B * flint.arb_mat(4, 1, [arb(s * c) for s, c in zip(sign, step.start.c, strict=True)])
            begun = [x + shift[i, 0] for i, x in enumerate(step.start.x)]
            there = enclosed_by_picard.after(begun, TORQUE, h)
            off = back * flint.arb_mat(4, 1, [a - b for a, b in zip(there, step.end.x, strict=True)])
            if any(upper(off[i, 0]) > step.end.c[i] for i in range(4)):
                return False
    return True


@pytest.mark.parametrize("state", STATES)
def test_a_step_holds_by_the_second_checker(task, state):
    step = stepped(task, wide(state, 1e-20), EnclosureMethod())
    assert holds(step) and step.end.c.max() < 2e-20


@pytest.mark.parametrize("state", STATES[:2])
def test_a_wide_set_is_refused_or_holds(task, state):
    for half_width in (1e-9, 1e-4, 1e-2):
        try:
            assert holds(stepped(task, wide(state, half_width)))
        except BadInput as error:
            assert "give more digits" in str(error)


def test_a_product_of_series_that_is_1e9_off_is_found(task, monkeypatch):
    monkeypatch.setitem(balls.SERIES, "mul", lambda a, b: a * b * (1 + arb(1e-9)))
    assert not holds(stepped(task, wide(STATES[0], 1e-20)))


def test_a_coefficient_that_is_1e9_off_makes_the_set_wide_and_no_lie(task, monkeypatch):
    expand = TaylorMotion.expand

    def off(self, *arguments):
        expand(self, *arguments)
        if len(self.x[2]) > 3:
            self.x[2][3] = (self.x[2][3] * (1 + arb(1e-9))).mid()

    monkeypatch.setattr(TaylorMotion, "expand", off)
    step = stepped(task, wide(STATES[0], 1e-20))
    assert holds(step) and step.end.half_widths.max() > 1e-14


def without(monkeypatch, change):
    noise = Enclosure._noise

    def changed(self, length, bounds, size, W, A_W):
        return change(noise(self, length, bounds, size, W, A_W), self, length, bounds, size)

    monkeypatch.setattr(Enclosure, "_noise", changed)


def test_a_remainder_left_out_is_found(task, monkeypatch):
    without(monkeypatch, lambda found, *_: (0.0, found[1]))
    coarse = dataclasses.replace(EnclosureMethod(), noise=1e-15, skew=1e-3)
    assert not holds(stepped(task, wide(STATES[0], 0.0), coarse))


def test_a_variational_remainder_left_out_is_found(task, monkeypatch):
    def change(found, self, length, bounds, size):
        return found[0] if size == 0 else 1e-25, found[1]

    without(monkeypatch, change)
    coarse = dataclasses.replace(EnclosureMethod(), order_of_W=4, skew=1e-3)
    assert not holds(stepped(task, wide(STATES[0], 1e-8), coarse))


def test_an_inclusion_test_skipped_is_found(task, monkeypatch):
    with pytest.raises(BadInput, match="give more digits"):
        stepped(task, wide(STATES[0], 0.5))
    without(monkeypatch, lambda found, *_: (1e-25, 0.0))
    assert not holds(stepped(task, wide(STATES[0], 0.5)))


@pytest.mark.slow
def test_runs_in_doubles_lie_within_their_stated_error_of_it(task):
    (*_, last) = enclose(task, EnclosureMethod(), Fraction(2))
    problem = dataclasses.replace(problem_of(cases.load("chmielewski")), t_end=2.0, output=0.5)
    for backend in ("native", "scipy-dop853", "scipy-rk45", "scipy-lsoda"):
        run = simulate(problem, Settings(backend=backend, tolerance=1e-9))
        for name, x in zip(("phi0d", "phi2d"), last.at.x[2:], strict=True):
            # errors grow as the tolerance to the power p/(p+1) or more: the finer run is off by a tenth at most
            stated = 10 / 9 * max(run.tolerance_difference, 1e-12) * np.abs(run.columns[name]).max()
            assert abs(float(x) - run.columns[name][-1]) <= stated, (backend, name)
    # torque and inertia alone would give M / (I0 + I2) in a second
    assert float(last.at.x[2]) == pytest.approx(1.5 / 0.84, rel=0.05)
    assert last.at.half_widths.max() < 1e-22


@pytest.mark.slow
def test_a_proof_goes_on_from_what_is_kept(task, tmp_path):
    whole = enclose(task, EnclosureMethod(), Fraction(3, 2))
    made = []
    enclose(task, EnclosureMethod(), Fraction(1), tmp_path)
    again = enclose(task, EnclosureMethod(), Fraction(3, 2), tmp_path, made.append)
    assert made[0] == 1 and again[-1].steps == whole[-1].steps
    assert [str(x) for x in again[-1].at.x] == [str(x) for x in whole[-1].at.x]
    other = dataclasses.replace(EnclosureMethod(), noise=1e-24)  # another proof: nothing kept of it
    enclose(task, other, Fraction(1), tmp_path, made.append)
    assert made[-2] == 0


def pendulum(angle, t_end):
    return Problem(mechanism=simulated.double_pendulum(), parts=(), q0=(angle, angle), u0=(0.0, 0.0), t_end=t_end)


def test_chaos_is_refused_by_the_digits_that_it_needs():
    wild = pendulum(2.5, 100.0)
    assert digits(task_of(wild, wild.mechanism, {}), 100.0, 1e-9) > MOST
    calm = pendulum(0.1, 2.0)
    task = task_of(calm, calm.mechanism, {})
    needed = digits(task, 2.0, 1e-9)
    assert needed < 30
    (*_, last) = enclose(task, method_for(needed), Fraction(2))
    run = simulate(dataclasses.replace(calm, output=0.5), Settings(tolerance=1e-12))
    assert [float(x) for x in last.at.x[:2]] == pytest.approx([run.columns[q][-1] for q in ("a", "b")], abs=1e-9)


def test_what_is_no_smooth_closed_form_is_refused():
    calm = pendulum(0.1, 1.0)
    pushed = Part(name="push", input="M", value=lambda t, q, u: 1.0)
    with pytest.raises(BadInput, match="push: no smooth closed form"):
        task_of(dataclasses.replace(calm, parts=(pushed,)), calm.mechanism, {})
    timed = Part(name="push", input="M", value=FormulaForce(function=lambda t, q, u: t))
    with pytest.raises(BadInput, match="follows the time"):
        task_of(dataclasses.replace(calm, parts=(timed,)), calm.mechanism, {})


@pytest.mark.parametrize("words", [["zotov-89"], ["chmielewski", "--t-end", "0"], ["chmielewski", "--window", "5"]])
def test_bad_input_is_one_line(words, capsys, monkeypatch):
    monkeypatch.setattr(sys, "argv", ["mechsym", "prove", *words])
    with pytest.raises(SystemExit) as ended:
        main()
    assert ended.value.code == 2 and len(capsys.readouterr().err.strip().splitlines()) == 1


@pytest.mark.slow
def test_the_statement_is_about_the_window():
    found = motion_of(cases.load("chmielewski"), 2.0, None, (1.0, 2.0))
    assert "from 1 to 2 s" in found.statement and "never in steady" not in found.statement  # the claim is of 90 s
    assert found.mean_least["phi0d"][1] <= 0.8921567534505 <= found.mean_largest["phi0d"][1]
    assert json.dumps(found.lower["phi0"]) and math.isfinite(found.digits)


@pytest.mark.slow
@pytest.mark.heavy
def test_the_page_says_what_the_whole_proof_says():
    root = Path(__file__).parents[2]
    if not (root / "build/proof/proof.json").is_file():
        pytest.skip("make proof writes build/proof/proof.json")
    page, case = (root / "docs/proof.md").read_text(encoding="utf-8"), cases.load("chmielewski")
    proven = motion_of(case, out=root / "build/proof", window=(55.0, 93.0))
    bounds = [n for interval in re.findall(r"\[(.*?)\]", proven.statement) for n in interval.split(", ")]
    assert len(bounds) == 4 and [n for n in bounds if n not in page] == []
    assert f"{proven.steps:,} steps" in page and f"near {proven.upper['phi0'][-1]:.0f} rad" in page


@pytest.mark.slow
@pytest.mark.heavy
def test_random_steps_of_the_whole_start_up_hold(task):
    file = Path(__file__).parents[2] / "build/proof/proof.json"
    if not file.is_file():
        pytest.skip("make proof writes build/proof/proof.json")
    seconds, random = json.loads(file.read_text())["seconds"], np.random.default_rng(99)
    with ctx.workprec(110):
        moving = motion(task)
        enclosing = Enclosure(moving, EnclosureMethod(), weights(moving, point(Fraction(0), [arb(0)] * 4), 2))
    checked = 0
    while checked < 200:
        start = restored(seconds[random.integers(1, len(seconds) - 1)])
        for number, step in enumerate(enclosing.steps(start, start.t + 1), 1):
            if random.random() < 0.1:
                assert holds(step, 1), float(step.start.t)
                checked += 1
            if number == 20:
                break
