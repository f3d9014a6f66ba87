# Generated from derivations/crankshaft_flywheel.py by mechsym.derive. Do NOT edit: run `make derive`.
# source sha256: 228f0b798f8c1ca9   (derivations/crankshaft_flywheel.py + mechsym/derive/*.py, newlines normalised)
# body   sha256: 74ddbdb1a6f4bc1c   (everything below this header)
# sympy 1.14.0
"""Crankshaft and flywheel, exact. Source: 002_d7297926d6c52225."""

import casadi as ca

NAME = "crankshaft_flywheel"
SOURCE = "002_d7297926d6c52225"
COORDINATES = ('phi0', 'phi2')
INPUTS = ('M', 'F')
PARAMETERS = ('I0', 'I2', 'r', 'l', 'm0', 'k1', 'c1')
# function: (arguments, outputs)
FUNCTIONS = {
    "kinematics": (
        ('phi0', 'r', 'l'),
        ('x0', 'dx0_dphi0', 'd2x0_dphi0_dphi0', 'gamma0'),
    ),
    "dynamics": (
        ('phi0', 'phi2', 'phi0d', 'phi2d', 'M', 'F', 'I0', 'I2', 'r', 'l', 'm0', 'k1', 'c1'),
        ('mass_phi0_phi0', 'mass_phi0_phi2', 'mass_phi2_phi0', 'mass_phi2_phi2', 'bias_phi0', 'bias_phi2', 'force_phi0', 'force_phi2'),
    ),
    "energy": (
        ('phi0', 'phi2', 'phi0d', 'phi2d', 'I0', 'I2', 'r', 'l', 'm0', 'k1'),
        ('kinetic_energy', 'potential_energy'),
    ),
    "reactions": (
        ('phi0', 'phi0d', 'phi0dd', 'F', 'r', 'l', 'm0'),
        ('rod_force',),
    ),
    "momentum": (
        ('phi0', 'phi0d', 'phi0dd', 'phi2dd', 'I0', 'I2', 'r', 'l', 'm0'),
        ('momentum_rate_x', 'momentum_rate_y', 'angular_momentum_rate'),
    ),
}


def kinematics(phi0, r, l):
    """Kinematics at given coordinates.

    Takes phi0 [rad], r [m], l [m].
    Returns x0, dx0_dphi0, d2x0_dphi0_dphi0, gamma0.
    """
    lam = r / l
    sin_phi0 = ca.sin(phi0)
    sin_gamma0 = lam * sin_phi0
    cos_gamma0 = ca.sqrt(1 - sin_gamma0**2)
    cos_phi0 = ca.cos(phi0)
    x0 = l * (1 - cos_gamma0) + r * (1 - cos_phi0)
    dsin_gamma0_dphi0 = cos_phi0 * lam
    _t0 = 1 / cos_gamma0
    dgamma0_dphi0 = _t0 * dsin_gamma0_dphi0
    dcos_gamma0_dphi0 = -dgamma0_dphi0 * sin_gamma0
    dx0_dphi0 = -dcos_gamma0_dphi0 * l + r * sin_phi0
    d2gamma0_dphi0_dphi0 = -_t0 * sin_gamma0 - dcos_gamma0_dphi0 * dsin_gamma0_dphi0 / cos_gamma0**2
    d2cos_gamma0_dphi0_dphi0 = -d2gamma0_dphi0_dphi0 * sin_gamma0 - dgamma0_dphi0 * dsin_gamma0_dphi0
    d2x0_dphi0_dphi0 = cos_phi0 * r - d2cos_gamma0_dphi0_dphi0 * l
    gamma0 = ca.asin(sin_gamma0)
    return x0, dx0_dphi0, d2x0_dphi0_dphi0, gamma0


def dynamics(phi0, phi2, phi0d, phi2d, M, F, I0, I2, r, l, m0, k1, c1):
    """Equations of motion: mass * qdd + bias = force (gravity, springs, dampers, inputs).

    Takes phi0 [rad], phi2 [rad], phi0d [rad/s], phi2d [rad/s], M [N*m], F [N], I0 [kg*m^2], I2 [kg*m^2], r [m], l
        [m], m0 [kg], k1 [N*m/rad], c1 [N*m*s/rad].
    Returns mass_phi0_phi0, mass_phi0_phi2, mass_phi2_phi0, mass_phi2_phi2, bias_phi0, bias_phi2, force_phi0,
        force_phi2.
    """
    lam = r / l
    sin_phi0 = ca.sin(phi0)
    sin_gamma0 = lam * sin_phi0
    cos_gamma0 = ca.sqrt(1 - sin_gamma0**2)
    cos_phi0 = ca.cos(phi0)
    dsin_gamma0_dphi0 = cos_phi0 * lam
    _t0 = 1 / cos_gamma0
    dgamma0_dphi0 = _t0 * dsin_gamma0_dphi0
    dcos_gamma0_dphi0 = -dgamma0_dphi0 * sin_gamma0
    dx0_dphi0 = -dcos_gamma0_dphi0 * l + r * sin_phi0
    d2gamma0_dphi0_dphi0 = -_t0 * sin_gamma0 - dcos_gamma0_dphi0 * dsin_gamma0_dphi0 / cos_gamma0**2
    d2cos_gamma0_dphi0_dphi0 = -d2gamma0_dphi0_dphi0 * sin_gamma0 - dgamma0_dphi0 * dsin_gamma0_dphi0
    d2x0_dphi0_dphi0 = cos_phi0 * r - d2cos_gamma0_dphi0_dphi0 * l
    twist = phi0 - phi2
    _t1 = k1 * twist
    _t2 = c1 * (phi0d - phi2d)
    mass_phi0_phi0 = I0 + m0 * dx0_dphi0**2
    mass_phi0_phi2 = 0
    mass_phi2_phi0 = 0
    mass_phi2_phi2 = I2
    bias_phi0 = d2x0_dphi0_dphi0 * dx0_dphi0 * m0 * phi0d**2
    bias_phi2 = 0
    force_phi0 = F * dx0_dphi0 + M - _t1 - _t2
    force_phi2 = _t1 + _t2
    return mass_phi0_phi0, mass_phi0_phi2, mass_phi2_phi0, mass_phi2_phi2, bias_phi0, bias_phi2, force_phi0, force_phi2


