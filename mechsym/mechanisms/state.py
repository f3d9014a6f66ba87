"""Everything that is known of a mechanism at one state, with or without constraints."""

import types
from collections.abc import Mapping, Sequence

import casadi as ca
import numpy as np

from mechsym.errors import BadInput
from mechsym.mechanisms import constraints, driven, loops
from mechsym.mechanisms.record import Mechanism, accelerations, listing, velocities
from mechsym.quantities.results import Columns, part, quantity, result


@result
class MechanismState:
    """What is known of a mechanism at one state; lists go along its coordinates."""

    mass_matrix: list[list[float]] = quantity("@inertia")  #: Generalised inertia
    bias: list[float] = quantity("@push")  #: Forces of inertia at no acceleration
    generalized_force: list[float] = quantity("@push")  #: Of inputs, gravity, springs and dampers
    acceleration: list[float] = quantity("@rate")  #: Of the coordinates
    kinetic_energy: float | None = quantity("J")  #: None of a model given only by its equations
    potential_energy: float | None = quantity("J")  #: Of gravity and springs
    outputs: Columns = part()  #: Travels, their slopes, reactions, as the declaration names them
    inertia: str
    push: str
    rate: str


_UNITS = {"rad": ("kg*m^2", "N*m", "rad/s^2"), "m": ("kg", "N", "m/s^2"), "-": ("kg*m^2", "N*m", "1/s^2")}
_MIXED = ("of its coordinates",) * 3


def state(
    mechanism: Mechanism, values: Mapping[str, float], units: Mapping[str, str] = types.MappingProxyType({})
) -> MechanismState:
    """Everything that is known of a mechanism at one state.

    values: coordinates, velocities and inputs; what is not named is 0, or what the constraints make it. Accelerations
    that are named are inverse dynamics: driving forces make them. units: of outputs, where they are to be told.
    """
    q, u = mechanism.coordinates, velocities(mechanism)
    values, qdd, joint_forces = _motion(mechanism, values)

    def numbers(names: Sequence[str]) -> list[float]:
        return [float(values.get(n, 0.0)) for n in names]

    dynamics = mechanism.functions["dynamics"]
    mass, bias, force = (np.asarray(v) for v in dynamics.call(numbers(dynamics.name_in())))
    quantities = dict(zip(accelerations(mechanism), qdd, strict=True)) | dict(values)
    outputs: dict[str, float | None] = {**_named(mechanism.functions["kinematics"], numbers(q)), **joint_forces}
    held = [name for name in mechanism.dependents if name in values]
    outputs |= {name: values[name] for q in held for name in (q, f"{q}d")}
    outputs |= _inertia(mechanism, values) | dict.fromkeys(mechanism.undetermined)
    if "reactions" in mechanism.functions and not any(n.startswith("driving_") for n in joint_forces):
        reactions = mechanism.functions["reactions"]
        outputs |= _named(reactions, [float(quantities.get(n, 0.0)) for n in reactions.name_in()])
    energies: dict[str, float | None] = {"kinetic_energy": None, "potential_energy": None}
    if "energy" in mechanism.functions:
        energies |= _named(mechanism.functions["energy"], numbers([*q, *u]))
    kinds = {mechanism.units.get(name, "rad") for name in q}
    inertia, push, rate = _UNITS.get(kinds.pop(), _MIXED) if len(kinds) == 1 else _MIXED
    known = {**dict.fromkeys(outputs, ""), **_units(mechanism), **units}
    shown = {n: mechanism.shown.get(n, n) for n in known}
    columns = Columns({shown[n]: v for n, v in outputs.items()}, {shown[n]: unit for n, unit in known.items()})
    return MechanismState(
        mass_matrix=mass.tolist(), bias=bias.ravel().tolist(), generalized_force=force.ravel().tolist(),
        acceleration=qdd.tolist(), outputs=columns, **energies, inertia=inertia, push=push, rate=rate,
    )  # fmt: skip


def _units(mechanism: Mechanism) -> dict[str, str]:
    """Of what is no output of the declaration."""
    known: dict[str, str] = {}
    if "constraints" in mechanism.functions:
        listed = listing(mechanism.name)
        known = {f"force_{c}": listed["outputs"][name] for c, name in listed.get("multipliers", {}).items()}
        known |= {"constraint_rank": "-", "constraint_count": "-"}
    for q in mechanism.coordinates:
        inertia, push, _ = _UNITS[unit := mechanism.units.get(q, "rad")]
        known |= {q: unit, f"{q}d": f"{unit}/s"} if q in mechanism.dependents else {}
        known |= {f"driving_{q}": push, f"dinertia_d{q}": f"{inertia}/{unit}"}
        known |= {"inertia": inertia} if q not in mechanism.dependents else {}
    return known


