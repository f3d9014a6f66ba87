r"""Twist of a shaft in a run, section by section.

    [phi1]--k1,c1--[phi2]-- ... --[phi_f]

.. math:: v_i = \varphi_i - \varphi_{i+1}, \qquad M_i = k_i v_i + c_i \dot v_i

The window is the stretch at the end over which speeds are summed up; the peaks are those of the whole run.

`settling` says where an engine settles after a start, and whether a critical speed holds it there. Held means: the mean
speed stays at an order of a natural frequency although the same engine on a rigid shaft would settle elsewhere, for the
work that should raise the speed goes into the vibration.

Criticals of a crank train at its speed of operation, and what the linear shaft makes of every order there.

.. math:: (K - k^2\omega^2 \bar M + \mathrm{i} k \omega C)\,v_k = T_k, \qquad V_k = \max_i |M_{i,k}| / \max_i |R_{i,k}|

M_i are torques of the sections of the elastic shaft, R_i those of a rigid one; V is the magnification of an order.
"""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence

import numpy as np

from mechsym import mechanisms
from mechsym.mechanisms.shaft import ElasticShaft, elastic, matrices
from mechsym.plausible import Doubt, proportion
from mechsym.quantities import record
from mechsym.quantities.display import figure, quantity_text
from mechsym.quantities.records import Record
from mechsym.quantities.results import part, quantity, result
from mechsym.quantities.units import Metre, NewtonMetre, Pascal, Radian, RadPerSecond, Second
from mechsym.simulate import Result
from mechsym.simulate.result import extremes_of
from mechsym.torsion import modes as torsion


@result
class ShaftSection:
    """Twist of one section of a shaft."""

    section: str = part()  #: The two coordinates at its ends
    twist_mean: float = quantity("rad")  #: Over the window
    twist_amplitude: float = quantity("rad")  #: Half the swing over the window
    torque_mean: float = quantity("N*m")  #: Over the window
    torque_amplitude: float = quantity("N*m")  #: Half the swing over the window
    twist_peak: float = quantity("rad", card="twist of section")  #: Largest twist of the whole run, without its sign
    torque_peak: float = quantity("N*m")  #: Largest torque of the whole run, without its sign


def sections(shaft: ElasticShaft, result: Result, since: Second) -> tuple[ShaftSection, ...]:
    """Twist of the shaft's sections in a run, free end to flywheel. since: where the window begins."""
    return tuple(
        _section(result, pair, k, c, since)
        for pair, k, c in zip(pairs(result, len(shaft.k)), shaft.k, shaft.c, strict=True)
    )


def pairs(result: Result, count: int) -> list[tuple[str, str]]:
    """Coordinates at the ends of each section from the free end on. result: its first columns are coordinates."""
    names = list(result.columns)[: count + 1]
    return list(zip(names, names[1:], strict=False))


def section_words(place: int, count: int) -> str:
    """A section of the shaft in words: of so many, from the free end on.

    >>> section_words(0, 1), section_words(0, 2), section_words(1, 2)
    ('free end to flywheel', 'throw 1 to throw 2', 'throw 2 to flywheel')
    """
    if count == 1:
        return "free end to flywheel"
    return f"throw {place + 1} to {'flywheel' if place == count - 1 else f'throw {place + 2}'}"


def _section(result: Result, pair: tuple[str, str], k: float, c: float, since: Second) -> ShaftSection:
    a, b = pair

    def borne(columns: Mapping[str, np.ndarray]) -> np.ndarray:
        twist = columns[a] - columns[b]
        return np.array([twist, k * twist + c * (columns[f"{a}d"] - columns[f"{b}d"])])

    window = result.t >= since
    twist, torque = borne(result.columns)
    swings = np.ptp(extremes_of(result, borne, since), axis=0) / 2
    peaks = np.abs(extremes_of(result, borne)).max(axis=0)
    return ShaftSection(
        section=f"{a}-{b}",
        twist_mean=_mean(result.t[window], twist[window]),
        twist_amplitude=float(swings[0]),
        torque_mean=_mean(result.t[window], torque[window]),
        torque_amplitude=float(swings[1]),
        twist_peak=float(peaks[0]),
        torque_peak=float(peaks[1]),
    )


