r"""The closed period integrated through its three phases, for numbers and for CasADi expressions alike.

Each phase runs over its own variable s from 0 to 1; during combustion phi = phi_s + dphi s^4, because a Wiebe function
with a broken exponent is not smooth at its start in phi, but is nearly so in s. `closed_function` is one differentiable
CasADi function, which also feeds the optimiser; `closed_map` takes the same operations through compiled lanes, which
pays for many designs.
"""

import functools
from collections.abc import Callable, Mapping, Sequence

import casadi as ca
import numpy as np

from mechsym.cycle.closed.equations import PHASES, SCALARS, Build, Closed, pressure, rates, scalars
from mechsym.cycle.closed.runge_kutta import METHOD, fold
from mechsym.native import compiled_all
from mechsym.native.fold import folder
from mechsym.quantities import record
from mechsym.quantities.units import Scalar

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

    Returns
    -------
    function : casadi.Function
        (design (k,)) -> the nodes `phi` [rad], `t` [K], `p` [Pa], `dt_dphi` [K/rad], `dp_dphi` [Pa/rad], each
        (1, steps + 3), the two angles where phases meet standing twice; and the scalars `work`, `wall_heat` [J] and
        the entries of `SCALARS`
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
        state, found = np.array(start(designs)), []
        for phase in PHASES:
            history = np.concatenate([state[None], folds[phase](state, designs, steps_of(phase, steps))])
            found.append(_nodes(nodes[phase].batch, designs, history))
            state = history[-1]
        curves = dict(zip(NODES, np.concatenate(found, axis=1).transpose(0, 2, 1), strict=True))
        sums = dict(zip(("work", "wall_heat"), state[1:, :, None], strict=True))
        return curves | sums | dict(zip(SCALARS, np.array(books(designs, state[:1]))[:, :, None], strict=True))

    return run


def _nodes(batch: Callable[..., np.ndarray], designs: np.ndarray, history: np.ndarray) -> np.ndarray:
    """Nodes at all states, shape (nodes, steps + 1, designs)."""
    count, _, n = history.shape
    s = np.repeat(np.arange(count) / (count - 1), n)
    states = history.transpose(1, 0, 2).reshape(history.shape[1], -1)
    return batch(*np.tile(designs, count), s, *states).reshape(-1, count, n)


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