def _motion(
    mechanism: Mechanism, values: Mapping[str, float]
) -> tuple[dict[str, float], np.ndarray, dict[str, float | None]]:
    if moved := [q for q in mechanism.coordinates if f"{q}dd" in values]:
        return _driven(mechanism, moved, values)
    if "constraints" in mechanism.functions:
        return constraints.motion(mechanism, values)
    dynamics = mechanism.functions["dynamics"]
    given = [float(values.get(n, 0.0)) for n in dynamics.name_in()]
    mass, bias, force = (np.asarray(v) for v in dynamics.call(given))
    _closes(mechanism, values, mass, bias, force)
    return dict(values), np.linalg.solve(mass, force - bias).ravel(), {}


def _closes(mechanism: Mechanism, values: Mapping[str, float], *results: np.ndarray) -> None:
    if not all(np.isfinite(v).all() for v in results):
        at = ", ".join(f"{q} = {float(values.get(q, 0.0)):g}" for q in mechanism.coordinates)
        raise BadInput(
            f"{mechanism.name}: the loop is open at {at}: links too short there, or a wrong branch; give another pose"
        )


def _driven(
    mechanism: Mechanism, given: list[str], values: Mapping[str, float]
) -> tuple[dict[str, float], np.ndarray, dict[str, float | None]]:
    """Inverse dynamics: some accelerations given, with the forces along their coordinates that make them."""
    held = mechanism.dependents
    own = {n: v for n, v in values.items() if not n.endswith("dd") or n[:-2] not in mechanism.coordinates}
    closed = constraints.close(mechanism, own) if held else own
    pose, rates = (
        [float(closed.get(n, 0.0)) for n in names] for names in (mechanism.coordinates, velocities(mechanism))
    )
    one = driven.drive(mechanism, given, dict(zip(mechanism.coordinates, pose, strict=True)))
    asked = [float(values[f"{n}dd"]) for n in one.driven]
    inputs = [float(values.get(n, 0.0)) for n in mechanism.inputs]
    a, force = (np.asarray(x).ravel() for x in one.forces(pose, rates, asked, inputs))
    if held and not (np.isfinite(a).all() and np.isfinite(force).all()):
        raise BadInput(f"{mechanism.name}: no force is determined there; the loop is open, or in a dead point")
    _closes(mechanism, closed, a, force)
    outputs: dict[str, float | None] = {}
    if "reactions" in mechanism.functions:
        letters = {**closed, **dict(zip(accelerations(mechanism), a.tolist(), strict=True))}
        function = driven.reactions(one)
        values = _named(function, [float(letters.get(n, 0.0)) for n in function.name_in()])
        outputs |= {n: v for n, v in values.items() if not n.startswith("driving_")}
    return closed, a, outputs | {f"driving_{n}": float(f) for n, f in zip(one.driven, force, strict=True)}


def _inertia(mechanism: Mechanism, values: Mapping[str, float]) -> dict[str, float]:
    """Of one free coordinate, what it feels of all that the loops move, and its slope: `inertia`, `dinertia_dphi`."""
    names, held = mechanism.coordinates, tuple(mechanism.dependents)
    if not held or len(names) != len(held) + 1:
        return {}
    (free,), q = loops.split(mechanism, held)[0], ca.SX.sym("q", len(names))
    T, _ = loops.motion(mechanism, q, ca.SX(1, 1), held)
    dynamics = mechanism.functions["dynamics"]
    mass = dynamics(*ca.vertsplit(q), *([0] * (dynamics.n_in() - len(names))))[0]
    inertia = ca.mtimes(T.T, ca.mtimes(mass, T))
    both = ca.Function("inertia", [q], [inertia, ca.jtimes(inertia, q, T)])([values[n] for n in names])
    return {
        n: float(v) for n, v in zip(("inertia", f"dinertia_d{names[free]}"), both, strict=True) if np.isfinite(float(v))
    }


def _named(function: ca.Function, values: Sequence[float]) -> dict[str, float]:
    return {n: float(v) for n, v in zip(function.name_out(), function.call(list(values)), strict=True)}
