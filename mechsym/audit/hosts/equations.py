"""The verdict of an equation of a text: by a theory that fits, by what the text says elsewhere, by its units."""

import ast
import re
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from mechsym.audit.hosts.asking import BESIDE, Asking
from mechsym.audit.hosts.carried import believed, carried, follows
from mechsym.audit.hosts.energy_slip import EnergySlip, energy_slip
from mechsym.audit.hosts.judged import AGREES, UNTOLD, Judged, of_other_left, passed, settled
from mechsym.audit.hosts.paper import CARRIED, DEFINED
from mechsym.audit.hosts.worded import Worded
from mechsym.audit.judge import fit as fitting
from mechsym.audit.judge import misfits as of_units
from mechsym.audit.judge.following import CUT_SHORT, expected, implied_by, solved
from mechsym.audit.judge.forms import (
    are_told,
    has_nothing,
    has_sense,
    is_another,
    is_one_of_several,
    is_still,
    known,
    readings,
    spelled,
    steady,
)
from mechsym.audit.judge.lagrangian import Energies
from mechsym.audit.judge.linear import with_frequency
from mechsym.audit.judge.primes import by_angle, is_slope, primed
from mechsym.audit.judge.resultants import squares_of_sums
from mechsym.audit.judge.sampled import alike, free, is_multiple, states, vanishes
from mechsym.audit.judge.solving import isolate
from mechsym.audit.judge.twins import Twins
from mechsym.audit.judge.world import World
from mechsym.audit.read.reader import AnyLetter, read_expression
from mechsym.audit.read.said import Said
from mechsym.audit.read.slopes import Slope
from mechsym.audit.read.spelling import to_latex
from mechsym.audit.read.tree import Node, function_of, is_operation, letters, negative, value_of
from mechsym.audit.theory.record import Theory
from mechsym.audit.theory.tape import minus, plus
from mechsym.audit.verdict import FINDINGS, PASSED
from mechsym.errors import BadInput

_CASE = re.compile(
    r"(?:^|[.:]\s)\s*(?:For|In|Under|During)\s[^,.:$]*,"  # for method B, it is
    r"|\b(?:if|when|whenever|otherwise|unless|else)\b|\\(?:leq?|geq?|lt|gt|ll|gg)(?![A-Za-z])|(?<!\w)[<>](?=\s)"
)
_OTHER_CASE = re.compile(
    r"\b(?:type|case|variant|version|option|method)\s(?:\d|[ivx]+\b|[a-c]\b)|\b(?:doubl|halv|tripl)\w+|\binstead\b",
    re.IGNORECASE,
)
_NEXT_COLUMN = re.compile(r"\$\$?\s*\|\s*\$\$?\s*$")
_NEARLY = 0.1  # what is cut short is off by at the most, of its largest value [-]


