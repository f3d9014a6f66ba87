"""Case -> hinge: machine -> torque wanted -> guide -> verdict; how it runs on first use."""

import functools
from collections.abc import Sequence
from dataclasses import replace

from mechsym import cases
from mechsym.cases import Case
from mechsym.cases.settings import TrialSettings
from mechsym.cycle.kinds import kind_of
from mechsym.errors import BadInput
from mechsym.hinge import steady
from mechsym.hinge.guide import Guide, refit
from mechsym.hinge.losses import HingeLosses
from mechsym.hinge.result import AtLoad, Design, Origin
from mechsym.hinge.retune import retune
from mechsym.hinge.setting import setting_of, with_setting
from mechsym.hinge.torque import torque
from mechsym.hinge.ways import offers
from mechsym.jobs.machine import kept_flywheel, machine
from mechsym.machine.record import Machine


def hinge(case: Case, diagram: str | None = None, loads: Sequence[float] = ()) -> Design:
    """Design the elastic hinge of an engine; how it runs is computed on first use, see `Design`.

    Parameters
    ----------
    case : Case
        With sections parameters, operation, cycle, spring, guide, rollers, limits
    diagram : str, optional
        CSV file of a measured diagram in place of the case's cycle
    loads : sequence of float
        Other loads to try the guide at, as shares of the case's mean indicated pressure [-]

    Returns
    -------
    design : Design
        Guide and verdict, also when it cannot be built; runs, flywheels and sensitivities of what could be cut

    Raises
    ------
    BadInput
        A section is missing, a value is impossible, or the cycle has one load only and others are asked for
    """
    spring, choices, rollers, limits = (case.need(name) for name in ("spring", "guide", "rollers", "limits"))
    pressures, engine = _pressures(case, diagram, loads), machine(case, diagram)
    wanted = torque(engine)
    chosen, *instead = offers(wanted, spring, choices, rollers, limits)
    return Design(
        origin=Origin(name=case.name, about=case.about, source=case.source, sections=case.sections),
        machine=engine, rollers=rollers, hinge=wanted, balance=chosen.balance, guide=chosen.guide,
        verdict=chosen.verdict, instead=tuple(instead), flywheel_kept=kept_flywheel(case),
        turns=case.sections.get("trials", TrialSettings()).turns, assumed=case.sections.get("losses", HingeLosses()),
        in_time=case.sections.get("losses"),
        other=functools.partial(_other, case), at_loads=lambda guide: tuple(at_loads(case, guide, pressures)),
    )  # fmt: skip


def design_load(case: Case) -> float:
    """The load that a case is designed for.

    Returns
    -------
    mean_indicated_pressure : float
        Of its cycle [Pa]

    Raises
    ------
    BadInput
        The cycle has no mean indicated pressure to change
    """
    cycle = case.need("cycle")
    if not kind_of(cycle).load:
        raise BadInput(f"{case.file}: [cycle] has no mean_indicated_pressure that could be changed; it has one load")
    return float(getattr(cycle, kind_of(cycle).load))


def at_loads(case: Case, guide: Guide, loads: Sequence[float]) -> list[AtLoad]:
    """Steady running of a guide at other loads, at the speed of operation.

    The guide stays as it was cut. At another load the gas torque has another shape, so the hinge misses it; a spring
    set anew for that load takes part of the rest away.

    Parameters
    ----------
    guide : Guide
        Guide of the case's hinge, status `cut`
    loads : sequence of float
        Mean indicated pressures to try [Pa]

    Returns
    -------
    rows : list of AtLoad
        As cut and set anew, one for each load
    """
    return [_at_load(case, guide, load) for load in loads]


def _at_load(case: Case, guide: Guide, load: float) -> AtLoad:
    cycle = replace(case.need("cycle"), mean_indicated_pressure=load)
    engine = machine(replace(case, sections={**case.sections, "cycle": cycle}))
    wanted = torque(engine)
    setting = retune(guide, wanted, "least_squares_work").setting
    anew = refit(guide, with_setting(guide.spring, setting))
    return AtLoad(
        share=load / design_load(case),
        mean_indicated_pressure=load,
        as_cut=steady.with_guide(engine, wanted, guide),
        reset=steady.with_guide(engine, wanted, anew),
        setting=setting,
        ratio=setting / setting_of(guide.spring),
    )


def _pressures(case: Case, diagram: str | None, loads: Sequence[float]) -> list[float]:
    if loads and diagram is not None:
        raise BadInput(f"{diagram}: a measured diagram has one load; leave the diagram or the other loads out")
    return [share * design_load(case) for share in loads]


def _other(case: Case) -> Machine | None:
    """The same engine and load with the speed and the cycle of another case, if the case names one."""
    section = case.sections.get("retune")
    if section is None:
        return None
    other = cases.load(section.case)
    same = {
        key: record for key, record in case.sections.items() if key in ("parameters", "flywheel", "load", "scavenging")
    }
    if other.mechanism != case.mechanism:
        raise BadInput(f"[retune] case = {other.name!r} is a case of {other.mechanism}, not of {case.mechanism}")
    sections = {key: record for key, record in other.sections.items() if key != "load"}
    return machine(replace(other, sections={**sections, **same}))
