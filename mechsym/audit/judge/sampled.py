"""Forms of a text compared at random states of its letters."""

import re
from dataclasses import replace

import numpy as np

from mechsym.audit.read.algebra import FLOATS, evaluate
from mechsym.audit.read.tree import Node, letters
from mechsym.audit.theory.record import Theory, complete, dependencies
from mechsym.errors import BadInput
from mechsym.quantities import record

_STATES = 48
_CLOSE = 1e-9


@record
class States:
    """Random values of all letters of a theory, at which forms are compared."""

    theory: Theory
    values: dict[str, np.ndarray]

    def value(self, tree: Node) -> np.ndarray:
        """Values of an expression [SI], nan where it has none."""
        with np.errstate(all="ignore"):
            complete(self.theory, self.values, letters(tree), FLOATS)
            return np.broadcast_to(np.asarray(evaluate(tree, self.values, FLOATS), dtype=float), (_STATES,))


def states(theory: Theory, seed: int = 5) -> States:
    """States of a theory, the same each time."""
    rng = np.random.default_rng(seed)
    values = {"pi": np.full(_STATES, np.pi)}
    for letter, about in theory.letters.items():
        signs = rng.choice((-1.0, 1.0), _STATES) if not about.positive else 1.0
        values[letter] = about.value * rng.uniform(0.5, 1.6, _STATES) * signs
        if letter == theory.angle:
            values[letter] = rng.uniform(-6, 6, _STATES)
    return States(theory=theory, values=values)


def alike(at: States, left: Node, right: Node) -> bool | None:
    """Whether two forms are the same at all states; None where too few have a value."""
    first, second = at.value(left), at.value(right)
    good = np.isfinite(first) & np.isfinite(second)
    if np.count_nonzero(good) < 8 or np.isfinite(first).sum() != np.isfinite(second).sum() and good.sum() < 12:
        return None
    size = np.maximum(np.abs(first), np.abs(second))[good]
    gap = np.abs(first - second)[good]
    return bool(np.all(gap <= _CLOSE * np.maximum(size, 1e-12)) and np.any(size > 1e-12))


def is_multiple(at: States, left: Node, right: Node) -> bool:
    """Whether a form is another one times the same number at all states."""
    first, second = at.value(left), at.value(right)
    if not (np.isfinite(first).all() and np.isfinite(second).all() and np.any(second)):
        return False
    ratio = float(first @ second / (second @ second))
    return bool(ratio and np.abs(first - ratio * second).max() <= _CLOSE * np.abs(first).max())


def where_defined(theory: Theory, tree: Node) -> Theory:
    """A theory whose angle is behind the angles with an index, where a form has no value in front of them: Wiebe's."""
    starts = [k for k in theory.letters if theory.angle and re.fullmatch(rf"{theory.angle}_?(?:\d|[a-z]+[^d]|s)", k)]
    if not starts or np.isfinite(states(theory).value(tree)).all():
        return theory
    letters_of = dict(theory.letters) | {k: replace(theory.letters[k], domain=(0.3, 0.9)) for k in starts}
    letters_of[theory.angle] = replace(theory.letters[theory.angle], domain=(1.2, 1.6))
    return replace(theory, letters=letters_of)


def vanishes(tree: Node) -> bool:
    """Whether a form is 0 whatever its letters are."""
    drawn = np.random.default_rng(11).uniform(0.3, 1.7, (len(letters(tree)), _STATES))
    values = dict(zip(letters(tree), drawn, strict=True)) | {"pi": np.pi}
    with np.errstate(all="ignore"):
        try:
            value = np.asarray(evaluate(tree, values, FLOATS), dtype=float)
        except (BadInput, KeyError, TypeError):
            return False
    return bool(np.all(np.abs(value) < _CLOSE))


def free(theory: Theory, tree: Node) -> set[str]:
    """Letters that an expression is made of in the end."""
    return dependencies(theory, letters(tree)) & theory.letters.keys()
