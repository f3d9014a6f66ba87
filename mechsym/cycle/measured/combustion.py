r"""Fits to measured pressure with confidence: the compression line in log p - log V, and Wiebe functions.

    log p |  \            slope -n; a wrong dead centre bends it, because V(phi) is then wrong most near top dead
          |    \          centre, where V'/V is large and changes sign
          |      \
          +--------- log V

Confidence is 95 % from the covariance of the least-squares fit, widened where neighbouring residuals hang together: n
correlated residuals tell as much as n (1 - r)/(1 + r) independent ones, r their lag-one correlation. It holds for the
model fitted, not for what the model leaves out.

A measured diagram taken apart: combustion of every cycle and of the mean one, and how sure all of it is.

measured cycles --> heat release, burn points, exponents of each --> weak cycles
               \--> mean cycle: Wiebe functions, compression line, trapped mass, what a degree of dead centre costs
"""

import dataclasses
import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Annotated

import numpy as np
import scipy

from mechsym.cycle.chamber import Chamber, volume
from mechsym.cycle.heat import Hohenberg
from mechsym.cycle.measured.heat_release import (
    EARLIEST,
    Combustion,
    CombustionFigures,
    Walls,
    burnt_fraction,
    combustion,
    combustion_figures,
    heat_release,
    wall_heat,
)
from mechsym.cycle.measured.joint_fit import log_pressure, mean_exponent
from mechsym.cycle.measured.measure import MeasuredCycles, around_compression, weak_cycles
from mechsym.cycle.wiebe import wiebe
from mechsym.page import Shown
from mechsym.quantities import quantity, record
from mechsym.quantities.results import Columns, result
from mechsym.quantities.units import NORMAL_95, Array, Kelvin, Kilogram, Pascal, Pure, Radian, RadPerSecond, Volume

_QUANTILE = 1.959963984540054  # 95 % of a normal distribution
_DOUBLE_STARTS = ((0.3, 1.0, 0.5), (0.6, 2.0, 0.7), (0.7, 1.0, 1.5))  # b, m_p, m_d to begin with


@record
class Fit:
    """A least-squares fit."""

    names: tuple[str, ...]
    units: tuple[str, ...]  #: SI, of the values
    #: Their values and the half width of their 95 % confidence intervals [units]
    values: tuple[float, ...]
    confidence: tuple[float, ...]
    rms: float  #: Root mean square of the residuals [unit of the data]
    unit: str = "-"  #: Of the data

    @property
    def columns(self) -> Columns:
        """`rms`, and each value with its confidence by its name."""
        pairs = zip(self.names, self.values, self.confidence, strict=True)
        values = {name: {"value": value, "confidence": half} for name, value, half in pairs}
        units = {"rms": self.unit, **dict(zip(self.names, self.units, strict=True))}
        return Columns({"rms": self.rms, **values}, units)


def least_squares_fit(
    residuals: Callable[[np.ndarray], np.ndarray], names: Mapping[str, str], start: np.ndarray, bounds: object
) -> Fit:
    """Fit parameters to residuals and say how well they are known.

    names: names of the parameters with their units; start: where to begin [units of the parameters], shape (k,).
    Returns fit: values with confidence; a parameter that the data do not determine has infinite confidence.
    """
    solution = scipy.optimize.least_squares(
        residuals, start, "3-point", bounds, x_scale="jac", xtol=1e-12, ftol=1e-12, gtol=1e-12
    )
    left, freedom = solution.fun, max(solution.fun.size - solution.x.size, 1)
    centred = left - left.mean()
    power = float(centred @ centred)
    r = min(max(float(centred[:-1] @ centred[1:]) / power, 0.0), 0.999) if power > 0 else 0.0
    spread = np.sqrt(_variances(solution.jac) * (left @ left) / freedom * (1 + r) / (1 - r))
    return Fit(
        names=tuple(names), units=tuple(names.values()), values=tuple(float(v) for v in solution.x),
        confidence=tuple(float(_QUANTILE * s) for s in spread), rms=float(np.sqrt(np.mean(left**2))),
    )  # fmt: skip


def trapped_mass(
    pressure: Pascal, v: Volume, temperature: Kelvin, gas_constant: Annotated[float, "J/(kg*K)"]
) -> Kilogram:
    """Mass of gas from the compression line.

    .. math:: m = p V/(R T)

    pressure: on the line, where the inlet closes. temperature: assumed temperature there; the mass is as uncertain as
    this. gas_constant: specific gas constant. Returns mass: trapped mass.
    """
    return pressure * v / (gas_constant * temperature)


