"""What every language comes to: scopes of assignments, branches and loops, and the expressions in them as trees."""

import ast
import keyword
import re
from collections.abc import Mapping, Sequence
from dataclasses import field

from mechsym.audit.read import tree as trees
from mechsym.audit.read.tree import FUNCTIONS, MEANINGS, MODULES, Node, meaning
from mechsym.errors import BadInput
from mechsym.quantities import record


@record
class Let:
    """A name gets a value; None where it is none of arithmetic."""

    name: str
    value: ast.expr | None
    line: int


@record
class Branch:
    """Ways of which one is gone."""

    arms: Sequence[Sequence["Statement"]]


@record
class Repeated:
    """What is done for each value of an index."""

    index: str
    body: Sequence["Statement"]


@record
class Scope:
    """A function, a model or the statements of a file."""

    name: str
    line: int
    parameters: Sequence[str]
    body: Sequence["Statement"]
    within: str = ""  #: Function around it
    about: str = ""  #: What its description says


Statement = Let | Branch | Repeated


@record
class ProgramText:
    """A file as it was read."""

    scopes: Sequence[Scope]
    comments: Mapping[int, str]  #: By line
    alone: frozenset[int] = frozenset()  #: Lines that are a comment and nothing else
    curved: bool = False  #: Whether elements of an array are written in round brackets
    abouts: Mapping[str, str] = field(default_factory=dict)  #: What a declaration says of a name


class Opaque(Exception):
    """What is no arithmetic, so that a name for it is a letter."""


_SAID = {
    "asin": "arcsin",
    "acos": "arccos",
    "atan": "arctan datan",
    "abs": "fabs Abs dabs",
    "log": "ln",
    "sqrt": "dsqrt",
    "sin": "dsin",
    "cos": "dcos",
    "tan": "dtan",
    "exp": "dexp",
    "radians": "degtorad deg2rad toRadians",
    "degrees": "rad2deg toDegrees",
    "atan2": "datan2",
}
#: What programs call a function of formulas
ALIASES = {said: function for function, many in _SAID.items() for said in many.split()}
_ALONE = {"float", "double", "array", "asarray", "real", "noEvent", "dble", "Real", "Float64", "float64", "matrix"}
OF = "\u00b7"  #: In a letter, where the program has a dot: a sign that names may hold
_SELF = ("self", "this", "obj", "cls")
_SIGNS = {"add": ast.Add, "subtract": ast.Sub, "multiply": ast.Mult, "divide": ast.Div}
_PI = re.compile(r"(?:\w+\.)*(?:pi|PI|M_PI|CH_C_PI|CH_PI|Pi|pi__)", re.ASCII)
_MODULES = {*MODULES, "casadi", "ca", "jnp", "cs", "scipy", "tf", "m", "umath"}
_FLOATED = re.compile(r"(a?(?:sin|cos|tan)|atan2|sqrt|pow|exp|log|fabs|hypot|cbrt)[fl]$")


_NO_NAMES = {"and", "or", "not", "in", "is", "if", "else", "for", "None", "True", "False"}
_KEYWORDS = re.compile(rf"(?<![\w.])(?:{'|'.join(sorted({*keyword.kwlist} - _NO_NAMES))})(?!\w)")


def parsed(text: str) -> ast.expr:
    """An expression of another language in Python's spelling; words of Python are names in it, as lambda is a ratio.

    Raises what `ast.parse` raises.
    """
    # a letter in bold is the letter to the parser, and makes no word of Python
    plain = _KEYWORDS.sub(lambda m: chr(0x1D41A + ord(m[0][0]) - ord("a")) + m[0][1:], text)
    return ast.parse(plain, mode="eval").body


