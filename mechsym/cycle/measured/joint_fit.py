r"""The trapped charge while nothing burns: pressure over the crank angle for an exponent that changes, and losses.

    log p |   \                       L = log(V/V_r), V_r the volume 45 degrees before top dead centre
          |     \  slope -(n0+n1 L)   k: share of the pressure that walls and rings take a radian at top dead centre
          |       \_ _
          +----------- log V          compression runs down the line, expansion comes back below it by what was lost

A constant exponent would put its own error into the dead centre: 0.05 in n are worth about 2 degrees.

Dead centre, exponent, losses, offset and drift of a measured charge line in one least-squares fit with priors.

    measured_k(phi) = offset_k + drift (phi - phi_r) + level_k p(phi - delta; n0, n1, loss, sharpness) + noise

Offset and level of every cycle and the dead centre are free; the rest has a prior, because dead centre, exponent and
losses of one line are nearly one number. The mean of the cycles carries all that they say of what they share. A lag
of the sensor at one speed is a later dead centre: their sum is found, and the sum is what the work needs;
`shared_centre` separates them where the cycles differ in speed.
"""

import math
from collections.abc import Sequence
from typing import Annotated

import numpy as np
import scipy

from mechsym.cycle.chamber import Chamber, dvolume_dphi, volume
from mechsym.quantities import record
from mechsym.quantities.units import Array, Pascal, Pure, Radian

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


_RAMP = math.radians(5.0)
_LONGEST_STEP = math.radians(3.0)
_DRIFT = 0.005  # of the swing per radian: slow drift, and what a membrane heated once a cycle does
_SETTLED, _TURNS = 1e-6, 30
_Solved = tuple[float, np.ndarray, np.ndarray, np.ndarray, np.ndarray]


@record
class Prior:
    """What is known before the fit, as middle and standard deviation."""

    n0: tuple[float, float] = (1.33, 0.045)  #: Exponent at the reference volume [-]
    n1: tuple[float, float] = (0.04, 0.035)  #: Its change with log V [-]
    loss: tuple[float, float] = (0.06, 0.06)  #: Lost share of the pressure [1/rad]
    sharpness: tuple[float, float] = (1.3, 0.4)  #: Exponent of the losses [-]
    tdc: tuple[float, float] | None = None  #: Dead centre on the scale of the angles [rad]


@record
class JointFit:
    """The fitted line; the order of the covariance is dead centre, n0, n1, loss, sharpness, level, offset, drift."""

    tdc: float  #: Dead centre on the scale of the angles given [rad]
    shape: ChargeShape
    level: float  #: Pressure 45 degrees before TDC, of the mean cycle [Pa]
    offset: float  #: What the sensor adds there, of the mean cycle [Pa]
    drift: float  #: How fast that changes [Pa/rad]
    covariance: np.ndarray  #: shape (8, 8), level, offset and drift by the swing of the record [rad, -, 1/rad]
    prior_share: float  #: Share of the variance of the dead centre that the priors leave; the rest is noise [-]
    between: tuple[float, float]  #: Ends of the line from the dead centre [rad]
    swing: float  #: Highest less lowest pressure of the record [Pa]
    rms: float  #: Root mean square of the residuals of the mean cycle [Pa]
    sigma: float  #: Noise behind the covariance, residuals that hang together allowed for [Pa]


def joint_fit(
    phi: Radian[Array],
    mean: Pascal[Array],
    cylinder: Chamber,
    between: tuple[Radian, Radian],
    sigma: Pascal,
    prior: Prior,
    starts: Sequence[Radian],
    inside: tuple[Radian, Radian] = (-math.inf, math.inf),
) -> JointFit:
    """Fit the charge line of the mean cycle.

    phi: ascending crank angles on any scale. mean: measured pressure. between: ends of the line from the dead centre;
    they move along with it. sigma: white noise of the mean cycle. starts: dead centres to begin with; where the line
    fits best in the end counts. inside: between which angles the dead centre must lie. Returns fit: with the noise that
    the residuals show where that is more than `sigma` [Pa].
    """
    swing = float(np.ptp(mean))
    floor = max(sigma / swing, 1e-5)
    tried = [_solve(phi, mean / swing, cylinder, between, floor, prior, start, inside) for start in starts]
    at = min(tried, key=lambda fit: _cost(fit, floor, prior))
    # noise by which n independent residuals would say as little as these, which hang together
    left = at[2]
    power = float(left @ left)
    r = min(max(float(left[:-1] @ left[1:]) / power, 0.0), 0.98) if power > 0 else 0.0
    noise = max(floor, math.sqrt(power / max(float(at[3].sum()) - 5.0, 1.0) * (1 + r) / (1 - r)))
    at = _solve(phi, mean / swing, cylinder, between, noise, prior, at[0], inside)
    return _result(at, swing, noise, prior, between)


