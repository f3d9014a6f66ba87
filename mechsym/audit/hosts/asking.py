"""What a search for one slip tells of an equation of a text, and when that is a misprint."""

import ast
import re
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from mechsym.audit.hosts.judged import Judged
from mechsym.audit.judge import misfits as of_units
from mechsym.audit.judge.asked import Asked
from mechsym.audit.judge.forms import has_nothing, has_sense, spelled
from mechsym.audit.judge.sampled import free, where_defined
from mechsym.audit.judge.world import World
from mechsym.audit.read.reader import AnyLetter, read_expression
from mechsym.audit.read.said import Said
from mechsym.audit.read.spelling import to_latex, to_python
from mechsym.audit.read.tree import Node, letters
from mechsym.audit.row import Row, answer
from mechsym.audit.theory.record import Theory
from mechsym.audit.theory.tape import retaped
from mechsym.errors import BadInput

_PUT_BACK = re.compile("repaired by (?:put back|letter)")
#: A slip by which a letter is lost that stands beside what is printed
BESIDE = re.compile(r"repaired by put back: (.+) becomes \1[*/]\w+(?:\*\*\d)?")


@dataclass
class Asking:
    """Searches for slips, of which a text has a number; what they find is believed for the equations behind."""

    world: World
    odd: Mapping[str, list[of_units.Odd]]
    searches: int  #: That are left, each of which takes long [-]
    wrong: dict[str, tuple[str, Node, Node]] = field(default_factory=dict)  #: Letter to its equation, printed and right

    def compared(self, theory: Theory, left: Node, right: Node, said: Said) -> Row | None:
        """What the search says of an expression that is to be another one; None where it says nothing."""
        claimed = "claimed"
        tape = retaped(theory.tape, {claimed: left}, theory.letters, theory.angle)
        grown = replace(theory, tape=tape, results=(*theory.results, claimed))
        row = self.asked(where_defined(grown, left), claimed, right, {}, said)
        more = row is not None and "put back" in row["note"] and free(theory, right) - free(theory, left)
        return None if more else row  # with a letter that what is put back takes away it is of another model

    def asked(self, theory: Theory, quantity: str, tree: Node, meant: Mapping[str, str], said: Said) -> Row | None:
        """What the search says of a formula of a quantity of a theory, its letters meant as given."""
        if self.searches <= 0:
            return None
        self.searches -= 1
        asked = Asked(
            text=to_python(tree), against=f"{theory.name}.{quantity}", given=theory, name=said.name,
            claim="approx" if said.claim else "", letters={k: v for k, v in meant.items() if k != v},
        )  # fmt: skip
        try:
            return answer(asked, one=True)
        except (BadInput, KeyError):  # of a broken text a letter that nothing gives a value
            return None

    def finding(self, row: Row, said: Said, side: Node, matched: str) -> Judged | None:
        """The misprint that a row tells; None where one slip does not explain it, or another model does."""
        if row["verdict"] != "misprint" or not row["correction"] or ", then by " in row["note"]:
            return None
        right = read_expression(row["correction"], (), AnyLetter())[0]
        if has_nothing(right):
            return None
        if "repaired by left out" in row["note"] and of_units.id_of(said) not in self.odd:
            if not set(letters(self.world.plain(side))) <= set(letters(right)):
                return None  # with a letter more it may be of another model
        beside = BESIDE.search(row["note"]) and set(letters(right)) <= set(letters(self.world.plain(side)))
        lost = _PUT_BACK.search(row["note"]) and not has_sense(self.world, said)
        if lost and of_units.id_of(said) not in self.odd and not beside:
            return None  # what is left out may be 1 there; with a unit, or beside itself, it cannot
        left = said.sides[0].id if isinstance(said.sides[0], ast.Name) else ""
        if left:
            self.wrong[left] = (said.name, self.world.plain(side), right)
        return Judged(
            verdict="misprint", matched=matched, note=row["note"], error=row["max_rel_error"],
            correction=to_latex(right, spelled(self.world, said)),
        )  # fmt: skip
