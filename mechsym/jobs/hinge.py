"""Case -> hinge: machine -> torque wanted -> guide -> verdict and its track; each runs on first use."""

import functools
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from mechsym import cases
from mechsym.cases import Case
from mechsym.cases.laws import bore
from mechsym.cases.needs import NO_FILE, require
from mechsym.cases.settings import TrialSettings
from mechsym.cycle.kinds import kind_of
from mechsym.errors import BadInput
from mechsym.hinge.guide import Guide, path, refit, setting_of, with_setting
from mechsym.hinge.limits import Contact, Verdict, at_pieces, judge
from mechsym.hinge.result import AtLoad, Design, Origin, offers
from mechsym.hinge.rollers import HingeLosses, RollerParameters
from mechsym.hinge.steady import retune, sensitivities, with_guide
from mechsym.hinge.torque import torque
from mechsym.jobs.machine import kept_flywheel, machine
from mechsym.jobs.problem import guide_of
from mechsym.machine.record import Machine, kinks_of
from mechsym.mechanisms import listing
from mechsym.periodic.pieces import PPoly
from mechsym.quantities import record
from mechsym.quantities.units import Pascal, Pure

ERROR = 1e-4  # of the track, that is tried [m]


@record
class TriedError:
    """What may be off by some size, and the speed ripple of the steady motion then."""

    name: str
    words: str  #: How far off, low and high
    size: float  #: [unit]
    unit: str
    low: float | None  #: Ripple with less; None where there is no steady motion [-]
    high: float | None  #: Ripple with more [-]


@record
class Workshop:
    """A guide with what a workshop has to know of it."""

    name: str
    about: str
    machine: Machine
    guide: Guide
    rollers: RollerParameters
    verdict: Verdict
    contact: Contact
    kinks: tuple[float, ...]  #: angles of the guide's shaft where the curvature jumps [rad]
    tolerances: tuple[TriedError, ...]


def workshop(case: Case, diagram: str | None = None) -> Workshop:
    """The guide of a case for the workshop. Raises BadInput: no guide can be cut, or a section is missing."""
    require(case, "guide", NO_FILE if diagram else "")
    rollers, limits = case.need("rollers"), case.need("limits")
    engine, wanted, guide = guide_of(case, diagram)
    rows = [
        TriedError(name=s.name, words="1 % low, high", size=0.01 * abs(s.value), unit=s.unit,
                   low=s.low.speed_ripple, high=s.high.speed_ripple)
        for s in sensitivities(engine, wanted, guide)
    ]  # fmt: skip
    rho = path(guide)
    tracks = []
    for distance in (-ERROR, ERROR):  # cut too near to the axis, and too far from it
        rows_of_track = rho.c.copy()
        rows_of_track[-1] += distance
        moved = PPoly(rows_of_track, rho.x, extrapolate="periodic")
        tracks.append(with_guide(engine, wanted, replace(guide, rho=moved)).speed_ripple)
    period = float(rho.x[-1])
    turns = range(round(2 * np.pi / period))
    ratio = guide.parameters.shaft_ratio
    # at the rows of a torque table the third derivative jumps, which the curvature does not show
    bends = () if "torque" in case.sections else kinks_of(engine)
    return Workshop(
        name=case.name, about=case.about, machine=engine, guide=guide, rollers=rollers,
        verdict=judge(guide, rollers, limits), contact=at_pieces(guide, rollers),
        kinks=tuple(sorted({float(k * ratio % period + n * period) for k in bends for n in turns})),
        tolerances=(*rows, TriedError(name="track", words=f"{1e3 * ERROR:g} mm in, out", size=ERROR, unit="m",
                                      low=tracks[0], high=tracks[1])),
    )  # fmt: skip


