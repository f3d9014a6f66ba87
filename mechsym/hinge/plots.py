"""Figures of a hinge design. matplotlib is imported in plot modules only; a figure is never shown."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from mechsym.cycle.chamber import volume
from mechsym.hinge.drawing import elastic_hinge, same_after_half_a_turn
from mechsym.hinge.limits import Contact
from mechsym.hinge.result import AtLoad, Design
from mechsym.hinge.rollers import parallel
from mechsym.hinge.trials import Trial
from mechsym.machine.record import gas_of
from mechsym.mechanisms.plots import figure_of
from mechsym.mechanisms.record import velocities
from mechsym.quantities.units import Metre
from mechsym.simulate.steady import Steady
from mechsym.style import (
    BLUE,
    GREEN,
    GREY,
    INK,
    ORANGE,
    RED,
    VIOLET,
    axis_unit,
    distinct,
    events,
    heading,
    legend,
    over_angle,
    panels,
)

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_COLORS = {
    "without": GREY,
    "flywheel": VIOLET,
    "hinge_constant": BLUE,
    "hinge_propeller": GREEN,
    "off_constant": RED,
    "off_propeller": ORANGE,
}


def pressure(design: Design) -> "Figure":
    """Cylinder pressure over the crank angle with the angles of its events, and over the volume."""
    room = gas_of(design.machine)
    gas = room.pressure
    figure, (left, right) = panels(9, 4.7, 1, 2, "Cylinder pressure over the crank angle and over the volume")
    phi = np.unique(np.append(np.linspace(0, gas.period, 1441), gas.kinks))
    p, v = gas.absolute(phi), volume(room.chamber, phi)
    (factor, unit), (room_factor, room_unit) = axis_unit("Pa", p), axis_unit("m^3", v)
    angle = over_angle(left, gas.period)
    left.plot(phi * angle, p * factor, color=BLUE)
    left.set_ylabel(f"absolute pressure [{unit}]")
    events(left, {n.replace("_", " "): at % gas.period * angle for n, at in gas.phases.items()}, width=3.6)
    right.plot(v * room_factor, p * factor, color=BLUE)
    right.set_xlabel(f"volume [{room_unit}]")
    right.set_ylabel(f"absolute pressure [{unit}]")
    return figure


def torque(design: Design) -> "Figure":
    """The hinge torque with its parts, and its work. Returns figure: two panels over the crank angle."""
    hinge = design.hinge
    name = "Torque of the hinge with its parts, and its work"
    figure, (upper, lower) = panels(9, 5.0, 2, 1, name, sharex=True, height_ratios=[2, 1])
    phi = np.linspace(0, hinge.period, 1441)
    angle = over_angle(lower, hinge.period)
    curves = {
        "gas and load": hinge.gas_part(phi), "inertia": hinge.inertia_part(phi), "gravity": hinge.gravity_part(phi),
        "hinge torque": hinge.torque(phi),
    }  # fmt: skip
    factor, unit = axis_unit("N*m", *curves.values())
    work_factor, work_unit = axis_unit("J", hinge.work(phi))
    for (label, values), color in zip(curves.items(), (RED, GREEN, ORANGE, BLUE), strict=True):
        upper.plot(phi * angle, values * factor, color=color, linewidth=2 if color == BLUE else 1, label=label)
    upper.axhline(0, color=INK, linewidth=0.6)
    upper.set_ylabel(f"torque on the crank [{unit}]")
    legend(upper)
    lower.plot(phi * angle, hinge.work(phi) * work_factor, color=BLUE)
    lower.set_ylabel(f"work [{work_unit}]")
    return figure


def track(design: Design, turn: Contact, radius: Metre) -> "Figure":
    """The path of the roller centres and the cut profile, to scale. turn: over a whole turn of the guide's shaft."""
    figure, (axis,) = panels(5.4, 5.8, title="Path of the roller centres and cut profile, to scale")
    x, y = parallel(turn.rho, turn.drho, turn.theta, radius)
    factor, unit = axis_unit("m", x, y)
    circle = design.guide.parameters.rho0 * np.exp(1j * np.linspace(0, 2 * np.pi, 361))
    path = turn.rho * np.exp(1j * turn.theta)
    curves: list[tuple[np.ndarray, np.ndarray, str, dict[str, Any]]] = [
        (circle.real, circle.imag, GREY, {"linewidth": 0.8, "linestyle": "--", "label": "spring at free height"}),
        (path.real, path.imag, BLUE, {"label": "path of the roller centre"}),
        (x, y, RED, {"label": "cut profile, first track"}),
    ]
    if design.guide.rollers == 2:
        told = "second track, half a turn on"
        if same_after_half_a_turn(np.column_stack([x, y])):
            curves[-1][3]["label"] = "cut profile, both tracks alike"
        else:
            curves.append((-x, -y, VIOLET, {"linewidth": 0.9, "label": told}))
    for across, up, color, options in curves:
        axis.plot(across * factor, up * factor, color=color, **options)
    axis.plot(0, 0, marker="+", color=INK, markersize=10)
    axis.set_aspect("equal")
    axis.set_xlabel(f"x [{unit}]")
    axis.set_ylabel(f"y [{unit}]")
    legend(axis, width=3.6)
    return figure


