r"""What the walls and the rings take of a charge that does not burn: expected before anything is measured.

Lag of a sensor, told by cycles of different speeds: a lag moves the line of a cycle by its speed.

.. math:: \varphi_k = \varphi_0 + \tau\,\omega_k

One speed gives the sum of dead centre and lag, which is what the work needs; only a range of speeds separates them.

One dead centre for several records of one encoder: what their charge lines say together.

    record k:  tdc_k = tdc + tau (omega_k - omega)          lag tau of the sensor
               loss_k = heat h(omega_k, p_k) + leak b(omega_k)    one engine: the same walls and rings
               n0_k, n1_k, sharpness_k                      alike, but for what load and speed do to the charge

Loads hardly tell losses from a shift of the dead centre; speeds do, for heat and blow-by lose less a radian of a fast
engine. Each line is fitted by itself; what the fits say is put together as normal distributions, and the lines are
fitted again from there.
"""

import dataclasses
import math
from collections.abc import Sequence

import numpy as np
import scipy

from mechsym.cycle.chamber import Chamber, wall_area
from mechsym.cycle.heat import Annand, GasAtWall, Hohenberg, Woschni, heat_flux
from mechsym.cycle.measured.alignment import (
    ENCODER,
    THROUGH,
    DeadCentre,
    align,
    between,
    from_compression,
    from_motored,
    in_one_piece,
    interval,
    peak_angle,
    sound_cycles,
)
from mechsym.cycle.measured.diagram import Diagram, line_prior, period_of
from mechsym.cycle.measured.file import recorded_speed
from mechsym.cycle.measured.joint_fit import JointFit, Prior, information, joint_fit, pulls
from mechsym.cycle.measured.measure import MeasuredCycles, around_compression
from mechsym.cycle.measured.signal import noise
from mechsym.quantities import record
from mechsym.quantities.units import NORMAL_95, Array, Pascal, Pure, Radian, RadPerSecond

_BOTTOM, _CHARGE, _WALL = 0.9e5, 340.0, 430.0  # Pa and K of a fresh charge, K of a wall: usual
_GAMMA, _R = 1.35, 287.0
#: By how much heat and blow-by change with the speed, and heat with the pressure, as exponents
HEAT_BY_SPEED, LEAK_BY_SPEED, HEAT_BY_PRESSURE = -0.3, -1.0, -0.2
_LEAK, _BORE, _PISTON_SPEED = 0.012, 0.08, 8.0


_HEAT, _LEAKS = 1.75, 2.2  # factors of a standard deviation: laws of heat differ by two to three, worn rings by more


def expected_losses(cylinder: Chamber, omega: RadPerSecond) -> tuple[tuple[float, float], tuple[float, float]]:
    r"""Losses of an unfired charge by three laws of heat transfer and a usual blow-by.

    .. math:: k_h = \frac{(\gamma - 1) q A_w}{p V \omega}, \quad
        k_l = 0.012\,\frac{80\,\mathrm{mm}}{B}\,\frac{8\,\mathrm{m/s}}{\bar S_p}

    Returns heat, leak: shares of the pressure lost at top dead centre to the walls, as the mean of the laws, and past
    the rings, each the middle of a log-normal distribution [1/rad] and its factor of a standard deviation [-].

    Sources: Woschni (1967), Annand (1963), Hohenberg (1979), without radiation; they differ by a factor of two to three
    (Heywood 1988, section 12.4). Blow-by: about 1 % of the charge at rated speed (Heywood 1988, section 8.6), through
    gaps that grow with the bore.
    Valid: charge of about 1 bar and 340 K, walls of 430 K.
    """
    t = _CHARGE * cylinder.compression_ratio ** (_GAMMA - 1)
    p = _BOTTOM * cylinder.compression_ratio**_GAMMA
    speed = cylinder.stroke * omega / math.pi
    state = GasAtWall(p, t, cylinder.clearance, _R, cylinder.bore, speed)
    laws = (
        Woschni(wall_temperature=_WALL),
        Annand(wall_temperature=_WALL, radiation=0.0),
        Hohenberg(wall_temperature=_WALL),
    )
    by = (_GAMMA - 1) * wall_area(cylinder, cylinder.clearance) / (p * cylinder.clearance * omega)
    shares = np.array([float(heat_flux(law, state)) for law in laws]) * by
    heat, leak = float(shares.mean()), _LEAK * _BORE / cylinder.bore * _PISTON_SPEED / speed
    return (heat, _HEAT), (leak, _LEAKS)


