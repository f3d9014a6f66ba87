"""`mechsym cycle`: the engine cycle at one or many speeds."""

import dataclasses
import sys
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
import numpy as np

from mechsym.cases import Case
from mechsym.cli import common
from mechsym.cli.common import emit, heads, judge_ends, only_of, parse_over, parse_speeds, progress, refuse_idle, table
from mechsym.cycle.columns import AFTER_FRICTION, UNITS, WORDS
from mechsym.cycle.source import BRAKE, IN_CYLINDER, INDICATED
from mechsym.errors import BadInput
from mechsym.files import Json
from mechsym.quantities.display import figure, quantity_text, shown_in
from mechsym.quantities.results import Columns, tell

if TYPE_CHECKING:
    from mechsym.cycle.source import FiguresPage, GasSource
    from mechsym.jobs.indicated import TorquePressure
    from mechsym.jobs.measured import LagTold, MeasuredDiagram
    from mechsym.simulate.loop.run import LoopNumbers


@common.case_command("Engine cycle at one or many speeds.", common.out_option)
@click.option("--speeds", metavar="A:B:STEP", help="Speeds in rpm; without it the case's operating speed.")
@click.option("--over", metavar="NAME=A:B:STEP", help="Run over another value of the engine, at one speed.")
@click.option(
    "--diagram",
    type=click.Path(dir_okay=False),
    multiple=True,
    help="CSV of a measured diagram: combustion from pressure; again: more of the same encoder.",
)
@click.option("--motored", type=click.Path(dir_okay=False), help="CSV without combustion, same encoder: dead centre.")
@click.option("--torque", type=click.Path(dir_okay=False), help="CSV of a measured crank torque: pressure from it.")
@click.option("--noise", metavar="TORQUE", help="Standard deviation of each torque of --torque, such as '2 N*m'.")
@click.option("--loop", type=click.FloatRange(0.5, 1000), help="Engine cycles to run with the mechanism in the loop.")
def cycle(case: Case, speeds: str | None, over: str | None, diagram: tuple[str, ...], motored: str | None,
          torque: str | None, noise: str | None, loop: float | None, out: Path | None) -> None:  # fmt: skip
    """Engine cycle of CASE: torque, power, consumption, energy shares, peak pressure.

    Torque and power are the engine's, all cylinders together; of several cylinders those of one stand beside them.

    With --diagram, or a case of kind "diagram": combustion out of measured pressure, cycle by cycle; --motored, a
    record of the same encoder without combustion, gives its dead centre. The sensor's lag is in it; cycles of several
    speeds (a run-down with time_s) tell the lag apart, with its interval. With --torque: the cylinder pressure out of a
    torque over the angle (a file as [torque] takes it), with gaps at the dead centres. With --loop: gas and motion
    integrated together, against the case's load (a propeller without [load]).

    \b
    Examples: mechsym cycle nunes-slider-crank --speeds 500:8000:500
              mechsym cycle nunes-hypocycloid --set cycle.method=nunes2017_printed --speeds 10:8000:10 --json
              mechsym cycle nunes-slider-crank --over "cycle.ignition=-30 deg:0 deg:2 deg" --speeds 4000
              mechsym cycle generator --diagram measured.csv --motored motored.csv
              mechsym cycle zotov-89 --torque torque.csv --noise "200 N*m"
              mechsym cycle nunes-hypocycloid --loop 10
              mechsym cycle alpha-stirling --set cycle.kind=stirling-adiabatic
              mechsym cycle generator-breathing --speeds 1000:4000:500
              mechsym cycle zotov-142 --set scavenging.source=turbocharger --set "scavenging.altitude=2000 m"
    """
    from mechsym.cases.needs import NO_FILE, require
    from mechsym.cycle.kinds import kind_of

    require(case, "cycle", NO_FILE if diagram else "")
    if torque or noise:
        refuse_idle("beside --torque", "speeds", "over", "diagram", "motored", "loop")
        _show_torque(case, torque, noise, out)
    elif diagram or motored or kind_of(case.need("cycle")).measured:
        refuse_idle("for a measured diagram, which has a speed of its own", "speeds", "over", "loop")
        _show_diagram(case, diagram, motored, out)
    elif loop:
        refuse_idle("beside --loop, which starts at the speed of operation", "speeds", "over")
        _show_loop(case, loop, out)
    else:
        omega = parse_speeds(speeds) if speeds is not None else [case.need("operation").speed]
        judge_ends(case, "operation.speed", omega)
        _show_figures(case, omega, over, out)


