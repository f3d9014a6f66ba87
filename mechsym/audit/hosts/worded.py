"""Equations of a text held against theories by their words, as the formulas of a program are by names and comments."""

import ast
import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cache
from itertools import product

from mechsym.audit.hosts.neighbours import Neighbours
from mechsym.audit.judge.kinds import kind_in, of_unit
from mechsym.audit.judge.lexicon import Lexicon
from mechsym.audit.judge.sampled import alike, states, vanishes
from mechsym.audit.judge.world import World
from mechsym.audit.read.algebra import FLOATS, evaluate
from mechsym.audit.read.called import owned
from mechsym.audit.read.programs.claims import Claim
from mechsym.audit.read.reader import AnyLetter, read_expression
from mechsym.audit.read.said import named_by_words
from mechsym.audit.read.spelling import to_python
from mechsym.audit.read.tree import (
    Node,
    function_of,
    is_operation,
    letters,
    renamed,
    substitute,
    walk,
)
from mechsym.audit.read.tree import name as name_of
from mechsym.audit.row import Row
from mechsym.audit.theory.catalogue import named, shipped_for
from mechsym.audit.theory.record import Theory

_ALONE = 4  # operations of a formula of one letter that is held against theories: (2/(k + 1))^(k/(k - 1))
_SPEED = re.compile(r"(?:omega|Omega|w|n|N)(?=\d$)")  # of the first shaft, and of the second
_TRANSMISSIONS = {"gear ratio", "transmission ratio", "speed ratio"}
_COUNTS = {"two": 2, "three": 3, "four": 4, "five": 5, "six": 6, "eight": 8, "ten": 10, "twelve": 12}
_EACH_HAS = re.compile(r"\b(two|three|four)\s+[a-z]+\s+each\b[^.$]*$", re.IGNORECASE)
_CYLINDERS = re.compile(rf"\b({'|'.join(_COUNTS)})[- ](?:cylinder|piston)", re.IGNORECASE)
_OF_ALL = re.compile(r"\b(?:engine|all|total|together|whole)\b[^.$]*$", re.IGNORECASE)
_SUM = "forcesum"  # letter for a sum of forces
_FROM_TOP = re.compile(r"\b(?:from|after|past)\s+(?:the\s+|its\s+)?(?:top|inner|upper)\s+dead\s+cent", re.IGNORECASE)
# slider cranks are counted from the other dead centre in every theory
_FROM_BOTTOM = re.compile(r"\b(?:counted|measured|taken)\s+from\s+(?:the\s+|its\s+)?(?:bottom|outer|lower)\s+dead")


@cache
def _vocabulary(name: str) -> Lexicon:
    return Lexicon(named(name))


