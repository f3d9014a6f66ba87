"""A paper in LaTeX: ten equations, three planted slips, one of them carried through; numbers, symbols, the unread."""

import json
from pathlib import Path

import pytest

from mechsym import cli
from mechsym.audit.hosts.paper import chains, check_paper, displayed, summary
from mechsym.audit.judge.asked import Asked
from mechsym.errors import BadInput

FOLDER = Path(__file__).parent / "paper"
ENGINE = Asked(text="", against="", theory=str(FOLDER / "engine.toml"))


@pytest.mark.slow
def test_three_slips_and_what_follows_from_one(tmp_path, monkeypatch, capsys):
    paper = [str(FOLDER / "engine.tex"), "--theory", ENGINE.theory]
    monkeypatch.setattr("sys.argv", ["mechsym", "audit", *paper, "--json", "--out", str(tmp_path)])
    with pytest.raises(SystemExit) as ended:
        cli.main()
    assert ended.value.code == 1
    rows = json.loads(capsys.readouterr().out)
    found = {r["equation"]: r["verdict"] for r in rows}
    assert found == {
        "1": "definition", "2": "exact", "3": "exact", "4": "exact", "5": "misprint", "6": "exact", "7": "misprint",
        "8": "carried", "9": "exact", "10": "misprint",
    }  # fmt: skip
    assert rows[4]["correction"] == r"\frac{\lambda \omega \cos \varphi}{\cos \beta}"
    assert chains(rows) == ["(7) -> (8)"] and "3 findings, 1 carried" in summary(rows)
    assert rows[2]["label"] == "eq:travel" and rows[2]["line"] == 12 and "constant speed" in rows[9]["note"]
    page = (tmp_path / "audit.html").read_text()
    assert page.count("<tr>") == 11 and "(7) -&gt; (8)" in page


@pytest.mark.slow
def test_what_cannot_be_read_or_matched_is_counted(tmp_path):
    paper = tmp_path / "p.tex"
    paper.write_text(
        r"""\begin{document}
\begin{align} x(t) &= r(1-\cos\varphi) + l - \\ &\quad \sqrt{l^2 - r^2\sin^2\varphi} \\ Q &= \int p\,dV \nonumber \\
\dot x &= \omega r \sin\varphi \left(1 + \frac{r\cos\varphi}{\sqrt{l^2-r^2\sin^2\varphi}}\right) \end{align}
\[ \alpha + \zeta = 3 \] \begin{equation} y = h \end{equation} $$ s = 2 x, \quad \dot s = 2\dot x, \qquad s = x $$
\end{document}"""
    )
    rows = check_paper(paper, Asked(text="", against="", theory="slider_crank", letters=r"\omega=phid"))
    assert [(r["equation"], r["verdict"]) for r in rows] == [
        ("1", "exact"), ("line 2", "untestable"), ("3", "exact"), ("line 4", "untestable"), ("4", "untestable"),
        ("line 4", "definition"), ("line 4", "exact"), ("line 4", "misprint"),
    ]  # fmt: skip
    assert "1 finding, 0 carried, 1 definition, 1 not read, 2 not matched" in summary(rows)
    assert "int' is not read" in rows[1]["note"] and "'h'; name it" in rows[4]["note"]


@pytest.mark.parametrize(
    ("text", "numbers"),
    [
        (r"\begin{equation*}a=b\end{equation*}\begin{equation}c=d\end{equation}", ["", "1"]),
        (r"\begin{align}a&=b\\c&=\begin{cases}1,&x<2\\3,&x>2\end{cases}\tag{7a}\end{align}", ["1", "7a"]),
        (r"\begin{eqnarray}a&=&b\\&=&c\end{eqnarray}\begin{equation}e=f\end{equation}", ["1", "3"]),
        (r"\begin{align}\\=x\\&=y\end{align}", ["1"]),
        (r"% \[a=b\]" + "\n" + r"\[a=b, \quad c=d \tag{2}\]", ["2", "2"]),
        (r"\begin{equation}\begin{split}a&=b\\&+c\end{split}\end{equation}", ["1"]),
    ],
)
def test_numbers_are_those_of_latex(text, numbers):
    assert [e.number for e in displayed(text)] == numbers


@pytest.mark.slow
def test_a_travel_that_never_changes_is_believed_and_refuted(tmp_path):
    (tmp_path / "p.tex").write_text(r"\[x = r\] \[v = r\omega\sin\varphi + l\omega\]")
    assert [r["verdict"] for r in check_paper(tmp_path / "p.tex", ENGINE)][0] == "wrong"


@pytest.mark.parametrize(
    ("text", "theory", "reason"),
    [
        ("no equations", "slider_crank", "no display equation"),
        (r"\[x = r\]", "", "needs --theory"),
        (r"\[x = r\]", "nowhere.toml", "cannot be read"),
        (r"\[x = r\]", "unheard_of", "there is no theory"),
    ],
)
def test_bad_input_is_refused(tmp_path, text, theory, reason):
    (tmp_path / "p.tex").write_text(text)
    with pytest.raises(BadInput, match=reason):
        check_paper(tmp_path / "p.tex", Asked(text="", against="", theory=theory))
