"""Case -> run: sections `[simulation]` and `[drive]`, and for an engine what its hinge design needs.

An engine whose case names no run turns 20 times from its speed of operation; one whose case names no load has a
propeller that takes its mean torque there.
"""

import dataclasses
import functools
import math

import numpy as np

from mechsym import mechanisms
from mechsym.cases import Case
from mechsym.cycle.kinds import kind_of
from mechsym.errors import BadInput
from mechsym.hinge.balance import balance
from mechsym.hinge.fitted import fitted
from mechsym.hinge.guide import cut
from mechsym.hinge.torque import torque
from mechsym.jobs import train as trains
from mechsym.jobs.flywheel import shaft
from mechsym.jobs.machine import machine
from mechsym.jobs.own import is_own
from mechsym.jobs.own import problem as own_problem
from mechsym.jobs.span import TURN_POINTS, count_times, count_turns, simulation_of
from mechsym.machine.loads import Load, PropellerLoad
from mechsym.machine.record import Machine
from mechsym.mechanisms.record import Mechanism
from mechsym.mechanisms.traits import is_train, traits_of, with_hinge
from mechsym.simulate import engine as engines
from mechsym.simulate.problem import Part, Problem, Steps, Stop
from mechsym.simulate.settings import Settings, Simulation, StepTorque

# the window whose mean, least and greatest speed is reported is sampled this finely
_WINDOW_POINTS = 4000


def settings_of(case: Case) -> Settings:
    """Tolerance and integrator of a case.

    Parameters
    ----------
    case : Case
        With section `[simulation]`
    """
    wanted = simulation_of(case)
    return Settings(tolerance=wanted.tolerance, backend=wanted.backend, difference_allowed=wanted.difference_allowed)


def problem_of(case: Case) -> Problem:
    """The run that a case describes.

    Parameters
    ----------
    case : Case
        With either `[simulation]` and `[drive]` (a torque that is switched on) or `[cycle]` (an engine); a crank
        train may have both. Gas that follows the motion is no problem of this kind: see `mechsym.jobs.loop`

    Raises
    ------
    BadInput
        A section is missing or names what the mechanism has not
    """
    if is_own(case.mechanism) and not _hinged(case):
        return own_problem(case)
    wanted, case = simulation_of(case), braked(case)
    if is_train(case.mechanism):
        return turned(case, wanted, trains.cylinders(case))[0]
    if "drive" in case.sections and not is_own(case.mechanism):
        return _driven(case, wanted)
    engine = engine_of(case)
    speed = case.need("operation").speed if wanted.speed_start is None else wanted.speed_start
    if wanted.turns is None or speed <= 0:
        raise BadInput(f"{case.file}: an engine needs simulation.turns and a start speed above 0 rad/s; give both")
    count_turns(case, wanted.turns)
    problem = engines.problem(engine, speed, wanted.turns, wanted.phi_start)
    if wanted.t_end is None:
        return problem
    return dataclasses.replace(problem, t_end=min(wanted.t_end, problem.t_end))  # whichever comes first


def braked(case: Case) -> Case:
    """The case of an engine with its load: a propeller that takes the mean torque, where it names none."""
    if "cycle" not in case.sections or "drive" in case.sections:
        return case
    return dataclasses.replace(case, sections={"load": PropellerLoad(), **case.sections})


def _hinged(case: Case) -> bool:
    """Whether a hinge is designed for the run."""
    acts = "cycle" in case.sections or is_own(case.mechanism)
    return acts and {"spring", "guide"} <= set(case.sections) and simulation_of(case).hinge == "designed"


def engine_of(case: Case) -> Machine:
    """The engine of a case with its hinge, as far as the case has one.

    Parameters
    ----------
    case : Case
        With `[cycle]` and `[operation]`; the hinge needs `[spring]` and `[guide]`

    Returns
    -------
    engine : Machine
        The hinge's torque comes from guide and spring

    Raises
    ------
    BadInput
        The guide that the case asks for cannot be cut
    """
    breathes = "cycle" in case.sections and kind_of(case.sections["cycle"]).given == "breathing"
    if not is_own(case.mechanism) and (case.mechanism not in with_hinge() or breathes):
        return shaft(case, 0.0)
    engine = machine(case)
    wanted = torque(engine)
    simulation = simulation_of(case)
    if simulation.hinge == "none" or not {"spring", "guide"} <= set(case.sections):
        return fitted(engine, wanted)
    choices = case.need("guide")
    guide = cut(balance(wanted, choices.balance), case.need("spring"), choices)
    if guide.rho is None:
        raise BadInput(f"{case.file}: no guide can be cut ({guide.reason}); set simulation.hinge=none to run without")
    return fitted(engine, wanted, guide)


