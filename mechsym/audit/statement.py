r"""An equation as printed: its left side, what it is said to be, how well, and the number in its margin."""

import re

from mechsym.errors import BadInput
from mechsym.quantities import record

_NUMBER = (
    re.compile(r"\\(?:tag|eqno|leqno)\*?\s*\{?\s*\(?([0-9A-Za-z][\w.\-']*)\)?\s*\}?"),
    re.compile(r"(?:\\qquad|\\quad|\\hfill|\s{2,}|[.,;]\s+)\s*\(([0-9]+(?:[.\-][0-9]+)*[a-z]?)\)\s*\.?\s*\$*\s*$"),
)
_LABEL = re.compile(r"\\label\s*\{([^{}]*)\}")
_SILENT = re.compile(r"\\(?:nonumber|notag|displaystyle|textstyle|centering)\b")
_ALMOST = re.compile(r"\\approx|\\simeq|\\cong|\\sim\b|\\doteq|≈|≃|≅|~=")
_EQUALS = re.compile(r"\\equiv|≡|(?<=\w) *:=|\\coloneqq|\\triangleq")
_ORDER = re.compile(
    r"[+-]\s*(?:\\mathcal\s*\{\s*O\s*\}|\\mathcal\s+O|O|o)\s*(?:\\left)?\s*\(\s*(?:\\lambda|λ|lam(?:bda)?)"
    r"\s*(?:\^|\*\*)?\s*\{?\s*(\d*)\s*\}?\s*(?:\\right)?\s*\)"
)
_AND_SO_ON = re.compile(r"[+-]\s*(?:\\l?dots[cb]?\b|\\cdots\b|\.\.\.|…)(?!\s*\w)")
_ZERO = re.compile(r"\$*\s*0\s*\.?\s*\$*")


@record
class Statement:
    """What an equation says."""

    left: str  #: Empty where the text is an expression alone
    right: tuple[str, ...]  #: Several where it says a = b = c
    claim: str = ""  #: `approx` or `lam^k` where the print says so
    number: str = ""
    label: str = ""
    note: str = ""


def statement(text: str) -> Statement:
    """Take an equation apart; number, label and what only says that it goes on are set aside."""
    text, number, label = _numbered(text)
    text, claim = _claimed(text)
    parts = [p.strip() for p in re.split(r"(?<![=<>!])=(?!=)(?![^{]*\})", text)]
    note = ""
    if len(parts) > 2 and _ZERO.fullmatch(parts[-1]):
        parts.pop()
        note = 'the trailing "= 0" was left out: with it the equation would say that the quantity vanishes'
    if len(parts) == 2 and _ZERO.fullmatch(parts[1]):
        raise BadInput("the right side is 0; solve the equation for the quantity: 'name = expression'")
    if len(parts) > 1 and not all(parts):
        raise BadInput("one side of the equals sign is empty; write 'name = expression'")
    left = parts[0] if len(parts) > 1 else ""
    right = tuple(p.rstrip(" .,;") for p in (parts[1:] if left else parts))
    return Statement(left=left, right=right, claim=claim, number=number, label=label, note=note)


def _numbered(text: str) -> tuple[str, str, str]:
    label = _LABEL.search(text)
    text = _SILENT.sub(" ", _LABEL.sub(" ", text))
    for pattern in _NUMBER:
        found = pattern.search(text)
        if found is not None and text[: found.start()].strip(" $"):
            return text[: found.start()] + text[found.end() :], found[1], label[1] if label else ""
    return text, "", label[1] if label else ""


def _claimed(text: str) -> tuple[str, str]:
    claim = ""
    if _ALMOST.search(text):
        text, claim = _ALMOST.sub("=", text), "approx"
    if order := _ORDER.search(text):
        text, claim = _ORDER.sub("", text), f"lam^{int(order[1] or 1) - 1}"
    if _AND_SO_ON.search(text):
        text, claim = _AND_SO_ON.sub("", text), claim or "approx"
    return text if re.search(r"\([^()]*:=", text) else _EQUALS.sub("=", text), claim
