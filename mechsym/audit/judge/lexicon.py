"""Which theory a program's names fit: letters by names, comments and units, quantities by what they are called."""

import ast
import re
import tomllib
from collections import Counter
from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from functools import cache, lru_cache
from importlib import resources
from itertools import islice, product

from mechsym.audit.read import tree as trees
from mechsym.audit.read.programs.claims import Claim, base, inlined
from mechsym.audit.read.programs.statements import OF
from mechsym.audit.read.reader import RESERVED, Formula, read_expression
from mechsym.audit.read.slopes import PRIMES, Slope
from mechsym.audit.read.tree import Node, letters
from mechsym.audit.read.units import PREPOSITIONS, of_turns
from mechsym.audit.theory.record import Theory, dependencies, known
from mechsym.audit.theory.tape import BY_OTHERS
from mechsym.quantities import dimension, record

# what the angle that turns, and its rates, are called in programs
ANGLES = ("theta", "phi", "th", "theta deg", "crank angle", "ca", "cad", "crankangle", "angle", "varphi")
_RATES = {"d": ("omega", "w", "angular velocity", "angular speed"), "dd": ("alpha", "angular acceleration")}
_MEANINGS, _TRIED, _READINGS = 3, 200, 4  # of a letter; of a formula at most: looked at, and held against numbers


@record
class Fitted:
    """A claim in the letters of a theory."""

    theory: Theory
    claim: Claim
    tree: Node  #: In the program's letters that have a meaning, other names put in
    meanings: Mapping[str, str]  #: Letter of the program to its meaning in the theory
    quantities: Sequence[str]  #: That the name is called like
    spare: Mapping[str, str]  #: Other letters of its function that have one meaning, which no letter of it has
    strong: int  #: Letters that a word tells, and not a single sign
    rank: int  #: How well its name tells the quantities, as of `Lexicon.meanings`


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
        for phrase, meaning in (self.phrases[i] for i in sorted(alike)):
            if turns and self._is_measured_otherwise(meaning, turns):
                continue
            rank, whole = 0, _joined(phrase)
            if whole not in joined and self._has_other_index(name, meaning):
                continue
            if said and said[-1] == "ratio" and "ratio" not in phrase and phrase != own:
                continue  # the connecting rod ratio is no length of the connecting rod
            if whole in joined:
                rank = 1 if whole in _GREEK else min(len(whole), 3)
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
        match, angle, results = _DERIVATIVE.fullmatch(name), self.theory.angle, self.theory.results
        primes = PRIMES.fullmatch(name)
        if not angle or not primes and (not match or match["by"] not in (angle, *ANGLES)):
            return ""
        of, order = (primes[1], primes[2].count("prime")) if primes else (match["of"] if match else "", 1)
        meant = self.meaning(of, "")[1] if primes else next((m for _, m in self.meanings(of, "") if m in results), "")
        return Slope(meant, angle, order).name if meant in results else ""

    def meaning(self, name: str, about: str) -> tuple[int, str]:
        """The one thing that a name means; empty where it means none or several alike."""
        ranked = self.meanings(name, about)
        several = len(ranked) > 1 and ranked[0][0] == ranked[1][0]
        return ranked[0] if ranked and not several else (0, "")


_DERIVATIVE = re.compile(r"d_?(?P<of>\w+?)_?d_?(?P<by>[A-Za-z]+)")
# (rad/sec) says nothing of a crank rad: what stands in brackets and has short words only
_UNIT = re.compile(r"[\[(](?:[^\[\]()A-Za-z]|(?<![A-Za-z])[A-Za-z]{1,4}(?![A-Za-z]))*[\])]")
_BY_SIGN = 1  # rank of a name that is one sign
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


def readings(claim: Claim, vocabulary: Lexicon) -> Iterator[Fitted]:
    """A claim in a theory's letters, the best told way first; none where a name in it means nothing there."""
    seen = set()
    for deep in (False, True):
        for fitted in _readings(claim, vocabulary, deep):
            key = ast.dump(fitted.tree), *sorted(fitted.meanings.items())
            if key not in seen:
                seen.add(key)
                yield fitted


