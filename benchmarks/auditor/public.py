"""The public bench: formulas as programs, pages and notes print them, and what the auditor says of each."""

import hashlib
from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

from benchmarks.auditor.spoiled import content
from benchmarks.auditor.truth import same
from mechsym.audit.hosts.formula import check_formula
from mechsym.audit.read.reader import CONSTANTS, letter_pairs, read, read_expression
from mechsym.audit.read.spelling import to_python
from mechsym.audit.theory.catalogue import theory
from mechsym.audit.theory.record import known
from mechsym.errors import BadInput

HALVES = ("open", "closed")
LABELS = ("right", "rounded", "approximate", "impure", "wrong")
ANSWERS = ("passed", "flagged", "left open", "unread")
INTRODUCTION = (
    "The public bench: formulas as programs, pages and notes print them, wrong ones and right ones as they came, each",
    "labelled by two truths that share no code with the auditor. Some sources have no address (`unnamed`) and cannot",
    "be looked up again. The open half was looked at while the auditor was improved; of the closed half these counts",
    "and some refusals were seen, and one hand wrote both down: it is not blind. What of it could not be",
    "read was looked at once, and its spellings are read now: of reading the closed half tells nothing any more. A",
    "source belongs to a half by the hash of its name.",
)
_ANSWER = {
    **dict.fromkeys(("exact", "truncation", "convention"), "passed"),
    **dict.fromkeys(("misprint", "nearer", "wrong"), "flagged"),
    **dict.fromkeys(("mixed", "untestable"), "left open"),
}


def formulas(half: str = "") -> list[dict[str, Any]]:
    """The rows of the bench, or of one half of it, with their source."""
    return [
        {**formula, "where": source["where"]}
        for source in content("public.toml")["source"]
        if half in ("", half_of(source["where"]))
        for formula in source["formula"]
    ]


def half_of(where: str) -> str:
    """Half that a source belongs to, by the hash of its name: the closed one is not looked at while tuning."""
    return HALVES[hashlib.sha256(where.encode()).digest()[0] % 2]


def asked(formula: Mapping[str, Any]) -> dict[str, Any]:
    """What the auditor says of one formula: its answer, verdict, note and correction, and whether that is right."""
    more = {k: formula[k] for k in ("letters", "assume") if k in formula}
    try:
        row = check_formula(formula["text"], formula["against"], **more)
    except BadInput as error:
        return {"answer": "unread", "verdict": "unread", "note": str(error), "correction": "", "repaired": False}
    correction = str(row["correction"] or "")
    repaired = bool(correction) and "right" in formula and _same(formula, correction)
    return {
        "answer": _ANSWER[row["verdict"]], "verdict": row["verdict"], "note": row["note"], "correction": correction,
        "repaired": repaired,
    }  # fmt: skip


def _same(formula: Mapping[str, Any], correction: str) -> bool:
    # compared by the trial's own evaluator; the author's letters as they were told
    found = theory(formula["against"].partition(".")[0])
    asked_for = read(formula["text"], known(found), letter_pairs(formula.get("letters", "")), found.tape)
    own = {name: text for name, tree in asked_for.letters.items() if (text := to_python(tree)) != name}
    names = [*asked_for.letters, *known(found), *CONSTANTS]
    plain = to_python(read_expression(correction, names, found.tape)[0])
    truths = content("public_letters.toml")[found.name]
    return same(plain, formula["right"], truths["ranges"], {**truths.get("define", {}), **own})


def bench(half: str) -> dict[str, Any]:
    """Counts of one half: what was said of what, findings, repairs, and what could not be read."""
    rows = formulas(half)
    found = [asked(row) for row in rows]
    pairs = Counter((row["label"], told["answer"]) for row, told in zip(rows, found, strict=True))
    return {
        "sources": len({row["where"] for row in rows}),
        "named": len({row["where"] for row in rows if not row["where"].startswith("unnamed")}),
        "formulas": len(rows),
        "answers": {label: {a: pairs[label, a] for a in ANSWERS} for label in LABELS},
        "corrected": sum(bool(t["correction"]) for t in found),
        "repaired": sum(t["repaired"] for t in found),
    }


def rates(found: Mapping[str, Any]) -> dict[str, tuple[int, int]]:
    """Hits and of how many: precision and recall of findings, repairs, what is right and passed, what was read."""
    answers = found["answers"]
    flagged = sum(row["flagged"] for row in answers.values())
    wrong, fine = sum(answers["wrong"].values()), ("right", "rounded", "approximate")
    return {
        "precision of findings": (answers["wrong"]["flagged"], flagged),
        "recall of errors": (answers["wrong"]["flagged"], wrong),
        "errors repaired": (found["repaired"], wrong),
        "right ones passed": (sum(answers[k]["passed"] for k in fine), sum(sum(answers[k].values()) for k in fine)),
        "read": (found["formulas"] - sum(row["unread"] for row in answers.values()), found["formulas"]),
    }


def lines(found: Mapping[str, Mapping[str, Any]]) -> Sequence[str]:
    """The public bench as Markdown, a table for each half."""
    shown = []
    for half in HALVES:
        now = found[half]
        shown += [
            f"The {half} half, {now['formulas']} formulas of {now['sources']} sources:", "",
            f"| what it is | n | {' | '.join(ANSWERS)} |", "|---" * (len(ANSWERS) + 2) + "|",
            *(
                f"| {label} | {sum(row.values())} | {' | '.join(str(row[a]) for a in ANSWERS)} |"
                for label, row in now["answers"].items()
            ),
            "", "; ".join(f"{name} {hits} of {of}" for name, (hits, of) in rates(now).items()) + ".", "",
        ]  # fmt: skip
    return shown[:-1]
