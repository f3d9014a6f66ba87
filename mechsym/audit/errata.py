"""docs/errata.md: one readable entry per finding, written by the audit and never by hand."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from mechsym.audit.entries import Audited
from mechsym.audit.findings import Row
from mechsym.audit.trial.matrix import lines

PATH = Path("docs") / "errata.md"
_TITLES = {
    "misprint": "Misprint", "wrong": "Wrong", "nearer": "Wrong", "mixed": "Mixed", "truncation": "Truncation",
    "convention": "Convention", "untestable": "Untestable", "unsupported claim": "Unsupported claim",
    "supported claim": "Supported claim",
}  # fmt: skip


def text(sources: Sequence[Audited], rows: Sequence[Row], found: Mapping[str, Any]) -> str:
    """The errata of all sources."""
    parts = [_HEAD, _summary(sources, rows)]
    for source in sources:
        own = [r for r in rows if r["source"] == source.stem]
        entries = [_entry(r) for r in own if r["verdict"] in _TITLES]
        parts.append(f"## {source.title}\n\nIn commands: `{source.name}`.")
        parts += entries or ["Nothing to report."]
        remarks = [
            f"- {_where(r)}, {_plain(r['claim'])}: {_plain(r['note'])}."
            for r in own
            if r["note"] and r["verdict"] not in _TITLES
        ]
        if remarks:
            parts += ["### Remarks on the other relations", "\n".join(remarks)]
    if not found:
        return "\n\n".join(parts) + "\n"
    parts += ["## How far the auditor can be trusted", _TRUST, "\n".join(lines(found))]
    misses = [f"- `{line}`" for name in ("one slip", "two slips") for line in found[name]["not repaired"]]
    parts += ["Spoiled formulas that did not come back (theory.quantity [slip]: spoiled -> what was said):"]
    return "\n\n".join([*parts, "\n".join(misses)]) + "\n"


_TRUST = """The formulas of this table are no formulas of the sources. They are spoiled by a program that shares no
code with the repair search, and every correction is judged by an evaluator of its own, to 30 digits. A
formula is passed when it is called exact, a truncation, or right under a convention."""

_HEAD = """# Errata of the sources

What this page says, for a reader who has never seen the program. Five papers print formulas for engines and their
mechanisms. Each formula was compared with the same quantity derived anew, from the mechanism's geometry and Lagrange's
equations, at random states and to 40 digits. Where the two differ, a search looks for the one slip of the pen that
explains it. An entry below shows the formula as printed, as corrected, and what the slip does to a number that matters.
Each formula has one of these verdicts:

- *exact*: the same function. *truncation*: the same but for powers of lambda = crank/rod that are left out; each
  one that is printed is right.
- *convention*: right under a condition that the paper takes for granted, such as constant speed.
- *mixed*: as good as a truncation, with some powers neither right nor left out: no slip, and no series either.
- *misprint*: wrong as printed, and one change, found by search, makes it right. It is printed below the formula.
- *nearer*, *wrong*: no such change was found. *untestable*: it has no value where the quantity has one.
- *definition*, *empirical*: nothing to derive. *supported*, *unsupported claim*: a sentence of the text, recomputed.

"Largest relative error 0.11" means: over one turn at the paper's own data the printed formula is off by at most 11 % of
the right value (near a zero of it, of a tenth of its peak). "Relative order 3" means that the error falls as lambda^3.
Formulas stand as printed, letters spelled out. Written by `make audit`; do not edit."""


def _summary(sources: Sequence[Audited], rows: Sequence[Row]) -> str:
    verdicts = list(dict.fromkeys(r["verdict"] for r in rows))
    head = f"| source | {' | '.join(verdicts)} |"
    body = [head, "|---" * (len(verdicts) + 1) + "|"]
    for source in sources:
        own = [r["verdict"] for r in rows if r["source"] == source.stem]
        body.append(f"| {source.name} | {' | '.join(str(own.count(v)) for v in verdicts)} |")
    return "\n".join(body)


def _entry(row: Row) -> str:
    parts = [f"### {_TITLES[row['verdict']]}: {_where(row)}, {_plain(row['claim'])}"]
    if row["printed"]:
        parts.append(f"As printed:\n\n    {row['printed']}")
    if row["correction"]:
        parts.append(f"Corrected:\n\n    {row['correction']}")
    sentence = _numbers(row)
    parts += [s for s in (sentence, _plain(_sentences(row["note"]))) if s]
    return "\n\n".join(parts)


def _where(row: Row) -> str:
    return f"({row['equation']})" if row["equation"][0].isdigit() else row["equation"]


def _numbers(row: Row) -> str:
    if row["verdict"].endswith("claim"):
        return ""
    found = [f"Largest relative error {row['max_rel_error']:.3g}"]
    if row["corrected_max_rel_error"] is not None:
        found.append(f"{_small(row['corrected_max_rel_error'])} when corrected")
    if row["order"] is not None:
        found.append("leading term wrong" if row["order"] < 0 else f"relative order {row['order']} in lambda")
    return ", ".join(found) + "."


def _sentences(note: str) -> str:
    return " ".join(f"{_capital(part)}." for part in note.split("; ") if part)


def _plain(sentence: str) -> str:
    """A sentence whose formulas keep their products: in Markdown two stars are the ends of italics."""
    return sentence.replace("*", r"\*")


def _capital(sentence: str) -> str:
    # a letter of a formula keeps its case
    word = sentence.split()[0]
    return sentence[0].upper() + sentence[1:] if word.isalpha() and len(word) > 1 or word == "a" else sentence


def _small(error: float) -> str:
    return "exact" if error < 1e-10 else f"{error:.3g}"
