"""Sweeps: axes as written, keys against the case, grids and samples, gaps with reasons, interrupts, single runs."""

import math
import shutil
import signal
import time

import numpy as np
import pytest

from mechsym import cases
from mechsym.errors import BadInput
from mechsym.jobs.problem import problem_of
from mechsym.simulate import Settings, simulate
from mechsym.sweep import Plan, columns, failures, layout, points, sweep, work
from mechsym.sweep.axes import override, parse_axis
from mechsym.sweep.axes import points as points_of

SHORT = {"simulation.t_end": "3", "simulation.window": "1"}
ENGINE = "nunes-slider-crank"


def axis_of(text, case="chmielewski"):
    return parse_axis(text, cases.locate(case, text.partition("=")[0]))


@pytest.mark.parametrize(
    "case, text, kind, unit, values",
    [
        ("zotov-89", "spring.p0=3..8 MPa:6", "grid", "MPa", (3, 4, 5, 6, 7, 8)),
        ("zotov-89", "spring.p0=3..8MPa:2", "grid", "MPa", (3, 8)),
        ("zotov-89", "spring.p0= 3 MPa .. 8 MPa : 2", "grid", "MPa", (3, 8)),
        ("zotov-89", "speed_rpm=89,142", "grid", "rpm", (89, 142)),
        ("zotov-89", "operation.speed=9,10", "grid", "rad/s", (9, 10)),
        ("zotov-89", "p0=3,5,8 MPa", "grid", "MPa", (3, 5, 8)),
        ("zotov-89", "simulation.hinge=designed,none", "grid", "", ("designed", "none")),
        ("zotov-89", "spring.n=1.2..1.3", "even", "-", (1.2, 1.3)),
        ("chmielewski", "c1=1e-1..+.5:3", "grid", "N*m*s/rad", (0.1, 0.3, 0.5)),
        ("chmielewski", "c1=5..1:2", "grid", "N*m*s/rad", (5, 1)),
        ("chmielewski", "k1=6500+-200 N*m/rad", "normal", "N*m/rad", (6500, 200)),
        ("chmielewski", "k1=6.5+-.2 kN*m/rad", "normal", "kN*m/rad", (6.5, 0.2)),
        (ENGINE, "pistons=1,2", "grid", "-", (1, 2)),
    ],
)
def test_axes_as_written(case, text, kind, unit, values):
    axis = axis_of(text, case)
    assert (axis.key, axis.kind, axis.unit) == (text.partition("=")[0].strip(), kind, unit)
    assert axis.values == (values if isinstance(values[0], str) else pytest.approx(values))


@pytest.mark.parametrize(
    "text, words",
    [
        ("c1", "KEY=RANGE"),
        ("=1..2:3", "KEY=RANGE"),
        ("c1=", "KEY=RANGE"),
        ("c1=a..b:3", "takes numbers, as a list or a range; .* c1=1..5 N[*]m[*]s/rad:9"),
        ("c1=1,x", "takes numbers"),
        ("c1=1..2:1.5", "takes numbers"),
        ("c1=1..2:-1", "takes numbers"),
        ("c1=1..2:0", "0 values; allowed are 1 to 1000000"),
        ("c1=1..2:99999999999", "99999999999 values; allowed are 1 to"),
        ("c1=nan,2", "takes numbers"),
        ("c1=1e999,2", "not finite"),
        ("c1=3+-0", "standard deviation 0 .* must be > 0"),
        ("m0=1 kg,1000 g", "write all values in one unit"),
        ("m0=1..2 m:3", "wrong dimension; give it in kg"),
        ("m0=1..2 stone:3", "'stone' is not known; units are"),
        ("drive.time_ms=1..2 s:3", "the key names ms; leave it away"),
        ("simulation.backend=auto,,native", "a word is empty"),
        ("simulation.backend=auto,auto", "stands twice"),
    ],
)
def test_bad_axes_say_how_to_write_them(text, words):
    with pytest.raises(BadInput, match=f"--over.*{words}"):
        layout(Plan(case="chmielewski", over=(text,)))


