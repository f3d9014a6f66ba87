"""Parameters of a mechanism that enter nothing of which a tab speaks: its own functions are asked, whatever it is.

Each number is moved a little and the functions are compared at a few states, with what is zero lifted off zero. A
letter that changes none of them can move nothing that follows from them.
"""

import dataclasses
import functools
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import casadi as ca
import numpy as np

from mechsym.app.sliders import numbers
from mechsym.cases import Case
from mechsym.cycle.friction import MechanismFriction
from mechsym.cycle.kinds import kind_of
from mechsym.cycle.measured.diagram import Diagram
from mechsym.cycle.motion import piston_roles
from mechsym.errors import BadInput
from mechsym.forces.turn import chain_of
from mechsym.forces.turn import turn as turn_of
from mechsym.jobs import own
from mechsym.jobs.gas import one_cylinder
from mechsym.jobs.own import is_own
from mechsym.jobs.turn import drive_of
from mechsym.jobs.whole_engine import cylinders
from mechsym.mechanisms import build
from mechsym.mechanisms.record import Mechanism, accelerations, bind, evaluate, listing
from mechsym.mechanisms.traits import is_train, traits_of

Seen = Mapping[str, np.ndarray]

_PHI = np.array([0.3, 1.1, 2.0, 2.9, 3.8, 4.7, 5.6])  # no dead centre, no symmetry [rad]
_SPEED = 10.0  # at which nothing is out of proportion [rad/s]
_MOVED = 1.01  # times a number
_LIFT = 0.05  # of the largest number of the same unit, in place of a zero
_ROUNDING = 1e-11  # of the largest value of an output
_ALL = "no output of the mechanism depends on it"
_HELD = "the speed is held"
_GAS = "of the mechanism only what moves the pistons, and what moves with them, acts here"
_PLACES = {"guides": ("mu_guide",), "teeth": ("mu_mesh", "module", "contact_ratio"),
           "piston_pins": ("mu_pin", "radius_piston_pin"), "crank_pins": ("mu_pin", "radius_crank_pin")}  # fmt: skip
_SHAFT = ("mu_main", "radius_main")


def unread(case: Case, tab: str) -> Mapping[str, str]:
    """Parameters that stand alone and enter nothing that a tab shows, each with the reason."""
    asked = {"forces": (_held, _HELD), "cycle": (_of_gas, _GAS), "simulate": (_free, _ALL)}.get(tab)
    if asked is None or "parameters" not in case.sections:
        return {}
    seen, reason = asked
    return dict.fromkeys(_still(case, seen), reason)


def rubbing(case: Case) -> frozenset[str]:
    """The values of `[friction]` that act at a place where parts of the mechanism rub."""
    if is_own(case.mechanism):
        bearings, guides = own.roles(case, "bearing"), own.roles(case, "guide")
        found = {"mu_pin": bearings, "radius_crank_pin": [b for b in bearings if b["radius"] is None],
                 "mu_guide": guides}  # fmt: skip
        return frozenset(name for name, places in found.items() if places)
    one = turn_of(drive_of(_with(case, _lifted(case))), None, _SPEED)
    rubs = chain_of(one.drive).rubbing(one, chain_of(one.drive).loads(one))
    return frozenset(n for r in rubs if np.any(r.force) and np.any(r.speed) for n in _PLACES[r.place]) | {*_SHAFT}


def _still(case: Case, seen: Callable[[Case], Seen]) -> list[str]:
    """Numbers among the parameters that change nothing of what is seen; none where it cannot be seen at all."""
    data = _lifted(case)
    if _seen(case, data, seen) is None:  # a zero may be wanted, as an offset that a cycle refuses
        data = _lifted(case, lambda other: _seen(case, other, seen) is not None)
    before = _seen(case, data, seen)
    if before is None:
        return []
    moved = {f.name: _moved(data, f.name) for f in numbers(case, "parameters")}
    return [n for n, other in moved.items() if other and _same(before, _seen(case, other, seen))]


def _seen(case: Case, parameters: Any, seen: Callable[[Case], Seen]) -> Seen | None:
    try:
        return seen(_with(case, parameters))
    except BadInput:
        return None


def _same(one: Seen, other: Seen | None) -> bool:
    return other is not None and all(_alike(value, other[name]) for name, value in one.items())


def _alike(one: np.ndarray, other: np.ndarray) -> bool:
    closed = np.isfinite(one) & np.isfinite(other)  # a loop may be open in a pose
    size = np.abs(one[closed]).max(initial=0.0)
    return not one.size or bool(closed.any() and np.abs(other - one)[closed].max() <= _ROUNDING * size)


def _with(case: Case, parameters: Any) -> Case:
    return dataclasses.replace(case, sections={**case.sections, "parameters": parameters})


def _numbers(data: Any) -> list[str]:
    return [f.name for f in dataclasses.fields(data) if isinstance(getattr(data, f.name), float)]


def _lifted(case: Case, allowed: Callable[[Any], bool] = lambda data: True) -> Any:
    """The parameters with a small value in place of each zero that has a slider and may have one."""
    data = case.need("parameters")
    for name in (f.name for f in numbers(case, "parameters") if getattr(data, f.name) == 0):
        other = _replaced(data, name, _small(data, name))
        data = other if other is not None and allowed(other) else data
    return data


