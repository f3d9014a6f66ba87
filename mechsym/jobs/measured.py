"""Combustion of a case's measured diagram: case -> cylinder -> measured cycles -> what they tell."""

import dataclasses
import math
from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from mechsym import cases
from mechsym.cases import Case
from mechsym.cases.new_diagram import TraceSizes, diagram_case
from mechsym.cycle.chamber import Chamber, chamber_over
from mechsym.cycle.kinds import with_diagram
from mechsym.cycle.measured.alignment import DeadCentre, between
from mechsym.cycle.measured.checks import brake_doubt, diagram_doubts, exponent_doubts, speed_doubt
from mechsym.cycle.measured.combustion import Analysis, DeadCentreShift, DiagramCombustion, diagram_combustion
from mechsym.cycle.measured.diagram import Diagram, line_prior
from mechsym.cycle.measured.file import has_angles, read_diagram, recorded_speed
from mechsym.cycle.measured.heat_release import Combustion, CombustionFigures
from mechsym.cycle.measured.joint_fit import Prior
from mechsym.cycle.measured.measure import cycle_work, diagram_facts, measured_cycles, read_and_used
from mechsym.cycle.measured.shared_centre import USUAL, SensorLag, encoder_records, lag_of, shared_centre, without_lag
from mechsym.cycle.motion import piston_travel
from mechsym.errors import BadInput
from mechsym.files import write_text
from mechsym.jobs.gas import of, one_cylinder
from mechsym.plausible import Doubt
from mechsym.quantities import RPM
from mechsym.quantities.results import Columns, computed, part, quantity, result, seen

_DEG = 180 / math.pi


@result
class DeadCentreTold:
    """Firing dead centre on the scale of the file's angles."""

    deg: float = quantity("deg")  #: Angle of the file, modulo 360 degrees
    #: It holds the truth 19 times in 20; its ends stay beside the value and may lie below 0 or above 360
    interval_deg: list[float] = quantity("deg")
    method: str = part()
    prior_share: float | None = quantity("-")  #: Share of the variance that is assumed and not measured
    loss_angle_deg: float | None = quantity("deg")  #: From the motored peak to the dead centre


@result
class LagTold:
    """What cycles of several speeds say of the sensor's lag."""

    seconds: float = quantity("s")  #: Middle of the interval
    interval_seconds: list[float] = quantity("s")  #: It holds the truth 19 times in 20
    usual_seconds: list[float] = quantity("s")  #: Of any sensor
    told: bool = part()  #: Whether the interval is narrower than what is usual
    speeds_rpm: list[float] = quantity("rpm")  #: Lowest and highest
    dead_centre_deg: float | None = quantity("deg")  #: Without the lag, where it is told
    dead_centre_interval_deg: list[float] | None = quantity("deg")  #: It holds the truth 19 times in 20


@result
class MeasuredCycle:
    """One cycle of a record; angles from firing dead centre."""

    cycle: int = quantity("-")  #: From 1
    mep_bar: float = quantity("bar")  #: Mean indicated pressure, net
    p_max_bar: float = quantity("bar")  #: Peak pressure, absolute
    p_max_deg: float = quantity("deg")  #: Where that is
    heat_j: float = quantity("J")  #: Heat released
    burn_10_deg: float = quantity("deg")  #: Where a tenth is burnt
    burn_50_deg: float = quantity("deg")  #: Where half is burnt
    burn_90_deg: float = quantity("deg")  #: Where nine tenths are burnt
    n_compression: float = quantity("-")  #: Exponent of the line before burning
    n_expansion: float = quantity("-")  #: Exponent of the line behind burning
    weak: bool = part()  #: Whether it does less than 0.7 of the median work
    speed_rpm: float | None = quantity("rpm")  #: By the file's times


