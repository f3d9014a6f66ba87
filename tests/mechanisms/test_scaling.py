"""Right equations rescale exactly: other units of mass, length and time give the same results in other units."""

import re

import pytest

from mechsym.derive.build import scripts
from mechsym.mechanisms.record import bind, listing
from mechsym.mechanisms.state import state

SCALES = {"kg": 3.7, "m": 0.41, "s": 1.9, "rad": 1.0, "-": 1.0, "": 1.0, "1": 1.0}
SCALES |= {"N": SCALES["kg"] * SCALES["m"] / SCALES["s"] ** 2}
SCALES |= {"J": SCALES["N"] * SCALES["m"]}


def factor(unit):
    """Value of a unit text such as kg*m^2, N*m*s/rad or m/(rad*rad) in the other system."""
    value = 1.0
    top, _, bottom = unit.partition("/")
    for text, sign in ((top, 1), (bottom, -1)):
        for part in re.split(r"[*/]", text.strip("()")):
            name, _, power = part.partition("^")
            value *= SCALES[name.strip("()")] ** (sign * int(power.strip("()") or 1))
    return value


def sample(name, rng):
    letters = listing(name)
    parameters = {n: rng.uniform(0.1, 1.0) + (2.0 if n[0] == "l" else 0.0) for n in letters["parameters"]}
    values = {n: rng.uniform(-2, 2) for n in letters["coordinates"] | letters["inputs"]}
    values |= {f"{n}d": rng.uniform(-5, 5) for n in letters["coordinates"]}
    if name == "rodless_constraints":
        values = {n: v for n, v in values.items() if n in ("alpha", "alphad", "F_a", "F_b", "M")}
    return letters, parameters, values


@pytest.mark.parametrize("name", scripts())
def test_other_units_give_the_same_results(name, rng):
    letters, parameters, values = sample(name, rng)
    units = letters["coordinates"] | letters["inputs"] | letters["parameters"]
    units |= {f"{q}d": f"{u}/s" for q, u in letters["coordinates"].items()}
    here = state(bind(name, parameters), values)
    there = state(
        bind(name, {n: v * factor(units[n]) for n, v in parameters.items()}),
        {n: v * factor(units[n]) for n, v in values.items()},
    )
    scale = max(abs(v) for v in here.outputs.values() if v is not None)
    for output, unit in letters["outputs"].items():
        wanted = here.outputs[output] * factor(unit)
        assert there.outputs[output] == pytest.approx(wanted, rel=1e-10, abs=1e-11 * scale * factor(unit)), output
    for a, b, unit in zip(here.acceleration, there.acceleration, letters["coordinates"].values(), strict=True):
        assert b == pytest.approx(a * factor(unit) / SCALES["s"] ** 2, rel=1e-9)
