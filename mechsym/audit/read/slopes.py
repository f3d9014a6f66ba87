"""The names of derivatives by a letter: dx_dphi, and d2x_dphi2 for the second."""

import re
from typing import NamedTuple

PRIMES = re.compile(r"(\w+?)((?:prime)+)")  #: A letter with primes
_NAME = r"d(?P<times>[2-9]?)(?P<of>[A-Za-z]\w*)_d(?P<by>{})(?P=times)"


class Slope(NamedTuple):
    """A derivative of what `of` names, by the letter `by`."""

    of: str
    by: str
    order: int = 1  # -

    @property
    def name(self) -> str:
        """The plain name: dx_dphi.

        >>> Slope("x", "phi", 2).name
        'd2x_dphi2'
        """
        times = str(self.order) if self.order > 1 else ""
        return f"d{times}{self.of}_d{self.by}{times}"

    @property
    def once_more(self) -> str:
        """Name of the next derivative by the same letter."""
        return Slope(self.of, self.by, self.order + 1).name

    @property
    def integrated(self) -> str:
        """Name of what this is the slope of."""
        return Slope(self.of, self.by, self.order - 1).name if self.order > 1 else self.of


def slope_in(name: str, by: str = "") -> Slope | None:
    """The derivative that a name is; None for any other name, and for one by another letter than `by`.

    Say `by` where it is known: dx_dr_drum is by r_drum, and dF_drag_dphi of F_drag.

    >>> slope_in("d2x_dphi2")
    Slope(of='x', by='phi', order=2)
    """
    match = re.fullmatch(_NAME.format(re.escape(by) or r"[A-Za-z]\w*?"), name)
    return Slope(match["of"], match["by"], int(match["times"] or 1)) if match else None