def hinge(design: Design) -> "Figure":
    """Spring, pistons, rollers and tracks to scale, the crank a little after top dead centre."""
    assert design.usable is not None
    drawn = elastic_hinge(design.usable, design.rollers)
    return figure_of(drawn, np.pi / 4, "The elastic hinge to scale: spring, pistons, rollers and tracks")


def contact(turn: Contact) -> "Figure":
    """Roller reactions, pressure angle, spring pressure and curvature around the turn.

    turn: the guide in numbers over a whole turn of its shaft. Returns figure: four panels over the angle of the guide's
    shaft.
    """
    figure, axes = panels(9, 5.4, 2, 2, "Contact of rollers and guide around the turn", sharex=True)
    words = ("excess pressure in the spring", "Pa") if turn.pressure is not None else ("spring force", "N")
    spring = (*words, turn.force if turn.pressure is None else turn.pressure)
    angles = [over_angle(axis, 2 * np.pi, "angle of the guide's shaft") for axis in axes[2:]]
    reactions = distinct({"N₁": turn.reaction_1, "N₂": turn.reaction_2})
    factor, unit = axis_unit("N", *reactions.values())
    for (label, values), color, line in zip(reactions.items(), (BLUE, RED), ("-", "--"), strict=False):
        axes[0].plot(turn.theta * angles[0], values * factor, line, color=color, label=label)
    legend(axes[0])
    axes[0].set_ylabel(f"roller reaction [{unit}]")
    others = (("pressure angle", "rad", turn.pressure_angle), spring, ("curvature of the path", "1/m", turn.curvature))
    for axis, (name, si, values) in zip(axes[1:], others, strict=True):
        factor, unit = axis_unit(si, values)
        axis.plot(turn.theta * angles[0], values * factor, color=BLUE)
        axis.set_ylabel(f"{name} [{unit}]")
    return figure


def speeds(design: Design) -> "Figure":
    """Crank speed of the trials side by side. Returns figure: two panels: with hinge, and all."""
    figure, (left, right) = panels(9, 4.2, 1, 2, "Crank speed of the runs over the turns")
    fitted = [t for t in design.trials if t.name not in ("without", "flywheel")]
    for axis, trials, words in ((left, fitted, "with the hinge"), (right, design.trials, "all, first two turns")):
        for label, color, turns, share in _runs(design, trials):
            axis.plot(turns, share, color=color, linewidth=1.1, label=label)
        heading(axis, words)
        legend(axis)
        axis.set_xlabel("turns of the crank [-]")
        axis.set_ylabel("speed over design speed [-]")
    right.set_xlim(0, 2)
    return figure


