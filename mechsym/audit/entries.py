"""What a paper holds: printed formulas, relations that are listed only, and claims of the text."""

from collections.abc import Callable, Mapping
from dataclasses import field
from typing import Protocol

import numpy as np

from mechsym.audit.verdict import Decision
from mechsym.quantities import record

Turn = Mapping[str, Callable[[np.ndarray], np.ndarray]]


@record
class Printed:
    """A formula as printed, and the derived quantity that it claims to be."""

    equation: str  #: Bare number; several parts of one equation share it
    claim: str  #: What it claims to be, in words
    statement: str  #: Transcribed as printed, in the author's letters
    quantity: str
    #: Author's letter to its expression in the theory's letters
    letters: Mapping[str, str] = field(default_factory=dict)
    hold: Mapping[str, float] = field(default_factory=dict)  #: Letters that the source's assumptions fix
    note: str = ""  #: What else there is to say
    turn: Callable[[], Turn] | None = None  #: Makes the letters that change over a turn in the source's data
    #: Takes the verdict and says how large the error is in a number that matters
    effect: Callable[[Decision], str] | None = None


@record
class Listed:
    """A relation that is not there to be proved."""

    equation: str
    claim: str
    statement: str
    verdict: str
    note: str = ""  #: What else there is to say


@record
class Decided:
    """The outcome of the computation that a claim of the text is tied to."""

    supported: bool  #: Whether the computation bears the claim out
    note: str
    #: Relative difference of claimed and computed value, where the claim is a number [-]
    rel_error: float | None = None


@record
class TextClaim:
    """A claim made in words."""

    equation: str  #: Where it stands: `text`, `abstract`, `conclusion 3`
    claim: str
    decide: Callable[[], Decided]


Entry = Printed | Listed | TextClaim


class Audited(Protocol):
    """A source as the auditor needs it: a paper of `mechsym.papers`."""

    @property
    def stem(self) -> str:
        """Of its file."""

    @property
    def name(self) -> str:
        """In one word."""

    @property
    def title(self) -> str:
        """Authors, year and title."""

    @property
    def entries(self) -> tuple[Entry, ...]:
        """Everything that is audited, in the order of the text."""
