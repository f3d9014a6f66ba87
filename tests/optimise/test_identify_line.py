"""Identification where least squares have a formula: a speed that is linear in the parameters and in its start.

phi'' = z1 t + z2 t^2 - W^2 phi, so u = z1 / W^2 + 2 z2 t / W^2 + A cos W t + B sin W t.
"""

import dataclasses
import math
from types import SimpleNamespace

import casadi as ca
import matplotlib.pyplot as plt
import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.stats import t as student

from mechsym import budget
from mechsym.errors import BadInput
from mechsym.optimise import shown
from mechsym.optimise.fit import TracedMotion, grid, legendre
from mechsym.optimise.identify import Estimate, _alike, _behind, doubts, durbin_watson, identify, white_noise
from mechsym.optimise.trace import Trace

W, Z = 1.3, (0.7, -0.4)
T = np.linspace(0.0, 6.0, 121)
SHAPES = np.column_stack([np.ones_like(T) / W**2, 2 * T / W**2, np.cos(W * T), np.sin(W * T)])


def motion(torque=lambda z, w: z[0] * w[0] + z[1] * w[1], low=(-np.inf, -np.inf), turning=True, stiffness=W**2):
    x, w, z = ca.SX.sym("x", 2), ca.SX.sym("w", 2), ca.SX.sym("z", 2)
    rate = ca.Function("rate", [x, w, z], [ca.vertcat(x[1], torque(z, w) - stiffness * x[0])])
    energy = ca.Function("energy", [x, w, z], [x[1] ** 2 / 2, x[1] * (torque(z, w) - stiffness * x[0])])
    return TracedMotion(
        rate=rate, velocities=("phid",), turning=(turning,), inputs=("a", "b"), names=("z1", "z2"), units=("N", "m"),
        start=np.array([0.5, 0.5]), size=np.array([0.7, 0.4]), low=np.array(low), known=lambda t: np.array([t, t**2]),
        pose=np.zeros(1), energy=energy, lossy=False,
    )  # fmt: skip


def trace(noise=0.05, t=T, seed=3, start=(1.5, -0.8)):
    speeds = SHAPES @ [*Z, *start] + np.random.default_rng(seed).normal(0, noise, T.size)
    return Trace(file="trace.csv", t=t, speeds={"phid": speeds[: t.size]}, unit="rad/s", inputs={})


def least_squares(speeds, shapes=SHAPES):
    """Best values, their covariance and the standard deviation of what is left, as every textbook has them."""
    best, squares, *_ = np.linalg.lstsq(shapes, speeds, rcond=None)
    variance = float(squares[0]) / (len(speeds) - shapes.shape[1])
    return best, variance * np.linalg.inv(shapes.T @ shapes), math.sqrt(variance)


@pytest.fixture(scope="module")
def found():
    return identify(motion(), trace())


def test_values_errors_and_intervals_are_those_of_linear_least_squares(found):
    best, covariance, noise = least_squares(trace().speeds["phid"])
    errors = np.sqrt(np.diag(covariance))
    wide = student.ppf(0.975, T.size - 4)
    for i, one in enumerate(found.estimates):
        assert (one.name, one.unit) == (("z1", "N"), ("z2", "m"))[i]
        assert one.value == pytest.approx(best[i], rel=1e-5)
        assert one.error == pytest.approx(errors[i], rel=1e-5)
        assert one.low == pytest.approx(best[i] - wide * errors[i], rel=1e-4)
        assert one.high == pytest.approx(best[i] + wide * errors[i], rel=1e-4)
    assert found.correlation == pytest.approx((covariance / np.outer(errors, errors))[:2, :2], abs=1e-5)
    assert found.noise == pytest.approx(noise, rel=1e-6)
    assert found.fitted["phid"] == pytest.approx(SHAPES @ best, abs=1e-5)
    assert found.measured["phid"] == pytest.approx(trace().speeds["phid"])
    rest = trace().speeds["phid"] - SHAPES @ best
    assert found.durbin_watson == pytest.approx(np.sum(np.diff(rest) ** 2) / np.sum(rest**2), rel=1e-4)
    assert (found.status, found.samples, found.unit, found.doubts) == ("found", T.size, "rad/s", ())


def test_rounding_has_errors_and_no_profile():
    clean = identify(motion(), trace(noise=0.0))
    for one, truth in zip(clean.estimates, Z, strict=True):
        assert one.value == pytest.approx(truth, rel=1e-6)
        wide = student.ppf(0.975, T.size - 4) * one.error
        assert (one.low, one.high) == pytest.approx((one.value - wide, one.value + wide), rel=1e-12)
    assert clean.doubts == ()


