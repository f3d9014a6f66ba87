"""A designed hinge: what it balances, the guide that gives it, how it runs, and where the data came from.

A two-stroke engine has one way to balance its torque, a four-stroke engine two: `whole_cycle` puts the guide on a
slower shaft, which turns once per cycle, and leaves no ripple. `every_turn` lets the guide turn with the crank and
takes only what repeats every turn; the rest stays as speed ripple.

Torque, guide and verdict are there at once. How the engine runs with them costs a hundred times as much and is
computed when it is first asked for.
"""

import dataclasses
import functools
from collections.abc import Callable, Mapping

from mechsym.hinge import balance, steady, trials
from mechsym.hinge.balance import Balance
from mechsym.hinge.choices import BALANCES, GuideParameters, Limits, closing_ratio
from mechsym.hinge.guide import Guide, cut
from mechsym.hinge.limits import Verdict, judge
from mechsym.hinge.price import Price, price
from mechsym.hinge.rollers import HingeLosses, RollerParameters
from mechsym.hinge.springs.face import Spring
from mechsym.hinge.steady import RIPPLE, Flywheels, Retuned, Sensitivity
from mechsym.hinge.torque import Hinge, torque
from mechsym.hinge.trials import RealHinge, Trial
from mechsym.machine.loads import PropellerLoad
from mechsym.machine.record import Machine
from mechsym.page import Shown
from mechsym.quantities import record
from mechsym.quantities.display import figure, per_cent, ratio_text
from mechsym.quantities.records import Record
from mechsym.quantities.results import computed, quantity, result, seen
from mechsym.quantities.units import Pure
from mechsym.simulate.steady import Flywheel, Steady


@result
class Offer:
    """One way to balance the torque, with its guide."""

    taken: Balance  # the part that the hinge takes
    track: Guide  # or why there is none
    verdict: Verdict

    balance: str = seen("taken.kind")  #: Part of the torque that is balanced
    shaft_ratio: float = seen("track.parameters.shaft_ratio", "-")  #: Turns of the guide's shaft by those of the crank
    feasible: bool = seen("verdict.feasible", "-")  #: Whether the guide can be built
    reason: str = seen("verdict.reason")  #: The limits that are not kept, or the tightest one
    work_left: float = seen("taken.rest_swing", "J")  #: Largest less smallest work that is left over
    #: Speed ripple that the rest leaves under a constant load; None for a stop
    ripple_constant_load: float | None = seen("taken.ripple_constant_load", "-")
    #: Speed ripple that the rest leaves under a propeller's load; None for a stop
    ripple_propeller_load: float | None = seen("taken.ripple_propeller_load", "-")


def offers(
    hinge: Hinge, spring: Spring, choices: GuideParameters, rollers: RollerParameters, limits: Limits
) -> tuple[Offer, ...]:
    """The offer that was chosen, and for a torque that repeats every two turns the other one with the same spring.

    hinge: torque that would keep the speed constant; choices: arrangement, start, shaft ratio and balance. Returns
    offers: one or two, the chosen one first.
    """
    kinds = [choices.balance] + [k for k in BALANCES if k != choices.balance]
    parts = [balance.balance(hinge, kind) for kind in kinds]
    if parts[0].period == parts[1].period:
        parts = parts[:1]
    offered = []
    for part in parts:
        wanted = choices if part is parts[0] else _instead(choices, part)
        track = cut(part, spring, wanted)
        offered.append(Offer(taken=part, track=track, verdict=judge(track, rollers, limits)))
    return tuple(offered)


def _instead(choices: GuideParameters, part: Balance) -> GuideParameters:
    ratio = closing_ratio(choices.arrangement, part.period)
    return dataclasses.replace(choices, balance=part.kind, shaft_ratio=ratio)


_SLACK = 0.02  # the ways to compute a ripple differ by about 1 % of it


@result
class Target:
    """A ripple that is asked for, and what the machine has of it with friction and heat."""

    ripple: float = quantity("-")  #: Asked for: largest (max - min) / mean of the speed
    with_losses: tuple[float | None, ...]  #: at each point; None where there is no steady motion [-]
    held: bool  #: guide and rollers keep their limits
    losses: bool = True  #: False where friction and heat were left out on request

    @property
    def kept(self) -> bool:
        """Whether every point keeps the ripple."""
        return all(r is not None and r <= (1 + _SLACK) * self.ripple for r in self.with_losses)

    @computed("-")
    def met(self) -> bool:
        """Whether the machine as built keeps the ripple within its limits."""
        return self.held and self.kept

    #: Ripple at each point with friction and heat; None where there is no steady motion
    ripple_with_losses: tuple[float | None, ...] = seen("with_losses", "-")

    @property
    def words(self) -> str:
        """`ripple of 2 % missed with losses: 9.9 %`."""
        wanted, how = f"ripple of {figure(100 * self.ripple)} %", "with losses" if self.losses else "without losses"
        if None in self.with_losses:
            return f"{wanted} missed: {how} there is no steady motion{' at some points' * (len(self.with_losses) > 1)}"
        worst = max(r for r in self.with_losses if r is not None)
        real = figure(100 * worst, 3 if worst < 2 * self.ripple else 2)
        return f"{wanted} {'met' if self.kept else 'missed'} {how}: {real} %"


def guide_words(target: Target, reason: str) -> str:
    """What is known of a guide; `reason` says which limit it breaks."""
    return f"guide can be cut; {target.words}" if target.held else f"guide CANNOT be built: {reason}"


def design_words(target: Target, status: str, reason: str) -> str:
    """What is known of a co-design; `status` and `reason` are those of its solver, or the limits that are passed."""
    if not target.held:
        return f"{'not within the limits' if status == 'optimal' else status}: {reason}"
    return f"{'optimal' if target.met else 'a guide is found'}; {target.words}"


def ripple_text(share: Pure | None, digits: int = 2) -> str:
    """A ripple in per cent, one of round-off as the ratio that it is."""
    return ratio_text(share, digits) if share is None or abs(share) < 1e-6 else per_cent(share, digits)


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

    #: Steady ripple with the spring as designed; None where there is none
    speed_ripple: float | None = seen("as_cut.speed_ripple", "-")
    reason: str = seen("as_cut.reason")  #: Why
    p0: float = seen("setting", "@unit")  #: Setting of the spring that fits the work of this load best
    p0_ratio: float = seen("ratio", "-")  #: That setting by that of the design
    speed_ripple_reset: float | None = seen("reset.speed_ripple", "-")  #: Steady ripple with it
    reason_reset: str = seen("reset.reason")  #: Why there is none


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
