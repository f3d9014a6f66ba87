r"""A paper in LaTeX: every display equation is one row, read or not, matched or not, with its verdict.

An equation is matched by its left side: a letter of the symbol table or of the theory, or a derivative of one. A left
side that is neither is the paper's own definition: its derivatives, and what it is said to be later, are compared with
it. An equation that is wrong, and right where an earlier wrong one is believed, is carried and no finding of its own.
"""

import ast
import re
import tomllib
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from mechsym import budget
from mechsym.audit.hosts.formula import SECONDS
from mechsym.audit.judge.asked import Asked, question_of
from mechsym.audit.judge.prover import agreement, judges
from mechsym.audit.read.displays import Displayed, displayed
from mechsym.audit.read.latex import read_latex
from mechsym.audit.read.macros import expanded
from mechsym.audit.read.reader import (
    RESERVED,
    AnyLetter,
    UnknownLetter,
    is_latex,
    joined,
    read,
    read_expression,
)
from mechsym.audit.read.slopes import Slope, slope_in
from mechsym.audit.read.spelling import resolve
from mechsym.audit.read.statement import statement
from mechsym.audit.read.tree import Node, letters, substitute
from mechsym.audit.row import Row, answer, unread_row
from mechsym.audit.theory.catalogue import named
from mechsym.audit.theory.declared import read_theory
from mechsym.audit.theory.record import Theory, dependencies, known
from mechsym.audit.theory.tape import retaped
from mechsym.audit.verdict import FINDINGS
from mechsym.errors import BadInput
from mechsym.files.inputs import read_text
from mechsym.quantities import record
from mechsym.quantities.results import part, quantity, result, tell

_ARGUMENT = re.compile(r"^(.*[\w}])\s*(?:\\left)?\(\s*(?:\\[a-z]+|[a-z])\s*(?:\\right)?\)$")
_LETTER = re.compile(r"[A-Za-z_]\w*")
DEFINED, CARRIED = "definition", "carried"


@record
class Symbols:
    """The symbol table: plain name of the author's letter to its expression in the theory's letters."""

    meanings: Mapping[str, str]

    @classmethod
    def of(cls, pairs: Mapping[str, str]) -> "Symbols":
        """A table whose letters may be written in LaTeX."""
        meanings = {}
        for written, meant in pairs.items():
            plain = letters(read_latex(written)[0]) if is_latex(written) else (written.strip(),)
            if len(plain) != 1:
                raise BadInput(f"symbols: {written!r} is no letter")
            meanings[plain[0]] = meant
        return cls(meanings=meanings)

    def letter(self, written: str, theory: Theory) -> str:
        """The free letter of the theory that a letter stands for; empty where it is none."""
        meant = self.meanings.get(written, written)
        return (resolve(meant, theory.letters) if _LETTER.fullmatch(meant) else None) or ""

    def quantity(self, written: str, theory: Theory) -> str:
        """Name on the theory's tape that a letter of the paper stands for; empty where it is none."""
        meant = self.meanings.get(written, written)
        if not _LETTER.fullmatch(meant):
            return ""
        named_there = meant if meant in theory.tape else resolve(meant, known(theory))
        if named_there and named_there in theory.tape:
            return named_there
        return "" if meant in theory.letters else self.derived(written, theory)

    def derived(self, written: str, theory: Theory) -> str:
        r"""Name on the tape of a derivative: x_d for \dot{x} and dx/dt, dx_dphi for dx/dphi; empty where it is none."""
        if slope := slope_in(written):
            of, by = self.quantity(slope.of, theory), self.letter(slope.by, theory)
            in_time = slope.by == "t" and not by
            new = f"{of}_{'d' * slope.order}" if in_time else Slope(of, by, slope.order).name
            return new if of and new in theory.tape else ""
        for dots in ("dd", "d"):
            if written.endswith(dots) and len(written) > len(dots):
                of = self.quantity(written[: -len(dots)], theory)
                if of and f"{of}_{dots}" in theory.tape:
                    return f"{of}_{dots}"
        return ""

    def used_in(self, text: str, theory: Theory) -> dict[str, str]:
        """The table with the dotted letters and derivatives that an equation uses."""
        table = dict(self.meanings)
        for side in re.split(r"(?<![<>!])=|\\approx|\\simeq|\\equiv", text):
            try:
                used = letters(read_expression(side if is_latex(side) else rf"\,{side}", (), AnyLetter())[0])
            except BadInput:
                continue  # what cannot be read is refused where it is compared
            for written in used:
                if written in table or resolve(written, known(theory)) or written in theory.tape:
                    continue
                if meant := self.derived(written, theory):
                    table[written] = meant
        return table