@record
class Spelled:
    """How expressions of one scope are turned into trees."""

    curved: bool
    indices: frozenset[str] = frozenset()
    functions: Mapping[str, tuple[tuple[str, ...], Node]] = field(default_factory=dict)

    def tree(self, node: ast.expr) -> Node:
        """An expression as a tree of arithmetic. Raises Opaque."""
        if isinstance(node, ast.Constant):
            if isinstance(node.value, (int, float)) and not isinstance(node.value, bool):
                return ast.Constant(value=node.value)
            raise Opaque
        if isinstance(node, (ast.Name, ast.Attribute, ast.Subscript)):
            return self._letter(node)
        if isinstance(node, ast.UnaryOp) and isinstance(node.op, (ast.UAdd, ast.USub)):
            inner = self.tree(node.operand)
            return inner if isinstance(node.op, ast.UAdd) else ast.UnaryOp(op=ast.USub(), operand=inner)
        if isinstance(node, ast.BinOp):
            return self._operation(node)
        if isinstance(node, ast.IfExp) and isinstance(node.test, ast.Compare) and len(node.test.ops) == 1:
            test, other = node.test, self.tree(node.orelse)
            sides = ast.Compare(left=self.tree(test.left), ops=test.ops, comparators=[self.tree(test.comparators[0])])
            if isinstance(test.ops[0], (ast.Lt, ast.LtE, ast.Gt, ast.GtE)):
                return ast.IfExp(test=sides, body=self.tree(node.body), orelse=other)
        if isinstance(node, ast.Call):
            return self._call(node)
        raise Opaque

    def _operation(self, node: ast.BinOp) -> Node:
        left, right = self.tree(node.left), self.tree(node.right)
        if isinstance(node.op, ast.FloorDiv):  # of two whole numbers, as C divides them
            above, below = trees.value_of(left), trees.value_of(right)
            if above is None or not below:
                raise Opaque
            return trees.number(int(above / below))
        if not isinstance(node.op, trees.OPERATORS):
            raise Opaque
        return ast.BinOp(left=left, op=node.op, right=right)

    def _letter(self, node: ast.expr) -> Node:
        path = letter_of(node, self.indices)
        return trees.name("pi" if _PI.fullmatch(path.replace(OF, ".")) else path)

    def _call(self, node: ast.Call) -> Node:
        function = _called(node.func)
        given = [a for a in node.args if not isinstance(a, ast.Starred)]
        if function in self.functions and len(given) == len(self.functions[function][0]) and not node.keywords:
            parameters, body = self.functions[function]
            values = dict(zip(parameters, map(self.tree, given), strict=True))
            return trees.substitute(body, lambda n: values.get(n.id) if isinstance(n, ast.Name) else None)
        plain = _FLOATED.sub(r"\1", ALIASES.get(function, function))
        plain = ALIASES.get(plain, plain)
        if plain in _SIGNS and len(given) == 2:
            return ast.BinOp(left=self.tree(given[0]), op=_SIGNS[plain](), right=self.tree(given[1]))
        if plain in _ALONE and len(given) == 1:
            return self.tree(given[0])
        if plain == "pi" and not given:
            return trees.name("pi")
        if plain in FUNCTIONS and plain != "sum" and len(given) == 1:
            return trees.call(plain, self.tree(given[0]))
        if plain in MEANINGS and not node.keywords:
            try:
                several = meaning(plain, [self.tree(a) for a in given])
            except BadInput:
                raise Opaque from None
            if several is not None:
                return several
        if self.curved and isinstance(node.func, (ast.Name, ast.Attribute)) and given:
            if all(_is_index(a, self.indices) for a in given):
                return self._letter(ast.Subscript(value=node.func, slice=given[0], ctx=ast.Load()))
        raise Opaque


def letter_of(node: ast.expr, indices: frozenset[str] = frozenset()) -> str:
    """The letter that `c.CD`, `self.l`, `y[i]` or `EngGeom.S` is."""
    parts: list[str] = []
    while not isinstance(node, ast.Name):
        if isinstance(node, ast.Attribute):
            parts.append(OF + node.attr)
            node = node.value
        elif isinstance(node, ast.Subscript):
            if not _is_index(node.slice, indices):
                parts.append(re.sub(r"\W+", "m", ast.unparse(node.slice))[:12])
            elif isinstance(node.slice, ast.Constant):
                parts.append(re.sub(r"\W+", "", str(node.slice.value)))
            node = node.value
        else:
            raise Opaque
    parts += [] if node.id in _SELF and parts or node.id in _MODULES and parts else [node.id]
    return "_".join(reversed(parts)).replace(f"_{OF}", OF).strip(OF)


def _is_index(node: ast.expr, indices: frozenset[str]) -> bool:
    if isinstance(node, ast.Tuple):
        return all(_is_index(n, indices) for n in node.elts)
    if isinstance(node, (ast.Slice, ast.Constant)):
        return True
    return isinstance(node, ast.Name) and (node.id in indices or node.id in ("i", "j", "k", "n", "ii", "idx"))


def _called(node: ast.expr) -> str:
    if isinstance(node, ast.Name):
        return node.id
    if isinstance(node, ast.Attribute) and isinstance(node.value, (ast.Name, ast.Attribute)):
        root = ast.unparse(node.value)
        if root.split(".")[0] in (*_MODULES, *_SELF):
            return node.attr
    return ""
