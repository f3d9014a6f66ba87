"""What the auditor says of programs and texts that a test writes."""

import numpy as np

from mechsym.audit.hosts.findings import of_files
from mechsym.audit.hosts.repository import audited, programs
from mechsym.audit.hosts.whole import check_texts, read_texts
from mechsym.audit.judge.asked import Asked
from mechsym.audit.read.algebra import FLOATS, evaluate
from mechsym.audit.read.latex import read_latex
from mechsym.audit.read.tree import letters
from mechsym.audit.verdict import FINDINGS

NONE = Asked(text="", against="")


def rows_of(tmp_path, files):
    for name, text in files.items():
        place = tmp_path / name
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_bytes(text if isinstance(text, bytes) else text.encode())
    return of_files(list(audited(tmp_path, NONE, programs(tmp_path))))


def judged(tmp_path, text, name="text.tex"):
    (tmp_path / name).write_text(text)
    return check_texts(read_texts(tmp_path / name))[0]


def blamed(rows):
    return [row for row in rows if row["verdict"] in FINDINGS]


def is_told(tmp_path, right, printed, line):
    """Whether that line of a text alone is blamed (None: no line), and corrected as the right text has it."""
    assert blamed(judged(tmp_path, right, "text.md")) == []
    rows = blamed(judged(tmp_path, printed, "text.md"))
    if line is None or [row["line"] for row in rows] != [line]:
        return line is None and rows == []
    left, _, other = right.split("\n")[line - 1].strip("$ ").partition("=")
    return same(rows[0]["correction"], left if other.strip() == "0" else other)  # of a motion the side that moves


def same(one, other):
    """Whether two formulas of LaTeX are one at random values of their letters."""
    plain = (text.replace(r"\delta", r"{\delta}") for text in (one, other))  # not the small change of what follows
    first, second = (read_latex(text, whole=True)[0] for text in plain)
    rng = np.random.default_rng(7)
    values = {k: rng.uniform(0.4, 1.6, 200) for k in {*letters(first), *letters(second)}} | {"pi": np.pi}
    with np.errstate(invalid="ignore"):  # roots of what is below 0 in both
        first, second = (evaluate(tree, values, FLOATS) for tree in (first, second))
    return np.isfinite(first).sum() > 10 and np.allclose(first, second, rtol=1e-9, equal_nan=True)
