"""One dead centre of several records: held as often as its interval says, by a simulator that shares nothing."""

import json
import math
import os
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from simulated_engine import DEG, encoder_records
from slider_crank import slider_crank

from mechsym.cli.cycle import cycle as cycle_command
from mechsym.cycle.measured.alignment import from_compression
from mechsym.cycle.measured.heat_release import interval, mean_pressures, variation
from mechsym.cycle.measured.joint_fit import Prior, information, joint_fit
from mechsym.cycle.measured.shared_centre import EncoderRecord, expected_losses, shared_centre
from mechsym.cycle.measured.signal import without_drift
from mechsym.errors import BadInput

LINE = (-90 * DEG, -15 * DEG)
DATA = os.environ.get("MECHSYM_TEST_DATA", "")
measured_only = pytest.mark.skipif(not DATA, reason="the generator's files need MECHSYM_TEST_DATA, their folder")


def cylinder_of(e):
    return slider_crank(e.stroke[0, 0] / 2, e.rod[0, 0], e.bore[0, 0], float(e.ratio[0, 0]))


def lines_of(made):
    inside = (made.file_angle > -4) & (made.file_angle < 2.3)
    return [
        EncoderRecord(
            angle=made.file_angle[inside], mean=rows.mean(axis=0)[inside], omega=float(e.omega[0, 0]), motored=False,
            spread=0.0,
        )
        for rows, e in zip(made.rows, made.engines, strict=True)
    ]  # fmt: skip


def told(rng, cycles=6):
    """Error and half interval of the shared dead centre [deg], and the error of the net mean pressure of each [-]."""
    made = encoder_records(rng, cycles)
    made = replace(made, rows=[without_drift(rows) for rows in made.rows])  # as a file is read
    cylinder = cylinder_of(made.engines[0])
    # what a case says of its fuel: mixture of a spark engine, air of a diesel
    exponent = 1.30 if cylinder.compression_ratio < 13 else 1.34
    found = shared_centre(lines_of(made), cylinder, LINE, Prior(n0=(exponent + 0.03, 0.045)))
    step, work = float(np.diff(made.file_angle)[0]), []
    for rows, p, own in zip(made.rows, made.pressures, found.records, strict=True):
        phi = made.file_angle
        true = mean_pressures(phi, p[None], cylinder).net[0]
        order = np.argsort(np.remainder(phi - own.angle + 2 * math.pi, 4 * math.pi))
        at = -2 * math.pi + step * np.arange(phi.size) + np.remainder(-own.angle, step)
        work.append(mean_pressures(at, rows.mean(axis=0)[order][None], cylinder).net[0] / true - 1)
    centre = found.centre
    off = (centre.angle - made.dead_centre.mean()) / DEG
    return off, (centre.high - centre.low) / 2 / DEG, np.array(work)


@pytest.mark.slow
def test_some_encoders():
    of = [told(np.random.default_rng(seed)) for seed in range(4)]
    off, half = np.array([o[0] for o in of]), np.array([o[1] for o in of])
    assert np.mean(np.abs(off) < half) >= 0.75 and abs(off.mean()) < 0.2 and np.median(half) < 0.8
    assert abs(np.mean([o[2] for o in of])) < 0.015


@pytest.mark.slow
@pytest.mark.heavy
def test_sixty_encoders_of_four_records():
    of = [told(np.random.default_rng(seed)) for seed in range(2_000_026, 2_000_086)]
    off, half = np.array([o[0] for o in of]), np.array([o[1] for o in of])
    print(f"bias {off.mean():.3f} deg, spread {off.std():.3f}, held {np.mean(np.abs(off) < half):.3f}, "
          f"half {np.median(half):.3f}, pressure {100 * np.mean([o[2] for o in of]):.2f} %, of the sets "
          f"{np.mean(np.abs(off) < 0.2):.2f} within 0.2 deg")  # fmt: skip
    assert abs(off.mean()) < 0.2 and 0.90 <= np.mean(np.abs(off) < half)
    assert abs(np.mean([o[2] for o in of])) < 0.015


def test_one_record_says_of_itself_what_its_fit_says():
    """Priors taken out and put in again: the fit of one line comes back."""
    made = encoder_records(np.random.default_rng(3), 3, speeds=(1.0,))
    (line,), cylinder = lines_of(made), cylinder_of(made.engines[0])
    fit = joint_fit(line.angle, line.mean, cylinder, LINE, 2e3, Prior(), [0.0])
    weight, pull = information(fit, Prior())
    tight = np.diag([0.0, *(1 / s**2 for _, s in (Prior().n0, Prior().n1, Prior().loss, Prior().sharpness))])
    middle = np.array([0.0, *(m for m, _ in (Prior().n0, Prior().n1, Prior().loss, Prior().sharpness))])
    back = np.linalg.solve(weight + tight, pull + tight @ middle)
    assert back[0] == pytest.approx(fit.tdc, abs=1e-6) and back[1] == pytest.approx(fit.shape.n0, abs=1e-6)


