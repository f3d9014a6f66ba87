"""What an equation says: its sides, its number, what it claims, and the letters that are told beside it."""

import re
from collections.abc import Mapping
from dataclasses import field

from mechsym.audit.read.displays import LABEL
from mechsym.audit.read.typed import typed
from mechsym.errors import BadInput
from mechsym.quantities import record

_NUMBER = (
    re.compile(r"\\(?:tag|eqno|leqno)\*?\s*\{?\s*\(?([0-9A-Za-z][\w.\-']*)\)?\s*\}?"),
    re.compile(r"(?:\\qquad|\\quad|\\hfill|\s{2,}|[.,;]\s+)\s*\(([0-9]+(?:[.\-][0-9]+)*[a-z]?)\)\s*\.?\s*\$*\s*$"),
)
_SILENT = re.compile(r"\\(?:nonumber|notag|displaystyle|textstyle|centering)\b")
_ALMOST = re.compile(r"\\approx|\\simeq|\\cong|\\sim\b|\\doteq|≈|≃|≅|~=")
_EQUALS = re.compile(r"\\equiv|≡|(?<=\w) *:=|\\coloneqq|\\triangleq")
_ORDER = re.compile(
    r"[+-]\s*(?:\\mathcal\s*\{\s*O\s*\}|\\mathcal\s+O|O|o)\s*(?:\\left)?\s*\(\s*(?:\\lambda|λ|lam(?:bda)?)"
    r"\s*(?:\^|\*\*)?\s*\{?\s*(\d*)\s*\}?\s*(?:\\right)?\s*\)"
)
_AND_SO_ON = re.compile(r"[+-]\s*(?:\\l?dots[cb]?\b|\\cdots\b|\.\.\.|…)(?!\s*\w)")
_APPLIED = re.compile(r"(?P<of>[\w}'])\s*(?:\\left)?\(\s*\\?[^\W\d]\w*\s*(?:\\right)?\)")
_CALLED = re.compile(r"(?:\\?(?:sin|cos|tan|tg|cot|ctg|exp|ln|log|sqrt|arc\w+)\s*|\^\s*\{[^{}]*\}|[\s\d]d\s*)$")
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
    letters: Mapping[str, str] = field(default_factory=dict)  #: Letters whose meanings stand beside it


def statement(text: str, of: str = "") -> Statement:
    """Take an equation apart; number, label and what only says that it goes on are set aside.

    of: the quantity that it tells, where letters may be told beside it.
    """
    text = typed(text) if of else text
    label = LABEL.search(text)
    text, number, claim = _SILENT.sub(" ", LABEL.sub(" ", text)), "", ""
    for pattern in _NUMBER:
        margin = pattern.search(text)
        if margin is not None and text[: margin.start()].strip(" $"):
            text, number = text[: margin.start()] + text[margin.end() :], margin[1]
            break
    if _ALMOST.search(text):
        text, claim = _ALMOST.sub("=", text), "approx"
    if order := _ORDER.search(text):
        text, claim = _ORDER.sub("", text), f"lam^{int(order[1] or 1) - 1}"
    if _AND_SO_ON.search(text):
        text, claim = _AND_SO_ON.sub("", text), claim or "approx"
    text = text if re.search(r"\([^()]*:=", text) else _EQUALS.sub("=", text)
    text, letters = _with_letters(text, of) if of else (text, {})
    parts = [p.strip() for p in re.split(r"(?<![=<>!])=(?!=)(?![^{]*\})", text)]
    note = ""
    if len(parts) > 2 and _ZERO.fullmatch(parts[-1]):
        parts.pop()
        note = 'the trailing "= 0" was left out: with it the equation would say that the quantity vanishes'
    if len(parts) == 2 and _ZERO.fullmatch(parts[0]):
        parts.reverse()
    if len(parts) == 2 and _ZERO.fullmatch(parts[1]):
        terms, last = _last_term(parts[0])
        if terms:
            return Statement(left=terms, right=(f"-({last})",), claim=claim, number=number, letters=letters)
        raise BadInput("the right side is 0; solve the equation for the quantity: 'name = expression'")
    if len(parts) > 1 and not all(parts):
        raise BadInput("one side of the equals sign is empty; write 'name = expression'")
    left = unapplied(parts[0], _APPLIED) if len(parts) > 1 else ""
    right = tuple(p.rstrip(" .,;") for p in (parts[1:] if left else parts))
    return Statement(
        left=left, right=right, claim=claim, number=number, label=label[1] if label else "", note=note, letters=letters
    )


