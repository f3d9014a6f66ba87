"""Combustion of a case's measured diagram: case -> cylinder -> measured cycles -> analysis -> JSON."""

import math
from dataclasses import asdict
from typing import Any

from mechsym.cases import Case
from mechsym.cycle.chamber import chamber_over
from mechsym.cycle.kinds import with_diagram
from mechsym.cycle.measured.combustion import Analysis, DiagramCombustion, diagram_combustion, rows
from mechsym.cycle.measured.fits import Fit
from mechsym.cycle.measured.measure import measured_cycles
from mechsym.cycle.motion import piston_travel
from mechsym.jobs.gas import of, one_cylinder

_DEG = 180 / math.pi


def measured_combustion(case: Case, file: str | None = None) -> DiagramCombustion:
    """Take the measured diagram of a case apart.

    Parameters
    ----------
    case : Case
        With `[parameters]` and `[cycle]`; `[combustion]` holds the assumptions of the analysis
    file : str, optional
        CSV file in place of the case's

    Returns
    -------
    found : DiagramCombustion
        Cycle by cycle and for the mean

    Raises
    ------
    BadInput
        The file is refused, or the diagram cannot be aligned
    """
    cycle = with_diagram(case.need("cycle"), file) if file else case.need("cycle")
    seen = one_cylinder(case)
    with of(case):
        travel = piston_travel(seen.mechanism, seen.need("parameters"))
    cylinder = chamber_over(travel, cycle.bore, cycle.compression_ratio)
    return diagram_combustion(measured_cycles(cycle, cylinder), cylinder, case.sections.get("combustion", Analysis()))


def summary(found: DiagramCombustion) -> dict[str, Any]:
    """The analysis under the names and units of the command line.

    Returns
    -------
    summary : dict
        `cycles` (rows), `weak_cycles` (from 1), `mean`, `wiebe`, `double_wiebe`, `compression_line`, `trapped_mass`,
        `tdc_uncertainty_deg`, `per_degree`, `uncertainty`
    """
    spread = found.tdc_uncertainty
    return {
        "cycles": rows(found),
        "weak_cycles": [k + 1 for k in found.weak],
        "mean": asdict(found.mean),
        "wiebe": _fit(found.wiebe),
        "double_wiebe": _fit(found.double_wiebe),
        "compression_line": _fit(found.line),
        "trapped_mass": found.mass,
        "tdc_uncertainty_deg": None if spread is None else spread * _DEG,
        "per_degree": found.per_degree,
        "uncertainty": found.uncertainty,
    }


def _fit(fit: Fit) -> dict[str, Any]:
    pairs = zip(fit.names, fit.values, fit.confidence, strict=True)
    return {"rms": fit.rms} | {name: {"value": value, "confidence": half} for name, value, half in pairs}
