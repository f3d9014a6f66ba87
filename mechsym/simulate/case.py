"""From a case file to a problem: sections `[simulation]`, `[drive]`, `[load]`, and `[cycle]` for an engine."""

import math
from dataclasses import dataclass, replace

import numpy as np

from mechsym import mechanisms
from mechsym.cases import Case
from mechsym.engine.cylinder import piston_area
from mechsym.engine.kinds import back_pressure, cylinder_pressure
from mechsym.engine.pressure import piston_force
from mechsym.errors import BadInput
from mechsym.loads import ConstantLoad, settle
from mechsym.quantities import check, choice, quantity
from mechsym.simulate import engine as engines
from mechsym.simulate.backends import BACKENDS, DEFAULT
from mechsym.simulate.engine import AngleForce, Engine
from mechsym.simulate.machine import tabulate
from mechsym.simulate.problem import Part, Problem, Steps
from mechsym.simulate.settings import Settings
from mechsym.simulate.steady import mean_torque

# the window whose mean, least and greatest speed is reported is sampled this finely
_WINDOW_POINTS = 4000


@dataclass(frozen=True, kw_only=True)
class Simulation:
    """Section `[simulation]`: how long, from where, how exactly.

    Parameters
    ----------
    t_end : float or None
        Last time; an engine may give turns instead [s]
    turns : float or None
        Turns of the crank to run [-]
    speed_start : float or None
        Speed of every coordinate at the start; None takes the speed of operation of an engine, else rest [rad/s]
    phi_start : float
        Every coordinate at the start [rad]
    tolerance : float
        Relative and absolute tolerance of a step [-]
    backend : str
        Integrator
    output_step : float
        Spacing of the results in a run to t_end [s]
    window : float or None
        Stretch at the end over which speeds are summed up; None takes the last turn, or all of a run to t_end [s]
    difference_allowed : float
        Largest relative difference to the run at the tighter tolerance that counts as converged [-]
    """

    t_end: float | None = quantity("s", default=None, above=0, about="last time")
    turns: float | None = quantity("-", default=None, above=0, about="turns to run")
    speed_start: float | None = quantity("rad/s", default=None, about="speed at the start")
    phi_start: float = quantity("rad", default=0.0, about="angle at the start")
    tolerance: float = quantity("-", default=1e-10, low=3e-14, high=1e-2, about="tolerance of a step")
    backend: str = choice(*BACKENDS, default=DEFAULT, about="integrator")
    output_step: float = quantity("s", default=0.01, above=0, about="spacing of the results")
    window: float | None = quantity("s", default=None, above=0, about="stretch at the end for the mean speed")
    difference_allowed: float = quantity("-", default=1e-4, above=0, about="difference that counts as converged")

    def __post_init__(self) -> None:
        check(self)
        if self.t_end is None and self.turns is None:
            raise BadInput("neither t_end nor turns says where the run ends; give t_end in s or turns")


@dataclass(frozen=True, kw_only=True)
class StepTorque:
    """Section `[drive]`: a torque that is switched on.

    Parameters
    ----------
    input : str
        The mechanism's input
    time : float
        When it is switched on [s]
    torque : float
        Torque from then on, 0 before [N*m]
    """

    input: str = "M"
    time: float = quantity("s", default=0.0, about="when the torque is switched on")
    torque: float = quantity("N*m", about="driving torque")

    def __post_init__(self) -> None:
        check(self)


def settings_of(case: Case) -> Settings:
    """Tolerance and integrator of a case.

    Parameters
    ----------
    case : Case
        With section `[simulation]`

    Returns
    -------
    settings : Settings
        For `simulate`
    """
    wanted: Simulation = case.need("simulation")
    return Settings(tolerance=wanted.tolerance, backend=wanted.backend, difference_allowed=wanted.difference_allowed)