@result
class RecordAmongOthers:
    """One of several records of an encoder."""

    file: str = part()
    speed_rpm: float = quantity("rpm")  #: By the file's times, else of the case
    dead_centre_deg: float = quantity("deg")  #: Its own: the lag of the sensor moves it with the speed
    imep_bar: float = quantity("bar")  #: Net indicated mean pressure, mean over the cycles
    imep_interval_bar: list[float] = quantity("bar")  #: It holds the truth 19 times in 20
    cov_imep: float | None = quantity("-")  #: Deviation of the net IMEP by its mean
    p_max_bar: float = quantity("bar")  #: Peak, absolute, mean over the cycles
    ca50_deg: float | None = quantity("deg")  #: Half is burnt
    n_compression: float = quantity("-")  #: Exponent of the line before burning
    n_expansion: float = quantity("-")  #: Exponent of the line behind burning


@result
class MeasuredDiagram:
    """A measured diagram taken apart."""

    figures: CombustionFigures = part(inline=True)
    combustion: DiagramCombustion
    centre: DeadCentre  #: Of this record, or of all records of the encoder at their mean speed
    omega: float  #: By the file's times, else of the case [rad/s]
    mep: float  #: Mean indicated pressure, net, mean over the cycles [Pa]
    sensor: SensorLag | None  #: What cycles of several speeds say of the sensor's lag; None where they have one
    line: str
    facts: tuple[str, ...]  #: What was assumed on the way, and what came out
    judged: tuple[Doubt, ...]
    others: "tuple[MeasuredDiagram, ...]" = ()  #: Further records of the encoder

    @computed()
    def records(self) -> list[RecordAmongOthers]:
        """All records that share the dead centre, this one first; empty where it is alone."""
        if not self.others:
            return []
        return [
            RecordAmongOthers(
                file=one.combustion.measured.file, speed_rpm=one.speed_rpm,
                dead_centre_deg=one.combustion.measured.tdc * _DEG % 360, imep_bar=one.figures.imep_bar,
                imep_interval_bar=one.figures.imep_interval_bar, cov_imep=one.figures.cov_imep,
                p_max_bar=one.figures.p_max_bar, ca50_deg=one.figures.ca50_deg, n_compression=one.n_compression,
                n_expansion=one.n_expansion,
            )
            for one in (self, *self.others)
        ]  # fmt: skip

    @computed()
    def dead_centre(self) -> DeadCentreTold:
        """Firing dead centre."""
        centre = self.centre
        deg, loss = centre.angle * _DEG % 360, centre.loss_angle
        return DeadCentreTold(
            deg=deg,
            interval_deg=[deg + (end - centre.angle) * _DEG for end in (centre.low, centre.high)],
            method=centre.method,
            prior_share=centre.prior_share,
            loss_angle_deg=None if loss is None else loss * _DEG,
        )

    @computed()
    def lag(self) -> LagTold | None:
        """Lag of the sensor, where the cycles have several speeds; its interval, and if told the centre without it."""
        lag, alignment = self.sensor, self.combustion.measured.alignment
        if lag is None:
            return None
        # of a dead centre from elsewhere this record does not know at which speed it was found
        centre = without_lag(alignment.dead_centre, lag) if lag.told and alignment.own is None else None
        deg, half = (None, None) if centre is None else (centre[0] * _DEG % 360, centre[1] * _DEG)
        return LagTold(
            seconds=lag.lag, interval_seconds=[lag.lag - lag.half, lag.lag + lag.half], usual_seconds=list(USUAL),
            told=lag.told, speeds_rpm=[speed / RPM for speed in lag.speeds], dead_centre_deg=deg,
            dead_centre_interval_deg=None if deg is None or half is None else [deg - half, deg + half],
        )  # fmt: skip

    @computed("rpm")
    def speed_rpm(self) -> float:
        """By the file's times, else of the case."""
        return self.omega / RPM

    @computed("bar")
    def mep_bar(self) -> float:
        """Mean indicated pressure, net, mean over the cycles."""
        return self.mep / 1e5

    @computed("-")
    def n_compression(self) -> float:
        """Exponent of the line before burning, mean over the cycles."""
        return float(np.mean([c.n_compression for c in self.combustion.cycles]))

    @computed("-")
    def n_expansion(self) -> float:
        """Exponent of the line behind burning, mean over the cycles."""
        return float(np.mean([c.n_expansion for c in self.combustion.cycles]))

    read_and_used: str = seen("line")  #: What was read of the file and what was used of it
    scale: float = seen("combustion.measured.scale", "-")  #: What the file's pressures are multiplied with

    @computed()
    def cycles(self) -> list[MeasuredCycle]:
        """Cycle by cycle."""
        speeds = self.combustion.measured.speeds
        rows = []
        for k, cycle in enumerate(self.combustion.cycles):
            burn_10, burn_50, burn_90 = (math.degrees(angle) for angle in cycle.burn_angles)
            rows.append(MeasuredCycle(
                cycle=k + 1, mep_bar=cycle.mean_indicated / 1e5, p_max_bar=cycle.p_max / 1e5,
                p_max_deg=math.degrees(cycle.phi_p_max), heat_j=cycle.heat, burn_10_deg=burn_10, burn_50_deg=burn_50,
                burn_90_deg=burn_90, n_compression=cycle.n_compression, n_expansion=cycle.n_expansion,
                weak=k in self.combustion.weak, speed_rpm=None if speeds is None else float(speeds[k]) / RPM,
            ))  # fmt: skip
        return rows

    @computed("-")
    def weak_cycles(self) -> list[int]:
        """Cycles with less than 0.7 of the median work, from 1."""
        return [k + 1 for k in self.combustion.weak]

    mean: Combustion = seen("combustion.mean")  #: Of the mean cycle

    @computed()
    def wiebe(self) -> Columns | None:
        """Wiebe function through the burnt fraction of the mean cycle."""
        fit = self.combustion.wiebe
        return None if fit is None else fit.columns

    @computed()
    def double_wiebe(self) -> Columns | None:
        """Double Wiebe function through the same."""
        fit = self.combustion.double_wiebe
        return None if fit is None else fit.columns

    #: Charge line of the joint fit: exponent, dead centre, pressure when the inlet closes
    compression_line: Columns = seen("combustion.line.columns")
    trapped_mass: float = seen("combustion.mass", "kg")  #: Gas in the cylinder, from that line

    @computed("deg")
    def tdc_uncertainty_deg(self) -> float | None:
        """Of the dead centre."""
        spread = self.combustion.tdc_uncertainty
        return None if spread is None else spread * _DEG

    per_degree: DeadCentreShift = seen("combustion.per_degree")  #: What a dead centre one degree later changes
    uncertainty: DeadCentreShift = seen("combustion.uncertainty")  #: What the uncertainty of the dead centre changes

    @computed()
    def doubts(self) -> tuple[Doubt, ...]:
        """What of the record is possible and not usual."""
        known = exponent_doubts(
            self.n_compression, None if self.combustion.measured.alignment.motored else self.n_expansion, self.judged
        )
        beside = (
            dataclasses.replace(doubt, quantity=f"{Path(one.combustion.measured.file).name}: {doubt.quantity}")
            for one in self.others
            for doubt in one.doubts
        )
        return (*self.judged, *known, *beside)


