r"""The linear spring, law `coil`.

.. math:: F = F_0 + k z, \qquad U = F_0 z + \tfrac12 k z^2
"""

import numpy as np

from mechsym.hinge.springs.face import Formulas, Spring
from mechsym.quantities import quantity, record
from mechsym.quantities.units import Scalar


@record
class Coil(Spring):
    """Linear coil spring."""

    setting = "F0", "N"
    sensitive = "F0", "k"
    words = "coil spring"

    k: float = quantity("N/m", above=0, about="stiffness")
    F0: float = quantity("N", low=0, about="preload at z = 0")
    H: float = quantity("m", low=1e-4, high=100, about="closing at which the coils touch")

    def force(self, z: Scalar, warm: object = None) -> Scalar:
        """F0 + k z [N]."""
        return self.F0 + self.k * z

    def stiffness(self, z: Scalar) -> Scalar:
        """The same everywhere [N/m]."""
        return self.k + 0 * z

    def energy(self, z: Scalar, warm: object = None) -> Scalar:
        """F0 z + k z^2 / 2 [J]."""
        return self.F0 * z + self.k * z**2 / 2

    def closing(self, U: Scalar) -> Scalar:
        """The inverse in closed form [m]."""
        k, F0 = self.k, self.F0
        # 2 U / (F0 + root) keeps its digits where (root - F0) / k would lose them; at F0 = U = 0 both are 0
        root = np.sqrt(F0**2 + 2 * k * np.asarray(U))
        if np.ndim(F0) == 0:
            return root / k if F0 == 0 else 2 * np.asarray(U) / (F0 + root)
        return np.where(F0 == 0, root / k, 2 * np.asarray(U) / np.where(F0 == 0, 1.0, F0 + root))

    @property
    def z_low(self) -> Scalar:
        """Below -F0 / k it would pull [m]."""
        return -self.F0 / self.k

    @property
    def energy_low(self) -> Scalar:
        """Energy there [J]."""
        return -(self.F0**2) / (2 * self.k)

    @property
    def energy_high(self) -> Scalar:
        """Energy where the coils touch [J]."""
        return self.F0 * self.H + self.k * self.H**2 / 2

    def symbolic(self) -> Formulas:
        """For symbols, with the root that keeps its digits."""

        def closing(U: Scalar) -> Scalar:
            return 2 * U / (self.F0 + np.sqrt(self.F0**2 + 2 * self.k * U))

        def along(U: Scalar) -> tuple[Scalar, Scalar, Scalar]:
            return closing(U), self.force(closing(U)), self.k

        return Formulas(energy=self.energy, closing=closing, along=along)
