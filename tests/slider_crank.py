"""A slider crank written down by hand, so that the engine's tests need no mechanism."""

import casadi as ca

from mechsym.cycle.chamber import Chamber
from mechsym.cycle.dead_centres import chamber_over


def slider_crank(r: float, l: float, bore: float, compression_ratio: float) -> Chamber:
    """Crank radius r and rod l, x = 0 at top dead centre."""
    phi = ca.SX.sym("phi")
    rod = ca.sqrt(l**2 - (r * ca.sin(phi)) ** 2)
    x = r * (1 - ca.cos(phi)) + l - rod
    dx_dphi = r * ca.sin(phi) + r**2 * ca.sin(phi) * ca.cos(phi) / rod
    kinematics = ca.Function("kinematics", [phi], [x, dx_dphi], ["phi"], ["x", "dx_dphi"])
    return chamber_over(kinematics, bore, compression_ratio)