def _small(data: Any, name: str) -> float:
    units = {f.name: f.metadata.get("unit") for f in dataclasses.fields(data)}
    return _LIFT * (max(abs(getattr(data, n)) for n in _numbers(data) if units[n] == units[name]) or 1.0)


def _moved(data: Any, name: str) -> Any:
    value = getattr(data, name)
    ends = (value * _MOVED, value / _MOVED) if value else (_small(data, name), -_small(data, name))
    return _replaced(data, name, ends[0]) or _replaced(data, name, ends[1])


def _replaced(data: Any, name: str, value: float) -> Any:
    try:
        return dataclasses.replace(data, **{name: value})
    except BadInput:
        return None


def _states(mechanism: Mechanism, held: bool) -> dict[str, Any]:
    """Angles, speeds and inputs, all different [SI]; accelerations too, of what is not held at its speed."""
    n = len(_PHI)
    found: dict[str, Any] = {}
    for i, q in enumerate(mechanism.coordinates):
        pushed = 0.0 if held and q not in mechanism.dependents else 7.0 + i
        found |= {q: _PHI + 0.1 * i, f"{q}d": np.full(n, _SPEED + i), f"{q}dd": np.full(n, pushed)}
    return found | {name: np.full(n, 1.0 + 0.1 * i) for i, name in enumerate(mechanism.inputs)}


@functools.lru_cache(maxsize=16)
def _symbolic(name: str) -> Mechanism:
    """A mechanism that takes its parameters as inputs, so that it is built once."""
    return bind(name, {letter: ca.SX.sym(letter) for letter in listing(name)["parameters"]})


def _told(case: Case, mechanism: Mechanism, groups: Sequence[str], held: bool = True) -> dict[str, np.ndarray]:
    """Outputs of groups of functions at the states, and what is left of the equations of motion there."""
    letters = {n: getattr(case.need("parameters"), n) for n in _numbers(case.need("parameters"))}
    given = letters | _states(mechanism, held)
    found: dict[str, np.ndarray] = {}
    for group in (g for g in ("dynamics", *groups) if g in mechanism.functions):
        names = mechanism.functions[group].name_in()
        values = evaluate(mechanism, group, **{n: given[n] for n in names if n in given})
        found |= {f"{group} {name}": value for name, value in values.items()}
    n = len(mechanism.coordinates)
    mass, bias, force = (found.pop(f"dynamics {name}") for name in ("mass_matrix", "bias", "generalized_force"))
    rates = np.array([given[a] for a in accelerations(mechanism)])
    return found | {"motion": np.einsum("ijk,jk->ik", mass.reshape(n, n, -1), rates) + (bias - force).reshape(n, -1)}


def _built(case: Case) -> Mechanism:
    assembled = is_train(case.mechanism)
    return build(case.mechanism, case.need("parameters")) if assembled else _symbolic(case.mechanism)


def _rigid(case: Case) -> Mechanism:
    """The mechanism with every reaction, of a train on a rigid shaft."""
    known = traits_of(case.mechanism)
    closed = known is not None and known.chain is not None and known.chain.rigid is not None
    return drive_of(case).mechanism if closed else _symbolic(case.mechanism)


def _held(case: Case) -> Seen:
    if not is_own(case.mechanism):
        found = _told(case, _rigid(case), ("reactions", "momentum"))
        elastic = is_train(case.mechanism) and "cycle" in case.sections  # its shaft is judged too
        return found | ({f"free {n}": v for n, v in _free(case).items()} if elastic else {})
    bearings = own.roles(case, "bearing") if "friction" in case.sections else []
    radii = {b["radius"]: getattr(case.need("parameters"), b["radius"]) for b in bearings if b["radius"]}
    found = _told(case, _rigid(case), ("kinematics", "constraints", "reactions", "momentum"))
    return found | {f"radius {name}": np.array([value]) for name, value in radii.items()}


def _free(case: Case) -> Seen:
    return _told(case, _built(case), ("constraints",), held=False)


def _of_gas(case: Case) -> Seen:
    """Travels of the pistons and what moves with them; torque where a figure is made of it."""
    if isinstance(case.sections.get("friction_pressure"), MechanismFriction):
        return _held(case)
    seen, train = one_cylinder(case), kind_of(case.need("cycle")).given == "train"
    roles, told = piston_roles(seen.mechanism), _told(seen, _symbolic(seen.mechanism), ("kinematics", "constraints"))
    wanted = {f"kinematics {role['travel']}" for role in roles}
    found = {n: v for n, v in told.items() if n in wanted or n.startswith("constraints")}
    if isinstance(case.need("cycle"), Diagram):
        return found
    if train or (len(roles) if is_own(case.mechanism) else cylinders(case).count) > 1:
        return found | {"motion": _told(case, _rigid(case), ())["motion"]}
    data = seen.need("parameters")
    return found | {f"mass {m}": np.array([getattr(data, m)]) for r in roles for m in r.get("masses", ())}
