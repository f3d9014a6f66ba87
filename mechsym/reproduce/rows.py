"""One row of a reproduction."""

from typing import Any

VERDICTS = ("reproduced", "reproduced with the source's slip", "not reproduced", "not computable")


def row(
    source: str, item: str, published: float | None, computed: float | None, verdict: str, note: str
) -> dict[str, Any]:
    """A published number beside the computed one.

    Parameters
    ----------
    source : str
        File stem of the source
    item : str
        What it is, with its unit
    published, computed : float or None
        None where there is no such number [unit of the item]
    verdict : str
        One of VERDICTS
    note : str
        How it was computed, and what is missing or wrong

    Returns
    -------
    row : dict
        Keys source, item, published, computed, rel_error, verdict, note
    """
    error = None
    if published is not None and computed is not None:
        error = computed / published - 1 if published else computed
    return {
        "source": source, "item": item, "published": published, "computed": computed, "rel_error": error,
        "verdict": verdict, "note": note,
    }  # fmt: skip
