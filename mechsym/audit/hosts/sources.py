"""What a paper holds, and its rows: printed formulas, relations, claims of the text; their Coq file, their errata."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import field
from pathlib import Path
from typing import Protocol

import numpy as np

from mechsym import budget
from mechsym.audit.hosts.formula import SECONDS
from mechsym.audit.judge.asked import Asked
from mechsym.audit.judge.asked import question_of as question_asked
from mechsym.audit.judge.certificate import script
from mechsym.audit.judge.coq import HEAD
from mechsym.audit.judge.question import Question, peak, turn, value
from mechsym.audit.read.reader import read
from mechsym.audit.read.statement import statement
from mechsym.audit.row import Row, formula_row, plain_row
from mechsym.audit.theory.catalogue import theory
from mechsym.audit.theory.record import known
from mechsym.audit.verdict import FINDINGS, Decision, decide
from mechsym.errors import BadInput
from mechsym.quantities import record

NAME = ("source", "equation", "claim")
COMPARED = ("verdict", "order", "correction")
Turn = Mapping[str, Callable[[np.ndarray], np.ndarray]]


@record
class Printed:
    """A formula as printed, and the derived quantity that it claims to be."""

    equation: str  #: Bare number; several parts of one equation share it
    claim: str  #: What it claims to be, in words
    statement: str  #: Transcribed as printed, in the author's letters
    quantity: str
    #: Author's letter to its expression in the theory's letters
    letters: Mapping[str, str] = field(default_factory=dict)
    hold: Mapping[str, float] = field(default_factory=dict)  #: Letters that the source's assumptions fix
    note: str = ""  #: What else there is to say
    turn: Callable[[], Turn] | None = None  #: Makes the letters that change over a turn in the source's data
    #: Takes the verdict and says how large the error is in a number that matters
    effect: Callable[[Decision], str] | None = None


@record
class Listed:
    """A relation that is not there to be proved."""

    equation: str
    claim: str
    statement: str
    verdict: str
    note: str = ""  #: What else there is to say


@record
class Decided:
    """The outcome of the computation that a claim of the text is tied to."""

    supported: bool  #: Whether the computation bears the claim out
    note: str
    #: Relative difference of claimed and computed value, where the claim is a number [-]
    rel_error: float | None = None


@record
class TextClaim:
    """A claim made in words."""

    equation: str  #: Where it stands: `text`, `abstract`, `conclusion 3`
    claim: str
    decide: Callable[[], Decided]


Entry = Printed | Listed | TextClaim


class Audited(Protocol):
    """A source as the auditor needs it: a paper of `mechsym.papers`."""

    @property
    def stem(self) -> str:
        """Of its file."""

    @property
    def name(self) -> str:
        """In one word."""

    @property
    def title(self) -> str:
        """Authors, year and title."""

    @property
    def entries(self) -> tuple[Entry, ...]:
        """Everything that is audited, in the order of the text."""


def question_of(entry: Printed) -> Question:
    """The question that a printed formula raises, with the data of its source."""
    name, _, quantity = entry.quantity.partition(".")
    derived = theory(name)
    return Question(
        formula=read(entry.statement, known(derived), entry.letters),
        theory=derived,
        quantity=quantity,
        hold=entry.hold,
        turn=entry.turn() if entry.turn else {},
    )


def rows(sources: Iterable[Audited], done: Callable[[], object] = lambda: None) -> list[Row]:
    """One row for each entry of the sources, in the order of the text."""
    answers, sources = [], list(sources)
    count = sum(len(source.entries) for source in sources)
    budget.require(f"{count} formulas of sources", SECONDS * count, 0.0, "name one --source")
    for source in sources:
        for entry in source.entries:
            answers.append(row(source.stem, entry))
            done()
    return answers


def row(source: str, entry: Entry) -> Row:
    """The verdict on one entry: the documented keys, and printed, evidence, effect."""
    head = {"source": source, "equation": entry.equation, "claim": entry.claim}
    if isinstance(entry, Listed):
        return head | plain_row(entry.verdict, None, entry.note, entry.statement)
    if isinstance(entry, TextClaim):
        decided = entry.decide()
        verdict = "supported claim" if decided.supported else "unsupported claim"
        error = None if decided.rel_error is None else abs(decided.rel_error)
        return head | plain_row(verdict, error, decided.note, "")
    question = question_of(entry)
    decision = decide(question, settled=True)
    effect = entry.effect(decision) if entry.effect else _at_the_data(question, decision)
    return head | formula_row(question, decision, entry.statement, entry.note, effect)


def _at_the_data(question: Question, decision: Decision) -> str:
    # what a wrong formula does to the number that it stands for
    if decision.verdict not in FINDINGS:
        return ""
    asked = turn(question)
    printed, derived = peak(value(asked, question.formula.tree)), peak(asked.expected)
    unit = question.theory.units.get(question.quantity, "").removesuffix("-")
    right, own = f"{derived:.4g} {unit}".strip(), f"{printed:.4g} {unit if decision.dimensions else ''}".strip()
    where = "the largest value over a turn at the source's data" if question.theory.angle else "at the source's data it"
    return f"{where} is {own} as printed and {right} as derived"


def certificate_of_formula(asked: Asked, row: Row) -> str:
    """The Coq file of a formula of one's own; refused where the verdict is not exact, or nothing proves it."""
    proof = None
    if row["verdict"] == "exact":
        question = question_asked(asked, statement(asked.text))
        proof = script(question, question.formula.tree, "formula")
    if proof is None:
        raise BadInput(
            f"--certificate: the verdict is {row['verdict']}; only what is exact and rational in letters, sines, "
            "cosines, roots and powers has a Coq script"
        )
    return "\n".join([HEAD, _comment(row), proof])


