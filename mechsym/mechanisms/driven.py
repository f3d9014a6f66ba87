r"""Driven coordinates: what must push along each of them so that it moves as it is told, while the rest moves freely.

.. math:: M \ddot q + h = Q + J^T \mu + E_d \tau, \qquad \ddot q = T a + c

a are the accelerations of the independent coordinates, those of the driven ones d given, those of the others f from
:math:`(T^T M T)_{ff} a_f = (T^T (Q - h - M c))_f - (T^T M T)_{fd} a_d`; :math:`\tau` is what is missing in the rows d.
"""

import itertools
from collections.abc import Callable, Mapping, Sequence

import casadi as ca
import numpy as np
import scipy

from mechsym.errors import BadInput
from mechsym.mechanisms import loops
from mechsym.mechanisms.arrays import with_multipliers
from mechsym.mechanisms.record import Mechanism, accelerations, velocities
from mechsym.quantities import quantity, record, reference
from mechsym.quantities.units import Array, Second

_SINGULAR = 1e-6  # smallest against largest singular value: nearer to it forces are no longer numbers
_GAP = 1e-12  # a loop that three steps of Newton's method leave wider is closed with more of them
_TOLERANCE = 1e-12  # of a step of the coordinates that move freely [-]
_MOST = 200_000  # evaluations of what moves freely: more come of a dead point only

#: Times (k,) [s] to places, speeds and accelerations of the driven coordinates, each (driven, k) [rad or m, by time]
Law = Callable[[np.ndarray], tuple[np.ndarray, np.ndarray, np.ndarray]]


@record
class MotionSettings:
    """What driven coordinates share in a section `[motion]`; beside it stands each of them with its speed or word."""

    file: str = reference("file", "")  #: CSV: t [s], and a column for each it drives
    periodic: bool = False  #: Whether the file repeats
    rise: float | str | None = None  #: Of words without one of their own [rad] or [m]
    duration: float | None = quantity("s", default=None, above=0, about="how long the rise of a word takes")
    t_end: float | None = quantity("s", default=None, above=0, about="last time; else of file, word or turn")
    points: int = quantity("-", default=1000, low=10, high=200_000, about="times that are told")


@record
class DrivenMechanism:
    """A mechanism some of whose coordinates are driven."""

    mechanism: Mechanism
    driven: tuple[str, ...]
    free: tuple[str, ...]  #: Independent, and moved by forces
    dependents: tuple[str, ...]  #: Held by the loops
    pose: ca.Function  #: `pose(q)`: from near a closed pose to it, and what the loops still gape
    #: `closed(q, v)`: the same with velocities of the independent coordinates to all, and the Jacobian of the loops
    closed: ca.Function
    #: `forces(q, u, given, inputs)`: accelerations of the driven coordinates to those of all, and the driving forces
    forces: ca.Function


def drive(mechanism: Mechanism, driven: Sequence[str], pose: Mapping[str, float]) -> DrivenMechanism:
    """A mechanism with driven coordinates; which others the loops hold is what conditions them best.

    pose: coordinates of a closed pose [rad] or [m]. Raises BadInput: no such coordinate, more drives than freedoms, or
    drives that the loops tie together.
    """
    names = mechanism.coordinates
    held = _held(mechanism, driven, np.array([pose[q] for q in names]))
    independent, i_held = loops.split(mechanism, held)
    d, f = ([k for k, i in enumerate(independent) if (names[i] in driven) is moved] for moved in (True, False))
    q, u, v, a_d = (ca.SX.sym("x", n) for n in (len(names), len(names), len(independent), len(d)))
    w = ca.SX.sym("w", len(mechanism.inputs))
    at = loops.closed(mechanism, q, held)
    gap, J = ca.SX(0, 1), ca.SX(0, len(names))
    if held:
        gap, J, _ = mechanism.functions["constraints"](*ca.vertsplit(at), *([0] * len(names)))
    closed = ca.Function("closed", [q, v], [at, ca.mtimes(loops.motion(mechanism, at, v, held)[0], v), J])
    T, c = loops.motion(mechanism, q, u[independent], held)
    mass, bias, force = mechanism.functions["dynamics"](
        *(ca.vertsplit(x)[i] for x in (q, u, w) for i in range(x.numel()))
    )
    M, right = ca.mtimes(T.T, ca.mtimes(mass, T)), ca.mtimes(T.T, force - bias - ca.mtimes(mass, c))
    a = ca.SX(len(independent), 1)
    a[d] = a_d
    if f:
        a[f] = ca.solve(M[f, f], right[f] - ca.mtimes(M[f, d], a_d))
    outputs = [ca.mtimes(T, a) + c, (ca.mtimes(M, a) - right)[d]]
    return DrivenMechanism(
        mechanism=mechanism, driven=tuple(names[independent[k]] for k in d),
        free=tuple(names[independent[k]] for k in f), dependents=held, closed=closed,
        pose=ca.Function("pose", [q], [at, gap]), forces=ca.Function("forces", [q, u, a_d, w], outputs),
    )  # fmt: skip


