"""Choosing and checking rolling bearings for a load history over the speeds."""

import functools
from collections.abc import Iterable

import numpy as np

from mechsym.quantities import RPM, record
from mechsym.quantities.units import Kilogram, Metre
from mechsym.sizing.checks import Check, at_least, at_most, at_speed, unsafe
from mechsym.sizing.rules import bearings
from mechsym.sizing.rules.bearings import Bearing
from mechsym.sizing.wants import Wants

_STEEL = 7800.0  # for the inner ring that is left out [kg/m^3]


@record
class Seat:
    """A place for bearings."""

    name: str  #: Name of the place, for the checks
    omega: np.ndarray  #: shape (k,): Crank speeds, for the notes [rad/s]
    load: np.ndarray  #: shape (k, n): Radial load of the place over the period [N]
    turning: np.ndarray  #: shape (k,): Speed of one ring relative to the other [rad/s]

    @functools.cached_property
    def peak(self) -> np.ndarray:
        """Largest load at each speed, shape (k,) [N]."""
        return np.asarray(np.abs(self.load).max(axis=1))

    @functools.cached_property
    def ball(self) -> np.ndarray:
        """Load of equal life on balls, shape (k,) [N]."""
        return bearings.equivalent_load(self.load, "ball")

    @functools.cached_property
    def roller(self) -> np.ndarray:
        """Load of equal life on rollers, shape (k,) [N]."""
        return bearings.equivalent_load(self.load, "roller")


@record
class Choice:
    """Bearings for a place."""

    bearing: Bearing
    count: int = 1
    ring_off: bool = False  #: Whether the shaft replaces the inner ring

    @property
    def stack(self) -> float:
        """Width of the bearings side by side [m]."""
        return self.count * self.bearing.width


def seat_diameter(choice: Choice) -> Metre:
    """Diameter of the shaft under a bearing. Returns d: bore, or the raceway when the inner ring is left out."""
    return float(choice.bearing.raceway if choice.ring_off and choice.bearing.raceway else choice.bearing.bore)


def mass(choice: Choice) -> Kilogram:
    """Mass of the bearings of one place. Returns m: mass, without the inner rings that are left out."""
    one = choice.bearing.mass
    if choice.ring_off and choice.bearing.raceway:
        one -= _STEEL * np.pi / 4 * (choice.bearing.raceway**2 - choice.bearing.bore**2) * choice.bearing.width
    return float(choice.count * one)


def check_bearing(choice: Choice, seat: Seat, wants: Wants) -> list[Check]:
    """Static load, life and speed of the bearings of one place, each at its worst crank speed."""
    bearing, name = choice.bearing, f"{seat.name}, {choice.count} x {choice.bearing.designation}"
    peak, P = seat.peak, seat.ball if bearing.kind == "ball" else seat.roller
    k = int(np.argmax(peak))
    C = bearings.set_rating(bearing.C, choice.count, bearing.kind)
    life = np.full(P.shape, np.inf)
    loaded = P > 0
    turns = bearings.life_revolutions(C, P[loaded], bearing.kind, wants.bearing_reliability)
    life[loaded] = bearings.life_hours(turns, seat.turning[loaded])
    j, i = int(np.argmin(life)), int(np.argmax(np.abs(seat.turning)))
    static = wants.static_ball if bearing.kind == "ball" else wants.static_roller
    return [
        at_most(name, "static load", float(peak[k]), choice.count * bearing.C0, "N", wanted=static,
                rule="static rating", source="ISO 76", note=at_speed(seat.omega, k)),
        at_least(name, "life", float(life[j]) * 3600, wants.life, "s", wanted=1.0, rule="rating life", source="ISO 281",
                 note=f"{at_speed(seat.omega, j)}: {life[j]:.0f} h, equivalent load {P[j]:.0f} N"),
        at_most(name, "speed", float(abs(seat.turning[i])), bearing.limiting, "rad/s", wanted=1.0,
                rule="limiting speed", source=bearing.source,
                note=f"{abs(seat.turning[i]) / RPM:.0f} rpm of one ring against the other"),
    ]  # fmt: skip


def choices(catalogue: Iterable[Bearing], shaft: tuple[Metre, Metre], outside: Metre, most: int = 3) -> list[Choice]:
    """Bearings that fit, the lightest first. shaft: smallest and largest diameter; outside: largest diameter."""
    fitting = []
    for bearing in catalogue:
        for ring_off in (False, True) if bearing.raceway and bearing.raceway > bearing.bore else (False,):
            for count in range(1, most + 1):
                choice = Choice(bearing=bearing, count=count, ring_off=ring_off)
                if shaft[0] - 1e-9 <= seat_diameter(choice) <= shaft[1] + 1e-9 and bearing.outside <= outside + 1e-9:
                    fitting.append(choice)
    return sorted(fitting, key=mass)


def choose(options: Iterable[Choice], seat: Seat, wants: Wants) -> Choice | None:
    """The first of the bearings offered that passes every check."""
    return next((option for option in options if not unsafe(check_bearing(option, seat, wants))), None)
