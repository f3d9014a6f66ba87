"""The formulas of one program held against theories: each by itself, and in the light of those that stand beside it.

A formula that is the quantity that its name says shows what the letters of its file mean. What is near to a quantity in
the same letters is told then also where its names alone say too little, and a convention that only this one formula
would have is none.
"""

import ast
import re
from collections.abc import Iterator, Sequence
from dataclasses import replace
from difflib import SequenceMatcher
from functools import cache
from itertools import islice

from mechsym.audit.hosts.slips import slip
from mechsym.audit.judge.fitted import Fitted, formula, readings
from mechsym.audit.judge.lexicon import WHOLLY, Lexicon
from mechsym.audit.judge.nearness import (
    Near,
    Probes,
    at_rest,
    compared,
    is_slip,
    nearest,
    of_same_letters,
    of_sign,
    of_units,
    shown_as,
)
from mechsym.audit.read import tree as trees
from mechsym.audit.read.programs.claims import Claim, base
from mechsym.audit.read.reader import Formula
from mechsym.audit.read.spelling import to_python
from mechsym.audit.row import Row
from mechsym.errors import BadInput

_NEAR = 0.6  # of a quantity's largest size: farther off, something else is meant [-]
_WITNESSES = 2  # formulas that agree beside one that is more than a slip away
_HEAVY = 8  # operations of a formula that comes to no quantity by chance
_BY_A_SIGN, _TWICE = 3, 1.0 + 1e-9  # rank of a name that no words tell; away where a factor of two is lost or doubled
_TENS = re.compile(r"(?<![\w.])10*(?:\*\*(?:\(-\d+\)|\d+))?(?![\w.])")  # and their powers
_ASKED = 4  # quantities that a slip of a formula is searched for


