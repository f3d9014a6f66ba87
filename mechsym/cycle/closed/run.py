r"""The closed period integrated through its three phases, at many operating points side by side, its accuracy audited.

The engine's differential equation is integrated with steps that are fixed beforehand, in a variable in which it is
smooth: the result is then a differentiable function of every parameter, and all speeds run through the same
operations. Accuracy is checked afterwards (first law), and steps are added where it is wanting.

Source of the method: Cooper and Verner (1972), "Some explicit Runge-Kutta methods of high order", SIAM J. Numer. Anal.
9; eleven stages, order 8, nodes of the Lobatto quadrature.

Each phase runs over its own variable s from 0 to 1; during combustion phi = phi_s + dphi s^4, because a Wiebe function
with a broken exponent is not smooth at its start in phi, but is nearly so in s. `closed_function` is one differentiable
CasADi function, which also feeds the optimiser; `closed_map` takes the same operations through compiled lanes, which
pays for many designs.

Every point goes through the same operations, so a whole performance map costs one call. The first law of the closed
period is then checked for each point by itself; where the residual is not below the tolerance the steps are doubled.
"""

import functools
from collections.abc import Callable, Mapping, Sequence

import casadi as ca
import numpy as np
import scipy

from mechsym.cycle.closed.equations import PHASES, SCALARS, Build, Closed, pressure, rates, scalars
from mechsym.errors import BadInput
from mechsym.native import compiled_all
from mechsym.native.march import Method, folder
from mechsym.quantities import RPM, record
from mechsym.quantities.units import Array, Kelvin, Pascal, Pure, Radian, Scalar

_S = 21**0.5
_A: tuple[dict[int, float], ...] = (
    {},
    {0: 1 / 2},
    {0: 1 / 4, 1: 1 / 4},
    {0: 1 / 7, 1: (-7 - 3 * _S) / 98, 2: (21 + 5 * _S) / 49},
    {0: (11 + _S) / 84, 2: (18 + 4 * _S) / 63, 3: (21 - _S) / 252},
    {0: (5 + _S) / 48, 2: (9 + _S) / 36, 3: (-231 + 14 * _S) / 360, 4: (63 - 7 * _S) / 80},
    {0: (10 - _S) / 42, 2: (-432 + 92 * _S) / 315, 3: (633 - 145 * _S) / 90, 4: (-504 + 115 * _S) / 70,
     5: (63 - 13 * _S) / 35},
    {0: 1 / 14, 4: (14 - 3 * _S) / 126, 5: (13 - 3 * _S) / 63, 6: 1 / 9},
    {0: 1 / 32, 4: (91 - 21 * _S) / 576, 5: 11 / 72, 6: (-385 - 75 * _S) / 1152, 7: (63 + 13 * _S) / 128},
    {0: 1 / 14, 4: 1 / 9, 5: (-733 - 147 * _S) / 2205, 6: (515 + 111 * _S) / 504, 7: (-51 - 11 * _S) / 56,
     8: (132 + 28 * _S) / 245},
    {4: (-42 + 7 * _S) / 18, 5: (-18 + 28 * _S) / 45, 6: (-273 - 53 * _S) / 72, 7: (301 + 53 * _S) / 72,
     8: (28 - 28 * _S) / 45, 9: (49 - 7 * _S) / 18},
)  # fmt: skip
_B = {0: 1 / 20, 7: 49 / 180, 8: 16 / 45, 9: 49 / 180, 10: 1 / 20}
METHOD = Method(rows=_A, weights=_B)


def step(rate: Callable[[Scalar, Scalar], Scalar], s: Pure[Scalar], y: Scalar, ds: Pure[Scalar]) -> Scalar:
    """One step of the method.

    s: independent variable at the start; y: state at the start [unit of the state]; ds: length of the step. Returns y:
    state at s + ds, shape (n,) [unit of the state].
    """
    slopes: list[Scalar] = []
    for row in METHOD.rows:
        shifted = y + ds * sum((a * slopes[j] for j, a in row.items()), 0 * y) if row else y
        slopes.append(rate(s + sum(row.values()) * ds, shifted))
    return y + ds * sum((b * slopes[j] for j, b in METHOD.weights.items()), 0 * y)


