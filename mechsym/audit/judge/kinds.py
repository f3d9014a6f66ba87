"""Units of the equations of a text: each must have one on both sides, by what its nomenclature says of the letters.

A letter with an index has the unit of the letter without one. A number that may carry a unit (0.4 in `t + 0.4`) makes
an equation empirical: nothing is said of it.
"""

import ast
import re
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from fractions import Fraction

from mechsym.audit.judge.exponents import exponent, is_left
from mechsym.audit.read.said import Said, Text
from mechsym.audit.read.slopes import slope_in
from mechsym.audit.read.spelling import SYMBOLS
from mechsym.audit.read.tree import Node, argument_of, function_of, is_operation, letters, value_of, walk
from mechsym.audit.read.units import defined_unit, misnamed, of_turns, usual_unit
from mechsym.errors import BadInput
from mechsym.quantities import dimension
from mechsym.quantities.units import scale

Kind = tuple[Fraction, ...]  # exponents of kg, m, s, K, of a factor 60 and of a factor 1000
PURE: Kind = (Fraction(0),) * 6
_LENGTH: Kind = (Fraction(0), Fraction(1), *PURE[2:])
_NEWTON: Kind = (Fraction(1), Fraction(1), Fraction(-2), *PURE[3:])
_MANY = 4  # letters of one family
SIXTY, THOUSAND = 4, 5
_SCALED = {"kW": 3, "kN": 3, "kPa": 3, "kJ": 3, "MPa": 6, "MW": 6, "MJ": 6}
_CONVERTS = {Fraction(15), Fraction(30), Fraction(60), Fraction(120)}
#: Whole numbers that formulas have of themselves; any other may carry a unit
_PLAIN = {
    *map(Fraction, (*range(1, 13), 15, 16, 24, 30, 32, 48, 60, 64, 96, 120, 128, 180, 360)),
    Fraction(1, 2),
    Fraction(1, 4),
}
_PLAIN |= {Fraction(3, 2), Fraction(3, 4), Fraction(5, 2), Fraction(1, 8), Fraction(4, 3)}
_FALLS = re.compile(r"\b(?:mass(?:es)?|weigh\w*|gravit\w*|lift\w*|hoist\w*|pendulum)\b", re.IGNORECASE)
_UNITS = ("kg", "m", "s", "K")
_WAYS = ("x", "y", "z", "s")


_STEMS = "|".join([*sorted(SYMBOLS, key=len, reverse=True), "[A-Za-z]"])
RATE = re.compile(rf"((?:{_STEMS})\w*?)(dd?)")
_STEP = re.compile(rf"(?:Delta|delta|d)((?:{'|'.join(sorted(SYMBOLS, key=len, reverse=True))}|[A-Zxyzms])\w*)")
_MARKED = re.compile(r"(\w+?)(?:bar|hat|tilde|star)")
_INDEX = re.compile(rf"({_STEMS})(\w+)")


class Clash(BadInput):
    """Two parts of an expression that have different units."""


class Unknown(Exception):  # noqa: N818 not an error
    """Nothing can be said of a unit: a letter of it is not known, or a number may carry one."""


