"""What no method can know of the records of `simulated_engine.encoder_records`: bounds with the simulator itself known.

A Bayesian information matrix for each set of four records: slopes of the sampled pressure by all that was drawn, over
the noise, and the spread with which each was drawn. Dead centre, offset and level of each record are free. Only the
values are unknown, never the model: heat capacities, law of heat, form of the swing are taken as they are made.
"""

import dataclasses
import math

import numpy as np
import scipy
from simulated_engine import DEG, DRIFT, ENCODER, LAG, MEMBRANE, Engines, drawn, whole_cycle

SPEEDS = (0.5, 0.75, 1.0, 1.3)
LINE, INLET, EXHAUST = (-90, -15), (-190, -170), (240, 300)  # degrees
_NEARLY_KNOWN = 1e-9
# by how much each value of the gas is moved for its slope, its spread, whether the four records share it
_GAS = {
    "wall": (5.0, 32.0, True), "cv0": (0.02, 0.16, True), "cv1": (0.02, 0.07, True),
    "evaporation": (0.005, 0.029, True), "t_closed": (2.0, 23.0, True),
}  # fmt: skip
_FACTORS = {"heat": (0.05, 0.53, True), "leak": (0.1, 0.79, True), "p_closed": (0.01, math.inf, False)}


@dataclasses.dataclass
class Bound:
    """Root mean squares over the sets, and the share of them that a normal error of that size has within the limits."""

    knows: str
    centre_rms: float  # [deg]
    centre_within: float  # 0.2 deg
    pressure_rms: float
    pressure_within: float  # 1.5 %

    def __str__(self) -> str:
        return (
            f"{self.knows}: {self.centre_rms:.3f} deg, {100 * self.centre_within:.0f} % within 0.2 deg; "
            f"{100 * self.pressure_rms:.2f} % of pressure, {100 * self.pressure_within:.0f} % within 1.5 %"
        )


def information_table(seeds):
    """Bounds for what is read of a record, from the compression line alone to all that a user can measure beside."""
    slopes = _Slopes(seeds)
    cases = {
        "compression line": {},
        "and a cycle that closes": {"closes": True},
        "and the pressures of inlet and exhaust to 1 kPa": {"closes": True, "known": 1e3},
        "and an even encoder": {"closes": True, "known": 1e3, "even": True},
    }
    return [_bound(name, slopes.deviations(**what)) for name, what in cases.items()]


def _bound(name, deviations):
    centre, pressure = (np.array(of) for of in zip(*deviations, strict=True))

    def within(limit, deviation):
        return float(scipy.special.erf(limit / deviation / math.sqrt(2)).mean())

    return Bound(name, float(np.sqrt(np.mean(centre**2))), within(0.2, centre),
                 float(np.sqrt(np.mean(pressure**2))), within(0.015, pressure))  # fmt: skip


def _engines(seeds):
    """Engines of a first cycle, four of each set as `encoder_records` draws them, and the noise of their mean cycles.

    The deviation of the noise is by the swing, of a hundred cycles, half a degree apart.
    """
    every, noise = [], []
    for seed in seeds:
        rng = np.random.default_rng(seed)
        e, size = drawn(rng, 1, 1), 0.0002 * math.exp(0.6 * rng.standard_normal())
        for factor in SPEEDS:
            every.append(
                dataclasses.replace(
                    e,
                    omega=e.omega * factor,
                    p_closed=e.p_closed * rng.uniform(0.55, 1.0),
                    t_closed=e.t_closed + rng.uniform(-10, 10),
                    burn_start=e.burn_start + rng.uniform(-4, 4) * DEG,
                )
            )
            noise.append([size])
    names = [f.name for f in dataclasses.fields(Engines)]
    return Engines(**{name: np.vstack([getattr(e, name) for e in every]) for name in names}), np.array(noise)


