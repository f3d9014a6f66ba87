"""The kinds of Stirling cycle, one function from a record of `[cycle]` to the turn of its engine, and its pressure."""

import math
from typing import Any

import numpy as np
import scipy

from mechsym.cycle.kinds.schmidt import Schmidt, schmidt_turn
from mechsym.cycle.kinds.stirling_second_order import SecondOrder, StirlingLosses, second_order
from mechsym.cycle.kinds.stirling_spaces import StirlingCylinders, Travel, five_spaces, swept
from mechsym.cycle.kinds.stirling_turn import StirlingTurn, turn
from mechsym.cycle.pressure import Pressure, periodic
from mechsym.errors import BadInput
from mechsym.quantities import record

_STEPS = 64  # between two cuts, for a pressure that is read at any angle
_FACTS = {
    "schmidt": "the gas is isothermal in each space (Schmidt); losses are left out, the work is an upper bound",
    "stirling-adiabatic": "the working spaces are adiabatic, the exchangers ideal: losses are left out",
    "stirling-second-order": "adiabatic working spaces at the gas temperatures that the films leave at this speed; the "
    "losses are no part of the pressure",
}


@record
class StirlingAdiabatic(StirlingCylinders):
    """Section `[cycle]`, `kind = "stirling-adiabatic"`."""


@record
class StirlingSecondOrder(StirlingCylinders):
    """Section `[cycle]`, `kind = "stirling-second-order"`; `[stirling]` has the exchangers and the seal."""


@record
class StirlingEngine:
    """A Stirling engine over one turn."""

    kind: str
    turn: StirlingTurn
    losses: SecondOrder | None = None  #: What it loses at its speed, where the kind knows it


def stirling_engine(
    cycle: StirlingCylinders, travels: tuple[Travel, Travel], omega: float, losses: StirlingLosses | None
) -> StirlingEngine:
    """The turn of an engine.

    Parameters
    ----------
    travels : tuple of callable
        Shaft angle, CasADi symbol [rad], to the travel of piston 1 and 2 [m]
    omega : float
        Shaft speed, which only the second order sees [rad/s]
    losses : StirlingLosses, optional
        Section `[stirling]`, which the second order needs
    """
    volumes = swept(cycle, travels)
    if isinstance(cycle, Schmidt):
        return StirlingEngine(kind="schmidt", turn=schmidt_turn(five_spaces(cycle, volumes)))
    if isinstance(cycle, StirlingAdiabatic):
        return StirlingEngine(kind="stirling-adiabatic", turn=turn(five_spaces(cycle, volumes), _STEPS))
    if losses is None:
        raise BadInput("[cycle] of kind 'stirling-second-order' needs section [stirling]: exchangers, seal, buffer")
    found = second_order(cycle, losses, volumes, omega)
    return StirlingEngine(kind="stirling-second-order", turn=found.turn, losses=found)


def stirling_pressure(engine: StirlingEngine) -> Pressure:
    """Pressure over the shaft angle, by cubics with the exact slopes."""
    found = engine.turn
    once = np.append(True, np.diff(found.phi) > 0)  # a cut stands twice among the nodes
    curve = scipy.interpolate.CubicHermiteSpline(found.phi[once], found.p[once], found.dp_dphi[once])
    best = int(np.argmax(found.p))
    return Pressure(
        kind=engine.kind,
        period=2 * math.pi,
        kinks=tuple(sorted(found.cuts.tolist())),
        absolute=periodic(curve, 2 * math.pi, float(found.phi[0])),
        p_max=float(found.p[best]),
        phi_p_max=float(math.remainder(found.phi[best], 2 * math.pi)),
        mean_indicated=found.mean_indicated,
        facts=(_FACTS[engine.kind],),
    )


def stirling_columns(engine: StirlingEngine, omega: float) -> dict[str, Any]:
    """Figures of one turn under the names of `mechsym cycle`; `losses` is a mapping [W]."""
    found, per_second = engine.turn, omega / (2 * math.pi)
    second = engine.losses
    power = found.work * per_second if second is None else second.power
    heat_in = found.heat_in * per_second if second is None else second.heat_in
    figures = {
        "torque_avg": power / omega, "power_kw": power / 1e3, "mep_kpa": found.mean_indicated / 1e3,
        "sfc_g_kwh": math.nan, "efficiency": _share(power, heat_in), "p_max_mpa": float(found.p.max()) / 1e6,
        "p_max_angle_deg": math.degrees(math.remainder(float(found.phi[np.argmax(found.p)]), 2 * math.pi)),
        "energy_residual": found.residual, "work_j": found.work, "work_hot_j": found.sums["W_e"],
        "work_cold_j": found.sums["W_c"], "heat_in_j": found.heat_in,
        "heat_out_j": -found.sums["Q_k"] - found.sums["Q_c"],
        "heat_regenerator_j": float(np.ptp(found.stored)),
        "indicated_efficiency": _share(found.work, found.heat_in), "heat_in_kw": heat_in / 1e3, "gas_kg": found.mass,
    }  # fmt: skip
    temperatures = {
        f"T_{side}_{name}_k": float(getattr(curve, name)())
        for side, curve in (("e", found.T_e), ("c", found.T_c)) for name in ("min", "max")
    }  # fmt: skip
    if second is not None:
        temperatures |= {"T_h_k": second.T_h, "T_k_k": second.T_k, "regenerator_effectiveness": second.effectiveness}
        flow = sum(lost for name, lost in second.work_losses.items() if name.startswith("flow_"))
        figures |= {"flow_share": _share(flow, found.work * per_second), "screen_reynolds": second.screen_reynolds,
                    "seal_reynolds": second.seal_reynolds}  # fmt: skip
    losses = {} if second is None else second.work_losses | {f"{k}_heat": v for k, v in second.heat_losses.items()}
    return figures | temperatures | {"losses": losses}


def _share(part: float, whole: float) -> float:
    """nan where there is nothing to take a share of: a machine that is driven takes no heat from its hot side."""
    return part / whole if whole > 0 else math.nan