def log_normal(of: tuple[float, float], at: float) -> tuple[float, float]:
    """Middle and deviation of the normal distribution that is like a log-normal one near a value.

    of: middle [1/rad] and factor [-] of the log-normal one; at: the value [1/rad]. Returns normal: middle and
    deviation of the normal one [1/rad].

    >>> log_normal((0.1, math.e), 0.1)
    (0.1, 0.1)
    """
    middle, factor = of
    at = min(max(at, middle / factor**3), middle * factor**3)
    return at * (1 + math.log(middle / at)), at * math.log(factor)


def by_state(speed: Pure, pressure: Pure) -> tuple[Pure, Pure]:
    """Factors on heat and blow-by at another speed and pressure of the charge, each by that of the middle record."""
    return speed**HEAT_BY_SPEED * pressure**HEAT_BY_PRESSURE, speed**LEAK_BY_SPEED


_LEVEL = 0.975
_FEWEST = 4
_SEEN = math.radians(0.05)  # cycles whose lines a usual lag moves by less are of one speed: no line is known so well
#: 19 lags in 20 lie between 0 and 0.1 ms: 20 mm of passage at 500 m/s take 0.04 ms, a filter of 3 kHz 0.05 ms [s]
USUAL = (0.0, 1e-4)
# How much n0, n1, loss, sharpness (in the order of the fit's covariance) and drift may change where the speed changes
# e-fold (assumed): 0.02 are 200 K of the charge; heat lost per radian goes as speed to -0.2 to -0.7, blow-by to -1
_BY_SPEED = np.array([0.0, 0.02, 0.02, 0.06, 0.2, 0.0, 0.0, 0.0025])


@record
class SensorLag:
    """Lag of the sensor between the cylinder and the file."""

    lag: float  #: Middle of the interval [s]
    half: float  #: Half the 95 % interval [s]
    omega: float  #: Speed at which the cycles tell the sum of dead centre and lag [rad/s]
    speeds: tuple[float, float]  #: Lowest and highest [rad/s]

    @property
    def told(self) -> bool:
        """Whether the cycles tell more of the lag than is known of any sensor."""
        return self.half < (USUAL[1] - USUAL[0]) / 2


def lag_of(measured: MeasuredCycles, cylinder: Chamber, diagram: Diagram) -> SensorLag | None:
    """Lag of the sensor of a record; None where its speeds are one, or its angles are spread evenly over each turn."""
    speeds, alignment = measured.speeds, measured.alignment
    if speeds is None or alignment.spread is not None or len(speeds) < _FEWEST or not _differ(speeds):
        return None
    phi, rows = around_compression(measured.phi, measured.cycles, measured.period)
    ends, prior = THROUGH if alignment.motored else between(diagram), line_prior(diagram)
    return sensor_lag(cycle_fits(phi, rows, cylinder, ends, prior), speeds, prior)


def without_lag(centre: DeadCentre, lag: SensorLag) -> tuple[Radian, Radian]:
    """Dead centre of a record less the lag in it.

    centre: of the mean cycle, by its own line. Returns angle, half: angle of the file and half its 95 % interval.
    """
    return centre.angle - lag.lag * lag.omega, math.hypot((centre.high - centre.low) / 2, lag.half * lag.omega)


def _differ(speeds: np.ndarray) -> bool:
    return bool(USUAL[1] * np.ptp(speeds) > _SEEN)


def cycle_fits(
    phi: Radian[Array], rows: Pascal[Array], cylinder: Chamber, ends: tuple[Radian, Radian], prior: Prior
) -> list[JointFit]:
    """Charge line of every cycle by itself.

    phi: ascending angles from the dead centre of the mean cycle, compression in one piece; rows: pressure of each
    cycle, shape (k, n).
    """
    return [joint_fit(phi, row, cylinder, ends, noise(row), prior, [0.0]) for row in rows]


