"""Figures of an engine of several cylinders against its mean torque over a turn, found from the whole mechanism."""

import json
import math

import numpy as np
import pytest
from click.testing import CliRunner

from mechsym import cases
from mechsym.cases.new_engine import write_engine
from mechsym.cli import mechsym
from mechsym.errors import BadInput
from mechsym.jobs.cycle import cycle, cylinders
from mechsym.jobs.machine import turn

SIX = """
mechanism = "crank_train"
source = "own"
about = "four-stroke six in line"
[parameters]
throw = [1, 2, 3, 4, 5, 6]
phase = ["0 deg", "240 deg", "120 deg", "120 deg", "240 deg", "0 deg"]
firing = ["0 deg", "480 deg", "240 deg", "600 deg", "120 deg", "360 deg"]
r = "45 mm"
l1 = "50 mm"
l2 = "100 mm"
m_rod = "0.6 kg"
I_rod = "0.003 kg*m^2"
m_piston = "0.5 kg"
I0 = "0.01 kg*m^2"
I_f = "0.2 kg*m^2"
k = "4e5 N*m/rad"
[operation]
speed = "3000 rpm"
"""


@pytest.fixture
def six(tmp_path):
    def write(**changes):
        text = SIX
        for section in ("chamber", "cycle", "heat_transfer"):
            body = cases.text("nunes-slider-crank").split(f"\n[{section}]\n", 1)[1].split("\n\n", 1)[0]
            text += f"\n[{section}]\n{body}\n"
        text = text.replace("pistons = 2 ", "pistons = 1 ")
        for key, value in changes.items():
            text = "\n".join(f"{key} = {value}" if line.startswith(f"{key} =") else line for line in text.splitlines())
        path = tmp_path / "six.toml"
        path.write_text(text)
        return str(path)

    return write


def test_a_six_has_the_power_of_six(six):
    case = cases.load(six())
    found, one = cycle(case), turn(case)
    assert found["cylinders"] == 6
    assert found["torque_avg"][0] == pytest.approx(one.torque.mean(), rel=2e-4)  # its gas is tabulated
    assert found["torque_max"][0] == pytest.approx(one.torque.max(), rel=1e-12)
    assert found["power_kw"][0] == pytest.approx(found["torque_avg"][0] * 3000 * math.pi / 30 / 1e3)
    assert found["per_cylinder"]["power_kw"][0] == pytest.approx(found["power_kw"][0] / 6)
    assert found["per_cylinder"]["torque_max"][0] > found["torque_max"][0] / 6


@pytest.mark.parametrize(("name", "count"), [("opposed-pistons", 2), ("balandin", 4), ("moroianu", 1)])
def test_cylinders_and_faces_are_counted(name, count):
    case = cases.load(name)
    found = cycle(case)
    assert found["cylinders"] == count
    assert found["torque_avg"][0] == pytest.approx(float(np.mean(turn(case).torque)), rel=2e-4)


@pytest.mark.slow
def test_the_command_says_whose_power_it_is(six):
    path = six()
    text = CliRunner().invoke(mechsym, ["cycle", path], catch_exceptions=False).output
    assert "engine of 6 cylinders" in text and "one cylinder" in text
    found = json.loads(CliRunner().invoke(mechsym, ["cycle", path, "--json"], catch_exceptions=False).output)
    assert found["power_kw"][0] == pytest.approx(6 * found["per_cylinder"]["power_kw"][0])


@pytest.mark.parametrize("command", ["cycle", "forces"])
def test_both_commands_refuse_the_same_firing_order(six, command):
    path = six(firing='["0 deg", "120 deg", "240 deg", "360 deg", "480 deg", "600 deg"]')
    with pytest.raises(BadInput, match='cylinder 4 .* firing = \\["0 deg", "480 deg", "240 deg", "600 deg"'):
        CliRunner().invoke(mechsym, [command, path], catch_exceptions=False)


def test_pistons_that_face_each_other_are_no_cylinders():
    pair = cases.load("opposed-pistons")
    assert (cylinders(pair).count, cylinders(pair).each) == (2, "piston")
    apart = cases.load("opposed-pistons", {"parameters.axis_y": [0.0, 0.1]})
    away = cases.load("opposed-pistons", {"parameters.axis_x": [0.0, -0.46]})
    assert cylinders(apart).each == cylinders(away).each == "cylinder"


def test_opposed_pistons_share_a_chamber(six):
    assert cycle(cases.load(six(pistons=2)))["cylinders"] == 3


def test_unlike_cylinders_have_no_common_cycle(six):
    with pytest.raises(BadInput, match="moves otherwise than 1"):
        cycle(cases.load(six(r="[0.045, 0.045, 0.045, 0.045, 0.045, 0.05]")))


def test_one_cylinder_is_as_heavy_in_the_cycle_as_in_the_force_chain(tmp_path):
    path = write_engine("inline", 0.04, 0.0392, 1, tmp_path / "one.toml")[0]
    case = cases.load(str(path))
    assert cycle(case)["torque_max"][0] == pytest.approx(float(turn(case).torque.max()), rel=1e-9)  # with its rod
