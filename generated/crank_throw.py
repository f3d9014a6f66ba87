# Generated from derivations/crank_throw.py by mechsym.derive. Do NOT edit: run `make derive`.
# source sha256: 414509663dc19c0d   (derivations/crank_throw.py + mechsym/derive/*.py, newlines normalised)
# body   sha256: 53640d61aa788905   (everything below this header)
# sympy 1.14.0
"""One throw: crank, rod, piston on an offset axis. Source: 002_d7297926d6c52225."""

import casadi as ca

NAME = "crank_throw"
SOURCE = "002_d7297926d6c52225"
COORDINATES = ('phi',)
INPUTS = ('F', 'M')
PARAMETERS = ('r', 'l1', 'l2', 'offset', 'm0', 'm_rod', 'm_piston', 'I_rod', 'I0', 'u0', 'g', 'axis_tilt')
# function: (arguments, outputs)
FUNCTIONS = {
    "kinematics": (
        ('phi', 'r', 'l1', 'l2', 'offset', 'm_rod', 'm_piston', 'I_rod', 'I0'),
        ('x', 'dx_dphi', 'd2x_dphi2', 'psi', 'dpsi_dphi', 'inertia', 'dinertia_dphi'),
    ),
    "dynamics": (
        ('phi', 'phid', 'F', 'M', 'r', 'l1', 'l2', 'offset', 'm_rod', 'm_piston', 'I_rod', 'I0', 'u0', 'g', 'axis_tilt'),
        ('mass_phi_phi', 'bias_phi', 'force_phi'),
    ),
    "energy": (
        ('phi', 'phid', 'r', 'l1', 'l2', 'offset', 'm_rod', 'm_piston', 'I_rod', 'I0', 'u0', 'g', 'axis_tilt'),
        ('kinetic_energy', 'potential_energy'),
    ),
    "reactions": (
        ('phi', 'phid', 'phidd', 'F', 'r', 'l1', 'l2', 'offset', 'm0', 'm_rod', 'm_piston', 'I_rod', 'u0', 'g', 'axis_tilt'),
        ('R_x_O', 'R_y_O', 'R_x_A', 'R_y_A', 'R_x_B', 'R_y_B', 'R_y_G'),
    ),
    "momentum": (
        ('phi', 'phid', 'phidd', 'r', 'l1', 'l2', 'offset', 'm_rod', 'm_piston', 'I_rod', 'I0', 'u0'),
        ('momentum_rate_x', 'momentum_rate_y', 'angular_momentum_rate'),
    ),
}


def kinematics(phi, r, l1, l2, offset, m_rod, m_piston, I_rod, I0):
    """Kinematics at given coordinates.

    Takes phi [rad], r [m], l1 [m], l2 [m], offset [m], m_rod [kg], m_piston [kg], I_rod [kg*m^2], I0 [kg*m^2].
    Returns x, dx_dphi, d2x_dphi2, psi, dpsi_dphi, inertia, dinertia_dphi.
    """
    cos_phi = ca.cos(phi)
    l = l1 + l2
    sin_phi = ca.sin(phi)
    _t0 = 1 / l
    _t1 = r * sin_phi
    _t2 = -_t1
    sin_psi = _t0 * (-_t2 - offset)
    cos_psi = ca.sqrt(1 - sin_psi**2)
    _t3 = cos_phi * r
    x = -_t3 - cos_psi * l + ca.sqrt(-offset**2 + (l + r)**2)
    dsin_psi_dphi = _t0 * _t3
    _t4 = 1 / cos_psi
    dpsi_dphi = _t4 * dsin_psi_dphi
    dcos_psi_dphi = -dpsi_dphi * sin_psi
    dx_dphi = -_t2 - dcos_psi_dphi * l
    d2sin_psi_dphi2 = -_t0 * _t1
    d2psi_dphi2 = _t4 * d2sin_psi_dphi2 - dcos_psi_dphi * dsin_psi_dphi / cos_psi**2
    d2cos_psi_dphi2 = -d2psi_dphi2 * sin_psi - dpsi_dphi * dsin_psi_dphi
    d2x_dphi2 = _t3 - d2cos_psi_dphi2 * l
    psi = ca.asin(sin_psi)
    dx_rod_dphi = _t2 + dcos_psi_dphi * l1
    dy_rod_dphi = dsin_psi_dphi * l2
    inertia = I0 + I_rod * dpsi_dphi**2 + m_piston * dx_dphi**2 + m_rod * (dx_rod_dphi**2 + dy_rod_dphi**2)
    d2x_rod_dphi2 = -_t3 + d2cos_psi_dphi2 * l1
    d2y_rod_dphi2 = d2sin_psi_dphi2 * l2
    _t5 = 2 * m_rod
    dinertia_dphi = 2 * I_rod * d2psi_dphi2 * dpsi_dphi + _t5 * d2x_rod_dphi2 * dx_rod_dphi + _t5 * d2y_rod_dphi2 * dy_rod_dphi + 2 * d2x_dphi2 * dx_dphi * m_piston
    return x, dx_dphi, d2x_dphi2, psi, dpsi_dphi, inertia, dinertia_dphi


