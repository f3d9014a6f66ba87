"""What a co-designed hinge is made of: spring, tracks and rollers.

z = c (rho0 - rho)      closing of the spring, moved by c rollers on tracks that turn with the shaft
F, U                    force of the spring on each roller and the energy it stores
m_h                     mass that moves with each roller: roller, pin, half of the spring's piston
"""

import dataclasses
from collections.abc import Mapping
from typing import Any

from mechsym.hinge.bounds.face import Station
from mechsym.hinge.springs.face import Spring, lettered
from mechsym.quantities import quantity, record
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
