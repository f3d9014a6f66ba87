"""Case -> run in time: a mechanism of n coordinates, and parts that act on its inputs, each with its work by itself.

    drive   gas of every piston, or [torque]   constants of [inputs]   hinge   load
      |                  |                              |                |       |
      '------------------'--------------.  .------------'----------------'-------'
                                     [ mechanism with its flywheel ]

An engine whose case names no run turns 20 times from its speed of operation; one whose case names no load has a
propeller that takes its mean torque there. A `[drive]` starts a shaft that twists from rest, with no load but the
case's own. Gas that follows the motion is no problem of this kind: see `mechsym.jobs.run`.
"""

import functools
import math
from collections.abc import Hashable, Mapping
from dataclasses import asdict, replace

import numpy as np

from mechsym import mechanisms
from mechsym.cases import Case
from mechsym.cases.settings import TURN_POINTS, count_times, count_turns, guesses, simulation_of
from mechsym.errors import BadInput
from mechsym.hinge.balance import balance
from mechsym.hinge.guide import Guide, cut, fitted
from mechsym.hinge.torque import Hinge, torque
from mechsym.jobs.gas import at_recorded_speed
from mechsym.jobs.machine import (
    acting_on,
    constants,
    drive_of,
    drive_on,
    load_input,
    machine,
    mechanism_of,
    turn,
    turned_by,
    turning,
)
from mechsym.jobs.machine import torque as shaft_torque
from mechsym.machine.loads import Load, PropellerLoad, settle
from mechsym.machine.record import Machine, acting, kinks_of, period_of
from mechsym.mechanisms.beyond import by_constraint, meets
from mechsym.mechanisms.own import letters_class
from mechsym.mechanisms.record import Mechanism, form_of
from mechsym.mechanisms.shaft import at_rest, with_torque
from mechsym.periodic import fit
from mechsym.periodic.pieces import PPoly
from mechsym.quantities import quantity, record
from mechsym.simulate.angle import tabulate
from mechsym.simulate.engine import at_angle, load_value, reduced
from mechsym.simulate.problem import Kinks, Part, Periodic, Problem, Steps, Stop
from mechsym.simulate.settings import Simulation
from mechsym.simulate.steady import mean_torque

# of the largest force: finer than any cycle, off by 4e-10 of its peak where it is closed, by 2e-6 where it breathes
_FOLLOWED = 1e-10
_AFTER = ("parameters", "flywheel", "simulation")  # sections that do not change what drives a train of one form
# the window whose mean, least and greatest speed is reported is sampled this finely
_WINDOW_POINTS = 4000


@record
class Ready:
    """A run whose parts are still known by what they are made of, so that their numbers can become parameters."""

    problem: Problem
    guide: Guide | None = None  #: Of the part `hinge`
    load: Load | None = None  #: Settled law of the part `load`, over the speed of the shaft


@record
class Driving:
    """What turns a shaft over its angle: the gas of every piston, or a torque from a table."""

    parts: tuple[Part, ...] = ()
    kinks: tuple[Kinks, ...] = ()  #: Where one of them is not smooth
    torque: float = 0.0  #: Their mean torque on the shaft [N*m]


@record
class _Shaft:
    """What says how a shaft starts, and what brakes it."""

    coordinate: str  #: Its angle
    twists: bool  #: Whether other coordinates are free beside it
    engine: bool  #: Whether gas or a torque from a table turns it, or a hinge keeps it turning
    driven: bool  #: Whether a `[drive]` does

    @property
    def running(self) -> bool:
        """Whether it is an engine at its speed of operation."""
        return self.engine and not (self.twists and self.driven)


#: What drives cases before this one, by all that it hangs on
Kept = dict[Hashable, "Driving"]


def problem_of(case: Case, kept: Kept | None = None) -> Problem:
    """The run that a case describes; `kept` lets cases that differ in masses and springs share what drives them.

    Raises BadInput: a section is missing or names what the mechanism has not.
    """
    return ready(case, kept).problem


