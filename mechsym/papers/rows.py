"""A row of a reproduction: what a source prints beside what the computation gives."""

from typing import Any

from mechsym.errors import BadInput

REPRODUCED, SLIP = "reproduced", "reproduced with the source's slip"
NOT_REPRODUCED, NOT_COMPUTABLE = "not reproduced", "not computable"
# follows from other printed numbers without any model: it checks the source's arithmetic and nothing else
ARITHMETIC = "arithmetic of the source"
VERDICTS = (REPRODUCED, SLIP, NOT_REPRODUCED, NOT_COMPUTABLE, ARITHMETIC)
# `printed` keeps the digits and the words of the source, `published` is its number
KEYS = ("source", "item", "published", "computed", "rel_error", "verdict", "note", "printed")


def row(
    source: str, item: str, published: str | None, computed: float | None, verdict: str, note: str = ""
) -> dict[str, Any]:
    """One row under its documented keys.

    Parameters
    ----------
    item : str
        What it is, with its place in the source and the unit
    published : str or None
        As printed: a number or a statement; None when the source gives no value
    computed : float or None
        In the unit of the print; None when nothing can be computed [-]
    note : str
        What is missing, which slip, how far off

    Returns
    -------
    row : dict
        Keys `KEYS`; published is None for words, rel_error unless both are numbers and the published one is not 0
    """
    if verdict not in VERDICTS:
        raise BadInput(f"verdict {verdict!r} is not an option; options are {', '.join(VERDICTS)}")
    value = number(published)
    error = computed / value - 1 if computed is not None and value else None
    return dict(zip(KEYS, (source, item, value, computed, error, verdict, note, published), strict=True))


def number(text: str | None) -> float | None:
    """The value of a printed text.

    Parameters
    ----------
    text : str or None
        A number as printed, or words

    Returns
    -------
    value : float or None
        None for words [-]
    """
    try:
        return None if text is None else float(text)
    except ValueError:
        return None


def last_digit(text: str) -> float:
    """Value of one unit in the last printed digit.

    Returns
    -------
    unit : float
        For example 0.001 for `9.188` [-]
    """
    mantissa, _, exponent = text.lower().partition("e")
    return 10.0 ** (int(exponent or 0) - len(mantissa.partition(".")[2]))


def by_digits(published: str, computed: float) -> str:
    """Verdict on a number by its printed digits alone.

    Parameters
    ----------
    computed : float
        What the computation gives, in the same unit [-]

    Returns
    -------
    verdict : str
        `reproduced` when rounding gives the print, else `not reproduced`
    """
    return REPRODUCED if abs(computed - float(published)) <= 0.5 * last_digit(published) else NOT_REPRODUCED