def fold(rate: ca.Function, steps: int) -> ca.Function:
    """Integration over s from 0 to 1: (y at 0, z) -> y at the ends of equal steps, shape (states, steps)."""
    s, y, z = (ca.SX.sym(name, rate.numel_in(i)) for i, name in enumerate("syz"))
    one = ca.Function("step", [y, s, z], [step(lambda s, y: rate(s, y, z), s, y, 1 / steps)])
    start, data = ca.MX.sym("y", rate.numel_in(1)), ca.MX.sym("z", rate.numel_in(2))
    starts = ca.DM([k / steps for k in range(steps)]).T
    history = one.mapaccum("steps", steps)(start, starts, ca.repmat(data, 1, steps))
    return ca.Function("fold", [start, data], [history])


_SHARES = {"before": 0.3, "during": 0.4, "after": 0.3}  # shares of the steps; combustion is short but steep
GRADING = {"before": 1, "during": 4, "after": 1}
NODES = ("phi", "t", "p", "dt_dphi", "dp_dphi")

Map = Callable[[np.ndarray, int], Mapping[str, np.ndarray]]


@record
class _Parts:
    """The functions of a phase of the design z: slope of the state over s, and the node at a state."""

    rate: ca.Function
    node: ca.Function


def closed_function(build: Build, names: Sequence[str], steps: int) -> ca.Function:
    """The closed period as a function of a design.

    build: callable, mapping of the design's names to CasADi symbols -> Closed. steps: steps of the integration in all;
    a multiple of 10.

    Returns function: (design (k,)) -> the nodes `phi` [rad], `t` [K], `p` [Pa], `dt_dphi` [K/rad], `dp_dphi` [Pa/rad],
    each (1, steps + 3), the two angles where phases meet standing twice; and the scalars `work`, `wall_heat` [J] and
    the entries of `SCALARS`.
    """
    start, parts, books = _functions(build, tuple(names))
    design = ca.MX.sym("design", len(names))
    state = start(design)
    nodes = []
    for phase in PHASES:
        n = steps_of(phase, steps)
        history = ca.horzcat(state, fold(parts[phase].rate, n)(state, design))
        s = ca.DM(np.arange(n + 1) / n).T
        nodes.append(parts[phase].node(ca.repmat(design, 1, n + 1), s, history))
        state = history[:, -1]
    outputs = [*ca.vertsplit(ca.horzcat(*nodes)), state[1], state[2], *ca.vertsplit(books(design, state[0]))]
    return ca.Function("closed", [design], outputs, ["design"], [*NODES, "work", "wall_heat", *SCALARS])


def closed_map(build: Build, names: Sequence[str]) -> Map:
    """The closed period at many designs, compiled where there is a compiler.

    Returns map: designs (k, n) and the number of steps -> what `closed_function` gives, by name, designs along the
    first axis.
    """
    start, parts, books = _functions(build, tuple(names))
    folds = {phase: folder(parts[phase].rate, METHOD) for phase in PHASES}
    nodes = compiled_all({phase: parts[phase].node for phase in PHASES})

    def run(designs: np.ndarray, steps: int) -> dict[str, np.ndarray]:
        state, rows = np.array(start(designs)), []
        for phase in PHASES:
            history = np.concatenate([state[None], folds[phase](state, designs, steps_of(phase, steps))])
            # nodes at all states, shape (nodes, steps + 1, designs)
            count, _, n = history.shape
            s = np.repeat(np.arange(count) / (count - 1), n)
            states = history.transpose(1, 0, 2).reshape(history.shape[1], -1)
            rows.append(nodes[phase].batch(*np.tile(designs, count), s, *states).reshape(-1, count, n))
            state = history[-1]
        curves = dict(zip(NODES, np.concatenate(rows, axis=1).transpose(0, 2, 1), strict=True))
        sums = dict(zip(("work", "wall_heat"), state[1:, :, None], strict=True))
        return curves | sums | dict(zip(SCALARS, np.array(books(designs, state[:1]))[:, :, None], strict=True))

    return run


def steps_of(phase: str, steps: int) -> int:
    """Steps of a phase out of all."""
    return round(_SHARES[phase] * steps)


