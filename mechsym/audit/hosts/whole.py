"""A whole text audits itself: each equation against what the text says elsewhere, its units, and theories that fit.

An equation is one row. A finding is said only where one slip of the pen explains it, or where units cannot be right;
where the text says something else with other letters nothing is said.
"""

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

from mechsym import budget
from mechsym.audit.hosts.asking import Asking
from mechsym.audit.hosts.equations import Judge
from mechsym.audit.hosts.judged import AGREES, Judged
from mechsym.audit.hosts.paper import CARRIED, EquationPlace, few
from mechsym.audit.hosts.worded import Worded
from mechsym.audit.judge import fit as fitting
from mechsym.audit.judge import misfits as of_units
from mechsym.audit.judge.kinds import kinds_of
from mechsym.audit.judge.lagrangian import Energies, laws
from mechsym.audit.judge.table_slips import TableSlip, table_slips
from mechsym.audit.judge.twins import Twins
from mechsym.audit.judge.world import World
from mechsym.audit.read.displays import Displayed
from mechsym.audit.read.notebook import LONGEST, words_of_notebook
from mechsym.audit.read.reader import joined
from mechsym.audit.read.restructured import with_dollars
from mechsym.audit.read.said import Said, Text, read_text_whole
from mechsym.audit.row import Row, html, plain_row, unread_row
from mechsym.audit.verdict import FINDINGS, PASSED
from mechsym.errors import BadInput
from mechsym.files.inputs import read_any_text
from mechsym.quantities import record, results
from mechsym.quantities.results import part, result, tell

SUFFIXES = (".tex", ".md", ".rst", ".txt", ".ipynb")
_PLAIN = {".ipynb": words_of_notebook, ".rst": with_dollars}  #: How the text of a file is got
_LARGEST = 8_000_000  # characters of a file
_SEARCHES, _EACH = 48, 3  # searches for a slip in one text: so many, or so many an equation where these are more
_SECONDS = 0.07  # that an equation of a text takes in the mean (measured: 0.04 of 2,440, 0.07 of 305) [s]


@result
class Coverage:
    """How much of a text was read and judged."""

    equations: int = results.quantity("-")  #: Displayed in the text
    read: int = results.quantity("-")  #: Understood as a formula
    matched: int = results.quantity("-")  #: Compared with something
    judged: int = results.quantity("-")  #: With a verdict
    by_units: int = results.quantity("-")  #: Of these, by their units alone
    unread: list[str] = part()


@record
class TextFile:
    """A file, and what is read of it, or why nothing is."""

    file: Path
    paper: Text | None
    refused: BadInput | None = None


def read_texts(path: Path) -> list[TextFile]:
    """A text, or all texts of a folder. Raises BadInput: none is read, or they take longer than the budget."""
    inside = (p for p in path.rglob("*") if not any(part.startswith(".") for part in p.relative_to(path).parts))
    files = sorted(p for p in inside if p.suffix in SUFFIXES and p.is_file()) if path.is_dir() else [path]
    if not files:
        raise BadInput(f"{path}: there is no {', '.join(SUFFIXES)} in it")
    texts = [_text_of(file) for file in files]
    refused = [text.refused for text in texts if text.refused is not None]
    if len(refused) == len(files):
        raise refused[0]
    if not (count := count_of(texts)):
        raise BadInput(f"{path}: there is no display equation in it; equation, align, gather, \\[ \\] and $$ are read")
    budget.require(f"{path}: the audit of {count} equations", _SECONDS * count, 0.0, "give a part of it")
    return texts


def _text_of(file: Path) -> TextFile:
    try:
        text = read_any_text(file, LONGEST if file.suffix == ".ipynb" else _LARGEST)
        return TextFile(
            file=file, paper=read_text_whole(_PLAIN.get(file.suffix, str)(text), marked=file.suffix in _PLAIN)
        )
    except BadInput as error:
        why = error if str(file) in str(error) else BadInput(f"{file}: {error}")
        return TextFile(file=file, paper=None, refused=why)


def count_of(texts: Sequence[TextFile]) -> int:
    """How many rows texts have."""
    return sum(1 if text.paper is None else sum(not said.inline for said in text.paper.said) for text in texts)


def check_texts(texts: Sequence[TextFile], step: Callable[[], object] = lambda: None) -> tuple[list[Row], Coverage]:
    """The rows of texts, and how much of them was judged. step: called after each row."""
    rows = []
    for text in texts:
        for row in _rows_of(text):
            rows.append(row)
            step()
    return rows, coverage(rows)


