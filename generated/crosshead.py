# Generated from derivations/crosshead.py by mechsym.derive. Do NOT edit: run `make derive`.
# source sha256: 17f5c30d0177d20c   (derivations/crosshead.py + mechsym/derive/*.py, newlines normalised)
# body   sha256: 79a98414e0168558   (everything below this header)
# sympy 1.14.0
"""Crank, rod, crosshead and elastic hinge. Source: 000_9f2b746dc1abd296."""

import casadi as ca

NAME = "crosshead"
SOURCE = "000_9f2b746dc1abd296"
COORDINATES = ('phi',)
INPUTS = ('F', 'M_r', 'M_h')
PARAMETERS = ('r1', 'r2', 'l1', 'l2', 'm1', 'm2', 'm3', 'm4', 'm5', 'I01', 'IC2', 'g', 'axis_tilt')
# function: (arguments, outputs)
FUNCTIONS = {
    "kinematics": (
        ('phi', 'r1', 'r2', 'l1', 'l2', 'm2', 'm3', 'm4', 'm5', 'I01', 'IC2'),
        ('x', 'dx_dphi', 'd2x_dphi2', 'psi', 'dpsi_dphi', 'inertia', 'dinertia_dphi'),
    ),
    "dynamics": (
        ('phi', 'phid', 'F', 'M_r', 'M_h', 'r1', 'r2', 'l1', 'l2', 'm1', 'm2', 'm3', 'm4', 'm5', 'I01', 'IC2', 'g', 'axis_tilt'),
        ('mass_phi_phi', 'bias_phi', 'force_phi'),
    ),
    "energy": (
        ('phi', 'phid', 'r1', 'r2', 'l1', 'l2', 'm1', 'm2', 'm3', 'm4', 'm5', 'I01', 'IC2', 'g', 'axis_tilt'),
        ('kinetic_energy', 'potential_energy'),
    ),
    "reactions": (
        ('phi', 'phid', 'phidd', 'F', 'r1', 'r2', 'l1', 'l2', 'm1', 'm2', 'm3', 'm4', 'm5', 'IC2', 'g', 'axis_tilt'),
        ('R_x_O', 'R_y_O', 'R_x_A', 'R_y_A', 'R_x_B', 'R_y_B', 'R_y_G'),
    ),
    "momentum": (
        ('phi', 'phid', 'phidd', 'r1', 'r2', 'l1', 'l2', 'm1', 'm2', 'm3', 'm4', 'm5', 'I01', 'IC2'),
        ('momentum_rate_x', 'momentum_rate_y', 'angular_momentum_rate'),
    ),
}


def kinematics(phi, r1, r2, l1, l2, m2, m3, m4, m5, I01, IC2):
    """Kinematics at given coordinates.

    Takes phi [rad], r1 [m], r2 [m], l1 [m], l2 [m], m2 [kg], m3 [kg], m4 [kg], m5 [kg], I01 [kg*m^2], IC2
        [kg*m^2].
    Returns x, dx_dphi, d2x_dphi2, psi, dpsi_dphi, inertia, dinertia_dphi.
    """
    cos_phi = ca.cos(phi)
    l = l1 + l2
    r = r1 + r2
    lam = r / l
    sin_phi = ca.sin(phi)
    sin_psi = lam * sin_phi
    cos_psi = ca.sqrt(1 - sin_psi**2)
    x = l * (1 - cos_psi) + r * (1 - cos_phi)
    dsin_psi_dphi = cos_phi * lam
    _t0 = 1 / cos_psi
    dpsi_dphi = _t0 * dsin_psi_dphi
    dcos_psi_dphi = -dpsi_dphi * sin_psi
    _t1 = -r * sin_phi
    dx_dphi = -_t1 - dcos_psi_dphi * l
    d2psi_dphi2 = -_t0 * sin_psi - dcos_psi_dphi * dsin_psi_dphi / cos_psi**2
    d2cos_psi_dphi2 = -d2psi_dphi2 * sin_psi - dpsi_dphi * dsin_psi_dphi
    _t2 = cos_phi * r
    d2x_dphi2 = _t2 - d2cos_psi_dphi2 * l
    psi = ca.asin(sin_psi)
    dx_rod_dphi = _t1 + dcos_psi_dphi * l1
    dy_rod_dphi = dsin_psi_dphi * l2
    _t3 = m3 + m4 + m5
    inertia = I01 + IC2 * dpsi_dphi**2 + _t3 * dx_dphi**2 + m2 * (dx_rod_dphi**2 + dy_rod_dphi**2)
    d2x_rod_dphi2 = -_t2 + d2cos_psi_dphi2 * l1
    d2y_rod_dphi2 = -l2 * sin_psi
    _t4 = 2 * m2
    dinertia_dphi = 2 * IC2 * d2psi_dphi2 * dpsi_dphi + 2 * _t3 * d2x_dphi2 * dx_dphi + _t4 * d2x_rod_dphi2 * dx_rod_dphi + _t4 * d2y_rod_dphi2 * dy_rod_dphi
    return x, dx_dphi, d2x_dphi2, psi, dpsi_dphi, inertia, dinertia_dphi


