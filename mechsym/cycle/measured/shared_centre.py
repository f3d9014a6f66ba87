r"""One dead centre for several records of one encoder: what their charge lines say together.

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

from mechsym.cycle.chamber import Chamber
from mechsym.cycle.measured.alignment import align, in_one_piece, sound_cycles
from mechsym.cycle.measured.dead_centre import ENCODER, DeadCentre, from_compression, from_motored, interval, peak_angle
from mechsym.cycle.measured.diagram import Diagram, period_of
from mechsym.cycle.measured.joint_fit import JointFit, Prior, information
from mechsym.cycle.measured.lag import USUAL
from mechsym.cycle.measured.losses import by_state, expected_losses, log_normal
from mechsym.cycle.measured.timing import recorded_speed
from mechsym.quantities import record
from mechsym.quantities.units import Radian, RadPerSecond

_FREE = 10.0  # standard deviation of what nothing is known of [rad]
_EACH = (0.01, 0.01, 0.15, 0.15)  # n0, n1, loss (as a share of it), sharpness: from record to record of one engine
# standard deviation about the exponent to expect, known to 0.06 for mixture or air; a record alone allows for more
_EXPONENT = 0.03
_ROUNDS, _TURN = 5, 2 * math.pi
_LAG = (sum(USUAL) / 2, (USUAL[1] - USUAL[0]) / (2 * 1.96))


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
        own.append(np.array([max(one.spread / 1.96, 1e-5), *_EACH]) * [1, 1, 1, loss, 1])
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
        alone = align(dataclasses.replace(diagram, motored="", alignment="compression_line"), cylinder, recording,
                      angle, rows)  # fmt: skip
        at, mean = in_one_piece(angle, rows.mean(axis=0), period_of(diagram))
        turns = (
            0 if not records else round((peak_angle(at, mean) - peak_angle(records[0].angle, records[0].mean)) / _TURN)
        )
        speed = recorded_speed(recording)
        records.append(EncoderRecord(angle=at - turns * _TURN, mean=mean, omega=omega if speed is None else speed,
                                     motored=alone.motored, spread=alone.spread or 0.0))  # fmt: skip
    return records
