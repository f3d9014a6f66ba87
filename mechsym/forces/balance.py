r"""Counterweights and balancer shafts: what leaves the least force and couple on the frame.

A weight of unbalance `u` that turns `n` times as fast as the crank (`n < 0`: against it) pulls the frame with

.. math:: u\,n^2\omega^2\,e^{i(n\varphi + \alpha)}

at its place along the shaft. The force of the moving masses and their couple about the shaft's middle are sums of such
vectors too, one for each whole `n`, so each `n` is a problem of its own: weights at two places cancel force and couple
of their `n` together, and with one place, or weights that are too small for it, the least mean square is left, the
couple weighed as a force at half the length of the shaft. A pair of balancer shafts that stand one above the other
along the reference axis turns the frame about the crankshaft too: it can take the roll of its order.
"""

import cmath
import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from mechsym.errors import BadInput
from mechsym.forces.loads import roll_moment
from mechsym.forces.mains import Journal, MainShaft, influence, journals, place, supports
from mechsym.forces.turn import Turn, at, main_roles
from mechsym.quantities import record
from mechsym.quantities.units import Array, KilogramMetre, Metre, Newton, NewtonMetre

HIGHEST = 12  #: Order beyond which nothing is told
_ROUNDING = 1e-12  # of the unbalance of the largest throw
_DIRECTIONS = 24  # in which a load is held: the largest is overrated by at most 1/cos(pi/24), 0.9 %
_ANGLES = 240  # of a turn at which it is held


@record
class Weight:
    """A weight on the crankshaft or on a balancer shaft."""

    z: float  #: Place along the shaft [m]
    unbalance: float  #: Mass times radius [kg*m]
    angle: float  #: Where it stands at crank angle 0, in the crank's sense of rotation [rad]
    order: int  #: Its speed over the crank's, negative against it [-]
    x: float = 0.0  #: Place of its shaft along the reference axis, from the crankshaft or the middle of a pair [m]

    @property
    def vector(self) -> complex:
        """Unbalance at crank angle 0 [kg*m]."""
        return cmath.rect(self.unbalance, self.angle)


@record
class Shaken:
    """What shakes the frame at constant speed."""

    force: np.ndarray  #: shape (n,): x + iy [N]
    couple: np.ndarray  #: shape (n,): Of these forces about the shaft's middle, sum of z times force, x + iy [N*m]
    roll: np.ndarray | None  #: shape (n,): Moment about the shaft [N*m]; None where it is not told
    rounding: float  #: An unbalance that is not larger is none [kg*m]
    journals: tuple[Journal, ...]


@record
class BalancedEngine:
    """Forces and couples before and after, and what is hung on for it."""

    turn: Turn
    before: Shaken
    after: Shaken
    counterweights: tuple[Weight, ...]
    shafts: tuple[Weight, ...]


def balance(
    turn: Turn,
    weights: str = "ends",
    shafts: Sequence[int] = (),
    least: str = "frame",
    largest: KilogramMetre | None = None,
    settings: MainShaft | None = None,
    apart: Metre = 0.0,
) -> BalancedEngine:
    """Weights that leave the least force and couple on the frame, or the least peak of the main bearings.

    weights: places on the crankshaft: `ends`, the first and the last throw; `webs`, every throw; `none`. shafts: orders
    of the balancer shafts, a pair that turns both ways for each. least: `frame`, or `mains`: the counterweights are for
    the largest load of a main bearing, the shafts for the frame. largest: unbalance that one weight may have. apart:
    distance of the two shafts of a pair along the reference axis, the one above that leaves less roll. Raises BadInput:
    the mechanism does not tell its momentum, or `mains` is asked for where the places of the bearings are not known.
    """
    if not turn.momentum:
        raise BadInput(f"{turn.drive.name} does not tell its momentum; a mechanism with links of known mass does")
    settings, before = settings or MainShaft(), _shaken(turn, settings)
    on_crank: tuple[Weight, ...] = ()
    for n in _senses(turn) if weights != "none" else ():
        places = _places(turn, weights, n)
        on_crank += (
            _for_mains(turn, before, n, places, settings, largest)
            if least == "mains"
            else _weights(places, _solved(turn, before, n, places, largest), n, before)
        )
    turned_already = {one.order for one in on_crank}
    hung: tuple[Weight, ...] = ()
    for n in (n for k in shafts for n in (k, -k) if n not in turned_already):
        places = _places(turn, "ends", _senses(turn)[0])
        hung += _weights(places, _solved(turn, before, n, places, largest), n, before)
    hung = _above(turn, before, hung, apart)
    after = _with(turn, before, on_crank, hung, settings)
    return BalancedEngine(turn=turn, before=before, after=after, counterweights=on_crank, shafts=hung)