def refuse_more(mechanism: Mechanism, driven: Sequence[str]) -> None:
    """Refuse more drives than degrees of freedom."""
    free = len(mechanism.coordinates) - len(mechanism.dependents)
    if len(driven) > free:
        raise BadInput(
            f"{mechanism.name}: {len(driven)} drives ({', '.join(driven)}) for {free} degrees of freedom; "
            "leave some of them away"
        )


def _held(mechanism: Mechanism, driven: Sequence[str], q: np.ndarray) -> tuple[str, ...]:
    """The coordinates that the loops hold, the declared ones where these are no worse than any others."""
    refuse_more(mechanism, driven)
    names, count = mechanism.coordinates, len(mechanism.dependents)
    rest = [i for i, n in enumerate(names) if n not in driven]
    if not count:
        return ()
    J = np.asarray(mechanism.functions["constraints"].call([*q, *([0.0] * len(q))])[1])
    scaled = loops.scaled(mechanism, J)
    best = [rest[k] for k in scipy.linalg.qr(scaled[:, rest], pivoting=True, mode="r")[1][:count]]
    size = np.linalg.svd(scaled[:, best], compute_uv=False)
    if not size[-1] > _SINGULAR * size[0]:
        raise BadInput(
            f"{mechanism.name}: the loops tie the drives along {', '.join(driven)} together in this pose; "
            "drive other coordinates or start from another pose"
        )
    declared = [i for i, n in enumerate(names) if n in mechanism.dependents]
    kept = not set(driven) & set(mechanism.dependents)
    if kept and 2 * abs(np.linalg.det(scaled[:, declared])) > abs(np.linalg.det(scaled[:, best])):
        best = declared
    return tuple(names[i] for i in sorted(best))


@record
class DrivenPath:
    """A driven mechanism over time."""

    t: np.ndarray  #: shape (k,): Times [s]
    q: np.ndarray  #: shape (n, k): Coordinates [rad] or [m]
    u: np.ndarray  #: shape (n, k): Velocities [rad/s] or [m/s]
    a: np.ndarray  #: shape (n, k): Accelerations [rad/s^2] or [m/s^2]
    force: np.ndarray  #: shape (driven, k): Along the driven coordinates [N*m] or [N]