def dynamics(phi, phid, F, M, r, l1, l2, offset, m_rod, m_piston, I_rod, I0, u0, g, axis_tilt):
    """Equations of motion: mass * qdd + bias = force (gravity, springs, dampers, inputs).

    Takes phi [rad], phid [rad/s], F [N], M [N*m], r [m], l1 [m], l2 [m], offset [m], m_rod [kg], m_piston [kg],
        I_rod [kg*m^2], I0 [kg*m^2], u0 [kg*m], g [m/s^2], axis_tilt [rad].
    Returns mass_phi_phi, bias_phi, force_phi.
    """
    l = l1 + l2
    sin_phi = ca.sin(phi)
    _t0 = 1 / l
    _t1 = r * sin_phi
    _t2 = -_t1
    sin_psi = _t0 * (-_t2 - offset)
    cos_psi = ca.sqrt(1 - sin_psi**2)
    cos_phi = ca.cos(phi)
    _t3 = cos_phi * r
    dsin_psi_dphi = _t0 * _t3
    _t4 = 1 / cos_psi
    dpsi_dphi = _t4 * dsin_psi_dphi
    dcos_psi_dphi = -dpsi_dphi * sin_psi
    dx_dphi = -_t2 - dcos_psi_dphi * l
    dx_rod_dphi = _t2 + dcos_psi_dphi * l1
    dy_rod_dphi = dsin_psi_dphi * l2
    inertia = I0 + I_rod * dpsi_dphi**2 + m_piston * dx_dphi**2 + m_rod * (dx_rod_dphi**2 + dy_rod_dphi**2)
    d2sin_psi_dphi2 = -_t0 * _t1
    d2psi_dphi2 = _t4 * d2sin_psi_dphi2 - dcos_psi_dphi * dsin_psi_dphi / cos_psi**2
    d2cos_psi_dphi2 = -d2psi_dphi2 * sin_psi - dpsi_dphi * dsin_psi_dphi
    d2x_dphi2 = _t3 - d2cos_psi_dphi2 * l
    d2x_rod_dphi2 = -_t3 + d2cos_psi_dphi2 * l1
    d2y_rod_dphi2 = d2sin_psi_dphi2 * l2
    dx_crank_dphi = _t2
    dy_crank_dphi = _t3
    _t5 = phid**2
    _t6 = ca.sin(axis_tilt)
    _t7 = _t6 * g
    _t8 = g * ca.cos(axis_tilt)
    _t9 = u0 / r
    mass_phi_phi = inertia
    bias_phi = _t5 * I_rod * d2psi_dphi2 * dpsi_dphi + _t5 * d2x_dphi2 * dx_dphi * m_piston + m_rod * (_t5 * d2x_rod_dphi2 * dx_rod_dphi + _t5 * d2y_rod_dphi2 * dy_rod_dphi)
    force_phi = F * dx_dphi + M + _t6 * dx_dphi * g * m_piston - _t7 * _t9 * dx_crank_dphi - _t7 * dx_rod_dphi * m_rod - _t8 * _t9 * dy_crank_dphi - _t8 * dy_rod_dphi * m_rod
    return mass_phi_phi, bias_phi, force_phi