def sensor_lag(fits: Sequence[JointFit], speeds: RadPerSecond[Array], prior: Prior) -> SensorLag | None:
    r"""Lag of the sensor from dead centres at several speeds, by weighted regression.

    .. math:: \tau = \sum_k b_k \varphi_k, \quad b_k = \frac{w_k (\omega_k - \bar\omega)}
        {\sum_i w_i (\omega_i - \bar\omega)^2}, \quad
        h^2 = t_{K-2}^2 s^2 + 1.96^2 \sum_j \left(\sum_k b_k g_{kj} c_j \ln\frac{\omega_k}{\bar\omega}\right)^2

    fits: line of every cycle, of one or several records of one sensor and encoder, on one scale of angles; speeds:
    their speeds, shape (k,). Returns lag: None with fewer than four cycles or a single speed. Weights w are one over
    the variance that the noise leaves of each dead centre; s is the deviation of tau by the scatter about the straight
    line. What is assumed of the charge (pull g on the dead centre) is in all cycles alike and goes out with phi_0, but
    for c_j, by which it may change with speed. Source: least squares; c of the losses from the exponents of speed of
    Woschni, Annand and Eichelberg, else assumed. Valid: a lag that is short beside compression (tau omega below about 3
    degrees), on an encoder that follows the shaft inside a turn.

    >>> sensor_lag([], np.array([]), Prior()) is None
    True
    """
    if len(fits) < _FEWEST or not _differ(speeds):
        return None
    at = np.array([fit.tdc for fit in fits])
    weight = 1 / np.array([fit.covariance[0, 0] * (1 - fit.prior_share) for fit in fits])
    middle = float(weight @ speeds / weight.sum())
    b = weight * (speeds - middle) / (weight @ (speeds - middle) ** 2)
    lag = float(b @ at)
    left = at - weight @ at / weight.sum() - lag * (speeds - middle)
    scatter = float(weight @ left**2) / (len(fits) - 2) / float(weight @ (speeds - middle) ** 2)
    pulled = np.array([pulls(fit, prior) for fit in fits]) * _BY_SPEED * np.log(speeds / middle)[:, None]
    half = math.hypot(
        scipy.special.stdtrit(len(fits) - 2, _LEVEL) * math.sqrt(scatter), NORMAL_95 * np.linalg.norm(b @ pulled)
    )
    return SensorLag(lag=lag, half=half, omega=middle, speeds=(float(speeds.min()), float(speeds.max())))


_FREE = 10.0  # standard deviation of what nothing is known of [rad]
_EACH = (0.01, 0.01, 0.15, 0.15)  # n0, n1, loss (as a share of it), sharpness: from record to record of one engine
# standard deviation about the exponent to expect, known to 0.06 for mixture or air; a record alone allows for more
_EXPONENT = 0.03
_ROUNDS, _TURN = 5, 2 * math.pi
_LAG = (sum(USUAL) / 2, (USUAL[1] - USUAL[0]) / (2 * NORMAL_95))


@record
class EncoderRecord:
    """One record among several of one encoder and sensor."""

    angle: np.ndarray  #: shape (n,): Ascending angles, compression in one piece, turns as in the other records [rad]
    mean: np.ndarray  #: shape (n,): Measured pressure of the mean cycle [Pa]
    omega: float  #: Mean speed [rad/s]
    motored: bool  #: Nothing burns in it
    spread: float  #: How far its angles may be off that were spread evenly over each turn, else 0 [rad]


@record
class SharedCentre:
    """The dead centre of several records, and what each takes from it."""

    centre: DeadCentre  #: At their mean speed
    records: tuple[DeadCentre, ...]  #: Of each: the lag of the sensor moves it with the speed
    priors: tuple[Prior, ...]  #: What all together say of the charge line of each


def shared_centre(
    records: Sequence[EncoderRecord], cylinder: Chamber, between: tuple[Radian, Radian], prior: Prior
) -> SharedCentre:
    r"""Dead centre of several records.

    .. math:: x = (\varphi, x_1, .., x_K), \quad (P^{-1} + \Lambda)\,x = P^{-1} m + b

    records: of one engine, encoder and sensor, at any loads and speeds. between: ends of the compression line from the
    dead centre. prior: of the exponent and the form of the losses; how large these are is expected by size and speed.

    x_k: dead centre, n0, n1, loss and sharpness of record k; Lambda and b: what its samples say of them, offset, level
    and drift free; m and P: middle and covariance of what is known before, which holds the records together.
    """
    omega = np.array([one.omega for one in records])
    prior = dataclasses.replace(prior, n0=(prior.n0[0], _EXPONENT))
    expected = expected_losses(cylinder, float(omega.mean()))
    priors = [prior] * len(records)
    heat, leak = (log_normal(of, of[0]) for of in expected)
    for _ in range(_ROUNDS):
        fits = [_fit(one, cylinder, between, p) for one, p in zip(records, priors, strict=True)]
        middle, known, shares = _before(records, fits, prior, heat, leak)
        data, pull = np.zeros_like(known), np.zeros_like(middle)
        for k, (fit, p) in enumerate(zip(fits, priors, strict=True)):
            at = slice(1 + 5 * k, 6 + 5 * k)
            data[at, at], pull[at] = information(fit, p)
        inverse = np.linalg.inv(known)
        covariance = np.linalg.inv(inverse + data)
        x = covariance @ (inverse @ middle + pull)
        moved = np.array([heat[0], leak[0]]) + shares @ inverse @ (x - middle)
        heat, leak = (log_normal(of, float(at)) for of, at in zip(expected, moved, strict=True))
        priors = [_prior(x[1 + 5 * k :][:5], np.diag(covariance)[1 + 5 * k :][:5]) for k in range(len(records))]
    share = float((covariance @ inverse @ covariance)[0, 0])
    return SharedCentre(
        centre=_told(x[0], covariance[0, 0], len(records), share),
        records=tuple(_told(x[1 + 5 * k], covariance[1 + 5 * k, 1 + 5 * k], len(records)) for k in range(len(records))),
        priors=tuple(priors),
    )


