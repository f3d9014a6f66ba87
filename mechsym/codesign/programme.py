r"""The programme: shapes of guides, pressures of springs and one small flywheel at once, for all points.

    minimise J   over the shapes z(phi), the pressures p_k, J, and the motion of each point
    subject to   the steady motion of each point keeps the ripple                          (motion_block)
                 spring, track and rollers keep their limits at the hardest points          (contact_block)

Angles are common to all points and contain the kinks. IPOPT with exact derivatives; the splines are sparse. The
multipliers of ripple and limits come out as what one unit of each is worth in flywheel.
"""

import dataclasses
import itertools
import time
from collections.abc import Iterable
from typing import Any

import casadi as ca
import numpy as np

from mechsym.codesign import contact_block, motion_block
from mechsym.codesign.basis import Basis, basis, curve, fitted, matrices
from mechsym.codesign.contact_block import Path
from mechsym.codesign.derivatives import solver
from mechsym.codesign.hardware import Hardware, gas_energy, outside, roller_inertia
from mechsym.codesign.points import Samples, sample
from mechsym.codesign.start import shapes, start_pressures
from mechsym.codesign.task import FREE, MOST_MASS, Active, CoDesign, Task, Track
from mechsym.quantities import quantity, record

_STATUS = {
    "Solve_Succeeded": "optimal",
    "Solved_To_Acceptable_Level": "optimal",
    "Infeasible_Problem_Detected": "infeasible",
}
_OPTIONS: dict[str, Any] = {
    "ipopt": {
        "print_level": 0, "sb": "yes", "tol": 1e-7, "acceptable_tol": 1e-5, "mu_strategy": "adaptive", "max_iter": 400
    },
    "print_time": False,
}  # fmt: skip
_FLYWHEEL = 1000.0  # unit of the flywheel in the programme [kg*m^2]
_SMOOTH = 1e-6  # weight of the mean of z''^2: it decides where nothing else does
_START = 3.0  # flywheel at the start, in units of `_FLYWHEEL`
_ACTIVE = 1e-3  # a limit is met if moving it by itself would move the flywheel by this share
_MASS = 100.0  # unit of a free mass [kg]
_UNITS = {"spring_pressure": "Pa", "closing_share": "-", "pressure_angle": "rad", "profile_radius": "m",
          "roller_reaction": "N", "hertz_stress": "Pa"}  # fmt: skip


@record
class Programme:
    """A task as IPOPT takes it; ripple and limits are parameters, so that a front is one programme."""

    task: Task
    samples: Samples
    basis: Basis
    solver: ca.Function
    read: ca.Function  #: unknowns to coefficients, pressures, hardware, flywheel and ripples in SI
    start: np.ndarray  #: [-]
    bounds: dict[str, np.ndarray]  #: lbx, ubx, lbg, ubg [-]
    wall: float = quantity("s", about="time of building")


@dataclasses.dataclass
class _Gathered:
    """Unknowns and rows while the programme is put together."""

    unknowns: list = dataclasses.field(default_factory=list)
    start: list = dataclasses.field(default_factory=list)
    box: list = dataclasses.field(default_factory=list)
    rows: list = dataclasses.field(default_factory=list)
    low: list = dataclasses.field(default_factory=list)
    high: list = dataclasses.field(default_factory=list)

    def unknown(self, name: str, start: np.ndarray, low: float, high: float) -> Any:
        """A column of unknowns with its start and bounds [-]."""
        found = ca.SX.sym(name, len(start))
        self.add(found, start, low, high)
        return found

    def add(self, symbols: Any, start: np.ndarray, low: float = -np.inf, high: float = np.inf) -> None:
        """Unknowns that exist already, with their start and bounds [-]."""
        self.unknowns.append(symbols)
        self.start.append(np.clip(start, low, high))
        self.box.append(np.tile([low, high], (len(start), 1)))

    def group(self, pieces: Iterable[tuple[Any, Any, Any]]) -> None:
        """Constraints that share terms, in pieces (rows, low, high): low <= rows <= high [-]."""
        self.rows.append([])
        for rows, low, high in pieces:
            self.rows[-1].append(rows)
            self.low.append(np.broadcast_to(low, rows.numel()))
            self.high.append(np.broadcast_to(high, rows.numel()))


