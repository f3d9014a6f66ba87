"""Traces of a wrong unit, of another machine or too long are refused before the fit, those that are right are taken."""

import time
from types import SimpleNamespace

import numpy as np
import pytest
from click.testing import CliRunner
from hand import write_trace

from mechsym import budget
from mechsym.cli import mechsym
from mechsym.errors import BadInput
from mechsym.optimise import preview

SLIPS = [
    ({"time": 1000}, "ms under"),
    ({"time": 1e6}, "ms under"),
    ({"speed": 57.29578}, "deg/s under"),
    ({"head": "phi0d [rpm]"}, "rad/s under .rpm"),
    ({"speed": 9.549297}, "rpm under .rad/s"),
    ({"speed": 0.0174533}, "rad/s under .deg/s"),
    ({"speed": -1}, "the other sign"),
    ({"speed": -1, "time": 0.001}, "another machine|wrong unit|under|the other sign"),
]


def fit(trace, *more):
    return CliRunner().invoke(mechsym, ["identify", "chmielewski", "--trace", str(trace), "--free", "I2,k1", *more])


@pytest.mark.parametrize(("done", "words"), SLIPS, ids=str)
def test_a_wrong_unit_is_refused_at_once_with_the_slip_that_explains_it(done, words, tmp_path):
    write_trace(done, tmp_path / "t.csv")
    began = time.process_time()
    answer = fit(tmp_path / "t.csv")
    assert isinstance(answer.exception, BadInput)
    assert time.process_time() - began < 5
    with pytest.raises(BadInput, match=words):
        raise answer.exception


def test_a_file_of_millions_of_samples_is_refused_before_it_is_read(tmp_path):
    with (tmp_path / "t.csv").open("wb") as file:
        file.truncate(300_000_000)
    began = time.process_time()
    with pytest.raises(BadInput, match=r"300 MB; at most 20 MB are read"):
        raise fit(tmp_path / "t.csv").exception
    assert time.process_time() - began < 1


def test_a_fit_beyond_its_budget_does_not_begin(tmp_path):
    write_trace({}, tmp_path / "t.csv")
    with pytest.raises(BadInput, match=r"a fit over about .* intervals takes .* --budget"):
        raise fit(tmp_path / "t.csv", "--budget", "1 s").exception


def test_a_long_text_begins_only_where_its_budget_holds(tmp_path):
    text = tmp_path / "long.md"
    text.write_text("$$y = m x$$\n" * 2000)
    with pytest.raises(BadInput, match=r"2000 equations takes about 2.3 min; 1 min .* or say --budget"):
        raise CliRunner().invoke(mechsym, ["audit", str(text), "--budget", "1 min"]).exception


@pytest.mark.parametrize("words", [["audit", "--source", "zotov2024"], ["audit"], ["optimise", "nunes-hypocycloid"]])
def test_sources_and_designs_beyond_their_budget_do_not_begin(words):
    with pytest.raises(BadInput, match=r"takes about .* --budget"):
        raise CliRunner().invoke(mechsym, [*words, "--budget", "1 s"]).exception


@pytest.mark.parametrize(("text", "fits"), [("", False), ("2 h", False), ("2 h, 8 GB", True), ("8 GB, 120 min", True)])
def test_a_budget_is_a_time_a_memory_or_both(text, fits):
    budget.choose(text)
    try:
        budget.require("it", 3600.0, 4e9, "make it smaller")
    except BadInput:
        assert not fits
    else:
        assert fits
    finally:
        budget.choose("")


@pytest.mark.parametrize("text", ["0 s", "8 km", "-1 GB", "much"])
def test_what_is_no_budget_is_refused(text):
    with pytest.raises(BadInput):
        budget.choose(text)


def test_the_energy_of_a_run_down_is_not_asked_of_friction_that_is_looked_for(tmp_path):
    t = np.linspace(0, 4, 401)
    rows = np.column_stack([t, 20 - 2 * t])
    np.savetxt(tmp_path / "t.csv", rows, delimiter=",", header="t [s],phi0d [rad/s]", comments="")
    words = ["identify", "chmielewski", "--trace", str(tmp_path / "t.csv"), "--free", "friction.constant"]
    still = ["--set", "drive.torque=0", "--set", "drive.time=0", "--set", "m0=0.001"]
    answer = CliRunner().invoke(mechsym, [*words, *still, "--json"])
    assert answer.exception is None or not isinstance(answer.exception, BadInput), answer.exception