def dynamics(phi, phid, F, M_r, M_h, r1, r2, l1, l2, m1, m2, m3, m4, m5, I01, IC2, g, axis_tilt):
    """Equations of motion: mass * qdd + bias = force (gravity, springs, dampers, inputs).

    Takes phi [rad], phid [rad/s], F [N], M_r [N*m], M_h [N*m], r1 [m], r2 [m], l1 [m], l2 [m], m1 [kg], m2 [kg],
        m3 [kg], m4 [kg], m5 [kg], I01 [kg*m^2], IC2 [kg*m^2], g [m/s^2], axis_tilt [rad].
    Returns mass_phi_phi, bias_phi, force_phi.
    """
    l = l1 + l2
    r = r1 + r2
    lam = r / l
    sin_phi = ca.sin(phi)
    sin_psi = lam * sin_phi
    cos_psi = ca.sqrt(1 - sin_psi**2)
    cos_phi = ca.cos(phi)
    dsin_psi_dphi = cos_phi * lam
    _t0 = 1 / cos_psi
    dpsi_dphi = _t0 * dsin_psi_dphi
    dcos_psi_dphi = -dpsi_dphi * sin_psi
    _t1 = -r * sin_phi
    dx_dphi = -_t1 - dcos_psi_dphi * l
    dx_rod_dphi = _t1 + dcos_psi_dphi * l1
    dy_rod_dphi = dsin_psi_dphi * l2
    _t2 = m3 + m4 + m5
    inertia = I01 + IC2 * dpsi_dphi**2 + _t2 * dx_dphi**2 + m2 * (dx_rod_dphi**2 + dy_rod_dphi**2)
    d2psi_dphi2 = -_t0 * sin_psi - dcos_psi_dphi * dsin_psi_dphi / cos_psi**2
    d2cos_psi_dphi2 = -d2psi_dphi2 * sin_psi - dpsi_dphi * dsin_psi_dphi
    _t3 = cos_phi * r
    d2x_dphi2 = _t3 - d2cos_psi_dphi2 * l
    d2x_rod_dphi2 = -_t3 + d2cos_psi_dphi2 * l1
    d2y_rod_dphi2 = -l2 * sin_psi
    dx_crank_dphi = -r1 * sin_phi
    dy_crank_dphi = cos_phi * r1
    _t4 = phid**2
    _t5 = ca.sin(axis_tilt)
    _t6 = _t5 * g
    _t7 = g * ca.cos(axis_tilt)
    mass_phi_phi = inertia
    bias_phi = _t4 * IC2 * d2psi_dphi2 * dpsi_dphi + _t2 * _t4 * d2x_dphi2 * dx_dphi + m2 * (_t4 * d2x_rod_dphi2 * dx_rod_dphi + _t4 * d2y_rod_dphi2 * dy_rod_dphi)
    force_phi = F * dx_dphi + M_h - M_r + _t2 * _t5 * dx_dphi * g - _t6 * dx_crank_dphi * m1 - _t6 * dx_rod_dphi * m2 - _t7 * dy_crank_dphi * m1 - _t7 * dy_rod_dphi * m2
    return mass_phi_phi, bias_phi, force_phi


