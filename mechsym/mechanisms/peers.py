"""Mechanisms of the package that stand for their kind in a comparison at equal stroke, moving mass and gas."""

from collections.abc import Iterator
from importlib import import_module
from importlib.util import find_spec
from typing import TYPE_CHECKING

from mechsym.mechanisms.own import packaged
from mechsym.quantities import record
from mechsym.quantities.records import Record

if TYPE_CHECKING:
    from mechsym.mechanisms.closing import ClosingRule, RodlessFaces


@record
class Alike:
    """What the mechanisms of a comparison have in common."""

    stroke: float  #: [m]
    mass: float  #: That moves with one piston [kg]
    area: float  #: Of a piston [m^2]
    period: float  #: Of the cycle [rad]
    lam: float  #: Crank radius over rod length [-]
    alpha_n: float  #: Pressure angle of teeth [rad]


@record
class Peer:
    """A mechanism that stands for its kind."""

    mechanism: str
    label: str
    parameters: Record
    faces: "RodlessFaces | None" = None
    closing: "ClosingRule | None" = None


def peers(alike: Alike) -> Iterator[Peer]:
    """Those that the modules of the package's mechanisms name, in the order of these."""
    for name in packaged():
        place = f"mechsym.mechanisms.{name}"
        if find_spec(place) is not None:
            yield from getattr(import_module(place), "peers", lambda alike: ())(alike)
