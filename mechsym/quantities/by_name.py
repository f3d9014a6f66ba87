"""Code named by a text, so that it is imported only when it is wanted."""

from importlib import import_module
from typing import Any


def load(entry: str) -> Any:
    """What a text `module:name` names.

    Examples
    --------
    >>> load("math:hypot")(3.0, 4.0)
    5.0
    """
    module, _, name = entry.partition(":")
    return getattr(import_module(module), name)
