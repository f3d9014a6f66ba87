"""Integrators by name.

`native` runs a whole problem in compiled C; `auto` takes it where there is a compiler and the problem has no plain
Python callables, otherwise scipy. Each of the others takes a `Phase` and returns a `Leg`; a new one is one line here.
"""

from collections.abc import Callable
from typing import TYPE_CHECKING

from mechsym.errors import BadInput
from mechsym.quantities import load

if TYPE_CHECKING:
    from mechsym.simulate.phase import Leg, Phase

DEFAULT, FALLBACK = "auto", "scipy-dop853"
NATIVE = ("auto", "native")
# name: ("module:function", arguments after the phase); imported on first use
_PHASES: dict[str, tuple[str, tuple[str, ...]]] = {
    "scipy-dop853": ("mechsym.simulate.scipy_backend:advance", ("DOP853",)),
    "scipy-rk45": ("mechsym.simulate.scipy_backend:advance", ("RK45",)),
    "scipy-rk23": ("mechsym.simulate.scipy_backend:advance", ("RK23",)),
    "scipy-lsoda": ("mechsym.simulate.scipy_backend:advance", ("LSODA",)),
    "scipy-radau": ("mechsym.simulate.scipy_backend:advance", ("Radau",)),
    "scipy-bdf": ("mechsym.simulate.scipy_backend:advance", ("BDF",)),
    "sundials": ("mechsym.simulate.symbolic_backends:advance_sundials", ()),
    "heyoka": ("mechsym.simulate.symbolic_backends:advance_heyoka", ()),
}

BACKENDS = (*NATIVE, *_PHASES)


def backend(name: str) -> "Callable[[Phase], Leg]":
    """The function that integrates a phase."""
    if name not in _PHASES:
        raise BadInput(f"backend {name!r} does not go phase by phase; there are {', '.join(_PHASES)}")
    (path, arguments) = _PHASES[name]
    found = load(path)
    return lambda phase: found(phase, *arguments)
