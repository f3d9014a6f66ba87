"""Measured records with a known dead centre: the first law integrated with heat loss and blow-by, then a poor sensor.

Shares no code and no model with `mechsym.cycle.measured`: heat capacities that rise with temperature, three laws of
heat transfer, an orifice for the rings, burning, a charge trapped at any temperature; the sensor adds offset, slow
drift, the swing of its heated membrane, a first-order lag, noise. All arrays are (engines, cycles) or (engines, 1).
"""

import dataclasses
import math

import numpy as np

DEG = math.pi / 180
CLOSES, OPENS, STEP = -125 * DEG, 115 * DEG, 0.5 * DEG


@dataclasses.dataclass
class Engines:
    """Many engines side by side; every value is an array of shape (engines, 1) or (engines, cycles), SI units."""

    bore: np.ndarray
    stroke: np.ndarray
    rod: np.ndarray
    ratio: np.ndarray
    omega: np.ndarray
    p_closed: np.ndarray
    t_closed: np.ndarray
    wall: np.ndarray
    cv0: np.ndarray  # c_v / R = cv0 + cv1 T/1000
    cv1: np.ndarray
    law: np.ndarray  # 0 Woschni, 1 Annand, 2 Eichelberg
    heat: np.ndarray  # factor on the law
    leak: np.ndarray  # orifice area by piston area [-]
    burn_start: np.ndarray
    burn_length: np.ndarray
    burn_heat: np.ndarray  # by the energy that the charge has when the inlet closes
    evaporation: np.ndarray  # heat that fuel droplets take during compression, by the same energy

    def take(self, index):
        return Engines(**{f.name: getattr(self, f.name)[index] for f in dataclasses.fields(self)})


def volume(e, phi):
    r = e.stroke / 2
    x = r * (1 - np.cos(phi)) + e.rod - np.sqrt(e.rod**2 - (r * np.sin(phi)) ** 2)
    return math.pi / 4 * e.bore**2 * (e.stroke / (e.ratio - 1) + x)


def _slope(e, phi, by=1e-5):
    return (volume(e, phi + by) - volume(e, phi - by)) / (2 * by)


def _energy(e, t):
    return 287.0 * (e.cv0 * t + e.cv1 * t**2 / 2000)


def _temperature(e, u):
    # c_v linear in T: the energy is a parabola
    a, b, c = e.cv1 / 2000, e.cv0, -u / 287.0
    return (-b + np.sqrt(b**2 - 4 * a * c)) / (2 * a)


def _flux(e, p, t):
    speed = e.stroke * e.omega / math.pi
    woschni = 3.26 * e.bore**-0.2 * (p / 1e3) ** 0.8 * t**-0.55 * (2.28 * speed) ** 0.8
    density, mu = p / (287.0 * t), 4.4e-7 * t**0.65
    annand = 0.5 * 1.35 * 1020 * mu / e.bore * (density * speed * e.bore / mu) ** 0.7
    eichelberg = 7.8e-3 * 1e3 * speed ** (1 / 3) * np.sqrt(p / 1e5 * t / 10.0) / 3.0
    return e.heat * np.choose(e.law, [woschni, annand, eichelberg]) * (t - e.wall)


def _leakage(e, p, t, outside=1.0e5):
    ratio = np.clip(np.minimum(p, outside) / np.maximum(p, outside), 0.528, 1.0)
    psi = np.sqrt(np.maximum(2 * 1.4 / 0.4 * (ratio ** (2 / 1.4) - ratio ** (2.4 / 1.4)), 0.0))
    area = e.leak * math.pi / 4 * e.bore**2
    return np.sign(p - outside) * area * np.maximum(p, outside) / np.sqrt(287.0 * t) * psi


