"""What the registry holds: printed formulas, relations that are listed only, and claims of the text."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np

from mechsym.audit.verdict import Verdict

Turn = Mapping[str, Callable[[np.ndarray], np.ndarray]]


@dataclass(frozen=True, kw_only=True)
class Printed:
    """A formula as printed, and the derived quantity that it claims to be.

    Parameters
    ----------
    equation : str
        Bare number; several parts of one equation share it
    claim : str
        What it claims to be, in words
    statement : str
        Transcribed as printed, in the author's letters
    quantity : str
        `theory.quantity`
    letters : mapping of str to str
        Author's letter to its expression in the theory's letters
    hold : mapping of str to float
        Letters that the source's assumptions fix
    note : str
        What else there is to say
    turn : callable, optional
        Makes the letters that change over a turn in the source's data
    effect : callable, optional
        Takes the verdict and says how large the error is in a number that matters
    """

    equation: str
    claim: str
    statement: str
    quantity: str
    letters: Mapping[str, str] = field(default_factory=dict)
    hold: Mapping[str, float] = field(default_factory=dict)
    note: str = ""
    turn: Callable[[], Turn] | None = None
    effect: Callable[[Verdict], str] | None = None


@dataclass(frozen=True, kw_only=True)
class Listed:
    """A relation that is not there to be proved.

    Parameters
    ----------
    equation : str
        Bare number
    claim : str
        What it is, in words
    statement : str
        Transcribed as printed
    verdict : str
        `definition` or `empirical`
    note : str
        What else there is to say
    """

    equation: str
    claim: str
    statement: str
    verdict: str
    note: str = ""


@dataclass(frozen=True, kw_only=True)
class Decided:
    """The outcome of the computation that a claim of the text is tied to.

    Parameters
    ----------
    supported : bool
        Whether the computation bears the claim out
    note : str
        The numbers
    rel_error : float or None
        Relative difference of claimed and computed value, where the claim is a number [-]
    """

    supported: bool
    note: str
    rel_error: float | None = None


@dataclass(frozen=True, kw_only=True)
class TextClaim:
    """A claim made in words.

    Parameters
    ----------
    equation : str
        Where it stands: `text`, `abstract`, `conclusion 3`
    claim : str
        The claim, in short
    decide : callable
        The computation that decides it
    """

    equation: str
    claim: str
    decide: Callable[[], Decided]


Entry = Printed | Listed | TextClaim


@dataclass(frozen=True, kw_only=True)
class Source:
    """A source with everything in it that is audited.

    Parameters
    ----------
    stem, short : str
        File stem and short name
    title : str
        Authors, year and title
    entries : tuple of Entry
        In the order of the text
    """

    stem: str
    short: str
    title: str
    entries: tuple[Entry, ...]
