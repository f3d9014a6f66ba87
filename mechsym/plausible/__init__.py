"""What is possible and what is usual: nonsense is refused, the unusual is a doubt.

    ranges    hard and usual range of each kind of value, with its reason
    together  the same of what several values make: sizes by bore and stroke
    judge     numbers by name against those ranges; acceptance of a doubt up to a value
    engine    what several values say together: piston speed, rod ratio, masses and spring by the piston's area

Takes numbers and names, so that case files and results are judged alike.
"""

from mechsym.plausible.engine import proportions, scaled
from mechsym.plausible.judge import Acceptance, Doubt, inputs, letters, proportion, results, sifted
from mechsym.plausible.ranges import INPUTS, RESULTS, Usual
from mechsym.plausible.together import PROPORTIONS

__all__ = [
    "INPUTS",
    "PROPORTIONS",
    "RESULTS",
    "Acceptance",
    "Doubt",
    "Usual",
    "inputs",
    "letters",
    "proportion",
    "proportions",
    "results",
    "scaled",
    "sifted",
]


def __dir__() -> list[str]:
    return __all__
