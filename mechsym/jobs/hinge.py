"""The whole job: case -> mechanism -> pressure -> hinge -> guide -> verdict -> trials -> retuning and other loads."""

import dataclasses
from collections.abc import Callable, Sequence
from typing import Any

from mechsym import cases
from mechsym.cases import Case
from mechsym.cases.settings import TrialSettings
from mechsym.errors import BadInput
from mechsym.hinge import steady as steadiness
from mechsym.hinge import torque as hinge
from mechsym.hinge import trials
from mechsym.hinge.balance import Balance
from mechsym.hinge.guide import Guide
from mechsym.hinge.limits import Verdict
from mechsym.hinge.steady import Flywheels, Retuned, Sensitivity
from mechsym.hinge.torque import Hinge
from mechsym.hinge.trials import Trial
from mechsym.hinge.ways import Offer, offers
from mechsym.jobs.machine import Assembly, assemble, kept_flywheel, load_of
from mechsym.jobs.other_loads import AtLoad, design_load, guide_at_loads
from mechsym.machine.loads import Load
from mechsym.quantities import record

STEPS = 6  # how often `design` calls `progress`


@record
class Design:
    """A designed hinge and how it runs."""

    assembly: Assembly
    hinge: Hinge  #: Torque that keeps the speed constant
    balance: Balance  #: Part of it that the guide gives
    guide: Guide  #: Guide, or why there is none
    verdict: Verdict
    #: The other way to balance a torque that repeats every two turns; empty for a two-stroke engine
    instead: tuple[Offer, ...]
    trials: tuple[Trial, ...]
    flywheels: Flywheels  #: What the hinge saves, and what a faulty one needs
    sensitivities: tuple[Sensitivity, ...]  #: Ripple for each per cent of error
    retuned: Retuned | None  #: The same guide at the other speed of the case
    flywheel_kept: float  #: Flywheel of the case [kg*m^2]
    loads: tuple[AtLoad, ...] = ()  #: The same guide at other loads, as far as they were asked for


def design(
    case: Case,
    diagram: str | None = None,
    progress: Callable[[], Any] = lambda: None,
    loads: Sequence[float] = (),
) -> Design:
    """Design the elastic hinge of an engine and prove it by simulation.

    Parameters
    ----------
    case : Case
        With sections parameters, operation, cycle, spring, guide, rollers, limits
    diagram : str, optional
        CSV file of a measured diagram in place of the case's cycle
    progress : callable, optional
        Called after each of the six steps
    loads : sequence of float
        Other loads to try the guide at, as shares of the case's mean indicated pressure [-]

    Raises
    ------
    BadInput
        A section is missing, a value is impossible, or the cycle has one load only and others are asked for
    """
    spring, choices = case.need("spring"), case.need("guide")
    rollers, limits, load = case.need("rollers"), case.need("limits"), load_of(case)
    turns = case.sections.get("trials", TrialSettings()).turns
    pressures = _pressures(case, diagram, loads)
    engine, other = assemble(case, diagram), _other(case)
    progress()
    wanted = hinge.build(engine.torques, engine.omega)
    chosen, *instead = offers(wanted, spring, choices, rollers, limits)
    usable = chosen.guide if chosen.guide.rho is not None else None
    progress()
    runs = trials.side_by_side(engine, wanted, usable, load, turns)
    progress()
    wheels = steadiness.flywheels(engine, wanted, usable, load)
    if wheels.steady.inertia:
        runs.append(trials.with_flywheel(engine, wanted, load, wheels.steady.inertia, turns))
    progress()
    errors = steadiness.sensitivities(engine, wanted, usable, load) if usable else []
    progress()
    again = _retuned(other, usable, load, turns) if usable and other else None
    progress()
    return Design(
        assembly=engine,
        hinge=wanted,
        balance=chosen.balance,
        guide=chosen.guide,
        verdict=chosen.verdict,
        instead=tuple(instead),
        trials=tuple(runs),
        flywheels=wheels,
        sensitivities=tuple(errors),
        retuned=again,
        flywheel_kept=kept_flywheel(case),
        loads=tuple(guide_at_loads(case, usable, pressures) if usable else ()),
    )


def _pressures(case: Case, diagram: str | None, loads: Sequence[float]) -> list[float]:
    if loads and diagram is not None:
        raise BadInput(f"{diagram}: a measured diagram has one load; leave the diagram or the other loads out")
    return [share * design_load(case) for share in loads]


def _other(case: Case) -> Assembly | None:
    """The same engine with the speed and the cycle of another case, if the case names one."""
    section = case.sections.get("retune")
    if section is None:
        return None
    other = cases.load(section.case)
    same = {key: record for key, record in case.sections.items() if key in ("parameters", "flywheel")}
    if other.mechanism != case.mechanism:
        raise BadInput(f"[retune] case = {other.name!r} is a case of {other.mechanism}, not of {case.mechanism}")
    return assemble(dataclasses.replace(other, sections={**other.sections, **same}))


def _retuned(other: Assembly, cut: Guide, load: Load, turns: float) -> Retuned:
    return steadiness.retuned(other, hinge.build(other.torques, other.omega), cut, load, turns)