def fit_wiebe(phi: Radian[Array], burnt: Pure[Array], a: Pure = 5.0) -> Fit:
    r"""Single Wiebe function through a burnt fraction.

    .. math:: X = \frac{1 - e^{-a y^{m+1}}}{1 - e^{-a}}, \quad y = (\varphi - \varphi_s)/\Delta\varphi \le 1

    burnt: burnt fraction, 0 to 1; a: completeness, which the duration cannot be told apart from. Returns fit: `start`,
    `duration` [rad], `m` [-]; rms [-].
    """

    def residuals(x: np.ndarray) -> np.ndarray:
        y = np.minimum((phi - x[0]) / x[1], 1.0)
        return wiebe(y, a, x[2]) / (1 - math.exp(-a)) - burnt

    first, last = phi[np.argmax(burnt > 0.02)], phi[np.argmax(burnt > 0.98)]
    start = np.array([first, max(last - first, 0.05), 1.5])
    bounds = (np.array([phi[0], 0.01, 0.0]), np.array([phi[-1], phi[-1] - phi[0], 15.0]))
    return least_squares_fit(residuals, {"start": "rad", "duration": "rad", "m": "-"}, start, bounds)


def fit_double_wiebe(phi: Radian[Array], burnt: Pure[Array], a: Pure = 5.0) -> Fit:
    r"""Double Wiebe function through a burnt fraction; of its two parts the shorter one is p, the premixed.

    .. math:: X = (1-b)\{1 - e^{-a y_p^{m_p+1}}\} + b\{1 - e^{-a y_d^{m_d+1}}\}, \; y = (\varphi-\varphi_s)/\Delta

    burnt: burnt fraction, 0 to 1; a: completeness of both parts, which their durations cannot be told apart from.
    Returns fit: `start`, `duration_p`, `duration_d` [rad], `m_p`, `m_d`, `b` [-]; rms [-].
    """

    def residuals(x: np.ndarray) -> np.ndarray:
        start, d_p, d_d, m_p, m_d, b = x
        parts = (1 - b) * wiebe((phi - start) / d_p, a, m_p) + b * wiebe((phi - start) / d_d, a, m_d)
        return parts - burnt

    single = fit_wiebe(phi, burnt)
    start, duration, _ = single.values
    bounds = (np.array([phi[0], 0.01, 0.01, 0.0, 0.0, 0.0]), np.array([phi[-1], 6.0, 6.0, 15.0, 15.0, 1.0]))
    names = dict.fromkeys(("start", "duration_p", "duration_d"), "rad") | dict.fromkeys(("m_p", "m_d", "b"), "-")
    tries = [
        least_squares_fit(residuals, names, np.array([start, 0.5 * duration, duration, m_p, m_d, b]), bounds)
        for b, m_p, m_d in _DOUBLE_STARTS
    ]
    best = min(tries, key=lambda fit: fit.rms)
    return best if best.values[1] <= best.values[2] else _exchanged(best)


def _exchanged(fit: Fit) -> Fit:
    """The same double Wiebe function with its parts p and d by each other's names."""
    start, d_p, d_d, m_p, m_d, b = fit.values
    of_p, of_d, m_of_p, m_of_d = fit.confidence[1:5]
    confidence = (fit.confidence[0], of_d, of_p, m_of_d, m_of_p, fit.confidence[5])
    return replace(fit, values=(start, d_d, d_p, m_d, m_p, 1 - b), confidence=confidence)


def _variances(jacobian: np.ndarray) -> np.ndarray:
    # diagonal of (J'J)^-1 by the singular values of J with columns of length one, so that units do not matter
    size = np.linalg.norm(jacobian, axis=0)
    if not np.all(size > 0):
        return np.full(size.size, np.inf)
    _, singular, vt = np.linalg.svd(jacobian / size, full_matrices=False)
    if singular[-1] < 1e-7 * singular[0]:
        return np.full(size.size, np.inf)
    return np.sum((vt.T / singular) ** 2, axis=1) / size**2


_DEGREE = math.radians(1.0)
_BEFORE_COMBUSTION = math.radians(-30.0)
_WALL = 430.0  # of walls: usual [K]


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


@result
class DeadCentreShift:
    """What another dead centre changes; None where its uncertainty is not known."""

    work: float | None = quantity("-")  #: Work of the cycle, relative
    heat: float | None = quantity("-")  #: Heat released, relative
    burn_50: float | None = quantity("rad")  #: Angle at which half is burnt

    def by(self, turned: float | None) -> "DeadCentreShift":
        """The size of the change by a dead centre that is off by some degrees, from that by one degree [-]."""
        if turned is None:
            return DeadCentreShift(work=None, heat=None, burn_50=None)
        return DeadCentreShift(**{name: abs(change) * turned / _DEGREE for name, change in vars(self).items()})


