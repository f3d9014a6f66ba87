"""Load laws: values, slopes, blanks, bad tables."""

import casadi as ca
import numpy as np
import pytest

from mechsym.errors import BadInput
from mechsym.machine.loads import ConstantLoad, PropellerLoad, TableLoad, load_slope, load_torque, settle

LAWS = [
    ConstantLoad(torque=40.0),
    PropellerLoad(torque=40.0, speed=5.0),
    TableLoad(speeds=(0.0, 4.0, 9.0), torques=(10.0, 30.0, 100.0)),
]


def test_values():
    assert load_torque(LAWS[0], 123.0) == 40.0
    assert load_torque(LAWS[1], 5.0) == pytest.approx(40.0)
    assert load_torque(LAWS[1], 10.0) == pytest.approx(160.0)
    assert load_torque(LAWS[1], -10.0) == pytest.approx(-160.0)  # opposes backward motion too
    np.testing.assert_allclose(load_torque(LAWS[2], np.array([-1.0, 0.0, 4.0, 9.0, 20.0])), [10, 10, 30, 100, 100])


@pytest.mark.parametrize("law", LAWS)
def test_slope_is_the_derivative(law):
    omega = np.array([0.5, 2.0, 3.3, 7.7])
    h = 1e-6
    expected = (load_torque(law, omega + h) - load_torque(law, omega - h)) / (2 * h)
    np.testing.assert_allclose(load_slope(law, omega), expected, atol=1e-6)


@pytest.mark.parametrize("law", LAWS[:2])
def test_symbols(law):
    omega = ca.SX.sym("omega")
    function = ca.Function("load", [omega], [load_torque(law, omega)])
    for value in (-3.0, 0.0, 7.0):
        assert float(function(value)) == pytest.approx(load_torque(law, value))


def test_table_does_not_overshoot():
    table = TableLoad(speeds=(0.0, 1.0, 2.0, 3.0), torques=(0.0, 0.0, 10.0, 10.0))
    values = load_torque(table, np.linspace(0, 3, 301))
    assert values.min() >= 0 and values.max() <= 10


def test_blanks_are_filled_from_the_engine():
    assert settle(ConstantLoad(), 9000.0, 9.3) == ConstantLoad(torque=9000.0)
    assert settle(PropellerLoad(speed=5.0), 9000.0, 9.3) == PropellerLoad(torque=9000.0, speed=5.0)
    assert settle(PropellerLoad(), 9000.0, 9.3) == PropellerLoad(torque=9000.0, speed=9.3)
    for law in LAWS:
        assert settle(law, 9000.0, 9.3) == law
    for blank in (ConstantLoad(), PropellerLoad()):
        with pytest.raises(BadInput, match="settle it"):
            load_torque(blank, 1.0)


@pytest.mark.parametrize(
    "speeds, torques, words",
    [
        ((1.0,), (1.0,), "at least two"),
        ((1.0, 2.0), (1.0,), "as many of each"),
        ((2.0, 1.0), (1.0, 2.0), "ascend"),
        ((1.0, 2.0), (1.0, float("nan")), "finite"),
    ],
)
def test_bad_tables(speeds, torques, words):
    with pytest.raises(BadInput, match=words):
        TableLoad(speeds=speeds, torques=torques)
    with pytest.raises(BadInput, match="speed = -1"):
        PropellerLoad(torque=1.0, speed=-1.0)
