"""Formulas out of program text: the assignments of one function or model, its own variables put in.

Python is read by its own parser; C, Java, JavaScript, MATLAB, Julia, Fortran and Modelica by their statements. Loops,
branches and arrays are not followed: what is assigned in one is unknown where it is used, or a letter where it has no
other formula.
"""

import ast
import re
from collections.abc import Collection
from pathlib import Path

from mechsym.errors import BadInput
from mechsym.files.inputs import read_text
from mechsym.quantities import record

# languages whose statements end with the line
COMMENTS = {".m": "%", ".jl": "#", ".f90": "!", ".f95": "!", ".f03": "!", ".f08": "!"}
_WHOLE = re.DOTALL | re.MULTILINE
LONGEST = 5000  # of a formula with everything put in
UNFOLLOWED = "unfollowed_"  # before the name of what a loop or a branch assigns, or what is changed in place
_NAME = r"[A-Za-z_]\w*"
_ASSIGNED = re.compile(
    rf"^(?:[\w.:<>,\[\]\s*&]*?[\s*&])?(?P<name>{_NAME})\s*(?P<text>\"[^\"]*\")?\s*:?=(?!=)\s*(?P<value>.+)$", re.DOTALL
)
_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
_DECLARED = re.compile(rf"(?P<name>{_NAME})\s*(?:\([^()]*\))?\s*\"(?P<about>[^\"]+)\"\s*$", re.DOTALL)
_SPELLED = (
    (re.compile(r"\b(?:Modelica\.Constants\.pi|Math\.PI|M_PI|math\.pi|np\.pi|numpy\.pi|std::numbers::pi)\b"), "pi"),
    (re.compile(r"\b(?:Math|std|Modelica\.Math|math|np|numpy)\s*(?:\.|::)\s*(?=[a-zA-Z])"), ""),
    (re.compile(r"\b(a?(?:sin|cos|tan)|atan2|sqrt|pow|exp|log|fabs|hypot|cbrt|fmax|fmin)[fl](?=\s*\()"), r"\1"),
    (re.compile(r"\.([*/^])"), r"\1"),
    # 1.0f; and not the l of self.l
    (re.compile(r"(?<![\w.])(\d+\.?\d*(?:[eE][-+]?\d+)?|\.\d+)[fFlLdD]\b"), r"\1"),
    (re.compile(r"\b(?:self|this|obj|params?|cfg|p|s)(?:\.|->)(?=[A-Za-z_])"), ""),
    (re.compile(r"\((?:double|float|real|Real)\)"), ""),
)
_CHANGED = re.compile(rf"({_NAME})\s*(?:[-+*/]?=(?!=)|\+\+|--)")
_OPENS = re.compile(r"^\s*(?:if|for|while|when|switch|else|do|try)\b")
# a letter that is only told in another unit keeps its name
_UNITS = re.compile(r"radians|deg2rad|180|[*/]\s*(?:60|1000|100|1e-?\d+)\b")
_ENDS = (".mo", ".c", ".h", ".cpp", ".cc", ".hpp", ".java", ".js", ".ts", ".cs", *COMMENTS)


@record
class Assigned:
    """A variable of a program with its formula."""

    name: str  #: `return` for what a function gives back
    text: str
    about: str  #: What a comment or a description says of it
    inner: bool = False  #: Whether a later formula is made of it


def read_code(place: str, letters: Collection[str] = ()) -> list[Assigned]:
    """The assignments of `FILE::FUNCTION`, its variables put in; `letters` stay letters where it gives them numbers."""
    file, mark, function = place.rpartition("::")
    if not mark or not file or not function:
        raise BadInput(f"--code {place!r} is not FILE::FUNCTION, as engine.c::piston_speed")
    suffix = Path(file).suffix
    text = read_text(Path(file), "--code")
    if suffix == ".py":
        assigned = _python(text, function, file)
    elif suffix in _ENDS:
        body = lined_body(text, function, suffix) if suffix in COMMENTS else _body(text, function, suffix)
        if body is None:
            raise BadInput(f"--code {file}: there is no {function}; name a function or model that stands there")
        assigned = _statements(body, ".m" if suffix in COMMENTS else suffix)
    else:
        raise BadInput(f"--code {file}: files that are read end in .py, {', '.join(_ENDS)}")
    formulas = _inlined([a for a in assigned if not (a.name in letters and _NUMBER.fullmatch(a.text))])
    if not formulas:
        raise BadInput(f"--code {place}: there is no assignment and no return of arithmetic in {function}")
    return formulas