@record
class DiagramCombustion(Shown):
    """What a measured diagram says of combustion."""

    measured: MeasuredCycles
    cylinder: Chamber
    analysis: Analysis
    figures: CombustionFigures
    cycles: tuple[Combustion, ...]
    mean: Combustion
    weak: tuple[int, ...]  #: Cycles with less than 0.7 of the median work, from 0
    #: Through the burnt fraction of the mean cycle; None where nothing burns
    wiebe: Fit | None
    double_wiebe: Fit | None
    line: Fit  #: Charge line of the joint fit: exponent, dead centre, pressure when the inlet closes
    mass: float  #: Trapped mass from that line [kg]
    tdc_uncertainty: float | None  #: Of the alignment [rad]
    per_degree: DeadCentreShift  #: Change by one degree of later dead centre
    uncertainty: DeadCentreShift  #: Change by the uncertainty of the dead centre


def diagram_combustion(
    measured: MeasuredCycles, cylinder: Chamber, analysis: Analysis, omega: RadPerSecond
) -> DiagramCombustion:
    """Take the measured cycles apart, cycle by cycle and for the mean. omega: speed of the record."""
    phi, cycles = around_compression(measured.phi, measured.cycles, measured.period)
    ends = (analysis.inlet_closes, analysis.exhaust_opens)
    burns = not measured.alignment.motored
    each = tuple(_said(combustion(phi, p, cylinder, analysis.gamma, ends), burns) for p in cycles)
    average = cycles.mean(axis=0)
    inside = (phi >= ends[0]) & (phi <= ends[1])
    at = phi[inside]
    burnt = burnt_fraction(at, heat_release(at, average[inside], cylinder, analysis.gamma))
    burning = at >= EARLIEST
    line = _line(measured, cylinder, analysis.inlet_closes)
    v_closed = float(volume(cylinder, analysis.inlet_closes))
    slopes = sensitivity(phi, average, cylinder, analysis)
    spread = measured.tdc_uncertainty
    mass = trapped_mass(line.values[2], v_closed, analysis.charge_temperature, analysis.gas_constant)
    walls = Walls(law=Hohenberg(wall_temperature=_WALL), mass=mass, gas_constant=analysis.gas_constant, omega=omega)
    return DiagramCombustion(
        measured=measured,
        cylinder=cylinder,
        analysis=analysis,
        figures=combustion_figures(
            phi,
            cycles,
            cylinder,
            measured.period,
            spread or 0.0,
            each,
            abs(slopes.burn_50 or 0.0) / _DEGREE,
            wall_heat(at, average[inside], cylinder, walls) if burns else None,
        ),
        cycles=each,
        mean=_said(combustion(phi, average, cylinder, analysis.gamma, ends), burns),
        weak=weak_cycles(np.array([c.mean_indicated for c in each])) if burns else (),
        wiebe=fit_wiebe(at[burning], burnt[burning]) if burns else None,
        double_wiebe=fit_double_wiebe(at[burning], burnt[burning]) if burns else None,
        line=line,
        mass=mass,
        tdc_uncertainty=spread,
        per_degree=slopes,
        uncertainty=slopes.by(spread),
    )


def _said(burning: Combustion, burns: bool) -> Combustion:
    """What a cycle says, without the heat and burn points of one in which nothing burns."""
    if burns:
        return burning
    return dataclasses.replace(burning, heat=0.0, burn_angles=(math.nan,) * len(burning.burn_angles))


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
        units=("-", "rad", "Pa"),
        values=(mean_exponent(cylinder, fit.shape, closed, _BEFORE_COMBUSTION), 0.0, pressure),
        confidence=(NORMAL_95 * exponent, measured.tdc_uncertainty or 0.0, NORMAL_95 * level * pressure),
        rms=measured.scale * fit.rms,
        unit="Pa",
    )


def sensitivity(phi: Radian[Array], p: Pascal[Array], cylinder: Chamber, analysis: Analysis) -> DeadCentreShift:
    """What a dead centre that lies one degree later changes, by central differences. p: absolute pressure."""
    ends = (analysis.inlet_closes, analysis.exhaust_opens)
    earlier, here, later = (
        combustion(phi + shift, p, cylinder, analysis.gamma, ends) for shift in (_DEGREE / 2, 0.0, -_DEGREE / 2)
    )
    return DeadCentreShift(
        work=(later.work - earlier.work) / here.work,
        heat=(later.heat - earlier.heat) / here.heat if here.heat else 0.0,
        burn_50=later.burn_angles[1] - earlier.burn_angles[1],
    )
