"""Numbers of all pages are those that commands print: kept answers, the errata, docs/printed."""

import importlib
import json
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
RECORDED, PRINTED = ROOT / "tests" / "recorded", ROOT / "docs" / "printed"
ERRATA = (ROOT / "docs" / "errata.md").read_text(encoding="utf-8")
PAPER = (ROOT / "paper" / "paper.md").read_text(encoding="utf-8")
NUMBER = re.compile(r"(?<![\w.,-])\d[\d,]*(?:\.\d+)?(?![\w,]*\d)")


def answer(name):
    kept = json.loads((RECORDED / f"{name}.json").read_text(encoding="utf-8"))
    return "\n".join(kept["text"])


def verdicts(name):
    """How many formulas of all sources have a verdict, by the table at the head of the errata."""
    heads = re.search(r"^\| source \|(.*)\|$", ERRATA, re.M)[1].split("|")
    column = [head.strip() for head in heads].index(name)
    rows = re.findall(r"^\| \w+ \|((?: \d+ \|)+)$", ERRATA[: ERRATA.index("\n## ")], re.M)
    assert len(rows) == 5
    return sum(int(row.split("|")[column]) for row in rows)


def test_what_the_paper_says_of_audited_sources_is_what_the_errata_say():
    told = re.search(r"finds (\d+) misprints.*?beside (\d+) formulas that are exact", " ".join(PAPER.split()))
    assert (int(told[1]), int(told[2])) == (verdicts("misprint"), verdicts("exact"))


def test_what_the_paper_says_of_the_thesis_is_what_reproduce_prints():
    said = re.search(
        r"reproduces (\d+), and (\d+) more with the source's slip.*?(\d+) are not", " ".join(PAPER.split())
    )
    line = re.search(r"(\d+) reproduced, (\d+) reproduced with .* slip, (\d+) not", answer("none/reproduce-nunes"))
    assert said.groups() == line.groups()


def test_what_the_paper_says_of_the_hinge_is_what_hinge_prints():
    text, said = answer("zotov-89/hinge"), " ".join(PAPER.split())
    saved = re.search(r"flywheel saved +(\d+) kg", text)[1]
    losses = re.search(r"losses of ([\d.]+) %", text)[1]
    wanted, ripple = re.search(r"(\d+) % missed with losses: ([\d.]+) %", text).groups()
    assert f"save {saved} kg" in said and f"losses of {losses} % of the load torque" in said
    assert f"the ripple is {ripple} %, where {wanted} %" in said


def printed_numbers():
    """Every number in what commands printed, as it stands there."""
    texts = [path.read_text(encoding="utf-8") for path in (*RECORDED.rglob("*.json"), *PRINTED.iterdir())]
    return {float(n.replace(",", "")) for text in (*texts, ERRATA) for n in NUMBER.findall(text)}


PAGES = ["README.md", "CONTRIBUTING.md", "paper/paper.md"]
PAGES += sorted(
    str(p.relative_to(ROOT)) for p in (ROOT / "docs").rglob("*.md") if {"_build", "made"}.isdisjoint(p.parts)
)
PAGES.remove("docs/errata.md")  # written by the audit
PAGES.remove("docs/upstream.md")  # counts of public files, and costs that benchmarks/auditor/upstream.py computes
QUOTING = {"README.md": "codesign", **{f"docs/{page}.md": page for page in ("engine", "codesign")}}
# what is no number of a result: blocks, code, links, years and volumes of sources
LEFT_OUT = (
    r"^---\n.*?^---$|```.*?```|^    [^\n]*$|`[^`]*`|\]\([^)]*\)|\[@[^\]]*\]|\((?:19|20)\d\d[^)]*\)|volume \d+"
    r"|Python 3\.\d+|Energies [\d()]+ \d+|J\. Mech\. Des\. \d+, \d+"
)
#: Numbers of a source, or of a command that the page names and whose answer is not kept
SOURCES = {
    # of `codesign zotov-89 --losses inside`, which test_docs.py runs
    "README.md": {2353},
    "docs/codesign.md": {2353},
    # Timoumi 2008, NASA TM-82646, SETT, and 6.35 kW by its 5.81
    "docs/engine.md": {3958, 977, 704, 288, 5.81, 5.61, 1.09},
    "docs/notation.md": {2.68, 2.75},  # numbers of equations
    "docs/proof.md": {264.312, 93.537, 100.015, 6956, 80559},  # make proof, whose test reads them off the page
    "docs/space.md": {5018, 182, 445},  # python -m benchmarks.space
}


def quoted_numbers(page):
    """Every number in what the commands printed that a page quotes."""
    text = "\n".join(importlib.import_module("walks").quoted(QUOTING[page]).values()) if page in QUOTING else ""
    return [float(n.replace(",", "")) for n in NUMBER.findall(text)]


def rounds(printed, written):
    """Whether a number as written is a printed one at fewer digits, perhaps in thousandths of its unit."""
    digits = len(written.partition(".")[2])
    return any(abs(float(written) - n * scale) <= 0.5001 * 10**-digits for n in printed for scale in (1, 1000))


@pytest.mark.slow
def test_no_page_has_a_number_that_no_command_printed(monkeypatch):
    """Numbers of three digits and more in prose; the heavy suite runs the commands that pages quote."""
    monkeypatch.syspath_prepend(str(ROOT / "docs"))
    known, unknown = printed_numbers(), {}
    for name in PAGES:
        text = re.sub(LEFT_OUT, "", (ROOT / name).read_text(encoding="utf-8"), flags=re.S | re.M)
        own = quoted_numbers(name)
        for written in (n.replace(",", "") for n in NUMBER.findall(text)):
            plain = float(written) in known | SOURCES.get(name, set()) or 1800 < float(written) < 2100
            if len(written.replace(".", "").strip("0")) > 2 and not plain and not rounds(own, written):
                unknown.setdefault(name, []).append(written)
    assert unknown == {}


def test_a_number_as_written_is_a_printed_one_rounded():
    assert rounds([134.4, 6.351], "134") and rounds([6.351], "6351") and rounds([2348.1], "2348")
    assert not rounds([134.4], "135") and not rounds([6.351], "6352") and not rounds([134.4], "134.5")
