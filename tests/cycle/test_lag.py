"""Lag of a sensor: told by cycles of several speeds as often as its interval says, never by one speed."""

import dataclasses
import json

import numpy as np
import pytest
import scipy
from click.testing import CliRunner
from simulated_engine import DEG, records
from slider_crank import slider_crank

from mechsym.cli.cycle import cycle as cycle_command
from mechsym.cycle.measured.alignment import THROUGH, from_motored
from mechsym.cycle.measured.joint_fit import Prior, joint_fit, pulls
from mechsym.cycle.measured.shared_centre import cycle_fits, sensor_lag, without_lag

LINE = (-90 * DEG, -15 * DEG)
RUN_DOWN = np.linspace(1.0, 0.4, 6)
LONG = 2 * DEG  # at the highest speed


def cylinder_of(r, k):
    e = r.engines
    return slider_crank(e.stroke[k, 0] / 2, e.rod[k, 0], e.bore[k, 0], float(r.ratio[k]))


def near_tdc(r, k):
    inside = (r.file_angle > -4) & (r.file_angle < 2.3)
    return r.file_angle[inside], r.rows[k][:, inside]


def told(r, k, ends):
    """Lag of a record and its dead centre without it."""
    (angle, rows), cylinder = near_tdc(r, k), cylinder_of(r, k)
    found = from_motored(angle, rows.mean(axis=0), cylinder, Prior(), "motored record")[0]
    lag = sensor_lag(cycle_fits(angle - found.angle, rows, cylinder, ends, Prior()), r.engines.omega[k], Prior())
    return lag, without_lag(found, lag)


@pytest.fixture(scope="module")
def fit():
    r = records(np.random.default_rng(21), 1, 1, fired=False)
    angle, rows = near_tdc(r, 0)
    return joint_fit(angle, rows[0], cylinder_of(r, 0), THROUGH, 1e3, Prior(), [0.0])


def test_interval_of_scattered_dead_centres(fit):
    rng, speeds, lag = np.random.default_rng(3), np.linspace(150.0, 300.0, 6), 5e-5
    held = []
    for _ in range(200):
        at = lag * speeds + 0.3 * DEG * rng.standard_normal(6)
        found = sensor_lag([dataclasses.replace(fit, tdc=float(t)) for t in at], speeds, Prior())
        held.append(abs(found.lag - lag) < found.half)
    assert 0.91 <= np.mean(held) <= 0.985


def test_what_is_assumed_may_change_with_speed(fit):
    """Without scatter the losses alone, 0.06 by the logarithm of the speed, leave their pull's slope."""
    speeds, row = np.linspace(150.0, 300.0, 6), np.zeros(8)
    row[3] = fit.covariance[0, 3]
    only = dataclasses.replace(fit, covariance=np.vstack([row, fit.covariance[1:]]))
    only.covariance[0, 0] = fit.covariance[0, 0]  # the dead centre is free: nothing pulls it by itself
    found = sensor_lag([dataclasses.replace(only, tdc=5e-5 * w) for w in speeds], speeds, Prior())
    moved = row[3] / 0.06**2 * 0.06 * np.log(speeds)
    assert found.half == pytest.approx(scipy.special.ndtri(0.975) * abs(np.polyfit(speeds, moved, 1)[0]), rel=1e-6)


def test_a_straight_line_gives_its_slope_whatever_the_weights(fit):
    speeds = np.array([100.0, 180.0, 260.0, 300.0, 310.0])
    better = dataclasses.replace(fit, covariance=fit.covariance / 9)
    fits = [dataclasses.replace(f, tdc=0.3 + 4e-5 * w) for f, w in zip([fit, better] * 3, speeds, strict=False)]
    found = sensor_lag(fits, speeds, Prior())
    assert found.lag == pytest.approx(4e-5)
    assert found.omega == pytest.approx(np.average(speeds, weights=[1, 9, 1, 9, 1])) and found.speeds == (100.0, 310.0)


def test_pulls_are_slopes_of_the_fit():
    """A prior moved by a little moves the dead centre by its pull."""
    r = records(np.random.default_rng(21), 1, 1)
    (angle, rows), cylinder = near_tdc(r, 0), cylinder_of(r, 0)
    low, high = (joint_fit(angle, rows[0], cylinder, LINE, 1e4, Prior(n0=(n, 0.045)), [0.0]) for n in (1.3299, 1.3301))
    assert pulls(low, Prior())[1] == pytest.approx((high.tdc - low.tdc) / 2e-4, rel=0.15)
    assert pulls(low, Prior())[[0, 5, 6]] == pytest.approx(0)


