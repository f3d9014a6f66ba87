"""Which theory a program's names fit: letters by names, comments and units, quantities by what they are called."""

import re
import tomllib
from collections.abc import Iterable, Sequence
from functools import cache, lru_cache
from importlib import resources

from mechsym.audit.read.programs.statements import OF
from mechsym.audit.read.slopes import PRIMES, Slope, slope_in
from mechsym.audit.read.units import PREPOSITIONS, of_turns
from mechsym.audit.theory.record import Theory
from mechsym.quantities import dimension

# what the angle that turns, and its rates, are called in programs
ANGLES = ("theta", "phi", "th", "theta deg", "crank angle", "ca", "cad", "crankangle", "angle", "varphi")
_RATES = {"d": ("omega", "w", "angular velocity", "angular speed"), "dd": ("alpha", "angular acceleration")}


def words(text: str) -> tuple[str, ...]:
    """The words of a name or a comment: 'crankRad_1' is crank, rad, 1; a single letter keeps its case."""
    parts = re.findall(r"[A-Za-z]+|\d+", re.sub(r"(?<=[a-z])(?=[A-Z])", " ", text))
    said = tuple(p if len(p) == 1 else p.lower() for p in parts if p not in ("the", "its", "their"))
    # the friction moment is a torque
    return _same((*said[:-1], "torque") if len(said) > 1 and said[-1] == "moment" else said)


@lru_cache(maxsize=20_000)
def _word_list(text: str) -> tuple[str, ...]:
    own = words(text)
    # t2v is the vector of t2
    return own[:-1] if len(own) > 2 and own[-1] == "v" and own[-2].isdigit() else own


def are_both_heats(letter: str, meaning: str) -> bool:
    """Whether one is the heat at constant pressure and the other that at constant volume, by their usual signs."""
    return {name.lower().replace("_", "") for name in (letter, meaning)} == {"cp", "cv"}


def _turned(said: tuple[str, ...]) -> tuple[str, ...]:
    # the speed of the engine is the engine speed
    if "of" not in said:
        return said
    cut = said.index("of")
    return (*(word for word in said[cut + 1 :] if word not in ("the", "a", "an")), *said[:cut])


def _joined(said: Sequence[str]) -> str:
    # V_d and Vd alike, and a single letter as it is
    whole = "".join(said)
    return whole.lower() if len(whole) > 1 else whole


