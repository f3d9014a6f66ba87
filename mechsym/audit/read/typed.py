"""What stands about a formula that somebody types or pastes and is no part of it: keywords, remarks, units."""

import re
import unicodedata

from mechsym.audit.read.displays import BRACKET
from mechsym.audit.read.spelling import LOWERED, RAISED, undotted
from mechsym.audit.read.tree import FUNCTIONS, MODULES
from mechsym.audit.read.units import unit_of

_SPACES = re.compile(r"[\u00a0\u2000-\u200a\u202f\u205f]|&nbsp;")
_NOTHING = re.compile(r"[\u200b-\u200d\u2060\ufeff]")
_LETTERS = re.compile(r"[\U0001d400-\U0001d7ff\u210e\u2113]")  # 𝑟, ℎ of typeset pages
_DISPLAYS = "equation|align|aligned|gather|gathered|multline|eqnarray|split|math|displaymath"
_ABOUT = (
    (re.compile(rf"\\(?:begin|end)\s*\{{(?:{_DISPLAYS})\*?\}}"), " "),
    (re.compile(r"\\\[|\\\]|\\\(|\\\)"), " "),
    (re.compile(r"(?<=\s)(?:(?:%|//|#|/\*)\s*[A-Za-zÀ-ž]|[!;]\s*[A-Za-zÀ-ž]{3,}\b(?!\s*[(\[]))[^=]*$"), ""),
    (re.compile(r"^\s*(?:return|double|float|const|let|var|real|auto)\s+(?=\w)"), ""),
    (re.compile(r"^\s*[A-Za-z][A-Za-z ,\-]{3,60}:\s+(?=\S+[^=]*=)"), ""),
    (re.compile(r"^\s*=(?!=)"), ""),
    (re.compile(r"^(\s*[\w.()\[\]]+\s*)<-"), r"\1="),
    (re.compile(r"^\s*(\w+)\[\w+_\]\s*:?="), r"\1 ="),
    (re.compile(r"(?<=[²³⁴)\]])\.(?=[^\W\d])"), "*"),
    (re.compile(r"(?<=\d)[dD](?=[+-]?\d)"), "e"),
    (re.compile(r"(\d+(?:[.,]\d+)?)\s*°"), r"(\1*pi/180)"),
)
_LAST_WORDS = re.compile(r"(?:\\q?quad\b|\\[,;:! ]|\s|,)+\\text\s*\{[^{}]*\}\s*[.,;]?\s*$")
_UNIT = re.compile(r",\s*([^\W\d_][\w.·⋅/^²³]{0,11})\s*$")
_INDEX = re.compile(r"^\s*[\w.]+\s*[\[(]\s*(i|j|k|n|ii|idx)\s*[\])]\s*=")
_FIELD = re.compile(r"(?<![\w.])[^\W\d]\w*(?:\.[^\W\d]\w*)+(?![\w(])")


def typed(text: str) -> str:
    """A formula as it was typed or pasted without what stands about it."""
    text = _NOTHING.sub("", _SPACES.sub(" ", text))
    text = undotted(text)
    text = _LETTERS.sub(lambda m: unicodedata.normalize("NFKC", m[0]), text)
    for pattern, instead in _ABOUT:
        text = pattern.sub(instead, text)
    text = re.sub(rf"(?<=O\(λ)[{RAISED}]", lambda m: f"^{unicodedata.digit(m[0])}", text)
    if r"\begin{cases}" not in text:
        text = re.sub(r"\\\\(?:\s*\[[^\]]*\])?|&", " ", text)
    if "=" in text:
        unit = BRACKET.search(text)
        if unit and unit_of(unit[1]) and text[: unit.start()].rstrip()[-1:] not in "=+-*/·(":
            text = text[: unit.start()]
        text = _LAST_WORDS.sub("", text)
        behind = _UNIT.search(text)
        text = text[: behind.start()] if behind and unit_of(behind[1]) else text
    if index := _INDEX.match(text):
        text = re.sub(rf"(?<=\w)\s*[\[(]\s*{index[1]}\s*[\])]", "", text)
    return fields(text).strip()


def fields(text: str) -> str:
    """Fields of records as letters: `self.r` is r and `engine.CR` is engine_CR; `m.r` is a product."""
    return _FIELD.sub(_field, text)


def _field(match: re.Match[str]) -> str:
    parts = match[0].split(".")
    if parts[0] in MODULES:
        return match[0]
    parts = parts[1:] if parts[0] in ("self", "this") else parts
    single = all(len(p.rstrip(RAISED + LOWERED)) == 1 or p in FUNCTIONS for p in parts)
    return ("*" if single else "_").join(parts)
