"""What is possible and what is usual: nonsense is refused, the unusual is a doubt.

`ranges.csv` has the hard and the usual range of each kind of value, with its reason, and of what several make: sizes by
bore. `judge` holds numbers by name against them, and together: piston speed, rod ratio, masses by the piston's area;
it takes the acceptance of a doubt up to a value.

Takes numbers and names, so that case files and results are judged alike.
"""

from mechsym.plausible.judge import (
    INPUTS,
    PROPORTIONS,
    RESULTS,
    Acceptance,
    Doubt,
    Usual,
    inputs,
    letters,
    moving_mass,
    piston_speed,
    proportion,
    proportions,
    results,
    sifted,
)

__all__ = [
    "INPUTS",
    "PROPORTIONS",
    "RESULTS",
    "Acceptance",
    "Doubt",
    "Usual",
    "inputs",
    "letters",
    "moving_mass",
    "piston_speed",
    "proportion",
    "proportions",
    "results",
    "sifted",
]


def __dir__() -> list[str]:
    return __all__