def energy(phi0, phi2, phi0d, phi2d, I0, I2, r, l, m0, k1):
    """Energies; the potential is zero at the origin.

    Takes phi0 [rad], phi2 [rad], phi0d [rad/s], phi2d [rad/s], I0 [kg*m^2], I2 [kg*m^2], r [m], l [m], m0 [kg],
        k1 [N*m/rad].
    Returns kinetic_energy, potential_energy.
    """
    lam = r / l
    sin_phi0 = ca.sin(phi0)
    sin_gamma0 = lam * sin_phi0
    cos_gamma0 = ca.sqrt(1 - sin_gamma0**2)
    cos_phi0 = ca.cos(phi0)
    dsin_gamma0_dphi0 = cos_phi0 * lam
    dgamma0_dphi0 = dsin_gamma0_dphi0 / cos_gamma0
    dcos_gamma0_dphi0 = -dgamma0_dphi0 * sin_gamma0
    dx0_dphi0 = -dcos_gamma0_dphi0 * l + r * sin_phi0
    twist = phi0 - phi2
    kinetic_energy = I2 * phi2d**2 / 2 + phi0d**2 * (I0 + m0 * dx0_dphi0**2) / 2
    potential_energy = k1 * twist**2 / 2
    return kinetic_energy, potential_energy


def reactions(phi0, phi0d, phi0dd, F, r, l, m0):
    """Joint reactions (first body on second) and other outputs that need accelerations.

    Takes phi0 [rad], phi0d [rad/s], phi0dd [rad/s^2], F [N], r [m], l [m], m0 [kg].
    Returns rod_force.
    """
    lam = r / l
    sin_phi0 = ca.sin(phi0)
    sin_gamma0 = lam * sin_phi0
    cos_gamma0 = ca.sqrt(1 - sin_gamma0**2)
    cos_phi0 = ca.cos(phi0)
    dsin_gamma0_dphi0 = cos_phi0 * lam
    _t0 = 1 / cos_gamma0
    dgamma0_dphi0 = _t0 * dsin_gamma0_dphi0
    dcos_gamma0_dphi0 = -dgamma0_dphi0 * sin_gamma0
    d2gamma0_dphi0_dphi0 = -_t0 * sin_gamma0 - dcos_gamma0_dphi0 * dsin_gamma0_dphi0 / cos_gamma0**2
    d2cos_gamma0_dphi0_dphi0 = -d2gamma0_dphi0_dphi0 * sin_gamma0 - dgamma0_dphi0 * dsin_gamma0_dphi0
    d2x0_dphi0_dphi0 = cos_phi0 * r - d2cos_gamma0_dphi0_dphi0 * l
    dx0_dphi0 = -dcos_gamma0_dphi0 * l + r * sin_phi0
    rod_force = _t0 * (-F + m0 * (d2x0_dphi0_dphi0 * phi0d**2 + dx0_dphi0 * phi0dd))
    return rod_force,


def momentum(phi0, phi0d, phi0dd, phi2dd, I0, I2, r, l, m0):
    """Rates of momentum, and of angular momentum about the origin, of all bodies: the sum of outer forces.

    Takes phi0 [rad], phi0d [rad/s], phi0dd [rad/s^2], phi2dd [rad/s^2], I0 [kg*m^2], I2 [kg*m^2], r [m], l [m],
        m0 [kg].
    Returns momentum_rate_x, momentum_rate_y, angular_momentum_rate.
    """
    cos_phi0 = ca.cos(phi0)
    lam = r / l
    sin_phi0 = ca.sin(phi0)
    sin_gamma0 = lam * sin_phi0
    cos_gamma0 = ca.sqrt(1 - sin_gamma0**2)
    dsin_gamma0_dphi0 = cos_phi0 * lam
    _t0 = 1 / cos_gamma0
    dgamma0_dphi0 = _t0 * dsin_gamma0_dphi0
    dcos_gamma0_dphi0 = -dgamma0_dphi0 * sin_gamma0
    d2gamma0_dphi0_dphi0 = -_t0 * sin_gamma0 - dcos_gamma0_dphi0 * dsin_gamma0_dphi0 / cos_gamma0**2
    d2cos_gamma0_dphi0_dphi0 = -d2gamma0_dphi0_dphi0 * sin_gamma0 - dgamma0_dphi0 * dsin_gamma0_dphi0
    d2x0_dphi0_dphi0 = cos_phi0 * r - d2cos_gamma0_dphi0_dphi0 * l
    dx0_dphi0 = -dcos_gamma0_dphi0 * l + r * sin_phi0
    momentum_rate_x = m0 * (-d2x0_dphi0_dphi0 * phi0d**2 - dx0_dphi0 * phi0dd)
    momentum_rate_y = 0
    angular_momentum_rate = I0 * phi0dd + I2 * phi2dd
    return momentum_rate_x, momentum_rate_y, angular_momentum_rate
