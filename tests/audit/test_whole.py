"""A whole text without a theory: what it says is held against itself, its units, and the theories that fit."""

import json
import os
from pathlib import Path

import pytest

from mechsym import cli
from mechsym.audit.hosts.whole import check_texts, page_of, read_texts, summary_of
from mechsym.audit.judge.kinds import kinds_of
from mechsym.audit.judge.misfits import findings, odd
from mechsym.audit.judge.table_slips import table_slips
from mechsym.audit.read.displays import displayed
from mechsym.audit.read.nomenclature import nomenclature
from mechsym.audit.read.said import read_text_whole
from mechsym.audit.read.spelling import to_python
from mechsym.audit.read.units import unit_of
from mechsym.audit.verdict import FINDINGS
from mechsym.errors import BadInput

FOLDER = Path(__file__).parent / "paper"
SEEDS = os.environ.get("MECHSYM_TEST_SEEDS")


def blamed(rows):
    return [row["equation"] for row in rows if row["verdict"] in FINDINGS]


@pytest.mark.slow
def test_the_five_slips_of_a_made_paper_and_what_two_of_them_carry(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr("sys.argv", ["mechsym", "audit", str(FOLDER / "made.tex"), "--json", "--out", str(tmp_path)])
    with pytest.raises(SystemExit) as ended:
        cli.main()
    told = json.loads(capsys.readouterr().out)
    rows = told["rows"]
    assert ended.value.code == 1 and blamed(rows) == ["8", "10", "19", "24", "28"]
    assert {r["equation"]: r["follows"] for r in rows if r["follows"]} == {"11": ["10"], "20": ["19"]}
    assert told["coverage"]["judged"] == told["coverage"]["equations"] == 30
    assert [r["equation"] for r in rows if "the table has k in N/m" in r["note"]] == ["29", "30"]
    assert {r["equation"] for r in rows if r["verdict"] == "convention"} == {"16"}
    page = (tmp_path / "audit.html").read_text()
    assert page.index("30 equations: 30 read") < page.index("<table") and "(10) -&gt; (11)" in page


@pytest.mark.slow
def test_the_four_slips_of_a_paper_of_another_kind():
    rows, cover = check_texts(read_texts(FOLDER / "unseen.md"))
    assert blamed(rows) == ["2", "8", "9", "16"] and cover.equations == cover.read == 22
    assert "Es in N" in summary_of(rows, cover) and "judged" in page_of("p", rows, cover)


@pytest.mark.slow
@pytest.mark.skipif(not SEEDS, reason="MECHSYM_TEST_SEEDS names the folder of the five sources")
def test_three_sources_as_they_are_have_no_false_finding():
    for stem, count in (("001", 10), ("002", 11), ("003", 10)):
        rows, cover = check_texts(read_texts(next(Path(SEEDS).glob(f"{stem}*"))))
        assert blamed(rows) == (["4"] if stem == "003" else []) and cover.read == cover.equations == count


@pytest.mark.slow
@pytest.mark.skipif(not SEEDS, reason="MECHSYM_TEST_SEEDS names the folder of the five sources")
def test_units_find_the_slips_of_a_thesis():
    paper = read_text_whole(next(Path(SEEDS).glob("004*")).read_text(encoding="utf-8"))
    kinds = kinds_of(paper)
    slips, left = table_slips(paper, kinds, odd(kinds, paper.said)[0])
    assert [(s.letter, s.wanted) for s in slips] == [("gamma", "1")]
    assert [o.said.name for o in findings(kinds, left, paper.said)] == ["2.16", "2.17", "2.46", "2.46", "2.49", "2.53"]
    assert sum(bool(s.sides) for s in paper.said if not s.inline) == 133


@pytest.mark.slow
@pytest.mark.heavy
@pytest.mark.skipif(not SEEDS, reason="MECHSYM_TEST_SEEDS names the folder of the five sources")
def test_a_thesis_as_it_is_has_seven_findings_that_its_registry_knows():
    rows, cover = check_texts(read_texts(next(Path(SEEDS).glob("004*"))))
    assert blamed(rows) == ["2.16", "2.17", "2.46", "2.49", "2.53", "2.60", "2.71"]
    assert cover.read == cover.equations == 133 and cover.judged >= 0.6 * cover.equations


def test_equations_of_plain_text_are_listed_with_why_they_are_not_read(tmp_path, monkeypatch, capsys):
    file = tmp_path / "copied.txt"
    file.write_text(
        "The speed of the pin is found from the crank, v=rω, and\n\n3\nT=12mv2+12Iφ˙2,\n\nwhere m is a mass.\n"
    )
    rows, cover = check_texts(read_texts(file))
    assert [(r["equation"], r["line"], r["read"]) for r in rows] == [("3", 4, False)] and cover.read == 0
    assert "12 may be 1/2" in rows[0]["note"]
    monkeypatch.setattr("sys.argv", ["mechsym", "audit", str(file)])
    with pytest.raises(SystemExit) as ended:
        cli.main()
    assert ended.value.code == 3 and "1 equation: 0 read" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("text", "sides"),
    [
        (r"$$F=F_p+F_{it} [N]$$ (7)", ["F", "Fp + Fit"]),
        (r"$$M - I\ddot\varphi = 0$$", ["M - I*phidd", "0"]),
        (r"$$\eta = 1 - e^{-k t}$$", ["eta", "1 - exp(-k*t)"]),
        (r"$$x' = r\sin\varphi$$", ["xprime", "r*sin(phi)"]),
        (r"$$u = 0, 2 \cdot \frac{(0,001 n)^2}{2}$$", ["u", "0.2*((0.001*n)**2/2)"]),
        (r"$$P = \sqrt{(P_1 \pm P_j)^2}$$", ["P", "sqrt((P1 + plusminus*Pj)**2)"]),
        (r"$$N = F \text{tg} \beta$$", ["N", "F*tan(beta)"]),
        (r"$$v = \underbrace{r\omega}_{\text{speed}} k$$", ["v", "r*omega*k"]),
        (r"$$\vec{F} = m \vec{a}$$", ["F", "m*a"]),
        (r"$$Q = \delta W + dU$$", ["Q", "deltaW + dU"]),
        (r"$$S(\theta) = 2r\cos(\theta) + l$$", ["S", "2*r*cos(theta) + l"]),
        ("models 92 $$\n\nText.\n\n$$a = b$$", ["a", "b"]),
    ],
)
def test_texts_are_read_as_they_are_printed(text, sides):
    assert [to_python(s) for s in read_text_whole(text).said[-1].sides] == sides


