"""`check` of a user's own engine: what its motion denies of its pistons, and no doubts that follow from an error."""

import json
import re

import pytest
from click.testing import CliRunner

from mechsym.cli import mechsym
from mechsym.mechanisms import listing

ENGINE = """
from mechsym.derive import Mechanism, pi

def single():
    m = Mechanism("single", about="One cylinder.")
    phi = m.coordinates("phi")
    F, M = m.inputs("F", "N"), m.inputs("M", "N*m")
    crank = m.link("crank", turns=phi, inertia="0.05 kg*m^2")
    rod = m.link("rod", mass="0.5 kg", centre=("45 mm", 0), inertia="1.6e-3 kg*m^2")
    piston = m.link("piston", mass="0.4 kg")
    m.pin("O", m.frame, crank)
    m.pin("A", crank.at("40 mm"), rod)
    m.slider("G", m.frame.line(), piston)
    m.pin("B", rod.at("140 mm"), piston, branch=BRANCH)
    x = m.let("x", m.parameters("far", "m", default="180 mm") - piston.at().x, "m")
    m.force(F, along=x)
    m.piston("p", travel=x, force=F, fires=FIRES)
    m.rotor("crank", angle=phi, load=M)
    m.torque(-M, along=phi)
    return m
"""
CASE = """
mechanism = "./single.py"
[operation]
speed = "3000 rpm"
[chamber]
bore = "88 mm"
compression_ratio = 10
[heat_transfer]
law = "woschni"
wall_temperature = "450 K"
[cycle]
kind = "spark-ignition"
intake_pressure = "0.95 bar"
intake_temperature = "340 K"
ignition = "-10 deg"
duration = "55 deg"
air_fuel_ratio = 14.7
stoichiometric_ratio = 14.7
heating_value = "44 MJ/kg"
"""


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)  # files below the working folder are the user's own


def checked(folder, fires="0", case=CASE, branch="1"):
    (folder / "single.py").write_text(ENGINE.replace("FIRES", fires).replace("BRANCH", branch))
    (folder / "case.toml").write_text(case)
    result = CliRunner().invoke(mechsym, ["check", str(folder / "case.toml"), "--json"], catch_exceptions=False)
    return result.exit_code, json.loads(result.stdout)


@pytest.mark.parametrize("fires", ["0", "2 * pi"])
def test_a_piston_that_fires_at_its_dead_centre_is_no_problem(tmp_path, fires):
    code, told = checked(tmp_path, fires)
    assert code == 0 and told["problems"] == [] and told["commands"]["cycle"] == []


def test_a_piston_that_fires_elsewhere_is_a_problem_of_its_file(tmp_path):
    code, told = checked(tmp_path, "pi / 2")
    (problem,) = told["problems"]
    assert code == 2 and problem["key"] == "mechanism"
    # x = r + l - r cos(phi) - sqrt(l^2 - r^2 sin(phi)^2), a quarter of a turn behind its dead centre
    below = 1e3 * (0.04 + 0.14 - (0.14**2 - 0.04**2) ** 0.5)
    assert f"fires 90 deg after its own top dead centre at 0 deg, where it stands {below:.4g} mm" in problem["why"]


@pytest.mark.parametrize(("branch", "doubts"), [("1", []), ("-1", ["inwards"])])
def test_gas_between_piston_and_shaft_is_doubted(tmp_path, branch, doubts):
    _, told = checked(tmp_path, branch=branch)
    assert [one["code"] for one in told["doubts"]] == doubts
    if doubts:  # 140 - 40 mm from the shaft at the top, 140 + 40 mm at the bottom
        assert told["doubts"][0]["value"] == pytest.approx(100 / 180, rel=1e-9)


def test_an_unknown_kind_of_cycle_makes_no_doubt_about_what_reads_it(tmp_path):
    code, told = checked(tmp_path, case=CASE.replace("spark-ignition", "otto"))
    assert code == 2 and [one["key"] for one in told["problems"]] == ["cycle.kind"]
    assert not [one for one in told["doubts"] if "unread" in one["quantity"]]


def test_a_key_of_another_section_is_named_by_that_section_alone(tmp_path):
    _, told = checked(tmp_path, case=CASE.replace("[cycle]\n", '[cycle]\nbore = "88 mm"\n'))
    (problem,) = told["problems"]
    assert problem["key"] == "cycle.bore" and re.match(r"it is a key of \[chamber\];", problem["allowed"])


STRUT = """
from mechsym.derive import Mechanism

def lever():
    m = Mechanism("lever", space=3, about="A lever lifts a sleeve by a strut.")
    al = m.coordinates("al")
    inertia = ("0.01 kg*m^2", "0.01 kg*m^2", "0.001 kg*m^2")
    arm, sleeve = m.link("arm", mass="1 kg", centre=(0, 0, "0.2 m"), inertia=inertia), m.link("sleeve", mass="2 kg")
    m.revolute("R", m.frame.axis("y"), arm.axis("y"), turns=al)
    m.prismatic("Z", m.frame.axis("z"), sleeve.axis("z"), pose="0.5 m")
    m.strut("S", arm.at(0, 0, "0.3 m"), sleeve, length="0.3 m")
    return m
"""


def test_a_strut_is_drawn_from_joint_to_joint(tmp_path):
    (tmp_path / "lever.py").write_text(STRUT)
    shapes = listing(f"{tmp_path / 'lever.py'}:lever")["shapes"]
    assert (
        len([one for one in shapes if one["kind"] == "line" and len(one["points"]) == 2]) == 2
    )  # the arm and the strut
