"""`mechsym forces` from end to end: keys, files, exit status."""

import json

import numpy as np
import pytest
from click.testing import CliRunner
from tables import read_table

from mechsym import cases
from mechsym.cli import mechsym
from mechsym.errors import BadInput
from mechsym.jobs.gas import gas, measured

CASES = ("moroianu", "balandin", "nunes-slider-crank", "nunes-hypocycloid")


def run(*words):
    return CliRunner().invoke(mechsym, ["forces", *words], catch_exceptions=False)


@pytest.mark.slow
@pytest.mark.parametrize("name", CASES)
def test_chain_and_pictures_are_written(name, tmp_path):
    result = run(name, "--json", "--out", str(tmp_path))
    assert result.exit_code == 0
    found = json.loads(result.output)
    assert found["power_residual"] < 1e-10
    columns, units = read_table(tmp_path / "forces.csv")
    for key, unit in (("torque", "N*m"), ("crank_pin_load", "N")):
        assert units[key] == unit
        assert columns[key].max() == pytest.approx(found["max"][key], rel=1e-10)
        assert columns[key].min() == pytest.approx(found["min"][key], rel=1e-10)
    for picture in ("forces", "polar", "orders", "mechanism", "friction"):
        assert (tmp_path / f"{picture}.svg").read_text().startswith("<svg")
    for file in ("mechanism.html", "report.html"):
        page = (tmp_path / file).read_text()
        assert "{{" not in page and 'src="http' not in page and 'href="http' not in page


@pytest.mark.slow
def test_equal_runs_give_equal_files(tmp_path):
    for folder in ("a", "b"):
        run("moroianu", "--out", str(tmp_path / folder))
    for file in ("forces.csv", "forces.svg", "mechanism.html"):
        assert (tmp_path / "a" / file).read_bytes() == (tmp_path / "b" / file).read_bytes()


def test_text_names_what_matters():
    text = run("balandin", "--comparison").output
    assert "rank 3 of 4" in text and "Stiffnesses" in text
    assert "rodless, four pistons, equal stiffnesses" in text


def test_much_friction_is_called_first_order():
    assert "first order only" in run("balandin").output
    assert "first order only" not in run("moroianu").output


def test_moroianu_shows_the_two_mass_error():
    found = json.loads(run("moroianu", "--json").output)["two_mass"]
    assert 0.001 < found["two_mass"]["M"] < 0.05
    assert found["terskih"]["Z"] > found["two_mass"]["Z"]


def test_balandin_turns_with_the_crank_not_along_the_rod():
    """Prymak's conclusion 3 is wrong: the constant resultant 4 m r omega^2 (with the link) turns with the crank."""
    found = json.loads(run("balandin", "--json").output)["rodless"]
    omega = 4000 * 3.141592653589793 / 30
    wanted = (2 * 2.1 + 0.8) * 0.02 * omega**2
    assert found["inertia_resultant_min"] == pytest.approx(wanted, rel=1e-12)
    assert found["inertia_resultant_max"] == pytest.approx(wanted, rel=1e-12)
    assert found["resultant_off_crank_deg"] < 1e-9


def test_balance_that_is_not_reached_ends_with_status_1():
    result = run("balandin", "--set", "u1=0", "--json")
    assert result.exit_code == 1
    assert not json.loads(result.output)["balance"]["reached"]


@pytest.mark.slow
def test_report_shows_comparison_and_claims(tmp_path):
    run("nunes-hypocycloid", "--comparison", "--out", str(tmp_path))
    page = (tmp_path / "report.html").read_text()
    for text in ("At equal stroke", "rodless, four pistons, equal stiffnesses", "first order"):
        assert text in page
    assert "unsupported claim" not in page  # its source makes none


def test_a_law_by_few_speeds_does_not_boast():
    few = run("nunes-slider-crank", "--law", "6000:8000:2000").output
    assert "fitted to 2 speeds within 0" in few and "how well it fits is open" in few
    many = json.loads(run("nunes-slider-crank", "--law", "4000:8000:1000", "--json").output)["friction_law"]
    assert many["speeds"] == 5


@pytest.mark.slow
def test_friction_as_a_section_of_the_case(tmp_path):
    """The printed lines make a law of the cycle whose brake efficiency is that of the mechanism's friction."""
    result = run("nunes-slider-crank", "--law", "6000:8000:1000")
    lines = result.output.split("fitted to")[1].splitlines()[1:6]
    case = tmp_path / "braked.toml"
    text = cases.text("nunes-slider-crank").split("[friction_pressure]")
    rest = text[1].split("\n\n", 1)[1]
    case.write_text(text[0] + "\n".join(["[friction_pressure]", *lines]) + "\n\n" + rest)
    cycle = json.loads(CliRunner().invoke(mechsym, ["cycle", str(case), "--json"], catch_exceptions=False).output)
    lost = json.loads(run("nunes-slider-crank", "--json").output)["friction"]
    wanted = lost["mechanical_efficiency"] * cycle["efficiency"][0]
    assert cycle["brake_efficiency"][0] == pytest.approx(wanted, rel=2e-3)


