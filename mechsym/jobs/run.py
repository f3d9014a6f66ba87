"""Case -> run in time: problem -> integration and audit -> speeds, twist of the shaft, start-ups explained; and
the cycle in motion, whose gas follows the speed.
"""

import math
import re
from collections.abc import Mapping
from dataclasses import asdict, replace
from typing import Annotated

import numpy as np

from mechsym import mechanisms
from mechsym.cases import Case
from mechsym.cases.at_start import of_start
from mechsym.cases.facts import facts_of
from mechsym.cases.needs import require
from mechsym.cases.outcomes import of_run
from mechsym.cases.settings import count_loop, guesses, settings_of, simulation_of
from mechsym.cycle.chamber import piston_area
from mechsym.cycle.closed.performance import performance
from mechsym.cycle.kinds import kind_of
from mechsym.cycle.motion import piston_motion, travel_of
from mechsym.errors import BadInput
from mechsym.forces.turn import gas_faces
from mechsym.jobs.cycle import engine
from mechsym.jobs.flywheel import shaft
from mechsym.jobs.forces import vibration
from mechsym.jobs.gas import at_recorded_speed, firing, gas, one_cylinder
from mechsym.jobs.machine import constants, load_input, mechanism_of, turning
from mechsym.jobs.problem import beyond, problem_of, window_of
from mechsym.machine.loads import ConstantLoad, PropellerLoad, TableLoad, settle
from mechsym.mechanisms import own
from mechsym.mechanisms.arrays import along
from mechsym.mechanisms.plan import plan_of
from mechsym.mechanisms.record import Mechanism
from mechsym.mechanisms.roles import ShaftRole
from mechsym.mechanisms.shaft import elastic as shaft_of
from mechsym.periodic.pieces import PPoly
from mechsym.quantities.display import quantity_text
from mechsym.quantities.results import Columns
from mechsym.simulate import Result, Settings, simulate, simulate_many
from mechsym.simulate.angle import tabulate
from mechsym.simulate.constrained import LOCKED
from mechsym.simulate.engine import reduced
from mechsym.simulate.loop.events import CYCLE
from mechsym.simulate.loop.run import simulate_loop
from mechsym.simulate.loop.system import Loop, LoopCylinder
from mechsym.simulate.problem import period_of
from mechsym.simulate.rest import RestPoses, rests
from mechsym.simulate.result import RunNumbers, extremes_of, final_state, summary
from mechsym.simulate.settings import Simulation
from mechsym.simulate.steady import steady_state
from mechsym.torsion.startup import AVERAGE, EngineSpeed, FinishedRun, StartUp, StartUpClaim, findings, start_up
from mechsym.torsion.startup import numbers as start_numbers
from mechsym.torsion.twist import (
    Settling,
    ShaftLimits,
    doubts,
    natural_frequencies,
    sections,
    sentences,
    settling,
    twist_words,
    words,
)

_CAM_POINTS = 20_000  # at which the force on a cam is looked at
_HELD = 1e-6  # of its largest: what is further below 0 is no rounding


def in_loop(case: Case) -> bool:
    """Whether the gas of a case follows its motion, so that both are integrated together."""
    cycle = case.sections.get("cycle")
    return cycle is not None and not {"drive", "blowdown"} & case.sections.keys() and kind_of(cycle).closed


def run_in_loop(case: Case, settings: Settings) -> Result:
    """The run in time of a case whose gas follows the motion.

    case: as for `loop`; without `[simulation]` it turns 20 times from the speed of operation.
    """
    wanted = simulation_of(case)
    speed = case.need("operation").speed if wanted.speed_start is None else wanted.speed_start
    if speed <= 0:
        raise BadInput(f"{case.file}: an engine needs simulation.speed_start above 0 rad/s; leave it away or raise it")
    t_end = math.inf if wanted.t_end is None else wanted.t_end
    turns = math.inf if wanted.turns is None else wanted.turns
    count_loop(case, turns, t_end, speed)
    return simulate_loop(loop(case), speed, turns, settings, wanted.phi_start, t_end)


