"""The last clause of a text, and which of its phrases names what the equation behind it gives."""

import re
from collections.abc import Iterator, Sequence

from mechsym.audit.read.phrases import NO_NAMES, piece_at, pieces
from mechsym.audit.read.units import KINDS

#: Where a display begins, at the end of what stands in front of it
OPENED = re.compile(r"(?:\\begin\{[a-z*]+\}|\$\$|\\\[|```math)\s*$")
SENTENCE = re.compile(
    r"\\end\{[a-z*]+\}|\$\$|\\\]|```|\*\*|[.!?](?=\s)|[:;](?=\s)|\n\s*\n|\\(?:sub)*section\*?\{[^{}]*\}|^#+ .*$"
    r"|^\s*[-*+] |\\item\b|\|[ \t]*$|\\\\",
    re.MULTILINE,
)
_UNWORDED = re.compile(r"\$[^$]*\$|\\[A-Za-z]+\*?(?:\{[^{}]*\})?|[{}~]")
# what sets a quantity equal to what follows; what it follows from, or how it changes
_SAYS = frozenset(
    "given found taken written expressed obtained approximated computed calculated determined defined derived set known"
    " connected characterised characterized estimated formulated measured assumed accepted fixed related governed"
    " expanded".split()
)
_FOLLOWS = frozenset(
    "follow result come arise depend consist compare count amount reduce obey vary refer relate correspond rise"
    " fall drop grow increase decrease change exceed".split()
)
# what comes with a verb: fires with the frequency
_BESIDE_KINDS = "angle speed rate amplitude moment reaction magnitude component function life decrement factor"
_MEASURED = frozenset((*KINDS, *_BESIDE_KINDS.split()))
_HOLDING = ("at", "with", "by", "to", "into", "below", "above")
_CHANGES = frozenset("raise lower limit reduce increase keep change".split())
_VERBS = ("is", "gives", "moves")
_REFERS = ("this", "that", "it", "they", "there", "which")
_AMOUNTS = ("magnitude", "amount", "size", "value")
_KIND_OF_CHANGE = re.compile(r"(?:isentrop|adiabat|polytrop)ic|isothermal")  # the compression is polytropic


