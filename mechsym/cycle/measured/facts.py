"""What a measured diagram tells of the engine, cycle by cycle, and of itself: work, weak cycles, facts and doubts."""

import math
from pathlib import Path
from typing import Annotated

import numpy as np

from mechsym.cycle.chamber import Chamber, travel
from mechsym.cycle.measured.alignment import between
from mechsym.cycle.measured.charge_line import mean_exponent
from mechsym.cycle.measured.diagram import Diagram
from mechsym.cycle.measured.joint_fit import Prior
from mechsym.cycle.measured.measure import MeasuredCycles
from mechsym.cycle.measured.smoothing import noise
from mechsym.quantities import RPM
from mechsym.quantities.display import quantity_text
from mechsym.quantities.units import Array, Pascal

_WEAK = 0.7
_Z = 1.96


def cycle_work(measured: MeasuredCycles, cylinder: Chamber) -> Pascal[Array]:
    r"""Mean indicated pressure of every cycle, net over the period.

    .. math:: p_{mi,k} = \frac{1}{s} \sum_i p_{k,i}\,x'(\varphi_i)\,\Delta\varphi

    Returns p_mi: mean indicated pressure, shape (k,).
    """
    step = measured.period / measured.phi.size
    return measured.cycles @ travel(cylinder.motion, measured.phi)[1] * step / cylinder.stroke


def work_per_angle(measured: MeasuredCycles, cylinder: Chamber) -> Annotated[float, "1/rad"]:
    r"""How much the mean cycle's work changes when the dead centre moves.

    .. math:: \frac{1}{p_{mi}} \frac{d p_{mi}}{d \varphi_{tdc}}

    Returns slope: relative change by angle, the pegging held; negative as a later dead centre means less work.
    """
    by = math.radians(0.5)
    mean = measured.cycles.mean(axis=0)
    later, here, earlier = (float(mean @ travel(cylinder.motion, measured.phi + s)[1]) for s in (-by, 0.0, by))
    return (later - earlier) / (2 * by) / here


def weak_cycles(p_mi: Pascal[Array]) -> tuple[int, ...]:
    """Cycles below 0.7 times the median work: misfires, near-misfires, late burns. p_mi: of every cycle, shape (k,)."""
    return tuple(int(k) for k in np.flatnonzero(p_mi < _WEAK * np.median(p_mi)))


def diagram_facts(
    diagram: Diagram, cylinder: Chamber, measured: MeasuredCycles, residual: Pascal | None = None
) -> tuple[str, ...]:
    """What was assumed on the way from the file to the mean cycle, and what came out.

    residual: root mean square of what the smoothing of the mean cycle left out; None where cycles are taken apart.
    """
    p_mi = cycle_work(measured, cylinder)
    smoothed = [] if residual is None else [_smoothing_fact(diagram, measured, residual)]
    return (
        read_and_used(diagram, measured),
        *(f"the file says: {comment}" for comment in measured.comments),
        f"{Path(measured.file).name}: {len(p_mi)} cycles; net mean indicated pressure {_pressures(p_mi)}, "
        f"peaks {_pressures(measured.cycles.max(axis=1))} absolute",
        _alignment_fact(measured, work_per_angle(measured, cylinder) * math.radians(1.0)),
        _pegging_fact(diagram, measured),
        _scale_fact(diagram, measured),
        _exponent_fact(diagram, cylinder, measured),
        *smoothed,
        _weak_fact(p_mi),
        f"under the piston: {_pressure(diagram.p_back)} absolute",
    )


