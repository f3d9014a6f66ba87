r"""The display equations of a text as it comes: LaTeX, or prose with `$$`, numbers in the margin, units in brackets."""

import re
from bisect import bisect_right
from collections.abc import Iterator
from dataclasses import replace
from itertools import pairwise

from mechsym.audit.read.matrices import entrywise
from mechsym.audit.read.units import unit_of
from mechsym.errors import BadInput
from mechsym.quantities import record

_ROWS = ("align", "gather", "eqnarray", "flalign", "alignat")
_WHOLE = ("equation", "multline", "displaymath", "math")
_OPENING = re.compile(
    rf"\\begin\{{(?P<name>{'|'.join((*_ROWS, *_WHOLE))})(?P<star>\*?)\}}(?:\{{\d+\}})?|\\\[|(?<!\\)\$\$"
    r"|^```math\b"  # as on GitHub
    r"|^[ \t]*\$(?=[^$\n=]+=[^$\n]+\$[ \t]*[.,;]?[ \t]*$)",  # a line of its own
    re.MULTILINE,
)
MOST = 3000  #: Equations of one file
_LONGEST = 6000  # characters of a display; two `$$` further apart are no pair
_COMMENT = re.compile(r"(?<!\\)%[^\n]*")
_FENCED = re.compile(r"^([ \t]*)(```+|~~~+)(math\b)?.*?(?:^\1\2[ \t]*$|\Z)", re.MULTILINE | re.DOTALL)
_REMARK = re.compile(r"^[ \t]*%[^\n]*", re.MULTILINE)
_INNER = re.compile(
    rf"\\(?:begin|end)\{{(?:split|aligned|alignedat|gathered|subequations|(?:{'|'.join((*_ROWS, *_WHOLE))})\*?)\}}"
    r"(?:\[\w\]|\{\d+\})?"
)
_NESTED = re.compile(r"\\(begin|end)\{|\\\\(?:\s*\[[\d.]+\s*\w+\])?")
LABEL = re.compile(r"\\label\s*\{([^{}]*)\}")
_TAG = re.compile(r"\\tag\*?\s*\{\s*\(?([^{}()]*)\)?\s*\}|\\eqno\s*\(?([\w.]+)\)?")
_MARGIN = re.compile(r"[ \t]*(?:\n[ \t]*)?\(?[ \t]*\(?(\d+(?:[.\-]\d+)*[a-z]?)\)[ \t.;,]*(?=\n|$)")
_TRAILING = re.compile(r"(?:(?:\\q?quad|\\[,;:! ]|~|\s|\.)+|\\q?quad\s*[-–—]+\s*)\((\d+(?:\.\d+)*[a-z]?)\)\s*$")
_UNNUMBERED = re.compile(r"\\(?:nonumber|notag)\b")
_SIGN = r"(?:[=+\-]|\\(?:approx|simeq|cdot|times|equiv)\b)"
_SPACE = r"(?:\s|~|\\q?quad\b|\\[,;:! ]|\{\})"
_WIDE = re.compile(rf"{_SPACE}{{9,}}")  # as good as one, and read in a moment
_TRAIL = re.compile(rf"(?:{_SPACE}|[.,;])+$")
_GOES_ON = re.compile(rf"{_SPACE}*{_SIGN}")
_OPEN = re.compile(rf"{_SIGN}\s*$")
_IS_ZERO = re.compile(rf"={_SPACE}*0{_SPACE}*[.,;]?{_SPACE}*$")
_WORDS = re.compile(
    rf"[,;.]?{_SPACE}*(?<!_)(?<!_\{{)\\(?:text|mbox|intertext|textrm|mathrm)\s*\{{\s*"
    r"(?:for|if|where|when|with|and|at|in|per|positive|negative|otherwise|as)\b[^{}]*\}.*$|"
    r"[,;]\s*(?:\\q?quad|\\ )+\s*(?:for|if|where|with|when)\b.*$",
    re.DOTALL,
)
_TWO = re.compile(
    rf"[,;]{_SPACE}*(?:\\q?quad\b|\\[;, ]|~){_SPACE}*(?=[^=]*=)|\\(?:implies|Rightarrow|Longrightarrow|iff|"
    rf"Leftrightarrow)(?![A-Za-z])|\\q?quad{_SPACE}*(?=\\?[A-Za-z][^=,;]{{0,40}}=)|\\text\s*\{{\s*,?\s*and\s*\}}"
)
_LIMIT = re.compile(r"(?<![\\{]),[^=,]*(?:<|>|\\leq?\b|\\geq?\b|\\ll\b|\\gg\b)[^=]*$")
_PROSE = re.compile(r"(?:^|\s)[A-Za-z]{3,}(?=[\s,.:;]|$)")  # a word, which no formula has
# signs of LaTeX and of a page's own language
_MARK = re.compile(r"[$\\`<>\"]|==|^(?: {4}|\t)|^\s*(?:[-*+]\s|[|#!\[]|\d+\.\s)")
_NUMBER = re.compile(r"\(?(\d{1,3}(?:\.\d+)*)\)?")
_UNIT = r"\\(?:text|mathrm|mbox|rm)\s*\{[^{}]*\}(?:\^\{?-?\d\}?)?"
_DATA = re.compile(rf"(=\s*-?\d[\d.,]*){_SPACE}*((?:{_UNIT}|/|\\cdot|{_SPACE})+)[.,;]?\s*$")  # 3\,\text{W/m}^3
BRACKET = re.compile(rf"{_SPACE}*(?:\\left)?\[([^\[\]]{{1,60}}?)(?:\\right)?\]{_SPACE}*[.,;]?\s*$")