def programme(task: Task) -> Programme:
    """Put the programme of a task together."""
    begin = time.perf_counter()
    samples = sample(task.points, round(task.angles * task.points[0].period / (2 * np.pi)))
    kinks = sorted({k for p in task.points for k in p.kinks})
    splines = basis(task.points[0].period, kinks, round(task.knots * task.points[0].period / (2 * np.pi)))
    parameters = ca.SX.sym("parameters", 1 + len(_UNITS))
    all_ = _Gathered()
    tracks = _tracks(task, samples, splines, all_)
    flywheel = all_.unknown("J", np.array([_START]), 0.0, np.inf)
    ripples = _motions(task, samples, tracks, _FLYWHEEL * flywheel, parameters[0], all_)
    _contacts(task, tracks, parameters, all_)
    smooth = sum(ca.sumsqr(t["path"].d2rho) for t in tracks) / samples.phi.size
    chosen = sum(ca.sumsqr(f - 1) for t in tracks for f in t["shares"])
    x = ca.vertcat(*all_.unknowns)
    objective = flywheel + _SMOOTH * (smooth + chosen)
    box = np.vstack(all_.box)
    out = [ca.horzcat(*(t["coefficients"] for t in tracks)), ca.horzcat(*(t["p0"] for t in tracks)),
           ca.horzcat(*(ca.vertcat(*t["values"].values()) for t in tracks)), _FLYWHEEL * flywheel, ripples]  # fmt: skip
    return Programme(
        task=task, samples=samples, basis=splines,
        solver=solver(x, parameters, objective, all_.rows, _OPTIONS),
        read=ca.Function("read", [x], out),
        start=np.concatenate(all_.start),
        bounds={"lbx": box[:, 0], "ubx": box[:, 1], "lbg": np.concatenate(all_.low), "ubg": np.concatenate(all_.high)},
        wall=time.perf_counter() - begin,
    )  # fmt: skip


def solve(task: Task, ready: Programme | None = None, near: CoDesign | None = None) -> CoDesign:
    r"""Guides, pressures and the smallest flywheel for a task.

    .. math:: \min J \quad \text{subject to} \quad \delta_k \le \delta, \; \text{limits}

    Parameters
    ----------
    task : Task
        Points, hardware, limits, ripple
    ready : Programme, optional
        A programme of the same task but for ripple and limits, used again
    near : CoDesign, optional
        A solution of the same programme to start from

    Returns
    -------
    found : CoDesign
        With status and reason; where nothing is feasible, the last design that was tried
    """
    made = ready or programme(task)
    begin = time.perf_counter()
    start = {"x0": made.start} if near is None else {k: near.solution[k] for k in ("x0", "lam_x0", "lam_g0")}
    found = made.solver(**start, p=_values(task), **made.bounds)
    wall = time.perf_counter() - begin + (made.wall if ready is None else 0.0)
    return _result(task, made, found, made.solver.stats(), wall)


def _values(task: Task) -> list[float]:
    return [task.ripple, *(getattr(task.bounds, key) for key in _UNITS)]


