"""The turbocharger against tables of the atmosphere, its balance of powers, its limits; no measurement was found."""

import numpy as np
import pytest

from mechsym.cycle.breathing.turbocharger import Boost, atmosphere, boosted, compressor_temperature, turbine_ratio
from mechsym.errors import BadInput

AIR = np.array([0.02, 0.03])


# ISO 2533:1975, table 1
@pytest.mark.parametrize(("altitude", "p", "T"), [(0, 101325, 288.15), (1000, 89874.6, 281.65), (11000, 22632, 216.65)])
def test_standard_atmosphere(altitude, p, T):
    found = atmosphere(altitude)
    assert found[0] == pytest.approx(p, rel=5e-5)
    assert found[1] == pytest.approx(T, abs=5e-3)


def test_shaft_balance_closes():
    boost = Boost(pressure=2e5, intercooler=0.6)
    state = boosted(boost, atmosphere(2000.0), lambda s: (np.array([900.0, 950.0]) + 0.5 * s.T_2, AIR), 2)
    ratio = state.p_2 / state.p_1
    compressor = 1005.0 * (compressor_temperature(state.T_1, ratio, boost.compressor_efficiency) - state.T_1)
    fall = 1 - (state.p_3 / state.p_1) ** (-0.34 / 1.34)
    turbine = (1 + 1 / boost.air_fuel_ratio) * 1130.0 * state.T_3 * boost.turbine_efficiency * fall
    assert turbine * boost.shaft_efficiency == pytest.approx(compressor, rel=1e-7)
    assert state.T_3 == pytest.approx(np.array([900.0, 950.0]) + 0.5 * state.T_2, rel=1e-7)


def test_no_boost_is_the_bare_engine():
    state = boosted(Boost(), atmosphere(0.0), lambda s: (np.array([950.0]), AIR[:1]), 1)
    assert (state.p_2, state.T_2) == pytest.approx(atmosphere(0.0), rel=1e-12)
    assert state.p_3 == pytest.approx(state.p_1, rel=1e-12)


def test_ideal_machine_with_hot_exhaust_costs_nothing_in_the_limit():
    perfect = Boost(compressor_efficiency=1.0, turbine_efficiency=1.0, shaft_efficiency=1.0)
    assert turbine_ratio(perfect, 288.15, 1e9, 2.0) == pytest.approx(1.0, abs=1e-6)
    assert compressor_temperature(300.0, 2.0, 1.0) == pytest.approx(300.0 * 2 ** (0.4 / 1.4), rel=1e-14)


def test_refusals_name_the_key():
    with pytest.raises(BadInput, match="boost.pressure"):
        boosted(Boost(pressure=5e4), atmosphere(0.0), lambda s: (np.array([900.0]), AIR[:1]), 1)
    with pytest.raises(BadInput, match="lower boost.pressure"):
        turbine_ratio(Boost(), 288.15, 400.0, 20.0)


def sloped(flow, ratio):
    return 0.8 - 3.0 * flow - 0.05 * ratio  # a plane, which linear pieces give back exactly


FLOWS, RATIOS = np.meshgrid([0.02, 0.05, 0.1], [1.0, 2.0, 3.0])
MAP = {"map_flow": tuple(FLOWS.ravel()), "map_ratio": tuple(RATIOS.ravel()),
       "map_efficiency": tuple(sloped(FLOWS, RATIOS).ravel())}  # fmt: skip


def test_map_gives_its_points_and_what_lies_between():
    boost = Boost(pressure=2e5, cylinders=2, **MAP)
    p, T = atmosphere(1000.0)
    state = boosted(boost, (p, T), lambda s: (np.array([950.0, 900.0]), AIR), 2)
    flow = AIR * 2 * np.sqrt(T / 288.15) / (p / 101325)
    assert state.efficiency == pytest.approx(sloped(flow, 2e5 / p), rel=1e-9)
    hot = compressor_temperature(T, 2e5 / p, state.efficiency)
    assert state.T_2 == pytest.approx(hot)
    # the worse compressor dams up more, at the same exhaust
    one = boosted(boost, (p, T), lambda s: (np.array([950.0, 950.0]), AIR), 2)
    assert one.p_3[1] > one.p_3[0]


def test_a_point_outside_the_map_is_refused_and_a_map_needs_all_its_columns():
    with pytest.raises(BadInput, match="surge or choke"):
        boosted(Boost(pressure=2e5, **MAP), atmosphere(0.0), lambda s: (np.array([950.0]), np.array([0.2])), 1)
    with pytest.raises(BadInput, match="all three"):
        Boost(map_flow=(0.1, 0.2), map_ratio=(1.0,))
