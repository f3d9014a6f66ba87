"""Python by its own parser: scopes with their statements."""

import ast
import io
import re
import tokenize
import warnings
from collections.abc import Iterator, Sequence

from mechsym.audit.read.notebook import cells_of
from mechsym.audit.read.programs.statements import (
    Branch,
    Let,
    Opaque,
    ProgramText,
    Repeated,
    Scope,
    Statement,
    letter_of,
)
from mechsym.errors import BadInput


def read_python(text: str) -> ProgramText:
    """The scopes of a Python file."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", SyntaxWarning)
            tree = ast.parse(text)
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        raise BadInput(f"not valid Python: {getattr(error, 'msg', None) or error}") from None
    comments, alone = _comments(text)
    scopes = [Scope(name="", line=1, parameters=(), body=_statements(tree.body)), *_scopes(tree.body, "")]
    for node in ast.walk(tree):
        # a docstring says what parameters are, line by line
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str):
            for i, line in enumerate(node.value.value.splitlines()):
                comments.setdefault(node.lineno + i, line.strip())
                alone.add(node.lineno + i)
    return ProgramText(scopes=scopes, comments=comments, alone=frozenset(alone))


def code_of_notebook(text: str) -> str:
    """The code cells of a Jupyter notebook, one below another, without those that are no Python."""
    code = cells_of(text, "code")
    plain = (re.sub(r"(?m)^(?=[ \t]*[%!?])", "# ", cell) for cell in code if not cell.startswith("%%"))
    return "\n".join(cell for cell in plain if _is_python(cell))


def _is_python(text: str) -> bool:
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", SyntaxWarning)
            ast.parse(text)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return False
    return True


def _comments(text: str) -> tuple[dict[int, str], set[int]]:
    comments, alone = {}, set()
    try:
        for token in tokenize.generate_tokens(io.StringIO(text).readline):
            if token.type == tokenize.COMMENT:
                comments[token.start[0]] = token.string.lstrip("# ")
                if not token.line[: token.start[1]].strip():
                    alone.add(token.start[0])
    except (tokenize.TokenError, IndentationError, SyntaxError):
        pass  # what was read so far
    return comments, alone


def _scopes(body: Sequence[ast.stmt], within: str) -> Iterator[Scope]:
    for node in body:
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)):
            names = [a.arg for a in (*node.args.posonlyargs, *node.args.args) if a.arg not in ("self", "cls")]
            inside, about = _statements(node.body), ast.get_docstring(node) or ""
            yield Scope(name=node.name, line=node.lineno, parameters=names, body=inside, within=within, about=about)
            yield from _scopes(node.body, node.name)
        elif isinstance(node, ast.ClassDef):
            yield Scope(name=node.name, line=node.lineno, parameters=(), body=_statements(node.body))
            yield from _scopes(node.body, within)
        elif isinstance(node, (ast.If, ast.For, ast.While, ast.With, ast.Try)):
            yield from _scopes(node.body, within)
        elif isinstance(node, ast.Assign) and isinstance(node.value, ast.Lambda):
            yield from _lambda(node, node.value, within)
        elif isinstance(node, ast.Return) and isinstance(node.value, ast.Lambda):
            value = node.value
            given = [a.arg for a in value.args.args]
            yield Scope(name=within, line=node.lineno, parameters=given, body=[_return(value.body)])


def _lambda(node: ast.Assign, value: ast.Lambda, within: str) -> Iterator[Scope]:
    if isinstance(node.targets[0], ast.Name):
        given = [a.arg for a in value.args.args]
        yield Scope(
            name=node.targets[0].id, line=node.lineno, parameters=given, body=[_return(value.body)], within=within
        )


def _return(value: ast.expr | None) -> Let:
    return Let(name="return", value=value, line=value.lineno if value else 0)


def _statements(body: Sequence[ast.stmt]) -> list[Statement]:
    return [one for node in body for one in _statement(node)]


def _statement(node: ast.stmt) -> Iterator[Statement]:
    if isinstance(node, ast.Return) and node.value is not None:
        yield _return(node.value)
    elif isinstance(node, ast.Assign):
        for target in node.targets:
            yield from _assigned(target, node.value)
    elif isinstance(node, ast.AnnAssign) and node.value is not None:
        yield from _assigned(node.target, node.value)
    elif isinstance(node, ast.AugAssign):
        yield from _assigned(node.target, None)
    elif isinstance(node, ast.If):
        yield Branch(arms=[_statements(node.body), _statements(node.orelse)])
    elif isinstance(node, ast.Match):
        yield Branch(arms=[_statements(case.body) for case in node.cases])
    elif isinstance(node, ast.Try):
        yield Branch(arms=[_statements(node.body), *(_statements(h.body) for h in node.handlers)])
    elif isinstance(node, (ast.For, ast.While)):
        index = ast.unparse(node.target) if isinstance(node, ast.For) else ""
        yield Repeated(index=index, body=_statements(node.body))
    elif isinstance(node, ast.With):
        yield from _statements(node.body)


def _assigned(target: ast.expr, value: ast.expr | None) -> Iterator[Let]:
    if isinstance(target, (ast.Tuple, ast.List)):
        parts = value.elts if isinstance(value, (ast.Tuple, ast.List)) and len(value.elts) == len(target.elts) else None
        for i, one in enumerate(target.elts):
            yield from _assigned(one, parts[i] if parts else None)
        return
    try:
        yield Let(name=letter_of(target, frozenset("ijkn")), value=value, line=target.lineno)
    except Opaque:
        return
