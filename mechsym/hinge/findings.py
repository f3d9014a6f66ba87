"""What a reader of a hinge has to know first: the ripple with losses, a lost combustion, what it forgives least."""

from collections.abc import Iterator

from mechsym.hinge.result import Design
from mechsym.hinge.summary import HingeNumbers
from mechsym.page.finding import LEAST_SURE, LOOK_AT, NOT_MET, Finding
from mechsym.quantities.display import figure, quantity_text
from mechsym.quantities.units import Pure

_FEW = 0.9  # of the speed: what one lost combustion may leave without a word


def of_design(design: Design) -> Iterator[Finding]:
    """What of a hinge design has to be known first."""
    numbers = HingeNumbers(judged=design)
    if not design.target.met:
        worst = [ripple for ripple in design.target.with_losses if ripple is not None]
        yield Finding(rank=NOT_MET, words=design.answer, value=max(worst, default=None))
    yield from lost_combustion(numbers.misfire_speed_share)
    yield from _least_sure(design)


def lost_combustion(share: Pure | None, where: str = "") -> Iterator[Finding]:
    """What one lost combustion does, where it is much.

    share: lowest speed after it, by the mean; 0 stalls. where: at which point, with the word before it.
    """
    if share is not None and share < _FEW:
        left = f"pulls the speed down to {figure(100 * share, 2)} % of its mean" if share else "stops the shaft"
        words = f"one lost combustion{where} {left} with the flywheel that is kept"
        yield Finding(rank=LOOK_AT if share else NOT_MET, words=words, value=share)


def _least_sure(design: Design) -> Iterator[Finding]:
    """The quantity of the spring of which 1 % costs most."""
    sides = [(one, side.speed_ripple) for one in design.sensitivities for side in (one.low, one.high)]
    known = [(ripple, one) for one, ripple in sides if ripple is not None]
    if known:
        ripple, worst = max(known, key=lambda row: row[0])
        value = quantity_text(worst.value, worst.unit, 4)
        words = f"{worst.name} = {value}: 1 % off it, the ripple is {figure(100 * ripple, 2)} %"
        yield Finding(rank=LEAST_SURE, words=words, value=ripple)
