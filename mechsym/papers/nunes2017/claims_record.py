"""What the claims of source 004 share: the reproduction of chapter 4, computed once, by item."""

from collections.abc import Mapping
from functools import cache
from typing import Any

from mechsym.audit.entries import Decided
from mechsym.papers.nunes2017 import sizing as nunes2017_sizing
from mechsym.papers.nunes2017.chapter4 import chapter4


def peaks() -> Mapping[str, Any]:
    """Peaks of the thesis's march.

    Returns
    -------
    peaks : mapping
        `p` [Pa], `F` [N], `T` [N*m], and over the speeds `rpm` and `tooth` [N]
    """
    return chapter4().peaks


@cache
def items() -> dict[str, dict[str, Any]]:
    """Rows of the reproduction of chapter 4.

    Returns
    -------
    items : dict of str to dict
        Keys published, computed, corrected and more, by item
    """
    return {row["item"]: row for row in nunes2017_sizing.rows()}


def right(item: str) -> float:
    """A corrected value.

    Returns
    -------
    value : float
        Corrected where the source slipped, else computed [unit of the item]
    """
    row = items()[item]
    return float(row["computed"] if row["corrected"] is None else row["corrected"])


def against(claimed: float, correct: float, note: str, within: float = 5e-3) -> Decided:
    """Decide a claim that is a number.

    Parameters
    ----------
    claimed, correct : float
        Both values, in the same unit [unit of the claim]
    within : float
        Relative difference up to which the claim stands [-]
    """
    error = claimed / correct - 1
    return Decided(supported=abs(error) <= within, note=note, rel_error=error)
