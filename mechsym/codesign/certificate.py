r"""How much inertia has to turn, whatever the guide: a lower bound by a few points, and a design beside it.

.. math:: (\max_\varphi I_t + \epsilon)\,q \ge \min_{a} \frac{\mathrm{ptp}(\sum_i a_i Y_i)
          - |\sum_i a_i|\,\mathrm{ptp}(I_h)/2 - |\sum_i a_i/\omega_i^2|\,\mathrm{ptp}(V)}{\sum_i |a_i|},
          \qquad Y = \frac{W}{\omega^2}, \quad q = \delta (1 + \delta/2)

I_t = I + J + I_h turns: engine, flywheel, rollers. The missing work is w = W + omega^2 I_h / 2 + V + sum_j p_j S_j: the
energy of a gas spring is affine in its excess pressure p, V is what the outside pressure adds. Of r + 1 points some
combination a, of mixed signs since pressures are positive, holds none of the r shapes S_j; so whatever they are,
ptp(sum a_i w_i / omega_i^2) is at least the numerator. With f = u^2 - 1 a motion of ripple delta has w = g - I_t
omega^2 f/2, and f spans at most 2 q: u_low <= 1 <= u_high and u_high - u_low <= delta, since mean(u^2) = 1 under a load
with the square of the speed and mean(1/u) = 1 under a constant one. So ptp(w) <= q omega^2 (max I_t + epsilon), with
epsilon = 0 under a constant load. Under the other g' = -M f, of mean 0, swings by at most q M P/2 in a period P:
epsilon = M P / (2 omega^2), pi M / omega^2 over a turn.

The least a is half of a game: for weights lambda, mu on the angles, each of sum 1, ptp(y) >= nu . y with nu = lambda -
mu, and what is left is linear in |a|, least at a single point. So any weights prove a bound; a linear programme finds
good ones. For given weights nu . g = -M int T f, T the sum of nu beyond an angle: at most q M int |T - mean T|, so
epsilon shrinks by the share 2/P of that integral.
"""

import dataclasses
import itertools
import math
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
import scipy

from mechsym.codesign.points import Point
from mechsym.codesign.rank import MOST, Bound
from mechsym.codesign.running import added_inertia
from mechsym.codesign.task import CoDesign
from mechsym.errors import BadInput
from mechsym.hinge.springs.face import affine_energy
from mechsym.plausible import Doubt
from mechsym.quantities import RPM, quantity, record
from mechsym.quantities.display import figure, quantity_text
from mechsym.quantities.units import Array, Inertia, Pure, Radian

_NOTHING, _SAME = 1e-12, 1e-6  # weights that are none; works that differ so little are the same [-]
_SUBSETS = 2000  # of points that are looked at; any subset proves a bound


@record
class Terms:
    """What the rollers and the pressure outside take from the proof: of the design that it is about."""

    rollers: float = quantity("kg*m^2", default=0.0, low=0, about="largest less smallest inertia of the rollers, I_h")
    ambient: float = quantity("J", default=0.0, low=0, about="the same of the energy V that the pressure outside adds")


@record
class Proof:
    """The least total inertia of any guides with so many springs, and the points that prove it."""

    springs: int
    total_inertia: float = quantity("kg*m^2", low=0, about="max over the turn of I + J + I_h is at least this")
    points: tuple[int, ...]  #: places of the points; empty where there are too few to prove anything


def swing_per_inertia(ripple: Pure, by: str = "mean") -> Pure:
    r"""Most of ptp(I_t (u^2 - 1)/2) by the largest I_t that a ripple leaves.

    .. math:: q = \delta (1 + \delta/2) \;\text{by the mean}, \qquad q = \delta / (1 - \delta/2)^2 \;\text{by mid-range}

    ripple: (max - min) by the mean in time, or by (max + min)/2 of the speed; by: `mean` of the speed in time, or the
    `mid-range` of its extremes. Returns q: (u_high^2 - u_low^2)/2 at most.
    """
    if by not in ("mean", "mid-range"):
        raise BadInput(f"by = {by!r} is not an option; options are mean, mid-range")
    return ripple * (1 + ripple / 2) if by == "mean" else ripple / (1 - ripple / 2) ** 2


def proofs(points: Sequence[Point], phi: Radian[Array], q: Pure, terms: Terms, springs: int) -> tuple[Proof, ...]:
    """The best bound on total inertia for 1 to some springs. phi: ascending, of a period. q: `swing_per_inertia`."""
    facts = _facts(points, phi, q, terms)
    return tuple(_best(facts, r, q) for r in range(1, springs + 1))