@pytest.mark.parametrize(
    "over, overrides, words",
    [
        (("no_such=1,2",), {}, "--over no_such is not known"),
        (("drive.torqe=1,2",), {}, "--over drive.torqe is not known; did you mean 'torque'"),
        (("spring.p0=1,2",), {}, r"--over spring.p0: no section \[spring\]"),
        (("c1=1,2", "parameters.c1=3,4"), {}, "--over c1 and --over parameters.c1 give the same value parameters.c1"),
        (("c1=1,2",), {"parameters.c1": "3"}, "--set parameters.c1 and --over c1 give the same value"),
        (("c1=1,2",), {"no_such": "3"}, "--set no_such is not known"),
    ],
)
def test_keys_are_found_before_anything_runs(monkeypatch, over, overrides, words):
    monkeypatch.setattr("mechsym.sweep.run.route", lambda *_: pytest.fail("ran"))
    with pytest.raises(BadInput, match=words):
        layout(Plan(case="chmielewski", over=over, overrides=overrides))


def test_values_go_back_with_their_unit():
    axis = axis_of("p0=0.1..0.3 MPa:3", "zotov-89")
    assert [override(axis, v) for v in axis.values] == ["0.1 MPa", "0.2 MPa", "0.3 MPa"]
    assert override(axis_of("speed_rpm=89,90", "zotov-89"), 89.0) == 89.0


def test_a_section_that_the_case_leaves_out():
    found = layout(Plan(case="zotov-89", over=("trials.turns=2,3",)))
    assert (found.axes[0].unit, found.points) == ("-", ((2.0,), (3.0,)))


def test_units_mean_the_same_value():
    plans = [
        ("speed_rpm=80,89",),
        ("operation.speed=80,89 rpm",),
        (f"speed={80 * math.pi / 30!r},{89 * math.pi / 30!r}",),
    ]
    first, *others = [columns(sweep(Plan(case="zotov-89", over=over, analysis="cycle"))) for over in plans]
    for other in others:
        np.testing.assert_allclose(other["power_kw"], first["power_kw"], rtol=1e-12)


def test_grid_runs_the_last_axis_fastest():
    found = layout(Plan(case="chmielewski", over=("c1=1,2", "m0=3..5:3")))
    assert found.dims == {"c1": 2, "m0": 3}
    assert found.points == ((1, 3), (1, 4), (1, 5), (2, 3), (2, 4), (2, 5))


def test_samples_have_the_wanted_distribution():
    axes = (axis_of("c1=2..6"), axis_of("m0=10+-0.5"))
    dims, found = points_of(axes, 1000, 3)
    a, b = np.array(found).T
    assert dims == {"sample": 1000}
    assert (a.min() > 2, a.max() < 6) == (True, True)
    assert a.mean() == pytest.approx(4, abs=0.01)
    assert (b.mean(), b.std()) == (pytest.approx(10, abs=0.01), pytest.approx(0.5, abs=0.01))
    assert found == points_of(axes, 1000, 3)[1]
    assert found != points_of(axes, 1000, 4)[1]
    assert len(points_of(axes, 1, 0)[1]) == 1


@pytest.mark.parametrize(
    "over, samples, words",
    [
        (("c1=1..2",), None, "say how many"),
        (("c1=1+-2",), None, "say how many"),
        (("c1=1..2:5",), 10, "give a range"),
        (("simulation.backend=auto,native",), 10, "give a range"),
        ((), None, "at least one key"),
        (("c1=1..2",), 0, "allowed are 1"),
        (("c1=1..2",), 2_000_000, "allowed are 1"),
        (("c1=0..1:5000", "m0=0..1:5000"), None, "25000000 points"),
    ],
)
def test_what_cannot_be_run_over_is_refused(over, samples, words):
    with pytest.raises(BadInput, match=words):
        layout(Plan(case="chmielewski", over=over, samples=samples))


