r"""A paper in LaTeX: every display equation is one row, read or not, matched or not, with its verdict.

An equation is matched by its left side: a letter of the symbol table or of the theory, or a derivative of one. A left
side that is neither is the paper's own definition: its derivatives, and what it is said to be later, are compared with
it. An equation that is wrong, and right where an earlier wrong one is believed, is carried and no finding of its own.
"""

import ast
import tomllib
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from mechsym.audit.displayed import Displayed, displayed
from mechsym.audit.findings import Row, unread_row
from mechsym.audit.formula import Asked, answer, question_of
from mechsym.audit.prover import agreement, judges
from mechsym.audit.reader import RESERVED, is_latex, letter_pairs, read
from mechsym.audit.statement import Statement, statement
from mechsym.audit.symbols import Symbols, left_letter, quantity_of, with_derivatives, without_argument
from mechsym.audit.theory.catalogue import named
from mechsym.audit.theory.declared import read_theory
from mechsym.audit.theory.record import Theory, dependencies, known
from mechsym.audit.theory.tape import retaped
from mechsym.audit.tree import Node, letters, substitute
from mechsym.errors import BadInput
from mechsym.files import read_text
from mechsym.quantities import record

FINDINGS = ("misprint", "nearer", "wrong")
DEFINED, CARRIED = "definition", "carried"
_UNKNOWN = "unknown letter"


@record
class _Wrong:
    """An equation that was found wrong, with what it says in the theory's letters."""

    name: str
    quantity: str
    tree: Node


def check_paper(path: Path, asked: Asked) -> list[Row]:
    """The rows of a LaTeX file: the keys of an audit row, and line, label, matched, follows.

    Parameters
    ----------
    asked : Asked
        `theory`: name of a theory, or TOML file that declares one or says `base` and `[symbols]`; `letters`: further
        symbols; assumptions and conventions for all equations
    """
    equations = displayed(read_text(path))
    if not equations:
        raise BadInput(f"{path}: there is no display equation in it; equation, align, gather, \\[ \\] and $$ are read")
    theory, symbols = _said_of(asked)
    rows: list[Row] = []
    wrong: list[_Wrong] = []
    for equation in equations:
        theory, row = _row(equation, theory, symbols, asked, wrong)
        rows.append(row | {"line": equation.line, "label": equation.label or None})
    return rows


def _said_of(asked: Asked) -> tuple[Theory, Symbols]:
    if not asked.theory:
        raise BadInput("a paper needs --theory: the name of a theory, or a TOML file with base = NAME and [symbols]")
    pairs = letter_pairs(asked.letters) if isinstance(asked.letters, str) else dict(asked.letters)
    if Path(asked.theory).suffix != ".toml":
        return named(asked.theory, asked.case), Symbols.of(pairs)
    content = _content(Path(asked.theory))
    symbols = content.get("symbols", {})
    if not isinstance(symbols, dict) or not all(isinstance(v, str) for v in symbols.values()):
        raise BadInput(f'{asked.theory}: [symbols] is a table of letters, as v = "x_d"')
    if "base" not in content:
        return read_theory(Path(asked.theory)), Symbols.of({**symbols, **pairs})
    if unknown := sorted(content.keys() - {"base", "symbols"}):
        raise BadInput(f"{asked.theory}: with base = NAME there are only [symbols]; found {', '.join(unknown)}")
    return named(str(content["base"]), asked.case), Symbols.of({**symbols, **pairs})


def _content(path: Path) -> dict[str, Any]:
    try:
        return tomllib.loads(read_text(path, "--theory"))
    except tomllib.TOMLDecodeError as error:
        raise BadInput(f"--theory {path}: not valid TOML: {error}") from None


def _row(
    equation: Displayed, theory: Theory, symbols: Symbols, asked: Asked, wrong: list[_Wrong]
) -> tuple[Theory, Row]:
    name = equation.number or equation.label or f"line {equation.line}"
    try:
        said = statement(equation.text)
        if not said.left:
            raise BadInput("there is no equals sign")
        bare = without_argument(said.left)
        equation = replace(equation, text=equation.text.replace(said.left, bare, 1))
        said, left = replace(said, left=bare), left_letter(bare)
        quantity = quantity_of(left, theory, symbols) if left else _of_law(said, theory, symbols)
        if left and not quantity:
            return _defined(equation, name, left, said, theory, symbols)
        if not quantity:
            raise BadInput(f"{_UNKNOWN}: its left side {said.left} is no quantity of {theory.name}")
        row, seen = _compared(equation, name, quantity, theory, symbols, asked)
    except BadInput as error:
        return theory, _left_open(equation, name, str(error))
    if row["verdict"] in FINDINGS and left:
        row = _carried(row, quantity, theory, seen, wrong)
        if row["verdict"] != CARRIED:
            wrong.append(_Wrong(name=name, quantity=quantity, tree=_in_theory(seen, theory, symbols)))
    return theory, row


