"""A card of a report is a field with a word, and its part one file and one row: `wear.py`, and the row below."""

import json

import pytest
from report import wear

from mechsym import cases
from mechsym.cli import main
from mechsym.quantities.display import choose
from mechsym.report import case_report, html
from mechsym.report.parts import PARTS


@pytest.fixture
def with_row(monkeypatch):
    monkeypatch.setitem(PARTS, "wear", wear.ROW)


def run(monkeypatch, capsys, *words):
    monkeypatch.setattr("sys.argv", ["mechsym", *words])
    with pytest.raises(SystemExit) as end:
        main()
    return end.value.code or 0, capsys.readouterr().out


def test_the_command_shows_it(with_row, monkeypatch, capsys, tmp_path):
    file = tmp_path / "report.html"
    words = ("report", "nunes-hypocycloid", "--parts", "wear", "--out", str(file))
    code, out = run(monkeypatch, capsys, *words, "--json")
    speed, (one,) = 8000 / 60 * 2 * 0.052, json.loads(out)["reports"]
    assert code == 0 and one["parts"]["wear"]["state"] == "done"
    assert one["parts"]["wear"]["result"] == {"speed": pytest.approx(speed), "life": pytest.approx(1e8 / speed)}
    page = file.read_text()
    for text in ("mean piston speed", "13.9 m/s", "life of a ring", "2003 h"):
        assert text in page, text
    code, out = run(monkeypatch, capsys, *words)
    assert code == 0 and "A ring wears." in out


def test_it_follows_the_units_that_a_reader_wants(with_row):
    try:
        choose("m/min")
        page = html([case_report(cases.load("nunes-hypocycloid"), ("wear",))])
    finally:
        choose(None)
    assert "832 m/min" in page and "13.9 m/s" not in page
