r"""Equations of a mechanism with stops and friction, in every mode by one function.

    y = (q, u, work of each part, loss of each friction, dissipation, guards),   w = (values held, flags of the mode)

Each stop and each friction acts through an input of its own, p; along it the speed is v = W^T u, W = dQ/dp. A mode says
by two flags of each, K and D, which condition holds:

.. math:: K_i\,\dot v_i + (1 - K_i)\,(p_i - f_i(p)) = 0,\qquad M \ddot q + h = Q + W p

Where loops close by constraint, \ddot q = T a + c with the accelerations a of the coordinates that are free; which
they are may change where the run comes near a dead point of them (the last guard is the logarithm of the determinant).

A closed stop and a friction that sticks have K = 1; one that slides has f = -D \mu(v) N(p) r, N made of reactions,
which p itself changes: Newton's method solves for all at once. Guards are what a change of mode is seen by; they are
integrated beside the motion, so that the integrator ends a step where one is zero.
"""

from functools import lru_cache

import casadi as ca
import numpy as np

from mechsym.errors import BadInput
from mechsym.mechanisms import loops
from mechsym.mechanisms.amounts import amount
from mechsym.mechanisms.record import velocities
from mechsym.mechanisms.roles import FrictionRole, StopRole
from mechsym.quantities import record
from mechsym.simulate.equations import RUBS, System, outer_values, part_values, power
from mechsym.simulate.problem import Periodic, Problem

_NEWTON = 5  # steps for normal forces of pins; from frictionless, digits double in each
_TINY = 1e-30  # under the root of a normal force [N^2]


@record
class Numbers:
    """A stop or a friction with its numbers."""

    role: StopRole | FrictionRole
    sizes: dict[str, float]  #: [SI]
    contact: int = -1  #: Of a friction that a stop presses: which one


@record
class Model:
    """The equations in every mode, and what is to be seen of a state."""

    system: System
    elements: tuple[Numbers, ...]
    base: int  #: Columns before the guards
    places: tuple[int, ...]  #: Of each element's first guard, behind the base
    dips: bool  #: Whether the last guard of a stop that gives way to none is the rate of its force
    holds: bool  #: Whether all friction acts on one freedom, which it may hold at rest
    #: (t, y, w) to p, v, dv/dt, limit of each, guards, rate of each column, derivative of friction by p
    look: ca.Function
    #: q to mass matrix, W, the velocities that impulses along W change, and W of the free coordinates
    blow: ca.Function
    pose: ca.Function  #: Coordinates and velocities put on the closure of the loops
    dependents: tuple[str, ...]  #: Coordinates that the loops hold
    margin: int | None  #: The guard that tells how far they are from a dead point


_RANGES = {"restitution": (0, 1), "stiffness": (0, np.inf), "damping": (0, np.inf), "mu_s": (0, np.inf),
           "mu_k": (0, np.inf), "stribeck": (0, np.inf), "viscous": (0, np.inf), "radius": (0, np.inf),
           "smoothing": (0, np.inf), "normal": (0, np.inf)}  # fmt: skip


def numbers(problem: Problem) -> tuple[Numbers, ...]:
    """Stops and friction of a problem with their numbers.

    Raises BadInput: a number is outside its range.
    """
    elements = []
    for role in problem.unilateral:
        texts = {k: getattr(role, k) for k in (*_RANGES, "speed") if getattr(role, k, None) is not None}
        sizes = {k: float(amount(text, problem.mechanism.parameters)) for k, text in texts.items()}
        for key, value in sizes.items():
            low, high = _RANGES.get(key, (-np.inf, np.inf))
            if not low <= value <= high:
                why = f"{key} = {value:g} of {role.name} ({texts[key]}) is outside {low:g} to {high:g}"
                raise BadInput(f"{why}; correct the parameter")
        if sizes.get("mu_s", 0.0) < sizes.get("mu_k", 0.0):
            why = f"{role.name} sticks less than it slides: mu = ({sizes['mu_s']:g}, {sizes['mu_k']:g})"
            raise BadInput(f"{why}; the first is that of sticking")
        names = [r.name for r in problem.unilateral]
        contact = names.index(role.contact) if isinstance(role, FrictionRole) and role.contact else -1
        elements.append(Numbers(role=role, sizes=sizes, contact=contact))
    return tuple(elements)


