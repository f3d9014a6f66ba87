"""A spring law of its own for the tests: a gas that keeps its temperature, F = A p0 H / (H - z)."""

import numpy as np

from mechsym.hinge.springs.face import Spring
from mechsym.quantities import quantity, record


@record
class Isotherm(Spring):
    """Its formulas take floats, arrays and symbols as they are."""

    setting = "p0", "Pa"
    sensitive = "p0", "A"
    words = "gas at one temperature"
    gas = True

    A: float = quantity("m^2", above=0, about="piston area")
    H: float = quantity("m", above=0, about="free height")
    p0: float = quantity("Pa", above=0, about="excess pressure at free height")

    @property
    def area(self):
        """Its own."""
        return self.A

    def pressure(self, z, warm=None):
        """By the law of Boyle."""
        return self.p0 * self.H / (self.H - z)

    def force(self, z, warm=None):
        """On its piston."""
        return self.A * self.pressure(z)

    def energy(self, z, warm=None):
        """Integral of the force."""
        return -self.A * self.p0 * self.H * np.log(1 - z / self.H)

    def closing(self, U):
        """The inverse."""
        return self.H * (1 - np.exp(-U / (self.A * self.p0 * self.H)))
