"""Drift and thermal swing of a sensor: made by hand and taken off again; what no method can know of made records."""

import math

import numpy as np
import pytest
from engine_information import information_table
from simulated_engine import DEG, encoder_records
from slider_crank import slider_crank

from mechsym.cycle.measured.diagram import Diagram
from mechsym.cycle.measured.heat_release import mean_pressures
from mechsym.cycle.measured.measure import diagram_facts, measured_cycles
from mechsym.cycle.measured.signal import closing, half_integral, without_drift
from mechsym.errors import BadInput

EXHAUST = 1.1e5  # of every made record


def cylinder_of(e):
    return slider_crank(e.stroke[0, 0] / 2, e.rod[0, 0], e.bore[0, 0], float(e.ratio[0, 0]))


def inlet_of(e):
    return 0.97 * float(e.p_closed.mean())


def diagram_of(e, file, **changes):
    values = {"bore": float(e.bore[0, 0]), "compression_ratio": float(e.ratio[0, 0]), "working_cycle": "four-stroke",
              "alignment": "given", "tdc_offset": 0.0, "pegging": "inlet", "inlet_pressure": inlet_of(e),
              "exhaust_pressure": EXHAUST, "scale": "swing"}  # fmt: skip
    return Diagram(file=file, **{**values, **changes})


def test_half_an_integral_twice_is_a_whole_one():
    phi = np.arange(1440) * DEG / 2
    wave = np.cos(phi / 2) + 0.3 * np.sin(3 * phi)
    once, twice = half_integral(wave, 2), half_integral(half_integral(wave, 2), 2)
    assert np.allclose(twice, 2 * np.sin(phi / 2) - 0.1 * np.cos(3 * phi), atol=1e-12)
    late = math.sqrt(2) * np.cos(phi / 2 - math.pi / 4) + 0.3 / math.sqrt(3) * np.sin(3 * phi - math.pi / 4)
    assert np.allclose(once, late, atol=1e-12) and np.allclose(half_integral(wave + 7.0, 2), once, atol=1e-12)


def test_what_a_cycle_misses_of_closing_is_its_drift():
    phi = np.arange(1440) * DEG / 2
    smooth = 3.0 + np.sin(phi / 2 + 0.4)
    assert closing(smooth) == pytest.approx(0.0, abs=1e-6)
    assert closing(smooth + 0.25 * phi / (4 * math.pi)) == pytest.approx(0.25, abs=1e-6)


def test_drift_is_taken_off_as_far_as_it_is_more_than_noise():
    phi = np.arange(1440) * DEG / 2
    peak = np.exp(4 * (np.cos((phi - 2 * math.pi) / 2) - 1))
    peak -= peak.min()
    drifting = peak + 0.01 * phi / (4 * math.pi)
    clean = without_drift(drifting[None])
    assert np.ptp(clean - peak) < 1e-5 and clean.mean() == pytest.approx(drifting.mean())
    # cycles whose ends scatter by three times the drift: four of them leave the third part of it, 1/(1 + 1.5^2)
    ends = 0.03 * np.array([-1, 1, 1, -1]) * math.sqrt(3) / 2
    rows = drifting + ends[:, None] * phi / (4 * math.pi)
    left = closing(without_drift(rows).mean(axis=0))
    assert left == pytest.approx(0.01 * (1 - 1 / (1 + 1.5**2)), rel=0.02)
    cut = np.roll(drifting, 720)[None]
    assert without_drift(cut) is cut


def net(measured, cylinder):
    return mean_pressures(measured.phi, measured.cycles, cylinder).net[0]


def test_a_sensor_that_drifts_and_swings_is_put_right(diagram_file):
    made = encoder_records(np.random.default_rng(4), 1, speeds=(1.0,))
    (e,), (clean,), phi = made.engines, made.pressures, made.file_angle
    noise = 1e-3 * np.ptp(clean) * np.random.default_rng(1).standard_normal(phi.size)
    poor = clean + noise + 3e6 + 0.02 * np.ptp(clean) * phi / (4 * math.pi) - 0.02 * half_integral(clean, 2)
    file = diagram_file({"crank_angle_deg": phi / DEG, "pressure_Pa": poor})
    cylinder = cylinder_of(e)
    true = mean_pressures(phi, clean[None], cylinder).net[0]
    right = measured_cycles(diagram_of(e, file), cylinder)
    plain = measured_cycles(diagram_of(e, file, scale="as_given"), cylinder)
    # the swing's form is taken from the record that swings itself: right to second order of its share
    errors = [abs(net(measured, cylinder) / true - 1) for measured in (right, plain)]
    assert errors[0] < 0.01 < 0.04 < errors[1]
    facts = diagram_facts(diagram_of(e, file), cylinder, right, 0.0)
    assert any("drift and thermal swing taken off" in text for text in facts)


@pytest.mark.parametrize(
    ("changes", "words"),
    [({"pegging": "joint"}, "needs pegging = 'inlet'"), ({"working_cycle": "two-stroke"}, "needs an exhaust stroke"),
     ({"inlet_pressure": None}, "needs inlet_pressure")],
)  # fmt: skip
def test_what_it_needs_is_said(changes, words):
    e = encoder_records(np.random.default_rng(3), 1, speeds=(1.0,)).engines[0]
    with pytest.raises(BadInput, match=words):
        diagram_of(e, "x.csv", **changes)


@pytest.mark.slow
@pytest.mark.heavy
def test_what_no_method_can_know_of_sixty_encoders():
    """A compression line alone holds neither in every set; known pressures of inlet and exhaust halve what is open."""
    alone, closed, told, even = information_table(range(2_000_026, 2_000_086))
    for row in (alone, closed, told, even):
        print(row)
    assert alone.pressure_within < 0.6 and alone.pressure_rms > 0.02 and alone.centre_within < 0.95
    assert closed.pressure_rms < 0.8 * alone.pressure_rms and told.pressure_rms < 0.6 * alone.pressure_rms
    assert told.centre_within < 0.95 and told.centre_rms < 0.2
    assert even.pressure_rms < 0.015
