"""Case -> what leaves the tool: its run, with what its parts are made of, and the machine in motion, to scale."""

import contextlib
import dataclasses
import math
from collections.abc import Callable, Mapping, Sequence

import numpy as np
import scipy

from mechsym import cases
from mechsym.cases import Case
from mechsym.cases.needs import NO_FILE, require
from mechsym.cycle.closed.model import closed_period
from mechsym.cycle.friction import NoFriction
from mechsym.cycle.kinds import kind_of
from mechsym.errors import BadInput
from mechsym.files import Json
from mechsym.forces.arrows import charged, pressed
from mechsym.hinge.guide import Guide
from mechsym.hinge.rollers import RollerParameters
from mechsym.hinge.shown import hinge_scene
from mechsym.hinge.torque import Hinge
from mechsym.jobs.forces import motion
from mechsym.jobs.gas import engine_with, gas, measured, one_cylinder
from mechsym.jobs.machine import acting_on, drive_of, mechanism_of, one_coordinate, turn
from mechsym.jobs.problem import Ready, beyond, guide_of
from mechsym.jobs.problem import ready as running
from mechsym.machine.loads import Load, settle
from mechsym.mechanisms import listing
from mechsym.mechanisms.drawing import Shapes, declared, drawn, extent_of
from mechsym.mechanisms.drawn_parts import turns_round
from mechsym.mechanisms.record import Mechanism
from mechsym.mechanisms.turning import FRAMES, Course, scene
from mechsym.periodic.pieces import PPoly
from mechsym.simulate import Settings, simulate
from mechsym.simulate.constrained import LOCKED
from mechsym.simulate.problem import Kinks, Periodic, Problem
from mechsym.simulate.settings import Simulation

TURNS = 10  # of a run where the case says nothing
_PIECE = math.radians(3.0)  # of a gas that is known as a table
_SAMPLES = 12  # in a piece
_Force = Callable[[np.ndarray], np.ndarray]  # angle [rad] to net force of the gas [N]
_MOST_TURNS, _LAST_TURNS = 4, 2  # more turns of a run are too quick for a picture, which shows so many
_FEW = 24  # results, with which two turns are no picture
_FLAT = 0.05  # height of a picture by its width that shows nothing
_INSIDE = 1e-9  # where the end of a piece is asked for [rad]


def ready(case: Case, diagram: str | None = None, command: str = "export") -> Ready:
    """The run of a case, ready to be exported; without `[simulation]` it runs ten turns. command: that wants it."""
    require(case, command, NO_FILE if diagram else "")
    if diagram is not None:
        if "cycle" not in case.sections or "drive" in case.sections or _by_spark(case):
            raise BadInput(f"{case.file}: --diagram needs an engine with crosshead and [cycle], as the case generator")
        case = measured(case, diagram)
    wanted = case.sections.get("simulation") or Simulation(turns=TURNS)
    # its own run in time may go on through a dead point of the closed forms: then by constraint
    case = beyond(dataclasses.replace(case, sections={**case.sections, "simulation": wanted}))
    prepared = running(case)
    if "sides" in prepared.problem.mechanism.functions and not prepared.problem.unilateral:
        run = simulate(prepared.problem, dataclasses.replace(Settings(), check="none"))
        prepared = running(beyond(case, ends=True)) if run.end == LOCKED else prepared
    return dataclasses.replace(prepared, problem=_splined(case, prepared.problem)) if _by_spark(case) else prepared


def _by_spark(case: Case) -> bool:
    return "cycle" in case.sections and kind_of(case.need("cycle")).closed


def named(name: str, settings: Mapping[str, str]) -> Ready:
    """The run of a case by its name or file, with values replaced by dotted key."""
    return ready(cases.load(name, settings))


def guide_named(name: str, settings: Mapping[str, str]) -> tuple[Guide, RollerParameters]:
    """Guide and rollers of a case by its name or file, with values replaced by dotted key."""
    case = cases.load(name, settings)
    return guide_of(case)[2], case.need("rollers")


def controlled(case: Case, diagram: str | None = None) -> tuple[Hinge, Guide, Load]:
    """What a controller of a case's spring needs: the wanted torque, the guide, and the settled load."""
    engine, wanted, guide = guide_of(case, diagram)
    return wanted, guide, settle(engine.load, wanted.load_torque, engine.omega)


def _splined(case: Case, problem: Problem) -> Problem:
    """The gas of spark ignition as splines between its kinks: its cycle is known as a table."""
    kinks = {k.coordinate: {round(a, 14) for a in k.angles} for k in problem.kinks}
    acts, parts = acting_on(case, drive_of(case)), []
    for part in problem.parts:
        starts = [(number, one.face.fires) for number, one in enumerate(acts) if one.face.input == part.input]
        if starts and isinstance(part.value, Periodic):
            period, number = part.value.period, 0 if len({one.gas for one in acts}) == 1 else starts[0][0]
            # ends of the closed period of the piston and of its combustion, from its firing dead centre
            engine = engine_with(one_cylinder(case), NoFriction(), number)
            closed = closed_period(engine, {"omega": case.need("operation").speed})
            ends = closed.closes, closed.starts, closed.starts + closed.duration, closed.opens
            angles = tuple(sorted({round((a + fires) % period, 14) for a in ends for _, fires in starts}))
            # splines between its kinks: the cycle behind the force is a table too
            edges = np.unique([0.0, *angles, period])
            pieces = [_spline(part.value.value, a, b) for a, b in zip(edges[:-1], edges[1:], strict=True)]
            rows = np.concatenate([p.c for p in pieces], axis=1)
            breaks = np.concatenate([*(p.x[:-1] for p in pieces), [period]])
            table = PPoly(rows, breaks, extrapolate="periodic")
            kinks.setdefault(part.value.coordinate, set()).update(angles)
            part = dataclasses.replace(part, value=dataclasses.replace(part.value, value=table, kinks=angles))
        parts.append(part)
    period = max(one.gas.pressure.period for one in acts)
    asked = tuple(Kinks(coordinate=q, angles=tuple(sorted(angles)), period=period) for q, angles in kinks.items())
    return dataclasses.replace(problem, parts=tuple(parts), kinks=asked)


