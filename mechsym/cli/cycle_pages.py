"""What `mechsym cycle` says to people: figures over the speeds of any gas, a measured diagram, a measured torque, and a
run of cycle and mechanism."""

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from mechsym.cli.common import heads, table
from mechsym.cycle.columns import AFTER_FRICTION, WORDS
from mechsym.cycle.source import BRAKE, IN_CYLINDER, INDICATED
from mechsym.files import Json
from mechsym.quantities.display import figure, quantity_text, shown_in
from mechsym.quantities.results import Columns, tell

if TYPE_CHECKING:
    from mechsym.cycle.source import FiguresPage
    from mechsym.jobs.indicated import TorquePressure
    from mechsym.jobs.measured import DeadCentreTold, LagTold, MeasuredDiagram
    from mechsym.simulate.loop.run import LoopNumbers

_ROWS = 16  # of a curve, shown on the terminal
_CYCLES = 12  # of a run
_POINTS = 20  # of speeds
_ONE = ("speed_rpm", "brake_power_kw", "brake_torque", "power_kw", "torque_avg", "torque_max")
_PEAKS = ("brake_torque", "brake_power_kw", "torque_avg", "power_kw", "torque_max", "p_max_mpa")
_SCAVENGED = ("speed_rpm", "p_in_kpa", "t_in_k", "p_out_kpa", "t_turbine_k", "t_evc_k", "delivery_ratio",
              "residual_gas", "air_kg_h")  # fmt: skip
_PISTON = (*BRAKE, *INDICATED[1:], *IN_CYLINDER[1:])
_NO_FRICTION = "indicated only: the case has no law of friction, so that nothing is known at the shaft"


