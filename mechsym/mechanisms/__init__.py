"""Runtime mechanisms on top of the generated code.

record        Mechanism: named CasADi functions with the parameters bound; `evaluate` along angles
state         everything at one state; constraints closes loops and finds joint forces
roles         what the parts are for: pistons, rotors, bearings, guides, teeth
driven        coordinates that move as they are told, and what must push along them
amounts       sizes that a declaration gives as text; closing  the force that an overconstrained mechanism leaves open
plan          what a name stands for; own  the user's own; peers  what stands beside others in a comparison
shaft         matrices of an elastic shaft
drawing, plots    to scale at any angle, moving in a page
"""

import dataclasses
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from mechsym.errors import BadInput, suggest
from mechsym.mechanisms import own
from mechsym.mechanisms.driven import MotionSettings
from mechsym.mechanisms.own import packaged
from mechsym.mechanisms.plan import plan_of, roles_of
from mechsym.mechanisms.record import Mechanism, bind, evaluate
from mechsym.mechanisms.state import state
from mechsym.quantities import check, quantity
from mechsym.quantities.records import Record

if TYPE_CHECKING:
    from mechsym.derive.listing import Listing


def names() -> list[str]:
    """Names of the mechanisms.

    >>> "crosshead" in names()
    True
    """
    return sorted({*packaged(), *own.brought()})


def parameters_class(name: str) -> type[Record]:
    """The record of a mechanism's parameters.

    Raises BadInput: no such mechanism.

    >>> parameters_class("hypocycloid").__name__
    'HypocycloidParameters'
    """
    if not own.is_file(name) and name not in packaged():
        raise BadInput(f"mechanism {name!r} is not known; {suggest(name, names())}")
    return plan_of(name).parameters


_KINDS = {"N*m": "torque", "N": "force"}  # of an input, by its unit


def inputs_class(name: str) -> type[Record]:
    """The record of `[inputs]`: constants for inputs that nothing drives, 0 where they are not given."""
    _refuse_lists(name)
    kinds = {n: (unit, _KINDS.get(unit, "input")) for n, unit in listing(name)["inputs"].items()}
    fields = {n: quantity(unit, default=0.0, about=f"constant {kind}") for n, (unit, kind) in kinds.items()}
    return own.letters_class("Inputs", fields)


def lists(name: str) -> tuple[str, ...]:
    """Parameters that take one value a throw or a cylinder."""
    return tuple(field.name for field in dataclasses.fields(parameters_class(name)) if field.type is not float)


def _refuse_lists(name: str) -> None:
    if lists(name):
        raise BadInput(f"{name} has as many letters as throws and takes none by itself; leave the section out")


def start_class(name: str) -> type[Record]:
    """The record of `[start]`: coordinates and velocities at the start; of dependent coordinates the guesses."""
    _refuse_lists(name)
    units = listing(name)["coordinates"]
    places = {n: quantity(unit, default=None, about="place at the start") for n, unit in units.items()}
    speeds = {f"{n}d": quantity(f"{unit}/s", default=None, about="speed at the start") for n, unit in units.items()}
    return own.letters_class("Start", {**places, **speeds})


def motion_class(name: str) -> type[Record]:
    """The record of `[motion]`: how each driven coordinate moves, and what all of these share."""
    _refuse_lists(name)
    fields = {q: dataclasses.field(default=None) for q in listing(name)["coordinates"]}
    rows: list[Any] = [(q, float | str | None, field) for q, field in fields.items()]
    for field in dataclasses.fields(MotionSettings):
        rows.append((field.name, field.type, dataclasses.field(default=field.default, metadata=field.metadata)))
    return dataclasses.make_dataclass("Motion", rows, frozen=True, kw_only=True, namespace={"__post_init__": check})


def build(name: str, parameters: Record) -> Mechanism:
    """The mechanism of that name with values for its parameters."""
    wanted = parameters_class(name)
    if [f.name for f in dataclasses.fields(parameters)] != [f.name for f in dataclasses.fields(wanted)]:
        raise BadInput(f"{name} takes {wanted.__name__}, not {type(parameters).__name__}")
    return plan_of(name).build(parameters)


def rigid(name: str, parameters: Record, guesses: Mapping[str, float] | None = None) -> Mechanism:
    """The mechanism with one coordinate: on a shaft that does not twist, loops closed along it.

    guesses: of coordinates that loops hold [rad] or [m]. Raises BadInput: more than one coordinate is free.
    """
    return plan_of(name).rigid(parameters, guesses or {})


def listing(name: str, mechanism: Mechanism | None = None) -> "Listing":
    """Letters, units and source of a mechanism.

    mechanism: what was built; a crank train's letters depend on its number of throws and cylinders. Returns listing:
    keys name, about, source, coordinates, parameters, inputs, outputs, equations.
    """
    return plan_of(name).listing(mechanism)


__all__ = ["Mechanism", "bind", "build", "evaluate", "listing", "names", "parameters_class", "roles_of", "state"]


def __dir__() -> list[str]:
    return __all__
