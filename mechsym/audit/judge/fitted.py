"""A claim in the letters of a theory, by what its names mean there."""

import ast
from collections import Counter
from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from itertools import islice, product

from mechsym.audit.judge.lexicon import BY_SIGN, WHOLLY, Lexicon
from mechsym.audit.read import tree as trees
from mechsym.audit.read.programs.claims import Claim, base, inlined
from mechsym.audit.read.programs.statements import OF
from mechsym.audit.read.reader import RESERVED, Formula, read_expression
from mechsym.audit.read.tree import Node, letters
from mechsym.audit.theory.record import Theory, dependencies, known
from mechsym.audit.theory.tape import BY_OTHERS
from mechsym.quantities import record

_MEANINGS, _TRIED, _READINGS = 3, 200, 4  # of a letter; of a formula at most: looked at, and held against numbers
_EXTREMES = {*"max min mean avg ave rms peak amp tot total sum".split()}  # ends of names that say more than of what


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
                (r, m) for r, m in vocabulary.meanings(*_told_of(claim, letter, vocabulary)) if base(m) not in called
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
        if letters_rank == WHOLLY and (solved := _by_others(theory, letters_called, meanings.values())):
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


def _told_of(claim: Claim, letter: str, vocabulary: Lexicon) -> tuple[str, str]:
    # a letter and what it is called, by its owner where the theory has such a name: the sun torque, elsewhere a torque
    own = base(letter)
    fuller = claim.owned.get(own, "")
    less = _less_place(own, claim, vocabulary)
    if less != own:
        return less, ""
    return own, fuller if vocabulary.knows(fuller) else claim.abouts.get(own, "")


def _less_place(name: str, claim: Claim, vocabulary: Lexicon) -> str:
    # n_g_fan, sigma_m_fan, Se_fan: those of the fan, which all the names of a formula say
    head, mark, place = name.rpartition("_")
    if not mark or not place.isalpha() or len(place) < 3 or place.lower() in _EXTREMES:
        return name
    together = sum(k.endswith(mark + place) for k in (base(claim.name), *map(base, letters(claim.tree))))
    return head if together > 2 and not vocabulary.meanings(name, "") and vocabulary.meanings(head, "") else name


def _spare(claim: Claim, meanings: Mapping[str, str], vocabulary: Lexicon) -> dict[str, str]:
    others = [p for p in dict.fromkeys((*claim.parameters, *claim.near)) if p not in meanings]
    told = {p: vocabulary.meaning(*_told_of(claim, p, vocabulary))[1] for p in others}
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
    return all(k in known or vocabulary.meanings(*_told_of(claim, k, vocabulary)) for k in letters(tree))


def _is_told_better(letter: str, told: int, claim: Claim, vocabulary: Lexicon, deep: bool) -> bool:
    # phi = radians(pressure_angle): another letter in its place, whose name says more; several where a sign alone does
    named = [k for k in letters(claim.values[letter]) if k != "pi"]
    told_of = [vocabulary.meaning(*_told_of(claim, k, vocabulary)) for k in named]
    angle = vocabulary.theory.angle if len(named) > 1 else ""
    ranks = [rank for rank, meaning in told_of if not angle or meaning != angle]
    return bool(ranks) and min(ranks) > told and (len(named) == 1 or deep and told == BY_SIGN)


def _has_angle(letter: str, claim: Claim, vocabulary: Lexicon) -> bool:
    # phi = asin(r*sin(theta)/l) is not the angle that turns
    inside = {base(k) for k in letters(claim.values[letter])} - {base(letter)}
    meant = [vocabulary.meaning(*_told_of(claim, k, vocabulary))[1] for k in inside]
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
            ranked = [(r, m) for r, m in vocabulary.meanings(_less_place(name, claim, vocabulary), about) if m in among]
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