def figures(found: Json, page: "FiguresPage", units: Mapping[str, str]) -> str:
    """Figures over the speeds, or over another value whose name has a dot; nothing is said twice."""
    count = len(found["speed_rpm"])
    every, words = max(1, -(-count // _POINTS)), {**WORDS, **page.words}
    rubs = bool(np.any(found.get("friction_mep_kpa", 0.0)))
    unsaid = {name for name in found if not rubs and name in AFTER_FRICTION}
    if not np.any(found.get("pumping_mep_kpa", 0.0)):
        unsaid |= {"pumping_mep_kpa", "gross_mep_kpa"}

    def block(title: str, names: Iterable[str], columns: Json = found) -> list[str]:
        known = [name for name in names if name in columns and name not in unsaid]
        if set(known) <= {"speed_rpm", *over}:
            return []
        heads = {words.get(name, name): units.get(name, "-") for name in known}  # losses have theirs in the title
        rows = [{words.get(name, name): float(columns[name][i]) for name in known} for i in range(0, count, every)]
        shown = {head: unit for head, unit in heads.items() if unit != "-"}
        return [*([title] if title else []), table(rows, list(heads), shown), ""]

    over = [name for name in found if "." in name]
    lines = []
    if found.get("per_cylinder") and found["cylinders"] > 1:
        lines.append(f"engine of {found['cylinders']} {found['each']}s")
    for title, names in page.tables:
        lines += block(title, [*over, *names])
    beside: dict[str, tuple[tuple[str, ...], Json]] = {
        f"piston {name}": (_PISTON, one) for name, one in found.get("pistons", {}).items()
    }
    if found.get("per_cylinder") and found["cylinders"] > 1:
        beside[f"one {found['each']}"] = _ONE, found["per_cylinder"]
    for title, (names, one) in beside.items():
        lines += block(title, names, {"speed_rpm": found["speed_rpm"], **one})
    if found.get("losses"):
        lines += block("lost [W]: work, and heat past the cycle", found["losses"], found["losses"])
    lines.pop()
    if every > 1:
        lines.append(f"{-(-count // every)} of {count} points shown; all with --json or --out")
    if page.peaks and count > 1 and not over:
        lines += [_largest(found, name, units[name]) for name in _PEAKS if name in found and name not in unsaid]
    if page.peaks and "delivery_ratio" in found:
        lines += ["", *block("turbocharger and scavenging", _SCAVENGED)[:-1]]
    return "\n".join([*lines, "", *([] if rubs or not page.peaks else [_NO_FRICTION]), page.closing(found)])


def _largest(found: Json, name: str, unit: str) -> str:
    at = int(found[name].argmax())
    value = quantity_text(float(found[name][at]), unit)
    return f"largest {WORDS[name].removeprefix('largest ')} {value} at {found['speed_rpm'][at]:.0f} rpm"


def diagram(result: "MeasuredDiagram") -> str:
    """Combustion out of measured pressure, cycle by cycle."""
    from mechsym.cycle.measured.shown import figure_cards
    from mechsym.jobs.measured import MeasuredCycle, RecordAmongOthers

    weak = ", ".join(map(str, result.weak_cycles)) or "none"
    answer = [f"{card.name}: {card.value}" + (f" ({card.about})" if card.about else "")
              for card in figure_cards(result.figures)]  # fmt: skip
    beside = [_beside(row) for row in tell(result.records)]
    work, heat = (100 * (share or 0.0) for share in (result.per_degree.work, result.per_degree.heat))
    rows = tell(result.cycles)
    lines = [
        *answer,
        f"exponents {result.n_compression:.3f} (compression), {result.n_expansion:.3f} (expansion); "
        f"{result.speed_rpm:.0f} rpm",
        "",
        *([table(beside, list(beside[0]), heads(RecordAmongOthers)), ""] if beside else []),
        table(rows, list(rows[0]), heads(MeasuredCycle)),
        result.read_and_used,
        f"nearly misfired (less than 0.7 of the median work): cycle {weak}",
        f"trapped mass {result.trapped_mass:.4g} kg",
        f"dead centre {_known(result.dead_centre)}; one degree later changes work by {work:+.2f} % and heat by "
        f"{heat:+.2f} %",
    ]
    fits = {name: getattr(result, name) for name in ("wiebe", "double_wiebe", "compression_line")}
    fitted = (f"{name.replace('_', ' ')}: {_fitted(fit)}" for name, fit in fits.items() if fit)
    return "\n".join([*lines, *_lag(result.lag), *fitted])


def _beside(row: Json) -> Json:
    """A record among others: its file's name, and the interval in words."""
    low, high = row.pop("imep_interval_bar")
    at = list(row).index("imep_bar") + 1
    named = {**row, "file": Path(row["file"]).name}
    return dict([*list(named.items())[:at], ("95 %", f"{low:.3g} to {high:.3g}"), *list(named.items())[at:]])


def _known(centre: "DeadCentreTold") -> str:
    low, high = centre.interval_deg
    if low == high:
        return f"{centre.deg:.2f} deg as given"
    assumed = f"{100 * (centre.prior_share or 0.0):.0f} % of its variance assumed, not measured"
    return f"{centre.deg:.2f} deg by {centre.method}, 95 %: {low:.2f} to {high:.2f} ({assumed})"


def _lag(lag: "LagTold | None") -> list[str]:
    if lag is None:
        return []
    (low, high), (slow, fast) = (1e3 * end for end in lag.interval_seconds), lag.speeds_rpm
    says = f"sensor's lag by cycles of {slow:.0f} to {fast:.0f} rpm: 95 %: {low:.3f} to {high:.3f} ms"
    if not lag.told:
        usual = " to ".join(f"{1e3 * end:g}" for end in lag.usual_seconds)
        return [f"{says}, wider than what is usual of any sensor ({usual} ms): the dead centre holds the lag"]
    if lag.dead_centre_deg is None:
        return [says]
    ends = " to ".join(f"{end:.2f}" for end in lag.dead_centre_interval_deg or ())
    return [f"{says}; dead centre without it {lag.dead_centre_deg:.2f} deg, 95 %: {ends}"]


def _fitted(fit: Columns) -> str:
    words = []
    for name, known in fit.items():
        if isinstance(known, Mapping):
            (value, half), unit = shown_in([known["value"], known["confidence"]], fit.units[name])
            low, high = figure(value - half, 3), figure(value + half, 3)
            words.append(
                f"{name.replace('_', ' ')} {figure(value, 3)} {unit}".removesuffix(" -") + f" ({low} to {high})"
            )
    return ", ".join(words)


def torque(result: "TorquePressure") -> str:
    """Cylinder pressure out of a measured torque on the shaft."""
    low, high = (quantity_text(end, "J", 4) for end in result.work_interval_j)
    blind = ", ".join(f"{a:.4g}" if a == b else f"{a:.4g} to {b:.4g}" for a, b in result.gaps_deg)
    pressure, every = result.pressure, max(1, -(-result.told // _ROWS))
    rows = [{name: float(values[i]) for name, values in pressure.items()} for i in range(0, result.told, every)]
    return "\n".join([
        f"{result.case} at {result.speed_rpm:.6g} rpm: pressure at {result.told} of {result.samples} angles",
        table(rows, list(pressure), pressure.units),
        f"{len(rows)} of {result.told} angles shown; all with --json or --out",
        f"work of the gas {quantity_text(result.work_j, 'J', 4)}, 95 %: {low} to {high}",
        f"not told, as the piston hardly moves there: {blind or 'nowhere'} [deg]",
        "low and high: 95 % of each value by itself, from the noise of the torque alone; friction counts as gas",
    ])  # fmt: skip


def loop(result: "LoopNumbers") -> str:
    """The cycle and the mechanism's motion integrated together."""
    ripple = "-" if result.speed_ripple is None else f"{result.speed_ripple:.4g}"
    lines = [
        f"{result.status}: {result.reason}",
        f"last two turns: {result.speed_mean_rpm:.2f} rpm, ripple {ripple}, "
        f"from {result.speed_min_rpm:.2f} to {result.speed_max_rpm:.2f} rpm",
    ]
    if rows := tell(result.cycles):
        units = heads(type(result.cycles[0])) | {"energy_residual": "-", "knock": "-"}
        lines.append(table(rows[-_CYCLES:], list(rows[0]), units))
    return "\n".join([*lines, f"energy of the motion closed to {abs(result.energy_residual):.1g} of the gas work"])
