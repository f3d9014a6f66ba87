"""A measured indicator diagram made usable: cut into cycles, aligned with the dead centre, pegged, scaled.

Every cycle is pegged by itself (sensors drift) and kept by itself, for whoever takes single cycles apart. What each
step assumed is in the inputs, what it found in the result.
"""

import math

import numpy as np

from mechsym.cycle.chamber import Chamber
from mechsym.cycle.measured.alignment import Alignment, align, between, in_one_piece, sound_cycles
from mechsym.cycle.measured.charge_line import ChargeShape, log_pressure
from mechsym.cycle.measured.dead_centre import DeadCentre
from mechsym.cycle.measured.diagram import Diagram, period_of
from mechsym.cycle.measured.joint_fit import JointFit, Prior, cycle_lines
from mechsym.cycle.measured.swing import without_swing
from mechsym.cycle.measured.timing import cycle_speeds
from mechsym.errors import BadInput
from mechsym.quantities import record
from mechsym.quantities.units import Array, Pascal, Radian

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
        found = self.alignment.dead_centre
        return None if found.method == "given" else (found.high - found.low) / 2


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
    found = align(diagram, cylinder, recording, angle, read, shared)
    # the row starts before TDC and ends behind it, whatever the file calls its angles
    phi = angle - found.dead_centre.angle
    phi = phi - period * math.ceil(phi[0] / period)
    raw = read
    if diagram.scale == "swing" and diagram.inlet_pressure is not None:
        inlet, exhaust = (_behind(phi, at, reach) for at, reach in (_INLET, _EXHAUST))
        raw = without_swing(read, 2, inlet, exhaust, diagram.exhaust_pressure - diagram.inlet_pressure)
    shape, drift = _pegging_line(diagram, found.fit)
    on_line, levels = cycle_lines(*around_compression(phi, raw, period), cylinder, between(diagram), shape, drift)
    offsets, level = _offsets(diagram, phi, raw, on_line), float(levels.mean())
    bottom = level * math.exp(float(log_pressure(cylinder, _BDC, shape)[0][0]))
    scale = _scale(diagram, phi, raw.mean(axis=0) - offsets.mean(), bottom)
    cycles = scale * (raw - offsets[:, None])
    _refuse_negative(diagram.file, cycles)
    return MeasuredCycles(
        file=diagram.file,
        period=period,
        phi=phi,
        cycles=cycles,
        raw_mean=read.mean(axis=0),
        alignment=found,
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


def _refuse_negative(file: str, cycles: np.ndarray) -> None:
    # noise may push single samples of a throttled engine below zero, the mean cycle not
    lowest = float(cycles.mean(axis=0).min())
    if lowest <= 0:
        raise BadInput(
            f"{file}: the absolute pressure of the mean cycle falls to {lowest / 1e5:.3g} bar; "
            "choose another pegging or dead centre (inlet, polytropic; alignment, fit_from, fit_to)"
        )


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