def measured_combustion(case: Case, files: Sequence[str] = (), motored: str | None = None) -> MeasuredDiagram:
    """Take the measured diagram of a case apart; several of one encoder and sensor share their dead centre.

    case: with `[parameters]` and `[cycle]`; `[combustion]` holds the assumptions of the analysis. files: CSV files in
    place of the case's. motored: CSV file of a record without combustion on the same encoder, in place of the case's.
    Raises BadInput: the file is refused, or the diagram cannot be aligned.
    """
    diagrams = [with_diagram(case.need("cycle"), file, motored) for file in files or (None,)]
    if (again := next((file for k, file in enumerate(files) if file in files[:k]), None)) is not None:
        raise BadInput(f"--diagram {again} is named twice; a record tells nothing more the second time, leave it out")
    seen = one_cylinder(case)
    with of(case):
        travel = piston_travel(seen.mechanism, seen.need("parameters"))
    cylinder = chamber_over(travel, diagrams[0].bore, diagrams[0].compression_ratio)
    if len(diagrams) == 1 or diagrams[0].motored or diagrams[0].alignment != "compression_line":
        first, *others = (_taken_apart(case, diagram, cylinder) for diagram in diagrams)
        return dataclasses.replace(first, others=tuple(others))
    records = encoder_records(diagrams, cylinder, case.need("operation").speed)
    shared = shared_centre(records, cylinder, between(diagrams[0]), line_prior(diagrams[0]))
    first, *others = (
        _taken_apart(case, diagram, cylinder, own)
        for diagram, own in zip(diagrams, zip(shared.records, shared.priors, strict=True), strict=True)
    )
    return dataclasses.replace(first, others=tuple(others), centre=shared.centre)