def window_of(case: Case, problem: Problem) -> float | None:
    """The stretch at the end over which speeds are summed up.

    Parameters
    ----------
    case : Case
        With section `[simulation]`

    Returns
    -------
    window : float or None
        None for the last turn [s]
    """
    wanted = simulation_of(case)
    if wanted.window is None and problem.turns is None:
        return problem.t_end - problem.t_start
    return wanted.window


def _drive(case: Case, usual: str) -> Part:
    drive: StepTorque = case.need("drive")
    steps = Steps(times=(drive.time,), values=(0.0, drive.torque))
    if drive.time <= 0:
        steps = Steps(values=(drive.torque,))
    return Part(name="drive", input=drive.input or usual, value=steps)


def _driven(case: Case, wanted: Simulation) -> Problem:
    mechanism = mechanisms.build(case.mechanism, case.need("parameters"))
    if wanted.t_end is None:
        raise BadInput(f"{case.file}: a driven run needs simulation.t_end, for example '100 s'")
    n = len(mechanism.coordinates)
    return Problem(
        mechanism=mechanism,
        parts=(_drive(case, "M"),),
        q0=(wanted.phi_start,) * n,
        u0=(wanted.speed_start or 0.0,) * n,
        t_end=wanted.t_end,
        turns=wanted.turns,
        output=_wanted_times(case, wanted.t_end, wanted),
    )


def turned(case: Case, wanted: Simulation, gas: trains.Cylinders) -> tuple[Problem, Load | None]:
    """The run of a crank train under the gas of its cylinders and a drive, and the settled law of its load."""
    driven = "drive" in case.sections
    if not (gas.parts or driven):
        raise BadInput(f"{case.file}: nothing turns the shaft; give [drive] with a torque or [cycle] with the gas")
    usual = case.need("operation").speed if gas.parts and not driven else 0.0
    speed = usual if wanted.speed_start is None else wanted.speed_start
    mechanism = _elastic(case)
    mean = gas.torque + (case.need("drive").torque if driven else 0.0)
    t_end, output = _end(case, wanted, speed)
    law = trains.load(case, mean, speed)
    held = () if law is None else (Part(name="load", input="M", role="load", value=engines.load_value(law, -1)),)
    problem = Problem(
        mechanism=mechanism,
        parts=(*((_drive(case, "M_drive"),) if driven else ()), *gas.parts, *held),
        q0=(wanted.phi_start,) * len(mechanism.coordinates),
        u0=(speed,) * len(mechanism.coordinates),
        t_end=t_end,
        turns=wanted.turns,
        kinks=gas.kinks,
        # a crank may swing back within a turn; the flywheel does only when the shaft stops
        stops=(Stop(name="stall", of="phi_fd", direction="falling"),) if speed > 0 else (),
        output=output,
    )
    return problem, law


def _elastic(case: Case) -> Mechanism:
    known = traits_of(case.mechanism)
    assert known is not None and known.assembled is not None
    return known.assembled.build_driven(case.need("parameters"))


def _wanted_times(case: Case, t_end: float, wanted: Simulation) -> tuple[float, ...]:
    count_times(case, t_end, wanted.step)
    return _times(t_end, wanted.step, wanted.window)


def _end(case: Case, wanted: Simulation, speed: float) -> tuple[float, float | tuple[float, ...]]:
    """Last time and wanted times: of a run to t_end, or of turns from a speed."""
    if wanted.t_end is not None:
        return wanted.t_end, _wanted_times(case, wanted.t_end, wanted)
    if speed <= 0:
        raise BadInput(f"{case.file}: turns need a start speed above 0 rad/s; give simulation.speed_start or t_end")
    turn_time = 2 * math.pi / speed
    # a shaft that takes ten times as long has stopped for every purpose
    assert wanted.turns is not None  # the section has one of the two
    count_turns(case, wanted.turns)
    return 10 * wanted.turns * turn_time, turn_time / TURN_POINTS


@functools.lru_cache(maxsize=8)
def _times(t_end: float, step: float, window: float | None) -> tuple[float, ...]:
    """Even times, and finer ones in the window, with both of its ends among them."""
    coarse = np.minimum(step * np.arange(1, math.ceil(t_end / step) + 1), t_end)
    if window is None:
        return tuple(np.unique(coarse).tolist())
    fine = np.linspace(max(t_end - window, 0.0), t_end, _WINDOW_POINTS + 1)
    # an even time and its neighbour of the finer set may differ by rounding only
    keep = coarse[coarse < fine[0] - 1e-9 * t_end]
    return tuple(np.concatenate([keep, fine[fine > 0]]).tolist())
