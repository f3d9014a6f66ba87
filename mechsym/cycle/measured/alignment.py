r"""Where the firing dead centre of a measured record lies, and between which angles it lies 19 times in 20.

given          the case says it
motored_peak   peak of a motored record plus a loss angle that the case says
motored        a record without combustion, the file itself or another one on the same encoder: its line is fitted
               through the dead centre, where the asymmetry of compression and expansion tells the losses
compression    joint fit of the compression line alone: one to two degrees, for the losses are assumed

From the cycles of a record to its dead centre, by the method of the case, and to the charge line through it.
"""

import dataclasses
import math

import numpy as np

from mechsym.cycle.chamber import Chamber
from mechsym.cycle.measured.diagram import Diagram, line_prior, period_of
from mechsym.cycle.measured.file import Recording, cut_cycles, read_diagram, spread_error, turn_speeds
from mechsym.cycle.measured.joint_fit import JointFit, Prior, joint_fit
from mechsym.cycle.measured.signal import noise, refuse_no_cylinder, without_drift
from mechsym.errors import BadInput
from mechsym.quantities import record
from mechsym.quantities.units import NORMAL_95, Array, Pascal, Pure, Radian

_DEG = math.radians(1.0)
_EARLIER, _BURNS = (0.0, 8.0 * _DEG), 1.4
ENCODER = 0.2 * _DEG  # what no line tells of: its mounting, its teeth
THROUGH = (-60.0 * _DEG, 60.0 * _DEG)
_LOSS_ANGLE, _STARTS = (0.6 * _DEG, 0.6 * _DEG), (-18.0, -5.0)
_MOTORED = 0.004  # of the swing: a line without combustion leaves a tenth of it, the weakest one with it twice as much


@record
class DeadCentre:
    """Firing dead centre on the scale of a file's angles."""

    angle: float  #: Angle of the file at firing TDC, or at that of its period's first turn [rad]
    low: float  #: Lower end of the 95 % interval [rad]
    high: float  #: Upper end [rad]
    method: str
    prior_share: (
        float | None
    )  #: Share of the variance that is assumed and not measured; None where nothing is fitted [-]
    loss_angle: float | None = None  #: From the motored peak to the dead centre, where there is such a peak [rad]


def given(angle: Radian) -> DeadCentre:
    """A dead centre that the case says. angle: angle of the file at firing TDC."""
    return DeadCentre(angle=angle, low=angle, high=angle, method="given", prior_share=None)


def behind_peak(peak: Radian, loss_angle: Radian) -> DeadCentre:
    """A dead centre behind the peak of a motored record.

    peak: angle of the file at the peak; loss_angle: from the peak to the dead centre, as the case says.
    """
    # heat and blow-by move the peak by 0.2 to 1.4 degrees, whatever a case assumes
    return interval(
        peak + loss_angle, 0.3 * _DEG, "motored peak and loss angle", prior_share=1.0, loss_angle=loss_angle
    )


def from_compression(
    angle: Radian[Array], mean: Pascal[Array], cylinder: Chamber, between: tuple[Radian, Radian], prior: Prior
) -> tuple[DeadCentre, JointFit]:
    """Dead centre of a fired record from its compression line.

    angle: ascending angles of one period, compression in one piece; mean: measured pressure of the mean cycle; between:
    ends of the line from the dead centre.
    """
    top = peak_angle(angle, mean)
    inside = (top - 60 * _DEG, top + 4 * _DEG)
    starts = [prior.tdc[0]] if prior.tdc else [top + s * _DEG for s in _STARTS]
    ends = [(between[0], between[1] - by) for by in _EARLIER if between[1] - by - between[0] > 25 * _DEG]
    fits = [joint_fit(angle, mean, cylinder, end, noise(mean), prior, starts, inside) for end in ends]
    # where an earlier end leaves far less, something burns before the end that the case names
    fit = fits[0]
    for earlier in fits[1:]:
        fit = earlier if fit.sigma > _BURNS * earlier.sigma else fit
    spread = math.hypot(math.sqrt(fit.covariance[0, 0]), ENCODER)
    share = 1 - (1 - fit.prior_share) * fit.covariance[0, 0] / spread**2
    return interval(fit.tdc, spread, "compression line", prior_share=share), fit


def from_motored(
    angle: Radian[Array], mean: Pascal[Array], cylinder: Chamber, prior: Prior, method: str
) -> tuple[DeadCentre, JointFit]:
    """Dead centre of a record without combustion from compression and expansion together.

    angle: ascending angles of one period, compression in one piece; mean: measured pressure of the mean cycle.
    """
    top = peak_angle(angle, mean)
    start = prior.tdc[0] if prior.tdc else top + _LOSS_ANGLE[0]
    fit = joint_fit(angle, mean, cylinder, THROUGH, noise(mean), prior, [start])
    spread = math.hypot(math.sqrt(fit.covariance[0, 0]), ENCODER)
    share = 1 - (1 - fit.prior_share) * fit.covariance[0, 0] / spread**2
    return interval(fit.tdc, spread, method, prior_share=share, loss_angle=fit.tdc - top), fit


