"""Code named by a text, so that it is imported only when it is wanted."""

import sys
import warnings
from collections.abc import Callable, Mapping
from importlib import import_module
from types import ModuleType
from typing import Any

#: Older name of something public, as `mechsym.room.name`, to the name that it has since a version, and that version;
#: a row stays as long as docs/stability.md promises. Version 1.0 renamed nothing
RENAMED: dict[str, tuple[str, str]] = {}


def load(entry: str) -> Any:
    """What a text `module:name` names.

    >>> load("math:hypot")(3.0, 4.0)
    5.0
    """
    module, _, name = entry.partition(":")
    return getattr(import_module(module), name)


def lazily(room: str, names: Mapping[str, str]) -> Callable[[str], Any]:
    """The `__getattr__` of a package that loads each of its names, a text `module:name`, on first use.

    A name of `RENAMED` is what its new name is, with a warning: a room without lazy names gives it an empty mapping.
    """
    package = sys.modules[room]
    package.__dict__["_NAMES"] = names
    package.__class__ = _Lazy

    def found(name: str) -> Any:
        new, since = RENAMED.get(f"{room}.{name}", ("", ""))
        if new:
            warnings.warn(f"{room}.{name} is {new} since version {since}; write that", DeprecationWarning, stacklevel=2)
            return load(":".join(new.rsplit(".", 1)))
        if name not in names:
            raise AttributeError(f"module {room!r} has no attribute {name!r}")
        setattr(package, name, load(names[name]))
        return package.__dict__[name]

    return found


class _Lazy(ModuleType):
    """A package some of whose names are those of its own modules: `jobs.hinge` is the job, not its page."""

    def __setattr__(self, name: str, value: object) -> None:
        # the import of a module would bind it under its name, in place of what has that name
        if not (isinstance(value, ModuleType) and name in self.__dict__["_NAMES"]):
            super().__setattr__(name, value)

    def __dir__(self) -> list[str]:
        return list(self.__dict__.get("__all__") or super().__dir__())