@dataclass
class Kinds:
    """The kinds of the letters of a text: printed, or inferred from what defines them."""

    printed: dict[str, Kind] = field(default_factory=dict)
    inferred: dict[str, Kind] = field(default_factory=dict)
    bare: dict[str, Kind] = field(default_factory=dict)  #: Of letters that a relative with a unit for an index tells
    scaled: set[str] = field(default_factory=set)  #: Letters that the table measures in no unit of the SI
    dotted: frozenset[str] = frozenset()  #: Letters with a dot: Ed is no E with an index
    indexed: frozenset[str] = frozenset()  #: Letters with an index: C_d is no rate of C
    misnamed: dict[str, str] = field(default_factory=dict)  #: Letters that the table has in no unit of theirs, to it
    spoken: frozenset[str] = frozenset()  #: Letters of which sentences tell, and no table
    turns: set[str] = field(default_factory=set)  #: Letters in revolutions a minute that formulas take as a number

    def of(self, letter: str) -> Kind | None:
        """Kind of a letter, of its rate, or of the one without its index."""
        for known in (self.inferred, self.printed):
            if letter in known:
                return known[letter]
        if "prime" in letter or letter in SYMBOLS:
            return None
        if slope := slope_in(letter):
            above, below = self.of(slope.of), self.of(slope.by)
            if above is None or below is None:
                return None
            return tuple(a - slope.order * b for a, b in zip(above, below, strict=True))
        if (rate := self.as_rate(letter)) and (still := self.of(rate[1])) is not None:
            # the dot on a mass or a heat may mean the angle
            return (*still[:2], still[2] - len(rate[2]), *still[3:]) if still in (PURE, _LENGTH) else None
        if within := _MARKED.fullmatch(letter) or _STEP.fullmatch(letter):
            return self.of(within[1])
        base = _INDEX.fullmatch(letter)
        if base is None or letter in self.dotted:
            return self.bare.get(letter)
        if base[2] in ("max", "min", "mean"):
            return self.of(base[1])
        if base[2][0].isdigit():
            kind = self.printed.get(base[1])
            siblings = {k for n, k in self.printed.items() if re.fullmatch(rf"{base[1]}\d\w*", n)}
            return kind if siblings <= {kind} else None  # T is an energy, T_2 a temperature
        kind = self.printed.get(base[1], self.bare.get(base[1]))
        if kind is None or kind == PURE and base[1] not in SYMBOLS:
            return None  # a number lends its kind to no other letter
        if len(base[2]) > 1:
            return kind
        # c_p beside a c_v that is no c
        like = {
            k[:4] for n, k in self.printed.items() if len(n) == len(letter) and n[:-1] == base[1] and n not in SYMBOLS
        }
        return kind if like <= {kind[:4]} else None

    def as_rate(self, letter: str) -> re.Match[str] | None:
        """A letter taken apart that is the rate of another one; None for all others."""
        return RATE.fullmatch(letter) if letter not in self.indexed else None

    def is_lent(self, letter: str) -> bool:
        """Whether a letter with an index has its kind from the one without it; a number for an index is lent less."""
        within = _MARKED.fullmatch(letter)
        if letter in self.printed or letter in self.inferred or self.as_rate(letter) or slope_in(letter):
            return False
        if within and (within[1] in self.printed or within[1] in self.inferred):
            return False  # a mean is measured as what it is the mean of
        base = _INDEX.fullmatch(within[1] if within else letter)
        if base is None or base[2][0].isdigit() and base[1] not in self.spoken:
            return False
        family = [k for n, k in self.printed.items() if n.startswith(base[1])]
        # beside F, F_g and F_n an F_r is a force
        return self.of(letter) is not None and (len(family) < _MANY or any(k != _NEWTON for k in family))

    def kind(self, tree: Node) -> Kind:
        """Kind of an expression. Raises Clash, and Unknown where a letter is unknown or a number may have a unit."""
        kind = self._kind(tree)
        if is_left(kind):
            raise Unknown
        return kind

    def _kind(self, tree: Node) -> Kind:
        value = value_of(tree)
        if value is not None:
            return _number(Fraction(value))
        if isinstance(tree, ast.Name):
            known = PURE if tree.id in ("pi", "plusminus") else self.of(tree.id)
            if known is None:
                raise Unknown
            return known
        if isinstance(tree, ast.UnaryOp):
            return self._kind(tree.operand)
        if isinstance(tree, ast.IfExp):
            return self._same(tree.body, tree.orelse)
        if isinstance(tree, ast.Call):
            return self._called(str(function_of(tree)), tree.args[0])
        if isinstance(tree, ast.BinOp):
            return self._operation(tree)
        raise Unknown

    def _called(self, function: str, argument: Node) -> Kind:
        inner = self._kind(argument)
        if function in ("abs", "sum"):
            return inner
        if function == "sqrt":
            return tuple(e / 2 for e in inner)
        if is_left(inner):
            raise Unknown
        if any(inner[:4]) and function != "log":  # log p + n log V is right in any unit
            raise Clash(f"the argument of {function} has the unit {shown(inner)}")
        return PURE

    def _operation(self, tree: ast.BinOp) -> Kind:
        if isinstance(tree.op, (ast.Add, ast.Sub)):
            return self._same(tree.left, tree.right)
        if isinstance(tree.op, ast.Pow):
            power, base = exponent(tree.right), self._kind(tree.left)
            if power is None:
                if any(base[:4]):
                    raise Unknown
                return PURE
            return tuple(e * power for e in base)
        sign = 1 if isinstance(tree.op, ast.Mult) else -1
        try:
            left = self._kind(tree.left)
        except Unknown:
            self._kind(tree.right)
            raise
        right = self._kind(tree.right)
        return tuple(a + sign * b for a, b in zip(left, right, strict=True))

    def _same(self, left: Node, right: Node) -> Kind:
        try:
            first = self._kind(left)
        except Unknown:
            self._kind(right)
            raise
        second = self._kind(right)
        if first[:4] != second[:4]:
            if value_of(left) == 0 or value_of(right) == 0:
                return second if value_of(left) == 0 else first
            if is_left(first) or is_left(second):
                raise Unknown
            raise Clash(f"{shown(first)} is added to {shown(second)}")
        return first if any(first[4:]) else second


