"""Formulas of programs compared with derived quantities: a variable claims to be what its name or comment says."""

import re
from collections.abc import Iterator
from pathlib import Path

from mechsym.audit.code import UNFOLLOWED, Assigned, read_code
from mechsym.audit.code_numbers import candidates, nearest
from mechsym.audit.findings import Row, unread_row
from mechsym.audit.formula import Asked, answer
from mechsym.audit.reader import letter_pairs
from mechsym.audit.theory.catalogue import named, shipped
from mechsym.audit.theory.catalogue import target as parted
from mechsym.audit.theory.record import Theory
from mechsym.errors import BadInput

_SAME = 1e-6  # numbers that agree but for rounding [-]


def check_code(place: str, against: str, asked: Asked) -> list[Row]:
    """Rows of `FILE::FUNCTION`.

    Parameters
    ----------
    against : str
        `THEORY.QUANTITY`: the variable of that name or description, or else what the function returns. `THEORY` or
        nothing: every variable whose name or description is that of a quantity, else what its numbers are near to
    asked : Asked
        Letters, assumptions and the rest, for every formula
    """
    theory, quantity = parted(against)
    found = read_code(place, _letters_of(theory or against.strip(), asked))
    pairs = list(_one(found, against.strip(), quantity) if theory else _every(found, against.strip(), asked))
    if not pairs and not theory:
        return _by_numbers(place, found, against.strip(), asked)
    rows = _answered([(assigned.name, _row(assigned, target, asked)) for assigned, target in pairs])
    if theory:
        return rows
    named_rows = {assigned.name for assigned, _ in pairs}
    rest = [a for a in candidates(found) if a.name not in named_rows]
    more = _liked(place, rest, against.strip(), asked) if against.strip() else []
    return _with_unmatched([*rows, *more], found, {*named_rows, *_names_of(more)})


def _names_of(rows: list[Row]) -> set[str]:
    return {row["equation"].partition(" (")[0] for row in rows}


def _with_unmatched(rows: list[Row], found: list[Assigned], matched: set[str]) -> list[Row]:
    # what was read and says nothing must not be taken for right
    silent = [k for k in dict.fromkeys(a.name for a in found) if k not in matched]
    told = f"read, and no quantity by name or numbers: {', '.join(silent)}"
    notes = [row["note"] for row in rows]
    last = "; ".join(n for n in (notes[-1], told) if n) if silent else notes[-1]
    return [row | {"unmatched": silent, "note": n} for row, n in zip(rows, [*notes[:-1], last], strict=True)]


def _letters_of(theory: str, asked: Asked) -> set[str]:
    # what the theory and the author call letters stays one, although the program gives it a number
    given = letter_pairs(asked.letters) if isinstance(asked.letters, str) else dict(asked.letters)
    about = theory or (Path(asked.theory).stem if asked.theory else "")
    return {*given, *(named(about, asked.case, asked.theory).letters if about else ())}


def _by_numbers(place: str, found: list[Assigned], theory: str, asked: Asked) -> list[Row]:
    # neither a name nor a comment says what it is
    rows = _liked(place, candidates(found), theory, asked)
    if not rows:
        names = ", ".join(dict.fromkeys(a.name for a in found))
        raise BadInput(
            f"--code {place}: none of {names} is called as a quantity or near to one in its numbers; name one with "
            "--against THEORY.QUANTITY, and letters of your own with --letters"
        )
    return _with_unmatched(rows, found, _names_of(rows))


def _liked(place: str, asked_for: list[Assigned], theory: str, asked: Asked) -> list[Row]:
    rows: list[Row] = []
    theories = [named(theory, asked.case, asked.theory)] if theory else [*_theories(asked), named("slider_crank")]
    for assigned in asked_for:
        likes = [(nearest(assigned.text, t, _own_letters(assigned.text, t, asked)), t) for t in theories]
        known = sorted(((k, t) for k, t in likes if k is not None), key=lambda pair: pair[0].away)
        if known and assigned.inner and known[0][0].away > _SAME:
            continue  # a step on the way to another variable is not meant to be a quantity
        if len(known) > 1 and known[0][0].away > _SAME:
            near = ", ".join(f"{t.name}.{like.quantity}" for like, t in known[:4])
            raise BadInput(
                f"--code {place}: the numbers of {assigned.name} are near to {near}; say which with --against"
            )
        if known:
            like, other = known[0]
            row = _row(assigned, f"{other.name}.{like.quantity}", asked)
            told = f"taken for {like.quantity} by its numbers; if it is another, name it with --against"
            rows.append(row | {"note": "; ".join(n for n in (row["note"], told) if n)})
    return rows