def cycle_lines(
    phi: Radian[Array],
    rows: Pascal[Array],
    cylinder: Chamber,
    between: tuple[Radian, Radian],
    shape: ChargeShape,
    drift: Annotated[float, "Pa/rad"],
) -> tuple[Pascal[Array], Pascal[Array]]:
    """Offset and level of every cycle under the shape that all of them share.

    phi: ascending crank angles from firing TDC; rows: measured pressure of each cycle, shape (k, n); between: ends of
    the line; drift: how fast the offset changes. Returns offsets, levels: of each cycle, 45 degrees before TDC, shape
    (k,).
    """
    root = np.sqrt(_weights(phi, between))
    inside = root > 0
    at = phi[inside]
    rise = np.exp(log_pressure(cylinder, at, shape)[0])
    columns = np.stack([np.ones_like(at), rise], axis=-1) * root[inside, None]
    measured = (rows[:, inside] - drift * (at - REFERENCE)) * root[inside]
    lines = np.linalg.lstsq(columns, measured.T, rcond=None)[0]
    return lines[0], lines[1]


def pulls(fit: JointFit, prior: Prior) -> np.ndarray:
    """How far the dead centre of a fit goes with the middle of each of its priors.

    Returns pulls: in the order of the covariance, 0 for what is free [rad by the unit of each], shape (8,).
    """
    return fit.covariance[0] * _known(prior, fit.tdc)[1] ** 2


def information(fit: JointFit, prior: Prior) -> tuple[np.ndarray, np.ndarray]:
    """What the samples of a fit say by themselves of dead centre, n0, n1, loss and sharpness, the rest free.

    prior: of the fit, taken out again. Returns weight, pull: they say weight @ x = pull with the covariance inv(weight)
    [by the units of the values], shape (5, 5), (5,).
    """
    middle, tight = (of[:5] for of in _known(prior, fit.tdc))
    shape = fit.shape
    values = np.array([fit.tdc, shape.n0, shape.n1, shape.loss, shape.sharpness])
    both, before = np.linalg.inv(fit.covariance[:5, :5]), np.diag(tight**2)
    return both - before, both @ values - before @ middle


def clearance_asked(
    fit: JointFit, phi: Radian[Array], mean: Pascal[Array], cylinder: Chamber, prior: Prior
) -> tuple[Pure, Pure]:
    r"""By how much larger a clearance fits a line best, and the standard deviation of that.

    .. math:: \hat g = \frac{c_\perp^T b}{c_\perp^T c_\perp}, \quad s = \frac{1}{|c_\perp|}, \quad
        c_\perp = c - A (A^T A)^{-1} A^T c

    fit: of these samples under the prior; phi: ascending crank angles on the scale of its dead centre. Returns change,
    spread: of the logarithm of the clearance, which is minus that of the compression ratio less 1. A: residuals of
    samples and priors by the values of the fit, b what they leave, c by the clearance: all that the dead centre,
    exponents, losses and the sensor can explain is taken out. One step of Gauss and Newton.
    """
    noise, shape = fit.sigma / fit.swing, fit.shape
    x = np.array([fit.tdc, shape.n0, shape.n1, shape.loss, shape.sharpness])
    values, left, weight, jacobian = _line(phi, mean / fit.swing, cylinder, fit.between, noise, x)
    inside = _weights(phi - fit.tdc, fit.between) > 0
    # the column of the level is the line itself
    c = values[5] * jacobian[:, 5] * by_clearance(cylinder, phi[inside] - fit.tdc, shape)
    middle, tight = _known(prior, fit.tdc)
    both = np.vstack([jacobian / noise, np.diag(tight)])
    rest, column = np.append(left / noise, tight * (middle - values)), np.append(c / noise, 0 * tight)
    alone = column - both @ np.linalg.lstsq(both, column, rcond=None)[0]
    size = float(alone @ alone)
    return float(alone @ rest) / size, 1 / math.sqrt(size)


def _weights(phi: np.ndarray, between: tuple[float, float]) -> np.ndarray:
    # they rise and fall inside the ends: what lies behind the last angle may burn already
    return np.clip(np.minimum(phi - between[0], between[1] - phi) / _RAMP, 0.0, 1.0)