@result
class EquationPlace:
    """Where an equation stands in its paper."""

    line: int = quantity("-")  #: Of the file, counted from 1
    label: str | None = part()


@record
class _Wrong:
    """An equation that was found wrong, with what it says in the theory's letters."""

    name: str
    quantity: str
    tree: Node


@dataclass
class _Paper:
    """What is known while a paper is read: the theory grows by its own definitions."""

    theory: Theory
    symbols: Symbols
    asked: Asked
    wrong: list[_Wrong] = field(default_factory=list)

    def row(self, equation: Displayed) -> Row:
        """The row of the next equation: read or not, matched or not, compared or a definition."""
        name = equation.number or equation.label or f"line {equation.line}"
        try:
            said = statement(equation.text)
            if not said.left:
                raise BadInput("there is no equals sign")
            # x for x(\varphi)
            inner = _ARGUMENT.match(said.left.strip())
            function = inner and re.search(r"\\?(?:sin|cos|tan|exp|ln|log|sqrt)\s*$", inner[1])
            bare = said.left if inner is None or function else inner[1]
            equation = replace(equation, text=equation.text.replace(said.left, bare, 1))
            said, tree = replace(said, left=bare), read_expression(bare, (), AnyLetter())[0]
            left = tree.id if isinstance(tree, ast.Name) else ""
            quantity = self.symbols.quantity(left, self.theory) if left else self._of_law(said.left)
            if left and not quantity:
                return self._defined(equation, name, left, said.right[0])
            if not quantity:
                raise UnknownLetter(f"unknown letter: its left side {said.left} is no quantity of {self.theory.name}")
            return self._compared(equation, name, quantity, bool(left))
        except UnknownLetter as error:
            note = f"not matched: {error.short}; name it in [symbols]"
            return unread_row(name, "", equation.text, "") | _marks(matched=False) | {"note": note}
        except BadInput as error:
            return unread_row(name, "", equation.text, str(error)) | _marks(read=False, matched=False)

    def _of_law(self, left: str) -> str:
        # any quantity that the left side is made of: the sides are compared with each other
        used = letters(self._tree(_in_latex(left), left))
        own = [k for k in used if k in self.theory.tape]
        return (own or [k for k in self.theory.results if dependencies(self.theory, [k]) & set(used)] or [""])[0]

    def _tree(self, text: str, within: str) -> Node:
        # an expression of an equation in the theory's letters
        own = self.symbols.used_in(within, self.theory)
        formula = read(text, known(self.theory), own, self.theory.tape)
        return substitute(formula.tree, lambda n: formula.letters.get(n.id) if isinstance(n, ast.Name) else None)

    def _defined(self, equation: Displayed, name: str, left: str, right: str) -> Row:
        if left in RESERVED:
            raise BadInput(f"{left} is a constant or a function already and cannot be redefined")
        row = unread_row(name, f"{self.theory.name}.{left}", equation.text, "") | {"verdict": DEFINED} | _marks()
        if left in self.theory.letters or self.symbols.letter(left, self.theory):
            return row | {"note": f"says what the letter {left} is; there is nothing to compare it with"}
        self.theory = _with(self.theory, left, self._tree(_in_latex(right), equation.text))
        return row | {"note": f"the paper's own {left}; what is said of it later is compared with this"}

    def _compared(self, equation: Displayed, name: str, quantity: str, named_left: bool) -> Row:
        text, theory = _in_latex(equation.text), self.theory
        own = self.symbols.used_in(equation.text, theory)
        against = f"{theory.name}.{quantity}"
        asked = replace(self.asked, text=text, against=against, letters=own, name=name, theory="", given=theory)
        aside = f"set aside: {equation.aside}" if equation.aside else ""
        row = answer(asked)
        row |= _marks() | {"note": joined(row["note"], aside), "printed": equation.text}
        blamed = row["verdict"] in FINDINGS
        if not named_left or not (blamed or row["correction"]):
            return row
        # what may be another convention may as well follow from an earlier slip
        carried = self._carried(row, quantity, asked)
        if carried is None and blamed:
            tree = self._tree(statement(text).right[0], text)
            self.wrong.append(_Wrong(name=name, quantity=quantity, tree=tree))
        return carried or row

    def _carried(self, row: Row, quantity: str, asked: Asked) -> Row | None:
        # right where one earlier wrong equation is believed, or all of them
        for believed in [*([w] for w in self.wrong), self.wrong] if self.wrong else []:
            if any(w.quantity == quantity for w in believed):
                continue
            other = self.theory
            for w in believed:
                if w.quantity not in dependencies(other, letters(w.tree)):
                    other = _with(other, w.quantity, w.tree)
            question = question_of(replace(asked, given=other), statement(asked.text))
            if agreement(judges(question), question.formula.tree).exact:
                names = [w.name for w in believed]
                why = f"follows from {', '.join(f'({n})' for n in names)} as printed, and is no slip of its own"
                return row | {"verdict": CARRIED, "note": joined(why, row["note"]), "follows": names}
        return None


