"""Case -> what leaves the tool: its run, with what the parts of it are made of."""

import dataclasses
import math
from collections.abc import Callable, Mapping

import numpy as np
import scipy

from mechsym import cases
from mechsym.cases import Case
from mechsym.cycle.closed.model import closed_period
from mechsym.cycle.friction import NoFriction
from mechsym.cycle.kinds.spark_ignition import SparkIgnition
from mechsym.errors import BadInput
from mechsym.forces.turn import Turn, at
from mechsym.hinge.balance import balance
from mechsym.hinge.fitted import fitted
from mechsym.hinge.guide import Guide, cut
from mechsym.hinge.rollers import RollerParameters
from mechsym.hinge.torque import Hinge, torque
from mechsym.jobs import own, own_gas
from mechsym.jobs.gas import engine_with, one_cylinder
from mechsym.jobs.machine import load, machine
from mechsym.jobs.own import is_own
from mechsym.jobs.problem import braked, problem_of, turned
from mechsym.jobs.train import Cylinders, cylinders
from mechsym.jobs.turn import turn
from mechsym.machine.loads import Load, settle
from mechsym.machine.record import Machine
from mechsym.mechanisms.crank_train.parameters import each
from mechsym.mechanisms.traits import is_train, with_hinge
from mechsym.quantities import record
from mechsym.simulate import Part, Problem
from mechsym.simulate import engine as engines
from mechsym.simulate.engine import load_value
from mechsym.simulate.problem import Kinks, Periodic, Stop
from mechsym.simulate.settings import Simulation

TURNS = 10  # of a run where the case says nothing
_PIECE = math.radians(3.0)  # of a gas that is known as a table
_SAMPLES = 12  # in a piece
_Force = Callable[[np.ndarray], np.ndarray]  # angle [rad] to net force of the gas [N]
_INSIDE = 1e-9  # where the end of a piece is asked for [rad]


@record
class Ready:
    """A run whose parts are still known by what they are made of, so that their numbers can become parameters."""

    problem: Problem
    guide: Guide | None = None  #: of the part `hinge`
    load: Load | None = None  #: settled law of the part `load`, over the speed of the last coordinate


def ready(case: Case, diagram: str | None = None) -> Ready:
    """The run of a case, ready to be exported; without `[simulation]` it runs ten turns."""
    hinged = {"spring", "guide"} <= set(case.sections)
    if is_own(case.mechanism) and not hinged or "drive" in case.sections:
        problem = problem_of(_running(case))
        return Ready(problem=_splined(case, problem) if is_own(case.mechanism) and _by_spark(case) else problem)
    if is_train(case.mechanism):
        return _elastic(case)
    if is_own(case.mechanism) or case.mechanism in with_hinge() and not _by_spark(case):
        return _engine(case, diagram)
    if diagram is not None:
        raise BadInput(f"{case.file}: --diagram needs an engine with crosshead, a case of kind generator")
    return _at_speed(case)


def _by_spark(case: Case) -> bool:
    return isinstance(case.sections.get("cycle"), SparkIgnition)


def named(name: str, settings: Mapping[str, str]) -> Ready:
    """The run of a case by its name or file, with values replaced by dotted key."""
    return ready(cases.load(name, settings))


def guide_named(name: str, settings: Mapping[str, str]) -> tuple[Guide, RollerParameters]:
    """Guide and rollers of a case by its name or file, with values replaced by dotted key."""
    case = cases.load(name, settings)
    guide = guide_of(case)[2]
    if guide is None:
        raise BadInput(f"{case.file}: sections [spring] and [guide] are missing; a guide needs both")
    return guide, case.need("rollers")


