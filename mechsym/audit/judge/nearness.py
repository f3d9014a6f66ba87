"""Numbers of a formula in a theory's letters beside those of its quantities, at random states and over turns."""

from collections.abc import Iterator, Sequence

import numpy as np

from mechsym.audit.judge.dimensions import ANGLE, kind_of, kind_of_unit
from mechsym.audit.judge.fitted import Fitted
from mechsym.audit.judge.question import Question, drawn, float_values, used_names
from mechsym.audit.read import tree as trees
from mechsym.audit.read.algebra import FLOATS, Values, evaluate
from mechsym.audit.read.reader import Formula
from mechsym.audit.read.tree import letters
from mechsym.audit.theory.record import Theory, complete, dependencies
from mechsym.audit.theory.tape import BY_OTHERS, needed
from mechsym.errors import BadInput
from mechsym.quantities import record

_POINTS, _TURNS, _STEPS = 24, 4, 7  # states at which numbers are compared, and of turns
_SAME = 1e-9
# factors by which units differ: degrees, minutes, hours, days and years, inches and feet, thousands
_TIMES = (60.0, 3600.0, 86400.0, 31536000.0, 31557600.0)
_SCALES = (1.0, np.pi / 180, *_TIMES, 2 * np.pi, np.pi / 30, 12.0, 25.4, 0.3048, 25.4**2, 25.4**3)
_UNITS = tuple(
    sign * 10.0**n * scale**power
    for n in (-9, -6, -3, -2, -1, 0, 1, 2, 3, 5, 6, 9)
    for scale in _SCALES
    for power in (1, -1)
    for sign in (1.0, -1.0)
)


def at_rest(theory: Theory, form: Formula) -> tuple[str, ...]:
    """Letters that a formula does not have and that are 0 in many machines: an offset, the angular acceleration."""
    used = {m for tree in form.letters.values() for m in letters(tree)}
    offsets = [k for k, about in theory.letters.items() if about.unit == "m" and about.sign == "any"]
    rates = [f"{theory.angle}dd"] if theory.angle and f"{theory.angle}d" in used else []
    return tuple(k for k in (*offsets, *rates) if k not in used)


def shown_as(theory: Theory, quantity: str) -> str:
    """A quantity with its theory as users read it; a letter that others give is that letter."""
    return f"{theory.name}.{quantity.removesuffix(BY_OTHERS)}"


def of_same_letters(theory: Theory, form: Formula, quantity: str) -> bool:
    """Whether a formula has the letters that a quantity is made of, or names made of them, and no other."""
    used = {m for tree in form.letters.values() for m in letters(tree)} - {"pi"}
    reached: set[str] = set()
    waiting = [quantity]
    while waiting:
        wish = waiting.pop()
        if wish not in reached and (wish not in used or wish == quantity):
            reached.add(wish)
            waiting += needed(theory.tape[wish]) if wish in theory.tape else []
    lacking = reached & theory.letters.keys() - used - {*at_rest(theory, form)}
    return not lacking and used <= dependencies(theory, [quantity])


@record
class Nearness:
    """Numbers of a formula beside those of a quantity, at random states."""

    away: float  #: Largest difference by the quantity's largest size [-]
    ratio: float | None  #: Where the formula is the quantity times one number [-]
    shift: bool  #: Whether it is the quantity, of either sign, but for what does not turn


class Probes:
    """Random states of a theory, and turns of its angle from four of them, with the values of its names as needed."""

    def __init__(self, theory: Theory, rest: Sequence[str] = ()) -> None:
        self.theory = theory
        question = Question(formula=Formula(tree=trees.number(1)), theory=theory, quantity=theory.results[-1])
        draws = float_values(drawn(question, _POINTS, seed=5))
        self.random: dict[str, Values] = {"pi": np.pi, **draws}
        few = float_values(drawn(question, _TURNS, seed=6))
        turned = {k: np.repeat(v, _STEPS) for k, v in few.items()}
        if theory.angle:
            turned[theory.angle] = np.tile(np.linspace(0.3, 5.9, _STEPS), _TURNS)
        for letter in rest:
            self.random[letter], turned[letter] = np.zeros(_POINTS), np.zeros(_TURNS * _STEPS)
        self.turned: dict[str, Values] = {"pi": np.pi, **turned}

    def values(self, at: dict[str, Values], form: Formula, quantity: str) -> tuple[np.ndarray, np.ndarray]:
        """Numbers of a formula and of a quantity at states [unit of each]. Raises BadInput and ArithmeticError."""
        with np.errstate(all="ignore"):
            complete(self.theory, at, [quantity], FLOATS)
        return self.of(form, at), _as_row(at[quantity], at)

    def of(self, form: Formula, at: dict[str, Values] | None = None) -> np.ndarray:
        """Numbers of a formula at states, those drawn where none are given [its unit]. Raises as `values`."""
        at = self.random if at is None else at
        with np.errstate(all="ignore"):
            complete(self.theory, at, used_names(form), FLOATS)
            own = {k: evaluate(tree, at, FLOATS) for k, tree in form.letters.items()}
            return _as_row(evaluate(form.tree, {**at, **own}, FLOATS), at)


