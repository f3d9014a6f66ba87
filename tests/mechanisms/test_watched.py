"""A watched point is told under its own name, by evaluation and by forces, in JSON and in tables."""

import json

import pytest
from click.testing import CliRunner

from mechsym.cli import mechsym

CRANK = """from mechsym.derive import Mechanism


def crank():
    m = Mechanism("crank")
    phi = m.coordinates("phi")
    M = m.inputs("M", "N*m")
    m.torque(M, along=phi)
    body = m.link("body", turns=phi, mass="1 kg", inertia=1.0)
    m.pin("O", m.frame, body)
    m.watch(body.at("0.2 m"), "P")
    return m
"""
CASE = """mechanism = "./crank.py"
[parameters]
[operation]
speed = "3 rad/s"
"""
NAMES = {f"P.{part}" for axis in "xy" for part in (axis, f"d{axis}_dphi", f"d2{axis}_dphi2", f"{axis}_d", f"{axis}_dd")}


@pytest.mark.slow
def test_a_watched_point_is_told_under_its_name(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "crank.py").write_text(CRANK)
    (tmp_path / "crank.toml").write_text(CASE)
    words = ["eval", "./crank.py", "--set", "phid=3", "--json"]
    outputs = json.loads(CliRunner().invoke(mechsym, words).output)["outputs"]
    assert outputs.keys() >= NAMES and not any("P_" in name for name in outputs)
    assert (outputs["P.x"], outputs["P.y_d"]) == pytest.approx((0.2, 0.6))
    done = CliRunner().invoke(mechsym, ["forces", "crank.toml", "--out", "told", "--json"])
    assert json.loads(done.output)["max"]["P.x_dd"] == pytest.approx(0.2 * 9, rel=1e-6)
    heads = (tmp_path / "told" / "forces.csv").read_text().splitlines()[0]
    assert "P.x [m]" in heads and "P.dy_dphi [m/rad]" in heads and "P.y_dd [m/s^2]" in heads
    assert done.exit_code == 0, done.output
