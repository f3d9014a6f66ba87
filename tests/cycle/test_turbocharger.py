"""The turbocharger against tables of the atmosphere, its balance of powers, its limits; no measurement was found."""

import numpy as np
import pytest

from mechsym.cycle.breathing.turbocharger import Boost, atmosphere, boosted, compressor_temperature, turbine_ratio
from mechsym.errors import BadInput


# ISO 2533:1975, table 1
@pytest.mark.parametrize(("altitude", "p", "T"), [(0, 101325, 288.15), (1000, 89874.6, 281.65), (11000, 22632, 216.65)])
def test_standard_atmosphere(altitude, p, T):
    found = atmosphere(altitude)
    assert found[0] == pytest.approx(p, rel=5e-5)
    assert found[1] == pytest.approx(T, abs=5e-3)


def test_shaft_balance_closes():
    boost = Boost(pressure=2e5, intercooler=0.6)
    state = boosted(boost, atmosphere(2000.0), lambda s: np.array([900.0, 950.0]) + 0.5 * s.T_2, 2)
    ratio = state.p_2 / state.p_1
    compressor = 1005.0 * (compressor_temperature(state.T_1, ratio, boost.compressor_efficiency) - state.T_1)
    fall = 1 - (state.p_3 / state.p_1) ** (-0.34 / 1.34)
    turbine = (1 + 1 / boost.air_fuel_ratio) * 1130.0 * state.T_3 * boost.turbine_efficiency * fall
    assert turbine * boost.shaft_efficiency == pytest.approx(compressor, rel=1e-7)
    assert state.T_3 == pytest.approx(np.array([900.0, 950.0]) + 0.5 * state.T_2, rel=1e-7)


def test_no_boost_is_the_bare_engine():
    state = boosted(Boost(), atmosphere(0.0), lambda s: np.array([950.0]), 1)
    assert (state.p_2, state.T_2) == pytest.approx(atmosphere(0.0), rel=1e-12)
    assert state.p_3 == pytest.approx(state.p_1, rel=1e-12)


def test_ideal_machine_with_hot_exhaust_costs_nothing_in_the_limit():
    perfect = Boost(compressor_efficiency=1.0, turbine_efficiency=1.0, shaft_efficiency=1.0)
    assert turbine_ratio(perfect, 288.15, 1e9, 2.0) == pytest.approx(1.0, abs=1e-6)
    assert compressor_temperature(300.0, 2.0, 1.0) == pytest.approx(300.0 * 2 ** (0.4 / 1.4), rel=1e-14)


def test_refusals_name_the_key():
    with pytest.raises(BadInput, match="boost.pressure"):
        boosted(Boost(pressure=5e4), atmosphere(0.0), lambda s: np.array([900.0]), 1)
    with pytest.raises(BadInput, match="lower boost.pressure"):
        turbine_ratio(Boost(), 288.15, 400.0, 20.0)