def _tracks(task: Task, samples: Samples, splines: Basis, all_: _Gathered) -> list[dict[str, Any]]:
    """Symbols of each guide: coefficients, pressures, values of its hardware, path, energy by pressure, inertia."""
    B, B1, B2 = matrices(splines, samples.phi)
    pressures, found = start_pressures(task, samples), []
    for s, shape in enumerate(shapes(task, samples)):
        values, shares = _hardware(task, s, all_)
        c = all_.unknown(f"z{s}", fitted(splines, shape, samples.phi), -np.inf, np.inf)
        count = 1 if task.schedule == "one" else len(task.points)
        p0 = all_.unknown(f"p{s}", np.ones(count), 1e-3, 1e3) * pressures[s][:count]
        path = _path(task.hardware, B, B1, B2, c, values)
        found.append({
            "coefficients": c, "p0": ca.repmat(p0, len(task.points) // count, 1), "values": values, "path": path,
            "shares": shares, "scale": float(pressures[s].max()),
            "inertia": roller_inertia(path.rho, path.drho, values["moving_mass"], task.hardware.roller_inertia,
                                      values["radius"], task.hardware.count),
        })  # fmt: skip
    return found


def _path(hardware: Hardware, B: Any, B1: Any, B2: Any, c: Any, values: dict[str, Any]) -> Path:
    z = B @ c
    return Path(z=z, rho=values["rho0"] - z / hardware.count, drho=-(B1 @ c) / hardware.count,
                d2rho=-(B2 @ c) / hardware.count)  # fmt: skip


def _hardware(task: Task, s: int, all_: _Gathered) -> tuple[dict[str, Any], list[Any]]:
    given = {name: getattr(task.hardware, name) for name in (*FREE, "moving_mass")}
    values: dict[str, Any] = {name: ca.SX(value) for name, value in given.items()}
    shares = []
    for name in task.free:
        if name == "moving_mass":
            values[name] = _MASS * all_.unknown(f"{name}{s}", np.array([1.0]), 0.0, MOST_MASS / _MASS)
        else:
            shares.append(all_.unknown(f"{name}{s}", np.array([1.0]), *FREE[name]))
            values[name] = given[name] * shares[-1]
    if task.hardware.count == 2 and set(task.free) & {"rho0", "H", "radius"}:
        # between the roller centres lie 2 rho = H - z + (2 rho0 - H); the rest beside the gas must hold both rollers
        all_.group([(values["rho0"] - values["H"] / 2 - values["radius"], 0.0, np.inf)])
    return values, shares


def _motions(task: Task, samples: Samples, tracks: list, flywheel: Any, ripple: Any, all_: _Gathered) -> Any:
    """Motion of each point at each corner of the errors; the ripple of each, shape (k * corners,) [-]."""
    hardware, pa = task.hardware, outside(task.hardware)
    rollers = sum(t["inertia"] for t in tracks)
    total = ca.DM(samples.inertia) + flywheel + rollers
    corners = list(itertools.product(*([(1 - task.robust, 1 + task.robust)] * task.springs))) if task.robust else []
    ripples = []
    for k, point in enumerate(task.points):
        # the constant of the work is free: g takes it up
        wanted = ca.DM(samples.work[k])
        for errors in corners or [(1.0,) * task.springs]:
            missing = wanted + point.omega**2 / 2 * rollers
            for track, error in zip(tracks, errors, strict=True):
                values, p0 = track["values"], error * track["p0"][k]
                energy = values["A"] * gas_energy(track["path"].z, p0, values["H"], hardware.n, pa)
                missing += energy
            made = motion_block.block(point, k, samples, missing, total, ripple, _left(task, samples, k))
            all_.add(made.unknowns, made.start)
            all_.group(zip(made.rows, made.low, made.high, strict=True))
            ripples.append(made.ripple)
    return ca.vertcat(*ripples)


def _left(task: Task, samples: Samples, k: int) -> np.ndarray:
    """Missing work of the start, which fits every point but for the shape of its work [J]."""
    return np.zeros(samples.phi.size) if task.springs else samples.work[k]


def _contacts(task: Task, tracks: list, parameters: Any, all_: _Gathered) -> None:
    """Limits where spring and rollers are asked most: at the largest pressure of the schedule and the highest speed."""
    bounds = dataclasses.make_dataclass("SymbolicBounds", list(_UNITS))(*ca.vertsplit(parameters[1:]))
    fastest = max(p.omega for p in task.points)
    for s, track in enumerate(tracks):
        scale = track["scale"]
        largest = scale * all_.unknown(f"p_max{s}", np.array([1.0]), 1e-3, 1e3)
        found = contact_block.ratios(
            track["path"], task.hardware, bounds, largest * (1 + task.robust), fastest, track["values"]
        )  # fmt: skip
        all_.group([*found.values(), ((track["p0"] - largest) / scale, -np.inf, 0.0)])


def _result(task: Task, made: Programme, found: Any, stats: Any, wall: float) -> CoDesign:
    coefficients, p0, values, flywheel, ripples = (np.array(v.full()) for v in made.read(found["x"]))
    names = (*FREE, "moving_mass")
    tracks = []
    for s in range(task.springs):
        chosen = {name: float(v) for name, v in zip(names, values[:, s], strict=True)}
        hardware = dataclasses.replace(task.hardware, p0=float(p0[:, s].max()), **chosen)
        tracks.append(Track(hardware=hardware, z=curve(made.basis, coefficients[:, s]), p0=p0[:, s]))
    status = stats["return_status"]
    return CoDesign(
        task=task, status=_STATUS.get(status, "not converged"), reason=str(status).replace("_", " ").lower(),
        flywheel=max(0.0, float(flywheel[0, 0])), tracks=tuple(tracks), ripple=ripples.reshape(len(task.points), -1).max(axis=1),
        active=_active(task, np.array(found["lam_p"]).ravel(), float(flywheel[0, 0])),
        iterations=int(stats["iter_count"]), wall=wall,
        solution={"x0": np.array(found["x"]).ravel(), "lam_x0": np.array(found["lam_x"]).ravel(),
                  "lam_g0": np.array(found["lam_g"]).ravel()},
    )  # fmt: skip


def _active(task: Task, sensitivity: np.ndarray, flywheel: float) -> tuple[Active, ...]:
    units = {"ripple": "-", **_UNITS}
    rows = zip(units.items(), _values(task), -_FLYWHEEL * sensitivity, strict=True)
    least = _ACTIVE * (flywheel + 1.0)
    return tuple(
        Active(limit=name, multiplier=float(cost), unit=unit)
        for (name, unit), value, cost in rows
        if abs(cost * value) > least
    )
