"""A mechanism of the user's own over one cycle at constant speed: outputs, joint reactions, the torque that drives it.

The driving torque acts on the first coordinate beside the gas and the constants of `[inputs]`. The same power follows
from the energies; their difference is the power residual.
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import casadi as ca
import numpy as np

from mechsym.cases import Case
from mechsym.errors import BadInput
from mechsym.files import write_quantities, write_text
from mechsym.jobs import own, own_gas, own_losses
from mechsym.mechanisms import own_drawing
from mechsym.mechanisms.record import Mechanism, listing
from mechsym.quantities import RPM, record

_STEPS_PER_TURN = 720


@record
class OwnTurn:
    """One cycle at constant speed."""

    mechanism: Mechanism  #: With one coordinate
    omega: float  #: [rad/s]
    phi: np.ndarray  #: shape (n,): crank angles without the end of the cycle [rad]
    #: shape (n,): inputs, outputs and reactions by name, `driving_torque` [N*m]
    columns: Mapping[str, np.ndarray]
    momentum: Mapping[str, np.ndarray]  #: Rates of momentum of all bodies [N, N*m]
    power_residual: float  #: Largest difference of the powers, over the largest of them [-]


def turn(case: Case) -> OwnTurn:
    """One cycle of a case at its speed of operation."""
    mechanism, omega = own.one_coordinate(case), case.need("operation").speed
    acting = own_gas.pistons(case, mechanism)
    curve, of_curve = own_gas.shaft_curve(case, mechanism, omega)
    period = max(own_gas.period_of(acting), of_curve) * _turns(case)
    n = round(_STEPS_PER_TURN * period / (2 * np.pi))
    phi = np.arange(n) * period / n
    (q,) = mechanism.coordinates
    letters = {q: phi, f"{q}d": np.full(n, omega), f"{q}dd": np.zeros(n)}
    letters |= {name: np.full(n, value) for name, value in own.constants(case).items()}
    for piston in acting:
        letters[piston.input] = letters.get(piston.input, np.zeros(n)) + piston.force(phi)
    if "torque" in case.sections:
        name, sign = own.shaft_input(case, mechanism)
        letters[name] = letters.get(name, np.zeros(n)) + sign * curve(phi)
    given = {name: letters.get(name, np.zeros(n)) for name in mechanism.inputs}
    letters |= given
    _, bias, force = _over(mechanism, "dynamics", letters)
    torque = (bias - force).ravel()
    columns = {**given, "driving_torque": torque}
    columns |= _named(mechanism, "kinematics", letters)
    if "reactions" in mechanism.functions:
        columns |= _named(mechanism, "reactions", letters)
    columns.pop(f"driving_{q}", None)  # the same torque
    _require_closed(case, q, phi, columns)
    momentum = _named(mechanism, "momentum", letters) if "momentum" in mechanism.functions else {}
    return OwnTurn(
        mechanism=mechanism, omega=omega, phi=phi, columns=columns, momentum=momentum,
        power_residual=_residual(mechanism, letters, torque),
    )  # fmt: skip


def _require_closed(case: Case, q: str, phi: np.ndarray, columns: Mapping[str, np.ndarray]) -> None:
    opened = ~np.all([np.isfinite(v) for v in columns.values()], axis=0)
    if opened.any():
        at = f"{q} = {np.degrees(phi[np.argmax(opened)]):.3f} deg"
        raise BadInput(f"{case.file}: the loop opens at {at}: links too short, or a wrong branch; it cannot turn round")


def _turns(case: Case) -> int:
    """Turns of the first coordinate after which a mechanism with loops repeats."""
    found = own.mechanism_of(case)
    if not found.dependents:
        return 1
    from mechsym.mechanisms.loops import along_turn

    return along_turn(found)[1]


def _over(mechanism: Mechanism, group: str, letters: Mapping[str, np.ndarray]) -> list[np.ndarray]:
    function = mechanism.functions[group]
    rows = [letters[name][None, :] for name in function.name_in()]
    n = rows[0].shape[1]
    return [np.broadcast_to(np.asarray(v), (v.shape[0], n)) for v in function.call(rows)]


def _named(mechanism: Mechanism, group: str, letters: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    found = _over(mechanism, group, letters)
    return {n: v.ravel() for n, v in zip(mechanism.functions[group].name_out(), found, strict=True)}


def _residual(mechanism: Mechanism, letters: Mapping[str, np.ndarray], torque: np.ndarray) -> float:
    """Driving power and power of the inputs against what energies and dampers take."""
    (q,) = mechanism.coordinates
    x, u = ca.SX.sym(q), ca.SX.sym(f"{q}d")
    inputs = ca.SX.sym("inputs", len(mechanism.inputs))
    force = mechanism.functions["dynamics"](x, u, *ca.vertsplit(inputs))[2]
    kinetic, potential = mechanism.functions["energy"](x, u)
    passive = ca.substitute(force, inputs, ca.SX.zeros(inputs.shape))
    lost = -(passive + ca.gradient(potential, x)) * u
    stored = ca.jtimes(kinetic + potential, x, u)  # at constant speed
    given = (force - passive) * u
    powers = ca.Function("powers", [x, u, inputs], [stored, lost, given])
    rows = np.vstack([letters[n] for n in mechanism.inputs]) if mechanism.inputs else np.zeros((0, len(torque)))
    parts = [np.asarray(v).ravel() for v in powers(letters[q][None, :], letters[f"{q}d"][None, :], rows)]
    driving = torque * letters[f"{q}d"]
    size = max(float(np.abs(p).max()) for p in (*parts, driving))
    return float(np.abs(driving + parts[2] - parts[0] - parts[1]).max()) / (size or 1.0)


def summary(found: OwnTurn, case: Case) -> dict[str, Any]:
    """The numbers of `mechsym forces`."""
    told = listing(case.mechanism)
    return {
        "case": case.name,
        "mechanism": told["name"],
        "speed_rpm": found.omega / RPM,
        "max": {n: float(v.max()) for n, v in found.columns.items()},
        "min": {n: float(v.min()) for n, v in found.columns.items()},
        "driving_torque_mean": float(found.columns["driving_torque"].mean()),
        "power_residual": found.power_residual,
        "units": units(case),
        "reactions": told["reactions"],
        "friction": own_losses.friction(case, found.mechanism, found.omega, found.phi, found.columns),
        "shaking": own_losses.shaking(found.omega, found.phi, found.momentum) if found.momentum else None,
    }


def units(case: Case) -> dict[str, str]:
    """Units of angle, inputs, outputs, reactions and the driving torque."""
    told = listing(case.mechanism)
    # a joint reaction is a force, or a moment where its name says so
    joints = {name: "N*m" if name.startswith("M_") else "N" for name in told["reactions"]}
    return {"phi": "rad", "driving_torque": "N*m"} | dict(told["inputs"]) | joints | dict(told["outputs"])


def write(found: OwnTurn, case: Case, folder: Path) -> list[Path]:
    """Write the table, the drawing and the page in which it turns."""
    from mechsym.mechanisms import plots
    from mechsym.style import svg

    files = [write_quantities(folder / "forces.csv", {"phi": found.phi, **found.columns}, units(case))]
    shapes = own_drawing.drawn(found.mechanism, listing(case.mechanism))
    if shapes is not None:
        files.append(write_text(folder / "mechanism.svg", svg(plots.figure_of(shapes, np.pi / 3))))
        title = case.about or listing(case.mechanism)["about"] or case.name
        files.append(write_text(folder / "mechanism.html", plots.animation_of(shapes, title)))
    return files