def closed_period(e):
    """Angles (m,) and pressure (engines, cycles, m) from the closing of the inlet to the opening of the exhaust."""
    phi = np.arange(CLOSES, OPENS + STEP / 2, STEP)
    mass = e.p_closed * volume(e, CLOSES) / (287.0 * e.t_closed)
    total = mass * _energy(e, e.t_closed)
    fuel = e.burn_heat * total

    def rates(at, state):
        m, u = state
        t = _temperature(e, u / m)
        v = volume(e, at)
        p = m * 287.0 * t / v
        y = np.maximum(at - e.burn_start, 0.0) / e.burn_length
        burning = fuel * 6.9 * 3 * y**2 / e.burn_length * np.exp(-6.9 * y**3)
        drying = (
            e.evaporation
            * total
            * np.exp(-0.5 * ((at + 75 * DEG) / (22 * DEG)) ** 2)
            / (22 * DEG * math.sqrt(2 * math.pi))
        )
        walls = math.pi * e.bore**2 / 2 * 1.15 + 4 * v / e.bore
        lost = _leakage(e, p, t)
        enthalpy = _energy(e, t) + 287.0 * t
        du = burning - drying - p * _slope(e, at) - (_flux(e, p, t) * walls + lost * enthalpy) / e.omega
        return np.array([-lost / e.omega, du]), p

    state, pressures = np.array(np.broadcast_arrays(mass, total)), []
    for at in phi:
        k1, p = rates(at, state)
        pressures.append(p)
        k2, _ = rates(at + STEP / 2, state + STEP / 2 * k1)
        k3, _ = rates(at + STEP / 2, state + STEP / 2 * k2)
        k4, _ = rates(at + STEP, state + STEP * k3)
        state = state + STEP / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    return phi, np.moveaxis(np.array(pressures), 0, -1)


def whole_cycle(e, inlet, exhaust):
    """Angles (n,) from -360 to 360 degrees and pressure (engines, cycles, n) of a four-stroke."""
    phi, p = closed_period(e)
    every = np.arange(-360, 360, STEP / DEG) * DEG
    result = np.empty((*p.shape[:-1], every.size))
    inside = (every > CLOSES - STEP / 2) & (every < OPENS + STEP / 2)
    result[..., inside] = p[..., : int(inside.sum())]
    before, behind = every < CLOSES - STEP / 2, every > OPENS + STEP / 2
    rise = np.exp((every[before] - CLOSES) / (10 * DEG))
    trapped = p[..., :1]
    early = inlet + (trapped - inlet) * rise
    overlap = 0.5 * (1 + np.tanh((every[before] + 345 * DEG) / (6 * DEG)))
    result[..., before] = exhaust + (early - exhaust) * overlap
    fall = np.exp(-(every[behind] - OPENS) / (18 * DEG))
    result[..., behind] = exhaust + (p[..., -1:] - exhaust) * fall
    return every, result


def sensed(signal, omega, lag, membrane):
    """The signal behind a first-order lag [s], less the share `membrane` of the slow swing of a heated membrane."""
    turns = signal.shape[-1]
    order = np.fft.rfftfreq(turns, 1 / turns) / 2  # per crank turn of a four-stroke
    spectrum = np.fft.rfft(signal, axis=-1)
    shape = (slice(None),) * (signal.ndim - 1) + (None,)
    jw = 1j * order * (omega * np.ones(signal.shape[:-1]))[shape]
    delay = 1 / (1 + jw * (lag * np.ones(signal.shape[:-1]))[shape])
    heated = np.fft.irfft(spectrum / (1 + jw / omega[shape] / 0.4), turns, axis=-1)
    mean = signal.mean(axis=-1, keepdims=True)
    return np.fft.irfft(spectrum * delay, turns, axis=-1) - membrane[shape] * (heated - mean)


def drawn(rng, engines, cycles):
    """Engines of very different kind: petrol and diesel, 50 to 300 mm, one to many cycles that differ in burning."""

    def one(low, high):
        return rng.uniform(low, high, (engines, 1))

    def about(middle, factor):
        return middle * np.exp(math.log(factor) * rng.standard_normal((engines, 1)))

    petrol = rng.random((engines, 1)) < 0.65
    bore = np.where(petrol, one(0.05, 0.1), one(0.07, 0.3))
    stroke = bore * one(0.8, 1.5)
    each = (engines, cycles)
    return Engines(
        bore=bore,
        stroke=stroke,
        rod=stroke / 2 * one(3.0, 4.4),
        ratio=np.where(petrol, one(7.5, 12.5), one(13.0, 18.0)),
        omega=math.pi / stroke * one(4.0, 12.0),
        p_closed=np.where(petrol, one(0.45e5, 1.1e5), one(1.0e5, 2.5e5)) * (1 + 0.01 * rng.standard_normal(each)),
        t_closed=one(310.0, 390.0),
        wall=one(370.0, 480.0),
        cv0=np.where(petrol, one(2.35, 2.9), one(2.28, 2.36)),
        cv1=np.where(petrol, one(0.7, 0.95), one(0.6, 0.75)),
        law=rng.integers(0, 3, (engines, 1)),
        heat=about(1.5, 1.7),
        leak=about(1e-4, 2.2) * (0.07 / bore),
        burn_start=np.where(petrol, one(-22.0, 3.0), one(-12.0, 5.0)) * DEG,
        burn_length=one(35.0, 70.0) * DEG * (1 + 0.08 * rng.standard_normal(each)),
        burn_heat=one(3.0, 7.0) * (1 + 0.05 * rng.standard_normal(each)),
        evaporation=np.where(petrol, one(0.0, 0.1), 0.0),
    )


