r"""The same task at several ripples, and what a guide that is cut for one point alone would need instead.

Pressure of the spring over speed and load, and the ripple that it keeps. The wanted work is affine in omega^2 at a
given load: a few loads are enough for a whole map.

What else evens a shaft out at the same points: a cam with coil springs, a flywheel behind noncircular gears.

.. math:: \text{coil springs:}\; \min_S \max_k \frac{\mathrm{ptp}(W_k - S)}{\omega_k^2}, \qquad
          \text{gears:}\; \min_S \max_k \mathrm{ptp}\Bigl(\frac{W_k}{\omega_k^2} - S\Bigr), \quad I_f = C - 2 S

A coil spring stores one work S at every point, whatever the speed and the load: nobody sets it anew. A flywheel behind
noncircular gears of the ratio g'(phi) stores I_f omega^2/2, I_f = J_f g'^2: it follows the square of the speed by
itself, and the load not at all. Both shapes are the best there are, by a linear programme; the motion is exact. A cam
of coil springs without mass and gears without limits but that of their ratio: no real one does better.
"""

import dataclasses
from collections.abc import Callable, Sequence

import numpy as np
import scipy

from mechsym.codesign.certificate import rollers_inertia
from mechsym.codesign.points import Function, Point, bare_flywheel, motion, sample, speed, swing
from mechsym.codesign.programme import ReadyProgramme, programme, solve
from mechsym.codesign.running import added_inertia
from mechsym.codesign.task import CoDesign, CoDesignTask
from mechsym.codesign.unknowns import closing
from mechsym.errors import BadInput
from mechsym.hinge.balance import STOPPED, or_stopped, propeller_load_squares, ripple
from mechsym.hinge.guide import setting_of
from mechsym.hinge.springs.face import affine_energy
from mechsym.periodic.roots import minimum, root
from mechsym.quantities import record
from mechsym.quantities.results import part, quantity, result
from mechsym.quantities.units import Array, Inertia, Pascal, Pure, RadPerSecond

_ANGLES = 180
_GOLDEN = (5**0.5 - 1) / 2
_STEPS = 30  # of the golden section
_SCHEDULE_FAR = (0.4, 2.5)  # pressures that are tried, by the ratio of the works


@record
class RippleMap:
    """The best pressure of one spring over speed and load."""

    omega: np.ndarray  #: shape (m,) [rad/s]
    load: np.ndarray  #: mean indicated pressure, shape (n,) [Pa]
    p0: np.ndarray  #: shape (m, n) [Pa]
    ripple: np.ndarray  #: shape (m, n); 2 where the shaft stops [-]


def ripple_map(design: CoDesign, loads: Sequence[Point], omega: RadPerSecond[Array], load: Pascal[Array]) -> RippleMap:
    """Ripple and pressure of a design with one spring under propeller load, for all pairs of speed and load.

    loads: the machine at ascending loads, at any speed; omega: speeds, shape (m,); load: mean indicated pressures,
    within those of the points.
    """
    if len(design.tracks) != 1:
        raise BadInput("the map is that of one spring; a design with several has a schedule for its points")
    (track,), period = design.tracks, loads[0].period
    phi = np.arange(_ANGLES) * period / _ANGLES
    inertia = loads[0].inertia(phi)
    gas = scipy.interpolate.PchipInterpolator(
        [p.load for p in loads], [p.work(phi) - p.omega**2 / 2 * p.inertia(phi) for p in loads]
    )(load)
    torque = scipy.interpolate.PchipInterpolator([p.load for p in loads], [p.load_torque for p in loads])(load)
    rollers = added_inertia(track, phi)
    total = inertia + rollers + design.flywheel
    square = omega[:, None, None] ** 2
    wanted = (gas[None] + square / 2 * (inertia + rollers)).reshape(-1, _ANGLES)
    fixed, by_p0 = affine_energy(track.hardware.spring, track.z(phi))
    speeds, torques = np.repeat(omega, load.size), np.tile(torque, omega.size)
    guess = np.ptp(wanted, axis=1) / np.ptp(by_p0)

    def ripple(p0: np.ndarray) -> np.ndarray:
        return _ripples(wanted + fixed + p0[:, None] * by_p0, total, speeds, torques, period)

    # where many functions of one number each are smallest
    a, b = (_SCHEDULE_FAR[0] * guess).copy(), (_SCHEDULE_FAR[1] * guess).copy()
    c, d = b - _GOLDEN * (b - a), a + _GOLDEN * (b - a)
    fc, fd = ripple(c), ripple(d)
    for _ in range(_STEPS):
        left = fc < fd
        a, b = np.where(left, a, c), np.where(left, d, b)
        c, d = np.where(left, b - _GOLDEN * (b - a), d), np.where(left, c, a + _GOLDEN * (b - a))
        new = ripple(np.where(left, c, d))
        fc, fd = np.where(left, new, fd), np.where(left, fc, new)
    p0 = (a + b) / 2
    shape = (omega.size, load.size)
    return RippleMap(omega=omega, load=load, p0=p0.reshape(shape), ripple=ripple(p0).reshape(shape))


