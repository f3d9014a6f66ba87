# Generated from derivations/hypocycloid.py by mechsym.derive. Do NOT edit: run `make derive`.
# source sha256: 9501e823bfdb2dcc   (derivations/hypocycloid.py + mechsym/derive/*.py, newlines normalised)
# body   sha256: c6c89544a290ab96   (everything below this header)
# sympy 1.14.0
"""Crank, planet of half the ring's size, piston. Source: 004_e00ef50339108dab."""

import casadi as ca

NAME = "hypocycloid"
SOURCE = "004_e00ef50339108dab"
COORDINATES = ('theta',)
INPUTS = ('F', 'M')
PARAMETERS = ('e', 'I1', 'u1', 'm2', 'I2', 'm3', 'alpha_n')
# function: (arguments, outputs)
FUNCTIONS = {
    "kinematics": (
        ('theta', 'e', 'I1', 'm2', 'I2', 'm3'),
        ('x', 'dx_dtheta', 'd2x_dtheta2', 'inertia', 'dinertia_dtheta'),
    ),
    "dynamics": (
        ('theta', 'thetad', 'F', 'M', 'e', 'I1', 'm2', 'I2', 'm3'),
        ('mass_theta_theta', 'bias_theta', 'force_theta'),
    ),
    "energy": (
        ('theta', 'thetad', 'e', 'I1', 'm2', 'I2', 'm3'),
        ('kinetic_energy', 'potential_energy'),
    ),
    "reactions": (
        ('theta', 'thetad', 'thetadd', 'F', 'e', 'u1', 'm2', 'I2', 'm3', 'alpha_n'),
        ('tooth_force', 'journal_force_x', 'journal_force_y', 'main_bearing_force_x', 'main_bearing_force_y', 'pin_force', 'tooth_force_radial', 'piston_torque'),
    ),
    "momentum": (
        ('theta', 'thetad', 'thetadd', 'e', 'I1', 'u1', 'm2', 'I2', 'm3'),
        ('momentum_rate_x', 'momentum_rate_y', 'angular_momentum_rate'),
    ),
}


def kinematics(theta, e, I1, m2, I2, m3):
    """Kinematics at given coordinates.

    Takes theta [rad], e [m], I1 [kg*m^2], m2 [kg], I2 [kg*m^2], m3 [kg].
    Returns x, dx_dtheta, d2x_dtheta2, inertia, dinertia_dtheta.
    """
    cos_theta = ca.cos(theta)
    sin_theta = ca.sin(theta)
    x = 2 * e * (1 - cos_theta)
    _t0 = e * sin_theta
    dx_dtheta = 2 * _t0
    _t1 = cos_theta * e
    d2x_dtheta2 = 2 * _t1
    dx_planet_dtheta = -_t0
    dy_planet_dtheta = _t1
    inertia = I1 + I2 + m3 * dx_dtheta**2 + m2 * (dx_planet_dtheta**2 + dy_planet_dtheta**2)
    dinertia_dtheta = 2 * d2x_dtheta2 * dx_dtheta * m3
    return x, dx_dtheta, d2x_dtheta2, inertia, dinertia_dtheta


def dynamics(theta, thetad, F, M, e, I1, m2, I2, m3):
    """Equations of motion: mass * qdd + bias = force (gravity, springs, dampers, inputs).

    Takes theta [rad], thetad [rad/s], F [N], M [N*m], e [m], I1 [kg*m^2], m2 [kg], I2 [kg*m^2], m3 [kg].
    Returns mass_theta_theta, bias_theta, force_theta.
    """
    cos_theta = ca.cos(theta)
    sin_theta = ca.sin(theta)
    _t0 = e * sin_theta
    dx_dtheta = 2 * _t0
    dx_planet_dtheta = -_t0
    _t1 = cos_theta * e
    dy_planet_dtheta = _t1
    inertia = I1 + I2 + m3 * dx_dtheta**2 + m2 * (dx_planet_dtheta**2 + dy_planet_dtheta**2)
    d2x_dtheta2 = 2 * _t1
    mass_theta_theta = inertia
    bias_theta = d2x_dtheta2 * dx_dtheta * m3 * thetad**2
    force_theta = F * dx_dtheta - M
    return mass_theta_theta, bias_theta, force_theta


def energy(theta, thetad, e, I1, m2, I2, m3):
    """Energies; the potential is zero at the origin.

    Takes theta [rad], thetad [rad/s], e [m], I1 [kg*m^2], m2 [kg], I2 [kg*m^2], m3 [kg].
    Returns kinetic_energy, potential_energy.
    """
    cos_theta = ca.cos(theta)
    sin_theta = ca.sin(theta)
    _t0 = e * sin_theta
    dx_dtheta = 2 * _t0
    dx_planet_dtheta = -_t0
    dy_planet_dtheta = cos_theta * e
    inertia = I1 + I2 + m3 * dx_dtheta**2 + m2 * (dx_planet_dtheta**2 + dy_planet_dtheta**2)
    kinetic_energy = inertia * thetad**2 / 2
    potential_energy = 0
    return kinetic_energy, potential_energy