@pytest.mark.parametrize(("words", "message"), [
    (("chmielewski",), "the 2 coordinates of crankshaft_flywheel are free"),
    (("moroianu", "--set", "l1=0.1", "--set", "l2=0.2"), "rod too short"),
    (("nunes-slider-crank", "--law", "x"), "--law 'x' takes numbers"),
])  # fmt: skip
def test_what_cannot_be_done_is_explained(words, message):
    with pytest.raises(BadInput, match=message):
        run(*words)


@pytest.fixture(scope="module")
def recorded(tmp_path_factory):
    """The pressure of moroianu's own cycle as a recording: every half degree, in bar."""
    found = gas(cases.load("moroianu"))
    degrees = np.arange(0, 360, 0.5)
    rows = [f"{a},{p / 1e5:.7g}" for a, p in zip(degrees, found.pressure.absolute(np.radians(degrees)), strict=True)]
    path = tmp_path_factory.mktemp("diagram") / "recorded.csv"
    path.write_text("\n".join(["crank_angle_deg,pressure_bar", *rows]) + "\n")
    return str(path)


@pytest.mark.slow
def test_a_recorded_diagram_drives_the_chain(recorded):
    own, measured = (
        json.loads(run("moroianu", "--json", *words).output) for words in ([], ["--diagram", recorded, "--comparison"])
    )
    assert measured["power_residual"] < 1e-10 and measured["comparison"]
    # the file tells neither offset nor dead centre, and a polytrope has no losses: half a degree is not to be had
    for key in ("F", "torque", "crank_pin_load", "side_force"):
        assert measured["max"][key] == pytest.approx(own["max"][key], rel=0.015)
    assert measured["max"]["torque"] != own["max"]["torque"]  # read from the file: with its rounding and its fit


def test_spark_ignition_gives_a_diagram_its_chamber(tmp_path):
    angles = np.arange(0, 720, 0.5)  # two turns: the cycle of the case is a four-stroke one
    rows = (f"{a},{p:.6g}\n" for a, p in zip(angles, 1 + 30 * np.exp(-(((angles - 370) / 40) ** 2)), strict=True))
    (tmp_path / "two-turns.csv").write_text("crank_angle_deg,pressure_bar\n" + "".join(rows))
    recorded = str(tmp_path / "two-turns.csv")
    case = measured(cases.load("nunes-slider-crank"), recorded)
    cycle, room = case.sections["cycle"], case.sections["chamber"]
    assert (cycle.bore, cycle.compression_ratio, cycle.p_back) == (
        room.bore,
        room.compression_ratio,
        room.back_pressure,
    )
    assert cycle.working_cycle == "four-stroke" and cycle.file == recorded


@pytest.mark.slow
def test_a_measured_diagram_of_the_generator(measured_data):
    found = json.loads(run("generator", "--json", "--diagram", str(measured_data / "generator-half-load.csv")).output)
    assert found["power_residual"] < 1e-10 and 3e3 < found["max"]["F"] < 7e3


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        ("moroianu", None, "nowhere.csv"),
        ("moroianu", "a,b\n1,2\n", "angle"),
        ("moroianu", "crank_angle_deg,pressure_bar\n0,1\n1,x\n", "line 3"),
        ("moroianu", "crank_angle_deg,pressure_bar\n" + "".join(f"{a},5\n" for a in range(360)), "swings by 0 bar"),
        ("alpha-stirling", "crank_angle_deg,pressure_bar\n0,1\n", "no cylinder"),
        ("chmielewski", "crank_angle_deg,pressure_bar\n0,1\n", "[cycle] is missing"),
    ],
)
def test_a_diagram_that_cannot_be_used_is_refused(name, content, words, tmp_path):
    path = tmp_path / ("nowhere.csv" if content is None else "diagram.csv")
    if content is not None:
        path.write_text(content)
    with pytest.raises(BadInput) as refused:
        run(name, "--diagram", str(path))
    assert words in str(refused.value)


@pytest.mark.parametrize("name", ["zotov-89", "zotov-142"])
def test_the_engines_of_the_hinge_lose_a_few_per_cent(name):
    found = json.loads(run(name, "--json").output)["friction"]
    assert 0.94 < found["mechanical_efficiency"] < 0.98
    assert sum(found["places"].values()) == pytest.approx(found["power"], rel=1e-12)
    # the coefficients are small and the shoes carry little: the rings take most, as in large engines
    assert max(found["places"], key=found["places"].get) == "rings"


@pytest.mark.slow
def test_claims_of_a_source_are_judged_for_its_own_engines_only(tmp_path):
    found = json.loads(run("moroianu", "--json", "--out", str(tmp_path)).output)["claims"]
    assert {row["source"] for row in found} == {"001_a140ef4f7e005dde"}
    page = (tmp_path / "report.html").read_text()
    assert all(row["verdict"] in page for row in found)
    assert json.loads(run("zotov-89", "--json").output)["claims"] == []
    mine = tmp_path / "mine.toml"
    mine.write_text(cases.text("moroianu").replace("001_a140ef4f7e005dde", "own"))
    assert "supported claim" not in run(str(mine)).output
