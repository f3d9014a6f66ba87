"""Small sections of a case: where the machine runs, its flywheel, how long trials take, which other speed is tried,
and what the gas must not exceed (`[gas_limits]`, doubted by every command and held by `mechsym optimise`).
"""

from mechsym.errors import BadInput
from mechsym.quantities import quantity, record


@record
class Operation:
    """Where the machine runs."""

    speed: float = quantity("rad/s", low=0.1, high=1e5, about="mean crank speed")


@record
class FlywheelSettings:
    """A flywheel that the engine keeps beside the hinge."""

    inertia: float = quantity("kg*m^2", low=0, about="inertia about the shaft")


@record
class TrialSettings:
    """How long the trials run."""

    turns: float = quantity("-", default=20.0, low=4, high=1000, about="turns of the crank")


@record
class RetuneSettings:
    """At which other speed the guide is tried."""

    case: str  #: Name or path of the case with the other speed


@record
class ReportSettings:
    """How results are shown."""

    units: str = ""  #: Units of text and tables: "mm, MPa, kN, kN*m, deg, rpm, kW"
    #: Title block of `mechsym report`
    project: str = ""
    engine: str = ""
    author: str = ""
    date: str = ""


@record
class Speeds:
    """The speeds of a performance map."""

    lowest: float = quantity("rad/s", above=0, about="first speed")
    highest: float = quantity("rad/s", above=0, about="last speed")
    step: float = quantity("rad/s", above=0, about="distance between speeds")

    def __post_init__(self) -> None:
        if self.highest < self.lowest:
            raise BadInput(f"highest = {self.highest:g} rad/s is below lowest = {self.lowest:g} rad/s")
        if 0 < self.highest - self.lowest < self.step:
            told = f"step = {self.step:g} rad/s is wider than the range from {self.lowest:g} to {self.highest:g} rad/s"
            raise BadInput(f"{told}; give a smaller one")


@record
class GasLimits:
    """Limits of the gas that the user sets; one that is left out is none."""

    peak_pressure: float | None = quantity("Pa", default=None, above=0, below=1e9, about="absolute, in the cylinder")
    peak_temperature: float | None = quantity("K", default=None, above=0, below=1e4, about="mean over the cylinder")
    knock: float | None = quantity("-", default=None, above=0, below=1e3, about="integral that ends in knock at 1")