def reactions(theta, thetad, thetadd, F, e, u1, m2, I2, m3, alpha_n):
    """Joint reactions (first body on second) and other outputs that need accelerations.

    Takes theta [rad], thetad [rad/s], thetadd [rad/s^2], F [N], e [m], u1 [kg*m], m2 [kg], I2 [kg*m^2], m3 [kg],
        alpha_n [rad].
    Returns tooth_force, journal_force_x, journal_force_y, main_bearing_force_x, main_bearing_force_y, pin_force,
        tooth_force_radial, piston_torque.
    """
    cos_theta = ca.cos(theta)
    sin_theta = ca.sin(theta)
    _t0 = cos_theta * e
    d2x_dtheta2 = 2 * _t0
    _t1 = 1 / e
    droll_ds_T = _t1
    _t2 = e * sin_theta
    dx_ds_T = -_t2 * droll_ds_T
    dx_dtheta = 2 * _t2
    d2x_planet_dtheta2 = -_t0
    droll_dx_C = _t1 * sin_theta
    dx_dx_C = -_t2 * droll_dx_C - 1
    dx_planet_dtheta = -_t2
    droll_dy_C = -_t1 * cos_theta
    dx_dy_C = -_t2 * droll_dy_C
    _t3 = thetad**2
    _t4 = _t3 * d2x_dtheta2 + dx_dtheta * thetadd
    _t5 = -_t4 * m3
    _t6 = I2 * thetadd
    _t7 = F * dx_ds_T + _t6 * droll_ds_T
    _t8 = _t3 * d2x_planet_dtheta2 + dx_planet_dtheta * thetadd
    _t9 = ca.tan(alpha_n)
    _t10 = _t4 * m3
    _t11 = ca.fabs(_t10 * dx_ds_T - _t7)
    _t12 = F * dx_dx_C - _t11 * _t9 * cos_theta + _t5 * dx_dx_C + _t6 * droll_dx_C - _t8 * m2
    _t13 = _t3 * dx_planet_dtheta - d2x_planet_dtheta2 * thetadd
    _t14 = F * dx_dy_C - _t11 * _t9 * sin_theta - _t13 * m2 + _t5 * dx_dy_C + _t6 * droll_dy_C
    tooth_force = -_t5 * dx_ds_T - _t7
    journal_force_x = -_t12
    journal_force_y = -_t14
    main_bearing_force_x = _t1 * _t8 * u1 - _t12
    main_bearing_force_y = _t1 * _t13 * u1 - _t14
    pin_force = F + _t5
    tooth_force_radial = _t11 * _t9
    piston_torque = dx_dtheta * (F - _t10)
    return tooth_force, journal_force_x, journal_force_y, main_bearing_force_x, main_bearing_force_y, pin_force, tooth_force_radial, piston_torque


def momentum(theta, thetad, thetadd, e, I1, u1, m2, I2, m3):
    """Rates of momentum, and of angular momentum about the origin, of all bodies: the sum of outer forces.

    Takes theta [rad], thetad [rad/s], thetadd [rad/s^2], e [m], I1 [kg*m^2], u1 [kg*m], m2 [kg], I2 [kg*m^2], m3
        [kg].
    Returns momentum_rate_x, momentum_rate_y, angular_momentum_rate.
    """
    cos_theta = ca.cos(theta)
    _t0 = cos_theta * e
    d2x_crank_dtheta2 = -_t0
    sin_theta = ca.sin(theta)
    d2x_dtheta2 = 2 * _t0
    _t1 = e * sin_theta
    dx_crank_dtheta = -_t1
    dx_dtheta = 2 * _t1
    _t2 = thetad**2
    _t3 = _t2 * d2x_crank_dtheta2 + dx_crank_dtheta * thetadd
    _t4 = u1 / e
    _t5 = _t2 * dx_crank_dtheta - d2x_crank_dtheta2 * thetadd
    momentum_rate_x = _t3 * _t4 + _t3 * m2 + m3 * (-_t2 * d2x_dtheta2 - dx_dtheta * thetadd)
    momentum_rate_y = _t4 * _t5 + _t5 * m2
    angular_momentum_rate = I1 * thetadd - I2 * thetadd + m2 * (_t3 * dx_crank_dtheta - _t5 * d2x_crank_dtheta2)
    return momentum_rate_x, momentum_rate_y, angular_momentum_rate
