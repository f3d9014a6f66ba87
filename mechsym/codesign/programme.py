r"""The programme: shapes of guides, pressures of springs and one small flywheel at once, for all points.

    minimise J   over the shapes z(phi), the pressures p_k, J, and the motion of each point
    subject to   the steady motion of each point keeps the ripple                          (motion_block)
                 spring, track and rollers keep their limits where they are asked most      (contact_block)
                 friction and heat, if the task asks for them                               (loss_block)

Angles are common to all points and contain the kinks. IPOPT with exact derivatives; the splines are sparse. The
multipliers of ripple and limits come out as what one unit of each is worth in flywheel.
"""

import dataclasses
import itertools
import time
from typing import Any

import casadi as ca
import numpy as np

from mechsym.codesign import contact_block, loss_block, motion_block
from mechsym.codesign.basis import Basis, basis, curve
from mechsym.codesign.derivatives import solver
from mechsym.codesign.hardware import Bounds, gas_energy, outside
from mechsym.codesign.points import Samples, sample
from mechsym.codesign.task import FREE, Active, CoDesign, CoDesignTask, Track
from mechsym.codesign.unknowns import Gathered, GuideSymbols, guides
from mechsym.codesign.verify import passed
from mechsym.quantities import quantity, record

_STATUS = {
    "Solve_Succeeded": "optimal",
    "Solved_To_Acceptable_Level": "optimal",
    "Infeasible_Problem_Detected": "infeasible",
}
_OPTIONS: dict[str, Any] = {
    "ipopt": {"print_level": 0, "sb": "yes", "tol": 1e-7, "acceptable_tol": 1e-5, "max_iter": 400},
    "print_time": False,
}
_FLYWHEEL = 1000.0  # unit of the flywheel in the programme [kg*m^2]
_SMOOTH = 1e-6  # weight of the mean of z''^2 and of free hardware: it decides where nothing else does
_START = 3.0  # flywheel at the start, in units of `_FLYWHEEL`
_ROUNDS, _LITTLE = 4, 2e-3  # of solving again where a limit is passed; share beyond that each is moved by [-]
_ACTIVE = 1e-3  # a limit is met if moving it by itself would move the flywheel by this share
_UNITS = {"spring_pressure": "Pa", "closing_share": "-", "pressure_angle": "rad", "profile_radius": "m",
          "roller_reaction": "N", "hertz_stress": "Pa"}  # fmt: skip
_HARDWARE = (*FREE, "moving_mass")


@record
class ReadyProgramme:
    """A task as IPOPT takes it; ripple and limits are parameters, so that a front is one programme."""

    task: CoDesignTask
    basis: Basis
    solver: ca.Function
    read: ca.Function  #: unknowns to coefficients, pressures, hardware, flywheel and ripples in SI
    start: np.ndarray  #: [-]
    bounds: dict[str, np.ndarray]  #: lbx, ubx, lbg, ubg [-]
    wall: float = quantity("s", about="time of building")


def programme(task: CoDesignTask) -> ReadyProgramme:
    """Put the programme of a task together."""
    begin, turns = time.perf_counter(), task.points[0].period / (2 * np.pi)
    samples = sample(task.points, round(task.angles * turns))
    kinks = sorted({k for p in task.points for k in p.kinks})
    splines = basis(task.points[0].period, kinks, round(task.knots * turns))
    parameters, gathered = ca.SX.sym("parameters", 1 + len(_UNITS)), Gathered()
    found = guides(task, samples, splines, gathered)
    flywheel = gathered.unknown("J", np.array([_START]), 0.0)
    ripples = _motions(task, samples, found, _FLYWHEEL * flywheel, parameters[0], gathered)
    _contacts(task, found, parameters, gathered)
    smooth = sum(ca.sumsqr(g.path.d2rho) for g in found) / samples.phi.size
    chosen = sum(ca.sumsqr(share - 1) for g in found for share in g.shares)
    x, box = ca.vertcat(*gathered.unknowns), np.vstack(gathered.box)
    values = [ca.vertcat(*(g.values[name] for name in _HARDWARE)) for g in found]
    read = [ca.horzcat(*(g.coefficients for g in found)), ca.horzcat(*(g.p0 for g in found)), ca.horzcat(*values),
            _FLYWHEEL * flywheel, ripples]  # fmt: skip
    return ReadyProgramme(
        task=task, basis=splines,
        solver=solver(x, parameters, flywheel + _SMOOTH * (smooth + chosen), gathered.rows, _options(task)),
        read=ca.Function("read", [x], read), start=np.concatenate(gathered.start),
        bounds={"lbx": box[:, 0], "ubx": box[:, 1], "lbg": np.concatenate(gathered.low),
                "ubg": np.concatenate(gathered.high)},
        wall=time.perf_counter() - begin,
    )  # fmt: skip


