"""Choices of a guide by name: how its track carries the spring, where its turn starts; and every limit that it has.

Arrangements
    two_tracks              two rollers half a turn apart on two tracks in offset planes, the second track turned by
                            half a turn, so that both rollers move in by the same amount; the planes' offset tilts
    one_roller              one roller against a fixed spring seat
    half_speed_pi_periodic  two rollers on one plane track that repeats every half turn of its shaft; the opposite
                            roller then moves alike, and the shaft turns at half the speed of the cycle

Starts
    as_printed              the spring has its free height at phi = 0, as in the source; where the torque has given
                            work since then, the spring would have to be longer than that
    placed                  the constant of the work is chosen so that the spring is never longer

Source: Zotov et al. (2024), section 3, draws two rollers on one track, which can only give a torque of period pi.
"""

import dataclasses
import functools
import math
from collections.abc import Callable, Iterator
from typing import Annotated, Any

import casadi as ca
import numpy as np

from mechsym.errors import BadInput
from mechsym.hinge import rollers as contact
from mechsym.quantities import choice, quantity, record
from mechsym.quantities.records import Record
from mechsym.quantities.units import Newton, Pascal, Pure, Radian, Scalar, scale


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


SPRING_PRESSURE = GuideLimit(
    name="spring_pressure", words="spring pressure", shown="MPa",
    unit="Pa", about="excess pressure in the air spring", allowed={"above": 0},
    value=lambda at, setting: at.pressure, holds=lambda spring, count: spring.gas, by_closing=True,
)  # fmt: skip

CLOSING = GuideLimit(
    name="closing", words="closing z/H", shown="",
    unit="-", about="closing over free height, z / H", allowed={"above": 0, "high": 1},
    value=lambda at, setting: at.z / at.spring.H, by_closing=True,
)  # fmt: skip


def _room(radius: float, room: float, setting: object, at: Station) -> str:
    rho0, H = at.rho0, at.spring.H
    if room > 0:
        return f"roller radius beside the gas column {1e3 * radius:.4g} of at most {1e3 * room:.4g} mm"
    return (
        f"between the rollers is no room for the gas column: 2 rho0 = {2 * rho0:.4g} m, it is H = {H:.4g} m "
        f"long; with rollers of {radius:.4g} m radius rho0 must be at least {H / 2 + radius:.4g} m"
    )


# between the roller centres lie 2 rho = H - z + (2 rho0 - H); the rest beside the gas must hold both rollers
ROOM = GuideLimit(
    name="room", words="roller radius beside the gas column", shown="mm", text=_room,
    value=lambda at, setting: at.rollers.radius, most=lambda at, setting: at.rho0 - at.spring.H / 2,
    holds=lambda spring, count: spring.gas and count == 2, by_closing=True,
)  # fmt: skip


def _slope(at: Station, setting: Scalar) -> Rows:
    slope, steepest = at.drho / at.rho, ca.tan(setting)
    return (slope / steepest, -math.inf, 1.0), (-slope / steepest, -math.inf, 1.0)


PRESSURE_ANGLE = GuideLimit(
    name="pressure_angle", words="pressure angle", shown="deg",
    unit="rad", about="pressure angle", allowed={"above": 0, "below": math.pi / 2},
    value=lambda at, setting: np.abs(at.pressure_angle), smooth=_slope,
    rising=lambda at, setting: np.abs(at.drho / at.rho), of_rising=lambda top, setting: np.arctan(top) / setting,
)  # fmt: skip


def _bulge(bend: float, most: float, profile_radius: float, at: Station) -> str:
    if bend <= 0:
        return f"the path never bends inwards; a bulge may have {profile_radius * 1e3:.4g} mm"
    radius = at.rollers.radius
    largest = (radius + profile_radius) / bend
    return (
        f"the path bends inwards with a radius of {largest * 1e3:.4g} mm, which leaves the profile "
        f"{(largest - radius) * 1e3:.4g} mm at a roller radius of {radius * 1e3:.4g} mm"
        + (" (undercut)" if largest <= radius else "")
        + f"; at least {profile_radius * 1e3:.4g} mm"
    )


UNDERCUT = GuideLimit(
    name="undercut", words="bend inwards by what the roller allows", shown="", text=_bulge, signed=True,
    unit="m", about="radius of the profile where it bulges towards the roller", allowed={"low": 0},
    value=lambda at, setting: -at.curvature * (at.rollers.radius + setting), most=lambda at, setting: 1.0,
    stricter=lambda setting, by, radius: (radius + setting) * by - radius,
)  # fmt: skip

