"""Claims of a program: each assigned name with its formula, and what the names in that formula stand for."""

import ast
import math
import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import field, replace
from itertools import count, takewhile

from mechsym.audit.read import notebook
from mechsym.audit.read import tree as trees
from mechsym.audit.read.programs.grammars import GRAMMARS, read_grammar
from mechsym.audit.read.programs.modelica import read_modelica
from mechsym.audit.read.programs.python import code_of_notebook, read_python
from mechsym.audit.read.programs.statements import OF, Let, Opaque, ProgramText, Repeated, Scope, Spelled, Statement
from mechsym.audit.read.tree import Node
from mechsym.errors import BadInput
from mechsym.quantities import record

ENDS = (".py", ".ipynb", ".mo", *GRAMMARS)  #: Of the names of files that are read
_LONGEST = 1_000_000  # characters
# before the number of a name's later values: changed with regard to the one before, or given in branches alone
_AGAIN, _ANEW = "__v", "__w"

_PI = {round(math.pi, digits) for digits in range(2, 16)} | {3.1415, 3.141592}  # its digits, rounded or cut


@record
class Claim:
    """A name with its formula; names in it that got a value before stand in `values`."""

    scope: str
    name: str  #: `return` for what a function gives back
    tree: Node
    line: int
    about: str  #: What a comment or a description says of it
    case: int  #: Number of the branch that it lies in, 0 in none
    values: Mapping[str, Node] = field(default_factory=dict)
    written: Mapping[str, Node] = field(default_factory=dict)  #: What names are that no word of a theory tells
    abouts: Mapping[str, str] = field(default_factory=dict)
    owned: Mapping[str, str] = field(default_factory=dict)  #: Names with whose they are: the sun's torque
    parameters: Sequence[str] = ()
    near: Sequence[str] = ()  #: Letters known there whose names differ in one sign from one that it has: xp, xg; a, aw
    whole: str = ""  #: The same with all that it is of
    ruled_out: tuple[str, ...] = ()  #: What names of quantities have that its words speak against: `two_stroke`
    from_top: bool = False  #: Whether the text says that its angle counts from the top dead centre
    last: bool = False  #: Of a function that gives nothing back by `return`: what it ends with


@record
class Reading:
    """The claims of a file."""

    names: Sequence[str]  #: Of its scopes
    assigned: int  #: Assignments and returned values, numbers and what is no arithmetic among them
    claims: Sequence[Claim]
    functions: Mapping[str, tuple[tuple[str, ...], Node]]
    described: Mapping[str, str]  #: By the name of a function that is the only one of its name: what describes it


def base(letter: str) -> str:
    """The name in the program of a letter in a claim."""
    return letter.partition(_AGAIN)[0].partition(_ANEW)[0]


def with_base_names(tree: Node) -> Node:
    """A formula in the names of the program; a part of something is joined to it by a line."""
    return trees.substitute(
        tree, lambda n: trees.name(base(n.id).replace(OF, "_")) if isinstance(n, ast.Name) else None
    )


def is_changed(letter: str) -> bool:
    """Whether a letter is what a loop or a branch made of an earlier value."""
    return _AGAIN in letter


def longest(suffix: str) -> int:
    """Characters of a file that are read at most."""
    return notebook.LONGEST if suffix == ".ipynb" else _LONGEST


def read_program(text: str, suffix: str) -> Reading:
    """The claims of a program text. Raises BadInput: the grammar is not there, or the text is not of its language."""
    try:
        if suffix == ".py":
            program = read_python(text)
        elif suffix == ".ipynb":
            program = read_python(code_of_notebook(text))
        elif suffix == ".mo":
            program = read_modelica(text)
        else:
            program = read_grammar(text, suffix)
        return _reading(program)
    except (RecursionError, MemoryError):
        raise BadInput("nested too deep to be read") from None


def _reading(program: ProgramText) -> Reading:
    functions: dict[str, tuple[tuple[str, ...], Node]] = {}
    abouts = {**_said(program.comments), **program.abouts}
    for _ in range(2):  # functions of functions
        for scope in program.scopes:
            if body := _as_function(program, scope, functions):
                functions[scope.name] = (tuple(scope.parameters), body)
    claims: list[Claim] = []
    globals_ = _Build(program, functions, abouts, program.scopes[0]) if program.scopes else None
    for scope in program.scopes:
        build = _Build(program, functions, abouts, scope)
        if globals_ is not None and scope is not program.scopes[0]:
            build.names.update({k: v for k, v in globals_.names.items() if k not in scope.parameters})
            build.values.update(globals_.values)
        build.run(scope.body, 0)
        if scope is program.scopes[0]:
            globals_ = build
        claims += _with_last(build.claims)
    times = Counter(scope.name for scope in program.scopes)
    return Reading(
        names=[s.name for s in program.scopes],
        assigned=sum(_count(scope.body) for scope in program.scopes),
        claims=claims,
        functions=functions,
        described={s.name: _description(program, s) for s in program.scopes if s.name and times[s.name] == 1},
    )