def _number(value: Fraction) -> Kind:
    if value and abs(value) not in _PLAIN:
        raise Unknown
    sixty = Fraction(int(abs(value) in _CONVERTS))
    return (*PURE[:4], sixty, Fraction(0))


def text(kind: Kind) -> str:
    """A kind as a unit."""
    shown = [f"{u}^{e}" if e != 1 else u for u, e in zip(_UNITS, kind, strict=False) if e]
    return " ".join(shown) or "1"


def shown(kind: Kind) -> str:
    """A kind as people write its unit: N in place of kg m s^-2."""
    return _NAMES.get(kind[:4]) or text(kind)


def of_unit(unit: str) -> Kind:
    """Kind of a printed unit."""
    return (*map(Fraction, dimension(unit)), Fraction(0), Fraction(0))


_NAMES = {
    of_unit(unit)[:4]: name for unit, name in (("N", "N"), ("Pa", "Pa"), ("J", "J or N m"), ("W", "W"), ("Hz", "1/s"))
}


def kinds_of(paper: Text) -> Kinds:
    """What the nomenclature, units behind equations, and definitions tell."""
    dotted = frozenset(k for said in paper.said for k, v in said.spelled.items() if v.startswith(("\\dot", "\\ddot")))
    spoken = frozenset(paper.called) - frozenset(paper.named)
    below = {k for said in paper.said for k, v in said.spelled.items() if "_" in v}
    kinds = Kinds(
        printed={"dt": of_unit("s"), "t": of_unit("s")}, dotted=dotted, spoken=spoken, indexed=frozenset(below) - dotted
    )
    indexed = {k for said in paper.said for k, v in said.spelled.items() if v.startswith("d_")}
    if "dt" in indexed:
        del kinds.printed["dt"]  # a diameter of something
    for letter, phrase in paper.called.items():
        is_listed = letter in paper.named and paper.named[letter].meaning == phrase
        if usual := (defined_unit if is_listed else usual_unit)(letter, phrase, letter in indexed):
            kinds.printed[letter] = of_unit(usual)
        measured = letter in paper.named and paper.named[letter].unit
        if not measured and (unit := of_turns(phrase)):
            kinds.printed[letter] = of_unit(unit)
            kinds.turns |= {letter} if unit == "rpm" else set()
    for letter, about in paper.named.items():
        unit = about.unit or of_turns(about.meaning) or defined_unit(letter, about.meaning, letter in indexed)
        if unit:
            kinds.printed[letter] = of_unit(unit)
        if wanted := misnamed(letter, about.meaning, about.unit):
            kinds.misnamed[letter] = wanted
            kinds.printed[letter] = of_unit(wanted)
        if unit == "rpm":
            kinds.turns.add(letter)
        elif about.unit and scale(about.unit) != 1:
            kinds.scaled.add(letter)
    _by_use(kinds, paper)
    beside = Counter(said.shown.begins for said in paper.said)
    for said in paper.said:  # the ratio of two speeds, of which one turns, is a length
        left, ratio = said.sides if len(said.sides) == 2 else (None, None)
        if isinstance(left, ast.Name) and ratio is not None and "ratio" in paper.called.get(left.id, ""):
            kind = kind_in(kinds, ratio) if is_operation(ratio, ast.Div) else None
            if kind is not None and all(map(kinds.as_rate, letters(ratio))):
                kinds.printed[left.id] = kind
    for _ in range(3):
        for said in paper.said:
            # numbers in a row are data, in units that stand elsewhere
            data = beside[said.shown.begins] > 1 and said.sides and value_of(said.sides[-1]) is not None
            if not data:
                infer(kinds, said)
    _numbers_of_turns(kinds, paper.said)
    for said in paper.said if kinds.turns else ():
        infer(kinds, said)
    return kinds


