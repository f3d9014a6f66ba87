"""Figures of an engine whose pistons move differently: of each by itself, and what they give together.

The cycle of the case stands over every piston, with its bore and its compression ratio. Torques, powers and air add up;
pressures referred to the swept volume are weighted by it, shares of the fuel's heat by the heat, consumptions by the
power. Of what is limited, and of residuals, the largest is told; the largest torque is that of the whole mechanism.
"""

from typing import Any

import numpy as np

from mechsym.cases import Case
from mechsym.cycle.breathing import engine as breathing_engine
from mechsym.cycle.engine import columns, over_design
from mechsym.cycle.figures import cylinder_columns
from mechsym.cycle.friction import Friction
from mechsym.cycle.kinds import kind_of
from mechsym.errors import BadInput
from mechsym.jobs.gas import breathing_with, engine_with, of
from mechsym.jobs.scavenge import follows
from mechsym.jobs.starts import guesses
from mechsym.jobs.whole_engine import largest_torque, piston_travels

_ADD = ("torque_avg", "power_kw", "brake_torque", "brake_power_kw", "air_kg_h")
_BY_VOLUME = ("mep_kpa", "friction_mep_kpa", "pumping_mep_kpa", "volumetric_efficiency")
_BY_HEAT = ("efficiency", "brake_efficiency")
_BY_POWER = {"sfc_g_kwh": "power_kw", "brake_sfc_g_kwh": "brake_power_kw"}
_RESIDUALS = ("energy_residual", "mass_residual")
_ONLY = ("speed_rpm", "fractions", "loads")  # of every piston the same, or put together by itself


def unlike_pistons(case: Case, omega: np.ndarray, friction: Friction) -> dict[str, Any]:
    """Figures of an engine from a file whose pistons do not move alike.

    Parameters
    ----------
    omega : ndarray, shape (n,)
        Crank speeds [rad/s]

    Returns
    -------
    figures : dict
        As `mechsym.jobs.cycle`, with `pistons`: the figures of each by its name in the declaration

    Raises
    ------
    BadInput
        Pistons that share a chamber, or gas that a turbocharger changes
    """
    if getattr(case.sections.get("chamber"), "pistons", 1) != 1 or follows(case):
        raise BadInput(
            f"{case.file}: the pistons move differently: the figures of each hold with a chamber and an inlet of its "
            "own; set chamber.pistons = 1 and leave out [scavenging], or use 'mechsym simulate'"
        )
    travels = piston_travels(case)
    rows = {name: _of_piston(case, omega, friction, number) for number, name in enumerate(travels)}
    swept = np.array([np.ptp(travel) for travel in travels.values()])
    found = {"speed_rpm": next(iter(rows.values()))["speed_rpm"], **_together(list(rows.values()), swept)}
    found["torque_max"] = largest_torque(case, omega)
    alone = {name: {k: v for k, v in row.items() if k not in _ONLY} for name, row in rows.items()}
    return found | {"loads": {}, "cylinders": len(rows), "per_cylinder": {}, "pistons": alone}


def _of_piston(case: Case, omega: np.ndarray, friction: Friction, number: int) -> dict[str, Any]:
    cycle = case.need("cycle")
    with of(case):
        if kind_of(cycle).given == "engine":
            return columns(over_design(engine_with(case, friction, number), {"omega": omega}))
        if kind_of(cycle).given == "breathing":
            run = breathing_engine.run(breathing_with(case, friction, number), omega.tolist())
            return breathing_engine.figures(run)
        return cylinder_columns(cycle, case.mechanism, case.need("parameters"), omega, guesses(case), number)


def _together(rows: list[dict[str, Any]], swept: np.ndarray) -> dict[str, Any]:
    """Figures of the engine from those of its pistons and what each sweeps [m]."""
    stacked = {k: np.array([row[k] for row in rows]) for k in rows[0] if k not in _ONLY}
    power = stacked["power_kw"]
    with np.errstate(divide="ignore", invalid="ignore"):
        heat = power / stacked["efficiency"]  # nan without fuel
    weights = dict.fromkeys(_BY_VOLUME, np.broadcast_to(swept[:, None], power.shape))
    weights |= dict.fromkeys(_BY_HEAT, heat) | {k: stacked[by] for k, by in _BY_POWER.items() if by in stacked}
    highest = np.argmax(stacked["p_max_mpa"], axis=0)
    found: dict[str, Any] = {}
    for name, values in stacked.items():
        if name in _ADD:
            found[name] = values.sum(axis=0)
        elif name in weights:
            found[name] = _mean(values, weights[name])
        elif name == "p_max_angle_deg" or name in _RESIDUALS:
            place = highest if name == "p_max_angle_deg" else np.argmax(np.abs(values), axis=0)
            found[name] = np.take_along_axis(values, place[None, :], axis=0)[0]
        else:
            found[name] = values.max(axis=0)
    shares = rows[0]["fractions"]
    found["fractions"] = {k: _mean(np.array([row["fractions"][k] for row in rows]), heat) for k in shares}
    return found


def _mean(values: np.ndarray, weights: np.ndarray) -> np.ndarray:
    return (values * weights).sum(axis=0) / weights.sum(axis=0)
