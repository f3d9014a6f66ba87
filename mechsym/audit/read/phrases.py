"""The phrases of a sentence: what it names, and the verbs and small words that join the names.

Only small words are known, and the verbs that papers put in front of an equation. A phrase is what stands between them.
"""

import re
import tomllib
from collections.abc import Iterator, Sequence
from dataclasses import replace
from importlib import resources

from mechsym.audit.read.units import KINDS
from mechsym.quantities import record

_LISTS = tomllib.loads((resources.files("mechsym.audit.read") / "words.toml").read_text(encoding="utf-8"))
_WORDS = {kind: frozenset(text.split()) for kind, text in _LISTS.items()}
_ARTICLES, _ALONE, _PLACES, _ADVERBS = (_WORDS[kind] for kind in ("articles", "alone", "places", "adverbs"))
_COUNTING = ("all", "both", "each", "one", "two")
_SPELLED = {"have": "has", "do": "does", "go": "goes", "carry": "carries", "supply": "supplies", "vary": "varies"}
#: Names with an `of` of their own
FUSED = re.compile(
    r"(?:moments?|modulus|coefficient|radius|degree|speed|velocity|angle) of "
    r"(?:inertia|elasticity|friction|gyration|irregularity|non-uniformity|unevenness|fluctuation|damping|sound|rotation|twist"
    r"|area|discharge|restitution)\b"
)
#: Words that stand for a name
NO_NAMES = frozenset("it they we he she there that which this these those both one who what each such".split())
#: Words for several to that for one
PLURALS = {"inertias": "inertia", "velocities": "velocity", "masses": "mass", "radii": "radius"}
PLURALS["stiffnesses"] = "stiffness"
PLURALS |= {f"{w}s": w for w in (*KINDS, "moment", "angle", "speed", "coefficient") if " " not in w}
_LETTER = "§"
_UNWORDED = re.compile(r"\\[A-Za-z]+\*?(?:\[[^\]]*\])?(?:\{[^{}]*\})?|\\.|[{}~*#]")
_NUMBER, _BRACKETED = re.compile(r"\(\d+\w?\)"), re.compile(r"\s*\([^()]{1,80}\)")
_MATH = re.compile(r"\$[^$]*\$|`[^`\n]{1,24}`")
_SMALL = r"(?!(?:in|of|at|on|by|is|or|to|as|it|the|its|an?)\b)"
_IN_UNIT = re.compile(  # behind a letter: the radius r in m
    rf"(?<={_LETTER})\s+in\s+{_SMALL}[A-Za-z]{{1,3}}(?:[/^*·\s]+{_SMALL}[A-Za-z]{{1,2}}\b)*"
    rf"(?=\s*(?:[,.;:{_LETTER}]|\s|$))"
)
_WORD = re.compile(rf"[A-Za-z][A-Za-z']*(?:-[A-Za-z]+)*|[,;:]|{_LETTER}")
_SEVERAL, _THIRD = re.compile(r"[^s]s$"), re.compile(r"[a-z]{3}[^s]s$")  # ends of names for several, and of verbs


@record
class Piece:
    """A phrase, or what joins phrases."""

    #: thing; of; at, another preposition; is; gives and moves, other verbs; done, a participle; that, and, comma
    kind: str
    words: tuple[str, ...] = ()
    letters: tuple[str, ...] = ()  #: Behind the phrase, or alone
    counted: bool = False  #: Whether the letter stands in front of it: n revolutions
    owner: str = ""  #: Whose it is: piston, of `the piston's acceleration`
    article: str = ""  #: In front of it

    @property
    def lettered(self) -> bool:
        """Whether it has a letter."""
        return bool(self.letters)

    @property
    def phrase(self) -> tuple[str, ...]:
        """Its words with what tells how many: all cylinders, both pistons, one end."""
        counts = self.article in _COUNTING and self.words != (self.article,)
        return (self.article, *self.words) if counts else self.words

    @property
    def head(self) -> str:
        """The last word of a phrase, the word of what joins."""
        return self.words[-1] if self.words else ""

    @property
    def is_named(self) -> bool:
        """Whether it is a phrase with words that name something."""
        return self.kind == "thing" and bool(self.words) and self.head not in NO_NAMES


def piece_at(parts: Sequence[Piece], at: int) -> Piece:
    """The piece at a place, one of no kind outside."""
    return parts[at] if 0 <= at < len(parts) else NOTHING