def _facts(points: Sequence[Point], phi: np.ndarray, q: float, terms: Terms) -> "_Facts":
    omega, period = np.array([p.omega for p in points]), points[0].period
    lag = np.array([abs(p.load_torque) * period / 2 if p.law == "propeller" else 0.0 for p in points])
    return _Facts(
        works=np.array([p.work(phi) for p in points]) / omega[:, None] ** 2,
        sides=np.column_stack([np.full(omega.size, terms.rollers / 2), terms.ambient / omega**2]),
        lag=q * lag / omega**2,
        share=np.diff(phi, append=phi[0] + period) / period,
    )


@record
class _Facts:
    """What the proof knows of some points."""

    works: np.ndarray  #: shape (k, n), W / omega^2 [kg*m^2]
    sides: np.ndarray  #: shape (k, 2), what rollers and pressure outside may add, of either sign [kg*m^2]
    lag: np.ndarray  #: shape (k,), q epsilon [kg*m^2]
    share: np.ndarray  #: shape (n,), from each angle to the next by the period [-]

    def at(self, subset: Sequence[int]) -> "_Facts":
        rows = list(subset)
        return _Facts(works=self.works[rows], sides=self.sides[rows], lag=self.lag[rows], share=self.share)


def _best(facts: _Facts, springs: int, q: float) -> Proof:
    """The subset of points that proves most; those that promise most are tried first."""
    best, chosen = 0.0, tuple[int, ...]()
    hopes = [(_hope(facts.at(s)), s) for s in _subsets(len(facts.works), springs + 1)]
    for hope, subset in sorted(hopes, reverse=True):
        if hope <= best:
            break
        value = _value(facts.at(subset), best)
        if value > best:
            best, chosen = value, subset
    return Proof(springs=springs, total_inertia=best / q, points=chosen)


def _subsets(count: int, size: int) -> list[tuple[int, ...]]:
    """Places of so many of `count` points; of very many points only some are taken, the ends among them."""
    kept = count
    while kept > size and math.comb(kept, size) > _SUBSETS:
        kept -= 1
    places = np.unique(np.linspace(0, count - 1, kept).round().astype(int)).tolist()
    return list(itertools.combinations(places, size))


def _hope(facts: _Facts) -> float:
    """No less than the subset proves: the left side at the combination that holds least of the works."""
    a = np.linalg.svd(facts.works - facts.works.mean(axis=1, keepdims=True), full_matrices=False)[0][:, -1]
    if np.all(a >= 0) or np.all(a <= 0):
        return np.inf
    a = a / np.abs(a).sum()
    return float(np.ptp(a @ facts.works) - np.abs(a @ facts.sides).sum())


def enclosed(points: Sequence[Point], phi: Radian[Array], q: Pure, terms: Terms, chosen: Sequence[int]) -> Inertia:
    """The total inertia that chosen points prove, in balls: works by the formulas of the torque, weights as they are.

    phi: as of `proofs`. Raises BadInput: a law that cannot be enclosed, or is not the one whose work the point has.
    """
    from mechsym.proof.balls import arb, ctx

    facts = _facts(points, phi, q, terms).at(chosen)
    weighed = [
        (signs, offset, _weights(signs[:, None] * facts.works, offset)) for signs, offset in _combinations(facts)
    ]
    used = np.flatnonzero(np.max([np.abs(nu) for *_, nu in weighed], axis=0) > 0)
    least = np.inf
    with ctx.workprec(80):
        works = [[w / arb(points[k].omega) ** 2 for w in _work_in_balls(points[k], phi[used])] for k in chosen]
        for signs, offset, nu in weighed:
            lag = _lag(nu, facts) * (1 + 1e-9)
            weights = [[arb(max(sign * v, 0.0)) for v in nu[used].tolist()] for sign in (1, -1)]
            up, down = ([w / sum(side, arb(0)) for w in side] for side in weights)  # sums of 1, exactly
            for i, row in enumerate(works):
                swing = sum(((a - b) * y for a, b, y in zip(up, down, row, strict=True)), arb(0))
                left = swing * int(signs[i]) + arb(float(offset[i])) - arb(float(lag[i]))
                least = min(least, float(left.lower()))
    return least / q * (1 - 1e-12)