class Clause:
    """The last sentence of a text in its phrases, from its last conjunction on."""

    def __init__(self, before: str) -> None:
        text = OPENED.sub("", before).rstrip(" \n:;.,")
        cuts = [m.end() for m in SENTENCE.finditer(text)]
        start = cuts[-1] if cuts else 0
        self.earlier, spoken = text[:start], text[start:]  #: What stands in front of the sentence
        self.plain = " ".join(_UNWORDED.sub(" ", spoken).split())  #: Its words
        self.parts = pieces(spoken) if not self.plain.endswith(", then") else []  # if .., then
        while self.parts and self.parts[-1].kind in ("comma", "of"):  # has a mass of
            self.parts.pop()
        if len(self.parts) > 2 and self.parts[-2].words == ("what",):  # is what remains
            self.parts = self.parts[:-2]
        joints = [k for k in range(len(self.parts) - 1) if self._joins(k)]
        if joints:  # so that the torque is; where the angle
            self.parts = self.parts[joints[-1] + 1 :]

    def kind(self, at: int) -> str:
        """Kind of the piece at a place, empty outside."""
        return piece_at(self.parts, at).kind

    def _joins(self, at: int) -> bool:
        # whether a clause of its own begins there, and none of what a phrase is
        if self.kind(at) != "that" or self.kind(at - 1) not in ("", "comma", "that", "and"):
            return False
        return self.parts[at].head not in ("which", "whose") or self.kind(at - 1) != "comma"

    def is_governed(self, at: int) -> bool:
        """Whether a preposition stands in front of a phrase, or of the list that it is in."""
        last_of_list = False
        while at > 0:
            kind, listed = self.kind(at - 1), self.kind(at - 2) == "thing"
            if kind in ("at", "of"):
                return True
            last_of_list |= kind == "and"
            plain = last_of_list or self.parts[at].lettered or not self.parts[at].article
            if not listed or kind != "and" and (kind != "comma" or not plain):
                return False
            at -= 2
        return False

    def _is_free(self, at: int) -> bool:
        # a phrase that may be what a clause is about
        return self.kind(at) == "thing" and not self.is_governed(at) and not self._is_aside(at)

    def _is_aside(self, at: int) -> bool:
        # positive towards the crankshaft, four-stroke, normal to the profile
        part = self.parts[at]
        alone = len(part.words) == 1 and not part.article and not part.owner and not part.lettered
        return alone and at > 1 and self.kind(at - 1) == "comma" and self.kind(at - 2) in ("thing", "comma")

    def subject(self) -> int | None:
        """Place of the phrase that names what follows; None without one."""
        end = self._without_places()
        if not end:
            return self._named_last() if self.kind(len(self.parts) - 1) in ("thing", "done", "at") else None
        last = self.parts[end - 1]
        if last.kind != "is" and self._is_relative(end - 1 - (last.kind == "done")):
            return self._named_last()
        if last.kind == "is" and self.parts[-1].words != ("at",):
            front = self.in_front(end - 1)
            if self._listed_with(start := self._last_phrase()):
                return start
            return self._with_it(end) if front is None else front
        if last.kind == "done" and last.words[0] == "is" and last.head in _SAYS:
            return self.in_front(end - 2)
        if last.kind in ("gives", "moves") and last.head in _FOLLOWS:
            proportional = end + 3 < len(self.parts) and self.parts[end + 1].head == "proportion"
            front = None if proportional else self.in_front(end - 1)
            return self._with_it(end) if front is None or self.parts[front].head in NO_NAMES else front
        named = last.kind == "thing" or last.kind == "done" and last.words[0] != "is"
        if named:
            return self._named_last()
        held = self._with_it(end)
        return self._changed() if held is None else held

    def _without_places(self) -> int:
        # the end of a clause without what prepositions put behind its verb: is, to first order,
        at = len(self.parts)
        while at > 0 and self.kind(at - 1) not in ("is", "gives", "moves"):
            kind = self.kind(at - 1)
            if kind == "done" and self.parts[at - 1].words[0] == "is":
                return at
            if kind == "that" or kind == "thing" and not self.is_governed(at - 1):
                return len(self.parts)
            at -= 1
        return at

    def _named_last(self) -> int | None:
        # what comes with something else, what a verb gives, what a quantity is, or a name alone
        start = self._last_phrase()
        if self._comes_with(start) or self._listed_with(start):
            return start
        for k in self._finite():
            if objects := [j for j in range(k + 1, len(self.parts)) if self._is_free(j)]:
                return self._said_by(k, objects)
        return self._fragment()

    def _said_by(self, verb: int, objects: Sequence[int]) -> int | None:
        # what a verb says of what it is said of, with the phrases behind it that nothing governs
        first, front = self.parts[objects[0]], self.in_front(verb)
        if self._begins_clause(objects[-1]) and len(objects) > 1:
            return objects[-1]
        is_of = self.kind(verb) == "is"
        if is_of and (first.lettered and not first.words or _KIND_OF_CHANGE.fullmatch(first.head)):
            return None  # the density is rho, the compression is polytropic
        pronoun = front is None or self.parts[front].head in _REFERS
        word = self.parts[verb].head
        if is_of or word == "follow" or self.kind(verb) == "moves" and word in _FOLLOWS:
            held = self._with_it(verb + 1) if word == "exceed" else None
            return held if held is not None else objects[0] if pronoun else front
        if first.head in _AMOUNTS and not pronoun:
            return front  # the centrifugal force has the magnitude
        # bears the force F with the specific load
        held = self._with_it(verb + 1) or (self._with_it(verb + 1, measured=False) if first.lettered else None)
        indirect = objects[1:2] == [objects[0] + 1]  # gives each piston the force
        return held if held is not None else objects[1] if indirect else objects[0]

    def _comes_with(self, at: int) -> bool:
        # with the damping; and fires with the frequency; for the degree of irregularity
        if self.kind(at) != "thing" or self.parts[at].lettered:
            return False
        joint, behind = self.parts[at - 1].words, self.kind(at - 2)
        alone = behind in ("", "and") or behind == "comma" and joint == ("with",)
        verb = behind == "moves" and joint == ("with",) and not self._is_relative(at - 2)
        return joint in (("with",), ("for",)) and (alone or verb)

    def _last_phrase(self) -> int:
        # the place of the phrase at the end, less what it is of
        start = len(self.parts) - 1
        while start > 1 and self.kind(start - 1) == "of":
            start -= 2
        return start

    def _listed_with(self, at: int) -> bool:
        # with the mean w and the degree of irregularity: the last has no letter, which the equation gives
        first = at
        while first > 1 and self.kind(first - 1) in ("and", "comma", "of"):
            first -= 2
        opens = self.kind(first - 2) in ("", "is", "comma") and self.kind(first - 1) == "at"
        named = self.kind(at) == "thing" and not self.parts[at].lettered and self.kind(at - 1) == "and"
        return named and opens and self.parts[first - 1].words == ("with",)

    def _finite(self) -> Iterator[int]:
        # verbs from the last on, but for those of what a phrase is: the force that presses it
        for k in range(len(self.parts) - 1, -1, -1):
            if self.kind(k) in _VERBS and not self._is_relative(k):
                yield k

    def _is_relative(self, at: int) -> bool:
        whose = [j for j in range(at) if self.kind(j) == "that" and self.kind(j - 1) in ("thing", "comma") and j]
        whose += [at - 1] if at and self.parts[at - 1].words == ("what",) else []
        return bool(whose) and not any(self.kind(j) in _VERBS for j in range(whose[-1] + 1, at))

    def _begins_clause(self, at: int) -> bool:
        # the work is W, and the mean pressure
        start = at - 1
        while self.kind(start) == "and":
            start -= 1
        behind = at + 1
        while self.kind(behind) in ("of", "at"):
            behind += 2
        if self.kind(behind) == "and":
            return False  # one of a list
        bare = start < at - 1 and self.kind(start) == "thing" and not self.parts[start].words
        return (bare or self.kind(start) == "comma") and not self.parts[at].lettered

    def _with_it(self, verb_end: int, measured: bool = True) -> int | None:
        # the node lies at the distance, the shaft is loaded by the torque; measured: only what a quantity is called
        for k in reversed(range(verb_end, len(self.parts))):
            part = self.parts[k]
            if part.kind == "thing" and self.kind(k - 1) == "at" and not part.lettered and part.article:
                if self.parts[k - 1].head == "with" and self.kind(k - 2) == "moves" and not self._is_relative(k - 2):
                    return k
                if self.parts[k - 1].head == "to" and self.parts[k - 2].head == "proportion":
                    return k
                if self.parts[k - 1].head in _HOLDING and (part.head in _MEASURED or not measured):
                    return k
        return None

    def _changed(self) -> int | None:
        # raises the temperature to, limits the degree of irregularity to
        said = self.parts[-1].words == ("as",)  # one writes the displacement as
        verbs = [k for k, p in enumerate(self.parts) if p.kind == "gives" and (said or p.head in _CHANGES)]
        limits = said or self.parts[-1].words in (("by",), ("to",), ("within",))
        object_of = verbs[-1] + 1 if verbs and limits else len(self.parts)
        return object_of if self.kind(object_of) == "thing" else None

    def _fragment(self) -> int | None:
        free = [k for k in range(len(self.parts)) if self._is_free(k) and not self.parts[k].lettered]
        main = [k for k in free if self.kind(k - 1) not in ("done", *_VERBS)]
        return main[-1] if main else None

    def in_front(self, at: int) -> int | None:
        """Place of the phrase that a verb is said of."""
        several, k = self.parts[at].head in ("are", "become"), at - 1
        while k >= 0:
            part = self.parts[k]
            if part.kind in _VERBS and self.kind(at - 1) == "and":
                return self.in_front(k)  # it occurs at top dead centre and is
            if part.kind in _VERBS:
                whose = [j for j in range(k) if self.kind(j) == "that"]
                if not whose:
                    return None
                k = whose[-1] - 1
                continue
            joined = self.kind(k - 1) in ("and", "comma") and self.kind(k - 2) == "thing"
            if part.kind == "thing" and self._is_free(k) and self.kind(k - 1) not in ("done", *_VERBS):
                if not (joined and part.lettered):
                    return None if several and self.kind(k - 1) == "and" and joined else k
            k -= 1
        return None
