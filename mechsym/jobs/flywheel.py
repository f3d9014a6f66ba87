"""The flywheel of a case for a wanted ripple of the speed, and the run in time that proves it.

The shaft is rigid: gas forces, weight and moving masses of all cylinders act on one coordinate, the load by its law.
"""

from dataclasses import replace
from typing import Any

import numpy as np

from mechsym.cases import Case
from mechsym.cases.settings import FlywheelSettings
from mechsym.cycle.gas import Gas
from mechsym.cycle.kinds.spark_ignition import SparkIgnition
from mechsym.errors import BadInput
from mechsym.forces.turn import CrankDrive, chain_of, pushes
from mechsym.hinge.trials import Trial, run
from mechsym.jobs.gas import gas
from mechsym.jobs.machine import heavier, kept_flywheel, load, machine
from mechsym.jobs.own import is_own
from mechsym.jobs.turn import drive_of
from mechsym.machine import ConstantLoad, Machine, settle
from mechsym.machine.record import AngleForce
from mechsym.quantities import record
from mechsym.simulate import Settings
from mechsym.simulate.angle import Panels, tabulate
from mechsym.simulate.angle_turn import turn
from mechsym.simulate.engine import reduced
from mechsym.simulate.steady import Steady, flywheel_for_ripple, mean_torque, steady_state

# the parameter that a flywheel adds to, and the input of the load
TURNS = 12.0


@record
class FlywheelDesign:
    """A flywheel, what it is for, and how the shaft turns with it."""

    status: str  #: `found`, `not needed` or `none`
    reason: str
    inertia: float | None  #: Inertia to add to what the case has [kg*m^2]
    inertia_kept: float  #: Mean inertia of what turns without it [kg*m^2]
    estimate: float  #: Rule of thumb W/(ripple omega^2), less what the case has [kg*m^2]
    #: Mean torque [N*m], and work that swings about it in a period at constant speed, moving masses included [J]
    torque_mean: float
    work_swing: float
    ripple_wanted: float  #: (max - min) / mean [-]
    ripple_bare: float | None  #: Without the flywheel; None where the shaft does not turn [-]
    steady: Steady  #: Motion with the flywheel, over the angle
    trial: Trial | None  #: Run in time with the flywheel


def flywheel(case: Case, ripple: float, turns: float = TURNS) -> FlywheelDesign:
    """Size the flywheel of a case at its speed of operation and run it.

    Parameters
    ----------
    ripple : float
        Wanted (max - min) / mean of the speed in steady motion [-]
    turns : float
        Turns of the run in time [-]
    """
    if not 1e-6 <= ripple < 1:
        raise BadInput(f"ripple = {ripple:g} must be from 1e-6 to below 1; give 0.02 or 2% for a fiftieth")
    omega, bare = case.need("operation").speed, shaft(case, 0.0)
    panels = tabulate(reduced(bare))
    found = flywheel_for_ripple(panels, omega, ripple)
    swing, kept = _swing(panels, omega), float(np.mean(panels.inertia))
    steady = steady_state(panels, omega, found.inertia or 0.0)
    trial = None
    if found.inertia is not None and len(steady.omega):
        driven, about = shaft(case, found.inertia), f"flywheel of {found.inertia:.4g} kg m²"
        start = steady_state(tabulate(reduced(driven)), omega)
        trial = run("flywheel", about, driven, float(start.omega[0]), turns, Settings())
    return FlywheelDesign(
        status=found.status, reason=found.reason, inertia=found.inertia, inertia_kept=kept,
        estimate=max(0.0, swing / (ripple * omega**2) - kept), torque_mean=mean_torque(panels), work_swing=swing,
        ripple_wanted=ripple, ripple_bare=steady_state(panels, omega).speed_ripple, steady=steady, trial=trial,
    )  # fmt: skip


def _swing(panels: Panels, omega: float) -> float:
    # at constant speed the moving masses take their own share of the work
    free = turn(replace(panels, load=ConstantLoad(torque=0.0)), 0.0, 0.0)
    even = free.energy - mean_torque(panels) * (panels.phi - panels.edges[0])
    return float(np.ptp(even - 0.5 * omega**2 * panels.inertia))


def shaft(case: Case, inertia: float) -> Machine:
    """The rigid shaft of a case with all that acts on it, and a flywheel.

    Parameters
    ----------
    inertia : float
        Of the flywheel, on top of what the case has [kg*m^2]
    """
    if is_own(case.mechanism):
        return _own_shaft(case, inertia)
    heavy, load_input = heavier(case, inertia)
    drive = drive_of(heavy)
    found = gas(case)
    free = Machine(
        mechanism=drive.mechanism, forces=_forces(drive, found), load=ConstantLoad(torque=0.0), load_input=load_input,
        omega=case.need("operation").speed, period=found.pressure.period if found else 2 * np.pi,
        kinks=_kinks(drive, found, _valves(case)),
    )  # fmt: skip
    torque = mean_torque(tabulate(reduced(free)))
    return replace(free, load=settle(load(case), torque, free.omega))


def _own_shaft(case: Case, inertia: float) -> Machine:
    kept = FlywheelSettings(inertia=inertia + kept_flywheel(case))
    sections = {**case.sections, "flywheel": kept, "load": ConstantLoad(torque=0.0)}
    free = machine(replace(case, sections=sections))
    return replace(free, load=settle(load(case), mean_torque(tabulate(reduced(free))), free.omega))


def _forces(drive: CrankDrive, found: Gas | None) -> tuple[AngleForce, ...]:
    if found is None:
        return ()

    def force(key: str) -> AngleForce:
        return AngleForce(name=f"gas_{key}", input=key, value=lambda phi: pushes(drive, found, phi)[key])

    return tuple(force(key) for key in pushes(drive, found, np.zeros(1)))


def _valves(case: Case) -> tuple[float, ...]:
    """Angles of a four-stroke gas that is tabulated, where its pressure jumps to that of the gas exchange."""
    cycle = case.sections.get("cycle")
    return (cycle.exhaust_opens, cycle.inlet_closes) if isinstance(cycle, SparkIgnition) else ()


def _kinks(drive: CrankDrive, found: Gas | None, valves: tuple[float, ...]) -> tuple[float, ...]:
    if found is None:
        return ()
    starts = (0.0,) if found.pistons else chain_of(drive).fires(drive)
    return tuple(
        sorted({(k + start) % found.pressure.period for start in starts for k in (*found.pressure.kinks, *valves)})
    )


def summary(found: FlywheelDesign) -> dict[str, Any]:
    """The design under the names of the command line."""
    trial = found.trial
    return {
        "status": found.status, "reason": found.reason, "inertia": found.inertia, "inertia_kept": found.inertia_kept,
        "estimate": found.estimate, "ripple_wanted": found.ripple_wanted, "ripple_bare": found.ripple_bare,
        "torque_mean": found.torque_mean, "work_swing": found.work_swing,
        "check": {
            "speed_ripple": trial.speed_ripple if trial else None,
            "energy_residual": trial.result.energy.residual if trial else None,
            "status": trial.result.status if trial else "not run",
        },
    }  # fmt: skip
