"""A measured indicator diagram made usable: cut into cycles, aligned with the dead centre, pegged, scaled.

Every cycle is pegged by itself (sensors drift) and kept by itself, for whoever takes single cycles apart. What each
step assumed is in the inputs, what it found in the result.
"""

import math

import numpy as np

from mechsym.cycle.chamber import Chamber
from mechsym.cycle.measured.compression_line import Line, dead_centre_uncertainty, find_dead_centre, fit_line
from mechsym.cycle.measured.cycles import cut_cycles
from mechsym.cycle.measured.diagram import Diagram, period_of, window
from mechsym.cycle.measured.file import read_diagram
from mechsym.errors import BadInput
from mechsym.quantities import record

_AT_BDC = math.radians(10.0)
_EXHAUST_MIDDLE, _EXHAUST_REACH = math.radians(270.0), math.radians(30.0)
_MOTORED_UNCERTAINTY = math.radians(0.5)


@record
class MeasuredCycles:
    """The measured cycles in absolute pressure over the crank angle."""

    file: str
    period: float  #: 2 pi or 4 pi [rad]
    #: shape (n,): Evenly spaced crank angles from firing TDC, one period that holds phi = 0 inside [rad]
    phi: np.ndarray
    cycles: np.ndarray  #: shape (k, n): Absolute pressure of each cycle [Pa]
    raw_mean: np.ndarray  #: shape (n,): Mean of the cycles as measured, neither pegged nor scaled [Pa]
    tdc: float  #: Angle of the file at firing TDC [rad]
    #: How far it may be off; None for a given dead centre, inf if the search's assumptions upset it [rad]
    tdc_uncertainty: float | None
    offsets: np.ndarray  #: shape (k,): What was taken off each cycle [Pa]
    scale: float  #: Factor on what remained [-]
    line: Line  #: Compression line fitted to `raw_mean`, before scaling
    comments: tuple[str, ...]


def measured_cycles(diagram: Diagram, cylinder: Chamber) -> MeasuredCycles:
    """Read a diagram file and make absolute pressure over the crank angle of it."""
    if not diagram.file:
        raise BadInput(
            "the diagram has no file; name it with --set cycle.file=FILE (or --diagram FILE of hinge, forces, cycle)"
        )
    period = period_of(diagram)
    recording = read_diagram(diagram.file, period, diagram.angle_column, diagram.pressure_column)
    angle, raw = cut_cycles(recording, period)
    tdc, uncertainty = _dead_centre(diagram, cylinder, angle, raw.mean(axis=0))
    # the row starts before TDC and ends behind it, whatever the file calls its angles
    phi = angle - tdc - period * math.ceil((angle[0] - tdc) / period)
    line = fit_line(*around_compression(phi, raw.mean(axis=0), period), cylinder, window(diagram))
    offsets = _offsets(diagram, cylinder, phi, raw)
    scale = _scale(diagram, phi, raw.mean(axis=0) - offsets.mean(), line)
    cycles = scale * (raw - offsets[:, None])
    _refuse_negative(diagram.file, cycles)
    return MeasuredCycles(
        file=diagram.file,
        period=period,
        phi=phi,
        cycles=cycles,
        raw_mean=raw.mean(axis=0),
        tdc=tdc,
        tdc_uncertainty=uncertainty,
        offsets=offsets,
        scale=scale,
        line=line,
        comments=recording.comments,
    )


def _refuse_negative(file: str, cycles: np.ndarray) -> None:
    # noise may push single samples of a throttled engine below zero, the mean cycle not
    lowest = float(cycles.mean(axis=0).min())
    if lowest <= 0:
        raise BadInput(
            f"{file}: the absolute pressure of the mean cycle falls to {lowest / 1e5:.3g} bar; "
            "choose another pegging or dead centre (inlet, polytropic; alignment, fit_from, fit_to)"
        )


def _dead_centre(
    diagram: Diagram, cylinder: Chamber, angle: np.ndarray, mean: np.ndarray
) -> tuple[float, float | None]:
    if diagram.alignment == "given":
        return diagram.tdc_offset, None
    top = _peak_angle(angle, mean)
    if diagram.alignment == "motored_peak":
        return top + diagram.loss_angle, _MOTORED_UNCERTAINTY
    guess = top - math.radians(15.0)
    period = period_of(diagram)
    shift = find_dead_centre(*around_compression(angle - guess, mean, period), cylinder, window(diagram))
    if not math.isfinite(shift):
        raise BadInput(
            f"{diagram.file}: no dead centre makes the compression line straight; is it of this engine? In a [cycle] "
            "of kind = 'diagram' change fit_from, fit_to or n_c, or give the dead centre with alignment = 'given', "
            "tdc_offset"
        )
    shifted = around_compression(angle - guess - shift, mean, period)
    return guess + shift, dead_centre_uncertainty(*shifted, cylinder, window(diagram))


def _peak_angle(angle: np.ndarray, mean: np.ndarray) -> float:
    # a parabola through the samples within 4 degrees of the highest one: noise moves a single sample by degrees
    at = int(np.argmax(mean))
    step = float(angle[1] - angle[0])
    reach = max(1, round(math.radians(4.0) / step))
    offsets = np.arange(-reach, reach + 1)
    c2, c1, _ = np.polyfit(offsets * step, np.take(mean, at + offsets, mode="wrap"), 2)
    return float(angle[at] - c1 / (2 * c2)) if c2 < 0 else float(angle[at])


def around_compression(phi: np.ndarray, values: np.ndarray, period: float) -> tuple[np.ndarray, np.ndarray]:
    """The same samples ordered so that compression is in one piece.

    Parameters
    ----------
    phi : ndarray, shape (n,)
        Crank angles of one period [rad]
    values : ndarray, shape (n,) or (k, n)
        Samples of pressure, crank angle last [Pa]
    period : float
        2 pi or 4 pi [rad]

    Returns
    -------
    phi : ndarray, shape (n,)
        Ascending from half a turn and 0.5 rad before TDC [rad]
    values : ndarray
        In the order of phi [Pa]
    """
    start = -math.pi - 0.5
    centred = start + np.remainder(phi - start, period)
    order = np.argsort(centred)
    return centred[order], values[..., order]


def _offsets(diagram: Diagram, cylinder: Chamber, phi: np.ndarray, raw: np.ndarray) -> np.ndarray:
    if diagram.pegging == "none":
        return np.zeros(len(raw))
    if diagram.pegging == "gauge":
        return np.full(len(raw), -diagram.p_back)
    ordered, rows = around_compression(phi, raw, period_of(diagram))
    if diagram.pegging == "inlet":
        near = np.abs(ordered + math.pi) <= _AT_BDC
        return rows[:, near].mean(axis=1) - diagram.inlet_pressure
    return np.array([fit_line(ordered, row, cylinder, window(diagram)).p_off for row in rows])


def _scale(diagram: Diagram, phi: np.ndarray, pegged: np.ndarray, line: Line) -> float:
    if diagram.scale == "trapped":
        return diagram.inlet_pressure / line.p_bdc
    if diagram.scale == "exhaust":
        behind = np.remainder(phi - _EXHAUST_MIDDLE + math.pi, 4 * math.pi) - math.pi
        return diagram.exhaust_pressure / float(pegged[np.abs(behind) <= _EXHAUST_REACH].mean())
    return 1.0
