"""`mechsym codesign`: case -> operating points -> bound -> guides, pressures, flywheel -> verified, losses, misfire."""

import dataclasses
from collections.abc import Callable, Sequence

import numpy as np

from mechsym import budget, cases
from mechsym.cases import Case
from mechsym.cases.needs import require
from mechsym.codesign import loss, machines, scenarios
from mechsym.codesign.certificate import floor, rollers_inertia
from mechsym.codesign.front import Rival, cut_for_one, front, peers, ripple_map, springs_of, worth_it
from mechsym.codesign.machines import hardware, point
from mechsym.codesign.points import Point, bare_flywheel
from mechsym.codesign.programme import programme, solve
from mechsym.codesign.rank import Count, counts, rank
from mechsym.codesign.realise import RealisedNumbers, chosen, realise
from mechsym.codesign.result import CoDesignNumbers, CoDesignResult
from mechsym.codesign.settings import CoDesignSettings
from mechsym.codesign.task import CoDesignTask
from mechsym.codesign.verify import Verified, spread, verify
from mechsym.cycle.kinds import kind_of
from mechsym.errors import BadInput
from mechsym.hinge.rollers import HingeLosses, LossTorques
from mechsym.jobs.machine import machine
from mechsym.machine.torque_curve import TorqueCurve
from mechsym.quantities import RPM
from mechsym.quantities.records import Record
from mechsym.quantities.results import part, result
from mechsym.quantities.units import Pure

_SHARES = (0.12, 1.1)  # loads of the map by the full load
_LOADS = 12  # computed; those between are interpolated
_SCAVENGE = 0.1  # of the scavenge pressure that is missing in a scenario
_LOSSY = (40, 240)  # most knots and least angles in a turn of a programme with friction and heat in it
# time of a co-design and of each of its points [s]: measured on zotov-89 at 2 and 12 points
_ONCE, _PER_POINT = 5.0, 0.65
_HALF = 0.5  # of the speed that the picture's lost combustion leaves
_MAP = 50  # speeds and loads of the map
STEPS = 6  # how often `codesign` calls `progress`, besides once for each ripple of a front


