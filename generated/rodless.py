# Generated from derivations/rodless.py by mechsym.derive. Do NOT edit: run `make derive`.
# source sha256: ea078aa92aa52f2c   (derivations/rodless.py + mechsym/derive/*.py, newlines normalised)
# body   sha256: 17bbf1828ca71e0f   (everything below this header)
# sympy 1.14.0
"""Crank, link and two sliders at right angles. Source: 003_8746f5f4ad51b1d1."""

import casadi as ca

NAME = "rodless"
SOURCE = "003_8746f5f4ad51b1d1"
COORDINATES = ('alpha',)
INPUTS = ('F_a', 'F_b', 'M')
PARAMETERS = ('r', 'I1', 'u1', 'm_link', 'I_link', 'm_a', 'm_b')
# function: (arguments, outputs)
FUNCTIONS = {
    "kinematics": (
        ('alpha', 'r', 'I1', 'm_link', 'I_link', 'm_a', 'm_b'),
        ('x_a', 'dx_a_dalpha', 'd2x_a_dalpha2', 'x_b', 'dx_b_dalpha', 'd2x_b_dalpha2', 'inertia', 'dinertia_dalpha'),
    ),
    "dynamics": (
        ('alpha', 'alphad', 'F_a', 'F_b', 'M', 'r', 'I1', 'm_link', 'I_link', 'm_a', 'm_b'),
        ('mass_alpha_alpha', 'bias_alpha', 'force_alpha'),
    ),
    "energy": (
        ('alpha', 'alphad', 'r', 'I1', 'm_link', 'I_link', 'm_a', 'm_b'),
        ('kinetic_energy', 'potential_energy'),
    ),
    "reactions": (
        ('alpha', 'alphad', 'alphadd', 'F_a', 'F_b', 'r', 'm_link', 'I_link', 'm_a', 'm_b'),
        ('pin_force_tangential', 'guide_combination', 'pin_and_guide_x', 'pin_and_guide_y'),
    ),
    "momentum": (
        ('alpha', 'alphad', 'alphadd', 'r', 'I1', 'u1', 'm_link', 'I_link', 'm_a', 'm_b'),
        ('momentum_rate_x', 'momentum_rate_y', 'angular_momentum_rate'),
    ),
}


def kinematics(alpha, r, I1, m_link, I_link, m_a, m_b):
    """Kinematics at given coordinates.

    Takes alpha [rad], r [m], I1 [kg*m^2], m_link [kg], I_link [kg*m^2], m_a [kg], m_b [kg].
    Returns x_a, dx_a_dalpha, d2x_a_dalpha2, x_b, dx_b_dalpha, d2x_b_dalpha2, inertia, dinertia_dalpha.
    """
    cos_alpha = ca.cos(alpha)
    sin_alpha = ca.sin(alpha)
    _t0 = cos_alpha * r
    x_a = 2 * _t0
    _t1 = r * sin_alpha
    dx_a_dalpha = -2 * _t1
    dx_link_dalpha = -_t1
    dy_link_dalpha = _t0
    inertia = I1 + I_link + m_a * dx_a_dalpha**2 + m_b * x_a**2 + m_link * (dx_link_dalpha**2 + dy_link_dalpha**2)
    dinertia_dalpha = -2 * dx_a_dalpha * m_a * x_a + 2 * dx_a_dalpha * m_b * x_a
    d2x_a_dalpha2 = -x_a
    x_b = -dx_a_dalpha
    dx_b_dalpha = x_a
    d2x_b_dalpha2 = dx_a_dalpha
    return x_a, dx_a_dalpha, d2x_a_dalpha2, x_b, dx_b_dalpha, d2x_b_dalpha2, inertia, dinertia_dalpha


def dynamics(alpha, alphad, F_a, F_b, M, r, I1, m_link, I_link, m_a, m_b):
    """Equations of motion: mass * qdd + bias = force (gravity, springs, dampers, inputs).

    Takes alpha [rad], alphad [rad/s], F_a [N], F_b [N], M [N*m], r [m], I1 [kg*m^2], m_link [kg], I_link
        [kg*m^2], m_a [kg], m_b [kg].
    Returns mass_alpha_alpha, bias_alpha, force_alpha.
    """
    cos_alpha = ca.cos(alpha)
    sin_alpha = ca.sin(alpha)
    _t0 = r * sin_alpha
    dx_a_dalpha = -2 * _t0
    _t1 = cos_alpha * r
    dx_b_dalpha = 2 * _t1
    dx_link_dalpha = -_t0
    dy_link_dalpha = _t1
    inertia = I1 + I_link + m_a * dx_a_dalpha**2 + m_b * dx_b_dalpha**2 + m_link * (dx_link_dalpha**2 + dy_link_dalpha**2)
    _t2 = alphad**2
    mass_alpha_alpha = inertia
    bias_alpha = -_t2 * dx_a_dalpha * dx_b_dalpha * m_a + _t2 * dx_a_dalpha * dx_b_dalpha * m_b
    force_alpha = F_a * dx_a_dalpha + F_b * dx_b_dalpha - M
    return mass_alpha_alpha, bias_alpha, force_alpha


