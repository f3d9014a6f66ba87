r"""The programme: shapes of guides, pressures of springs and one small flywheel at once, for all points.

    minimise J   over the shapes z(phi), the pressures p_k, J, and the motion of each point; J + mean(I_h) where
                 hardware is free: a flywheel on the rollers is a flywheel
    subject to   the steady motion of each point keeps the ripple                          (motion_rows)
                 spring, track and rollers keep their limits where they are asked most      (task.limit_rows)
                 friction and heat, if the task asks for them                               (unknowns)

Angles are common to all points and contain the kinks. IPOPT with exact derivatives; the splines are sparse. The
multipliers of ripple and limits come out as what one unit of each is worth in flywheel.

The steady motion of one point as constraints of the programme, exact under propeller and constant load.

.. math:: u^2 = (\dot\varphi/\omega)^2 = 1 + \frac{2 (g - w)}{I_t \omega^2}, \qquad g' = a (w - g), \qquad
          a = \frac{2 M_r}{I_t \omega^2}

with w the missing work. Propeller: g is periodic, and the mean of u^2 over the angle is 1 of itself. Constant load:
a = 0, g is a number, and a governor holds the mean speed in time, mean(1/u) = 1.
"""

import dataclasses
import itertools
import time
import warnings
from collections.abc import Sequence
from typing import Any

import casadi as ca
import numpy as np

from mechsym.codesign import unknowns
from mechsym.codesign.points import Point, Samples, sample, swing
from mechsym.codesign.settings import FREE
from mechsym.codesign.task import Active, CoDesign, CoDesignTask, Track, limit_rows
from mechsym.codesign.unknowns import Basis, Gathered, GuideSymbols, basis, curve, guides
from mechsym.codesign.verify import passed
from mechsym.hinge.choices import asked as asked_of
from mechsym.hinge.springs.face import lettered
from mechsym.optimise.solvers import Solved, ipopt
from mechsym.quantities import quantity, record
from mechsym.quantities.units import Inertia, Joule, NewtonMetre, Pure, Scalar

_OPTIONS: dict[str, Any] = {
    "ipopt": {"print_level": 0, "sb": "yes", "tol": 1e-7, "acceptable_tol": 1e-5, "max_iter": 400},
    "print_time": False,
}
_SMOOTH = 1e-6  # weight of the mean of (z''/H)^2 and of free hardware: it decides where nothing else does
_NONE = 1e-7  # flywheel that the solver cannot tell from none, by the swing of the works: its tolerance
_START = 3.0  # flywheel at the start, by the same
_ROUNDS, _LITTLE = 4, 2e-3  # of solving again where a limit is passed; share beyond that each is moved by [-]
_ACTIVE = 1e-3  # a limit is met if moving it by itself would move the flywheel by this share, or by 1e-6 of the swing
_HARDWARE = (*FREE, "moving_mass")


@record
class ReadyProgramme:
    """A task as IPOPT takes it; ripple and limits are parameters, so that a front is one programme."""

    task: CoDesignTask
    basis: Basis
    solver: ca.Function
    read: ca.Function  #: unknowns to coefficients, pressures, hardware, flywheel and ripples in SI
    unit: float = quantity("kg*m^2", about="inertia that the objective counts in: the swing of the works")
    start: np.ndarray  #: [-]
    bounds: dict[str, np.ndarray]  #: lbx, ubx, lbg, ubg [-]
    wall: float = quantity("s", about="time of building")


def programme(task: CoDesignTask) -> ReadyProgramme:
    """Put the programme of a task together."""
    with warnings.catch_warnings():
        # numpy's functions take symbols; casadi announces that it may do so otherwise one day
        warnings.simplefilter("ignore", FutureWarning)
        return _programme(task)


