"""The couple of a mechanism in space: a Hooke joint against its closed form."""

import numpy as np
import pytest

from mechsym import cases
from mechsym.forces.balance import amplitudes
from mechsym.jobs.forces import balance

BEND, INERTIA, OMEGA = np.radians(30.0), 0.02, 20 * np.pi
DECLARATION = """
from mechsym.derive import Mechanism, cos, sin

def hooke():
    m = Mechanism("hooke", space=3, about="Two shafts and a Hooke joint.")
    phi, b = m.coordinates("phi"), m.parameters("b", "rad", default="30 deg")
    first, second = m.link("first", inertia="0.01 kg*m^2"), m.link("second", inertia="0.02 kg*m^2")
    m.revolute("A", m.frame, first, axis="z", turns=phi)
    m.revolute("C", m.frame.axis((sin(b), 0, cos(b))), second.axis("z"))
    m.universal("U", first.axis("x"), second.axis("y"))
    m.torque(m.inputs("T", "N*m"), along=phi)
    return m
"""


def test_the_bent_shaft_of_a_hooke_joint_rocks_the_frame(tmp_path):
    (tmp_path / "hooke.py").write_text(DECLARATION)
    case = tmp_path / "case.toml"
    case.write_text('mechanism = "./hooke.py"\n[operation]\nspeed = "600 rpm"\n')
    one = balance(cases.load(str(case)), weights="none")
    # the second shaft turns at omega cos b / (1 - sin^2 b cos^2 phi), whose rate is felt about its own axis
    phi, squared = one.turn.phi, np.sin(BEND) ** 2
    rate = -(OMEGA**2) * np.cos(BEND) * squared * np.sin(2 * phi) / (1 - squared * np.cos(phi) ** 2) ** 2
    series = 2 * np.abs(np.fft.rfft(INERTIA * rate * np.sin(BEND))) / len(phi)
    told = amplitudes(one.before.couple, one.turn)
    assert [told[k] for k in range(1, 9)] == pytest.approx(series[1:9].tolist(), abs=1e-9 * series.max())
    assert told[2] > 1.0 and np.abs(one.before.force).max() < 1e-9
