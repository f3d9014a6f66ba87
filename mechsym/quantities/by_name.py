"""Code named by a text, so that it is imported only when it is wanted."""

import sys
from collections.abc import Callable, Mapping
from importlib import import_module
from types import ModuleType
from typing import Any


def load(entry: str) -> Any:
    """What a text `module:name` names.

    >>> load("math:hypot")(3.0, 4.0)
    5.0
    """
    module, _, name = entry.partition(":")
    return getattr(import_module(module), name)


def lazily(room: str, names: Mapping[str, str]) -> Callable[[str], Any]:
    """The `__getattr__` of a package that loads each of its names, a text `module:name`, on first use."""
    package = sys.modules[room]
    package.__dict__["_NAMES"] = names
    package.__class__ = _Lazy

    def found(name: str) -> Any:
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
