"""Kinds of cycle: one table, kind -> record of its data, what answers for its gas, what the kind needs and reads.

A new kind is one file with its record and its `source.GasSource`, and one row here: commands, sweeps, force chain and
case files follow from the row. Case files read this table, so nothing of the physics is imported with it.
"""

import dataclasses
import math
from typing import TYPE_CHECKING, Any

from mechsym.errors import BadInput
from mechsym.quantities import load, record
from mechsym.quantities.units import RadPerSecond

if TYPE_CHECKING:
    import casadi as ca

    from mechsym.cycle.gas import Gas
    from mechsym.cycle.heat import Law
    from mechsym.cycle.measured.diagram import Diagram
    from mechsym.cycle.source import EngineParts, GasSource


@record
class Kind:
    """One kind of cycle; classes and functions are texts "module:name", imported when they are wanted."""

    cycle: str  #: Record of its data
    gas: str  #: (cycle, parts) -> `source.GasSource`
    needs: tuple[str, ...] = ()  #: Sections of a case that it cannot do without
    reads: tuple[str, ...] = ()  #: Sections of a case that it reads where they stand
    as_diagram: str = ""  #: cycle -> fields of a `Diagram` in its place; empty: a diagram needs more than the cycle
    load: str = ""  #: Field of its mean indicated pressure, which a load changes; empty: it has one load
    scavenge: str = ""  #: Field of its scavenge pressure; empty: none
    fired: bool = True  #: Whether fuel burns in it
    driven: bool = False  #: Whether it takes work
    measured: bool = False  #: Whether it is read from a file, which may have changed since
    recorded: str = ""  #: cycle -> speed at which it was recorded [rad/s] or None; empty: it runs at any speed
    facts: bool = False  #: Whether its temperatures and fuel are facts only while its mean pressure is given
    ideal: bool = False  #: Whether it is without the losses that other kinds of its data have
    shared: bool = False  #: Whether two pistons share the gas, one figure standing for both
    closed: bool = False  #: Whether its closed period is integrated: with the motion, by gradients, as maps
    two_turns: bool = False  #: Whether it takes two turns of the crank; of a diagram its data say so
    noise: float = 0.0  #: By which its figures jump between neighbours, as a share [-]

    @property
    def chambered(self) -> bool:
        """Whether its cylinder stands in `[chamber]`; figures after friction are told of these."""
        return "chamber" in self.needs

    @property
    def cylinder(self) -> bool:
        """Whether it needs nothing but a cylinder, which its own data describe."""
        return not self.shared and not self.chambered


