"""What a hinge can offer: a two-stroke engine has one way to balance its torque, a four-stroke engine two.

`whole_cycle` puts the guide on a slower shaft, which turns once per cycle, and leaves no ripple. `every_turn` lets the
guide turn with the crank and takes only what repeats every turn; the rest stays as speed ripple.
"""

import dataclasses

from mechsym.hinge import balance
from mechsym.hinge.balance import Balance
from mechsym.hinge.choices import BALANCES, GuideParameters, Limits, closing_ratio
from mechsym.hinge.guide import Guide, Spring, cut
from mechsym.hinge.limits import Verdict, judge
from mechsym.hinge.rollers import RollerParameters
from mechsym.hinge.torque import Hinge
from mechsym.quantities import record


@record
class Offer:
    """One way to balance the torque, with its guide."""

    balance: Balance  #: The part that the hinge takes, and the ripple that the rest leaves
    guide: Guide  #: Guide, or why there is none
    verdict: Verdict


def offers(
    hinge: Hinge, spring: Spring, choices: GuideParameters, rollers: RollerParameters, limits: Limits
) -> tuple[Offer, ...]:
    """The offer that was chosen, and for a torque that repeats every two turns the other one with the same spring.

    Parameters
    ----------
    hinge : Hinge
        Torque that would keep the speed constant
    choices : GuideParameters
        Arrangement, start, shaft ratio and balance

    Returns
    -------
    offers : tuple of Offer
        One or two, the chosen one first
    """
    kinds = [choices.balance] + [k for k in BALANCES if k != choices.balance]
    parts = [balance.balance(hinge, kind) for kind in kinds]
    if parts[0].period == parts[1].period:
        parts = parts[:1]
    found = []
    for part in parts:
        wanted = choices if part is parts[0] else _instead(choices, part)
        track = cut(part, spring, wanted)
        found.append(Offer(balance=part, guide=track, verdict=judge(track, rollers, limits)))
    return tuple(found)


def _instead(choices: GuideParameters, part: Balance) -> GuideParameters:
    ratio = closing_ratio(choices.arrangement, part.period)
    return dataclasses.replace(choices, balance=part.kind, shaft_ratio=ratio)
