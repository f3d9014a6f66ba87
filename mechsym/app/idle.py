"""Sliders that a tab does not offer, because nothing that it shows depends on them, and why.

Of a mechanism's letters its functions say it: they are built with every letter that has a slider left free; a letter
is in what they give where its exact derivative is more than round-off at a few states. A zero is taken as a small
number there: it may hide another letter.
"""

from collections.abc import Callable, Mapping, Sequence
from types import SimpleNamespace
from typing import Any, cast

import casadi as ca
import numpy as np

from mechsym import mechanisms
from mechsym.app.sliders import REACH, numbers
from mechsym.cases import Case
from mechsym.cycle.friction import MechanismFriction
from mechsym.cycle.kinds import kind_of
from mechsym.errors import BadInput
from mechsym.forces.friction import rubbing as places_of
from mechsym.forces.turn import turn as turn_of
from mechsym.jobs.cycle import cylinders
from mechsym.jobs.machine import drive_of
from mechsym.mechanisms import roles_of
from mechsym.mechanisms.closing import closed
from mechsym.mechanisms.plan import plan_of
from mechsym.mechanisms.record import Mechanism, accelerations, velocities
from mechsym.mechanisms.roles import FaceRole, PistonRole
from mechsym.quantities.records import Record, moved
from mechsym.quantities.records import unread as unread_keys
from mechsym.quantities.units import Scalar


def idle(case: Case, tab: str) -> Mapping[str, str]:
    """Keys of a case that move nothing in a tab, each with the reason."""
    reasons = {f"{s}.{name}": why for s, data in case.sections.items() for name, why in unread_keys(data).items()}
    reasons |= {
        f"{s}.{name}": f"{key} tells it" for s, data in case.sections.items() for name, key in moved(data).items()
    }
    for section, names, tabs, reason in _RULES:
        data = case.sections.get(section)
        why = None if data is None or (tabs and tab not in tabs) else reason(case, data)
        if why is not None:
            reasons |= {f"{section}.{name}": why for name in names or vars(data) if name in vars(data)}
    if "friction" in case.sections and tab == "forces":
        acting = rubbing(case)
        reasons |= {f"friction.{n}": _NO_PLACE for n in vars(case.need("friction")) if n not in acting}
    return reasons | {f"parameters.{name}": why for name, why in unread(case, tab).items()}


Idle = Callable[[Case, Any], str | None]  # why a section of a case is not read


def _unless(field: str, value: str) -> Idle:
    """A reason while a choice of the same section is another one."""

    def reason(case: Case, data: object) -> str | None:
        chosen = getattr(data, field, value)
        return None if chosen == value else f"{field} is {chosen}"

    return reason


def _said(words: str) -> Idle:
    return lambda case, data: words


def _fuel(case: Case, data: object) -> str | None:
    kind = kind_of(data)
    given = kind.facts and getattr(data, kind.load)
    return "the mean pressure is given: it tells temperatures and fuel only" if given else None


def _no_friction(case: Case, data: Any) -> str | None:
    free = data.friction == "none" and "losses" not in case.sections
    return "the rollers have no friction" if free else None


def _schmidt(case: Case, data: object) -> str | None:
    return "kind is schmidt, without losses" if "cycle" in case.sections and kind_of(case.need("cycle")).ideal else None


def _opposed(case: Case, data: object) -> str | None:
    return "it acts on both ends of a slider" if "faces" in case.sections else None


def _measured(case: Case, data: object) -> str | None:
    measured = "cycle" in case.sections and kind_of(case.need("cycle")).measured
    return "the cycle is measured" if measured else None


def _no_joints(case: Case, data: object) -> str | None:
    """The cycle asks for the friction of the joints only where its mean pressure is made of it."""
    law = case.sections.get("friction_pressure")
    return None if isinstance(law, MechanismFriction) else "the cycle is without the friction of the joints"


def _anew(words: str) -> Idle:
    """A reason where rules size the parts anew; parts that a case gives are checked under all of its loads."""
    return lambda case, data: words if _rules(case) and "part_crosshead" not in case.sections else None


def _rules(case: Case) -> str:
    """By which parts are sized; without a closed cycle `size` tells loads only."""
    closed = "cycle" in case.sections and kind_of(case.need("cycle")).closed
    return roles_of(case.mechanism).rules if closed else ""


def _chosen(case: Case, data: object) -> str | None:
    return (
        None if "part_crosshead" in case.sections else "the part is sized anew, of the given one only masses are read"
    )


def _kept(case: Case, data: object) -> str | None:
    return "pins, guide and rod are checked" if "part_crosshead" in case.sections else None


def _fine(case: Case, data: Any) -> str | None:
    wanted = case.sections.get("sizing")
    return "sizing.speed_step is wider" if wanted and REACH * data.step <= wanted.speed_step else None


