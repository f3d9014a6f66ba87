"""Moroianu (2017): nine curves of forces without any data, so that nothing can be compared number by number."""

from typing import Any

from mechsym.reproduce.rows import row

SOURCE = "001_a140ef4f7e005dde"
_FIGURES = {
    "1": "pressure force", "3": "inertia force", "4": "total force", "6": "longitudinal force", "7": "normal force",
    "9": "radial force", "10": "tangential force", "11": "total radial force", "12": "driving moment",
}  # fmt: skip


def rows() -> list[dict[str, Any]]:
    """The paper's figures.

    Returns
    -------
    rows : list of dict
        Keys source, item, published, computed, rel_error, verdict, note
    """
    missing = "the figure's curve is not in the text, and the paper prints no masses, lengths, speed or diagram"
    return [row(SOURCE, f"Fig. {n}: {name}", None, None, "not computable", missing) for n, name in _FIGURES.items()]
