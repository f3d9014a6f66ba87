"""Where each value of a case comes from: its comment, its default, or the command line."""

import pytest

from mechsym import cases
from mechsym.cases.provenance import comments, sourced


def test_comments_key_by_key():
    text = """
# a head
[parameters]
r = "0.2 m"   # Zotov, Fig. 4: radius # with a mark
l = "1 # m"   # same: rod
speed_rpm = 5
z = [1,       # first
     2]       # second
u.v = 1       # dotted
"""
    assert comments(text) == {
        "parameters.r": "Zotov, Fig. 4: radius # with a mark",
        "parameters.l": "Zotov, Fig. 4: rod",
        "parameters.speed_rpm": "",
        "parameters.z": "first; second",
        "parameters.u.v": "dotted",
    }


def test_every_value_of_a_case_has_an_origin():
    rows = {row.key: row for row in sourced(cases.load("zotov-89", {"p0": "6 MPa"}))}
    assert rows["spring.p0"].origin == "set for this run" and rows["spring.p0"].value == "6 MPa"
    assert rows["parameters.l1"].origin.startswith("Zotov et al. 2024, caption of Fig. 4")
    assert rows["spring.pa"].origin == "usual value of mechsym"
    assert rows["cycle.evc"].value == "-110 deg" and rows["cycle.evc"].about


@pytest.mark.parametrize("name", cases.names())
def test_no_value_is_without_origin(name):
    rows = sourced(cases.load(name))
    assert all(row.origin and row.value for row in rows)
    assert [row.key for row in rows if not row.about or "`" in row.about] == []  # each with its meaning


def test_a_height_above_the_sea_is_no_length_of_a_machine():
    rows = {row.key: row.value for row in sourced(cases.load("zotov-89", {"scavenging.altitude": "50 m"}))}
    assert rows["scavenging.altitude"] == "50 m" and rows["cycle.bore"].endswith(" mm")
