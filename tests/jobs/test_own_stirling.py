"""A Stirling engine of the user's own, whose pistons and outputs have names of their own, through the commands."""

import json

import pytest
from click.testing import CliRunner

from mechsym.cli import mechsym

ENGINE = """
from mechsym.derive import Mechanism, cos, pi, sin

def alpha():
    m = Mechanism("alpha", about="Two pistons at right angles on one pin.")
    phi = m.coordinates("phi")
    r, l = m.parameters("r l", "m", above=0)
    push = {"hot": m.inputs("F_hot", "N"), "cold": m.inputs("F_cold", "N")}
    M = m.inputs("M", "N*m")
    crank = m.link("crank", turns=phi, inertia="0.3 kg*m^2")
    m.pin("O", m.frame, crank)
    for name, bank in (("hot", HOT), ("cold", COLD)):
        rod = m.link(f"{name}_rod", mass="0.6 kg", centre=(l / 3, 0), inertia="4e-3 kg*m^2")
        piston = m.link(f"{name}_piston", mass="1.1 kg")
        m.pin(f"A_{name}", crank.at(r), rod)
        m.slider(f"G_{name}", m.frame.line(angle=bank), piston)
        m.pin(f"B_{name}", rod.at(l), piston, branch=1)
        x = m.let(f"x_{name}", r + l - piston.at().x * cos(bank) - piston.at().y * sin(bank), "m")
        m.force(push[name], along=x)
        m.piston(name, travel=x, force=push[name])
    m.rotor("crank", angle=phi, load=M)
    m.torque(-M, along=phi)
    return m
"""
CASE = """
mechanism = "./alpha.py"
[parameters]
r = "60 mm"
l = "260 mm"
[operation]
speed = "600 rpm"
[cycle]
kind = "schmidt"
gas = "air"
bore = "90 mm"
dead_hot = "100 cm^3"
dead_cold = "80 cm^3"
dead_regenerator = "120 cm^3"
T_e = "900 K"
T_c = "330 K"
mean_pressure = "5 bar"
p_back = "5 bar"
"""


@pytest.mark.parametrize(("hot", "driven"), [("0", False), ("pi / 2", True)])
def test_forces_tell_whether_the_hot_piston_leads(tmp_path, monkeypatch, hot, driven):
    monkeypatch.chdir(tmp_path)
    cold = "pi / 2" if hot == "0" else "0"
    (tmp_path / "alpha.py").write_text(ENGINE.replace("HOT", hot).replace("COLD", cold))
    (tmp_path / "alpha.toml").write_text(CASE)
    result = CliRunner().invoke(mechsym, ["forces", "alpha.toml", "--json"], catch_exceptions=False)
    told = json.loads(result.stdout)
    cycle = json.loads(CliRunner().invoke(mechsym, ["cycle", "alpha.toml", "--json"], catch_exceptions=False).stdout)
    (work,), doubts = cycle["work_j"], {one["code"]: one["value"] for one in told["doubts"]}
    # the crank passes the hot cylinder's dead centre first where its bank is the smaller angle
    assert result.exit_code == 0 and ("driven" in doubts) == driven == (work < 0)
    assert doubts.get("driven", work) == pytest.approx(work, rel=1e-6)


@pytest.mark.parametrize(("dead", "codes"), [("100 cm^3", []), ("100 L", ["dead_volume"])])
def test_a_dead_volume_beyond_the_swept_one_is_doubted(tmp_path, monkeypatch, dead, codes):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "alpha.py").write_text(ENGINE.replace("HOT", "0").replace("COLD", "pi / 2"))
    (tmp_path / "alpha.toml").write_text(CASE.replace('dead_hot = "100 cm^3"', f'dead_hot = "{dead}"'))
    told = json.loads(CliRunner().invoke(mechsym, ["check", "alpha.toml", "--json"], catch_exceptions=False).stdout)
    assert [one["code"] for one in told["doubts"]] == codes
