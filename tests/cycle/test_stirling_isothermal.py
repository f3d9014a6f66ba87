"""The isothermal Stirling cycle by two other ways: quadrature on the crank's volumes, and Schmidt's closed form."""

import math

import numpy as np
import pytest

from mechsym import cases
from mechsym.jobs.gas import gas

# the data of alpha-stirling, written down here again
R, L, AREA, T_E, T_C, MEAN = 0.06, 0.26, math.pi * 0.09**2 / 4, 900.0, 330.0, 5e5
DEAD_HOT, DEAD_COLD, DEAD_BETWEEN = 100e-6, 80e-6, 120e-6
HOT, COLD = math.pi / 2, 0.0  # phases; the hot piston leads
LOG_MEAN = (T_E - T_C) / math.log(T_E / T_C)


def computed(**changes):
    """Work of a turn and the two ends of the pressure, from the package."""
    pressure = gas(cases.load("alpha-stirling", {"cycle.kind": "schmidt", **changes})).pressure
    p = pressure.absolute(np.arange(7200) * math.pi / 3600)
    swept = 2 * AREA * R
    return pressure.mean_indicated * 2 * swept, p.min(), p.max()


def by_quadrature(between=DEAD_BETWEEN):
    """The same by the trapezoidal rule, exact for smooth periodic curves; dV by the volumes alone."""
    phi = np.arange(4096) * math.pi / 2048

    def travel(angle):
        return R + L - R * np.cos(angle) - np.sqrt(L**2 - (R * np.sin(angle)) ** 2)

    hot, cold = DEAD_HOT + AREA * travel(phi + HOT), DEAD_COLD + AREA * travel(phi + COLD)
    p = 1 / (hot / T_E + between / LOG_MEAN + cold / T_C)
    p *= MEAN / p.mean()
    waves = np.fft.rfftfreq(phi.size, 1 / phi.size)
    slope = np.fft.irfft(1j * waves * np.fft.rfft(hot + cold), phi.size)
    return 2 * math.pi * np.mean(p * slope), p.min(), p.max()


def closed_form():
    """Schmidt (1871) for sinusoidal volumes: p = p_mean sqrt(1 - b^2) / (1 + b cos(phi - alpha))."""
    # V_e/T_e + V_r/T_r + V_c/T_c = K (1 + b cos(phi - alpha))
    half = AREA * R
    turning = -half * (np.exp(1j * HOT) / T_E + np.exp(1j * COLD) / T_C)
    K = (DEAD_HOT + half) / T_E + DEAD_BETWEEN / LOG_MEAN + (DEAD_COLD + half) / T_C
    b, alpha = abs(turning) / K, -np.angle(turning)
    q = (1 - math.sqrt(1 - b**2)) / b  # p / p_mean = 1 - 2 q cos(phi - alpha) + ...
    work = -2 * math.pi * q * MEAN * half * (math.sin(HOT + alpha) + math.sin(COLD + alpha))
    return work, MEAN * math.sqrt((1 - b) / (1 + b)), MEAN * math.sqrt((1 + b) / (1 - b))


def test_on_the_crank_s_volumes():
    work, low, high = computed()
    assert (work, low, high) == pytest.approx(by_quadrature(), rel=2e-6)
    assert (round(work, 3), round(low / 1e5, 4), round(high / 1e5, 4)) == (224.077, 2.7016, 9.5567)


def test_with_a_rod_of_no_end():
    work, low, high = computed(**{"parameters.l1": "0.06 m", "parameters.l2": "99 m"})
    # the rod of 99 m is not without end: r / l is 6e-4 of the swing
    assert (work, low, high) == pytest.approx(closed_form(), rel=2e-3)
    wanted = closed_form()
    assert [round(wanted[0], 3), *(round(p / 1e5, 4) for p in wanted[1:])] == [225.122, 2.6004, 9.6139]


def test_the_regenerator_has_the_logarithmic_mean_temperature():
    # the more of the gas is in the regenerator, the more its temperature decides
    wide = computed(**{"cycle.dead_regenerator": "1200 cm^3"})
    assert wide == pytest.approx(by_quadrature(1200e-6), rel=2e-6)
    assert LOG_MEAN == pytest.approx(568.1, abs=0.1)