KINDS: dict[str, Kind] = {
    "two-stroke-marine": Kind(
        cycle="mechsym.cycle.kinds.two_stroke:TwoStrokeMarine",
        gas="mechsym.cycle.breathing.marine:MarineGas",
        as_diagram="mechsym.cycle.kinds.two_stroke:as_diagram",
        reads=("scavenging",),
        facts=True,
        load="mean_indicated_pressure",
        scavenge="p_s",
    ),
    "two-stroke-zone": Kind(
        cycle="mechsym.cycle.kinds.two_stroke_zone:TwoStrokeZone",
        gas="mechsym.cycle.kinds.two_stroke_zone:ZoneGas",
        as_diagram="mechsym.cycle.kinds.two_stroke_zone:as_diagram",
        reads=("heat_transfer",),
        load="mean_indicated_pressure",
        scavenge="p_s",
    ),
    "compressor": Kind(
        cycle="mechsym.cycle.kinds.compressor:CompressorCycle",
        gas="mechsym.cycle.kinds.compressor:CompressorGas",
        fired=False,
        driven=True,
    ),
    "diagram": Kind(
        cycle="mechsym.cycle.measured.diagram:Diagram",
        gas="mechsym.cycle.measured.pressure:DiagramGas",
        measured=True,
        recorded="mechsym.cycle.measured.file:speed_of",
    ),
    "spark-ignition": Kind(
        cycle="mechsym.cycle.kinds.spark_ignition:SparkIgnition",
        gas="mechsym.cycle.engine:SparkGas",
        needs=("chamber", "heat_transfer"),
        reads=("gas", "blowdown"),
        closed=True,
        two_turns=True,
    ),
    "gas-exchange": Kind(
        cycle="mechsym.cycle.breathing.flow:GasExchange",
        gas="mechsym.cycle.breathing.engine:BreathingGas",
        needs=("chamber", "breathing"),
        reads=("heat_transfer", "boost"),
        two_turns=True,
        noise=2e-4,  # as a timing passes one of its half degrees
    ),
    # the losses of [stirling] wait beside these two for the second order; their facts say that they are left out
    "schmidt": Kind(
        cycle="mechsym.cycle.kinds.stirling:Schmidt",
        gas="mechsym.cycle.kinds.stirling:SchmidtGas",
        ideal=True,
        fired=False,
        shared=True,
        reads=("stirling",),
    ),
    "stirling-adiabatic": Kind(
        cycle="mechsym.cycle.kinds.stirling:StirlingAdiabatic",
        gas="mechsym.cycle.kinds.stirling:AdiabaticGas",
        fired=False,
        shared=True,
        reads=("stirling",),
    ),
    "stirling-second-order": Kind(
        cycle="mechsym.cycle.kinds.stirling:StirlingSecondOrder",
        gas="mechsym.cycle.kinds.stirling:SecondOrderGas",
        fired=False,
        shared=True,
        needs=("stirling",),
    ),
}


def kind_of(cycle: object) -> Kind:
    """The row of a cycle's record."""
    name = f"{type(cycle).__module__}:{type(cycle).__name__}"
    return next(kind for kind in KINDS.values() if kind.cycle == name)


def source_of(cycle: object, parts: "EngineParts") -> "GasSource":
    """What answers for the gas of a cycle in an engine: the one place where the kinds part."""
    answers: GasSource = load(kind_of(cycle).gas)(cycle, parts)
    return answers


def four_stroke(cycle: object) -> bool:
    """Whether a cycle takes two turns of the crank."""
    return kind_of(cycle).two_turns or getattr(cycle, "working_cycle", "") == "four-stroke"


def gas_in_cylinder(
    cycle: object, kinematics: "ca.Function", omega: RadPerSecond = math.nan, walls: "Law | None" = None
) -> "Gas":
    """Gas of a cycle that needs nothing but a cylinder.

    kinematics: one input, the crank angle [rad]; named outputs `x` [m] and `dx_dphi` [m/rad]. omega: crank speed, of
    cycles that depend on it. walls: heat to the walls, of kinds that ask for it. Raises BadInput: the cycle cannot be
    made, or needs more than a cylinder.
    """
    kind = kind_of(cycle)
    if not kind.cylinder:
        *first, last = (name for name, row in KINDS.items() if row.cylinder)
        others = " or ".join(name for name, row in KINDS.items() if not row.cylinder)
        raise BadInput(
            f"[cycle] of kind {others} gives no indicator diagram here; take kind {', '.join(first)} or {last} "
            "(spark ignition in motion: 'mechsym cycle CASE --loop 10')"
        )
    sections = () if walls is None else (("heat_transfer", walls),)
    parts = load("mechsym.cycle.source:EngineParts")(mechanism="", parameters=None, sections=sections)
    gas: Gas = load(kind.gas)(cycle, parts, kinematics).at(omega)
    return gas


def with_diagram(cycle: Any, file: str | None, motored: str | None = None) -> "Diagram":
    """The cycle with a measured diagram in its place.

    cycle: of a `diagram` all methods are kept, of another kind what it knows of the engine. Raises BadInput: a cycle of
    another kind, whose cylinder is not known.
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
        file=file or "",
        motored=motored or "",
        **known,
    )
