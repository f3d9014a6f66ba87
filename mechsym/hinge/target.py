"""Is the ripple that was asked for kept with losses? The one sentence that commands, pages, cards and the app say."""

from mechsym.quantities.display import figure, per_cent, ratio_text
from mechsym.quantities.results import computed, quantity, result
from mechsym.quantities.units import Pure

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

    @computed("-")
    def ripple_with_losses(self) -> tuple[float | None, ...]:
        """Ripple at each point with friction and heat; None where there is no steady motion."""
        return self.with_losses

    @property
    def words(self) -> str:
        """`2 % missed with losses: 9.9 %`."""
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
