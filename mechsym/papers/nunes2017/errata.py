"""What the proven slips of the thesis's engine model cost, computed: the numbers behind its errata E2 to E8, E20, E23.

Each function gives one erratum's figures by name; `errata` gives all of them under the erratum's number.
"""

from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np

from mechsym.cases import load
from mechsym.cycle.chamber import chamber, piston_force
from mechsym.cycle.closed.model import ClosedEngine
from mechsym.cycle.closed.performance import Performance
from mechsym.cycle.columns import crossovers
from mechsym.cycle.engine import over_speeds
from mechsym.cycle.kinds.printed import March, marched
from mechsym.jobs.cycle import engine, speed_range
from mechsym.quantities import RPM

_PRINTED = {"cycle.method": "nunes2017_printed"}
_MAXIMA = np.array([5400.0, 6700.0])  # published speeds of the largest average torque [rpm]
_CV, _T0 = 718.0, 288.15
# the thesis's own parts on the cylinder axis: piston, crankpin and webs (.4159 - 2 * .0908), two bearings HK2516
_RECIPROCATING = 0.2947 + (0.4159 - 2 * 0.0908) + 0.050


def errata() -> dict[str, dict[str, float]]:
    """All figures by erratum. Returns errata: `E2`, `E3`, .. to name and value; units stand in the names."""
    functions: dict[str, Callable[[], dict[str, float]]] = {
        "E2": one_piston, "E3": unburnt_share, "E4": vapour_energy, "E5": lost_burn, "E6": averages,
        "E7": engine_torque, "E8": rod_length, "E20": reciprocating_mass, "E23": back_pressure,
    }  # fmt: skip
    return {name: function() for name, function in functions.items()}


def one_piston() -> dict[str, float]:
    """E2: compression ratio of the clearance with one piston only, as eqs. (2.60) and (2.71) print it [-]."""
    machine = _engine("nunes-slider-crank")
    room = chamber(machine.chamber, machine.motion)
    return {"compression_ratio": float(1 + room.area * room.stroke / room.clearance)}


def unburnt_share() -> dict[str, float]:
    """E3: the remainder that the thesis calls unburnt, and the share that is, of the fuel's energy [-]."""
    (machine, result), performance = _marched("nunes-slider-crank"), _figures("nunes-slider-crank")
    fuel = result.fuel * machine.cycle.heating_value
    share = 1 - result.heat_released.sum(axis=0) / fuel
    excess = performance.unburnt - share
    return {
        "remainder_min": float(performance.unburnt.min()), "remainder_max": float(performance.unburnt.max()),
        "unburnt_min": float(share.min()), "unburnt_max": float(share.max()),
        "excess_min": float(excess.min()), "excess_max": float(excess.max()),
        "vapour_energy": float(result.fuel * _CV * _T0 / fuel),
        "first_law_residual": float(np.abs(performance.energy_residual).max()),
    }  # fmt: skip


def vapour_energy() -> dict[str, float]:
    """E4: the vapour's mass enters without its energy; the march with the latent heat less c_v T_0 instead.

    Returns figures: largest pressures [MPa] and relative change of the largest torque [-].
    """
    latent = {"cycle.latent_heat": f"{4e5 - _CV * _T0} J/kg"}
    figures = {}
    for name in ("slider-crank", "hypocycloid"):
        before, after = _figures(f"nunes-{name}"), _figures(f"nunes-{name}", latent)
        figures[f"p_max_mpa {name}"] = float(after.p_max.max() / 1e6)
        figures[f"torque_max_change {name}"] = float(after.torque_max.max() / before.torque_max.max() - 1)
        figures[f"torque_avg_change {name}"] = float(np.abs(after.torque_avg / before.torque_avg - 1)[199:].max())
    return figures


def lost_burn() -> dict[str, float]:
    """E5: burn of the last broken degree, which the grid cuts off.

    Returns figures: largest loss [-], period of the saw-tooth [rpm], end of burn at the published maxima [deg].
    """
    machine, result = _marched("nunes-slider-crank")
    complete = 1 - np.exp(-machine.cycle.wiebe_a)
    efficiency = 0.9 * (-1.6082 + 4.6509 - 2.0764)
    burnt = result.heat_released.sum(axis=0) / (result.fuel * machine.cycle.heating_value)
    ends = 350.93 - 0.0004 * _MAXIMA + 30.663 + 0.0027 * _MAXIMA
    return {
        "largest_loss": float((efficiency * complete - burnt).max()),
        "period_rpm": 1 / (0.0027 - 0.0004),
        **{f"end_of_burn_{speed:.0f}": float(end) for speed, end in zip(_MAXIMA, ends, strict=True)},
    }