def amplitudes(values: Newton[Array], turn: Turn, rounding: Newton = 0.0) -> dict[float, Newton]:
    """|forwards| + |backwards| of each order of a force or couple.

    rounding: what is not larger is 0. Returns amplitudes: of all whole orders, and of those between that act: gears
    that close after several turns, and the gas of a four-stroke engine.
    """
    turns, sizes = round(turn.period / (2 * math.pi)), dict[float, float]()
    spectrum = np.abs(np.fft.fft(values)) / len(values)
    for k in range(1, HIGHEST * turns + 1):
        size = float(spectrum[k] + spectrum[-k])
        acts = size > rounding
        if acts or not k % turns:
            sizes[k / turns if k % turns else k // turns] = size if acts else 0.0
    return sizes


def part(values: Newton[Array], turn: Turn, n: int) -> complex:
    """The vector of a force or couple x + iy that turns n times as fast as the crank."""
    return complex(np.mean(values * np.exp(-1j * n * turn.phi)))


def middle(turn: Turn) -> float:
    """Middle of the shaft, about which couples are taken [m]."""
    z = [place(turn, role) for role in main_roles(turn)] or [0.0]
    return (min(z) + max(z)) / 2


def length(turn: Turn) -> float:
    """Length of the shaft between its outer throws, 1 m of a single one [m]."""
    z = [place(turn, role) for role in main_roles(turn)] or [0.0]
    return max(z) - min(z) or 1.0


def couple(turn: Turn) -> NewtonMetre[Array]:
    """Couple of the moving masses about the shaft's middle, sum of z times force as x + iy; 0 in one plane."""
    rates = turn.momentum
    about = next((name for name in ("rocking_rate", "angular_momentum_rate") if f"{name}_x" in rates), None)
    if about is None:
        return np.zeros(len(turn.phi), dtype=complex)
    # a force S at z has the moments -z S_y about the X axis and z S_x about Y
    about_zero = -(rates[f"{about}_y"] - 1j * rates[f"{about}_x"])
    return np.asarray(about_zero - middle(turn) * _force(turn))


def _force(turn: Turn) -> Array:
    return -(turn.momentum["momentum_rate_x"] + 1j * turn.momentum["momentum_rate_y"])


def _shaken(turn: Turn, settings: MainShaft | None) -> Shaken:
    idle = at(turn.drive, (), turn.omega, turn.phi, period=turn.period)
    sizes = [np.hypot(*(idle.reactions[name] for name in role.reactions)).max() for role in main_roles(turn)]
    force = _force(turn)
    rounding = _ROUNDING * max([*sizes, np.abs(force).max()]) / turn.omega**2
    return Shaken(
        force=force, couple=couple(turn), roll=roll_moment(turn), rounding=float(rounding),
        journals=journals(turn, settings),
    )  # fmt: skip


def _senses(turn: Turn) -> tuple[int, ...]:
    """Senses in which the cranks turn."""
    return tuple(sorted({int(role.sense) for role in main_roles(turn)}, reverse=True)) or (1,)


def _places(turn: Turn, weights: str, sense: int) -> tuple[float, ...]:
    """Where weights find room along a crankshaft [m]."""
    z = sorted({place(turn, role) for role in main_roles(turn, sense)}) or [0.0]
    return tuple(z) if weights == "webs" else tuple(sorted({z[0], z[-1]}))


def _frame(turn: Turn, shaken: Shaken, n: int, places: Sequence[float]) -> tuple[Array, Array]:
    """What unbalances at places do to the force and the couple of one speed, and what they should do."""
    z = np.array(places) - middle(turn)
    length = float(np.ptp(places)) / 2 or 1.0
    wanted = -np.array([part(shaken.force, turn, n), part(shaken.couple, turn, n) / length]) / (n * turn.omega) ** 2
    return np.array([np.ones(len(z)), z / length]), wanted


def _solved(turn: Turn, shaken: Shaken, n: int, places: Sequence[float], largest: float | None) -> Array:
    """Unbalances of one speed that leave the least mean square of its force and couple, shape (m,), complex [kg*m]."""
    matrix, wanted = _frame(turn, shaken, n, places)
    u = np.asarray(np.linalg.lstsq(matrix.astype(complex), wanted, rcond=None)[0])
    return u if largest is None or np.abs(u).max() <= largest else _bounded(matrix, wanted, largest)


def _weights(places: Sequence[float], u: Array, n: int, shaken: Shaken) -> tuple[Weight, ...]:
    """Those that are more than round-off of what shakes."""
    return tuple(
        Weight(z=float(z), unbalance=abs(one), angle=cmath.phase(one) % (2 * math.pi), order=n)
        for z, one in zip(places, u.tolist(), strict=True)
        if abs(one) > shaken.rounding
    )


def _bounded(matrix: Array, wanted: Array, largest: float) -> Array:
    """The same with none larger than allowed: a convex problem, solved from the scaled free weights on."""
    from scipy.optimize import minimize

    def vector(parts: Array) -> Array:
        return np.asarray(parts[: len(parts) // 2] + 1j * parts[len(parts) // 2 :])

    def left(parts: Array) -> float:
        return float(np.sum(np.abs(matrix @ vector(parts) - wanted / largest) ** 2))

    room = {"type": "ineq", "fun": lambda parts: 1 - np.abs(vector(parts)) ** 2}
    best = minimize(left, np.zeros(2 * matrix.shape[1]), constraints=[room], method="SLSQP", tol=1e-14)
    u = vector(best.x)
    return np.asarray(largest * u / np.maximum(1.0, np.abs(u)))


def _for_mains(
    turn: Turn, shaken: Shaken, n: int, places: Sequence[float], settings: MainShaft, largest: float | None
) -> tuple[Weight, ...]:
    """Of the weights that leave the frame the least, the least peak of a main bearing, by a linear programme."""
    from scipy.optimize import linprog

    held = [one for one in shaken.journals if one.sense == n]
    if not held:
        raise BadInput(
            f"{turn.drive.name} does not say where its main bearings stand; give shaft.bearings, or z of two throws"
        )
    frame, shares, m = _frame(turn, shaken, n, places)[0], _shares_of(turn, settings, places, n), len(places)
    best_for_frame = _solved(turn, shaken, n, places, largest)
    some = slice(None, None, max(1, len(turn.phi) // _ANGLES))
    loads = np.array([one.x[some] + 1j * one.y[some] for one in held])
    scale = float(np.abs(loads).max())
    turning = np.exp(1j * n * turn.phi[some])
    rows, right = [], []
    for seen in np.exp(-2j * math.pi * np.arange(_DIRECTIONS) / _DIRECTIONS):
        pull = (shares[:, None, :] * (turning * seen)[None, :, None]).reshape(-1, m)
        rows.append(np.hstack([pull.real, -pull.imag, -np.ones((len(pull), 1))]))
        right.append(-(loads * seen).real.ravel() / scale)
        if largest is not None:
            rows.append(np.hstack([seen.real * np.eye(m), -seen.imag * np.eye(m), np.zeros((m, 1))]))
            right.append(np.full(m, largest * turn.omega**2 / scale * math.cos(math.pi / _DIRECTIONS)))
    none = np.zeros_like(frame)
    kept = np.block([[frame, none, np.zeros((2, 1))], [none, frame, np.zeros((2, 1))]])
    force = frame @ best_for_frame * turn.omega**2 / scale
    best = linprog(
        np.r_[np.zeros(2 * m), 1.0], np.vstack(rows), np.concatenate(right), kept, np.r_[force.real, force.imag],
        bounds=[*[(None, None)] * 2 * m, (0, None)],
    )  # fmt: skip
    # where the frame leaves no choice, rounding may have it that there is none at all
    u = (best.x[:m] + 1j * best.x[m:-1]) * scale / turn.omega**2 if best.status == 0 else best_for_frame
    return _weights(places, u, n, shaken)


def _shares_of(turn: Turn, settings: MainShaft, places: Sequence[float], sense: int) -> Array:
    """What of a force at each place goes to each journal of a shaft: shape (journals, places) [-]."""
    stands = supports([place(turn, role) for role in main_roles(turn, sense)], settings.bearings)
    return influence(turn, settings, stands, np.array(places))


def _above(turn: Turn, shaken: Shaken, hung: Sequence[Weight], apart: Metre) -> tuple[Weight, ...]:
    """Both shafts of each pair at their places, so that its moment about the crankshaft is against the roll."""
    if not apart or shaken.roll is None:
        return tuple(hung)
    placed: tuple[Weight, ...] = ()
    for k in sorted({abs(one.order) for one in hung}):
        pair = [one for one in hung if abs(one.order) == k]
        ways = [tuple(replace(one, x=math.copysign(apart / 2, side * one.order)) for one in pair) for side in (1, -1)]
        placed += min(ways, key=lambda way: abs(part(shaken.roll + _roll(turn, way), turn, k)))
    return placed


def _roll(turn: Turn, weights: Sequence[Weight]) -> NewtonMetre[Array]:
    """Moment of weights about the crankshaft."""
    return sum((one.x * _pull(turn, one).imag for one in weights), np.zeros_like(turn.phi))


def _pull(turn: Turn, one: Weight) -> Newton[Array]:
    """Force of a weight on the frame, x + iy."""
    return np.asarray(one.vector * (one.order * turn.omega) ** 2 * np.exp(1j * one.order * turn.phi))


def _with(
    turn: Turn, shaken: Shaken, on_crank: Sequence[Weight], hung: Sequence[Weight], settings: MainShaft
) -> Shaken:
    """What shakes the frame with weights; those on the crankshaft load its bearings."""
    force, turned, held = shaken.force, shaken.couple, list(shaken.journals)
    for one in (*on_crank, *hung):
        pull = _pull(turn, one)
        force, turned = force + pull, turned + (one.z - middle(turn)) * pull
        own = [i for i, journal in enumerate(held) if journal.sense == one.order and one in on_crank]
        shares = _shares_of(turn, settings, [one.z], one.order)[:, 0] if own else ()
        for i, share in zip(own, shares, strict=True):
            held[i] = replace(held[i], x=held[i].x + share * pull.real, y=held[i].y + share * pull.imag)
    roll = None if shaken.roll is None else shaken.roll + _roll(turn, hung)
    return Shaken(force=force, couple=turned, roll=roll, rounding=shaken.rounding, journals=tuple(held))
