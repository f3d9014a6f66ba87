"""From the cycles of a record to its dead centre, by the method of the case, and to the charge line through it."""

import dataclasses
import math

import numpy as np

from mechsym.cycle.chamber import Chamber
from mechsym.cycle.measured.cycles import cut_cycles
from mechsym.cycle.measured.dead_centre import (
    DeadCentre,
    behind_peak,
    carried,
    from_compression,
    from_motored,
    given,
    is_motored,
    peak_angle,
    widened,
)
from mechsym.cycle.measured.diagram import Diagram, line_prior, period_of
from mechsym.cycle.measured.file import Recording, read_diagram
from mechsym.cycle.measured.joint_fit import JointFit, Prior, joint_fit
from mechsym.cycle.measured.sanity import refuse_no_cylinder
from mechsym.cycle.measured.smoothing import noise
from mechsym.cycle.measured.swing import without_drift
from mechsym.cycle.measured.timing import spread_error, turn_speeds
from mechsym.errors import BadInput
from mechsym.quantities import record
from mechsym.quantities.units import Array, Pascal, Radian

_PINNED = 1e-6
_DEG = math.radians(1.0)
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
    found = carried(shared[0], at, mean) if shared else _named(diagram, cylinder, at, mean)
    chosen = own if found is None else found
    _refuse_far(diagram, chosen, peak_angle(at, mean))
    phi, ordered = in_one_piece(angle - chosen.angle, rows.mean(axis=0), period, start=-math.pi - 0.5)
    if found is not None:
        pinned = dataclasses.replace(shared[1] if shared else prior, tdc=(0.0, _PINNED))
        line = joint_fit(phi, ordered, cylinder, between(diagram), noise(ordered), pinned, [0.0])
    line = dataclasses.replace(line, tdc=0.0)
    _refuse_no_line(recording.file, line, float(np.ptp(mean)))
    turns = turn_speeds(recording)
    spread = None if turns is None else spread_error(turns, phi, ordered - line.offset, cylinder, -chosen.angle)
    if spread is not None and diagram.alignment != "given" and not shared:
        chosen = widened(chosen, spread)
    return Alignment(
        dead_centre=chosen, fit=line, own=None if found is None else own, motored=motored, spread=spread
    )  # fmt: skip


def _named(diagram: Diagram, cylinder: Chamber, at: np.ndarray, mean: np.ndarray) -> DeadCentre | None:
    """The dead centre that does not come from the record's own line."""
    if diagram.alignment == "given":
        return given(diagram.tdc_offset + _period_before(diagram, peak_angle(at, mean)))
    if diagram.alignment == "motored_peak":
        return behind_peak(peak_angle(at, mean), diagram.loss_angle)
    return carried(motored_file(diagram, cylinder), at, mean) if diagram.motored else None


def _period_before(diagram: Diagram, top: float) -> float:
    period = period_of(diagram)
    return period * round((top - 12 * _DEG - diagram.tdc_offset) / period)


def _refuse_far(diagram: Diagram, found: DeadCentre, top: float) -> None:
    behind = top - found.angle
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
        f"({found.method}), which no cylinder has; {mend}"
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