def _compared(
    equation: Displayed, name: str, quantity: str, theory: Theory, symbols: Symbols, asked: Asked
) -> tuple[Row, Asked]:
    own = with_derivatives(equation.text, theory, symbols)
    seen = replace(
        asked,
        text=_in_latex(equation.text),
        against=f"{theory.name}.{quantity}",
        letters=own,
        name=name,
        theory="",
        given=theory,
    )
    row = answer(seen)
    aside = f"set aside: {equation.aside}" if equation.aside else ""
    note = "; ".join(n for n in (row["note"], aside) if n)
    return row | _marks() | {"note": note, "printed": equation.text}, seen


def _in_latex(text: str) -> str:
    # a side without any command is LaTeX too: 2 x is a product
    return "=".join(side if is_latex(side) else rf"\,{side}" for side in text.split("="))


def _of_law(said: Statement, theory: Theory, symbols: Symbols) -> str:
    # any quantity that the left side is made of: the sides are compared with each other
    own = with_derivatives(said.left, theory, symbols)
    tree = _expanded(read(_in_latex(said.left), known(theory), own, theory.tape))
    used = letters(tree)
    found = [k for k in used if k in theory.tape]
    return (found or [k for k in theory.results if dependencies(theory, [k]) & set(used)] or [""])[0]


def _defined(
    equation: Displayed, name: str, left: str, said: Statement, theory: Theory, symbols: Symbols
) -> tuple[Theory, Row]:
    if left in RESERVED:
        raise BadInput(f"{left} is a constant or a function already and cannot be redefined")
    row = unread_row(name, f"{theory.name}.{left}", equation.text, "")
    row |= {"verdict": DEFINED} | _marks()
    if left in theory.letters or symbols.letter(left, theory):
        return theory, row | {"note": f"says what the letter {left} is; there is nothing to compare it with"}
    own = with_derivatives(equation.text, theory, symbols)
    tree = _expanded(read(_in_latex(said.right[0]), known(theory), own, theory.tape))
    note = f"the paper's own {left}; what is said of it later is compared with this"
    return _with(theory, left, tree), row | {"note": note, "understood": None}


def _left_open(equation: Displayed, name: str, why: str) -> Row:
    # read, but with letters that are not known; or not read at all
    row = unread_row(name, "", equation.text, why) | _marks(read=_UNKNOWN in why, matched=False)
    if not row["read"]:
        return row
    return row | {"note": f"not matched: {why.partition('; letters are')[0]}; name it in [symbols]"}


def _marks(read: bool = True, matched: bool = True) -> Row:
    return {"source": "paper", "read": read, "matched": matched, "follows": None}


def _carried(row: Row, quantity: str, theory: Theory, seen: Asked, wrong: Sequence[_Wrong]) -> Row:
    # right where one earlier wrong equation is believed, or all of them
    for believed in [*([w] for w in wrong), list(wrong)] if wrong else []:
        if any(w.quantity == quantity for w in believed):
            continue
        other = theory
        for w in believed:
            if w.quantity not in dependencies(other, letters(w.tree)):
                other = _with(other, w.quantity, w.tree)
        question = question_of(replace(seen, given=other), statement(seen.text))
        if agreement(judges(question), question.formula.tree).exact:
            names = [w.name for w in believed]
            told = f"follows from {', '.join(f'({n})' for n in names)} as printed, and is no slip of its own"
            note = "; ".join(n for n in (told, row["note"]) if n)
            return row | {"verdict": CARRIED, "note": note, "follows": names}
    return row


def _with(theory: Theory, name: str, tree: Node) -> Theory:
    results = theory.results if name in theory.results else (*theory.results, name)
    return replace(theory, tape=retaped(theory.tape, {name: tree}, theory.letters, theory.angle), results=results)


def _in_theory(seen: Asked, theory: Theory, symbols: Symbols) -> Node:
    own = with_derivatives(seen.text, theory, symbols)
    return _expanded(read(statement(seen.text).right[0], known(theory), own, theory.tape))


def _expanded(formula: Any) -> Node:
    own: Mapping[str, Node] = formula.letters
    return substitute(formula.tree, lambda n: own.get(n.id) if isinstance(n, ast.Name) else None)


def chains(rows: Sequence[Row]) -> list[str]:
    """What follows from which wrong equation: `(2) -> (7) -> (8)`."""
    found: dict[str, list[str]] = {}
    for row in rows:
        for start in row.get("follows") or []:
            found.setdefault(start, []).append(row["equation"])
    return [" -> ".join(f"({n})" for n in [start, *rest]) for start, rest in found.items()]


def summary(rows: Sequence[Row]) -> str:
    """One line: how many equations, how many findings, what was carried, what was not read or not matched."""
    count = Counter(r["verdict"] for r in rows)
    findings = sum(count[v] for v in FINDINGS)
    unread = sum(not r["read"] for r in rows)
    unmatched = sum(r["read"] and not r["matched"] for r in rows)
    told = "; ".join(chains(rows))
    return (
        f"{few(len(rows), 'equation')}: {few(findings, 'finding')}, {count[CARRIED]} carried"
        f"{f': {told}' if told else ''}, {few(count[DEFINED], 'definition')}, {unread} not read, "
        f"{unmatched} not matched"
    )


def few(count: int, word: str) -> str:
    """A count and its word, in the plural where there is not just one."""
    return f"{count} {word}{'' if count == 1 else 's'}"
