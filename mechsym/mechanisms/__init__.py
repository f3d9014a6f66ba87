"""Runtime mechanisms on top of the generated code.

record        Mechanism: named CasADi functions with the parameters bound; `evaluate` along angles
state         everything at one state; constraints closes loops and finds joint forces
own           the user's own; traits, chain  what the module of a built-in one says of it, found by its name
shaft         matrices of an elastic shaft
drawing, plots    to scale at any angle, moving in a page
"""

import dataclasses
from collections.abc import Mapping
from typing import Any

from mechsym.errors import BadInput, suggest
from mechsym.mechanisms import own
from mechsym.mechanisms.own import packaged
from mechsym.mechanisms.record import Mechanism, bind, evaluate
from mechsym.mechanisms.record import listing as stored_listing
from mechsym.mechanisms.state import state
from mechsym.mechanisms.traits import traits_of
from mechsym.quantities import quantity


def names() -> list[str]:
    """Names of the mechanisms.

    Examples
    --------
    >>> "crosshead" in names()
    True
    """
    return sorted({*packaged(), *own.brought()})


def parameters_class(name: str) -> Any:
    """The record of a mechanism's parameters.

    Raises
    ------
    BadInput
        No such mechanism

    Examples
    --------
    >>> parameters_class("hypocycloid").__name__
    'HypocycloidParameters'
    """
    if own.is_file(name):
        return own.load(name).parameters
    if name not in packaged():
        raise BadInput(f"mechanism {name!r} is not known; {suggest(name, names())}")
    known = traits_of(name)
    return known.parameters if known is not None else own.record_of(stored_listing(name))


_KINDS = {"N*m": "torque", "N": "force"}  # of an input, by its unit


def inputs_class(name: str) -> Any:
    """The record of `[inputs]`: constants for inputs that nothing drives, 0 where they are not given."""
    found = {n: (unit, _KINDS.get(unit, "input")) for n, unit in listing(name)["inputs"].items()}
    fields = {n: quantity(unit, default=0.0, about=f"constant {kind}") for n, (unit, kind) in found.items()}
    return own.letters_class("Inputs", fields)


def start_class(name: str) -> Any:
    """The record of `[start]`: coordinates and velocities at the start; of dependent coordinates the guesses."""
    units = listing(name)["coordinates"]
    places = {n: quantity(unit, default=None, about="place at the start") for n, unit in units.items()}
    speeds = {f"{n}d": quantity(f"{unit}/s", default=None, about="speed at the start") for n, unit in units.items()}
    return own.letters_class("Start", {**places, **speeds})


def by_roles(name: str) -> bool:
    """Whether the roles of its declaration are all that is known of a mechanism: it has no module of its own."""
    return own.is_file(name) or (name in packaged() and traits_of(name) is None)


def build(name: str, parameters: Any) -> Mechanism:
    """The mechanism of that name with values for its parameters."""
    if not isinstance(parameters, parameters_class(name)):
        raise BadInput(f"{name} takes {parameters_class(name).__name__}, not {type(parameters).__name__}")
    known = traits_of(name)
    if known is not None and known.assembled is not None:
        return known.assembled.build(parameters)
    return bind(name, dataclasses.asdict(parameters))


def listing(name: str, mechanism: Mechanism | None = None) -> Mapping[str, Any]:
    """Letters, units and source of a mechanism.

    Parameters
    ----------
    mechanism : Mechanism, optional
        What was built; a crank train's letters depend on its number of throws and cylinders

    Returns
    -------
    listing : mapping
        Keys name, about, source, coordinates, parameters, inputs, outputs, equations
    """
    known = traits_of(name)
    if known is not None and known.assembled is not None:
        return known.assembled.listing(mechanism)
    return stored_listing(name)


__all__ = ["Mechanism", "bind", "build", "evaluate", "listing", "names", "parameters_class", "state"]


def __dir__() -> list[str]:
    return __all__
