"""Traces of a wrong unit, of another machine or too long are refused before the fit, those that are right are taken."""

import time

import numpy as np
import pytest
from click.testing import CliRunner
from hand import write_trace

from mechsym import budget
from mechsym.cli import mechsym
from mechsym.errors import BadInput

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