_TRIED = (("four-stroke", "checked"), ("four-stroke", "exhaust"), ("two-stroke", "checked"))


def case_of_trace(trace: Path, sizes: TraceSizes, folder: Path) -> tuple[str, tuple[Doubt, ...]]:
    """Text of the case of a measured pressure, and what is doubted of it when it is taken apart.

    folder: where the case will stand. Raises BadInput: no cycle and no scale makes a cylinder pressure of it; as the
    first of them says.
    """
    by_time, refused = not has_angles(trace), None
    for working, scale in _TRIED:
        turn = (4 if working == "four-stroke" else 2) * math.pi
        try:
            recorded = recorded_speed(read_diagram(trace, turn, omega=sizes.speed if by_time else None))
            beside = diagram_case(trace, sizes, folder, recorded, working, scale, by_time)
            with TemporaryDirectory() as there:
                case = cases.load(str(write_text(Path(there) / "trace.toml", beside)))
                measured = measured_combustion(case, [str(trace)])
        except BadInput as error:
            refused = refused or error
            continue
        doubts = (*case.doubts, *measured.doubts)
        if sizes.compression is None:
            why = "dead centre, heat and burn angles hang on it: give --compression, geometric"
            ratio = case.need("cycle").compression_ratio
            doubts += (Doubt(code="compression", quantity="compression ratio, assumed [-]", value=ratio,
                             usual="as built", why=why),)  # fmt: skip
        return beside, tuple(dict.fromkeys(doubts))
    raise refused or BadInput(f"{trace}: no cylinder pressure")


def _taken_apart(
    case: Case, cycle: Diagram, cylinder: Chamber, shared: tuple[DeadCentre, Prior] | None = None
) -> MeasuredDiagram:
    measured = measured_cycles(cycle, cylinder, shared)
    speed = case.need("operation").speed
    omega = speed if measured.speeds is None else float(measured.speeds.mean())
    combustion = diagram_combustion(measured, cylinder, case.sections.get("combustion", Analysis()), omega)
    mep = float(cycle_work(measured, cylinder).mean())
    doubts = diagram_doubts(cycle, cylinder, measured, combustion.mean.phi_p_max)
    # several records are of several speeds: that tells the losses from a shift of the dead centre
    beside = [] if measured.speeds is None or shared else [speed_doubt(float(measured.speeds.mean()), speed)]
    if "measured" in case.sections and mep > 0:
        torque, swept = case.sections["measured"].torque, float(cylinder.displacement)
        beside.append(brake_doubt(torque, mep, swept, measured.period))
    return MeasuredDiagram(
        figures=combustion.figures, combustion=combustion, centre=measured.alignment.dead_centre, omega=omega, mep=mep,
        sensor=lag_of(measured, cylinder, cycle), line=read_and_used(cycle, measured),
        facts=diagram_facts(cycle, cylinder, measured),
        judged=doubts + tuple(doubt for doubt in beside if doubt is not None),
    )  # fmt: skip