def _options(task: CoDesignTask) -> dict[str, Any]:
    """The barrier falls step by step: adaptive, some systems without losses fill up for half a minute."""
    strategy = "adaptive" if task.losses else "monotone"
    return {**_OPTIONS, "ipopt": {**_OPTIONS["ipopt"], "mu_strategy": strategy}}


def solve(task: CoDesignTask, ready: ReadyProgramme | None = None, near: CoDesign | None = None) -> CoDesign:
    r"""Guides, pressures and the smallest flywheel for a task.

    .. math:: \min J \quad \text{subject to} \quad \delta_k \le \delta, \; \text{limits}

    Parameters
    ----------
    ready : ReadyProgramme, optional
        A programme of the same task but for ripple and limits, used again
    near : CoDesign, optional
        A solution of the same programme to start from

    Returns
    -------
    found : CoDesign
        With status and reason; where nothing is feasible, the last design that was tried
    """
    made = ready or programme(task)
    found = _solved(task, made, near, made.wall if ready is None else 0.0)
    asked, wall = task.bounds, found.wall
    for _ in range(_ROUNDS):
        over = passed(found) if found.status == "optimal" else {}
        if not over:
            break
        # between its angles, and beside the hardest point, the programme does not look
        asked = _tighter(asked, over, found.tracks[0].hardware.radius)
        again = _solved(dataclasses.replace(task, bounds=asked), made, found, 0.0)
        wall += again.wall
        if again.status != "optimal":
            break
        found = dataclasses.replace(again, task=task, wall=wall)
    return found


def _tighter(bounds: Bounds, over: dict[str, float], radius: float) -> Bounds:
    """Limits moved by what they are passed [-], and a little; rollers have a radius [m]."""
    changed = {key: getattr(bounds, key) / (1 + share + _LITTLE) for key, share in over.items()}
    if "profile_radius" in over:
        changed["profile_radius"] = (radius + bounds.profile_radius) * (1 + over["profile_radius"] + _LITTLE) - radius
    return dataclasses.replace(bounds, **changed)


def _solved(task: CoDesignTask, made: ReadyProgramme, near: CoDesign | None, building: float) -> CoDesign:
    begin = time.perf_counter()
    start = {"x0": made.start} if near is None else dict(near.solution)
    found = made.solver(**start, p=_values(task), **made.bounds)
    return _result(task, made, found, time.perf_counter() - begin + building)


def _values(task: CoDesignTask) -> list[float]:
    return [task.ripple, *(getattr(task.bounds, key) for key in _UNITS)]


