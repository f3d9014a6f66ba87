"""What is asked of a co-design, what its hinge is made of, the limits of its path, and what it gives.

z = c (rho0 - rho)      closing of the spring, moved by c rollers on tracks that turn with the shaft
F, U                    force of the spring on each roller and the energy it stores
m_h                     mass that moves with each roller: roller, pin, half of the spring's piston
"""

import dataclasses
from collections.abc import Mapping
from typing import Any

import numpy as np

from mechsym.codesign.points import Point
from mechsym.codesign.settings import FREE
from mechsym.errors import BadInput
from mechsym.hinge.choices import CENTRE, Limits, Rows, Station, asked
from mechsym.hinge.rollers import HingeLosses
from mechsym.hinge.springs.face import Spring, lettered
from mechsym.periodic.pieces import PPoly
from mechsym.quantities import choice, quantity, record
from mechsym.quantities.records import Record
from mechsym.quantities.results import part, result
from mechsym.quantities.units import Inertia, Kilogram, Metre, MetrePerRadian, RadPerSecond, Scalar


@record
class Hardware:
    """One guide with its spring and rollers; a second spring has a second one like it."""

    spring: Spring  #: with the setting to start from; its force follows from the closing alone
    rho0: float = quantity("m", above=0, about="roller centre to shaft axis at free height")
    z_margin: float = quantity("m", default=0.0, low=0, about="smallest closing")
    count: int = 2  #: rollers c that move the spring
    shaft_ratio: float = quantity("-", default=1.0, above=0, about="turns of the guide's shaft per turn of the crank")
    radius: float = quantity("m", above=0, about="roller radius")
    width: float = quantity("m", above=0, about="width of contact")
    E: float = quantity("Pa", default=2.06e11, above=0, about="Young's modulus of roller and track")
    nu: float = quantity("-", default=0.3, low=0, high=0.5, about="Poisson's ratio of roller and track")
    moving_mass: float = quantity("kg", default=0.0, low=0, about="mass that moves with each roller")
    roller_inertia: float = quantity("kg*m^2", default=0.0, low=0, about="inertia of a roller about its pin")

    def values(self, *names: str) -> dict[str, float]:
        """Those of some numbers that its spring or itself has [SI]."""
        owners = {name: self.spring if hasattr(self.spring, name) else self for name in names}
        return {name: getattr(owner, name) for name, owner in owners.items() if hasattr(owner, name)}

    def changed(self, values: Mapping[str, Scalar]) -> "Hardware":
        """The same with other numbers of its spring or of itself [SI]."""
        own = {f.name for f in dataclasses.fields(self.spring)}
        spring = dataclasses.replace(self.spring, **{k: v for k, v in values.items() if k in own})
        return dataclasses.replace(self, spring=spring, **{k: v for k, v in values.items() if k not in own})

    def charged(self, setting: Scalar, **letters: Scalar) -> Spring:
        """Its spring with a setting [Pa, or N of a coil] and other numbers; arrays and symbols too."""
        own = {name: value for name, value in letters.items() if hasattr(self.spring, name)}
        return lettered(self.spring, {self.spring.setting[0]: setting, **own})

    def walled(self, setting: Scalar, losses: HingeLosses, omega: RadPerSecond) -> Any:
        """Its spring, set [Pa, or N of a coil], with a wall at a crank speed [rad/s]; None of a law without heat."""
        return self.charged(setting).with_wall(losses, self.shaft_ratio * omega)

    def station(self, path: Any, spring: Spring, omega: RadPerSecond[Scalar], **letters: Scalar) -> Station:
        """A guide at the angles of a path, for its limits; omega of the crank, other numbers [SI]."""
        rollers = lettered(self, letters)
        return Station(
            spring=spring, rollers=rollers, count=self.count, rho0=rollers.rho0, omega=self.shaft_ratio * omega,
            rho=path.rho, drho=path.drho, d2rho=path.d2rho, z=path.z, force=spring.force(path.z),
        )  # fmt: skip


def roller_inertia(
    rho: Metre[Scalar],
    drho: MetrePerRadian[Scalar],
    mass: Kilogram[Scalar],
    inertia: Inertia,
    radius: Metre[Scalar],
    count: int,
) -> Inertia[Scalar]:
    r"""Inertia that the rollers add to the shaft of the guide.

    .. math:: I_h = c\,(\rho^2 + \rho'^2)\left(m_h + \frac{J_r}{r^2}\right)

    rho, drho: path of the roller centres and its derivative; mass: m_h of each roller; inertia: J_r of each roller
    about its pin; radius: of a roller. Returns I_h: about the axis of the guide's shaft. Spring and rollers turn with
    the shaft and press outwards on tracks around them; the rollers roll without slip.

    >>> round(roller_inertia(0.7, 0.0, 100.0, 0.0, 0.1, 2), 6)
    98.0
    """
    return count * (rho**2 + drho**2) * (mass + inertia / radius**2)


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
    z: PPoly  #: closing of the spring over the crank angle [m]
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


_FINE = 720  # angles of a turn on which a finished guide is looked at


@record
class Path:
    """Path of the roller centres on the angles of the programme, symbols or arrays of shape (n,)."""

    z: Scalar  #: closing of the spring [m]
    rho: Scalar  #: shaft axis to roller centre [m]
    drho: Scalar  #: its derivative by the angle of the guide's shaft [m/rad]
    d2rho: Scalar  #: and the second [m/rad^2]


def path_of(hardware: Hardware, rho0: Scalar, z: Scalar, dz: Scalar, d2z: Scalar) -> Path:
    """Path of the rollers of a closing z [m] and its derivatives by the crank angle [m/rad, m/rad^2]; rho0 in [m]."""
    c, ratio = hardware.count, hardware.shaft_ratio
    return Path(z=z, rho=rho0 - z / c, drho=-dz / (c * ratio), d2rho=-d2z / (c * ratio**2))


def fine_path(track: Track, period: float) -> tuple[np.ndarray, Path]:
    """Even angles [rad] of a turn and the path of a guide there."""
    phi = np.arange(round(_FINE * period / (2 * np.pi))) * 2 * np.pi / _FINE
    z, h = track.z(phi), track.hardware
    return phi, path_of(h, h.rho0, z, track.z.derivative()(phi), track.z.derivative(2)(phi))


def limit_rows(at: Station, limits: Record, least: Metre, reach: Metre[Scalar] | None) -> Rows:
    """Each limit as (values, lowest, highest), values by the limit or by their scale.

    limits: settings as symbols. least: smallest closing. reach: largest radius that rollers may reach; None asks none.
    """
    entries = [((at.z - least) / at.spring.H, 0.0, np.inf)]
    for _, limit, setting in asked(limits, CENTRE):
        if limit.holds(at.spring, at.count):
            entries += limit.rows(at, setting)
    if reach is not None:
        entries.append(((at.rho + at.rollers.radius) / reach, -np.inf, 1.0))
    return tuple(entries)