def hinge(case: Case, diagram: str | None = None, loads: Sequence[Pure] = ()) -> Design:
    """Design the elastic hinge of an engine; how it runs is computed on first use, see `Design`.

    case: with sections parameters, operation, cycle, spring, guide, rollers, limits; diagram: CSV file of a measured
    diagram in place of the case's cycle; loads: other loads to try the guide at, as shares of the case's mean indicated
    pressure. Returns design: guide and verdict, also when it cannot be built; runs, flywheels and sensitivities of what
    could be cut. Raises BadInput: a section is missing, a value is impossible, or the cycle has one load only and
    others are asked for.
    """
    require(case, "hinge", NO_FILE if diagram else "")
    spring, choices, rollers, limits = (case.need(name) for name in ("spring", "guide", "rollers", "limits"))
    if loads and diagram is not None:
        raise BadInput(f"{diagram}: a measured diagram has one load; leave the diagram or the other loads out")
    pressures, engine = [share * design_load(case) for share in loads], machine(case, diagram)
    wanted = torque(engine)
    chosen, *instead = offers(wanted, spring, choices, rollers, limits)
    return Design(
        origin=Origin(name=case.name, about=case.about, source=case.source, sections=case.sections),
        machine=engine, rollers=rollers, hinge=wanted, balance=chosen.taken, guide=chosen.track,
        verdict=chosen.verdict, instead=tuple(instead), flywheel_kept=kept_flywheel(case),
        turns=case.sections.get("trials", TrialSettings()).turns, assumed=case.sections.get("losses", HingeLosses()),
        in_time=case.sections.get("losses"),
        other=functools.partial(_other, case), at_loads=lambda guide: tuple(at_loads(case, guide, pressures)),
    )  # fmt: skip


def design_load(case: Case) -> Pascal:
    """The mean indicated pressure that a case is designed for. Raises BadInput: the cycle has none to change."""
    cycle = case.need("cycle")
    if not kind_of(cycle).load:
        raise BadInput(f"{case.file}: [cycle] has no mean_indicated_pressure that could be changed; it has one load")
    return float(getattr(cycle, kind_of(cycle).load))


def at_loads(case: Case, guide: Guide, loads: Sequence[Pascal]) -> list[AtLoad]:
    """Steady running of a guide at other loads, at the speed of operation.

    The guide stays as it was cut. At another load the gas torque has another shape, so the hinge misses it; a spring
    set anew for that load takes part of the rest away. guide: guide of the case's hinge, status `cut`; loads: mean
    indicated pressures to try.
    """
    rows = []
    for load in loads:
        cycle = replace(case.need("cycle"), mean_indicated_pressure=load)
        engine = machine(replace(case, sections={**case.sections, "cycle": cycle}))
        wanted = torque(engine)
        setting = retune(guide, wanted, "least_squares_work").setting
        anew = refit(guide, with_setting(guide.spring, setting))
        rows.append(AtLoad(
            share=load / design_load(case), mean_indicated_pressure=load, as_cut=with_guide(engine, wanted, guide),
            reset=with_guide(engine, wanted, anew), setting=setting, ratio=setting / setting_of(guide.spring),
            unit=guide.spring.setting[1],
        ))  # fmt: skip
    return rows


def _other(case: Case) -> Machine | None:
    """The same engine and load with the speed and the cycle of another case, if the case names one."""
    section = case.sections.get("retune")
    if section is None:
        return None
    other = cases.load(section.case)
    same = {
        key: record for key, record in case.sections.items() if key in ("parameters", "flywheel", "load", "scavenging")
    }
    if listing(other.mechanism)["name"] != listing(case.mechanism)["name"]:
        raise BadInput(f"[retune] case = {other.name!r} is a case of {other.mechanism}, not of {case.mechanism}")
    own, theirs = bore(case.sections), bore(other.sections)
    if own and theirs and own != theirs:
        there = f"its bore is {theirs:g} m, not {own:g} m; give a case of this one at the other speed"
        raise BadInput(f"[retune] case = {other.name!r} is of another engine: {there}")
    sections = {key: record for key, record in other.sections.items() if key != "load"}
    return machine(replace(other, mechanism=case.mechanism, sections={**sections, **same}))