def _motions(
    task: CoDesignTask, samples: Samples, found: list[GuideSymbols], flywheel: Any, ripple: Any, gathered: Gathered
) -> Any:
    """Motion of each point at each corner of the errors; the ripple of each, shape (k * corners,) [-]."""
    rollers = sum(g.inertia for g in found)
    total = ca.DM(samples.inertia) + flywheel + rollers
    sides = (1 - task.robust, 1 + task.robust) if task.robust else (1.0,)
    ripples, given = [], task.losses
    warm = loss_block.warmths(task, samples, found, given, gathered) if given else []
    for k, point in enumerate(task.points):
        for errors in itertools.product(sides, repeat=task.springs):
            # the constant of the work is free: g takes it up
            missing, taken = ca.DM(samples.work[k]) + point.omega**2 / 2 * rollers, 0.0
            if given:
                pressures = [e * g.p0[k] for g, e in zip(found, errors, strict=True)]
                lost = loss_block.taken(task, point, samples, found, pressures, warm[k], given, gathered)
                missing, taken = missing + lost.work, lost.torque
            else:
                missing += sum(_energy(task, g, k, e) for g, e in zip(found, errors, strict=True))
            made = motion_block.block(point, k, samples, missing, total, ripple, taken)
            gathered.add(made.unknowns, made.start)
            gathered.group(zip(made.rows, made.low, made.high, strict=True))
            ripples.append(made.ripple)
    return ca.vertcat(*ripples)


def _energy(task: CoDesignTask, guide: GuideSymbols, k: int, error: float) -> Any:
    """Energy of a spring at a point [J], with its pressure off by a factor."""
    of, H = task.hardware, guide.values["H"]
    return guide.values["A"] * gas_energy(guide.path.z, error * guide.p0[k], H, of.n, outside(of))


def _contacts(task: CoDesignTask, found: list[GuideSymbols], parameters: Any, gathered: Gathered) -> None:
    """Limits where spring and rollers are asked most: at the largest pressure of the schedule and the highest speed."""
    bounds = dataclasses.make_dataclass("SymbolicBounds", list(_UNITS))(*ca.vertsplit(parameters[1:]))
    fastest = task.hardware.shaft_ratio * max(p.omega for p in task.points)
    for guide in found:
        largest = (1 + task.robust) * guide.largest
        rows = contact_block.ratios(guide.path, task.hardware, bounds, largest, fastest, guide.values)
        gathered.group([*rows.values(), ((guide.p0 - guide.largest) / guide.scale, -np.inf, 0.0)])


def _result(task: CoDesignTask, made: ReadyProgramme, found: Any, wall: float) -> CoDesign:
    coefficients, p0, values, flywheel, ripples = (np.array(v.full()) for v in made.read(found["x"]))
    tracks = []
    for s in range(task.springs):
        # IPOPT relaxes bounds by 1e-8
        chosen: dict[str, Any] = dict(zip(_HARDWARE, np.maximum(values[:, s], 0.0).tolist(), strict=True))
        hardware = dataclasses.replace(task.hardware, p0=float(p0[:, s].max()), **chosen)
        tracks.append(Track(hardware=hardware, z=curve(made.basis, coefficients[:, s]), p0=p0[:, s]))
    stats, inertia = made.solver.stats(), max(0.0, float(flywheel[0, 0]))
    return CoDesign(
        task=task,
        status=_STATUS.get(stats["return_status"], "not converged"),
        reason=str(stats["return_status"]).replace("_", " ").lower(),
        flywheel=inertia,
        tracks=tuple(tracks),
        ripple=ripples.reshape(len(task.points), -1).max(axis=1),
        active=_active(task, np.array(found["lam_p"]).ravel(), inertia),
        iterations=int(stats["iter_count"]),
        wall=wall,
        solution={key: np.array(found[from_]).ravel() for key, from_ in
                  (("x0", "x"), ("lam_x0", "lam_x"), ("lam_g0", "lam_g"))},
    )  # fmt: skip


def _active(task: CoDesignTask, sensitivity: np.ndarray, flywheel: float) -> tuple[Active, ...]:
    units = {"ripple": "-", **_UNITS}
    rows = zip(units.items(), _values(task), -_FLYWHEEL * sensitivity, strict=True)
    least = _ACTIVE * (flywheel + 1.0)
    return tuple(
        Active(limit=name, multiplier=float(cost), unit=unit)
        for (name, unit), value, cost in rows
        if abs(cost * value) > least
    )
