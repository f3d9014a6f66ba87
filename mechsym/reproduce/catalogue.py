"""The sources whose numbers are computed again, by file stem and by short name."""

import importlib
from collections.abc import Callable
from typing import Any

from mechsym.errors import BadInput

# short name: (file stem, module with rows(), module and function with the figures)
_SOURCES: dict[str, tuple[str, str, str]] = {
    "zotov2024": ("000_9f2b746dc1abd296", "zotov2024", "plots:zotov2024"),
    "moroianu2017": ("001_a140ef4f7e005dde", "moroianu2017", ""),
    "chmielewski2015": ("002_d7297926d6c52225", "chmielewski2015", "plots:chmielewski2015"),
    "prymak": ("003_8746f5f4ad51b1d1", "prymak", "plots:prymak"),
    "nunes2017": ("004_e00ef50339108dab", "nunes2017", "nunes2017_plots:nunes2017"),
}


def short_name(source: str) -> str:
    """Short name of a source.

    Parameters
    ----------
    source : str
        File stem, with or without its end, or short name

    Returns
    -------
    name : str
        Short name

    Raises
    ------
    BadInput
        No such source
    """
    for name, (stem, _, _) in _SOURCES.items():
        if source.removesuffix(".txt") in (name, stem, stem[:3]):
            return name
    names = ", ".join(f"{name} ({stem})" for name, (stem, _, _) in _SOURCES.items())
    raise BadInput(f"source {source!r} is not known; there are {names}")


def names() -> list[str]:
    """Short names of all sources.

    Returns
    -------
    names : list of str
        In the order of the sources
    """
    return list(_SOURCES)


def rows(name: str) -> list[dict[str, Any]]:
    """The published numbers of a source with their verdicts.

    Parameters
    ----------
    name : str
        Short name

    Returns
    -------
    rows : list of dict
        Keys source, item, published, computed, rel_error, verdict, note
    """
    found = importlib.import_module(f"mechsym.reproduce.{_SOURCES[name][1]}").rows()
    return [row | {"published": None if row["published"] is None else float(row["published"])} for row in found]


def figures(name: str) -> Callable[[], dict[str, Any]] | None:
    """What draws the figures of a source as the source drew them.

    Parameters
    ----------
    name : str
        Short name

    Returns
    -------
    draw : callable or None
        Gives matplotlib figures by file stem; None when nothing can be drawn
    """
    place = _SOURCES[name][2]
    if not place:
        return None
    module, _, function = place.partition(":")
    return getattr(importlib.import_module(f"mechsym.reproduce.{module}"), function)