class Neighbours:
    """The claims of a program with what they are in theories."""

    def __init__(self, claims: Sequence[Claim], vocabularies: Sequence[Lexicon], si: bool = False) -> None:
        """si: whether all is in one system of units, so that a factor of two units is a slip."""
        self.vocabularies, self.si = vocabularies, si
        self.near = {id(claim): list(self._near(claim)) for claim in claims}
        self.witnesses = [
            near
            for every in self.near.values()
            for near in every
            if near.away == 0.0 and near.quantity in near.fitted.quantities and len(near.fitted.meanings) > 1
        ]

        self.exact: dict[tuple[str, str, str], set[str]] = {}  # theory, quantity and function to the names that are it
        for near in (near for every in self.near.values() for near in every if near.away == 0.0):
            own = near.fitted.claim
            self.exact.setdefault((near.fitted.theory.name, near.quantity, own.scope), set()).add(own.name)

    def outcome(self, claim: Claim) -> Row | None:
        """The best of what theories say of a claim: it agrees with one, is a slip away from one, or differs from it."""
        every = self.near[id(claim)]
        if not every:
            return None
        # called like another quantity, in letters that others show to be understood, it is no excuse to be this one
        called = [n for n in every if n.away and n.fitted.rank > 1 and n.quantity in n.fitted.quantities]
        other, named = any(self._beside(n) for n in called), any(self._is_named(n) for n in called)
        best = max((n.fitted.rank for n in every if n.quantity in n.fitted.quantities), default=0)
        outranked = set[tuple[str, str]]()  # right, but that another quantity is called so wholly
        for near in every:
            if best == WHOLLY > near.fitted.rank and near.quantity in near.fitted.quantities:
                outranked |= {(near.fitted.theory.name, near.quantity)} if near.away == 0.0 else set()
                continue  # a polar section modulus is no section modulus
            own = near.fitted.theory.words  # that have another name for it
            excused = not other and not (named and near.quantity in own) and not self._clashes(near)
            excused = excused and not self._is_another(near)
            if near.away == 0.0 and (near.quantity in near.fitted.quantities or excused):
                sense, against = self._sense(near), shown_as(near.fitted.theory, near.quantity)
                if sense and _is_rate_of_its_own(near):
                    right = to_python(trees.negative(claim.tree))
                    note = "the angle whose rate it is stands in it, and has its sense"
                    return {
                        "verdict": "misprint",
                        "claim": against,
                        "correction": right,
                        "note": note,
                        "max_rel_error": 2.0,
                    }
                return {"verdict": "agrees", "claim": against} | sense
        beside = [(near, self._beside(near)) for near in every if near.quantity]
        beside.sort(key=lambda b: _unlikely(*b))
        worse, misprints = None, []
        asked = (
            (n, o)
            for n, o in beside
            if n.away and (n.fitted.theory.name, n.quantity) not in outranked
            and _is_told(n, o) and not self._has_other_name(n)
        )  # fmt: skip
        for near, others in islice(asked, _ASKED):
            if _is_right_undefined(near):
                return {"verdict": "agrees", "claim": shown_as(near.fitted.theory, near.quantity)}
            row = slip(replace(near, settled=self._is_settled(near)), others, self._of_angle(near))
            if row is not None and row["verdict"] == "wrong":
                worse = worse or _wrong(row, near, others)
            elif row is not None and row["verdict"] == "misprint":
                if not _is_of_another(claim.name, row["correction"]) and (
                    self.si or not _converts(to_python(claim.tree), row["correction"])
                ):
                    misprints.append(row)
            elif row is not None:
                return row
        # of two quantities that are a slip away the one whose formula is most like what stands there
        text = to_python(claim.tree)
        likeness = [SequenceMatcher(None, text, row["correction"]).ratio() for row in misprints]
        if misprints:
            return misprints[likeness.index(max(likeness))]
        return worse or {"verdict": "", "claim": ""}

    def _is_named(self, near: Near) -> bool:
        # in words, and off by a number that is lost or taken twice: no other quantity of its theory is meant
        met = compared(near.form, near.states, near.quantity) if self.si and near.fitted.rank > _BY_A_SIGN else None
        return met is not None and is_slip(met.ratio)

    def _sense(self, near: Near) -> Row:
        # where signs are told, what is counted the other way round
        met = compared(near.form, near.states, near.quantity) if self.si else None
        turned = met is not None and met.ratio is not None and met.ratio < 0
        return {"passed": "convention", "note": "exact with the opposite sense"} if turned else {}

    def _clashes(self, near: Near) -> bool:
        # by number it is a quantity of another name, with a letter that elsewhere in the program means something else
        own = {base(k): m for k, m in near.fitted.meanings.items()}
        for other in self.witnesses:
            if other.fitted.theory is near.fitted.theory:
                meant = {base(k): m for k, m in other.fitted.meanings.items()}
                # each function has names of its own for what is given to it
                here = other.fitted.claim.scope == near.fitted.claim.scope
                taken = {m: k for k, m in meant.items()} if here else {}
                if any(meant.get(k, m) != m or taken.get(m, k) != k for k, m in own.items()):
                    return True
        return False

    def _of_angle(self, near: Near) -> list[Near]:
        """Witnesses of any theory that count the same angle."""
        angles = {base(k) for k, m in near.fitted.meanings.items() if base(m) == near.fitted.theory.angle}
        return [
            other
            for other in self.witnesses
            if other.fitted.claim is not near.fitted.claim
            and any(base(k) in angles and m == other.fitted.theory.angle for k, m in other.fitted.meanings.items())
        ]

    def _near(self, claim: Claim) -> Iterator[Near]:
        several = len(set(trees.letters(claim.tree)) - {"pi"}) > 1  # twice a name is no formula of what it stands for
        for vocabulary in self.vocabularies:
            for fitted in readings(claim, vocabulary):
                if not several and len(fitted.meanings) > 1:
                    continue
                if any(kind in meaning for kind in claim.ruled_out for meaning in fitted.meanings.values()):
                    continue
                try:
                    form = formula(fitted)
                except BadInput:
                    continue
                states = _states(vocabulary, at_rest(fitted.theory, form))
                met = list(_met(fitted, form, states, self.si))
                for away, quantity in met:
                    named = " ".join((quantity, *fitted.meanings.values()))
                    both = "two_stroke" in named and "four_stroke" in named  # no engine is
                    if both or any(kind in quantity for kind in claim.ruled_out):
                        continue
                    yield Near(away=away, fitted=fitted, form=form, quantity=quantity, states=states)
                if not met and len(fitted.meanings) > 1:
                    yield Near(away=1.0, fitted=fitted, form=form, quantity="", states=states)

    def _has_other_name(self, near: Near) -> bool:
        # not called so, where another letter of the same function is that quantity
        own = near.fitted.claim
        others = self.exact.get((near.fitted.theory.name, near.quantity, own.scope), set()) - {own.name}
        return bool(others) and near.quantity not in near.fitted.quantities

    def _is_another(self, near: Near) -> bool:
        # another letter of the text is this quantity, too: one of the two is something else
        own = near.fitted.claim
        return self.si and bool(self.exact.get((near.fitted.theory.name, near.quantity, own.scope), set()) - {own.name})

    def _is_settled(self, near: Near) -> bool:
        # i = z_2/z_1 = n_2/n_1: the first form tells which way round the ratio is
        own = near.fitted.claim
        # an efficiency is no more than 1, the index of a spring no less, a volume is counted from nothing, and what is
        # relative is by something else
        if re.search(r"efficiency|volume|index|\beta_", " ".join((near.quantity, *near.fitted.meanings.values()))):
            return True
        if own.about.startswith("relative "):
            return True
        return any(
            other.fitted.theory is near.fitted.theory
            and other.quantity == near.quantity
            and (other.fitted.claim.name, other.fitted.claim.line) == (own.name, own.line)
            for other in self.witnesses
        )

    def _beside(self, near: Near) -> list[Near]:
        # other quantities of the theory that other formulas are, and no letter means something else in them
        if near.fitted.quantities and near.quantity not in near.fitted.quantities:
            return []
        meant = {base(k): m for k, m in near.fitted.meanings.items()}
        return [
            other
            for other in self.witnesses
            if other.fitted.theory is near.fitted.theory
            and other.quantity != near.quantity
            and other.fitted.claim is not near.fitted.claim
            and all(meant.get(base(k), m) == m for k, m in other.fitted.meanings.items())
        ]


