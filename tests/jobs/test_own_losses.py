"""Friction and shaking by the roles of a declaration: a Scotch yoke, whose forces are known in closed form."""

import json
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from one_turn import numbers

from mechsym import cases
from mechsym.cli import mechsym
from mechsym.errors import BadInput
from mechsym.jobs.export import ready
from mechsym.out.block import block_of

EXAMPLES = Path(__file__).parents[2] / "examples" / "mechanisms"
CASE = """mechanism = "./yoke.py"
[parameters]
r = 0.1
m_yoke = 2.0
I_crank = 0.05
[operation]
speed = "30 rad/s"
[friction]
mu_guide = 0.1
mu_pin = 0.02
mu_main = 0.5
radius_piston_pin = "1 m"
radius_crank_pin = "20 mm"
radius_main = "1 m"
"""
ROLES = """    m.bearing("shaft", reactions=("R_x_O", "R_y_O"), turns=phi{radius})
    m.guide("slot", reaction="R_n_S", travel=r * sin(phi))
"""


def written(folder, roles):
    text = (EXAMPLES / "scotch_yoke.py").read_text().replace("import Mechanism, pi", "import Mechanism, pi, sin")
    (folder / "yoke.py").write_text(text.replace("    return m", roles + "    return m"))
    (folder / "yoke.toml").write_text(CASE)
    return str(folder / "yoke.toml")


@pytest.fixture
def told(tmp_path):
    def told_of(roles):
        case = cases.load(written(tmp_path, roles))
        return numbers(case)

    return told_of


@pytest.mark.parametrize(("radius", "metres"), [("", 0.02), (", radius=r", 0.1)])
def test_friction_of_bearing_and_slot(told, radius, metres):
    lost = told(ROLES.format(radius=radius))["friction"]
    r, mass, w = 0.1, 2.0, 30.0
    # the pin pushes the yoke with m r w^2 cos phi and slides in it with r w cos phi; the shaft bears the same force
    assert lost["places"]["slot"] == pytest.approx(0.1 * mass * r**2 * w**3 / 2, rel=1e-12)
    assert lost["places"]["shaft"] == pytest.approx(0.02 * metres * mass * r * w**2 * 2 / np.pi * w, rel=1e-5)
    assert lost["power"] == pytest.approx(sum(lost["places"].values()))


def test_the_shaking_force_has_one_order_and_half_of_it_turns_with_the_crank(told):
    found = told(ROLES.format(radius=""))["shaking"]
    amplitudes = np.array(found["orders"]["force_x"]["amplitude"])
    whole = 2.0 * 0.1 * 30.0**2
    assert amplitudes[1] == pytest.approx(whole, rel=1e-12) and np.abs(np.delete(amplitudes, 1)).max() < 1e-10
    assert np.abs(found["orders"]["force_y"]["amplitude"]).max() < 1e-10
    weight = found["counterweight"]
    assert weight["unbalance"] == pytest.approx(2.0 * 0.1 / 2) and weight["angle_deg"] == pytest.approx(180)
    assert weight["rms_before"] == pytest.approx(whole / np.sqrt(2)) and weight["rms_after"] == pytest.approx(whole / 2)


def test_friction_without_a_place_says_so(told):
    lost = told("")["friction"]
    assert lost["power"] == 0 and "declare m.bearing" in lost["note"]
    with pytest.raises(BadInput, match="radius 2\\*r of the bearing 'shaft' is no parameter"):
        told(ROLES.format(radius=", radius=2 * r"))


def test_the_command_tells_it(tmp_path):
    file = written(tmp_path, ROLES.format(radius=""))
    result = CliRunner().invoke(mechsym, ["forces", file, "--json"])
    assert json.loads(result.stdout)["friction"]["power"] > 0
    text = CliRunner().invoke(mechsym, ["forces", file]).stdout
    assert "\nfriction " in text and "kg*m at 180 deg: shaking force" in text


def test_a_coordinate_that_a_bearing_puts_out_is_exported_once(tmp_path):
    text = '[drive]\ntorque = "1 N*m"\ninput = "M_r"\n[simulation]\nt_end = "1 s"\n'
    file = written(tmp_path, ROLES.format(radius=""))
    with open(file, "a") as case:
        case.write(text)
    made = block_of("yoke", "", ready(cases.load(file)))
    names = [port.name for port in (*made.states, *made.outputs)]
    assert len(names) == len(set(names)) and "R_n_S" in names
