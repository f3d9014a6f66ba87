"""A designed hinge: what it balances, the guide that gives it, how it runs, and where the data came from."""

from collections.abc import Mapping
from typing import Any

from mechsym.hinge.balance import Balance
from mechsym.hinge.guide import Guide
from mechsym.hinge.limits import Verdict
from mechsym.hinge.price import Price
from mechsym.hinge.rollers import RollerParameters
from mechsym.hinge.steady import Flywheels, Retuned, Sensitivity
from mechsym.hinge.torque import Hinge
from mechsym.hinge.trials import Trial
from mechsym.hinge.ways import Offer
from mechsym.machine.record import Machine
from mechsym.quantities import record
from mechsym.simulate.steady import Steady


@record
class AtLoad:
    """The hinge at one load."""

    share: float  #: Load over that of the design [-]
    mean_indicated_pressure: float  #: Load [Pa]
    as_cut: Steady
    reset: Steady  #: With the spring setting that fits this load's work best
    #: That setting, p0 [Pa] or F0 of a coil [N], and over that of the design [-]
    setting: float
    ratio: float


@record
class Origin:
    """What a design was made from, for its report."""

    name: str
    about: str = ""
    source: str = ""
    sections: Mapping[str, Any]  #: Records by section


@record
class Design:
    """A designed hinge and how it runs."""

    origin: Origin
    machine: Machine  #: With its load as declared, perhaps without numbers
    rollers: RollerParameters
    hinge: Hinge  #: Torque that keeps the speed constant
    balance: Balance  #: Part of it that the guide gives
    guide: Guide  #: Guide, or why there is none
    verdict: Verdict
    #: The other way to balance a torque that repeats every two turns; empty for a two-stroke engine
    instead: tuple[Offer, ...]
    trials: tuple[Trial, ...]
    flywheels: Flywheels  #: What the hinge saves, and what a faulty one needs
    sensitivities: tuple[Sensitivity, ...]  #: Ripple for each per cent of error
    retuned: Retuned | None  #: The same guide at the other speed of the case
    flywheel_kept: float  #: Flywheel of the case [kg*m^2]
    price: Price | None = None  #: What the ideal design leaves out; None without a guide
    loads: tuple[AtLoad, ...] = ()  #: The same guide at other loads, as far as they were asked for