@dataclass
class Worded:
    """What the words of a text say of its equations."""

    world: World
    claims: dict[tuple[int, int], Claim] = field(default_factory=dict)  #: By place of the equation and its side
    neighbours: Neighbours | None = None
    outcomes: dict[tuple[int, int], Row | None] = field(default_factory=dict)
    sums: dict[tuple[int, int], Node] = field(default_factory=dict)  #: Of forces, which stand in a claim as one

    def __post_init__(self) -> None:
        """Every side of a letter's equation is a claim, the letter's name in the text its comment."""
        paper = self.world.paper
        values = {d.letter: d.tree for d in self.world.defined}
        # a speed of the table is none that its angular velocity gives
        solved = {d.letter for d in self.world.defined if not d.side and d.letter in paper.named}
        # the angle that turns is the one that the text's motion goes by, and follows from nothing
        plain = {k for k, words in paper.called.items() if words == "angle"}
        vague = {k for k in plain if k in values or self.world.angle not in ("", k)}
        called = {k: words for k, words in paper.called.items() if k not in vague}
        may_be = [_vocabulary(name) for name in shipped_for(paper.prose)]
        whose = self._owned()
        turning = {n for n in self.world.used if n.rstrip("0123456789") in self.world.kinds.turns and n not in called}
        called |= dict.fromkeys((*self.world.kinds.turns, *sorted(turning)), "revolutions per minute")
        from_top = any(_FROM_TOP.search(text) for text in (paper.prose, *called.values()))
        for order, said in enumerate(paper.said):
            if not said.sides or said.claim or said.inline:
                continue
            if (named := named_by_words(said.sides[0])) is None:
                continue
            letter, solved_for = named
            if not isinstance(letter, ast.Name) and not said.about:
                continue
            left = letter.id if isinstance(letter, ast.Name) else "ratio"  # the critical pressure ratio p_k/p_0
            about = called.get(left) or said.about
            for k, side in enumerate(said.sides[1:], 1):
                calls = {function_of(n) for _, n in walk(side)} - {None}
                heavy = calls or sum(isinstance(n, ast.BinOp) for _, n in walk(side)) > _ALONE
                if (len(letters(side)) > 1 or heavy) and not vanishes(side) and "sum" not in calls:
                    others = {name: tree for name, tree in values.items() if name not in (left, *called)}
                    tree = self._with_one_force(order, k, solved_for(side))
                    self.claims[order, k] = Claim(
                        scope="", name=left, tree=tree, line=said.shown.line, about=about, case=0, values=others,
                        abouts=called | {_SUM: "resulting force"}, owned=whose,
                        ruled_out=_ruled_out(said.before, paper.prose),
                        whole=said.about if said.about.startswith(about) else "",
                        parameters=tuple(called), from_top=from_top,
                        written={name: tree for name, tree in values.items() if name not in (left, *solved)},
                    )  # fmt: skip
        names = {k for claim in self.claims.values() for k in (*letters(claim.tree), claim.name)}
        names |= {word for name in names for word in called.get(name, "").split()}
        touched = [v for v in may_be if v.touches(names) and not self._contradicts(v.theory)]
        self.neighbours = Neighbours([*self.claims.values()], touched, si=True)

    def _owned(self) -> dict[str, str]:
        # the sun receives the torque T_1: the sun torque
        paper = self.world.paper
        letter_of = {printed: k for said in paper.said for k, printed in said.spelled.items()}
        return {letter_of[printed]: words for printed, words in owned(paper.prose) if printed in letter_of}

    def _with_one_force(self, order: int, side: int, tree: Node) -> Node:
        # (F - m a) sin psi: what a theory calls a force may be a sum of several
        factors = [product.left for _, product in walk(tree) if is_operation(product, ast.Mult, ast.Div)]
        sums = [n for n in factors if is_operation(n, ast.Add, ast.Sub)]
        summed = next((n for n in sums if kind_in(self.world.kinds, n) == of_unit("N")), None)
        if summed is None:
            return tree
        self.sums[order, side] = summed
        return substitute(tree, lambda n: name_of(_SUM) if n is summed else None)

    def _contradicts(self, theory: Theory) -> bool:
        # of another mechanism: by a word, or by its stroke of four throws, where that of the theory is two
        prose = self.world.paper.prose.lower()
        if theory.rods and _FROM_BOTTOM.search(prose):
            return True
        for meaning, said in theory.words.items():
            for one in self.world.defined if not meaning.isidentifier() else ():
                phrase = self.world.paper.called.get(one.letter, "").split()
                if any(word in phrase for word in said if len(word) > 2):
                    tree = ast.parse(meaning, mode="eval").body
                    if {*letters(tree)} == {*letters(one.tree)} and to_python(tree) != to_python(one.tree):
                        values = {name: 0.7 + 0.1 * k for k, name in enumerate(letters(tree))}
                        first, second = (float(evaluate(t, values, FLOATS)) for t in (tree, one.tree))
                        return abs(first - second) > 1e-9 * abs(first)
        return self._turns_its_ratio(theory)

    def _turns_its_ratio(self, theory: Theory) -> bool:
        # whether a ratio of two speeds is the other way round than in a theory
        named = [d.tree for d in self.world.defined if "ratio" in self.world.phrase(d.letter)]
        own = [ratio for tree in named if (ratio := _ratio_of_speeds(theory, tree)) is not None]
        its = [m for m, said in theory.words.items() if m not in theory.letters and _TRANSMISSIONS & {*said}]
        return any(
            alike(states(theory), ratio, read_expression(meaning, (), AnyLetter())[0]) is False
            for ratio, meaning in product(own, its)
        )

    def outcome(self, order: int, side: int) -> Row | None:
        """What theories say of one side of an equation; None where they say nothing."""
        if (order, side) not in self.outcomes:
            claim = self.claims.get((order, side))
            row = self.neighbours.outcome(claim) if claim is not None and self.neighbours is not None else None
            row = row if row is not None and row["verdict"] in ("agrees", "misprint") else None
            if row and claim and row["verdict"] == "misprint" and self._counts_several(order, claim.tree, row):
                row = None
            if row is not None and (order, side) in self.sums:
                written = f"({to_python(self.sums[order, side])})"
                row = row | {key: row[key].replace(_SUM, written) for key in ("correction", "note") if row.get(key)}
            self.outcomes[order, side] = row
        return self.outcomes[order, side]

    def _counts_several(self, order: int, tree: Node, row: Row) -> bool:
        # z cylinders with two pistons each, the displacement of an engine of four: what is blamed is what is said
        prose, before = self.world.paper.prose, self.world.paper.said[order].before.rstrip("$ \n")
        counts = {_COUNTS[said.lower()] for said in _EACH_HAS.findall(before)}
        if _OF_ALL.search(before):
            counts |= {_COUNTS[said.lower()] for said in _CYLINDERS.findall(prose)}
        if not counts:
            return False
        right = read_expression(row["correction"], (), AnyLetter())[0]
        values = {name: 0.7 + 0.1 * k for k, name in enumerate({*letters(tree), *letters(right)})}
        first, second = (float(evaluate(t, values, FLOATS)) for t in (tree, right))
        return any(abs(first - count * second) < 1e-9 * abs(first) for count in counts)

    def agrees(self, order: int) -> bool:
        """Whether an equation is exactly what its words say in every form."""
        rows = [self.outcome(order, k) for k in range(1, len(self.world.paper.said[order].sides))]
        return all(row and row["verdict"] == "agrees" and row.get("passed", "exact") == "exact" for row in rows)

    def is_suspect(self, letter: str, order: int) -> bool:
        """Whether another equation defines a letter, and is a slip away from what its own words say."""
        own = [d for d in self.world.defined if d.letter == letter and d.order != order]
        rows = [self.outcome(d.order, d.side) for d in own if d.side]
        return any(row is not None and row["verdict"] == "misprint" for row in rows)

    def in_own_letters(self, right: Node, printed: Node) -> Node:
        """A form in which what was put in for letters of an equation stands under these letters again."""
        values = {d.letter: d.tree for d in reversed(self.world.defined)}
        known: dict[str, str] = {}
        for letter in (n for n in letters(printed) if n in values):
            within = substitute(values[letter], lambda n: values.get(n.id) if isinstance(n, ast.Name) else None)
            known |= {ast.dump(values[letter]): letter, ast.dump(within): letter}
        for _ in known:
            right = substitute(right, lambda n: name_of(known[ast.dump(n)]) if ast.dump(n) in known else None)
        return right

    def blamed_on(self, letter: str) -> Iterator[tuple[int, Node, Node, str]]:
        """Equations that another meaning of a letter would mend: place, what is printed, what is wanted, of what."""
        for (order, side), claim in self.claims.items():
            row = self.outcome(order, side) if letter in letters(claim.tree) and claim.name != letter else None
            if row is not None and row["verdict"] == "misprint":
                right = read_expression(row["correction"], (), AnyLetter())[0]
                if letter not in letters(right):
                    yield order, claim.tree, right, row["claim"]


