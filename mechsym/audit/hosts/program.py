"""Formulas of programs compared with derived quantities: a variable claims to be what its name or comment says."""

import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

import numpy as np

from mechsym.audit.hosts.code import Assigned, read_code
from mechsym.audit.judge.asked import Asked
from mechsym.audit.judge.dimensions import is_consistent, rescaled
from mechsym.audit.judge.question import Question, turn, value
from mechsym.audit.read.reader import joined, read
from mechsym.audit.read.slopes import Slope
from mechsym.audit.read.tree import letters, name
from mechsym.audit.row import Row, answer_or_why, unread_row
from mechsym.audit.theory.catalogue import named, shipped
from mechsym.audit.theory.catalogue import target as parted
from mechsym.audit.theory.record import Theory, known
from mechsym.errors import BadInput
from mechsym.quantities import record

_SAME = 1e-6  # numbers that agree but for rounding [-]
# half a peak off is a lost factor of two, the largest slip that still tells what was meant
_NEAR = 0.6


@record
class Likeness:
    """How near the numbers of a formula come to a quantity."""

    quantity: str
    away: float  #: Largest difference over a turn at the theory's data, by the quantity's peak; of either sign [-]


def check_code(place: str, against: str, asked: Asked) -> list[Row]:
    """Rows of `FILE::FUNCTION`.

    against: `THEORY.QUANTITY`: the variable of that name or description, or else what the function returns. `THEORY` or
    nothing: every variable whose name or description is that of a quantity, else what its numbers are near to; asked:
    letters, assumptions and the rest, for every formula.
    """
    against = against.strip()
    theory, quantity = parted(against)
    # what the theory and the author call letters stays one, although the program gives it a number
    about = theory or against or (Path(asked.theory).stem if asked.theory else "")
    letters_there = {*asked.pairs, *(named(about, asked.case, asked.theory).letters if about else ())}
    assigned = read_code(place, letters_there)
    if theory:
        called = [a for a in assigned if _is_called(a, quantity)]
        returned = [a for a in assigned if a.name == "return"]
        return [_row((called or returned or assigned)[-1], against, asked)]
    rows = [(one.name, _row(one, target, asked)) for one, target in _every(assigned, against, asked)]
    # a name that several theories have is asked of those whose letters it has; of one where it has none's
    answered = {name for name, row in rows if row["understood"] is not None}
    first = {name: row for name, row in reversed(rows)}
    chosen = [row for name, row in rows if row["understood"] is not None or name not in answered and row is first[name]]
    returned = [a for a in assigned if a.name == "return"]
    candidates = [a for a in returned or {a.name: a for a in assigned}.values() if a.name not in first]
    if against or not rows:
        liked = _liked(place, candidates, against, asked)
        chosen += liked
        first |= {row["equation"].partition(" (")[0]: row for row in liked}
    if not chosen:
        names = ", ".join(dict.fromkeys(a.name for a in assigned))
        raise BadInput(
            f"--code {place}: none of {names} is called as a quantity or near to one in its numbers; name one with "
            "--against THEORY.QUANTITY, and letters of your own with --letters"
        )
    # what was read and says nothing must not be taken for right
    silent = [k for k in dict.fromkeys(a.name for a in assigned) if k not in first]
    if silent:
        note = f"read, and no quantity by name or numbers: {', '.join(silent)}"
        chosen[-1] = chosen[-1] | {"note": joined(chosen[-1]["note"], note)}
    return [row | {"unmatched": silent} for row in chosen]


def _every(assigned: Sequence[Assigned], theory: str, asked: Asked) -> Iterator[tuple[Assigned, str]]:
    # variables that are called as a quantity of the theory, or of any
    theories = [named(theory, asked.case, asked.theory)] if theory else _theories(asked)
    for one in assigned:
        for other in theories:
            for quantity in other.results:
                # x or v alone says little where no theory is named
                alone = not theory and not asked.theory and len(_words(quantity)) < 2
                if not alone and _is_called(one, quantity):
                    yield one, f"{other.name}.{quantity}"


