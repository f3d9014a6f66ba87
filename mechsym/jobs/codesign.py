"""`mechsym codesign`: case -> operating points -> bound -> guides, pressures, flywheel -> verified, losses, misfire."""

import dataclasses
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from mechsym import cases
from mechsym.cases import Case
from mechsym.codesign import family, loss, scenarios
from mechsym.codesign.family import Place
from mechsym.codesign.front import cut_for_one, front
from mechsym.codesign.hardware import Bounds, Hardware
from mechsym.codesign.misfire import unfired, unfired_kinks
from mechsym.codesign.points import Point, bare_flywheel
from mechsym.codesign.programme import programme, solve
from mechsym.codesign.rank import rank
from mechsym.codesign.result import CoDesignResult
from mechsym.codesign.schedule import RippleMap, ripple_map
from mechsym.codesign.settings import CoDesignSettings
from mechsym.codesign.task import CoDesign, Task
from mechsym.codesign.uncertainty import spread
from mechsym.codesign.verify import verify
from mechsym.errors import BadInput
from mechsym.hinge import torque as hinge
from mechsym.hinge.choices import ROLLERS
from mechsym.hinge.losses import Losses
from mechsym.jobs.machine import Assembly, assemble
from mechsym.mechanisms.record import curves

_SHARES = (0.12, 1.1)  # loads of the map by the full load
_LOADS = 12  # computed; those between are interpolated
_MAP = 50  # speeds and loads of the map
STEPS = 6  # how often `codesign` calls `progress`, besides once for each ripple of a front


def codesign(
    case: Case,
    settings: CoDesignSettings,
    ripples: Sequence[float] = (),
    progress: Callable[[], Any] = lambda: None,
) -> CoDesignResult:
    """Guides, pressures and flywheel of a case for its range of speeds and loads.

    Parameters
    ----------
    settings : CoDesignSettings
        The case's own, or changed by options
    ripples : sequence of float
        Of a front, besides the one that is wanted [-]
    """
    task = task_of(case, settings)
    progress()
    bound = rank(task.points)
    bare = bare_flywheel(task.points, task.ripple)
    progress()
    cut = cut_for_one(task, _middle(task))
    progress()
    ready = programme(task)
    design = _heavy_enough(solve(task, ready), settings.misfire_speed)
    progress()
    designs = front(task, ripples, ready, progress)
    verified = verify(design)
    progress()
    assumed = case.sections.get("losses", Losses())
    lost, misfire = loss.losses(design, assumed), scenarios.misfire_shares(design)
    lossy = tuple(loss.with_losses(design, k, assumed) for k in range(len(task.points)))
    progress()
    return CoDesignResult(
        name=case.name, about=case.about, design=design, bound=bound, bare=bare, cut=cut, verified=verified,
        losses=lost, assumed=assumed, lossy=lossy, misfire=tuple(misfire), front=tuple(designs),
    )  # fmt: skip


def for_report(case: Case, settings: CoDesignSettings, result: CoDesignResult) -> CoDesignResult:
    """The result with what only the report shows: scenarios, spread under small errors, map over speed and load."""
    design, high = result.design, settings.full_speed
    one = len(design.tracks) == 1 and settings.curve == "propeller"
    return dataclasses.replace(
        result,
        scenarios=tuple(scenarios.table(design)),
        spread=spread(design),
        map=_map(case, settings, design, 1.05 * max(*settings.speeds, high)) if one else None,
    )


def task_of(case: Case, settings: CoDesignSettings) -> Task:
    """Points, hardware and limits of a case."""
    return Task(
        points=points(case, settings),
        hardware=hardware(case, settings.moving_mass),
        bounds=Bounds(**{f.name: getattr(case.need("limits"), f.name) for f in dataclasses.fields(Bounds)}),
        ripple=settings.ripple,
        springs=int(settings.springs),
        schedule=settings.schedule,
        robust=settings.robust,
        free=tuple(name.rpartition(".")[2] for name in settings.free),
        knots=int(settings.knots),
        angles=int(settings.angles),
    )


