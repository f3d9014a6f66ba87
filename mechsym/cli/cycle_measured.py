"""`mechsym cycle --diagram`: combustion out of measured pressure, cycle by cycle."""

from pathlib import Path
from typing import Any

from mechsym.cli.common import emit, table
from mechsym.quantities.display import figure, shown_in

_UNITS = {"pressure": "Pa", "tdc": "rad", **dict.fromkeys(("start", "duration", "duration_p", "duration_d"), "rad")}


def show(case: Any, files: tuple[str | None, str | None], as_json: bool, out: Path | None) -> None:
    """Print the combustion of a measured diagram, and write its table.

    Parameters
    ----------
    case : Case
        With a cycle of kind `diagram`, or any cycle that a diagram replaces
    files : tuple of str or None
        CSV files of the diagram and of a motored record, in place of the case's
    """
    from mechsym.files import write_quantities
    from mechsym.jobs.measured import measured_combustion, summary

    found = summary(measured_combustion(case, *files))
    rows = found["cycles"]
    written = [write_quantities(out / "combustion.csv", {k: [row[k] for row in rows] for k in rows[0]})] if out else []
    emit(found, as_json, lambda: "\n".join([_text(found), *(f"written: {file}" for file in written)]))


def _text(found: dict[str, Any]) -> str:
    weak = ", ".join(map(str, found["weak_cycles"])) or "none"
    per_degree = found["per_degree"]
    lines = [
        table(found["cycles"], list(found["cycles"][0])),
        found["read_and_used"],
        f"mean: {found['mep_bar']:.3g} bar indicated at {found['speed_rpm']:.0f} rpm, exponents "
        f"{found['n_compression']:.3f} (compression), {found['n_expansion']:.3f} (expansion)",
        f"nearly misfired (less than 0.7 of the median work): cycle {weak}",
        f"trapped mass {found['trapped_mass']:.4g} kg",
        f"dead centre {_known(found['dead_centre'])}; one degree later changes work by "
        f"{100 * per_degree['work']:+.2f} % and heat by {100 * per_degree['heat']:+.2f} %",
    ]
    return "\n".join([*lines, *_lag(found["lag"]), *_fits(found)])


def _known(centre: dict[str, Any]) -> str:
    low, high = centre["interval_deg"]
    if low == high:
        return f"{centre['deg']:.2f} deg as given"
    assumed = f"{100 * centre['prior_share']:.0f} % of its variance assumed, not measured"
    return f"{centre['deg']:.2f} deg by {centre['method']}, 19 times in 20 between {low:.2f} and {high:.2f} ({assumed})"


def _lag(lag: dict[str, Any] | None) -> list[str]:
    if lag is None:
        return []
    (low, high), (slow, fast) = (1e3 * end for end in lag["interval_seconds"]), lag["speeds_rpm"]
    says = f"sensor's lag by cycles of {slow:.0f} to {fast:.0f} rpm: 19 times in 20 between {low:.3f} and {high:.3f} ms"
    if not lag["told"]:
        usual = " to ".join(f"{1e3 * end:g}" for end in lag["usual_seconds"])
        return [f"{says}, wider than what is usual of any sensor ({usual} ms): the dead centre holds the lag"]
    if lag["dead_centre_deg"] is None:
        return [says]
    ends = " and ".join(f"{end:.2f}" for end in lag["dead_centre_interval_deg"])
    return [f"{says}; dead centre without it {lag['dead_centre_deg']:.2f} deg, between {ends}"]


def _fits(found: dict[str, Any]) -> list[str]:
    fits = ((name, found[name]) for name in ("wiebe", "double_wiebe", "compression_line") if found[name])
    return [
        f"{name.replace('_', ' ')}: " + ", ".join(_fitted(k, v) for k, v in fit.items() if k != "rms")
        for name, fit in fits
    ]


def _fitted(name: str, known: dict[str, float]) -> str:
    (value, half), unit = shown_in([known["value"], known["confidence"]], _UNITS.get(name, "-"))
    return f"{name.replace('_', ' ')} {figure(value, 4)} +- {figure(half, 2)} {unit}".removesuffix(" -")
