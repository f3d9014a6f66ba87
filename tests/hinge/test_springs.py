"""Spring laws: the printed force, energy as the integral of force, the inverse, limits."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad

from mechsym.errors import BadInput
from mechsym.hinge.springs import air
from mechsym.hinge.springs.air import AirAbsolute, AirGauge
from mechsym.hinge.springs.coil import Coil

GAUGE = AirGauge(A=0.031, H=1.0, p0=5e6, n=1.25)
ABSOLUTE = AirAbsolute(A=0.031, H=1.0, p0=5e6, n=1.25)
COIL = Coil(k=1e6, F0=1e5, H=0.5)
SOME = [GAUGE, ABSOLUTE, COIL, AirGauge(A=0.01, H=0.4, p0=3e6, n=1.0), AirAbsolute(A=0.01, H=0.4, p0=3e6, n=1.0)]


def shares(spring):
    return spring.H * np.array([-0.02, 0.0, 1e-9, 0.1, 0.5, 0.9])


def test_9_force_of_the_paper():
    assert GAUGE.force(0.0) == pytest.approx(0.031 * 5e6)
    assert GAUGE.force(0.3) == pytest.approx(1**1.25 * 0.031 * 5e6 / (1 - 0.3) ** 1.25)


def test_absolute_force_starts_at_the_excess_pressure():
    assert ABSOLUTE.force(0.0) == pytest.approx(0.031 * 5e6)
    expected = 0.031 * ((5e6 + 101325) * (1 / 0.7) ** 1.25 - 101325)
    assert ABSOLUTE.force(0.3) == pytest.approx(expected)


@pytest.mark.parametrize("spring", SOME, ids=repr)
def test_energy_is_the_integral_of_force(spring):
    functions = spring
    for z in shares(spring):
        work, _ = quad(functions.force, 0, z, epsabs=1e-9, epsrel=1e-12)
        assert float(functions.energy(z)) == pytest.approx(work, rel=1e-11, abs=1e-9)


@pytest.mark.parametrize("spring", SOME, ids=repr)
def test_closing_is_the_inverse_of_energy(spring):
    functions, z = spring, shares(spring)
    assert functions.closing(functions.energy(z)) == pytest.approx(z, rel=1e-12, abs=1e-15)


@pytest.mark.parametrize("spring", SOME, ids=repr)
def test_bounds_of_energy_belong_to_bounds_of_closing(spring):
    functions = spring
    if np.isfinite(functions.z_low):
        assert functions.force(functions.z_low) == pytest.approx(0, abs=1e-9)
        assert float(functions.energy(functions.z_low)) == pytest.approx(functions.energy_low, rel=1e-12)
    if np.isfinite(functions.energy_high):
        assert float(functions.energy(functions.H)) == pytest.approx(functions.energy_high)


def test_energy_of_the_paper_s_spring_has_the_lower_bound_it_says():
    # (H/(H - z))^(n - 1) falls to 0 as the gas column grows without end
    functions = GAUGE
    assert functions.energy_low == pytest.approx(-0.031 * 5e6 * 1.0 / 0.25)
    assert float(functions.energy(-1e44)) == pytest.approx(functions.energy_low, rel=1e-9)
    assert AirGauge(A=0.01, H=0.4, p0=3e6, n=1.0).energy_low == -np.inf
    assert functions.z_low == -np.inf and functions.H == 1.0 and functions.energy_high == np.inf


def test_a_real_gas_spring_pulls_below_its_lower_bound():
    # at z_low the gas has the pressure of the air outside: p0 + pa times (H/(H - z))^n is pa
    functions = ABSOLUTE
    assert functions.z_low == pytest.approx(1 - (5101325 / 101325) ** 0.8)
    work, _ = quad(functions.force, 0, functions.z_low, epsrel=1e-12)
    assert functions.energy_low == pytest.approx(work, rel=1e-9) and functions.energy_low < 0
    assert functions.H == 1.0 and functions.energy_high == np.inf


def test_a_coil_pulls_below_its_preload():
    functions = COIL
    assert (functions.z_low, functions.H) == (-0.1, 0.5)
    assert functions.energy_low == pytest.approx(-5e3) and functions.energy_high == pytest.approx(1.75e5)


@pytest.mark.parametrize("spring", [ABSOLUTE, AirAbsolute(A=1e-3, H=0.1, p0=2e3, n=1.4)], ids=repr)
def test_newton_falls_onto_the_closing_in_a_few_steps(monkeypatch, spring):
    # a wrong slope would still arrive, slowly: two of the calls belong to a step
    functions, calls = spring, []
    monkeypatch.setattr(air.np, "abs", lambda x: calls.append(x) or np.absolute(x))
    functions.closing(functions.energy(np.linspace(0.9 * functions.z_low, 0.95 * spring.H, 41)))
    assert 1 < len(calls) <= 28, len(calls)


BOUNDS = [
    (AirGauge, {"A": (1e-8, 100), "H": (1e-4, 100), "p0": (1, 1e12), "n": (1, 2)}),
    (AirAbsolute, {"A": (1e-8, 100), "H": (1e-4, 100), "p0": (1, 1e12), "n": (1, 2), "pa": (1e-300, None)}),
    (Coil, {"k": (1e-300, None), "F0": (0, None), "H": (1e-4, 100)}),
]
GOOD = {AirGauge: GAUGE, AirAbsolute: ABSOLUTE, Coil: COIL}


@pytest.mark.parametrize(
    ("kind", "name", "low", "high"), [(kind, name, *ends) for kind, all_of in BOUNDS for name, ends in all_of.items()]
)
def test_ranges_of_springs(kind, name, low, high):
    assert getattr(replace(GOOD[kind], **{name: low}), name) == low
    with pytest.raises(BadInput, match=name):
        replace(GOOD[kind], **{name: 0.95 * low if low > 1e-300 else -1e-3})
    if high is not None:
        assert getattr(replace(GOOD[kind], **{name: high}), name) == high
        with pytest.raises(BadInput, match=name):
            replace(GOOD[kind], **{name: 1.05 * high})


def test_the_air_outside_is_the_standard_atmosphere():
    assert ABSOLUTE.pa == 101325.0


def test_index_one_is_the_limit_of_indices_above_one():
    near, at = AirGauge(A=0.01, H=0.4, p0=3e6, n=1 + 1e-7), AirGauge(A=0.01, H=0.4, p0=3e6, n=1.0)
    assert float(near.energy(0.3)) == pytest.approx(float(at.energy(0.3)), rel=1e-6)
    assert float(near.closing(5e3)) == pytest.approx(float(at.closing(5e3)), rel=1e-6)


def test_pressure_times_area_is_the_force():
    for spring in (GAUGE, ABSOLUTE):
        assert spring.A * spring.pressure(0.4) == pytest.approx(spring.force(0.4))
    assert COIL.pressure(0.1) is None


@given(st.floats(1e-4, 1), st.floats(0.01, 5), st.floats(1e4, 5e7), st.floats(1.0, 1.7), st.floats(-0.2, 0.98))
def test_newton_inverts_every_gas_spring(A, H, p0, n, share):
    functions = AirAbsolute(A=A, H=H, p0=p0, n=n)
    z = max(share * H, 0.9 * functions.z_low)
    assert float(functions.closing(functions.energy(z))) == pytest.approx(z, rel=1e-9, abs=1e-11 * H)


@given(st.floats(1, 1e7), st.floats(0, 1e6), st.floats(0, 1))
def test_coil_without_preload_too(k, F0, z):
    functions = Coil(k=k, F0=F0, H=1.0)
    assert float(functions.closing(functions.energy(z))) == pytest.approx(z, rel=1e-9, abs=1e-12)


@pytest.mark.parametrize("change", [{"A": 0}, {"H": -1}, {"p0": 0}, {"n": 0.9}, {"n": float("nan")}])
def test_impossible_springs_are_refused(change):
    with pytest.raises(BadInput, match=next(iter(change))):
        AirGauge(**({"A": 0.031, "H": 1.0, "p0": 5e6, "n": 1.25} | change))
