r"""The trapped charge while nothing burns: pressure over the crank angle for an exponent that changes, and losses.

    log p |   \                       L = log(V/V_r), V_r the volume 45 degrees before top dead centre
          |     \  slope -(n0+n1 L)   k: share of the pressure that walls and rings take a radian at top dead centre
          |       \_ _
          +----------- log V          compression runs down the line, expansion comes back below it by what was lost

A constant exponent would put its own error into the dead centre: 0.05 in n are worth about 2 degrees.
"""

import math

import numpy as np
import scipy

from mechsym.cycle.chamber import Chamber, dvolume_dphi, volume
from mechsym.quantities import record
from mechsym.quantities.units import Array, Pure, Radian

REFERENCE = math.radians(-45.0)
_GRID = np.linspace(-math.pi, math.pi, 181)  # cubic in between: 1e-6 of the integral


@record
class ChargeShape:
    """What the line of a trapped charge depends on, besides its level."""

    n0: float  #: Exponent at the reference volume, without the losses [-]
    n1: float  #: Its change with log V: heat capacities grow with the temperature [-]
    loss: float  #: Share of the pressure lost to walls and rings per radian at top dead centre [1/rad]
    sharpness: float  #: Losses follow (V_c/V)^sharpness [-]


def log_pressure(cylinder: Chamber, phi: Radian[Array], shape: ChargeShape) -> tuple[Pure[Array], np.ndarray]:
    r"""Logarithm of the pressure of a trapped charge, and how it changes with what it depends on.

    .. math:: \ln\frac{p}{p_r} = -n_0 L - \tfrac12 n_1 L^2 - k \int_{\varphi_r}^{\varphi} \left(\frac{V_c}{V}\right)^q
        d\varphi, \quad L = \ln\frac{V}{V_r}

    phi: crank angle from firing TDC, within half a turn of it. Returns slopes: derivatives by a later dead centre
    [1/rad], n0, n1 [-], loss [rad], sharpness [-], shape (n, 5).
    Source: first law of a trapped ideal gas, (dp/p)/dphi = -gamma V'/V - (gamma - 1) Q'/(p V) - gamma m'/m, with the
    last two terms as one power of the volume. Valid: nothing burns, valves closed, k small against n V''/V.
    """
    v, v_ref, v_c = volume(cylinder, phi), float(volume(cylinder, REFERENCE)), float(volume(cylinder, 0.0))
    level = np.log(v / v_ref)
    share = v_c / volume(cylinder, _GRID)
    density = share**shape.sharpness
    total = scipy.interpolate.CubicSpline(_GRID, np.stack([density, density * np.log(share)], axis=-1)).antiderivative()
    lost, by_sharpness = (total(phi) - total(REFERENCE)).T
    at = (v_c / v) ** shape.sharpness
    by_angle = -(shape.n0 + shape.n1 * level) * dvolume_dphi(cylinder, phi) / v - shape.loss * at
    slopes = np.stack([-by_angle, -level, -(level**2) / 2, -lost, -shape.loss * by_sharpness], axis=-1)
    return -shape.n0 * level - shape.n1 * level**2 / 2 - shape.loss * lost, slopes


def by_clearance(cylinder: Chamber, phi: Radian[Array], shape: ChargeShape) -> Pure[Array]:
    r"""How the logarithm of the pressure changes with the logarithm of the clearance.

    .. math:: \frac{\partial \ln p/p_r}{\partial \ln V_c} = -(n_0 + n_1 L)\left(\frac{V_c}{V} - \frac{V_c}{V_r}\right)
        - k q \int_{\varphi_r}^{\varphi} \left(\frac{V_c}{V}\right)^q \left(1 - \frac{V_c}{V}\right) d\varphi

    phi: crank angle from firing TDC, within half a turn of it. Returns slope: shape (n,).
    Source: derivative of `log_pressure`. A rod that is not the engine's bends the line in the same way.
    """
    v, v_ref, v_c = volume(cylinder, phi), float(volume(cylinder, REFERENCE)), float(volume(cylinder, 0.0))
    share = v_c / volume(cylinder, _GRID)
    grown = scipy.interpolate.CubicSpline(_GRID, share**shape.sharpness * (1 - share)).antiderivative()
    lost = shape.loss * shape.sharpness * (grown(phi) - grown(REFERENCE))
    return -(shape.n0 + shape.n1 * np.log(v / v_ref)) * (v_c / v - v_c / v_ref) - lost


def mean_exponent(cylinder: Chamber, shape: ChargeShape, first: Radian, last: Radian) -> Pure:
    r"""The exponent of the straight line between two points of the charge's line.

    .. math:: n = -\frac{\ln p_2 - \ln p_1}{\ln V_2 - \ln V_1}

    Returns n: losses included.
    """
    ends = np.array([first, last])
    drop, _ = log_pressure(cylinder, ends, shape)
    return -float(np.diff(drop)[0] / np.diff(np.log(volume(cylinder, ends)))[0])