def beyond(case: Case, ends: bool = False) -> Case:
    """The case on loops that close by constraint, where its closed forms end on the way, or would leave the motion.

    ends: whether a run is known to end there.
    """
    mechanism = mechanism_of(case)
    if "sides" not in mechanism.functions or not (ends or meets(mechanism)):
        return case
    roles = mechanisms.roles_of(case.mechanism)
    if roles.stops or roles.frictions:
        return case
    start = {q: simulation_of(case).phi_start for q in mechanism.coordinates} | guesses(case)
    at = {q: start[q] for q in mechanism.coordinates}
    name, numbers, pose = by_constraint(case.mechanism, mechanism, asdict(case.need("parameters")), at)
    places = letters_class("Start", {n: quantity("", default=v) for n, v in {**start, **pose}.items()})()
    return replace(case, mechanism=name, sections={**case.sections, "parameters": numbers, "start": places})


def ready(case: Case, kept: Kept | None = None) -> Ready:
    """The run of a case, with the parts that it is made of. kept: see `problem_of`."""
    case = at_recorded_speed(case)
    wanted, mechanism = simulation_of(case), mechanism_of(case)
    driving = driving_of(case, kept, mechanism)
    drive = drive_on(case, mechanism) if "drive" in case.sections else None
    declared = [r.angle for r in mechanisms.roles_of(case.mechanism).rotors if r.load]
    shaft = _Shaft(
        coordinate=next((q for q in declared if q in mechanism.coordinates), mechanism.coordinates[0]),
        twists=sum(q not in mechanism.dependents for q in mechanism.coordinates) > 1,
        engine=bool(driving.parts) or is_hinged(case),
        driven=drive is not None,
    )
    speed = wanted.speed_start
    if speed is None:
        speed = case.need("operation").speed if shaft.running else 0.0
    law = _law(case, driving.torque + (drive.driving if drive else 0.0), speed, shaft)
    parts = []
    if drive:
        time = case.need("drive").time
        steps = Steps(times=(time,), values=(0.0, drive.value)) if time > 0 else Steps(values=(drive.value,))
        parts.append(Part(name="drive", input=drive.input, value=steps))
    parts += driving.parts
    taken = {part.input for part in parts}
    for name, value in constants(case).items():  # on what nothing else acts on
        if value and name not in taken:
            parts.append(Part(name=f"input_{name}", input=name, value=Steps(values=(value,))))
    guide = None
    if is_hinged(case) and not shaft.twists:
        engine, hinge, guide = guide_of(case)
        hinged = fitted(replace(engine, load=_unsettled(case, shaft) or engine.load), hinge, guide)
        law = hinged.load if law is not None else None
        parts.append(_at(hinged, "hinge"))
    if law is not None:
        index = mechanism.coordinates.index(shaft.coordinate)
        parts.append(Part(name="load", input=load_input(case), role="load", value=load_value(law, index)))
    # places for the torque of a hinge, and of a drive at the free end of a shaft that twists
    places = {"M_h", *(rotor.drive for rotor in mechanisms.roles_of(case.mechanism).rotors if rotor.drive)}
    for name in sorted(places & {part.input for part in parts}):
        mechanism = with_torque(mechanism, name)
    roles, (q0, u0) = mechanisms.roles_of(case.mechanism), _start(case, mechanism, wanted, speed)
    t_end, output = _end(case, wanted, u0[0])
    stalls = shaft.engine or shaft.twists and speed > 0 and bool(load_input(case))
    problem = Problem(
        mechanism=mechanism, parts=tuple(parts), q0=q0, u0=u0, t_end=t_end, turns=wanted.turns, kinks=driving.kinks,
        # a crank on a shaft that twists may swing back within a turn; its flywheel does only when the shaft stops
        stops=(Stop(name="stall", of=f"{shaft.coordinate}d", direction="falling"),) if stalls else (),
        unilateral=(*roles.stops, *roles.frictions), output=output,
    )  # fmt: skip
    return Ready(problem=problem, guide=guide, load=law)


def _unsettled(case: Case, shaft: _Shaft) -> Load | None:
    """The law of the load as the case gives it: without one an engine drives a propeller."""
    return case.sections.get("load", PropellerLoad() if shaft.running else None)


