"""The equations of a mechanism as papers write them, from what its derivation has stored."""

import re

from mechsym.mechanisms.plan import plan_of
from mechsym.mechanisms.record import listing
from mechsym.quantities import record

_WORD = re.compile(r"(?<![\\A-Za-z])[A-Za-z]{2,}")


@record
class MechanismEquations:
    """Equations of one mechanism; a notebook shows them set."""

    name: str
    rows: tuple[dict[str, str], ...]  #: Keys title and latex, in the order of the derivation

    @property
    def latex(self) -> str:
        """All equations in one `align*`, with the title of each group before it."""
        lines, title = [], ""
        for row in self.rows:
            if row["title"] != title:
                title = row["title"]
                lines.append(rf"  \text{{{title}:}} \\")
            lines.append("  " + row["latex"].replace("=", "&=", 1) + r" \\")
        return "\n".join([r"\begin{align*}", *lines, r"\end{align*}"])

    def _repr_latex_(self) -> str:
        return self.latex


def equations(name: str) -> MechanismEquations:
    """Equations of a mechanism: kinematics, motion, energies.

    name: name of a mechanism, or a file with one.

    >>> equations("crosshead").rows[0]["latex"]
    'l = l_{1} + l_{2}'
    """
    listed = listing(plan_of(name).theory)["equations"]
    # names of several letters are words and stand upright; a single letter is a quantity
    upright = [_WORD.sub(lambda word: rf"\mathrm{{{word[0]}}}", row["latex"]) for row in listed]
    rows = tuple({"title": row["title"], "latex": text} for row, text in zip(listed, upright, strict=True))
    return MechanismEquations(name=name, rows=rows)