class _Letters:
    """Letters of the equations."""

    def __init__(self, problem: Problem, elements: tuple[Numbers, ...], dependents: tuple[str, ...]) -> None:
        mechanism, n, m = problem.mechanism, len(problem.mechanism.coordinates), len(elements)
        self.t, self.q, self.u, self.p = ca.SX.sym("t"), ca.SX.sym("q", n), ca.SX.sym("u", n), ca.SX.sym("p", m)
        self.outer = outer_values(problem)
        self.w = ca.SX.sym("w", len(self.outer) + 2 * m + 1)
        flags = self.w[len(self.outer) :]
        self.K, self.D, self.rest = flags[:m], flags[m : 2 * m], flags[2 * m]
        q, u = ca.vertsplit(self.q), ca.vertsplit(self.u)
        self.parts = part_values(problem, self.t, q, u, self.w)
        own = {e.role.force: self.p[i] for i, e in enumerate(elements)}
        self.inputs = [
            sum((v for part, v in self.parts if part.input == name), ca.SX(0)) + own.get(name, 0)
            for name in mechanism.inputs
        ]
        mass, bias, force = mechanism.functions["dynamics"](*q, *u, *self.inputs)
        self.mass, self.W = mass, ca.jacobian(force, self.p)
        free = ca.substitute(force, self.p, ca.SX.zeros(m))
        self.free, held = loops.split(mechanism, dependents)
        T, c = loops.motion(mechanism, self.q, self.u[self.free], dependents)
        reduced, self.along_free = ca.mtimes(T.T, ca.mtimes(mass, T)), ca.mtimes(T.T, self.W)
        push = ca.mtimes(T.T, free - bias - ca.mtimes(mass, c)) + ca.mtimes(self.along_free, self.p)
        self.a = ca.mtimes(T, ca.solve(reduced, push)) + c
        self.moved = ca.mtimes(T, ca.solve(reduced, self.along_free))
        self.margin = ca.SX(0, 1)
        if held:
            jacobian = mechanism.functions["constraints"](*q, *([0] * n))[1][:, held]
            self.margin = ca.log(ca.fabs(ca.det(jacobian)))
        self.v = ca.mtimes(self.W.T, self.u)
        self.v_rate = ca.jtimes(self.v, self.q, self.u) + ca.mtimes(self.W.T, self.a)
        names = list(dict.fromkeys(r for e in elements for r in getattr(e.role, "reactions", ())))
        borne: dict[str, ca.SX] = {}
        if names:
            reactions = mechanism.functions["reactions"]
            borne = dict(zip(reactions.name_out(), reactions(*q, *u, *ca.vertsplit(self.a), *self.inputs), strict=True))
        # what is linear in p, and letters that stand for it
        self.linear = ca.vertcat(self.v_rate, *(borne[name] for name in names))
        self.stand = ca.SX.sym("z", self.linear.shape)
        self.borne = {name: self.stand[m + k] for k, name in enumerate(names)}
        self.x, self.x_rate = ca.vertcat(self.q, self.u, self.t), ca.vertcat(self.u, self.a, 1)
        self.all = [self.p, self.t, self.q, self.u, self.w]


def _normal(one: Numbers, s: _Letters) -> ca.SX:
    """Force that presses a friction's faces together [N]."""
    if one.contact >= 0:
        return s.p[one.contact]
    if "normal" in one.sizes:
        return ca.SX(one.sizes["normal"])
    return ca.sqrt(sum((s.borne[r] ** 2 for r in getattr(one.role, "reactions", ())), ca.SX(0)) + _TINY)


def _laws(problem: Problem, elements: tuple[Numbers, ...], s: _Letters) -> tuple[ca.SX, ca.SX, ca.SX, ca.SX]:
    """Force of each law, that at the limit of sticking, the limit alone, and gaps; speeds in the laws are relative."""
    kinematics = problem.mechanism.functions["kinematics"]
    gaps = dict(zip(kinematics.name_out(), kinematics.call(ca.vertsplit(s.q)), strict=True))
    moving, static, limits, gap = [], [], [], []
    for i, e in enumerate(elements):
        size, d = e.sizes, s.D[i]
        if isinstance(e.role, StopRole):
            g = gaps[e.role.gap]
            pressed = size.get("stiffness", 0.0) * -g * (1 - size.get("damping", 0.0) * s.v[i])
            moving.append(d * ca.fmax(pressed, 0))
            static.append(ca.SX(0))
            limits.append(ca.SX(0))
            gap.append(g)
            continue
        v = s.v[i] - size.get("speed", 0.0)
        push = _normal(e, s) * size.get("radius", 1.0)
        mu: ca.SX | float = size["mu_k"]
        if size.get("stribeck"):
            mu = mu + (size["mu_s"] - mu) * ca.exp(-((v / size["stribeck"]) ** 2))
        way = ca.tanh(v / size["smoothing"]) if e.role.law == "smooth" else 1
        moving.append(-d * way * mu * push - d**2 * size.get("viscous", 0.0) * v)
        static.append(-d * size["mu_s"] * push)
        limits.append(size["mu_s"] * push)
        gap.append(ca.SX(0))
    return tuple(ca.vertcat(*v) for v in (moving, static, limits, gap))  # type: ignore[return-value]