def _description(program: ProgramText, scope: Scope) -> str:
    """What a docstring says, or the lines of comment right above and below where a function begins."""
    if scope.about:
        return scope.about
    above = [*takewhile(program.alone.__contains__, range(scope.line - 1, 0, -1))][::-1]
    below = takewhile(program.alone.__contains__, count(scope.line + 1))
    return "\n".join(program.comments[line] for line in (*above, *below))


def _with_last(claims: Sequence[Claim]) -> Sequence[Claim]:
    # MATLAB and Fortran give back what a name has at the end
    if not claims or not claims[-1].scope or any(c.name == "return" for c in claims):
        return claims
    return [*claims[:-1], replace(claims[-1], last=True)]


def _count(body: Sequence[Statement]) -> int:
    return sum(
        1 if isinstance(s, Let) else _count(s.body) if isinstance(s, Repeated) else sum(map(_count, s.arms))
        for s in body
    )


_TELLS = re.compile(
    r"^[\s%#*!/<>@:.\-\\]*(?:param\w*\s+(?:\[\w+\]\s*)?)?([A-Za-z_]\w*)\s*(?:\([^()]*\))?\s*(?:\[[^\]]*\])?\s*[:=\-]+\s*(\S.{2,90})"
)


def _said(comments: Mapping[int, str]) -> dict[str, str]:
    # theta: crank angle [deg]
    said: dict[str, str] = {}
    for line in comments.values():
        if match := _TELLS.match(line):
            said.setdefault(match[1], match[2])
    return said


def _as_function(
    program: ProgramText, scope: Scope, functions: Mapping[str, tuple[tuple[str, ...], Node]]
) -> Node | None:
    # what a call stands for, where a scope is straight to its one value
    if not scope.name or not scope.parameters or not scope.body or not all(isinstance(s, Let) for s in scope.body):
        return None
    build = _Build(program, functions, {}, scope)
    build.run(scope.body, 0)
    last = scope.body[-1]
    if not isinstance(last, Let) or not build.claims or build.claims[-1].line != last.line:
        return None
    if last.name != "return" and not program.curved:
        return None
    if last.name != "return" and sum(isinstance(s, Let) for s in scope.body) > 3:
        return None
    whole = inlined(build.claims[-1].tree, build.values)
    return whole if whole is not None and not any(base(k) != k for k in trees.letters(whole)) else None


def inlined(tree: Node, values: Mapping[str, Node], keep: Mapping[str, object] | None = None) -> Node | None:
    """A formula with the values of its names put in, but for those to keep; None where it grows too large."""
    size = 0

    def change(node: Node) -> Node | None:
        nonlocal size
        size += 1
        if size > trees.MAX_NODES:
            raise Opaque
        if isinstance(node, ast.Name) and node.id in values and node.id not in (keep or {}):
            return trees.substitute(values[node.id], change)
        return None

    try:
        return trees.substitute(tree, change)
    except (Opaque, RecursionError):
        return None