def points(case: Case, settings: CoDesignSettings) -> tuple[Point, ...]:
    """The operating points of a case."""
    high = cases.load(settings.high_case).need("cycle") if settings.high_case else None
    law = "constant" if settings.curve == "constant_speed" else "propeller"
    found = []
    for place in family.places(settings):
        cycle = family.cycle_at(case.need("cycle"), high, settings, place.mep)
        operation = dataclasses.replace(case.need("operation"), speed=place.omega)
        at = dataclasses.replace(case, sections={**case.sections, "cycle": cycle, "operation": operation})
        found.append(point(assemble(at), place, law))
    return tuple(found)


def point(engine: Assembly, place: Place, law: str) -> Point:
    """An engine at one speed and load as a point of a co-design; `law` is `propeller` or `constant`."""
    torques, wanted = engine.torques, hinge.build(engine.torques, engine.omega)
    without = unfired(engine.force, torques.period)
    (q,) = engine.mechanism.coordinates

    def misfire(phi: np.ndarray) -> np.ndarray:
        return np.asarray(without(phi) * curves(engine.mechanism, phi)[f"dx_d{q}"] + torques.gravity_torque(phi))

    return Point(
        omega=wanted.omega, load=place.mep, load_torque=wanted.load_torque, law=law, weight=place.weight,
        period=wanted.period, work=wanted.work, inertia=wanted.inertia, misfire=misfire,
        torque=lambda phi: torques.gas_torque(phi) + torques.gravity_torque(phi), kinks=tuple(torques.kinks),
        misfire_kinks=unfired_kinks(torques.kinks, torques.period),
    )  # fmt: skip


def hardware(case: Case, moving_mass: float) -> Hardware:
    """Spring, guide and rollers of a case, with a mass [kg] on each roller."""
    spring, guide, rollers = case.need("spring"), case.need("guide"), case.need("rollers")
    law = {"AirAbsolute": "air_absolute", "AirGauge": "air_gauge"}.get(type(spring).__name__)
    if law is None:
        raise BadInput(f'{case.file}: codesign takes a gas spring; write [spring] law = "air_absolute" or "air_gauge"')
    return Hardware(
        law=law, A=spring.A, H=spring.H, n=spring.n, pa=getattr(spring, "pa", 101325.0), p0=spring.p0, rho0=guide.rho0,
        z_margin=guide.z_margin, count=ROLLERS[guide.arrangement], shaft_ratio=guide.shaft_ratio,
        radius=rollers.radius, width=rollers.width, E=rollers.E, nu=rollers.nu, moving_mass=moving_mass,
    )  # fmt: skip


def _map(case: Case, settings: CoDesignSettings, design: CoDesign, fastest: float) -> RippleMap:
    shares = tuple(np.linspace(_SHARES[0], _SHARES[1], _LOADS).tolist())
    family_ = dataclasses.replace(settings, curve="constant_speed", speeds=(settings.full_speed,), loads=shares)
    loads = points(case, family_)
    omega = np.linspace(0.9 * min(settings.speeds), fastest, _MAP)
    return ripple_map(design, loads, omega, np.linspace(loads[0].load, loads[-1].load, _MAP))


def _middle(task: Task) -> int:
    swings = [float(np.ptp(p.work(np.linspace(0, p.period, 181)))) for p in task.points]
    return int(np.argsort(swings)[(len(swings) - 1) // 2])


def _heavy_enough(design: CoDesign, misfire_speed: float) -> CoDesign:
    """The design with the flywheel that a lost combustion asks for, if that is more."""
    if misfire_speed <= 0 or design.status != "optimal":
        return design
    needed = scenarios.misfire_flywheel(design, misfire_speed)
    return design if needed is None else dataclasses.replace(design, flywheel=needed)
