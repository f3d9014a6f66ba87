"""C, C++, Java, JavaScript, MATLAB, Julia and Fortran by their kept grammars (tree-sitter): scopes with statements."""

import ast
import re
import warnings
from collections.abc import Iterator
from functools import cache
from importlib import import_module
from typing import TYPE_CHECKING

from mechsym.audit.read.programs.statements import (
    Branch,
    Let,
    Opaque,
    ProgramText,
    Repeated,
    Scope,
    Statement,
    letter_of,
    parsed,
)
from mechsym.errors import BadInput

if TYPE_CHECKING:
    from tree_sitter import Node, Parser

_ENDS = {
    "cpp": ".c .h .cpp .cc .cxx .hpp",
    "java": ".java .cs",
    "javascript": ".js .mjs .ts",
    "matlab": ".m",
    "julia": ".jl",
    "fortran": ".f90 .f95 .f03 .f08",
}
#: Grammar by the end of a file's name
GRAMMARS = {end: language for language, ends in _ENDS.items() for end in ends.split()}
_CURVED = ("matlab", "fortran")
_WHOLE = ("cpp", "java", "fortran")  # 1/2 is 0
_DEEPEST = 300  # brackets within brackets
_FUNCTIONS = set(
    """
    function_definition method_declaration function_declaration method_definition function subroutine
    constructor_declaration short_function_definition program
    """.split()
)
_LAMBDAS = {"lambda_expression", "lambda", "arrow_function", "arrow_function_expression", "function_expression"}
_ASSIGNED = {"assignment_expression", "assignment", "assignment_statement", "init_declarator", "variable_declarator"}
_CHANGED = {"augmented_assignment_expression", "compound_assignment_expression", "update_expression"}
_RETURNS = {"return_statement"}
_BRANCHES = set(
    """
    if_statement switch_statement switch_expression select_case_statement try_statement ternary_if
    where_statement
    """.split()
)
_CLAUSES = set(
    """
    else_clause elseif_clause case_statement switch_case switch_default case_clause catch_clause
    otherwise_clause switch_block_statement_group switch_rule
    """.split()
)
_INSIDE = {"compound_statement", "switch_body", "switch_block"}
_LOOPS = {"for_statement", "while_statement", "do_statement", "do_loop", "do_loop_statement", "enhanced_for_statement"}
_BINARY = set(
    "binary_expression binary_operator math_expression juxtaposition_expression parenthesized_expression".split()
)
_NAMES = {"identifier", "field_identifier", "property_identifier", "name", "type_member", "this"}
_SUFFIX = re.compile(r"(?<=[\d.])(?:[fFlLuU]+|_\w+)$")
_SIGNS = {"^": "**", ".^": "**", ".*": "*", "./": "/", ".**": "**", "×": "*", "÷": "/"}


@cache
def _parser(language: str) -> "Parser":
    try:
        from tree_sitter import Language, Parser

        module = import_module(f"tree_sitter_{language}")
    except ImportError:
        raise BadInput(
            f"programs of this language are read by tree-sitter-{language}, which is not installed; "
            "pip install 'mechsym[code]'"
        ) from None
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)
        return Parser(Language(module.language()))


def read_grammar(text: str, suffix: str) -> ProgramText:
    """The scopes of a file by the grammar of its suffix. Raises BadInput: the grammar is not installed."""
    language = GRAMMARS[suffix]
    if language == "julia":  # whose grammar takes 4*(a + b) for 4 times a call of *
        text = re.sub(r"([-+*/^÷\\])\(", r"\1 (", text)
    root = _parser(language).parse(text.encode("utf-8", "replace")).root_node
    return _Reading(language).program(root)


