"""Brake figures of one cycle against their definitions, and where they say nothing."""

import math

import numpy as np
import pytest

from mechsym.cycle.chamber import ChamberParameters
from mechsym.cycle.friction import brake_figures, mechanical_efficiency
from mechsym.errors import BadInput

WORK, VOLUME, ANGLE, OMEGA = 500.0, 5e-4, 4 * math.pi, 400.0  # J, m^3, rad, rad/s
FUEL, HEAT = 3e-5, 1300.0  # kg, J


def test_brake_figures_by_definition():
    told = brake_figures(WORK, 1.2e5, VOLUME, ANGLE, OMEGA, (FUEL, HEAT))
    left = 500 - 60  # FMEP 1.2 bar over 0.5 litres is 60 J
    assert told["friction_mep_kpa"] == pytest.approx(120)
    assert told["brake_mep_kpa"] == pytest.approx(880)
    assert told["brake_torque"] == pytest.approx(left / ANGLE)
    assert told["brake_power_kw"] == pytest.approx(left * OMEGA / ANGLE / 1e3)
    # grams of fuel of a second by kilowatts, times the seconds of an hour
    per_second = 1e3 * FUEL * OMEGA / ANGLE
    assert told["brake_sfc_g_kwh"] == pytest.approx(3600 * per_second / told["brake_power_kw"], rel=1e-14)
    assert told["brake_efficiency"] == pytest.approx(left / HEAT)
    assert told["mechanical_efficiency"] == pytest.approx(0.88)


def test_what_friction_eats_up_has_no_consumption():
    told = brake_figures(np.array([500.0, 60.0, 50.0]), 1.2e5, VOLUME, ANGLE, OMEGA, (FUEL, HEAT))
    assert np.isnan(told["brake_sfc_g_kwh"]).tolist() == [False, True, True]
    assert told["brake_mep_kpa"][2] == pytest.approx(-20)


@pytest.mark.parametrize(("brake", "indicated"), [(1.0, 1.0), (-2.0, -1.0), (-1.0, 0.0)])
def test_no_efficiency_without_friction_or_power(brake, indicated):
    assert math.isnan(mechanical_efficiency(brake, indicated))


def test_a_chamber_has_one_piston_or_two():
    for pistons in (1, 2):
        assert ChamberParameters(bore=0.1, compression_ratio=10, pistons=pistons).pistons == pistons
    for pistons in (0, 1.5, 3):
        with pytest.raises(BadInput, match="options are 1"):
            ChamberParameters(bore=0.1, compression_ratio=10, pistons=pistons)