def _ripples(
    missing: np.ndarray, inertia: np.ndarray, omega: np.ndarray, torque: np.ndarray, period: float
) -> np.ndarray:
    """Ripple of many motions at once under propeller load, in rows."""
    speed = omega[:, None]
    squares = propeller_load_squares(missing, inertia, speed, torque[:, None], period) / speed**2
    u = np.sqrt(np.maximum(squares, 1e-12))
    lowest, weak = squares.min(axis=1), np.ptp(u, axis=1) * np.mean(1 / u, axis=1)
    return np.where(lowest <= 0, STOPPED - lowest, weak)


_EVEN = 720
_FAR = (0.5, 2.0)  # pressures that are tried, by the ratio of the works


def front(
    task: CoDesignTask,
    ripples: Sequence[Pure],
    ready: ReadyProgramme | None = None,
    progress: Callable[[], object] = lambda: None,
    saving: Pure = 0.0,
) -> list[CoDesign]:
    """The best flywheel for each ripple, smallest ripple first; one programme, each solve starts from the one before.

    ripples: allowed (max - min) / mean of the speed; ready: of the same task but for ripple and limits; saving: share
    of the bare flywheel that a hinge must save. Returns designs: one for each ripple, in ascending order.
    """
    designs: list[CoDesign] = []
    if ripples:
        ready = ready or programme(task)
    for wanted in sorted(ripples):
        asked = dataclasses.replace(task, ripple=wanted)
        near = designs[-1] if designs and designs[-1].status == "optimal" else None
        design = solve(asked, ready, near)
        if near is not None and design.status != "optimal":
            design = solve(asked, ready)
        designs.append(worth_it(design, bare_flywheel(task.points, wanted), saving))
        progress()
    return designs


def worth_it(design: CoDesign, bare: float, saving: float) -> CoDesign:
    """The design, infeasible where its flywheel is not enough below the bare one [kg*m^2] by the share `saving` [-].

    A flywheel that is free makes up for any hinge: without this no limit could ever be too narrow. Where hardware is
    free the rollers count as flywheel.
    """
    most = (1 - saving) * bare
    left = design.flywheel + (rollers_inertia(design) if design.task.free else 0.0)
    if design.status != "optimal" or left <= most or bare == 0:
        return design
    met = ", ".join(a.limit for a in design.active if a.limit != "ripple") or "no limit but the ripple"
    words = (
        f"a hinge within these limits leaves {left:.5g} of {bare:.5g} kg*m^2, and {most:.5g} is the most "
        f"that codesign.saving = {saving:g} allows; active: {met}"
    )
    return dataclasses.replace(design, status="infeasible", reason=words)


@record
class CutForOne:
    """A guide cut exactly for one point, its pressure set anew at each of the others."""

    at: int  #: the point that it is cut for
    flywheel: float | None = quantity("kg*m^2", about="that keeps the ripple at all points; None where none does")
    p0: np.ndarray  #: shape (k,), pressures with the least ripple [Pa]
    ripple: np.ndarray  #: shape (k,), with that flywheel [-]


