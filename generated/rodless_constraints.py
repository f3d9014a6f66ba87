# Generated from derivations/rodless_constraints.py by mechsym.derive. Do NOT edit: run `make derive`.
# source sha256: 7e008584bf723068   (derivations/rodless_constraints.py + mechsym/derive/*.py, newlines normalised)
# body   sha256: 5f1b4311eb39dbd8   (everything below this header)
# sympy 1.14.0
"""The rodless mechanism with constraints, for its rank. Source: 003_8746f5f4ad51b1d1."""

import casadi as ca

NAME = "rodless_constraints"
SOURCE = "003_8746f5f4ad51b1d1"
COORDINATES = ('alpha', 'x_C', 'y_C', 'beta')
INPUTS = ('F_a', 'F_b', 'M')
PARAMETERS = ('r', 'I1', 'u1', 'm_link', 'I_link', 'm_a', 'm_b')
# function: (arguments, outputs)
FUNCTIONS = {
    "kinematics": (
        ('x_C', 'y_C', 'beta', 'r'),
        ('x_a', 'dx_a_dbeta', 'x_b', 'dx_b_dbeta'),
    ),
    "dynamics": (
        ('beta', 'betad', 'F_a', 'F_b', 'M', 'r', 'I1', 'm_link', 'I_link', 'm_a', 'm_b'),
        ('mass_alpha_alpha', 'mass_alpha_x_C', 'mass_alpha_y_C', 'mass_alpha_beta', 'mass_x_C_alpha', 'mass_x_C_x_C', 'mass_x_C_y_C', 'mass_x_C_beta', 'mass_y_C_alpha', 'mass_y_C_x_C', 'mass_y_C_y_C', 'mass_y_C_beta', 'mass_beta_alpha', 'mass_beta_x_C', 'mass_beta_y_C', 'mass_beta_beta', 'bias_alpha', 'bias_x_C', 'bias_y_C', 'bias_beta', 'force_alpha', 'force_x_C', 'force_y_C', 'force_beta'),
    ),
    "energy": (
        ('beta', 'alphad', 'x_Cd', 'y_Cd', 'betad', 'r', 'I1', 'm_link', 'I_link', 'm_a', 'm_b'),
        ('kinetic_energy', 'potential_energy'),
    ),
    "momentum": (
        ('alpha', 'x_C', 'y_C', 'beta', 'alphad', 'betad', 'alphadd', 'x_Cdd', 'y_Cdd', 'betadd', 'r', 'I1', 'u1', 'm_link', 'I_link', 'm_a', 'm_b'),
        ('momentum_rate_x', 'momentum_rate_y', 'angular_momentum_rate'),
    ),
    "constraints": (
        ('alpha', 'x_C', 'y_C', 'beta', 'alphad', 'betad', 'r'),
        ('closure_pin_x', 'closure_pin_y', 'closure_guide_a', 'closure_guide_b', 'jacobian_pin_x_alpha', 'jacobian_pin_x_x_C', 'jacobian_pin_x_y_C', 'jacobian_pin_x_beta', 'jacobian_pin_y_alpha', 'jacobian_pin_y_x_C', 'jacobian_pin_y_y_C', 'jacobian_pin_y_beta', 'jacobian_guide_a_alpha', 'jacobian_guide_a_x_C', 'jacobian_guide_a_y_C', 'jacobian_guide_a_beta', 'jacobian_guide_b_alpha', 'jacobian_guide_b_x_C', 'jacobian_guide_b_y_C', 'jacobian_guide_b_beta', 'bias_pin_x', 'bias_pin_y', 'bias_guide_a', 'bias_guide_b'),
    ),
}


def kinematics(x_C, y_C, beta, r):
    """Kinematics at given coordinates.

    Takes x_C [m], y_C [m], beta [rad], r [m].
    Returns x_a, dx_a_dbeta, x_b, dx_b_dbeta.
    """
    cos_beta = ca.cos(beta)
    _t0 = cos_beta * r
    x_a = _t0 + x_C
    sin_beta = ca.sin(beta)
    _t1 = r * sin_beta
    dx_a_dbeta = -_t1
    x_b = -_t1 + y_C
    dx_b_dbeta = -_t0
    return x_a, dx_a_dbeta, x_b, dx_b_dbeta