def energy(phi, phid, r1, r2, l1, l2, m1, m2, m3, m4, m5, I01, IC2, g, axis_tilt):
    """Energies; the potential is zero at the origin.

    Takes phi [rad], phid [rad/s], r1 [m], r2 [m], l1 [m], l2 [m], m1 [kg], m2 [kg], m3 [kg], m4 [kg], m5 [kg],
        I01 [kg*m^2], IC2 [kg*m^2], g [m/s^2], axis_tilt [rad].
    Returns kinetic_energy, potential_energy.
    """
    l = l1 + l2
    r = r1 + r2
    lam = r / l
    sin_phi = ca.sin(phi)
    sin_psi = lam * sin_phi
    cos_psi = ca.sqrt(1 - sin_psi**2)
    cos_phi = ca.cos(phi)
    dsin_psi_dphi = cos_phi * lam
    dpsi_dphi = dsin_psi_dphi / cos_psi
    dcos_psi_dphi = -dpsi_dphi * sin_psi
    _t0 = -r * sin_phi
    dx_dphi = -_t0 - dcos_psi_dphi * l
    dx_rod_dphi = _t0 + dcos_psi_dphi * l1
    dy_rod_dphi = dsin_psi_dphi * l2
    _t1 = m3 + m4 + m5
    inertia = I01 + IC2 * dpsi_dphi**2 + _t1 * dx_dphi**2 + m2 * (dx_rod_dphi**2 + dy_rod_dphi**2)
    x_crank = cos_phi * r1
    x = l * (1 - cos_psi) + r * (1 - cos_phi)
    x_crosshead = l + r - x
    x_rod = cos_phi * r + cos_psi * l1
    y_crank = r1 * sin_phi
    y_rod = l2 * sin_psi
    _t2 = ca.sin(axis_tilt)
    _t3 = g * m1
    _t4 = ca.cos(axis_tilt)
    _t5 = g * m2
    kinetic_energy = inertia * phid**2 / 2
    potential_energy = _t1 * _t2 * g * x_crosshead + _t2 * _t3 * x_crank + _t2 * _t5 * x_rod + _t3 * _t4 * y_crank + _t4 * _t5 * y_rod
    return kinetic_energy, potential_energy


def reactions(phi, phid, phidd, F, r1, r2, l1, l2, m1, m2, m3, m4, m5, IC2, g, axis_tilt):
    """Joint reactions (first body on second) and other outputs that need accelerations.

    Takes phi [rad], phid [rad/s], phidd [rad/s^2], F [N], r1 [m], r2 [m], l1 [m], l2 [m], m1 [kg], m2 [kg], m3
        [kg], m4 [kg], m5 [kg], IC2 [kg*m^2], g [m/s^2], axis_tilt [rad].
    Returns R_x_O, R_y_O, R_x_A, R_y_A, R_x_B, R_y_B, R_y_G.
    """
    cos_phi = ca.cos(phi)
    d2x_crank_dphi2 = -cos_phi * r1
    l = l1 + l2
    r = r1 + r2
    _t0 = 1 / l
    lam = _t0 * r
    sin_phi = ca.sin(phi)
    sin_psi = lam * sin_phi
    cos_psi = ca.sqrt(1 - sin_psi**2)
    dsin_psi_dphi = cos_phi * lam
    _t1 = 1 / cos_psi
    dpsi_dphi = _t1 * dsin_psi_dphi
    dcos_psi_dphi = -dpsi_dphi * sin_psi
    d2psi_dphi2 = -_t1 * sin_psi - dcos_psi_dphi * dsin_psi_dphi / cos_psi**2
    d2cos_psi_dphi2 = -d2psi_dphi2 * sin_psi - dpsi_dphi * dsin_psi_dphi
    _t2 = cos_phi * r
    d2x_dphi2 = _t2 - d2cos_psi_dphi2 * l
    d2x_rod_dphi2 = -_t2 + d2cos_psi_dphi2 * l1
    dx_crank_dphi = -r1 * sin_phi
    _t3 = -r * sin_phi
    dx_dphi = -_t3 - dcos_psi_dphi * l
    dx_rod_dphi = _t3 + dcos_psi_dphi * l1
    d2y_rod_dphi2 = -l2 * sin_psi
    dsin_psi_dy_O = _t0
    dpsi_dy_O = _t1 * dsin_psi_dy_O
    dcos_psi_dy_O = -dpsi_dy_O * sin_psi
    dx_dy_O = -dcos_psi_dy_O * l
    dx_rod_dy_O = dcos_psi_dy_O * l1
    dy_rod_dphi = dsin_psi_dphi * l2
    _t4 = dsin_psi_dy_O * l2
    dy_rod_dy_O = _t4
    dy_rod_dy_B = _t4 - 1
    _t5 = phid**2
    _t6 = g * ca.sin(axis_tilt)
    _t7 = _t5 * d2x_rod_dphi2 + dx_rod_dphi * phidd
    _t8 = _t6 * m2
    _t9 = m3 + m4 + m5
    _t10 = _t6 * _t9
    _t11 = _t9 * (-_t5 * d2x_dphi2 - dx_dphi * phidd)
    _t12 = F + _t10 + _t11
    _t13 = _t12 + _t7 * m2 + _t8
    _t14 = F * dx_dy_O
    _t15 = ca.cos(axis_tilt)
    _t16 = _t15 * g
    _t17 = _t8 * dx_rod_dy_O
    _t18 = _t16 * m2
    _t19 = _t10 * dx_dy_O
    _t20 = IC2 * dpsi_dy_O * (-_t5 * d2psi_dphi2 - dpsi_dphi * phidd)
    _t21 = _t11 * dx_dy_O
    _t22 = _t7 * dx_rod_dy_O
    _t23 = _t5 * d2y_rod_dphi2 + dy_rod_dphi * phidd
    _t24 = _t22 + _t23 * dy_rod_dy_O
    _t25 = _t14 - _t17 + _t19 + _t20 + _t21
    _t26 = _t22 + _t23 * dy_rod_dy_B
    _t27 = -_t18 * dy_rod_dy_B + _t25
    R_x_O = _t13 + _t6 * m1 + m1 * (_t5 * d2x_crank_dphi2 + dx_crank_dphi * phidd)
    R_y_O = -_t14 + _t16 * m1 + _t17 + _t18 * dy_rod_dy_O - _t19 - _t20 - _t21 + _t24 * m2 + m1 * (_t5 * dx_crank_dphi - d2x_crank_dphi2 * phidd)
    R_x_A = _t13
    R_y_A = _t15 * dy_rod_dy_O * g * m2 + _t24 * m2 - _t25
    R_x_B = _t12
    R_y_B = _t26 * m2 - _t27
    R_y_G = _t16 * _t9 - _t26 * m2 + _t27
    return R_x_O, R_y_O, R_x_A, R_y_A, R_x_B, R_y_B, R_y_G