def certificate_of_sources(sources: Iterable[Audited], rows: Sequence[Row]) -> tuple[str, list[str]]:
    """The Coq file of all exact verdicts of sources, and the equations that are exact and have no script."""
    entries = [(source, number, entry) for source in sources for number, entry in enumerate(source.entries, start=1)]
    parts, without = [HEAD], []
    for (source, number, entry), row in zip(entries, rows, strict=True):
        if not isinstance(entry, Printed) or row["verdict"] != "exact":
            continue
        question = question_of(entry)
        proof = script(question, question.formula.tree, f"{source.name}_{number}")
        if proof is None:
            without.append(f"{source.name} ({entry.equation}) {entry.claim}")
        else:
            parts += [_comment(row), proof]
    return "\n".join(parts), without


def _comment(row: Row) -> str:
    # Coq's comments nest, and look for strings
    head = f"{row['source']} ({row['equation']})" if row["equation"] != "-" else row["source"]
    text = f"{head}, {row['claim']}: {row['printed'].strip()}"
    return f"(* {text.replace('(*', '( *').replace('*)', '* )').replace(chr(34), chr(39))} *)"


ERRATA = Path("docs") / "errata.md"  #: Written by the audit and never by hand
TRIAL = Path("benchmarks") / "auditor" / "trial.md"  #: Section that the last trial of the auditor wrote
_TITLES = {
    "misprint": "Misprint", "wrong": "Wrong", "nearer": "Wrong", "mixed": "Mixed", "truncation": "Truncation",
    "convention": "Convention", "untestable": "Untestable", "unsupported claim": "Unsupported claim",
    "supported claim": "Supported claim",
}  # fmt: skip
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


def errata(sources: Sequence[Audited], rows: Sequence[Row], trial: str) -> str:
    """The errata of all sources, and last the section of a trial of the auditor."""
    verdicts = list(dict.fromkeys(r["verdict"] for r in rows))
    table = [f"| source | {' | '.join(verdicts)} |", "|---" * (len(verdicts) + 1) + "|"]
    parts: list[str] = []
    for source in sources:
        own = [r for r in rows if r["source"] == source.stem]
        counts = [str(sum(r["verdict"] == v for r in own)) for v in verdicts]
        table.append(f"| {source.name} | {' | '.join(counts)} |")
        parts.append(f"## {source.title}\n\nIn commands: `{source.name}`.")
        parts += [_entry(r) for r in own if r["verdict"] in _TITLES] or ["Nothing to report."]
        others = [r for r in own if r["note"] and r["verdict"] not in _TITLES]
        remarks = [f"- {_where(r)}, {_plain(r['claim'])}: {_plain(r['note'])}." for r in others]
        if remarks:
            parts += ["### Remarks on the other relations", "\n".join(remarks)]
    return "\n\n".join([_HEAD, "\n".join(table), *parts, trial]) + ("" if trial else "\n")


def _entry(row: Row) -> str:
    parts = [f"### {_TITLES[row['verdict']]}: {_where(row)}, {_plain(row['claim'])}"]
    if row["printed"]:
        parts.append(f"As printed:\n\n    {row['printed']}")
    if row["correction"]:
        parts.append(f"Corrected:\n\n    {row['correction']}")
    if not row["verdict"].endswith("claim"):
        errors = [f"Largest relative error {row['max_rel_error']:.3g}"]
        left = row["corrected_max_rel_error"]
        if left is not None:
            errors.append(f"{'exact' if left < 1e-10 else format(left, '.3g')} when corrected")
        if row["order"] is not None:
            errors.append("leading term wrong" if row["order"] < 0 else f"relative order {row['order']} in lambda")
        parts.append(", ".join(errors) + ".")
    sentences = _plain(" ".join(f"{_capital(part)}." for part in row["note"].split("; ") if part))
    return "\n\n".join([*parts, sentences] if sentences else parts)


def _where(row: Row) -> str:
    return f"({row['equation']})" if row["equation"][0].isdigit() else row["equation"]


def _plain(sentence: str) -> str:
    # in Markdown two stars are the ends of italics: products of formulas keep theirs
    return sentence.replace("*", r"\*")


def _capital(sentence: str) -> str:
    # a letter of a formula keeps its case
    word = sentence.split()[0]
    return sentence[0].upper() + sentence[1:] if word.isalpha() and len(word) > 1 or word == "a" else sentence
