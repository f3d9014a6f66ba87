"""What every limit of a guide answers, and what a guide is and bears at an angle of its track."""

import dataclasses
import functools
import math
from collections.abc import Callable, Iterator
from typing import Annotated, Any

import casadi as ca
import numpy as np

from mechsym.hinge import rollers as contact
from mechsym.quantities import quantity, record
from mechsym.quantities.records import Record
from mechsym.quantities.units import Newton, Pascal, Radian, Scalar, scale


@record
class Station:
    """A guide at angles of its track: floats, arrays or symbols in SI."""

    spring: Any  #: with the setting that it has there, see `springs.face`
    rollers: Any  #: radius, width, modulus and mass of a roller
    count: int  #: rollers that move the spring
    rho0: Scalar  #: roller centre to shaft axis at free height [m]
    omega: Scalar  #: speed of the guide's shaft [rad/s]
    #: path of the roller centres and its derivatives [m], [m/rad], [m/rad^2]
    rho: Scalar
    drho: Scalar = 0.0
    d2rho: Scalar = 0.0
    z: Scalar  #: closing of the spring [m]
    force: Scalar  #: of the spring on each roller [N]
    warm: Scalar = None  #: state of its gas, where it has one [-]

    @functools.cached_property
    def pressure(self) -> Scalar:
        """Excess pressure in the spring [Pa]; None without gas."""
        return self.spring.pressure(self.z, self.warm)

    @functools.cached_property
    def pressure_angle(self) -> Radian[Scalar]:
        """Of the path, signed."""
        return contact.pressure_angle(self.rho, self.drho)

    @functools.cached_property
    def curvature(self) -> Annotated[Scalar, "1/m"]:
        """Of the path, negative where it bends inwards."""
        return contact.curvature(self.rho, self.drho, self.d2rho)

    @functools.cached_property
    def reaction(self) -> Newton[Scalar]:
        """Contact force of a roller."""
        return contact.contact_force(self.force, self.rho, self.drho, self.d2rho, self.rollers.moving_mass, self.omega)

    @functools.cached_property
    def hertz_stress(self) -> Pascal[Scalar]:
        """Contact pressure, infinite where the profile is undercut."""
        return contact.hertz_stress(self.reaction, self.curvature, self.rollers)


Rows = tuple[tuple[Scalar, float, float], ...]


@record
class GuideLimit:
    """What is asked of a guide along its track, and what it may be asked."""

    name: str  #: of its check
    words: str  #: what is asked
    shown: str  #: unit in which people read it; empty for a pure number
    value: Callable[[Station, Scalar], Scalar]  #: asked at a station, for a setting [SI]
    most: Callable[[Station, Scalar], Scalar] = lambda at, setting: setting  #: allowed there [SI]
    #: whether it holds for a spring, a number of rollers
    holds: Callable[[Any, int], bool] = lambda spring, count: True
    by_closing: bool = False  #: whether the closing alone decides, so that an end of the path asks most
    signed: bool = False  #: whether it asks nothing where its value is not positive
    #: what rises with the share and is cheaper for many guides at once, and the share where that has a value
    rising: Callable[[Station, Scalar], Scalar] | None = None
    of_rising: Callable[[Scalar, Scalar], Scalar] = lambda top, setting: top
    #: constraints low <= rows <= high of a programme, smooth where the share is not
    smooth: Callable[[Station, Scalar], Rows] | None = None
    #: setting that makes it so much stricter [-], of rollers of a radius [m]
    stricter: Callable[[Scalar, float, float], Scalar] = lambda setting, by, radius: setting / by
    #: value, allowed, setting and station in words, where they say more than the numbers
    text: Callable[[float, float, Scalar, Station], str] | None = None
    unit: str = ""  #: of its setting in `[limits]`, SI; empty where it has none
    about: str = ""  #: meaning of the setting
    allowed: dict[str, Any] = dataclasses.field(default_factory=dict)  #: range of the setting, as `quantity` has it

    def share(self, at: Station, setting: Scalar) -> Scalar:
        """Share of the limit that is used [-]; beyond 1 too where nothing at all is allowed."""
        value, most = self.value(at, setting), self.most(at, setting)
        if self.unit:
            return value / most
        if isinstance(most, ca.SX):
            return ca.if_else(most > 0, value / most, 2 - most / value)
        room = np.asarray(most) > 0
        return np.where(room, value / np.where(room, most, 1.0), 2 - most / value)

    def rows(self, at: Station, setting: Scalar) -> Rows:
        """Constraints of a programme [-] for a setting [SI]."""
        return self.smooth(at, setting) if self.smooth else ((self.share(at, setting), -math.inf, 1.0),)

    def told(self, value: float, most: float, setting: Scalar, at: Station) -> str:
        """Value and limit [SI] in words."""
        if self.text:
            return self.text(value, most, setting, at)
        of = scale(self.shown or "-")
        return f"{self.words} {value / of:.4g} of at most {most / of:.4g} {self.shown}".rstrip()

    def setting(self, default: object = dataclasses.MISSING) -> Any:
        """Its field of `[limits]`; None as default asks nothing."""
        field = quantity(self.unit, about=self.about, default=default, **self.allowed)
        return dataclasses.field(default=field.default, metadata={**field.metadata, "limit": self})


def asked(limits: Record, *others: GuideLimit) -> Iterator[tuple[str, GuideLimit, Scalar]]:
    """Limits of a record with their key and setting [SI], and others that have none."""
    for field in dataclasses.fields(limits):
        if getattr(limits, field.name) is not None:
            yield field.name, field.metadata["limit"], getattr(limits, field.name)
    for limit in others:
        yield limit.name, limit, None
