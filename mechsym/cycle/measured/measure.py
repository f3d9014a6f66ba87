"""A measured indicator diagram made usable, and what it tells of the engine and of itself, cycle by cycle.

Cut into cycles, aligned with the dead centre, pegged, scaled. Every cycle is pegged by itself (sensors drift) and kept
by itself, for whoever takes single cycles apart. What each step assumed is in the inputs, what it found in the result.
"""

import math
from pathlib import Path
from typing import Annotated

import numpy as np

from mechsym.cycle.chamber import Chamber, travel
from mechsym.cycle.measured.alignment import Alignment, DeadCentre, align, between, in_one_piece, sound_cycles
from mechsym.cycle.measured.diagram import Diagram, period_of
from mechsym.cycle.measured.file import cycle_speeds
from mechsym.cycle.measured.joint_fit import ChargeShape, JointFit, Prior, cycle_lines, log_pressure, mean_exponent
from mechsym.cycle.measured.signal import noise, without_swing
from mechsym.errors import BadInput
from mechsym.quantities import RPM, record
from mechsym.quantities.display import quantity_text
from mechsym.quantities.units import NORMAL_95, Array, Pascal, Radian

# middle and half width of where the pressure is that of the inlet, and that of the exhaust
_INLET, _EXHAUST = (-math.pi, math.radians(10.0)), (math.radians(270.0), math.radians(30.0))
_BDC = np.array([-math.pi])
USUAL_SCALE = (0.7, 1.4)
_USUAL_BOTTOM = (0.2e5, 5e5)  # where no inlet pressure is given: throttled to the utmost, charged to the utmost


@record
class MeasuredCycles:
    """The measured cycles in absolute pressure over the crank angle."""

    file: str
    period: float  #: 2 pi or 4 pi [rad]
    #: shape (n,): Evenly spaced crank angles from firing TDC, one period that holds phi = 0 inside [rad]
    phi: np.ndarray
    cycles: np.ndarray  #: shape (k, n): Absolute pressure of each cycle [Pa]
    raw_mean: np.ndarray  #: shape (n,): Mean of the cycles as measured, neither pegged nor scaled [Pa]
    alignment: Alignment
    offsets: np.ndarray  #: shape (k,): What was taken off each cycle [Pa]
    scale: float  #: Factor on what remained [-]
    level: float  #: The charge line 45 degrees before TDC, scaled [Pa]
    bottom: float  #: The charge line drawn on to the bottom dead centre before compression, scaled [Pa]
    speeds: np.ndarray | None  #: shape (k,): Speed of each cycle; None when the file has no times [rad/s]
    comments: tuple[str, ...]

    @property
    def tdc(self) -> float:
        """Angle of the file at firing TDC [rad]."""
        return self.alignment.dead_centre.angle

    @property
    def tdc_uncertainty(self) -> float | None:
        """Half the 95 % interval of the dead centre; None for a given one [rad]."""
        centre = self.alignment.dead_centre
        return None if centre.method == "given" else (centre.high - centre.low) / 2


