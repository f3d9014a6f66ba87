"""Start-up of Chmielewski et al. (2015): converged, energy in balance, explained by orders and natural frequency."""

import dataclasses

import numpy as np
import pytest

from mechsym import cases, mechanisms
from mechsym.cases.settings import settings_of
from mechsym.jobs.problem import problem_of
from mechsym.jobs.run import startup, startup_map
from mechsym.simulate import Settings, simulate
from mechsym.simulate.fixed_step import fixed_step
from mechsym.simulate.result import summary
from mechsym.torsion.startup import find_captures, findings, numbers, series

BACKENDS = ("scipy-dop853", "sundials")


def case(**values):
    return cases.load("chmielewski", {k.replace("__", "."): v for k, v in values.items()})


def test_first_seconds_agree_between_integrators():
    start = case(t_end="4 s", window="1 s")
    problem = problem_of(start)
    means = []
    for backend in BACKENDS:
        result = simulate(problem, Settings(backend=backend))
        assert result.status == "converged"
        assert abs(result.energy.residual) < 1e-8
        means.append(summary(result, problem.mechanism.coordinates, 1.0).speeds)
    for coordinate in ("phi0", "phi2"):
        assert means[0][coordinate]["mean"] == pytest.approx(means[1][coordinate]["mean"], rel=1e-7)


def test_torque_is_off_before_its_time():
    result = simulate(problem_of(case(t_end="3 s", window="0.5 s")), Settings())
    early = result.t <= 1.0
    assert early.sum() > 100
    assert not np.any(result.columns["phi0d"][early]) and not np.any(result.columns["work_drive"][early])
    assert result.columns["phi0d"][-1] > 0


def test_rigid_drive_is_an_upper_bound():
    found = startup(case(t_end="12 s"))
    mean = 1.1 * 0.06**2 / 2 * (1 + (0.06 / 0.26) ** 2 / 4)  # of m0 x0'^2, to the second order in r/l
    bound = 1.5 / (0.26 + 0.58 + mean)
    assert found.rigid_rate == pytest.approx(bound, rel=1e-5)
    late = found.t > 6.0  # several turns a second, so that the mean over a second is one over turns
    assert np.all(found.speed_mean[late] < 1.003 * bound * (found.t[late] - 1.0))
    assert found.speed_mean[-1] > 0.99 * bound * (found.t[-1] - 1.0)
    assert found.captures == ()
    assert abs(found.result.energy.residual) < 1e-8


def test_captures_are_found_in_a_made_up_series():
    criticals = startup(case(t_end="3 s")).criticals
    second = next(c for c in criticals if c.order == 2)
    t = np.arange(0, 100, 0.1)
    held = np.where(t < 50, 1.9 * t, np.where(t < 80, second.speed * 1.001, second.speed + 2 * (t - 80)))
    (capture,) = find_captures(t, held, criticals, 1.9)
    assert capture.critical.order == 2 and capture.released
    assert capture.t_start == pytest.approx(second.speed * 0.98 / 1.9, abs=0.11)
    assert capture.t_end == pytest.approx(80 + 0.02 * second.speed / 2, abs=0.2)
    assert find_captures(t, 1.9 * t, criticals, 1.9) == ()
    (capture,) = find_captures(t, np.minimum(1.9 * t, second.speed), criticals, 1.9)
    assert not capture.released


def test_series_of_means():
    found = startup(case(t_end="5 s"))
    t, speed, twist = series(found.result)
    assert t[0] == 0.5 and t[-1] == pytest.approx(4.5)
    np.testing.assert_allclose(np.diff(t), 0.1)
    assert np.all(twist <= found.twist_peak) and speed[-1] == pytest.approx(found.rigid_rate * 3.5, rel=5e-3)


@pytest.mark.slow
@pytest.mark.heavy
def test_hundred_seconds_converge():
    whole = case()
    problem = problem_of(whole)
    means = {}
    for backend, tolerance in (("scipy-dop853", 1e-10), ("scipy-dop853", 1e-12), ("sundials", 1e-11)):
        result = simulate(problem, Settings(backend=backend, tolerance=tolerance, check="none"))
        if backend == "scipy-dop853":
            assert abs(result.energy.residual) < 1e-8
        speeds = summary(result, problem.mechanism.coordinates, 2.0).speeds
        means[backend, tolerance] = [speeds[c]["mean"] for c in ("phi0", "phi2")]
    reference = means["scipy-dop853", 1e-12]
    for other in means.values():
        np.testing.assert_allclose(other, reference, rtol=1e-4 / 100)  # a hundredth of what is asked for


@pytest.mark.slow
@pytest.mark.heavy
def test_capture_by_the_second_order_and_what_damping_does():
    runs = startup_map(case(backend="sundials", simulation__tolerance="1e-11"), (0.0, 0.2, 1.0, 5.0))
    assert all(r.result.status == "converged" for r in runs)
    bare, weak, middle, strong = runs
    assert [c.critical.order for c in bare.captures] == [2] and bare.captures[0].released
    assert [c.critical.order for c in weak.captures] == [2] and not weak.captures[0].released
    assert middle.captures == strong.captures == ()
    # the linear theory says which damper lets this drive pass, the runs agree
    second = next(d for c, d in zip(bare.criticals, bare.holding_damping, strict=True) if c.order == 2)
    assert 0.2 < second < 1.0
    assert 50 < bare.captures[0].t_start < 56 and 85 < bare.captures[0].t_end < 95
    assert bare.twist_peak > 1 and bare.speed_min < 0
    assert [numbers(r).model_holds for r in runs] == [False, False, True, True]
    assert any("model does not hold" in line for line in findings(bare))
    assert not any("model does not hold" in line for line in findings(strong))
    # 194 rad/s from 90 s on is more than the work of the drive allows, damped or not
    assert all(r.rigid_rate * 99.0 < 194.0 for r in runs)
    assert all(any("194 rad/s" in line and "beyond what" in line for line in findings(r)) for r in runs)


@pytest.mark.slow
@pytest.mark.heavy
def test_a_fixed_step_holds_the_resonance_at_a_false_amplitude():
    """With steps just below a millisecond the printed model stays captured, and the crank peaks near 194 rad/s."""
    whole = case()
    printed = mechanisms.build("crankshaft_flywheel_printed", whole.need("parameters"))
    problem = dataclasses.replace(problem_of(whole), mechanism=printed)
    t, y = fixed_step(problem, 0.88e-3, 3)
    late = t > 90.0
    assert np.ptp(y[late, 0]) / np.ptp(t[late]) == pytest.approx(94.9, abs=0.1)
    assert y[late, 2].max() == pytest.approx(194.0, abs=2.0)
    converged = simulate(problem, Settings(backend="sundials", tolerance=1e-11))
    assert converged.status == "converged" and converged.energy.residual is None
    assert converged.columns["phi0d"][converged.t > 90.0].max() > 250.0


def test_settings_come_from_the_case():
    assert settings_of(case()) == Settings(tolerance=1e-10)
    assert settings_of(case(simulation__tolerance=1e-8, backend="heyoka")).backend == "heyoka"