def _show_torque(case: Case, file: str | None, noise: str | None, out: Path | None) -> None:
    from mechsym.files import write_quantities
    from mechsym.forces.plots import pressure_picture
    from mechsym.jobs.indicated import indicated
    from mechsym.quantities import parse

    if file is None:
        raise BadInput("--noise belongs to --torque FILE; give both")
    if noise is None:
        raise BadInput("--torque needs --noise, the standard deviation of each torque, such as --noise '2 N*m'")
    result = indicated(case, file, parse(noise, "N*m", "--noise"))
    files = [
        write_quantities(out / "pressure.csv", result.pressure, result.pressure.units),
        pressure_picture(out / "pressure.svg", result.indicated, result.period),
    ] if out else []  # fmt: skip
    emit(result, lambda: _torque(result), files=files)


def _show_diagram(case: Case, diagram: tuple[str, ...], motored: str | None, out: Path | None) -> None:
    from mechsym.files import write_quantities, write_text
    from mechsym.jobs.measured import MeasuredCycle, measured_combustion

    case = only_of(case, "cycle")
    result = measured_combustion(case, diagram, motored)
    names = [field.name for field in dataclasses.fields(MeasuredCycle)]
    columns = {name: [getattr(cycle, name) for cycle in result.cycles] for name in names}
    files = []
    if out:
        from mechsym.report.build import combustion_html

        files = [write_quantities(out / "combustion.csv", columns, heads(MeasuredCycle)),
                 write_text(out / "combustion.html", combustion_html(case, result))]  # fmt: skip
    emit(result, lambda: _diagram(result), files=files)


def _show_loop(case: Case, cycles: float, out: Path | None) -> None:
    from mechsym.cases.outcomes import of_limits
    from mechsym.files import write_quantities
    from mechsym.jobs.run import loop
    from mechsym.simulate.loop.run import run_loop, series, summary

    machine = loop(case)
    run = run_loop(machine, case.need("operation").speed, cycles)
    result = summary(machine, run)
    files = [write_quantities(out / "loop.csv", series(machine, run))] if out else []
    data = tell(result)
    emit(data | {"doubts": of_limits(case, data)}, lambda: _loop(result), files=files)
    if result.status != "done":
        sys.exit(1)


def _show_figures(case: Case, omega: list[float], over: str | None, out: Path | None) -> None:
    from mechsym.cases.outcomes import of_cycle
    from mechsym.cycle.source import ENGINE_PAGE
    from mechsym.jobs.cycle import cycle
    from mechsym.jobs.gas import one_cylinder
    from mechsym.jobs.gas import source as source_of

    units: dict[str, str] = {}
    figures: Any
    if over:
        figures, units = _over(case, omega, over)
    else:
        with progress(len(omega), "cycles") as bar:
            figures = cycle(case, np.asarray(omega), bar.update)
    source = source_of(one_cylinder(case)) if over else figures.source
    files = _write(case, source, figures, omega, out) if out else []
    page, units = source.page if source is not None else ENGINE_PAGE, {**UNITS, **units}
    beside = {"doubts": () if over else of_cycle(case, figures, source_of(case).bound)}
    first = () if over else figures.view.findings()
    emit(figures, lambda: _figures(figures, page, units), beside=beside, files=files, findings=first)