@dataclasses.dataclass
class Records:
    """What sensor and encoder make of the engines, and what is true."""

    engines: Engines
    file_angle: np.ndarray  # (n,) ascending angles of the file [rad]
    rows: np.ndarray  # (engines, cycles, n) measured pressure [Pa]
    dead_centre: np.ndarray  # (engines,) where the true one lies on the angles of the file, with the sensor's lag [rad]
    ratio: np.ndarray  # (engines,) compression ratio of the data sheet [-]
    lag: np.ndarray  # (engines,) lag of the sensor [s]
    noise: np.ndarray  # (engines,) deviation of white noise that says as much as that of the mean cycle [Pa]


LAG, DRIFT, MEMBRANE, ENCODER, SHEET = 0.3 * DEG, 0.01, 0.01, 0.4 * DEG, 0.02


def records(rng, engines, cycles, fired=True, faster=1.0, longest=LAG):
    """Records of very different quality with everything that spoils them.

    `faster` is every cycle's factor on the speed, `longest` the longest lag at factor 1 [rad].
    """
    e = drawn(rng, engines, cycles)
    base, e = e.omega, dataclasses.replace(e, omega=e.omega * faster)
    if not fired:
        e = dataclasses.replace(e, burn_heat=0 * e.burn_heat)
    phi, p = whole_cycle(e, (0.97 * e.p_closed.mean(axis=1, keepdims=True))[..., None], 1.1e5)
    each, swing = (engines, cycles), np.ptp(p, axis=-1).mean(axis=1)[:, None, None]
    lag = rng.uniform(0, longest, (engines, 1))
    y = sensed(
        p,
        np.broadcast_to(e.omega, each),
        lag / base,
        np.broadcast_to(MEMBRANE * abs(rng.standard_normal((engines, 1))), each),
    )
    y = y + swing * (
        DRIFT * rng.standard_normal((engines, 1, 1)) * phi / (4 * math.pi)
        + rng.uniform(-0.2, 1.0, (engines, cycles, 1))
    )
    size, kept = 0.002 * np.exp(0.6 * rng.standard_normal((engines, 1, 1))), rng.uniform(0, 0.6, (engines, 1, 1))
    white = rng.standard_normal(y.shape)
    for k in range(1, y.shape[-1]):
        white[..., k] = kept[..., 0] * white[..., k - 1] + np.sqrt(1 - kept[..., 0] ** 2) * white[..., k]
    y = y + size * swing * white
    # an eccentric encoder: the file's angle errs once a turn; the dead centre is where the true one stands in the file
    by, where = ENCODER * abs(rng.standard_normal(engines)), rng.uniform(0, 2 * math.pi, engines)
    file_angle = phi[::2]
    true = file_angle - (by[:, None] * np.sin(file_angle + where[:, None]))
    rows = np.array([[np.interp(t, phi, row) for row in record] for t, record in zip(true, y, strict=True)])
    spread = (size * swing * np.sqrt((1 + kept) / (1 - kept)) / math.sqrt(cycles))[:, 0, 0]
    return Records(
        engines=e,
        file_angle=file_angle,
        rows=rows,
        dead_centre=by * np.sin(where) + lag[:, 0],
        ratio=e.ratio[:, 0] * (1 + SHEET * rng.standard_normal(engines)),
        lag=(lag / base)[:, 0],
        noise=spread,
    )


