r"""An author's own commands of LaTeX, `\newcommand{\dd}{\mathrm{d}}`, written out where they are used."""

import re
from collections.abc import Mapping

from mechsym.quantities import record

_BEGINS = re.compile(
    r"\\(?:(?:re)?newcommand|providecommand)\*?\s*\{?\s*\\(?P<name>[A-Za-z]+)\s*\}?\s*(?:\[(?P<count>\d)\])?"
    r"(?:\[(?P<first>[^\[\]]*)\])?\s*(?=\{)"
    r"|\\DeclareMathOperator\*?\s*\{?\s*\\(?P<operator>[A-Za-z]+)\s*\}?\s*(?=\{)"
    r"|\\def\s*\\(?P<defined>[A-Za-z]+)\s*(?P<marks>(?:#\d)*)\s*(?=\{)"
)
_LONGEST = 6000  # characters of an argument
_DEEPEST = 8  # commands within commands
_LARGEST = 4  # a text with its commands written out, by the text


@record
class Macro:
    """A command of an author's."""

    body: str
    arguments: int  #: How many it takes [-]
    first: str | None  #: What the first is where it is left out in brackets


def expanded(text: str) -> str:
    """A text with its author's commands written out; each line keeps its number."""
    macros: dict[str, Macro] = {}
    parts, at = [], 0
    for match in _BEGINS.finditer(text):
        if match.start() < at or (end := _closing(text, match.end())) is None:
            continue
        name = match["name"] or match["operator"] or match["defined"]
        body = " ".join(text[match.end() + 1 : end - 1].split())
        body = rf"\operatorname{{{body}}}" if match["operator"] else body
        count = len(match["marks"]) // 2 if match["defined"] else int(match["count"] or 0)
        macros[name] = Macro(body=body, arguments=count, first=match["first"])
        parts += [text[at : match.start()], re.sub(r"[^\n]", " ", text[match.start() : end])]
        at = end
    if not macros:
        return text
    whole = "".join([*parts, text[at:]])
    used = re.compile(rf"\\({'|'.join(sorted(macros, key=len, reverse=True))})(?![A-Za-z])")
    for _ in range(_DEEPEST):
        following = _written_out(whole, used, macros)
        if following == whole or len(following) > _LARGEST * len(text) + 10_000:
            break
        whole = following
    return whole


def _written_out(text: str, used: re.Pattern[str], macros: Mapping[str, Macro]) -> str:
    parts, at = [], 0
    for match in used.finditer(text):
        if match.start() < at:
            continue
        macro, end, arguments = macros[match[1]], match.end(), []
        if macro.first is not None:
            given = re.compile(r"\s*\[([^\[\]]*)\]").match(text, end)
            arguments.append(given[1] if given else macro.first)
            end = given.end() if given else end
        while len(arguments) < macro.arguments:
            while text[end : end + 1].isspace():
                end += 1
            close = _closing(text, end) if text[end : end + 1] == "{" else None
            arguments.append(text[end + 1 : close - 1] if close else text[end : end + 1])
            end = close or end + 1
        body = macro.body
        for k, argument in enumerate(arguments, 1):
            body = body.replace(f"#{k}", argument)
        lost = text.count("\n", match.start(), end) - body.count("\n")
        # a letter behind would become a part of a command that ends the body
        parts += [text[at : match.start()], body, " " * bool(re.search(r"\\[A-Za-z]+$", body)), "\n" * lost]
        at = end
    return "".join([*parts, text[at:]])


def _closing(text: str, start: int) -> int | None:
    """Where the group that begins at a brace has ended; None where it never does."""
    depth = 0
    for match in re.compile(r"\\.|[{}]", re.DOTALL).finditer(text, start, start + _LONGEST):
        depth += {"{": 1, "}": -1}.get(match[0], 0)
        if depth == 0:
            return match.end()
    return None