@functools.lru_cache(maxsize=8)
def _functions(build: Build, names: tuple[str, ...]) -> tuple[ca.Function, dict[str, _Parts], ca.Function]:
    """State at the start, the phases, and the scalars, as functions of the design."""
    z, t = ca.SX.sym("z", len(names)), ca.SX.sym("t")
    closed = build({name: z[k] for k, name in enumerate(names)})
    start = ca.Function("start", [z], [ca.vertcat(closed.temperature, 0.0, 0.0)])
    parts = {phase: _Parts(rate=_rate(closed, phase, z), node=_node(closed, phase, z)) for phase in PHASES}
    return start, parts, ca.Function("scalars", [z, t], [ca.vertcat(*scalars(closed, t))])


def _span(closed: Closed, phase: str, s: Scalar) -> tuple[Scalar, Scalar]:
    ends = closed.starts + closed.duration
    first, last = {
        "before": (closed.closes, closed.starts),
        "during": (closed.starts, ends),
        "after": (ends, closed.opens),
    }[phase]
    power = GRADING[phase]
    return first + (last - first) * s**power, (last - first) * power * s ** (power - 1)


def _rate(closed: Closed, phase: str, z: Scalar) -> ca.Function:
    s, phi, y = ca.SX.sym("s"), ca.SX.sym("phi"), ca.SX.sym("y", 3)
    slope = ca.Function("slope", [phi, y, z], [ca.vertcat(*rates(closed, phase, phi, y[0]))])
    here, ds = _span(closed, phase, s)
    return ca.Function(f"rate_{phase}", [s, y, z], [slope(here, y, z) * ds])


def _node(closed: Closed, phase: str, z: Scalar) -> ca.Function:
    s, y, phi = ca.SX.sym("s"), ca.SX.sym("y", 3), ca.SX.sym("phi")
    p = pressure(closed, phase, phi, y[0])
    dt = rates(closed, phase, phi, y[0])[0]
    dp = ca.jacobian(p, phi) + ca.jacobian(p, y[0]) * dt
    at_phi = ca.Function("at_phi", [z, phi, y], [ca.vertcat(phi, y[0], p, dt, dp)])
    return ca.Function(f"node_{phase}", [z, s, y], [at_phi(z, _span(closed, phase, s)[0], y)])


_STEPS, _MOST_STEPS = 120, 7680
MANY = 100  # points for which it pays to compile, or to read what is compiled
_SAME = 1e-12  # angles closer than this are one [rad]
TOLERANCE = 1e-10  # first-law residual of a cycle over the fuel's energy
FINE, _DEGREE = 480, 7  # steps of a period whose curves are wanted, and the degree of the splines through them


@record
class ClosedRun:
    """The closed period at n operating points."""

    #: shape (n, k): crank angle from firing top dead centre [rad]; angles where the equations change stand twice
    phi: np.ndarray
    t: np.ndarray  #: shape (n, k): temperature [K]
    p: np.ndarray  #: shape (n, k): pressure [Pa]
    dt_dphi: np.ndarray  #: shape (n, k) [K/rad]
    dp_dphi: np.ndarray  #: shape (n, k) [Pa/rad]
    scalars: Mapping[str, np.ndarray]  #: shape (n,): `work`, `wall_heat` and the entries of `closed.SCALARS`
    residual: np.ndarray  #: shape (n,): First law: (change of energy - heat + losses + work)/heat released [-]


def run(build: Build, design: Mapping[str, Scalar], steps: int = _STEPS) -> ClosedRun:
    """Integrate the closed period at every operating point.

    build: callable, mapping of names to values -> Closed, for example `model.closed_period` with its engine bound.
    design: mapping of str to ndarray, shape (n,), values of the design at the n points; numbers are repeated. steps:
    steps to begin with, a multiple of 10. Returns run: all points with one number of steps, the smallest that closes
    the first law everywhere.
    """
    names = list(design)
    values = np.array(np.broadcast_arrays(*(np.atleast_1d(np.asarray(design[n], float)) for n in names)))
    while True:
        result = _run(build, tuple(names), values, steps)
        check_phases(result.scalars)
        worst = np.max(np.abs(result.residual))
        if worst < TOLERANCE:
            return result
        if not np.isfinite(worst) or steps >= _MOST_STEPS:
            bad = int(np.argmax(~(np.abs(result.residual) < TOLERANCE)))
            raise BadInput(_not_closed(result, names, values, bad))
        steps *= 2