@dataclass
class Judge:
    """Judges the equations of a text in their order; a slip is believed mended for those behind it."""

    world: World
    fits: Sequence[fitting.Match]
    agreeing: set[str]
    worded: Worded
    energies: Energies
    twins: Twins
    asking: Asking
    paired: set[int] = field(default_factory=set)  #: Sides of the last equation that the text told of
    slip: EnergySlip | None = field(init=False)  #: Of an energy, where that explains the equations of motion

    def __post_init__(self) -> None:
        """What a slip of an energy explains is judged by what the energy should be."""
        self.slip = energy_slip(self.world, self.energies)
        self.energies = self.slip.energies if self.slip else self.energies

    def verdict(self, order: int, said: Said) -> Judged:
        """The verdict of an equation: a theory that fits, the text itself, its units.

        What the equation in front of it gives is right by that one, whatever stands farther off.
        """
        judged = self._verdict(order, said)
        by_text = judged.verdict == "misprint" and judged.matched == "the text"
        source = implied_by(self.world, order) if by_text else None
        name = "" if source is None else self.world.paper.said[source].name
        if not name or any(name == blamed for blamed, *_ in self.asking.wrong.values()):
            return judged
        return Judged(verdict="exact", matched="the text", note=f"follows from ({name})", error=0.0)

    def _verdict(self, order: int, said: Said) -> Judged:
        odd = self.asking.odd.get(of_units.id_of(said), ())
        met = self._met(order, said)
        if met is not None and not odd:
            # with other letters it may be right; by the text's own it is not
            own = self._by_text(order, said)
            return own if own.verdict == "misprint" else met
        if self.slip is not None and self.slip.order == order:
            follow = ", ".join(f"({name})" for name in self.slip.follow)
            right = to_latex(self.slip.right, spelled(self.world, said))
            return Judged(verdict="misprint", matched="the text", note=f"without it {follow} follows", correction=right)
        if (of_motion := self._by_energies(order, said)) is not None:
            return of_motion
        if (squares := squares_of_sums(self.world, order, said)) is not None:
            return Judged(
                verdict="misprint", matched="the text", correction=to_latex(squares, said.spelled),
                note="the squares belong outside the sums: so the resultant has the size that stands beside it",
            )  # fmt: skip
        if (left := of_other_left(self.twins, order)) is not None:
            return left
        own = self._by_text(order, said)
        if own.verdict in (*FINDINGS, CARRIED) or own.verdict not in ("", DEFINED) and not odd:
            # of a chain the text may tell of one form only
            untold = [k for k in range(1, len(said.sides)) if k not in self.paired] if own.verdict in PASSED else []
            slip = self._by_words(order, said, untold) if untold and len(said.sides) > 2 else None
            return slip if slip is not None and slip.verdict == "misprint" else own
        if odd:
            slip, telling = self._by_words(order, said), {"misprint", "exact" if is_another(self.world, said) else ""}
            if slip is not None and slip.verdict in telling:
                return slip  # which mends the units, too
            return Judged(verdict="wrong", matched="units", note="; ".join(dict.fromkeys(o.why for o in odd)))
        for fit in self.fits:
            if (slip := self._slip(fit, order, said)) is not None:
                return slip
        behind = (self._by_its_frequency, self._by_later)
        for way in (self._by_solving, self._by_what_is_before, self._by_words, self._by_twin, *behind):
            if (judged := way(order, said)) is not None:
                return judged
        if of_units.id_of(said) in self.agreeing:
            return Judged(verdict=AGREES, matched="units", note=own.note)
        return own if own.verdict else UNTOLD

    def _met(self, order: int, said: Said) -> Judged | None:
        for fit in self.fits:
            met = [fit.met[order, k] for k in range(1, len(said.sides)) if (order, k) in fit.met]
            if met and len(met) == len(said.sides) - 1:
                against = f"{fit.theory.name}.{met[0].quantity}"
                if all(m.sign > 0 for m in met):
                    exact = Judged(verdict="exact", matched=against, error=0.0)
                    return carried(self.world, self.asking, order, said, exact)
                if has_sense(self.world, said):
                    continue
                return Judged(verdict="convention", matched=against, note="exact with the opposite sense")
        return None

    def _by_energies(self, order: int, said: Said) -> Judged | None:
        # an equation of motion, or what stands before an acceleration in one, by the energies of the text
        if said.law is not None:
            why = "Lagrange's equation: " + (
                "what follows from the text's energies by it is compared with what stands there"
                if self.energies.laws
                else "the text prints no energies that it can be told of"
            )
            return Judged(verdict=DEFINED, note=why)
        if not self.energies.laws or len(said.sides) != 2:
            return None
        theory = self.world.theory(order)
        sides = [by_angle(known(self.world, side, theory), theory) for side in said.sides]
        if not self.energies.tells(order, theory, sides):
            return None
        matched = "the text's energies"
        if self.energies.holds(order, theory, sides):
            return Judged(verdict="exact", matched=matched, error=0.0)
        for letter, (source, _, right) in self.asking.wrong.items():
            if self.energies.holds(order, self.world.theory(order, {letter: right}), sides):
                return Judged(verdict="exact", matched=matched, error=0.0, note=f"with ({source}) as corrected")
        printed, wanted, beside = self.energies.wanted(order, theory, sides)
        # one slip away from what the energies give; what is cut short is none
        for tree in wanted if not CUT_SHORT.search(said.before) else ():
            row = self.asking.compared(theory, tree, printed, said)
            if row is not None and (slip := self.asking.finding(row, said, printed, matched)):
                right = read_expression(row["correction"], (), AnyLetter())[0]
                right = minus(right, beside.operand) if isinstance(beside, ast.UnaryOp) else plus(right, beside)
                return replace(slip, correction=to_latex(right, spelled(self.world, said)))
        return None

    def _by_words(self, order: int, said: Said, sides: Sequence[int] = ()) -> Judged | None:
        # by what the letters are called, as in a program
        short = bool(said.claim or CUT_SHORT.search(said.before))
        agreed: Judged | None = None
        for k in sides or range(1, len(said.sides)):
            row = self.worded.outcome(order, k) if self.asking.searches > 0 else None
            self.asking.searches -= row is not None and row["verdict"] != "agrees"
            if row is None or row["verdict"] == "misprint" and short and row["max_rel_error"] < _NEARLY:
                continue
            if row["verdict"] == "agrees":
                verdict, error = row.get("passed", "exact"), row.get("max_rel_error", 0.0)
                if row.get("order") == 1 and not short:
                    continue  # so short it may be another thing of that name
                agreed = agreed or Judged(verdict=verdict, matched=row["claim"], note=row.get("note", ""), error=error)
                continue
            right = self.worded.in_own_letters(read_expression(row["correction"], (), AnyLetter())[0], said.sides[k])
            if has_nothing(right):
                continue
            gone = [n for n in letters(said.sides[k]) if n not in letters(right)]
            if wrong := [n for n in gone if n in self.asking.wrong]:
                return follows(self.asking, wrong)
            own = "repaired by letter" not in row["note"] and any(self.worded.is_suspect(n, order) for n in gone)
            grown = not {*letters(right)} <= {*letters(said.sides[k])}
            lost = "repaired by put back" in row["note"] and grown and not BESIDE.search(row["note"])
            if own or lost and of_units.id_of(said) not in self.asking.odd:
                continue  # the slip is one of that letter's own equation; what is left out may be 1 there
            if isinstance(said.sides[0], ast.Name):
                printed, mended = self.world.plain(said.sides[k]), self.world.plain(right)
                self.asking.wrong[said.sides[0].id] = (said.name, printed, mended)
            elif isinstance(right, ast.Call) and function_of(right) == f"a{function_of(said.sides[0])}":
                right = right.args[0]  # of tan(x) what stands on its right
            elif is_operation(right, ast.Div) and value_of(right.left) == 1:
                right = right.right  # what stands on the right of 1/E
            return Judged(
                verdict="misprint", matched=row["claim"], note=row["note"], error=row["max_rel_error"],
                correction=to_latex(right, spelled(self.world, said)),
            )  # fmt: skip
        return agreed

    def _by_later(self, order: int, said: Said) -> Judged | None:
        # a definition with which two later equations miss what their words say by the same slip of this one
        own = next((d for d in self.world.defined if d.order == order and d.side), None)
        if own is None or len(said.sides) != 2 or said.claim:
            return None
        slips: dict[int, Judged] = {}
        for place, printed, right, against in self.worded.blamed_on(own.letter):
            meant = isolate(self.world.plain(printed), own.letter, self.world.plain(right))
            row = None if meant is None else self.asking.compared(self.world.bare, meant, own.tree, said)
            slip = None if row is None else self.asking.finding(row, said, said.sides[1], against)
            slips |= {} if slip is None else {place: slip}
        if len(slips) < 2 or len({slip.correction for slip in slips.values()}) > 1:
            self.asking.wrong.pop(own.letter, None)
            return None
        others = ", ".join(dict.fromkeys(f"({self.world.paper.said[place].name})" for place in slips))
        return replace(slips[min(slips)], matched="the text", note=f"without it {others} is what its words say")

    def _by_its_frequency(self, order: int, said: Said) -> Judged | None:
        # an equation of motion whose frequency stands behind it, and is what its words say
        printed = self.world.plain(said.sides[0])
        for place, wanted in with_frequency(self.world, order):
            row = self.asking.compared(self.world.bare, wanted, printed, said) if self.worded.agrees(place) else None
            if row is not None and (slip := self.asking.finding(row, said, said.sides[0], "the text")):
                return replace(slip, note=f"({self.world.paper.said[place].name}) is its frequency; {slip.note}")
        return None

    def _by_solving(self, order: int, said: Said) -> Judged | None:
        # what the equation before it gives, where a word says that this is it
        follows = solved(self.world, order)
        if follows is None:
            return None
        theory, (tree, place) = self.world.theory(order), follows
        both = known(self.world, tree, theory), known(self.world, said.sides[1], theory)
        wanted, printed = next(readings(self.world, *both, theory))
        source = self.world.paper.said[place].name
        try:
            at = states(steady(self.world, theory, said))
            if alike(at, wanted, printed):
                return Judged(verdict="exact", matched="the text", note=f"follows from ({source})", error=0.0)
            if alike(at, wanted, negative(printed)):
                mended = to_latex(negative(said.sides[1]), spelled(self.world, said))
                return Judged(
                    verdict="misprint", matched="the text", note=f"({source}) gives the other sign", correction=mended
                )
        except (BadInput, KeyError, RecursionError):
            return None
        row = self.asking.compared(theory, wanted, printed, said)
        return None if row is None else self.asking.finding(settled(row), said, said.sides[1], "the text")

    def _by_what_is_before(self, order: int, said: Said) -> Judged | None:
        slips = []
        for one in expected(self.world, order) if not self.worded.agrees(order) else ():
            theory = self.world.theory(order) if one.whole else self.world.bare
            try:
                if (is_multiple if one.scaled else alike)(states(theory), one.printed, one.tree):
                    return Judged(verdict="exact", matched="the text", note=one.note, error=0.0)
            except (BadInput, KeyError, RecursionError):
                continue
            slips.append((theory, one))
        for theory, one in slips:
            row = self.asking.compared(theory, one.tree, one.printed, said)
            slip = self.asking.finding(settled(row), said, said.sides[not one.scaled], "the text") if row else None
            if slip or row and row["verdict"] in PASSED:  # what is cut short is no slip
                return slip
        return None

    def _by_twin(self, order: int, said: Said) -> Judged | None:
        # x_2 by x_1: of two that no theory knows the later one is told of
        slip = self.twins.slip(order)
        sure = slip is not None and any((slip[1], 1) in fit.met for fit in self.fits)
        if slip is None or not sure and (slip[1] > order or self.world.paper.said[slip[1]].section != said.section):
            return None
        twin = self.world.paper.said[slip[1]].name
        note = f"its twin ({twin}) has another form" + ": one of both has a slip" * (not sure)
        mended = to_latex(slip[0], spelled(self.world, said))
        return Judged(verdict="misprint", matched="the text", note=note, correction=mended)

    def _slip(self, fit: fitting.Match, order: int, said: Said) -> Judged | None:
        # one slip away from the quantity that the text's words name, in letters that are all known
        for k, side in enumerate(said.sides[1:], 1):
            tree = self.world.plain(side)
            used = [n for n in letters(tree) if n != "pi"]
            if (order, k) in fit.met or not used or len(used) < 2 or vanishes(tree):
                continue
            partners = [fit.met[order, j].quantity for j in range(1, len(said.sides)) if (order, j) in fit.met]
            for quantity in partners or fitting.candidates(fit, said, self.world):
                for reading in fitting.readings(fit, self.world, used):
                    against = f"{fit.theory.name}.{quantity}"
                    row = self.asking.asked(fit.theory, quantity, tree, reading, said)
                    by_factor = row is not None and "repaired by factor" in row["note"]
                    if by_factor and not are_told(self.world, tree, fit.meant):
                        continue  # the m of a text may be of both pistons, or of one
                    if row is not None and (slip := self.asking.finding(row, said, side, against)):
                        return slip
                    if row is not None and row["verdict"] in PASSED:
                        return passed(row, against)
        return None

    def _by_text(self, order: int, said: Said) -> Judged:
        own = next((d for d in self.world.defined if d.order == order), None)
        first = own.side if own else 0
        # an equation says nothing of what it defines, and of what it was solved with
        others = [k for k in range(1, len(said.sides)) if own is None or k not in (own.side, own.against)]
        if _NEXT_COLUMN.search(said.before):
            others = []  # of another case
        if own is None and _CASE.search(said.before.rstrip("$[\\ \n").rpartition("\n\n")[2]):
            first, others = 1, others[1:]  # what an earlier equation says holds elsewhere
        if not others or is_one_of_several(self.world, said):
            nothing = own is None and bool(others)  # of one of several that hold together
            return Judged(verdict="" if nothing else DEFINED, note=f"the text's own {own.letter}" if own else "")
        # a rate of what the text defines is held against the formula, not the other way round
        slopes = [k for k in others if own is not None and is_slope(said.sides[k])]
        said_all = [self._pair(order, said, *((k, first) if k in slopes else (first, k))) for k in others]
        worst = next((v for v in said_all if v.verdict in (*FINDINGS, CARRIED)), None)
        if worst is not None:
            return worst
        self.paired = {first, *(k for k, v in zip(others, said_all, strict=True) if v.verdict)}
        verdicts = [v for v in said_all if v.verdict]
        if verdicts:
            return carried(self.world, self.asking, order, said, max(verdicts, key=lambda v: PASSED.index(v.verdict)))
        return Judged(verdict=DEFINED if own else "", note=f"the text's own {own.letter}" if own else "")

    def _pair(self, order: int, said: Said, i: int, k: int) -> Judged:
        nothing = Judged(verdict="")
        theory = self.world.theory(order)
        own = getattr(said.sides[i], "id", "")
        if any(
            d.order > order and own in letters(d.tree) for d in self.world.defined if d.letter in letters(said.sides[k])
        ):
            return nothing  # which is solved for that letter later
        left, right = known(self.world, said.sides[i], theory), known(self.world, said.sides[k], theory)
        if value_of(right) == 0 and value_of(left) is None and not (free(theory, left)):
            return nothing
        if any(is_still(self.world, n) for n in {*letters(left), *letters(right)}):
            return nothing
        for first, second in readings(self.world, left, right, theory):
            try:
                same = alike(states(steady(self.world, theory, said)), first, second)
            except (BadInput, KeyError, RecursionError):
                return nothing
            if same:
                if ast.dump(first) == ast.dump(second):
                    return nothing
                return Judged(verdict="exact", matched="the text", error=0.0)
        return self._unlike(order, said, i, k, theory)

    def _is_of_case(self, order: int, left: Node, note: str) -> bool:
        # of a letter that is given anew, with a term more, or with another number where words tell of another case
        said = self.world.paper.said[order]
        if not isinstance(left, ast.Name):
            return False
        before = [one.sides[0] for one in self.world.paper.said[:order] if len(one.sides) == 2 and not one.inline]
        again = any(isinstance(one, ast.Name) and one.id == left.id for one in before)
        number = again and "repaired by factor" in note and _OTHER_CASE.search(said.before) is not None
        return "left out" in note or number

    def _unlike(self, order: int, said: Said, i: int, k: int, theory: Theory) -> Judged:
        nothing = Judged(verdict="")
        left, right = known(self.world, said.sides[i], theory), known(self.world, said.sides[k], theory)
        by = "{}_d" if f"{self.world.angle}d" in letters(right) else Slope("{}", self.world.angle).name
        left, right = primed(left, by, theory), primed(right, by, theory)
        first, second = free(theory, left), free(theory, right)
        if not first and (isinstance(said.sides[i], ast.Name) or value_of(said.sides[i]) is not None):
            return nothing  # a letter has this value somewhere, or is to be found for it
        circular = isinstance(left, ast.Name) and left.id in second
        if not (first <= second or second <= first or circular) or not second or value_of(right) == 0:
            return nothing
        if isinstance(left, ast.Name) and left.id in theory.letters and not circular:
            return nothing
        if (carry := believed(self.world, self.asking, order, said, (i, k))) is not None:
            return carry
        # of a chain the slip may stand in the earlier form
        for wanted, printed, side in ((left, right, k), (right, left, i))[: 1 + (i > 0)]:
            row = self.asking.compared(theory, wanted, printed, said)
            if row is not None and row["verdict"] in PASSED:
                return passed(row, "the text")
            # a letter that is given anew, with a term more or another number, is one of another case; F = F_x + F_y
            # may be of vectors, whose size the root of their squares is
            how = row["note"] if row is not None else ""
            if "repaired by squares" in how or how and self._is_of_case(order, said.sides[i], how):
                continue
            row = settled(row) if row is not None and has_sense(self.world, said) else row
            if row is not None and (slip := self.asking.finding(row, said, said.sides[side], "the text")):
                return slip
        return nothing
