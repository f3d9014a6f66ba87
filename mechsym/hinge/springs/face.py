"""What every spring of a hinge answers: guide, limits, runs in time, prices, exports and drawings ask nothing else."""

import dataclasses
import math
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, ClassVar, TypeVar

import numpy as np

from mechsym.quantities import quantity, record
from mechsym.quantities.units import Scalar

if TYPE_CHECKING:
    from mechsym.hinge.balance import Balance
    from mechsym.hinge.choices import GuideParameters
    from mechsym.hinge.rollers import HingeLosses
    from mechsym.hinge.springs.law_path import TrackPath
    from mechsym.hinge.torque import Hinge


@record
class Formulas:
    """A law written out for symbols, for the functions that are compiled; see `mechsym.hinge.kernel`."""

    energy: Callable[[Scalar], Scalar]  #: Closing [m] to stored energy [J]
    closing: Callable[[Scalar], Scalar]  #: The inverse
    #: Stored energy [J] to closing [m], force [N] and its slope [N/m]
    along: Callable[[Scalar], tuple[Scalar, Scalar, Scalar]]


@record
class GasTurn:
    """A periodic turn of the gas; arrays over the angles that were asked for."""

    temperature: np.ndarray  #: shape (n,) [K]
    warmth: np.ndarray  #: shape (n,): Temperature by the wall's [-]
    pressure: np.ndarray  #: excess pressure, shape (n,) [Pa]
    loss: float = quantity("J", about="work that the gas takes and does not give back in a period")
    n_effective: float = quantity("-", about="index that fits pressure over volume around the turn")
    leaked: float = quantity("kg", default=0.0, about="mass that make-up has to bring back in a period")


@record
class Spring:
    """A spring by its numbers, which are floats; of `lettered` ones arrays or symbols.

    A law whose force follows from the closing alone has `energy` and `closing`, its inverse; the path is then common to
    all. One with a state of its gas, T / T_w, has `path`, `turn`, `warming` and `heat` in place of `closing`.
    """

    setting: ClassVar[tuple[str, str]]  #: Name and unit of the number that retuning changes; the force is affine in it
    words: ClassVar[str]  #: What it is, for a drawing
    sensitive: ClassVar[tuple[str, ...]]  #: Numbers whose errors are tried, the setting first
    gas: ClassVar[bool] = False  #: Whether there is gas in it, whose pressure has limits of its own
    state: ClassVar[str] = ""  #: Name of the state of its gas; empty where the closing says all
    if TYPE_CHECKING:
        H: float  #: Closing at which it is full [m]

    @property
    def tunable(self) -> tuple[str, ...]:
        """Numbers that may be changed without another track: all of them."""
        return tuple(field.name for field in dataclasses.fields(self))

    @property
    def area(self) -> float:
        """Area of the piston on its gas, 0 without gas [m^2]."""
        return 0.0

    @property
    def index(self) -> float | None:
        """Index of the polytrope that its gas follows; None where it follows none [-]."""
        return None

    @property
    def outside(self) -> float:
        """Pressure outside that the law counts [Pa]."""
        return 0.0

    def force(self, z: Scalar, warm: object = None) -> Scalar:
        """Force outwards [N] at a closing [m], and at T / T_w of a gas with a state [-]."""
        raise NotImplementedError

    def pressure(self, z: Scalar, warm: object = None) -> Scalar:
        """Excess pressure [Pa], as `force`; None without gas."""
        return None

    def stiffness(self, z: Scalar) -> Scalar:
        """Slope of the force [N/m] at a closing [m], where the closing says all."""
        import casadi as ca

        x = ca.SX.sym("z")
        slope = ca.jacobian(self.force(x), x)
        if isinstance(z, ca.SX):
            return ca.substitute(slope, x, z)
        return np.asarray(ca.Function("slope", [x], [slope])(np.reshape(z, (1, -1)))).reshape(np.shape(z))

    def energy(self, z: Scalar, warm: object = None) -> Scalar:
        """Stored energy [J], as `force`; 0 at z = 0 where the closing says all."""
        raise NotImplementedError

    def closing(self, U: Scalar) -> Scalar:
        """Closing [m] at a stored energy [J]."""
        raise NotImplementedError

    @property
    def z_low(self) -> Scalar:
        """Closing below which it would pull; -inf where there is none [m]."""
        return -math.inf

    @property
    def energy_low(self) -> Scalar:
        """Stored energy there [J]."""
        return -math.inf

    @property
    def energy_high(self) -> Scalar:
        """Stored energy at its full closing [J]."""
        return math.inf

    def symbolic(self) -> Formulas:
        """The law for symbols; a law overrides it to be faster, or where its own formulas take none."""

        def along(U: Scalar) -> tuple[Scalar, Scalar, Scalar]:
            z = self.closing(U)
            return z, self.force(z), self.stiffness(z)

        return Formulas(energy=self.energy, closing=self.closing, along=along)

    def path(self, wanted: "Hinge | Balance", parameters: "GuideParameters") -> "TrackPath":
        """Path of the roller centres on which the spring gives a torque, or why there is none."""
        from mechsym.hinge.springs.law_path import law_path

        return law_path(wanted, self, parameters)

    def with_wall(self, losses: "HingeLosses", omega: float) -> Any:
        """The law `air_thermal` of its gas on a shaft of some speed [rad/s]; None without gas."""
        return None

    def turn(self, z: np.ndarray, step: np.ndarray, omega: float) -> GasTurn:
        """Periodic turn of a gas with a state: closings [m], angle from each to the next [rad], speed [rad/s]."""
        raise NotImplementedError

    def warming(self, warm: object, z: Scalar, opening: object) -> Scalar:
        """Rate of the state [1/s] at a closing [m] and the speed -dz/dt [m/s]."""
        raise NotImplementedError

    def heat(self, warm: object) -> Scalar:
        """Heat that the wall takes [W]."""
        raise NotImplementedError


Lettered = TypeVar("Lettered")


def lettered(record: Lettered, letters: Mapping[str, Scalar]) -> Lettered:
    """The same spring, or limits, with arrays or symbols in place of some numbers, which nobody checks."""
    return of_letters(type(record), {**vars(record), **letters})


def of_letters(law: type[Lettered], letters: Mapping[str, Scalar]) -> Lettered:
    """A spring by arrays or symbols alone."""
    spring = object.__new__(law)
    spring.__dict__.update(letters)
    return spring


def affine_energy(spring: Spring, z: Scalar) -> tuple[Scalar, Scalar]:
    """Energy of a spring without its setting [J], and for each unit of the setting, at a closing [m]."""
    name, far = spring.setting[0], 1e6  # far enough to lose no digits
    fixed = lettered(spring, {name: 0.0}).energy(z)
    return fixed, (lettered(spring, {name: far}).energy(z) - fixed) / far