def _liked(place: str, candidates: Sequence[Assigned], theory: str, asked: Asked) -> list[Row]:
    # what its numbers are near to
    rows: list[Row] = []
    theories = [named(theory, asked.case, asked.theory)] if theory else [*_theories(asked), named("slider_crank")]
    for assigned in candidates:
        likes = [(nearest(assigned.text, t, _own_letters(assigned.text, t, asked)), t) for t in theories]
        near = sorted(((k, t) for k, t in likes if k is not None), key=lambda pair: pair[0].away)
        if not near or assigned.inner and near[0][0].away > _SAME:
            continue  # a step on the way to another variable is not meant to be a quantity
        if len(near) > 1 and near[0][0].away > _SAME:
            places = ", ".join(f"{t.name}.{like.quantity}" for like, t in near[:4])
            raise BadInput(
                f"--code {place}: the numbers of {assigned.name} are near to {places}; say which with --against"
            )
        like, other = near[0]
        row = _row(assigned, f"{other.name}.{like.quantity}", asked)
        note = f"taken for {like.quantity} by its numbers; if it is another, name it with --against"
        rows.append(row | {"note": joined(row["note"], note)})
    return rows


def _row(assigned: Assigned, target: str, asked: Asked) -> Row:
    about = f" ({assigned.about})" if assigned.about not in ("", assigned.name) else ""
    name = assigned.name + about
    if assigned.unfollowed:
        why = (
            f"{assigned.unfollowed[0]} is assigned in a loop or a branch, or changed in place, which is not followed; "
            "ask for a variable before it, or write the formula for --formula"
        )
        return unread_row(name, target, assigned.text, why)
    own = _own_letters(assigned.text, named(parted(target)[0], asked.case, asked.theory), asked)
    row = answer_or_why(
        replace(asked, text=assigned.text, against=target, letters=own, name=name, hidden="noted", given=None)
    )
    note = ", ".join(f"{k} taken for {v}" for k, v in own.items() if k not in str(asked.letters))
    return row if row["understood"] is None else row | {"note": joined(row["note"], note)}


def _own_letters(text: str, theory: Theory, asked: Asked) -> dict[str, str]:
    # omega_m is omega where the theory has omega and the author gave nothing for omega_m
    own = asked.pairs
    for used in dict.fromkeys(re.findall(r"(?<![\w.])[A-Za-z_]\w*", text)):
        stem = used.partition("_")[0]
        if used not in own and used not in theory.letters and used not in theory.tape and stem in theory.letters:
            own[used] = stem
    return own


def _theories(asked: Asked) -> list[Theory]:
    if asked.theory:
        return [named(Path(asked.theory).stem, asked.case, asked.theory)]
    return [named(one) for one in shipped()]


def _is_called(assigned: Assigned, quantity: str) -> bool:
    wanted = _words(quantity)
    if len(quantity) == 1 and len(assigned.name) == 1:
        return assigned.name == quantity
    return _words(assigned.name) == wanted or len(wanted) > 1 and set(wanted) <= set(_words(assigned.about))


def _words(text: str) -> list[str]:
    return re.findall(r"[a-z]+|\d+", re.sub(r"(?<=[a-z])(?=[A-Z])", " ", text).lower())


def nearest(text: str, theory: Theory, own: Mapping[str, str]) -> Likeness | None:
    """The quantity of the same dimension whose numbers are nearest to those of a formula in the letters `own`."""
    try:
        formula = read(text, known(theory), own, theory.tape)
    except BadInput:
        return None
    if len(letters(formula.tree)) < 2:
        return None
    quantities = list(dict.fromkeys(_quantities(theory)))
    asked = turn(Question(formula=formula, theory=theory, quantity=quantities[0]))
    printed, likes = _floats(value(asked, formula.tree)), []
    for quantity in quantities:
        expected = _floats(value(asked, name(quantity)))
        if np.all(np.isfinite(printed)) and np.all(np.isfinite(expected)) and np.any(expected):
            away = min(float(np.max(np.abs(sign * printed - expected))) for sign in (1, -1))
            likes.append(Likeness(quantity=quantity, away=away / float(np.max(np.abs(expected)))))
    for like in sorted((k for k in likes if k.away <= _NEAR), key=lambda k: k.away):
        question = Question(formula=formula, theory=theory, quantity=like.quantity)
        if is_consistent(rescaled(question), formula.tree):
            return like
    return None


def _quantities(theory: Theory) -> Iterator[str]:
    # the theory's own names first: x_d is often one of them, too
    plain = [q for q in theory.results if not isinstance(theory.tape[q], tuple)]
    yield from plain
    for q in plain if theory.angle else ():
        for derived in (Slope(q, theory.angle).name, Slope(q, theory.angle, 2).name, f"{q}_d", f"{q}_dd"):
            with suppress(BadInput):
                if theory.tape.get(derived) is not None:
                    yield derived


def _floats(values: object) -> np.ndarray:
    return np.atleast_1d(np.asarray(values, dtype=float))
