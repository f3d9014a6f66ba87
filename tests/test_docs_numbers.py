"""Numbers of the README and of the paper are those that commands print: kept answers, the errata, docs/printed."""

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
    """Every number in what commands printed."""
    texts = [path.read_text(encoding="utf-8") for path in (*RECORDED.rglob("*.json"), *PRINTED.iterdir())]
    return {float(n.replace(",", "")) for text in (*texts, ERRATA) for n in NUMBER.findall(text)}


PAGES = ["README.md", "paper/paper.md", *sorted(f"docs/theory/{p.name}" for p in (ROOT / "docs/theory").glob("*.md"))]
# what is no number of a result: blocks, code, links, years of sources
LEFT_OUT = r"^---\n.*?^---$|```.*?```|`[^`]*`|\]\([^)]*\)|\[@[^\]]*\]|\((?:19|20)\d\d[^)]*\)|volume \d+|Python 3\.\d+"


@pytest.mark.slow
def test_no_page_has_a_number_that_no_command_printed():
    """Numbers of three digits and more in prose; those of co-design in the README are held by the heavy suite."""
    known, unknown = printed_numbers(), {}
    for name in PAGES:
        text = re.sub(LEFT_OUT, "", (ROOT / name).read_text(encoding="utf-8"), flags=re.S | re.M)
        text = re.sub(r"What a co-designed hinge is worth.*?\n\n", "", text, flags=re.S)
        numbers = [n.replace(",", "") for n in NUMBER.findall(text)]
        told = [float(n) for n in numbers if len(n.replace(".", "").strip("0")) > 2]
        unknown[name] = [n for n in told if n not in known and not 1800 < n < 2100]
    assert {name: numbers for name, numbers in unknown.items() if numbers} == {}
