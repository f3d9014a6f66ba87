"""Diagrams with known offset, scale and dead centre are taken apart again; the smooth pressure is periodic."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from slider_crank import slider_crank

from mechsym.cycle.chamber import travel, volume
from mechsym.cycle.measured.checks import diagram_doubts
from mechsym.cycle.measured.diagram import Diagram
from mechsym.cycle.measured.joint_fit import ChargeShape, Prior, cycle_lines, joint_fit, log_pressure, mean_exponent
from mechsym.cycle.measured.measure import cycle_work, measured_cycles, weak_cycles, work_per_angle
from mechsym.cycle.measured.pressure import diagram_pressure
from mechsym.cycle.measured.signal import noise, smooth
from mechsym.cycle.wiebe import wiebe
from mechsym.errors import BadInput

DEG = math.pi / 180
BAR = 1e5
SMALL = slider_crank(0.0275, 0.0842, 0.0677, 8.5)
GIVEN = {"alignment": "given", "tdc_offset": 234 * DEG}


def four_stroke(phi, n_c=1.30, heat=2.2, start=-8 * DEG):
    """Absolute pressure of a plain four-stroke cycle: inlet 0.6 bar, exhaust 1.05 bar, both blended over 40 degrees."""
    # from the middle of the exhaust stroke, where nothing is blended
    phi = np.remainder(np.asarray(phi) + 450 * DEG, 4 * math.pi) - 450 * DEG
    v = volume(SMALL, phi) / (SMALL.clearance * SMALL.compression_ratio)
    closed = 0.6 * BAR * v**-n_c * (1 + heat * wiebe((phi - start) / (60 * DEG), 5.0, 2.0))

    def blend(angle):
        return 0.5 * (1 + np.tanh((phi - angle) / (12 * DEG)))

    release, induce, trap = blend(160 * DEG), blend(-350 * DEG), blend(-190 * DEG)
    outside = 1.05 * BAR + induce * (0.6 - 1.05) * BAR
    return np.where(phi < 0, trap * closed + (1 - trap) * outside, (1 - release) * closed + release * 1.05 * BAR)


def generator(file, **changes) -> Diagram:
    values = {"bore": 0.0677, "compression_ratio": 8.5, "working_cycle": "four-stroke", "inlet_pressure": 0.6 * BAR}
    return Diagram(file=file, **{**values, **changes})


def recorded(diagram_file, tdc=234.0, offset=88.0, gain=1.0, cycles=4, step=1.0, sigma=0.0, seed=1):
    angle = np.arange(0, 720 * cycles, step)
    pressure = offset + gain * four_stroke((angle - tdc) * DEG) / BAR
    noisy = pressure + np.random.default_rng(seed).normal(0, sigma, angle.size) if sigma else pressure
    return diagram_file({"crank_angle_deg": angle, "pressure_bar": noisy})


def test_dead_centre_offset_and_exponent_are_recovered(diagram_file):
    # a polytrope without losses is no real charge: priors that expect losses pull by half a degree
    measured = measured_cycles(generator(recorded(diagram_file)), SMALL)
    assert measured.tdc / DEG % 720 == pytest.approx(234.0, abs=0.6)
    assert np.allclose(measured.offsets, 88.0 * BAR, atol=0.08 * BAR)
    mean = measured.cycles.mean(axis=0)
    assert np.allclose(mean, four_stroke(measured.phi + measured.tdc - 234 * DEG), atol=0.08 * BAR)
    exponent = mean_exponent(SMALL, measured.alignment.fit.shape, -90 * DEG, -15 * DEG)
    assert exponent == pytest.approx(1.30, abs=0.03)


def test_noise_moves_the_dead_centre_less_than_the_stated_uncertainty(diagram_file):
    measured = measured_cycles(generator(recorded(diagram_file, cycles=12, sigma=0.05)), SMALL)
    assert abs(measured.tdc / DEG % 720 - 234.0) < measured.tdc_uncertainty / DEG < 4.0


@pytest.mark.parametrize("n", [1.28, 1.34])
def test_another_exponent_than_expected_is_inside_the_stated_uncertainty(diagram_file, n):
    angle = np.arange(0, 2880.0)
    rows = four_stroke((angle - 234) * DEG, n_c=n) / BAR + np.random.default_rng(4).normal(0, 0.02, angle.size)
    measured = measured_cycles(generator(diagram_file({"phi_deg": angle, "p_bar": rows})), SMALL)
    assert abs(measured.tdc / DEG % 720 - 234.0) < measured.tdc_uncertainty / DEG < 2.0


@pytest.mark.parametrize("scale", ["trapped", "exhaust"])
def test_scale_is_recovered(diagram_file, scale):
    file = recorded(diagram_file, gain=3.4)
    measured = measured_cycles(generator(file, scale=scale, exhaust_pressure=1.05 * BAR), SMALL)
    assert measured.scale == pytest.approx(1 / 3.4, rel=0.03)
    assert np.allclose(measured.cycles[0], four_stroke(measured.phi + measured.tdc - 234 * DEG), atol=0.5 * BAR)
    assert [d.code for d in diagram_doubts(generator(file, scale=scale), SMALL, measured, 0.3)] == ["scale"]
    with pytest.raises(BadInput, match="starts from 2.* bar.*scale = 'exhaust'"):
        measured_cycles(generator(file), SMALL)
    as_given = measured_cycles(generator(file, scale="as_given"), SMALL)
    assert "scale" in [d.code for d in diagram_doubts(generator(file, scale="as_given"), SMALL, as_given, 0.3)]


def test_pegging_at_the_inlet_and_given_dead_centre(diagram_file):
    file = recorded(diagram_file, offset=5.0)
    diagram = generator(file, alignment="given", tdc_offset=234 * DEG, pegging="inlet")
    measured = measured_cycles(diagram, SMALL)
    assert measured.tdc_uncertainty is None
    at_bdc = float(four_stroke(np.linspace(-190, -170, 21) * DEG).mean())
    assert np.allclose(measured.offsets, 5.0 * BAR + at_bdc - 0.6 * BAR, atol=10.0)


def test_file_taken_as_absolute_or_gauge(diagram_file):
    given_tdc = {"alignment": "given", "tdc_offset": 234 * DEG}
    absolute = measured_cycles(generator(recorded(diagram_file, offset=0.0), pegging="none", **given_tdc), SMALL)
    gauge = generator(recorded(diagram_file, offset=-1.01325), pegging="gauge", **given_tdc)
    assert np.allclose(absolute.cycles, measured_cycles(gauge, SMALL).cycles, rtol=1e-8)
    assert np.allclose(absolute.cycles[0], four_stroke(absolute.phi), rtol=1e-8)


def test_motored_peak_plus_loss_angle(diagram_file):
    angle = np.arange(720.0)
    motored = four_stroke((angle - 300.6) * DEG, heat=0.0) / BAR
    diagram = generator(
        diagram_file({"phi_deg": angle, "p_bar": motored}), alignment="motored_peak", loss_angle=0.0, pegging="none"
    )
    assert measured_cycles(diagram, SMALL).tdc / DEG == pytest.approx(300.6, abs=0.02)


@pytest.mark.parametrize("tdc", [0.0, 30.0, 120.0, 234.0, 355.0, 594.0, 700.0])
def test_any_start_of_the_record(diagram_file, tdc):
    usual = measured_cycles(generator(recorded(diagram_file)), SMALL).tdc - 234 * DEG
    for cycles in (1, 3):
        measured = measured_cycles(generator(recorded(diagram_file, tdc=tdc, cycles=cycles)), SMALL)
        assert math.remainder(measured.tdc - tdc * DEG - usual, 4 * math.pi) / DEG == pytest.approx(0.0, abs=0.01)
        # compression, combustion and expansion of each cycle stand in one row
        assert measured.phi[0] < -100 * DEG and measured.phi[-1] > 60 * DEG
        assert len(measured.cycles) in (cycles, cycles - 1)
        assert np.allclose(measured.cycles, four_stroke(measured.phi + usual), atol=0.08 * BAR)


@pytest.mark.parametrize("step", [0.1, 0.5, 0.7, 2.0, 5.0])
def test_any_spacing(diagram_file, step):
    file = recorded(diagram_file, step=step, cycles=2)
    pressure = diagram_pressure(generator(file, **GIVEN, pegging="polytropic"), SMALL)
    assert pressure.mean_indicated == pytest.approx(reference_work(), rel=0.01)


def reference_work():
    phi = np.linspace(-2 * math.pi, 2 * math.pi, 14400, endpoint=False)
    return float(np.mean(four_stroke(phi) * travel(SMALL.motion, phi)[1])) * 4 * math.pi / SMALL.stroke


def test_uneven_spacing_is_interpolated(diagram_file):
    angle = np.concatenate([np.arange(0, 180, 4.0), np.arange(180, 300, 0.5), np.arange(300, 720, 4.0)])
    file = diagram_file({"phi_deg": angle, "p_bar": four_stroke((angle - 234) * DEG) / BAR})
    pressure = diagram_pressure(generator(file, alignment="given", tdc_offset=234 * DEG, pegging="none"), SMALL)
    phi = np.linspace(-2 * math.pi, 2 * math.pi, 999)
    assert np.allclose(pressure.absolute(phi), four_stroke(phi), atol=0.1 * BAR)
    assert pressure.mean_indicated == pytest.approx(reference_work(), rel=2e-3)


def test_pressure_is_smooth_periodic_and_at_the_noise(diagram_file):
    file = recorded(diagram_file, cycles=12, sigma=0.1)
    pressure = diagram_pressure(generator(file, **GIVEN, pegging="polytropic"), SMALL)
    phi = np.linspace(-7, 7, 1001)
    assert pressure.kinks == () and pressure.period == 4 * math.pi
    assert np.allclose(pressure.absolute(phi), pressure.absolute(phi + 8 * math.pi), rtol=1e-9)
    residual = pressure.absolute(phi) - four_stroke(phi)
    assert np.sqrt(np.mean(residual**2)) < 0.06 * BAR
    assert pressure.mean_indicated == pytest.approx(reference_work(), rel=0.02)
    assert 0 < pressure.phi_p_max < 45 * DEG and pressure.doubts == ()


def test_interpolation_goes_through_the_mean(diagram_file):
    diagram = generator(recorded(diagram_file, sigma=0.1), smoothing="interpolate")
    measured = measured_cycles(diagram, SMALL)
    assert np.allclose(diagram_pressure(diagram, SMALL).absolute(measured.phi), measured.cycles.mean(axis=0), rtol=1e-9)


def test_noise_is_estimated_from_the_samples_alone():
    phi = np.linspace(0, 4 * math.pi, 720, endpoint=False)
    values = np.exp(3 * np.cos(phi)) * 1e5
    assert noise(values) < 50.0
    assert noise(values + np.random.default_rng(3).normal(0, 2e3, 720)) == pytest.approx(2e3, rel=0.15)


def test_smooth_closes_with_continuous_curvature():
    phi = np.linspace(0, 2 * math.pi, 360, endpoint=False)
    spline = smooth(phi, np.cos(phi) + np.random.default_rng(5).normal(0, 0.01, 360), 2 * math.pi, "spline")
    for order in (0, 1, 2):
        ends = spline(np.array([1e-9, 2 * math.pi - 1e-9]), nu=order)
        assert ends[0] == pytest.approx(ends[1], abs=1e-6)


def test_a_weak_cycle_is_found_and_kept(diagram_file):
    angle = np.arange(720.0 * 5)
    heat = np.where(angle // 720 == 3, 0.3, 2.2)
    file = diagram_file({"phi_deg": angle, "p_bar": four_stroke((angle - 234) * DEG, heat=heat) / BAR})
    diagram = generator(file, pegging="none", alignment="given", tdc_offset=234 * DEG)
    measured = measured_cycles(diagram, SMALL)
    assert weak_cycles(cycle_work(measured, SMALL)) == (3,)
    pressure = diagram_pressure(diagram, SMALL)
    assert any("nearly misfired" in fact and "cycle 4" in fact for fact in pressure.facts)
    assert pressure.mean_indicated == pytest.approx(cycle_work(measured, SMALL).mean(), rel=1e-3)


def test_a_degree_of_dead_centre_is_worth_per_cents_of_work(diagram_file):
    file = recorded(diagram_file, offset=0.0)
    earlier, middle, later = (
        measured_cycles(generator(file, pegging="none", alignment="given", tdc_offset=a * DEG), SMALL)
        for a in (233.5, 234.0, 234.5)
    )
    works = [cycle_work(measured, SMALL)[0] for measured in (earlier, middle, later)]
    slope = work_per_angle(middle, SMALL) * DEG
    assert slope == pytest.approx((works[2] - works[0]) / works[1], rel=1e-3)
    assert -0.08 < slope < -0.01


@settings(deadline=None, derandomize=True, max_examples=10)
@given(
    tdc=st.floats(-8, 12),
    offset=st.floats(-50, 100),
    gain=st.floats(0.3, 5),
    n=st.floats(1.2, 1.4),
    n1=st.floats(-0.05, 0.15),
    loss=st.floats(0.0, 0.2),
)
def test_exact_line_gives_back_what_it_was_made_of(tdc, offset, gain, n, n1, loss):
    phi = np.arange(-200, 60, 1.0) * DEG
    shape = ChargeShape(n0=n, n1=n1, loss=loss, sharpness=1.3)
    pressure = offset * BAR + gain * BAR * np.exp(log_pressure(SMALL, np.clip(phi - tdc * DEG, -3, 3), shape)[0])
    fit = joint_fit(phi, pressure, SMALL, (-95 * DEG, -12 * DEG), 0.0, Prior(), [0.0])
    assert fit.tdc / DEG == pytest.approx(tdc, abs=0.5)
    assert abs(fit.tdc / DEG - tdc) < 2.6 * math.sqrt(fit.covariance[0, 0]) / DEG
    assert fit.level == pytest.approx(gain * BAR, rel=0.03)
    rows = np.stack([pressure, pressure + 2e5])
    offsets, levels = cycle_lines(phi - fit.tdc, rows, SMALL, (-95 * DEG, -12 * DEG), fit.shape, fit.drift)
    assert offsets[1] - offsets[0] == pytest.approx(2e5, abs=1.0) and levels[0] == pytest.approx(levels[1], rel=1e-6)


def test_slopes_of_the_charge_line_are_its_derivatives():
    phi, h = np.linspace(-1.6, 1.6, 33), 1e-6
    values = {"n0": 1.31, "n1": 0.06, "loss": 0.09, "sharpness": 1.2}
    slopes = log_pressure(SMALL, phi, ChargeShape(**values))[1]
    later, earlier = (log_pressure(SMALL, phi - s * h, ChargeShape(**values))[0] for s in (1, -1))
    assert np.allclose(slopes[:, 0], (later - earlier) / (2 * h), atol=1e-8)
    for column, name in enumerate(values, start=1):
        up, down = (
            log_pressure(SMALL, phi, ChargeShape(**(values | {name: values[name] + s * h})))[0] for s in (1, -1)
        )
        assert np.allclose(slopes[:, column], (up - down) / (2 * h), atol=1e-8)


def test_a_charge_line_without_losses_is_a_polytrope_and_symmetric():
    phi = np.linspace(-2, 2, 41)
    log_p, _ = log_pressure(SMALL, phi, ChargeShape(n0=1.3, n1=0.0, loss=0.0, sharpness=1.0))
    assert np.allclose(log_p, -1.3 * np.log(volume(SMALL, phi) / volume(SMALL, -45 * DEG)), atol=1e-12)
    lost = log_pressure(SMALL, phi, ChargeShape(n0=1.3, n1=0.05, loss=0.1, sharpness=1.0))[0]
    assert np.all(lost[:20] > lost[:20:-1])  # compression lies above expansion


@pytest.mark.parametrize(
    ("changes", "named"),
    [
        ({"working_cycle": "six-stroke"}, "working_cycle"),
        ({"alignment": "guess"}, "alignment"),
        ({"pegging": "absolute"}, "pegging"),
        ({"smoothing": "fourier"}, "smoothing"),
        ({"fit_to": -80 * DEG}, "fit_to"),
        ({"fit_from": 10 * DEG}, "fit_from"),
        ({"n_c": 2.0}, "n_c"),
        ({"scale": "trapped", "pegging": "inlet"}, "scale"),
        ({"scale": "exhaust", "working_cycle": "two-stroke"}, "exhaust"),
        ({"inlet_pressure": -1.0}, "inlet_pressure"),
    ],
)
def test_bad_inputs_are_refused_by_name(changes, named):
    values = {"bore": 0.0677, "compression_ratio": 8.5, "working_cycle": "four-stroke", **changes}
    with pytest.raises(BadInput, match=named):
        Diagram(**values)


def test_no_file_says_how_to_name_one():
    with pytest.raises(BadInput, match="--diagram FILE"):
        measured_cycles(generator(""), SMALL)


def test_negative_absolute_pressure_is_refused(diagram_file):
    file = recorded(diagram_file, offset=-5.0)
    with pytest.raises(BadInput, match=r"falls to -4.* bar.*pegging"):
        measured_cycles(generator(file, pegging="none", alignment="given", tdc_offset=234 * DEG), SMALL)


def test_gas_exchange_dead_centre_given_for_the_firing_one_is_refused(diagram_file):
    diagram = generator(recorded(diagram_file, offset=5.0), alignment="given", tdc_offset=-126 * DEG, pegging="none")
    with pytest.raises(BadInput, match="highest pressure lies.*behind the dead centre.*a turn away"):
        measured_cycles(diagram, SMALL)
