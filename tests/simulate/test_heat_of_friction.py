"""What friction of a declaration turns into heat, by closed forms."""

import numpy as np
import pytest

from mechsym import cases
from mechsym.jobs.run import run

CLUTCH = """
from mechsym.derive import Mechanism

def clutch():
    m = Mechanism("clutch", about="Two discs and a clutch.")
    a, b = m.coordinates("a b")
    m.body("first", turns=a, inertia="0.5 kg*m^2")
    m.body("second", turns=b, inertia="0.2 kg*m^2")
    m.friction(a - b, name="plates", mu=(0.35, 0.3), normal="2 kN", radius="0.1 m")
    return m
"""
BELT = """
from mechsym.derive import Mechanism

def belt():
    m = Mechanism("belt", about="A block on a belt that runs.")
    x = m.coordinates("x", "m")
    m.body("block", mass="2 kg", at=(x, 0))
    m.friction(x, mu=(0.3, 0.3), normal="10 N", speed="0.5 m/s")
    return m
"""


def ran(folder, monkeypatch, text, name, case):
    monkeypatch.chdir(folder)
    (folder / f"{name}.py").write_text(text)
    (folder / "case.toml").write_text(f'mechanism = "./{name}.py"\n{case}')
    return run(cases.load("case.toml"))


def test_a_clutch_takes_half_the_common_inertia_times_the_slip_squared(tmp_path, monkeypatch):
    case = '[start]\nad = "1500 rpm"\nbd = "300 rpm"\n[simulation]\nt_end = "1 s"\n'
    done = ran(tmp_path, monkeypatch, CLUTCH, "clutch", case)
    slip = 1200 * np.pi / 30
    heat = 0.5 * 0.2 / 0.7 * slip**2 / 2
    assert done.summary.energy.friction == {"plates": pytest.approx(heat, rel=1e-9)}
    assert done.summary.energy.dissipation == pytest.approx(heat, rel=1e-9)
    column = done.result.columns["loss_plates"]
    torque, t = 0.3 * 2000 * 0.1, done.result.t
    until = slip / (torque / 0.5 + torque / 0.2)  # then they turn as one
    sliding = t < until
    assert column[sliding] == pytest.approx(torque * (slip * t - slip / until * t**2 / 2)[sliding], abs=1e-6 * heat)
    assert column[~sliding] == pytest.approx(np.full((~sliding).sum(), heat), rel=1e-9)


def test_a_belt_heats_by_what_slips_and_not_by_what_it_carries(tmp_path, monkeypatch):
    done = ran(tmp_path, monkeypatch, BELT, "belt", '[simulation]\nt_end = "1 s"\n')
    # the block comes to the belt's speed: half of what the belt gives is heat
    assert done.summary.energy.friction == {"friction_x": pytest.approx(2 * 0.5**2 / 2, rel=1e-9)}
    assert done.summary.energy.dissipation == pytest.approx(-2 * 0.5**2 / 2, rel=1e-9)