def bound(r, between):
    """Deviation of the dead centre below which no unbiased method gets, given how the records were drawn [rad].

    The Bayesian information matrix: slopes of the simulated record between two angles, by all that is not known, over
    its noise, and the spread with which each was drawn; dead centre, offset and level are free.
    """
    single = {f.name: getattr(r.engines, f.name)[:, :1] for f in dataclasses.fields(Engines)}
    base = Engines(**single)
    steps = {
        "p_closed": (0.01 * base.p_closed, math.inf), "t_closed": (2.0, 23.0), "wall": (5.0, 32.0), "cv0": (0.02, 0.16),
        "cv1": (0.02, 0.07), "heat": (0.05 * base.heat, 0.53 * base.heat), "leak": (0.1 * base.leak, 0.79 * base.leak),
        "evaporation": (0.005, 0.029), "ratio": (0.01 * base.ratio, SHEET * base.ratio),
    }  # fmt: skip
    phi, p = closed_period(base)
    inside = (phi > between[0]) & (phi < between[1])
    swing = np.ptp(p, axis=-1)
    columns, tight = [np.gradient(p[:, 0], phi, axis=-1), np.ones_like(p[:, 0])], [0 * swing, 0 * swing]
    for name, (by, drawn_with) in steps.items():
        moved = dataclasses.replace(base, **{name: getattr(base, name) + by})
        columns.append((closed_period(moved)[1][:, 0] - p[:, 0]) / by)
        tight.append(1 / drawn_with * np.ones_like(swing))
    membrane = np.cumsum(p[:, 0] - p[:, 0].mean(axis=-1, keepdims=True), axis=-1) * STEP * 0.4
    waves = (np.sin(phi) * columns[0], (np.cos(phi) - 1) * columns[0])
    for column, drawn_with in (
        (phi * swing, DRIFT / (4 * math.pi)),
        (membrane, MEMBRANE),
        *((w, ENCODER / 1.4) for w in waves),
    ):
        columns.append(column)
        tight.append(1 / drawn_with * np.ones_like(swing))
    found = []
    for k in range(len(swing)):
        slopes = (
            np.array([c[k][inside] for c in columns]).T / r.noise[k] / math.sqrt(2)
        )  # the file has half the samples
        prior = np.diag([float(np.ravel(t[k])[0]) for t in tight])
        whole = np.vstack([slopes, prior])
        size = np.linalg.norm(whole, axis=0)
        inverse = np.linalg.inv((whole / size).T @ (whole / size))
        found.append(math.sqrt(inverse[0, 0]) / size[0])
    return np.array(found)


@dataclasses.dataclass
class EncoderRecords:
    """Records of one engine with one encoder and one sensor, each at a speed and a load of its own."""

    engines: list[Engines]  # of one engine and many cycles each
    file_angle: np.ndarray  # (n,) ascending angles of every file [rad]
    rows: list[np.ndarray]  # (cycles, n) measured pressure of each record [Pa]
    dead_centre: np.ndarray  # (records,) of each: the sensor's lag moves it with the speed [rad]
    pressures: list[np.ndarray]  # (n,) what the mean cycle of each really was, over the true angle `file_angle` [Pa]


def encoder_records(rng, cycles, speeds=(0.5, 0.75, 1.0, 1.3), of=100):
    """Records of one engine and encoder at several speeds; the noise of `cycles` says as much as that of `of`."""
    e = drawn(rng, 1, cycles)
    lag, membrane = rng.uniform(0, LAG) / e.omega[0, 0], MEMBRANE * abs(rng.standard_normal())
    by, where = ENCODER * abs(rng.standard_normal()), rng.uniform(0, 2 * math.pi)
    size = 0.002 * math.exp(0.6 * rng.standard_normal()) * math.sqrt(cycles / of)
    made = EncoderRecords([], np.array([]), [], np.array([]), [])
    for factor in speeds:
        each = dataclasses.replace(
            e,
            omega=e.omega * factor,
            p_closed=e.p_closed * rng.uniform(0.55, 1.0),
            t_closed=e.t_closed + rng.uniform(-10, 10),
            burn_start=e.burn_start + rng.uniform(-4, 4) * DEG,
            burn_length=e.burn_length * (1 + 0.08 * rng.standard_normal((1, cycles))),
        )
        phi, p = whole_cycle(each, (0.97 * each.p_closed.mean(axis=1, keepdims=True))[..., None], 1.1e5)
        swing = float(np.ptp(p, axis=-1).mean())
        y = sensed(p, np.broadcast_to(each.omega, (1, cycles)), np.full((1, 1), lag), np.full((1, cycles), membrane))
        y = y + swing * (
            DRIFT * rng.standard_normal() * phi / (4 * math.pi)
            + rng.uniform(-0.2, 1.0, (1, cycles, 1))
            + size * rng.standard_normal(y.shape)
        )
        made.file_angle = phi[::2]
        true = made.file_angle - by * np.sin(made.file_angle + where)
        made.engines.append(each)
        made.rows.append(np.array([np.interp(true, phi, row) for row in y[0]]))
        made.pressures.append(p[0].mean(axis=0)[::2])
        made.dead_centre = np.append(made.dead_centre, by * math.sin(where) + lag * float(each.omega[0, 0]))
    return made