def is_motored(angle: Radian[Array], mean: Pascal[Array], cylinder: Chamber, prior: Prior) -> bool:
    """Whether one line of trapped charge goes through compression and expansion: nothing burns.

    angle: ascending angles of one period, compression in one piece; mean: measured pressure of the mean cycle.
    """
    top, sigma = peak_angle(angle, mean), noise(mean)
    pinned = Prior(n0=prior.n0, tdc=(top + _LOSS_ANGLE[0], _LOSS_ANGLE[1]))
    fit = joint_fit(angle, mean, cylinder, THROUGH, sigma, pinned, [top + _LOSS_ANGLE[0]])
    return math.sqrt(max(fit.rms**2 - sigma**2, 0.0)) < _MOTORED * float(np.ptp(mean))


def carried(centre: DeadCentre, angle: Radian[Array], mean: Pascal[Array]) -> DeadCentre:
    """The dead centre of a motored record on the angles of a fired one of the same encoder.

    angle: ascending angles of one period of the fired record; mean: its measured pressure.
    """
    # an encoder knows whole turns: the one is taken whose dead centre lies just before the peak of combustion
    expected = peak_angle(angle, mean) - 12 * _DEG
    moved = 2 * math.pi * round((expected - centre.angle) / (2 * math.pi))
    return dataclasses.replace(centre, angle=centre.angle + moved, low=centre.low + moved, high=centre.high + moved)


def widened(centre: DeadCentre, by: Radian) -> DeadCentre:
    """The same dead centre in an interval that is wider. by: on both sides."""
    return dataclasses.replace(centre, low=centre.low - by, high=centre.high + by)


def peak_angle(angle: Radian[Array], mean: Pascal[Array]) -> Radian:
    """Angle of the highest pressure, by a parabola: noise moves a single sample by degrees.

    angle: evenly spaced angles of one period; mean: measured pressure. Returns peak: angle of the file.
    """
    at = int(np.argmax(mean))
    step = float(angle[1] - angle[0])
    reach = max(2, round(5.0 * _DEG / step))
    offsets = np.arange(-reach, reach + 1)
    c2, c1, _ = np.polyfit(offsets * step, np.take(mean, at + offsets, mode="wrap"), 2)
    # a stretch that is not bent downwards, or not there, has no peak
    inside = c2 < 0 and abs(c1 / (2 * c2)) < reach * step
    return float(angle[at] - c1 / (2 * c2)) if inside else float(angle[at])


def interval(
    angle: Radian, spread: Radian, method: str, prior_share: Pure | None = None, loss_angle: Radian | None = None
) -> DeadCentre:
    """A dead centre with its 95 % interval. spread: standard deviation; the others as in `DeadCentre`."""
    low, high = angle - NORMAL_95 * spread, angle + NORMAL_95 * spread
    return DeadCentre(angle=angle, low=low, high=high, method=method, prior_share=prior_share, loss_angle=loss_angle)


_PINNED = 1e-6
_WORST_LINE = 0.02  # of the swing: what a charge line leaves of a signal that is none


@record
class Alignment:
    """Where the dead centre of a record lies, and its charge line."""

    dead_centre: DeadCentre
    fit: JointFit  #: Charge line through that dead centre, over the crank angle from it
    own: DeadCentre | None  #: What the compression line alone says, where the dead centre comes from elsewhere
    motored: bool  #: Nothing burns in the record
    spread: (
        float | None
    )  #: How far angles are off that were spread evenly over each turn; None where they were not [rad]


def sound_cycles(file: str, diagram: Diagram, cylinder: Chamber) -> tuple[Recording, Radian[Array], Pascal[Array]]:
    """A recording and its cycles, refused where no cylinder made them.

    Returns recording: as it stands in the file; angle: evenly spaced angles of the first cycle, zero as in the file;
    rows: measured pressure, without drift where its offset is sought anyway, shape (k, n).
    """
    period = period_of(diagram)
    recording = read_diagram(file, period, diagram.angle_column, diagram.pressure_column, diagram.recorded_speed)
    angle, rows = cut_cycles(recording, period)
    steps = np.abs(np.diff(recording.pressure))
    refuse_no_cylinder(file, angle, rows, cylinder, period, float(steps[steps > 0].min()))
    return recording, angle, rows if diagram.pegging in ("none", "gauge") else without_drift(rows)


