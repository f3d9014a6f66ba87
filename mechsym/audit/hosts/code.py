"""Formulas out of one function of a program: its assignments and what it returns, its own variables put in."""

from collections.abc import Collection
from pathlib import Path

from mechsym.audit.read.programs.claims import (
    ENDS,
    Claim,
    base,
    inlined,
    is_changed,
    longest,
    read_program,
    with_base_names,
)
from mechsym.audit.read.programs.statements import OF
from mechsym.audit.read.spelling import to_python
from mechsym.audit.read.tree import letters
from mechsym.errors import BadInput
from mechsym.files.inputs import read_any_text
from mechsym.quantities import record

LONGEST = 5000  # of a formula with everything put in


@record
class Assigned:
    """A variable of a program with its formula."""

    name: str  #: `return` for what a function gives back
    text: str
    about: str  #: What a comment or a description says of it
    inner: bool = False  #: Whether a later formula is made of it
    #: Names in it that get their values in a loop or a branch, or are changed in place: no formula stands for them
    unfollowed: tuple[str, ...] = ()


def read_code(place: str, own: Collection[str] = ()) -> list[Assigned]:
    """The assignments of `FILE::FUNCTION`, its variables put in; `own` stay letters where it gives them numbers."""
    file, mark, function = place.rpartition("::")
    if not mark or not file or not function:
        raise BadInput(f"--code {place!r} is not FILE::FUNCTION, as engine.c::piston_speed")
    suffix = Path(file).suffix.lower()
    if suffix not in ENDS:
        raise BadInput(f"--code {file}: files that are read end in {', '.join(ENDS)}")
    text = read_any_text(file, longest(suffix), "--code")
    try:
        reading = read_program(text, suffix)
    except BadInput as error:
        raise BadInput(f"--code {file}: {error}") from None
    if function not in reading.names:
        names = ", ".join(dict.fromkeys(n for n in reading.names if n))
        raise BadInput(f"--code {file}: there is no function {function}; there are {names or 'none'}")
    claims = [c for c in reading.claims if c.scope == function]
    if not claims:
        raise BadInput(f"--code {place}: there is no assignment and no return of arithmetic in {function}")
    return [_assigned(claim, claims[i + 1 :], own) for i, claim in enumerate(claims)]


def _assigned(claim: Claim, later: list[Claim], own: Collection[str]) -> Assigned:
    kept = {k: 1 for k, v in claim.values.items() if base(k) in own and not letters(v)}
    whole = inlined(claim.tree, claim.values, kept)
    shown = to_python(whole) if whole is not None else ""
    tree = claim.tree if whole is None or len(shown) > LONGEST else whole
    inner = any(base(k) == claim.name for other in later for k in letters(other.tree))
    return Assigned(
        name=claim.name.replace(OF, "_"),
        text=to_python(with_base_names(tree)),
        about=claim.about or (claim.scope if claim.name == "return" else ""),
        inner=inner,
        unfollowed=tuple(dict.fromkeys(base(k) for k in letters(tree) if is_changed(k))),
    )