def _over(case: Case, omega: list[float], over: str) -> tuple[Columns, dict[str, str]]:
    """Figures over another value of the engine at one speed, and the units of its names."""
    from mechsym.cycle.engine import columns, over_design
    from mechsym.cycle.kinds import kind_of
    from mechsym.jobs.cycle import cylinders, engine, of_engine
    from mechsym.jobs.gas import one_cylinder
    from mechsym.optimise.solver import design_units
    from mechsym.quantities.results import Columns

    cylinders(case)  # what is wrong with them is said before the work begins
    if not kind_of(case.need("cycle")).closed:
        raise BadInput("--over needs a cycle of kind spark-ignition; for others use 'mechsym sweep'")
    machine = engine(one_cylinder(case))
    if len(omega) > 1:
        raise BadInput("--over runs at one speed; give --speeds one value, or leave it out")
    units = design_units(machine)
    name, values = parse_over(over, units)
    judge_ends(case, name, values)
    design = {"omega": np.asarray(omega), name: np.asarray(values)}
    with progress(len(values), "cycles") as bar:
        figures = columns(over_design(machine, design, bar.update))
    of_design = of_engine(case, {name: design[name]} | figures, None)
    return Columns(of_design, {**dict.fromkeys(of_design, ""), **UNITS, **units}), units


def _write(case: Case, source: "GasSource | None", data: Json, omega: list[float], out: Path) -> list[Path]:
    from mechsym.cycle.plots import performance_picture
    from mechsym.files import write_quantities

    left_out = ("fractions", "loads", "losses", "cylinders", "each", "per_cylinder", "pistons")
    flat = {name: values for name, values in data.items() if name not in left_out}
    if data.get("cylinders", 1) > 1:
        flat |= {f"{name}_per_cylinder": values for name, values in data["per_cylinder"].items()}
    flat |= {f"fraction_{name}": values for name, values in data["fractions"].items()} | data["loads"]
    flat |= {f"loss_{name}_w": values for name, values in data.get("losses", {}).items()}
    units = {**UNITS, **{f"{name}_per_cylinder": unit for name, unit in UNITS.items()}}
    units |= dict.fromkeys(data["loads"], UNITS["loads"])
    files = [write_quantities(out / "performance.csv", flat, units)]
    for name, one in data.get("pistons", {}).items():
        files.append(write_quantities(out / f"performance-{name}.csv", {"speed_rpm": data["speed_rpm"], **one}, UNITS))
    if source is not None and (curves := source.curves(np.asarray(omega), case.need("operation").speed)):
        files += [write_quantities(out / "cycle.csv", curves), source.picture(out / "cycle.svg", curves)]
    if "losses" not in data and len(set(flat["speed_rpm"])) > 1:
        files.append(performance_picture(out / "performance.svg", {"": data}))
    return files


_ROWS = 16  # of a curve, shown on the terminal
_CYCLES = 12  # of a run
_POINTS = 20  # of speeds
_ONE = ("speed_rpm", "brake_power_kw", "brake_torque", "power_kw", "torque_avg", "torque_max")
_PEAKS = ("brake_torque", "brake_power_kw", "torque_avg", "power_kw", "torque_max", "p_max_mpa")
_SCAVENGED = ("speed_rpm", "p_in_kpa", "t_in_k", "p_out_kpa", "t_turbine_k", "t_evc_k", "delivery_ratio",
              "residual_gas", "air_kg_h")  # fmt: skip
_PISTON = (*BRAKE, *INDICATED[1:], *IN_CYLINDER[1:])
_NO_FRICTION = "indicated only: the case has no law of friction, so that nothing is known at the shaft"


