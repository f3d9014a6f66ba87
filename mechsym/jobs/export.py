"""From a case to what leaves the tool: its run, with what the parts of it are made of."""

import dataclasses
import math
from collections.abc import Mapping
from typing import Any

import numpy as np
from scipy.interpolate import PPoly, make_lsq_spline

from mechsym import periodic
from mechsym.cases import Case
from mechsym.cycle.closed.model import closed_period
from mechsym.cycle.kinds.spark_ignition import SparkIgnition
from mechsym.cycle.on_pistons import one_cylinder
from mechsym.errors import BadInput
from mechsym.forces.turn import Turn, at, one_coordinate, turn
from mechsym.hinge import balance, guide
from mechsym.hinge import torque as hinge
from mechsym.hinge.guide import Guide
from mechsym.jobs.cycle import engine as closed_engine
from mechsym.jobs.machine import assemble, load_of, running
from mechsym.jobs.run import Simulation, problem_of
from mechsym.machine.loads import Load, settle
from mechsym.quantities import record
from mechsym.simulate import Kinks, Part, Problem, Stop
from mechsym.simulate import engine as engines
from mechsym.simulate.engine import load_value

TURNS = 10  # of a run where the case says nothing
_PIECE = math.radians(3.0)  # of a gas that is known as a table
_SAMPLES = 12  # in a piece
_INSIDE = 1e-9  # where the end of a piece is asked for [rad]


@record
class Ready:
    """A run whose parts are still known by what they are made of, so that their numbers can become parameters."""

    problem: Problem
    guide: Guide | None = None  #: of the part `hinge`
    load: Load | None = None  #: settled law of the part `load`, over the speed of the first coordinate
    tables: Mapping[str, PPoly] = dataclasses.field(default_factory=dict)  #: parts that are curves, over its angle


def ready(case: Case, diagram: str | None = None) -> Ready:
    """The run of a case, ready to be exported; without `[simulation]` it runs ten turns."""
    if "drive" in case.sections or case.mechanism == "crank_train":
        return Ready(problem=problem_of(_running(case)))
    if case.mechanism == "crosshead" and not isinstance(case.sections.get("cycle"), SparkIgnition):
        return _engine(case, diagram)
    return _at_speed(case)


def _running(case: Case) -> Case:
    wanted = case.sections.get("simulation") or Simulation(turns=TURNS)
    return dataclasses.replace(case, sections={**case.sections, "simulation": wanted})


def guide_of(case: Case, diagram: str | None = None) -> tuple[Any, Any, Guide | None]:
    """Engine, wanted torque and guide of a case with a hinge; None without `[spring]` and `[guide]`."""
    engine = assemble(case, diagram)
    wanted = hinge.build(engine.torques, engine.omega)
    if not {"spring", "guide"} <= set(case.sections):
        return engine, wanted, None
    choices = case.need("guide")
    cut = guide.build(balance.build(wanted, choices.balance), case.need("spring"), choices)
    if cut.rho is None:
        raise BadInput(f"{case.file}: no guide can be cut ({cut.reason}); change [spring] or [guide]")
    return engine, wanted, cut


def _engine(case: Case, diagram: str | None) -> Ready:
    engine, wanted, cut = guide_of(case, diagram)
    engine_ready = running(engine, wanted, load_of(case), cut)
    section = case.sections.get("simulation")
    speed = getattr(section, "speed_start", None) or engine.omega
    turns = getattr(section, "turns", None) or TURNS
    problem = engines.problem(engine_ready, speed, turns, getattr(section, "phi_start", 0.0))
    return Ready(problem=problem, guide=cut, load=engine_ready.load)


def _at_speed(case: Case) -> Ready:
    """A mechanism with gas on its pistons at the speed of operation, against the mean torque or the case's load."""
    mechanism, omega, once = one_coordinate(case), case.need("operation").speed, turn(case)
    load_input = next(n for n in ("M_r", "M") if n in mechanism.inputs)
    (q,) = mechanism.coordinates
    kinks = _kinks(case, once)
    tables = {f"gas_{name}": _table(case, once, name, kinks) for name in once.inputs}
    law = settle(load_of(case), float(np.mean(once.torque)), omega)
    parts = [Part(name=n, input=n.removeprefix("gas_"), value=_callable(poly)) for n, poly in tables.items()]
    parts.append(Part(name="load", input=load_input, role="load", value=load_value(law)))
    turn_time = 2 * math.pi / omega
    problem = Problem(
        mechanism=mechanism, parts=tuple(parts), q0=(0.0,), u0=(omega,), t_end=10 * TURNS * turn_time, turns=TURNS,
        kinks=(Kinks(coordinate=q, angles=kinks, period=once.period),) if kinks else (),
        stops=(Stop(name="stall", of=f"{q}d", direction="falling"),), output=turn_time / 360,
    )  # fmt: skip
    return Ready(problem=problem, load=law, tables=tables)


def _table(case: Case, once: Turn, name: str, kinks: tuple[float, ...]) -> PPoly:
    """A gas force as splines between its kinks: the cycle behind it is a table too."""
    edges = np.unique([0.0, *kinks, once.period])
    pieces = [_spline(case, once, name, a, b) for a, b in zip(edges[:-1], edges[1:], strict=True)]
    rows = np.concatenate([p.c for p in pieces], axis=1)
    breaks = np.concatenate([*(p.x[:-1] for p in pieces), [once.period]])
    return PPoly(rows, breaks, extrapolate="periodic")


def _spline(case: Case, once: Turn, name: str, first: float, last: float) -> PPoly:
    """A smooth curve through a piece of the table: of degree 7, so that an integrator of order 8 keeps its order."""
    pieces = max(round((last - first) / _PIECE), 1)
    phi = np.linspace(first, last, _SAMPLES * pieces + 1)
    asked = phi.copy()
    asked[[0, -1]] += np.array([_INSIDE, -_INSIDE])  # the force may jump at an edge
    force = at(case, once.mechanism, once.gas, once.omega, asked).inputs[name]
    knots = np.concatenate([[first] * 7, np.linspace(first, last, pieces + 1), [last] * 7])
    poly = PPoly.from_spline(make_lsq_spline(phi, force, knots, k=7))
    return PPoly(poly.c[:, 7:-7], poly.x[7:-7])


def _kinks(case: Case, once: Turn) -> tuple[float, ...]:
    """Angles in a period where a gas force is not smooth [rad]: ends of the closed period and of its combustion."""
    angles = list(once.gas.kinks if once.gas else ())
    if isinstance(case.sections.get("cycle"), SparkIgnition):
        closed = closed_period(closed_engine(one_cylinder(case)), {"omega": once.omega})
        angles = [closed.closes, closed.starts, closed.starts + closed.duration, closed.opens]
    firing = getattr(case.sections.get("faces"), "firing", (0.0,))
    return tuple(sorted({float(a + f) % once.period for a in angles for f in firing}))


def _callable(poly: PPoly) -> Any:
    point = periodic.scalar(poly)
    return lambda t, q, u: point(q[0])[0]