class _Reading:
    def __init__(self, language: str) -> None:
        self.language, self.curved = language, language in _CURVED
        self.scopes: list[Scope] = []
        self.comments: dict[int, str] = {}
        self.alone: set[int] = set()
        self.within: list[str] = []

    def program(self, root: "Node") -> ProgramText:
        self._find_comments(root)
        body = self.statements(root, 0)
        self.scopes.insert(0, Scope(name="", line=1, parameters=(), body=body))
        return ProgramText(scopes=self.scopes, comments=self.comments, alone=frozenset(self.alone), curved=self.curved)

    def _find_comments(self, root: "Node") -> None:
        waiting = [root]
        while waiting:
            node = waiting.pop()
            if "comment" in node.type:
                before = node.prev_sibling
                row = node.start_point[0]
                for i, line in enumerate(_text(node).splitlines()):
                    self.comments[row + i + 1] = line.strip(" \t/*%!#<")
                    if i or before is None or before.end_point[0] != row:
                        self.alone.add(row + i + 1)
            waiting += node.children

    def statements(self, node: "Node", depth: int) -> list[Statement]:
        return [] if depth > _DEEPEST else [s for child in node.named_children for s in self.statement(child, depth)]

    def statement(self, node: "Node", depth: int) -> Iterator[Statement]:
        kind = node.type
        if kind in _FUNCTIONS and not (kind == "program" and self.language != "fortran"):
            self._function(node, depth)
        elif kind in _ASSIGNED:
            yield from self._assigned(node, depth)
        elif kind in _CHANGED:
            target = node.child_by_field_name("left") or node.child_by_field_name("argument") or _child(node)
            yield from self._let(target, None, node)
        elif kind in _RETURNS:
            value = _child(node)
            if value is not None:
                yield Let(name="return", value=self.expression(value), line=node.start_point[0] + 1)
        elif kind in _BRANCHES:
            yield Branch(arms=list(self._arms(node, depth)))
        elif kind in _LOOPS:
            yield Repeated(index=self._index(node), body=self.statements(node, depth + 1))
        elif kind == "preproc_def":
            yield from self._defined(node)
        else:
            yield from self.statements(node, depth + 1)

    def _defined(self, node: "Node") -> Iterator[Let]:
        name, value = node.child_by_field_name("name"), node.child_by_field_name("value")
        if name is not None and value is not None:
            yield Let(name=_text(name), value=_parsed(_text(value)), line=node.start_point[0] + 1)

    def _arms(self, node: "Node", depth: int) -> Iterator[list[Statement]]:
        inside = [c for c in node.named_children if c.type in _INSIDE and node.type.startswith("switch")]
        plain: list[Statement] = []
        clauses = []
        for child in inside[0].named_children if inside else node.named_children:
            other = node.child_by_field_name("alternative")
            if child.type in _CLAUSES or other is not None and child.id == other.id:
                clauses.append(child)
            else:
                plain += self.statement(child, depth + 1)
        yield plain
        for clause in clauses:
            yield self.statements(clause, depth + 1) if clause.type in _CLAUSES else list(self.statement(clause, depth))

    def _index(self, node: "Node") -> str:
        for _ in range(4):
            child = next((c for c in node.named_children if c.type != "comment"), None)
            if child is None:
                return ""
            if child.type == "identifier":
                return _text(child)
            node = child
        return ""

    def _assigned(self, node: "Node", depth: int) -> Iterator[Statement]:
        left = node.child_by_field_name("left") or node.child_by_field_name("declarator")
        left = left or node.child_by_field_name("name") or _child(node)
        right = node.child_by_field_name("right") or node.child_by_field_name("value")
        if right is None and node.named_child_count > 1:
            right = _child(node, -1)
        if left is None or right is None:
            return
        sign = next((_text(c) for c in node.children if _text(c) in ("+=", "-=", "*=", "/=")), "")
        if right.type in _LAMBDAS:
            self._function(right, depth, _text(left))
        elif left.type == "call_expression" and self.language == "julia":
            self._function(node, depth)
        elif right.type in _ASSIGNED:  # a = b = c
            inner = list(self.statement(right, depth + 1))
            yield from inner
            yield from self._let(left, inner[-1].value if inner and isinstance(inner[-1], Let) else None, node)
        elif left.type in ("multioutput_variable", "open_tuple", "tuple_expression", "structured_binding_declarator"):
            for part in left.named_children:
                yield from self._let(part, None, node)
        else:
            yield from self._let(left, None if sign else self.expression(right), node)

    def _let(self, target: "Node | None", value: ast.expr | None, node: "Node") -> Iterator[Let]:
        written = self.expression(target) if target is not None else None
        if isinstance(written, ast.Call) and self.curved and written.args:
            written = ast.Subscript(value=written.func, slice=written.args[0], ctx=ast.Load())
        try:
            if written is not None:
                name = letter_of(written, frozenset(("i", "j", "k", "n", "ii", *self.within[-1:])))
                yield Let(name=name, value=value, line=node.start_point[0] + 1)
        except Opaque:
            return

    def _function(self, node: "Node", depth: int, name: str = "") -> None:
        if depth > _DEEPEST:
            return
        declared = node.child_by_field_name("declarator")
        head = node if declared is None else declared
        while head.type in ("pointer_declarator", "reference_declarator") and head.named_child_count:
            head = _child(head, -1) or head
        if not name:
            named = head.child_by_field_name("name") or head.child_by_field_name("declarator")
            signed = next((c for c in node.named_children if c.type == "signature"), node)
            named = named or _first(signed, "name", "identifier")
            name = re.split(r"::|\.", _text(named))[-1] if named is not None else ""
        listed = head.child_by_field_name("parameters") or _first(
            node,
            "function_arguments",
            "arguments",
            "parameters",
            "argument_list",
            "parameter_list",
            "formal_parameters",
        )
        parameters = [p for p in map(self._parameter, listed.named_children)] if listed is not None else []
        if listed is None and node.named_child_count and node.type in _LAMBDAS:
            parameters = [_text(n) for n in node.named_children[:1] if n.type == "identifier"]
        around = self.within[-1] if self.within else ""
        self.within.append(name)
        place = len(self.scopes)
        body = self.statements(node, depth + 1)
        value = node.child_by_field_name("expression") or node.child_by_field_name("body")
        if not body and (node.type in _LAMBDAS or node.type == "assignment"):
            value = value or _child(node, -1)
            if value is not None:
                body = [Let(name="return", value=self.expression(value), line=node.start_point[0] + 1)]
        last = _child(node, -1)
        if (
            self.language == "julia"
            and last is not None
            and last.type.endswith("_expression")
            and node.type in _FUNCTIONS
        ):
            if not last.type.startswith("compound_assignment"):
                body.append(Let(name="return", value=self.expression(last), line=last.start_point[0] + 1))
        self.within.pop()
        scope = Scope(
            name=name, line=node.start_point[0] + 1, parameters=[p for p in parameters if p], body=body, within=around
        )
        self.scopes.insert(place, scope)

    def _parameter(self, node: "Node") -> str:
        if node.type == "identifier":
            return _text(node)
        named = node.child_by_field_name("declarator") or node.child_by_field_name("name") or _child(node)
        return self._parameter(named) if named is not None else ""

    def expression(self, node: "Node") -> ast.expr | None:
        """An expression as Python's own; None where it is none."""
        try:
            return _parsed(self._spelled(node, 0))
        except Opaque:
            return None

    def _spelled(self, node: "Node", depth: int) -> str:
        kind = node.type
        if depth > _DEEPEST or node.has_error:
            raise Opaque
        inner = [c for c in node.children if "comment" not in c.type and "continuation" not in c.type]
        if not inner:
            return self._token(node)
        if kind == "cast_expression":
            return self._spelled(node.child_by_field_name("value") or inner[-1], depth + 1)
        if kind in ("conditional_expression", "ternary_expression") and len(node.named_children) == 3:
            test, yes, no = (self._spelled(c, depth + 1) for c in node.named_children)
            return f"(({yes}) if ({test}) else ({no}))"
        if kind == "postfix_operator":
            return self._spelled(inner[0], depth + 1)
        if kind == "qualified_identifier":
            return _text(node).split("::")[-1]
        if kind == "juxtaposition_expression":
            return "(" + "*".join(self._spelled(c, depth + 1) for c in inner) + ")"
        if kind in _BINARY:
            parts = [self._spelled(c, depth + 1) for c in inner]
            if self._is_whole(inner, parts):
                parts[1] = "//"
            return "(" + " ".join(parts) + ")" if kind != "parenthesized_expression" else "".join(parts)
        return "".join(self._spelled(c, depth + 1) for c in inner)

    def _is_whole(self, inner: "list[Node]", parts: list[str]) -> bool:
        if self.language not in _WHOLE or len(parts) != 3 or parts[1] != "/":
            return False
        return all(re.fullmatch(r"\(*\d+\)*", p) for p in (parts[0], parts[2]))

    def _token(self, node: "Node") -> str:
        text = _text(node)
        if node.type in ("number", "number_literal", "float_literal", "integer_literal") or "literal" in node.type:
            plain = text.replace("'", "").replace("_", "") if not text.startswith(("'", '"')) else "''"
            plain = re.sub(r"(?<=[\d.])[dD](?=[-+\d])", "e", plain)
            plain = re.sub(r"(?<=[\d.])(?:_\w+|[fFlLuUdD]+)$", "", plain)
            return re.sub(r"^0+(?=\d)", "", plain)
        if text in ("...", "&") and self.curved:
            return " "
        if text == "^" and self.language in ("cpp", "java", "javascript"):
            raise Opaque
        if self.language == "fortran":  # which does not tell small letters from capitals
            text = text.lower()
        if text in ("->", "%"):
            return "." if text == "->" or self.language == "fortran" else text
        return _SIGNS.get(text, text) if text != "\n" else " "


def _parsed(text: str) -> ast.expr | None:
    if len(text) > 20_000:
        return None
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", SyntaxWarning)
            return parsed(text.strip())
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return None


def _first(node: "Node", *kinds: str) -> "Node | None":
    # nearest below, a level at a time
    level = [node]
    for _ in range(4):
        level = [c for n in level for c in n.named_children if c.type not in ("block", "compound_statement")]
        for child in level:
            if child.type in kinds:
                return child
    return None


def _child(node: "Node", which: int = 0) -> "Node | None":
    children = [c for c in node.named_children if "comment" not in c.type]
    return children[which] if children else None


def _text(node: "Node") -> str:
    return (node.text or b"").decode("utf-8", "replace")
