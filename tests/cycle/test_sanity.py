"""Signals that no cylinder makes are refused, poor records are doubted: never a bare number."""

import math
from dataclasses import replace

import numpy as np
import pytest
from simulated_engine import DEG, records, whole_cycle
from slider_crank import slider_crank

from mechsym.cycle.measured.checks import brake_doubt, diagram_doubts, speed_doubt
from mechsym.cycle.measured.diagram import Diagram
from mechsym.cycle.measured.measure import measured_cycles
from mechsym.errors import BadInput

ANGLE = np.arange(0.0, 2160.0)


@pytest.fixture(scope="module")
def engine():
    """One small petrol engine: its cylinder, and its pressure in bar over three cycles, dead centre at 400 degrees."""
    r = records(np.random.default_rng(21), 12, 1)
    e = r.engines.take(slice(int(np.argmax(r.engines.ratio[:, 0] < 10)), None)).take(slice(0, 1))
    phi, p = whole_cycle(e, e.p_closed[..., None], 1.05e5)
    at = np.remainder(ANGLE - 400 + 360, 720) - 360
    cylinder = slider_crank(e.stroke[0, 0] / 2, e.rod[0, 0], e.bore[0, 0], e.ratio[0, 0])
    noise = np.random.default_rng(2).normal(0, 0.01, ANGLE.size)
    return cylinder, np.interp(at * DEG, phi, p[0, 0]) / 1e5 + noise


def read(diagram_file, cylinder, pressure, angle=ANGLE, **changes):
    values = {"bore": cylinder.bore, "compression_ratio": cylinder.compression_ratio, "working_cycle": "four-stroke"}
    file = diagram_file({"angle_deg": angle, "pressure_bar": pressure})
    diagram = Diagram(file=file, **{**values, **changes})
    return diagram, measured_cycles(diagram, cylinder)


def codes(diagram, cylinder, measured):
    mean = measured.cycles.mean(axis=0)
    return {d.code for d in diagram_doubts(diagram, cylinder, measured, float(measured.phi[np.argmax(mean)]))}


def test_a_sound_record_has_no_doubts(diagram_file, engine):
    cylinder, p = engine
    diagram, measured = read(diagram_file, cylinder, p)
    assert codes(diagram, cylinder, measured) == set()
    found = measured.alignment.dead_centre
    assert found.low < 400 * DEG < found.high
    # without inlet_pressure nothing else checks the scale
    assert "scale" in codes(diagram, cylinder, replace(measured, bottom=2.8e5))


NONSENSE = {
    "sine": (lambda p: 20 + 19 * np.cos((ANGLE - 400) * DEG / 2), "above half of its swing for"),
    "sine of every turn": (lambda p: 20 + 19 * np.cos((ANGLE - 400) * DEG), "two humps in 720 deg"),
    "square wave": (lambda p: np.where(np.remainder(ANGLE - 380, 720) < 90, 20.0, 1.0), "saturated|stuck"),
    "broad square wave": (lambda p: np.where(np.remainder(ANGLE - 380, 720) < 300, 20.0, 1.0), "saturated|stuck"),
    "saturated": (lambda p: np.minimum(p, 0.7 * p.max()), "saturated at"),
    "stuck": (lambda p: np.where(np.abs(np.remainder(ANGLE - 400 + 360, 720) - 360 + 35) < 14, 5.0, p), "stuck at"),
    "upside down": (lambda p: -p, "above half of its swing|stuck|second"),
    "noise": (lambda p: np.random.default_rng(1).normal(5, 2, ANGLE.size), "humps|above half|behind the dead centre"),
}


@pytest.mark.parametrize("kind", NONSENSE)
def test_signals_of_no_cylinder_are_refused(diagram_file, engine, kind):
    make, message = NONSENSE[kind]
    cylinder, p = engine
    with pytest.raises(BadInput, match=message) as caught:
        read(diagram_file, cylinder, make(p))
    assert "diagram.csv" in str(caught.value) and "\n" not in str(caught.value)


def test_camshaft_degrees_are_refused(diagram_file, engine):
    cylinder, p = engine
    with pytest.raises(BadInput, match="two humps in 720 deg.*camshaft degrees"):
        read(diagram_file, cylinder, p[:1440], angle=ANGLE[:1440] / 2)


def test_a_four_stroke_record_in_a_two_stroke_case_is_refused(diagram_file, engine):
    cylinder, p = engine
    with pytest.raises(BadInput, match="every second turn.*four-stroke"):
        read(diagram_file, cylinder, p, working_cycle="two-stroke")


@pytest.mark.parametrize("factor", [0.1, 10.0, 14.5])
def test_a_wrong_unit_is_refused_or_doubted(diagram_file, engine, factor):
    cylinder, p = engine
    inlet = float(np.median(p)) * 1e5
    with pytest.raises(BadInput, match="swings by|starts from .* bar absolute at BDC"):
        read(diagram_file, cylinder, factor * p, inlet_pressure=inlet)
    if factor < 14:
        diagram, measured = read(diagram_file, cylinder, factor * p, inlet_pressure=inlet, scale="as_given")
        assert "scale" in codes(diagram, cylinder, measured)


def test_a_dead_centre_given_wrong_is_doubted(diagram_file, engine):
    cylinder, p = engine
    diagram, measured = read(diagram_file, cylinder, p, alignment="given", tdc_offset=394 * DEG)
    assert "dead_centre" in codes(diagram, cylinder, measured)


def test_a_sensor_that_is_saturated_below_is_doubted(diagram_file, engine):
    cylinder, p = engine
    diagram, measured = read(diagram_file, cylinder, np.maximum(p, 2.5))
    assert "floor" in codes(diagram, cylinder, measured)


def test_a_speed_that_is_not_the_engines_is_doubted():
    assert speed_doubt(250.0, 320.0) is None
    assert speed_doubt(0.32, 320.0).code == "speed"  # milliseconds read as seconds
    assert speed_doubt(3.2e5, 320.0).value == pytest.approx(1000)


def test_speed_of_every_cycle_comes_from_the_times(diagram_file, engine):
    cylinder, p = engine
    speed = np.where(ANGLE < 720, 300.0, np.where(ANGLE < 1440, 310.0, 320.0))
    time = np.concatenate([[0.0], np.cumsum(DEG / speed)])[:-1]
    file = diagram_file({"angle_deg": ANGLE, "time_ms": 1e3 * time, "pressure_bar": p})
    values = {"bore": cylinder.bore, "compression_ratio": cylinder.compression_ratio, "working_cycle": "four-stroke"}
    measured = measured_cycles(Diagram(file=file, **values), cylinder)
    start = int(measured.speeds.size == 2)  # a record cut through the middle of compression loses a cycle
    assert np.allclose(measured.speeds, [300.0, 310.0, 320.0][: 3 - start], rtol=0.03)
    backwards = diagram_file({"angle_deg": ANGLE, "time_s": -time, "pressure_bar": p}, "backwards.csv")
    with pytest.raises(BadInput, match="backwards.csv, line 3: time .* does not rise"):
        measured_cycles(Diagram(file=backwards, **values), cylinder)


def test_brake_torque_and_indicated_work_belong_together():
    assert brake_doubt(8.0, 7e5, 2e-4, 4 * math.pi) is None
    assert brake_doubt(12.0, 7e5, 2e-4, 4 * math.pi).code == "mechanical_efficiency"
    assert brake_doubt(2.0, 7e5, 2e-4, 4 * math.pi).value == pytest.approx(0.18, abs=0.01)