class Lexicon:
    """What the letters and quantities of a theory are called."""

    def __init__(self, theory: Theory) -> None:
        self.theory = theory
        self.phrases: list[tuple[tuple[str, ...], str]] = []
        for name in [*theory.letters, *theory.results]:
            self.phrases.append((words(name), name))
        for meaning, said in theory.words.items():
            self.phrases += [(words(one), meaning) for one in said]
        if theory.angle:
            self.phrases += [(words(one), theory.angle) for one in ANGLES]
            for dots, said in _RATES.items():
                self.phrases += [(words(one), theory.angle + dots) for one in said]
        self.heads: dict[str, list[int]] = {}  # to places in the phrases: what each is without spaces
        self.having: dict[str, list[int]] = {}  # the same by each of their words
        for i, (phrase, _) in enumerate(self.phrases):
            self.heads.setdefault(_joined(phrase), []).append(i)
            for word in phrase:
                self.having.setdefault(word, []).append(i)
        self.parts = {word for word in self.having if len(word) > 2}
        self.known: dict[tuple[str, str], list[tuple[int, str]]] = {}

    def knows(self, name: str) -> bool:
        """Whether something here is called so."""
        return _joined(_word_list(name)) in self.heads

    def touches(self, names: Iterable[str]) -> bool:
        """Whether two names at least may mean something here."""
        alike = 0
        for name in names:
            own = _word_list(name)
            tail = _joined(_word_list(name.rpartition(OF)[2]))
            alike += tail in self.heads or _joined(own) in self.heads or not self.parts.isdisjoint(own)
        return alike > 1

    def meanings(self, name: str, about: str) -> list[tuple[int, str]]:
        """What a name may mean, with how well it is told: 5 by a whole comment, 4 by words of it, 3 by words, 2 by a
        part, 1 by one sign."""
        if (name, about) not in self.known:
            self.known[name, about] = self._meanings(name, about)
        return self.known[name, about]

    def _meanings(self, name: str, about: str) -> list[tuple[int, str]]:
        own, said = _word_list(name), _word_list(_UNIT.sub(" ", about))
        tail = _word_list(name.rpartition(OF)[2])
        turned = _turned(said)
        turns = of_turns(about)
        joined = (_joined(own), _joined(tail))
        alike = {i for whole in joined for i in self.heads.get(whole, ())}
        alike |= {i for word in {*own, *said} for i in self.having.get(word, ())}
        counts: dict[str, int] = {}
        standing: list[tuple[tuple[str, ...], str]] = []
        by_name = set[str]()
        for phrase, meaning in (self.phrases[i] for i in sorted(alike)):
            if turns and self._is_measured_otherwise(meaning, turns):
                continue
            rank, whole = 0, _joined(phrase)
            if whole not in joined and self._has_other_index(name, meaning):
                continue
            if said and said[-1] == "ratio" and "ratio" not in phrase and whole not in joined:
                continue  # the connecting rod ratio is no length of the connecting rod
            if whole in joined:
                rank = 1 if whole in _GREEK else min(len(whole), 3)
                by_name |= {meaning} if rank > 1 else set()
            elif len(whole) > 3 and (own[-len(phrase) :] == phrase or own[: len(phrase)] == phrase):
                rest = own[: -len(phrase)] if own[-len(phrase) :] == phrase else own[len(phrase) :]
                rank = 2 if all(w in _QUALIFIERS for w in rest) else 0
            alone = phrase in (said, turned) and len(whole) > 2 and not _UNIT.search(about)
            several = len(phrase) > 1 and len(whole) > 4
            if alone and len(phrase) > 1:
                rank = WHOLLY
                standing.append((phrase, meaning))
            elif alone or several and (_stands_in(phrase, said) or _stands_in(phrase, turned) or _is_of(phrase, said)):
                rank = max(rank, 4)
                standing.append((phrase, meaning))
            elif phrase[0] == _ANY and said[-len(phrase) + 1 :] == phrase[1:] and len(said) > 1:
                rank = max(rank, 3)
            if rank > counts.get(meaning, 0):
                counts[meaning] = rank
        for phrase, meaning in standing:  # the damped natural frequency is no natural frequency
            longer = [(other, m) for other, m in standing if len(other) > len(phrase) and _inside(phrase, other)]
            if longer and all(m != meaning for _, m in longer):
                counts.pop(meaning, None)
        for m in by_name:  # of two addenda, or what a comment alone says in full, the one that the name says, too
            for other in [k for k, rank in counts.items() if rank == counts.get(m) and k not in by_name]:
                if other == m.translate(OTHER_OF_TWO) or counts[other] == WHOLLY and m in self.theory.letters:
                    counts.pop(other)
        if slope := self._slope(name.rpartition(OF)[2]):
            counts[slope] = 3
        free = self.theory.letters  # a mass is the letter m before it is what follows from a density
        ranked = sorted(((rank, m in free, m) for m, rank in counts.items()), reverse=True)
        return [(rank, m) for rank, _, m in ranked]

    def _is_measured_otherwise(self, meaning: str, unit: str) -> bool:
        # n_1 of revolutions per minute is no number of teeth
        letter = self.theory.letters.get(meaning)
        return letter is not None and dimension(letter.unit) != dimension(unit)

    def _has_other_index(self, name: str, meaning: str) -> bool:
        # z_2 is no z_1 where the theory has both, and omega_1 no mean speed where it has a first one
        if are_both_heats(name, meaning):
            return True
        its, own = re.fullmatch(r"(\w+?)(?:_(\d))?", meaning), re.fullmatch(r"[A-Za-z]+_?(\d)", name)
        names = {*self.theory.letters, *self.theory.tape}
        return bool(its and own and its[2] != own[1] and f"{its[1]}_{own[1]}" in names)

    def _slope(self, name: str) -> str:
        # dV_dtheta: the slope of what V is, by the angle
        angle, results = self.theory.angle, self.theory.results
        primes, match, slope = PRIMES.fullmatch(name), _DERIVATIVE.fullmatch(name), slope_in(name)
        of, order = (primes[1], primes[2].count("prime")) if primes else (match["of"], 1) if match else ("", 0)
        by = angle if primes else match["by"] if match else ""
        if slope and slope.order > 1:
            of, by, order = slope.of, slope.by, slope.order
        if not angle or not order or by not in (angle, *ANGLES):
            return ""
        meant = self.meaning(of, "")[1] if primes else next((m for _, m in self.meanings(of, "") if m in results), "")
        return Slope(meant, angle, order).name if meant in results else ""

    def meaning(self, name: str, about: str) -> tuple[int, str]:
        """The one thing that a name means; empty where it means none or several alike."""
        ranked = self.meanings(name, about)
        several = len(ranked) > 1 and ranked[0][0] == ranked[1][0]
        return ranked[0] if ranked and not several else (0, "")


