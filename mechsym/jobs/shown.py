"""What of the jobs' results is worth seeing; rooms below show their own."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from mechsym.jobs.compare import EngineComparison, unit_of
from mechsym.jobs.cycle import CycleFigures
from mechsym.jobs.optimise import Optimised
from mechsym.jobs.run import FinishedRun
from mechsym.jobs.size import Sizing
from mechsym.page import Card, Picture, View, shows
from mechsym.quantities.display import figure, quantity_text, ratio_text
from mechsym.sizing.rows import COLUMNS

_CYCLE = (("power", "power_kw", 1e3, "W"), ("mean torque", "torque_avg", 1.0, "N*m"),
          ("mean indicated pressure", "mep_kpa", 1e3, "Pa"), ("peak pressure", "p_max_mpa", 1e6, "Pa"),
          ("brake power", "brake_power_kw", 1e3, "W"))  # fmt: skip


@shows(CycleFigures)
def cycle_view(found: CycleFigures) -> View:
    """Power, torque, pressures, consumption; of several speeds each where it is largest."""
    rpm = np.asarray(found["speed_rpm"])
    one = rpm.size == 1
    cards = [Card(name="speed", value=quantity_text(float(rpm[0]) * np.pi / 30, "rad/s", 4))] if one else []
    cylinders = found.get("cylinders", 1)
    for name, key, factor, unit in _CYCLE:
        if key.startswith("brake") and not np.any(found.get("friction_mep_kpa", 0.0)):
            continue  # nothing is known of friction
        values = np.asarray(found.get(key, np.nan), dtype=float)
        if np.isfinite(values).any():
            k = int(np.nanargmax(values))
            told = "" if one else f"largest, at {figure(float(rpm[k]), 4)} rpm"
            if cylinders > 1 and key in found.get("per_cylinder", {}):
                told = f"{told + ', ' if told else ''}of {cylinders} {found.get('each', 'cylinder')}s together"
            cards.append(Card(name=name, value=quantity_text(factor * float(values.flat[k]), unit, 4), about=told))
    best = np.asarray(found.get("efficiency", np.nan), dtype=float)
    if np.isfinite(best).any():
        missing = "friction is" if "volumetric_efficiency" in found else "gas exchange and friction are"
        about = (
            "indicated, of the heat from the hot side"
            if "heat_in_j" in found
            else f"indicated, of the fuel's heating value; {missing} not in it"
        )
        cards.append(Card(name="efficiency", value=f"{figure(100 * float(np.nanmax(best)), 4)} %", about=about))
    drawn = (
        () if one else (Picture(name="speeds", see="Torque and power over the speed.", draw=lambda: _speeds(found)),)
    )
    return View(title="Engine cycle", cards=tuple(cards), pictures=drawn, columns=lambda: _flat(found, rpm.size))


def _flat(found: Mapping[str, Any], size: int) -> dict[str, Any]:
    return {k: v for k, v in found.items() if isinstance(v, np.ndarray) and v.shape == (size,)}


def _speeds(found: Mapping[str, Any]) -> Any:
    from mechsym.style import BLUE, axis_unit, panels

    made, axes = panels(9, 3.2, 1, 2, "Torque and power over the speed")
    omega = np.asarray(found["speed_rpm"]) * np.pi / 30
    curves = (("mean torque", np.asarray(found["torque_avg"]), "N*m"), ("power", 1e3 * found["power_kw"], "W"))
    for axis, (name, values, si) in zip(axes, curves, strict=True):
        (across, rpm), (factor, unit) = axis_unit("rad/s", omega), axis_unit(si, values)
        axis.plot(omega * across, values * factor, color=BLUE)
        axis.set(xlabel=f"speed [{rpm}]", ylabel=f"{name} [{unit}]")
    return made


@shows(EngineComparison)
def comparison_view(found: EngineComparison) -> View:
    """Where the torque curves of two engines cross."""
    crossing = ", ".join(quantity_text(float(v) * np.pi / 30, "rad/s") for v in found["crossover_rpm"])
    card = Card(name="mean torque crosses at", value=crossing or "no speed")
    rows = found["table"]
    columns = {n: [row[n] for row in rows] for n in ("quantity", "speed_rpm", "a", "b", "difference")}
    columns["unit"] = [unit_of(row["quantity"]) for row in rows]
    return View(title="Two engines", cards=(card,), columns=lambda: columns)


@shows(Sizing)
def sizing_view(found: Sizing) -> View:
    """Whether every factor holds, and the tightest checks."""
    checks = [row for row in found.rows if row["limit"] is not None and row["safety_factor"] is not None]
    state = f"{len(found.failing)} of {len(checks)} too low" if found.failing else "all hold"
    about = f"{len(checks)} checks; masses and loads {'agree' if found.converged else 'do NOT agree'}"
    cards = [Card(name="safety factors", value=state, about=about, mark="no" if found.failing else "yes")]
    if not checks and not found.failing:
        cards = [Card(name="sizes", value="loads only", about="no rule sizes its parts")]
    for row in tightest(found)[:3]:
        wanted = f"factor; wanted {figure(row['wanted'])}"
        cards.append(Card(name=f"{row['component']}, {row['quantity']}", about=wanted,
                          value=figure(row["safety_factor"], 4), mark="" if row["holds"] else "no"))  # fmt: skip
    drawn: tuple[Picture, ...] = ()
    if found.stock is not None:
        see = "Section to scale at top dead centre: the sizes of the tables, and whether they fit."
        drawn = (Picture(name="section", see=see, draw=lambda: _section(found)),)
    return View(title="Sizes and safety factors", cards=tuple(cards), pictures=drawn,
                columns=lambda: {name: [row[name] for row in found.rows] for name in COLUMNS})  # fmt: skip


def tightest(found: Sizing) -> list[dict[str, Any]]:
    """Checks with a factor, the least beside the wanted one first."""
    rows = [row for row in found.rows if row["limit"] and row["safety_factor"] is not None and row["wanted"]]
    return sorted(rows, key=lambda row: float(row["safety_factor"] / row["wanted"]))


def _section(found: Sizing) -> Any:
    from mechsym.sizing.drawing import section

    return section(found.parts, found.forces, found.stock)  # type: ignore[arg-type]


@shows(Optimised)
def optimised_view(found: Optimised) -> View:
    """The best design and what stops it from being better."""
    best = found.best
    cards = [
        Card(name="optimum", value=best.status, about=best.reason, mark="yes" if best.status == "optimal" else "no")
    ]
    aim = next((name for name, v in best.figures.items() if v == best.objective), "")
    cards += [Card(name="objective", value=quantity_text(best.objective, found.units.get(aim, "-")), about=aim)]
    cards += [Card(name=name, value=quantity_text(value, found.units.get(name, "-")))
              for name, value in best.variables.items()]  # fmt: skip
    cards += [Card(name=f"limit {row['name']}", value=f"{row['side']} {quantity_text(row['limit'], row['unit'])}",
                   about=row["meaning"]) for row in best.active]  # fmt: skip
    points = found.front or (best,)
    return View(title="Best design", cards=tuple(cards), columns=lambda: {
        **{name: [p.variables[name] for p in points] for name in best.variables},
        "objective": [p.objective for p in points], "status": [p.status for p in points]})  # fmt: skip


@shows(FinishedRun)
def run_view(run: FinishedRun) -> View:
    """Speeds, end and audit of a run in time."""
    told = run.summary
    mean, low, high = (run.speed[key] for key in ("mean", "min", "max"))
    where = f"over the last period{f', of the {run.engine.words}' if run.engine and run.engine.words else ''}"
    good = told["status"] not in ("failed", "not converged", "chaotic")
    share = (high - low) / mean if mean else None
    ripple = "–" if share is None else ratio_text(share) if abs(share) < 1e-6 else f"{figure(100 * share, 3)} %"
    cards = [
        Card(name="run", value=told["status"], about=told["reason"], mark="" if good else "no"),
        Card(name="mean speed", value=quantity_text(mean, "rad/s", 4), about=f"{span(low, high)} {where}"),
        Card(name="speed ripple", value=ripple, about=where),
        Card(name="energy residual", value=ratio_text(told["energy_residual"], 2), about="of the work brought in"),
    ]  # fmt: skip
    cards += [Card(name=f"twist of section {s.section}", value=quantity_text(s.twist_peak, "rad", 4), about="peak")
              for s in run.twist]  # fmt: skip
    return View(title="Run in time", cards=tuple(cards), pictures=_run_pictures(run),
                columns=lambda: {"t": run.result.t, **run.result.columns})  # fmt: skip


def span(low: float, high: float) -> str:
    """Least and greatest speed; one that stays is told once.

    Parameters
    ----------
    low, high : float
        Speeds [rad/s]
    """
    ends = [quantity_text(speed, "rad/s", 4) for speed in (low, high)]
    return f"steady at {ends[0]}" if ends[0] == ends[1] else " to ".join(ends)


def _run_pictures(run: FinishedRun) -> tuple[Picture, ...]:
    from mechsym.simulate.plots import speed
    from mechsym.torsion import plots

    result, engine, starts, found = run.result, run.engine, run.start_ups, []
    if engine is not None and len(result.t) > 1:
        see = "Speed over time with its mean over each period, and the last period over the angle."
        found.append(Picture(name="speed", see=see, draw=lambda: speed(
            result, engine.coordinate, engine.period, engine.wanted, engine.words)))  # fmt: skip
    if run.twist:
        see = "Twist of each shaft section: the peak decides on the shaft."
        found.append(Picture(name="twist", see=see, draw=lambda: plots.twist(result, len(run.twist))))
    if starts:
        see = "Where an order of the drive meets a natural frequency the start-up may be held."
        found.append(Picture(name="campbell", see=see, draw=lambda: plots.campbell(starts[0])))
        see = "The start-up with its dampers: held below a critical speed, or through it."
        found.append(Picture(name="startup", see=see, draw=lambda: plots.start_up(starts, starts[0].claim.claim_speed)))
    return tuple(found)