@record
class Displayed:
    """One equation as it stands in the file."""

    number: str  #: As it would be printed, empty where it has none
    label: str
    text: str
    line: int  #: Where it begins, counted from 1 [-]
    aside: str = ""  #: Words behind it that are no formula
    unit: str = ""  #: Unit in brackets behind it
    begins: int = 0  #: Where it stands in the file [-]
    opens: int = 0  #: Where its display begins there [-]


@record
class _Display:
    body: str
    start: int
    rows: bool
    numbered: bool
    number: str = ""


def displayed(text: str) -> list[Displayed]:
    """All display equations of a text in their order; numbers are counted as LaTeX counts them."""
    latex = r"\begin{document}" in text or r"\documentclass" in text
    text = (_COMMENT if latex else _REMARK).sub(lambda m: " " * len(m[0]), _without_programs(text))
    equations: list[Displayed] = []
    breaks = [m.start() for m in re.finditer("\n", text)]
    count = 0
    for block in _blocks(text, max(text.find(r"\begin{document}"), 0)):
        before = len(equations)
        for start, row in _rows(block.body) if block.rows else [(0, block.body)]:
            tag, label = _TAG.search(row), LABEL.search(row)
            counts = block.numbered and not _UNNUMBERED.search(row) and not tag and bool(row.strip())
            count += counts
            plain = _plain(row)
            if not plain:
                continue
            trailing = _TRAILING.search(plain)
            plain = plain[: trailing.start()] if trailing else plain
            number = (tag[1] or tag[2] or "").strip() if tag else str(count) if counts else block.number
            number = trailing[1] if trailing and not number else number
            begins = block.start + start + len(row) - len(row.lstrip())
            line = bisect_right(breaks, begins) + 1
            one = Displayed(
                number=number, label=label[1] if label else "", text=plain, line=line, begins=begins, opens=block.start
            )
            if equations and _joins(equations[-1].text, plain, len(equations) > before):
                last = equations.pop()
                number, name = last.number or number, last.label or one.label
                one = replace(last, number=number, label=name, text=f"{last.text} {plain}")
                before = min(before, len(equations))
            equations.append(one)
        if len(equations) > MOST:
            raise BadInput(f"it has more than {MOST} equations; give a part of it")
    everyone = (replace(whole, text=text) for whole in equations for text in entrywise(whole.text))
    return [part for equation in everyone for part in _parts(equation)]


def _without_programs(text: str) -> str:
    return _FENCED.sub(lambda m: m[0] if m[3] else re.sub(r"[^\n]", " ", m[0]), text)


def _joins(last: str, plain: str, same_block: bool) -> bool:
    # a row that begins with a sign goes on; across displays only what an open or leading equals sign asks for
    if same_block:
        if _IS_ZERO.search(last) and "=" in plain and not re.match(rf"{_SPACE}*=", plain):
            return False  # nothing is added to 0
        return bool(_GOES_ON.match(plain) or _OPEN.search(last))
    return bool(re.match(rf"{_SPACE}*=", plain) or re.search(r"=\s*$", last))


