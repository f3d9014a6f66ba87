"""What belongs to a link or a joint is read by its owner and a dot: `rod.mass`, `rod.angle`, `C.x`."""

import json
from dataclasses import asdict
from pathlib import Path

import pytest
from click.testing import CliRunner

from mechsym import cases
from mechsym.cli import mechsym
from mechsym.errors import BadInput

BOOM = """from mechsym.derive import Mechanism, sqrt


def boom():
    m = Mechanism("boom")
    s = m.coordinates("s", "m")
    m.pose(s="1.1 m")
    arm = m.link("arm", mass="300 kg", centre=("1.5 m", 0), inertia="250 kg*m^2", pose="40 deg")
    m.pin("O", m.frame, arm)
    arm.settle()
    top = arm.at("1.2 m")
    m.constraint("cylinder", sqrt((top.x - m.frame.at("0.5 m").x) ** 2 + (top.y + m.frame.at("0.3 m").x) ** 2) - s)
    m.force(m.inputs("F", "N"), along=s)
    m.weight(0, -9.81)
    return m
"""
CASE = """mechanism = "./boom.py"
[parameters]
{mass} = "200 kg"
[start]
s = "1.1 m"
{angle} = "40 deg"
[inputs]
F = "3 kN"
[simulation]
t_end = "0.2 s"
"""


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("boom.py").write_text(BOOM)
    Path("dots.toml").write_text(CASE.format(mass="arm.mass", angle="arm.angle"))
    Path("plain.toml").write_text(CASE.format(mass="arm_mass", angle="theta_arm"))
    return tmp_path


def run(*words):
    done = CliRunner().invoke(mechsym, [str(w) for w in words])
    assert done.exit_code == 0, (words, done.output, done.exception)
    return done.output


def test_a_case_reads_them_as_the_letters(folder):
    dots, plain = cases.load("dots.toml"), cases.load("plain.toml")
    assert [asdict(s) for s in dots.sections.values()] == [asdict(s) for s in plain.sections.values()]
    assert dots.need("parameters").arm_mass == 200
    assert json.loads(run("check", "dots.toml", "--json"))["problems"] == []
    for key in ("arm.mass", "parameters.arm.mass", "arm_mass"):
        assert cases.load("dots.toml", {key: "100 kg"}).need("parameters").arm_mass == 100
    assert cases.load("dots.toml", {"start.arm.angle": "50 deg"}).need("start").theta_arm == pytest.approx(0.872664626)


def test_commands_read_them_too(folder):
    told = [json.loads(run("eval", "./boom.py", "--set", f"{name}=100 kg", "--set", "s=1.1", "--set", "sd=1", "--json"))
            for name in ("arm.mass", "arm_mass")]  # fmt: skip
    assert told[0] == told[1] and told[0]["kinetic_energy"] > 0
    for name in ("arm.mass", "arm_mass"):
        run("sweep", "dots.toml", "--over", f"{name}=100,200 kg", "--show", "speed_min", "--out", name)
    tables = [Path(name, "sweep.csv").read_text().splitlines()[1:] for name in ("arm.mass", "arm_mass")]
    assert tables[0] == tables[1] and len(tables[0]) == 2


def test_an_unknown_one_is_refused_with_what_there_is(folder):
    with pytest.raises(BadInput, match=r"section \[arm\] is not known"):
        cases.load("dots.toml", {"arm.weight": "2 kg"})
    Path("bad.toml").write_text(CASE.format(mass="arm.length", angle="theta_arm"))
    with pytest.raises(BadInput, match="arm.length"):
        cases.load("bad.toml")
    Path("both.toml").write_text(CASE.format(mass='arm_mass = "1 kg"\narm.mass', angle="theta_arm"))
    with pytest.raises(BadInput, match="twice"):
        cases.load("both.toml")