def _solved(s: _Letters, residual: ca.SX) -> ca.SX:
    """The forces p for which the conditions of a mode hold, as an expression of the state.

    What is linear in p, accelerations and reactions, is worked out once; Newton's steps take it as it is.
    """
    base = ca.substitute(s.linear, s.p, ca.SX.zeros(s.p.shape))
    slopes = ca.jacobian(s.linear, s.p)
    known = ca.Function("known", s.all[1:], [base, slopes])
    b, c = ca.SX.sym("b", base.shape), ca.SX.sym("c", slopes.sparsity())
    here = ca.substitute(residual, s.stand, b + ca.mtimes(c, s.p))
    slope = ca.jacobian(here, s.p)
    step = ca.Function("newton", [*s.all, b, c], [s.p - ca.solve(slope, here)])
    p, parts = ca.SX.zeros(s.p.shape), known(*s.all[1:])
    for _ in range(_NEWTON if ca.jacobian(ca.vec(slope), s.p).nnz() else 1):
        p = step(p, *s.all[1:], *parts)
    return p


@lru_cache(maxsize=8)
def model(problem: Problem, dependents: tuple[str, ...]) -> Model:
    """The equations of a problem with stops and friction; `dependents` are the coordinates that its loops hold.

    Raises BadInput: what acts cannot go with friction that sticks.
    """
    elements, mechanism = numbers(problem), problem.mechanism
    _require_suited(problem)
    s = _Letters(problem, elements, dependents)
    moving, static, limits, gaps = _laws(problem, elements, s)
    m = len(elements)
    condition = s.K * s.stand[:m] + (1 - s.K) * (s.p - moving)
    p = _solved(s, condition)
    residual, moving_, limits = (ca.substitute(e, s.stand, s.linear) for e in (condition, moving, limits))
    slope = ca.jacobian(residual, s.p)
    p_rate = -ca.solve(slope, ca.jtimes(residual, s.x, s.x_rate))
    dips = all(isinstance(e.role, StopRole) for e in elements)  # beside friction such a rate is too long a formula
    holds, places, seen, needed = _guards(problem, elements, s, gaps, limits, p_rate if dips else None)
    margin = seen.shape[0] if dependents else None
    seen, needed = ca.vertcat(seen, s.margin), ca.vertcat(needed, ca.SX.ones(s.margin.shape[0], 1))
    seen_rate = ca.jtimes(seen, s.x, s.x_rate) + ca.mtimes(ca.jacobian(seen, s.p), p_rate)
    at = ca.Function("at", s.all, [s.a * (1 - s.rest), s.v, s.v_rate, limits, seen, seen_rate * needed,
                                   ca.jacobian(moving_, s.p)])  # fmt: skip
    a, v, v_rate, limit, seen, seen_rate, gain = at(p, *s.all[1:])
    if holds:
        seen, seen_rate = _held(s, static, seen, seen_rate)
    n = len(mechanism.coordinates)
    rates, loss = power(mechanism, ca.vertsplit(s.q), ca.vertsplit(s.u))
    powers = [value * rates[part.input] for part, value in s.parts]
    columns = _columns(problem)
    y = ca.SX.sym("y", len(columns) + seen.shape[0])
    heats = [
        -p[i] * (v[i] - e.sizes.get("speed", 0.0)) for i, e in enumerate(elements) if isinstance(e.role, FrictionRole)
    ]
    out = ca.vertcat(s.u, a, *powers, *heats, loss - ca.dot(p, v), seen_rate)
    whole = ca.Function("whole", s.all[1:], [out, p, v, v_rate, limit, seen, gain])
    pose = _closure(problem, dependents)
    ydot, *others = whole(s.t, *pose(y[:n], y[n : 2 * n]), s.w)
    names = [f"guard {k}" for k in range(seen.shape[0])]
    system = System(
        function=ca.Function("system", [s.t, y, s.w], [ydot], ["t", "y", "w"], ["ydot"]),
        columns=(*columns, *names),
        units=mechanism.state_units + ("J",) * (len(columns) - 2 * n) + ("",) * len(names),
        values=s.outer,
        size=n,
        audited="energy" in mechanism.functions,
        fixed=(0.0,) * (2 * len(elements) + 1),
    )
    p_, v_, v_rate_, limit_, seen_, gain_ = others
    look = ca.Function("look", [s.t, y, s.w], [p_, v_, v_rate_, limit_, seen_, ydot, gain_])
    blow = ca.Function("blow", [s.q], [s.mass, s.W, s.moved, s.along_free])
    return Model(system=system, elements=elements, base=len(columns), places=places, dips=dips, holds=holds, look=look,
                 blow=blow, pose=pose, dependents=dependents, margin=margin)  # fmt: skip


