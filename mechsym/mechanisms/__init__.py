"""Runtime mechanisms: frozen parameters and `build(params) -> Mechanism` on top of the generated code."""

import dataclasses
from importlib import import_module
from typing import Any

from mechsym.errors import BadInput
from mechsym.mechanism import Mechanism, bind

_CLASSES = {
    "crosshead": "crosshead:CrossheadParameters",
    "crankshaft_flywheel": "crankshaft_flywheel:CrankshaftFlywheelParameters",
    "crankshaft_flywheel_printed": "crankshaft_flywheel:CrankshaftFlywheelParameters",
}


def names() -> list[str]:
    """Names of the mechanisms.

    Returns
    -------
    names : list of str
        Sorted names
    """
    return sorted(_CLASSES)


def parameters_class(name: str) -> Any:
    """The record of a mechanism's parameters.

    Parameters
    ----------
    name : str
        Name of the mechanism

    Returns
    -------
    cls : type
        A frozen dataclass

    Raises
    ------
    BadInput
        No such mechanism
    """
    if name not in _CLASSES:
        raise BadInput(f"mechanism {name!r} is not known; there are {', '.join(names())}")
    module, _, cls = _CLASSES[name].partition(":")
    return getattr(import_module(f"mechsym.mechanisms.{module}"), cls)


def build(name: str, parameters: Any) -> Mechanism:
    """The mechanism of that name with values for its parameters.

    Parameters
    ----------
    name : str
        Name of the mechanism
    parameters : dataclass instance
        Its record of parameters

    Returns
    -------
    mechanism : Mechanism
        Named CasADi functions
    """
    if not isinstance(parameters, parameters_class(name)):
        raise BadInput(f"{name} takes {parameters_class(name).__name__}, not {type(parameters).__name__}")
    return bind(name, dataclasses.asdict(parameters))