def test_rows_units_and_numbers_of_a_display():
    shown = displayed(
        "$$\\begin{aligned} a &= b \\\\ c &= d + e \\\\ &\\quad + f \\end{aligned}$$ (2.4)\n$$p = q\\;[\\mathrm{m/s}]$$"
    )
    assert [(e.text, e.number, e.unit) for e in shown] == [
        ("a = b", "2.4", ""), (r"c = d + e \quad + f", "2.4", ""), ("p = q", "", "m/s"),
    ]  # fmt: skip
    assert [e.text for e in displayed(r"$$a = b \implies c = d$$")] == ["a = b", "c = d"]


def test_a_nomenclature_in_a_table_or_a_sentence():
    assert unit_of("J/(kg.K)") == "J/kg/K" and unit_of(r"-2r\sin\theta") is None
    named = nomenclature("| $D$ | bore | mm |\n$p$ – pressure [MPa],\nC _v\tHeat Capacity\tJ/(kg.K)\n")
    assert {k: v.unit for k, v in named.items()} == {"D": "mm", "p": "MPa", "C_v": "J/kg/K"}


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("no equations", "no display equation"),
        (r"\begin{equation} x = " * 2000, "no display equation"),
        ("$$x = r$$\n\n" * 3100, "more than 3000 equations"),
    ],
)
def test_broken_texts_are_refused_in_a_line(tmp_path, text, why):
    (tmp_path / "p.txt").write_text(text, encoding="utf-8")
    with pytest.raises(BadInput, match=why) as refused:
        check_texts(read_texts(tmp_path))
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize("text", ["$$x = " + "(" * 1000 + "r$$", "\ufffd$$=$$", "$$x = \\frac{1}{$$"])
def test_what_cannot_be_read_is_a_row_that_says_why(tmp_path, text):
    (tmp_path / "p.txt").write_text(text, encoding="utf-8")
    (row,), cover = check_texts(read_texts(tmp_path))
    assert not row["read"] and row["note"] and "\n" not in row["note"] and cover.read == 0 and len(cover.unread) == 1


def test_a_text_of_another_encoding_is_refused_in_a_line(tmp_path):
    (tmp_path / "p.txt").write_text("$$x = r$$", encoding="utf-16")
    with pytest.raises(BadInput, match=r"p\.txt is no text"):
        check_texts(read_texts(tmp_path))


def test_what_is_nested_too_deep_is_a_row_that_says_so():
    paper = read_text_whole("$$x = " + "(" * 1000 + "r" + ")" * 1000 + "$$")
    assert "nested" in paper.said[0].why
