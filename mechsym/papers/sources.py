"""The papers: each is a folder here, found by its name; what it prints is read from its `printed.toml`.

One [[entry]] is a formula, a definition or a claim of the text:

equation = "2"                        # its number, or where it stands: "text", "table 4.9"
claim = "reduced moment of inertia"   # what it claims to be, in words
statement = "..."                     # as printed, in the author's letters
quantity = "crosshead.inertia"        # a formula: what is derived
letters = { R = "r" }                 # of the author; or the name of a table in [letters], or a list of both
hold = { phidd = 0.0 }                # what is taken for granted; the same with [hold]
turn, effect = "claims.loads"         # functions of the paper's folder
verdict = "definition"                # instead of a quantity: it is not there to be proved
decide = "claims.about_twice"         # instead of a statement: what decides a claim made in words
note = "..."                          # what else there is to say; of a claim in words, with the numbers that decide it
"""

import pkgutil
import tomllib
from collections.abc import Callable, Mapping
from functools import partial
from importlib import resources
from typing import TYPE_CHECKING

from mechsym.errors import BadInput
from mechsym.files import Json
from mechsym.quantities import load, record

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from mechsym.audit.hosts.sources import Decided, Entry


_FUNCTIONS, _TABLES = ("turn", "effect", "decide"), ("letters", "hold")


def entries(folder: str) -> "tuple[Entry, ...]":
    """The entries of a paper in the order of the text."""
    from mechsym.audit.hosts.sources import Listed, Printed, TextClaim

    text = (resources.files(f"mechsym.papers.{folder}") / "printed.toml").read_text(encoding="utf-8")
    content = tomllib.loads(text)
    entries: list[Entry] = []
    for said in content["entry"]:
        fields = dict(said)
        for key in (k for k in _FUNCTIONS if k in said):
            fields[key] = load(f"mechsym.papers.{folder}.{said[key].replace('.', ':')}")
        for key in (k for k in _TABLES if k in said):
            parts = said[key] if isinstance(said[key], list) else [said[key]]
            tables = [content[key][part] if isinstance(part, str) else part for part in parts]
            fields[key] = {k: v for table in tables for k, v in table.items()}
        kind = Printed if "quantity" in said else Listed if "verdict" in said else TextClaim
        if kind is TextClaim:
            fields["decide"] = partial(_decided, fields["decide"], fields.pop("note"))
        entries.append(kind(**fields))
    return tuple(entries)


@record
class Weighed:
    """What decides a claim made in words."""

    supported: bool  #: Whether the computation bears the claim out
    numbers: Mapping[str, object]  #: That its note names
    rel_error: float | None  #: Of claimed and computed value, where the claim is a number [-]


def weighed(supported: bool, rel_error: float | None = None, **numbers: object) -> Weighed:
    """A claim that stands or not. rel_error: of a claim that is a number [-]; numbers: that its note names."""
    return Weighed(supported=supported, numbers=numbers, rel_error=rel_error)


def against(claimed: float, correct: float, within: float = 5e-3, **numbers: object) -> Weighed:
    """A claim that is a number [its unit]: it stands within a relative difference; its note may name `correct`."""
    error = claimed / correct - 1
    return weighed(abs(error) <= within, error, correct=correct, **numbers)


def _decided(decide: Callable[[], Weighed], note: str) -> "Decided":
    from mechsym.audit.hosts.sources import Decided

    claim = decide()
    return Decided(supported=claim.supported, note=note.format_map(claim.numbers), rel_error=claim.rel_error)


@record
class Source:
    """A paper or thesis; the folder that it stands in has its name."""

    stem: str  #: Of its file; sources are listed in the order of their stems
    name: str
    title: str  #: Authors, year and title
    #: Relative difference of a computed value from the recorded one that is left to processor and library [-]
    tolerance: float = 1e-6

    @property
    def entries(self) -> "tuple[Entry, ...]":
        """What is audited, in the order of the text."""
        return entries(self.name)

    def rows(self) -> list[Json]:
        """Its published numbers beside the computed ones: the keys of `Row.told`."""
        rows = load(f"mechsym.papers.{self.name}.rows:rows")()
        return [row.told(self.stem, self.tolerance) for row in rows]

    def figures(self) -> "Mapping[str, Figure]":
        """The figures that it prints, drawn from the computation."""
        return load(f"mechsym.papers.{self.name}.figures:figures")()


def sources(name: str | None = None) -> tuple[Source, ...]:
    """All sources, or the one with a name, a stem or a stem's number."""
    from mechsym import papers

    folders = [m.name for m in pkgutil.iter_modules(papers.__path__) if m.ispkg]
    known = sorted((load(f"mechsym.papers.{folder}:SOURCE") for folder in folders), key=lambda s: s.stem)
    if name is None:
        return tuple(known)
    chosen = tuple(s for s in known if name.removesuffix(".txt") in (s.stem, s.name, s.stem[:3]))
    if not chosen:
        raise BadInput(f"source {name!r} is not known; there are {', '.join(f'{s.name} ({s.stem})' for s in known)}")
    return chosen


def short_name(stem: str) -> str:
    """Name and year of the source with a stem; what is no source (a file of data, an own engine) stays as it is."""
    return next((one.name for one in sources() if one.stem == stem), stem)