def momentum(phi, phid, phidd, r1, r2, l1, l2, m1, m2, m3, m4, m5, I01, IC2):
    """Rates of momentum, and of angular momentum about the origin, of all bodies: the sum of outer forces.

    Takes phi [rad], phid [rad/s], phidd [rad/s^2], r1 [m], r2 [m], l1 [m], l2 [m], m1 [kg], m2 [kg], m3 [kg], m4
        [kg], m5 [kg], I01 [kg*m^2], IC2 [kg*m^2].
    Returns momentum_rate_x, momentum_rate_y, angular_momentum_rate.
    """
    cos_phi = ca.cos(phi)
    d2x_crank_dphi2 = -cos_phi * r1
    l = l1 + l2
    r = r1 + r2
    lam = r / l
    sin_phi = ca.sin(phi)
    sin_psi = lam * sin_phi
    cos_psi = ca.sqrt(1 - sin_psi**2)
    dsin_psi_dphi = cos_phi * lam
    _t0 = 1 / cos_psi
    dpsi_dphi = _t0 * dsin_psi_dphi
    dcos_psi_dphi = -dpsi_dphi * sin_psi
    d2psi_dphi2 = -_t0 * sin_psi - dcos_psi_dphi * dsin_psi_dphi / cos_psi**2
    d2cos_psi_dphi2 = -d2psi_dphi2 * sin_psi - dpsi_dphi * dsin_psi_dphi
    _t1 = cos_phi * r
    d2x_dphi2 = _t1 - d2cos_psi_dphi2 * l
    d2x_rod_dphi2 = -_t1 + d2cos_psi_dphi2 * l1
    dx_crank_dphi = -r1 * sin_phi
    _t2 = -r * sin_phi
    dx_dphi = -_t2 - dcos_psi_dphi * l
    dx_rod_dphi = _t2 + dcos_psi_dphi * l1
    d2y_rod_dphi2 = -l2 * sin_psi
    dy_rod_dphi = dsin_psi_dphi * l2
    x_rod = _t1 + cos_psi * l1
    _t3 = phid**2
    _t4 = _t3 * d2x_rod_dphi2 + dx_rod_dphi * phidd
    _t5 = _t3 * d2y_rod_dphi2 + dy_rod_dphi * phidd
    momentum_rate_x = _t4 * m2 + m1 * (_t3 * d2x_crank_dphi2 + dx_crank_dphi * phidd) + (-_t3 * d2x_dphi2 - dx_dphi * phidd) * (m3 + m4 + m5)
    momentum_rate_y = _t5 * m2 + m1 * (_t3 * dx_crank_dphi - d2x_crank_dphi2 * phidd)
    angular_momentum_rate = I01 * phidd + IC2 * (-_t3 * d2psi_dphi2 - dpsi_dphi * phidd) + m2 * (_t4 * d2y_rod_dphi2 + _t5 * x_rod)
    return momentum_rate_x, momentum_rate_y, angular_momentum_rate
