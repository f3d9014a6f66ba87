r"""Gas springs whose pressure follows a polytrope of the closing: the laws `air_gauge` and `air_absolute`.

.. math:: F = A\left[(p_0 + p_a) \left(\frac{H}{H - z}\right)^n - p_a\right], \qquad
          U = A\left\{\frac{(p_0 + p_a) H}{n - 1}\left[\left(\frac{H}{H - z}\right)^{n - 1} - 1\right]
          - p_a z\right\}

The paper prints p_a = 0: its excess pressure alone follows the polytrope. At n = 1 the energy is the logarithm that it
tends to. The inverse is found over s = -ln(1 - z/H), in which the energy is convex and increasing.

Source: Zotov et al. (2024), eq. (9) and the left side of (10), with p_a = 0.
"""

import math
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from mechsym.hinge.springs.face import Formulas, Spring
from mechsym.quantities import quantity, record
from mechsym.quantities.units import Metre, Pascal, Pure, Scalar

if TYPE_CHECKING:
    from mechsym.hinge.rollers import HingeLosses
    from mechsym.hinge.springs.air_thermal import AirThermal

_STRAIGHT = (
    1e-5  # least n - 1 of symbols: nearer to the isotherm the energy would lose digits and no margin would change
)
_HALLEY = 3  # steps, each with three times the digits of the last, from a start that is a thousandth off


@record
class Polytrope(Spring):
    """What both air springs have in common."""

    setting = "p0", "Pa"
    sensitive = "p0", "n"
    gas = True
    weighed: ClassVar[bool]  #: Whether the air outside counts

    A: float = quantity("m^2", low=1e-8, high=100, about="piston area")
    H: float = quantity("m", low=1e-4, high=100, about="free height of the gas column")
    p0: float = quantity("Pa", low=1, high=1e12, about="excess pressure at free height")
    n: float = quantity("-", low=1, high=2, about="polytropic index")

    @property
    def area(self) -> float:
        """Its own [m^2]."""
        return self.A

    @property
    def index(self) -> float:
        """Its own [-]."""
        return self.n

    def force(self, z: Scalar, warm: object = None) -> Scalar:
        """Piston area by the excess pressure [N]."""
        return self.A * self.pressure(z)

    def stiffness(self, z: Scalar) -> Scalar:
        """In closed form [N/m]."""
        return self.n * (self.force(z) + self.A * self.outside) / (self.H - z)

    @property
    def _full(self) -> Scalar:
        return self.A * (self.p0 + self.outside) * self.H

    def with_wall(self, losses: "HingeLosses", omega: float) -> "AirThermal":
        """The same gas with a wall; without a time of its own such that its index shows at this speed [rad/s]."""
        from mechsym.hinge.springs.air_thermal import AirThermal, relaxation_time

        return AirThermal(
            A=self.A,
            H=self.H,
            p0=self.p0,
            tau=relaxation_time(self.n, omega, losses),
            gamma=losses.gamma,
            wall_temperature=losses.wall_temperature,
            pa=self.outside,
        )

    def symbolic(self) -> Formulas:
        """For symbols, over x = -ln(1 - z/H), in which the energy is nearly straight."""
        pa, e = self.outside, np.maximum(self.n - 1, _STRAIGHT)
        full, outside = self._full, self.A * pa * self.H
        # products with these are cheaper than quotients, and they are computed once
        per_e, per_H = 1 / e, 1 / self.H
        near, step = _inverse(full, outside, e)

        def energy(z: Scalar) -> Scalar:
            x = -np.log(1 - z / self.H)
            # exp - 1 and not expm1, which would be computed one design at a time
            return full * (np.exp(e * x) - 1) * per_e + outside * (np.exp(-x) - 1)

        def closing(U: Scalar) -> Scalar:
            x = np.log(near(U)) * per_e
            for _ in range(_HALLEY if self.weighed else 0):
                x = x + step(np.exp(e * x), np.exp(-x), U)
            return self.H * (1 - np.exp(-x))

        def along(U: Scalar) -> tuple[Scalar, Scalar, Scalar]:
            # the exponentials are computed once and follow two steps by their series
            E = near(U)
            V = np.exp(-per_e * np.log(E))
            for _ in range(2 if self.weighed else 0):
                d = step(E, V, U)
                E, V = E * _exp(e * d), V * _exp(-d)
            per_V = 1 / V
            pressed = (full * per_H) * E * per_V
            return self.H * (1 - V), pressed - outside * per_H, (self.n * per_H) * pressed * per_V

        return Formulas(energy=energy, closing=closing, along=along)


@record
class AirGauge(Polytrope):
    """Air spring as the paper prints it: the gauge pressure alone follows the polytrope."""

    words = "air, its excess pressure on the polytrope"
    weighed = False

    def pressure(self, z: Scalar, warm: object = None) -> Scalar:
        """Pressure [Pa] at a closing z [m], see `gauge_pressure`."""
        return gauge_pressure(z, self.H, self.p0, self.n)

    def energy(self, z: Scalar, warm: object = None) -> Scalar:
        """Of the excess pressure alone [J]."""
        return self._full * _power_integral(-np.log1p(-np.asarray(z) / self.H), self.n - 1)

    def closing(self, U: Scalar) -> Scalar:
        """The inverse in closed form [m]."""
        return -self.H * np.expm1(-_inverse_power_integral(np.asarray(U) / self._full, self.n - 1))

    @property
    def energy_low(self) -> Scalar:
        """What the gas gives as its column grows without end [J]."""
        e = self.n - 1
        if np.ndim(e):
            return -np.where(e > 0, self._full / np.where(e > 0, e, 1.0), math.inf)
        return -self._full / e if e > 0 else -math.inf