def path(
    one: DrivenMechanism, law: Law, t: Second[Array], start: Mapping[str, float], inputs: Sequence[float]
) -> DrivenPath:
    """Coordinates and driving forces over time.

    start: a closed pose [rad] or [m], and the velocities of what moves freely, 0 where not named. inputs: what acts, in
    the order of the mechanism's inputs [SI]. Raises BadInput: a loop opens or locks on the way; says when.
    """
    names, (places, speeds, given) = one.mechanism.coordinates, law(t)
    independent, held = loops.split(one.mechanism, one.dependents)
    d, f = ([names.index(n) for n in group] for group in (one.driven, one.free))
    v_d, v_f = ([independent.index(i) for i in group] for group in (d, f))
    q, v = np.zeros((len(names), len(t))), np.zeros((len(independent), len(t)))
    q[:, 0] = [start[n] for n in names]
    q[d], v[v_d] = places, speeds
    if f:
        q[f], v[v_f] = _freely(one, law, t, start, np.asarray(inputs, dtype=float))
    for k in range(len(t)) if held else ():
        q[held, k] = 2 * q[held, k - 1] - q[held, k - 2] if k > 2 else q[held, max(k - 1, 0)]
        q[:, k] = _closed(one, q[:, k], q[held, max(k - 1, 0)], t[k])
    at, u, J = (np.asarray(x) for x in one.closed.map(len(t))(q, v))
    columns = J.reshape(len(held), len(t), len(names)).transpose(1, 0, 2) if held else np.zeros((len(t), 0, 1))
    _require_held(one, columns, t)
    w = np.repeat(np.asarray(inputs, dtype=float)[:, None], len(t), axis=1)
    a, force = (np.asarray(x) for x in one.forces.map(len(t))(at, u, given, w))
    bad = ~(np.isfinite(a).all(axis=0) & np.isfinite(force).all(axis=0))
    if bad.any():
        raise _opens(one, float(t[int(np.argmax(bad))]))
    return DrivenPath(t=t, q=at, u=u, a=a, force=force)


def _opens(one: DrivenMechanism, t: Second) -> BadInput:
    return BadInput(
        f"{one.mechanism.name}: a loop opens or locks at t = {t:.6g} s on the way of {', '.join(one.driven)}; the "
        "links do not reach so far: give another path or another start"
    )


def _closed(one: DrivenMechanism, q: np.ndarray, before: np.ndarray, t: Second) -> np.ndarray:
    """Coordinates closed from a guess, with as many steps as that takes; `before`: the last pose of the dependents."""
    at, gap = one.pose(q)
    if np.abs(np.asarray(gap)).max(initial=0.0) <= _GAP:
        return np.asarray(at).ravel()
    names = one.mechanism.coordinates
    guess = dict(zip(one.dependents, before, strict=True))
    whole = loops.close(one.mechanism, {n: x for n, x in zip(names, q, strict=True) if n not in guess}, guess)
    if whole is None or not np.isfinite(whole).all():
        raise _opens(one, t)
    return whole


def _require_held(one: DrivenMechanism, J: np.ndarray, t: np.ndarray) -> None:
    """Refuse a path through a pose where the loops do not hold the dependents: no force is determined there."""
    if not one.dependents:
        return
    scale = np.abs(J).max(axis=1, keepdims=True)
    scaled = (J / np.where(scale > 0, scale, 1.0))[:, :, loops.split(one.mechanism, one.dependents)[1]]
    sizes, signs = np.linalg.svd(scaled, compute_uv=False), np.sign(np.linalg.det(scaled))
    bad = (sizes[:, -1] < _SINGULAR * sizes[:, 0]) | (signs != signs[0])
    if bad.any():
        raise BadInput(
            f"{one.mechanism.name}: the path passes a dead point of its loops near t = {t[int(np.argmax(bad))]:.6g} s, "
            f"where no drive along {', '.join(one.driven)} holds it; give another path"
        )


