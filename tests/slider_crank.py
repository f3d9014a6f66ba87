"""A slider crank written down by hand, so that the engine's tests need no mechanism; a formula of Prymak for one."""

import casadi as ca
import numpy as np

from mechsym.cycle.chamber import Chamber, chamber_over
from mechsym.forces.textbook import slider_crank as of_turn


def slider_crank(r: float, l: float, bore: float, compression_ratio: float) -> Chamber:
    """Crank radius r and rod l, x = 0 at top dead centre."""
    phi = ca.SX.sym("phi")
    rod = ca.sqrt(l**2 - (r * ca.sin(phi)) ** 2)
    x = r * (1 - ca.cos(phi)) + l - rod
    dx_dphi = r * ca.sin(phi) + r**2 * ca.sin(phi) * ca.cos(phi) / rod
    kinematics = ca.Function("kinematics", [phi], [x, dx_dphi], ["phi"], ["x", "dx_dphi"])
    return chamber_over(kinematics, bore, compression_ratio)


def piston_inertia_printed(turn):
    """Prymak, eq. (6): P_j = -m_j R omega^2 (cos phi + lam cos 2 phi), positive away from the head [N]."""
    s = of_turn(turn)
    m_j, lam = s.m_p + s.m_b * s.L_m / s.L, s.R / s.L
    return -m_j * s.R * turn.omega**2 * (np.cos(turn.phi) + lam * np.cos(2 * turn.phi))