def guide_of(case: Case, diagram: str | None = None) -> tuple[Machine, Hinge, Guide | None]:
    """Engine, wanted torque and guide of a case with a hinge; None without `[spring]` and `[guide]`."""
    engine = machine(case, diagram)
    wanted = torque(engine)
    if not {"spring", "guide"} <= set(case.sections):
        return engine, wanted, None
    choices = case.need("guide")
    guide = cut(balance(wanted, choices.balance), case.need("spring"), choices)
    if guide.rho is None:
        raise BadInput(f"{case.file}: no guide can be cut ({guide.reason}); change [spring] or [guide]")
    return engine, wanted, guide


def controlled(case: Case, diagram: str | None = None) -> tuple[Hinge, Guide, Load]:
    """What a controller of a case's spring needs: the wanted torque, the guide, and the settled load."""
    engine, wanted, guide = guide_of(case, diagram)
    if guide is None:
        raise BadInput(f"{case.file}: sections [spring] and [guide] are missing; a controller sets a spring")
    return wanted, guide, settle(engine.load, wanted.load_torque, engine.omega)


def _running(case: Case) -> Case:
    wanted = case.sections.get("simulation") or Simulation(turns=TURNS)
    return dataclasses.replace(case, sections={**case.sections, "simulation": wanted})


def _engine(case: Case, diagram: str | None) -> Ready:
    wanted: Simulation = _running(case).need("simulation")
    engine, hinge, guide = guide_of(case, diagram)
    guide = None if wanted.hinge == "none" else guide
    built = fitted(engine, hinge, guide)
    speed = engine.omega if wanted.speed_start is None else wanted.speed_start
    if wanted.turns is None or speed <= 0:
        raise BadInput(f"{case.file}: an engine needs simulation.turns and a start speed above 0 rad/s; give both")
    problem = engines.problem(built, speed, wanted.turns, wanted.phi_start)
    return Ready(problem=problem, guide=guide, load=built.load)


def _elastic(case: Case) -> Ready:
    """A crank train with gas on the throws of its elastic shaft."""
    running = braked(_running(case))
    gas = _of_spark(running) if _by_spark(case) else cylinders(running)
    problem, law = turned(running, running.need("simulation"), gas)
    return Ready(problem=problem, load=law)


def _of_spark(case: Case) -> Cylinders:
    """The gas of spark ignition at the speed of operation, over the angle of each throw."""
    once, parameters = turn(case), case.need("parameters")
    throws = {f"F{k}": f"phi{throw}" for k, throw in enumerate(parameters.throw, 1)}
    kinks = {name: _kinks(case, once, firing) for name, firing in zip(throws, each(parameters, "firing"), strict=True)}
    followed = {q: sorted({a for n, at in throws.items() if at == q for a in kinks[n]}) for q in throws.values()}
    return Cylinders(
        parts=tuple(_gas(once, name, q, kinks[name]) for name, q in throws.items()),
        kinks=tuple(Kinks(coordinate=q, angles=tuple(at), period=once.period) for q, at in followed.items()),
        torque=float(np.mean(once.torque)),
    )


def _at_speed(case: Case) -> Ready:
    """A mechanism with gas on its pistons at the speed of operation, against the mean torque or the case's load."""
    once = turn(case)
    mechanism, omega = once.drive.mechanism, once.omega
    (q,) = mechanism.coordinates
    kinks = _kinks(case, once, *getattr(case.sections.get("faces"), "firing", (0.0,)))
    law = settle(load(case), float(np.mean(once.torque)), omega)
    load_input = next(n for n in ("M_r", "M") if n in mechanism.inputs)
    parts = [_gas(once, name, q, kinks) for name in once.inputs]
    parts.append(Part(name="load", input=load_input, role="load", value=load_value(law)))
    turn_time = 2 * math.pi / omega
    problem = Problem(
        mechanism=mechanism, parts=tuple(parts), q0=(0.0,), u0=(omega,), t_end=10 * TURNS * turn_time, turns=TURNS,
        kinks=(Kinks(coordinate=q, angles=kinks, period=once.period),) if kinks else (),
        stops=(Stop(name="stall", of=f"{q}d", direction="falling"),), output=turn_time / 360,
    )  # fmt: skip
    return Ready(problem=problem, load=law)