def _weighed(case: Case, data: object) -> str | None:
    anew = _rules(case) in ("slider crank", "planet") and "part_crosshead" not in case.sections
    return "sized parts weigh what they weigh" if anew else None


def _family(case: Case, data: object) -> str | None:
    wanted = case.sections.get("codesign")
    return "the scavenging of the co-design tells it at each load" if wanted is not None and wanted.scavenge else None


def _designed(case: Case, data: object) -> str | None:
    return "designed at the speeds of [codesign]" if "codesign" in case.sections else None


_NO_PLACE = "the mechanism has no such place that rubs"

# section, keys (none: all of it), tabs (none: all of them), reason while it holds
_RULES: tuple[tuple[str, tuple[str, ...], tuple[str, ...], Idle], ...] = (
    ("scavenging", (), (), _unless("source", "turbocharger")),
    ("rollers", (), ("simulate",), _no_friction),
    ("limits", (), ("simulate",), _said("the tab hinge judges them")),
    ("cycle", ("c_v", "lhv", "R"), ("simulate", "codesign"), _fuel),
    ("cycle", ("T_evc",), ("simulate", "codesign"), _fuel),
    ("cycle", ("lhv", "T_evc", "R", "c_v"), ("size",), _fuel),
    ("cycle", ("octane",), ("simulate", "forces", "size", "hinge", "codesign"), _said("the tab cycle tells the knock")),
    ("cycle", ("clearance_share_hot", "clearance_share_cold"), (), _schmidt),
    ("cycle", ("p_back",), ("cycle",), _measured),
    ("stirling", (), (), _schmidt),
    ("operation", ("speed",), ("cycle",), _measured),
    ("friction", (), ("cycle",), _no_joints),
    ("rings", (), ("cycle",), _no_joints),
    ("closing", (), ("cycle",), _said("it shares out forces whose sum acts here")),
    ("chamber", ("back_pressure",), ("forces", "simulate", "size"), _opposed),
    ("simulation", ("turns",), ("forces",), _said("a turn at constant speed")),
    ("shaking", ("limit",), ("forces",), _said("it only judges")),
    ("friction", (), ("size",), _said("parts are sized without friction of the joints")),
    ("operation", ("speed",), ("size",), _anew("sized at the speeds of [speeds]")),
    ("speeds", ("step",), ("size",), _fine),
    ("cycle", ("p_s",), ("codesign",), _family),
    ("operation", ("speed",), ("codesign",), _designed),
    ("rollers", ("plane_offset",), ("codesign",), _said("the tab hinge judges it")),
    ("parameters", ("I1",), ("size",), _anew("the speed is held")),
    ("parameters", ("m1", "m2", "m3", "m4", "m5", "I01", "IC2", "u1", "I2"), ("size",), _weighed),
    ("parameters", ("g",), ("size",), _anew("parts are sized without their weight")),
    ("parameters", ("m1", "I01"), ("size",), _kept),
    ("part_piston", ("ring_radial", "ring_axial", "land_top", "land"), ("size",), _chosen),
    ("part_cylinder", ("flange", "bolts", "thread_mm"), ("size",), _chosen),
    ("part_gears", ("shift", "teeth_pinion", "teeth_ring"), ("size",), _chosen),
    ("part_crank", ("pin", "web_width"), ("size",), _chosen),
    ("part_masses", ("crankshaft",), ("size",), _chosen),
)


_SPEED = 10.0  # at which nothing is out of proportion [rad/s]
_STATES = np.array([0.3, 1.1, 2.0, 2.9, 3.8, 4.7, 5.6])  # no dead centre, no symmetry [SI]
_SMALL = 1e-3  # in place of a zero [SI]
_ROUNDING = 1e-12  # of the largest value of an output
_ALL = "no output of the mechanism depends on it"
_HELD = "the speed is held"
_GAS = "of the mechanism only what moves the pistons, and what moves with them, acts here"


def unread(case: Case, tab: str) -> dict[str, str]:
    """Parameters that stand alone and enter nothing that a tab shows, each with the reason."""
    asked = {"forces": (_held, _HELD), "cycle": (_of_gas, _GAS), "simulate": (_free, _ALL)}.get(tab)
    if tab == "size" and not _rules(case) and "part_crosshead" not in case.sections:
        asked = _loads, _HELD  # at the speed of operation
    offered = numbers(case, "parameters") if "parameters" in case.sections else []
    if asked is None or not offered:
        return {}
    entering, reason = asked
    try:
        acting = entering(case)
    except BadInput:  # the command says it
        return {}
    return {field.name: reason for field in offered if field.name not in acting}


