"""Files of a reproduction: table as CSV, pictures as SVG and PNG, and one HTML page that opens offline."""

import io
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from mechsym.files import write_bytes, write_csv, write_text
from mechsym.page import page
from mechsym.papers.rows import KEYS, VERDICTS
from mechsym.papers.sources import Source
from mechsym.style import svg

_DPI = 110
_ROUND_OFF = 1e-10  # computed numbers are sized as the papers print them


def write(
    folder: Path,
    sources: Sequence[Source],
    rows: Mapping[str, Sequence[dict[str, Any]]],
    differences: Sequence[str],
) -> list[Path]:
    """Write everything.

    Parameters
    ----------
    folder : Path
        Where to write; made when missing
    rows : mapping of str to sequence of dict
        Rows of each source by its stem
    differences : sequence of str
        How the outcome differs from the recorded one
    """
    figures = {source.stem: source.figures() for source in sources}
    drawn = {stem: {n: svg(f, f"{stem} {n}") for n, f in found.items()} for stem, found in figures.items()}
    files = [write_text(folder / "reproduction.html", html(sources, rows, drawn, differences))]
    flat = [row for source in sources for row in rows[source.stem]]
    files.append(write_csv(folder / "reproduction.csv", {key: [r[key] for r in flat] for key in KEYS}))
    for source in sources:
        for name, figure in figures[source.stem].items():
            files.append(write_text(folder / source.name / f"{name}.svg", drawn[source.stem][name]))
            files.append(_write_png(folder / source.name / f"{name}.png", figure))
    return files


def html(
    sources: Sequence[Source],
    rows: Mapping[str, Sequence[dict[str, Any]]],
    drawn: Mapping[str, Mapping[str, str]],
    differences: Sequence[str],
) -> str:
    """The page as text.

    Parameters
    ----------
    rows : mapping of str to sequence of dict
        Rows of each source by its stem
    drawn : mapping of str to mapping
        Figures of each source as SVG, by its stem
    differences : sequence of str
        How the outcome differs from the recorded one
    """
    return page(
        "reproduction.html",
        sources=sources,
        rows=rows,
        counts={s.stem: counts(rows[s.stem]) for s in sources},
        pictures=drawn,
        differences=differences,
        round_off=round_off,
    )


def round_off(value: object) -> bool:
    """Whether a computed number is nothing but round-off."""
    return isinstance(value, float) and 0 < abs(value) < _ROUND_OFF


def counts(rows: Sequence[dict[str, Any]]) -> dict[str, int]:
    """How many rows have each verdict.

    Returns
    -------
    counts : dict of str to int
        In the order of the verdicts
    """
    found = Counter(row["verdict"] for row in rows)
    return {verdict: found[verdict] for verdict in VERDICTS}


def _write_png(path: Path, figure: Any) -> Path:
    buffer = io.BytesIO()
    # no software version in the file, so that equal data give equal bytes
    figure.savefig(buffer, format="png", dpi=_DPI, metadata={"Software": None})
    return write_bytes(path, buffer.getvalue())