def _readings(claim: Claim, vocabulary: Lexicon, deep: bool) -> Iterator[Fitted]:
    # deep: with what a letter is in its place also where only a sign tells what it means
    theory = vocabulary.theory
    rank, called = _called(claim, vocabulary, theory.tape)
    letters_rank, letters_called = _called(claim, vocabulary, theory.letters)
    tree, options = _of_either_sign(claim.tree), dict[str, list[tuple[int, str]]]()
    for _ in range(12):
        put_in = {}
        for letter in letters(tree):
            if letter in options or letter == "pi":
                continue
            ranked = [
                (r, m)
                for r, m in vocabulary.meanings(base(letter), claim.abouts.get(base(letter), ""))
                if base(m) not in called
            ]
            unsure = not ranked or len(ranked) > 1 and ranked[0][0] == ranked[1][0]
            told = ranked[0][0] if ranked else 0
            if letter in claim.values and (
                unsure
                and (not ranked or _is_readable(claim.values[letter], claim, vocabulary))
                or ranked[0] == (1, theory.angle)
                and _has_angle(letter, claim, vocabulary)
                or _is_told_better(letter, told, claim, vocabulary, deep)
            ):
                put_in[letter] = claim.values[letter]
            elif ranked:
                options[letter] = ranked[:_MEANINGS]
            elif letter in claim.written:
                put_in[letter] = claim.written[letter]
            else:
                return
        if not put_in:
            break
        whole = inlined(tree, put_in, keep={k: 1 for k in claim.values if k not in put_in})
        if whole is None:
            return
        tree = whole
    used = [k for k in letters(tree) if k != "pi"]
    if not used or any(k not in options for k in used):
        return
    for reading in _distinct([options[k] for k in used]):
        meanings = {k: _in_degrees(k, m, tree, theory) for k, (_, m) in zip(used, reading, strict=True)}
        strong = sum(r > 1 for r, _ in reading)
        quantities, told = called, rank
        if letters_rank >= rank and (solved := _by_others(theory, letters_called, meanings.values())):
            quantities, told = [*solved, *(called if letters_rank == rank else [])], letters_rank
        yield Fitted(
            theory=theory,
            claim=claim,
            tree=tree,
            meanings=meanings,
            quantities=quantities,
            spare=_spare(claim, meanings, vocabulary),
            strong=strong,
            rank=told,
        )


def _spare(claim: Claim, meanings: Mapping[str, str], vocabulary: Lexicon) -> dict[str, str]:
    told = {p: vocabulary.meaning(p, claim.abouts.get(p, ""))[1] for p in claim.parameters if p not in meanings}
    counts = Counter([*told.values(), *meanings.values()])
    return {p: m for p, m in told.items() if m.isidentifier() and counts[m] == 1}


def _distinct(options: Sequence[Sequence[tuple[int, str]]]) -> Iterator[tuple[tuple[int, str], ...]]:
    # no two letters mean one thing; those that words tell best, and ties between them
    best = [o[0][0] for o in options]
    chosen = (c for c in islice(product(*options), _TRIED) if len({m for _, m in c}) == len(c))
    ranked = sorted(chosen, key=lambda c: -sum(r for r, _ in c))
    if ranked:
        least = sum(r for r, _ in ranked[0])
        plain = least == sum(best)
        yield from islice((c for c in ranked if not plain or sum(r for r, _ in c) == least), _READINGS)


def _is_readable(tree: Node, claim: Claim, vocabulary: Lexicon) -> bool:
    # whether each letter of what a letter is has a meaning or a value
    known = {*claim.values, *claim.written, "pi"}
    return all(k in known or vocabulary.meanings(base(k), claim.abouts.get(base(k), "")) for k in letters(tree))