def _by_use(kinds: Kinds, paper: Text) -> None:
    # angles by the sines that they stand under, letters whose index is a unit, units behind an equation
    used = {n for said in paper.said for side in said.sides for n in letters(side)}
    for side in (side for said in paper.said for side in said.sides):
        for _, node in walk(side):
            argument = argument_of(node, "sin", "cos", "tan", "cot")
            if argument is not None and all(
                isinstance(n, ast.Name | ast.operator) or value_of(n) is not None for n in _sum(argument)
            ):
                alone = isinstance(argument, ast.Name)  # cos 3 x of a way x has a number in 1/m
                angles = [n for n in letters(argument) if alone or n not in _WAYS]
                kinds.printed |= {n: PURE for n in angles if kinds.of(n) is None}
    defined = {side.id for said in paper.said for side in said.sides[:1] if isinstance(side, ast.Name)}
    if "g" in used - defined - kinds.printed.keys() - paper.called.keys() and _FALLS.search(paper.prose):
        kinds.inferred["g"] = of_unit("m/s^2")
    for letter in sorted(used):
        unit = next((u for u in _SCALED if letter.endswith(u) and len(letter) > len(u)), "")
        if unit:
            kinds.printed[letter] = (*map(Fraction, dimension(unit)), Fraction(0), Fraction(-_SCALED[unit], 3))
            kinds.bare.setdefault(letter.removesuffix(unit), (*kinds.printed[letter][:4], Fraction(0), Fraction(0)))
    for said in paper.said:
        if said.shown.unit and said.sides and isinstance(said.sides[0], ast.Name):
            kinds.printed.setdefault(said.sides[0].id, of_unit(said.shown.unit))


def infer(kinds: Kinds, said: Said) -> None:
    """The unit of the letter that an equation defines, or one over it, where its other side is known."""
    left = said.sides[0] if said.sides else None
    over = left is not None and is_operation(left, ast.Div) and value_of(left.left) == 1
    letter = left.right if over and isinstance(left, ast.BinOp) else left
    alike = {side.id for side in said.sides if isinstance(side, ast.Name)}
    if len(alike) == len(said.sides) > 1 and len({n[0] for n in alike}) == 1:  # m_1 = m_2 = m
        shared = {kind for n in alike if (kind := kinds.of(n)) is not None}
        if len(shared) == 1:
            kinds.inferred |= dict.fromkeys((n for n in alike if kinds.of(n) is None), *shared)
    if not isinstance(letter, ast.Name) or letter.id in kinds.inferred or letter.id in kinds.printed:
        return
    # x(t_f) = 1 may be 1 m
    at_a_point = "(" in said.shown.text.partition("=")[0] and value_of(said.sides[-1]) is not None
    known = [k for side in said.sides[1:] if not at_a_point and (k := kind_in(kinds, side)) is not None]
    like = kinds.of(letter.id)  # n_p as n, but for what takes it from a minute to a second
    if like is not None and (like[4:] == PURE[4:] or not known or known[0][:4] != like[:4]):
        return
    if known and all(k == known[0] for k in known):
        sign = -1 if over else 1
        kinds.inferred[letter.id] = (*(sign * e for e in known[0][:4]), Fraction(0), Fraction(0))


def kind_in(kinds: Kinds, tree: Node) -> Kind | None:
    """The kind of an expression; None where it has none, or a letter of it is not known."""
    try:
        return kinds.kind(tree)
    except (Unknown, Clash):
        return None


def _numbers_of_turns(kinds: Kinds, said: Sequence[Said]) -> None:
    # N/60 in two equations, or wherever it stands: N counts revolutions a minute, and is sixty times its value in all
    for letter in kinds.turns:
        uses = [one for one in said if letter in letters_of(one) and not _is_exponent(one, letter)]
        uses = [one for one in uses if converted(one, letter) or not _is_of_two_speeds(kinds, one, letter)]
        if (count := sum(converted(one, letter) for one in uses)) > 1 or count == len(uses):
            kinds.printed[letter] = (*kinds.printed[letter][:4], Fraction(1), Fraction(0))


def _is_of_two_speeds(kinds: Kinds, said: Said, letter: str) -> bool:
    # n_3 = n_1/i holds for turns in a minute and in a second
    left = said.sides[0]
    speed = kinds.of(left.id) if isinstance(left, ast.Name) and left.id != letter else None
    return speed is not None and speed[:4] == of_unit("1/s")[:4]


def _is_exponent(said: Said, letter: str) -> bool:
    powers = [n for side in said.sides for _, n in walk(side) if is_operation(n, ast.Pow)]
    return any(letter in letters(power.right) for power in powers)


def _sum(tree: Node) -> list[Node]:
    if isinstance(tree, ast.BinOp) and isinstance(tree.op, (ast.Add, ast.Sub)):
        return [*_sum(tree.left), *_sum(tree.right)]
    return [tree.right] if isinstance(tree, ast.BinOp) and value_of(tree.left) is not None else [tree]


def converted(said: Said, letter: str) -> bool:
    """Whether an equation takes a letter from a minute to a second."""
    used = [side for side in said.sides if letter in letters(side)]
    constants = {abs(Fraction(v)) for side in used for _, n in walk(side) if (v := value_of(n)) is not None}
    return bool(constants & _CONVERTS)


def letters_of(said: Said) -> Iterable[str]:
    """All letters of an equation."""
    return {n for side in said.sides for n in letters(side)}
