r"""The display equations of a LaTeX file, each with its number, its label and its line."""

import re
from collections.abc import Iterator

from mechsym.quantities import record

_ROWS = ("align", "gather", "eqnarray", "flalign", "alignat")
_WHOLE = ("equation", "multline", "displaymath", "math")
_DISPLAY = re.compile(
    rf"\\begin\{{(?P<name>{'|'.join((*_ROWS, *_WHOLE))})(?P<star>\*?)\}}(?:\{{\d+\}})?(?P<body>.*?)"
    r"\\end\{(?P=name)(?P=star)\}|\\\[(?P<bracket>.*?)\\\]|\$\$(?P<dollar>.*?)\$\$",
    re.DOTALL,
)
_COMMENT = re.compile(r"(?<!\\)%[^\n]*")
_INNER = re.compile(r"\\(?:begin|end)\{(?:split|aligned|gathered|subequations)\}(?:\[\w\])?")
_NESTED = re.compile(r"\\(begin|end)\{|\\\\(?:\s*\[[^\]]*\])?")
_LABEL = re.compile(r"\\label\s*\{([^{}]*)\}")
_TAG = re.compile(r"\\tag\*?\s*\{\s*\(?([^{}()]*)\)?\s*\}")
_UNNUMBERED = re.compile(r"\\(?:nonumber|notag)\b")
_SIGN = r"(?:[=+\-]|\\(?:approx|simeq|cdot|times|equiv)\b)"
_GOES_ON = re.compile(rf"(?:\s|\\q?quad\b|\\[,;:! ])*{_SIGN}")
_OPEN = re.compile(rf"{_SIGN}\s*$")
_WORDS = re.compile(r"(?:[,;]?\s*\\q?quad\s*)?\\(?:text|mbox|intertext)\s*\{[^{}]*\}.*$", re.DOTALL)
_TWO = re.compile(r"[,;]\s*(?:\\q?quad|\\[;,: ]|~)+(?=[^=]*=)")


@record
class Displayed:
    """One equation as it stands in the file."""

    number: str  #: As it would be printed, empty where it has none
    label: str
    text: str
    line: int  #: Where it begins, counted from 1 [-]
    aside: str = ""  #: Words behind it that are no formula


def displayed(text: str) -> list[Displayed]:
    """All display equations of a LaTeX text in their order; numbers are counted as LaTeX counts them."""
    text = _COMMENT.sub("", text)
    begin = text.find(r"\begin{document}")
    found: list[Displayed] = []
    count = 0
    for match in _DISPLAY.finditer(text, max(begin, 0)):
        body = next(match[k] for k in ("body", "bracket", "dollar") if match[k] is not None)
        numbered = match["name"] in (*_ROWS, "equation", "multline") and not match["star"]
        offset = match.start() + match[0].index(body)
        rows = list(_rows(body)) if match["name"] in _ROWS else [(0, body)]
        before = len(found)
        for start, row in rows:
            counts = numbered and not _UNNUMBERED.search(row) and not _TAG.search(row) and bool(row.strip())
            count += counts
            line = text.count("\n", 0, offset + start + len(row) - len(row.lstrip())) + 1
            _add(found, row, str(count) if counts else "", line, joined=len(found) > before)
    return [part for equation in found for part in _parts(equation)]


def _rows(body: str) -> Iterator[tuple[int, str]]:
    # rows of an alignment; line ends inside cases and the like are left alone
    depth, start = 0, 0
    for mark in _NESTED.finditer(body):
        if mark[1]:
            depth += 1 if mark[1] == "begin" else -1
        elif depth == 0:
            yield start, body[start : mark.start()]
            start = mark.end()
    if body[start:].strip():
        yield start, body[start:]


def _add(found: list[Displayed], row: str, number: str, line: int, joined: bool) -> None:
    tag, label = _TAG.search(row), _LABEL.search(row)
    number, name = tag[1].strip() if tag else number, label[1] if label else ""
    plain = _plain(row)
    if not plain:
        return
    if joined and (_GOES_ON.match(plain) or _OPEN.search(found[-1].text)):
        last = found.pop()
        text = f"{last.text} {plain}"
        found.append(Displayed(number=last.number or number, label=last.label or name, text=text, line=last.line))
        return
    found.append(Displayed(number=number, label=name, text=plain, line=line))


def _plain(row: str) -> str:
    for pattern in (_TAG, _LABEL, _UNNUMBERED, _INNER):
        row = pattern.sub(" ", row)
    if r"\begin{" not in row:
        row = re.sub(r"\\\\(?:\s*\[[^\]]*\])?", " ", row).replace("&", " ")
    return " ".join(row.split())


def _parts(equation: Displayed) -> Iterator[Displayed]:
    # a = b, \quad c = d is two statements; words behind are set aside
    words = _WORDS.search(equation.text) if r"\begin{" not in equation.text else None
    text = equation.text[: words.start()] if words and words.start() else equation.text
    aside = words[0].strip(" ,;") if words and words.start() else ""
    for part in _TWO.split(text):
        yield Displayed(
            number=equation.number, label=equation.label, text=part.strip(" .,;"), line=equation.line, aside=aside
        )