def _programme(task: CoDesignTask) -> ReadyProgramme:
    begin, turns = time.perf_counter(), task.points[0].period / (2 * np.pi)
    samples = sample(task.points, round(task.angles * turns))
    kinks = sorted({k for p in task.points for k in p.kinks})
    splines = basis(task.points[0].period, kinks, round(task.knots * turns))
    parameters, gathered = ca.SX.sym("parameters", len(_values(task))), Gathered()
    symbols = guides(task, samples, splines, gathered)
    flywheel, unit = gathered.unknown("J", np.array([_START]), 0.0), swing(task.points)
    rollers = sum(g.inertia for g in symbols)
    ripples = _motions(task, samples, symbols, unit * flywheel, parameters[0], gathered)
    goal = flywheel + (ca.dot(ca.DM(samples.weights), rollers) / unit if task.free else 0.0)
    # limits where spring and rollers are asked most: at the largest pressure of the schedule and the highest speed
    hardware, fastest = task.hardware, max(p.omega for p in task.points)
    *settings, reach = ca.vertsplit(parameters[1:])
    limits = lettered(task.bounds, dict(zip((key for key, *_ in asked_of(task.bounds)), settings, strict=True)))
    for guide in symbols:
        spring = hardware.charged((1 + task.robust) * guide.largest, **guide.values)
        at = hardware.station(guide.path, spring, fastest, **guide.values)
        # rollers of the case's own guide reach rho0 + r and no farther
        rows = limit_rows(at, limits, hardware.z_margin, reach if task.free else None)
        gathered.group([*rows, ((guide.p0 - guide.largest) / guide.scale, -np.inf, 0.0)])
    smooth = sum(ca.sumsqr(g.path.d2rho / task.hardware.spring.H) for g in symbols) / samples.phi.size
    chosen = sum(ca.sumsqr(share - 1) for g in symbols for share in g.shares)
    x, box = ca.vertcat(*gathered.unknowns), np.vstack(gathered.box)
    values = [ca.vertcat(*g.values.values()) for g in symbols]
    read = [ca.horzcat(*(g.coefficients for g in symbols)), ca.horzcat(*(g.p0 for g in symbols)), ca.horzcat(*values),
            unit * flywheel, ripples]  # fmt: skip
    return ReadyProgramme(
        task=task, basis=splines, unit=unit,
        solver=_solver(x, parameters, goal + _SMOOTH * (smooth + chosen), gathered.rows, _options(task)),
        read=ca.Function("read", [x], read), start=np.concatenate(gathered.start),
        bounds={"lbx": box[:, 0], "ubx": box[:, 1], "lbg": np.concatenate(gathered.low),
                "ubg": np.concatenate(gathered.high)},
        wall=time.perf_counter() - begin,
    )  # fmt: skip


def _solver(
    x: ca.SX, p: ca.SX, objective: ca.SX, groups: Sequence[Sequence[ca.SX]], options: dict[str, Any]
) -> ca.Function:
    """IPOPT for min objective(x, p), all scaled [-], subject to rows: groups share terms, pieces what they touch."""
    # a mean over the turn touches every unknown of its point, the flywheel every row: coloured together they ask for
    # hundreds of directions, piece by piece for a dozen
    g = ca.vertcat(*(piece for group in groups for piece in group))
    jacobian = ca.vertcat(*(ca.jacobian(piece, x) for group in groups for piece in group))
    by_objective, by_rows = ca.SX.sym("by_objective"), ca.SX.sym("by_rows", g.numel())
    hessian, at = _hessian(by_objective * objective, x), 0
    for group in groups:
        rows = ca.vertcat(*group)
        hessian += _hessian(ca.dot(by_rows[at : at + rows.numel()], rows), x)
        at += rows.numel()
    first = ca.Function("nlp_jac_g", [x, p], [g, jacobian], ["x", "p"], ["g", "jac_g_x"])
    second = ca.Function(
        "nlp_hess_l", [x, p, by_objective, by_rows], [hessian], ["x", "p", "lam_f", "lam_g"], ["triu_hess_gamma_x_x"]
    )
    problem = {"x": x, "p": p, "f": objective, "g": g}
    return ca.nlpsol("codesign", "ipopt", problem, {**options, "jac_g": first, "hess_lag": second})


def _hessian(scalar: ca.SX, x: ca.SX) -> ca.SX:
    return ca.triu(ca.hessian(scalar, x)[0])


def _options(task: CoDesignTask) -> dict[str, Any]:
    """The barrier falls step by step: adaptive, some systems without losses fill up for half a minute."""
    strategy = "adaptive" if task.losses else "monotone"
    return {**_OPTIONS, "ipopt": {**_OPTIONS["ipopt"], "mu_strategy": strategy}}


