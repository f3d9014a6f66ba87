"""Nonsense is refused, the unusual doubted, what a case accepts is told apart; and --strict."""

import contextlib
import dataclasses
import inspect
import json
import re
from pathlib import Path

import pytest
from click.testing import CliRunner

from mechsym import cases
from mechsym.cases import new_engine
from mechsym.cases.outcomes import of_cycle, of_run
from mechsym.cases.settings import settings_of
from mechsym.cli import mechsym
from mechsym.errors import BadInput
from mechsym.jobs.gas import gas, source
from mechsym.jobs.run import run_of
from mechsym.plausible import INPUTS, PROPORTIONS, RESULTS, Acceptance, inputs, proportion, proportions, results, sifted


def run(*words):
    done = CliRunner().invoke(mechsym, list(words))
    return done.exit_code, done


@pytest.mark.parametrize("name", cases.names())
def test_built_in_cases_have_no_doubt_left(name):
    case = cases.load(name)
    remaining, accepted = sifted(case.doubts, case.acceptances)
    assert not remaining
    assert {d.code for d in accepted} == (
        {"polytropic_index"} if "spring" in case.sections else {"back_pressure"} if "nunes" in name else set()
    )


@pytest.mark.parametrize("name", cases.names())
@pytest.mark.parametrize("factor", [0.95, 1.05])
def test_nearly_no_value_is_doubted_a_little_off(name, factor):
    case, doubted = cases.load(name), set()
    for section, record in case.sections.items():
        for field in dataclasses.fields(record):
            value = getattr(record, field.name)
            if isinstance(value, float) and value:
                with contextlib.suppress(BadInput):  # whole numbers, and values at the end of their table
                    other = cases.load(name, {f"{section}.{field.name}": value * factor})
                    doubted |= {(field.name, d.code) for d in sifted(other.doubts, other.acceptances)[0]}
    # an index further from that of the gas than the source's is one that its case does not accept
    assert doubted <= ({("n", "polytropic_index")} if factor < 1 else set())


def test_the_unusual_is_doubted_and_strict_says_so():
    setting = ("--set", "cycle.compression_ratio=60")
    status, done = run("forces", "moroianu", *setting, "--json")
    assert status == 0
    assert [d["code"] for d in json.loads(done.stdout)["doubts"]] == ["compression_ratio", "peak_pressure"]
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


def test_every_residual_that_a_report_has_is_judged():
    package = Path(inspect.getfile(cases)).parents[1]
    rooms = [file for file in package.rglob("*.py") if file.relative_to(package).parts[0] != "papers"]  # no reports
    field = re.compile(r"^    (\w+_residual): |\"(\w+_residual)\":", re.MULTILINE)
    found = {name for file in rooms for pair in field.findall(file.read_text()) for name in pair if name}
    assert found == {"power_residual", "energy_residual", "mass_residual"}
    for name in found:
        for report in ({name: 0.049}, {"runs": {"a": {name: [0.0, -0.049]}}}, {"data": {f"check.{name}": [0.049]}}):
            assert len(results(report)) == 1, (name, report)
        assert results({name: [1e-9, None, 0.0]}) == ()


@pytest.mark.parametrize("residual", [0.049, -2e-6, 5e-7])
def test_power_that_does_not_balance_is_a_doubt_and_strict_says_so(monkeypatch, residual):
    monkeypatch.setattr("mechsym.forces.summary.power_residual", lambda *_: residual)
    status, done = run("forces", "moroianu", "--json", "--strict")
    doubted = abs(residual) > 1e-6
    assert status == (3 if doubted else 0)
    assert [d["code"] for d in json.loads(done.stdout)["doubts"]] == ["power_balance"] * doubted


def test_an_ideal_cycle_reaches_its_bound_but_for_rounding():
    assert proportion("efficiency_bound", "efficiency / its bound", 1 + 4e-16) == ()
    assert [d.code for d in proportion("efficiency_bound", "efficiency / its bound", 1 + 1e-6)] == ["efficiency_bound"]


