"""What is asked of a co-design, and what it gives."""

from collections.abc import Mapping

import numpy as np
import scipy

from mechsym.codesign.hardware import Hardware
from mechsym.codesign.points import Point
from mechsym.codesign.settings import FREE
from mechsym.errors import BadInput
from mechsym.hinge.choices import Limits
from mechsym.hinge.losses import HingeLosses
from mechsym.quantities import choice, quantity, record
from mechsym.quantities.results import part, result

MOST_MASS = 1000.0  # largest mass on each roller where it is free [kg]
_MOST_POINTS = 60
_ROOM = 1.5  # of the radius that the case's own rollers reach, where nothing else is asked (assumed)


@record
class CoDesignTask:
    """A machine, its points, the hardware of its guides, and the ripple that is allowed."""

    points: tuple[Point, ...]
    hardware: Hardware
    bounds: Limits
    ripple: float = quantity("-", above=0, below=2, about="largest (max - min) / mean of the speed at every point")
    springs: int = 1  #: guides on the shaft, each with a spring and a pressure of its own
    schedule: str = choice("each_point", "one", default="each_point", about="pressures: set at each point, or one")
    robust: float = quantity("-", default=0.0, low=0, high=0.2, about="error of every p0 that the ripple must bear")
    free: tuple[str, ...] = ()  #: names of `FREE`, and `moving_mass`, that are chosen too
    track_radius: float = quantity(
        "m", default=0.0, low=0, about="largest reach of the rollers where hardware is free; 0: 1.5 (rho0 + r)"
    )
    losses: HingeLosses | None = None  #: friction and heat inside the programme; None leaves them beside it
    knots: int = 60  #: of the spline of each guide
    angles: int = 180  #: of the programme over a turn of the crank

    def __post_init__(self) -> None:
        if not 1 <= len(self.points) <= _MOST_POINTS:
            raise BadInput(f"{len(self.points)} operating points; give 1 to {_MOST_POINTS}")
        if not 1 <= self.springs <= 3:
            raise BadInput(f"springs = {self.springs} is out of range; it must be 1, 2 or 3")
        for name in self.free:
            if name not in (*FREE, "moving_mass"):
                raise BadInput(f"free {name!r} is not an option; options are {', '.join((*FREE, 'moving_mass'))}")
            if not self.hardware.values(name):
                raise BadInput(f"free {name!r} is no number of this spring or guide; free others")

    @property
    def widest(self) -> float:
        """Largest radius that rollers may reach where hardware is free: the track and the casing are around it [m]."""
        return self.track_radius or _ROOM * (self.hardware.rho0 + self.hardware.radius)


@record
class Track:
    """One guide of a co-design with its spring."""

    hardware: Hardware  #: with the values that were chosen; p0 is the largest of the schedule [Pa]
    z: "scipy.interpolate.PPoly"  #: closing of the spring over the crank angle [m]
    p0: np.ndarray  #: shape (k,), excess pressure at free height for each point [Pa]


@result
class Active:
    """A limit that the design meets, and what it costs."""

    limit: str = part()  #: Key of `[limits]`, `z_margin` or `ripple`
    multiplier: float = quantity("@price")  #: Change of what is made small for one unit more of the limit
    unit: str = part()  #: Of the limit

    @property
    def price(self) -> str:
        """Unit of the multiplier."""
        return "kg*m^2" if self.unit == "-" else f"kg*m^2/{self.unit}"


@record
class CoDesign:
    """Guides, schedule of pressures and flywheel, as the programme found them."""

    task: CoDesignTask
    status: str  #: `optimal`, `infeasible` or `not converged`
    reason: str  #: the solver's own words
    flywheel: float = quantity("kg*m^2", low=0, about="inertia added to the engine's own")
    tracks: tuple[Track, ...]
    ripple: np.ndarray  #: shape (k,), as the programme sees it, at the worst corner of `robust` [-]
    active: tuple[Active, ...]
    iterations: int
    wall: float = quantity("s", low=0, about="time of building and solving")
    solution: Mapping[str, np.ndarray]  #: unknowns and multipliers as scaled, for the start of another solve [-]