def averages() -> dict[str, float]:
    """E6: 721 for 720 points, 6.28 for 2 pi, and how well the sum of torques gives the work [-]."""
    (_, result), performance = _marched("nunes-slider-crank"), _figures("nunes-slider-crank")
    work = np.sum((result.p[1:] + result.p[:-1]) / 2 * np.diff(result.v)[:, None], axis=0)
    from_torque = performance.torque_avg * 721 / 720 * 4 * np.pi
    return {
        "points": 720 / 721 - 1,
        "two_pi": 6.28 / (2 * np.pi) - 1,
        "torque_sum_against_work": float(np.abs(from_torque / work - 1)[49:].max()),
    }


def engine_torque() -> dict[str, float]:
    """E7: largest torque of both pistons, in phase [N*m]; the printed peak is one's, the average both's."""
    return {
        f"torque_max {name}": float(2 * _figures(f"nunes-{name}").torque_max.max())
        for name in ("slider-crank", "hypocycloid")
    }


def rod_length() -> dict[str, float]:
    """E8: crossover speed with the rod of table 3.2 and with the rod that chapter 5 must have used [rpm]."""
    other = _figures("nunes-hypocycloid")
    figures = {}
    for rod in (90, 74):
        half = f"{rod / 2} mm"
        own = _figures("nunes-slider-crank", {"parameters.l1": half, "parameters.l2": half})
        speed = own.omega / RPM
        figures[f"crossover_rpm {rod} mm"] = float(crossovers(speed, own.torque_avg, other.torque_avg)[-1])
    return figures


def reciprocating_mass() -> dict[str, float]:
    """E20: forces at 8000 rpm with the mass of the parts that the thesis itself puts on the cylinder axis.

    Returns figures: mass [kg], largest force and force at exhaust dead centre [N], largest reversed tooth load [N].
    """
    figures = {"mass_kg": _RECIPROCATING}
    for label, mass in (("as printed", 0.250), ("own parts", _RECIPROCATING)):
        machine, result = _marched("nunes-hypocycloid", {"parameters.m3": f"{mass} kg"})
        room = chamber(machine.chamber, machine.motion)
        phi = np.radians(result.theta_deg - 360.0)
        force = piston_force(room, phi, result.omega[-1], result.p[:, -1])
        exhaust = piston_force(room, phi, result.omega[-1], machine.cycle.intake_pressure)
        figures[f"force_max {label}"] = float(force.max())
        figures[f"force_at_exhaust_tdc {label}"] = float(exhaust[180])
        figures[f"tooth_load_reversed {label}"] = float((exhaust * np.sin(phi))[180:].min())
    return figures


def back_pressure() -> dict[str, float]:
    """E23: absolute pressure taken as the net pressure on the piston.

    Returns figures: surplus force [N], largest torques with the atmosphere on the piston's back [N*m].
    """
    machine = _engine("nunes-slider-crank")
    figures = {"surplus_force": 101325 * np.pi / 4 * machine.chamber.bore**2}
    for name in ("slider-crank", "hypocycloid"):
        performance = _figures(f"nunes-{name}", {"chamber.back_pressure": "101325 Pa"})
        figures[f"torque_max {name}"] = float(performance.torque_max.max())
    return figures


def _engine(case: str, changes: dict[str, str] | None = None) -> ClosedEngine:
    return engine(load(case, {**_PRINTED, **(changes or {})}))


def _marched(case: str, changes: dict[str, str] | None = None) -> tuple[ClosedEngine, March]:
    machine = _engine(case, changes)
    return machine, marched(machine, _speeds(case))


def _figures(case: str, changes: dict[str, str] | None = None) -> Performance:
    return _figures_once(case, tuple((changes or {}).items()))


@cache
def _figures_once(case: str, changes: tuple[tuple[str, str], ...]) -> Performance:
    # several claims ask for the same run, and none for the loads of joints
    machine = _engine(case, dict(changes))
    return over_speeds(replace(machine, motion=replace(machine.motion, loads=None)), _speeds(case))


def _speeds(case: str) -> np.ndarray:
    return speed_range(load(case).need("speeds"))