def _answered(rows: list[tuple[str, Row]]) -> list[Row]:
    # a name that several theories have is asked of those whose letters it has; of one where it has none's
    answered = {name for name, row in rows if row["understood"] is not None}
    first = {name: row for name, row in reversed(rows)}
    return [row for name, row in rows if row["understood"] is not None or name not in answered and row is first[name]]


def _row(assigned: Assigned, target: str, asked: Asked) -> Row:
    name = (
        f"{assigned.name} ({assigned.about})" if assigned.about and assigned.about != assigned.name else assigned.name
    )
    try:
        if unfollowed := re.search(rf"\b{UNFOLLOWED}(\w+)", assigned.text):
            raise BadInput(
                f"{unfollowed[1]} is assigned in a loop or a branch, or changed in place, which is not followed; "
                "ask for a variable before it, or write the formula for --formula"
            )
        letters = _letters(assigned.text, target, asked)
        note = ", ".join(f"{k} taken for {v}" for k, v in letters.items() if k not in str(asked.letters))
        row = answer(
            Asked(
                text=assigned.text, against=target, letters=letters, case=asked.case, name=name,
                assume=asked.assume, claim=asked.claim, convention=asked.convention, theory=asked.theory,
                hidden="noted",
            )
        )  # fmt: skip
        return row | {"note": "; ".join(n for n in (row["note"], note) if n)}
    except BadInput as error:
        return unread_row(name, target, assigned.text, str(error))


def _letters(text: str, target: str, asked: Asked) -> dict[str, str]:
    return _own_letters(text, named(parted(target)[0], asked.case, asked.theory), asked)


def _own_letters(text: str, theory: Theory, asked: Asked) -> dict[str, str]:
    # omega_m is omega where the theory has omega and the author gave nothing for omega_m
    given = letter_pairs(asked.letters) if isinstance(asked.letters, str) else dict(asked.letters)
    for used in dict.fromkeys(re.findall(r"(?<![\w.])[A-Za-z_]\w*", text)):
        stem = used.partition("_")[0]
        if used not in given and used not in theory.letters and used not in theory.tape and stem in theory.letters:
            given[used] = stem
    return given


def _one(found: list[Assigned], target: str, quantity: str) -> Iterator[tuple[Assigned, str]]:
    called = [a for a in found if _is_called(a, quantity)]
    returned = [a for a in found if a.name == "return"]
    chosen = (called or returned or found)[-1]
    yield chosen, target


def _every(found: list[Assigned], theory: str, asked: Asked) -> Iterator[tuple[Assigned, str]]:
    theories = [named(theory, asked.case, asked.theory)] if theory else list(_theories(asked))
    for assigned in found:
        for other in theories:
            for quantity in other.results:
                # x or v alone says little where no theory is named
                if not theory and not asked.theory and len(_words(quantity)) < 2:
                    continue
                if _is_called(assigned, quantity):
                    yield assigned, f"{other.name}.{quantity}"


def _theories(asked: Asked) -> Iterator[Theory]:
    if asked.theory:
        yield named(Path(asked.theory).stem, asked.case, asked.theory)
    for name in () if asked.theory else shipped():
        yield named(name)


def _is_called(assigned: Assigned, quantity: str) -> bool:
    wanted = _words(quantity)
    if len(quantity) == 1 and len(assigned.name) == 1:
        return assigned.name == quantity
    return _words(assigned.name) == wanted or len(wanted) > 1 and set(wanted) <= set(_words(assigned.about))


def _words(text: str) -> list[str]:
    return re.findall(r"[a-z]+|\d+", re.sub(r"(?<=[a-z])(?=[A-Z])", " ", text).lower())
