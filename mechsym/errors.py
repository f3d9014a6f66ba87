"""The errors that a user can mend, and their words. The command line prints one line and ends with exit status 2."""

import difflib
from collections.abc import Iterable


class BadInput(ValueError):
    """Input that cannot be used.

    The message is one line: what was found (file, key, value, unit), what is allowed, and the way out. What a reader of
    the error has to know stands beside it.
    """

    def __init__(self, why: str = "", way: str = "", *, key: str = "", reason: str = "") -> None:
        """An error of a key, told by why it is one and the way out; reason: that of the system, in a few words."""
        super().__init__(f"{why}; {way}" if way else why)
        self.why, self.way, self.key, self.reason = why, way, key, reason


class MissingSection(BadInput):
    """A case lacks a section that a command cannot do without."""


class MissingExtra(BadInput):
    """A command needs an optional package; the message names the extra that brings it."""


def suggest(word: str, options: Iterable[str]) -> str:
    """What is allowed in place of a word that is not, the nearest first.

    Of dotted names the shortest with all parts of the word is the nearest. Returns text: for example ``did you mean
    'bore'? allowed are bore, stroke``.

    >>> suggest("bre", ["bore", "stroke"])
    "did you mean 'bore'? allowed are bore, stroke"
    >>> suggest("R_O.max", ["max.R_A", "max.R_O"])
    "did you mean 'max.R_O'? allowed are max.R_A, max.R_O"
    """
    options, parts = list(options), {*word.split(".")}
    near = sorted((one for one in options if parts <= {*one.split(".")}), key=len)
    near = near or difflib.get_close_matches(word, options, n=1)
    hint = f"did you mean {near[0]!r}? " if near else ""
    return f"{hint}allowed are {', '.join(options)}"


def shown(value: object, longest: int = 60) -> str:
    """A value as a message shows it, cut where it is very long."""
    text = repr(value)
    return text if len(text) <= longest else f"{text[: longest - 3]}..."
