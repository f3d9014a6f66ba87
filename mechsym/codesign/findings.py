"""What a reader of a co-design has to know first: a missed target, a lost combustion, what is least sure."""

from collections.abc import Iterator

from mechsym.codesign.result import CoDesignResult
from mechsym.hinge.findings import lost_combustion
from mechsym.page.finding import LEAST_SURE, NOT_MET, Finding
from mechsym.quantities.display import figure, quantity_text


def of_codesign(found: CoDesignResult) -> Iterator[Finding]:
    """What of a co-design has to be known first."""
    if not found.target.met:
        worst = [ripple for ripple in found.target.with_losses if ripple is not None]
        yield Finding(rank=NOT_MET, words=found.answer, value=max(worst, default=None))
    points = found.design.task.points
    known = [(share, k) for k, share in enumerate(found.misfire) if share is not None]
    if known:
        share, k = min(known)
        where = f" at {quantity_text(points[k].omega, 'rad/s', 4)}" if len(points) > 1 else ""
        yield from lost_combustion(share, where)
    if found.taken != "none":
        shares = [at.total / abs(p.load_torque) for at, p in zip(found.losses, points, strict=True)]
        words = f"friction in the hinge is assumed: {figure(100 * max(shares), 3)} % of the torque at the worst point"
        yield Finding(rank=LEAST_SURE, words=words, value=max(shares))