@pytest.mark.parametrize("speeds", [[200.0] * 6, [200.0, 201.0, 202.0, 203.0, 204.0, 205.0], [100.0, 200.0, 300.0]])
def test_one_speed_or_three_cycles_tell_no_lag(fit, speeds):
    assert sensor_lag([fit] * len(speeds), np.array(speeds), Prior()) is None


@pytest.mark.slow
@pytest.mark.heavy
def test_interval_holds_the_lag_as_often_as_it_says():
    r = records(np.random.default_rng(31), 150, 6, fired=False, faster=RUN_DOWN, longest=LONG)
    found = [told(r, k, THROUGH) for k in range(150)]
    off = np.array([lag.lag for lag, _ in found]) - r.lag
    half = np.array([lag.half for lag, _ in found])
    assert 0.90 <= np.mean(np.abs(off) < half) <= 0.98
    assert np.mean(r.lag > half) > 0.4  # none is no answer
    at = np.array([angle for _, (angle, _) in found]) - (r.dead_centre - r.lag * r.engines.omega[:, 0])
    assert np.mean(np.abs(at) < [half for _, (_, half) in found]) >= 0.90


@pytest.mark.slow
@pytest.mark.heavy
def test_fired_records_tell_little_and_say_so():
    r = records(np.random.default_rng(32), 60, 6, faster=RUN_DOWN, longest=LONG)
    found = [told(r, k, LINE)[0] for k in range(60)]
    held = np.abs(np.array([lag.lag for lag in found]) - r.lag) < [lag.half for lag in found]
    assert np.mean(held) >= 0.85
    assert np.mean([lag.told for lag in found]) < 0.2


def written(path, r, k):
    """A record with its times, the speed even over the angle."""
    count = len(r.rows[k])
    angle = (r.file_angle + 720 * DEG * np.arange(count)[:, None]).ravel()
    line = np.polyfit(720 * DEG * np.arange(count), r.engines.omega[k] * np.ones(count), 1)
    time = np.append(0.0, np.cumsum(np.diff(angle) / np.polyval(line, (angle[1:] + angle[:-1]) / 2)))
    table = np.stack([angle / DEG + 360, time, r.rows[k].ravel() / 1e5], axis=-1)
    np.savetxt(path, table, "%.9g", ",", header="crank_angle_deg,time_s,pressure_bar", comments="")
    return path


def analysed(r, k, file, *more):
    e = r.engines
    values = {
        "parameters.r2": e.stroke[k, 0] / 2, "parameters.l1": 0.3 * e.rod[k, 0], "parameters.l2": 0.7 * e.rod[k, 0],
        "cycle.bore": e.bore[k, 0], "cycle.compression_ratio": r.ratio[k], "cycle.scale": "as_given",
        "cycle.pegging": "joint",
    }  # fmt: skip
    sets = [word for key, value in values.items() for word in ("--set", f"{key}={value}")]
    result = CliRunner().invoke(
        cycle_command, ["generator", "--diagram", str(file), *sets, *more], catch_exceptions=False
    )
    return result.stdout


@pytest.mark.slow
def test_a_run_down_tells_lag_and_dead_centre(tmp_path):
    r = records(np.random.default_rng(7), 1, 6, fired=False, faster=RUN_DOWN, longest=LONG)
    file = written(tmp_path / "run-down.csv", r, 0)
    lag = json.loads(analysed(r, 0, file, "--json"))["lag"]
    low, high = lag["interval_seconds"]
    assert lag["told"] and 0 < low < r.lag[0] < high
    omega = r.engines.omega[0]
    # mean over the time of a cycle in which the speed falls evenly over the angle
    fall = omega[0] - omega[1]
    mean = fall / np.log((omega + fall / 2) / (omega - fall / 2)) * 30 / np.pi
    assert lag["speeds_rpm"] == pytest.approx([mean[-1], mean[0]], rel=1e-3)
    true = (r.dead_centre[0] - r.lag[0] * omega[0]) / DEG % 360
    low, high = lag["dead_centre_interval_deg"]
    assert low < true < high
    assert "sensor's lag by cycles of" in analysed(r, 0, file) and "dead centre without it" in analysed(r, 0, file)


@pytest.mark.slow
def test_a_steady_record_tells_none(tmp_path):
    r = records(np.random.default_rng(7), 1, 6, fired=False, longest=LONG)
    file = written(tmp_path / "steady.csv", r, 0)
    assert json.loads(analysed(r, 0, file, "--json"))["lag"] is None
