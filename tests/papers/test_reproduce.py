"""`mechsym reproduce`: keys, verdicts, the record, files; the whole of it in the slow suite."""

import json
from collections import Counter

import pytest
from click.testing import CliRunner
from pictures import drawn, faults, ids

from mechsym import papers
from mechsym.cli import mechsym
from mechsym.errors import BadInput
from mechsym.papers import page, sources
from mechsym.papers import rows as record
from mechsym.papers.rows import ARITHMETIC, KEYS, NOT_REPRODUCED, REPRODUCED, VERDICTS, by_digits, last_digit, row

FAST = ("zotov2024", "moroianu2017", "prymak")
FIGURES = {"zotov2024": 4, "moroianu2017": 9, "chmielewski2015": 8, "prymak": 1, "nunes2017": 32}


def run(*arguments):
    return CliRunner().invoke(mechsym, ["reproduce", *arguments])


def test_rows_by_digits():
    assert last_digit("9.188") == pytest.approx(1e-3) and last_digit("2.9405e-4") == pytest.approx(1e-8)
    assert by_digits("9.188", 9.18849) == REPRODUCED and by_digits("9.188", 9.1886) == NOT_REPRODUCED
    assert by_digits("194", 103.98) == NOT_REPRODUCED


def test_row_keeps_words_and_numbers_apart():
    assert row("i", "194", 97.0, NOT_REPRODUCED).told("s")["rel_error"] == -0.5
    words = row("i", "rises", 97.0, NOT_REPRODUCED).told("s")
    assert words["published"] is None and words["printed"] == "rises" and words["rel_error"] is None
    assert row("i", "0", 1e-3, NOT_REPRODUCED).told("s")["rel_error"] is None
    with pytest.raises(BadInput, match="reproduced"):
        row("i", None, None, "maybe")


@pytest.mark.parametrize("name", FAST)
def test_fast_sources_give_the_recorded_outcome(name):
    result = run(name, "--json")
    found = json.loads(result.stdout)
    assert result.exit_code == 0 and found
    (source,) = sources(name)
    for one in found:
        assert set(KEYS) <= set(one) and one["source"] == source.stem and one["verdict"] in VERDICTS
        assert one["note"] or one["verdict"] in (REPRODUCED, ARITHMETIC)
        for key in ("published", "computed", "rel_error"):
            assert one[key] is None or isinstance(one[key], (int, float))


def test_source_by_stem_and_text_for_people():
    result = run("003_8746f5f4ad51b1d1")
    assert result.exit_code == 0
    assert "squared" in result.stdout and "the outcome is the recorded one" in result.stdout


def test_another_outcome_is_exit_status_1(monkeypatch):
    known = record.stored("mechsym.papers")
    changed = [r | {"verdict": REPRODUCED} if r["item"].startswith("conclusion 3") else r for r in known]
    monkeypatch.setattr(record, "stored", lambda package: changed)
    result = run("prymak")
    assert result.exit_code == 1 and "conclusion 3" in result.stdout.split("differs from")[1]
    assert run("moroianu2017").exit_code == 0
    monkeypatch.setattr(record, "stored", lambda package: known[1:])
    assert run("zotov2024", "--json").exit_code == 1


@pytest.mark.parametrize(
    ("computed", "before", "differs"),
    [
        (1.0, 1.0 + 5e-7, False), (1.0, 1.0 + 2e-6, True), (1e-12, -1e-10, False), (1e-12, 1e-8, True),
        (None, 1.0, True), (2.0, None, True), (None, None, False),
    ],
)  # fmt: skip
def test_values_are_recorded_with_a_tolerance(monkeypatch, computed, before, differs):
    kept = {"source": "s", "item": "i", "verdict": REPRODUCED, "tolerance": 1e-6}
    monkeypatch.setattr(record, "stored", lambda package: [kept | {"computed": before}])
    found = record.differences("p", [kept | {"computed": computed}], ("source", "item"), ("verdict", "computed"))
    assert bool(found) is differs
    assert all("i: computed" in line for line in found)


