"""Functions of languages whose statements end with the line: MATLAB, Julia and Fortran, brought into one form."""

import re

COMMENTS = {".m": "%", ".jl": "#", ".f90": "!", ".f95": "!", ".f03": "!", ".f08": "!"}
_FORTRAN = tuple(s for s in COMMENTS if s.startswith(".f"))
_WHOLE = re.DOTALL | re.MULTILINE


def lined_body(text: str, function: str, suffix: str) -> str | None:
    """The statements of a function, each closed by a semicolon, comments behind `%`; None where it is not there."""
    name = re.escape(function)
    if suffix == ".m":
        match = re.search(rf"^\s*function\b[^\n]*\b{name}\b[^\n]*\n(.*?)(?=^\s*function\b|\Z)", text, _WHOLE)
    elif suffix == ".jl":
        match = re.search(rf"^(\s*)function\s+{name}\s*\([^\n]*\n(?P<body>.*?)^\1end\b", text, _WHOLE)
        short = re.search(rf"^\s*{name}\s*\([^\n=]*\)\s*=(?!=)([^\n]*)", text, re.MULTILINE)
        if match is None and short is not None:
            return _closed(f"return {short[1].strip()}", suffix)
    else:
        match = re.search(
            rf"\b(?:function|subroutine)\s+{name}\s*\([^\n]*\n(?P<body>.*?)^\s*end\s*(?:function|subroutine)?\b(?!\s*(?:if|do))",
            text,
            _WHOLE | re.IGNORECASE,
        )
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
        code = _fortran(code) if suffix in _FORTRAN else code
        lines.append([code if not code or code.endswith(";") else f"{code};", remark])
    if suffix == ".jl":
        _with_return(lines)
    return "\n".join(f"{code} %{remark}" if remark and code else code for code, remark in lines)


def _fortran(code: str) -> str:
    code = re.sub(r"^.*::\s*", "", code.lower())
    code = re.sub(r"(?<![\w.])(\d+\.?\d*)d([-+]?\d+)", r"\1e\2", code)
    code = re.sub(r"^end\s*(?:if|do)\b", "end", code)
    if re.match(r"if\b", code) and not code.endswith("then"):
        return f"{code};\nend"  # an if of one line
    return re.sub(r"^do\b", "for", code)


def _with_return(lines: list[list[str]]) -> None:
    # Julia gives back what stands last
    last = next((line for line in reversed(lines) if line[0]), None)
    if last is not None and not re.match(r"(?:return|end)\b", last[0]) and not re.search(r"(?<![<>=!])=(?!=)", last[0]):
        last[0] = f"return {last[0]}"