def coverage(rows: Sequence[Row]) -> Coverage:
    """How much of a text was read and judged."""
    judged = [r for r in rows if r["verdict"] in (*PASSED, *FINDINGS, CARRIED, AGREES)]
    return Coverage(
        equations=len(rows), read=sum(r["read"] for r in rows), matched=sum(bool(r["matched"]) for r in rows),
        judged=len(judged), by_units=sum(r["verdict"] == AGREES for r in judged),
        unread=[f"{r['file']}:{r['line']}: {r['note']}" for r in rows if not r["read"]],
    )  # fmt: skip


def _rows_of(text: TextFile) -> Iterator[Row]:
    paper = text.paper
    if paper is None:  # of a folder the others are read all the same
        nothing = Said(shown=Displayed(number="", label="", text="", line=1), name="file", why=str(text.refused))
        yield _row(text.file, nothing, None, ())
        return
    kinds = kinds_of(paper)
    misfits, _ = of_units.odd(kinds, paper.said)
    slips, left = table_slips(paper, kinds, misfits)
    odd: dict[str, list[of_units.Odd]] = {}
    for one in of_units.findings(kinds, left, paper.said):
        odd.setdefault(of_units.id_of(one.said), []).append(one)
    _, fitted = of_units.odd(kinds, paper.said)
    world = World(paper=paper, kinds=kinds)
    judge = Judge(
        world=world, fits=fitting.fits(world), agreeing=fitted, worded=Worded(world),
        energies=Energies(world=world, laws=laws(world)), twins=Twins(world),
        asking=Asking(world, odd, searches=max(_SEARCHES, _EACH * sum(not said.inline for said in paper.said))),
    )  # fmt: skip
    for order, said in enumerate(world.paper.said):
        if not said.inline:
            yield _row(text.file, said, _verdict(judge, order, said), slips)


def _verdict(judge: Judge, order: int, said: Said) -> Judged | None:
    if not said.sides:
        return None
    try:
        return judge.verdict(order, said)
    except BadInput as error:
        why = str(error)
    except (KeyError, RecursionError):
        why = "a letter has no value, or it is nested too deep"
    return Judged(verdict="untestable", note=f"nothing can be told of it: {why}")


def _row(file: Path, said: Said, verdict: Judged | None, slips: Sequence[TableSlip]) -> Row:
    shown = said.shown
    place = {"file": str(file), **tell(EquationPlace(line=shown.line, label=shown.label or None))}
    if verdict is None:
        row = unread_row(said.name, "", shown.text, said.why)
        return row | {"source": "paper", "read": False, "matched": None, "follows": None} | place
    doubts = [
        f"the table has {s.letter} in {s.printed}, and this wants {s.wanted}" for s in slips if said.name in s.equations
    ]
    aside = f"set aside: {shown.aside}" if shown.aside else ""
    note = joined(verdict.note, *doubts, aside)
    row = {"source": "paper", "equation": said.name, "claim": verdict.matched}
    row |= plain_row(verdict.verdict, verdict.error, note, shown.text)
    row |= {"correction": verdict.correction, "read": True, "matched": verdict.matched or None}
    return row | {"follows": list(verdict.follows) or None} | place


def summary_of(rows: Sequence[Row], cover: Coverage) -> str:
    """Coverage first, then findings, what is carried, and units of tables."""
    count = Counter(r["verdict"] for r in rows)
    findings = sum(count[v] for v in FINDINGS)
    chains = sorted({f"({s}) -> ({r['equation']})" for r in rows for s in r["follows"] or ()})
    tables = sorted({n for r in rows for n in r["note"].split("; ") if n.startswith("the table has")})
    return "; ".join([
        f"{few(cover.equations, 'equation')}: {cover.read} read, {cover.matched} matched, {cover.judged} judged "
        f"({cover.by_units} by their units alone)",
        few(findings, "finding"),
        f"{count[CARRIED]} carried{': ' + ', '.join(chains) if chains else ''}",
        *(["unit of the table: " + ", ".join(t.removeprefix("the table has ") for t in tables)] if tables else []),
    ])  # fmt: skip


def listed(rows: Sequence[Row]) -> list[str]:
    """A line for each equation, with the correction of a slip below it."""
    lines = []
    for row in rows:
        matched = f", {row['matched']}" if row["matched"] else ""
        number = "" if row["equation"] == f"line {row['line']}" else f"({row['equation']}) "
        lines.append(f"{row['file']}:{row['line']}: {number}{row['verdict']}{matched}")
        if row["verdict"] in FINDINGS or not row["read"]:
            lines.append(f"    printed:   {row['printed']}")
        if row["correction"]:
            lines.append(f"    corrected: {row['correction']}")
        if row["note"]:
            lines.append(f"    {row['note']}")
    return lines


def page_of(title: str, rows: Sequence[Row], cover: Coverage) -> str:
    """The page of a text: coverage first, findings before the rest, every equation with its line."""
    first = sorted(rows, key=lambda r: (r["verdict"] not in FINDINGS, r["verdict"] != CARRIED))
    return html(title, summary_of(rows, cover), first)