def steps_needed(build: Build, design: Mapping[str, Scalar]) -> tuple[Pure[Array], dict[int, str]]:
    """Steps with which each point closes the first law, and why others never do.

    design: mapping of str to ndarray, shape (n,), values of the design at the n points; numbers are repeated. Returns
    steps: 0 at points that have no cycle; reasons: why they have none, by index.
    """
    names = list(design)
    values = np.array(np.broadcast_arrays(*(np.atleast_1d(np.asarray(design[n], float)) for n in names)))
    needed, open_, steps = np.zeros(values.shape[1], dtype=int), np.arange(values.shape[1]), _STEPS
    reasons: dict[int, str] = {}
    while open_.size:
        result = _run(build, tuple(names), values[:, open_], steps)
        faults = _phase_faults(result.scalars)
        size = np.abs(result.residual)
        hopeless = ~np.isfinite(size) | ((size >= TOLERANCE) & (steps >= _MOST_STEPS))
        faults |= {int(k): _not_closed(result, names, values[:, open_], int(k)) for k in np.flatnonzero(hopeless)
                   if k not in faults}  # fmt: skip
        reasons |= {int(open_[k]): reason for k, reason in faults.items()}
        closed = (size < TOLERANCE) & ~np.isin(np.arange(open_.size), list(faults))
        needed[open_[closed]] = steps
        open_ = np.setdiff1d(open_[~closed], list(reasons))
        steps *= 2
    return needed, reasons


def check_phases(scalars: Mapping[str, np.ndarray]) -> None:
    """Refuse points at which combustion does not fit. scalars: `omega` [rad/s], `closes`, `starts`, `ends`, `opens`."""
    for reason in _phase_faults(scalars).values():
        raise BadInput(reason)


def _phase_faults(scalars: Mapping[str, np.ndarray]) -> dict[int, str]:
    """Points at which combustion does not fit, and why."""
    closes, starts, ends, opens = (scalars[k] for k in ("closes", "starts", "ends", "opens"))
    faults: dict[int, str] = {}
    for angle, bound, bad, reason in (
        (starts, closes, starts <= closes, "ignition is before the inlet closes"),
        (starts, opens, starts >= opens, "ignition is after the exhaust opens"),
        (ends, starts, ends <= starts, "the end of combustion is not after its start"),
        (ends, opens, ends > opens, "combustion ends after the exhaust opens"),
    ):
        for k in np.flatnonzero(bad):
            at, limit = np.degrees(angle[k]), np.degrees(bound[k])
            faults.setdefault(
                int(k),
                f"{reason}: {at:.2f} deg against {limit:.2f} deg from firing TDC at "
                f"{scalars['omega'][k] / RPM:.5g} rpm; change ignition or duration",
            )
    return faults


def dense(result: ClosedRun, parts: int = 4) -> tuple[Radian[Array], Pascal[Array], Kelvin[Array]]:
    """Pressure and temperature at the nodes and between them, by cubic Hermite polynomials; every angle stands once.

    result: the closed period at n points; parts: parts that each step is cut into. Returns phi: crank angle, shape (n,
    k); p: pressure, shape (n, k); t: temperature, shape (n, k).
    """
    u = np.arange(parts) / parts
    h = np.diff(result.phi, axis=1)[..., None]
    phi = _close(result.phi[:, :-1, None] + u * h, result.phi)
    once = np.append(np.any(np.diff(phi, axis=1) > _SAME, axis=0), True)
    p, t = _hermite(result.p, result.dp_dphi, h, u), _hermite(result.t, result.dt_dphi, h, u)
    return phi[:, once], p[:, once], t[:, once]


@record
class _PhaseCurves:
    #: Where it begins and ends [rad]
    first: float
    last: float
    power: int  #: phi = first + (last - first) s**power [-]
    spline: Callable[[np.ndarray], np.ndarray]  #: s (n,) to pressure [Pa] and temperature [K], shape (n, 2)