def read_and_used(diagram: Diagram, measured: MeasuredCycles) -> str:
    """What was read and what was used, in one line."""
    found = measured.alignment.dead_centre
    by = "as read" if measured.scale == 1.0 else f"scaled {measured.scale:.3g} by scale = {diagram.scale}"
    shifted = _pressures(-measured.offsets)
    speeds = "" if measured.speeds is None else f", {_range(measured.speeds / RPM, '.0f')} rpm by time_s"
    turns = 360 * (math.degrees(found.angle) // 360)
    angle, low, high = (math.degrees(value) - turns for value in (found.angle, found.low, found.high))
    read, used = _pressure(measured.raw_mean.max()), _pressure(measured.cycles.mean(axis=0).max(), 3)
    return (
        f"peak {read} read, {used} absolute used: shifted by {shifted}, pegging = {diagram.pegging}, "
        f"{by}, dead centre {angle:.2f} deg ({low:.2f} to {high:.2f}) by "
        f"{found.method}{speeds}"
    )


def _pressure(value: float, digits: int = 4) -> str:
    return quantity_text(float(value), "Pa", digits)


def _pressures(values: np.ndarray) -> str:
    low, high = (_pressure(value, 3) for value in (values.min(), values.max()))
    return low if low == high else f"{low} to {high}"


def _range(values: np.ndarray, form: str) -> str:
    low, high = format(values.min(), form), format(values.max(), form)
    return low if low == high else f"{low} to {high}"


def _alignment_fact(measured: MeasuredCycles, per_degree: float) -> str:
    found, spread = measured.alignment.dead_centre, measured.tdc_uncertainty
    ends = f"95 %: {math.degrees(found.low):.2f} to {math.degrees(found.high):.2f} deg"
    known = "not estimated" if spread is None else ends
    assumed = "" if found.prior_share is None else f", {100 * found.prior_share:.0f} % of it assumed and not measured"
    loss = "" if found.loss_angle is None else f", {math.degrees(found.loss_angle):.2f} deg behind the motored peak"
    even = measured.alignment.spread
    uneven = "" if even is None else f"; up to {math.degrees(even):.1f} deg of it: angles spread evenly over each turn"
    return (
        f"firing dead centre at {math.degrees(found.angle):.2f} deg of the file, the sensor's lag in it, "
        f"{known}{assumed}: {found.method}{loss}{uneven}; one degree changes the work by {100 * per_degree:+.1f} %"
    )


def _pegging_fact(diagram: Diagram, measured: MeasuredCycles) -> str:
    how = {
        "none": "none, the file is taken as absolute",
        "gauge": f"the file is taken as gauge, over {_pressure(diagram.p_back)} absolute",
        "inlet": "inlet_pressure at the dead centre before compression (assumed)",
        "polytropic": f"every cycle's compression line follows the exponent {diagram.n_c:g} (assumed)",
        "joint": "offset of every cycle's compression line in the joint fit",
    }[diagram.pegging]
    return f"pegging: {how}; {_pressures(measured.offsets)} were taken off the cycles"


def _scale_fact(diagram: Diagram, measured: MeasuredCycles) -> str:
    start = f"the compression line starts from {_pressure(measured.bottom, 3)} absolute at BDC"
    if diagram.scale in ("checked", "as_given"):
        return f"scale as given; {start}"
    if diagram.scale == "swing":
        level = _pressure(diagram.exhaust_pressure, 3)
        return f"scale as given, drift and thermal swing taken off: {level} in the exhaust stroke (assumed); {start}"
    assumed = "inlet_pressure there" if diagram.scale == "trapped" else (
        f"{_pressure(diagram.exhaust_pressure, 3)} in the middle of the exhaust stroke"
    )  # fmt: skip
    return f"scaled by {measured.scale:.4f} (assumed: {assumed}); {start}; all pressures and the work are as uncertain"


def _exponent_fact(diagram: Diagram, cylinder: Chamber, measured: MeasuredCycles) -> str:
    shape = measured.alignment.fit.shape
    found = mean_exponent(cylinder, shape, *between(diagram))
    return (
        f"compression exponent {found:.3f} (expected {diagram.n_c:.2f} +- {_Z * Prior().n0[1]:.2f}), losses "
        f"{100 * shape.loss:.0f} % of the pressure per radian at TDC (expected {100 * Prior().loss[0]:.0f} +- "
        f"{100 * _Z * Prior().loss[1]:.0f} %)"
    )


def _smoothing_fact(diagram: Diagram, measured: MeasuredCycles, residual: float) -> str:
    scatter = float(measured.cycles.std(axis=0).max())
    return (
        f"smoothing ({diagram.smoothing}) leaves {_pressure(residual, 3)} rms of the mean cycle; its noise is "
        f"{_pressure(noise(measured.cycles.mean(axis=0)), 3)}, the cycles scatter by up to {_pressure(scatter, 3)}"
    )


def _weak_fact(p_mi: np.ndarray) -> str:
    weak = weak_cycles(p_mi)
    if not weak:
        return f"no cycle does less than {_WEAK:g} of the median work"
    named = ", ".join(f"{k + 1} ({_pressure(p_mi[k], 3)})" for k in weak)
    return f"nearly misfired (less than {_WEAK:g} of the median work), kept in the mean: cycle {named}"