def _python(text: str, function: str, file: str) -> list[Assigned]:
    try:
        tree = ast.parse(text)
    except (SyntaxError, ValueError) as error:
        raise BadInput(f"--code {file}: not valid Python: {error}") from None
    functions = [n for n in ast.walk(tree) if isinstance(n, (ast.FunctionDef, ast.AsyncFunctionDef))]
    chosen = next((n for n in functions if n.name == function), None)
    if chosen is None:
        names = ", ".join(dict.fromkeys(n.name for n in functions if isinstance(n, ast.FunctionDef)))
        raise BadInput(f"--code {file}: there is no function {function}; there are {names or 'none'}")
    lines, assigned = text.splitlines(), []
    for node in chosen.body:
        about = lines[node.lineno - 1].partition("#")[2].strip()
        if isinstance(node, ast.Return) and node.value is not None:
            assigned.append(Assigned(name="return", text=_spelled(ast.unparse(node.value)), about=about or function))
        elif isinstance(node, ast.Assign) and len(node.targets) == 1 and isinstance(node.targets[0], ast.Name):
            assigned.append(Assigned(name=node.targets[0].id, text=_spelled(ast.unparse(node.value)), about=about))
        else:
            assigned += _unfollowed(ast.unparse(node))
    return assigned


def _unfollowed(statement: str) -> list[Assigned]:
    # without a text what is assigned without regard to its value before
    assigned = []
    for name in dict.fromkeys(_CHANGED.findall(statement)):
        again = rf"\b{name}\s*(?:[-+*/]=|\+\+|--)|\b{name}\s*=(?!=)[^;\n]*\b{name}\b"
        assigned.append(Assigned(name=name, text=UNFOLLOWED + name if re.search(again, statement) else "", about=""))
    return assigned


def _body(text: str, function: str, suffix: str) -> str | None:
    # of a Modelica model, or between braces
    name = re.escape(function)
    if suffix == ".mo":
        model = re.search(rf"\b(?:model|function|block|class)\s+{name}\b(.*?)\bend\s+{name}\s*;", text, re.DOTALL)
        return model[1] if model else None
    for match in re.finditer(rf"\b{name}\s*\([^;{{}}]*\)[^;{{}}]*\{{", text):
        depth, start = 1, match.end()
        for i in range(start, len(text)):
            depth += {"{": 1, "}": -1}.get(text[i], 0)
            if depth == 0:
                return text[start:i]
    return None


def lined_body(text: str, function: str, suffix: str) -> str | None:
    """The statements of a function whose statements end with the line, each closed by a semicolon, comments behind `%`;
    None where it is not there."""
    name = re.escape(function)
    if suffix == ".m":
        match = re.search(rf"^\s*function\b[^\n]*\b{name}\b[^\n]*\n(.*?)(?=^\s*function\b|\Z)", text, _WHOLE)
    elif suffix == ".jl":
        match = re.search(rf"^(\s*)function\s+{name}\s*\([^\n]*\n(?P<body>.*?)^\1end\b", text, _WHOLE)
        short = re.search(rf"^\s*{name}\s*\([^\n=]*\)\s*=(?!=)([^\n]*)", text, re.MULTILINE)
        if match is None and short is not None:
            return _closed(f"return {short[1].strip()}", suffix)
    else:
        ending = r"^\s*end\s*(?:function|subroutine)?\b(?!\s*(?:if|do))"
        whole = rf"\b(?:function|subroutine)\s+{name}\s*\([^\n]*\n(?P<body>.*?){ending}"
        match = re.search(whole, text, _WHOLE | re.IGNORECASE)
    return None if match is None else _closed(match[match.lastgroup or 1], suffix)


def _closed(body: str, suffix: str) -> str:
    lines, pending = [], ""
    for line in body.splitlines():
        code, _, remark = line.partition(COMMENTS[suffix])
        code = (pending + code).strip()
        if code.endswith(("...", "&")) or code.count("(") > code.count(")"):
            pending = code.rstrip(".&") + " "
            continue
        pending = ""
        code = _fortran(code) if suffix.startswith(".f") else code
        lines.append([code if not code or code.endswith(";") else f"{code};", remark])
    last = next((line for line in reversed(lines) if line[0]), None) if suffix == ".jl" else None
    # Julia gives back what stands last
    if last is not None and not re.match(r"(?:return|end)\b", last[0]) and not re.search(r"(?<![<>=!])=(?!=)", last[0]):
        last[0] = f"return {last[0]}"
    return "\n".join(f"{code} %{remark}" if remark and code else code for code, remark in lines)


