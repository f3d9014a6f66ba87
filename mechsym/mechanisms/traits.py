"""What a mechanism of the package brings beside its declaration: its own module says it in one record, `TRAITS`.

The registry is the list of what was generated, and of the packages of this room that put a mechanism together at run
time. A generated mechanism without a module of its own has its record of parameters, gas, friction and drawing from the
roles of its declaration, as a mechanism of a user's own has.
"""

import functools
from collections.abc import Callable, Iterable, Mapping
from importlib import import_module
from importlib.util import find_spec
from typing import Any

from mechsym.mechanisms.chain import CrankChain
from mechsym.mechanisms.drawn_parts import Circle, Line
from mechsym.mechanisms.own import packaged
from mechsym.mechanisms.proportions import Proportions
from mechsym.mechanisms.record import Mechanism
from mechsym.quantities import record

_ROOM = "mechsym.mechanisms"


@record
class Assembled:
    """A mechanism that is put together at run time from a derived part."""

    part: str  #: Name of the derived part
    build: Callable[[Any], Mechanism]
    build_driven: Callable[[Any], Mechanism]  #: With a torque at its free end
    listing: Callable[[Mechanism | None], Mapping[str, Any]]


@record
class ElasticShaft:
    """A shaft that twists, from the free end to the flywheel."""

    #: Inertia of each disc alone [kg*m^2]
    discs: Callable[[Any], tuple[float, ...]]
    #: Stiffness [N*m/rad] and damping [N*m*s/rad] of each section
    springs: Callable[[Any], tuple[tuple[float, ...], tuple[float, ...]]]
    start_up: bool = False  #: Whether `[startup]` explains how it runs up


@record
class Traits:
    """What the module of a mechanism says of it."""

    parameters: Any  #: Class of its record
    #: Shapes at a crank angle [rad], with a bore [m] or None
    drawing: Callable[[Any, float, float | None], Iterable[Line | Circle]] | None = None
    chain: CrankChain | None = None  #: Of a mechanism with a crank and pistons
    proportions: Callable[[Any], Proportions] | None = None  #: By its record
    assembled: Assembled | None = None
    shaft: ElasticShaft | None = None
    rules: str = ""  #: By which its parts are sized: `slider crank`, `planet`
    #: The mechanism as one cylinder of it sees itself: name and record of one that has a single piston
    alone: Callable[[Any], tuple[str, Any]] | None = None


@functools.lru_cache(maxsize=64)
def traits_of(name: str) -> Traits | None:
    """What the module of a mechanism says of it; None where there is no such module."""
    if not name.isidentifier() or find_spec(f"{_ROOM}.{name}") is None:
        return None
    return getattr(import_module(f"{_ROOM}.{name}"), "TRAITS", None)


def with_trait(wanted: Callable[[Traits], Any]) -> tuple[str, ...]:
    """Names of the mechanisms of the package whose module says what is wanted."""
    named = ((name, traits_of(name)) for name in packaged())
    return tuple(name for name, known in named if known is not None and wanted(known))


def with_chain() -> tuple[str, ...]:
    """Names of the mechanisms whose force chain is known."""
    return with_trait(lambda known: known.chain)


def with_hinge() -> tuple[str, ...]:
    """Names of the mechanisms with a place for a hinge on the crank."""
    return with_trait(lambda known: known.chain and known.chain.hinged)


def is_train(name: str) -> bool:
    """Whether a mechanism is put together at run time: throws on an elastic shaft, with one coordinate each."""
    known = traits_of(name)
    return known is not None and known.assembled is not None


def rules_of(name: str) -> str:
    """The rules by which the parts of a mechanism are sized, empty where there are none."""
    known = traits_of(name)
    return known.rules if known is not None else ""


def name_of(parameters: type) -> str:
    """Name of the first mechanism whose record is of a class; empty where there is none."""
    return next(iter(with_trait(lambda known: known.parameters is parameters)), "")