def measured_cycles(
    diagram: Diagram, cylinder: Chamber, shared: tuple[DeadCentre, Prior] | None = None
) -> MeasuredCycles:
    """Read a diagram file and make absolute pressure over the crank angle of it.

    shared: what several records of the encoder say of this one, in place of the method of the case.
    """
    if not diagram.file:
        raise BadInput(
            "the diagram has no file; name it with --set cycle.file=FILE (or --diagram FILE of hinge, forces, cycle)"
        )
    period = period_of(diagram)
    recording, angle, read = sound_cycles(diagram.file, diagram, cylinder)
    aligned = align(diagram, cylinder, recording, angle, read, shared)
    # the row starts before TDC and ends behind it, whatever the file calls its angles
    phi = angle - aligned.dead_centre.angle
    phi = phi - period * math.ceil(phi[0] / period)
    raw = read
    if diagram.scale == "swing" and diagram.inlet_pressure is not None:
        inlet, exhaust = (_behind(phi, at, reach) for at, reach in (_INLET, _EXHAUST))
        raw = without_swing(read, 2, inlet, exhaust, diagram.exhaust_pressure - diagram.inlet_pressure)
    shape, drift = _pegging_line(diagram, aligned.fit)
    on_line, levels = cycle_lines(*around_compression(phi, raw, period), cylinder, between(diagram), shape, drift)
    offsets, level = _offsets(diagram, phi, raw, on_line), float(levels.mean())
    bottom = level * math.exp(float(log_pressure(cylinder, _BDC, shape)[0][0]))
    scale = _scale(diagram, phi, raw.mean(axis=0) - offsets.mean(), bottom)
    cycles = scale * (raw - offsets[:, None])
    # noise may push single samples of a throttled engine below zero, the mean cycle not
    lowest = float(cycles.mean(axis=0).min())
    if lowest <= 0:
        raise BadInput(
            f"{diagram.file}: the absolute pressure of the mean cycle falls to {lowest / 1e5:.3g} bar; "
            "choose another pegging or dead centre (inlet, polytropic; alignment, fit_from, fit_to)"
        )
    return MeasuredCycles(
        file=diagram.file,
        period=period,
        phi=phi,
        cycles=cycles,
        raw_mean=read.mean(axis=0),
        alignment=aligned,
        offsets=offsets,
        scale=scale,
        level=scale * level,
        bottom=scale * bottom,
        speeds=cycle_speeds(recording, float(angle[0]), period, len(raw)),
        comments=recording.comments,
    )


def around_compression(
    phi: Radian[Array], values: Pascal[Array], period: Radian
) -> tuple[Radian[Array], Pascal[Array]]:
    """The same samples ordered so that compression is in one piece.

    values: samples of pressure, crank angle last; period: 2 pi or 4 pi. Returns phi: ascending from half a turn and 0.5
    rad before TDC; values: in the order of phi.
    """
    return in_one_piece(phi, values, period, start=-math.pi - 0.5)


def _pegging_line(diagram: Diagram, joint: JointFit) -> tuple[ChargeShape, float]:
    """Shape and drift that give every cycle its offset: of the joint fit, or of the polytrope of the case."""
    if diagram.pegging != "polytropic":
        return joint.shape, joint.drift
    return ChargeShape(n0=diagram.n_c, n1=0.0, loss=0.0, sharpness=1.0), 0.0


def _offsets(diagram: Diagram, phi: np.ndarray, raw: np.ndarray, on_line: np.ndarray) -> np.ndarray:
    if diagram.pegging == "none":
        return np.zeros(len(raw))
    if diagram.pegging == "gauge":
        return np.full(len(raw), -diagram.p_back)
    if diagram.pegging == "inlet" and diagram.inlet_pressure is not None:
        return raw[:, _behind(phi, *_INLET, period_of(diagram))].mean(axis=1) - diagram.inlet_pressure
    return on_line


def _behind(phi: np.ndarray, middle: float, reach: float, period: float = 4 * math.pi) -> np.ndarray:
    """Which angles lie no further than `reach` from the middle, whole periods aside [rad]."""
    return np.abs(np.remainder(phi - middle + period / 2, period) - period / 2) <= reach


def _scale(diagram: Diagram, phi: np.ndarray, pegged: np.ndarray, bottom: float) -> float:
    if diagram.scale == "trapped" and diagram.inlet_pressure is not None:
        return diagram.inlet_pressure / bottom
    if diagram.scale == "exhaust":
        level = float(pegged[_behind(phi, *_EXHAUST)].mean())
        if level <= 0:
            raise BadInput(
                f"{diagram.file}: in the middle of the exhaust stroke the pegged pressure is {level / 1e5:.3g} bar, "
                "below zero: the sensor drifts too far for scale = 'exhaust'; use 'trapped' with inlet_pressure"
            )
        return diagram.exhaust_pressure / level
    if diagram.scale == "checked":
        _refuse_scale(diagram, bottom)
    return 1.0