def loop(case: Case) -> Loop:
    """The loop that a case describes.

    case: with a spark-ignition cycle and a mechanism with pistons; of opposed pistons that share a chamber one
    mechanism is followed, which carries its share of the load; without `[load]` a propeller takes the mean torque.
    Raises BadInput: no spark-ignition cycle, a table as load, or cylinders that fire far from their dead centre.
    """
    machine, omega = engine(one_cylinder(case)), case.need("operation").speed
    if machine.blowdown is not None:
        raise BadInput(
            f"{case.file}: gas and motion integrated together know no [blowdown]; leave it out, or take "
            "'mechsym simulate', where the gas is that of the speed of operation"
        )
    mechanism = mechanism_of(case)
    mechanism = turning(case) if mechanism.dependents else mechanism
    cylinders, taken = _cylinders(case, mechanism), load_input(case)
    if not taken:
        raise BadInput(f"{case.file}: nothing takes the load; declare m.rotor('crank', angle=phi, load=M_r)")
    # the figures of a chamber count all its pistons, each of which drives a mechanism of its own
    own_area = piston_area(machine.chamber.bore)
    faces = sum(1.0 if c.area is None else c.area / own_area for c in cylinders)
    torque = float(performance(machine, {"omega": omega}).torque_avg[0]) * faces / machine.chamber.pistons
    load = settle(case.sections.get("load", PropellerLoad()), torque, omega)
    if isinstance(load, TableLoad):
        raise BadInput(f"{case.file}: the cycle in the loop takes a constant or a propeller load, no table")
    return Loop(
        engine=machine, mechanism=mechanism, cylinders=cylinders, load=load, load_input=taken,
        load_coordinate=mechanism.coordinates[-1],
    )  # fmt: skip


def _cylinders(case: Case, mechanism: Mechanism) -> tuple[LoopCylinder, ...]:
    """Each piston of the declaration with a motion of its own; else the faces, or the throws, of a case."""
    q, values = mechanism.coordinates, asdict(case.need("parameters"))
    cylinders = []
    for number, role in enumerate(mechanisms.roles_of(case.mechanism).pistons):
        fires = firing(case, role, travel_of(mechanism, role.travel)) % (4 * math.pi)
        motion = piston_motion(case.mechanism, values, guesses(case), number) if number else None
        cylinders.append(LoopCylinder(input=role.force, coordinate=q[0], firing=fires, motion=motion))
    if cylinders:
        return tuple(cylinders)
    plan = plan_of(case.mechanism)
    roles = plan.parts(case.need("parameters"))
    faces = case.need("faces") if roles.chosen else None
    plan.require_firing(case.need("parameters"), 4 * math.pi)
    return tuple(
        LoopCylinder(input=f.input, coordinate=q[f.throw], firing=f.fires % (4 * math.pi), area=f.area, sense=f.sense)
        for f in gas_faces(roles, values, faces)
    )


def run(case: Case, dampings: tuple[Annotated[float, "N*m*s/rad"], ...] = (), check: str = "tolerance") -> FinishedRun:
    """Simulate a case over time, with an energy audit and a check of the tolerance.

    case: with `[simulation]` and `[drive]`, or `[cycle]`. dampings: further values of c1 for a start-up. check:
    `tolerance` runs again at a hundredth of the tolerance; `none` leaves that out. Returns run: columns, audit, speeds,
    twist and findings.
    """
    require(case, "simulate")
    case = at_recorded_speed(case)
    settings = replace(settings_of(case), check=check)
    result, numbers, period = run_of(case, settings)
    engine = _engine(case, numbers, period)
    starts, settles = _start_ups(case, result, dampings), settled(case, result)
    elastic = shaft_of(case.mechanism, case.need("parameters"))
    twist = () if elastic is None else sections(elastic, result, result.t[-1] - numbers.window)
    train, facts, rate = vibration(case), facts_of(case.mechanism, case.sections), result.happened.contraction
    lines: list[str] = []
    if facts.twists and load_input(case) and not (facts.has("load") or facts.has("cycle")):
        lines.append("there is no [load]: nothing brakes the flywheel, and the speed is not that of steady running")
    if rate is not None:
        lines.append(f"friction and reactions: their fixed point contracts by {rate:.3g} or less a turn")
    lines += [*words(train), *twist_words(train, twist, case.sections.get("shaft", ShaftLimits()))] if train else []
    lines += [*(findings(starts[0]) if starts else ()), *(sentences(settles) if settles else ())]
    if engine and result.end == "stall":
        where = math.degrees(result.columns[engine.coordinate][-1])
        lines.append(
            f"the shaft stops at t = {result.t[-1]:.4g} s, {engine.coordinate} = {where:.1f} deg: what it stores does "
            "not carry it over compression and load; raise flywheel.inertia or simulation.speed_start, or lower [load]"
        )
    lines += _lifted(case, result)
    result, outputs = outputs_of(case, result)
    doubted = of_run(case, gas(case), result, numbers)
    doubted += tuple(of_start(case, mechanism_of(case), result.columns))
    return FinishedRun(
        case=case.name, backend=settings.backend, tolerance=result.tolerance or settings.tolerance, result=result,
        summary=numbers,
        final_state=final_state(result, numbers.speeds),
        natural_frequencies=natural_frequencies(case.mechanism, case.need("parameters")), twist=twist,
        start_up=tuple(start_numbers(s) for s in starts), start_ups=starts, vibration=train, settling=settles,
        engine=engine, alone=facts.alone, outputs=outputs, findings=tuple(lines),
        doubts=doubted + (doubts(train, twist) if train else ()),
    )  # fmt: skip