OTHER_OF_TWO = str.maketrans("12", "21")  #: The wheel's letters for the pinion's
_DERIVATIVE = re.compile(r"d_?(?P<of>\w+?)_?d_?(?P<by>[A-Za-z]+)")
# (rad/sec) says nothing of a crank rad: what stands in brackets and has short words only
_UNIT = re.compile(r"[\[(](?:[^\[\]()A-Za-z]|(?<![A-Za-z])[A-Za-z]{1,4}(?![A-Za-z]))*[\])]")
BY_SIGN = 1  # rank of a name that is one sign
WHOLLY = 5  #: Rank of a name that a comment is
_ANY = "any"  # mass: the rocker's as well
_SILENT = frozenset("the a an its their".split())
# a sign spelled out is no word
_GREEK = set("alpha beta gamma delta theta phi varphi psi omega lambda lam rho mu nu sigma tau epsilon eta".split())
# what stands beside a name without changing what it is
_QUALIFIERS = set(
    """
    m c i M C 0 1 2 rad deg cyl engine geom mm cm in inst piston get calc compute calculate formula crank v vec arr
    """.split()
)


def _stands_in(phrase: tuple[str, ...], said: tuple[str, ...]) -> bool:
    n = len(phrase)
    return any(said[i : i + n] == phrase for i in range(min(6, len(said) - n + 1)))


def _inside(phrase: tuple[str, ...], other: tuple[str, ...]) -> bool:
    return any(other[i : i + len(phrase)] == phrase for i in range(len(other))) or {*phrase} < {*other}


@cache
def _parts(said: tuple[str, ...]) -> tuple[str, frozenset[str], frozenset[str]]:
    """What a phrase is of: its head, the words before it, and all words that mean something."""
    cut = next((i for i, word in enumerate(said) if word in PREPOSITIONS and i), len(said))
    before = frozenset(said[: max(cut - 1, 0)]) - _SILENT
    return said[cut - 1] if said else "", before, frozenset(said) - _SILENT - {*PREPOSITIONS}


def _is_of(phrase: tuple[str, ...], said: tuple[str, ...]) -> bool:
    # the force along the connecting rod is the connecting rod force, the inertia force of it is not
    head, _, content = _parts(phrase)
    own, before, whole = _parts(said)
    return head == own and len(content) > 1 and before <= content <= whole


_SYNONYMS = tomllib.loads((resources.files("mechsym.audit.judge") / "synonyms.toml").read_text(encoding="utf-8"))
_SAME = [(tuple(words_of.split()), tuple(instead.split())) for words_of, instead in _SYNONYMS.items()]


def _same(said: tuple[str, ...]) -> tuple[str, ...]:
    for words_of, instead in _SAME:
        for i in range(len(said) - len(words_of), -1, -1):
            if said[i : i + len(words_of)] == words_of:
                said = (*said[:i], *instead, *said[i + len(words_of) :])
    return said
