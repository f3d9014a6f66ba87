"""The five sources by name, with the functions that give their rows and their figures."""

from collections.abc import Mapping
from importlib import import_module
from typing import Any

from mechsym.errors import BadInput
from mechsym.papers.rows import number
from mechsym.quantities import record


@record
class Source:
    """A source and where its reproduction is computed."""

    stem: str
    name: str
    about: str
    rows: tuple[str, ...]  #: Functions without arguments that give rows, as `module:function`
    figures: str  #: Function without arguments that gives figures by name, as `module:function`


SOURCES = (
    Source(
        stem="000_9f2b746dc1abd296",
        name="zotov2024",
        about="Zotov, Tokarev, Valeev, Fatkullina (2024): Two-stroke engine with constant crank angular velocity",
        rows=("mechsym.papers.zotov2024.rows:rows",),
        figures="mechsym.papers.zotov2024.figures:figures",
    ),
    Source(
        stem="001_a140ef4f7e005dde",
        name="moroianu2017",
        about="Moroianu (2017): The dynamic design of the marin engines",
        rows=("mechsym.papers.moroianu2017.computed:rows",),
        figures="mechsym.papers.moroianu2017.figures:figures",
    ),
    Source(
        stem="002_d7297926d6c52225",
        name="chmielewski2015",
        about="Chmielewski, Bogucki, Guminski, Maczak (2015): Crankshaft assembly with two degrees of freedom",
        rows=("mechsym.papers.chmielewski2015.computed:rows",),
        figures="mechsym.papers.chmielewski2015.figures:figures",
    ),
    Source(
        stem="003_8746f5f4ad51b1d1",
        name="prymak",
        about="Prymak: Forces in connecting-rod-less mechanisms",
        rows=("mechsym.papers.prymak.computed:rows",),
        figures="mechsym.papers.prymak.figures:figures",
    ),
    Source(
        stem="004_e00ef50339108dab",
        name="nunes2017",
        about="Nunes (2017): Opposed-piston engine, slider crank against geared hypocycloid",
        rows=(
            "mechsym.papers.nunes2017.computed:rows",
            "mechsym.papers.nunes2017.text:rows",
        ),
        figures="mechsym.papers.nunes2017.figures:figures",
    ),
)


def chosen(name: str | None = None) -> tuple[Source, ...]:
    """One source by name, or all.

    Returns
    -------
    sources : tuple of Source
        In the order of their stems
    """
    if name is None:
        return SOURCES
    found = tuple(s for s in SOURCES if name.removesuffix(".txt") in (s.stem, s.name))
    if not found:
        raise BadInput(f"source {name!r} is not known; there are {', '.join(f'{s.name} ({s.stem})' for s in SOURCES)}")
    return found


def rows(source: Source) -> list[dict[str, Any]]:
    """All rows of a source.

    Returns
    -------
    rows : list of dict
        Keys `rows.KEYS`, and for some sources more
    """
    return [_with_print(row) for path in source.rows for row in _function(path)()]


def _with_print(row: dict[str, Any]) -> dict[str, Any]:
    text = row.get("printed", row["published"])
    return row | {"published": number(text), "printed": text}


def figures(source: Source) -> Mapping[str, Any]:
    """The figures that the source prints, drawn from the computation."""
    return _function(source.figures)()


def _function(path: str) -> Any:
    module, _, name = path.partition(":")
    return getattr(import_module(module), name)
