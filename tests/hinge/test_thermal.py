"""The gas spring with heat: small strokes by formula, limits, published check values, the energy it keeps."""

import casadi as ca
import numpy as np
import pytest
from hinges import small_stroke_index
from hypothesis import given
from hypothesis import strategies as st

from mechsym.hinge.springs.air_thermal import AirThermal, gas_temperature, x_of_index

N = 3600
PHI = np.arange(N) * 2 * np.pi / N
STEP = np.full(N, 2 * np.pi / N)
OMEGA = 9.32


def spring(x, **changes):
    return AirThermal(**{"A": 0.031, "H": 1.0, "p0": 4e6, "pa": 0.0, "tau": x / OMEGA} | changes)


@pytest.mark.parametrize("x", [0.05, 0.3, 1.0, 1.29, 5.0, 40.0])
def test_small_strokes_follow_the_complex_index(x):
    stroke = 1.2e-3
    made = spring(x).turn(0.224 - stroke * np.cos(PHI), STEP, OMEGA)
    index = small_stroke_index(x)
    assert made.loss == pytest.approx(np.pi * index.imag * 4e6 * 0.031 * (stroke / 0.776) ** 2, rel=1e-5)
    assert made.n_effective == pytest.approx(index.real, abs=1e-5)


@pytest.mark.parametrize(("x", "loss", "index"), [(1.29, 6021, 1.251), (10, 1229, 1.396), (60, 207, 1.400)])
def test_large_strokes_of_the_specification(x, loss, index):
    made = spring(x).turn(0.224 - 0.214 * np.cos(PHI), STEP, OMEGA)
    assert made.loss == pytest.approx(loss, abs=0.5)
    assert made.n_effective == pytest.approx(index, abs=5e-4)


@pytest.mark.parametrize(("x", "index"), [(1e6, 1.4), (1e-6, 1.0)])
def test_slow_and_fast_exchange_lose_nothing(x, index):
    made = spring(x).turn(0.224 - 0.214 * np.cos(PHI), STEP, OMEGA)
    assert made.n_effective == pytest.approx(index, abs=1e-6)
    assert 0 <= made.loss < 0.1


@given(x=st.floats(0.2, 50), deep=st.floats(0.05, 0.4))
def test_heat_is_the_work_that_is_kept(x, deep):
    z = 0.45 - deep * np.cos(PHI)
    of = spring(x, pa=101325.0)
    made = of.turn(z, STEP, OMEGA)
    p, V = made.pressure + of.pa, of.A * (of.H - z)
    work = -np.sum((p + np.roll(p, -1)) / 2 * (np.roll(V, -1) - V))
    assert made.loss == pytest.approx(work, rel=1e-3)
    assert made.loss > 0


def test_symbols_give_what_numbers_give():
    z = ca.SX.sym("z", 24)
    step, height = np.full(24, 2 * np.pi / 24), 1 - (0.3 - 0.2 * np.cos(np.arange(24) * 2 * np.pi / 24))
    symbols = ca.Function("T", [z], [gas_temperature(z, step, 1.29, 1.4, 320.0)])
    numbers = gas_temperature(height, step, 1.29, 1.4, 320.0)
    assert np.asarray(symbols(height)).ravel() == pytest.approx(numbers, rel=1e-12)


def test_leak_takes_the_mass_of_its_conductance():
    made = spring(10.0, leak=1e-12).turn(np.full(N, 0.5), STEP, OMEGA)
    assert made.leaked == pytest.approx(1e-12 * 8e6 * 2 * np.pi / OMEGA, rel=1e-6)


def test_an_index_between_one_and_gamma_is_near_the_worst():
    assert x_of_index(1.25) == pytest.approx(1.29, abs=2e-3)
    assert small_stroke_index(x_of_index(1.25)).imag == pytest.approx(0.194, abs=5e-4)
