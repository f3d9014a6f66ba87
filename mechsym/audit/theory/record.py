"""The record of a theory, made from sympy expressions: what printed formulas are compared with."""

import ast
from collections.abc import Iterable, Mapping
from dataclasses import field, replace
from fractions import Fraction
from functools import partial

import mpmath
import numpy as np

from mechsym.audit.read.algebra import DIGITS, FLOATS, SYMBOLS, Algebra, Values, evaluate
from mechsym.audit.read.reader import CONSTANTS, read_expression
from mechsym.audit.read.tree import Node, children, function_of, letters, walk
from mechsym.audit.theory.ranges import harmonic, ranged
from mechsym.audit.theory.tape import Entry, Harmonic, Ranged, Root, TheoryTape, needed, slope_by
from mechsym.errors import BadInput
from mechsym.quantities import dimension, record

_STEPS = 60


def root(entry: Root, names: dict[str, Values], algebra: Algebra) -> Values:
    """Values of the unknown at all states, in its unit; nan where Newton's method does not converge."""
    if algebra is SYMBOLS:
        raise BadInput("a root of an equation is decided by its digits alone")
    slope = slope_by(entry.equation, entry.unknown)
    start = evaluate(entry.start, names, algebra)
    floats = {k: np.asarray(v, dtype=float) for k, v in names.items()}
    solution = _newton(entry, slope, floats, np.asarray(start, dtype=float), FLOATS, _STEPS)
    if algebra is FLOATS:
        return solution
    steps = 2 + int(np.log2(max(mpmath.mp.dps / 14, 1)) + 1)
    digits = np.array([mpmath.mpf(float(v)) for v in np.atleast_1d(solution)])
    return _newton(entry, slope, names, digits, DIGITS, steps)


def _newton(entry: Root, slope: Node, names: dict[str, Values], value: Values, algebra: Algebra, steps: int) -> Values:
    divide = algebra.operations[ast.Div]
    for _ in range(steps):
        now = {**names, entry.unknown: value}
        step = divide(evaluate(entry.equation, now, algebra), evaluate(slope, now, algebra))
        value = value - step
        if algebra is FLOATS and not np.any(np.abs(step) > 1e-15 * (1 + np.abs(value))):
            break
    if algebra is FLOATS:
        left = np.abs(evaluate(entry.equation, {**names, entry.unknown: value}, algebra))
        value = np.where(left < 1e-9 * (1 + np.max(np.where(np.isfinite(left), left, 0.0))), value, np.nan)
    return value


@record
class Letter:
    """A letter with its unit, the value that its source gives it, and where it may lie."""

    unit: str  #: SI unit, `"-"` for a pure number
    value: float  #: Value in the source's data, or a plausible one where it prints none [unit]
    #: `positive`, `any`, or by the unit: lengths, masses, pressures, temperatures and numbers are positive
    sign: str = ""
    domain: tuple[float, float] | None = None  #: Ends of the range, where it is known [unit]

    @property
    def positive(self) -> bool:
        """Whether it is never negative."""
        if self.domain:
            return self.domain[0] >= 0
        if self.sign or self.value < 0 or self.unit.startswith("rad"):
            return self.sign == "positive"
        mass, length, time, kelvin = dimension(self.unit)
        return time == 0 or kelvin != 0 or (mass, length, time) == (1, -1, -2)


def letters_of(text: str) -> dict[str, Letter]:
    """Letters of a table with name, value and unit of each: `B 0.06 m; p 9.6e6 Pa`."""
    rows = (line.split() for line in text.split(";"))
    return {name: Letter(unit=unit, value=float(value)) for name, value, unit in rows}


@record
class Theory:
    """Letters and a tape of derived expressions in them."""

    name: str  #: Name before the dot in `crosshead.inertia`
    letters: Mapping[str, Letter]
    #: Named expressions in letters and earlier names; a tuple has one value per part (per journal)
    tape: Mapping[str, Entry]
    results: tuple[str, ...]  #: Names on the tape that formulas may claim to be
    units: Mapping[str, str] = field(default_factory=dict)  #: Units of names on the tape, where known
    angle: str = ""  #: Letter that runs over a turn, empty when nothing turns
    rods: tuple[str, ...] = ()  #: Lengths that grow without limit when lambda goes to zero
    small: tuple[str, ...] = ()  #: Numbers that go to zero as lambda does
    #: What a source may take for granted: words to the letters that vanish then
    conditions: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    data: str = ""
    words: Mapping[str, tuple[str, ...]] = field(default_factory=dict)  #: What programs call letters and quantities
    #: Random states that were drawn before, which questions of one theory share
    states: dict[tuple[object, ...], Mapping[str, list[Fraction]]] = field(
        default_factory=dict, init=False, repr=False, compare=False
    )

    def __post_init__(self) -> None:
        """Every name gets its slopes, rates and harmonics."""
        if not isinstance(self.tape, TheoryTape):
            object.__setattr__(self, "tape", TheoryTape(self.tape, self.letters, self.angle))