def rubbing(case: Case) -> frozenset[str]:
    """The values of `[friction]` that act at a place where parts of the mechanism rub."""
    one = turn_of(drive_of(case), None, _SPEED)
    return frozenset(n for r in places_of(one) if np.any(r.force) and np.any(r.speed) for n in r.reads)


def _open(case: Case, rigid: bool) -> Mechanism:
    """The mechanism with its sliders' letters free, on a shaft that does not twist where it is put together so."""
    plan, free = plan_of(case.mechanism), {f.name: ca.SX.sym(f.name) for f in numbers(case, "parameters")}
    letters = cast(Record, SimpleNamespace(**vars(case.need("parameters")) | free))
    rigid = rigid and bool(mechanisms.lists(case.mechanism))
    return plan.rigid(letters, {}) if rigid else plan.build(letters)


def _entering(case: Case, groups: Sequence[str], held: bool = True, only: Sequence[str] = ()) -> set[str]:
    """Letters in outputs of groups of functions and, unless only some are named, in the equations of motion."""
    mechanism = _open(case, held)
    for role in mechanisms.roles_of(case.mechanism).closings if "reactions" in groups else ():
        mechanism = closed(mechanism, role, case.need("closing"))
    q, a = mechanism.coordinates, accelerations(mechanism)
    still = {name for name, of in zip(a, q, strict=True) if held and of not in mechanism.dependents}
    state = {n: ca.SX(0) if n in still else ca.SX.sym(n) for n in (*q, *velocities(mechanism), *a, *mechanism.inputs)}
    parameters: Mapping[str, Scalar] = mechanism.parameters  # numbers, or letters left free
    free = {name: value for name, value in parameters.items() if isinstance(value, ca.SX)}

    def outputs(group: str) -> dict[str, ca.SX]:
        function, known = mechanism.functions[group], state | free
        return function(**{n: known[n] for n in function.name_in()})

    values = [v for g in groups if g in mechanism.functions for n, v in outputs(g).items()
              if g != "kinematics" or not only or n in only]  # fmt: skip
    if not only:
        motion, rates = outputs("dynamics"), ca.vertcat(*(state[name] for name in a))
        values.append(motion["mass_matrix"] @ rates + motion["bias"] - motion["generalized_force"])
    inside = _inside(ca.vertcat(*map(ca.vec, values)), [v for v in state.values() if v.is_symbolic()], free, case)
    return set(np.array(list(free))[inside])


def _inside(values: ca.SX, state: Sequence[ca.SX], free: Mapping[str, ca.SX], case: Case) -> np.ndarray:
    """Whether each letter moves one of some values, by its derivative at a few states."""
    letters, own = ca.vertcat(*free.values()), np.array([getattr(case.need("parameters"), n) for n in free])
    function = ca.Function("moved", [ca.vertcat(*state), letters], [values, ca.jacobian(values, letters)])
    rows = [function(at + 0.1 * np.arange(len(state)), np.where(own, own, _SMALL)) for at in _STATES]
    # a loop may be open in a pose
    size, slope = (np.nanmax([np.abs(np.asarray(row[i])) for row in rows], axis=0, initial=0.0) for i in (0, 1))
    return (slope * np.where(own, np.abs(own), 1.0) > _ROUNDING * size).any(axis=0)


def _held(case: Case) -> set[str]:
    roles = mechanisms.roles_of(case.mechanism)
    acting = _entering(case, ("kinematics", "constraints", "reactions", "momentum"))
    acting |= {b.radius for b in roles.bearings if b.radius and "friction" in case.sections}
    # the shaft of an engine is judged too
    return acting | (_free(case) if roles.shafts and "cycle" in case.sections else set())


def _loads(case: Case) -> set[str]:
    return _entering(case, ("constraints", "reactions"))


def _free(case: Case) -> set[str]:
    return _entering(case, ("constraints",), held=False)


def _of_gas(case: Case) -> set[str]:
    """What moves the pistons and moves with them; torque where a figure is made of it."""
    if isinstance(case.sections.get("friction_pressure"), MechanismFriction):
        return _held(case)
    kind, plan = kind_of(case.need("cycle")), plan_of(case.mechanism)
    parts = plan.parts(case.need("parameters"))
    heads: tuple[PistonRole | FaceRole, ...] = (*parts.pistons, *parts.faces)
    acting = _entering(case, ("kinematics", "constraints"), only=[head.travel for head in heads])
    if kind.measured:
        return acting
    stands_in = plan.alone(case.need("parameters"))[0] != case.mechanism
    if kind.shared or stands_in or len(parts.pistons) > 1 or cylinders(case).count > 1:
        return acting | _entering(case, ())
    return acting | {mass for head in heads for mass in head.masses if isinstance(mass, str)}
