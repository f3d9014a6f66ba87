"""The loop of a case: its engine on its mechanism against its load, and its run in time."""

import math
from dataclasses import asdict

from mechsym import mechanisms
from mechsym.cases import Case
from mechsym.cycle.chamber import piston_area
from mechsym.cycle.closed.performance import performance
from mechsym.cycle.kinds import kind_of
from mechsym.cycle.motion import piston_motion, piston_roles
from mechsym.errors import BadInput
from mechsym.jobs import own
from mechsym.jobs.cycle import engine
from mechsym.jobs.gas import one_cylinder
from mechsym.jobs.machine import heavier, kept_flywheel
from mechsym.jobs.own import is_own
from mechsym.jobs.own_gas import firing as own_firing
from mechsym.jobs.own_gas import travel_of
from mechsym.jobs.span import count_loop, simulation_of
from mechsym.jobs.starts import guesses
from mechsym.machine.loads import ConstantLoad, Load, PropellerLoad, TableLoad, settle
from mechsym.mechanisms.record import Mechanism
from mechsym.mechanisms.shaft_inertia import with_inertia
from mechsym.mechanisms.traits import traits_of
from mechsym.simulate import Result, Settings
from mechsym.simulate.loop.result import simulate_loop
from mechsym.simulate.loop.system import Loop, LoopCylinder


def in_loop(case: Case) -> bool:
    """Whether the gas of a case follows its motion, so that both are integrated together."""
    cycle = case.sections.get("cycle")
    return cycle is not None and "drive" not in case.sections and kind_of(cycle).given == "engine"


def run_in_loop(case: Case, settings: Settings) -> Result:
    """The run in time of a case whose gas follows the motion.

    Parameters
    ----------
    case : Case
        As for `loop`; without `[simulation]` it turns 20 times from the speed of operation
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

    Parameters
    ----------
    case : Case
        With a spark-ignition cycle and a mechanism with pistons; of opposed pistons that share a chamber one mechanism
        is followed, which carries its share of the load; without `[load]` a propeller takes the mean torque

    Raises
    ------
    BadInput
        No spark-ignition cycle, a table as load, or cylinders that fire far from their dead centre
    """
    machine, omega = engine(one_cylinder(case)), case.need("operation").speed
    mechanism, cylinders, load_input = _own(case) if is_own(case.mechanism) else _built_in(case)
    load = case.sections.get("load", PropellerLoad())
    # the figures of a chamber count all its pistons, each of which drives a mechanism of its own
    own_area = piston_area(machine.chamber.bore)
    faces = sum(1.0 if c.area is None else c.area / own_area for c in cylinders)
    torque = float(performance(machine, {"omega": omega}).torque_avg[0]) * faces / machine.chamber.pistons
    return Loop(
        engine=machine,
        mechanism=mechanism,
        cylinders=cylinders,
        load=_smooth(case, settle(load, torque, omega)),
        load_input=load_input,
        load_coordinate=mechanism.coordinates[-1],
    )


def _smooth(case: Case, load: Load) -> ConstantLoad | PropellerLoad:
    if isinstance(load, TableLoad):
        raise BadInput(f"{case.file}: the cycle in the loop takes a constant or a propeller load, no table")
    return load


def _built_in(case: Case) -> tuple[Mechanism, tuple[LoopCylinder, ...], str]:
    heavy, load_input = heavier(case)
    mechanism = mechanisms.build(case.mechanism, heavy.need("parameters"))
    return mechanism, _cylinders(case, mechanism), load_input


def _own(case: Case) -> tuple[Mechanism, tuple[LoopCylinder, ...], str]:
    """A mechanism from a file: each of its pistons with a motion of its own."""
    mechanism = with_inertia(own.one_coordinate(case), kept_flywheel(case))
    loads = [r["load"] for r in own.roles(case, "rotor") if r["load"]]
    if not loads:
        raise BadInput(f"{case.file}: nothing takes the load; declare m.rotor('crank', angle=phi, load=M_r)")
    q, values, found = mechanism.coordinates[0], asdict(case.need("parameters")), []
    for number, role in enumerate(piston_roles(case.mechanism)):
        firing = own_firing(case, role, travel_of(mechanism, role["travel"])) % (4 * math.pi)
        motion = piston_motion(case.mechanism, values, guesses(case), number) if number else None
        found.append(LoopCylinder(input=role["force"], coordinate=q, firing=firing, motion=motion))
    return mechanism, tuple(found), loads[0]


def _cylinders(case: Case, mechanism: Mechanism) -> tuple[LoopCylinder, ...]:
    known = traits_of(case.mechanism)
    assert known is not None and known.chain is not None  # it takes a load
    faces = case.need("faces") if known.chain.areas is not None else None
    return tuple(
        LoopCylinder(
            input=face.input, coordinate=mechanism.coordinates[face.throw], firing=face.fires % (4 * math.pi),
            area=face.area, sense=face.sense,
        )
        for face in known.chain.cylinders(case.need("parameters"), faces)
    )  # fmt: skip
