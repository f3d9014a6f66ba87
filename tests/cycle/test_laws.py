"""Gas properties, heat-transfer laws, friction correlations and ideal cycles against independent values."""

import casadi as ca
import numpy as np
import pytest

from mechsym import cases
from mechsym.cycle.friction import ChenFlynn, Heywood, NoFriction, friction_pressure
from mechsym.cycle.heat import (
    Adiabatic,
    Annand,
    ConstantGamma,
    GasAtWall,
    Hohenberg,
    NasaMixture,
    Woschni,
    conductivity,
    heat_flux,
    motored_swirl,
    properties,
    viscosity,
)
from mechsym.errors import BadInput

# JANAF tables (NIST), cp in J/(mol K)
JANAF = {
    "N2": {300: 29.125, 1000: 32.697, 2000: 35.971},
    "O2": {300: 29.385, 1000: 34.870, 2000: 37.741},
    "CO2": {300: 37.221, 1000: 54.308, 2000: 60.350},
    "H2O": {300: 33.596, 1000: 41.268, 2000: 51.180},
}


def air_cp(t):
    found = properties(NasaMixture(), t, 0.0)
    return float(found.heat_capacity + found.gas_constant)


@pytest.mark.parametrize("t", [300, 1000, 2000])
def test_air_against_janaf(t):
    mass = 31.9988e-3 + 3.773 * 28.0134e-3
    assert air_cp(t) == pytest.approx((JANAF["O2"][t] + 3.773 * JANAF["N2"][t]) / mass, rel=2e-3)


@pytest.mark.parametrize("t", [300, 1000, 2000])
def test_stoichiometric_products_against_janaf(t):
    y = 1.87
    moles = {"CO2": 1.0, "H2O": y / 2, "N2": 3.773 * (1 + y / 4)}
    mass = 44.0095e-3 + y / 2 * 18.01528e-3 + moles["N2"] * 28.0134e-3
    found = properties(NasaMixture(hydrogen_carbon=y), t, 1.0)
    cp = sum(n * JANAF[s][t] for s, n in moles.items()) / mass
    assert float(found.heat_capacity + found.gas_constant) == pytest.approx(cp, rel=3e-3)


@pytest.mark.parametrize("burnt", [0.0, 0.4, 1.0])
def test_heat_capacity_is_the_derivative_of_energy(burnt):
    t, x = ca.SX.sym("t"), ca.SX.sym("x")
    found = properties(NasaMixture(), t, x)
    slopes = ca.Function("slopes", [t, x], [ca.gradient(found.energy, t), ca.gradient(found.energy, x)])
    values = ca.Function("values", [t, x], [found.heat_capacity, found.energy_slope])
    for at in (400.0, 950.0, 1000.0, 1100.0, 2600.0):
        assert np.allclose(np.array(slopes(at, burnt)), np.array(values(at, burnt)), rtol=1e-12)


def test_nasa_energy_is_zero_at_298_15_kelvin():
    assert abs(float(properties(NasaMixture(), 298.15, 0.3).energy)) < 5.0


def test_constant_gamma():
    found = properties(ConstantGamma(gas_constant=287.0, gamma=1.4), 500.0, 0.5)
    assert (found.energy, found.heat_capacity, found.energy_slope) == (pytest.approx(358750.0), pytest.approx(717.5), 0)


def test_transport_properties_of_air():
    assert viscosity(300.0) == pytest.approx(1.92e-5, rel=0.02)
    assert conductivity(300.0) == pytest.approx(0.0263, rel=0.05)


STATE = GasAtWall(5e6, 2000.0, 5e-5, 287.0, 0.06, 12.0, 0.0)


def test_annand_by_hand():
    mu = 7.457e-6 + 4.1547e-8 * 2000 - 7.4793e-12 * 2000**2
    k = 6.1944e-3 + 7.3814e-5 * 2000 - 1.2491e-8 * 2000**2
    re = 5e6 / (287 * 2000) * 12 * 0.06 / mu
    coefficients = k / 0.06 * 0.49 * re**0.7 + 4.25e-9 * (2000**4 - 350**4) / (2000 - 350)
    assert heat_flux(Annand(wall_temperature=350.0), STATE) == pytest.approx(coefficients * 1650, rel=1e-13)


def test_radiation_is_finite_at_the_wall_s_temperature():
    assert heat_flux(Annand(wall_temperature=350.0), STATE._replace(t=350.0)) == 0.0


def test_woschni_by_hand():
    state = STATE._replace(swirl=1000.0)
    w = 2.28 * 12 + 3.24e-3 * 1000
    h = 3.26 * 0.06**-0.2 * 5000**0.8 * 2000**-0.55 * w**0.8
    assert heat_flux(Woschni(wall_temperature=400.0), state) == pytest.approx(h * 1600, rel=1e-13)


def test_hohenberg_by_hand():
    h = 130 * 5e-5**-0.06 * 50**0.8 * 2000**-0.4 * (12 + 1.4) ** 0.8
    assert heat_flux(Hohenberg(wall_temperature=400.0), STATE) == pytest.approx(h * 1600, rel=1e-13)


def test_woschni_term_counts_combustion_only():
    law = Woschni(wall_temperature=400.0)
    assert float(motored_swirl(law, 4e6, 5e6, 1e-3)) == 0.0
    assert float(motored_swirl(law, 6e6, 5e6, 1e-3)) == pytest.approx(1000.0)
    assert motored_swirl(Adiabatic(), 6e6, 5e6, 1e-3) == 0.0


def test_friction_by_hand():
    assert friction_pressure(NoFriction(), 6e6, 10.0, 300.0) == 0
    assert friction_pressure(ChenFlynn(), 6e6, 10.0, 300.0) == pytest.approx(0.4e5 + 0.3e5 + 0.9e5 + 0.09e5)
    at_3000_rpm = friction_pressure(Heywood(), 6e6, 10.0, 100 * np.pi)
    assert at_3000_rpm == pytest.approx((0.97 + 0.45 + 0.45) * 1e5)


@pytest.mark.parametrize(("section", "law", "names"), [
    ("friction_pressure", "chen_flynn", "constant per_peak_pressure per_speed per_speed_squared"),
    ("heat_transfer", "annand", "a radiation"),
    ("heat_transfer", "woschni", "c1 c2"),
    ("heat_transfer", "hohenberg", "c1 c2"),
])  # fmt: skip
def test_a_part_of_a_law_may_be_left_away_and_not_turned_round(section, law, names):
    base = {f"{section}.law": law} | ({"heat_transfer.wall_temperature": 450} if section == "heat_transfer" else {})
    for name in names.split():
        none = cases.load("generator-breathing", base | {f"{section}.{name}": 0})
        assert getattr(none.sections[section], name) == 0
        with pytest.raises(BadInput, match=name):
            cases.load("generator-breathing", base | {f"{section}.{name}": -1e-12})


def test_lean_exhaust_is_burnt_gas_and_the_air_left_over():
    """A kilogram of fuel with twice the air it needs: stoichiometric products and as much air once more."""
    rich, lean, air = (
        properties(NasaMixture(excess_air=e), 1200.0, x) for e, x in ((1.0, 1.0), (2.0, 1.0), (1.0, 0.0))
    )
    fuel = (12.011 + 1.87 * 1.008) / (12.011 + 1.87 * 1.008 + (1 + 1.87 / 4) * 137.9)  # of the stoichiometric charge
    weight = (1 - fuel) / (2 - fuel)  # of the air left over
    mixed = (1 - weight) * float(rich.gas_constant) + weight * float(air.gas_constant)
    assert float(lean.gas_constant) == pytest.approx(mixed, rel=2e-3)
