"""Slider crank, hypocycloid and rodless at equal stroke, reciprocating mass and gas force: loads, shaking, friction.

Equal gas force means the same indicator diagram: equal pressure at equal travel of the piston, so that every mechanism
gets the same work from the gas. Equal pressure at equal crank angle would not: the pistons move differently.
Rods, planets, links and cranks have no mass here, so that only the arrangement differs. The rodless mechanism stands
there with one piston and with four (two on each axis), each under both closing rules: what the guides carry depends on
how the parts give way.
"""

import math
from typing import Any

import numpy as np

from mechsym.cycle.gas import Gas, at_same_travel
from mechsym.cycle.motion import one_cylinder, piston_travel
from mechsym.errors import BadInput
from mechsym.forces.friction import Friction, losses, pistons
from mechsym.forces.harmonics import whole
from mechsym.forces.loads import loads, power_residual
from mechsym.forces.rings import Rings
from mechsym.forces.shaking import shaking
from mechsym.forces.turn import CrankDrive, Turn, at, chain_named, chain_of, crank_drive
from mechsym.mechanisms.chain import Alike
from mechsym.mechanisms.traits import with_chain
from mechsym.quantities import quantity, record


@record
class ComparisonSettings:
    """Section `[comparison]`: what the compared mechanisms need besides the case."""

    #: Crank radius over rod length of the slider crank [-]
    lam: float = quantity("-", default=26 / 90, above=0, below=1, about="crank radius over rod length")
    #: Pressure angle of the hypocycloid's teeth [rad]
    alpha_n: float = quantity("rad", default=math.radians(25), low=0, below=math.pi / 2, about="pressure angle")


def compare(turn: Turn, friction: Friction | None, rings: Rings, settings: ComparisonSettings) -> list[dict[str, Any]]:
    """The mechanisms side by side with the stroke, mass and gas of a machine, which must have gas.

    Parameters
    ----------
    friction : Friction or None
        The same coefficients for all; None leaves friction out

    Returns
    -------
    rows : list of dict
        One a mechanism; forces in N, torque in N*m, `friction_per_piston` in W
    """
    if turn.gas is None:
        raise BadInput("a comparison at equal gas force needs a [cycle]")
    machines = _machines(turn, turn.gas, settings)
    return [_row(name, turn, machine, friction, rings) for name, machine in machines.items()]


def reciprocating_mass(turn: Turn) -> float:
    """Mass that moves with one piston.

    Returns
    -------
    mass : float
        Mass [kg]
    """
    return chain_of(turn.drive).mass(turn.drive)


def _machines(turn: Turn, gas: Gas, settings: ComparisonSettings) -> dict[str, CrankDrive]:
    alike = Alike(
        stroke=gas.chamber.stroke, mass=reciprocating_mass(turn), area=gas.chamber.area, period=gas.pressure.period,
        lam=settings.lam, alpha_n=settings.alpha_n,
    )  # fmt: skip
    peers = [(name, peer) for name in with_chain() for peer in chain_named(name).peers(alike)]
    return {peer.label: crank_drive(name, peer.parameters, peer.faces, peer.closing) for name, peer in peers}


def _row(name: str, turn: Turn, drive: CrankDrive, friction: Friction | None, rings: Rings) -> dict[str, Any]:
    travels = (piston_travel(*one_cylinder(d.name, d.parameters)) for d in (turn.drive, drive))
    machine = at(drive, at_same_travel(turn.gas, *travels) if turn.gas else None, turn.omega, turn.phi)
    found, shake, count = loads(machine), shaking(machine), len(pistons(machine))
    pin = np.hypot(found.pins[0].x, found.pins[0].y)
    main = np.hypot(*found.bearings["main_bearing"])
    row = {
        "mechanism": name,
        "pistons": count,
        "side_force_max": max(float(np.abs(v).max()) for v in found.guides.values()),
        "crank_pin_max": float(pin.max()),
        "crank_pin_mean": float(pin.mean()),
        "main_bearing_max": float(main.max()),
        "tooth_force_max": _tooth_force(machine),
        "torque_max": float(machine.torque.max()),
        "torque_mean": float(machine.torque.mean()),
        "shaking_order_1": _amplitude(shake, 1),
        "shaking_order_2": _amplitude(shake, 2),
        "shaking_rms_after_counterweight": shake.counterweight.rms_after,
        "power_residual": power_residual(machine, found),
    }
    if friction is None:
        return row
    lost = losses(machine, found, friction, rings)
    return row | {
        "friction_per_piston": sum(lost.places.values()) / count,
        "friction_places": {place: power / count for place, power in lost.places.items()},
        "mechanical_efficiency": lost.mechanical_efficiency,
        "friction_mean_pressure": lost.friction_mean_pressure,
    }


def _tooth_force(machine: Turn) -> float | None:
    force = machine.reactions.get("tooth_force")
    return None if force is None else float(np.abs(force).max())


def _amplitude(shake: Any, order: int) -> float:
    return max(abs(whole(shake.orders[n], order)) for n in ("force_x", "force_y"))