def unapplied(text: str, applied: re.Pattern[str]) -> str:
    """V(\\theta) as V; `applied` is what stands so, with the end of its name as group `of`, and a sine stays one."""
    return applied.sub(lambda m: m[0] if _CALLED.search(text[: m.start() + 1]) else m["of"], text)


def _last_term(text: str) -> tuple[str, str]:
    # of what is zero: its terms but the last, and the last with its sign
    depth, text, begins = 0, text.strip(" $").replace("−", "-"), 0
    for at, sign in enumerate(text):
        depth += {"(": 1, "[": 1, "{": 1, ")": -1, "]": -1, "}": -1}.get(sign, 0)
        if depth == 0 and sign in "+-" and text[:at].rstrip()[-1:] not in (*"*/^eE·(", ""):
            begins = at
    return text[:begins].strip(), text[begins:]


_APART = re.compile(
    r"[,;]?\s*(?:\\q?quad\b|\\text\s*\{\s*(?:with|where|and|mit|и|где)\s*\}|\b(?:with|where|mit)\b|\n)+[,;:\s]*"
    r"|[,;](?!\s*\d)\s*(?:\\[,;:!]\s*|\\ )*"
)
_AT = re.compile(r"\\?(?:[Bb]ig+[rgl]?|right|left|)\s*\|_\s*(?:\{([^{}=]+=[^{}=]+)\}|\(([^()=]+=[^()=]+)\))\s*$")


def _with_letters(text: str, quantity: str) -> tuple[str, dict[str, str]]:
    """An equation, and the letters that are said beside it: `tau = K*8*F*D/(pi*d**3), K = .., C = D/d`."""
    at_value = _AT.search(text.strip(" $."))
    if at_value is not None:
        name, _, value = (part.strip() for part in (at_value[1] or at_value[2]).partition("="))
        alone = rf"(?<![A-Za-z\\_])(?<!_\{{){re.escape(name)}(?![A-Za-z_])"
        return re.sub(alone, lambda _: f"{{{value}}}", text.strip(" $.")[: at_value.start()]), {}
    pieces, depth, start = [], 0, 0
    text = text.strip().removeprefix("$$").removesuffix("$$").strip("$ ")
    for at, sign in enumerate(text):
        depth += {"(": 1, "[": 1, "{": 1, ")": -1, "]": -1, "}": -1}.get(sign, 0)
        apart = _APART.match(text, at) if depth == 0 and at >= start else None
        if apart and apart.end() > at:
            pieces.append(text[start:at])
            start = apart.end()
    pieces = [p.strip() for p in (*pieces, text[start:]) if p.strip(" .,;")]
    sides = [p.split("=") for p in pieces]
    if len(pieces) < 2 or any(len(s) != 2 or not all(x.strip() for x in s) for s in sides):
        return text, {}
    lefts, rights = [s[0].strip() for s in sides], [s[1].strip(" .,;") for s in sides]
    named = [i for i, left in enumerate(lefts) if re.sub(r"[\W_]", "", left) == quantity.replace("_", "")]
    # what no other needs is what they all are for
    last = [i for i, left in enumerate(lefts) if not any(left in other for j, other in enumerate(rights) if j != i)]
    chosen = (named or last or [0])[0]
    others = {left: right for i, (left, right) in enumerate(zip(lefts, rights, strict=True)) if i != chosen}
    return pieces[chosen], others