@record
class AirAbsolute(Polytrope):
    """Air spring with the absolute pressure on the polytrope and the atmosphere on the other side of the piston."""

    words = "air, its absolute pressure on the polytrope"
    weighed = True

    pa: float = quantity("Pa", default=101325.0, above=0, about="pressure outside")

    @property
    def outside(self) -> float:
        """The atmosphere [Pa]."""
        return self.pa

    def pressure(self, z: Scalar, warm: object = None) -> Scalar:
        """Pressure [Pa] at a closing z [m], see `absolute_pressure`."""
        return absolute_pressure(z, self.H, self.p0, self.n, self.pa)

    def energy(self, z: Scalar, warm: object = None) -> Scalar:
        """Of the gas less the work of the air outside [J]."""
        return self._energy_of(-np.log1p(-np.asarray(z) / self.H))

    def _energy_of(self, s: Scalar) -> Scalar:
        return self._full * _power_integral(s, self.n - 1) + self.A * self.pa * self.H * np.expm1(-s)

    def closing(self, U: Scalar) -> Scalar:
        """The inverse by Newton's method [m].

        Dropping the work against the atmosphere, at most pa A H, gives a start to the right of the root, from where the
        method falls onto it without overshooting.
        """
        U, full, aired = np.asarray(U, dtype=float), self._full, self.A * self.pa * self.H
        s = _inverse_power_integral((U + aired) / full, self.n - 1)
        last, done = math.inf, np.zeros(np.shape(U), bool)
        for _ in range(60):
            step = (self._energy_of(s) - U) / (full * np.exp((self.n - 1) * s) - aired * np.exp(-s))
            s = s - step
            size = np.abs(step)
            # the steps fall until only rounding is left, which near z_low is more than the last digit of s
            done = done | (size <= 4e-16 * (1 + np.abs(s))) | (size >= last)
            if done.all():
                break
            last = size
        return -self.H * np.expm1(-s)

    @property
    def _s_low(self) -> Scalar:
        return -np.log1p(self.p0 / self.pa) / self.n

    @property
    def z_low(self) -> Scalar:
        """Where the gas has the pressure of the air outside [m]."""
        return -self.H * np.expm1(-self._s_low)

    @property
    def energy_low(self) -> Scalar:
        """Energy there [J]."""
        return self._energy_of(self._s_low)


def gauge_pressure(z: Metre[Scalar], H: Metre[Scalar], p0: Pascal[Scalar], n: Pure[Scalar]) -> Pascal[Scalar]:
    r"""Excess pressure of the paper's air spring, for numbers and symbols alike.

    .. math:: p = p_0 \left(\frac{H}{H - z}\right)^n

    z, H: closing and free height; p0: excess pressure at free height; n: polytropic index.
    Source: Zotov et al. (2024), eq. (9).

    >>> gauge_pressure(0.5, 1.0, 5e6, 1.0)
    10000000.0
    """
    return p0 * (H / (H - z)) ** n


def absolute_pressure(
    z: Metre[Scalar], H: Metre[Scalar], p0: Pascal[Scalar], n: Pure[Scalar], pa: Pascal[Scalar]
) -> Pascal[Scalar]:
    r"""Excess pressure of a real gas spring, for numbers and symbols alike.

    .. math:: p = (p_0 + p_a) \left(\frac{H}{H - z}\right)^n - p_a

    z, H: closing and free height; p0, pa: excess pressure at free height, and the pressure outside; n: polytropic
    index.

    >>> absolute_pressure(0.5, 1.0, 5e6, 1.0, 1e5)
    10100000.0
    """
    return (p0 + pa) * (H / (H - z)) ** n - pa


def _power_integral(s: Scalar, e: Scalar) -> Scalar:
    """Integral of exp(e s) from 0 to s: (exp(e s) - 1) / e, and s at e = 0."""
    if np.ndim(e):
        safe = np.where(e > 0, e, 1.0)
        return np.where(e > 0, np.expm1(safe * s) / safe, s)
    return np.expm1(e * s) / e if e > 0 else s


def _inverse_power_integral(q: Scalar, e: Scalar) -> Scalar:
    if np.ndim(e):
        safe = np.where(e > 0, e, 1.0)
        return np.where(e > 0, np.log1p(safe * q) / safe, q)
    return np.log1p(e * q) / e if e > 0 else q


def _inverse(full: Scalar, outside: Scalar, e: Scalar) -> tuple[Scalar, Scalar]:
    """From the energy U to x: nearly exp(e x), and a step of Halley from where exp(e x) is E and exp(-x) is V."""
    per_e, per_full = 1 / e, 1 / full

    def near(U: Scalar) -> Scalar:
        # what the outside takes of the energy, by the force that the free spring has
        D = full - outside + U / 2
        share = D**2 / (D**2 + D * U + U**2 / 2)
        return 1 + (e * per_full) * (U + outside * (1 - share))

    def step(E: Scalar, V: Scalar, U: Scalar) -> Scalar:
        over = (full * per_e) * (E - 1) + outside * (V - 1) - U
        slope, bend = full * E - outside * V, e * full * E + outside * V
        return -2 * over * slope / (2 * slope**2 - over * bend)

    return near, step


def _exp(d: Scalar) -> Scalar:
    """Series of exp(d) for small d."""
    return 1 + d * (1 + d * (1 / 2 + d * (1 / 6 + d / 24)))