def _as_row(values: Values, at: dict[str, Values]) -> np.ndarray:
    count = len(next(v for k, v in at.items() if k != "pi"))
    return np.broadcast_to(np.asarray(values, dtype=float), (count,))


def compared(form: Formula, states: Probes, quantity: str) -> Nearness | None:
    """A formula's numbers beside a quantity's; None where there are none."""
    try:
        printed, expected = states.values(states.random, form, quantity)
        turns = states.values(states.turned, form, quantity) if states.theory.angle else None
    except (BadInput, ArithmeticError, ValueError, KeyError, RecursionError):
        return None
    good = np.isfinite(expected) & np.isfinite(printed)
    if np.count_nonzero(good) < _POINTS // 2 or not np.any(expected[good]):
        return None
    p, e = printed[good], expected[good]
    with np.errstate(all="ignore"):
        ratios = p / e
        middle = float(np.median(ratios))
        constant = bool(np.all(np.abs(ratios - middle) <= _SAME * abs(middle))) and middle != 0
    away = min(float(np.max(np.abs(p - e))), float(np.max(np.abs(p + e)))) / float(np.max(np.abs(e)))
    return Nearness(
        away=away,
        ratio=middle if constant else None,
        shift=turns is not None and _shifted(*turns) and _is_place(states.theory, quantity),
    )


def _is_place(theory: Theory, quantity: str) -> bool:
    # what may be counted from another place
    return kind_of(theory, trees.name(quantity)) in (ANGLE, kind_of_unit("m"), kind_of_unit("m^3"))


def _shifted(printed: np.ndarray, expected: np.ndarray) -> bool:
    # counted from another place: the difference does not change with the angle
    if not np.all(np.isfinite(printed)) or not np.all(np.isfinite(expected)):
        return False
    moves = np.ptp(expected.reshape(_TURNS, _STEPS), axis=1)
    rests = [np.ptp((printed - sign * expected).reshape(_TURNS, _STEPS), axis=1) for sign in (1, -1)]
    return bool(np.all(moves > 0)) and any(bool(np.all(rest <= _SAME * moves)) for rest in rests)


@record
class Near:
    """A formula beside a quantity of a theory that it may be."""

    away: float  #: Largest difference by the quantity's largest size; 0 where it is the quantity [-]
    fitted: Fitted
    form: Formula
    quantity: str  #: Empty where it is near to none
    states: Probes
    settled: bool = False  #: Whether another form of its equation tells how its author counts


# 4 pi^2 where a conversion is upside down
_SLIPS = tuple(k**power for k in (2.0, 3.0, 4.0, np.pi, 2 * np.pi, 4 * np.pi**2) for power in (1, -1, 0.5, -0.5))


def is_slip(ratio: float | None) -> bool:
    """Whether a ratio [-] is one that is lost or taken twice; another one is somebody's own number."""
    return ratio is None or any(abs(abs(ratio) / k - 1) < 1e-5 for k in _SLIPS)


def of_units(ratio: float | None) -> bool:
    """Whether a ratio of numbers [-] is one of units, or of sign alone."""
    return ratio is not None and any(abs(ratio / u - 1) < 1e-5 for u in _UNITS)


def of_sign(ratio: float | None) -> bool:
    """Whether a ratio of numbers [-] is 1 or -1."""
    return ratio is not None and abs(abs(ratio) - 1) < 1e-9


def nearest(fitted: Fitted, form: Formula, states: Probes, si: bool = False) -> Iterator[tuple[float, str]]:
    """Quantities whose numbers a formula comes near to, the nearest first, with how far it is off [-]."""
    theory = fitted.theory
    used = {m for t in form.letters.values() for m in letters(t)}
    near = []
    for quantity in theory.results:
        needed = dependencies(theory, [quantity])
        if quantity in used or not used & needed or isinstance(theory.tape[quantity], tuple):
            continue
        if (met := compared(form, states, quantity)) is not None:
            right = of_sign(met.ratio) if si else of_units(met.ratio) or met.shift
            near.append((0.0 if right else max(met.away, 1e-9), quantity))
    yield from sorted(near)
