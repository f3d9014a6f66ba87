"""What two records differ in: a number beyond rounding, a word, a key, an exit status; and what is no difference."""

import pytest
from matrix.compare import Scales, differences, same_text
from matrix.entries import EVERY, HEAVY, ONE, PLAIN, entries
from matrix.record import MASK, rounded

from mechsym.cli import COMMANDS

KEPT = {"exit": 0, "text": ["peak 12.34 MPa at 8 deg"], "json": {"p_max": 1.2345e7, "kinds": ["a"], "steps": 7}}


@pytest.mark.parametrize(("changes", "told"), [
    ({"exit": 1}, ".exit: 0, now 1 (1.0e+00)"),
    ({"text": ["peak 12.36 MPa at 8 deg"]}, ".text[0]: 'peak 12.34 MPa at 8 deg', now 'peak 12.36 MPa at 8 deg'"),
    ({"text": ["peak 12.34 MPa at 9 deg"]}, ".text[0]: 'peak 12.34 MPa at 8 deg', now 'peak 12.34 MPa at 9 deg'"),
    ({"json": {"p_max": 1.2346e7, "kinds": ["a"], "steps": 7}}, ".json.p_max: 12345000, now 12346000 (8.1e-05)"),
    ({"json": {"p_max": None, "kinds": ["a"], "steps": 7}}, ".json.p_max: 12345000.0, now None"),
    ({"json": {"p_max": 1.2345e7, "kinds": [], "steps": 7}}, ".json.kinds: 1 entries, now 0"),
    ({"json": {"kinds": ["a"], "steps": 7}}, ".json.p_max: gone"),
])  # fmt: skip
def test_a_difference_is_told_with_its_place(changes, told):
    assert [*differences(KEPT, KEPT | changes)] == [told]


@pytest.mark.parametrize("changes", [
    {}, {"text": ["peak 12.35 MPa at  8 deg"]}, {"json": {"p_max": 1.2345e7 * (1 + 1e-9), "kinds": ["a"], "steps": 9}},
])  # fmt: skip
def test_rounding_is_no_difference(changes):
    assert not [*differences(KEPT, KEPT | changes)]


def test_whole_numbers_count():
    assert not same_text("3 of 4 limits", "3 of 5 limits", 1e-6)
    assert same_text("steps      1030", "steps      1009", 1e-6)
    assert not same_text("x = 1.2e-03 m", "x = 1.4e-03 m", 1e-6) and same_text("x = 1.2e-03 m", "x = 1.3e-03 m", 1e-6)
    assert same_text("energy residual       0", "energy residual       below 1e-8", 1e-6)
    assert not same_text("energy residual       0", "energy residual       below 1e-5", 1e-6)
    assert not [*differences({"energy_residual": 3e-11}, {"energy_residual": -8e-12})]
    assert [*differences({"energy_residual": 3e-11}, {"energy_residual": 2e-3})]


def test_what_is_left_of_a_sum_is_known_to_a_share_of_the_largest_of_its_unit():
    old = {"json": {"check": {"speed_ripple": 4e-12}, "energy": {"work": {"gas": 1.7e4, "hinge": -3e-7}}}}
    now = {"json": {"check": {"speed_ripple": 5e-12}, "energy": {"work": {"gas": 1.7e4, "hinge": 2e-7}}}}
    assert len([*differences(old, now)]) == 2
    energies = {"json": {"energy": old["json"]["energy"]}}, {"json": {"energy": now["json"]["energy"]}}
    assert not [*differences(*energies, scales=Scales(now, "simulate"))]
    ripple = {"json": {"check": old["json"]["check"]}}, {"json": {"check": now["json"]["check"]}}
    assert not [*differences(*ripple, scales=Scales(now, "hinge"))]
    small = {"json": {"energy": {"work": {"gas": 1e-4, "hinge": -3e-7}}}}
    assert [
        *differences(
            small, {"json": {"energy": {"work": {"gas": 1e-4, "hinge": 2e-7}}}}, scales=Scales(small, "simulate")
        )
    ]
    column = {"t.csv": {"W [J]": {"last": 1e4}, "V [J]": {"last": 1e-7}, "s [m]": {"last": 1e-7}}}
    other = {"t.csv": {"W [J]": {"last": 1e4}, "V [J]": {"last": 2e-7}, "s [m]": {"last": 2e-7}}}
    assert [line.split(":")[0] for line in differences(column, other, scales=Scales(other))] == [".t.csv.s [m].last"]


def test_a_list_without_a_unit_is_measured_by_itself_and_never_by_its_length():
    old = {"json": {"orders": {"phase": {"count": 13, "min": -5.47e-12, "max": 3.14}}, "gap": -5.47e-12}}
    now = {"json": {"orders": {"phase": {"count": 13, "min": -5.42e-12, "max": 3.14}}, "gap": -5.42e-12}}
    assert [line.split(":")[0] for line in differences(old, now, scales=Scales(now))] == [".json.gap"]
    assert Scales({"t.csv": {"x [m]": {"count": 1440, "max": 0.2}}}).of(".t.csv.x [m].min") == 0.2


def test_long_lists_are_kept_by_their_figures():
    kept = rounded({"wall_s": 3.2, "x": [0.1 * k for k in range(101)], "y": 1 / 3})
    figures = {"count": 101, "first": 0.0, "last": 10.0, "min": 0.0, "max": 10.0}
    assert kept == {"wall_s": MASK, "x": figures, "y": 0.333333333}


def test_every_command_is_in_the_matrix():
    said = {line.split()[0] for lines in (EVERY, PLAIN, *ONE.values()) for line in lines.values()}
    assert set(COMMANDS) - said == {"app", "cite", "native"}  # a server; what this machine has; the version
    assert len({entry.name for entry in entries()}) == len([*entries()])
    assert set(HEAVY) <= {entry.command for entry in entries()}