def _forms(verbs: str) -> dict[str, str]:
    # the forms of verbs to their first: carries, carry
    forms: dict[str, str] = {}
    for verb in verbs.split():
        third = _SPELLED.get(verb) or verb + ("es" if verb.endswith(("s", "sh", "ch", "x")) else "s")
        forms |= {third: verb, verb: verb}
    return forms


NOTHING = Piece(kind="")  #: Where there is none
_GIVING = _forms(_LISTS["gives"])
_VERBS = _GIVING | _forms(_LISTS["moves"])


def pieces(sentence: str) -> list[Piece]:
    """A sentence as phrases and what joins them; what stands in brackets is left out."""
    text = _BRACKETED.sub("", _NUMBER.sub(" $(n)$ ", sentence))
    letters = [m[0].strip("$`") for m in _MATH.finditer(text)]
    text = _IN_UNIT.sub("", _UNWORDED.sub(" ", _MATH.sub(f" {_LETTER} ", text)))
    parts: list[Piece] = []
    for piece in _Reader(_WORD.findall(text), letters).run():
        last = parts[-1] if parts else None
        if last is not None and last.lettered and not last.words and piece.is_named and not piece.article:
            parts[-1] = replace(piece, letters=last.letters, counted=True)  # n revolutions
        elif last is not None and piece.kind in ("gives", "moves") and last.kind in ("gives", "is"):
            parts[-1] = piece  # has to provide
        else:
            parts.append(piece)
    return parts


