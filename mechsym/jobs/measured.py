"""Combustion of a case's measured diagram: case -> cylinder -> measured cycles -> analysis -> JSON."""

import math
from dataclasses import asdict
from typing import Any

import numpy as np

from mechsym.cases import Case
from mechsym.cycle.dead_centres import chamber_over
from mechsym.cycle.kinds import with_diagram
from mechsym.cycle.measured.checks import brake_doubt, diagram_doubts, speed_doubt
from mechsym.cycle.measured.combustion import Analysis, DiagramCombustion, diagram_combustion, rows
from mechsym.cycle.measured.facts import cycle_work, read_and_used
from mechsym.cycle.measured.fits import Fit
from mechsym.cycle.measured.lag import USUAL, SensorLag, lag_of, without_lag
from mechsym.cycle.measured.measure import measured_cycles
from mechsym.cycle.motion import piston_travel
from mechsym.jobs.gas import of, one_cylinder
from mechsym.plausible import Doubt
from mechsym.quantities import RPM, record

_DEG = 180 / math.pi


@record
class MeasuredResult:
    """A measured diagram taken apart."""

    combustion: DiagramCombustion
    doubts: tuple[Doubt, ...]
    line: str  #: What was read and what was used
    mep: float  #: Mean indicated pressure, net, mean over the cycles [Pa]
    speed: float  #: By the file's times, else of the case [rad/s]
    lag: SensorLag | None  #: What cycles of several speeds say of the sensor's lag; None where they have one


def measured_combustion(case: Case, file: str | None = None, motored: str | None = None) -> MeasuredResult:
    """Take the measured diagram of a case apart.

    Parameters
    ----------
    case : Case
        With `[parameters]` and `[cycle]`; `[combustion]` holds the assumptions of the analysis
    file : str, optional
        CSV file in place of the case's
    motored : str, optional
        CSV file of a record without combustion on the same encoder, in place of the case's

    Raises
    ------
    BadInput
        The file is refused, or the diagram cannot be aligned
    """
    cycle = with_diagram(case.need("cycle"), file, motored)
    seen = one_cylinder(case)
    with of(case):
        travel = piston_travel(seen.mechanism, seen.need("parameters"))
    cylinder = chamber_over(travel, cycle.bore, cycle.compression_ratio)
    measured = measured_cycles(cycle, cylinder)
    found = diagram_combustion(measured, cylinder, case.sections.get("combustion", Analysis()))
    mep = float(cycle_work(measured, cylinder).mean())
    doubts = diagram_doubts(cycle, cylinder, measured, found.mean.phi_p_max)
    speed = case.need("operation").speed
    beside = [] if measured.speeds is None else [speed_doubt(float(measured.speeds.mean()), speed)]
    if "measured" in case.sections and mep > 0:
        torque, swept = case.sections["measured"].torque, float(cylinder.displacement)
        beside.append(brake_doubt(torque, mep, swept, measured.period))
    doubts += tuple(doubt for doubt in beside if doubt is not None)
    return MeasuredResult(
        combustion=found,
        doubts=doubts,
        line=read_and_used(cycle, measured),
        mep=mep,
        speed=speed if measured.speeds is None else float(measured.speeds.mean()),
        lag=lag_of(measured, cylinder, cycle),
    )


def summary(result: MeasuredResult) -> dict[str, Any]:
    """The analysis under the names and units of the command line.

    Returns
    -------
    summary : dict
        `dead_centre`, `lag`, `speed_rpm`, `mep_bar`, `n_compression`, `n_expansion`, `read_and_used`, `cycles` (rows),
        `weak_cycles` (from 1), `mean`, `wiebe`, `double_wiebe`, `compression_line`, `trapped_mass`,
        `tdc_uncertainty_deg`, `per_degree`, `uncertainty`, `doubts`
    """
    found = result.combustion
    spread, speeds = found.tdc_uncertainty, found.measured.speeds
    table = rows(found)
    for k, row in enumerate(table):
        row["speed_rpm"] = None if speeds is None else float(speeds[k]) / RPM
    return {
        "dead_centre": _dead_centre(found),
        "lag": None if result.lag is None else _lag(found, result.lag),
        "speed_rpm": result.speed / RPM,
        "mep_bar": result.mep / 1e5,
        "n_compression": float(np.mean([c.n_compression for c in found.cycles])),
        "n_expansion": float(np.mean([c.n_expansion for c in found.cycles])),
        "read_and_used": result.line,
        "scale": found.measured.scale,
        "cycles": table,
        "weak_cycles": [k + 1 for k in found.weak],
        "mean": asdict(found.mean),
        "wiebe": _fit(found.wiebe),
        "double_wiebe": _fit(found.double_wiebe),
        "compression_line": _fit(found.line),
        "trapped_mass": found.mass,
        "tdc_uncertainty_deg": None if spread is None else spread * _DEG,
        "per_degree": found.per_degree,
        "uncertainty": found.uncertainty,
        "doubts": [asdict(doubt) for doubt in result.doubts],
    }


def _dead_centre(found: DiagramCombustion) -> dict[str, Any]:
    """Modulo 360 degrees; the ends of the interval stay beside the value and may lie below 0 or above 360."""
    centre = found.measured.alignment.dead_centre
    deg = centre.angle * _DEG % 360
    loss = centre.loss_angle
    return {
        "deg": deg,
        "interval_deg": [deg + (end - centre.angle) * _DEG for end in (centre.low, centre.high)],
        "method": centre.method,
        "prior_share": centre.prior_share,
        "loss_angle_deg": None if loss is None else loss * _DEG,
    }


def _lag(found: DiagramCombustion, lag: SensorLag) -> dict[str, Any]:
    """Interval of the lag and whether it is narrower than what is usual; if so, the dead centre without it."""
    alignment = found.measured.alignment
    # of a dead centre from elsewhere this record does not know at which speed it was found
    centre = without_lag(alignment.dead_centre, lag) if lag.told and alignment.own is None else None
    deg, half = (None, None) if centre is None else (centre[0] * _DEG % 360, centre[1] * _DEG)
    return {
        "seconds": lag.lag,
        "interval_seconds": [lag.lag - lag.half, lag.lag + lag.half],
        "usual_seconds": list(USUAL),
        "told": lag.told,
        "speeds_rpm": [speed / RPM for speed in lag.speeds],
        "dead_centre_deg": deg,
        "dead_centre_interval_deg": None if deg is None or half is None else [deg - half, deg + half],
    }


def _fit(fit: Fit | None) -> dict[str, Any] | None:
    if fit is None:
        return None
    pairs = zip(fit.names, fit.values, fit.confidence, strict=True)
    return {"rms": fit.rms} | {name: {"value": value, "confidence": half} for name, value, half in pairs}
