"""What a hinge can offer: a two-stroke engine has one way to balance its torque, a four-stroke engine two.

`whole_cycle` puts the guide on a slower shaft, which turns once per cycle, and leaves no ripple. `every_turn` lets the
guide turn with the crank and takes only what repeats every turn; the rest stays as speed ripple.
"""

import dataclasses

from mechsym.hinge import balance
from mechsym.hinge.balance import Balance
from mechsym.hinge.choices import BALANCES, GuideParameters, Limits, closing_ratio
from mechsym.hinge.guide import Guide, cut
from mechsym.hinge.limits import Verdict, judge
from mechsym.hinge.rollers import RollerParameters
from mechsym.hinge.springs.face import Spring
from mechsym.hinge.torque import Hinge
from mechsym.quantities.results import computed, result


@result
class Offer:
    """One way to balance the torque, with its guide."""

    taken: Balance  # the part that the hinge takes
    track: Guide  # or why there is none
    verdict: Verdict

    @computed()
    def balance(self) -> str:
        """Part of the torque that is balanced."""
        return self.taken.kind

    @computed("-")
    def shaft_ratio(self) -> float:
        """Turns of the guide's shaft by those of the crank."""
        return self.track.parameters.shaft_ratio

    @computed("-")
    def feasible(self) -> bool:
        """Whether the guide can be built."""
        return self.verdict.feasible

    @computed()
    def reason(self) -> str:
        """The limits that are not kept, or the tightest one."""
        return self.verdict.reason

    @computed("J")
    def work_left(self) -> float:
        """Largest less smallest work that is left over."""
        return self.taken.rest_swing

    @computed("-")
    def ripple_constant_load(self) -> float | None:
        """Speed ripple that the rest leaves under a constant load; None for a stop."""
        return self.taken.ripple_constant_load

    @computed("-")
    def ripple_propeller_load(self) -> float | None:
        """Speed ripple that the rest leaves under a propeller's load; None for a stop."""
        return self.taken.ripple_propeller_load


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
    found = []
    for part in parts:
        wanted = choices if part is parts[0] else _instead(choices, part)
        track = cut(part, spring, wanted)
        found.append(Offer(taken=part, track=track, verdict=judge(track, rollers, limits)))
    return tuple(found)


def _instead(choices: GuideParameters, part: Balance) -> GuideParameters:
    ratio = closing_ratio(choices.arrangement, part.period)
    return dataclasses.replace(choices, balance=part.kind, shaft_ratio=ratio)
