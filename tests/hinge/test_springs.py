"""Spring laws: the printed force, energy as the integral of force, the inverse, limits."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad

from mechsym.errors import BadInput
from mechsym.hinge.springs import AirAbsolute, AirGauge, Coil, law

GAUGE = AirGauge(A=0.031, H=1.0, p0=5e6, n=1.25)
ABSOLUTE = AirAbsolute(A=0.031, H=1.0, p0=5e6, n=1.25)
COIL = Coil(k=1e6, F0=1e5, H=0.5)
SOME = [GAUGE, ABSOLUTE, COIL, AirGauge(A=0.01, H=0.4, p0=3e6, n=1.0), AirAbsolute(A=0.01, H=0.4, p0=3e6, n=1.0)]


def shares(spring):
    return spring.H * np.array([-0.02, 0.0, 1e-9, 0.1, 0.5, 0.9])


def test_9_force_of_the_paper():
    assert law(GAUGE).force(0.0) == pytest.approx(0.031 * 5e6)
    assert law(GAUGE).force(0.3) == pytest.approx(1**1.25 * 0.031 * 5e6 / (1 - 0.3) ** 1.25)


def test_absolute_force_starts_at_the_excess_pressure():
    assert law(ABSOLUTE).force(0.0) == pytest.approx(0.031 * 5e6)
    expected = 0.031 * ((5e6 + 101325) * (1 / 0.7) ** 1.25 - 101325)
    assert law(ABSOLUTE).force(0.3) == pytest.approx(expected)


@pytest.mark.parametrize("spring", SOME, ids=repr)
def test_energy_is_the_integral_of_force(spring):
    functions = law(spring)
    for z in shares(spring):
        work, _ = quad(functions.force, 0, z, epsabs=1e-9, epsrel=1e-12)
        assert float(functions.energy(z)) == pytest.approx(work, rel=1e-11, abs=1e-9)


@pytest.mark.parametrize("spring", SOME, ids=repr)
def test_closing_is_the_inverse_of_energy(spring):
    functions, z = law(spring), shares(spring)
    assert functions.closing(functions.energy(z)) == pytest.approx(z, rel=1e-12, abs=1e-15)


@pytest.mark.parametrize("spring", SOME, ids=repr)
def test_bounds_of_energy_belong_to_bounds_of_closing(spring):
    functions = law(spring)
    if np.isfinite(functions.z_low):
        assert functions.force(functions.z_low) == pytest.approx(0, abs=1e-9)
        assert float(functions.energy(functions.z_low)) == pytest.approx(functions.energy_low, rel=1e-12)
    if np.isfinite(functions.energy_high):
        assert float(functions.energy(functions.z_high)) == pytest.approx(functions.energy_high)


def test_index_one_is_the_limit_of_indices_above_one():
    near, at = law(AirGauge(A=0.01, H=0.4, p0=3e6, n=1 + 1e-7)), law(AirGauge(A=0.01, H=0.4, p0=3e6, n=1.0))
    assert float(near.energy(0.3)) == pytest.approx(float(at.energy(0.3)), rel=1e-6)
    assert float(near.closing(5e3)) == pytest.approx(float(at.closing(5e3)), rel=1e-6)


def test_pressure_times_area_is_the_force():
    for spring in (GAUGE, ABSOLUTE):
        assert spring.A * law(spring).pressure(0.4) == pytest.approx(law(spring).force(0.4))
    assert law(COIL).pressure is None


@given(st.floats(1e-4, 1), st.floats(0.01, 5), st.floats(1e4, 5e7), st.floats(1.0, 1.7), st.floats(-0.2, 0.98))
def test_newton_inverts_every_gas_spring(A, H, p0, n, share):
    functions = law(AirAbsolute(A=A, H=H, p0=p0, n=n))
    z = max(share * H, 0.9 * functions.z_low)
    assert float(functions.closing(functions.energy(z))) == pytest.approx(z, rel=1e-9, abs=1e-11 * H)


@given(st.floats(1, 1e7), st.floats(0, 1e6), st.floats(0, 1))
def test_coil_without_preload_too(k, F0, z):
    functions = law(Coil(k=k, F0=F0, H=1.0))
    assert float(functions.closing(functions.energy(z))) == pytest.approx(z, rel=1e-9, abs=1e-12)


@pytest.mark.parametrize("change", [{"A": 0}, {"H": -1}, {"p0": 0}, {"n": 0.9}, {"n": float("nan")}])
def test_impossible_springs_are_refused(change):
    with pytest.raises(BadInput, match=next(iter(change))):
        AirGauge(**({"A": 0.031, "H": 1.0, "p0": 5e6, "n": 1.25} | change))