def cut_for_one(task: CoDesignTask, at: int) -> CutForOne:
    """What the guide of one point needs at all points; rollers without mass, as the exact guide has them."""
    hardware, points = task.hardware, task.points
    phi = np.arange(_EVEN) * points[0].period / _EVEN
    work = np.array([p.work(phi) for p in points])
    spring = hardware.spring
    least, setting = float(spring.energy(hardware.z_margin)), setting_of(spring)
    z = closing(hardware, least + work[at].max() - work[at], setting, spring.H * (1 - 1e-6))
    fixed, by_p0 = affine_energy(spring, z)
    own = points[0].inertia(phi)
    guess = setting * np.ptp(work, axis=1) / np.ptp(work[at])

    def best(k: int, flywheel: float) -> tuple[float, float]:
        def at_pressure(p0: float) -> float:
            missing = work[k] + fixed + p0 * by_p0
            return _ripple(points[k], missing - missing.mean(), own + flywheel)

        return minimum(at_pressure, _FAR[0] * guess[k], _FAR[1] * guess[k], 1e-5 * guess[k])

    def excess(flywheel: float) -> float:
        return max(best(k, flywheel)[1] for k in range(len(points))) - task.ripple

    high = size = swing(points)
    while excess(high) > 0 and high < _MOST * size:
        high *= 3
    flywheel = 0.0 if excess(0.0) <= 0 else root(excess, 0.0, high, xtol=1e-6 * size) if high < _MOST * size else None
    rows = [best(k, flywheel or high) for k in range(len(points))]
    return CutForOne(at=at, flywheel=flywheel, p0=np.array([r[0] for r in rows]), ripple=np.array([r[1] for r in rows]))


def _ripple(point: Point, missing: np.ndarray, inertia: np.ndarray) -> float:
    """Ripple [-]; where the shaft stops a number that is larger than any and grows with the missing work."""
    beyond = float(np.ptp(missing)) / (float(inertia.max()) * point.omega**2)
    return or_stopped(ripple(speed(point, missing, inertia)), beyond)


_RATIO = 3.0  # largest by smallest ratio of noncircular gears (assumed)
_MOST = 1e5  # flywheels that are tried, by the swing of the works


@result
class Rival:
    """Another way to keep a ripple at the same points."""

    name: str = part()
    ripple: float = quantity("-")  #: That it keeps
    flywheel_inertia: float | None = quantity("kg*m^2")  #: Added; None where it cannot keep the ripple
    about: str = part()  #: What is assumed
    swing: float | None  #: What its shape leaves of the works by the square of the speed [kg*m^2]


def peers(points: Sequence[Point], ripples: Sequence[float]) -> list[Rival]:
    """A plain flywheel, a cam with coil springs and a flywheel behind noncircular gears, for each ripple [-]."""
    # angles [rad], the best fixed work [J] and the best work by the square of the speed [kg*m^2]
    samples = sample(points, round(_ANGLES * points[0].period / (2 * np.pi)))
    square = samples.omega[:, None] ** 2
    phi, cam, gears = samples.phi, _best(samples.work, square), _best(samples.work / square, np.ones_like(square))
    left_cam, left_gears = _left(points, phi, cam, None), _left(points, phi, gears, 2.0)
    rows = []
    for wanted in sorted(ripples):
        rows += [
            Rival(name="plain flywheel", ripple=wanted, flywheel_inertia=bare_flywheel(points, wanted),
                 swing=_left(points, phi, 0 * cam, None), about="no hinge"),
            Rival(name="cam with coil springs", ripple=wanted, flywheel_inertia=cam_flywheel(points, phi, cam, wanted),
                 swing=left_cam, about="one preload for all points, massless, any shape, no limit of contact"),
            Rival(name="noncircular gears", ripple=wanted, flywheel_inertia=gear_flywheel(points, phi, gears, wanted),
                 swing=left_gears, about=f"ratio within {_RATIO:g} to 1 (assumed), teeth without play or loss"),
        ]  # fmt: skip
    return rows


def springs_of(task: CoDesignTask, ripples: Sequence[float], springs: int) -> list[Rival]:
    """Co-designed guides with another number of springs, for each ripple [-]; within the limits of the task."""
    designs = front(dataclasses.replace(task, springs=springs), ripples)
    words = {1: "one spring", 2: "two springs", 3: "three springs"}[springs]
    about = "co-designed within the same limits, a pressure for each point and spring"
    return [
        Rival(
            name=words,
            ripple=d.task.ripple,
            flywheel_inertia=d.flywheel if d.status == "optimal" else None,
            swing=None,
            about=about,
        )
        for d in designs
    ]