def _freely(
    one: DrivenMechanism, law: Law, t: np.ndarray, start: Mapping[str, float], inputs: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Places and speeds over time of the coordinates that nothing drives [rad or m, by time]."""
    names = one.mechanism.coordinates
    independent, held = loops.split(one.mechanism, one.dependents)
    d, f = ([names.index(n) for n in group] for group in (one.driven, one.free))
    v_d, v_f = ([independent.index(i) for i in group] for group in (d, f))
    pose, v, calls = np.array([start[n] for n in names]), np.zeros(len(independent)), itertools.count()

    def rates(at: float, y: np.ndarray) -> np.ndarray:
        places, speeds, given = law(np.array([at]))
        pose[d], pose[f], v[v_d], v[v_f] = places[:, 0], y[: len(f)], speeds[:, 0], y[len(f) :]
        pose[:] = _closed(one, pose.copy(), pose[held], at)
        u = np.asarray(one.closed(pose, v)[1]).ravel()
        a = np.asarray(one.forces(pose, u, given, inputs)[0]).ravel()
        if not np.isfinite(a).all() or next(calls) > _MOST:
            raise _opens(one, at)
        return np.concatenate([u[f], a[f]])

    y0 = [*(start[n] for n in one.free), *(start.get(f"{n}d", 0.0) for n in one.free)]
    run = scipy.integrate.solve_ivp(
        rates, (t[0], t[-1]), y0, method="DOP853", t_eval=t, rtol=_TOLERANCE, atol=_TOLERANCE
    )
    if not run.success:
        raise BadInput(
            f"{one.mechanism.name}: what nothing drives runs away: {run.message}; give it a start or a drive"
        )
    return run.y[: len(f)], run.y[len(f) :]


def outputs(one: DrivenMechanism, way: DrivenPath, inputs: Sequence[float]) -> dict[str, np.ndarray]:
    """Outputs, reactions, driving forces and their powers over time.

    inputs: as of `path` [SI]. Returns outputs: by name, shape (k,); the force along each driven coordinate, its
    power [W], and `power_residual`: drives, inputs and dampers less what the energies gain [W].
    """
    mechanism = one.mechanism
    letters = dict(zip(mechanism.coordinates, way.q, strict=True))
    letters |= dict(zip(velocities(mechanism), way.u, strict=True))
    letters |= dict(zip(accelerations(mechanism), way.a, strict=True))
    letters |= {n: np.full(len(way.t), float(w)) for n, w in zip(mechanism.inputs, inputs, strict=True)}
    values: dict[str, np.ndarray] = {}
    functions = [mechanism.functions["kinematics"]]
    if "reactions" in mechanism.functions:
        functions.append(reactions(one))
    for function in [*functions, *([_gain(mechanism)] if "energy" in mechanism.functions else ())]:
        columns = function.map(len(way.t)).call([letters[n] for n in function.name_in()])
        values |= {n: np.asarray(x).ravel() for n, x in zip(function.name_out(), columns, strict=True)}
    values = {n: x for n, x in values.items() if not n.startswith("driving_")}
    powers = {}
    for q, force in zip(one.driven, way.force, strict=True):
        values[f"driving_{q}"] = force
        powers[f"power_{q}"] = force * letters[f"{q}d"]
    if "gain" in values:
        values["power_residual"] = sum(powers.values(), np.zeros(len(way.t))) - values.pop("gain")
    return values | powers


def reactions(one: DrivenMechanism) -> ca.Function:
    """The reactions with what the loops carry by this choice of dependents."""
    functions = one.mechanism.functions
    if not one.dependents:
        return functions["reactions"]
    return with_multipliers(functions, one.dependents)


def _gain(mechanism: Mechanism) -> ca.Function:
    """What the kinetic energy gains less what all forces but the drives give [W]."""
    names = (*mechanism.coordinates, *velocities(mechanism), *accelerations(mechanism), *mechanism.inputs)
    letters = {n: ca.SX.sym(n) for n in names}
    q, u, a = (ca.vertcat(*(letters[n] for n in names[k : k + n_q])) for n_q in (len(mechanism.coordinates),)
               for k in (0, n_q, 2 * n_q))  # fmt: skip
    called = {g: mechanism.functions[g] for g in ("energy", "dynamics")}
    kinetic, force = (
        f.call([letters[n] for n in f.name_in()])[k] for f, k in zip(called.values(), (0, 2), strict=True)
    )
    gain = ca.jtimes(kinetic, q, u) + ca.jtimes(kinetic, u, a) - ca.dot(force, u)
    return ca.Function("gain", list(letters.values()), [gain], list(names), ["gain"])