def test_a_changed_value_is_noticed_though_the_verdict_stays(monkeypatch):
    known = record.stored("mechsym.papers")
    changed = [
        r | {"computed": r["computed"] * 1.0001} if "share of the inertia part" in r["item"] else r for r in known
    ]
    monkeypatch.setattr(record, "stored", lambda package: changed)
    result = run("zotov2024")
    assert result.exit_code == 1 and result.stdout.split("differs from")[1].count("computed") == 1


def test_every_recorded_number_has_its_tolerance():
    for one in record.stored("mechsym.papers"):
        assert 0 < one["tolerance"] <= 1e-4
        assert one["computed"] is not None or one["verdict"] == "not computable"


def test_unknown_source_and_write_of_one_source_are_refused():
    assert isinstance(run("nobody").exception, BadInput)
    assert isinstance(run("prymak", "--write").exception, BadInput)


@pytest.mark.slow
def test_files(tmp_path):
    assert run("prymak", "--out", str(tmp_path)).exit_code == 0
    text = (tmp_path / "reproduction.html").read_text()
    assert "<svg" in text and not any(outside in text for outside in ("src=", 'href="http', "@import"))
    assert (tmp_path / "reproduction.csv").read_text().startswith("source,item,published,computed,rel_error,verdict,")
    assert (tmp_path / "prymak" / "figure_3.png").read_bytes().startswith(b"\x89PNG")
    first = (tmp_path / "prymak" / "figure_3.svg").read_text()
    assert run("prymak", "--out", str(tmp_path)).exit_code == 0
    assert (tmp_path / "prymak" / "figure_3.svg").read_text() == first


PAPER = {
    "__init__.py": "from mechsym.papers import Source\n"
    "SOURCE = Source(stem='009_f', name='doe1999', title='Doe (1999): Cranks')\n",
    "printed.toml": "entry = []\n",
    "rows.py": "from mechsym.papers import row\ndef rows():\n    return [row('sum', '2', 1 + 1, 'reproduced')]\n",
    "figures.py": "def figures():\n    return {}\n",
}


def test_a_paper_is_its_folder(tmp_path, monkeypatch):
    folder = tmp_path / "doe1999"
    folder.mkdir()
    for name, text in PAPER.items():
        (folder / name).write_text(text)
    monkeypatch.setattr(papers, "__path__", [*papers.__path__, str(tmp_path)])
    assert [s.name for s in sources()][-1] == "doe1999" and not sources("009")[0].entries
    result = run("doe1999", "--out", str(tmp_path / "out"))
    assert "doe1999: Doe (1999): Cranks" in result.stdout and "1 reproduced" in result.stdout
    assert "is not recorded" in result.stdout and result.exit_code == 1


def test_counts():
    assert page.counts([{"verdict": REPRODUCED}]) == {v: int(v == REPRODUCED) for v in VERDICTS}


@pytest.mark.slow
@pytest.mark.heavy
def test_the_whole_reproduction_is_the_recorded_one(tmp_path, monkeypatch):
    figures = drawn(monkeypatch)
    result = run("--json", "--out", str(tmp_path))
    assert result.exit_code == 0
    found = json.loads(result.stdout)
    assert {r["source"] for r in found} == {s.stem for s in sources()}
    twice = [key for key, count in Counter((r["source"], r["item"]) for r in found).items() if count > 1]
    assert not twice
    for name, count in FIGURES.items():
        assert len(list((tmp_path / name).glob("*.svg"))) == count
    page_text = (tmp_path / "reproduction.html").read_text()
    assert "The outcome is the recorded one." in page_text
    assert len(figures) == sum(FIGURES.values()) and not ids(page_text)
    assert {f"{k} {figure.get_label()}": faults(figure) for k, figure in enumerate(figures) if faults(figure)} == {}


@pytest.mark.parametrize("name", ["zotov2024", "moroianu2017"])
def test_figures_have_curves(name):
    (source,) = sources(name)
    found = source.figures()
    assert len(found) == FIGURES[name]
    for figure in found.values():
        assert all(axis.lines for axis in figure.axes) and all(
            axis.get_title(loc="left") or axis.get_title() for axis in figure.axes
        )


def test_rows_of_a_source_carry_the_print():
    (source,) = sources("prymak")
    assert {r["printed"] for r in source.rows()} >= {"4", "along the rod"}
