"""Runtime mechanisms on top of the generated code.

record        Mechanism: named CasADi functions with the parameters bound; `evaluate` along angles
state         everything at one state; constraints closes loops and finds joint forces
crosshead, crank_throw, crank_train, crankshaft_flywheel, hypocycloid, rodless    parameters of the built-in ones
shaft         matrices of an elastic shaft
drawing, plots    to scale at any angle, moving in a page
"""

import dataclasses
from collections.abc import Mapping
from importlib import import_module
from typing import Any

from mechsym.errors import BadInput, suggest
from mechsym.mechanisms.record import Mechanism, bind, evaluate
from mechsym.mechanisms.record import listing as stored_listing
from mechsym.mechanisms.state import state
from mechsym.quantities import load

_CLASSES = {
    "crosshead": "crosshead:CrossheadParameters",
    "crank_throw": "crank_throw:CrankThrowParameters",
    "crank_train": "crank_train:CrankTrainParameters",
    "hypocycloid": "hypocycloid:HypocycloidParameters",
    "rodless": "rodless:RodlessParameters",
    "rodless_constraints": "rodless:RodlessParameters",
    "crankshaft_flywheel": "crankshaft_flywheel:CrankshaftFlywheelParameters",
    "crankshaft_flywheel_printed": "crankshaft_flywheel:CrankshaftFlywheelParameters",
}

_ASSEMBLED = ("crank_train",)  # put together at run time from a derived part


def names() -> list[str]:
    """Names of the mechanisms."""
    return sorted(_CLASSES)


def parameters_class(name: str) -> Any:
    """The record of a mechanism's parameters.

    Raises
    ------
    BadInput
        No such mechanism
    """
    if name not in _CLASSES:
        raise BadInput(f"mechanism {name!r} is not known; {suggest(name, names())}")
    return load(f"mechsym.mechanisms.{_CLASSES[name]}")


def build(name: str, parameters: Any) -> Mechanism:
    """The mechanism of that name with values for its parameters."""
    if not isinstance(parameters, parameters_class(name)):
        raise BadInput(f"{name} takes {parameters_class(name).__name__}, not {type(parameters).__name__}")
    if name in _ASSEMBLED:
        return import_module(f"mechsym.mechanisms.{name}").build(parameters)
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
    if name in _ASSEMBLED:
        return import_module(f"mechsym.mechanisms.{name}").listing(mechanism)
    return stored_listing(name)


__all__ = ["Mechanism", "bind", "build", "evaluate", "listing", "names", "parameters_class", "state"]


def __dir__() -> list[str]:
    return __all__
