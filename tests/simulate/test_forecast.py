"""How long a run would be is told by its first steps; a run that is merely slow, or stuck, is not refused."""

import numpy as np
import pytest

from mechsym import cases
from mechsym.errors import BadInput
from mechsym.jobs.problem import problem_of
from mechsym.simulate import Settings, simulate
from mechsym.simulate.problem import Problem
from mechsym.simulate.result import Result
from mechsym.simulate.run import TRIAL, _once, refuse_endless

QUICK = Settings(tolerance=1e-3, check="none")


def problem(t_end, **more):
    return problem_of(cases.load("chmielewski", {"simulation.t_end": t_end, "output_step": t_end / 10, **more}))


def reached(share, turned=0.0, t_end=100.0):
    """A run that came so far, made of what the forecast looks at."""
    fields = dict.fromkeys(Result.__dataclass_fields__)
    fields |= {"t": np.array([0.0, share * t_end]), "columns": {"phi0": np.array([0.0, turned])}, "end": "failure"}
    return Result(**fields)


def forecast(half, whole, t_end=100.0, turns=None, turned=(0.0, 0.0), allowed=5_000_000):
    run = problem(t_end)
    run = Problem(**{n: getattr(run, n) for n in Problem.__dataclass_fields__} | {"turns": turns})
    found = [reached(share, angle, t_end) for share, angle in zip((half, whole), turned, strict=True)]
    refuse_endless(run, *found, Settings(max_steps=allowed))


def test_even_steps_are_counted_on():
    forecast(1e-3, 2e-3)  # 10 million: twice what is allowed is not refused
    with pytest.raises(
        BadInput, match=r"t_end = 100 s asks for about 1e\+07 steps .* allowed are 4900000; .* about 49 s"
    ):
        forecast(1e-3, 2e-3, allowed=4_900_000)


def test_a_shaft_that_goes_ever_faster_takes_more_than_even_steps():
    half = 1e-2
    whole = half * 2**0.5  # angle by the square of time
    with pytest.raises(BadInput, match=r"about 1e\+08 steps .* about 22 s"):
        forecast(half, whole)
    forecast(half, 2 * half)  # evenly it would be 1 million


def test_turns_end_a_run_that_time_does_not():
    angle = 2 * np.pi * 1e4
    with pytest.raises(BadInput, match=r"turns = 10000 asks for about 2e\+07 steps .* about 2\.5e\+03 turns"):
        forecast(1e-9, 2e-9, turns=1e4, turned=(angle * 5e-4, angle * 1e-3))
    forecast(1e-9, 2e-9, turns=1e4, turned=(angle * 5e-2, angle * 1e-1))


@pytest.mark.parametrize(("half", "whole"), [(0.0, 0.0), (1e-9, 1e-9), (1e-9, 1.1e-9), (0.0, 1e-9)])
def test_a_run_that_is_stuck_is_run_to_where_it_ends(half, whole):
    forecast(half, whole)


def test_the_forecast_of_a_start_holds():
    run = problem(1000.0)
    whole = _once(run, QUICK)
    assert whole.end == "t_end" and whole.steps > 5 * TRIAL
    with pytest.raises(BadInput) as told:
        simulate(run, Settings(tolerance=1e-3, check="none", max_steps=TRIAL + 1))
    forecast_steps = float(str(told.value).split("about ")[1].split()[0])
    assert whole.steps / 2 < forecast_steps < 2 * whole.steps


def test_a_run_beyond_the_trial_is_the_same_as_without():
    run = problem(400.0)
    tried, at_once = simulate(run, QUICK), _once(run, QUICK)
    assert tried.end == "t_end" and tried.steps == at_once.steps > TRIAL
    assert all(np.array_equal(tried.columns[name], column) for name, column in at_once.columns.items())
