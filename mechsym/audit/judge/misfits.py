"""Equations of a text whose units do not fit, and which of them are told of."""

import ast
from collections import Counter
from collections.abc import Sequence

from mechsym.audit.judge.kinds import PURE, SIXTY, THOUSAND, Clash, Kind, Kinds, Unknown, letters_of, shown
from mechsym.audit.read.said import Said
from mechsym.audit.read.slopes import slope_in
from mechsym.audit.read.tree import letters, value_of
from mechsym.quantities import record


@record
class Odd:
    """An equation whose units do not fit."""

    said: Said
    part: int  #: Which side, counted from the left [-]
    why: str


def odd(kinds: Kinds, said: Sequence[Said]) -> tuple[list[Odd], set[str]]:
    """Equations whose units do not fit, and the names of those whose units were compared and do."""
    misfits, fitting = [], set()
    for one in said:
        if not one.sides or one.inline:
            continue
        sides: list[tuple[int, Kind]] = []
        for i, side in enumerate(one.sides):
            if not letters(side):  # 0 has any unit, and numbers alone are in one that stands behind them
                continue
            try:
                sides.append((i, kinds.kind(side)))
            except Clash as clash:
                misfits.append(Odd(said=one, part=i, why=str(clash)))
            except Unknown:
                continue
        misfits += _unlike(kinds, one, sides)
        if (len(sides) > 1 or len(one.sides) > 1 and value_of(one.sides[-1]) == 0 and sides) and not _unlike(
            kinds, one, sides
        ):
            fitting.add(id_of(one))
    return misfits, fitting


def id_of(said: Said) -> str:
    """What an equation is known by."""
    return f"{said.shown.begins}:{said.shown.text}"


def _unlike(kinds: Kinds, one: Said, sides: Sequence[tuple[int, Kind]]) -> list[Odd]:
    if len({k for _, k in sides}) < 2:
        return []
    plain = Counter(k[:4] for _, k in sides)
    common = plain.most_common(1)[0][0] if len(sides) > 2 else sides[0][1][:4]
    misfits = [
        Odd(said=one, part=i, why=f"its unit is {shown(k)}, and that of the other side {shown((*common, *PURE[4:]))}")
        for i, k in sides if k[:4] != common
    ]  # fmt: skip
    if misfits:
        return misfits
    for place, factor in ((SIXTY, "60"), (THOUSAND, "1000")):
        if place == THOUSAND and kinds.scaled & set(letters_of(one)):
            continue
        first = sides[0][1][place]
        misfits += [
            Odd(said=one, part=i, why=f"a factor {factor} is missing between the units of its sides")
            for i, k in sides[1:] if k[place] != first
        ]  # fmt: skip
    return misfits


def _is_only_time(kinds: Kinds, letter: str) -> bool:
    slope, rate = slope_in(letter), kinds.as_rate(letter)
    of = slope.of if slope and slope.by == "t" else rate[1] if rate else letter
    kind = kinds.inferred.get(of)
    followed = kind is not None and not any((*kind[:2], kind[3]))  # omega = d theta/dt of such a text
    return letter in ("t", "dt") or kinds.of(of) in (None, PURE) or followed


def findings(kinds: Kinds, misfits: Sequence[Odd], said: Sequence[Said]) -> list[Odd]:
    """Misfits that no letter of doubtful unit explains: a form of several, or a left side whose own unit is printed."""
    _, fitting = odd(kinds, said)
    agreeing = [one for one in said if id_of(one) in fitting and getattr(one.sides[0], "id", "") not in kinds.inferred]
    sure = {n for one in agreeing for n in letters_of(one)}
    lent = {getattr(one.said.sides[0], "id", "") for one in misfits}
    doubtful = {n for n in lent if kinds.is_lent(n)}  # M_b beside a mass M is a moment
    kept = []
    bare = [one for one in misfits if one.why.startswith("the argument of")]
    in_numbers = {n for one in bare for n in letters_of(one.said)} if len(bare) > 1 else set()
    for one in misfits:
        if one in bare and not in_numbers.isdisjoint(letters_of(one.said)):
            continue  # a text of several such counts lengths in a unit of its own
        if len(one.said.sides) > 2 and not doubtful.isdisjoint(letters_of(one.said)):
            continue
        if all(_is_only_time(kinds, n) for n in letters_of(one.said)):
            continue  # y' = -2 y t of mathematics has no seconds
        left = one.said.sides[0]
        two = len(one.said.sides) == 2
        if two and "factor" not in one.why and any(kinds.is_lent(n) and n not in sure for n in letters_of(one.said)):
            continue  # S_p beside a stroke S is a speed
        named = isinstance(left, ast.Name) and kinds.of(left.id) is not None and left.id not in kinds.inferred
        if len(one.said.sides) > 2 or named or one.part and not isinstance(left, ast.Name):
            kept.append(one)
    return kept
