"""Case -> start-ups explained: the run of the case, and the same with other dampers."""

from dataclasses import replace

from mechsym.cases import Case
from mechsym.errors import BadInput
from mechsym.jobs.problem import problem_of, settings_of
from mechsym.mechanisms.traits import with_trait
from mechsym.simulate import Result, simulate, simulate_many
from mechsym.torsion.startup import StartUp, StartUpClaim, start_up


def startup(case: Case, result: Result | None = None) -> StartUp:
    """Run a start-up case, or take its finished run, and explain it.

    Parameters
    ----------
    case : Case
        Mechanism `crankshaft_flywheel` with `[drive]` and `[simulation]`
    result : Result, optional
        Its run, when there is one already

    Returns
    -------
    found : StartUp
        Critical speeds, which of them held the shaft, twist and torque
    """
    parameters = case.need("parameters")
    known = with_trait(lambda one: one.shaft and one.shaft.start_up)
    if case.mechanism not in known:
        raise BadInput(
            f"{case.file}: [startup] explains a {' or '.join(known)}, not a {case.mechanism}; leave the section out"
        )
    if result is None:
        result = simulate(problem_of(case), settings_of(case))
    return start_up(parameters, case.need("drive"), case.sections.get("startup", StartUpClaim()), result)


def startup_map(case: Case, dampings: tuple[float, ...]) -> tuple[StartUp, ...]:
    """The same start-up with several dampers, run side by side.

    Parameters
    ----------
    dampings : tuple of float
        Values of c1 [N*m*s/rad]

    Returns
    -------
    found : tuple of StartUp
        One for each damper, in their order
    """
    damped = [replace(case.need("parameters"), c1=c1) for c1 in dampings]
    cases = [replace(case, sections={**case.sections, "parameters": p}) for p in damped]
    results = simulate_many([problem_of(c) for c in cases], settings_of(case))
    return tuple(startup(c, r) for c, r in zip(cases, results, strict=True))
