"""An FMU through poses in which two motions of its linkage meet."""

from pathlib import Path

import numpy as np
import pytest
import scipy
from click.testing import CliRunner

from mechsym.cli import mechsym

pytest.importorskip("fmpy")
from mechsym.out.fmi.compare import driven  # noqa: E402

FLAT = """from mechsym.derive import Mechanism, cos, sin


def flat():
    m = Mechanism("flat")
    phi = m.coordinates("phi")
    a, b = m.parameters("a b", "m", above=0)
    J = m.parameters("J", "kg*m^2", above=0)
    ground = m.parameters("ground", "rad")
    m.torque(m.inputs("M", "N*m"), along=phi)
    crank, rocker = (m.link(name, turns=t, inertia=J) for name, t in (("crank", phi), ("rocker", None)))
    rod = m.link("rod", mass="1 kg", centre=(b / 3, 0), inertia=J)
    m.pin("A", m.frame, crank)
    m.pin("B", crank.at(a), rod)
    m.pin("D", m.frame.at(b * cos(ground), b * sin(ground)), rocker)
    rod.settle(), rocker.settle()
    m.pin("C", rod.at(b), rocker.at(a))
    m.weight(0, -9.81)
    return m
"""
FLAT_CASE = """mechanism = "./flat.py"
[parameters]
a = 0.2
b = 0.4
J = 0.01
ground = 0.7
[simulation]
t_end = 6
speed_start = {speed}
phi_start = {start}
[start]
theta_rod = 0.7
theta_rocker = {start}
[drive]
torque = 0
"""


@pytest.mark.slow
def test_twenty_flat_poses_of_a_parallelogram_are_passed_as_in_closed_form(tmp_path, monkeypatch):
    """It is a pendulum of the inertia 2 J + m a^2; at each flat pose its rocker might as well turn the other way."""
    monkeypatch.chdir(tmp_path)
    Path("flat.py").write_text(FLAT)
    rng, t, errors = np.random.default_rng(7), np.linspace(0, 6, 61), []
    for _ in range(5):
        start, speed = rng.uniform(0.1, 3), rng.uniform(8, 14)
        Path("flat.toml").write_text(FLAT_CASE.format(start=start, speed=speed))
        done = CliRunner().invoke(mechsym, ["fmu", "flat.toml", "--out", "f.fmu", "--platforms", "linux64"])
        assert done.exit_code == 0, (done.output, done.exception)
        swing = scipy.integrate.solve_ivp(
            lambda t, y: [y[1], -9.81 * 0.2 * np.cos(y[0]) / 0.06], (0, 6), [start, speed], method="DOP853", rtol=1e-13,
            atol=1e-13, t_eval=t,
        )  # fmt: skip
        with driven(Path("f.fmu"), "cs", 1e-12) as unit:
            phi = [unit.states()[0]]
            for now, until in zip(t[:-1], t[1:], strict=True):
                assert not unit.step(float(now), float(until - now))
                phi.append(unit.states()[0])
        errors.append(np.abs(phi - swing.y[0]).max())
        assert swing.y[0, -1] - start > 15 * np.pi
    assert np.median(errors) < 1e-9 and max(errors) < 1e-7, errors
