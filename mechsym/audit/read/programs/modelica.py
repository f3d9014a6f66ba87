"""Modelica by a small grammar of its sections: declarations, and the equations and algorithms of a model."""

import re

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

_TOKEN = re.compile(
    r'(?P<comment>//[^\n]*|/\*.*?(?:\*/|\Z))|(?P<text>"(?:[^"\\]|\\.)*")|(?P<end>;)|(?P<open>[(\[{])|(?P<close>[)\]}])'
    r"|(?P<word>[A-Za-z_][\w.]*)|(?P<line>\n)|(?P<rest>:=|<=|>=|==|<>|\.?[\d.]+(?:[eE][-+]?\d+)?|\S)",
    re.DOTALL,
)
_HEAD = re.compile(
    r"^(?:within|final|encapsulated|partial|replaceable|inner|outer|redeclare|public|protected|expandable|operator)?\s*"
    r"(?:partial\s+|expandable\s+)?(?:model|block|class|function|record|connector)\s+(\w+)"
)
_OPENS = re.compile(r"^(if|for|when|while)\b")
_ENDS = re.compile(r"^end\s+(if|for|when|while)\b")
_DECLARED = re.compile(r"^(?:[\w.]+\s+)+?(?:[\w.]+\s*)?(?:\[[^\]]*\])?\s*(\w+)\s*(?:\[[^\]]*\]\s*)?(?:\(.*\))?\s*$")


class _Piece:
    """A statement without its strings: text, line, what a string says of it, and whether it is a declaration."""

    def __init__(self, words: list[str], line: int, about: str) -> None:
        self.text, self.line, self.about = " ".join(words), line, about


def read_modelica(text: str) -> ProgramText:
    """The scopes of a Modelica file: each model with its bindings, equations and algorithms."""
    scopes: list[tuple[str, int, list[_Piece], list[str]]] = [("", 1, [], [])]
    abouts: dict[str, str] = {}
    comments: dict[int, str] = {}
    for piece in _pieces(text, comments):
        head = _HEAD.match(piece.text)
        if head:
            scopes.append((head[1], piece.line, [], []))
            piece.text = piece.text[head.end() :].strip()
        if piece.text.startswith("annotation"):
            continue
        if declared := _DECLARED.match(piece.text):
            abouts.setdefault(declared[1], f"{piece.about} {_unit(piece.text)}".strip())
            if piece.text.startswith("input"):
                scopes[-1][3].append(declared[1])
        elif piece.about and "=" in piece.text:
            comments.setdefault(piece.line, piece.about)
        scopes[-1][2].append(piece)
    read = [Scope(name=name, line=line, parameters=given, body=_body(pieces)) for name, line, pieces, given in scopes]
    return ProgramText(scopes=read, comments=comments, abouts=abouts)


def _unit(declared: str) -> str:
    kind = re.search(r"SIunits\.(\w+)|Units\.SI\.(\w+)", declared)
    return re.sub(r"(?<=[a-z])(?=[A-Z])", " ", (kind[1] or kind[2]) if kind else "")


def _pieces(text: str, comments: dict[int, str]) -> list[_Piece]:
    pieces: list[_Piece] = []
    words: list[str] = []
    about, line, start, depth = "", 1, 1, 0
    for match in _TOKEN.finditer(text):
        kind, said = match.lastgroup, match[0]
        if kind == "comment":
            comments[line] = said.strip("/* \n")
        elif kind == "text":
            about = said.strip('"')[:200]
        elif (
            kind == "end"
            and depth == 0
            or kind == "word"
            and depth == 0
            and said
            in (
                "equation",
                "algorithm",
                "then",
                "loop",
                "else",
                "protected",
                "public",
                "elseif",
            )
        ):
            opens = said if said in ("else", "elseif") else ""
            if words:
                pieces.append(_Piece(words, start, about))
            words, about, start = ([opens] if opens == "elseif" else []), "", line
            if opens == "else":
                pieces.append(_Piece(["else"], line, ""))
        elif kind != "line":
            depth = max(0, depth + (kind == "open") - (kind == "close"))
            start = line if not words else start
            words.append(said)
        line += said.count("\n")
    return [*pieces, _Piece(words, start, about)] if words else pieces


def _body(pieces: list[_Piece]) -> list[Statement]:
    stack: list[tuple[str, list[list[Statement]]]] = [("", [[]])]
    for piece in pieces:
        if opened := _OPENS.match(piece.text):
            stack.append((piece.text, [[]]))
        elif piece.text.startswith(("else", "elseif")) and len(stack) > 1:
            stack[-1][1].append([])
        elif _ENDS.match(piece.text) and len(stack) > 1:
            said, arms = stack.pop()
            index = re.match(r"for\s+(\w+)", said)
            whole: Statement = Repeated(index=index[1], body=arms[0]) if index else Branch(arms=arms)
            stack[-1][1][-1].append(whole)
        elif not opened and (one := _let(piece)):
            stack[-1][1][-1].append(one)
    while len(stack) > 1:
        _, arms = stack.pop()
        stack[-1][1][-1].append(Branch(arms=arms))
    return stack[0][1][0]


def _let(piece: _Piece) -> Let | None:
    match = re.match(r"^(?P<left>[^=()]*?(?:\([^()]*\))?)\s*:?=(?!=)\s*(?P<right>.+)$", piece.text, re.DOTALL)
    if match is None:
        return None
    left = re.sub(r"\([^()]*\)\s*$", "", match["left"]).strip().split(" ")
    target = re.search(r"[A-Za-z_][\w.]*(?:\s*\[[^\]]*\])?\s*$", " ".join(left))
    if target is None:
        return None
    try:
        value = parsed(re.sub(r"\.?\^", "**", match["right"]))
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        value = None
    try:
        name = letter_of(parsed(target[0].strip()), frozenset("ijkn"))
    except (Opaque, SyntaxError, ValueError, RecursionError, MemoryError):
        return None
    return Let(name=name, value=value, line=piece.line)
