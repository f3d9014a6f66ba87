"""A slider crank written down by hand, so that the engine's tests need no mechanism."""

import numpy as np

from mechsym.cycle.cylinder import Cylinder


def slider_crank(r: float, l: float, bore: float, compression_ratio: float) -> Cylinder:
    """Crank radius r and rod l, x = 0 at top dead centre."""

    def x(phi):
        return r * (1 - np.cos(phi)) + l - np.sqrt(l**2 - (r * np.sin(phi)) ** 2)

    def dx_dphi(phi):
        return r * np.sin(phi) + r**2 * np.sin(phi) * np.cos(phi) / np.sqrt(l**2 - (r * np.sin(phi)) ** 2)

    return Cylinder(bore=bore, stroke=2 * r, compression_ratio=compression_ratio, x=x, dx_dphi=dx_dphi)
