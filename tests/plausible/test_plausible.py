"""Nonsense is refused, the unusual doubted, what a case accepts is told apart; and --strict."""

import json

import pytest
from click.testing import CliRunner

from mechsym import cases
from mechsym.cli import mechsym
from mechsym.errors import BadInput
from mechsym.plausible import INPUTS, RESULTS, Acceptance, inputs, proportions, results, sifted


def run(*words):
    done = CliRunner().invoke(mechsym, list(words))
    return done.exit_code, done


@pytest.mark.parametrize("name", cases.names())
def test_built_in_cases_have_no_doubt_left(name):
    case = cases.load(name)
    remaining, accepted = sifted(case.doubts, case.acceptances)
    assert not remaining
    assert {d.code for d in accepted} == ({"polytropic_index"} if "spring" in case.sections else set())


@pytest.mark.parametrize("name", cases.names())
@pytest.mark.parametrize("factor", [0.95, 1.05])
def test_nearly_no_value_is_doubted_a_little_off(name, factor):
    case, doubted = cases.load(name), set()
    fields = [field for kind in INPUTS for field in kind.keys]
    for section, record in case.sections.items():
        for field in fields:
            value = getattr(record, field, None)
            if isinstance(value, float) and value:
                other = cases.load(name, {f"{section}.{field}": value * factor})
                doubted |= {d.code for d in sifted(other.doubts, other.acceptances)[0]}
    assert doubted <= {"polytropic_index"}


IMPOSSIBLE = [
    ("nunes-slider-crank", "cycle.intake_temperature=15"),
    ("nunes-slider-crank", "cycle.intake_pressure=14.7"),
    ("nunes-slider-crank", "heating_value=43.5"),
    ("nunes-slider-crank", "chamber.bore=60"),
    ("nunes-slider-crank", "gas.gamma=1.0001"),
    ("nunes-slider-crank", "heat_transfer.wall_temperature=77"),
    ("moroianu", "mu_guide=2"),
    ("moroianu", "operation.speed=12700 rpm"),
    ("zotov-89", "rollers.E=206 MPa"),
    ("chmielewski", "simulation.output_step=200"),
    ("alpha-stirling", "T_e=900000"),
    ("alpha-stirling", "operation.speed=600000 rpm"),
]


@pytest.mark.parametrize(("name", "setting"), IMPOSSIBLE)
def test_the_impossible_is_refused_with_what_is_possible(name, setting):
    key, _, value = setting.partition("=")
    with pytest.raises(BadInput) as told:
        cases.load(name, {key: value})
    words = str(told.value)
    assert "\n" not in words
    assert key.rpartition(".")[2] in words


def test_the_unusual_is_doubted_and_strict_says_so():
    setting = ("--set", "cycle.compression_ratio=60")
    status, done = run("forces", "moroianu", *setting, "--json")
    assert status == 0
    assert [d["code"] for d in json.loads(done.stdout)["doubts"]] == ["compression_ratio"]
    assert run("forces", "moroianu", *setting, "--strict")[0] == 3
    assert run("forces", "moroianu", "--strict")[0] == 0
    status, done = run("forces", "moroianu", *setting)
    assert "doubt: cycle.compression_ratio = 60, usual is at least 3 and at most 30" in done.stdout


def test_a_case_accepts_a_doubt_up_to_a_value(tmp_path):
    text = cases.text("moroianu") + '\n[doubts]\ncompression_ratio = { up_to = 65, why = "an experiment" }\n'
    file = tmp_path / "mine.toml"
    file.write_text(text)
    for ratio, remaining in ((50, 0), (60, 0)):
        case = cases.load(str(file), {"cycle.compression_ratio": ratio})
        assert len(sifted(case.doubts, case.acceptances)[0]) == remaining
    file.write_text(text.replace("up_to = 65", "up_to = 40"))
    case = cases.load(str(file), {"cycle.compression_ratio": 50})
    assert [d.code for d in sifted(case.doubts, case.acceptances)[0]] == ["compression_ratio"]


@pytest.mark.parametrize(
    "row",
    [
        'nonsense = { up_to = 1, why = "x" }',
        "gamma = 1.3",
        "gamma = { up_to = 1.3 }",
        'gamma = { up_to = "2 m", why = "" }',
    ],
)
def test_a_wrong_acceptance_is_refused(tmp_path, row):
    file = tmp_path / "mine.toml"
    file.write_text(cases.text("moroianu") + f"\n[doubts]\n{row}\n")
    with pytest.raises(BadInput, match="doubts"):
        cases.load(str(file))


def test_results_are_found_wherever_they_stand():
    report = {"p_max_bar": 400.0, "check": {"energy_residual": 1e-3}, "twist": [{"twist_peak": 0.5}], "mep_kpa": [1.0]}
    assert {d.code for d in results(report)} == {"peak_pressure", "energy_balance", "twist"}
    assert results({"efficiency": [0.3, None], "p_max_bar": float("nan")}) == ()


def test_ends_of_the_ranges():
    for kind in (*INPUTS, *RESULTS):
        assert kind.lowest <= kind.low <= kind.high <= kind.highest, kind.code
    assert proportions(None, None, None) == ()
    assert [d.code for d in proportions(0.1, 1.5, 100.0)] == ["rod_ratio"]
    accepted = {"gamma": Acceptance(code="gamma", up_to=1.1, why="burnt gas")}
    low, lower = inputs({"gas.gamma": 1.12}), inputs({"gas.gamma": 1.05})
    assert sifted(low, accepted) == ((), low)
    assert sifted(lower, accepted) == (lower, ())