def energy(phi, phid, r, l1, l2, offset, m_rod, m_piston, I_rod, I0, u0, g, axis_tilt):
    """Energies; the potential is zero at the origin.

    Takes phi [rad], phid [rad/s], r [m], l1 [m], l2 [m], offset [m], m_rod [kg], m_piston [kg], I_rod [kg*m^2],
        I0 [kg*m^2], u0 [kg*m], g [m/s^2], axis_tilt [rad].
    Returns kinetic_energy, potential_energy.
    """
    l = l1 + l2
    sin_phi = ca.sin(phi)
    _t0 = 1 / l
    _t1 = r * sin_phi
    _t2 = -_t1
    sin_psi = _t0 * (-_t2 - offset)
    cos_psi = ca.sqrt(1 - sin_psi**2)
    cos_phi = ca.cos(phi)
    _t3 = cos_phi * r
    dsin_psi_dphi = _t0 * _t3
    dpsi_dphi = dsin_psi_dphi / cos_psi
    dcos_psi_dphi = -dpsi_dphi * sin_psi
    dx_dphi = -_t2 - dcos_psi_dphi * l
    dx_rod_dphi = _t2 + dcos_psi_dphi * l1
    dy_rod_dphi = dsin_psi_dphi * l2
    inertia = I0 + I_rod * dpsi_dphi**2 + m_piston * dx_dphi**2 + m_rod * (dx_rod_dphi**2 + dy_rod_dphi**2)
    x_crank = _t3
    _t4 = -ca.sqrt(-offset**2 + (l + r)**2)
    x = -_t3 - _t4 - cos_psi * l
    x_piston = -_t4 - x
    x_rod = _t3 + cos_psi * l1
    y_crank = _t1
    y_rod = l2 * sin_psi + offset
    _t5 = ca.cos(axis_tilt)
    _t6 = g * m_piston
    _t7 = ca.sin(axis_tilt)
    _t8 = g * m_rod
    _t9 = g * u0 / r
    kinetic_energy = inertia * phid**2 / 2
    potential_energy = _t5 * _t6 * offset + _t5 * _t8 * y_rod + _t5 * _t9 * y_crank + _t6 * _t7 * x_piston + _t7 * _t8 * x_rod + _t7 * _t9 * x_crank
    return kinetic_energy, potential_energy


def reactions(phi, phid, phidd, F, r, l1, l2, offset, m0, m_rod, m_piston, I_rod, u0, g, axis_tilt):
    """Joint reactions (first body on second) and other outputs that need accelerations.

    Takes phi [rad], phid [rad/s], phidd [rad/s^2], F [N], r [m], l1 [m], l2 [m], offset [m], m0 [kg], m_rod [kg],
        m_piston [kg], I_rod [kg*m^2], u0 [kg*m], g [m/s^2], axis_tilt [rad].
    Returns R_x_O, R_y_O, R_x_A, R_y_A, R_x_B, R_y_B, R_y_G.
    """
    cos_phi = ca.cos(phi)
    _t0 = cos_phi * r
    d2x_crank_dphi2 = -_t0
    l = l1 + l2
    sin_phi = ca.sin(phi)
    _t1 = 1 / l
    _t2 = r * sin_phi
    _t3 = -_t2
    sin_psi = _t1 * (-_t3 - offset)
    cos_psi = ca.sqrt(1 - sin_psi**2)
    d2sin_psi_dphi2 = -_t1 * _t2
    dsin_psi_dphi = _t0 * _t1
    _t4 = 1 / cos_psi
    dpsi_dphi = _t4 * dsin_psi_dphi
    dcos_psi_dphi = -dpsi_dphi * sin_psi
    d2psi_dphi2 = _t4 * d2sin_psi_dphi2 - dcos_psi_dphi * dsin_psi_dphi / cos_psi**2
    d2cos_psi_dphi2 = -d2psi_dphi2 * sin_psi - dpsi_dphi * dsin_psi_dphi
    d2x_dphi2 = _t0 - d2cos_psi_dphi2 * l
    d2x_rod_dphi2 = -_t0 + d2cos_psi_dphi2 * l1
    dx_crank_dphi = _t3
    dx_dphi = -_t3 - dcos_psi_dphi * l
    dx_rod_dphi = _t3 + dcos_psi_dphi * l1
    d2y_rod_dphi2 = d2sin_psi_dphi2 * l2
    dsin_psi_dy_O = _t1
    dpsi_dy_O = _t4 * dsin_psi_dy_O
    dcos_psi_dy_O = -dpsi_dy_O * sin_psi
    dx_dy_O = -dcos_psi_dy_O * l
    dx_rod_dy_O = dcos_psi_dy_O * l1
    dy_rod_dphi = dsin_psi_dphi * l2
    _t5 = dsin_psi_dy_O * l2
    dy_rod_dy_O = _t5
    dy_rod_dy_B = _t5 - 1
    _t6 = u0 / r
    _t7 = -_t6 + m0
    _t8 = g * ca.sin(axis_tilt)
    _t9 = phid**2
    _t10 = _t9 * d2x_rod_dphi2 + dx_rod_dphi * phidd
    _t11 = _t8 * m_rod
    _t12 = _t8 * m_piston
    _t13 = m_piston * (-_t9 * d2x_dphi2 - dx_dphi * phidd)
    _t14 = F + _t12 + _t13
    _t15 = _t10 * m_rod + _t11 + _t14
    _t16 = F * dx_dy_O
    _t17 = _t11 * dx_rod_dy_O
    _t18 = ca.cos(axis_tilt)
    _t19 = _t18 * g
    _t20 = _t19 * m_rod
    _t21 = _t12 * dx_dy_O
    _t22 = I_rod * dpsi_dy_O * (-_t9 * d2psi_dphi2 - dpsi_dphi * phidd)
    _t23 = _t13 * dx_dy_O
    _t24 = _t10 * dx_rod_dy_O
    _t25 = _t9 * d2y_rod_dphi2 + dy_rod_dphi * phidd
    _t26 = _t24 + _t25 * dy_rod_dy_O
    _t27 = _t16 - _t17 + _t21 + _t22 + _t23
    _t28 = _t24 + _t25 * dy_rod_dy_B
    _t29 = -_t20 * dy_rod_dy_B + _t27
    R_x_O = _t15 + _t6 * _t8 + _t6 * (_t9 * d2x_crank_dphi2 + dx_crank_dphi * phidd) + _t7 * _t8
    R_y_O = -_t16 + _t17 + _t19 * _t6 + _t19 * _t7 + _t20 * dy_rod_dy_O - _t21 - _t22 - _t23 + _t26 * m_rod + _t6 * (_t9 * dx_crank_dphi - d2x_crank_dphi2 * phidd)
    R_x_A = _t15
    R_y_A = _t18 * dy_rod_dy_O * g * m_rod + _t26 * m_rod - _t27
    R_x_B = _t14
    R_y_B = _t28 * m_rod - _t29
    R_y_G = _t19 * m_piston - _t28 * m_rod + _t29
    return R_x_O, R_y_O, R_x_A, R_y_A, R_x_B, R_y_B, R_y_G


