"""A limit is one file and one row: a limit that lives in the tests goes through every command that asks limits."""

import csv
import json
from pathlib import Path

import pytest
from click.testing import CliRunner

import mechsym
from mechsym import cases, jobs
from mechsym.app.answers import hinge_answer
from mechsym.cases import schema
from mechsym.cli import mechsym as command
from mechsym.codesign.programme import solve
from mechsym.codesign.verify import used
from mechsym.jobs.codesign import codesign_task

ROOT = Path(mechsym.__file__).parent


@pytest.fixture
def case(monkeypatch, tmp_path):
    """The marine engine with that limit at 3 kN/mm; its guide asks 2.61."""
    monkeypatch.setitem(schema.ENTRIES, "limits", "hinge.line_load:WithLineLoad")
    text = (ROOT / "cases/zotov-89.toml").read_text(encoding="utf-8")
    path = tmp_path / "line.toml"
    path.write_text(text.replace("[limits]\n", '[limits]\nline_load = "3 kN/mm"\n'), encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    return str(path)


def done(line, status=0):
    ended = CliRunner().invoke(command, line.split())
    assert ended.exit_code == status, (line, ended.output, ended.exception)
    return ended.output


def test_the_case_without_it_is_as_before():
    assert "line_load" not in cases.text("zotov-89")


def test_a_hinge_tells_how_much_of_it_is_used(case):
    design = jobs.hinge(cases.load(case))
    asked = design.verdict.spring_force_max / cases.load(case).need("rollers").width
    assert design.verdict.used["line_load"] == pytest.approx(asked / 3e6, rel=1e-6)
    (row,) = (c for c in design.verdict.checks if c.name == "line_load")
    assert row.kept and row.text == f"spring force on a width of roller {asked / 1e3:.4g} of at most 3000 N/mm"


def test_a_limit_that_is_passed_ends_with_one_and_says_why(case):
    line = f"hinge {case} --set limits.line_load=2kN/mm --set trials.turns=4"
    assert "spring force on a width of roller" in done(line, 1)
    guide = json.loads(done(f"{line} --json", 1))["guide"]
    assert (
        not guide["feasible"]
        and guide["reason"].startswith("spring force on a width")
        and guide["used"]["line_load"] > 1
    )
    done(f"{line} --out out", 1)
    assert "spring force on a width" in Path("out/report.html").read_text(encoding="utf-8")


def test_check_and_guide_know_it(case):
    assert json.loads(done(f"check {case} --json"))["problems"] == []
    Path("wrong.toml").write_text(Path(case).read_text(encoding="utf-8").replace("3 kN/mm", "3 mm"), encoding="utf-8")
    assert "limits.line_load" in done("check wrong.toml", 2)
    assert "spring force on a width" in done(f"guide {case} --set limits.line_load=2kN/mm --sheet sheet.svg")


def test_sweeps_of_one_guide_after_the_other_and_of_many_at_once_agree(case):
    columns = []
    for of, show in (("hinge", "guide.used.line_load"), ("guides", "margins.line_load")):
        done(f"sweep {case} --of {of} --over limits.line_load=2,2.5,3kN/mm --show {show} --jobs 1 --out {of}")
        with (Path(of) / "sweep.csv").open(encoding="utf-8") as file:
            columns.append([float(row[f"{show} [-]"]) for row in csv.DictReader(file)])
    assert columns[1] == pytest.approx([1 - used for used in columns[0]], abs=1e-4)
    assert columns[1][0] < 0 < columns[1][2]


def test_the_workbench_has_its_bar_and_its_slider(case):
    answer = hinge_answer(case, {"limits.line_load": 2e6})
    (bar,) = (b for b in answer.bars if b.name == "line_load")
    assert not bar.kept and not answer.good


def test_a_co_design_keeps_it_and_says_what_it_costs(case):
    small = {"codesign.speeds": ["75 rpm", "120 rpm"], "codesign.knots": 24, "codesign.angles": 90}
    wide, tight = (solve(codesign_task(cases.load(case, {"limits.line_load": most, **small}))) for most in (6e6, 1.8e6))
    assert used(wide)["line_load"] < 0.99 and used(tight)["line_load"] == pytest.approx(1, abs=6e-3)
    units = {limit.limit: limit.unit for limit in tight.active}
    assert units["line_load"] == "N/m" and "line_load" not in [limit.limit for limit in wide.active]
    assert tight.flywheel > wide.flywheel


@pytest.mark.slow
def test_a_co_design_by_command_tells_it(case):
    told = json.loads(done(f"codesign {case} --speeds 75,120 --ripple 2% --set limits.line_load=1.8kN/mm --json"))
    assert told["verified"]["used"]["line_load"] == pytest.approx(1, abs=6e-3)
    assert "line_load" in [limit["limit"] for limit in told["active"]]


@pytest.mark.slow
def test_a_page_takes_it(case):
    """The page of the same run, whatever the case's limits are."""
    pages = []
    for name in (case, "zotov-89"):
        done(f"page {name} --set simulation.turns=1 --out page.html")
        pages.append(Path("page.html").read_text(encoding="utf-8").replace("line", "zotov-89"))
    assert "M_h" in pages[0] and len(pages[0]) == pytest.approx(len(pages[1]), rel=0.01)


@pytest.mark.slow
def test_a_report_lists_it(case):
    done(f"report {case} --out report.html --set limits.line_load=2kN/mm", 1)
    assert "line load" in Path("report.html").read_text(encoding="utf-8")