def _mean(t: np.ndarray, values: np.ndarray) -> float:
    return float(np.trapezoid(values, t) / (t[-1] - t[0])) if len(t) > 1 else float(values[-1])


def natural_frequencies(mechanism: str, parameters: Record) -> tuple[RadPerSecond, ...]:
    """Natural frequencies with the mean reciprocating inertia, without turning as a whole; none if rigid."""
    if elastic(mechanism, parameters) is None:
        return ()
    linear = matrices(mechanism, parameters)
    return tuple(torsion.modes(linear.inertia_mean, linear.stiffness).frequencies[1:].tolist())


_AT_CRITICAL = 0.02  # a mean speed this close to a critical one counts as being at it [-]
_ELSEWHERE = 0.02  # and this far from that of the rigid shaft it is not there by its own balance [-]
_STEADY = 2e-3  # change of the mean speed over the last tenth of the run that counts as settled [-]
_HIGHEST = 6  # orders above are too weak to hold an engine


@result
class Settling:
    """Mean speeds of a start, and what they meet."""

    speed_start: float = quantity("rad/s")  #: Over the first period
    speed_end: float = quantity("rad/s")  #: Over the last period
    settled: bool = part()
    speed_rigid: float | None = quantity("rad/s")  #: Steady speed of the same engine on a rigid shaft, if it has one
    passed: tuple[tuple[float, float], ...] = quantity("-, rad/s")  #: Order and critical speed of what it passed
    at: tuple[float, float] | None = quantity("-, rad/s")  #: Order and critical speed that it runs at, if any
    held: bool = part()


