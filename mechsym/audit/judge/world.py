"""What a text says of its own letters, as a theory: definitions in their order, what is solved for, rates of angles.

Two forms of one thing are compared in it at random states; where they differ, the auditor's own search looks for the
slip. A letter that a later section defines anew means the new thing from there on.
"""

import ast
import re
import zlib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property

from mechsym.audit.judge.kinds import PURE, Kinds, text
from mechsym.audit.judge.motion import ANGLES, angle_of, energies_of, even_rate, with_angle
from mechsym.audit.judge.primes import is_rate, stems_of
from mechsym.audit.judge.solving import isolate, targets
from mechsym.audit.read.reader import RESERVED
from mechsym.audit.read.said import Said, Text
from mechsym.audit.read.slopes import PRIMES, Slope, slope_in
from mechsym.audit.read.spelling import SPEEDS
from mechsym.audit.read.tree import (
    Node,
    argument_of,
    binary,
    function_of,
    is_operation,
    letters,
    name,
    number,
    renamed,
    substitute,
    value_of,
    walk,
)
from mechsym.audit.theory.record import Letter, Theory
from mechsym.audit.theory.tape import TheoryTape, over, times
from mechsym.quantities import record

_OPAQUE = re.compile(r"integral\w{8}|constant|function")
_SLENDER = re.compile(r"\bratio\b.*\bcrank\b.*\brod\b|\b(?:crank[- ]to[- ]|connecting |^)rod ratio\b")
_CASE = re.compile(r"\b(?:for|if|when|where)\b[^.;:$]*$", re.IGNORECASE)  # for equal masses m_1 = m_2


@record
class Defined:
    """A letter and what a text says that it is."""

    order: int  #: Place of the equation in the text [-]
    letter: str
    tree: Node
    side: int = 0  #: Which side of the equation it is; 0 where the equation was solved for the letter [-]
    against: int = 0  #: Which side it was solved with [-]


