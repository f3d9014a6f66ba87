"""Integrators by name. Each takes a `Phase` and returns a `Leg`; a new one is one line here."""

from collections.abc import Callable
from importlib import import_module

from mechsym.errors import BadInput
from mechsym.simulate.phase import Leg, Phase

DEFAULT = "scipy-dop853"
# name: ("module:function", arguments after the phase); imported on first use
BACKENDS: dict[str, tuple[str, tuple[str, ...]]] = {
    "scipy-dop853": ("mechsym.simulate.scipy_backend:advance", ("DOP853",)),
    "scipy-rk45": ("mechsym.simulate.scipy_backend:advance", ("RK45",)),
    "scipy-rk23": ("mechsym.simulate.scipy_backend:advance", ("RK23",)),
    "scipy-lsoda": ("mechsym.simulate.scipy_backend:advance", ("LSODA",)),
    "scipy-radau": ("mechsym.simulate.scipy_backend:advance", ("Radau",)),
    "scipy-bdf": ("mechsym.simulate.scipy_backend:advance", ("BDF",)),
    "sundials": ("mechsym.simulate.symbolic_backends:advance_sundials", ()),
    "heyoka": ("mechsym.simulate.symbolic_backends:advance_heyoka", ()),
}


def backend(name: str) -> Callable[[Phase], Leg]:
    """The function that integrates a phase.

    Parameters
    ----------
    name : str
        Name of the backend

    Returns
    -------
    advance : callable
        Phase to Leg

    Raises
    ------
    BadInput
        No such backend
    """
    if name not in BACKENDS:
        raise BadInput(f"backend {name!r} is not known; there are {', '.join(BACKENDS)}")
    (path, arguments) = BACKENDS[name]
    module, _, function = path.partition(":")
    found = getattr(import_module(module), function)
    return lambda phase: found(phase, *arguments)