def cam_flywheel(points: Sequence[Point], phi: np.ndarray, stored: np.ndarray, wanted: float) -> float | None:
    """Flywheel [kg*m^2] beside a work [J] over angles [rad] that is the same at every point, for a ripple [-]."""

    def of(point: Point, flywheel: float) -> float:
        fixed = _at(point, phi, stored)
        return _ripple_of(point, lambda x: point.work(x) - fixed(x), lambda x: point.inertia(x) + flywheel)

    def worst(flywheel: float) -> float:
        return max(of(p, flywheel) for p in points)

    return _least(worst, wanted, swing(points))


def gear_flywheel(points: Sequence[Point], phi: np.ndarray, shape: Inertia[Array], wanted: float) -> float | None:
    """Inertia J_f of a flywheel whose gears turn it as the square of the speed asks, for a ripple [-].

    shape: work by the square of the speed.
    """

    def reduced(more: float) -> np.ndarray:
        # I_f takes the shape away; what is more of it is a plain flywheel
        return np.asarray(2 * (shape.max() - shape) + least + more)

    # the lightest that the ratio allows
    least = 2 * float(np.ptp(shape)) / (_RATIO**2 - 1)

    def of(point: Point, more: float) -> float:
        turned, half = _at(point, phi, reduced(more)), point.omega**2 / 2
        return _ripple_of(point, lambda x: point.work(x) + half * turned(x), lambda x: point.inertia(x) + turned(x))

    def worst(more: float) -> float:
        return max(of(p, more) for p in points)

    more = _least(worst, wanted, swing(points))
    # the flywheel turns as often as the shaft: the mean of its ratio is one
    return None if more is None else float(np.mean(np.sqrt(reduced(more)))) ** 2


def _best(works: np.ndarray, scale: np.ndarray) -> np.ndarray:
    """S with the smallest max_k ptp(works_k - S) / scale_k, a linear programme."""
    sparse, (k, n) = scipy.sparse, works.shape
    size = float(np.ptp(works / scale, axis=1).max()) or 1.0
    weight = 1 / scale.ravel()
    columns = sparse.csr_matrix(weight[:, None])
    by_shape, by_low = (
        sparse.kron(columns, sparse.identity(n)),
        sparse.kron(sparse.identity(k), np.ones((n, 1))),
    )
    target = (works / scale).ravel() / size
    # low_k <= (works - S)/scale <= low_k + D, S in units of its own
    ones = sparse.csr_matrix(np.ones((k * n, 1)))
    unit = float(scale.mean())
    matrix = sparse.vstack(
        [sparse.hstack([unit * by_shape, by_low, 0 * ones]), sparse.hstack([-unit * by_shape, -by_low, -ones])]
    ).tocsr()
    cost = np.concatenate([np.zeros(n + k), [1.0]])
    optimum = scipy.optimize.linprog(
        cost, A_ub=matrix, b_ub=np.concatenate([target, -target]), bounds=(None, None), method="highs"
    )
    return np.asarray(optimum.x[:n]) * unit * size


def _left(points: Sequence[Point], phi: np.ndarray, shape: np.ndarray, power: float | None) -> float:
    """Largest swing [kg*m^2] that a shape leaves, which goes with the speed to a power, or not at all."""
    return max(float(np.ptp(p.work(phi) / p.omega**2 - shape * (1.0 if power else 1 / p.omega**2))) for p in points)


def _at(point: Point, phi: np.ndarray, values: np.ndarray) -> Function:
    def function(angle: np.ndarray) -> np.ndarray:
        return np.interp(np.asarray(angle) % point.period, phi, values, period=point.period)

    return function


def _ripple_of(point: Point, missing: Function, inertia: Function) -> float:
    def centred(phi: np.ndarray) -> np.ndarray:
        work = missing(phi)
        return np.asarray(work - work.mean())

    value = ripple(motion(point, centred, inertia)[1])
    return 10.0 if value is None else value


def _least(worst: Callable[[float], float], wanted: float, size: float) -> float | None:
    """The smallest inertia with which `worst` is at most what is wanted [-]; it and its size in [kg*m^2]."""
    if worst(0.0) <= wanted:
        return 0.0
    high = size
    while worst(high) > wanted:
        high *= 3
        if high > _MOST * size:
            return None
    return root(lambda x: worst(x) - wanted, 0.0, high, xtol=1e-6 * high)
