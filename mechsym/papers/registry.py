"""All sources with what is audited in them."""

import importlib

from mechsym.audit.entries import Source
from mechsym.errors import BadInput

_MODULES = ("zotov2024", "moroianu2017", "chmielewski2015", "prymak", "nunes2017")


def sources() -> list[Source]:
    """All sources."""
    return [importlib.import_module(f"mechsym.papers.{name}.printed").SOURCE for name in _MODULES]


def source(name: str) -> Source:
    """A source by its file stem or short name."""
    for found in sources():
        if name.removesuffix(".txt") in (found.stem, found.short, found.stem[:3]):
            return found
    names = ", ".join(f"{s.short} ({s.stem})" for s in sources())
    raise BadInput(f"source {name!r} is not known; there are {names}")
