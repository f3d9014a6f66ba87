"""Small sections of a case: where the machine runs, its flywheel, how long trials take, which other speed is tried."""

import dataclasses

from mechsym.errors import BadInput
from mechsym.quantities import check, quantity


@dataclasses.dataclass(frozen=True, kw_only=True)
class Operation:
    """Where the machine runs.

    Parameters
    ----------
    speed : float
        Mean crank speed [rad/s]
    """

    speed: float = quantity("rad/s", low=0.1, high=1e5, about="mean crank speed")

    def __post_init__(self) -> None:
        check(self)


@dataclasses.dataclass(frozen=True, kw_only=True)
class FlywheelSettings:
    """A flywheel that the engine keeps beside the hinge.

    Parameters
    ----------
    inertia : float
        Inertia about the shaft [kg*m^2]
    """

    inertia: float = quantity("kg*m^2", low=0, about="inertia about the shaft")

    def __post_init__(self) -> None:
        check(self)


@dataclasses.dataclass(frozen=True, kw_only=True)
class TrialSettings:
    """How long the trials run.

    Parameters
    ----------
    turns : float
        Turns of the crank [-]
    """

    turns: float = quantity("-", default=20.0, low=4, high=10000, about="turns of the crank")

    def __post_init__(self) -> None:
        check(self)


@dataclasses.dataclass(frozen=True, kw_only=True)
class RetuneSettings:
    """At which other speed the guide is tried.

    Parameters
    ----------
    case : str
        Name or path of the case with the other speed
    """

    case: str


@dataclasses.dataclass(frozen=True, kw_only=True)
class Speeds:
    """The speeds of a performance map.

    Parameters
    ----------
    lowest, highest, step : float
        First and last speed and the distance between speeds [rad/s]
    """

    lowest: float = quantity("rad/s", above=0, about="first speed")
    highest: float = quantity("rad/s", above=0, about="last speed")
    step: float = quantity("rad/s", above=0, about="distance between speeds")

    def __post_init__(self) -> None:
        check(self)
        if self.highest < self.lowest:
            raise BadInput(f"highest = {self.highest:g} rad/s is below lowest = {self.lowest:g} rad/s")