ROLLER_REACTION = GuideLimit(
    name="roller_reaction", words="roller reaction", shown="kN",
    unit="N", about="contact force on a roller", allowed={"above": 0},
    value=lambda at, setting: at.reaction,
    smooth=lambda at, setting: ((at.reaction / setting, 0.0, 1.0),),  # the track can only push
)  # fmt: skip


def _pressed(at: Station, setting: Scalar) -> Rows:
    # by 1 + r kappa on both sides, so that there is a number where the profile is undercut
    r, modulus = at.rollers.radius, contact.contact_modulus(at.rollers)
    pressed = at.reaction * modulus / (math.pi * at.rollers.width * r * setting**2)
    return ((pressed - r * at.curvature, -math.inf, 1.0),)


HERTZ_STRESS = GuideLimit(
    name="hertz_stress", words="contact pressure", shown="MPa",
    unit="Pa", about="contact pressure", allowed={"above": 0},
    value=lambda at, setting: at.hertz_stress, smooth=_pressed,
)  # fmt: skip

CENTRE = GuideLimit(
    name="centre", words="roller radius beside the path's smallest radius", shown="mm",
    value=lambda at, setting: at.rollers.radius, most=lambda at, setting: at.rho, by_closing=True,
    smooth=lambda at, setting: ((at.rollers.radius / at.rho, -math.inf, 1.0),),
)  # fmt: skip


BALANCES = ("whole_cycle", "every_turn")  # part of the torque that is balanced
ROLLERS = {"two_tracks": 2, "one_roller": 1, "half_speed_pi_periodic": 2}
_PERIODS_MULTIPLE_OF = {"two_tracks": 1, "one_roller": 1, "half_speed_pi_periodic": 2}


@record
class GuideParameters:
    """What is chosen about the guide."""

    arrangement: str = choice(*ROLLERS, about="how the track carries the spring")
    start: str = choice("placed", "as_printed", default="placed", about="where the turn starts on the spring's curve")
    #: Shaft axis to roller centre where the spring has its free height [m]
    rho0: float = quantity("m", above=0, high=100, about="roller centre to shaft axis at free height")
    z_margin: float = quantity(
        "m", default=0.0, low=0, about="smallest closing of a placed start", only=("start", "placed")
    )
    shaft_ratio: float = quantity("-", default=1.0, above=0, about="turns of the guide's shaft per turn of the crank")
    #: Part of the torque to balance, `whole_cycle` or `every_turn`
    balance: str = choice(*BALANCES, default="whole_cycle", about="part of the torque to balance")

    @property
    def rollers(self) -> int:
        """Rollers c that move the spring."""
        return ROLLERS[self.arrangement]


@record
class Limits:
    """What the spring, the track and the rollers may be asked; one row for each limit, see `GuideLimit`."""

    spring_pressure: float = SPRING_PRESSURE.setting()
    closing_share: float = CLOSING.setting()
    pressure_angle: float = PRESSURE_ANGLE.setting()
    profile_radius: float = UNDERCUT.setting()
    roller_reaction: float = ROLLER_REACTION.setting()
    hertz_stress: float = HERTZ_STRESS.setting()


def closing_ratio(arrangement: str, period: Radian) -> Pure:
    """The fastest shaft on which a track closes after one turn.

    period: period of the torque over the crank angle. Returns shaft_ratio: turns of the guide's shaft per turn of the
    crank.
    """
    return 2 * math.pi / (period * _PERIODS_MULTIPLE_OF[arrangement])


def refuse_open_track(parameters: GuideParameters, period: Radian) -> None:
    """Refuse a shaft ratio with which the track would not close. period: period of the torque over the crank angle."""
    multiple = _PERIODS_MULTIPLE_OF[parameters.arrangement]
    periods = 2 * math.pi / (period * parameters.shaft_ratio)
    if round(periods) < 1 or abs(periods - round(periods)) > 1e-9 or round(periods) % multiple:
        raise BadInput(
            f"guide.shaft_ratio = {parameters.shaft_ratio:g}: the {parameters.arrangement} track does not close, since "
            f"the torque repeats every {period / (2 * math.pi):g} turns of the crank; "
            f"use {closing_ratio(parameters.arrangement, period):g}"
        )