def test_more_records_tell_more_and_an_uneven_one_less():
    made = encoder_records(np.random.default_rng(5), 4)
    lines, cylinder = lines_of(made), cylinder_of(made.engines[0])
    one, two, four = (shared_centre(lines[:k], cylinder, LINE, Prior()).centre for k in (1, 2, 4))
    assert four.high - four.low < two.high - two.low < one.high - one.low
    uneven = shared_centre([lines[0], replace(lines[1], spread=2 * DEG)], cylinder, LINE, Prior()).centre
    assert two.high - two.low < uneven.high - uneven.low
    single = from_compression(lines[0].angle, lines[0].mean, cylinder, LINE, Prior())[0]
    assert abs(one.angle - single.angle) < single.high - single.low


def test_losses_are_those_of_the_laws_by_hand():
    """A small engine by hand: a cube of gas, the law of Hohenberg alone; larger and faster engines lose less."""
    small, large = slider_crank(0.0275, 0.0842, 0.0677, 8.5), slider_crank(0.275, 0.842, 0.677, 8.5)
    slow, fast = expected_losses(small, 150.0), expected_losses(small, 300.0)
    (heat, _), (leak, _) = fast
    assert 0.02 < heat < slow[0][0] < 0.15 and leak == pytest.approx(slow[1][0] / 2)
    assert expected_losses(large, 30.0)[0][0] < heat
    t, p = 340 * 8.5**0.35, 0.9e5 * 8.5**1.35
    v, speed = float(small.clearance), 0.055 * 300 / math.pi
    hohenberg = 130 * v**-0.06 * (p / 1e5) ** 0.8 * t**-0.4 * (speed + 1.4) ** 0.8 * (t - 430)
    area = 2 * math.pi / 4 * 0.0677**2 + 4 * v / 0.0677
    share = 0.35 * hohenberg * area / (p * v * 300)
    assert 0.4 * share < heat < 2.5 * share


def test_eleven_cycles_know_their_variation_to_half():
    cov, (low, high) = variation(np.random.default_rng(1).normal(1.0, 0.05, 11))
    assert low / cov == pytest.approx(0.699, abs=1e-3) and high / cov == pytest.approx(1.755, abs=1e-3)
    assert variation(np.array([1.0])) is None and variation(np.array([-1.0, -2.0])) is None
    held = 0
    for seed in range(400):
        _, (low, high) = variation(np.random.default_rng(seed).normal(1.0, 0.05, 11))
        held += low < 0.05 < high
    assert 0.92 < held / 400 < 0.98


def test_interval_of_a_mean_carries_the_dead_centre():
    values = np.array([1.0, 2.0, 3.0, 4.0])
    mean, (low, high) = interval(values, 0.0)
    assert mean == 2.5 and high - mean == pytest.approx(3.18245 * np.std(values, ddof=1) / 2, rel=1e-4)
    wider = interval(values, 3.0)[1]
    assert wider[1] - mean == pytest.approx(math.hypot(high - mean, 3.0)) and interval(values[:1], 3.0)[1] == [-2, 4]


def analysed(*names):
    files = [word for name in names for word in ("--diagram", str(Path(DATA) / f"generator-{name}.csv"))]
    return json.loads(CliRunner().invoke(cycle_command, ["generator", *files, "--json"], catch_exceptions=False).stdout)


@measured_only
def test_two_fired_records_of_the_generator():
    found = analysed("full-load", "half-load")
    low, high = found["dead_centre"]["interval_deg"]
    assert low < 238.3 < high and (high - low) / 2 <= 1.0
    full, half = found["records"]
    assert full["imep_bar"] == found["imep_bar"] > half["imep_bar"]
    low, high = found["imep_interval_bar"]
    assert low < found["imep_bar"] < high and found["imep_gross_bar"] > found["imep_bar"]
    assert found["ca10_deg"] < found["ca50_deg"] < found["ca90_deg"]
    low, high = found["cov_imep_interval"]
    assert (low / found["cov_imep"], high / found["cov_imep"]) == (
        pytest.approx(0.70, abs=0.01),
        pytest.approx(1.75, abs=0.01),
    )


@measured_only
def test_with_the_motored_record_among_them():
    found = analysed("motored", "full-load", "half-load")
    assert 238.0 <= found["dead_centre"]["deg"] <= 238.9


@measured_only
def test_a_record_that_is_named_twice_is_refused():
    with pytest.raises(BadInput, match="named twice"):
        analysed("full-load", "full-load")
