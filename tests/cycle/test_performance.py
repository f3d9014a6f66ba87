"""Figures of a closed cycle that follow from each other, and a peak between samples."""

import math

import numpy as np
import pytest

from mechsym import cases
from mechsym.cycle.closed.performance import peak
from mechsym.jobs.cycle import cycle


@pytest.mark.parametrize("place", [0.31, 0.52, 0.74])
def test_the_peak_of_a_parabola_lies_between_the_samples(place):
    phi = np.array([[0.0, 0.2, 0.5, 0.6, 0.9, 1.4]])
    largest, where = peak(phi, 7.0 - 3.0 * (phi - place) ** 2)
    assert (largest[0], where[0]) == pytest.approx((7.0, place), rel=1e-12)


def test_a_peak_at_an_end_or_a_corner_stays_on_a_sample():
    phi = np.linspace(0.0, 1.0, 6)[None, :]
    largest, where = peak(phi, phi.copy())
    assert (largest[0], where[0]) == (1.0, 1.0)
    largest, where = peak(np.vstack([phi, phi]), np.vstack([-np.abs(phi - 0.4), 2.0 - np.abs(phi - 0.8)]))
    assert where == pytest.approx([0.4, 0.8]) and largest == pytest.approx([0.0, 2.0], abs=1e-12)


@pytest.mark.parametrize("law", ["chen_flynn", "heywood"])
def test_figures_follow_from_each_other(law):
    told = cycle(cases.load("nunes-slider-crank", {"friction_pressure.law": law}))
    speed = np.array(told["speed_rpm"]) * math.pi / 30
    power = {kind: np.array(told[f"{kind}power_kw"]) * 1e3 for kind in ("", "brake_")}
    assert power[""] == pytest.approx(np.array(told["torque_avg"]) * speed, rel=1e-9)
    assert power["brake_"] == pytest.approx(np.array(told["brake_torque"]) * speed, rel=1e-9)
    mep, brake, friction = (np.array(told[f"{kind}mep_kpa"]) for kind in ("", "brake_", "friction_"))
    assert brake == pytest.approx(mep - friction, rel=1e-12)
    assert np.array(told["gross_mep_kpa"]) == pytest.approx(mep - np.array(told["pumping_mep_kpa"]), rel=1e-12)
    assert power["brake_"] / power[""] == pytest.approx(brake / mep, rel=1e-9)
    assert np.array(told["mechanical_efficiency"]) == pytest.approx(brake / mep, rel=1e-9)
    # the same fuel to both, and the same heat to both
    for figure, sense in (("sfc_g_kwh", -1), ("efficiency", 1)):
        ratio = np.array(told[f"brake_{figure}"]) / np.array(told[figure])
        assert ratio == pytest.approx((brake / mep) ** sense, rel=1e-9)
    shares = [float(np.ravel(share)[0]) for share in told["fractions"].values()]
    assert sum(shares) == pytest.approx(1.0, abs=1e-9)  # by the energy balance


def test_the_friction_of_chen_and_flynn_counts_the_mean_piston_speed():
    case = cases.load("nunes-slider-crank", {"friction_pressure.law": "chen_flynn"})
    told = cycle(case)
    parameters = case.need("parameters")
    stroke = 2 * (parameters.r1 + parameters.r2)
    speed = 2 * stroke * np.array(told["speed_rpm"]) / 60
    pressure = 0.4e5 + 0.005 * np.array(told["p_max_mpa"]) * 1e6 + 0.09e5 * speed + 0.0009e5 * speed**2
    assert np.array(told["friction_mep_kpa"]) == pytest.approx(pressure / 1e3, rel=1e-9)