_SLOPE = re.compile(r"d\d?(.+?)_d")  # of an output


def outputs_of(case: Case, result: Result) -> tuple[Result, dict[str, Columns]]:
    """The run of a user's machine that no shaft stands for, with the outputs of its declaration along it, but for
    slopes and inertia; and their ends.
    """
    if not own.is_file(case.mechanism) or not facts_of(case.mechanism, case.sections).alone:
        return result, {}
    kinematics = mechanism_of(case).functions.get("kinematics")
    if kinematics is None or not kinematics.n_out():
        return result, {}
    taken = [name for name in kinematics.name_in() if name in result.columns]
    if len(taken) < kinematics.n_in():
        return result, {}
    outputs, units = kinematics.name_out(), plan_of(case.mechanism).listing(None)["outputs"]
    slopes = {name for name in outputs if (slope := _SLOPE.match(name)) and slope[1] in outputs}
    names = [n for n in outputs if n in units and n not in slopes | {"inertia"} and n not in result.columns]
    if not names:
        return result, {}

    def rows(columns: Mapping[str, np.ndarray]) -> np.ndarray:
        values = along(kinematics, {n: columns[n] for n in taken})
        return np.array([np.broadcast_to(values[n], columns[taken[0]].shape) for n in names])

    shown = rows(result.columns)
    least, greatest = extremes_of(result, rows)
    ends = {n: {"min": float(a), "max": float(b), "end": float(v[-1])}
            for n, a, b, v in zip(names, least, greatest, shown, strict=True)}  # fmt: skip
    columns = result.columns | dict(zip(names, shown, strict=True))
    run = replace(result, columns=columns, units={**result.units, **{n: units[n] for n in names}})
    return run, {n: Columns(of, dict.fromkeys(of, units[n])) for n, of in ends.items()}


def _lifted(case: Case, result: Result) -> list[str]:
    """Cams whose follower is held, where the run pulls it: it would have left the cam."""
    cams = [cam for cam in mechanisms.roles_of(case.mechanism).cams if cam.force]
    mechanism = mechanism_of(case) if cams and result.dense is not None else None
    if mechanism is None or result.dense is None:
        return []
    t = np.linspace(result.t[0], result.t[-1], min(50 * result.steps, _CAM_POINTS))
    at = dict(result.dense(t)) | constants(case)
    for q in mechanism.coordinates:
        at[f"{q}dd"] = PPoly.spline(t, at[f"{q}d"])(t, 1)
    reactions = mechanism.functions["reactions"]
    forces = along(reactions, {n: at[n] for n in reactions.name_in() if n in at})
    pulled = ((cam.name, forces[cam.force]) for cam in cams)
    return [
        f"the follower of the cam {name} would lift off at t = {t[int(np.argmax(force < 0))]:.4g} s: it is held by up "
        f"to {quantity_text(-float(force.min()), 'N', 4)}; declare the cam with restitution= to see it fly"
        for name, force in pulled
        if force.min() < -_HELD * np.abs(force).max()
    ]


def _engine(case: Case, numbers: RunNumbers, period: float) -> EngineSpeed | None:
    if not {"cycle", "operation"} <= case.sections.keys():
        return None
    rotors = [rotor for rotor in mechanisms.roles_of(case.mechanism).rotors if rotor.angle in numbers.speeds]
    taken = next((rotor for rotor in rotors if rotor.load), None)
    shaft = taken.angle if taken else next(iter(numbers.speeds))
    words = taken.name if taken and facts_of(case.mechanism, case.sections).twists else ""
    return EngineSpeed(coordinate=shaft, words=words, period=period, wanted=case.need("operation").speed)


