"""`mechsym cycle --diagram`: combustion out of measured pressure, cycle by cycle."""

from pathlib import Path
from typing import Any

from mechsym.cli.common import emit, table


def show(case: Any, diagram: str | None, as_json: bool, out: Path | None) -> None:
    """Print the combustion of a measured diagram, and write its table.

    Parameters
    ----------
    case : Case
        With a cycle of kind `diagram`, or any cycle that a diagram replaces
    diagram : str or None
        CSV file in place of the case's
    """
    from mechsym.files import write_csv
    from mechsym.jobs.measured import measured_combustion, summary

    found = summary(measured_combustion(case, diagram))
    rows = found["cycles"]
    files = [write_csv(out / "combustion.csv", {k: [row[k] for row in rows] for k in rows[0]})] if out else []
    emit(found, as_json, lambda: "\n".join([_text(found), *(f"written: {file}" for file in files)]))


def _text(found: dict[str, Any]) -> str:
    weak = ", ".join(map(str, found["weak_cycles"])) or "none"
    spread = found["tdc_uncertainty_deg"]
    known = "not estimated" if spread is None else f"+- {spread:.2f} deg"
    fits = [
        f"{name}: " + ", ".join(f"{k} {v['value']:.4g} +- {v['confidence']:.2g}" for k, v in fit.items() if k != "rms")
        for name, fit in ((n, found[n]) for n in ("wiebe", "double_wiebe", "compression_line"))
    ]
    lines = [
        table(found["cycles"], list(found["cycles"][0])),
        f"nearly misfired (less than 0.7 of the median work): cycle {weak}",
        f"trapped mass {found['trapped_mass']:.4g} kg",
        f"dead centre {known}; one degree later changes work by {100 * found['per_degree']['work']:+.2f} % and heat "
        f"by {100 * found['per_degree']['heat']:+.2f} %",
    ]
    return "\n".join([*lines, *fits])