class _Slopes:
    """Slopes of records by what is not known, one in each row of each array, four rows a set."""

    def __init__(self, seeds):
        e, noise = _engines(seeds)
        self.phi, self.p = _cycle(e)
        self.swing, step = np.ptp(self.p, axis=1)[:, None], self.phi[1] - self.phi[0]
        self.noise = noise * self.swing
        self.rise = np.gradient(self.p, step, axis=1)
        self.by_omega = e.omega / np.repeat(e.omega.reshape(-1, 4).mean(axis=1), 4)[:, None] - 1
        order = np.fft.rfftfreq(self.phi.size, 1 / self.phi.size) / 2
        heated = np.fft.irfft(np.fft.rfft(self.p) / (1 + 1j * order / 0.4), self.phi.size)
        self.heated = heated - heated.mean(axis=1, keepdims=True)
        self.gas = []
        moves = {name: (by, by, *rest) for name, (by, *rest) in _GAS.items()}
        moves |= {name: (by * getattr(e, name), by, *rest) for name, (by, *rest) in _FACTORS.items()}
        for name, (move, by, spread, shared) in moves.items():
            slope = (_cycle(dataclasses.replace(e, **{name: getattr(e, name) + move}))[1] - self.p) / by
            self.gas.append((slope, spread, shared))
            if name == "t_closed":  # from record to record
                self.gas.append((slope, 5.8, False))
        self.area = self._travel(e) / e.stroke
        self.mean_pressure = (self.p * self.area).sum(axis=1, keepdims=True)

    def _travel(self, e):
        r = e.stroke / 2
        return r * np.sin(self.phi) * (1 + r * np.cos(self.phi) / np.sqrt(e.rod**2 - (r * np.sin(self.phi)) ** 2))

    def deviations(self, closes=False, known=None, even=False):
        """Of every set the standard deviations of dead centre [deg] and, for each record, net mean pressure [-]."""
        phi, nothing = self.phi, np.zeros_like(self.p)
        degrees = phi / DEG
        line, inlet, exhaust = ((degrees > a) & (degrees < b) for a, b in (LINE, INLET, EXHAUST))
        mask = line if known is None else line | inlet | exhaust
        slow = self.swing * phi / (4 * math.pi)
        # slope of the record, spread, whether shared, and what an error in it adds to the pressure that is worked out
        rows = [
            (self.rise, math.inf, True, self.rise),
            (self.rise * self.by_omega, LAG / math.sqrt(12), True, self.rise * self.by_omega),
            *(
                (self.rise * wave, _NEARLY_KNOWN if even else ENCODER / math.sqrt(2), True, self.rise * wave)
                for wave in (np.cos(phi) - 1, np.sin(phi))
            ),
            (-self.heated, MEMBRANE * 0.603, True, -self.heated),  # of half a normal distribution
            (slow, _NEARLY_KNOWN if closes else DRIFT, False, slow),
            (self.swing * np.ones_like(phi), math.inf, False, nothing),
            *((slope, spread, shared, nothing) for slope, spread, shared in self.gas),
        ]
        if known is not None:
            rows += [(np.ones_like(self.p) * where, known, False, nothing) for where in (inlet, exhaust)]
        return [self._deviations(rows, mask, slice(first, first + 4)) for first in range(0, len(self.p), 4)]

    def _deviations(self, rows, mask, at):
        columns, prior, work = [], [], []
        for slope, spread, shared, error in rows:
            each = slope[at, mask] / (self.noise[at] * math.sqrt(2))  # the file has half the samples
            gain = ((error * self.area).sum(axis=1) / self.mean_pressure[:, 0])[at]
            for k in [slice(None)] if shared else [slice(i, i + 1) for i in range(len(each))]:
                column, share = np.zeros_like(each), np.zeros(len(each))
                column[k], share[k] = each[k], gain[k]
                columns.append(column.ravel())
                prior.append(0.0 if math.isinf(spread) else 1 / spread)
                work.append(share)
        whole = np.vstack([np.array(columns).T, np.diag(prior)])
        size = np.linalg.norm(whole, axis=0)
        covariance = np.linalg.inv((whole / size).T @ (whole / size)) / np.outer(size, size)
        spread = np.sqrt(np.einsum("ik,ij,jk->k", work, covariance, work))
        return math.sqrt(covariance[0, 0]) / DEG, spread


def _cycle(e):
    phi, p = whole_cycle(e, (0.97 * e.p_closed)[..., None], 1.1e5)
    return phi, p[:, 0]