def codesign(
    case: Case,
    settings: CoDesignSettings,
    ripples: Sequence[Pure] = (),
    progress: Callable[[], object] = lambda: None,
) -> CoDesignResult:
    """Guides, pressures and flywheel of a case for its range of speeds and loads.

    settings: the case's own, or changed by options; ripples: of a front, besides the one that is wanted.
    """
    require(case, "codesign")
    points = len(settings.speeds) * len(settings.loads)
    seconds = (_ONCE + _PER_POINT * points) * (1 + len(ripples))
    what = f"a co-design of {points} points" + f" for {1 + len(ripples)} ripples" * bool(ripples)
    budget.require(what, seconds, 0.0, "give fewer --speeds, --loads or --pareto")
    task = task_of(case, settings)
    progress()
    bound = rank(task.points)
    bare = bare_flywheel(task.points, task.ripple)
    progress()
    swings = [float(np.ptp(p.work(np.linspace(0, p.period, 181)))) for p in task.points]
    cut = cut_for_one(task, int(np.argsort(swings)[(len(swings) - 1) // 2]))  # the point with the middle swing
    progress()
    ready = programme(task)
    best = worth_it(solve(task, ready), bare, settings.saving)
    design = best
    if settings.misfire_speed > 0 and best.status == "optimal":
        # the limits are prices of the smaller flywheel, not of that which a lost combustion asks for
        needed = scenarios.misfire_flywheel(best, settings.misfire_speed)
        design = best if needed is None else dataclasses.replace(best, flywheel=needed, active=())
    given = solve(dataclasses.replace(task, free=())) if task.free else None
    progress()
    designs = front(task, ripples, ready, progress, settings.saving)
    verified = verify(design)
    progress()
    assumed, taken, misfire = _losses(case), _taken(case, settings), scenarios.misfire_shares(design)
    if taken == "none":
        lost, lossy = _ideal(verified)
    else:
        lost = loss.losses(design, assumed)
        lossy = tuple(loss.with_losses(design, k, assumed) for k in range(len(task.points)))
    progress()
    return CoDesignResult(
        name=case.name, about=case.about, design=design, given=given, bound=bound, bare=bare, cut=cut,
        floor=floor(design, bound, verified.steady_ripple), verified=verified,
        losses=lost, assumed=assumed, lossy=lossy, taken=taken, misfire=tuple(misfire), front=tuple(designs),
    )  # fmt: skip


def compared(result: CoDesignResult, progress: Callable[[], object] = lambda: None) -> CoDesignResult:
    """The result with its peers at the ripples of its front: flywheel, coil springs, noncircular gears, two springs."""
    task = result.design.task
    ripples = sorted({task.ripple, *(d.task.ripple for d in result.front)})
    others = peers(task.points, ripples)
    progress()
    to_save = any(d.flywheel > 0 for d in (result.design, *result.front))  # a second spring saves nothing of nothing
    more = springs_of(task, ripples, 2) if task.springs == 1 and len(task.points) > 1 and to_save else []
    progress()
    return dataclasses.replace(result, peers=(*others, *more))


@result
class Beside:
    """What else was asked of a co-design; left out where it was not."""

    peers: tuple[Rival, ...] = part(default=(), optional=True)  #: Other machines at the same points
    cylinders: tuple[Count, ...] = part(default=(), optional=True)  #: Several cylinders on one shaft
    realised: RealisedNumbers | None = part(default=None, optional=True)  #: Other hardware


@result
class CoDesignAnswer:
    """A co-design in numbers."""

    numbers: CoDesignNumbers = part(inline=True)
    beside: Beside = part(inline=True)


def beside(result: CoDesignResult, cylinders: int, goal: str, progress: Callable[[], object] = lambda: None) -> Beside:
    """What 1 to `cylinders` of these cylinders need, and the hardware of least `goal`; nothing of what is not asked."""
    rows: tuple[Count, ...] = ()
    other, task = None, result.design.task
    if cylinders:
        rows = tuple(counts(task.points, task.ripple, cylinders, rollers_inertia(result.design)))
        progress()
    if goal:
        new = realise(result.design, goal)
        tracks = new.design.tracks
        other = RealisedNumbers(
            goal=goal, status=new.status, before=new.before, after=new.after,
            p0=tuple(tuple(track.p0.tolist()) for track in tracks),
            guides=tuple(chosen(track.hardware) for track in tracks),
        )  # fmt: skip
        progress()
    return Beside(peers=result.peers, cylinders=rows, realised=other)


def for_report(case: Case, settings: CoDesignSettings, result: CoDesignResult) -> CoDesignResult:
    """The result with what only the report shows: scenarios, spread under small errors, map over speed and load."""
    design, drawn = result.design, None
    if len(design.tracks) == 1 and design.task.losses is None and settings.curve == "propeller":
        full = settings.full_speed
        shares = tuple(np.linspace(_SHARES[0], _SHARES[1], _LOADS).tolist())
        loads = points(case, dataclasses.replace(settings, curve="constant_speed", speeds=(full,), loads=shares))
        omega = np.linspace(0.9 * min(settings.speeds), 1.05 * max(*settings.speeds, full), _MAP)
        drawn = ripple_map(design, loads, omega, np.linspace(loads[0].load, loads[-1].load, _MAP))
    # what else happens at the first and the last point
    designs = []
    for k in sorted({0, len(design.task.points) - 1}):
        place = machines.places(settings)[k]
        cycle, lower = _acting(case, settings, place.mep).get("cycle"), None
        if cycle is not None and (key := kind_of(cycle).scavenge):
            changed = dataclasses.replace(cycle, **{key: (1 - _SCAVENGE) * getattr(cycle, key)})
            lower = _point(case, settings, place, {"cycle": changed})
        designs += scenarios.rows(design, k, lower)
    return dataclasses.replace(
        result,
        scenarios=(*scenarios.table(design), *designs),
        spread=spread(design),
        map=drawn,
        misfire_floor=scenarios.misfire_flywheel(design, _HALF, 0.0) if design.status == "optimal" else None,
    )


def settings_of(case: Case) -> CoDesignSettings:
    """Section `[codesign]` of a case; without one its own speed and load, and the mass on its rollers."""
    require(case, "codesign")
    if "codesign" in case.sections:
        return case.need("codesign")
    engine, rollers = machine(case), case.need("rollers")
    mean = 0.0 if engine.gas is None else abs(engine.gas.pressure.mean_indicated)
    if mean == 0:
        raise BadInput(
            f"{case.file}: codesign sizes for shares of a full load, and it has no mean indicated pressure to "
            "stand for it; give [codesign] full_load, a label in Pa, with speeds and full_speed"
        )
    return CoDesignSettings(
        speeds=(engine.omega,), curve="constant_speed", full_speed=engine.omega, full_load=mean, scavenge="",
        moving_mass=rollers.moving_mass,
    )  # fmt: skip


def codesign_task(case: Case) -> CoDesignTask:
    """Points, hardware and limits of a case, as its section `[codesign]` asks; without one at its own speed."""
    return task_of(case, settings_of(case))


def task_of(case: Case, settings: CoDesignSettings) -> CoDesignTask:
    """Points, hardware and limits of a case for other settings than its own."""
    inside, knots, angles = _taken(case, settings) == "inside", int(settings.knots), int(settings.angles)
    if inside:  # with friction a guide of many knots would find its way between the angles
        knots, angles = min(knots, _LOSSY[0]), max(angles, _LOSSY[1])
    return CoDesignTask(
        points=points(case, settings),
        hardware=hardware(case.need("spring"), case.need("guide"), case.need("rollers"), settings.moving_mass),
        bounds=case.need("limits"), ripple=settings.ripple, springs=int(settings.springs), schedule=settings.schedule,
        robust=settings.robust, losses=_losses(case) if inside else None,
        free=tuple(name.rpartition(".")[2] for name in settings.free), track_radius=settings.track_radius,
        knots=knots, angles=angles,
    )  # fmt: skip


def _taken(case: Case, settings: CoDesignSettings) -> str:
    """Where friction and heat are taken: in the programme where the case tells of its losses."""
    by_case = "inside" if "losses" in case.sections else "beside"
    return by_case if settings.losses == "by_case" else settings.losses


def _ideal(verified: Verified) -> tuple[tuple[LossTorques, ...], tuple[loss.Lossy, ...]]:
    """No losses at each point, and the ripple that is left then."""
    none = LossTorques(**dict.fromkeys(loss.KINDS, 0.0))
    columns = (verified.steady_ripple, verified.time_ripple, verified.energy_residual)
    rows = [[float(v) if np.isfinite(v) else None for v in row] for row in zip(*columns, strict=True)]
    lossy = tuple(loss.Lossy(ripple=a, time_ripple=b, energy_residual=c, fill=1.0) for a, b, c in rows)
    return (none,) * len(rows), lossy


def _losses(case: Case) -> HingeLosses:
    return case.sections.get("losses", HingeLosses())


def points(case: Case, settings: CoDesignSettings) -> tuple[Point, ...]:
    """The operating points of a case."""
    places = machines.places(settings)
    return tuple(_point(case, settings, place, _acting(case, settings, place.mep)) for place in places)


def _point(case: Case, settings: CoDesignSettings, place: machines.SpeedAndLoad, acting: dict[str, Record]) -> Point:
    operation = dataclasses.replace(case.need("operation"), speed=place.omega)
    at = dataclasses.replace(case, sections={**case.sections, **acting, "operation": operation})
    engine = machine(at)
    if abs(engine.omega - place.omega) > 1e-6 * place.omega:
        raise BadInput(
            f"{case.file}: the diagram is of {engine.omega / RPM:.6g} rpm and not at {place.omega / RPM:.6g} rpm; "
            "leave --speeds away, or make a point of each diagram (examples/codesign_generator.py)"
        )
    law = "constant" if settings.curve == "constant_speed" else "propeller"
    return point(engine, place.mep, law, place.weight)


def _acting(case: Case, settings: CoDesignSettings, mep: float) -> dict[str, Record]:
    """Cycle at a mean indicated pressure [Pa], or torque curve at that share of its full load."""
    if "torque" in case.sections:
        curve: TorqueCurve = case.need("torque")
        return {"torque": dataclasses.replace(curve, load=curve.load * mep / settings.full_load)}
    high = cases.load(settings.high_case).need("cycle") if settings.high_case else None
    return {"cycle": machines.cycle_at(case.need("cycle"), high, settings, mep)}