def _closure(problem: Problem, dependents: tuple[str, ...]) -> ca.Function:
    """Coordinates and velocities put on the closure of the loops, as they are where there are none."""
    mechanism, n = problem.mechanism, len(problem.mechanism.coordinates)
    q, u = ca.SX.sym("q", n), ca.SX.sym("u", n)
    if not dependents:
        return ca.Function("closure", [q, u], [q, u])
    at, free = loops.closed(mechanism, q, dependents), loops.split(mechanism, dependents)[0]
    return ca.Function("closure", [q, u], [at, ca.mtimes(loops.motion(mechanism, at, u[free], dependents)[0], u[free])])


def _guards(
    problem: Problem,
    elements: tuple[Numbers, ...],
    s: _Letters,
    gaps: ca.SX,
    limits: ca.SX,
    p_rate: ca.SX | None,
) -> tuple[bool, tuple[int, ...], ca.SX, ca.SX]:
    """Whether friction may hold the only freedom, each element's first guard, guards, and whether a mode needs them."""
    sticking = [e for e in elements if isinstance(e.role, FrictionRole) and e.role.law != "smooth"]
    holds = len(s.free) == 1 and len(sticking) > 1
    places: list[int] = []
    guards: list[ca.SX] = []
    needed: list[ca.SX] = []  # a guard that a mode has no use for stands still
    for i, e in enumerate(elements):
        places.append(len(guards))
        if isinstance(e.role, StopRole):
            rigid = "stiffness" not in e.sizes
            pressed = [s.p[i], *([] if p_rate is None else [p_rate[i]])] if rigid else []
            guards += [gaps[i], s.v[i], *pressed]
            needed += [ca.SX(1), ca.SX(1), *([s.K[i]] * len(pressed))]
        elif e.role.law != "smooth":
            guards += [s.v[i] - e.sizes.get("speed", 0.0), limits[i] - s.p[i], limits[i] + s.p[i]]
            # held friction has guards of its own
            needed += [1 - s.K[i], *([ca.SX(0)] * 2 if holds else [s.K[i]] * 2)]
    if not guards:
        return holds, tuple(places), ca.SX(0, 1), ca.SX(0, 1)
    return holds, tuple(places), ca.vertcat(*guards), ca.vertcat(*needed)


def _held(s: _Letters, static: ca.SX, seen: ca.SX, seen_rate: ca.SX) -> tuple[ca.SX, ca.SX]:
    """Two guards more: the acceleration that either way of sliding would have against the friction that sticks."""
    edge = s.K * s.stand[: s.p.shape[0]] + (1 - s.K) * (s.p - static)
    for way in (edge, ca.substitute(edge, s.D, -s.D)):
        p, condition = _solved(s, way), ca.substitute(way, s.stand, s.linear)
        rate = -ca.solve(ca.jacobian(condition, s.p), ca.jtimes(condition, s.t, ca.SX(1)))
        a = s.a[s.free]
        at = ca.Function("at", s.all, [a, ca.jtimes(a, s.t, ca.SX(1)) + ca.mtimes(ca.jacobian(a, s.p), rate)])
        a, a_rate = at(p, *s.all[1:])
        seen, seen_rate = ca.vertcat(seen, a), ca.vertcat(seen_rate, a_rate * s.rest)
    return seen, seen_rate


def _columns(problem: Problem) -> tuple[str, ...]:
    works = (f"work_{p.name}" for p in problem.parts)
    rubs = (f"{RUBS}{e.name}" for e in problem.unilateral if isinstance(e, FrictionRole))
    return (*problem.mechanism.coordinates, *velocities(problem.mechanism), *works, *rubs, "dissipation")


def _require_suited(problem: Problem) -> None:
    mechanism = problem.mechanism
    sticking = [e.name for e in problem.unilateral if isinstance(e, FrictionRole) and e.law != "smooth"]
    rough = [p.name for p in problem.parts if isinstance(p.value, Periodic) or callable(p.value)]
    if rough and sticking:
        why = f"{sticking[0]} sticks, and {rough[0]!r} comes from a table or a cycle, whose rate in time is not known"
        raise BadInput(f"{why}; declare law='smooth' with its smoothing")
    driven = [e.name for e in problem.unilateral if isinstance(e, FrictionRole) and e.speed is not None]
    if driven and len(sticking) > 1 and len(mechanism.coordinates) - len(mechanism.dependents) == 1:
        why = f"{driven[0]} rubs on a face that moves, beside {len(sticking) - 1} more on the same freedom"
        raise BadInput(f"{why}, which may stick one by one; declare law='smooth' for all but one")
    if problem.states or problem.inertia or problem.curves:
        raise BadInput(f"{mechanism.name} has stops or friction, which go with no hinge and no gas in the loop")