def _ratio_of_speeds(theory: Theory, tree: Node) -> Node | None:
    # omega2/omega1 in the letters of a theory, which may count turns; None where it is no such ratio
    known = {n.replace("_", ""): n for n in (*theory.letters, *theory.tape)}
    meant = {n: known.get(n) or known.get(_SPEED.sub("n", n)) or "" for n in letters(tree) if _SPEED.match(n)}
    ratio = is_operation(tree, ast.Div) and len(meant) == len(letters(tree)) == 2
    return renamed(tree, meant) if ratio and all(meant.values()) else None


def _ruled_out(before: str, prose: str) -> tuple[str, ...]:
    """What names of quantities have that a text speaks against, or nothing in it says, as that springs stand side by
    side.
    """
    rows = re.search(r"\b(?:series|one behind the other|in a row|add up)\b", prose, re.IGNORECASE)
    beside = re.search(r"\b(?:parallel|side by side)\b", prose, re.IGNORECASE)
    kinds = ["parallel"] if rows and not beside else ["series"] if beside and not rows else []
    other = _other_kind(before, prose)
    return (*kinds, *([other] if other else []))


def _other_kind(before: str, prose: str) -> str:
    """What names of quantities have that a text speaks against: of a disc that it is a ring, of a ring that it is a
    disc, and of engines with two strokes and with four the kind that the sentence in front of an equation does not
    name, or that a text never names; of what is no engine all of these.
    """
    last = re.split(r"[.;]\s", before.strip())[-1]
    if re.search(r"\b(?:disc|disk|solid cylinder)\b", last, re.IGNORECASE):
        return "thin_ring"
    if re.search(r"\b(?:rim|ring|hoop)\b", last, re.IGNORECASE):
        return "cylinder"
    for words in (last, prose):
        named = {word.lower() for word in re.findall(r"\b(two|four)[- ]stroke", words, re.IGNORECASE)}
        if named:
            return {"two": "four_stroke", "four": "two_stroke"}[named.pop()] if len(named) == 1 else ""
    return "" if re.search(r"\b(?:engines?|diesel|motors?|otto)\b", prose, re.IGNORECASE) else "_stroke"
