"""Parameters of a mechanism that enter nothing of which a tab speaks, as its own functions have them.

The functions are built with every letter that has a slider left free; a letter is in what they give where its exact
derivative is more than round-off at a few states. A zero is taken as a small number there: it may hide another letter.
"""

from collections.abc import Mapping, Sequence
from types import SimpleNamespace
from typing import cast

import casadi as ca
import numpy as np

from mechsym import mechanisms
from mechsym.app.sliders import numbers
from mechsym.cases import Case
from mechsym.cycle.friction import MechanismFriction
from mechsym.cycle.kinds import kind_of
from mechsym.errors import BadInput
from mechsym.forces.friction import rubbing as places_of
from mechsym.forces.turn import turn as turn_of
from mechsym.jobs.cycle import cylinders
from mechsym.jobs.machine import drive_of
from mechsym.mechanisms.closing import closed
from mechsym.mechanisms.plan import plan_of
from mechsym.mechanisms.record import Mechanism, accelerations, velocities
from mechsym.mechanisms.roles import FaceRole, PistonRole
from mechsym.quantities.records import Record
from mechsym.quantities.units import Scalar

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