def align(
    diagram: Diagram,
    cylinder: Chamber,
    recording: Recording,
    angle: Radian[Array],
    rows: Pascal[Array],
    shared: tuple[DeadCentre, Prior] | None = None,
) -> Alignment:
    """Find the dead centre by the method of the case, and the charge line through it.

    angle: evenly spaced angles of the first cycle, zero as in the file; rows: measured pressure, shape (k, n). shared:
    what several records of the encoder say of this one, in place of the method of the case.
    """
    period, prior = period_of(diagram), line_prior(diagram)
    at, mean = in_one_piece(angle, rows.mean(axis=0), period)
    motored = is_motored(at, mean, cylinder, prior)
    if motored:
        own, line = from_motored(at, mean, cylinder, prior, "motored record")
    else:
        own, line = from_compression(at, mean, cylinder, between(diagram), prior)
    centre = carried(shared[0], at, mean) if shared else _named(diagram, cylinder, at, mean)
    chosen = own if centre is None else centre
    _refuse_far(diagram, chosen, peak_angle(at, mean))
    phi, ordered = in_one_piece(angle - chosen.angle, rows.mean(axis=0), period, start=-math.pi - 0.5)
    if centre is not None:
        pinned = dataclasses.replace(shared[1] if shared else prior, tdc=(0.0, _PINNED))
        line = joint_fit(phi, ordered, cylinder, between(diagram), noise(ordered), pinned, [0.0])
    line = dataclasses.replace(line, tdc=0.0)
    _refuse_no_line(recording.file, line, float(np.ptp(mean)))
    turns = turn_speeds(recording)
    spread = None if turns is None else spread_error(turns, phi, ordered - line.offset, cylinder, -chosen.angle)
    if spread is not None and diagram.alignment != "given" and not shared:
        chosen = widened(chosen, spread)
    return Alignment(dead_centre=chosen, fit=line, own=None if centre is None else own, motored=motored, spread=spread)


def _named(diagram: Diagram, cylinder: Chamber, at: np.ndarray, mean: np.ndarray) -> DeadCentre | None:
    """The dead centre that does not come from the record's own line."""
    if diagram.alignment == "given":
        period = period_of(diagram)
        return given(
            diagram.tdc_offset + (period * round((peak_angle(at, mean) - 12 * _DEG - diagram.tdc_offset) / period))
        )
    if diagram.alignment == "motored_peak":
        return behind_peak(peak_angle(at, mean), diagram.loss_angle)
    return carried(motored_file(diagram, cylinder), at, mean) if diagram.motored else None


def _refuse_far(diagram: Diagram, centre: DeadCentre, top: float) -> None:
    behind = top - centre.angle
    if -15 * _DEG < behind < 60 * _DEG:
        return
    mend = (
        f"is tdc_offset = {math.degrees(diagram.tdc_offset):.5g} deg the firing dead centre on the scale of the file, "
        "or that of the gas exchange a turn away?"
        if diagram.alignment == "given"
        else "change fit_from, fit_to or compression_ratio, or give it with alignment = 'given', tdc_offset"
    )
    raise BadInput(
        f"{diagram.file}: the highest pressure lies {math.degrees(behind):.1f} deg behind the dead centre "
        f"({centre.method}), which no cylinder has; {mend}"
    )


def between(diagram: Diagram) -> tuple[Radian, Radian]:
    """Ends of the compression line.

    Returns first, last: from the dead centre.
    """
    return diagram.fit_from, diagram.fit_to


def motored_file(diagram: Diagram, cylinder: Chamber) -> DeadCentre:
    """Dead centre of the motored record that the case names."""
    _, angle, rows = sound_cycles(diagram.motored, diagram, cylinder)
    at, mean = in_one_piece(angle, rows.mean(axis=0), period_of(diagram))
    if not is_motored(at, mean, cylinder, line_prior(diagram)):
        raise BadInput(
            f"{diagram.motored}: no motored record, something burns in it (compression and expansion do not follow one "
            "line of trapped charge); give a record without ignition and fuel, of this engine, or leave it out"
        )
    return from_motored(at, mean, cylinder, line_prior(diagram), "motored file")[0]


def in_one_piece(
    angle: Radian[Array], values: Pascal[Array], period: Radian, start: Radian | None = None
) -> tuple[Radian[Array], Pascal[Array]]:
    """The same samples ordered so that compression, combustion and expansion are in one piece.

    angle: evenly spaced angles of one period. values: samples of pressure, crank angle last. period: 2 pi or 4 pi.
    start: where the order begins; half a turn and 0.8 rad before the highest pressure by default. Returns angle:
    ascending; values: in the order of the angles.
    """
    if start is None:
        start = float(angle[int(np.argmax(values))]) - math.pi - 0.8
    moved = start + np.remainder(angle - start, period)
    order = np.argsort(moved)
    return moved[order], values[..., order]


def _refuse_no_line(file: str, fit: JointFit, swing: float) -> None:
    # noise is no misfit: only what hangs together counts
    if fit.sigma > 5 * _WORST_LINE * swing or (fit.rms > _WORST_LINE * swing and fit.sigma > 2 * fit.rms):
        raise BadInput(
            f"{file}: no charge line fits, {100 * fit.rms / swing:.1f} % of the swing are left; is it a cylinder "
            "pressure of this engine? Else change fit_from, fit_to, compression_ratio"
        )