def test_ends_of_the_ranges():
    for kind in (*INPUTS, *RESULTS, *PROPORTIONS):
        assert kind.lowest <= kind.low <= kind.high <= kind.highest, kind.code
    assert proportions(None, None, None) == ()
    assert [d.code for d in proportions(0.1, 1.5, 100.0)] == ["rod_ratio"]
    short = {"rod_ratio": Acceptance(code="rod_ratio", up_to=1.6, why="a model")}
    assert sifted(proportions(None, 1.7, None), short)[0] == ()
    assert sifted(proportions(None, 1.5, None), short)[0]
    accepted = {"gamma": Acceptance(code="gamma", up_to=1.1, why="burnt gas")}
    low, lower = inputs({"gas.gamma": 1.12}), inputs({"gas.gamma": 1.05})
    assert sifted(low, accepted) == ((), low)
    assert sifted(lower, accepted) == (lower, ())


def test_the_outcome_of_a_run_is_doubted_by_its_piston_speed():
    short = {"simulation.t_end": "3 s", "simulation.window": "1 s"}
    case = cases.load("chmielewski", short)
    result, numbers, _ = run_of(case, settings_of(case))
    for fastest, codes in ((700.0, []), (1000.0, ["piston_speed"]), (1e9, ["piston_speed"])):
        doubts = of_run(case, gas(case), result, dataclasses.replace(numbers, speed_max=fastest))
        assert [doubt.code for doubt in doubts] == codes


def test_a_step_of_results_that_turns_do_not_use_is_refused():
    with pytest.raises(BadInput, match="output_step = 500 s is not used over turns"):
        cases.load("zotov-89", {"simulation.output_step": 500})
    assert cases.load("zotov-89", {"simulation.output_step": "0.1 s", "t_end": "5 s"}).need("simulation").step == 0.1


def test_a_window_longer_than_the_run_is_doubted():
    setting = ("--set", "turns=4", "--set", "simulation.window=60 s")
    _, done = run("simulate", "zotov-89", *setting, "--no-check", "--json")
    (found,) = json.loads(done.stdout)["doubts"]
    assert found["code"] == "window"
    assert found["value"] == pytest.approx(60 / json.loads(done.stdout)["t_end"])


def test_no_efficiency_beats_the_bound_of_its_cycle():
    for name, bound in (("nunes-slider-crank", 1 - 10**-0.4), ("alpha-stirling", 1 - 330 / 900)):
        case = cases.load(name)
        of_source = source(case).bound
        assert of_cycle(case, {"efficiency": [bound * 0.99, float("nan")]}, of_source) == ()
        assert [d.code for d in of_cycle(case, {"efficiency": [bound * 1.01]}, of_source)] == ["efficiency_bound"]
    nothing = cases.load("moroianu")
    assert of_cycle(nothing, {"efficiency": [float("nan")]}, source(nothing).bound) == ()


@pytest.mark.parametrize("name", "generator-breathing nunes-slider-crank alpha-stirling zotov-89 moroianu".split())
def test_efficiency_has_a_bound_in_every_kind_of_cycle(name):
    columns = {"efficiency": [0.3], "p_max_mpa": [5.0]}
    case = cases.load(name)
    bound = source(case).bound
    assert of_cycle(case, columns, bound) == ()
    (doubt,) = of_cycle(case, columns | {"efficiency": [0.3, 0.95]}, bound)
    assert doubt.code == "efficiency_bound"


def test_a_new_engine_is_judged_by_the_sizes_in_which_its_kind_is_built():
    assert {d.code for d in new_engine.judged("inline", 0.9, 2.5)} == {"bore", "stroke_ratio"}
    assert new_engine.judged("two-stroke-crosshead", 0.95, 3.46) == ()
    assert new_engine.judged("v", 0.096, 0.0416) == ()