@dataclass
class World:
    """The letters of a text and what is said of them."""

    paper: Text
    kinds: Kinds
    angle: str = ""
    aliases: dict[str, str] = field(default_factory=dict)  #: Author's letter to the rate of the angle that it is
    defined: list[Defined] = field(default_factory=list)
    theories: dict[tuple[int, ...], Theory] = field(default_factory=dict)
    dotted: frozenset[str] = frozenset()  #: Letters with a dot somewhere
    energetic: bool = False  #: Whether a Lagrange equation stands in it, or is spoken of

    def __post_init__(self) -> None:
        """Find the angle that runs, its rates, and all definitions."""
        spelled = {k: v for said in self.paper.said for k, v in said.spelled.items()}
        dots = {k: 1 + v.startswith("\\ddot") for k, v in spelled.items() if v.startswith(("\\dot", "\\ddot"))}
        self.dotted = frozenset(k[:-count] for k, count in dots.items())
        self.energetic = any(said.law is not None for said in self.paper.said) or bool(energies_of(self.paper))
        self._name_time()
        self.angle = angle_of(self.paper)
        self._name_alike()
        self._name_rates()
        for order, said in enumerate(self.paper.said):
            self._define(order, said)
        self._name_motion()
        self._name_turns()
        self._name_applied()

    def _name_time(self) -> None:
        # omega t under a sine, where time stands nowhere else: an angle, and omega its rate
        trees = [side for said in self.paper.said for side in said.sides]
        sines = [a for t in trees for _, n in walk(t) if (a := argument_of(n, "sin", "cos", "tan")) is not None]
        rates = {k for a in sines if "t" in letters(a) for k in letters(a) if k in SPEEDS}
        angle = next((a for a in ANGLES[1:] if all(a not in letters(tree) for tree in trees)), "")
        if len(rates) != 1 or not angle:
            return
        rate = rates.pop()
        said = [replace(one, sides=tuple(with_angle(s, rate, angle) for s in one.sides)) for one in self.paper.said]
        if any("t" in letters(side) for one in said for side in one.sides):
            return
        sign = rf"\{rate} t" if len(rate) > 1 else f"{rate} t"
        self.paper = replace(self.paper, said=[replace(o, spelled={**o.spelled, angle: sign}) for o in said])
        self.aliases[rate] = f"{angle}d"

    def _name_alike(self) -> None:
        # a nu that is a v where the same letter has one
        used = {n for said in self.paper.said for side in said.sides for n in letters(side)} | set(self.paper.named)
        self.aliases |= {
            n: n.replace("nu", "v") for n in used if "nu" in n and n != "nu" and n.replace("nu", "v") in used
        }

    def _name_applied(self) -> None:
        # S(theta) is the one letter with an S that is a function of the angle: S_piston
        sign = {"lam": "lambda"}.get(self.angle, self.angle)
        applied = re.compile(rf"(?<![A-Za-z_\\{{])([A-Za-z])\s*\(\s*\\(?:var)?{sign}\s*\)")
        said = []
        for one in self.paper.said:
            meant: dict[str, str] = {}
            for letter in set(applied.findall(one.shown.text)) if sign else ():
                turning = {d.letter for d in self.defined if d.letter.startswith(letter) and self.turns(d.letter)}
                if len(turning) == 1 and all(d.letter != letter for d in self.defined):
                    meant[letter] = turning.pop()
            said.append(replace(one, sides=tuple(renamed(s, meant) for s in one.sides)) if meant else one)
        self.paper = replace(self.paper, said=said)

    def _name_rates(self) -> None:
        rates = {f"{self.angle}d": 1, f"{self.angle}prime": 1, f"d{self.angle}_dt": 1, f"{self.angle}dd": 2}
        for said in self.paper.said:
            names = [s.id for s in said.sides if isinstance(s, ast.Name)]
            for rate, order in rates.items():
                if self.angle and len(names) > 1 and rate in names:
                    self.aliases |= {
                        n: f"{self.angle}{'d' * order}" for n in names if n != f"{self.angle}{'d' * order}"
                    }
        written = {n for said in self.paper.said for side in said.sides for n in letters(side)}
        for usual in SPEEDS:
            about = self.paper.named.get(usual)
            fits = usual != "w" or about and about.unit == "rad/s"
            # beside the dotted angle it is the constant speed, where it is called a speed of what turns
            beside = f"{self.angle}d" in written and not re.search("angular (?:velocity|speed)", self.phrase(usual))
            if (
                self.angle
                and f"{self.angle}d" not in self.aliases.values()
                and usual in written
                and fits
                and not beside
            ):
                self.aliases[usual] = f"{self.angle}d"

    def phrase(self, letter: str) -> str:
        """What the text calls a letter."""
        about = self.paper.named.get(letter)
        return (about.meaning if about else self.paper.called.get(letter, "")).lower()

    def _define(self, order: int, said: Said) -> None:
        if rate := even_rate(said):
            self.aliases |= {rate: f"{self.angle}d"} if letters(said.sides[0]) == (self.angle,) else {}
        if not said.sides or said.claim or rate:
            return
        sides = [self.plain(s) for s in said.sides]
        left, sides[1:] = sides[0], [self._sloped(side) for side in sides[1:]]
        if isinstance(left, ast.Name):
            if left.id == f"{self.angle}d" and self.angle:
                self._solve(order, sides[0], sides[1:], any_letter=True)
            elif self._may_define(left.id, said, order):
                for k, side in enumerate(sides[1:], 1):
                    opaque = any(_OPAQUE.fullmatch(n) for n in letters(side))
                    if not opaque and left.id not in self._reach(side) and not is_rate(side):
                        self.defined.append(Defined(order=order, letter=left.id, tree=side, side=k))
                        return
            return
        below = left.right if is_operation(left, ast.Div) and value_of(left.left) == 1 else None
        if isinstance(below, ast.Name) and self._may_define(below.id, said, order):
            if below.id not in self._reach(sides[1]):  # 1/R = 1/R_1 + 1/R_2
                turned = binary(ast.Div, number(1), sides[1])
                self.defined.append(Defined(order=order, letter=below.id, tree=turned, against=1))
            return
        if is_operation(left, ast.Div) and isinstance(left.left, ast.Name) and isinstance(left.right, ast.Name):
            above = left.left.id if len(sides) == 2 else ""  # Q_b/Q_0 = .. of what slopes are taken of elsewhere
            if above in self._shares and above not in self._reach(sides[1]):
                self.defined.append(Defined(order=order, letter=above, tree=times(sides[1], left.right), against=1))
                return
        self._solve(order, left, sides[1:], any_letter=False)

    @cached_property
    def _shares(self) -> frozenset[str]:
        # letters that no equation gives, with a slope that one does, or in a form of several
        lefts = [said.sides[0].id for said in self.paper.said if said.sides and isinstance(said.sides[0], ast.Name)]
        chained = {n for said in self.paper.said if len(said.sides) > 2 for side in said.sides for n in letters(side)}
        return frozenset({slope.of for left in lefts if (slope := slope_in(left))} | chained) - {*lefts, "d"}

    def _sloped(self, tree: Node) -> Node:
        # the prime of what is defined, within another definition: its slope by the angle
        known = {d.letter for d in self.defined} if self.angle else set()
        slopes = {f"{k}prime": Slope(k, self.angle).name for k in known}
        return substitute(tree, lambda n: name(slopes[n.id]) if isinstance(n, ast.Name) and n.id in slopes else None)

    def _may_define(self, letter: str, said: Said, order: int) -> bool:
        if letter in RESERVED or _OPAQUE.fullmatch(letter):
            return False
        if letter in (self.angle, f"{self.angle}d", f"{self.angle}dd"):
            return False
        if self.energetic and said.spelled.get(letter, "").startswith("\\ddot"):
            return False
        if PRIMES.fullmatch(letter) or re.fullmatch(r"d\d?\w+_d\w+", letter) or self._rate_of(letter):
            return False
        before = [d for d in self.defined if d.letter == letter]
        return not before or self.paper.said[before[-1].order].section != said.section and not said.inline

    def _rate_of(self, letter: str) -> bool:
        return any(letter == d.letter + dots for d in self.defined for dots in ("d", "dd"))

    def _solve(self, order: int, left: Node, right: Sequence[Node], any_letter: bool) -> None:
        # the one letter that nothing has defined yet: under a sine, or a force in a balance
        known = {d.letter for d in self.defined}
        if self.energetic and any(n.endswith("dd") for side in (left, *right) for n in letters(side)):
            return  # an equation of motion
        for k, side in enumerate(right, 1):
            for whole, other in ((left, side), (side, left)):
                for target in targets(whole, known | {self.angle, f"{self.angle}d", f"{self.angle}dd"}, any_letter):
                    if target in letters(other) or target in self.kinds.turns and not any_letter:
                        continue
                    if (solved := isolate(whole, target, other)) is not None and target not in self._reach(solved):
                        self.defined.append(Defined(order=order, letter=target, tree=solved, against=k))
                        return

    def _reach(self, tree: Node) -> set[str]:
        reached, waiting = set(), list(letters(tree))
        latest = {d.letter: d.tree for d in self.defined}
        while waiting:
            letter = waiting.pop()
            if letter in reached:
                continue
            reached.add(letter)
            waiting += letters(latest[letter]) if letter in latest else [s for s in stems_of(letter) if s in latest]
        return reached

    def _name_motion(self) -> None:
        # a letter that is called an acceleration, beside one that is called the velocity of the same thing
        if not self.angle:
            return
        called = {word: self._called(word) for word in ("travel", "velocity", "acceleration")}
        for slower, faster in (("travel", "velocity"), ("velocity", "acceleration")):
            known = {d.letter for d in self.defined}
            for letter in called[faster]:
                base = next((k for k in called[slower] if k in known and self.turns(k)), "")
                if base and letter not in known:
                    self.defined.append(Defined(order=-1, letter=letter, tree=name(f"{base}_d")))

    def _name_turns(self) -> None:
        # an angular speed that nothing gives, beside the one letter that counts turns
        a_second = {k for k, about in self.paper.named.items() if about.unit in ("1/s", "-/s")}
        counted = sorted(k for k in self.kinds.turns | a_second if re.search("(?:speed|minute)$", self.phrase(k)))
        if len(counted) != 1 or any(d.letter in (counted[0], "omega") for d in self.defined):
            return
        each = times(number(Fraction(1, 30) if counted[0] in self.kinds.turns else 2), name("pi"))
        if crank := self.aliases.get("omega"):
            self.defined.append(Defined(order=-1, letter=counted[0], tree=over(name(crank), each)))
        elif "omega" in self.used:
            self.defined.append(Defined(order=-1, letter="omega", tree=times(each, name(counted[0]))))

    def _called(self, word: str) -> list[str]:
        alike = {"travel": ("travel", "displacement", "position")}.get(word, (word,))
        fitting = [k for k, about in self.paper.named.items() if any(w in about.meaning.lower() for w in alike)]
        angular = {k for k in fitting if "angular" in self.paper.named[k].meaning.lower()}
        return [k for k in fitting if k not in angular]

    @property
    def moving(self) -> frozenset[str]:
        """Letters with a dot somewhere that no equation defines: coordinates."""
        return self.dotted - {d.letter for d in self.defined} - {self.angle}

    @property
    def coordinates(self) -> frozenset[str]:
        """Letters that move by themselves, the angle that runs among them."""
        return self.moving | ({self.angle} if self.angle else set())

    def turns(self, letter: str) -> bool:
        """Whether a defined letter changes with the angle, or another coordinate."""
        reached = self._reach(name(letter))
        return self.angle in reached or not {m for q in self.moving for m in (q, f"{q}d")}.isdisjoint(reached)

    def plain(self, tree: Node) -> Node:
        """A side with the rates of the angle under their names, and sums over parts as one letter."""

        def changed(node: Node) -> Node | None:
            if isinstance(node, ast.Name) and node.id in self.aliases:
                return name(self.aliases[node.id])
            if isinstance(node, ast.Call) and function_of(node) == "sum":
                return name(f"sum{zlib.crc32(ast.dump(node).encode()):08x}")
            return None

        return substitute(tree, changed)

    def theory(self, order: int, believed: Mapping[str, Node] | None = None) -> Theory:
        """The definitions that hold at an equation; `believed`: what letters are taken to be instead."""
        latest, said = dict[str, int](), self.paper.said
        for index, one in enumerate(self.defined):
            source = said[one.order]
            holds = one.order < 0 or source.section == said[order].section and not source.equates
            case = source.equates and _CASE.search(source.before) and "equal" not in said[order].before[-120:]
            over_it = one.order >= 0 and case and any(not other.inline for other in said[one.order + 1 : order])
            if one.order <= order and not over_it or holds and one.letter not in latest:
                latest[one.letter] = index
        key = tuple(sorted(latest.values()))
        if believed is None and key in self.theories:
            return self.theories[key]
        tape = {self.defined[i].letter: self.defined[i].tree for i in key} | dict(believed or {})
        theory = self._made(tape)
        if believed is None:
            self.theories[key] = theory
        return theory

    @cached_property
    def used(self) -> frozenset[str]:
        """All letters of a text whose rates and angles have their names."""
        return frozenset(n for said in self.paper.said for side in said.sides for n in letters(self.plain(side)))

    @cached_property
    def bare(self) -> Theory:
        """A theory of the letters alone: nothing is defined."""
        return self._made({})

    def _made(self, tape: Mapping[str, Node]) -> Theory:
        used = self.used | {n for tree in tape.values() for n in letters(tree)}
        used |= {self.angle, f"{self.angle}d", f"{self.angle}dd"} if self.angle else set()
        bare = {n for n in used if n not in tape and not self._derivative(n, tape) and n != "pi"}
        known = all(self.kinds.of(n) is not None for n in bare)
        rods = tuple(sorted(self._rods(tape) & bare))
        values = {n: self._letter(n, known, n in rods) for n in sorted(bare)}
        small = tuple(n for n in values if self.kinds.of(n) == PURE and _SLENDER.search(self.phrase(n)))
        values |= {n: replace(values[n], value=0.27) for n in small}
        ordered = {letter: self._rated(tree, tape) for letter, tree in _in_order(tape)}
        return Theory(
            name="paper", letters=values, tape=TheoryTape(ordered, values, self.angle, declared=True),
            results=tuple(ordered), angle=self.angle, rods=rods, small=small,
        )  # fmt: skip

    def _rated(self, tree: Node, tape: Mapping[str, Node]) -> Node:
        # rates of the text's own letters under the names of the tape
        def changed(node: Node) -> Node | None:
            if not isinstance(node, ast.Name) or node.id in tape:
                return None
            rate = re.fullmatch(r"(\w+?)(dd?)", node.id)
            return name(f"{rate[1]}_{rate[2]}") if rate and rate[1] in tape and self.turns(rate[1]) else None

        return substitute(tree, changed)

    def _derivative(self, letter: str, tape: Mapping[str, Node]) -> bool:
        if slope := slope_in(letter):
            return slope.of in tape
        if prime := PRIMES.fullmatch(letter):
            return prime[1] in tape and bool(self.angle)
        stem = re.fullmatch(r"(\w+?)_?dd?", letter)
        return bool(stem and stem[1] in tape and self.turns(stem[1]))

    def _rods(self, tape: Mapping[str, Node]) -> set[str]:
        ratio = [t.right.id for t in tape.values() if is_operation(t, ast.Div) and isinstance(t.right, ast.Name)
                 and isinstance(t.left, ast.Name)]  # fmt: skip
        # and what a root is real by: sqrt(l^2 - r^2 sin^2)
        roots = [a for t in tape.values() for _, n in walk(t) if (a := argument_of(n, "sqrt")) is not None]
        ratio += [k for a in roots if any(function_of(n) == "sin" for _, n in walk(a)) for k in letters(a)]
        return {r for r in ratio if r in ("l", "L")}

    def _letter(self, letter: str, known: bool, rod: bool) -> Letter:
        kind = self.kinds.of(letter)
        unit = "-" if not known or kind is None or kind == PURE else text(kind).replace(" ", "*")
        if letter == self.angle or letter.startswith(self.angle) and letter in (f"{self.angle}d", f"{self.angle}dd"):
            unit, value = {0: ("rad", 1.0), 1: ("rad/s", 1.7), 2: ("rad/s^2", 1.3)}[len(letter) - len(self.angle)]
            return Letter(unit=unit, value=value, sign="any")  # at 1 a rate that is left out would not be missed
        share = zlib.crc32(letter.encode()) % 100 / 250
        return Letter(unit=unit, value=4.0 if rod else 0.8 + share, sign="positive")


def _in_order(tape: Mapping[str, Node]) -> Iterator[tuple[str, Node]]:
    done: set[str] = set()

    def put(letter: str, above: frozenset[str]) -> Iterator[tuple[str, Node]]:
        if letter in done or letter in above:
            return
        for n in letters(tape[letter]):
            for need in (n, *stems_of(n)):
                if need in tape:
                    yield from put(need, above | {letter})
        if letter not in done:
            done.add(letter)
            yield letter, tape[letter]

    for letter in tape:
        yield from put(letter, frozenset())
