"""The forces of a turn in numbers: largest and smallest, orders, losses, claims."""

import dataclasses
import math
from typing import Any

from mechsym.forces import claims, textbook
from mechsym.forces.friction import Losses
from mechsym.forces.harmonics import Harmonics
from mechsym.forces.loads import power_residual
from mechsym.forces.result import Forces
from mechsym.forces.shaking import Shaking
from mechsym.forces.table import angle_of_largest, extremes
from mechsym.forces.turn import Turn, chain_named, pushes
from mechsym.mechanisms.traits import with_chain

_FIRST_ORDER = 0.9  # below this efficiency the frictionless reactions are no longer good for friction
_RAW = ("phi", "x", "psi", "R_", "two_mass", "terskih")  # motion, reactions that have a name besides, chains


def summary(found: Forces, case: str, source: str = "") -> dict[str, Any]:
    """The result under the names of the command line.

    Parameters
    ----------
    case, source : str
        Name of the case, and the source whose engine it is: only the claims of that source are judged

    Returns
    -------
    summary : dict
        `max`, `min`, `power_residual`, `angle_of_max_deg`, `torque_orders`, `shaking`, `friction`, `two_mass`,
        `weight`, `rodless`, `unbalanced`, `comparison`, `claims`, `facts`; what a mechanism does not have is null
    """
    one = found.turn
    largest, smallest = extremes(found.columns)
    angles = {k: angle_of_largest(one.phi, v) for k, v in found.columns.items() if k != "phi_deg"}
    return {
        "case": case,
        "mechanism": one.drive.name,
        "speed_rpm": one.omega * 30 / math.pi,
        "max": largest,
        "min": smallest,
        "angle_of_max_deg": angles,
        "power_residual": power_residual(one, found.loads),
        "torque_mean": float(one.torque.mean()),
        "torque_orders": _order_table(found.torque_orders),
        "shaking": _shaking(found.shaking),
        "friction": None if found.losses is None else _friction(found.losses),
        "two_mass": _two_mass(found) or None,
        "weight": textbook.weight_shares(one) if found.chains else None,
        **_told(one),
        "balance": {"reached": not found.unbalanced, "reasons": found.unbalanced},
        "comparison": found.comparison,
        "claims": [row for row in _claims(found) if row["source"] == source],
        "facts": _facts(found),
    }


def quantities(numbers: dict[str, Any]) -> list[str]:
    """Columns that a reader wants to see the extremes of.

    Returns
    -------
    names : list of str
        Without motion, raw reactions and the printed chains
    """
    return [name for name in numbers["max"] if not name.startswith(_RAW)]


def _order_table(found: Harmonics) -> dict[str, list[float]]:
    return {"order": found.order.tolist(), "amplitude": found.amplitude.tolist(), "phase": found.phase.tolist()}


def _shaking(found: Shaking) -> dict[str, Any]:
    counterweight = dataclasses.asdict(found.counterweight)
    angle = counterweight.pop("angle")
    return {
        "orders": {name: _order_table(values) for name, values in found.orders.items()},
        "counterweight": counterweight | {"angle_deg": math.degrees(angle)},
        "planes": [{"z": p.z, "unbalance": p.unbalance, "angle_deg": math.degrees(p.angle)} for p in found.planes],
    }


def _friction(found: Losses) -> dict[str, Any]:
    return {
        "power": sum(found.places.values()),
        "places": found.places,
        "indicated_power": found.indicated_power,
        "mechanical_efficiency": found.mechanical_efficiency,
        "friction_mean_pressure": found.friction_mean_pressure,
    }


def _two_mass(found: Forces) -> dict[str, dict[str, float]]:
    return {name: textbook.errors(found.turn, chain) for name, chain in found.chains.items()}


def half(found: Forces) -> bool:
    """Whether the turn is that of one piston of two that share a chamber."""
    gas = found.turn.gas
    return gas is not None and len(pushes(found.turn.drive, gas, found.turn.phi[:1])) < gas.chamber.pistons


def _facts(found: Forces) -> list[str]:
    gas, lost = found.turn.gas, found.losses
    facts = list(gas.pressure.facts) if gas else ["no gas acts: the case has no [cycle]"]
    if half(found):
        facts.append("loads, torque and friction are those of one piston with its crank; the engine has two of them")
    if lost is not None and lost.mechanical_efficiency is not None and lost.mechanical_efficiency < _FIRST_ORDER:
        share = 100 * (1 - lost.mechanical_efficiency)
        facts.append(f"friction takes {share:.3g} %: first order only, it would change the reactions by about as much")
    return facts


def _claims(found: Forces) -> list[dict[str, str]]:
    judged = [] if found.comparison is None else claims.claims(found.comparison)
    if found.chains:
        efficiency = None if found.losses is None else found.losses.mechanical_efficiency
        judged.append(claims.left_out(textbook.weight_shares(found.turn), efficiency))
    return judged


def _told(one: Turn) -> dict[str, Any]:
    """What only some mechanisms have to tell, by their names; null where it is another that turns."""
    known = {name: told for name in with_chain() if (told := chain_named(name).told) is not None}
    return {name: told(one) if one.drive.name == name else None for name, told in known.items()}
