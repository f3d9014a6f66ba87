# Generated from derivations/crankshaft_flywheel_printed.py by mechsym.derive. Do NOT edit: run `make derive`.
# source sha256: 00b687030df71ac5   (derivations/crankshaft_flywheel_printed.py + mechsym/derive/*.py, newlines normalised)
# body   sha256: 00cf8cb64a3d52f6   (everything below this header)
# sympy 1.14.0
"""Crankshaft and flywheel, as (6) prints it. Source: 002_d7297926d6c52225."""

import casadi as ca

NAME = "crankshaft_flywheel_printed"
SOURCE = "002_d7297926d6c52225"
COORDINATES = ('phi0', 'phi2')
INPUTS = ('M',)
PARAMETERS = ('I0', 'I2', 'r', 'l', 'm0', 'k1', 'c1')
# function: (arguments, outputs)
FUNCTIONS = {
    "kinematics": (
        ('phi0', 'r', 'l'),
        ('x0',),
    ),
    "dynamics": (
        ('phi0', 'phi2', 'phi0d', 'phi2d', 'M', 'I0', 'I2', 'r', 'l', 'm0', 'k1', 'c1'),
        ('mass_phi0_phi0', 'mass_phi0_phi2', 'mass_phi2_phi0', 'mass_phi2_phi2', 'bias_phi0', 'bias_phi2', 'force_phi0', 'force_phi2'),
    ),
}


def kinematics(phi0, r, l):
    """Kinematics at given coordinates.

    Takes phi0 [rad], r [m], l [m].
    Returns x0.
    """
    cos_phi0 = ca.cos(phi0)
    lam = r / l
    x0 = r * (-cos_phi0 + lam * (1 - ca.cos(2 * phi0)) / 4 + 1)
    return x0,


def dynamics(phi0, phi2, phi0d, phi2d, M, I0, I2, r, l, m0, k1, c1):
    """Equations of motion: mass * qdd + bias = force (gravity, springs, dampers, inputs).

    Takes phi0 [rad], phi2 [rad], phi0d [rad/s], phi2d [rad/s], M [N*m], I0 [kg*m^2], I2 [kg*m^2], r [m], l [m],
        m0 [kg], k1 [N*m/rad], c1 [N*m*s/rad].
    Returns mass_phi0_phi0, mass_phi0_phi2, mass_phi2_phi0, mass_phi2_phi2, bias_phi0, bias_phi2, force_phi0,
        force_phi2.
    """
    lam = r / l
    sin_phi0 = ca.sin(phi0)
    _t0 = 2 * phi0
    slope = r * (lam * ca.sin(_t0) / 2 + sin_phi0)
    cos_phi0 = ca.cos(phi0)
    transmission = cos_phi0 * lam * sin_phi0 / ca.sqrt(-lam**2 * sin_phi0**2 + 1) + sin_phi0
    curvature = r * (cos_phi0 + lam * ca.cos(_t0))
    shaft = c1 * (phi0d - phi2d) + k1 * (phi0 - phi2)
    _t1 = m0 * r * transmission
    mass_phi0_phi0 = I0 + _t1 * slope
    mass_phi0_phi2 = 0
    mass_phi2_phi0 = 0
    mass_phi2_phi2 = I2
    bias_phi0 = _t1 * curvature * phi0d**2
    bias_phi2 = 0
    force_phi0 = M - shaft
    force_phi2 = shaft
    return mass_phi0_phi0, mass_phi0_phi2, mass_phi2_phi0, mass_phi2_phi2, bias_phi0, bias_phi2, force_phi0, force_phi2