def _is_of_another(name: str, right: str) -> bool:
    # I2 = 2*I1 is not I1: two quantities of one kind
    return re.fullmatch(r"\w+", right) is not None and re.sub(r"_?\d+$", "", right) == re.sub(r"_?\d+$", "", base(name))


def _converts(text: str, right: str) -> bool:
    # S_p*A_t*10**(-3) - F_i: MPa and mm^2 beside kN
    return _TENS.sub("1", text) == _TENS.sub("1", right)


def _is_right_undefined(near: Near) -> bool:
    # F_H/(b d) where F_H = F_P/2 is half of another force: a force all the same
    fitted = near.fitted
    defined = [k for k in trees.letters(fitted.claim.tree) if k != "pi" and k not in fitted.meanings]
    if len(defined) != 1 or defined[0] not in fitted.claim.values:
        return False
    meant = {k: m for k, m in fitted.meanings.items() if k in trees.letters(fitted.claim.tree)}
    for letter in trees.letters(fitted.claim.values[defined[0]]):
        meaning = fitted.meanings.get(letter, "")
        if meaning and meaning not in meant.values():
            plain = replace(fitted, tree=fitted.claim.tree, meanings={**meant, defined[0]: meaning})
            try:
                met = compared(formula(plain), near.states, near.quantity)
            except BadInput:
                continue
            if met is not None and of_sign(met.ratio):
                return True
    return False


def _is_rate_of_its_own(near: Near) -> bool:
    entry = near.fitted.theory.tape.get(near.quantity)
    of = re.sub("_d+$", "", entry.id) if isinstance(entry, ast.Name) else ""
    return of in near.fitted.meanings.values()