def solve(task: CoDesignTask, ready: ReadyProgramme | None = None, near: CoDesign | None = None) -> CoDesign:
    r"""Guides, pressures and the smallest flywheel for a task.

    .. math:: \min J \quad \text{subject to} \quad \delta_k \le \delta, \; \text{limits}

    ready: a programme of the same task but for ripple and limits, used again; near: a solution of the same programme to
    start from. Returns design: with status and reason; where nothing is feasible, the last design that was tried.
    """
    prepared = ready or programme(task)
    design = _solved(task, prepared, near, prepared.wall if ready is None else 0.0)
    asked, wall = task.bounds, design.wall
    for _ in range(_ROUNDS):
        over = passed(design) if design.status == "optimal" else {}
        if not over:
            break
        # between its angles, and beside the hardest point, the programme does not look
        radius = design.tracks[0].hardware.radius
        settings = {key: limit.stricter(setting, 1 + over[key] + _LITTLE, radius)
                    for key, limit, setting in asked_of(asked) if key in over}  # fmt: skip
        asked = dataclasses.replace(asked, **settings)
        again = _solved(dataclasses.replace(task, bounds=asked), prepared, design, 0.0)
        wall += again.wall
        if again.status != "optimal":
            break
        design = dataclasses.replace(again, task=task, wall=wall)
    return design


def _solved(task: CoDesignTask, ready: ReadyProgramme, near: CoDesign | None, building: float) -> CoDesign:
    begin = time.perf_counter()
    start = {"x0": ready.start} if near is None else dict(near.solution)
    solved = ipopt(ready.solver, {**start, "p": _values(task), **ready.bounds}, nearly=True)
    return _result(task, ready, solved, time.perf_counter() - begin + building)


def _values(task: CoDesignTask) -> list[float]:
    return [task.ripple, *(setting for _, _, setting in asked_of(task.bounds)), task.widest]


def _motions(
    task: CoDesignTask,
    samples: Samples,
    symbols: list[GuideSymbols],
    flywheel: ca.SX,
    ripple: ca.SX,
    gathered: Gathered,
) -> ca.SX:
    """Motion of each point at each corner of the errors; the ripple of each, shape (k * corners,) [-]."""
    rollers = sum(g.inertia for g in symbols)
    total = ca.DM(samples.inertia) + flywheel + rollers
    sides = (1 - task.robust, 1 + task.robust) if task.robust else (1.0,)
    ripples, given = [], task.losses
    warm = unknowns.warmths(task, samples, symbols, given, gathered) if given else []
    for k, point in enumerate(task.points):
        for errors in itertools.product(sides, repeat=task.springs):
            # the constant of the work is free: g takes it up
            missing, taken = ca.DM(samples.work[k]) + point.omega**2 / 2 * rollers, 0.0
            if given:
                pressures = [e * g.p0[k] for g, e in zip(symbols, errors, strict=True)]
                lost = unknowns.taken(task, point, samples, symbols, pressures, warm[k], given, gathered)
                missing, taken = missing + lost.work, lost.torque
            else:
                missing += sum(
                    task.hardware.charged(e * g.p0[k], **g.values).symbolic().energy(g.path.z)
                    for g, e in zip(symbols, errors, strict=True)
                )
            rows = motion_rows(point, k, samples, missing, total, ripple, taken)
            gathered.add(rows.unknowns, rows.start)
            gathered.group(zip(rows.rows, rows.low, rows.high, strict=True))
            ripples.append(rows.ripple)
    return ca.vertcat(*ripples)


