r"""An engine as one record, and its closed period at any design.

A design is a mapping of dotted names to values that replace those of the record: `omega`, `cycle.ignition`,
`chamber.compression_ratio`, `parameters.e`, `heat_transfer.a`, ... The values may be numbers or CasADi symbols.
"""

import copy
import dataclasses
from collections.abc import Mapping
from typing import Any

import numpy as np

from mechsym.cycle.chamber import ChamberParameters, Motion, chamber
from mechsym.cycle.closed.blowdown import Blowdown
from mechsym.cycle.closed.equations import Closed
from mechsym.cycle.friction import Friction
from mechsym.cycle.heat import Law
from mechsym.cycle.kinds.spark_ignition import SparkIgnition, charge, latent_heat, timing, vapour_energy
from mechsym.cycle.mixture import ConstantGamma, NasaMixture, properties
from mechsym.errors import BadInput
from mechsym.quantities import record
from mechsym.quantities.units import Scalar

_SECTIONS = ("chamber", "cycle", "gas", "heat_transfer", "friction_pressure")


@record
class ClosedEngine:
    """A four-stroke engine: sections of a case, and the motion of its pistons."""

    chamber: ChamberParameters
    motion: Motion  #: Travel of one piston; its parameters are the names `parameters.*` of a design
    cycle: SparkIgnition
    gas: ConstantGamma | NasaMixture
    heat_transfer: Law
    friction_pressure: Friction
    blowdown: Blowdown | None = None


def at_design(engine: ClosedEngine, design: Mapping[str, Scalar]) -> ClosedEngine:
    """The engine with some of its values replaced.

    design: mapping of str to value, dotted names; `omega` belongs to no section and is passed over. Returns engine: a
    copy; values that are CasADi symbols are not checked.
    """
    parts = {f.name: getattr(engine, f.name) for f in dataclasses.fields(engine)}
    for name, value in design.items():
        if name == "omega":
            continue
        section, _, key = name.partition(".")
        if section == "parameters" and key in parts["motion"].parameters:
            parameters = {**parts["motion"].parameters, key: value}
            parts["motion"] = dataclasses.replace(parts["motion"], parameters=parameters)
        elif isinstance(getattr(parts.get(section), key, None), (int, float)) and section != "motion":
            parts[section] = _replaced(parts[section], key, value)
        else:
            raise BadInput(f"{name!r} is not a number of the engine; names are {', '.join(design_names(engine))}")
    return ClosedEngine(**parts)


def check_design(engine: ClosedEngine, design: Mapping[str, Scalar]) -> None:
    """Refuse a design with numbers that the engine's own records would refuse.

    design: mapping of str to float or ndarray, dotted names to numbers; each is tried at its smallest and its largest
    value.
    """
    for name, values in design.items():
        section, _, key = name.partition(".")
        numbers = np.asarray(values, float)
        if name == "omega" and not np.all(numbers > 0):
            raise BadInput(f"omega = {numbers.min():g} rad/s is out of range; it must be > 0 rad/s")
        record: Any = getattr(engine, section, None)
        if section in _SECTIONS and hasattr(record, key):
            for value in (numbers.min(), numbers.max()):
                dataclasses.replace(record, **{key: float(value)})


def design_names(engine: ClosedEngine) -> list[str]:
    """Names that a design may hold."""
    names = ["omega", *(f"parameters.{key}" for key in engine.motion.parameters)]
    for section in _SECTIONS:
        record = getattr(engine, section)
        names += [f"{section}.{f.name}" for f in dataclasses.fields(record) if "unit" in f.metadata]
    return names


def closed_period(engine: ClosedEngine, design: Mapping[str, Scalar]) -> Closed:
    """The closed period at a design of `omega` [rad/s] and of names that replace values of the engine."""
    engine, omega = at_design(engine, design), design["omega"]
    cycle, room = engine.cycle, chamber(engine.chamber, engine.motion)
    held = charge(room, cycle, properties(engine.gas, cycle.intake_temperature, 0.0).gas_constant)
    starts, duration = timing(cycle, omega)
    return Closed(
        chamber=room, gas=engine.gas, law=engine.heat_transfer, omega=omega, closes=cycle.inlet_closes,
        starts=starts, duration=duration, opens=cycle.exhaust_opens, pressure=cycle.intake_pressure,
        temperature=cycle.intake_temperature, mass=held.gas, fuel=held.fuel, heat=held.heat,
        fuel_heat=held.fuel * cycle.heating_value, latent_heat=held.fuel * latent_heat(cycle),
        fuel_energy=vapour_energy(cycle, engine.gas),
        fuel_entry="premixed" if cycle.vaporisation == "none" else "vaporised",
        wiebe=(cycle.wiebe_a, cycle.wiebe_m, 1.0, 0.0, 0.0), blowdown=engine.blowdown,
    )  # fmt: skip


def _replaced(record: object, key: str, value: object) -> object:
    # dataclasses.replace would run the range checks, which cannot compare symbols
    twin = copy.copy(record)
    object.__setattr__(twin, key, value)
    return twin