def settling(
    result: Result, coordinate: str, period: Radian, natural: tuple[RadPerSecond, ...], speed_rigid: RadPerSecond | None
) -> Settling:
    """Judge a finished start.

    period: of the gas; natural: natural frequencies of the shaft; speed_rigid: steady speed on a rigid shaft.
    """
    t, phi = result.t, result.columns[coordinate]
    edges = np.arange(phi[0], phi[-1] + 1e-9, period)
    speeds = period / np.diff(np.interp(edges, phi, t))
    first, last, before = speeds[0], speeds[-1], speeds[-1 - max(1, len(speeds) // 10)]
    step = 2 * np.pi / period
    criticals = [(k * step, f / (k * step)) for f in natural for k in range(1, int(_HIGHEST / step) + 1)]
    near = [c for c in criticals if abs(last / c[1] - 1) <= _AT_CRITICAL]
    at = min(near, key=lambda c: abs(last - c[1]), default=None)
    elsewhere = speed_rigid is None or bool(abs(last / speed_rigid - 1) > _ELSEWHERE)
    low, high = sorted((float(first), float(last)))
    passed = tuple(c for c in sorted(criticals, key=lambda c: c[1]) if low < c[1] < high and c != at)
    return Settling(
        speed_start=float(first),
        speed_end=float(last),
        settled=bool(abs(last / before - 1) < _STEADY),
        speed_rigid=speed_rigid,
        passed=passed,
        at=at,
        held=at is not None and elsewhere,
    )


def _speed(value: float) -> str:
    return quantity_text(value, "rad/s", 4)


def sentences(start: Settling) -> tuple[str, ...]:
    """What a reader of the run should know."""
    lines = [
        f"from {_speed(start.speed_start)} the engine {'settles at' if start.settled else 'has come to'} "
        f"{_speed(start.speed_end)}{'' if start.settled else ', which still changes'}"
    ]
    if start.speed_rigid is not None:
        lines.append(f"on a rigid shaft gas and load are in balance at {_speed(start.speed_rigid)}")
    lines += [f"order {order:g} at {_speed(speed)} is passed" for order, speed in start.passed]
    if start.at is None:
        lines.append("it runs at no critical speed")
    elif start.held:
        lines.append(f"order {start.at[0]:g} holds it at its critical speed of {_speed(start.at[1])}")
    else:
        lines.append(
            f"order {start.at[0]:g} has a critical speed of {_speed(start.at[1])}, within 2 % of where it runs: the "
            "balance of gas and load puts it there, the critical does not hold it, but it vibrates"
        )
    return tuple(lines)


_COUNT = 12  # orders above are too weak
_WEAK = 0.01  # of the largest order's torque on a rigid shaft; a weaker order is no critical
_NEAR = 0.05  # a critical speed so close to the speed of operation is run at
_SAME = 0.002  # what is nearer is critical at it
_RANGE = 0.2  # of the speed of operation, either way: the operating range where a case gives none


@record
class ShaftLimits:
    """What the sections of an elastic shaft can bear."""

    twist_limit: float = quantity("rad", default=0.1, above=0, high=10, about="largest twist of a section")
    diameter: float = quantity("m", default=0.0, low=0, high=5, about="smallest diameter; 0: the twist limit alone")
    shear_limit: float = quantity("Pa", default=2e8, above=0, high=2e9, about="shear at which the shaft yields")


@result
class CriticalOrder:
    """An order that meets a natural frequency within the operating range."""

    order: float = quantity("-")  #: Oscillations per turn
    speed: float = quantity("rad/s")  #: Where it is critical
    natural: float = quantity("rad/s")  #: Natural frequency that it meets there
    away: float = quantity("-")  #: Critical speed over the speed of operation, less 1
    #: Its amplitude in the worst section of a rigid shaft, at the speed of operation
    torque_rigid: float = quantity("N*m")
    torque: float = quantity("N*m")  #: The same of the elastic shaft, linear and steady
    magnification: float = quantity("-")  #: Quotient of the two


@result
class TrainVibration:
    """Torsional vibration of a crank train at its speed of operation."""

    omega: float = quantity("rad/s")  #: Speed of operation
    low: float = quantity("rad/s")  #: Least speed of the operating range
    high: float = quantity("rad/s")  #: Greatest speed of the operating range
    natural_bare: tuple[float, ...] = quantity("rad/s")  #: Natural frequencies without the reciprocating inertia
    natural: tuple[float, ...] = quantity("rad/s")  #: Natural frequencies with the mean reciprocating inertia
    criticals: tuple[CriticalOrder, ...] = part()  #: Within the operating range, the nearest first
    torque_rigid: float = quantity("N*m")  #: Half the swing of the worst section of a rigid shaft
    torque_amplitude: tuple[float, ...] = quantity("N*m")  #: Of each section, half the swing of the steady vibration
    twist_limit: tuple[float, ...] = quantity("rad")  #: Twist that each section can bear


@record
class _Response:
    order: np.ndarray  #: Oscillations per turn [-]
    #: shape (orders, sections): Complex amplitudes in the sections of the elastic and of a rigid shaft [N*m]
    elastic: np.ndarray
    rigid: np.ndarray


def vibration(
    name: str,
    parameters: Record,
    gas: Mapping[str, Callable[[np.ndarray], np.ndarray]],
    period: Radian,
    speeds: tuple[RadPerSecond, RadPerSecond, RadPerSecond],
    limits: ShaftLimits,
) -> TrainVibration:
    """Criticals and steady vibration of a mechanism on a shaft that twists, by its name and numbers.

    gas: input to its force over the shaft angle, ndarray (m,) to (m,) [N]; period: of the gas; speeds: speed of
    operation, lowest and highest speed of the operating range.
    """
    omega, low, high = speeds
    mechanism, bare = mechanisms.build(name, parameters), matrices(name, parameters)
    linear = torsion.matrices(mechanism)
    modes = torsion.modes(linear.mass, linear.stiffness)
    response = _response(linear, torsion.orders(mechanism, _COUNT, gas, period), omega)
    stiffness = -np.diag(bare.stiffness, 1)
    natural = modes.frequencies[1:]
    span = (low, high)
    rigid, elastic = (np.abs(a).max(axis=1) for a in (response.rigid, response.elastic))
    strong = rigid > _WEAK * rigid.max()
    rows = [
        CriticalOrder(
            order=float(k), speed=float(f / k), natural=float(f), away=float(f / k / omega - 1),
            torque_rigid=float(r), torque=float(e), magnification=float(e / r),
        )
        for k, r, e, counts in zip(response.order, rigid, elastic, strong, strict=True)
        for f in natural
        if counts and span[0] <= f / k <= span[1]
    ]  # fmt: skip
    return TrainVibration(
        omega=omega,
        low=low,
        high=high,
        natural_bare=tuple(torsion.modes(bare.inertia, bare.stiffness).frequencies[1:].tolist()),
        natural=tuple(modes.frequencies[1:].tolist()),
        criticals=tuple(sorted(rows, key=lambda c: abs(c.away))),
        torque_amplitude=tuple(_swing(response, response.elastic, period).tolist()),
        torque_rigid=float(_swing(response, response.rigid, period).max()),
        twist_limit=tuple(_limits(limits, stiffness).tolist()),
    )


def operating_range(
    omega: RadPerSecond, start: RadPerSecond | None, named: tuple[RadPerSecond, RadPerSecond] | None
) -> tuple[float, float, float]:
    """Speed of operation with its range [rad/s]: as named, lowest and highest, else a fifth either way."""
    if named is not None:
        return omega, *named
    low = (1 - _RANGE) * omega
    return omega, (min(low, start) if start else low), (1 + _RANGE) * omega


def _response(linear: torsion.Matrices, excitation: torsion.Orders, omega: float) -> _Response:
    elastic, rigid = [], []
    for k, inertia, gas in zip(excitation.order, excitation.inertia, excitation.gas, strict=True):
        force, w = inertia * omega**2 + gas, k * omega
        v = np.linalg.solve(linear.stiffness - w**2 * linear.mass + 1j * w * linear.damping, force)
        # what a section hands on is what the discs before it are pushed with and do not take themselves
        alone = force - linear.mass.sum(axis=1) * (force.sum() / linear.mass.sum())
        through = (linear.stiffness + 1j * w * linear.damping) @ v
        elastic.append(np.cumsum(through)[:-1])
        rigid.append(np.cumsum(alone)[:-1])
    return _Response(order=excitation.order, elastic=np.array(elastic), rigid=np.array(rigid))


def _swing(response: _Response, torque: np.ndarray, period: float) -> np.ndarray:
    """Half the swing of each section, of the amplitudes of its orders [N*m]."""
    phi = np.linspace(0.0, period, 1440, endpoint=False)
    turning = np.exp(1j * response.order[:, None] * phi)
    return np.ptp(np.real(torque.T @ turning), axis=1) / 2


def _limits(limits: ShaftLimits, stiffness: np.ndarray) -> np.ndarray:
    r"""Twist at which a section yields, :math:`\tau_y \pi d^3 / (16 k)`, but at most the limit given."""
    if not limits.diameter:
        return np.full(len(stiffness), limits.twist_limit)
    return np.minimum(limits.twist_limit, limits.shear_limit * np.pi * limits.diameter**3 / 16 / stiffness)


def words(train: TrainVibration) -> tuple[str, ...]:
    """What a reader of a crank train should know of its criticals."""
    bare, full = (", ".join(figure(f / math.tau, 4) for f in values) for values in (train.natural_bare, train.natural))
    lines = [f"natural frequency {bare} Hz bare, {full} Hz with the mean reciprocating inertia"]
    lines += map(critical_words, train.criticals)
    if not train.criticals:
        low, high = (quantity_text(speed, "rad/s", 4) for speed in (train.low, train.high))
        lines.append(f"no order is critical from {low} to {high}")
    return tuple(lines)


def critical_words(critical: CriticalOrder) -> str:
    """What a reader should know of one critical."""
    away, side = figure(round(100 * abs(critical.away), 1)), "above" if critical.away > 0 else "below"
    where = f"{away} % {side}" if abs(critical.away) >= _SAME else "at"
    at, carried = quantity_text(critical.speed, "rad/s", 4), quantity_text(critical.torque, "N*m", 4)
    return (
        f"order {critical.order:g} is critical at {at}, {where} the speed of operation: "
        f"there the shaft carries {carried} of it, {critical.magnification:.3g} times a rigid one's"
    )


def shaft_diameter(torque: NewtonMetre, shear: Pascal) -> Metre:
    r"""Diameter of a solid round shaft whose surface bears a shear stress, :math:`d = (16 M / (\pi \tau))^{1/3}`.

    Source: Timoshenko, Strength of Materials, torsion of a circular shaft. Valid: elastic, without notches.
    """
    return float(np.cbrt(16 * torque / (np.pi * shear)))


def twist_words(train: TrainVibration, twist: Sequence[ShaftSection], limits: ShaftLimits) -> tuple[str, ...]:
    """What a run says of the twist, and of the stress that it means for the shaft."""
    lines, yields = [], f"{quantity_text(limits.shear_limit, 'Pa', 3)} of shear"
    for place, section in enumerate(twist):
        peak, torque = quantity_text(section.twist_peak, "rad", 3), quantity_text(section.torque_peak, "N*m", 4)
        needed = shaft_diameter(section.torque_peak, limits.shear_limit)
        bears = f"a solid shaft of {quantity_text(needed, 'm', 3)} or more bears it with {yields}"
        if limits.diameter:
            stress = limits.shear_limit * (needed / limits.diameter) ** 3
            bears = f"{quantity_text(stress, 'Pa', 3)} of shear in the shaft, which yields at {yields}"
        lines.append(f"largest twist from {section_words(place, len(twist))} {peak}, shaft torque {torque}: {bears}")
    return (*lines, *(words for words, _ in beyond(train, twist)))


def beyond(train: TrainVibration, twist: Sequence[ShaftSection]) -> Iterator[tuple[str, Radian]]:
    """Sections of a shaft that a run twists further than they bear, in words, and by how much."""
    for place, (section, limit) in enumerate(zip(twist, train.twist_limit, strict=True)):
        if section.twist_peak > limit:
            peak, most = (quantity_text(angle, "rad", 3) for angle in (section.twist_peak, limit))
            where = section_words(place, len(twist))
            words = f"the model does not hold: the shaft from {where} twists by {peak}, it yields or breaks at {most}"
            yield words, section.twist_peak


def doubts(train: TrainVibration, twist: Sequence[ShaftSection] = ()) -> tuple[Doubt, ...]:
    """Criticals that swing the shaft at the speed of operation, and twist beyond what the shaft can bear."""
    raised: tuple[Doubt, ...] = ()
    for c in train.criticals:
        if abs(c.away) <= _NEAR:
            what = f"order {c.order:g}, critical at {quantity_text(c.speed, 'rad/s', 4)}: its torque at "
            what += f"{quantity_text(train.omega, 'rad/s', 4)} / the swing of a rigid shaft"
            raised += proportion("critical", what, c.torque / train.torque_rigid)
    for section, limit in zip(twist, train.twist_limit if twist else (), strict=True):
        if section.twist_peak > limit:
            why = "beyond it the shaft yields or breaks ([shaft] of the case); a linear spring is no model of it"
            raised += (Doubt(code="twist", quantity=f"twist_peak of {section.section}", value=section.twist_peak,
                           usual=f"at most {limit:.3g} rad", why=why),)  # fmt: skip
    return raised
