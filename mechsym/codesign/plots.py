"""Pictures of a co-design."""

from typing import TYPE_CHECKING

import numpy as np

from mechsym.codesign.loss import KINDS
from mechsym.codesign.rank import Count
from mechsym.codesign.result import CoDesignResult
from mechsym.codesign.task import fine_path
from mechsym.quantities.display import key_words, quantity_text
from mechsym.style import (
    BLUE,
    GREEN,
    GREY,
    INK,
    ORANGE,
    RED,
    SERIES,
    VIOLET,
    axis_unit,
    bare,
    heading,
    legend,
    over_angle,
    panels,
    unit_words,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_PEERS = {"plain flywheel": RED, "cam with coil springs": ORANGE, "noncircular gears": VIOLET, "two springs": GREEN}


def works(result: CoDesignResult) -> "Figure":
    """The works that the points want, by their own pressures: nearly one curve; what one shape leaves."""
    several = len(result.design.task.points) > 1
    what = ", and what one shape leaves of them" if several else ""
    figure, (left, *others) = _panels(1 + several, f"Works that the points want{what}")
    bound, best = result.bound, result.bound.best[0]
    period = result.design.task.points[0].period
    angle = bound.phi * [over_angle(axis, period) for axis in (left, *others)][0]
    factor, unit = axis_unit("kg*m^2", bound.wanted)
    for k, point in enumerate(result.design.task.points):
        color, name = SERIES[k % len(SERIES)], _speed(point.omega)
        left.plot(angle, factor * bound.wanted[k], color=color, linewidth=1, label=name)
        for right in others:
            right.plot(angle, factor * (bound.wanted[k] - best.shares[k] @ best.shapes), color=color, linewidth=1)
    left.set_ylabel(f"wanted work by speed squared [{unit}]")
    legend(left)
    for right in others:
        right.set_ylabel(f"left by one shape [{unit}]")
        heading(right, unit_words(f"swing {quantity_text(best.swing, 'kg*m^2', 3)}"))
    return figure


_WIDE = 100.0  # a flywheel above it is compared with others by decades [kg*m^2]


def front(result: CoDesignResult) -> "Figure":
    """Flywheel over ripple: bare, guide cut for one speed, co-designed, with losses, estimate, what a misfire asks."""
    figure, (axis,) = _panels(1, "Flywheel over the ripple")
    factor, unit = axis_unit("kg*m^2", result.bare)
    designs = sorted([*result.front, result.design], key=lambda d: d.task.ripple)
    ripples = np.array([100 * d.task.ripple for d in designs])
    words = {1: "one spring", 2: "two springs", 3: "three springs"}[result.design.task.springs]
    added = [factor * d.flywheel for d in designs]
    axis.plot(ripples, added, _through(ripples), color=BLUE, markersize=4, label=f"co-designed, {words}")
    wanted = 100 * result.design.task.ripple
    axis.plot([wanted], [factor * result.bare], "s", color=RED, label="without a hinge")
    if result.cut.flywheel is not None:
        axis.plot([wanted], [factor * result.cut.flywheel], "D", color=ORANGE, label="guide cut for one speed")
    real = [at.ripple for at in result.lossy if at.ripple is not None]
    if result.taken == "beside" and real:
        axis.plot([100 * max(real)], [factor * result.design.flywheel], "o", color=BLUE, fillstyle="none",
                  label="co-designed, with its losses")  # fmt: skip
    if result.misfire_floor is not None:
        axis.axhline(factor * result.misfire_floor, color=INK, linestyle="--", linewidth=0.9,
                     label="least that leaves half the speed after a lost combustion")  # fmt: skip
    for name, colour in _PEERS.items():
        rows = [p for p in result.peers if p.name == name and p.flywheel_inertia is not None]
        if rows:
            held, needed = [100 * p.ripple for p in rows], [factor * (p.flywheel_inertia or 0.0) for p in rows]
            axis.plot(held, needed, "o--", color=colour, markersize=3, linewidth=0.9, label=name)
    swings = result.bound.swing[result.design.task.springs - 1]
    own = float(np.mean(result.design.task.points[0].inertia(np.linspace(0, 2 * np.pi, 181))))
    floor = factor * np.maximum(100 * swings / ripples - own, 1e-3)
    axis.plot(ripples, floor, ":", color=GREY, label="estimate (massless)")
    if result.bare > _WIDE:
        axis.set_yscale("symlog", linthresh=_WIDE / 10 * factor)
        axis.set_ylim(0, max(axis.get_ylim()[1], 2 * factor * result.bare))
    else:
        axis.set_ylim(0, 1.1 * axis.get_ylim()[1])
    axis.set(xlabel="speed ripple [%]", ylabel=f"added flywheel [{unit}]")
    legend(axis)
    return figure


def guides(result: CoDesignResult) -> "Figure":
    """Paths of the roller centres to scale, and contact force and closing around the turn at the hardest point."""
    from matplotlib.figure import Figure
    from matplotlib.ticker import MaxNLocator

    figure = Figure(figsize=(9, 3.6), layout="constrained")
    figure.set_label("Paths of the roller centres, and the closing of the springs over a turn")
    longest, widest = (max(getattr(c, key) for c in result.verified.contacts) for key in ("rho_max", "z_max"))
    (factor, unit), (closing, closing_unit) = axis_unit("m", longest), axis_unit("m", widest)
    polar, force = figure.add_subplot(1, 2, 1, projection="polar"), figure.add_subplot(1, 2, 2)
    angle, heads = over_angle(force, result.design.task.points[0].period), []
    for s, (track, contact) in enumerate(zip(result.design.tracks, result.verified.contacts, strict=True)):
        period = result.design.task.points[0].period
        phi, path = fine_path(track, period)
        rho = factor * np.append(path.rho, path.rho[0])
        polar.plot(np.append(phi, phi[0] + period) * track.hardware.shaft_ratio, rho, color=SERIES[s])
        heads.append(f"{quantity_text(contact.rho_min, 'm', 4)} to {quantity_text(contact.rho_max, 'm', 4)}")
        name = f"guide {s + 1}" if len(result.design.tracks) > 1 else "closing z"
        force.plot(phi * angle, closing * path.z, color=SERIES[s], label=name)
    polar.set_title("roller centres at " + ",\n".join(heads), fontsize=8)
    polar.set_ylim(0)
    polar.set_xlabel(f"radius [{unit}]", fontsize=8)
    polar.yaxis.set_major_locator(MaxNLocator(3))
    polar.tick_params(labelsize=7)
    force.set_ylabel(f"closing z [{closing_unit}]")
    bare(force)
    legend(force)
    return figure


def points(result: CoDesignResult) -> "Figure":
    """Ripple by three ways, and the schedule of pressures, over the speed."""
    figure, (left, right) = _panels(2, "Ripple by three ways, and the pressures to set")
    design, verified = result.design, result.verified
    omega = np.array([p.omega for p in design.task.points])
    (turning, rpm), (factor, unit) = axis_unit("rad/s", omega), axis_unit("Pa", *(t.p0 for t in design.tracks))
    speeds = omega * turning
    left.plot(
        speeds, 100 * verified.programme_ripple, "o", color=BLUE, label="programme", markersize=7, fillstyle="none"
    )
    left.plot(speeds, 100 * verified.steady_ripple, "x", color=RED, label="over the angle")
    left.plot(speeds, 100 * verified.time_ripple, "+", color=INK, label="run in time")
    left.axhline(100 * design.task.ripple, color=GREY, linewidth=0.8)
    left.set(xlabel=f"speed [{rpm}]", ylabel="speed ripple [%]")
    left.set_ylim(0, 1.15 * left.get_ylim()[1])
    legend(left)
    for s, track in enumerate(design.tracks):
        right.plot(speeds, track.p0 * factor, _through(speeds), color=SERIES[s], markersize=4, label=f"spring {s + 1}")
    right.set(xlabel=f"speed [{rpm}]", ylabel=f"excess pressure p0 [{unit}]")
    right.set_ylim(bottom=0)
    legend(right)
    return figure


def losses(result: CoDesignResult) -> "Figure":
    """What friction and heat take at each point, as shares of the load's torque."""
    figure, (axis,) = _panels(1, "What friction and heat take at each point")
    task = result.design.task
    turning, rpm = axis_unit("rad/s", [p.omega for p in task.points])
    names = [f"{p.omega * turning:.4g}\n{quantity_text(p.load, 'Pa', 3)}" for p in task.points]
    places, below = np.arange(len(names)), np.zeros(len(names))
    for kind, color in zip(KINDS, SERIES, strict=False):
        values = np.array(
            [100 * getattr(at, kind) / abs(p.load_torque) for at, p in zip(result.losses, task.points, strict=True)]
        )
        if values.any():
            axis.bar(places, values, bottom=below, color=color, label=kind, width=0.6)
        below = below + values
    axis.set_xticks(places, names)
    axis.set_xlim(min(-0.5, len(names) / 2 - 2.0), max(len(names) - 0.5, len(names) / 2 + 1.0))
    axis.set(xlabel=f"speed [{rpm}], mean indicated pressure", ylabel="losses of the hinge, of the load's torque [%]")
    legend(axis)
    return figure


def scenarios(result: CoDesignResult) -> "Figure":
    """Speed over the turns of every scenario that was run, a panel each."""
    rows = [s for s in result.scenarios if s.run is not None]
    names = list(dict.fromkeys(s.name for s in rows))
    down = -(-len(names) // 3)
    figure, axes = panels(9, 2.3 * down, down, 3, "Speed over the turns of what may happen")
    for axis, name in zip(axes, names, strict=False):
        for s in (s for s in rows if s.name == name):
            assert s.run is not None
            point = result.design.task.points[s.point]
            turns, color = (s.run.phi - s.run.phi[0]) / (2 * np.pi), BLUE if s.point == 0 else RED
            axis.plot(turns, s.run.omega / point.omega, color=color, linewidth=0.8, label=_speed(point.omega))
        axis.set(xlabel="turns [-]", ylabel="speed by the mean [-]")
        heading(axis, name)
        bare(axis)
    legend(axes[0])
    for axis in axes[len(names) :]:
        axis.set_visible(False)
    return figure


_MARK = "#fefefe"  # over a range of colours, the same on dark paper


def ripple_map(result: CoDesignResult) -> "Figure":
    """Ripple and best pressure over speed and load."""
    assert result.map is not None
    figure, (left, right) = _panels(2, "Ripple and best pressure over speed and load")
    (turning, rpm), (factor, unit) = axis_unit("rad/s", result.map.omega), axis_unit("Pa", result.map.p0)
    pressing, pressure = axis_unit("Pa", result.map.load)
    speeds, loads = result.map.omega * turning, result.map.load * pressing
    shown = np.minimum(100 * result.map.ripple, 30.0)
    drawn = left.contourf(speeds, loads, shown.T, levels=[0, 1, 2, 3, 5, 8, 12, 20, 30], cmap="viridis_r")
    figure.colorbar(drawn, ax=left, label="speed ripple [%]")
    drawn = right.contourf(speeds, loads, result.map.p0.T * factor, levels=12, cmap="cividis")
    figure.colorbar(drawn, ax=right, label=f"p0 [{unit}]")
    for axis in (left, right):
        at = [(p.omega * turning, p.load * pressing) for p in result.design.task.points]
        axis.plot(*zip(*at, strict=True), "o-", color=_MARK, markersize=4, linewidth=0.9, markeredgecolor="black",
                  markeredgewidth=0.6)  # fmt: skip
        axis.set(xlabel=f"speed [{rpm}]", ylabel=f"mean indicated pressure [{pressure}]")
    return figure


def spread(result: CoDesignResult) -> "Figure":
    """Ripple under small errors: histogram and tornado."""
    assert result.spread is not None
    figure, (left, right) = _panels(2, "Ripple under small errors")
    left.hist(100 * result.spread.samples, bins=24, color=BLUE)
    left.axvline(100 * result.spread.p95, color=RED, linewidth=1, label="19 of 20 keep this")
    left.set(xlabel="largest speed ripple [%]", ylabel="machines [-]")
    legend(left)
    base = 100 * float(result.verified.programme_ripple.max())
    rows = sorted(result.spread.alone.items(), key=lambda row: max(row[1]))
    for y, (_, (low, high)) in enumerate(rows):
        for value, color, side, name in ((low, ORANGE, 0.17, "lower value"), (high, BLUE, -0.17, "higher value")):
            right.barh(y + side, 100 * value - base, 0.3, base, color=color, label=name if y == 0 else None)
    right.set_yticks(
        range(len(rows)), [f"{key_words(name)} ± {200 * result.spread.errors[name]:g} %" for name, _ in rows]
    )
    right.set(xlabel="largest speed ripple [%]")
    legend(right)
    return figure


def cylinders(rows: list[Count]) -> "Figure":
    """Flywheel over the number of cylinders, without a hinge and with one."""
    figure, (axis,) = _panels(1, "Flywheel over the number of cylinders")
    factor, unit = axis_unit("kg*m^2", max(r.flywheel_inertia_bare for r in rows))
    numbers = np.array([r.cylinders for r in rows])
    axis.bar(
        numbers - 0.2, [factor * r.flywheel_inertia_bare for r in rows], width=0.4, color=RED, label="without a hinge"
    )
    least = [factor * max(r.flywheel_inertia_estimate, 0.0) for r in rows]
    axis.bar(numbers + 0.2, least, width=0.4, color=BLUE, label="one hinge, at least")
    axis.set_yscale("symlog", linthresh=10 * factor)
    axis.set(xlabel="cylinders, even firing [-]", ylabel=f"added flywheel [{unit}]", xticks=numbers)
    legend(axis)
    return figure


def _panels(count: int, title: str) -> "tuple[Figure, list[Axes]]":
    figure, axes = panels(9 if count == 2 else 6, 3.9, 1, count, title)
    return figure, list(axes)


def _through(values: np.ndarray) -> str:
    """Points joined by lines; two make no curve."""
    return "o-" if len(values) > 2 else "o"


def _speed(omega: float) -> str:
    return quantity_text(omega, "rad/s", 4)