def _spline(force: _Force, first: float, last: float) -> PPoly:
    """A smooth curve through a piece of the table: of degree 7, so that an integrator of order 8 keeps its order."""
    pieces = max(round((last - first) / _PIECE), 1)
    phi = np.linspace(first, last, _SAMPLES * pieces + 1)
    asked = phi.copy()
    asked[[0, -1]] += np.array([_INSIDE, -_INSIDE])  # the force may jump at an edge
    knots = np.concatenate([[first] * 7, np.linspace(first, last, pieces + 1), [last] * 7])
    poly = scipy.interpolate.PPoly.from_spline(scipy.interpolate.make_lsq_spline(phi, force(asked), knots, k=7))
    return PPoly(poly.c[:, 7:-7], poly.x[7:-7])


def drawing(case: Case) -> tuple[Callable[[float], Shapes], Course | None] | None:
    """Crank angle [rad] to the machine of a case as its declaration draws it; None where nothing draws it.

    What does not turn round is drawn over its motion, which takes one turn of that angle; its course then.
    """
    with contextlib.suppress(BadInput):
        acting = gas(case)
        bore = None if acting is None else float(acting.chamber.bore)
        shapes = drawn(case.mechanism, case.need("parameters"), lambda: one_coordinate(case), bore)
        if "motion" not in case.sections and shapes is not None and turns_round(shapes):
            return shapes, None
    with contextlib.suppress(BadInput):
        return _in_motion(case)
    return None


def _in_motion(case: Case) -> tuple[Callable[[float], Shapes], Course] | None:
    """A drawing over a motion: there and back again as `[motion]` drives it, else as it runs in time."""
    back = "motion" in case.sections
    if back:
        mechanism, table = mechanism_of(case), motion(case).columns
        t = table["t"]
    else:
        problem = ready(case).problem
        run = simulate(problem, dataclasses.replace(Settings(), check="none"))
        mechanism, table, t = problem.mechanism, run.columns, run.t
    t, once = np.unique(t, return_index=True)  # an event may have two rows
    rows = np.array([table[q] for q in mechanism.coordinates])[:, once]
    turned = _turned(mechanism, rows)
    last = turned <= 2 * math.pi * _LAST_TURNS
    if not back and turned[0] > 2 * math.pi * _MOST_TURNS and np.count_nonzero(last) > _FEW:
        rows, t = rows[:, last], t[last]
    curve = scipy.interpolate.CubicSpline((t - t[0]) / (t[-1] - t[0]), rows.T)

    def pose(angle: float) -> Sequence[float]:
        share = angle / (2 * math.pi)
        return curve(1 - abs(1 - 2 * share) if back else share).tolist()

    shapes = declared(mechanism, listing(mechanism.name), pose)
    if shapes is None:
        return None
    left, right, low, high = extent_of(shapes)
    if min(right - left, high - low) < _FLAT * max(right - left, high - low):
        return None  # dots along a line
    return shapes, Course(starts=float(t[0]), lasts=float(t[-1] - t[0]), back=back)


def _turned(mechanism: Mechanism, rows: np.ndarray) -> np.ndarray:
    """How far the coordinate that turns most has still to turn, at each time [rad]."""
    left = np.abs(rows - rows[:, -1:])
    angles = [mechanism.units.get(q, "rad") == "rad" for q in mechanism.coordinates]
    return max(left[angles], key=lambda row: float(row[0]), default=np.zeros(rows.shape[1]))


def loaded(scenes: list[Json], case: Case) -> list[Json]:
    """Scenes of a case whose first shows its gas and what presses in its joints; as they are where nothing is known."""
    if not scenes or "operation" not in case.sections:
        return scenes
    try:
        one = turn(case)
    except BadInput:
        return scenes
    return [pressed(charged(scenes[0], one.drive, one.acting), one), *scenes[1:]]


def turning(case: Case, guide: Guide | None = None) -> list[Json]:
    """The machine of a case as a page turns it, and the hinge of a guide; nothing of one without a drawing."""
    drawn_as, scenes = drawing(case), []
    turns = 1 if guide is None else max(1, round(1 / guide.parameters.shaft_ratio))
    if drawn_as is not None:
        shapes, course = drawn_as
        scenes.append(scene(shapes, "the machine to scale", turns, turns * FRAMES, course))
    if guide is not None:
        scenes.append(hinge_scene(guide, case.need("rollers"), turns, turns * FRAMES))
    return loaded(scenes, case)