class _Reader:
    """Goes through the words of a sentence; a phrase is open until a small word or a verb ends it."""

    def __init__(self, words: Sequence[str], letters: Sequence[str]) -> None:
        self.words, self.letters = words, iter(letters)
        self.open: list[str] = []
        self.article = ""  # in front of the phrase that is open
        self.owner = ""
        self.finite = self.infinitive = False  # behind a modal verb, and behind `to`
        self.last = ""  # kind of the last piece
        self.relative = False  # whether that is `which`
        self.counted = False  # whether that is a bare letter, as in `n turns`

    def run(self) -> Iterator[Piece]:
        """The pieces in their order."""
        for at, word in enumerate(self.words):
            after = [w.lower() for w in self.words[at + 1 : at + 3]] + ["", ""]
            for piece in self._next(word, self._kind(word, word.lower(), after), after[0]):
                self.last, self.counted = piece.kind, piece.lettered and not piece.words
                self.relative = piece.words in (("which",), ("that",)) and piece.kind == "that"
                yield piece
        yield from self._closed()

    def _closed(self, letters: tuple[str, ...] = (), alone: str = "") -> Iterator[Piece]:
        if self.open or letters or alone:
            words = tuple(self.open) or ((alone,) if alone else ())
            yield Piece(kind="thing", words=words, letters=letters, owner=self.owner, article=self.article or alone)
        self.open, self.article, self.owner = [], "", ""

    def _kind(self, word: str, low: str, after: Sequence[str]) -> str:
        # what a word is by itself, by what stands around it, and by what is open
        if word == _LETTER:
            return "letter"
        if low in ",;:":
            return "comma"
        for kind in ("and", "of"):
            if low == kind or (kind, low) == ("and", "or"):
                return kind
        if low.endswith("'s") and len(low) > 3:
            return "owner"
        if low in ("call", "denote") and after[0] == _LETTER:
            return "that"
        if low in _WORDS["modal"] or low in ("do", "does") and after[0] == "not":
            return "modal"
        if low == "to" and (after[0] in _VERBS or self._is_infinitive(*after[:2])):
            return "to"
        if low in _WORDS["is"] and (low not in ("equal", "read") or self.last == "is" or self.finite):
            return "is"
        if low == "that" and not self.open and (after[0] == "of" or after[0] in _PLACES):
            return "pronoun"
        if low == "that" or low in _WORDS["joining"]:
            return "that"
        if low in _ALONE and not self.open and self._stands_alone(after[0]):
            return "alone"
        if low in ("a", "an") and self.open and after[0] in ("turn", "revolution", "second", "minute"):
            return "per"
        if low in _ARTICLES or low in ("both", "whose") or low == "one" and not self.open:
            return "article"
        if low in _WORDS["pronouns"]:
            return "pronoun"
        if low in _PLACES:
            return "at"
        if low in _ADVERBS or after[0] == "than" or low.endswith("ly") and low not in ("supply", "assembly"):
            return "adverb"
        return self._verb(low, after[0]) or "name"

    def _next(self, word: str, kind: str, after: str) -> Iterator[Piece]:
        low = word.lower()
        if kind == "name":
            self.open.append(word)
        if kind in ("name", "adverb"):
            return
        if kind == "owner":
            owner, self.open = " ".join([*self.open, word[:-2]]), []
            yield from self._closed()
            self.owner = owner
            return
        had = self.last in ("gives", "is") and not self.open  # has to supply
        letter = (next(self.letters, ""),) if kind == "letter" else ()
        yield from self._closed(letter, alone=low if kind == "alone" else "")
        if kind in ("modal", "to"):
            self.finite, self.infinitive = True, kind == "to" and not had
        elif kind == "article":
            self.article = low
            if low == "whose":
                yield Piece(kind="that", words=(low,))
        elif kind == "at":
            if not (self.last == "is" and low in ("by", "as", "to", "from") and _ends(after)):
                yield Piece(kind="at", words=(low,))
        elif kind in ("per", "pronoun"):
            yield Piece(kind="at", words=("per",)) if kind == "per" else Piece(kind="thing", words=(low,))
        elif kind == "is":
            self.finite = False
            if self.last != "is":
                yield Piece(kind="is", words=(low,))
        elif kind == "done":
            yield Piece(kind="done", words=("is", low) if self.last == "is" else (low,))
        elif kind in ("gives", "moves"):
            verb = Piece(kind=kind, words=(_VERBS.get(low, low),))
            yield Piece(kind="done", words=("to", low)) if self.infinitive else verb
            self.finite = self.infinitive = False
        elif kind in ("comma", "and", "of", "that"):
            yield Piece(kind=kind, words=(low,) if kind == "that" else ())

    def _verb(self, low: str, after: str) -> str:
        # kind of a verb or a participle, empty for what is none
        if self._is_verb(low, after):
            return "gives" if low in _GIVING or low not in _VERBS else "moves"
        if self.relative and not self.open and not self.article and _SEVERAL.search(low):
            return "moves"  # which overhangs by
        # friction opposes the rotation: an article stands behind no end of a phrase that no preposition governs
        free = bool(self.open) and (bool(self.article) or self.last not in ("of", "at")) or self.last == "thing"
        if free and after in _ARTICLES and not self.counted and _THIRD.search(low):
            return "gives"
        return "done" if self._is_done(low, after) else ""

    def _stands_alone(self, after: str) -> bool:
        # both act, of both the torque is, but both ends
        if after in _VERBS:
            first = after == _VERBS[after] and self.last not in ("of", "at")
            return first or _VERBS[after] not in _WORDS["things_too"]
        return self.last == "of" if after == "the" else not after or _begins(after) and after not in _ARTICLES

    def _is_infinitive(self, verb: str, behind: str) -> bool:
        # needed to fill the cylinder
        return behind in _ARTICLES and verb.isalpha() and not _begins(verb)

    def _is_verb(self, low: str, after: str) -> bool:
        if low not in _VERBS or self.finite:
            return self.finite
        if self.article and not self.open and self.article not in _ALONE and low != "has":
            return False  # the load
        third, a_thing_too = low != _VERBS[low], _VERBS[low] in _WORDS["things_too"]
        joined = not self.open and self.last in ("and", "comma")  # and carries the force, and acts on it with
        plain = third or low == "have" or not after or joined and (self.last == "and" or after in _ARTICLES)
        if plain and not a_thing_too:
            return True
        if third and joined and (not after or after != "per" and after in _PLACES | _WORDS["pronouns"]):
            return True
        own = self.open and (self.article or self.last not in ("of", "at") or after in _PLACES)
        behind = own or self.last in ("thing", "that") and not self.counted
        several = not self.open or _SEVERAL.search(self.open[-1])
        if not behind or not third and not several:
            return False
        return not after or _begins(after) and after not in ("of", "per", "and", "or") or not a_thing_too

    def _is_done(self, low: str, after: str) -> bool:
        ends = low.endswith(("ed", "ing")) and len(low) > 4 and low not in _WORDS["names"]
        if not ends and low not in _WORDS["done"]:
            return False
        alone = not self.open and not self.article
        if self.open and after == _LETTER:
            return False  # the load rating C
        return alone and self.last in ("is", "comma") or (bool(self.open) or alone) and (not after or _begins(after))


_JOINTS = frozenset((",", ";", ":", _LETTER, "of", "and", "that", "to")) | _ARTICLES | _PLACES | _ALONE | _ADVERBS
_JOINTS |= _WORDS["is"] | _WORDS["modal"] | _WORDS["joining"] | _WORDS["pronouns"]


def _begins(word: str) -> bool:
    # whether a phrase has ended in front of a word
    return word in _JOINTS or word.endswith("ly")


def _ends(word: str) -> bool:
    return not word or _begins(word) and word not in _ARTICLES or word in _VERBS
