r"""A measured diagram taken apart: combustion of every cycle and of the mean one, and how sure all of it is.

measured cycles --> heat release, burn points, exponents of each --> weak cycles
               \--> mean cycle: Wiebe functions, compression line, trapped mass, what a degree of dead centre costs
"""

import dataclasses
import math
from typing import Any

import numpy as np

from mechsym.cycle.chamber import Chamber, volume
from mechsym.cycle.measured.charge_line import log_pressure, mean_exponent
from mechsym.cycle.measured.facts import weak_cycles
from mechsym.cycle.measured.fits import Fit, fit_double_wiebe, fit_wiebe, trapped_mass
from mechsym.cycle.measured.heat_release import Combustion, burnt_fraction, combustion, heat_release
from mechsym.cycle.measured.measure import MeasuredCycles, around_compression
from mechsym.quantities import quantity, record

_DEGREE = math.radians(1.0)
_EARLIEST = math.radians(-45.0)
_BEFORE_COMBUSTION = math.radians(-30.0)
_Z = 1.96


@record
class Analysis:
    """Section `[combustion]`: what the analysis of a measured diagram assumes."""

    #: Ratio of heat capacities of the hot charge [-]
    gamma: float = quantity("-", default=1.32, above=1, high=5 / 3, about="ratio of heat capacities")
    gas_constant: float = quantity("J/kg/K", default=287.0, above=0, about="specific gas constant")
    inlet_closes: float = quantity("rad", default=math.radians(-130.0), low=-math.pi, below=0, about="from firing TDC")
    exhaust_opens: float = quantity("rad", default=math.radians(120.0), above=0, high=math.pi, about="from firing TDC")
    #: When the inlet closes, for the trapped mass [K]
    charge_temperature: float = quantity("K", default=330.0, above=0, about="when the inlet closes")


@record
class DiagramCombustion:
    """What a measured diagram says of combustion."""

    measured: MeasuredCycles
    cycles: tuple[Combustion, ...]
    mean: Combustion
    weak: tuple[int, ...]  #: Cycles with less than 0.7 of the median work, from 0
    #: Through the burnt fraction of the mean cycle; None where nothing burns
    wiebe: Fit | None
    double_wiebe: Fit | None
    line: Fit  #: Charge line of the joint fit: exponent, dead centre, pressure when the inlet closes
    mass: float  #: Trapped mass from that line [kg]
    tdc_uncertainty: float | None  #: Of the alignment [rad]
    #: Change by one degree of later dead centre: `work`, `heat` relative [-], `burn_50` [rad]
    per_degree: dict[str, float]
    uncertainty: dict[str, float | None]  #: The same for the uncertainty of the dead centre


def diagram_combustion(measured: MeasuredCycles, cylinder: Chamber, analysis: Analysis) -> DiagramCombustion:
    """Take the measured cycles apart.

    Returns
    -------
    found : DiagramCombustion
        Cycle by cycle and for the mean
    """
    phi, cycles = around_compression(measured.phi, measured.cycles, measured.period)
    ends = (analysis.inlet_closes, analysis.exhaust_opens)
    burns = not measured.alignment.motored
    each = tuple(_said(combustion(phi, p, cylinder, analysis.gamma, ends), burns) for p in cycles)
    average = cycles.mean(axis=0)
    inside = (phi >= ends[0]) & (phi <= ends[1])
    at = phi[inside]
    burnt = burnt_fraction(at, heat_release(at, average[inside], cylinder, analysis.gamma))
    burning = at >= _EARLIEST
    line = _line(measured, cylinder, analysis.inlet_closes)
    v_closed = float(volume(cylinder, analysis.inlet_closes))
    slopes = sensitivity(phi, average, cylinder, analysis)
    spread = measured.tdc_uncertainty
    return DiagramCombustion(
        measured=measured,
        cycles=each,
        mean=_said(combustion(phi, average, cylinder, analysis.gamma, ends), burns),
        weak=weak_cycles(np.array([c.mean_indicated for c in each])) if burns else (),
        wiebe=fit_wiebe(at[burning], burnt[burning]) if burns else None,
        double_wiebe=fit_double_wiebe(at[burning], burnt[burning]) if burns else None,
        line=line,
        mass=trapped_mass(line.values[2], v_closed, analysis.charge_temperature, analysis.gas_constant),
        tdc_uncertainty=spread,
        per_degree=slopes,
        uncertainty={k: None if spread is None else abs(v) * spread / _DEGREE for k, v in slopes.items()},
    )


