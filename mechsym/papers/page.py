"""Files of a reproduction: table as CSV, pictures as SVG and PNG, and one HTML page; the axis of figures."""

import io
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from mechsym.files import Json, write_bytes, write_csv, write_text
from mechsym.page import page
from mechsym.papers.rows import KEYS, VERDICTS
from mechsym.papers.sources import Source
from mechsym.style import angle_axis, svg

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_DPI = 110
_ROUND_OFF = 1e-10  # computed numbers are sized as the papers print them


def write(
    folder: Path, sources: Sequence[Source], rows: Mapping[str, Sequence[Json]], differences: Sequence[str]
) -> list[Path]:
    """Write everything into a folder, which is made when missing.

    rows: of each source by its stem; differences: how the outcome differs from the recorded one.
    """
    figures = {source.stem: source.figures() for source in sources}
    drawn = {stem: {n: svg(f, f"{stem} {n}") for n, f in own.items()} for stem, own in figures.items()}
    text = page(
        "reproduction.html",
        sources=sources,
        rows=rows,
        counts={s.stem: counts(rows[s.stem]) for s in sources},
        pictures=drawn,
        differences=differences,
        round_off=round_off,
    )
    files = [write_text(folder / "reproduction.html", text)]
    flat = [row for source in sources for row in rows[source.stem]]
    files.append(write_csv(folder / "reproduction.csv", {key: [r[key] for r in flat] for key in KEYS}))
    for source in sources:
        for name, figure in figures[source.stem].items():
            files.append(write_text(folder / source.name / f"{name}.svg", drawn[source.stem][name]))
            buffer = io.BytesIO()
            # no software version in the file, so that equal data give equal bytes
            figure.savefig(buffer, format="png", dpi=_DPI, metadata={"Software": None})
            files.append(write_bytes(folder / source.name / f"{name}.png", buffer.getvalue()))
    return files


def round_off(value: object) -> bool:
    """Whether a computed number is nothing but round-off."""
    return isinstance(value, float) and 0 < abs(value) < _ROUND_OFF


def counts(rows: Sequence[Json]) -> dict[str, int]:
    """How many rows have each verdict, in the order of the verdicts."""
    count = Counter(row["verdict"] for row in rows)
    return {verdict: count[verdict] for verdict in VERDICTS}


def turn_axis(axis: "Axes") -> None:
    """A turn of the crank along the axis of a figure, in eighths."""
    angle_axis(axis, 360.0)
    axis.set_xlabel("crank angle [deg]")
