"""What sentences call their letters: the rod force $S$, $m$ is the mass, with $n$ revolutions per minute."""

import re
from collections.abc import Iterator, Sequence

from mechsym.audit.read.clause import SENTENCE
from mechsym.audit.read.phrases import FUSED, NOTHING, PLURALS, Piece, piece_at, pieces
from mechsym.audit.read.units import KINDS

_DISPLAY = re.compile(
    r"\$\$.*?\$\$|\\begin\{((?:equation|align|gather|multline|eqnarray|displaymath|flalign|alignat)\*?)\}.*?\\end\{\1\}"
    r"|\\\[.*?\\\]|```.*?```",
    re.DOTALL,
)
_ROW = re.compile(r"^.*(?<!\\)[&|].*$", re.MULTILINE)  # of a table
_BRACKETED = re.compile(r"\b([a-z]{3,})\s*\(([^()]*\$[^()]*)\)")
_STRESSED = re.compile(r"(?<!\w)\*{1,2}([A-Za-z][A-Za-z -]*[A-Za-z])\*{1,2}(?!\w)")
_WHOLE = ("coefficient", "moment", "modulus", "swept volume", "mass flow")  # that need what they are of
_MEASURES = frozenset(
    "stiffness radius length diameter mass width height thickness weight bore stroke area volume exponent rate"
    " frequency".split()
)
_QUANTITIES = frozenset(
    (*KINDS, *_MEASURES, "angle", "speed", "moment", "inertia", "coefficient", "modulus", "flow", "order")
)
# what is always of something, and what is counted
_RELATIONS = frozenset("swing excess change fluctuation start end degree ratio".split())
_COUNTS = frozenset(
    "revolutions turns strokes cycles cylinders teeth coils holes slots plungers pistons stages leaves bolts blades "
    "balls rollers starts threads faces surfaces planets".split()
)
_AT_END = re.compile(r"(?:at|from) (?:the )?(?:[a-z]+ )?(?:pin|end)")
_NO_WORDS, _WHILE = (("constant",), ("small",), ("equal",), ("given",)), ("over", "during")
_DAMPER = re.compile(r"\bdamper\b")
_EVERY = r"(?:1|rev|r|turns|revolutions)\s?(?:/|per)\s?"
_PER_MINUTE = re.compile(
    rf"\$([A-Za-z][^$\n=]{{0,20}})\$\s*(?:in\s+\$?|\(\s*\$?)(?:{_EVERY}(?P<unit>s|min)|rpm|min\^|(?P<second>s\^))"
    r"|\$([A-Za-z][^$\n=]{0,20})\$\s+(?:rpm|r/min|rev/min|1/min)\b"
)


def spoken(text: str) -> Iterator[tuple[str, str]]:
    """Letters as they are written, with what sentences call them, the best told first."""
    text = _STRESSED.sub(r"\1", text)
    yield from ((m[0], "cylinders") for m in re.findall(r"\$(([^$\n=]{1,20}))\$-cylinder", text))
    for match in _PER_MINUTE.finditer(text):
        each = "second" if match["unit"] == "s" or match["second"] else "minute"
        yield match[1] or match[4], f"revolutions per {each}"
    for sentence in _sentences(text):
        yield from _Names(sentence).pairs()
        for inside in _BRACKETED.finditer(sentence):  # the rocker (moment of inertia J)
            yield from ((k, f"{inside[1]} {name}") for k, name in _Names(inside[2]).pairs())


def owned(text: str) -> Iterator[tuple[str, str]]:
    """Letters as they are written, with the names that their owners give them: the sun receives the torque T_1."""
    for sentence in _sentences(text):
        yield from _Names(sentence).owned()


def _sentences(text: str) -> Iterator[str]:
    # those that have a letter
    for sentence in SENTENCE.split(_ROW.sub("\n\n", _DISPLAY.sub("\n\n", text))):
        if sentence and ("$" in sentence or "`" in sentence):
            yield sentence