def ratio_of(kinetic, power, monkeypatch, lossy=False):
    """Of a machine of a given kinetic energy and power at even times from 0 to 2 s."""
    t = np.linspace(0.0, 2.0, len(power))
    monkeypatch.setattr(preview, "followed", lambda *_: None)
    model = SimpleNamespace(
        known=lambda _: None, energy=lambda *_: (np.array([kinetic]), np.array([power])), start=np.zeros(1), lossy=lossy
    )
    return preview._ratio(model, SimpleNamespace(t=t), 0.0)


def test_energy_is_held_against_the_work_of_what_is_known(monkeypatch):
    t = np.linspace(0.0, 2.0, 400)
    late = np.clip(40 * (t - 1), 0, 10)  # 10 J gained, none of it within the ends that are averaged
    hump = np.where((t > 0.5) & (t < 1.5), 5.0, 0.0)  # 5 J of work
    assert ratio_of(late, hump, monkeypatch) == pytest.approx(2.0, rel=5e-3)
    assert ratio_of(10 - late, -hump, monkeypatch) == pytest.approx(2.0, rel=5e-3)
    assert ratio_of(late, -hump, monkeypatch) == pytest.approx(-2.0, rel=5e-3)
    assert ratio_of(late, 100 * hump, monkeypatch) == pytest.approx(0.02, rel=5e-3)


def test_what_tells_of_no_force_is_not_judged(monkeypatch):
    t = np.linspace(0.0, 2.0, 400)
    steady, swings = np.full_like(t, 10.0), 10 + 0.4 * np.sin(np.pi * t / 2)
    assert ratio_of(steady, np.zeros_like(t), monkeypatch) == 1.0
    assert ratio_of(swings, np.full_like(t, 1.0), monkeypatch) == 1.0  # 2 J of the 3 that would tell
    assert ratio_of(swings, np.full_like(t, np.nan), monkeypatch) == 1.0
    assert ratio_of(np.where(t > 1, np.inf, 1.0), np.ones_like(t), monkeypatch) == 1.0


def test_friction_that_is_looked_for_may_take_and_never_gives(monkeypatch):
    t = np.linspace(0.0, 2.0, 400)
    late, hump = np.clip(40 * (t - 1), 0, 10), np.where((t > 0.5) & (t < 1.5), 1.0, 0.0)
    assert ratio_of(10 - late, hump, monkeypatch, lossy=True) == 1.0
    assert ratio_of(late, hump, monkeypatch, lossy=True) == pytest.approx(10.0, rel=5e-3)
    assert ratio_of(late, 2 * hump, monkeypatch, lossy=True) == 1.0  # within six times
    assert ratio_of(late, 0 * hump, monkeypatch, lossy=True) == pytest.approx(10 / 0.3)


def test_of_several_poses_one_that_agrees_is_enough(monkeypatch):
    ratios = iter([-1.0, 20.0, 1.5])
    monkeypatch.setattr(preview, "_ratio", lambda *_: next(ratios))
    model = SimpleNamespace(velocities=("phid",), turning=(True,), low=np.zeros(1))
    trace = SimpleNamespace(t=np.linspace(0, 1, 100), speeds={"phid": None}, file="t.csv")
    preview.require_plausible(model, trace, [0.0, 1.0, 2.0], 0.01)
    with pytest.raises(BadInput, match=r"a sample every .* turns or swings once in 0.00628"):
        preview.require_plausible(model, trace, [0.0], 5e-4)


@pytest.mark.parametrize("number", ["10", "1.5", "1e3", "-3", "2 h, 8"])
def test_a_budget_without_a_unit_is_refused(number):
    with pytest.raises(BadInput, match=r"of what\? write --budget '.* min' or '.* GB'"):
        budget.choose(number)
