"""A loop through several links by a length, whose formula is too long to be multiplied out."""

import numpy as np
import pytest

from mechsym.mechanisms import build, parameters_class
from mechsym.mechanisms.constraints import close

DIGGER = """
from mechsym.derive import Mechanism, sqrt

def digger():
    m = Mechanism("digger", about="Boom and stick on two cylinders.")
    s1, s2 = m.coordinates("s1 s2", "m")
    m.pose(s1="1.46 m", s2="2.04 m")
    boom = m.link("boom", mass="600 kg", centre=("1.8 m", "0.3 m"), inertia="900 kg*m^2", pose="35 deg")
    stick = m.link("stick", mass="300 kg", centre=("0.6 m", 0), inertia="130 kg*m^2", pose="-60 deg")
    m.pin("O", m.frame, boom)
    m.pin("E", boom.at("3.8 m"), stick)
    boom.settle()
    stick.settle()
    f1, t1 = m.frame.at("0.6 m", "-0.4 m"), boom.at("1.5 m", "0.1 m")
    f2, t2 = boom.at("1.9 m", "0.5 m"), stick.at("-0.5 m", "0.1 m")
    m.constraint("c1", sqrt((t1.x - f1.x) ** 2 + (t1.y - f1.y) ** 2) - s1)
    m.constraint("c2", sqrt((t2.x - f2.x) ** 2 + (t2.y - f2.y) ** 2) - s2)
    return m
"""


def lengths(boom, stick):
    """Of both cylinders at the angles of the links."""

    def turned(angle, x, y):
        return np.array([x * np.cos(angle) - y * np.sin(angle), x * np.sin(angle) + y * np.cos(angle)])

    first = turned(boom, 1.5, 0.1) - np.array([0.6, -0.4])
    second = turned(boom, 3.8, 0.0) + turned(stick, -0.5, 0.1) - turned(boom, 1.9, 0.5)
    return np.array([np.hypot(*first), np.hypot(*second)])


def test_the_curvature_of_a_length_through_two_links_is_that_of_its_motion(tmp_path):
    (tmp_path / "digger.py").write_text(DIGGER)
    name = str(tmp_path / "digger.py")
    mechanism = build(name, parameters_class(name)())
    at = close(mechanism, {"s1": 1.46, "s2": 2.04, "s1d": 0.1, "s2d": -0.2})
    boom, stick = at["theta_boom"], at["theta_stick"]
    assert lengths(boom, stick) == pytest.approx([1.46, 2.04], abs=1e-9)
    rates, step = np.array([at["theta_boomd"], at["theta_stickd"]]), 1e-4

    def moved(t):
        return lengths(boom + t * rates[0], stick + t * rates[1])

    # at constant rates of the links their lengths have the rates that were asked for, and curve as the bias says
    assert (moved(step) - moved(-step)) / (2 * step) == pytest.approx([0.1, -0.2], abs=1e-7)
    curved = (moved(step) - 2 * moved(0.0) + moved(-step)) / step**2
    names = mechanism.coordinates
    *_, bias = mechanism.functions["constraints"].call([at[n] for n in (*names, *(f"{q}d" for q in names))])
    assert np.asarray(bias).ravel() == pytest.approx(curved, rel=1e-5)