def _fortran(code: str) -> str:
    code = re.sub(r"^.*::\s*", "", code.lower())
    code = re.sub(r"(?<![\w.])(\d+\.?\d*)d([-+]?\d+)", r"\1e\2", code)
    code = re.sub(r"^end\s*(?:if|do)\b", "end", code)
    if re.match(r"if\b", code) and not code.endswith("then"):
        return f"{code};\nend"  # an if of one line
    return re.sub(r"^do\b", "for", code)


def _statements(body: str, suffix: str) -> list[Assigned]:
    comment = "%" if suffix == ".m" else "//"
    abouts: dict[str, str] = {}
    assigned: list[Assigned] = []
    body = re.sub(r"/\*.*?\*/", " ", body, flags=re.DOTALL)
    # a comment behind a statement belongs to it
    body = re.sub(rf";[ \t]*{comment}([^\n]*)", lambda m: f"; \x01{m[1].strip()}\x02", body)
    body = re.sub(rf"{comment}[^\n]*", " ", body)
    # what opens and closes a block is a statement of its own
    if suffix in (".m", ".mo"):
        body = re.sub(r"(?m)^(\s*(?:end\b|(?:for|while|if|switch)\b(?=[^\n;]*$))[^\n;]*)", r";\1;", body)
    else:
        body = re.sub(r"([{}])", r";\1;", body)
    if suffix == ".mo":
        body = re.sub(r"\b(?:initial\s+)?(?:equation|algorithm)\b", ";", body)
    depth = 0
    for statement in body.split(";"):
        behind = re.match(r"\s*\x01(.*?)\x02", statement)
        if behind is not None:
            if assigned:
                abouts.setdefault(assigned[-1].name, behind[1])
            statement = statement[behind.end() :]
        statement = statement.strip()
        if suffix == ".mo" and (declared := _DECLARED.search(statement)) and "=" not in statement:
            abouts[declared["name"]] = declared["about"]
            continue
        inside, depth = depth, max(0, depth + _opened(statement, suffix))
        if inside or depth or _OPENS.match(statement) or re.search(r"[-+*/]=|\+\+|--", statement):
            assigned += _unfollowed(statement)
            continue
        # double s = sin(t), c = cos(t)
        parts = re.split(rf",\s*(?={_NAME}\s*=(?!=))", statement)
        whole = all(p.count("(") == p.count(")") for p in parts)
        assigned += filter(None, (_assigned(part, suffix) for part in (parts if whole else [statement])))
    return [Assigned(name=a.name, text=a.text, about=abouts.get(a.name, a.about)) for a in assigned]


def _opened(statement: str, suffix: str) -> int:
    # by how many blocks the statements behind are deeper
    if suffix not in (".m", ".mo"):
        return statement.count("{") - statement.count("}")
    lines = statement.splitlines()
    opened = sum(bool(re.match(r"\s*(?:for|while|when|if|switch|try)\b", line)) for line in lines)
    return opened - sum(bool(re.match(r"\s*end\b", line)) for line in lines)


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


def _inlined(assignments: list[Assigned]) -> list[Assigned]:
    known: dict[str, str] = {}
    formulas = []
    for i, assigned in enumerate(assignments):
        if not assigned.text and assigned.name not in known:
            continue  # a letter
        if not assigned.text or assigned.text.startswith(UNFOLLOWED):
            known[assigned.name] = UNFOLLOWED + assigned.name
            formulas.append(Assigned(name=assigned.name, text=known[assigned.name], about=assigned.about))
            continue
        text = re.sub(rf"(?<![\w.]){_NAME}", lambda m: f"({known[m[0]]})" if m[0] in known else m[0], assigned.text)
        if len(text) > LONGEST:
            text = assigned.text
        inner = any(re.search(rf"(?<![\w.]){assigned.name}\b", later.text) for later in assignments[i + 1 :])
        formulas.append(Assigned(name=assigned.name, text=text, about=assigned.about, inner=inner))
        again = re.search(rf"(?<![\w.]){re.escape(assigned.name)}\b", text)
        if assigned.name != "return" and not (again and _UNITS.search(assigned.text)):
            known[assigned.name] = text
    return formulas
