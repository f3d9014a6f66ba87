"""Results tell their numbers with units: the same names in JSON, in the list of a class, and leaf by leaf."""

import json
import re

import numpy as np
import pytest

from mechsym.cli.results import RESULTS
from mechsym.files import to_json
from mechsym.quantities import record
from mechsym.quantities.results import Columns, computed, declared, leaves, part, quantity, result, tell, units_of


@record
class Losses:
    """An input that a result repeats."""

    mu: float = quantity("-", above=0)


@result
class Row:
    """A part with a unit of its own."""

    component: str = part()
    value: float = quantity("@unit")  #: What is held against the limit
    unit: str = part()


@result
class Answer:
    """A result with everything that results have."""

    torque: float | None = quantity("N*m", about="of the load")
    speeds: tuple[float, ...] = quantity("rpm")  #: Speeds of the range
    work: dict[str, float] = quantity("J")  #: By who gives it
    rows: tuple[Row, ...] = part()
    largest: Columns = part()  #: Of each column
    assumed: Losses = part()
    engine: object = None  # stays behind

    @computed("kg*m^2")
    def inertia(self) -> float:
        """Inertia that the torque asks for.

        Seldom needed.
        """
        return 2 * (self.torque or 0.0)


ANSWER = Answer(
    torque=3.0,
    speeds=(60.0, 89.0),
    work={"gas": 5.0},
    rows=(Row(component="pin", value=2.0, unit="MPa"),),
    largest=Columns({"pin": np.array([1.0, 4.0])}, {"pin": "N", "other": "m"}).each(np.max),
    assumed=Losses(mu=0.1),
)


def test_json_has_what_is_told_and_nothing_else():
    assert json.loads(to_json(ANSWER)) == {
        "torque": 3.0,
        "speeds": [60.0, 89.0],
        "work": {"gas": 5.0},
        "rows": [{"component": "pin", "value": 2.0, "unit": "MPa"}],
        "largest": {"pin": 4.0},
        "assumed": {"mu": 0.1},
        "inertia": 6.0,
    }


def test_each_number_has_its_unit():
    assert {leaf.path: leaf.unit for leaf in leaves(ANSWER)} == {
        "torque": "N*m",
        "speeds": "rpm",
        "work.gas": "J",
        "rows[0].value": "MPa",
        "largest.pin": "N",
        "assumed.mu": "-",
        "inertia": "kg*m^2",
    }


def test_a_class_tells_its_numbers_before_they_are_computed():
    assert {d.path: (d.unit, d.about) for d in declared(Answer)} == {
        "torque": ("N*m", "of the load"),
        "speeds": ("rpm", "Speeds of the range"),
        "work.*": ("J", "By who gives it"),
        "rows[].value": ("in unit", "What is held against the limit"),
        "largest.*": ("of its column", "Of each column"),
        "assumed.mu": ("-", ""),
        "inertia": ("kg*m^2", "Inertia that the torque asks for"),
    }


def test_only_what_is_wanted_is_computed():
    class Slow:
        @computed("s")
        def long(self) -> float:
            """Not wanted here."""
            raise AssertionError

        @computed("s")
        def short(self) -> float:
            """Wanted."""
            return 1.0

    assert tell(Slow(), only=("short",)) == {"short": 1.0}
    assert units_of(Slow) == {"long": "s", "short": "s"}


def test_columns_without_a_unit_are_refused():
    with pytest.raises(KeyError, match="no unit of travel"):
        Columns({"travel": 1.0}, {})


@pytest.mark.parametrize("command", RESULTS)
def test_every_number_that_a_command_may_tell_has_unit_and_meaning(command):
    from mechsym.cli.results import rows

    listed = rows(command)
    assert listed
    assert [row["path"] for row in listed if not row["unit"] or not re.search(r"\w", row["about"])] == []
