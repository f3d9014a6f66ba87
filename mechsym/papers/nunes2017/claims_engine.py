"""What decides the claims of source 004, chapters 3 and 5: parameters, torque, remainder, crossover."""

import math

import numpy as np

from mechsym.audit.entries import Decided
from mechsym.papers.nunes2017 import errata
from mechsym.papers.nunes2017.claims_record import against, peaks
from mechsym.quantities import dimension

# table 3.1: speed [rpm], and its two columns as headed [deg]
_SPEED = (1200, 2400, 3600, 4800, 6000, 7600, 9200)
_DURATION = (352, 348, 350, 349, 346, 349, 347)
_START = (32, 41, 39, 44, 44, 51, 56)


def displacement() -> Decided:
    """Bore and stroke against the displacement of the text."""
    volume = math.pi * 0.060**2 / 4 * 0.104
    return against(2.9405e-5, volume, (
        f"{volume:.4e} m^3, the 294.05 cc beside it; the 2.86e-5 m^3 (286 cc) of section 3.1 have the same slip"
    ))  # fmt: skip


def combustion_columns() -> Decided:
    """Straight lines through the columns of table 3.1.

    Returns
    -------
    decided : Decided
        They are (3.2) and (3.1) the other way round
    """
    lines = [np.polyfit(_SPEED, column, 1) for column in (_DURATION, _START)]
    shift = (lines[0][0] + 0.0004) * 8000
    return Decided(
        supported=False,
        note="the columns are exchanged: the one headed duration gives "
        f"{lines[0][1]:.2f} {lines[0][0]:+.3e} N, which is the start (3.1), the other {lines[1][1]:.2f} "
        f"{lines[1][0]:+.3e} N, the duration (3.2); rounding the first slope moves the start by {-shift:.2f} degrees "
        "at 8000 rpm",
    )


def heat_capacity_ratio() -> Decided:
    """The unit of a ratio of two heat capacities."""
    return Decided(supported=dimension("-") == dimension("J/kg/K"), note="a ratio has no unit, by (2.2)")


def peak_torque() -> Decided:
    """Both cranks' torque."""
    found = errata.engine_torque()
    crank, hypo = found["torque_max slider-crank"], found["torque_max hypocycloid"]
    return against(276.255, crank, (
        "the peaks are those of one piston, the averages those of both; the pistons run in phase, so the engine's "
        f"peaks are {crank:.1f} and {hypo:.1f} N m"
    ))  # fmt: skip


def unburnt() -> Decided:
    """The remainder of the shares against the fuel that is not released."""
    found = errata.unburnt_share()
    closes = "closes" if found["first_law_residual"] < 1e-12 else "does not close"
    return against(found["remainder_max"], found["unburnt_max"], (
        f"0.141 to 0.144 is what the other shares leave; 1 - Q_R/E_f is {found['unburnt_min']:.4f} to "
        f"{found['unburnt_max']:.4f} (the first law of the march {closes}); the rest, {found['excess_min']:.4f} to "
        f"{found['excess_max']:.4f}, is the internal energy that fuel vapour takes from the gas, "
        f"{found['vapour_energy']:.4f} at most"
    ))  # fmt: skip


def vapour_charge() -> Decided:
    """The march with vapour that brings its internal energy."""
    found = errata.vapour_energy()
    crank, hypo = found["p_max_mpa slider-crank"], found["p_max_mpa hypocycloid"]
    return against(9.604, hypo, (
        "by (3.4) with (3.8) the gas pays the latent heat and the vapour's internal energy; with the vapour charged "
        f"with c_v T_0 the largest pressures are {crank:.3f} MPa for 9.188 and {hypo:.3f} MPa for 9.604, the largest "
        f"torques rise by {100 * found['torque_max_change hypocycloid']:.1f} %, the averages by less than 0.1 %"
    ))  # fmt: skip


def best_speeds() -> Decided:
    """Where the burn of the march ends at the published maxima."""
    found = errata.lost_burn()
    return Decided(
        supported=False,
        note="the march burns to the last whole degree only and loses up to "
        f"{found['largest_loss']:.4f} of the fuel's energy, a saw-tooth of {found['period_rpm']:.0f} rpm; at 5400 and "
        f"6700 rpm the burn ends at {found['end_of_burn_5400']:.2f} and {found['end_of_burn_6700']:.2f} degrees and "
        "loses nothing; the converged maxima lie elsewhere (see `mechsym reproduce nunes2017`)",
    )


def crossover() -> Decided:
    """The crossover speed with the rod of table 3.2."""
    found = errata.rod_length()
    return against(6436.0, found["crossover_rpm 90 mm"], (
        f"{found['crossover_rpm 90 mm']:.0f} rpm with the 90 mm of table 3.2; 6436 rpm, and all curves of section "
        f"5.1.1, follow from a rod of 74 mm ({found['crossover_rpm 74 mm']:.0f} rpm)"
    ))  # fmt: skip


def net_pressure() -> Decided:
    """Absolute pressure as net pressure.

    Returns
    -------
    decided : Decided
        With the atmosphere on the piston's back
    """
    found = errata.back_pressure()
    surplus, force = found["surplus_force"], float(peaks()["F"])
    return against(force, force - surplus, (
        f"the atmosphere behind the piston takes {surplus:.1f} N; the largest torques are "
        f"{found['torque_max slider-crank']:.2f} and {found['torque_max hypocycloid']:.2f} N m for 276.26 and 243.58; "
        "the averages stay"
    ))  # fmt: skip
