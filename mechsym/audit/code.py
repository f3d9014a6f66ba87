"""Formulas out of program text: the assignments of one function or model, its own variables put in.

Python is read by its own parser; C, Java, JavaScript, MATLAB and Modelica by their statements. Loops, branches and
arrays are not followed: a variable that is assigned in one keeps its name, and is unknown where it is used.
"""

import ast
import re
from pathlib import Path

from mechsym.errors import BadInput
from mechsym.files import read_text
from mechsym.quantities import record

LONGEST = 5000  # of a formula with everything put in
_NAME = r"[A-Za-z_]\w*"
_ASSIGNED = re.compile(
    rf"^(?:[\w.:<>,\[\]\s*&]*?[\s*&])?(?P<name>{_NAME})\s*(?P<text>\"[^\"]*\")?\s*:?=(?!=)\s*(?P<value>.+)$", re.DOTALL
)
_DECLARED = re.compile(rf"(?P<name>{_NAME})\s*(?:\([^()]*\))?\s*\"(?P<about>[^\"]+)\"\s*$", re.DOTALL)
_SPELLED = (
    (re.compile(r"\b(?:Modelica\.Constants\.pi|Math\.PI|M_PI|math\.pi|np\.pi|numpy\.pi|std::numbers::pi)\b"), "pi"),
    (re.compile(r"\b(?:Math|std|Modelica\.Math|math|np|numpy)\s*(?:\.|::)\s*(?=[a-zA-Z])"), ""),
    (re.compile(r"\.([*/^])"), r"\1"),
    (re.compile(r"(?<=[\d.])[fFlLdD]\b"), ""),
    (re.compile(r"\b(?:self|this|obj|params?|cfg|p|s)(?:\.|->)(?=[A-Za-z_])"), ""),
    (re.compile(r"\((?:double|float|real|Real)\)"), ""),
)
_ENDS = {".mo": ";", ".c": ";", ".h": ";", ".cpp": ";", ".cc": ";", ".hpp": ";", ".java": ";", ".js": ";", ".ts": ";",
         ".cs": ";", ".m": ";"}  # fmt: skip


@record
class Assigned:
    """A variable of a program with its formula."""

    name: str  #: `return` for what a function gives back
    text: str
    about: str  #: What a comment or a description says of it


def read_code(place: str) -> list[Assigned]:
    """The assignments of `FILE::FUNCTION`, each with the function's own variables put in."""
    file, mark, function = place.rpartition("::")
    if not mark or not file or not function:
        raise BadInput(f"--code {place!r} is not FILE::FUNCTION, as engine.c::piston_speed")
    path = Path(file)
    text = read_text(path, "--code")
    if path.suffix == ".py":
        found = _python(text, function, file)
    elif path.suffix in _ENDS:
        found = _statements(_body(text, function, file, path.suffix), path.suffix)
    else:
        raise BadInput(f"--code {file}: files that are read end in .py, {', '.join(_ENDS)}")
    if not found:
        raise BadInput(f"--code {place}: there is no assignment and no return of arithmetic in {function}")
    return _inlined(found)


def _python(text: str, function: str, file: str) -> list[Assigned]:
    try:
        tree = ast.parse(text)
    except (SyntaxError, ValueError) as error:
        raise BadInput(f"--code {file}: not valid Python: {error}") from None
    lines = text.splitlines()
    bodies = [
        n for n in ast.walk(tree) if isinstance(n, (ast.FunctionDef, ast.AsyncFunctionDef)) and n.name == function
    ]
    if not bodies:
        raise BadInput(f"--code {file}: there is no function {function}")
    found = []
    for node in bodies[0].body:
        about = lines[node.lineno - 1].partition("#")[2].strip()
        if isinstance(node, ast.Return) and node.value is not None:
            found.append(Assigned(name="return", text=_spelled(ast.unparse(node.value)), about=about or function))
        elif isinstance(node, ast.Assign) and len(node.targets) == 1 and isinstance(node.targets[0], ast.Name):
            found.append(Assigned(name=node.targets[0].id, text=_spelled(ast.unparse(node.value)), about=about))
    return found


