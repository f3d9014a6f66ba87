"""docs/errata.md: one readable entry per finding, written by the audit and never by hand."""

from collections.abc import Sequence
from pathlib import Path

from mechsym.audit.entries import Audited
from mechsym.audit.findings import Row
from mechsym.audit.trust import Trust, lines

PATH = Path("docs") / "errata.md"
_TITLES = {
    "misprint": "Misprint", "wrong": "Wrong", "approximate": "Approximate", "unsupported claim": "Unsupported claim",
    "supported claim": "Supported claim",
}  # fmt: skip


def text(sources: Sequence[Audited], rows: Sequence[Row], found: Trust) -> str:
    """The errata of all sources."""
    parts = [_HEAD, _summary(sources, rows)]
    for source in sources:
        own = [r for r in rows if r["source"] == source.stem]
        entries = [_entry(r) for r in own if r["verdict"] in _TITLES]
        parts.append(f"## {source.title}\n\nSource `{source.stem}` (`{source.name}`).")
        parts += entries or ["Nothing to report."]
        remarks = [
            f"- {_where(r)}, {r['claim']}: {r['note']}." for r in own if r["note"] and r["verdict"] not in _TITLES
        ]
        if remarks:
            parts += ["### Remarks on the other relations", "\n".join(remarks)]
    parts.append("## How far the auditor can be trusted")
    parts.append("\n".join(f"- {line}" for line in lines(found)[:2]))
    misses = lines(found)[2:]
    if misses:
        parts.append("Spoiled formulas that did not come back (theory.quantity [slip]: spoiled -> what was found):")
        parts.append("\n".join(f"- `{line.partition(': ')[2]}`" for line in misses))
    return "\n\n".join(parts) + "\n"


_HEAD = """# Errata of the sources

Written by `make audit` from the derivations; do not edit. Each formula is given as printed (letters spelled out), with
the correction that the repair search found and the largest relative error over a turn at the source's data. An
approximation is honest when its error is at most that of leaving out the first power of lambda that it neglects."""


def _summary(sources: Sequence[Audited], rows: Sequence[Row]) -> str:
    verdicts = list(dict.fromkeys(r["verdict"] for r in rows))
    head = f"| source | {' | '.join(verdicts)} |"
    body = [head, "|---" * (len(verdicts) + 1) + "|"]
    for source in sources:
        own = [r["verdict"] for r in rows if r["source"] == source.stem]
        body.append(f"| {source.name} | {' | '.join(str(own.count(v)) for v in verdicts)} |")
    return "\n".join(body)


def _entry(row: Row) -> str:
    parts = [f"### {_TITLES[row['verdict']]}: {_where(row)}, {row['claim']}"]
    if row["printed"]:
        parts.append(f"As printed:\n\n    {row['printed']}")
    if row["correction"]:
        parts.append(f"Corrected:\n\n    {row['correction']}")
    sentence = _numbers(row)
    parts += [s for s in (sentence, _sentences(row["note"])) if s]
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


def _capital(sentence: str) -> str:
    # a letter of a formula keeps its case
    word = sentence.split()[0]
    return sentence[0].upper() + sentence[1:] if word.isalpha() and len(word) > 1 or word == "a" else sentence


def _small(error: float) -> str:
    return "exact" if error < 1e-10 else f"{error:.3g}"