def run_of(case: Case, settings: Settings) -> tuple[Result, RunNumbers, float]:
    """The run of a case, its numbers, and its period [rad]; gas that follows the motion is integrated with it."""
    if in_loop(case):
        result = run_in_loop(case, settings)
        coordinates = tuple(name for name, unit in result.units.items() if unit == "rad")
        return result, summary(result, coordinates, simulation_of(case).window, CYCLE), CYCLE
    case = beyond(case)
    problem = problem_of(case)
    result = simulate(problem, settings)
    if result.end == LOCKED and (further := beyond(case, ends=True)) is not case:
        case, problem = further, problem_of(further)
        result = simulate(problem, settings)
    period = period_of(problem)
    return result, summary(result, problem.mechanism.coordinates, window_of(case, problem), period), period


def at_rest(case: Case) -> RestPoses:
    """Where a case stays at rest, under its constant forces, and whether it comes back there."""
    if in_loop(case):
        raise BadInput(f"{case.file}: the gas of an engine that runs has no pose at rest; leave [cycle] out")
    # how long it would run is no matter
    sections = {"simulation": Simulation(t_end=1.0), **case.sections}
    try:
        return rests(problem_of(beyond(replace(case, sections=sections))), case.name)
    except BadInput as error:
        raise BadInput(f"{case.file}: {str(error).removeprefix(f'{case.file}: ')}") from None


def _start_ups(case: Case, result: Result, dampings: tuple[float, ...]) -> tuple[StartUp, ...]:
    """The start-up of the run, and of further dampers; nothing for other runs."""
    if "startup" not in case.sections:
        if dampings:
            raise BadInput(f"{case.file}: --dampings needs a start-up case, with a section [startup]")
        return ()
    if result.status == "failed" or result.t[-1] - result.t[0] <= AVERAGE:
        return ()
    return (startup(case, result), *startup_map(case, dampings))


_PERIODS = 20.0  # a shorter run tells nothing of where it settles


def settled(case: Case, result: Result) -> Settling | None:
    """Where the engine of a case settles; None for a run that is no start of an engine against a load.

    A start has `simulation.speed_start`, a cycle, and a load that grows with speed.
    """
    wanted = case.sections.get("simulation")
    facts = facts_of(case.mechanism, case.sections)
    if not (facts.twists and facts.has("cycle", "load")) or wanted is None or wanted.speed_start is None:
        return None
    if isinstance(case.need("load"), ConstantLoad):
        return None
    angle = next(rotor.angle for rotor in mechanisms.roles_of(case.mechanism).rotors if rotor.load)
    rigid, turned = shaft(case, 0.0), float(result.columns[angle][-1] - result.columns[angle][0])
    if result.end not in ("turns", "t_end") or turned < _PERIODS * rigid.period:
        return None
    steady = steady_state(tabulate(reduced(rigid)), rigid.omega)
    natural = natural_frequencies(case.mechanism, case.need("parameters"))
    return settling(result, angle, rigid.period, natural, steady.speed_mean)


def startup(case: Case, result: Result | None = None) -> StartUp:
    """Run a start-up case, or take its finished run, and explain it.

    case: of a shaft with two discs, with `[drive]` and `[simulation]`; result: its run, when there is one already.
    Returns start_up: critical speeds, which of them held the shaft, twist and torque.
    """
    _two_discs(case)
    if result is None:
        result = simulate(problem_of(case), settings_of(case))
    claim = case.sections.get("startup", StartUpClaim())
    return start_up(case.mechanism, case.need("parameters"), case.need("drive"), claim, result)


def _two_discs(case: Case) -> ShaftRole:
    """The shaft whose start-up is explained."""
    for role in mechanisms.roles_of(case.mechanism).shafts:
        if len(role.discs) == 2:
            return role
    raise BadInput(
        f"{case.file}: [startup] explains a shaft with two discs, declared with m.shaft(..), and {case.mechanism} has "
        "none; leave the section out"
    )


def startup_map(case: Case, dampings: tuple[Annotated[float, "N*m*s/rad"], ...]) -> tuple[StartUp, ...]:
    """The same start-up with several dampers of the shaft, run side by side; one for each, in their order."""
    (letter,) = _two_discs(case).damping
    damped = [replace(case.need("parameters"), **{str(letter): damping}) for damping in dampings]
    cases = [replace(case, sections={**case.sections, "parameters": p}) for p in damped]
    results = simulate_many([problem_of(c) for c in cases], settings_of(case))
    return tuple(startup(c, r) for c, r in zip(cases, results, strict=True))
