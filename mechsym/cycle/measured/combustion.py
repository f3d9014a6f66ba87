r"""A measured diagram taken apart: combustion of every cycle and of the mean one, and how sure all of it is.

measured cycles --> heat release, burn points, exponents of each --> weak cycles
               \--> mean cycle: Wiebe functions, compression line, trapped mass, what a degree of dead centre costs
"""

import dataclasses
import math

import numpy as np

from mechsym.cycle.chamber import Chamber, volume
from mechsym.cycle.heat import Hohenberg
from mechsym.cycle.measured.charge_line import log_pressure, mean_exponent
from mechsym.cycle.measured.facts import weak_cycles
from mechsym.cycle.measured.figures import CombustionFigures, combustion_figures
from mechsym.cycle.measured.fits import Fit, fit_double_wiebe, fit_wiebe, trapped_mass
from mechsym.cycle.measured.heat_release import (
    Combustion,
    Walls,
    burnt_fraction,
    combustion,
    heat_release,
    wall_heat,
)
from mechsym.cycle.measured.measure import MeasuredCycles, around_compression
from mechsym.page import Shown
from mechsym.quantities import quantity, record
from mechsym.quantities.results import result
from mechsym.quantities.units import Array, Pascal, Radian, RadPerSecond

_DEGREE = math.radians(1.0)
_EARLIEST = math.radians(-45.0)
_BEFORE_COMBUSTION = math.radians(-30.0)
_Z = 1.96
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
    """Take the measured cycles apart. omega: speed of the record. Returns found: cycle by cycle and for the mean."""
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
    mass = trapped_mass(line.values[2], v_closed, analysis.charge_temperature, analysis.gas_constant)
    walls = Walls(
        law=Hohenberg(wall_temperature=_WALL), mass=mass, gas_constant=analysis.gas_constant, omega=omega
    )  # fmt: skip
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
        ),  # fmt: skip
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
        units=("-", "rad", "Pa"),
        values=(mean_exponent(cylinder, fit.shape, closed, _BEFORE_COMBUSTION), 0.0, pressure),
        confidence=(_Z * exponent, measured.tdc_uncertainty or 0.0, _Z * level * pressure),
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