def _is_told_better(letter: str, told: int, claim: Claim, vocabulary: Lexicon, deep: bool) -> bool:
    # phi = radians(pressure_angle): another letter in its place, whose name says more; several where a sign alone does
    named = [k for k in letters(claim.values[letter]) if k != "pi"]
    told_of = [vocabulary.meaning(base(k), claim.abouts.get(base(k), "")) for k in named]
    angle = vocabulary.theory.angle if len(named) > 1 else ""
    ranks = [rank for rank, meaning in told_of if not angle or meaning != angle]
    return bool(ranks) and min(ranks) > told and (len(named) == 1 or deep and told == _BY_SIGN)


def _has_angle(letter: str, claim: Claim, vocabulary: Lexicon) -> bool:
    # phi = asin(r*sin(theta)/l) is not the angle that turns
    inside = {base(k) for k in letters(claim.values[letter])} - {base(letter)}
    meant = [vocabulary.meaning(k, claim.abouts.get(k, ""))[1] for k in inside]
    return len(meant) > 1 and vocabulary.theory.angle in meant


def _of_either_sign(tree: Node) -> Node:
    # the size of a quantity is the quantity, as signs are not told
    while isinstance(tree, ast.Call) and isinstance(tree.func, ast.Name) and tree.func.id == "abs":
        tree = tree.args[0]
    return tree


def _called(claim: Claim, vocabulary: Lexicon, among: Container[str]) -> tuple[int, list[str]]:
    # quantities, or letters, that the name or the comment of a claim says, or the function that gives it back
    names = [claim.scope] if claim.name == "return" else [claim.name, *[claim.scope] * claim.last]
    best, called = 0, dict[str, None]()
    for name in names:
        for about in dict.fromkeys((claim.about, claim.whole or claim.about)):
            ranked = [(r, m) for r, m in vocabulary.meanings(name, about) if m in among]
            called |= dict.fromkeys(m for r, m in ranked if r == ranked[0][0])
            best = max(best, ranked[0][0] if ranked else 0)
    return best, list(called)


def _by_others(theory: Theory, called: Sequence[str], meanings: Iterable[str]) -> list[str]:
    # letters that can be had from quantities which stand in a formula, and do not stand there themselves
    meant = {*meanings}
    reached = dependencies(theory, [m for m in meant if m in theory.tape])
    return [f"{m}{BY_OTHERS}" for m in called if m in reached and m not in meant]


def _in_degrees(letter: str, meaning: str, tree: Node, theory: Theory) -> str:
    # theta*pi/180 says that theta counts degrees
    if meaning not in theory.letters or theory.letters[meaning].unit != "rad":
        return meaning
    for _, node in trees.walk(tree):
        if isinstance(node, ast.BinOp) and letters(node) and set(letters(node)) <= {letter, "pi"}:
            numbers = [trees.value_of(n) for _, n in trees.walk(node) if isinstance(n, ast.Constant)]
            if letter in letters(node) and 180 in numbers:
                return f"{meaning}*180/pi"
    return meaning


def formula(fitted: Fitted) -> Formula:
    """A fit as the auditor's formula. Raises BadInput."""
    theory = fitted.theory
    renamed = {k: safe(k) for k in letters(fitted.tree) if k != "pi"}
    tree = trees.substitute(
        fitted.tree, lambda n: trees.name(renamed.get(n.id, n.id)) if isinstance(n, ast.Name) else None
    )
    trees.check(tree)
    own = {renamed[k]: read_expression(v, [*known(theory), "pi"], theory.tape)[0] for k, v in fitted.meanings.items()}
    return Formula(tree=tree, letters=own)


def safe(letter: str) -> str:
    """A program's name as a letter that a formula may hold."""
    plain = letter.replace("__v", "_").replace("__w", "_").replace(OF, "_").strip("_") or "x"
    return f"{plain}_own" if plain in RESERVED or plain in ("lambda", "in", "is", "if", "as", "or") else plain