def _refuse_scale(diagram: Diagram, bottom: float) -> None:
    low, high = _USUAL_BOTTOM
    allowed = f"{low / 1e5:g} to {high / 1e5:g} bar of any engine"
    if diagram.inlet_pressure is not None:
        low, high = (factor * diagram.inlet_pressure for factor in USUAL_SCALE)
        allowed = (
            f"{USUAL_SCALE[0]:g} to {USUAL_SCALE[1]:g} times inlet_pressure = {diagram.inlet_pressure / 1e5:.3g} bar"
        )
    if not low <= bottom <= high:
        raise BadInput(
            f"{diagram.file}: the compression line starts from {bottom / 1e5:.3g} bar absolute at BDC, allowed are "
            f"{allowed}; unit or scale of the sensor is wrong: mend the file, or choose scale = 'exhaust' or 'trapped' "
            "(scaled by the exhaust or inlet pressure) or 'as_given' in [cycle]"
        )


_WEAK = 0.7


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
    shape = measured.alignment.fit.shape
    exponent = mean_exponent(cylinder, shape, *between(diagram))
    how = {
        "none": "none, the file is taken as absolute",
        "gauge": f"the file is taken as gauge, over {_pressure(diagram.p_back)} absolute",
        "inlet": "inlet_pressure at the dead centre before compression (assumed)",
        "polytropic": f"every cycle's compression line follows the exponent {diagram.n_c:g} (assumed)",
        "joint": "offset of every cycle's compression line in the joint fit",
    }[diagram.pegging]
    return (
        read_and_used(diagram, measured),
        *(f"the file says: {comment}" for comment in measured.comments),
        f"{Path(measured.file).name}: {len(p_mi)} cycles; net mean indicated pressure {_pressures(p_mi)}, "
        f"peaks {_pressures(measured.cycles.max(axis=1))} absolute",
        _alignment_fact(measured, work_per_angle(measured, cylinder) * math.radians(1.0)),
        f"pegging: {how}; {_pressures(measured.offsets)} were taken off the cycles",
        _scale_fact(diagram, measured),
        f"compression exponent {exponent:.3f} (expected {diagram.n_c:.2f} +- {NORMAL_95 * Prior().n0[1]:.2f}), losses "
        f"{100 * shape.loss:.0f} % of the pressure per radian at TDC (expected {100 * Prior().loss[0]:.0f} +- "
        f"{100 * NORMAL_95 * Prior().loss[1]:.0f} %)",
        *smoothed,
        _weak_fact(p_mi),
        f"under the piston: {_pressure(diagram.p_back)} absolute",
    )


def read_and_used(diagram: Diagram, measured: MeasuredCycles) -> str:
    """What was read and what was used, in one line."""
    centre = measured.alignment.dead_centre
    by = "as read" if measured.scale == 1.0 else f"scaled {measured.scale:.3g} by scale = {diagram.scale}"
    shifted = _pressures(-measured.offsets)
    speeds = "" if measured.speeds is None else f", {_range(measured.speeds / RPM, '.0f')} rpm by time_s"
    turns = 360 * (math.degrees(centre.angle) // 360)
    angle, low, high = (math.degrees(value) - turns for value in (centre.angle, centre.low, centre.high))
    read, used = _pressure(measured.raw_mean.max()), _pressure(measured.cycles.mean(axis=0).max(), 3)
    return (
        f"peak {read} read, {used} absolute used: shifted by {shifted}, pegging = {diagram.pegging}, "
        f"{by}, dead centre {angle:.2f} deg ({low:.2f} to {high:.2f}) by "
        f"{centre.method}{speeds}"
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
    centre, spread = measured.alignment.dead_centre, measured.tdc_uncertainty
    ends = f"95 %: {math.degrees(centre.low):.2f} to {math.degrees(centre.high):.2f} deg"
    known = "not estimated" if spread is None else ends
    assumed = "" if centre.prior_share is None else f", {100 * centre.prior_share:.0f} % of it assumed and not measured"
    loss = "" if centre.loss_angle is None else f", {math.degrees(centre.loss_angle):.2f} deg behind the motored peak"
    even = measured.alignment.spread
    uneven = "" if even is None else f"; up to {math.degrees(even):.1f} deg of it: angles spread evenly over each turn"
    return (
        f"firing dead centre at {math.degrees(centre.angle):.2f} deg of the file, the sensor's lag in it, "
        f"{known}{assumed}: {centre.method}{loss}{uneven}; one degree changes the work by {100 * per_degree:+.1f} %"
    )


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