def _work_in_balls(point: Point, phi: np.ndarray) -> list[Any]:
    """The work wanted at ascending angles, but for a constant: of inertia, gas and weight, and the load they drive."""
    from mechsym.native.tape import read
    from mechsym.proof.balls import REAL, arb, evaluate
    from mechsym.proof.work import integrals

    if point.inertia_formula is None:
        raise BadInput("the torque is no formula of the angle")
    pieces = [(a, b, read(f)) for a, b, f in point.formulas]
    start, last = pieces[0][0], pieces[-1][1]
    turn = 2 * arb.pi() * round(point.period / (2 * math.pi))
    order = np.argsort(np.where(phi < last, phi, phi - point.period))
    # an angle behind the last piece is one before; its double is another by a rounding, which the torque there covers
    angles = [float(phi[n] if phi[n] < last else phi[n] - point.period) for n in order]
    *given, whole = integrals(pieces, [*angles, last])
    inertia, works = read(point.inertia_formula), [arb(0)] * len(phi)
    for n, angle, done in zip(order, angles, given, strict=True):
        at = arb(angle, 4e-15 * abs(angle))
        torque = max(abs(float(b.mid())) + float(b.rad()) for b in (whole, done)) + abs(point.load_torque) * 10
        moved = evaluate(inertia, REAL, [at])[0] * arb(point.omega) ** 2 / 2
        works[n] = moved - done + whole * (at - arb(start)) / turn + arb(0, 1e-13 * torque)
    floats = point.work(phi)
    off = [abs(float(w.mid()) - float(works[0].mid()) - (f - floats[0])) for w, f in zip(works, floats, strict=True)]
    if max(off) > _SAME * float(np.ptp(floats)):
        raise BadInput("the formulas of the torque are not those of the work")
    return works


def _value(facts: _Facts, enough: float) -> float:
    """The least left side [kg*m^2] over all combinations of mixed signs; given up where it is not above `enough`."""
    least = np.inf
    for signs, offset in _combinations(facts):
        works = signs[:, None] * facts.works
        nu = _weights(works, offset)
        least = min(least, float(np.min(works @ nu + offset - _lag(nu, facts))))
        if least <= enough:
            return least
    return least


def _combinations(facts: _Facts) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Mixed signs of the points, and what rollers and pressure outside may take from each [kg*m^2]."""
    for rest in itertools.product((1.0, -1.0), repeat=len(facts.works) - 1):
        signs = np.array([1.0, *rest])
        if signs.min() > 0:
            continue
        # -|x| is the smaller of x and -x
        for side in itertools.product(*((1.0, -1.0) if column.any() else (0.0,) for column in facts.sides.T)):
            yield signs, signs * (facts.sides @ np.array(side))


def _weights(works: np.ndarray, offset: np.ndarray) -> np.ndarray:
    """Weights on the angles that prove much; the solver only finds them, their sums are seen to here."""
    count, n = works.shape
    scale = float(np.ptp(works, axis=1).max()) or 1.0
    rows = np.hstack([-works / scale, works / scale, np.ones((count, 1))])
    sums = np.zeros((2, 2 * n + 1))
    sums[0, :n] = sums[1, n : 2 * n] = 1.0
    optimum = scipy.optimize.linprog(
        np.append(np.zeros(2 * n), -1.0), A_ub=rows, b_ub=offset / scale, A_eq=sums, b_eq=np.ones(2),
        bounds=[(0.0, None)] * (2 * n) + [(None, None)], method="highs-ds",
    )  # fmt: skip
    if optimum.x is None:
        return np.zeros(n)  # proves nothing: 0 less what stands beside it
    up, down = (np.where(part > _NOTHING, part, 0.0) for part in (optimum.x[:n], optimum.x[n : 2 * n]))
    return up / up.sum() - down / down.sum()


def _lag(nu: np.ndarray, facts: _Facts) -> np.ndarray:
    """What a load with the square of the speed takes of what weights prove [kg*m^2]."""
    beyond = nu.sum() - np.cumsum(nu)
    return facts.lag * 2 * float(facts.share @ np.abs(beyond - facts.share @ beyond))


PROVEN = "proven"
_LOSSY = "an estimate, proven without friction and heat only"
_CLOSE = 1e-3  # by which balls may hold less than doubles [-]
_FINE = 720  # angles of a turn
_MOVED = 0.1  # share of the flywheel saved by free hardware that may go into the rollers without a word


@record
class Floor:
    """What turns in a design, and the least that has to."""

    total_inertia: float = quantity("kg*m^2", about="largest of engine, flywheel and rollers together over the turn")
    rollers: float = quantity("kg*m^2", about="mean inertia of the rollers, I_h")
    ripple: float = quantity("-", about="that the bound is for: asked, or of the design where that is more")
    terms: Terms  #: of this design's rollers and springs
    proofs: tuple[Proof, ...]  #: for 1, 2, 3 springs
    estimate: tuple[float, ...]  #: D_r by the ripple, for 1, 2, 3 springs [kg*m^2]
    assumes: tuple[str, ...]  #: what the proof holds for
    proven: bool  #: of this design, in balls
    kind: str  #: `proven`, or what it is instead and why


def floor(design: CoDesign, bound: Bound, ripple: np.ndarray) -> Floor:
    """The bound with the terms of a design's own hardware; `ripple` [-] is what it has at each point, nan for none."""
    points = design.task.points
    phi = np.arange(round(_FINE * points[0].period / (2 * np.pi))) * 2 * np.pi / _FINE
    rollers = sum(added_inertia(track, phi) for track in design.tracks)
    total = points[0].inertia(phi) + design.flywheel + rollers
    kept = float(np.nanmax(np.append(ripple, design.task.ripple)))
    hardware = ((track.hardware, track.z(phi)) for track in design.tracks)
    terms = Terms(
        rollers=float(np.ptp(rollers)),
        ambient=float(np.ptp(np.asarray(sum(affine_energy(h.spring, z)[0] for h, z in hardware)))),
    )
    q = swing_per_inertia(kept)
    proof_list = list(proofs(points, bound.phi, q, terms, MOST))
    kind = _in_balls(design, bound, q, terms, proof_list) if design.task.losses is None else _LOSSY
    return Floor(
        total_inertia=float(total.max()),
        rollers=float(np.mean(rollers)),
        ripple=kept,
        terms=terms,
        proofs=tuple(proof_list),
        estimate=tuple(swing / kept for swing in bound.swing),
        assumes=_assumes(design, kept, terms),
        proven=kind == PROVEN,
        kind=kind,
    )