def energy(alpha, alphad, r, I1, m_link, I_link, m_a, m_b):
    """Energies; the potential is zero at the origin.

    Takes alpha [rad], alphad [rad/s], r [m], I1 [kg*m^2], m_link [kg], I_link [kg*m^2], m_a [kg], m_b [kg].
    Returns kinetic_energy, potential_energy.
    """
    cos_alpha = ca.cos(alpha)
    sin_alpha = ca.sin(alpha)
    _t0 = r * sin_alpha
    dx_a_dalpha = -2 * _t0
    _t1 = cos_alpha * r
    dx_b_dalpha = 2 * _t1
    dx_link_dalpha = -_t0
    dy_link_dalpha = _t1
    inertia = I1 + I_link + m_a * dx_a_dalpha**2 + m_b * dx_b_dalpha**2 + m_link * (dx_link_dalpha**2 + dy_link_dalpha**2)
    kinetic_energy = inertia * alphad**2 / 2
    potential_energy = 0
    return kinetic_energy, potential_energy


def reactions(alpha, alphad, alphadd, F_a, F_b, r, m_link, I_link, m_a, m_b):
    """Joint reactions (first body on second) and other outputs that need accelerations.

    Takes alpha [rad], alphad [rad/s], alphadd [rad/s^2], F_a [N], F_b [N], r [m], m_link [kg], I_link [kg*m^2],
        m_a [kg], m_b [kg].
    Returns pin_force_tangential, guide_combination, pin_and_guide_x, pin_and_guide_y.
    """
    cos_alpha = ca.cos(alpha)
    sin_alpha = ca.sin(alpha)
    _t0 = cos_alpha * r
    d2x_a_dalpha2 = -2 * _t0
    _t1 = r * sin_alpha
    d2x_b_dalpha2 = -2 * _t1
    d2x_link_dalpha2 = -_t0
    d2y_link_dalpha2 = -_t1
    dx_a_dt_C = -2 * sin_alpha
    dx_b_dt_C = 2 * cos_alpha
    _t2 = I_link * alphadd / r
    _t3 = alphad**2
    _t4 = _t3 * d2x_a_dalpha2 + alphadd * d2x_b_dalpha2
    _t5 = _t4 * m_a
    _t6 = m_b * (_t3 * d2x_b_dalpha2 - alphadd * d2x_a_dalpha2)
    _t7 = _t3 * d2y_link_dalpha2 - alphadd * d2x_link_dalpha2
    _t8 = _t3 * d2x_link_dalpha2 + alphadd * d2y_link_dalpha2
    pin_force_tangential = -F_a * dx_a_dt_C - F_b * dx_b_dt_C + _t2 + _t5 * dx_a_dt_C + _t6 * dx_b_dt_C + m_link * (_t7 * cos_alpha - _t8 * sin_alpha)
    guide_combination = -F_a * sin_alpha + F_b * cos_alpha - _t2 + _t4 * m_a * sin_alpha - _t6 * cos_alpha
    pin_and_guide_x = -F_a + _t5 + _t8 * m_link
    pin_and_guide_y = -F_b + _t6 + _t7 * m_link
    return pin_force_tangential, guide_combination, pin_and_guide_x, pin_and_guide_y


def momentum(alpha, alphad, alphadd, r, I1, u1, m_link, I_link, m_a, m_b):
    """Rates of momentum, and of angular momentum about the origin, of all bodies: the sum of outer forces.

    Takes alpha [rad], alphad [rad/s], alphadd [rad/s^2], r [m], I1 [kg*m^2], u1 [kg*m], m_link [kg], I_link
        [kg*m^2], m_a [kg], m_b [kg].
    Returns momentum_rate_x, momentum_rate_y, angular_momentum_rate.
    """
    cos_alpha = ca.cos(alpha)
    sin_alpha = ca.sin(alpha)
    _t0 = cos_alpha * r
    d2x_a_dalpha2 = -2 * _t0
    d2x_crank_dalpha2 = -_t0
    _t1 = r * sin_alpha
    dx_a_dalpha = -2 * _t1
    dx_crank_dalpha = -_t1
    _t2 = alphad**2
    _t3 = _t2 * d2x_crank_dalpha2 + alphadd * dx_crank_dalpha
    _t4 = u1 / r
    _t5 = _t2 * dx_crank_dalpha - alphadd * d2x_crank_dalpha2
    momentum_rate_x = _t3 * _t4 + _t3 * m_link + m_a * (_t2 * d2x_a_dalpha2 + alphadd * dx_a_dalpha)
    momentum_rate_y = _t4 * _t5 + _t5 * m_link + m_b * (_t2 * dx_a_dalpha - alphadd * d2x_a_dalpha2)
    angular_momentum_rate = I1 * alphadd - I_link * alphadd + m_link * (_t3 * dx_crank_dalpha - _t5 * d2x_crank_dalpha2)
    return momentum_rate_x, momentum_rate_y, angular_momentum_rate