@cache
def _states(vocabulary: Lexicon, rest: tuple[str, ...]) -> Probes:
    # where numbers are compared: what a formula does not have, and may be none, is none
    return Probes(vocabulary.theory, rest)


def _met(fitted: Fitted, form: Formula, states: Probes, si: bool) -> Iterator[tuple[float, str]]:
    seen = set()
    for quantity in fitted.quantities:
        met = compared(form, states, quantity)
        if met is not None:
            seen.add(quantity)
            right = of_sign(met.ratio) if si else of_units(met.ratio) or met.shift
            # a ratio that is turned over
            wholly = met.ratio is None and fitted.rank > _BY_A_SIGN and fitted.strong == len(fitted.meanings)
            wholly = wholly and (len(fitted.meanings) > 1 or fitted.rank == WHOLLY)
            if right or is_slip(met.ratio) or wholly:
                yield (0.0 if right else max(met.away, 1e-9)), quantity
    many = len(fitted.meanings)
    if many > 2 or many > 1 and fitted.strong and seen:
        for away, quantity in nearest(fitted, form, states, si):
            if quantity not in seen and (away == 0.0 or not fitted.quantities and away <= _NEAR):
                yield away, quantity


def _unlikely(near: Near, beside: Sequence[Near]) -> tuple[bool, bool, int, bool, float]:
    # what is called so, stands beside others that agree, needs nothing to be none, and has the same letters comes first
    rest, other = at_rest(near.fitted.theory, near.form), True
    if near.quantity:
        other = not of_same_letters(near.fitted.theory, near.form, near.quantity)
    return not near.fitted.quantities, not beside, len(rest), other, near.away


def _is_told(near: Near, beside: Sequence[Near]) -> bool:
    """Whether names, neighbours or its size say that a formula is meant to be a quantity."""
    fitted = near.fitted
    many, strong = len(fitted.meanings), fitted.strong
    entry = fitted.theory.tape[near.quantity]
    if _chooses(near.form.tree) and not (isinstance(entry, ast.AST) and _chooses(entry)):
        return False
    if near.quantity not in fitted.quantities:
        alike = bool(beside) and of_same_letters(fitted.theory, near.form, near.quantity)
        return near.away <= _NEAR and many > 2 and (strong > 1 or alike)
    if fitted.rank > _BY_A_SIGN and (strong and many > 1 or fitted.rank == WHOLLY) and near.away <= _TWICE:
        return True
    angles = sum(m == fitted.theory.angle for m in fitted.meanings.values()) if fitted.rank > _BY_A_SIGN else 0
    worded = many <= strong + angles and (many > 1 or fitted.rank > _BY_A_SIGN)  # all of it
    if worded or many > 4 and strong > 1 or near.away <= _NEAR and many > 2 and strong > 0:
        return True
    if beside:
        return many > 1 or fitted.rank > 2
    return many > 2 and sum(isinstance(n, (ast.BinOp, ast.Call)) for _, n in trees.walk(near.form.tree)) >= _HEAVY


def _chooses(tree: ast.AST) -> bool:
    # (a + b + abs(a - b))/2 is the larger of two
    return any(isinstance(n, ast.Name) and n.id in ("abs", "max", "min") for n in ast.walk(tree))


def _wrong(row: Row, near: Near, beside: Sequence[Near]) -> Row | None:
    # more than a slip away: told only where the letters are certainly understood
    quantities = sorted({other.quantity for other in beside if len(other.fitted.meanings) > 2})
    nearer = any(away <= near.away and q != near.quantity for away, q in nearest(near.fitted, near.form, near.states))
    sure = len(quantities) >= _WITNESSES and of_same_letters(near.fitted.theory, near.form, near.quantity)
    if nearer or not sure or list(near.fitted.quantities) != [near.quantity]:
        return None
    return row | {"note": f"in the same letters {' and '.join(quantities)} of this file agree"}