def _in_balls(design: CoDesign, bound: Bound, q: float, terms: Terms, stated: list[Proof]) -> str:
    """What the bound of a design's springs is; where balls prove it, the proof is what they prove."""
    place = design.task.springs - 1
    if not stated[place].points:
        return PROVEN  # that nothing is proven
    try:
        proven = enclosed(design.task.points, bound.phi, q, terms, stated[place].points)
    except BadInput as error:  # MissingExtra too
        return f"computed in doubles and not proven ({error})"
    if proven < (1 - _CLOSE) * stated[place].total_inertia:
        return "computed in doubles and not proven (balls hold less)"
    stated[place] = dataclasses.replace(stated[place], total_inertia=min(proven, stated[place].total_inertia))
    return PROVEN


def rollers_inertia(design: CoDesign) -> float:
    """Mean inertia that the rollers of a design add to the shaft [kg*m^2]."""
    phi = np.arange(_FINE) * design.task.points[0].period / _FINE
    return float(np.mean(sum(added_inertia(track, phi) for track in design.tracks)))


def _assumes(design: CoDesign, ripple: float, terms: Terms) -> tuple[str, ...]:
    loads = sorted({point.law for point in design.task.points})
    words = {"propeller": "a load with the square of the speed", "constant": "a constant load, its mean speed governed"}
    return (
        f"ripple at most {figure(100 * ripple, 4)} % by the mean speed, {' or '.join(words[law] for law in loads)}",
        f"rollers whose inertia varies over the turn by at most {quantity_text(terms.rollers, 'kg*m^2', 3)}, as here",
        f"gas springs with energy affine in their excess pressure, to which the pressure outside adds at most "
        f"{quantity_text(terms.ambient, 'J', 3)}, as here",
        "any shapes, any positive pressures; no friction, no heat",
    )


def proving(proven: Floor, design: CoDesign) -> tuple[float, ...]:
    """Speeds [rpm] of the points that prove the bound for the design's number of springs."""
    return tuple(design.task.points[k].omega / RPM for k in proven.proofs[design.task.springs - 1].points)


def hidden(design: CoDesign, given: CoDesign | None) -> tuple[Doubt, ...]:
    """A doubt where free hardware has the flywheel on its rollers; `given` is the design with the case's hardware."""
    if given is None or {design.status, given.status} != {"optimal"} or given.flywheel <= design.flywheel:
        return ()
    moved = rollers_inertia(design) - rollers_inertia(given)
    share = moved / (given.flywheel - design.flywheel)
    if share <= _MOVED:
        return ()
    why = (
        f"of {quantity_text(given.flywheel - design.flywheel, 'kg*m^2', 4)} that the free hardware takes off the "
        f"flywheel the rollers turn {quantity_text(moved, 'kg*m^2', 4)} more: inertia has moved, not gone"
    )
    name = "moved_to_rollers"
    return (Doubt(code=name, quantity=name, value=share, usual=f"at most {_MOVED:g}", why=why),)