def _fit(one: EncoderRecord, cylinder: Chamber, between: tuple[float, float], prior: Prior) -> JointFit:
    if one.motored:
        return from_motored(one.angle, one.mean, cylinder, prior, "motored record")[1]
    return from_compression(one.angle, one.mean, cylinder, between, prior)[1]


def _before(
    records: Sequence[EncoderRecord], fits: Sequence[JointFit], prior: Prior, heat: tuple[float, float],
    leak: tuple[float, float],
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:  # fmt: skip
    """Middle and covariance of all values before the samples are looked at: what is shared, and what each has more."""
    omega = np.array([one.omega for one in records])
    level = np.array([fit.level for fit in fits])
    # dead centre, n0, n1, heat, leak, sharpness, lag
    shared = np.array([(records[0].angle.mean(), _FREE), prior.n0, prior.n1, heat, leak, prior.sharpness, _LAG])
    ways, own = [np.eye(7)[0][None]], [np.zeros(1)]
    for k, one in enumerate(records):
        by_heat, by_leak = by_state(omega[k] / omega.mean(), level[k] / level.mean())
        rows = np.zeros((5, 7))
        rows[0, 0], rows[0, 6] = 1.0, omega[k] - omega.mean()
        rows[1, 1] = rows[2, 2] = rows[4, 5] = 1.0
        rows[3, 3], rows[3, 4] = by_heat, by_leak
        loss = by_heat * heat[0] + by_leak * leak[0]
        ways.append(rows)
        own.append(np.array([max(one.spread / NORMAL_95, 1e-5), *_EACH]) * [1, 1, 1, loss, 1])
    way = np.vstack(ways)
    spread = np.diag(shared[:, 1] ** 2)
    known = way @ spread @ way.T + np.diag(np.maximum(np.concatenate(own), 1e-6) ** 2)
    return way @ shared[:, 0], known, (spread @ way.T)[3:5]


def _prior(values: np.ndarray, variances: np.ndarray) -> Prior:
    tdc, n0, n1, loss, sharpness = ((float(v), math.sqrt(s)) for v, s in zip(values, variances, strict=True))
    return Prior(n0=n0, n1=n1, loss=loss, sharpness=sharpness, tdc=tdc)


def _told(angle: float, variance: float, count: int, prior_variance: float | None = None) -> DeadCentre:
    spread = math.hypot(math.sqrt(variance), ENCODER)
    share = None if prior_variance is None else (prior_variance + ENCODER**2) / spread**2
    return interval(float(angle), spread, f"compression lines of {count} records", prior_share=share)


def encoder_records(diagrams: Sequence[Diagram], cylinder: Chamber, omega: RadPerSecond) -> list[EncoderRecord]:
    """The records of one encoder, each on the turn of the first one.

    diagrams: of one case, each with its file. omega: speed of files without times.
    """
    records: list[EncoderRecord] = []
    for diagram in diagrams:
        recording, angle, rows = sound_cycles(diagram.file, diagram, cylinder)
        alone = align(
            dataclasses.replace(diagram, motored="", alignment="compression_line"), cylinder, recording, angle, rows
        )
        at, mean = in_one_piece(angle, rows.mean(axis=0), period_of(diagram))
        turns = (
            0 if not records else round((peak_angle(at, mean) - peak_angle(records[0].angle, records[0].mean)) / _TURN)
        )
        speed = recorded_speed(recording)
        records.append(EncoderRecord(angle=at - turns * _TURN, mean=mean, omega=omega if speed is None else speed,
                                     motored=alone.motored, spread=alone.spread or 0.0))  # fmt: skip
    return records