@pytest.mark.parametrize("turning", [True, False])
def test_an_interval_is_half_a_radian_of_the_fastest_motion(turning):
    # swinging by W, and turning by twice the largest speed where the coordinate is an angle
    measured = trace()
    fastest = 2 * np.abs(measured.speeds["phid"]).max() if turning else W
    found = identify(motion(turning=turning), measured)
    assert found.intervals == math.ceil(T[-1] * fastest / 0.5)


def test_a_least_value_holds_a_parameter_and_the_others_do_their_best():
    speeds = trace().speeds["phid"]
    best, covariance, _ = least_squares(speeds)
    least = best[0] + 4 * math.sqrt(covariance[0, 0])
    held = identify(motion(low=(least, -np.inf)), trace())
    rest, *_ = np.linalg.lstsq(SHAPES[:, 1:], speeds - least * SHAPES[:, 0], rcond=None)
    assert [one.value for one in held.estimates] == pytest.approx([least, rest[0]], rel=1e-5)
    assert ("bound", "z1") in {(doubt.code, doubt.quantity) for doubt in held.doubts}


def test_an_interval_does_not_reach_below_the_least_value():
    best, covariance, _ = least_squares(trace().speeds["phid"])
    error = math.sqrt(covariance[0, 0])
    near = identify(motion(low=(best[0] - error, -np.inf)), trace())
    one = near.parameters["z1"]
    assert one.low == pytest.approx(best[0] - error, rel=1e-6)
    assert one.high == pytest.approx(best[0] + student.ppf(0.975, T.size - 4) * error, rel=1e-4)
    assert [doubt.code for doubt in near.doubts] == ["open"]


def test_only_a_combination_is_refused_by_name():
    with pytest.raises(BadInput, match="does not determine z1, z2:"):
        identify(motion(lambda z, w: (z[0] + 3 * z[1]) * w[0]), trace())
    with pytest.raises(BadInput, match="no motion shows z2:"):
        identify(motion(lambda z, w: z[0] * w[0]), trace())


def test_ten_samples_for_each_unknown_are_enough():
    # two parameters, an angle and a speed at the start
    with pytest.raises(BadInput, match="39 samples for 4 unknowns"):
        identify(motion(), trace(t=T[:39]))
    assert identify(motion(), trace(t=T[:40])).samples == 40


def test_an_angle_that_no_speed_shows_is_no_unknown():
    # a rotor without a spring: u = z1 t^2 / 2 + z2 t^3 / 3 + u0, wherever it started
    shapes = np.column_stack([T**2 / 2, T**3 / 3, np.ones_like(T)])
    speeds = shapes @ [*Z, 1.5] + np.random.default_rng(5).normal(0, 0.05, T.size)
    measured = dataclasses.replace(trace(), speeds={"phid": speeds})
    found = identify(motion(stiffness=0.0, turning=False), measured)
    best, covariance, noise = least_squares(speeds, shapes)
    assert [one.value for one in found.estimates] == pytest.approx(list(best[:2]), rel=1e-5)
    assert [one.error for one in found.estimates] == pytest.approx(list(np.sqrt(np.diag(covariance))[:2]), rel=1e-5)
    assert found.noise == pytest.approx(noise, rel=1e-6)
    few = dataclasses.replace(measured, t=T[:29], speeds={"phid": speeds[:29]})
    with pytest.raises(BadInput, match="29 samples for 3 unknowns"):
        identify(motion(stiffness=0.0, turning=False), few)