def _law(case: Case, mean: float, speed: float, shaft: _Shaft) -> Load | None:
    """The law of the load with its blanks filled in from the mean torque [N*m]; None where nothing takes it."""
    law = _unsettled(case, shaft) if load_input(case) else None
    if law is None:
        return None
    blank = isinstance(law, PropellerLoad) and law.speed is None
    if shaft.twists and speed <= 0 and not isinstance(law, PropellerLoad):
        raise BadInput(
            f"{case.file}: a load with a torque at rest would pull the shaft backwards; give simulation.speed_start "
            "above 0 rad/s or [load] law = 'propeller'"
        )
    known = blank or "operation" in case.sections
    return settle(law, mean, case.need("operation").speed if known else math.nan)


def _at(machine: Machine, name: str) -> Part:
    force = next(force for force in acting(machine) if force.name == name)
    return Part(name=force.name, input=force.input, role=force.role, value=at_angle(machine, force))


def _start(
    case: Case, mechanism: Mechanism, wanted: Simulation, speed: float
) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Coordinates and velocities at the start [rad or m, by time]."""
    held, places = mechanism.dependents, mechanism.coordinates
    roles = mechanisms.roles_of(case.mechanism)
    cams = {cam.name for cam in roles.cams}
    still = {*held, *(stop.gap for stop in roles.stops if stop.name in cams)}  # a follower begins on its cam
    still |= {q for q in places if mechanism.units.get(q, "rad") != "rad"}
    values = {q: held.get(q, 0.0 if q in still else wanted.phi_start) for q in places} | guesses(case)
    rates = {f"{q}d": 0.0 if q in still else speed for q in places} | guesses(case)
    _require_closed(case, mechanism, values)
    return tuple(values[q] for q in places), tuple(rates[f"{q}d"] for q in places)


def _require_closed(case: Case, mechanism: Mechanism, start: Mapping[str, float]) -> None:
    dynamics = mechanism.functions["dynamics"]
    values = [start.get(n, 0.0) for n in dynamics.name_in()]
    if not np.isfinite(np.asarray(dynamics.call(values)[0])).all():
        at = ", ".join(f"{q} = {start[q]:g}" for q in mechanism.coordinates)
        raise BadInput(
            f"{case.file}: the loop is open at the start ({at}): links too short there; give [start] another pose"
        )


def _end(case: Case, wanted: Simulation, speed: float) -> tuple[float, float | tuple[float, ...]]:
    """Last time and wanted times: of a run to t_end, or of turns from a speed."""
    if wanted.t_end is not None and (wanted.turns is None or wanted.output_step is not None or speed <= 0):
        count_times(case, wanted.t_end, wanted.step)
        return wanted.t_end, _times(wanted.t_end, wanted.step, wanted.window)
    if speed <= 0:
        raise BadInput(f"{case.file}: turns need a start speed above 0 rad/s; give simulation.speed_start or t_end")
    assert wanted.turns is not None  # the section has one of the two
    turn_time = 2 * math.pi / speed
    count_turns(case, wanted.turns)
    # a shaft that takes ten times as long has stopped for every purpose
    longest = 10 * wanted.turns * turn_time
    return longest if wanted.t_end is None else min(wanted.t_end, longest), turn_time / TURN_POINTS


@functools.lru_cache(maxsize=8)
def _times(t_end: float, step: float, window: float | None) -> tuple[float, ...]:
    """Even times, and finer ones in the window, with both of its ends among them."""
    coarse = np.minimum(step * np.arange(1, math.ceil(t_end / step) + 1), t_end)
    if window is None:
        return tuple(np.unique(coarse).tolist())
    fine = np.linspace(max(t_end - window, 0.0), t_end, _WINDOW_POINTS + 1)
    # an even time and its neighbour of the finer set may differ by rounding only
    keep = coarse[coarse < fine[0] - 1e-9 * t_end]
    return tuple(np.concatenate([keep, fine[fine > 0]]).tolist())


def window_of(case: Case, problem: Problem) -> float | None:
    """The stretch at the end over which speeds are summed up, None for the last turn [s]."""
    wanted = simulation_of(case)
    if wanted.window is None and problem.turns is None:
        return problem.t_end - problem.t_start
    return wanted.window


def is_hinged(case: Case) -> bool:
    """Whether a hinge is designed for the run."""
    return {"spring", "guide"} <= set(case.sections) and simulation_of(case).hinge == "designed"


def guide_of(case: Case, diagram: str | None = None) -> tuple[Machine, Hinge, Guide]:
    """Engine, wanted torque and guide of a case. Raises BadInput: the guide that it asks for cannot be cut."""
    engine, choices = machine(case, diagram), case.need("guide")
    wanted = torque(engine)
    guide = cut(balance(wanted, choices.balance), case.need("spring"), choices)
    if guide.rho is None:
        raise BadInput(
            f"{case.file}: no guide can be cut ({guide.reason}); change [spring] or [guide], or set "
            "simulation.hinge = 'none' to run without"
        )
    return engine, wanted, guide


def driving_of(case: Case, kept: Kept | None = None, mechanism: Mechanism | None = None) -> Driving:
    """What turns the shaft of a case over its angle; nothing without `[cycle]` and `[torque]`.

    kept: see `problem_of`; mechanism: with all coordinates, where it is built already.
    Raises BadInput: Pistons on two throws of a shaft that share one gas, or a torque on a shaft that twists.
    """
    if not {"cycle", "torque"} & set(case.sections):
        return Driving()
    whole = mechanism or mechanism_of(case)
    if len(whole.coordinates) - len(whole.dependents) > 1:
        form = form_of(whole)
        if kept is None or form is None or form.pushed is None:
            return _on_throws(case, whole)
        rest = [(name, section) for name, section in case.sections.items() if name not in _AFTER]
        key = form.pushed, repr(rest)
        if key not in kept:
            kept[key] = _on_throws(case, whole)
        return kept[key]
    plain = turned_by(case, turning(case))
    (q,) = plain.mechanism.coordinates
    still = replace(plain, mechanism=at_rest(plain.mechanism))
    angles = kinks_of(plain)
    return Driving(
        parts=tuple(_at(plain, force.name) for force in acting(plain)),
        kinks=(Kinks(coordinate=q, angles=angles, period=period_of(plain)),) if angles else (),
        torque=mean_torque(tabulate(reduced(still))),
    )


def _on_throws(case: Case, mechanism: Mechanism) -> Driving:
    """The gas on a shaft that twists, over the angle of each cylinder's own throw, twist included.

    M_drive --> [throw 1]--[throw 2]-- ... --[throw N]--[flywheel] <-- M (load law of the flywheel's speed)
                   ^ F1       ^ F2              ^ FN
    """
    if "torque" in case.sections:
        raise BadInput(f"{case.file}: [torque] turns a stiff shaft; give [drive] or [cycle]")
    acts = acting_on(case, drive_of(case))
    throws = {one.face.throw for one in acts}
    if len(throws) > 1 and any(one.gas.pistons for one in acts):
        raise BadInput(
            f"{case.file}: throw = {[one.face.throw + 1 for one in acts]}: the twist between throws would change the "
            "volume of a gas that both cylinders share; put them on one throw"
        )
    curves: dict[object, PPoly] = {}  # cylinders that are equal share one
    parts, bends = [], {mechanism.coordinates[throw]: set[float]() for throw in sorted(throws)}
    for number, one in enumerate(acts, 1):
        name, period = mechanism.coordinates[one.face.throw], one.gas.pressure.period
        angles = tuple(sorted((k + one.face.fires) % period for k in one.gas.pressure.kinks))
        bends[name].update(angles)
        alike, own = (id(one.gas), one.area, one.face.sense), replace(one, face=replace(one.face, fires=0.0))
        curve = curves.get(alike) or fit(own.force, one.gas.pressure.kinks, period, _FOLLOWED)
        curves[alike] = curve
        fired = PPoly(curve.c, curve.x + one.face.fires % period, extrapolate="periodic")
        value = Periodic(coordinate=name, value=fired, period=period, kinks=angles)
        parts.append(Part(name=f"gas_{number}", input=one.face.input, value=value))
    kinks = (Kinks(coordinate=q, angles=tuple(sorted(bent)), period=period) for q, bent in bends.items() if bent)
    mean = float(np.mean(shaft_torque(case)))
    if not math.isfinite(mean):
        turn(case)  # which says where the loop opens
    return Driving(parts=tuple(parts), kinks=tuple(kinks), torque=mean)
