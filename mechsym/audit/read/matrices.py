r"""Equations between matrices that are printed entry by entry, as one equation for each entry."""

import re
from collections.abc import Iterator, Sequence
from functools import reduce

_KIND = r"(?:[bpvBV]?matrix|smallmatrix|array)"
_BLOCK = re.compile(
    rf"(?:\\left\s*)?[\[(]?\s*\\begin\{{({_KIND})\}}\s*(?:\{{[lcr|]*\}})?(.*?)\\end\{{\1\}}\s*(?:(?:\\right\s*)?[\])])?"
)
_SPACE = re.compile(r"\\(?:q?quad|[,;:! ]|cdot|times)|~|\s")
_OPERATOR = re.compile(r"frac\s*\{\s*(?:\\partial|d)|\\(?:nabla|int|sum|partial|frac\s*\{\s*\\mathrm)")
_LETTER_OF_MATRIX = re.compile(r"\\(?:mathbf|boldsymbol|bm|vec)(?![A-Za-z])")
_SIGNED = re.compile(r"^(.*?)\s*([+-])\s*([^+-]*)$")
_MOST = 16  # entries of a matrix that are one equation each

Entries = list[list[str]]


def entrywise(text: str) -> list[str]:
    """The equations of the entries of a matrix equation; the text itself where it is none that is multiplied out."""
    if r"\begin{" not in text or text.count(r"\begin{") != len(_BLOCK.findall(text)):
        return [text]
    sides = [_side(side) for side in _sides(text)]
    known = [side for side in sides if isinstance(side, list)]
    if len(sides) < 2 or len(known) < len(sides):
        return [text]
    rows, columns = len(known[0]), len(known[0][0])
    shapes = {(len(side), len(row)) for side in known for row in side}
    if shapes != {(rows, columns)} or rows * columns > _MOST:
        return [text]
    return [" = ".join(side[i][k] for side in known) for i in range(rows) for k in range(columns)]


def _sides(text: str) -> Iterator[str]:
    # equals signs outside of the blocks and braces
    start = depth = 0
    for mark in re.finditer(r"\\(begin|end)\{|[{}]|=", text):
        if mark[1]:
            depth += 1 if mark[1] == "begin" else -1
            depth += 1  # its own brace closes
        elif mark[0] == "=" and depth == 0:
            yield text[start : mark.start()].strip()
            start = mark.end()
        else:
            depth += {"{": 1, "}": -1}.get(mark[0], 0)
    yield text[start:].strip(" .,;")


def _side(text: str) -> Entries | str | None:
    """A side multiplied out; its text where no matrix stands in it, None where it cannot be."""
    blocks = list(_BLOCK.finditer(text))
    if not blocks:
        return text
    terms: list[Entries] = []
    product: Entries | None = None
    sign, at = "", 0
    for block in blocks:
        between, at = _plain(text[at : block.start()]), block.end()
        if product is not None and (signed := _SIGNED.match(between)):
            terms.append(_times(sign, signed[1], product))
            product, sign, between = None, signed[2], signed[3]
        elif product is None and between.startswith("-"):
            sign, between = "-", between[1:]
        if _OPERATOR.search(between) or _LETTER_OF_MATRIX.search(between):
            return None
        entries = _entries(block[2])
        joint = _multiplied(product, entries) if product and entries else entries
        if not joint:
            return None
        product = _times("", between.strip(), joint)
    rest = _plain(text[at:])
    if product is None or re.search(r"[+\-^=]", rest) or _LETTER_OF_MATRIX.search(rest):
        return None
    terms.append(_times(sign, rest, product))
    alike = len({(len(term), len(term[0])) for term in terms}) == 1
    return reduce(_sum, terms) if alike else None


def _plain(text: str) -> str:
    return _SPACE.sub(" ", text).strip()


def _entries(body: str) -> Entries:
    rows = [
        [cell.strip() for cell in row.split("&")] for row in re.split(r"\\\\(?:\s*\[[^\]]*\])?", body) if row.strip()
    ]
    whole = len({len(row) for row in rows}) == 1 and all(cell for row in rows for cell in row)
    return rows if whole and not any("dots" in cell for row in rows for cell in row) else []


def _times(sign: str, factor: str, entries: Entries) -> Entries:
    if not factor and sign != "-":
        return entries
    front = ("-" if sign == "-" else "") + (rf"{_bracketed(factor)} \cdot " if factor else "")
    return [[f"{front}{_bracketed(entry)}" for entry in row] for row in entries]


def _sum(left: Entries, right: Entries) -> Entries:
    return [
        [f"{a} + {b}" if b[:1] != "-" else f"{a} {b}" for a, b in zip(p, q, strict=True)]
        for p, q in zip(left, right, strict=True)
    ]


def _multiplied(left: Entries, right: Entries) -> Entries | None:
    if len(left[0]) != len(right):
        return None
    columns: Sequence[tuple[str, ...]] = list(zip(*right, strict=True))
    return [[_dot(row, column) for column in columns] for row in left]


def _dot(row: Sequence[str], column: Sequence[str]) -> str:
    products = [
        a if b == "1" else b if a == "1" else rf"{_bracketed(a)} \cdot {_bracketed(b)}"
        for a, b in zip(row, column, strict=True)
        if "0" not in (a, b)
    ]
    return " + ".join(products) or "0"


def _bracketed(text: str) -> str:
    return text if re.fullmatch(r"\\?[A-Za-z]+(?:_\w|_\{\w+\})?|\d+", text) else rf"\left({text}\right)"