def problem_of(case: Case, torques: tuple[AngleForce, ...] = ()) -> Problem:
    """The run that a case describes.

    Parameters
    ----------
    case : Case
        With `[simulation]` and either `[drive]` (a torque that is switched on) or `[cycle]` (an engine)
    torques : tuple of AngleForce
        What acts on an engine besides the gas, for example its hinge

    Returns
    -------
    problem : Problem
        For `simulate`

    Raises
    ------
    BadInput
        A section is missing or names what the mechanism has not
    """
    wanted: Simulation = case.need("simulation")
    if "drive" in case.sections:
        return _driven(case, wanted)
    engine = engine_of(case, torques)
    speed = case.need("operation").speed if wanted.speed_start is None else wanted.speed_start
    if wanted.turns is None or speed <= 0:
        raise BadInput(f"{case.file}: an engine needs simulation.turns and a start speed above 0 rad/s; give both")
    return engines.problem(engine, speed, wanted.turns, wanted.phi_start)


def engine_of(case: Case, torques: tuple[AngleForce, ...] = ()) -> Engine:
    """The engine of a case: mechanism, gas force of its cycle, load law.

    Parameters
    ----------
    case : Case
        With `[cycle]` and `[operation]`; `[load]` if it is not constant at the mean torque
    torques : tuple of AngleForce
        What acts on it besides the gas; a periodic part must not change the mean torque

    Returns
    -------
    engine : Engine
        A blank in the load law is filled with the mean torque of the gas and the speed of operation
    """
    mechanism = mechanisms.build(case.mechanism, case.need("parameters"))
    cycle = case.need("cycle")
    pressure, cylinder = cylinder_pressure(cycle, mechanism.functions["kinematics"])
    area, p_back = piston_area(cylinder.bore), back_pressure(cycle)
    gas = AngleForce(name="gas", input="F", value=lambda phi: piston_force(pressure, p_back, area, phi))
    engine = Engine(
        mechanism=mechanism, forces=(gas,), load=ConstantLoad(torque=0.0), period=pressure.period, kinks=pressure.kinks
    )
    mean = mean_torque(tabulate(engines.machine(engine)))
    load = settle(case.sections.get("load", ConstantLoad()), mean, case.need("operation").speed)
    return replace(engine, forces=(gas, *torques), load=load)


def window_of(case: Case, problem: Problem) -> float | None:
    """The stretch at the end over which speeds are summed up.

    Parameters
    ----------
    case : Case
        With section `[simulation]`
    problem : Problem
        Its run

    Returns
    -------
    window : float or None
        None for the last turn [s]
    """
    wanted: Simulation = case.need("simulation")
    if wanted.window is None and problem.turns is None:
        return problem.t_end - problem.t_start
    return wanted.window


def _driven(case: Case, wanted: Simulation) -> Problem:
    mechanism = mechanisms.build(case.mechanism, case.need("parameters"))
    drive: StepTorque = case.need("drive")
    if wanted.t_end is None:
        raise BadInput(f"{case.file}: a driven run needs simulation.t_end, for example '100 s'")
    steps = Steps(times=(drive.time,), values=(0.0, drive.torque))
    if drive.time <= 0:
        steps = Steps(values=(drive.torque,))
    n = len(mechanism.coordinates)
    return Problem(
        mechanism=mechanism,
        parts=(Part(name="drive", input=drive.input, value=steps),),
        q0=(wanted.phi_start,) * n,
        u0=(wanted.speed_start or 0.0,) * n,
        t_end=wanted.t_end,
        turns=wanted.turns,
        output=_times(wanted.t_end, wanted.output_step, wanted.window),
    )


def _times(t_end: float, step: float, window: float | None) -> tuple[float, ...]:
    """Even times, and finer ones in the window, with both of its ends among them."""
    coarse = np.minimum(step * np.arange(1, math.ceil(t_end / step) + 1), t_end)
    if window is None:
        return tuple(np.unique(coarse).tolist())
    fine = np.linspace(max(t_end - window, 0.0), t_end, _WINDOW_POINTS + 1)
    # an even time and its neighbour of the finer set may differ by rounding only
    keep = coarse[coarse < fine[0] - 1e-9 * t_end]
    return tuple(np.concatenate([keep, fine[fine > 0]]).tolist())
