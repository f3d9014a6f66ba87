"""Case -> run in time: problem -> integration and audit -> speeds, twist of the shaft, start-ups explained."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from mechsym.cases import Case
from mechsym.errors import BadInput
from mechsym.jobs.judged import of_run
from mechsym.jobs.problem import problem_of, settings_of, window_of
from mechsym.jobs.settling import settled
from mechsym.jobs.startup import startup, startup_map
from mechsym.jobs.train import remarks
from mechsym.plausible import Doubt
from mechsym.quantities import record
from mechsym.simulate import Result, simulate
from mechsym.simulate.settings import Settings
from mechsym.simulate.summary import summary
from mechsym.torsion.findings import findings
from mechsym.torsion.settling import Settling, sentences
from mechsym.torsion.startup import AVERAGE, StartUp
from mechsym.torsion.twist import ShaftSection, natural_frequencies, sections


@record
class FinishedRun:
    """A finished run and what is said of it."""

    settings: Settings
    result: Result
    summary: Mapping[str, Any]  #: The numbers that `mechsym simulate` reports
    natural_frequencies: tuple[float, ...]  #: Of an elastic shaft [rad/s]
    twist: tuple[ShaftSection, ...]
    start_ups: tuple[StartUp, ...]  #: That of the run first, then one for each further damper
    settling: Settling | None  #: Where an engine settles after a start against a load
    findings: tuple[str, ...]
    doubts: tuple[Doubt, ...] = ()  #: Of gas and window, that no number of the summary tells


def run(case: Case, dampings: tuple[float, ...] = (), check: str = "tolerance") -> FinishedRun:
    """Simulate a case over time, with an energy audit and a check of the tolerance.

    Parameters
    ----------
    case : Case
        With `[simulation]`, and `[drive]` or `[cycle]`
    dampings : tuple of float
        Further values of c1 for a start-up [N*m*s/rad]
    check : str
        `tolerance` runs again at a hundredth of the tolerance; `none` leaves that out

    Returns
    -------
    run : FinishedRun
        Columns, audit, speeds, twist and findings
    """
    settings, problem = settings_of(case), problem_of(case)
    result = simulate(problem, replace(settings, check=check))
    told = summary(result, problem.mechanism.coordinates, window_of(case, problem))
    starts, settles = _start_ups(case, result, dampings), settled(case, result)
    return FinishedRun(
        settings=settings,
        result=result,
        summary=told,
        natural_frequencies=natural_frequencies(case.need("parameters")),
        twist=sections(case.need("parameters"), result, result.t[-1] - told["window"]),
        start_ups=starts,
        settling=settles,
        doubts=of_run(case, float(result.t[-1] - result.t[0])),
        findings=(*remarks(case), *(findings(starts[0]) if starts else ()), *(sentences(settles) if settles else ())),
    )


def _start_ups(case: Case, result: Result, dampings: tuple[float, ...]) -> tuple[StartUp, ...]:
    """The start-up of the run, and of further dampers; nothing for other runs."""
    if "startup" not in case.sections:
        if dampings:
            raise BadInput(f"{case.file}: --dampings needs a start-up case, with a section [startup]")
        return ()
    if result.status == "failed" or result.t[-1] - result.t[0] <= AVERAGE:
        return ()
    return (startup(case, result), *startup_map(case, dampings))