class _Names:
    """What the phrases of a sentence call its letters."""

    def __init__(self, sentence: str) -> None:
        self.sentence, self.parts = sentence, pieces(sentence)

    def at(self, k: int) -> Piece:
        """The piece at a place."""
        return piece_at(self.parts, k)

    def pairs(self) -> Iterator[tuple[str, str]]:
        """Letters with their names."""
        taken: set[int] = set()
        for k, part in enumerate(self.parts):
            if part.kind != "thing" or not part.lettered or k in taken:
                continue
            row, alike = ([k], self._alike(k)) if part.counted else (self._row(k), {})
            taken.update(row, alike)
            yield from ((self.at(j).letters[0], name) for j, name in alike.items())
            one = self._counted(k) if part.counted else self._in_front(k) if part.words else self._beside(row)
            one = "damping coefficient" if one == "coefficient" and _DAMPER.search(self.sentence) else one
            for j, name in zip(row, self._each(k, row) or [one] * len(row), strict=True):
                if name:
                    yield self.at(j).letters[0].partition("=")[0], name

    def owned(self) -> Iterator[tuple[str, str]]:
        """Letters with their names and whose they are."""
        for k, part in enumerate(self.parts):
            verb = k - 1 - (self.at(k - 1).kind == "at")
            owner = self.at(verb - 1)
            if part.lettered and part.words and self.at(verb).kind in ("gives", "moves") and owner.is_named:
                if not owner.lettered and not part.counted:
                    yield part.letters[0], f"{_singular(owner)} {' '.join(part.words)}"

    def _alike(self, k: int) -> dict[int, str]:
        # the sun has z_1 teeth, each planet z_2, the ring z_3
        alike: dict[int, str] = {}
        while self.at(k).head == "teeth" and self.at(k + 1 + 2 * len(alike)).kind in ("comma", "and"):
            at = k + 2 + 2 * len(alike)
            at += self.at(at).kind == "and"
            part = self.at(at)
            if not part.words or not part.lettered or part.counted:
                break
            alike[at] = f"{_singular(part)} teeth"
        return alike

    def _row(self, k: int) -> list[int]:
        # the places of the letters that share a phrase for several: the angles a, b and c
        row, words = [k], self.at(k).words
        of = self.at(k - 2).head if self.at(k - 1).kind == "of" else ""  # the moments of inertia
        several = not words or any(word in PLURALS or word.endswith("s") for word in (words[-1], of))
        while several and self.at(row[-1] + 1).kind in ("and", "comma"):
            at = row[-1] + (3 if self.at(row[-1] + 2).kind == "and" else 2)
            if self.at(at).words or not self.at(at).lettered or "=" in self.at(at).letters[0]:
                break
            row.append(at)
        return row

    def _each(self, k: int, row: Sequence[int]) -> list[str]:
        # the inertias J_1 and J_2 of crank and flywheel
        part, at = self.at(k), row[-1] + 2
        if len(row) < 2 or part.head not in PLURALS or self.at(at - 1).kind != "of":
            return []
        owners = [self.at(at)]
        while self.at(at + 1).kind in ("and", "comma") and self.at(at + 2).words:
            at += 2
            owners.append(self.at(at))
        kind = " ".join([*part.words[:-1], PLURALS[part.head]])
        return [f"{_singular(o)} {kind}" for o in owners] if len(owners) == len(row) else []

    def _in_front(self, k: int) -> str:
        # the words of a phrase in front of its letter
        part, joint, before = self.at(k), self.at(k - 1), self.at(k - 2)
        own = [PLURALS.get(w, w) for w in part.words]
        plain = " ".join([part.owner, *own] if part.owner else own)
        vague = not part.article and own[-1] not in _QUANTITIES and part.lettered and "=" in part.letters[0]
        beside = joint.kind == "at" and (vague or not part.article and joint.head in _WHILE)
        if part.words in _NO_WORDS or beside:
            return ""  # in steady running, over time
        owner = before if before.is_named and not before.lettered else NOTHING
        if joint.kind == "of":
            if before.words == ("that",):  # the moving mass is that of the piston m
                kinds = [p.head for p in self.parts[: k - 2] if p.head in KINDS]
                return f"{kinds[-1]} of {plain}" if kinds else plain
            apart = before.kind == "comma" and self.at(k - 3).kind == "thing"  # the chamber, of volume V
            named = self._of(self.at(k - 3) if apart else owner, part, own, plain)
        else:
            named = self._by(joint.head, owner, own, plain)
        return self._with_rest(k, named, own)

    def _of(self, owner: Piece, part: Piece, own: Sequence[str], plain: str) -> str:
        # a spring of stiffness k; the moment of inertia J; the mass of the piston m, whose letter is the mass's
        if not owner.words:
            return plain
        if FUSED.fullmatch(f"{owner.head} of {plain}") or owner.head in _RELATIONS:
            return f"{_singular(owner)} of {' '.join(part.words)}"
        if own[-1] in _MEASURES and (len(own) == 1 or own[-1] == "stiffness") and owner.head not in _QUANTITIES:
            return f"{_singular(owner)} {plain}"
        return plain if own[-1] in _QUANTITIES or part.owner else f"{_singular(owner)} of {plain}"

    def _by(self, joint: str, owner: Piece, own: Sequence[str], plain: str) -> str:
        # a piston with the stroke S, friction with the coefficient mu, a mass per length m
        if not owner.words or joint not in ("per", "with"):
            return plain
        if joint == "per":
            return f"{_singular(owner)} per {plain}"
        measure = own[-1] in _MEASURES and owner.article or own == ["coefficient"]
        return f"{_singular(owner)} {plain}" if measure and owner.head not in _QUANTITIES else plain

    def _with_rest(self, k: int, name: str, own: Sequence[str]) -> str:
        # the coefficient k of fluctuation, the number z of teeth, the mass m at the crank pin, the load q per metre
        words = self._behind(k)
        if not words:
            return name
        if words[0] == "per" and self.at(k).lettered:
            return f"{name} {' '.join(words[:2])}"
        if own == ["number"] and words[0] == "of":
            return " ".join(words[1:])
        at_end = _AT_END.search(" ".join(words))
        whole = words[0] == "of" and name.endswith(_WHOLE)
        placed = at_end and name.endswith("mass" if at_end[0].startswith("at") else "distance")
        return f"{name} {' '.join(words)}" if whole or placed else name

    def _behind(self, k: int) -> list[str]:
        # the words behind a phrase that say what it is of, and where
        words: list[str] = []
        while self.at(k + 1).kind in ("of", "at") and self.at(k + 2).kind == "thing":
            k, join, part = k + 2, self.at(k + 1), self.at(k + 2)
            if not part.words or part.lettered:
                break
            the = ["the"] if part.head in ("pin", "end") and part.phrase[0] != "one" else []
            words += [join.head or join.kind, *the, *part.phrase]
        return words

    def _counted(self, k: int) -> str:
        # n revolutions per minute, a pinion with z teeth
        part = self.at(k)
        if part.head not in _COUNTS:
            return ""
        per = self.at(k + 2).words if self.at(k + 1).words == ("per",) else ()
        words = " ".join((*part.words, *(("per", *per) if per else ())))
        joined = self.at(k - 1).kind in ("of", "gives") or self.at(k - 1).words == ("with",)
        owner = self.at(k - 2) if joined and part.head == "teeth" else NOTHING
        return f"{owner.head} {words}".strip() if owner.kind == "thing" else words

    def _beside(self, row: Sequence[int]) -> str:
        # m is the mass, the masses are m_1 and m_2, by R the crank throw; z_1 and z_2 teeth
        k, join, after = row[0], self.at(row[-1] + 1), self.at(row[-1] + 2)
        commas = self.at(k - 1).kind == join.kind == "comma"  # the fluctuation of energy, E, is
        between = commas and after.kind in ("is", "gives", "done", "moves")
        if between or self.at(k - 1).kind == "is" or self.at(k - 1).words == ("being",):
            head = k - 2
            while self.at(head - 1).kind == "of" or self.at(head - 1).kind == "at" and not between:
                head -= 2
            if self._may_name(head):
                kind = self.at(head).head in KINDS
                return " ".join([self._in_front(head), *([] if kind else self._behind(head))])
        if join.kind in ("and", "comma") and after.counted:
            return self._counted(row[-1] + 2)
        if len(row) > 1:
            return ""
        if (join.kind in ("is", "comma") or join.words == ("being",)) and self._may_name(k + 2):
            aside = self.at(k + 3).kind in ("and", "is", "gives", "moves") and join.kind == "comma"
            return "" if aside else " ".join([self._in_front(k + 2), *self._behind(k + 2)])
        said = self.at(k - 1).head in ("by", "with", "call", "denote") and after.kind in ("", "comma", "and", "of")
        return self._in_front(k + 1) if said and self._may_name(k + 1) and "=" not in self.at(k).letters[0] else ""

    def _may_name(self, k: int) -> bool:
        # whether a phrase may name the letter beside it, and has none of its own
        part = self.at(k)
        taken = self.at(k + 1).kind == "of" and self.at(k + 2).lettered
        return part.is_named and bool(part.article) and not part.lettered and not taken


def _singular(part: Piece) -> str:
    one = re.sub(r"(?<=[a-z]{3}[^aius])s$", "", re.sub("ies$", "ys", part.head))
    return " ".join([*part.words[:-1], PLURALS.get(part.head, one)])