def dynamics(beta, betad, F_a, F_b, M, r, I1, m_link, I_link, m_a, m_b):
    """Equations of motion: mass * qdd + bias = force (gravity, springs, dampers, inputs).

    Takes beta [rad], betad [rad/s], F_a [N], F_b [N], M [N*m], r [m], I1 [kg*m^2], m_link [kg], I_link [kg*m^2],
        m_a [kg], m_b [kg].
    Returns mass_alpha_alpha, mass_alpha_x_C, mass_alpha_y_C, mass_alpha_beta, mass_x_C_alpha, mass_x_C_x_C,
        mass_x_C_y_C, mass_x_C_beta, mass_y_C_alpha, mass_y_C_x_C, mass_y_C_y_C, mass_y_C_beta, mass_beta_alpha,
        mass_beta_x_C, mass_beta_y_C, mass_beta_beta, bias_alpha, bias_x_C, bias_y_C, bias_beta, force_alpha,
        force_x_C, force_y_C, force_beta.
    """
    sin_beta = ca.sin(beta)
    dx_a_dbeta = -r * sin_beta
    cos_beta = ca.cos(beta)
    dx_b_dbeta = -cos_beta * r
    _t0 = m_a + m_b + m_link
    _t1 = dx_a_dbeta * m_a
    _t2 = dx_a_dbeta * m_b
    _t3 = _t1 - _t2
    _t4 = dx_b_dbeta * m_a
    _t5 = -_t4 + dx_b_dbeta * m_b
    _t6 = dx_a_dbeta**2 + dx_b_dbeta**2
    _t7 = betad**2
    mass_alpha_alpha = I1
    mass_alpha_x_C = 0
    mass_alpha_y_C = 0
    mass_alpha_beta = 0
    mass_x_C_alpha = 0
    mass_x_C_x_C = _t0
    mass_x_C_y_C = 0
    mass_x_C_beta = _t3
    mass_y_C_alpha = 0
    mass_y_C_x_C = 0
    mass_y_C_y_C = _t0
    mass_y_C_beta = _t5
    mass_beta_alpha = 0
    mass_beta_x_C = _t3
    mass_beta_y_C = _t5
    mass_beta_beta = I_link + _t6 * m_a + _t6 * m_b
    bias_alpha = 0
    bias_x_C = _t4 * _t7 - _t7 * dx_b_dbeta * m_b
    bias_y_C = _t1 * _t7 - _t2 * _t7
    bias_beta = 0
    force_alpha = -M
    force_x_C = F_a
    force_y_C = F_b
    force_beta = F_a * dx_a_dbeta + F_b * dx_b_dbeta
    return mass_alpha_alpha, mass_alpha_x_C, mass_alpha_y_C, mass_alpha_beta, mass_x_C_alpha, mass_x_C_x_C, mass_x_C_y_C, mass_x_C_beta, mass_y_C_alpha, mass_y_C_x_C, mass_y_C_y_C, mass_y_C_beta, mass_beta_alpha, mass_beta_x_C, mass_beta_y_C, mass_beta_beta, bias_alpha, bias_x_C, bias_y_C, bias_beta, force_alpha, force_x_C, force_y_C, force_beta


def energy(beta, alphad, x_Cd, y_Cd, betad, r, I1, m_link, I_link, m_a, m_b):
    """Energies; the potential is zero at the origin.

    Takes beta [rad], alphad [rad/s], x_Cd [m/s], y_Cd [m/s], betad [rad/s], r [m], I1 [kg*m^2], m_link [kg],
        I_link [kg*m^2], m_a [kg], m_b [kg].
    Returns kinetic_energy, potential_energy.
    """
    sin_beta = ca.sin(beta)
    dx_a_dbeta = -r * sin_beta
    cos_beta = ca.cos(beta)
    dx_b_dbeta = -cos_beta * r
    _t0 = m_a / 2 + m_b / 2 + m_link / 2
    _t1 = dx_a_dbeta**2 + dx_b_dbeta**2
    kinetic_energy = I1 * alphad**2 / 2 + _t0 * x_Cd**2 + _t0 * y_Cd**2 + betad**2 * (I_link + _t1 * m_a + _t1 * m_b) / 2 + betad * x_Cd * (dx_a_dbeta * m_a - dx_a_dbeta * m_b) + betad * y_Cd * (-dx_b_dbeta * m_a + dx_b_dbeta * m_b)
    potential_energy = 0
    return kinetic_energy, potential_energy


