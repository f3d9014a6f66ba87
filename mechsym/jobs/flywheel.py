"""The flywheel of a case for a wanted ripple of the speed, and the run in time that proves it.

The shaft is rigid: gas forces, weight and moving masses of all cylinders act on one coordinate, the load by its law.
"""

from dataclasses import replace

import numpy as np

from mechsym.cases import Case
from mechsym.cases.facts import facts_of
from mechsym.cases.needs import require
from mechsym.errors import BadInput
from mechsym.hinge.trials import Trial, run
from mechsym.jobs.machine import load, machine
from mechsym.machine import ConstantLoad, Machine, settle
from mechsym.page.finding import LOOK_AT, NOT_MET, Finding
from mechsym.quantities.display import figure
from mechsym.quantities.results import computed, part, quantity, result
from mechsym.quantities.units import Inertia, Pure
from mechsym.simulate import Settings
from mechsym.simulate.angle import tabulate, turn
from mechsym.simulate.engine import reduced
from mechsym.simulate.steady import Steady, flywheel_for_ripple, mean_inertia, mean_torque, steady_state

TURNS = 12.0  # of the run in time


@result
class FlywheelCheck:
    """The run in time that proves a flywheel."""

    speed_ripple: float | None = quantity("-", default=None)  #: (max - min) / mean
    energy_residual: float | None = quantity("-", default=None)  #: Of all work and energy
    status: str = part(default="not run")


@result
class FlywheelDesign:
    """A flywheel, what it is for, and how the shaft turns with it."""

    status: str = part()  #: `found`, `not needed` or `none`
    reason: str = part()
    inertia: float | None = quantity("kg*m^2")  #: Inertia to add to what the case has
    inertia_kept: float = quantity("kg*m^2")  #: Mean inertia of what turns without it
    estimate: float = quantity("kg*m^2")  #: Rule of thumb W/(ripple omega^2), less what the case has
    ripple_wanted: float = quantity("-")  #: (max - min) / mean
    #: Without a further one than the case has; None where the shaft does not turn
    ripple_bare: float | None = quantity("-")
    torque_mean: float = quantity("N*m")  #: Of all that acts but the load
    #: Work that swings about the mean torque in a period at constant speed, moving masses included
    work_swing: float = quantity("J")
    steady: Steady  #: Motion with the flywheel, over the angle
    twists: bool = part()  #: Whether the shaft of the case twists, and its run in time with it
    trial: Trial | None  #: Run in time with the flywheel

    @computed()
    def check(self) -> FlywheelCheck:
        """The run in time with the flywheel."""
        if self.trial is None:
            return FlywheelCheck()
        energy = self.trial.result.energy
        status = self.trial.result.status
        return FlywheelCheck(speed_ripple=self.trial.speed_ripple, energy_residual=energy.residual, status=status)

    @property
    def findings(self) -> tuple[Finding, ...]:
        """What has to be known before its numbers."""
        findings = []
        if self.inertia is None:
            words = f"no flywheel gives {figure(100 * self.ripple_wanted, 4)} %: {self.reason}"
            findings.append(Finding(rank=NOT_MET, words=words, value=self.ripple_wanted))
        elif self.check.status != "converged":
            findings.append(
                Finding(rank=NOT_MET, words=f"the run in time does not prove it: it is {self.check.status}")
            )
        return (*findings, *([Finding(rank=LOOK_AT, words=_TWISTS)] if self.twists else []))


_TWISTS = (
    "all of this is on a rigid shaft; 'mechsym simulate' lets the shaft of this case twist, and its ripple is that of "
    "the flywheel at its end, to which the vibration of the sections adds"
)


def flywheel(case: Case, ripple: Pure, turns: Pure = TURNS) -> FlywheelDesign:
    """Size the flywheel of a case at its speed of operation and run it.

    ripple: wanted (max - min) / mean of the speed in steady motion; turns: turns of the run in time.
    """
    if not 1e-6 <= ripple < 1:
        raise BadInput(f"ripple = {ripple:g} must be from 1e-6 to below 1; give 0.02 or 2% for a fiftieth")
    require(case, "flywheel")
    bare = shaft(case, 0.0)
    omega = bare.omega
    panels = tabulate(reduced(bare))
    wheel = flywheel_for_ripple(panels, omega, ripple)
    # at constant speed the moving masses take their own share of the work
    free = turn(replace(panels, load=ConstantLoad(torque=0.0)), 0.0, 0.0)
    even = free.energy - mean_torque(panels) * (panels.phi - panels.edges[0])
    swing, kept = float(np.ptp(even - 0.5 * omega**2 * panels.inertia)), mean_inertia(panels)
    steady = steady_state(panels, omega, wheel.inertia or 0.0)
    trial = None
    if wheel.inertia is not None and len(steady.omega):
        driven, about = shaft(case, wheel.inertia), f"flywheel of {wheel.inertia:.4g} kg m²"
        start = steady_state(tabulate(reduced(driven)), omega)
        trial = run("flywheel", about, driven, float(start.omega[0]), turns, Settings())
    return FlywheelDesign(
        status=wheel.status, reason=wheel.reason, inertia=wheel.inertia, inertia_kept=kept,
        estimate=max(0.0, swing / (ripple * omega**2) - kept), torque_mean=mean_torque(panels), work_swing=swing,
        ripple_wanted=ripple, ripple_bare=steady_state(panels, omega).speed_ripple, steady=steady, trial=trial,
        twists=facts_of(case.mechanism, case.sections).vibrates,
    )  # fmt: skip


def shaft(case: Case, inertia: Inertia) -> Machine:
    """The rigid shaft of a case with all that acts on it. inertia: of a flywheel, on top of what the case has."""
    free = machine(replace(case, sections={**case.sections, "load": ConstantLoad(torque=0.0)}), inertia=inertia)
    torque = mean_torque(tabulate(reduced(free)))
    return replace(free, load=settle(load(case), torque, free.omega))
