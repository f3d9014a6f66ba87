"""Case -> case with the scavenge pressure and trapped temperature that its turbocharger gives it."""

import functools
from dataclasses import replace
from typing import Any

import numpy as np

from mechsym.cases import Case
from mechsym.cycle.breathing.marine import ScavengeState, scavenge, with_charge
from mechsym.cycle.breathing.scavenging import Scavenging
from mechsym.cycle.dead_centres import chamber_over
from mechsym.cycle.gas import Gas
from mechsym.cycle.kinds import kind_of
from mechsym.cycle.kinds.two_stroke import TwoStrokeMarine
from mechsym.cycle.motion import one_cylinder, piston_travel
from mechsym.errors import BadInput
from mechsym.jobs.starts import guesses
from mechsym.quantities import RPM
from mechsym.quantities.display import quantity_text


def follows(case: Case) -> bool:
    """Whether the turbocharger of a case says what its scavenge pressure is; a measured diagram needs none."""
    section, cycle = case.sections.get("scavenging"), case.sections.get("cycle")
    return section is not None and section.source == "turbocharger" and not (cycle and kind_of(cycle).measured)


def scavenged(case: Case, omega: float | None = None) -> tuple[Case, ScavengeState | None]:
    """The case with p_s and T_evc from its turbocharger, and how that runs; unchanged and None where both are given.

    Parameters
    ----------
    omega : float, optional
        Crank speed, else that of operation [rad/s]

    Raises
    ------
    BadInput
        Another kind of cycle, or no balance
    """
    if not follows(case):
        return case, None
    cycle, speed = case.need("cycle"), case.need("operation").speed if omega is None else omega
    if not isinstance(cycle, TwoStrokeMarine):
        raise BadInput(f"{case.file}: [scavenging] belongs to a cycle of kind two-stroke-marine; leave it out, or set "
                       "scavenging.source = 'given'")  # fmt: skip
    section: Scavenging = case.need("scavenging")
    known = case.mechanism, case.need("parameters"), tuple(guesses(case).items())
    try:
        state = _balance(section, cycle, *known, float(speed))
    except BadInput as error:
        raise BadInput(f"{case.file}: {error}") from None
    there = with_charge(cycle, state.p_s, state.T_evc)
    return replace(case, sections={**case.sections, "cycle": there}), state


@functools.lru_cache(maxsize=64)
def _balance(
    section: Scavenging, cycle: TwoStrokeMarine, mechanism: str, parameters: Any, guesses: tuple[Any, ...], omega: float
) -> ScavengeState:
    name, seen = one_cylinder(mechanism, parameters)
    room = chamber_over(piston_travel(name, seen, dict(guesses)), cycle.bore, cycle.compression_ratio)
    return scavenge(section, cycle, room, omega)


def told(found: Gas, state: ScavengeState | None) -> Gas:
    """The gas with what its turbocharger does among its facts."""
    if state is None:
        return found
    pressure = found.pressure
    return replace(found, pressure=replace(pressure, facts=(*pressure.facts, *facts(state))))


def facts(state: ScavengeState) -> tuple[str, ...]:
    """How the turbocharger runs, in sentences."""
    return (
        f"turbocharger: scavenge air {quantity_text(state.p_s, 'Pa', 4)} and {state.T_s:.0f} K, before the turbine "
        f"{quantity_text(state.p_r, 'Pa', 4)} and {state.T_r:.0f} K, compressor ratio {state.ratio:.2f}",
        f"scavenging: {state.delivery:.2f} times the cylinder's volume of air, {100 * state.residual:.0f} % stays "
        f"burnt gas; the exhaust closes on {state.T_evc:.0f} K",
        f"mean-value balance: mass closed to {state.mass_residual:.1g}, energy to {state.energy_residual:.1g}",
    )


def columns(states: list[ScavengeState], omega: np.ndarray) -> dict[str, Any]:
    """What `mechsym cycle` shows of the turbocharger and, with the fuel known, of the fuel, of one cylinder.

    Parameters
    ----------
    omega : ndarray, shape (n,)
        Crank speeds [rad/s]
    """
    rows = [_row(state) for state in states]
    found: dict[str, Any] = {name: np.array([row[name] for row in rows]) for name in rows[0]}
    heat, work = found.pop("heat"), found["efficiency"]
    shares = {"heat": heat, "work": work, "exhaust": 1 - heat - work, "unburnt": np.zeros(len(rows))}
    return {"speed_rpm": omega / RPM} | found | {"fractions": shares}


def _row(s: ScavengeState) -> dict[str, float]:
    row = {
        "sfc_g_kwh": 3.6e9 * s.fuel / s.indicated, "efficiency": s.indicated / s.heat, "heat": s.walls / s.heat,
        "p_in_kpa": s.p_s / 1e3, "t_in_k": s.T_s, "p_out_kpa": s.p_r / 1e3, "t_turbine_k": s.T_r, "t_evc_k": s.T_evc,
        "delivery_ratio": s.delivery, "residual_gas": s.residual, "compressor_ratio": s.ratio,
        "air_kg_h": s.air * 3600, "energy_residual": s.energy_residual, "mass_residual": s.mass_residual,
    }  # fmt: skip
    return row if s.dew is None else row | {"dew_margin_k": s.T_s - s.dew}
