"""A machine s times as large that turns s times as slowly, of the same stuff: pressures, stresses and speeds of pistons
stay, so every number follows from its unit. What does not follow is a number of the program with a unit of its own.
"""

import dataclasses

from mechsym import cases
from mechsym.quantities.units import exponents

DENSITY = 3  # kg go with the cube of the metre, seconds with the metre


def factor(unit, s):
    """What a number in a unit is multiplied by."""
    if not unit or unit == "-":
        return 1.0
    kg, m, sec, *_ = exponents(unit.replace("(rad*rad)", "rad^2"))
    return s ** (DENSITY * kg + m + sec)


def similar(name, s, changes=None):
    """A built-in case at another size, its defaults too. changes: overrides of the case before that."""
    case, scaled = cases.load(name, changes or {}), dict(changes or {})
    for section, record in case.sections.items():
        for field in dataclasses.fields(record) if dataclasses.is_dataclass(record) else ():
            value, unit = getattr(record, field.name), field.metadata.get("unit")
            if (times := factor(unit, s)) == 1.0 or value is None:
                continue
            numbers = value if isinstance(value, tuple) else (value,)
            if all(isinstance(one, float) and one != 0 for one in numbers):
                scaled[f"{section}.{field.name}"] = ",".join(f"{one * times!r} {unit}" for one in numbers)
    return cases.load(name, scaled)
