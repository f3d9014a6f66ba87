"""Case -> run in time: problem -> integration and audit -> speeds, twist of the shaft, start-ups explained."""

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from mechsym.cases import Case
from mechsym.errors import BadInput
from mechsym.jobs.judged import of_run
from mechsym.jobs.loop import in_loop, run_in_loop
from mechsym.jobs.problem import problem_of, settings_of, window_of
from mechsym.jobs.settling import settled
from mechsym.jobs.span import simulation_of
from mechsym.jobs.startup import startup, startup_map
from mechsym.jobs.train import remarks
from mechsym.jobs.vibration import vibration
from mechsym.mechanisms.traits import is_train
from mechsym.page import Shown
from mechsym.plausible import Doubt
from mechsym.quantities import record
from mechsym.simulate import Result, simulate
from mechsym.simulate.loop.events import CYCLE
from mechsym.simulate.problem import period_of
from mechsym.simulate.settings import Settings
from mechsym.simulate.summary import summary
from mechsym.torsion.findings import findings
from mechsym.torsion.settling import Settling, sentences
from mechsym.torsion.startup import AVERAGE, StartUp
from mechsym.torsion.train import TrainVibration, doubts, twist_words, words
from mechsym.torsion.twist import ShaftSection, natural_frequencies, sections


@record
class EngineSpeed:
    """What an engine's speed is looked at by."""

    coordinate: str  #: Its shaft
    words: str  #: Its name for people, empty where there is one shaft only
    period: float  #: A turn, or two of a four-stroke engine [rad]
    wanted: float  #: Speed of operation [rad/s]


@record
class FinishedRun(Shown):
    """A finished run and what is said of it."""

    settings: Settings
    result: Result
    summary: Mapping[str, Any]  #: The numbers that `mechsym simulate` reports
    natural_frequencies: tuple[float, ...]  #: Of an elastic shaft [rad/s]
    twist: tuple[ShaftSection, ...]
    start_ups: tuple[StartUp, ...]  #: That of the run first, then one for each further damper
    vibration: TrainVibration | None  #: Criticals of a crank train
    settling: Settling | None  #: Where an engine settles after a start against a load
    engine: EngineSpeed | None  #: Of an engine
    findings: tuple[str, ...]
    doubts: tuple[Doubt, ...] = ()  #: Of gas and window, that no number of the summary tells

    @property
    def speed(self) -> Mapping[str, float]:
        """Mean, least and greatest speed at the end, of the engine's shaft or of the first coordinate [rad/s]."""
        speeds = self.summary["speeds"]
        return speeds[self.engine.coordinate if self.engine else next(iter(speeds))]


def run(case: Case, dampings: tuple[float, ...] = (), check: str = "tolerance") -> FinishedRun:
    """Simulate a case over time, with an energy audit and a check of the tolerance.

    Parameters
    ----------
    case : Case
        With `[simulation]` and `[drive]`, or `[cycle]`
    dampings : tuple of float
        Further values of c1 for a start-up [N*m*s/rad]
    check : str
        `tolerance` runs again at a hundredth of the tolerance; `none` leaves that out

    Returns
    -------
    run : FinishedRun
        Columns, audit, speeds, twist and findings
    """
    settings = replace(settings_of(case), check=check)
    result, told, period = run_of(case, settings)
    engine = _engine(case, told, period)
    starts, settles = _start_ups(case, result, dampings), settled(case, result)
    twist = sections(case.need("parameters"), result, result.t[-1] - told["window"])
    train = vibration(case)
    return FinishedRun(
        settings=settings,
        result=result,
        summary=told,
        natural_frequencies=natural_frequencies(case.need("parameters")),
        twist=twist,
        start_ups=starts,
        vibration=train,
        settling=settles,
        engine=engine,
        doubts=of_run(case, float(result.t[-1] - result.t[0]), told.get("speed_max", 0.0))
        + (doubts(train, twist) if train else ()),
        findings=(
            *remarks(case), *((*words(train), *twist_words(train, twist)) if train else ()),
            *(findings(starts[0]) if starts else ()), *(sentences(settles) if settles else ()),
            *(_stopped(result, engine) if engine else ()),
        ),
    )  # fmt: skip


def _engine(case: Case, told: dict[str, Any], period: float) -> EngineSpeed | None:
    if "cycle" not in case.sections or "operation" not in case.sections:
        return None
    train = is_train(case.mechanism)
    shaft = list(told["speeds"])[-1 if train else 0]
    wanted = case.need("operation").speed
    return EngineSpeed(coordinate=shaft, words="flywheel" if train else "", period=period, wanted=wanted)


def _stopped(result: Result, engine: EngineSpeed) -> tuple[str, ...]:
    """What to do about an engine that stops."""
    if result.end != "stall":
        return ()
    where = math.degrees(result.columns[engine.coordinate][-1])
    return (
        f"the shaft stops at t = {result.t[-1]:.4g} s, {engine.coordinate} = {where:.1f} deg: what it stores does not "
        "carry it over compression and load; raise flywheel.inertia or simulation.speed_start, or lower [load]",
    )


def run_of(case: Case, settings: Settings) -> tuple[Result, dict[str, Any], float]:
    """The run of a case, its numbers, and its period [rad]; gas that follows the motion is integrated with it."""
    if in_loop(case):
        result = run_in_loop(case, settings)
        coordinates = tuple(name for name, unit in result.units.items() if unit == "rad")
        return result, summary(result, coordinates, simulation_of(case).window, CYCLE), CYCLE
    problem = problem_of(case)
    result, period = simulate(problem, settings), period_of(problem)
    return result, summary(result, problem.mechanism.coordinates, window_of(case, problem), period), period


def _start_ups(case: Case, result: Result, dampings: tuple[float, ...]) -> tuple[StartUp, ...]:
    """The start-up of the run, and of further dampers; nothing for other runs."""
    if "startup" not in case.sections:
        if dampings:
            raise BadInput(f"{case.file}: --dampings needs a start-up case, with a section [startup]")
        return ()
    if result.status == "failed" or result.t[-1] - result.t[0] <= AVERAGE:
        return ()
    return (startup(case, result), *startup_map(case, dampings))