def _said(found: Combustion, burns: bool) -> Combustion:
    """What a cycle says, without the heat and burn points of one in which nothing burns."""
    if burns:
        return found
    return dataclasses.replace(found, heat=0.0, burn_angles=(math.nan,) * len(found.burn_angles))


def _line(measured: MeasuredCycles, cylinder: Chamber, closed: float) -> Fit:
    """The charge line of the joint fit as exponent, dead centre and pressure when the inlet closes."""
    fit, ends = measured.alignment.fit, np.array([closed, _BEFORE_COMBUSTION])
    log_p, slopes = log_pressure(cylinder, ends, fit.shape)
    rise = float(np.diff(np.log(volume(cylinder, ends)))[0])
    known = fit.covariance[:5, :5].copy()
    known[0, :] = known[:, 0] = 0.0  # the dead centre has its own interval
    by_exponent, by_level = -np.diff(slopes, axis=0)[0] / rise, slopes[0]
    exponent = math.sqrt(float(by_exponent @ known @ by_exponent))
    by_offset = math.sqrt(float(fit.covariance[5, 5])) * fit.swing / fit.level
    level = math.hypot(math.sqrt(float(by_level @ known @ by_level)), by_offset)
    pressure = measured.level * math.exp(float(log_p[0]))
    return Fit(
        names=("n", "tdc", "pressure"),
        values=(mean_exponent(cylinder, fit.shape, closed, _BEFORE_COMBUSTION), 0.0, pressure),
        confidence=(_Z * exponent, measured.tdc_uncertainty or 0.0, _Z * level * pressure),
        rms=measured.scale * fit.rms,
    )


def sensitivity(phi: np.ndarray, p: np.ndarray, cylinder: Chamber, analysis: Analysis) -> dict[str, float]:
    """What a dead centre that lies one degree later changes.

    Parameters
    ----------
    phi : ndarray, shape (n,)
        Crank angles of one period [rad]
    p : ndarray, shape (n,)
        Absolute pressure [Pa]

    Returns
    -------
    change : dict of str to float
        `work`, `heat` relative [-], `burn_50` [rad], by central differences
    """
    ends = (analysis.inlet_closes, analysis.exhaust_opens)
    earlier, here, later = (
        combustion(phi + shift, p, cylinder, analysis.gamma, ends) for shift in (_DEGREE / 2, 0.0, -_DEGREE / 2)
    )
    return {
        "work": (later.work - earlier.work) / here.work,
        "heat": (later.heat - earlier.heat) / here.heat if here.heat else 0.0,
        "burn_50": later.burn_angles[1] - earlier.burn_angles[1],
    }


def rows(found: DiagramCombustion) -> list[dict[str, Any]]:
    """One row for each cycle, in the units of the command line.

    Returns
    -------
    rows : list of dict
        cycle (from 1), mep_bar, p_max_bar, p_max_deg, heat_j, burn_10_deg, burn_50_deg, burn_90_deg, n_compression,
        n_expansion, weak
    """
    table = []
    for k, cycle in enumerate(found.cycles):
        burn_10, burn_50, burn_90 = (math.degrees(angle) for angle in cycle.burn_angles)
        table.append({
            "cycle": k + 1, "mep_bar": cycle.mean_indicated / 1e5, "p_max_bar": cycle.p_max / 1e5,
            "p_max_deg": math.degrees(cycle.phi_p_max), "heat_j": cycle.heat, "burn_10_deg": burn_10,
            "burn_50_deg": burn_50, "burn_90_deg": burn_90, "n_compression": cycle.n_compression,
            "n_expansion": cycle.n_expansion, "weak": k in found.weak,
        })  # fmt: skip
    return table