@pytest.mark.parametrize(
    "given, words", [({"analysis": "weigh"}, "simulate, hinge, guides, cycle"), ({"seed": -1}, "seed = -1")]
)
def test_plans_are_checked(given, words):
    with pytest.raises(BadInput, match=words):
        Plan(case="chmielewski", over=("c1=1,2",), **given)


def test_simulations_are_those_of_single_runs():
    found = sweep(Plan(case="chmielewski", over=("c1=0,1", "drive.torque=1.5,3"), overrides=SHORT))
    assert (found.analysis, found.dims) == ("simulate", {"c1": 2, "drive.torque": 2})
    data = columns(found)
    for i, (c1, torque) in enumerate(found.points):
        alone = cases.load("chmielewski", {**SHORT, "c1": c1, "drive.torque": torque})
        result = simulate(problem_of(alone), Settings())
        assert data["energy.work.drive"][i] == pytest.approx(result.energy.work["drive"], rel=1e-9)
    assert data["status"].tolist() == ["converged"] * 4
    assert failures(found) == {}


def test_an_elastic_shaft_reports_its_twist():
    found = sweep(Plan(case="alpha-stirling", over=("parameters.c=5,10",), overrides={"simulation.turns": "3"}))
    data = columns(found)
    assert found.analysis == "simulate"
    peaks = [name for name in data if name.startswith("twist.") and name.endswith(".twist_peak")]
    assert data["twist_peak"].tolist() == np.max([data[name] for name in peaks], axis=0).tolist()
    # a stronger damper leaves less twist
    assert data["twist_peak"][1] < data["twist_peak"][0]


def test_settings_may_be_an_axis():
    over = (
        "simulation.tolerance=1e-6,1e-10",
        "simulation.backend=auto,scipy-rk45",
        "simulation.difference_allowed=0.1",
    )
    found = sweep(Plan(case="chmielewski", over=over, overrides=SHORT))
    assert failures(found) == {}
    steps = columns(found)["steps"].reshape(2, 2)
    assert np.all(steps[1] > steps[0])


def test_points_that_fail_are_gaps_with_reasons():
    found = sweep(Plan(case="chmielewski", over=("m0=-1,1.1",), overrides=SHORT))
    assert list(failures(found)) == [0]
    assert "m0 = -1" in failures(found)[0]
    speed = columns(found)["speed_mean"]
    assert math.isnan(speed[0]) and speed[1] > 0


def test_runs_that_differ_from_their_check_are_gaps():
    found = sweep(Plan(case="chmielewski", over=("simulation.difference_allowed=1e-16,1e-4",), overrides=SHORT))
    assert list(failures(found)) == [0]
    assert failures(found)[0].startswith("chaotic: the runs at the two tolerances part")
    assert np.isnan(columns(found)["speed_mean"]).tolist() == [True, False]
    assert columns(found)["status"].tolist() == ["", "converged"]


@pytest.mark.parametrize("where", ["problem_of", "simulate_many"])
def test_errors_of_arithmetic_are_gaps_of_their_points(monkeypatch, where):
    def spoiled(case, kept):
        if case.need("parameters").c1 == 1:
            raise ZeroDivisionError("no such machine")
        return problem_of(case, kept)

    def upset(problems, settings):
        raise RuntimeError("one of many")

    if where == "problem_of":
        monkeypatch.setattr("mechsym.jobs.problem.problem_of", spoiled)
    else:
        monkeypatch.setattr("mechsym.simulate.simulate_many", upset)
    found = sweep(Plan(case="chmielewski", over=("c1=0,1,2",), overrides=SHORT))
    assert failures(found) == ({1: "ZeroDivisionError: no such machine"} if where == "problem_of" else {})


def test_mistakes_of_the_program_are_not_gaps(monkeypatch):
    def mistaken(case, kept):
        raise TypeError("a mistake")

    monkeypatch.setattr("mechsym.jobs.problem.problem_of", mistaken)
    with pytest.raises(TypeError, match="a mistake"):
        sweep(Plan(case="chmielewski", over=("c1=0,1",), overrides=SHORT))


