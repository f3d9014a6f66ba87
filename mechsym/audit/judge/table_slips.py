"""Letters of a nomenclature whose printed unit no equation can use."""

from collections.abc import Sequence
from fractions import Fraction

from mechsym.audit.judge.kinds import Kind, Kinds, converted, infer, letters_of, of_unit, shown
from mechsym.audit.judge.misfits import Odd, id_of, odd
from mechsym.audit.read.said import Said, Text
from mechsym.audit.read.slopes import slope_in
from mechsym.audit.read.units import head_of
from mechsym.quantities import dimension, record


@record
class TableSlip:
    """A letter whose printed unit no equation can use."""

    letter: str
    printed: str
    wanted: str
    line: int
    equations: Sequence[str]


def table_slips(paper: Text, kinds: Kinds, misfits: Sequence[Odd]) -> tuple[list[TableSlip], list[Odd]]:
    """Letters of the table to blame, whose other unit mends two equations or more; and the misfits that are left."""
    slips = [*_angular(paper, kinds), *_misnamed(paper, kinds)]
    left = list(misfits)
    while left:
        best: tuple[int, str, Kind] | None = None
        for letter in sorted({n for o in left for n in letters_of(o.said) if n in paper.named and paper.named[n].unit}):
            own = [s for s in paper.said if any(n.startswith(letter) or _moves(n, letter) for n in letters_of(s))]
            before = {id_of(o.said) for o in odd(kinds, own)[0]}
            sure = _sure(letter, left)
            for kind in _wanted(kinds, letter):
                count = _mended(kinds, letter, kind, own, before)
                count += sure + (count > 0 and _has_relative(paper, letter, kind))
                if count > 1 and (best is None or count > best[0]):
                    best = (count, letter, kind)
        if best is None:
            return slips, left
        _, letter, kind = best
        about = paper.named[letter]
        mended = [o for o in left if letter in letters_of(o.said)]
        _measure(kinds, letter, kind, paper.said)
        kinds.inferred.pop(letter, None)
        left, _ = odd(kinds, paper.said)
        names = list(dict.fromkeys(o.said.name for o in mended if all(o.said.name != m.said.name for m in left)))
        slips.append(TableSlip(letter=letter, printed=about.unit, wanted=shown(kind), line=about.line, equations=names))
    return slips, left


def _angular(paper: Text, kinds: Kinds) -> list[TableSlip]:
    """Angular speeds that the table counts in turns a minute, and no equation converts: they are in rad/s."""
    slips = []
    for letter in sorted(kinds.turns & paper.named.keys()):
        about = paper.named[letter]
        uses = [said for said in paper.said if letter in letters_of(said)]
        if "angular" in about.meaning.lower() and len(uses) > 1 and not any(converted(said, letter) for said in uses):
            names = [said.name for said in uses if not said.inline]
            slips.append(TableSlip(letter=letter, printed=about.unit, wanted="rad/s", line=about.line, equations=names))
            kinds.turns.discard(letter)
    return slips


def _misnamed(paper: Text, kinds: Kinds) -> list[TableSlip]:
    slips = []
    for letter, wanted in sorted(kinds.misnamed.items()):
        about, unit = paper.named[letter], wanted.replace("*", " ")
        uses = [said.name for said in paper.said if letter in letters_of(said) and not said.inline]
        if not uses:  # it is told of at the first equation behind the table
            uses = [said.name for said in paper.said if said.shown.line > about.line and not said.inline][:1]
        slips.append(TableSlip(letter=letter, printed=about.unit, wanted=unit, line=about.line, equations=uses))
    return slips


def _sure(letter: str, misfits: Sequence[Odd]) -> int:
    # a table that says otherwise than all forms of the letter's own equation
    return int(
        any(o.part == 0 and len(o.said.sides) > 2 and getattr(o.said.sides[0], "id", "") == letter for o in misfits)
    )


def _has_relative(paper: Text, letter: str, kind: Kind) -> bool:
    # V beside a V_0 that the table has in cubic metres, both a volume
    last = head_of(paper.named[letter].meaning).split()[-1:]
    others = [about for other, about in paper.named.items() if other != letter and other[0] == letter[0] and about.unit]
    return any(of_unit(about.unit) == kind and head_of(about.meaning).split()[-1:] == last for about in others if last)


def _wanted(kinds: Kinds, letter: str) -> set[Kind]:
    known = kinds.of(letter)
    if known is None:
        return set()
    tried = {(*map(Fraction, dimension(u)), Fraction(0), Fraction(0)) for u in _TRIED}
    return {k for k in tried if k[:4] != known[:4]}


_TRIED = (
    "-", "m", "m^2", "m^3", "s", "kg", "K", "N", "N*m", "Pa", "W", "J/kg/K", "m/s", "m/s^2", "rad/s", "rad/s^2",
    "kg*m^2", "kg/m^3", "N/m", "J/kg", "kg/s", "W/m/K", "W/m^2/K", "N*s/m", "N*m*s", "kg*m", "m^3/s", "Pa*s",
)  # fmt: skip


def _moves(name: str, letter: str) -> bool:
    # the slope of a letter, or by it
    slope = slope_in(name)
    return slope is not None and letter in (slope.of, slope.by)


def _measure(kinds: Kinds, letter: str, kind: Kind, said: Sequence[Said]) -> None:
    # a letter in another unit, and what follows from it anew
    kinds.printed[letter] = kind
    uses = [one for one in said if letter in letters_of(one)]
    for one in uses:
        kinds.inferred.pop(getattr(one.sides[0], "id", ""), None)
    for one in uses:
        infer(kinds, one)


def _mended(kinds: Kinds, letter: str, kind: Kind, own: Sequence[Said], before: set[str]) -> int:
    # how many equations of a letter another unit mends; none where it spoils one
    printed, inferred = dict(kinds.printed), dict(kinds.inferred)
    _measure(kinds, letter, kind, own)
    after = {id_of(o.said) for o in odd(kinds, own)[0]}
    kinds.printed.clear()
    kinds.printed.update(printed)
    kinds.inferred.clear()
    kinds.inferred.update(inferred)
    return 0 if after - before else len(before - after)
