"""Certificate files: which exact verdicts become Coq scripts, and what says so in their heads."""

from collections.abc import Iterable, Sequence

from mechsym.audit.certificate import HEAD, script
from mechsym.audit.entries import Audited, Printed
from mechsym.audit.findings import Row, question_of
from mechsym.audit.formula import Asked
from mechsym.audit.formula import question_of as question_asked
from mechsym.audit.statement import statement
from mechsym.errors import BadInput


def of_formula(asked: Asked, row: Row) -> str:
    """The file of a formula of one's own; refused where the verdict is not proved by polynomials."""
    found = None
    if _is_proved(row):
        question = question_asked(asked, statement(asked.text))
        found = script(question, question.formula.tree, "formula")
    if found is None:
        proof = (row["evidence"] or {}).get("certificate") or "no proof"
        raise BadInput(
            f"--certificate: the verdict is {row['verdict']} by {proof}; only what is exact by polynomials, in sines, "
            "cosines and square roots, has a Coq script"
        )
    return "\n".join([HEAD, _comment(row), found])


def of_sources(sources: Iterable[Audited], rows: Sequence[Row]) -> tuple[str, list[str]]:
    """The file of all exact verdicts of sources, and the equations that are proved and have no script."""
    entries = [(source, number, entry) for source in sources for number, entry in enumerate(source.entries, start=1)]
    parts, without = [HEAD], []
    for (source, number, entry), row in zip(entries, rows, strict=True):
        if not isinstance(entry, Printed) or not _is_proved(row):
            continue
        question = question_of(entry)
        found = script(question, question.formula.tree, f"{source.name}_{number}")
        if found is None:
            without.append(f"{source.name} ({entry.equation}) {entry.claim}")
        else:
            parts += [_comment(row), found]
    return "\n".join(parts), without


def _is_proved(row: Row) -> bool:
    return row["verdict"] == "exact" and row["evidence"].get("certificate") == "polynomial"


def _comment(row: Row) -> str:
    # Coq's comments nest, and look for strings
    head = f"{row['source']} ({row['equation']})" if row["equation"] != "-" else row["source"]
    text = f"{head}, {row['claim']}: {row['printed'].strip()}"
    return f"(* {text.replace('(*', '( *').replace('*)', '* )').replace(chr(34), chr(39))} *)"