def _body(text: str, function: str, file: str, suffix: str) -> str:
    if suffix == ".mo":
        match = re.search(
            rf"\b(?:model|function|block|class)\s+{re.escape(function)}\b(.*?)\bend\s+{re.escape(function)}\s*;",
            text,
            re.DOTALL,
        )
        body = match[1] if match else None
    elif suffix == ".m":
        match = re.search(
            rf"^\s*function\b[^\n]*\b{re.escape(function)}\b[^\n]*\n(.*?)(?=^\s*function\b|\Z)",
            text,
            re.DOTALL | re.MULTILINE,
        )
        body = match[1] if match else None
    else:
        body = _braced(text, function)
    if body is None:
        raise BadInput(f"--code {file}: there is no {function}; name a function or model that stands there")
    return body


def _braced(text: str, function: str) -> str | None:
    for match in re.finditer(rf"\b{re.escape(function)}\s*\([^;{{}}]*\)[^;{{}}]*\{{", text):
        depth, start = 1, match.end()
        for i in range(start, len(text)):
            depth += {"{": 1, "}": -1}.get(text[i], 0)
            if depth == 0:
                return text[start:i]
    return None


def _statements(body: str, suffix: str) -> list[Assigned]:
    comment = "%" if suffix == ".m" else "//"
    abouts: dict[str, str] = {}
    found: list[Assigned] = []
    body = re.sub(r"/\*.*?\*/", " ", body, flags=re.DOTALL)
    # a comment behind a statement belongs to it
    body = re.sub(rf";[ \t]*{comment}([^\n]*)", lambda m: f"; \x01{m[1].strip()}\x02", body)
    body = re.sub(rf"{comment}[^\n]*", " ", body)
    if suffix == ".mo":
        body = re.sub(r"\b(?:initial\s+)?(?:equation|algorithm)\b", ";", body)
    for statement in body.split(";"):
        behind = re.match(r"\s*\x01(.*?)\x02", statement)
        if behind is not None:
            if found:
                abouts.setdefault(found[-1].name, behind[1])
            statement = statement[behind.end() :]
        statement = statement.strip()
        if suffix == ".mo" and (declared := _DECLARED.search(statement)) and "=" not in statement:
            abouts[declared["name"]] = declared["about"]
            continue
        for part in _declarators(statement):
            if assigned := _assigned(part, suffix):
                found.append(assigned)
    return [Assigned(name=a.name, text=a.text, about=abouts.get(a.name, a.about)) for a in found]


def _declarators(statement: str) -> list[str]:
    # double s = sin(t), c = cos(t)
    parts = re.split(rf",\s*(?={_NAME}\s*=(?!=))", statement)
    return parts if all(p.count("(") == p.count(")") for p in parts) else [statement]


def _assigned(statement: str, suffix: str) -> Assigned | None:
    if match := re.match(r"return\b\s*(.+)$", statement, re.DOTALL):
        return Assigned(name="return", text=_spelled(match[1]), about="")
    match = _ASSIGNED.match(statement)
    if match is None or re.match(r"(?:if|for|while|when|else|end|assert|import|switch)\b", statement):
        return None
    value, about = match["value"], (match["text"] or "").strip('"')
    if suffix == ".mo" and (described := re.search(r"\"([^\"]*)\"\s*$", value)):
        value, about = value[: described.start()], described[1]
    return Assigned(name=match["name"], text=_spelled(value), about=about)


def _spelled(text: str) -> str:
    for pattern, instead in _SPELLED:
        text = pattern.sub(instead, text)
    return " ".join(text.split())


def _inlined(found: list[Assigned]) -> list[Assigned]:
    known: dict[str, str] = {}
    done = []
    for assigned in found:
        text = re.sub(rf"(?<![\w.]){_NAME}", lambda m: f"({known[m[0]]})" if m[0] in known else m[0], assigned.text)
        if len(text) > LONGEST:
            text = assigned.text
        done.append(Assigned(name=assigned.name, text=text, about=assigned.about))
        if assigned.name != "return" and re.search(rf"(?<![\w.]){re.escape(assigned.name)}\b", text) is None:
            known[assigned.name] = text
    return done