def _splined(case: Case, problem: Problem) -> Problem:
    """The gas of spark ignition on a mechanism from a file as splines between its kinks, each piston's its own."""
    parts, kinks = list(problem.parts), {k.coordinate: set(k.angles) for k in problem.kinks}
    for number, piston in enumerate(own_gas.pistons(case, own.one_coordinate(case))):
        period = piston.gas.pressure.period
        angles = tuple(sorted({round((a + piston.start) % period, 14) for a in _closed_angles(case, number)}))
        place, part = next((i, p) for i, p in enumerate(parts) if p.input == piston.input)
        assert isinstance(part.value, Periodic)
        table = _table(piston.force, angles, period)
        parts[place] = dataclasses.replace(part, value=dataclasses.replace(part.value, value=table, kinks=angles))
        kinks[part.value.coordinate].update(angles)
    asked = tuple(dataclasses.replace(k, angles=tuple(sorted(kinks[k.coordinate]))) for k in problem.kinks)
    return dataclasses.replace(problem, parts=tuple(parts), kinks=asked)


def _closed_angles(case: Case, number: int = 0) -> tuple[float, ...]:
    """Ends of the closed period of a piston and of its combustion, from its firing dead centre [rad]."""
    engine = engine_with(case, NoFriction(), number)
    closed = closed_period(engine, {"omega": case.need("operation").speed})
    return closed.closes, closed.starts, closed.starts + closed.duration, closed.opens


def _gas(once: Turn, name: str, coordinate: str, kinks: tuple[float, ...]) -> Part:
    """A gas force as splines over an angle."""
    table = _table(lambda phi: at(once.drive, once.gas, once.omega, phi).inputs[name], kinks, once.period)
    value = Periodic(coordinate=coordinate, value=table, period=once.period, kinks=kinks)
    return Part(name=f"gas_{name}", input=name, value=value)


def _table(force: _Force, kinks: tuple[float, ...], period: float) -> "scipy.interpolate.PPoly":
    """A gas force as splines between its kinks over its period [rad]: the cycle behind it is a table too."""
    edges = np.unique([0.0, *kinks, period])
    pieces = [_spline(force, a, b) for a, b in zip(edges[:-1], edges[1:], strict=True)]
    rows = np.concatenate([p.c for p in pieces], axis=1)
    breaks = np.concatenate([*(p.x[:-1] for p in pieces), [period]])
    return scipy.interpolate.PPoly(rows, breaks, extrapolate="periodic")


def _spline(force: _Force, first: float, last: float) -> "scipy.interpolate.PPoly":
    """A smooth curve through a piece of the table: of degree 7, so that an integrator of order 8 keeps its order."""
    pieces = max(round((last - first) / _PIECE), 1)
    phi = np.linspace(first, last, _SAMPLES * pieces + 1)
    asked = phi.copy()
    asked[[0, -1]] += np.array([_INSIDE, -_INSIDE])  # the force may jump at an edge
    knots = np.concatenate([[first] * 7, np.linspace(first, last, pieces + 1), [last] * 7])
    poly = scipy.interpolate.PPoly.from_spline(scipy.interpolate.make_lsq_spline(phi, force(asked), knots, k=7))
    return scipy.interpolate.PPoly(poly.c[:, 7:-7], poly.x[7:-7])


def _kinks(case: Case, once: Turn, *firing: float) -> tuple[float, ...]:
    """Angles in a period where a gas force is not smooth [rad]: ends of the closed period and of its combustion."""
    angles = list(once.gas.pressure.kinks if once.gas else ())
    if _by_spark(case):
        angles = list(_closed_angles(one_cylinder(case)))
    return tuple(sorted({float(a + f) % once.period for a in angles for f in firing}))