def _figures(data: Json, page: "FiguresPage", units: Mapping[str, str]) -> str:
    """Figures over the speeds, or over another value whose name has a dot; nothing is said twice."""
    count = len(data["speed_rpm"])
    every, words = max(1, -(-count // _POINTS)), {**WORDS, **page.words}
    rubs = bool(np.any(data.get("friction_mep_kpa", 0.0)))
    unsaid = {name for name in data if not rubs and name in AFTER_FRICTION}
    if not np.any(data.get("pumping_mep_kpa", 0.0)):
        unsaid |= {"pumping_mep_kpa", "gross_mep_kpa"}

    def block(title: str, names: Iterable[str], columns: Json = data) -> list[str]:
        known = [name for name in names if name in columns and name not in unsaid]
        if set(known) <= {"speed_rpm", *over}:
            return []
        heads = {words.get(name, name): units.get(name, "-") for name in known}  # losses have theirs in the title
        rows = [{words.get(name, name): float(columns[name][i]) for name in known} for i in range(0, count, every)]
        shown = {head: unit for head, unit in heads.items() if unit != "-"}
        return [*([title] if title else []), table(rows, list(heads), shown), ""]

    over = [name for name in data if "." in name]
    lines = []
    if data.get("per_cylinder") and data["cylinders"] > 1:
        lines.append(f"engine of {data['cylinders']} {data['each']}s")
    for title, names in page.tables:
        lines += block(title, [*over, *names])
    beside: dict[str, tuple[tuple[str, ...], Json]] = {
        f"piston {name}": (_PISTON, one) for name, one in data.get("pistons", {}).items()
    }
    if data.get("per_cylinder") and data["cylinders"] > 1:
        beside[f"one {data['each']}"] = _ONE, data["per_cylinder"]
    for title, (names, one) in beside.items():
        lines += block(title, names, {"speed_rpm": data["speed_rpm"], **one})
    if data.get("losses"):
        lines += block("lost [W]: work, and heat past the cycle", data["losses"], data["losses"])
    lines.pop()
    if every > 1:
        lines.append(f"{-(-count // every)} of {count} points shown; all with --json or --out")
    if page.peaks and count > 1 and not over:
        for name in (name for name in _PEAKS if name in data and name not in unsaid):
            at = int(data[name].argmax())
            value = quantity_text(float(data[name][at]), units[name])
            words_of = WORDS[name].removeprefix("largest ")
            lines.append(f"largest {words_of} {value} at {data['speed_rpm'][at]:.0f} rpm")
    if page.peaks and "delivery_ratio" in data:
        lines += ["", *block("turbocharger and scavenging", _SCAVENGED)[:-1]]
    return "\n".join([*lines, "", *([] if rubs or not page.peaks else [_NO_FRICTION]), page.closing(data)])


def _diagram(result: "MeasuredDiagram") -> str:
    """Combustion out of measured pressure, cycle by cycle."""
    from mechsym.cycle.measured.shown import figure_cards
    from mechsym.jobs.measured import MeasuredCycle, RecordAmongOthers

    weak = ", ".join(map(str, result.weak_cycles)) or "none"
    answer = [f"{card.name}: {card.value}" + (f" ({card.about})" if card.about else "")
              for card in figure_cards(result.figures)]  # fmt: skip
    beside = []
    for row in tell(result.records):
        low, high = row.pop("imep_interval_bar")
        cells = list((row | {"file": Path(row["file"]).name}).items())
        at = list(row).index("imep_bar") + 1
        beside.append(dict([*cells[:at], ("95 %", f"{low:.3g} to {high:.3g}"), *cells[at:]]))
    centre = result.dead_centre
    known = f"{centre.deg:.2f} deg as given"
    if centre.interval_deg[0] != centre.interval_deg[1]:
        ends = " to ".join(f"{end:.2f}" for end in centre.interval_deg)
        assumed = f"{100 * (centre.prior_share or 0.0):.0f} % of its variance assumed, not measured"
        known = f"{centre.deg:.2f} deg by {centre.method}, 95 %: {ends} ({assumed})"
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
        f"dead centre {known}; one degree later changes work by {work:+.2f} % and heat by {heat:+.2f} %",
    ]
    fits = {name: getattr(result, name) for name in ("wiebe", "double_wiebe", "compression_line")}
    fitted = (f"{name.replace('_', ' ')}: {_fitted(fit)}" for name, fit in fits.items() if fit)
    return "\n".join([*lines, *_lag(result.lag), *fitted])


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


def _torque(result: "TorquePressure") -> str:
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


def _loop(result: "LoopNumbers") -> str:
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
