"""Numbers of a JSON value by their paths, and whether a list of results has them."""

import functools
import re
from collections.abc import Iterable, Iterator, Mapping
from typing import Any

#: Commands whose numbers are those of a file that they print, or ranges of keys beside their unit
WITHOUT = {"cases", "sections"}
#: Every command's, and what has to be known first: their numbers stand beside their unit
DOUBTS = ("doubts", "accepted", "headline")
_FIGURES = {"count", "first", "last", "min", "max"}  # of a long list, as records keep it


def numbers(found: Any, path: str = "") -> Iterator[str]:
    """Paths of all numbers, a place in a list as `[]`."""
    if isinstance(found, Mapping) and found.keys() <= _FIGURES and "count" in found:
        yield path
    elif isinstance(found, Mapping) and found.keys() == {"count", "some"}:
        yield from numbers(found["some"], path)
    elif isinstance(found, Mapping):
        for name, inner in found.items():
            if name not in DOUBTS:
                yield from numbers(inner, f"{path}.{name}" if path else name)
    elif isinstance(found, list):
        for inner in found:
            yield from numbers(inner, path if _number(inner) else f"{path}[]")
    elif _number(found):
        yield path


def listed(path: str, rows: Iterable[Mapping[str, str]]) -> bool:
    """Whether rows of `mechsym sections --results` have a path; a `*` stands for any name, with dots too."""
    bare = _bare(path)
    return any(_pattern(row["path"]).fullmatch(bare) for row in rows)


def _bare(path: str) -> str:
    return path.replace("[]", "").lstrip(".")


@functools.cache
def _pattern(path: str) -> re.Pattern[str]:
    return re.compile(re.escape(_bare(path)).replace(r"\*", ".+"))


def _number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)
