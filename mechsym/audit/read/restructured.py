"""Formulas of reStructuredText, as Sphinx writes pages, under the signs of other texts."""

import re
from collections.abc import Iterator, Sequence
from itertools import takewhile

_DIRECTIVE = re.compile(r"(\s*)\.\. math::\s*(.*)")
_OPTION = re.compile(r"\s*:\w+:")
_ROLE = re.compile(r":math:`([^`\n]*)`")


def with_dollars(text: str) -> str:
    """The text with each paragraph of a math directive between `$$`, and the role within a line between `$`; as many
    lines as before."""
    return "\n".join(_lines(_ROLE.sub(r"$\1$", text).split("\n")))


def _lines(lines: Sequence[str]) -> Iterator[str]:
    at = 0
    while at < len(lines):
        directive = _DIRECTIVE.fullmatch(lines[at])
        at += 1
        if directive is None:
            yield lines[at - 1]
            continue
        deeper = re.compile(rf"{directive[1]}\s.*|\s*")
        block = [*takewhile(deeper.fullmatch, lines[at:])]
        at += len(block)
        body = [directive[2], *("" if _OPTION.match(k) else k.strip() for k in block)]
        for i, line in enumerate(body):
            opens = line and (i == 0 or not body[i - 1])
            closes = line and (i + 1 == len(body) or not body[i + 1])
            yield "$$" * bool(opens) + line + "$$" * bool(closes)