def momentum(phi, phid, phidd, r, l1, l2, offset, m_rod, m_piston, I_rod, I0, u0):
    """Rates of momentum, and of angular momentum about the origin, of all bodies: the sum of outer forces.

    Takes phi [rad], phid [rad/s], phidd [rad/s^2], r [m], l1 [m], l2 [m], offset [m], m_rod [kg], m_piston [kg],
        I_rod [kg*m^2], I0 [kg*m^2], u0 [kg*m].
    Returns momentum_rate_x, momentum_rate_y, angular_momentum_rate.
    """
    cos_phi = ca.cos(phi)
    _t0 = cos_phi * r
    d2x_crank_dphi2 = -_t0
    l = l1 + l2
    sin_phi = ca.sin(phi)
    _t1 = 1 / l
    _t2 = r * sin_phi
    _t3 = -_t2
    sin_psi = _t1 * (-_t3 - offset)
    cos_psi = ca.sqrt(1 - sin_psi**2)
    d2sin_psi_dphi2 = -_t1 * _t2
    dsin_psi_dphi = _t0 * _t1
    _t4 = 1 / cos_psi
    dpsi_dphi = _t4 * dsin_psi_dphi
    dcos_psi_dphi = -dpsi_dphi * sin_psi
    d2psi_dphi2 = _t4 * d2sin_psi_dphi2 - dcos_psi_dphi * dsin_psi_dphi / cos_psi**2
    d2cos_psi_dphi2 = -d2psi_dphi2 * sin_psi - dpsi_dphi * dsin_psi_dphi
    d2x_dphi2 = _t0 - d2cos_psi_dphi2 * l
    d2x_rod_dphi2 = -_t0 + d2cos_psi_dphi2 * l1
    dx_crank_dphi = _t3
    dx_dphi = -_t3 - dcos_psi_dphi * l
    dx_rod_dphi = _t3 + dcos_psi_dphi * l1
    d2y_rod_dphi2 = d2sin_psi_dphi2 * l2
    dy_rod_dphi = dsin_psi_dphi * l2
    x_rod = _t0 + cos_psi * l1
    y_rod = l2 * sin_psi + offset
    _t5 = phid**2
    _t6 = _t5 * d2x_rod_dphi2 + dx_rod_dphi * phidd
    _t7 = m_piston * (-_t5 * d2x_dphi2 - dx_dphi * phidd)
    _t8 = u0 / r
    _t9 = _t5 * d2y_rod_dphi2 + dy_rod_dphi * phidd
    momentum_rate_x = _t6 * m_rod + _t7 + _t8 * (_t5 * d2x_crank_dphi2 + dx_crank_dphi * phidd)
    momentum_rate_y = _t8 * (_t5 * dx_crank_dphi - d2x_crank_dphi2 * phidd) + _t9 * m_rod
    angular_momentum_rate = I0 * phidd + I_rod * (-_t5 * d2psi_dphi2 - dpsi_dphi * phidd) - _t7 * offset + m_rod * (-_t6 * y_rod + _t9 * x_rod)
    return momentum_rate_x, momentum_rate_y, angular_momentum_rate