def _blocks(text: str, at: int) -> Iterator[_Display]:
    while match := _OPENING.search(text, at):
        at = match.end()
        name, star = match["name"], match["star"] or ""
        paired = {"$": "$", "$$": "$$", "```math": "```", r"\[": r"\]"}
        closing = rf"\end{{{name}{star}}}" if name else paired[match[0].strip()]
        close = text.find(closing, at, at + _LONGEST)
        body = text[at:close] if close >= 0 else ""
        if not body.strip() or match[0] == "$$" and re.search(r"\n[ \t]*\n|\n#", body.strip() if "=" in body else body):
            continue  # a sign that closes nothing: the next one opens
        lines = body.count("=") > 1 and re.search(r"\\\\[ \t]*\n", body)
        rows = name in _ROWS or bool(_INNER.search(body) or lines) and "{split}" not in body
        start, at = at, close + len(closing)
        margin = _MARGIN.match(text, at) if not name else None
        numbered = name in (*_ROWS, "equation", "multline") and not star
        yield _Display(body=body, start=start, rows=rows, numbered=bool(numbered), number=margin[1] if margin else "")
        at = margin.end() if margin else at


def _rows(body: str) -> Iterator[tuple[int, str]]:
    # rows of an alignment; line ends inside cases and the like are left alone
    body = _INNER.sub(lambda m: " " * len(m[0]), body)
    depth, start = 0, 0
    for mark in _NESTED.finditer(body):
        if mark[1]:
            depth += 1 if mark[1] == "begin" else -1
        elif depth == 0:
            yield start, body[start : mark.start()]
            start = mark.end()
    if body[start:].strip():
        yield start, body[start:]


def _plain(row: str) -> str:
    for pattern in (_TAG, LABEL, _UNNUMBERED, _INNER):
        row = pattern.sub(" ", row)
    if r"\begin{" not in row:
        row = re.sub(r"\\\\(?:\s*\[[\d.]+\s*\w+\])?", " ", row)
        cells = row.split("&")
        pairs = [" ".join(cells[k : k + 2]) for k in range(0, len(cells), 2)]
        several = len(pairs) > 1 and all("=" in pair for pair in pairs)  # a &= b, & c &= d
        row = r", \quad ".join(pairs) if several else " ".join(cells)
    return _WIDE.sub(r" \\quad ", " ".join(row.split()))


def _parts(equation: Displayed) -> Iterator[Displayed]:
    # a = b, \quad c = d is two statements; words behind and a unit in brackets are set aside
    words = _WORDS.search(equation.text) if r"\begin{" not in equation.text else None
    text = equation.text[: words.start()] if words and words.start() else equation.text
    aside = words[0].strip(" ,;") if words and words.start() else ""
    for part in _split(text):
        limit = _LIMIT.search(part)
        if limit and "=" in part[: limit.start()]:
            part, aside = part[: limit.start()], limit[0].strip(" ,")
        unit = BRACKET.search(part)
        known = unit_of(unit[1]) if unit and "=" in part[: unit.start()] else None
        if unit and known:
            part = part[: unit.start()]
        elif data := _DATA.search(part):
            part, known = part[: data.end(1)], unit_of(data[2])
            aside = aside or ("" if known else data[2].strip())
        part = _TRAIL.sub("", part).strip(" .,;")
        if part.strip("\\"):
            yield replace(equation, text=part, aside=aside, unit=known or "")


def _split(text: str) -> list[str]:
    # where no brace is open
    cuts = [m.span() for m in _TWO.finditer(text) if text.count("{", 0, m.start()) == text.count("}", 0, m.start())]
    return [text[a:b] for (_, a), (b, _) in pairwise([(0, 0), *cuts, (len(text), 0)])]


def flattened(text: str) -> list[Displayed]:
    """Lines that are equations in a text that marks none, as one copied from a page is: their fraction bars, roots
    and powers are lost."""
    equations: list[Displayed] = []
    lines = _without_programs(text).split("\n")
    for i, line in enumerate(lines):
        left, equals, _ = line.strip().partition("=")
        if not equals or not left or _PROSE.search(line.strip()) or _MARK.search(line):
            continue
        number = _NUMBER.fullmatch(lines[i - 1].strip()) if i else None
        one = Displayed(number=number[1] if number else "", label="", text=line.strip(), line=i + 1)
        equations.append(one)
    return equations[:MOST]