def complete(theory: Theory, names: dict[str, Values], wanted: Iterable[str], algebra: Algebra) -> None:
    """Add the values of those names on the tape that are wanted."""
    for wish in wanted:
        if wish in names or wish not in theory.tape:
            continue
        entry = theory.tape[wish]
        if isinstance(entry, Harmonic):
            fill = partial(complete, theory, wanted=[entry.of], algebra=algebra)
            names[wish] = harmonic(entry, names, algebra, fill)
            continue
        complete(theory, names, needed(entry), algebra)
        if isinstance(entry, Ranged):
            inside = [k for k in letters(entry.of) if k != entry.by]
            names[wish] = ranged(entry, names, algebra, partial(complete, theory, wanted=inside, algebra=algebra))
            continue
        if isinstance(entry, Root):
            names[wish] = root(entry, names, algebra)
        elif isinstance(entry, tuple):
            names[wish] = np.stack(np.broadcast_arrays(*(evaluate(part, names, algebra) for part in entry)))
        else:
            names[wish] = evaluate(entry, names, algebra)


def dependencies(theory: Theory, wanted: Iterable[str]) -> set[str]:
    """Letters and names that the wanted ones are made of, themselves included."""
    reached, waiting = set(), list(wanted)
    while waiting:
        wish = waiting.pop()
        if wish in reached:
            continue
        reached.add(wish)
        if wish in theory.tape:
            waiting += needed(theory.tape[wish])
    return reached


def related(theory: Theory, quantity: str) -> list[str]:
    """Results that are made of no other letters than a quantity, itself left out."""
    own = dependencies(theory, [quantity]) & theory.letters.keys()
    results = [k for k in theory.results if k != quantity]
    return [k for k in results if dependencies(theory, [k]) & theory.letters.keys() <= own]


def parts(theory: Theory, tree: Node) -> bool:
    """Whether a letter with one value per part stands outside every sum()."""
    if isinstance(tree, ast.Name):
        return isinstance(theory.tape.get(tree.id), tuple)
    return function_of(tree) != "sum" and any(parts(theory, child) for _, child in children(tree))


def check_sums(theory: Theory, tree: Node) -> None:
    """Refuse a letter with parts outside sum(), and a sum() without one."""
    letters_with_parts = [k for k, entry in theory.tape.items() if isinstance(entry, tuple)]
    hint = f"letters of {theory.name} with one value per part: {', '.join(letters_with_parts) or 'none'}"
    if parts(theory, tree):
        raise BadInput(f"a letter that has one value per part stands outside sum(); {hint}")
    for _, node in walk(tree):
        if function_of(node) == "sum" and not parts(theory, dict(children(node))["argument"]):
            raise BadInput(f"sum() is over nothing that has parts; {hint}")


def known(theory: Theory) -> list[str]:
    """Letters that a formula may use: free letters, results, and names that have a unit."""
    named = [k for k in theory.tape if k in theory.units]
    return list(dict.fromkeys([*theory.letters, *theory.results, *named]))


def need_result(theory: Theory, quantity: str) -> None:
    """Refuse a quantity that the theory does not derive."""
    if quantity not in theory.tape:
        known = ", ".join(n for n in theory.results if not n.endswith("_"))
        beyond = "what hangs on a loop closed by constraint cannot be audited"
        raise BadInput(f"{theory.name} has no quantity {quantity!r}; it has {known}; {beyond}")


def extended(
    theory: Theory, new_name: str, more_letters: Mapping[str, Letter], expressions: Mapping[str, tuple[str, str]]
) -> Theory:
    """A theory with further letters and expressions, each with its unit, in the order of definition."""
    letters_now = {**theory.letters, **more_letters}
    tape = dict(theory.tape)
    for new, (text, _) in expressions.items():
        tape[new] = read_expression(text, [*letters_now, *tape, *CONSTANTS])[0]
    return replace(
        theory,
        name=new_name,
        letters=letters_now,
        tape=tape,
        results=(*theory.results, *expressions),
        units={**theory.units, **{k: unit for k, (_, unit) in expressions.items()}},
    )
