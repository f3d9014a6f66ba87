"""What of a run in time, and of a start-up in it, is worth seeing, and what has to be known first."""

from collections.abc import Iterator, Sequence
from itertools import cycle
from typing import TYPE_CHECKING

import numpy as np

from mechsym.page import Card, Picture, View, card, shows
from mechsym.page.finding import LOOK_AT, NOT_MET, Finding
from mechsym.quantities.display import figure, quantity_text, ratio_text
from mechsym.quantities.results import Columns
from mechsym.quantities.units import RadPerSecond
from mechsym.simulate import Result
from mechsym.simulate.between import between
from mechsym.simulate.result import period_means
from mechsym.simulate.run import POLE
from mechsym.simulate.speed import Speed
from mechsym.style import GREY, INK, PAPER, RED, SERIES, axis_unit, envelope, heading, legend, panels, spread
from mechsym.torsion.startup import FinishedRun, StartUp
from mechsym.torsion.twist import ShaftSection, TrainVibration, beyond, critical_words, pairs, section_words

if TYPE_CHECKING:
    from matplotlib.figure import Figure

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
            about=f"the shaft is taken to bear {limit}",
            mark="" if bears else "no",
        ),
        Card(name="largest torque of the shaft", value=quantity_text(start.torque_peak, "N*m", 4)),
    )
    drawn = (
        Picture(name="startup", see="Mean speed and twist over time, beside a rigid shaft.",
                draw=lambda: start_up([start], start.claim.claim_speed)),
        Picture(name="campbell", see="Where an order meets the natural frequency the shaft may be held.",
                draw=lambda: campbell(start)),
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
    unsettled = drift(run)
    cards = [
        Card(name="run", value="unsettled" if unsettled else _ENDS.get(run.result.end, run.result.end) if good else
             numbers.status, about="" if good else numbers.reason, mark="open" if unsettled else "" if good else "no"),
    ]  # fmt: skip
    if run.alone:
        last = f"over the last {quantity_text(numbers.window, 's')}"
        cards += [Card(name=f"speed of {q}", value=span(of), about=last) for q, of in numbers.speeds.items()]
        cards += [Card(name=name, value=span(of), about="over the run") for name, of in run.outputs.items()]
    else:
        share = speed.ripple
        ripple = "–" if share is None else ratio_text(share) if abs(share) < 1e-6 else f"{figure(100 * share, 3)} %"
        mean = quantity_text(speed.mean, run.speed.units["mean"], 4)
        cards.append(Card(name="mean speed", value=mean, about=f"{span(run.speed)} {where}"))
        cards.append(Card(name="speed ripple", value=ripple, about=f"of a transient, {where}" if unsettled else where,
                          mark="open" if unsettled else ""))  # fmt: skip
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
    from mechsym.simulate.plots import met, motion, speed

    result, engine, starts, pictures = run.result, run.engine, run.start_ups, []
    if engine is not None and len(result.t) > 1:
        see = f"Speed over time with its mean over each period, and the last period over the angle: {span(run.speed)}."
        pictures.append(Picture(name="speed", see=see, draw=lambda: speed(
            result, engine.coordinate, engine.period, engine.wanted, engine.words)))  # fmt: skip
    if result.happened.events:
        see = "The motion, and when each stop, contact and friction was met, left, stuck or slid."
        pictures.append(Picture(name="events", see=see, draw=lambda: met(result)))
    elif run.alone and len(result.t) > 1:
        see = f"Coordinates and their speeds{', and the outputs of the declaration,' if run.outputs else ''} over time."
        pictures.append(Picture(name="motion", see=see, draw=lambda: motion(result, [*run.outputs])))
    if run.twist:
        peak = quantity_text(max(section.twist_peak for section in run.twist), "rad", 4)
        see = f"Twist of each shaft section: the peak, {peak}, decides on the shaft."
        pictures.append(Picture(name="twist", see=see, draw=lambda: twist(result, len(run.twist))))
    if starts:
        natural = quantity_text(starts[0].natural, "rad/s", 4)
        see = f"Where an order of the drive meets the natural frequency, {natural}, the start-up may be held."
        pictures.append(Picture(name="campbell", see=see, draw=lambda: campbell(starts[0])))
        held = [f"at order {c.critical.order:g}, {quantity_text(c.critical.speed, 'rad/s', 4)}"
                for start in starts for c in start.captures]  # fmt: skip
        see = f"The start-up beside a rigid shaft: {'held ' + '; '.join(held) if held else 'nothing holds it'}."
        pictures.append(Picture(name="startup", see=see, draw=lambda: start_up(starts, starts[0].claim.claim_speed)))
    return tuple(pictures)


NEAR = 0.1  #: A critical speed so close to the speed of operation is told before any figure [-]
ON = 0.02  #: One so close to it is run at [-]
_SLIGHT = 0.01  # of a rigid shaft's torque: an order that carries less swings nothing [-]
DRIFT = 1e-4  #: Change of the mean speed from one period to the next beyond which a run has not settled [-]


def criticals(train: TrainVibration | None) -> Iterator[Finding]:
    """Orders critical near the speed of operation; one at it, or beyond the rigid shaft's torque, is not met."""
    if train is None:
        return
    for one in train.criticals:
        if abs(one.away) <= NEAR and one.torque > _SLIGHT * train.torque_rigid:
            worse = abs(one.away) <= ON or one.torque > train.torque_rigid
            yield Finding(rank=NOT_MET if worse else LOOK_AT, words=critical_words(one), value=one.away)


def drift(run: FinishedRun) -> Finding | None:
    """A run of an engine whose mean speed has not settled, or that is too short to tell."""
    if run.engine is None or not run.result.as_planned:
        return None
    means = period_means(run.result, run.engine.coordinate, run.engine.period)
    if len(means) < 3:
        return Finding(rank=LOOK_AT, words="the run is too short to have settled: its ripple is a transient's")
    last = float(means[-1] / means[-2] - 1)
    if abs(last) <= DRIFT:
        return None
    ends = " to ".join(quantity_text(float(speed), "rad/s", 5) for speed in (means[0], means[-1]))
    way = "rises" if last > 0 else "falls"
    words = f"the run has not settled: its mean speed still {way}, {ends}, and its ripple is a transient's"
    return Finding(rank=LOOK_AT, words=words, value=last)


def of_run(run: FinishedRun) -> Iterator[Finding]:
    """What of a run in time has to be known first."""
    if run.result.status in ("failed", "not converged", "chaotic"):
        yield Finding(rank=NOT_MET, words=run.summary.reason or f"the run is {run.result.status}")
    if run.result.end == "stall":
        yield Finding(rank=NOT_MET, words="the shaft stops", value=float(run.result.t[-1]), unit="s")
    if run.result.end == POLE:
        words = (
            "two angles of a ball joint come to turn about one axis; leave its sequence out: a quaternion has no pole"
        )
        yield Finding(rank=NOT_MET, words=words, value=float(run.result.t[-1]), unit="s")
    for start in run.start_ups:
        for stay in start.captures:
            at, twist = (quantity_text(v, u, 4) for v, u in ((stay.critical.speed, "rad/s"), (start.twist_peak, "rad")))
            words = f"the shaft is held at its critical speed of order {stay.critical.order:g}, {at}, from "
            words += f"{figure(stay.t_start, 3)} s on; it twists by {twist}"
            yield Finding(rank=NOT_MET, words=words, value=start.twist_peak, unit="rad")
    yield from criticals(run.vibration)
    for words, peak in beyond(run.vibration, run.twist) if run.vibration else ():
        yield Finding(rank=NOT_MET, words=words, value=peak, unit="rad")
    if settling := drift(run):
        yield settling


_MOST_ORDERS = 4


def campbell(start: StartUp) -> "Figure":
    """Natural frequency and orders of excitation over the speed; dots mark critical speeds that held the shaft."""
    figure, (axes,) = panels(7.5, 4.8, title="Orders of excitation and natural frequency over the crank speed")
    factor, unit = axis_unit("rad/s", start.natural)
    top = 1.1 * max(c.speed for c in start.criticals)
    shown = [c for c in start.criticals if c.order <= _MOST_ORDERS]
    natural, held = start.natural * factor, {c.critical.order for c in start.captures}
    high = 1.45 * natural
    axes.axhline(natural, color=INK, lw=1.5, label=f"natural frequency {natural:.4g} {unit}")
    ends = [min(top, 1.3 * c.speed) for c in shown]
    heights = spread([min(c.order * e * factor / high, 1.0) for c, e in zip(shown, ends, strict=True)], 0.06, 0.0, 1.0)
    for critical, end, height in zip(shown, ends, heights, strict=True):
        speed = critical.speed * factor
        axes.plot([0, end * factor], [0, critical.order * end * factor], color=GREY, lw=1.0)
        words, at = f"order {critical.order:g}: {speed:.4g} {unit}", (end * factor, critical.order * end * factor)
        axes.annotate(words, at, (1.02, height), textcoords="axes fraction", va="center", fontsize=8, color=INK,
                      arrowprops={"arrowstyle": "-", "color": GREY, "lw": 0.5})  # fmt: skip
        color = RED if critical.order in held else PAPER
        axes.plot(speed, natural, "o", mec=INK, mfc=color, ms=7)
    axes.set(
        xlim=(0, 1.08 * top * factor), ylim=(0, high), xlabel=f"crank speed [{unit}]", ylabel=f"frequency [{unit}]"
    )
    for color, words in ((PAPER, "critical speed"), (RED, "critical speed that held the shaft")):
        axes.plot([], [], "o", mec=INK, mfc=color, ms=7, label=words)
    legend(axes)
    return figure


def start_up(runs: Sequence[StartUp], claim_speed: RadPerSecond | None = None) -> "Figure":
    """Mean speed and twist of start-ups with several dampers, and the rigid shaft. claim_speed: the source's."""
    figure, (speed, twist) = panels(7.5, 6.5, 2, 1, "Start-up: mean speed and twist over time", sharex=True)
    first = runs[0]
    factor, unit = axis_unit("rad/s", first.natural)
    angle, angle_unit = axis_unit("rad", 1.0)
    onset, end = first.drive.time, float(first.result.t[-1])
    speed.plot([onset, end], [0, first.rigid_rate * (end - onset) * factor], "--", color=GREY, label="rigid shaft")
    for run, color in zip(runs, SERIES[1:], strict=False):
        speed.plot(run.t, run.speed_mean * factor, color=color, lw=1.6, label=f"c1 = {run.c1:g} N m s/rad")
        twist.semilogy(run.t, np.maximum(run.twist_amplitude, 1e-5) * angle, color=color, lw=1.2)
    marks = {f"order {c.order:g}": c.speed * factor for c in first.criticals if c.order <= _MOST_ORDERS}
    if claim_speed is not None:
        marks["printed"] = claim_speed * factor
        speed.set_ylim(top=1.12 * claim_speed * factor)
    # lines across a panel with their names at its right
    low, high = speed.get_ylim()
    shown = {name: at for name, at in marks.items() if low <= at <= high}
    places = spread([(at - low) / (high - low) for at in shown.values()], 0.07, 0.0, 1.0)
    for (name, at), place in zip(shown.items(), places, strict=True):
        speed.axhline(at, color=GREY, lw=0.7, ls=":")
        speed.text(1.01, place, name, transform=speed.transAxes, va="center", color=INK, fontsize=8)
    speed.set(ylabel=f"mean crank speed [{unit}]")
    legend(speed)
    twist.set(xlabel="time [s]", ylabel=f"twist amplitude [{angle_unit}]")
    return figure


_FINER = 4  # points of a curve for each sample, so that its peaks are seen


def twist(result: Result, shafts: int) -> "Figure":
    """Speed of the ends of an elastic shaft, twist of its sections over time, and the last two turns."""
    name = "Speed of both ends of the shaft and its twist, over time and in the last two turns"
    figure, axes = panels(9, 6.0, 2, 2, name, width_ratios=(2, 1), sharex="col", sharey="row")
    ends_of, t, columns = pairs(result, shafts), result.t, result.columns
    if len(np.unique(t)) == len(t) > 2:
        t = np.linspace(t[0], t[-1], _FINER * len(t))
        columns = between(result.t, result.columns)(t)
    ends = {"free end": columns[f"{ends_of[0][0]}d"], "flywheel": columns[f"{ends_of[-1][1]}d"]}
    twists = {section_words(k, len(ends_of)): columns[a] - columns[b] for k, (a, b) in enumerate(ends_of)}
    last = columns[ends_of[0][0]] >= columns[ends_of[0][0]][-1] - 4 * np.pi
    for row, (curves, si, label) in enumerate(((ends, "rad/s", "speed"), (twists, "rad", "twist"))):
        whole, zoomed = axes[2 * row : 2 * row + 2]
        factor, unit = axis_unit(si, *curves.values())
        for (curve, values), color in zip(curves.items(), cycle(SERIES[1:]), strict=False):
            envelope(whole, t, values * factor, color, curve)
            zoomed.plot(t[last], values[last] * factor, color=color, lw=0.9)
        whole.set(ylabel=f"{label} [{unit}]")
        legend(whole, width=5.0)
    for axis in axes[2:]:
        axis.set(xlabel="time [s]")
    heading(axes[1], "last two turns")
    return figure