@pytest.mark.parametrize(
    "plan, words",
    [
        (Plan(case="chmielewski", over=("c1=1,2",), analysis="hinge"), r"section \[spring\] is missing"),
        (Plan(case="chmielewski", over=("c1=1,2",), analysis="cycle"), r"section \[cycle\] is missing"),
        (Plan(case="moroianu", over=("bore=0.5,0.52",), analysis="codesign"), "this kind of engine has no hinge"),
        (Plan(case="no-such-case", over=("c1=1,2",)), "no-such-case"),
    ],
)
def test_what_fails_everywhere_for_one_reason_is_bad_input(plan, words):
    with pytest.raises(BadInput, match=words):
        sweep(plan)


def test_unknown_results_are_refused_early():
    with pytest.raises(BadInput, match="--show speed_men is no result here; did you mean 'speed_mean'"):
        sweep(Plan(case="chmielewski", over=("c1=0,1",), overrides=SHORT, show=("speed_men",)))


@pytest.mark.parametrize(
    "number, default", [(signal.SIGINT, signal.default_int_handler), (signal.SIGTERM, signal.SIG_DFL)]
)
def test_a_signal_ends_the_sweep_after_the_points_under_way(number, default):
    plan = Plan(case="zotov-89", over=("spring.p0=5,6,7,8 MPa",), analysis="cycle")
    done = []

    def progress(count):
        done.append(count)
        if len(done) == 2:
            signal.raise_signal(number)

    # a process in the background ignores interrupts
    usual = signal.signal(number, default)
    try:
        found = sweep(plan, progress)
        assert signal.getsignal(number) is default
    finally:
        signal.signal(number, usual)
    assert found.interrupted and len(done) == 2
    assert failures(found) == {2: "interrupted", 3: "interrupted"}


def test_an_interrupt_in_the_last_points_is_not_forgotten():
    usual = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        plan = Plan(case="zotov-89", over=("spring.p0=5,6 MPa",), analysis="cycle")
        found = sweep(plan, lambda count: signal.raise_signal(signal.SIGINT))
    finally:
        signal.signal(signal.SIGINT, usual)
    assert found.interrupted and set(failures(found)) <= {1}


@pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="timers of processes are POSIX")
def test_points_that_take_long_are_interrupted(monkeypatch):
    def slow(*_):
        signal.raise_signal(signal.SIGINT)
        time.sleep(60)

    monkeypatch.setattr(work, "tied", slow)
    usual = signal.signal(signal.SIGINT, signal.default_int_handler)
    began = time.monotonic()
    try:
        found = sweep(Plan(case="zotov-89", over=("spring.p0=5,6 MPa",), analysis="cycle"))
    finally:
        signal.signal(signal.SIGINT, usual)
    assert found.interrupted and len(failures(found)) == 2 and time.monotonic() - began < 30


def test_an_interrupt_keeps_what_is_finished(monkeypatch):
    monkeypatch.setattr(points, "_LANES", 1)
    done = []

    def progress(count):
        done.append(count)
        if len(done) == 2:
            raise KeyboardInterrupt

    found = sweep(Plan(case="chmielewski", over=("c1=0,1,2,3",), overrides=SHORT), progress)
    assert found.interrupted
    assert failures(found) == {2: "interrupted", 3: "interrupted"}
    assert np.isfinite(columns(found)["speed_mean"]).tolist() == [True, True, False, False]


def test_progress_counts_every_point():
    done = []
    sweep(Plan(case="chmielewski", over=("c1=-1..1:42",), overrides=SHORT), done.append)
    assert sum(done) == 42


@pytest.mark.skipif(not any(map(shutil.which, ("gcc", "clang", "cc"))), reason="no C compiler to hide")
def test_without_a_compiler(monkeypatch, tmp_path):
    plan = Plan(case="chmielewski", over=("c1=0,1",), overrides=SHORT)
    compiled = columns(sweep(plan))
    monkeypatch.delenv("CC", raising=False)
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    plain = columns(sweep(plan))
    np.testing.assert_allclose(plain["speed_mean"], compiled["speed_mean"], rtol=1e-8)
    assert np.any(plain["steps"] != compiled["steps"])