def check_paper(path: Path, asked: Asked) -> list[Row]:
    """The rows of a LaTeX file: the keys of an audit row, and line, label, matched, follows.

    asked: `theory`: name of a theory, or TOML file that declares one or says `base` and `[symbols]`; `letters`: further
    symbols; assumptions and conventions for all equations.
    """
    equations = displayed(expanded(read_text(path)))
    if not equations:
        raise BadInput(f"{path}: there is no display equation in it; equation, align, gather, \\[ \\] and $$ are read")
    budget.require(f"{path}: {len(equations)} equations", SECONDS * len(equations), 0.0, "give a part of it")
    theory, symbols = _said_of(asked)
    paper = _Paper(theory, symbols, asked)
    places = (EquationPlace(line=equation.line, label=equation.label or None) for equation in equations)
    return [paper.row(equation) | tell(place) for equation, place in zip(equations, places, strict=True)]


def _said_of(asked: Asked) -> tuple[Theory, Symbols]:
    if not asked.theory:
        raise BadInput("a paper needs --theory: the name of a theory, or a TOML file with base = NAME and [symbols]")
    pairs, path = asked.pairs, Path(asked.theory)
    if path.suffix != ".toml":
        return named(asked.theory, asked.case), Symbols.of(pairs)
    try:
        content = tomllib.loads(read_text(path, "--theory"))
    except tomllib.TOMLDecodeError as error:
        raise BadInput(f"--theory {asked.theory}: not valid TOML: {error}") from None
    symbols = content.get("symbols", {})
    if not isinstance(symbols, dict) or not all(isinstance(v, str) for v in symbols.values()):
        raise BadInput(f'{asked.theory}: [symbols] is a table of letters, as v = "x_d"')
    if "base" not in content:
        return read_theory(path), Symbols.of({**symbols, **pairs})
    if unknown := sorted(content.keys() - {"base", "symbols"}):
        raise BadInput(f"{asked.theory}: with base = NAME there are only [symbols]; found {', '.join(unknown)}")
    return named(str(content["base"]), asked.case), Symbols.of({**symbols, **pairs})


def _in_latex(text: str) -> str:
    # a side without any command is LaTeX too: 2 x is a product
    return "=".join(side if is_latex(side) else rf"\,{side}" for side in text.split("="))


def _marks(read: bool = True, matched: bool = True) -> Row:
    return {"source": "paper", "read": read, "matched": matched, "follows": None}


def _with(theory: Theory, name: str, tree: Node) -> Theory:
    results = theory.results if name in theory.results else (*theory.results, name)
    return replace(theory, tape=retaped(theory.tape, {name: tree}, theory.letters, theory.angle), results=results)


def chains(rows: Sequence[Row]) -> list[str]:
    """What follows from which wrong equation: `(2) -> (7) -> (8)`."""
    following: dict[str, list[str]] = {}
    for row in rows:
        for start in row.get("follows") or []:
            following.setdefault(start, []).append(row["equation"])
    return [" -> ".join(f"({n})" for n in [start, *rest]) for start, rest in following.items()]


def summary(rows: Sequence[Row]) -> str:
    """One line: how many equations, how many findings, what was carried, what was not read or not matched."""
    count = Counter(r["verdict"] for r in rows)
    findings = sum(count[v] for v in FINDINGS)
    unread = sum(not r["read"] for r in rows)
    unmatched = sum(r["read"] and not r["matched"] for r in rows)
    text = "; ".join(chains(rows))
    return (
        f"{few(len(rows), 'equation')}: {few(findings, 'finding')}, {count[CARRIED]} carried"
        f"{f': {text}' if text else ''}, {few(count[DEFINED], 'definition')}, {unread} not read, "
        f"{unmatched} not matched"
    )


def few(count: int, word: str) -> str:
    """A count and its word, in the plural where there is not just one."""
    return f"{count} {word}{'' if count == 1 else 's'}"