def _solve(
    phi: np.ndarray, mean: np.ndarray, cylinder: Chamber, between: tuple[float, float], noise: float,
    prior: Prior, start: float, bounds: tuple[float, float],
) -> _Solved:  # fmt: skip
    """Gauss-Newton steps; dead centre, all values, residuals, weights and Jacobian where they settle."""
    middle, tight = _known(prior, start)
    x = middle[:5].copy()
    for turn in range(_TURNS):
        values, left, weight, jacobian = _line(phi, mean, cylinder, between, noise, x)
        step = np.linalg.lstsq(
            np.vstack([jacobian / noise, np.diag(tight)]),
            np.append(left / noise, tight * (middle - values)),
            rcond=None,
        )[0][:5]
        if np.abs(step).max() < _SETTLED or turn == _TURNS - 1:
            break
        # the samples change with the dead centre: later steps are damped so that the search cannot swing for ever
        limit = _LONGEST_STEP * min(1.0, abs(10.0 / (1 + turn)))
        step *= min(1.0, limit / max(abs(step[0]), 1e-12)) * (1.0 if turn < 8 else 0.5)
        x = x + step
        x[0], x[4] = np.clip(x[0], *bounds), np.clip(x[4], 0.3, 3.0)
    return float(x[0]), values, left, weight, jacobian


def _line(
    phi: np.ndarray, mean: np.ndarray, cylinder: Chamber, between: tuple[float, float], noise: float, x: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """All values with the level, offset and drift that fit best, residuals, weights and Jacobian inside the ends."""
    weight = _weights(phi - x[0], between)
    inside = weight > 0
    angle, y, root = phi[inside] - x[0], mean[inside], np.sqrt(weight[inside])
    log_p, slopes = log_pressure(cylinder, angle, ChargeShape(n0=x[1], n1=x[2], loss=x[3], sharpness=x[4]))
    rise = np.exp(log_p)
    linear = np.stack([rise, np.ones_like(rise), angle - REFERENCE], axis=-1)
    held = np.array([0.0, 0.0, noise / _DRIFT])
    size, offset, drift = np.linalg.lstsq(
        np.vstack([(linear * root[:, None]), held]), np.append((y * root), 0.0), rcond=None
    )[0]
    jacobian = np.hstack([size * rise[:, None] * slopes, linear]) * root[:, None]
    left = (y - linear @ np.array([size, offset, drift])) * root
    return np.array([*x, size, offset, drift]), left, weight[inside], jacobian


def _known(prior: Prior, start: float) -> tuple[np.ndarray, np.ndarray]:
    """Middle of every prior, and one over its deviation (0: free)."""
    tdc = prior.tdc or (start, math.inf)
    pairs = [tdc, prior.n0, prior.n1, prior.loss, prior.sharpness, (0.0, math.inf), (0.0, math.inf), (0.0, _DRIFT)]
    return np.array([m for m, _ in pairs]), np.array([1 / s for _, s in pairs])


def _cost(at: _Solved, noise: float, prior: Prior) -> float:
    """Weighted squares of residuals and priors by the number of samples."""
    tdc, values, left, weight, _ = at
    middle, tight = _known(prior, tdc)
    return float(left @ left / noise**2 + np.sum((tight * (values - middle))[1:] ** 2)) / float(weight.sum())


def _result(at: _Solved, swing: float, noise: float, prior: Prior, between: tuple[float, float]) -> JointFit:
    tdc, values, left, weight, jacobian = at
    tight = _known(prior, tdc)[1]
    data = jacobian.T @ jacobian / noise**2
    scale = 1 / np.sqrt(np.diag(data) + tight**2)
    covariance = np.linalg.inv((data + np.diag(tight**2)) * np.outer(scale, scale)) * np.outer(scale, scale)
    _, n0, n1, loss, sharpness, level, offset, drift = (float(value) for value in values)
    return JointFit(
        tdc=tdc,
        shape=ChargeShape(n0=n0, n1=n1, loss=loss, sharpness=sharpness),
        level=level * swing,
        offset=offset * swing,
        drift=drift * swing,
        covariance=covariance,
        prior_share=float((covariance @ np.diag(tight**2) @ covariance)[0, 0] / covariance[0, 0]),
        between=between,
        swing=swing,
        rms=float(np.sqrt(left @ left / weight.sum())) * swing,
        sigma=noise * swing,
    )
