"""Everything that the auditor is tried on, counted by what it said: the confusion matrix of docs/errata.md."""

import json
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from benchmarks.auditor import public
from benchmarks.auditor.spoiled import Spoiled, content, doubles, literature, singles
from mechsym.audit.hosts.formula import check_formula
from mechsym.audit.hosts.sources import TRIAL
from mechsym.audit.judge.asked import Asked, question_of
from mechsym.audit.judge.prover import agreement, judges
from mechsym.audit.read.reader import statement
from mechsym.files import to_json, write_text

VERDICTS = ("exact", "truncation", "convention", "mixed", "untestable", "misprint", "nearer", "wrong")
SEED = 31  # not the one that the search was looked at with
SINGLE_KINDS, DOUBLES = 5, 2  # how often each form is spoiled
STEPS = 8  # how often `done` is called
_STORED = Path(__file__).parent / "results.json"
_SECTION = Path(__file__).parents[2] / TRIAL


def trial(done: Callable[[], Any] = lambda: None) -> dict[str, Any]:
    """Try the auditor: right formulas, traps, formulas at constant speed, formulas spoiled once and twice."""
    forms = content("forms.toml")["form"]
    asked = {
        "right": [(f["text"], f["against"]) for f in forms],
        "constant speed": list(constant_speed()),
    }
    verdicts = {"traps": Counter(trapped())}
    for name, pairs in asked.items():
        verdicts[name] = Counter(check_formula(*pair)["verdict"] for pair in pairs)
        done()
    once = counted(singles(SINGLE_KINDS, SEED))
    done()
    twice = counted(doubles(DOUBLES, SEED))
    done()
    listed = counted(literature(), by_kind=False)
    done()
    benches = {}
    for half in public.HALVES:
        benches[half] = public.bench(half)
        done()
    return {
        "verdicts": {k: dict(sorted(v.items())) for k, v in verdicts.items()}, "one slip": once, "two slips": twice,
        "literature": listed,
        "public": benches,
    }  # fmt: skip


def trapped() -> Iterator[str]:
    """Of every trap, whether it is called exact; what else is said of it does not matter."""
    for trap in content("traps.toml")["trap"]:
        for text in trap["texts"]:
            question = question_of(Asked(text=text, against=trap["against"]), statement(text))
            yield "exact" if agreement(judges(question), question.formula.tree).exact else "not exact"


def constant_speed() -> Iterator[tuple[str, str]]:
    """Textbook formulas at constant speed, and what they are."""
    found = content("constant_speed.toml")
    for quantity, place in found["places"].items():
        for spelling in found["accelerations"]:
            yield place.format(a=spelling), f"slider_crank.{quantity}"
    for quantity, texts in found["also"].items():
        for text in texts:
            yield text, f"slider_crank.{quantity}"


def counted(spoiled: Sequence[Spoiled], by_kind: bool = True) -> dict[str, Any]:
    """Counts of spoiled formulas: how many were refuted, corrected, and corrected to the right function."""
    kinds = sorted({k for s in spoiled for k in s.kind.split(", ")}) if by_kind else []
    sorted_out = {k: [s for s in spoiled if k in s.kind.split(", ")] for k in kinds}
    return {
        "asked": len(spoiled),
        "verdicts": dict(sorted(Counter(s.verdict for s in spoiled).items())),
        "refuted": sum(not s.passed for s in spoiled),
        "corrected": sum(bool(s.correction) for s in spoiled),
        "repaired": sum(s.repaired for s in spoiled),
        "by kind": {k: [sum(s.repaired for s in v), len(v)] for k, v in sorted_out.items()},
        "not repaired": [_told(s) for s in spoiled if not s.repaired],
    }


def _told(spoiled: Spoiled) -> str:
    instead = spoiled.correction or f"judged {spoiled.verdict}"
    return f"{spoiled.against} [{spoiled.kind}]: {spoiled.text} -> {instead}"


def stored() -> dict[str, Any]:
    """The results of the last trial that was recorded; empty where there is none."""
    return json.loads(_STORED.read_text(encoding="utf-8")) if _STORED.is_file() else {}


def record(found: Mapping[str, Any]) -> None:
    """Record the results of a trial, and the section of docs/errata.md that tells of them."""
    write_text(_STORED, to_json(found) + "\n")
    write_text(_SECTION, section(found))


_TRUST = """The formulas of this table are no formulas of the sources. They are spoiled by a program that shares no
code with the repair search, and every correction is judged by an evaluator of its own, to 30 digits. A
formula is passed when it is called exact, a truncation, or right under a convention."""


def section(found: Mapping[str, Any]) -> str:
    """How far the auditor can be trusted, as Markdown."""
    misses = [f"- `{line}`" for name in _spoiled(found) for line in found[name]["not repaired"]]
    spoiled = "Spoiled formulas that did not come back (theory.quantity [slip]: spoiled -> what was said):"
    parts = ["## How far the auditor can be trusted", _TRUST, "\n".join(lines(found)), spoiled, "\n".join(misses)]
    return "\n\n".join(parts) + "\n"


def lines(found: Mapping[str, Any]) -> list[str]:
    """The confusion matrix and the rates, as Markdown."""
    traps = found["verdicts"]["traps"]
    rows = {k: v for k, v in found["verdicts"].items() if k != "traps"}
    rows |= {k: found[k]["verdicts"] for k in _spoiled(found)}
    head = [f"| what was asked | n | {' | '.join(VERDICTS)} |", "|---" * (len(VERDICTS) + 2) + "|"]
    body = [
        f"| {_ROWS[name]} | {sum(row.values())} | {' | '.join(str(row.get(v, 0)) for v in VERDICTS)} |"
        for name, row in rows.items()
    ]
    trap = (
        f"- traps, right for one sign or on one branch: {traps.get('exact', 0)} of {sum(traps.values())} called exact"
    )
    rates = (_rates(k, found[k]) for k in _spoiled(found))
    shown = ["", *public.INTRODUCTION, "", *public.lines(found["public"])] if "public" in found else []
    return [*head, *body, "", trap, *rates, *shown]


_ROWS = {
    "right": "right formulas, exact",
    "constant speed": "textbook formulas at constant speed", "one slip": "spoiled once", "two slips": "spoiled twice",
    "literature": "spoiled by a person's list",
}  # fmt: skip


def _spoiled(found: Mapping[str, Any]) -> list[str]:
    return [k for k in ("one slip", "two slips", "literature") if k in found]


def _rates(name: str, found: Mapping[str, Any]) -> str:
    asked, corrected = found["asked"], found["corrected"]
    kinds = ", ".join(f"{kind} {right}/{of}" for kind, (right, of) in found["by kind"].items())
    return (
        f"- {_ROWS[name]}: {100 * found['refuted'] / asked:.1f} % not passed ({found['refuted']} of {asked}), "
        f"{100 * found['repaired'] / asked:.1f} % repaired to the right function ({found['repaired']}), "
        f"{100 * found['repaired'] / max(corrected, 1):.1f} % of the corrections right ({found['repaired']} of "
        f"{corrected}); repaired by slip: {kinds}"
    )