@record
class ClosedCurves:
    """Pressure and temperature of one closed period over the angle, smooth from event to event."""

    phases: tuple[_PhaseCurves, ...]  #: One behind the other; none without length

    def at(self, phi: Radian[Array]) -> tuple[Pascal[Array], Kelvin[Array]]:
        """Pressure and temperature; where two phases meet that of the later, outside those of the nearest."""
        of = np.searchsorted([phase.first for phase in self.phases[1:]], phi, side="right")
        values = np.empty((2, *np.shape(phi)))
        for k, phase in enumerate(self.phases):
            share = (phi[of == k] - phase.first) / (phase.last - phase.first)
            values[:, of == k] = phase.spline(np.clip(share, 0.0, 1.0) ** (1 / phase.power)).T
        return values[0], values[1]

    def even(self, step: Radian) -> tuple[Radian[Array], Pascal[Array], Kelvin[Array]]:
        """Even angles from inlet closing to exhaust opening, and pressure and temperature there."""
        first, last = self.phases[0].first, self.phases[-1].last
        phi = np.linspace(first, last, round((last - first) / step) + 1)
        return phi, *self.at(phi)


def closed_curves(result: ClosedRun) -> ClosedCurves:
    """The curves of the first point, by splines of degree 7 in the variable in which a phase is smooth.

    With `FINE` steps they are off by less than 1e-8 of their peak; cubics between nodes and across events were by 1e-3.
    """
    steps, at, phases = result.phi.shape[1] - len(PHASES), 0, []
    for phase in PHASES:
        n = steps_of(phase, steps)
        phi, values = result.phi[0, at : at + n + 1], np.stack([result.p, result.t], axis=-1)[0, at : at + n + 1]
        at += n + 1
        if phi[-1] - phi[0] > _SAME:
            spline = scipy.interpolate.make_interp_spline(np.arange(n + 1) / n, values, k=_DEGREE)
            phases.append(_PhaseCurves(first=phi[0], last=phi[-1], power=GRADING[phase], spline=spline))
    return ClosedCurves(phases=tuple(phases))


def _run(build: Build, names: tuple[str, ...], values: np.ndarray, steps: int) -> ClosedRun:
    outputs = _mapped(build, names)(values, steps) if values.shape[1] >= MANY else _called(build, names, values, steps)
    scalars = {k: v[:, 0] for k, v in outputs.items() if k not in NODES}
    gain = scalars["energy_end"] - scalars["energy_start"] + scalars["work"] + scalars["wall_heat"]
    with np.errstate(divide="ignore", invalid="ignore"):  # where nothing burns, `run` refuses
        residual = (gain - scalars["heat_released"] - scalars["fuel_energy"]) / scalars["heat_released"]
    return ClosedRun(**{k: outputs[k] for k in NODES}, scalars=scalars, residual=residual)


def _called(build: Build, names: tuple[str, ...], values: np.ndarray, steps: int) -> dict[str, np.ndarray]:
    outputs = _function(build, names, steps).call({"design": values})
    return {k: np.asarray(v).reshape(values.shape[1], -1) for k, v in outputs.items()}


@functools.lru_cache(maxsize=8)
def _mapped(build: Build, names: tuple[str, ...]) -> Map:
    return closed_map(build, names)


@functools.lru_cache(maxsize=8)
def _function(build: Build, names: tuple[str, ...], steps: int) -> ca.Function:
    # searches call `run` again and again with one `build`; making the function costs more than evaluating it
    return closed_function(build, names, steps)


def _not_closed(result: ClosedRun, names: list[str], values: np.ndarray, k: int) -> str:
    point = ", ".join(f"{name} = {value:.5g}" for name, value in zip(names, values[:, k], strict=True))
    return (f"the cycle does not converge at {point}: first-law residual {result.residual[k]:.2g} of the heat released "
            f"with {_MOST_STEPS} steps; very low speeds lose all heat to the walls, raise the speed")  # fmt: skip


def _hermite(y: np.ndarray, slope: np.ndarray, h: np.ndarray, u: np.ndarray) -> np.ndarray:
    y0, y1, d0, d1 = (a[..., None] for a in (y[:, :-1], y[:, 1:], slope[:, :-1], slope[:, 1:]))
    rise = y1 - y0
    bend = u * (1 - u) * ((1 - u) * (d0 * h - rise) - u * (d1 * h - rise))
    return _close(y0 + u * rise + bend, y)


def _close(inner: np.ndarray, nodes: np.ndarray) -> np.ndarray:
    return np.concatenate([inner.reshape(nodes.shape[0], -1), nodes[:, -1:]], axis=1)