def _runs(design: Design, trials: Sequence[Trial]) -> list[tuple[str, str, np.ndarray, np.ndarray]]:
    """Name, colour, turns and speed of each run; runs that cannot be told apart once, under their names."""
    (q,), (u,) = design.machine.mechanism.coordinates, velocities(design.machine.mechanism)
    found: list[tuple[str, str, np.ndarray, np.ndarray]] = []
    for trial in trials:
        turns = trial.result.columns[q] / (2 * np.pi)
        share = trial.result.columns[u] / design.machine.omega
        for k, (label, color, other, values) in enumerate(found):
            if abs(other[-1] - turns[-1]) < 0.01 and np.abs(np.interp(other, turns, share) - values).max() < 1e-4:
                found[k] = (f"{label} = {trial.about}", color, other, values)
                break
        else:
            found.append((trial.about, _COLORS[trial.name], turns, share))
    return found


def retuning(design: Design) -> "Figure":
    """Torque that the other speed needs, and what the same guide gives there with the best pressure."""
    from mechsym.hinge.guide import crank_torque, refit

    again = design.retuned
    if again is None:
        raise ValueError("the design was not retuned")
    figure, (left, right) = panels(9, 3.9, 1, 2, "The same guide at another speed: torque and crank speed")
    phi = np.linspace(0, again.wanted.period, 1441)
    angle, _ = (over_angle(axis, again.wanted.period) for axis in (left, right))
    curves = {
        "wanted at the design speed": (design.hinge.torque(phi), GREY),
        "wanted at the other speed": (again.wanted.torque(phi), BLUE),
        "same guide, best pressure": (crank_torque(refit(design.guide, again.spring), phi), RED),
    }
    factor, unit = axis_unit("N*m", *(values for values, _ in curves.values()))
    for label, (values, color) in curves.items():
        left.plot(phi * angle, values * factor, color=color, label=label)
    left.set_ylabel(f"hinge torque [{unit}]")
    for steady, color, name in ((again.steady, RED, "best pressure"), (again.paper, GREY, "paper's factor 1.9")):
        if steady.speed_mean is not None:
            right.plot(steady.phi * angle, steady.omega / steady.speed_mean, color=color, label=name)
    right.set_ylabel("speed over its mean [-]")
    for axis in (left, right):
        legend(axis)
    return figure


def loads(rows: Sequence[AtLoad]) -> "Figure":
    """Ripple of a guide over the load, with the spring as designed and set anew, and that setting.

    Returns figure: two panels; a cross at the top marks a load at which the crank does not turn steadily.
    """
    figure, (left, right) = panels(9, 3.6, 1, 2, "Speed ripple and setting of the spring over the load")
    ordered = sorted(rows, key=lambda row: row.share)
    shares = [100 * row.share for row in ordered]
    for found, color, name in (
        ([row.as_cut for row in ordered], RED, "spring as designed"),
        ([row.reset for row in ordered], BLUE, "setting of that load"),
    ):
        # no line between the points: at the design's own load, which may lie between, there is no ripple
        left.plot(shares, [_per_cent(s) for s in found], "o", color=color, markersize=5, label=name)
        stopped = [share for share, s in zip(shares, found, strict=True) if s.speed_ripple is None]
        left.plot(stopped, [1.0] * len(stopped), "x", color=color, transform=left.get_xaxis_transform(), clip_on=False)
    left.set(xlabel="load over that of the design [%]", ylabel="speed ripple [%]")
    left.set_ylim(bottom=0)
    legend(left)
    right.plot(shares, [row.ratio for row in ordered], "o-", color=BLUE, markersize=4)
    right.axhline(1.0, color=GREY, linewidth=0.8)
    right.set(xlabel="load over that of the design [%]", ylabel="setting over that of the design [-]")
    return figure


def _per_cent(steady: Steady) -> float:
    return float("nan") if steady.speed_ripple is None else 100 * steady.speed_ripple
