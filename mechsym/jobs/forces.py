"""The whole job: case -> turn -> loads -> chain, shaking, orders, friction -> one record, and its summary."""

import dataclasses
import math
from typing import Any

import numpy as np

from mechsym import mechanisms
from mechsym.cases import Case
from mechsym.forces import claims, textbook
from mechsym.forces.comparison import ComparisonSettings, compare
from mechsym.forces.friction import Losses, losses
from mechsym.forces.harmonics import Harmonics, orders
from mechsym.forces.loads import Loads, loads, power_residual
from mechsym.forces.rings import NoRings
from mechsym.forces.shaking import Shaking, shaking, verdict
from mechsym.forces.table import angle_of_largest, columns, extremes
from mechsym.forces.turn import Turn, turn
from mechsym.mechanisms import constraints
from mechsym.quantities import record

_FIRST_ORDER = 0.9  # below this efficiency the frictionless reactions are no longer good for friction
_RAW = ("phi", "x", "psi", "R_", "two_mass", "terskih")  # motion, reactions that have a name besides, chains


@record
class Forces:
    """Everything that `mechsym forces` reports of a case."""

    turn: Turn
    loads: Loads
    columns: dict[str, np.ndarray]  #: shape (n,): The table `forces.csv`
    torque_orders: Harmonics
    shaking: Shaking  #: Forces and moments on the frame
    losses: Losses | None  #: Friction, where the case has coefficients
    chains: dict[str, textbook.Chain]  #: For a slider crank: rod as two masses, and Terskih's rule
    unbalanced: list[str]  #: Why balance that was asked for is not reached
    comparison: list[dict[str, Any]] | None


def forces(case: Case, comparison: bool = False) -> Forces:
    """Forces of a case over one cycle at constant speed.

    Parameters
    ----------
    case : Case
        See `turn`; `[friction]`, `[rings]`, `[shaking]` and `[comparison]` are read where they stand
    comparison : bool
        Whether the mechanisms are put side by side as well
    """
    one = turn(case)
    found = loads(one)
    shake = shaking(one)
    friction, rings = case.sections.get("friction"), case.sections.get("rings", NoRings())
    settings = case.sections.get("comparison", ComparisonSettings())
    wanted = case.sections.get("shaking")
    chains = _chains(one)
    table = columns(one, found)
    for name, chain in chains.items():
        table |= {f"{name}_{f.name}": getattr(chain, f.name) for f in dataclasses.fields(chain)}
    return Forces(
        turn=one,
        loads=found,
        columns=table,
        torque_orders=orders(one.torque, one.period),
        shaking=shake,
        losses=losses(one, found, friction, rings) if friction else None,
        chains=chains,
        unbalanced=verdict(one, shake, wanted) if wanted else [],
        comparison=compare(one, friction, rings, settings) if comparison else None,
    )


def _chains(one: Turn) -> dict[str, textbook.Chain]:
    if one.case.mechanism not in ("crosshead", "crank_throw"):
        return {}
    rod = textbook.slider_crank(one)
    ratios = {"two_mass": rod.L_m / rod.L, "terskih": textbook.terskih(one.omega)}
    return {name: textbook.chain(one, ratio) for name, ratio in ratios.items()}


def summary(found: Forces) -> dict[str, Any]:
    """The result under the names of the command line.

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
        "case": one.case.name,
        "mechanism": one.case.mechanism,
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
        "rodless": _rodless(one) if one.case.mechanism == "rodless" else None,
        "balance": {"reached": not found.unbalanced, "reasons": found.unbalanced},
        "comparison": found.comparison,
        "claims": _claims(found),
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


def _facts(found: Forces) -> list[str]:
    gas, lost = found.turn.gas, found.losses
    facts = list(gas.facts) if gas else ["no gas acts: the case has no [cycle]"]
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


def _rodless(one: Turn) -> dict[str, Any]:
    p = one.case.need("parameters")
    rigid = mechanisms.build("rodless_constraints", p)
    solution = constraints.solve(rigid, constraints.close(rigid, {"alpha": 0.6, "alphad": one.omega}))
    # of link, sliders and pistons; the crank's own unbalance is there to balance it
    rate = one.momentum["momentum_rate_x"] + 1j * one.momentum["momentum_rate_y"]
    in_crank = -rate * np.exp(-1j * one.phi) - p.u1 * one.omega**2
    size, wandering = np.abs(in_crank), np.abs(np.angle(in_crank)).max()
    rule = one.case.need("closing")
    return {
        "constraint_rank": solution.rank,
        "constraint_count": solution.count,
        "closing_rule": type(rule).__name__,
        "inertia_resultant_max": float(size.max()),
        "inertia_resultant_min": float(size.min()),
        "resultant_off_crank_deg": math.degrees(float(wandering)),
    }
