"""A designed hinge: what it balances, the guide that gives it, how it runs, and where the data came from.

Torque, guide and verdict are there at once. How the engine runs with them costs a hundred times as much and is
computed when it is first asked for.
"""

import functools
from collections.abc import Callable, Mapping

from mechsym.hinge import steady, trials
from mechsym.hinge.balance import Balance
from mechsym.hinge.guide import Guide
from mechsym.hinge.in_time import RealHinge
from mechsym.hinge.limits import Verdict
from mechsym.hinge.losses import HingeLosses
from mechsym.hinge.price import Price, price
from mechsym.hinge.rollers import RollerParameters
from mechsym.hinge.steady import RIPPLE, Flywheels, Retuned, Sensitivity
from mechsym.hinge.target import Target, guide_words
from mechsym.hinge.torque import Hinge, torque
from mechsym.hinge.trials import Trial
from mechsym.hinge.ways import Offer
from mechsym.machine.loads import PropellerLoad
from mechsym.machine.record import Machine
from mechsym.page import Shown
from mechsym.quantities import record
from mechsym.quantities.records import Record
from mechsym.quantities.results import computed, quantity, result
from mechsym.simulate.steady import Flywheel, Steady


@result
class AtLoad:
    """The hinge at one load."""

    share: float = quantity("-")  #: Load over that of the design
    mean_indicated_pressure: float  #: Load [Pa]
    as_cut: Steady
    reset: Steady  #: With the spring setting that fits this load's work best
    setting: float  #: That setting [unit]
    ratio: float  #: And over that of the design [-]
    unit: str  # of the setting

    @computed("bar")
    def mep_bar(self) -> float:
        """Mean indicated pressure."""
        return self.mean_indicated_pressure / 1e5

    @computed("-")
    def speed_ripple(self) -> float | None:
        """Steady ripple with the spring as designed; None where there is none."""
        return self.as_cut.speed_ripple

    @computed()
    def reason(self) -> str:
        """Why."""
        return self.as_cut.reason

    @computed("@unit")
    def p0(self) -> float:
        """Setting of the spring that fits the work of this load best."""
        return self.setting

    @computed("-")
    def p0_ratio(self) -> float:
        """That setting by that of the design."""
        return self.ratio

    @computed("-")
    def speed_ripple_reset(self) -> float | None:
        """Steady ripple with it."""
        return self.reset.speed_ripple

    @computed()
    def reason_reset(self) -> str:
        """Why there is none."""
        return self.reset.reason


@record
class JudgedHinge:
    """What is known of a hinge before its guide is cut."""

    machine: Machine  #: With its load as declared, perhaps without numbers
    hinge: Hinge  #: Torque that keeps the speed constant
    verdict: Verdict

    @property
    def flywheels(self) -> Flywheels:
        """What the hinge saves; the same for every guide of one engine."""
        return steady.flywheels(self.machine, self.hinge)


@record
class Origin:
    """What a design was made from, for its report."""

    name: str
    about: str = ""
    source: str = ""
    sections: Mapping[str, Record]  #: By section


@record
class Design(JudgedHinge, Shown):
    """A designed hinge and how it runs."""

    origin: Origin
    rollers: RollerParameters
    balance: Balance  #: Part of the torque that the guide gives
    guide: Guide  #: Guide, or why there is none
    #: The other way to balance a torque that repeats every two turns; empty for a two-stroke engine
    instead: tuple[Offer, ...]
    flywheel_kept: float  #: Flywheel of the case [kg*m^2]
    turns: float  #: Turns of each trial [-]
    assumed: HingeLosses = HingeLosses()  #: What an ideal hinge leaves out
    in_time: HingeLosses | None = None  #: Friction in the runs in time; None for an ideal hinge
    other: Callable[[], Machine | None] = lambda: None  #: The engine at the other speed of the case, if it has one
    at_loads: Callable[[Guide], tuple[AtLoad, ...]] = lambda guide: ()  #: A guide at the loads that were asked for

    @functools.cached_property
    def usable(self) -> Guide | None:
        """The guide, if it could be cut."""
        return None if self.guide.rho is None else self.guide

    @functools.cached_property
    def check(self) -> Trial | None:
        """The run that proves the design: with the hinge, under the load of the case; None without a guide."""
        if self.usable is None:
            return None
        law = "propeller" if isinstance(self.machine.load, PropellerLoad) else "constant"
        return trials.trial(f"hinge_{law}", self.machine, self.hinge, self.real(self.usable), self.turns)

    def real(self, guide: Guide) -> RealHinge:
        """A guide with what the runs in time have beside it."""
        return RealHinge(guide=guide, rollers=self.rollers, losses=self.in_time)

    @functools.cached_property
    def trials(self) -> tuple[Trial, ...]:
        """All runs in time, the proof among them."""
        hinge = self.real(self.usable) if self.usable else None
        runs = trials.side_by_side(self.machine, self.hinge, hinge, self.turns, self.check)
        if inertia := self.flywheels.steady.inertia:
            runs.append(trials.with_flywheel(self.machine, self.hinge, inertia, self.turns))
        return tuple(runs)

    @functools.cached_property
    def beside_faulty(self) -> Flywheel | None:
        """The flywheel that a faulty hinge needs; None without a guide."""
        return steady.beside_faulty(self.machine, self.hinge, self.usable) if self.usable else None

    @functools.cached_property
    def sensitivities(self) -> tuple[Sensitivity, ...]:
        """Ripple for each per cent of error."""
        return tuple(steady.sensitivities(self.machine, self.hinge, self.usable)) if self.usable else ()

    @functools.cached_property
    def retuned(self) -> Retuned | None:
        """The same guide at the other speed of the case."""
        other = self.other() if self.usable else None
        return (
            steady.retuned(other, torque(other), self.real(self.usable), self.turns) if other and self.usable else None
        )

    @functools.cached_property
    def price(self) -> Price | None:
        """What the ideal design leaves out; None without a guide."""
        return price(self.machine, self.hinge, self.usable, self.rollers, self.assumed) if self.usable else None

    @property
    def target(self) -> Target:
        """The ripple of every hinge, and whether this one keeps it with losses."""
        real = None if self.price is None else self.price.speed_ripple
        return Target(ripple=RIPPLE, with_losses=(real,), held=self.verdict.feasible)

    @property
    def answer(self) -> str:
        """The verdict in a sentence."""
        return guide_words(self.target, self.verdict.reason)

    @functools.cached_property
    def loads(self) -> tuple[AtLoad, ...]:
        """The same guide at the loads that were asked for."""
        return self.at_loads(self.usable) if self.usable else ()


LATER = ("check", "trials", "flywheels", "beside_faulty", "sensitivities", "retuned", "price", "loads")


def complete(design: Design, progress: Callable[[], object] = lambda: None) -> Design:
    """Compute all of a design; `progress` is called after each part named in `LATER`."""
    for part in LATER:
        getattr(design, part)
        progress()
    return design