def drift(count):
    """One step of 2 in the middle."""
    return np.repeat([1.0, -1.0], count // 2)[None, :]


def test_the_statistic_of_what_is_left_over():
    assert durbin_watson(np.array([[1.0, -1.0, 1.0, -1.0]])) == 3.0
    assert durbin_watson(np.array([[1.0, 1.0], [2.0, 2.0]])) == 0.0  # speeds are not one row
    any_trace = trace()
    for count in (64, 256):  # alternating pairs miss 2 by next to nothing, a drift by all of it
        white = np.tile([1.0, 1.0, -1.0, -1.0], count // 4)[None, :]
        assert white_noise(white, any_trace) and not white_noise(drift(count), any_trace)
    assert white_noise(1e-7 * drift(64), any_trace)  # rounding


def estimate(**changes):
    usual = Estimate(name="m", value=2.0, error=0.1, low=1.8, high=2.2, unit="kg")
    return dataclasses.replace(usual, **changes)


@pytest.mark.parametrize(
    ("changes", "code"),
    [
        ({}, None),
        ({"low": 0.1, "high": 2.05}, None), ({"low": 0.1, "high": 4.2}, "loose"),
        ({"value": -2.0, "low": -4.2, "high": -0.1}, "loose"),
        ({"high": math.inf}, "open"), ({"low": -math.inf}, "open"), ({"low": -5.0}, "open"),
        ({"value": -5.0}, "bound"), ({"value": -5.0 + 1e-8}, "bound"),
        ({"name": "friction.constant", "value": -2.0, "low": -2.2, "high": -1.8}, "drives"),
        ({"name": "friction.constant", "value": -0.5, "low": -0.9, "high": 0.1}, None),
    ],
)  # fmt: skip
def test_what_is_doubted_of_an_estimate(changes, code):
    white = np.tile([1.0, 1.0, -1.0, -1.0], 30)[None, :]
    told = doubts(white, trace(), (estimate(**changes),), np.array([-5.0]), 1)
    assert [doubt.code for doubt in told] == ([code] if code else [])


def test_what_is_doubted_of_what_is_left_over():
    white = np.tile([1.0, 1.0, -1.0, -1.0], 64)[None, :]
    spiked = white.copy()
    spiked[0, 100] = 7.0  # of a standard deviation a little above 1
    assert [d.code for d in doubts(spiked, trace(), (), np.array([]), 1)] == ["outlier"]
    assert [d.code for d in doubts(white, trace(), (), np.array([]), 2)] == ["ambiguous"]
    (told,) = doubts(drift(400), trace(), (), np.array([]), 1)
    assert (told.code, told.value, told.usual) == ("residuals", 4 / 400, "1.70 to 2.30")


def test_a_grid_is_exact_for_the_polynomials_of_its_degree():
    t = np.linspace(1.0, 4.0, 31)
    points = grid(t, (2.0, 9.0), 0.6)
    assert points.edges == pytest.approx([1, 1.5, 2, 2.5, 3, 3.5, 4])
    starts = points.edges[:-1, None]
    at = np.column_stack([starts, points.nodes.reshape(6, 5)]).ravel()  # a start and five nodes an interval
    value, slope = at**5 - 3 * at**2, 5 * points.nodes**4 - 6 * points.nodes
    assert value @ points.samples == pytest.approx(t**5 - 3 * t**2, rel=1e-10)
    _, slopes, end = legendre()
    value, slope = value.reshape(6, 6), slope.reshape(6, 5)
    assert value @ slopes == pytest.approx(slope * points.lengths[:, None], rel=1e-9, abs=1e-9)
    assert value[:-1] @ end == pytest.approx(value[1:, 0], abs=1e-9)


def test_a_motion_half_a_turn_on_explains_as_much_with_the_other_sign():
    # phi'' = z cos phi: phi + pi and -z give the same speed, so the interval holds both
    x, w, z = ca.SX.sym("x", 2), ca.SX.sym("w", 2), ca.SX.sym("z", 1)
    model = dataclasses.replace(
        motion(), rate=ca.Function("rate", [x, w, z], [ca.vertcat(x[1], z[0] * ca.cos(x[0]))]),
        names=("z1",), units=("N",), start=np.array([0.1]), size=np.array([1.0]), low=np.array([-np.inf]),
    )  # fmt: skip
    t = np.linspace(0, 4, 81)
    run = solve_ivp(lambda _, y: [y[1], 1.5 * math.cos(y[0])], (0, 4), [0.3, 2.0], t_eval=t, rtol=1e-10, atol=1e-10)
    noise = np.random.default_rng(5).normal(0, 0.02, t.size)
    found = identify(model, Trace(file="t.csv", t=t, speeds={"phid": run.y[1] + noise}, unit="rad/s", inputs={}))
    one = found.parameters["z1"]
    assert abs(one.value) == pytest.approx(1.5, rel=0.02)
    assert one.high == pytest.approx(-one.low, rel=1e-2)
    assert one.high == pytest.approx(abs(one.value) + student.ppf(0.975, t.size - 3) * one.error, rel=1e-2)
    ambiguous, loose = found.doubts
    assert (ambiguous.code, ambiguous.value) == ("ambiguous", 2.0)
    assert (loose.code, loose.value) == ("loose", pytest.approx((one.high - one.low) / abs(one.value)))


def test_ends_of_a_bent_interval_are_those_of_the_straight_one():
    # the model is straight in the cube of z1, so the interval of z1 ends at the cube roots of the ends of that one
    bent = identify(motion(lambda z, w: z[0] ** 3 * w[0] + z[1] * w[1]), trace(noise=0.6))
    best, covariance, _ = least_squares(trace(noise=0.6).speeds["phid"])
    wide = student.ppf(0.975, T.size - 4) * math.sqrt(covariance[0, 0])
    one = bent.parameters["z1"]
    assert one.value == pytest.approx(np.cbrt(best[0]), rel=1e-5)
    for end, sign in ((one.low, -1), (one.high, 1)):
        assert end**3 == pytest.approx(best[0] + sign * wide, abs=0.025 * wide)


def test_a_start_walks_off_by_two_standard_errors(monkeypatch):
    steps = []
    monkeypatch.setattr("mechsym.optimise.identify.pulled", lambda task, here, number, step: steps.append(step))
    slopes = SHAPES[:, :3]
    best = SimpleNamespace(slopes=slopes, rest=np.zeros(T.size), left=T.size * 1e-4)  # a variance of 1e-4
    assert list(_behind(SimpleNamespace(spent=False), best, 2)) == []
    error = 1e-2 * math.sqrt(np.linalg.inv(slopes.T @ slopes)[2, 2])
    assert steps == pytest.approx([2 * error, -2 * error])
    best = SimpleNamespace(slopes=slopes, rest=np.zeros(T.size), left=T.size * 1e4)
    assert list(_behind(SimpleNamespace(spent=False), best, 2)) == []
    assert steps[2:] == [0.25, -0.25]  # and never by more than a quarter of a radian


def test_a_fit_is_forecast_by_the_numbers_of_its_linear_system(monkeypatch):
    # a column for each of two parameters, for angle and speed at the start, and for what is measured
    asked = []
    monkeypatch.setattr(budget, "require", lambda what, seconds, size, way_out: asked.append([seconds, size]))
    x, w, z = ca.SX.sym("x", 2), ca.SX.sym("w", 2), ca.SX.sym("z", 1)
    fewer = dataclasses.replace(
        motion(turning=False), names=("z1",), units=("N",), start=np.array([0.5]), size=np.array([0.7]),
        low=np.array([-np.inf]), rate=ca.Function("rate", [x, w, z], [ca.vertcat(x[1], z[0] * w[0] - W**2 * x[0])]),
    )  # fmt: skip
    for model, t in ((motion(turning=False), T), (motion(turning=False), T[:61]), (fewer, T)):
        identify(model, trace(t=t))
    assert np.divide(asked[0], asked[1]) == pytest.approx([2.0, 2.0])
    assert np.divide(asked[0], asked[2]) == pytest.approx([5 / 4, 5 / 4])


def test_fits_are_one_where_they_start_at_one_angle_or_have_the_same_parameters():
    def fit(angle, theta):
        states = np.array([[angle, 9.0], [5.0, 7.0]])
        return SimpleNamespace(states=states, theta=np.array([theta]), status="converged", left=1.0)

    def count(angle, theta):
        return len(_alike([fit(0.3, 1.0), fit(angle, theta)], 1.0, np.array([0.1])))

    assert (count(0.3 + 2 * math.pi, 2.0), count(0.4, 2.0), count(1.3, 1.001)) == (1, 1, 1)
    assert (count(1.3, 2.0), count(0.3 + math.pi, 1.1)) == (2, 2)


def drawn(result, monkeypatch, tmp_path):
    figures = []
    monkeypatch.setattr(shown, "write_picture", lambda path, figure: figures.append(figure) or path)
    assert shown.trace_picture(tmp_path / "trace.svg", result) == tmp_path / "trace.svg"
    plt.close(figures[0])
    return figures[0].axes


def points(axis):
    return {line.get_label(): line.get_xydata() for line in axis.lines}


def test_speeds_are_drawn_in_the_unit_of_their_axis(found, monkeypatch, tmp_path):
    left, right = drawn(found, monkeypatch, tmp_path)
    assert (left.get_ylabel(), right.get_ylabel()) == ("speed [rpm]", "measured less fitted [rpm]")
    rpm, lines = 30 / np.pi, points(left)
    assert lines["measured"] == pytest.approx(np.column_stack([T, found.measured["phid"] * rpm]))
    assert lines["fitted"] == pytest.approx(np.column_stack([T, found.fitted["phid"] * rpm]))
    (rest,) = points(right).values()
    assert rest == pytest.approx(np.column_stack([T, (found.measured["phid"] - found.fitted["phid"]) * rpm]))
    assert {axis.get_xlabel() for axis in (left, right)} == {"time [s]"}


def test_several_speeds_are_told_apart(found, monkeypatch, tmp_path):
    speeds, model = ({"phid": v["phid"], "psid": 2 * v["phid"]} for v in (found.measured, found.fitted))
    left, right = drawn(dataclasses.replace(found, measured=speeds, fitted=model), monkeypatch, tmp_path)
    assert list(points(left)) == ["phi measured", "phi fitted", "psi measured", "psi fitted"]
    assert list(points(right)) == ["phi", "psi"]
    assert len({line.get_color() for line in right.lines}) == 2


def test_rounding_is_no_picture(found, monkeypatch, tmp_path):
    left, right = drawn(dataclasses.replace(found, noise=1e-14), monkeypatch, tmp_path)
    assert not right.lines
    assert [text.get_text() for text in right.texts] == ["0 to round-off"]
    assert right.get_xlim() == left.get_xlim()