def momentum(alpha, x_C, y_C, beta, alphad, betad, alphadd, x_Cdd, y_Cdd, betadd, r, I1, u1, m_link, I_link, m_a, m_b):
    """Rates of momentum, and of angular momentum about the origin, of all bodies: the sum of outer forces.

    Takes alpha [rad], x_C [m], y_C [m], beta [rad], alphad [rad/s], betad [rad/s], alphadd [rad/s^2], x_Cdd
        [m/s^2], y_Cdd [m/s^2], betadd [rad/s^2], r [m], I1 [kg*m^2], u1 [kg*m], m_link [kg], I_link [kg*m^2], m_a
        [kg], m_b [kg].
    Returns momentum_rate_x, momentum_rate_y, angular_momentum_rate.
    """
    cos_beta = ca.cos(beta)
    _t0 = cos_beta * r
    d2x_a_dbeta2 = -_t0
    cos_alpha = ca.cos(alpha)
    d2x_crank_dalpha2 = -cos_alpha * r
    sin_beta = ca.sin(beta)
    _t1 = r * sin_beta
    dx_a_dbeta = -_t1
    sin_alpha = ca.sin(alpha)
    dx_crank_dalpha = -r * sin_alpha
    x_a = _t0 + x_C
    x_b = -_t1 + y_C
    y_a = _t1 + y_C
    y_b = -_t0 + x_C
    _t2 = betad**2
    _t3 = _t2 * d2x_a_dbeta2 + betadd * dx_a_dbeta
    _t4 = _t3 + x_Cdd
    _t5 = -_t3 + x_Cdd
    _t6 = alphad**2
    _t7 = u1 / r
    _t8 = betadd * d2x_a_dbeta2
    _t9 = _t2 * dx_a_dbeta
    _t10 = -_t8 + _t9 + y_Cdd
    _t11 = _t8 - _t9 + y_Cdd
    momentum_rate_x = _t4 * m_a + _t5 * m_b + _t7 * (_t6 * d2x_crank_dalpha2 + alphadd * dx_crank_dalpha) + m_link * x_Cdd
    momentum_rate_y = _t10 * m_a + _t11 * m_b + _t7 * (_t6 * dx_crank_dalpha - alphadd * d2x_crank_dalpha2) + m_link * y_Cdd
    angular_momentum_rate = I1 * alphadd + I_link * betadd + m_a * (_t10 * x_a - _t4 * y_a) + m_b * (_t11 * y_b - _t5 * x_b) + m_link * (x_C * y_Cdd - x_Cdd * y_C)
    return momentum_rate_x, momentum_rate_y, angular_momentum_rate


def constraints(alpha, x_C, y_C, beta, alphad, betad, r):
    """Constraints: closure = 0, jacobian * qdd + bias = 0.

    Takes alpha [rad], x_C [m], y_C [m], beta [rad], alphad [rad/s], betad [rad/s], r [m].
    Returns closure_pin_x, closure_pin_y, closure_guide_a, closure_guide_b, jacobian_pin_x_alpha,
        jacobian_pin_x_x_C, jacobian_pin_x_y_C, jacobian_pin_x_beta, jacobian_pin_y_alpha, jacobian_pin_y_x_C,
        jacobian_pin_y_y_C, jacobian_pin_y_beta, jacobian_guide_a_alpha, jacobian_guide_a_x_C,
        jacobian_guide_a_y_C, jacobian_guide_a_beta, jacobian_guide_b_alpha, jacobian_guide_b_x_C,
        jacobian_guide_b_y_C, jacobian_guide_b_beta, bias_pin_x, bias_pin_y, bias_guide_a, bias_guide_b.
    """
    cos_alpha = ca.cos(alpha)
    sin_alpha = ca.sin(alpha)
    sin_beta = ca.sin(beta)
    _t0 = r * sin_beta
    y_a = _t0 + y_C
    cos_beta = ca.cos(beta)
    _t1 = -x_C
    _t2 = cos_beta * r
    y_b = -_t1 - _t2
    dy_a_dbeta = _t2
    dy_b_dbeta = _t0
    _t3 = cos_alpha * r
    _t4 = r * sin_alpha
    _t5 = alphad**2
    _t6 = betad**2
    closure_pin_x = -_t1 - _t3
    closure_pin_y = -_t4 + y_C
    closure_guide_a = y_a
    closure_guide_b = y_b
    jacobian_pin_x_alpha = _t4
    jacobian_pin_x_x_C = 1
    jacobian_pin_x_y_C = 0
    jacobian_pin_x_beta = 0
    jacobian_pin_y_alpha = -_t3
    jacobian_pin_y_x_C = 0
    jacobian_pin_y_y_C = 1
    jacobian_pin_y_beta = 0
    jacobian_guide_a_alpha = 0
    jacobian_guide_a_x_C = 0
    jacobian_guide_a_y_C = 1
    jacobian_guide_a_beta = dy_a_dbeta
    jacobian_guide_b_alpha = 0
    jacobian_guide_b_x_C = 1
    jacobian_guide_b_y_C = 0
    jacobian_guide_b_beta = dy_b_dbeta
    bias_pin_x = _t3 * _t5
    bias_pin_y = _t4 * _t5
    bias_guide_a = -_t6 * dy_b_dbeta
    bias_guide_b = _t6 * dy_a_dbeta
    return closure_pin_x, closure_pin_y, closure_guide_a, closure_guide_b, jacobian_pin_x_alpha, jacobian_pin_x_x_C, jacobian_pin_x_y_C, jacobian_pin_x_beta, jacobian_pin_y_alpha, jacobian_pin_y_x_C, jacobian_pin_y_y_C, jacobian_pin_y_beta, jacobian_guide_a_alpha, jacobian_guide_a_x_C, jacobian_guide_a_y_C, jacobian_guide_a_beta, jacobian_guide_b_alpha, jacobian_guide_b_x_C, jacobian_guide_b_y_C, jacobian_guide_b_beta, bias_pin_x, bias_pin_y, bias_guide_a, bias_guide_b
