"""Kinds of cycle: one table, kind -> record, pressure, back pressure, figures, and what the kind has to be given.

A new kind is one file with its record and functions, and one row here: commands, sweeps, force chain and case files
follow from the row. Case files read this table, so nothing of the physics is imported with it.
"""

import dataclasses
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from mechsym.errors import BadInput
from mechsym.quantities import choice, load, record

if TYPE_CHECKING:
    import casadi as ca

    from mechsym.cycle.chamber import Chamber
    from mechsym.cycle.measured.diagram import Diagram
    from mechsym.cycle.pressure import Pressure


@record
class Kind:
    """One kind of cycle; functions are texts "module:name", imported when they are wanted."""

    cycle: str  #: Record of its data
    #: What gives a pressure beside the data: the chamber alone, a whole engine at a speed, a train of cylinders, or
    #: valves and volumes around a cylinder at a speed
    given: str = choice("chamber", "engine", "train", "breathing", default="chamber")
    pressure: str = ""  #: (cycle, chamber) -> Pressure, of kinds that are given a chamber
    back: str = ""  #: cycle -> absolute pressure behind the piston [Pa], of the same kinds; empty: its field p_back
    figures: str = ""  #: (cycle, chamber, omega) -> Pressure and figures of the fuel; empty: no figures over the speed
    as_diagram: str = ""  #: cycle -> fields of a `Diagram` in its place; empty: a diagram needs more than the cycle
    load: str = ""  #: Field of its mean indicated pressure, which a load changes; empty: it has one load
    scavenge: str = ""  #: Field of its scavenge pressure; empty: none
    measured: bool = False  #: Whether it is read from a file, which may have changed since


KINDS: Mapping[str, Kind] = {
    "two-stroke-marine": Kind(
        cycle="mechsym.cycle.kinds.two_stroke:TwoStrokeMarine",
        pressure="mechsym.cycle.kinds.two_stroke_solve:two_stroke_pressure",
        back="mechsym.cycle.kinds.two_stroke:back_pressure",
        figures="mechsym.cycle.kinds.two_stroke_solve:at_speed",
        as_diagram="mechsym.cycle.kinds.two_stroke:as_diagram",
        load="mean_indicated_pressure",
        scavenge="p_s",
    ),
    "two-stroke-zone": Kind(
        cycle="mechsym.cycle.kinds.two_stroke_zone:TwoStrokeZone",
        pressure="mechsym.cycle.kinds.two_stroke_zone:two_stroke_zone_pressure",
        figures="mechsym.cycle.kinds.two_stroke_zone:at_speed",
        as_diagram="mechsym.cycle.kinds.two_stroke_zone:as_diagram",
        load="mean_indicated_pressure",
        scavenge="p_s",
    ),
    "compressor": Kind(
        cycle="mechsym.cycle.kinds.compressor:CompressorCycle",
        pressure="mechsym.cycle.kinds.compressor:compressor_pressure",
        figures="mechsym.cycle.kinds.compressor:at_speed",
    ),
    "diagram": Kind(
        cycle="mechsym.cycle.measured.diagram:Diagram",
        pressure="mechsym.cycle.measured.pressure:diagram_pressure",
        measured=True,
    ),
    "spark-ignition": Kind(cycle="mechsym.cycle.kinds.spark_ignition:SparkIgnition", given="engine"),
    "gas-exchange": Kind(cycle="mechsym.cycle.kinds.gas_exchange:GasExchange", given="breathing"),
    "schmidt": Kind(cycle="mechsym.cycle.kinds.schmidt:Schmidt", given="train"),
    "stirling-adiabatic": Kind(cycle="mechsym.cycle.kinds.stirling:StirlingAdiabatic", given="train"),
    "stirling-second-order": Kind(cycle="mechsym.cycle.kinds.stirling:StirlingSecondOrder", given="train"),
}


def kind_of(cycle: Any) -> Kind:
    """The row of a cycle's record."""
    name = f"{type(cycle).__module__}:{type(cycle).__name__}"
    return next(kind for kind in KINDS.values() if kind.cycle == name)


def cylinder_pressure(cycle: Any, kinematics: "ca.Function") -> "tuple[Pressure, Chamber]":
    """Pressure in the cylinder of a mechanism.

    Parameters
    ----------
    kinematics : casadi.Function
        One input, the crank angle; outputs `x` and `dx_dphi`

    Raises
    ------
    BadInput
        The cycle cannot be made, or depends on more than the angle
    """
    kind = kind_of(cycle)
    if kind.given != "chamber":
        *first, last = (name for name, row in KINDS.items() if row.given == "chamber")
        others = " or ".join(name for name, row in KINDS.items() if row.given != "chamber")
        raise BadInput(
            f"[cycle] of kind {others} gives no indicator diagram here; take kind {', '.join(first)} or {last} "
            "(spark ignition in motion: 'mechsym cycle CASE --loop 10')"
        )
    chamber_over = load("mechsym.cycle.dead_centres:chamber_over")
    room = chamber_over(kinematics, cycle.bore, cycle.compression_ratio, back_pressure(cycle))
    return load(kind.pressure)(cycle, room), room


def back_pressure(cycle: Any) -> float:
    """Absolute pressure under the piston.

    Parameters
    ----------
    cycle : record
        Of a kind that is given a chamber

    Returns
    -------
    p_back : float
        Absolute pressure [Pa]
    """
    back = kind_of(cycle).back
    return load(back)(cycle) if back else cycle.p_back


def with_diagram(cycle: Any, file: str | None, motored: str | None = None) -> "Diagram":
    """The cycle with a measured diagram in its place.

    Parameters
    ----------
    cycle : record
        Of a `diagram` all methods are kept, of another kind what it knows of the engine

    Raises
    ------
    BadInput
        A cycle of another kind, whose cylinder is not known
    """
    kind = kind_of(cycle)
    if kind.measured:
        return dataclasses.replace(cycle, file=file or cycle.file, motored=motored or cycle.motored)
    if not kind.as_diagram:
        raise BadInput(
            f"{file or motored}: a measured diagram has no cylinder in this case; give [cycle] kind = 'diagram' with "
            "bore, compression_ratio and working_cycle"
        )
    known = load(kind.as_diagram)(cycle)
    return load(KINDS["diagram"].cycle)(
        bore=cycle.bore,
        compression_ratio=cycle.compression_ratio,
        p_back=back_pressure(cycle),
        file=file or "",
        motored=motored or "",
        **known,
    )
