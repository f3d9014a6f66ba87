"""`mechsym hinge` on the marine engine: what the design must reach, its JSON, its exit status, its report."""

import json
import math
import re
import sys

import numpy as np
import pytest
from tables import read_table

from mechsym import cases
from mechsym.cli import main
from mechsym.files import plain
from mechsym.hinge import shown
from mechsym.hinge.guide import crank_torque
from mechsym.hinge.summary import HingeNumbers
from mechsym.jobs import hinge as design
from mechsym.quantities.results import tell

NAMES = ("zotov-89", "zotov-142")
KEYS = {
    "speed_rpm", "p_max_bar", "mep_bar", "load_torque", "hinge_torque_max", "hinge_torque_min", "hinge_torque_mean",
    "hinge_work_max", "hinge_work_min", "guide", "check", "retune", "flywheel_inertia_saved",
}  # fmt: skip
NESTED = {
    "guide": {
        "feasible", "reason", "rho_min", "rho_max", "z_min", "z_max", "pressure_angle_max", "curvature_radius_min",
        "roller_reaction_max",
    },
    "check": {"speed_ripple", "energy_residual"},
    "retune": {"speed_rpm", "p0", "speed_ripple"},
}  # fmt: skip


@pytest.fixture(scope="session")
def designs():
    """Each design once: it takes some seconds."""
    return {name: design(cases.load(name)) for name in NAMES}


@pytest.fixture(params=NAMES)
def designed(request, designs):
    return designs[request.param]


@pytest.fixture(scope="session")
def written(designs, tmp_path_factory):
    """Report and tables of one design."""
    folder = tmp_path_factory.mktemp("hinge")
    return {file.name: file for file in shown.write(designs["zotov-89"], folder)}


@pytest.fixture
def run(monkeypatch, capsys):
    """Exit status, JSON and standard error of a short `mechsym hinge zotov-89 --json`."""

    def hinge(*overrides):
        options = [word for text in ("trials.turns=4", *overrides) for word in ("--set", text)]
        monkeypatch.setattr(sys, "argv", ["mechsym", "hinge", "zotov-89", "--json", *options])
        with pytest.raises(SystemExit) as end:
            main()
        printed = capsys.readouterr()
        return end.value.code or 0, strict_json(printed.out), printed.err

    return hinge


def strict_json(text):
    def refuse(word):
        raise AssertionError(f"{word} is no JSON")

    return json.loads(text, parse_constant=refuse)


def assert_complete(numbers):
    assert numbers.keys() >= KEYS
    for key, inner in NESTED.items():
        assert numbers[key].keys() >= inner


def peak(hinge):
    return max(hinge.torque_max, -hinge.torque_min)


def test_work_of_a_turn_vanishes(designed):
    assert abs(designed.hinge.mean_torque) < 1e-9 * peak(designed.hinge)


def test_speed_stays_constant_under_both_loads(designed):
    runs = tell(HingeNumbers(judged=designed))["runs"]
    assert runs["hinge_constant"]["speed_ripple"] < 1e-6
    assert runs["hinge_propeller"]["speed_ripple"] < 1e-6
    assert runs["off_constant"]["speed_ripple"] > 1e-3
    assert all(abs(r["energy_residual"]) < 1e-8 for r in runs.values())


def test_without_hinge_and_flywheel_it_stops_within_a_turn(designed):
    event = tell(HingeNumbers(judged=designed))["runs"]["without"]["event"]
    assert event["name"] == "stall" and 0 < event["phi"] < 2 * math.pi and event["t"] > 0


def test_virtual_work_returns_the_torque(designed, rng):
    phi = rng.uniform(0, 2 * math.pi, 20_000)
    given = crank_torque(designed.guide, phi)
    assert np.abs(given - designed.hinge.torque(phi)).max() < 1e-8 * peak(designed.hinge)


def test_keys_and_numbers_of_the_interface(designed):
    numbers = tell(HingeNumbers(judged=designed))
    assert_complete(numbers)
    assert strict_json(json.dumps(plain(numbers), allow_nan=False)) == plain(numbers)
    assert numbers["guide"]["feasible"] and numbers["guide"]["margin"] > 0
    assert numbers["flywheel_inertia_saved"] > 1000


def test_the_other_speed_stands_beside_the_paper(designs):
    again = tell(HingeNumbers(judged=designs["zotov-89"]))["retune"]
    assert again["speed_rpm"] == pytest.approx(142)
    # the paper says about 2 and 1.9 for its own, unpublished diagrams
    assert 2 < again["torque_ratio_peak"] < 3
    assert 2 < again["p0_ratio"] < 3
    assert 0.01 < again["speed_ripple"] < 0.3
    back = tell(HingeNumbers(judged=designs["zotov-142"]))["retune"]
    assert back["speed_rpm"] == pytest.approx(89)
    assert back["torque_ratio_peak"] == pytest.approx(1 / again["torque_ratio_peak"], rel=1e-6)


def test_design_that_can_be_built(run):
    status, numbers, err = run()
    assert status == 0 and err == ""
    assert_complete(numbers)


