r"""How many steps a run would take, from its first ones: what could not end is refused before it is begun.

.. math:: N(s) = N_1 (s/s_1)^p, \qquad p = \ln 2/\ln(s_1/s_{1/2})

s is the share of the run, by time or by turns, that N steps come to: s_1 those of the trial, s_1/2 half of them. A
shaft that a torque speeds up for ever has p = 2. Where the second half hardly comes on (p above 5) the run is stiff or
singular, which no forecast tells, and it is run to the end that it meets.
"""

import math
from dataclasses import replace

from mechsym.errors import BadInput
from mechsym.simulate.problem import Problem
from mechsym.simulate.result import Result
from mechsym.simulate.settings import Settings

TRIAL = 20_000  # steps that a run is tried with
_OFF = 2.0  # a forecast may be off by so much; within it the run has its chance
_STUCK = 5.0  # exponent of a run that hardly comes on any more


def shorter(settings: Settings, steps: int = TRIAL) -> Settings:
    """The same settings with few steps allowed."""
    return replace(settings, max_steps=min(steps, settings.max_steps))


def refuse_endless(problem: Problem, first: Result, tried: Result, settings: Settings) -> None:
    """Refuse a run whose first steps show that it would not end within those allowed.

    Parameters
    ----------
    first, tried : Result
        The run with half of `TRIAL` steps, and with all of them

    Raises
    ------
    BadInput
        The forecast is more than twice what is allowed, with how far the run may go
    """
    half, whole = _share(problem, first), _share(problem, tried)
    if not 0 < half < whole or math.log(2) > _STUCK * math.log(whole / half):
        return
    exponent = math.log(2) / math.log(whole / half)
    steps = TRIAL / whole**exponent
    if steps > _OFF * settings.max_steps:
        reach = whole * (settings.max_steps / TRIAL) ** (1 / exponent)
        by_turns = problem.turns is not None and _by_turns(problem, tried) >= _by_time(problem, tried)
        asked = f"turns = {problem.turns:g}" if by_turns else f"t_end = {problem.t_end:g} s"
        most = f"{reach * (problem.turns or 0):.2g} turns" if by_turns else f"{reach * problem.t_end:.2g} s"
        raise BadInput(
            f"{asked} asks for about {steps:.2g} steps of the integrator; allowed are {settings.max_steps}; give at "
            f"most about {most}, or a larger tolerance"
        )


def _share(problem: Problem, found: Result) -> float:
    return max(_by_time(problem, found), _by_turns(problem, found))


def _by_time(problem: Problem, found: Result) -> float:
    return float((found.t[-1] - problem.t_start) / (problem.t_end - problem.t_start))


def _by_turns(problem: Problem, found: Result) -> float:
    if problem.turns is None:
        return 0.0
    angle = found.columns[problem.mechanism.coordinates[0]]
    return float((angle[-1] - problem.q0[0]) / (2 * math.pi * problem.turns))