class _Build:
    """The statements of one scope gone through, with what each name stands for at the time."""

    def __init__(
        self,
        program: ProgramText,
        functions: Mapping[str, tuple[tuple[str, ...], Node]],
        abouts: Mapping[str, str],
        scope: Scope,
    ) -> None:
        self.program, self.scope, self.abouts = program, scope, dict(abouts)
        self.spelled = Spelled(curved=program.curved, functions=functions)
        self.names: dict[str, str] = {}
        self.values: dict[str, Node] = {}
        self.claims: list[Claim] = []
        self.counts: dict[str, int] = {}
        self.arms = 0
        self.on_line = Counter(let.line for let in _lets(scope.body))

    def run(self, body: Sequence[Statement], case: int) -> None:
        """Go through statements."""
        for statement in body:
            if isinstance(statement, Let):
                self._let(statement, case)
            elif isinstance(statement, Repeated):
                self._loop(statement, case)
            else:
                before = dict(self.names)
                for arm in statement.arms:
                    self.names = dict(before)
                    self.arms += 1
                    self.run(arm, self.arms)
                self.names = before
                lets = [let for arm in statement.arms for let in _lets(arm)]
                again = {*before, *self.scope.parameters, *(let.name for let in lets if _uses_itself(let))}
                for name in sorted({let.name for let in lets}):
                    self._fresh(name, _AGAIN if name in again else _ANEW)

    def _loop(self, loop: Repeated, case: int) -> None:
        seen: set[str] = set()
        carried = set()
        for let in _lets(loop.body):
            carried |= _used(let) - seen
            seen.add(let.name)
        again = sorted({let.name for let in _lets(loop.body)} & carried)
        for name in again:
            self._fresh(name)
        kept = self.spelled
        self.spelled = replace(kept, indices=kept.indices | {loop.index})
        self.run(loop.body, case)
        self.spelled = kept
        for name in again:
            self._fresh(name)

    def _fresh(self, name: str, mark: str = _AGAIN) -> str:
        count = self.counts[name] = self.counts.get(name, 0) + 1
        known = name in self.names or count > 1
        self.names[name] = f"{name}{mark}{count}" if known or name in self.values else name
        return self.names[name]

    def _let(self, let: Let, case: int) -> None:
        try:
            tree = self.spelled.tree(let.value) if let.value is not None else None
            if tree is not None:
                trees.check(tree)
        except (Opaque, BadInput, RecursionError):
            tree = None
        if tree is not None:
            tree = trees.substitute(tree, self._meant)
        about = self._about(let)
        if let.name == "return":
            if tree is not None:
                self._claim(let, tree, about, case)
            return
        if _uses_itself(let):  # what it was before is a step on the way
            self.claims = [c for c in self.claims if c.name != let.name or c.line >= let.line]
        letter = self._fresh(let.name)
        if about:
            self.abouts.setdefault(let.name, about)
        if tree is None or letter in trees.letters(tree):
            return
        if trees.letters(tree) and trees.letters(tree) != ("pi",):
            self._claim(let, tree, about or self.abouts.get(let.name, ""), case)
        self.values[letter] = tree

    def _meant(self, node: Node) -> Node | None:
        # a name as it stands by now, and pi for its digits
        if isinstance(node, ast.Name) and node.id in self.names:
            return trees.name(self.names[node.id])
        digits = isinstance(node, ast.Constant) and node.value in _PI
        return trees.name("pi") if digits and "pi" not in self.names else None

    def _about(self, let: Let) -> str:
        comments, alone = self.program.comments, self.program.alone
        if self.on_line[let.line] > 1:
            return ""  # which of them it is about, nobody knows
        if let.line in comments and let.line not in alone:
            return comments[let.line]
        above = comments[let.line - 1] if let.line - 1 in alone else ""
        told = _TELLS.match(above)
        return above if told is None or told[1] == let.name else ""  # it says what another name is

    def _claim(self, let: Let, tree: Node, about: str, case: int) -> None:
        self.claims.append(
            Claim(
                scope=self.scope.name,
                name=let.name,
                tree=tree,
                line=let.line,
                about=about,
                case=case,
                values=self.values,
                abouts=self.abouts,
                parameters=self.scope.parameters,
                near=self._near(tree),
            )
        )

    def _near(self, tree: Node) -> Sequence[str]:
        used = trees.letters(tree)
        own = {base(k) for k in used}
        return [
            k for name, k in self.names.items() if k not in used and any(_is_a_sign_away(name, other) for other in own)
        ]


def _is_a_sign_away(one: str, other: str) -> bool:
    if abs(len(one) - len(other)) == 1:
        return one.startswith(other) or other.startswith(one)
    return len(one) == len(other) > 1 and sum(a != b for a, b in zip(one, other, strict=True)) == 1


def _used(let: Let) -> set[str]:
    # without a value it is changed in place
    return {n.id for n in ast.walk(let.value) if isinstance(n, ast.Name)} if let.value is not None else {let.name}


def _uses_itself(let: Let) -> bool:
    return let.name in _used(let)


def _lets(body: Sequence[Statement]) -> Iterator[Let]:
    for statement in body:
        if isinstance(statement, Let):
            yield statement
        elif isinstance(statement, Repeated):
            yield from _lets(statement.body)
        else:
            for arm in statement.arms:
                yield from _lets(arm)