def test_limit_that_is_not_kept(run):
    status, numbers, err = run("limits.pressure_angle=5 deg")
    assert status == 1 and err == ""
    assert_complete(numbers)
    assert not numbers["guide"]["feasible"] and numbers["guide"]["margin"] < 0
    assert "pressure angle" in numbers["guide"]["reason"] and "at most 5 deg" in numbers["guide"]["reason"]
    assert numbers["check"]["speed_ripple"] < 1e-6


def test_spring_that_is_too_weak(run):
    status, numbers, _ = run("spring.p0=10 kPa", "spring.H=0.1 m", "guide.rho0=0.4 m")
    assert status == 1
    assert_complete(numbers)
    assert "closes it fully" in numbers["guide"]["reason"]
    assert numbers["guide"]["rho_min"] is None and numbers["check"]["speed_ripple"] is None
    assert numbers["flywheel_inertia_saved"] > 1000


def test_spring_at_its_limits(run):
    status, numbers, _ = run("spring.p0=0.1 MPa")
    assert status == 1
    assert_complete(numbers)
    assert "closing z/H" in numbers["guide"]["reason"] and "spring pressure" in numbers["guide"]["reason"]


def test_other_speed_is_of_the_same_engine(run):
    # without its own masses the other engine would ask for a negative pressure
    status, numbers, err = run("m1=80 t")
    assert status == 1 and err == ""
    assert numbers["retune"]["p0"] > 0
    assert numbers["retune"]["p0_ratio"] > 1


def test_files(written):
    assert {"report.html", "summary.json", "hinge.csv", "guide.csv", "torque.svg", "track.svg"} <= written.keys()
    table, units = read_table(written["hinge.csv"])
    assert all(units.values()) and len(table["phi"]) == 721 and table["phi"][-1] == pytest.approx(2 * math.pi)
    guide, units = read_table(written["guide.csv"])
    assert all(units.values()) and units["rho"] == "m"
    assert guide["rho"][0] == pytest.approx(guide["rho"][-1], rel=1e-12)
    assert_complete(strict_json(written["summary.json"].read_text()))


def test_report_opens_offline(written):
    text = written["report.html"].read_text(encoding="utf-8")
    assert "<math" in text and "<svg" in text
    assert not re.findall(r'(?:src|href)\s*=\s*["\'](?!#)', re.sub(r'xlink:href="#', 'href="#', text))
    assert set(re.findall(r"https?://([^/\"']+)", text)) <= {
        "www.w3.org",
        "purl.org",
        "creativecommons.org",
        "matplotlib.org",
        "github.com",  # the notice of the charts' licence
    }
    for word in ("approximately 2 times", "1.9 (5 to 9.5 MPa)", "almost constant", "Why they differ"):
        assert word in text


@pytest.mark.slow
def test_other_loads_have_their_own_key_table_and_picture(tmp_path, monkeypatch, capsys):
    words = ["--set", "trials.turns=4", "--loads", "0.5,0.9,1", "--out", str(tmp_path)]
    monkeypatch.setattr(sys, "argv", ["mechsym", "hinge", "zotov-89", "--json", *words])
    with pytest.raises(SystemExit) as end:
        main()
    half, nine, full = strict_json(capsys.readouterr().out)["loads"]
    assert (end.value.code or 0) == 0
    assert [row["mep_bar"] for row in (half, nine, full)] == pytest.approx([4.0, 7.2, 8.0])
    assert full["speed_ripple"] < 1e-9 and full["p0_ratio"] == pytest.approx(1.0, rel=1e-9)
    assert 0.05 < nine["speed_ripple_reset"] < nine["speed_ripple"] and nine["p0_ratio"] < 1
    assert half["speed_ripple"] is None and "it stops after" in half["reason"]
    page = (tmp_path / "report.html").read_text()
    assert "<h2>The same guide at other loads</h2>" in page and half["reason"] in page
    assert (tmp_path / "loads.svg").read_text().startswith("<svg")


def test_no_other_loads_unless_asked_for(run, written):
    assert run()[1]["loads"] == [] and "other loads" not in written["report.html"].read_text()


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--loads", "0"], "--loads 0: shares"),
        (["--loads", ""], "takes numbers"),
        (["--loads", "1,0.5,1"], "--loads 1,0.5,1: each share once"),
        (["--loads", "50"], "--loads 50: shares"),
        (["--loads", "half"], "--loads"),
        (["--loads", "0.5,"], "--loads"),
        (["--loads", "0.5", "--diagram", "own.csv"], "one load"),
    ],
)
def test_other_loads_that_make_no_sense_are_refused(words, message, monkeypatch, capsys):
    monkeypatch.setattr(sys, "argv", ["mechsym", "hinge", "zotov-89", "--json", *words])
    with pytest.raises(SystemExit) as end:
        main()
    printed = capsys.readouterr()
    assert end.value.code == 2 and printed.out == ""
    assert message in printed.err and printed.err.count("\n") == 1
