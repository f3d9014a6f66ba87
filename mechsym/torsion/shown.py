"""What of a run in time, and of a start-up in it, is worth seeing."""

from mechsym.page import Card, Picture, View, card, shows
from mechsym.quantities.display import figure, quantity_text, ratio_text
from mechsym.quantities.results import Columns
from mechsym.simulate.speed import Speed
from mechsym.torsion import plots
from mechsym.torsion.findings import drift, of_run
from mechsym.torsion.finished import FinishedRun
from mechsym.torsion.startup import StartUp
from mechsym.torsion.twist import ShaftSection, section_words

_ENDS = {"turns": "all turns", "t_end": "to its end", "stall": "the shaft stops"}


@shows(StartUp)
def startup_view(start: StartUp) -> View:
    """The speed that is reached, what held the shaft, and the twist that it bore."""
    held = ", ".join(f"order {c.critical.order:g} from {figure(c.t_start, 3)} s" for c in start.captures)
    bears = start.twist_peak <= start.claim.twist_limit
    limit = quantity_text(start.claim.twist_limit, "rad", 3)
    cards = (
        Card(name="mean speed at the end", value=quantity_text(float(start.speed_mean[-1]), "rad/s", 4)),
        Card(name="held at a critical speed", value=held or "nowhere", mark="no" if held else "yes"),
        Card(
            name="largest twist",
            value=quantity_text(start.twist_peak, "rad", 4),
            about=f"a linear shaft is a model up to {limit}",
            mark="" if bears else "no",
        ),
        Card(name="largest torque of the shaft", value=quantity_text(start.torque_peak, "N*m", 4)),
    )
    drawn = (
        Picture(name="startup", see="Mean speed and twist over time, beside a rigid shaft.",
                draw=lambda: plots.start_up([start], start.claim.claim_speed)),
        Picture(name="campbell", see="Where an order meets the natural frequency the shaft may be held.",
                draw=lambda: plots.campbell(start)),
    )  # fmt: skip
    return View(title="Start-up", cards=cards, pictures=drawn, columns=lambda: _columns(start))


def _columns(start: StartUp) -> Columns:
    columns = {"t": start.t, "speed_mean": start.speed_mean, "twist_amplitude": start.twist_amplitude}
    return Columns(columns, {"t": "s", "speed_mean": "rad/s", "twist_amplitude": "rad"})


@shows(FinishedRun)
def run_view(run: FinishedRun) -> View:
    """Speeds, end and audit of a run in time."""
    numbers = run.summary
    speed = Speed(**run.speed)
    where = f"over the last period{f', of the {run.engine.words}' if run.engine and run.engine.words else ''}"
    good = numbers.status not in ("failed", "not converged", "chaotic")
    share = speed.ripple
    ripple = "–" if share is None else ratio_text(share) if abs(share) < 1e-6 else f"{figure(100 * share, 3)} %"
    unsettled = drift(run)
    cards = [
        Card(name="run", value="unsettled" if unsettled else _ENDS.get(run.result.end, run.result.end) if good else
             numbers.status, about="" if good else numbers.reason, mark="open" if unsettled else "" if good else "no"),
        Card(name="mean speed", value=quantity_text(speed.mean, run.speed.units["mean"], 4),
             about=f"{span(run.speed)} {where}"),
        Card(name="speed ripple", value=ripple, about=f"of a transient, {where}" if unsettled else where,
             mark="open" if unsettled else ""),
    ]  # fmt: skip
    cards += [card(ShaftSection, "twist_peak", s.twist_peak, "peak", section_words(k, len(run.twist)))
              for k, s in enumerate(run.twist)]  # fmt: skip
    curves = {"t": run.result.t, **run.result.columns}
    return View(title="Run in time", cards=tuple(cards), pictures=_run_pictures(run),
                columns=lambda: Columns(curves, {"t": "s", **run.result.units}),
                findings=lambda: of_run(run))  # fmt: skip


def span(speed: Columns) -> str:
    """Least and greatest speed; one that stays is told once."""
    ends = [quantity_text(speed[name], speed.units[name], 4) for name in ("min", "max")]
    return f"steady at {ends[0]}" if ends[0] == ends[1] else " to ".join(ends)


def _run_pictures(run: FinishedRun) -> tuple[Picture, ...]:
    from mechsym.simulate.plots import speed

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
