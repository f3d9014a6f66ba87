"""The papers: each is a folder here, found by its name. What a folder holds is in the table of `mechsym.papers`."""

import pkgutil
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from mechsym.errors import BadInput
from mechsym.papers.entries import entries
from mechsym.papers.rows import number
from mechsym.quantities import load, record

if TYPE_CHECKING:
    from mechsym.audit.entries import Entry


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

    def rows(self) -> list[dict[str, Any]]:
        """Its published numbers beside the computed ones.

        Returns
        -------
        rows : list of dict
            Keys `rows.KEYS`, the tolerance of the record, and for some sources more
        """
        return [
            _with_print(row) | {"tolerance": self.tolerance} for row in load(f"mechsym.papers.{self.name}.rows:rows")()
        ]

    def figures(self) -> Mapping[str, Any]:
        """The figures that it prints, drawn from the computation."""
        return load(f"mechsym.papers.{self.name}.figures:figures")()


def sources(name: str | None = None) -> tuple[Source, ...]:
    """All sources, or the one with a name, a stem or a stem's number."""
    from mechsym import papers

    folders = [m.name for m in pkgutil.iter_modules(papers.__path__) if m.ispkg]
    known = sorted((load(f"mechsym.papers.{folder}:SOURCE") for folder in folders), key=lambda s: s.stem)
    if name is None:
        return tuple(known)
    found = tuple(s for s in known if name.removesuffix(".txt") in (s.stem, s.name, s.stem[:3]))
    if not found:
        raise BadInput(f"source {name!r} is not known; there are {', '.join(f'{s.name} ({s.stem})' for s in known)}")
    return found


def _with_print(row: dict[str, Any]) -> dict[str, Any]:
    text = row.get("printed", row["published"])
    return row | {"published": number(text), "printed": text}


def short_name(stem: str) -> str:
    """Name and year of the source with a stem; what is no source (a file of data, an own engine) stays as it is."""
    return next((one.name for one in sources() if one.stem == stem), stem)