def _result(task: CoDesignTask, ready: ReadyProgramme, solved: Solved, wall: float) -> CoDesign:
    best = solved.values
    coefficients, p0, values, flywheel, ripples = (np.array(v.full()) for v in ready.read(best["x"]))
    tracks = []
    for s in range(task.springs):
        # IPOPT relaxes bounds by 1e-8
        names = task.hardware.values(*_HARDWARE)
        chosen = dict(zip(names, np.maximum(values[:, s], 0.0).tolist(), strict=True))
        chosen[task.hardware.spring.setting[0]] = float(p0[:, s].max())
        hardware = task.hardware.changed(chosen)
        tracks.append(Track(hardware=hardware, z=curve(ready.basis, coefficients[:, s]), p0=p0[:, s]))
    inertia = float(flywheel[0, 0]) if float(flywheel[0, 0]) > _NONE * ready.unit else 0.0
    priced = solved.status == "optimal" and inertia
    costs = -ready.unit * np.array(best["lam_p"]).ravel()
    return CoDesign(
        task=task,
        status=solved.status,
        reason=solved.reason,
        flywheel=inertia,
        tracks=tuple(tracks),
        ripple=ripples.reshape(len(task.points), -1).max(axis=1),
        # what is no solution has no prices, and of no flywheel nothing can be saved
        active=_active(task, costs, inertia + 1e-3 * ready.unit) if priced else (),
        iterations=solved.iterations,
        wall=wall,
        solution={key: np.array(best[from_]).ravel() for key, from_ in
                  (("x0", "x"), ("lam_x0", "lam_x"), ("lam_g0", "lam_g"))},
    )  # fmt: skip


def _active(task: CoDesignTask, costs: np.ndarray, size: float) -> tuple[Active, ...]:
    units = {"ripple": "-", **{key: limit.unit for key, limit, _ in asked_of(task.bounds)}, "track_radius": "m"}
    rows = zip(units.items(), _values(task), costs, strict=True)
    return tuple(
        Active(limit=name, multiplier=float(cost), unit=unit)
        for (name, unit), value, cost in rows
        if abs(cost * value) > _ACTIVE * size
    )


@record
class MotionRows:
    """Unknowns and constraints of one motion, scaled to the order of one."""

    unknowns: ca.SX  #: g by its scale, then the lowest and the highest u [-]
    start: np.ndarray  #: where the unknowns start [-]
    ripple: ca.SX  #: (max - min) / mean over the angles; the programme bounds it from above [-]
    rows: tuple[ca.SX, ...]  #: constraints in pieces: low <= rows <= high [-]
    low: tuple[float, ...]  #: least value of each piece [-]
    high: tuple[float, ...]  #: largest value of each piece [-]


def motion_rows(
    point: Point,
    k: int,
    samples: Samples,
    missing: Joule[Scalar],
    inertia: Inertia[Scalar],
    ripple: Pure[Scalar],
    taken: NewtonMetre[Scalar] = 0.0,
) -> MotionRows:
    """The motion of a point that keeps a ripple.

    missing: work that is wanted and missing; inertia: all inertia that turns; ripple: largest (max - min) / mean of the
    speed; taken: mean torque that the hinge takes from the load.
    """
    n = samples.phi.size
    scale = 0.1 * float(np.ptp(samples.work[k]))
    propeller = point.law == "propeller"
    g = ca.SX.sym(f"g{k}", n if propeller else 1)
    u_low, u_high = ca.SX.sym(f"u_low{k}"), ca.SX.sym(f"u_high{k}")
    lag = g - missing / scale
    squares = 1 + 2 * scale * lag / (inertia * point.omega**2)
    # outside of sensible speeds the square root would leave the programme without a number
    inverse = 1 / ca.sqrt(ca.fmax(squares, 1e-3))
    mean = ca.dot(ca.DM(samples.weights), inverse)
    rows = [squares - u_low**2, squares - u_high**2, (u_high - u_low) * mean - ripple]
    if propeller:
        rate = -2 * (point.load_torque - taken) / (inertia * point.omega**2) * lag
        after = ca.vertcat(rate[1:], rate[0])
        rows.append(ca.vertcat(g[1:], g[0]) - g - ca.DM(samples.step) / 2 * (rate + after))
    else:
        rows.append(mean - 1)
    return MotionRows(
        unknowns=ca.vertcat(g, u_low, u_high),
        start=np.concatenate([np.zeros(g.numel()), [0.9, 1.1]]),
        ripple=(ca.mmax(1 / inverse) - ca.mmin(1 / inverse)) * mean,
        rows=tuple(rows),
        low=(0.0, -np.inf, -np.inf, 0.0),
        high=(np.inf, 0.0, 0.0, 0.0),
    )
