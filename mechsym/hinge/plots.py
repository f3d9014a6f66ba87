"""Figures of a hinge design, and the hinge drawn to scale: gas or coil between two pistons, rollers, tracks.

   ___ track ___           The tracks stand still, the spring turns with the guide's shaft at the angle
 /     _____     \\         theta = shaft_ratio * phi. The second roller runs on a track of its own, half a turn
(o)-[|gas|]-(o)   |        on, unless one track serves both.
 \\ ____________ /
"""

import math
from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from mechsym import style
from mechsym.cycle.chamber import volume
from mechsym.hinge.guide import Guide, closing, path
from mechsym.hinge.limits import Contact
from mechsym.hinge.result import AtLoad, Design
from mechsym.hinge.rollers import RollerParameters, parallel
from mechsym.hinge.trials import Trial
from mechsym.machine.record import gas_of
from mechsym.mechanisms.drawing import Circle, Line, Point, Shapes
from mechsym.mechanisms.drawn_parts import box, turned
from mechsym.mechanisms.plots import figure_of
from mechsym.mechanisms.record import velocities
from mechsym.quantities.units import Array, Metre
from mechsym.simulate.steady import Steady

if TYPE_CHECKING:
    from matplotlib.figure import Figure


_CORNERS = 181  # of a track
_COILS = 9


def elastic_hinge(guide: Guide, rollers: RollerParameters) -> Callable[[float], Shapes]:
    """Crank angle [rad] to a drawing of spring, pistons, rollers and tracks."""
    tracks = tuple(_tracks(guide, rollers))
    rho, ratio = path(guide), guide.parameters.shaft_ratio
    period = rho.x[-1] - rho.x[0]

    def shapes(angle: float) -> Shapes:
        theta = ratio * angle
        at = float(rho(rho.x[0] + (theta - rho.x[0]) % period))
        hub = Circle(role="joint", centre=(0.0, 0.0), radius=0.02 * guide.parameters.rho0)
        return (*tracks, *turned(_spring(guide, rollers, at), theta), hub)

    return shapes


def same_after_half_a_turn(points: Metre[Array]) -> bool:
    """Whether a closed curve repeats after half a turn. points: at even angles, both ends, odd n, shape (n, 2)."""
    half = len(points) // 2
    return bool(np.abs(points[half:] + points[: half + 1]).max() < 1e-6 * float(np.abs(points).max()))


def _tracks(guide: Guide, rollers: RollerParameters) -> Iterator[Line]:
    rho, theta = path(guide), np.linspace(0, 2 * math.pi, _CORNERS)
    inside = rho.x[0] + (theta - rho.x[0]) % (rho.x[-1] - rho.x[0])
    points = np.column_stack(parallel(rho(inside), rho.derivative()(inside), theta, rollers.radius))
    points[-1] = points[0]
    if guide.rollers == 2 and not same_after_half_a_turn(points):
        yield Line(role="second_track", points=_corners(-points))
    yield Line(role="track", points=_corners(points))


def _corners(points: np.ndarray) -> tuple[Point, ...]:
    return tuple((float(x), float(y)) for x, y in points)


def _spring(guide: Guide, rollers: RollerParameters, rho: float) -> Iterator[Line | Circle]:
    """Along x: the roller of the first track at +rho, of the second at -rho or a seat on the shaft."""
    z, both = float(closing(guide, np.array(rho))), guide.rollers == 2
    if guide.spring.gas:
        yield from _gas(guide, rollers.radius, rho, z, both)
    else:
        yield from _coil(rho, rollers.radius, both)
    for x in (rho, -rho) if both else (rho,):
        yield Circle(role="roller", centre=(x, 0.0), radius=rollers.radius)
        yield Circle(role="joint", centre=(x, 0.0), radius=0.2 * rollers.radius)


def _gas(guide: Guide, radius: float, rho: float, z: float, both: bool) -> Iterator[Line | Circle]:
    """Column of gas between two pistons in a sleeve; their rods, of constant length, end at the rollers."""
    spring = guide.spring
    length, bore = spring.H - z, math.sqrt(4 * spring.area / math.pi)
    thick = min(0.25 * bore, 0.08 * guide.parameters.rho0)
    # one roller: the seat stands so far behind the shaft that the rod keeps the roller's radius and a piston's length
    seat = -length / 2 if both else min(0.0, guide.parameters.rho0 - spring.H - radius - 2 * thick)
    face = seat + length
    widest = spring.H - guide.rollers * (guide.parameters.rho0 - float(_largest(guide)))
    end = (widest / 2 if both else seat + widest) + thick
    yield box("gas", (seat, -bore / 2), (length, bore))
    yield box("piston", (face, -bore / 2), (thick, bore))
    yield box("piston", (seat - thick, -bore / 2), (thick, bore))
    for y in (-bore / 2, bore / 2):
        yield Line(role="frame", points=((-end if both else seat - thick, 1.04 * y), (end, 1.04 * y)))
    yield Line(role="rod", points=((face + thick, 0.0), (rho, 0.0)))
    if both:
        yield Line(role="rod", points=((seat - thick, 0.0), (-rho, 0.0)))


def _largest(guide: Guide) -> float:
    rho = path(guide)
    return float(np.max(rho(np.linspace(rho.x[0], rho.x[-1], 361))))


def _coil(rho: float, radius: float, both: bool) -> Iterator[Line | Circle]:
    """A coil between two seats that the rollers carry, or between one and the shaft; its width is drawn, not given."""
    right, half = rho - 1.6 * radius, 0.8 * radius
    left = -right if both else 0.0
    places = np.linspace(left, right, 2 * _COILS + 1)
    points = [(float(x), half * (-1.0) ** k) for k, x in enumerate(places[1:-1])]
    yield Line(role="spring", points=((left, 0.0), *points, (right, 0.0)))
    for x in (left, right):
        yield Line(role="piston", points=((x, -1.2 * half), (x, 1.2 * half)))
    yield Line(role="rod", points=((right, 0.0), (rho, 0.0)))
    if both:
        yield Line(role="rod", points=((left, 0.0), (-rho, 0.0)))


_COLORS = {
    "without": style.GREY,
    "flywheel": style.VIOLET,
    "hinge_constant": style.BLUE,
    "hinge_propeller": style.GREEN,
    "off_constant": style.RED,
    "off_propeller": style.ORANGE,
}


def pressure(design: Design) -> "Figure":
    """Cylinder pressure over the crank angle with the angles of its events, and over the volume."""
    room = gas_of(design.machine)
    gas = room.pressure
    figure, (left, right) = style.panels(9, 4.7, 1, 2, "Cylinder pressure over the crank angle and over the volume")
    phi = np.unique(np.append(np.linspace(0, gas.period, 1441), gas.kinks))
    p, v = gas.absolute(phi), volume(room.chamber, phi)
    (factor, unit), (room_factor, room_unit) = style.axis_unit("Pa", p), style.axis_unit("m^3", v)
    angle = style.over_angle(left, gas.period)
    left.plot(phi * angle, p * factor, color=style.BLUE)
    left.set_ylabel(f"absolute pressure [{unit}]")
    style.events(left, {n.replace("_", " "): at % gas.period * angle for n, at in gas.phases.items()}, width=3.6)
    right.plot(v * room_factor, p * factor, color=style.BLUE)
    right.set_xlabel(f"volume [{room_unit}]")
    right.set_ylabel(f"absolute pressure [{unit}]")
    return figure


def torque(design: Design) -> "Figure":
    """The hinge torque with its parts, and its work. Returns figure: two panels over the crank angle."""
    hinge = design.hinge
    name = "Torque of the hinge with its parts, and its work"
    figure, (upper, lower) = style.panels(9, 5.0, 2, 1, name, sharex=True, height_ratios=[2, 1])
    phi = np.linspace(0, hinge.period, 1441)
    angle = style.over_angle(lower, hinge.period)
    curves = {
        "gas and load": hinge.gas_part(phi), "inertia": hinge.inertia_part(phi), "gravity": hinge.gravity_part(phi),
        "hinge torque": hinge.torque(phi),
    }  # fmt: skip
    factor, unit = style.axis_unit("N*m", *curves.values())
    work_factor, work_unit = style.axis_unit("J", hinge.work(phi))
    for (label, values), color in zip(curves.items(), (style.RED, style.GREEN, style.ORANGE, style.BLUE), strict=True):
        upper.plot(phi * angle, values * factor, color=color, linewidth=2 if color == style.BLUE else 1, label=label)
    upper.axhline(0, color=style.INK, linewidth=0.6)
    upper.set_ylabel(f"torque on the crank [{unit}]")
    style.legend(upper)
    lower.plot(phi * angle, hinge.work(phi) * work_factor, color=style.BLUE)
    lower.set_ylabel(f"work [{work_unit}]")
    return figure


def track(design: Design, turn: Contact, radius: Metre) -> "Figure":
    """The path of the roller centres and the cut profile, to scale. turn: over a whole turn of the guide's shaft."""
    figure, (axis,) = style.panels(5.4, 5.8, title="Path of the roller centres and cut profile, to scale")
    x, y = parallel(turn.rho, turn.drho, turn.theta, radius)
    factor, unit = style.axis_unit("m", x, y)
    circle = design.guide.parameters.rho0 * np.exp(1j * np.linspace(0, 2 * np.pi, 361))
    path = turn.rho * np.exp(1j * turn.theta)
    curves: list[tuple[np.ndarray, np.ndarray, str, dict[str, Any]]] = [
        (circle.real, circle.imag, style.GREY, {"linewidth": 0.8, "linestyle": "--", "label": "spring at free height"}),
        (path.real, path.imag, style.BLUE, {"label": "path of the roller centre"}),
        (x, y, style.RED, {"label": "cut profile, first track"}),
    ]
    if design.guide.rollers == 2:
        second = "second track, half a turn on"
        if same_after_half_a_turn(np.column_stack([x, y])):
            curves[-1][3]["label"] = "cut profile, both tracks alike"
        else:
            curves.append((-x, -y, style.VIOLET, {"linewidth": 0.9, "label": second}))
    for across, up, color, options in curves:
        axis.plot(across * factor, up * factor, color=color, **options)
    axis.plot(0, 0, marker="+", color=style.INK, markersize=10)
    axis.set_aspect("equal")
    axis.set_xlabel(f"x [{unit}]")
    axis.set_ylabel(f"y [{unit}]")
    style.legend(axis, width=3.6)
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
    figure, axes = style.panels(9, 5.4, 2, 2, "Contact of rollers and guide around the turn", sharex=True)
    words = ("excess pressure in the spring", "Pa") if turn.pressure is not None else ("spring force", "N")
    spring = (*words, turn.force if turn.pressure is None else turn.pressure)
    angles = [style.over_angle(axis, 2 * np.pi, "angle of the guide's shaft") for axis in axes[2:]]
    reactions = style.distinct({"N₁": turn.reaction_1, "N₂": turn.reaction_2})
    factor, unit = style.axis_unit("N", *reactions.values())
    for (label, values), color, line in zip(reactions.items(), (style.BLUE, style.RED), ("-", "--"), strict=False):
        axes[0].plot(turn.theta * angles[0], values * factor, line, color=color, label=label)
    style.legend(axes[0])
    axes[0].set_ylabel(f"roller reaction [{unit}]")
    others = (("pressure angle", "rad", turn.pressure_angle), spring, ("curvature of the path", "1/m", turn.curvature))
    for axis, (name, si, values) in zip(axes[1:], others, strict=True):
        factor, unit = style.axis_unit(si, values)
        axis.plot(turn.theta * angles[0], values * factor, color=style.BLUE)
        axis.set_ylabel(f"{name} [{unit}]")
    return figure


def speeds(design: Design) -> "Figure":
    """Crank speed of the trials side by side. Returns figure: two panels: with hinge, and all."""
    figure, (left, right) = style.panels(9, 4.2, 1, 2, "Crank speed of the runs over the turns")
    fitted = [t for t in design.trials if t.name not in ("without", "flywheel")]
    for axis, trials, words in ((left, fitted, "with the hinge"), (right, design.trials, "all, first two turns")):
        for label, color, turns, share in _runs(design, trials):
            axis.plot(turns, share, color=color, linewidth=1.1, label=label)
        style.heading(axis, words)
        style.legend(axis)
        axis.set_xlabel("turns of the crank [-]")
        axis.set_ylabel("speed over design speed [-]")
    right.set_xlim(0, 2)
    return figure


def _runs(design: Design, trials: Sequence[Trial]) -> list[tuple[str, str, np.ndarray, np.ndarray]]:
    """Name, colour, turns and speed of each run; runs that cannot be told apart once, under their names."""
    (q,), (u,) = design.machine.mechanism.coordinates, velocities(design.machine.mechanism)
    runs: list[tuple[str, str, np.ndarray, np.ndarray]] = []
    for trial in trials:
        turns = trial.result.columns[q] / (2 * np.pi)
        share = trial.result.columns[u] / design.machine.omega
        for k, (label, color, other, values) in enumerate(runs):
            if abs(other[-1] - turns[-1]) < 0.01 and np.abs(np.interp(other, turns, share) - values).max() < 1e-4:
                runs[k] = (f"{label} = {trial.about}", color, other, values)
                break
        else:
            runs.append((trial.about, _COLORS[trial.name], turns, share))
    return runs


def retuning(design: Design) -> "Figure":
    """Torque that the other speed needs, and what the same guide gives there with the best pressure."""
    from mechsym.hinge.guide import crank_torque, refit

    again = design.retuned
    if again is None:
        raise ValueError("the design was not retuned")
    figure, (left, right) = style.panels(9, 3.9, 1, 2, "The same guide at another speed: torque and crank speed")
    phi = np.linspace(0, again.wanted.period, 1441)
    angle, _ = (style.over_angle(axis, again.wanted.period) for axis in (left, right))
    curves = {
        "wanted at the design speed": (design.hinge.torque(phi), style.GREY),
        "wanted at the other speed": (again.wanted.torque(phi), style.BLUE),
        "same guide, best pressure": (crank_torque(refit(design.guide, again.spring), phi), style.RED),
    }
    factor, unit = style.axis_unit("N*m", *(values for values, _ in curves.values()))
    for label, (values, color) in curves.items():
        left.plot(phi * angle, values * factor, color=color, label=label)
    left.set_ylabel(f"hinge torque [{unit}]")
    for steady, color, name in (
        (again.steady, style.RED, "best pressure"),
        (again.paper, style.GREY, "paper's factor 1.9"),
    ):
        if steady.speed_mean is not None:
            right.plot(steady.phi * angle, steady.omega / steady.speed_mean, color=color, label=name)
    right.set_ylabel("speed over its mean [-]")
    for axis in (left, right):
        style.legend(axis)
    return figure


_STEADY = 1e-3  # of ripple [%]: less is round-off


def loads(rows: Sequence[AtLoad]) -> "Figure":
    """Ripple of a guide over the load, with the spring as designed and set anew, and that setting.

    Returns figure: two panels; a cross at the top marks a load at which the crank does not turn steadily.
    """
    figure, (left, right) = style.panels(9, 3.6, 1, 2, "Speed ripple and setting of the spring over the load")
    ordered = sorted(rows, key=lambda row: row.share)
    shares = [100 * row.share for row in ordered]
    for points, color, name in (
        ([row.as_cut for row in ordered], style.RED, "spring as designed"),
        ([row.reset for row in ordered], style.BLUE, "setting of that load"),
    ):
        # no line between the points: at the design's own load, which may lie between, there is no ripple
        left.plot(shares, [_per_cent(s) for s in points], "o", color=color, markersize=5, label=name)
        stopped = [share for share, s in zip(shares, points, strict=True) if s.speed_ripple is None]
        left.plot(stopped, [1.0] * len(stopped), "x", color=color, transform=left.get_xaxis_transform(), clip_on=False)
    left.set(xlabel="load over that of the design [%]", ylabel="speed ripple [%]")
    left.set_ylim(0, max(left.get_ylim()[1], _STEADY))
    style.legend(left)
    right.plot(shares, [row.ratio for row in ordered], "o-", color=style.BLUE, markersize=4)
    right.axhline(1.0, color=style.GREY, linewidth=0.8)
    right.set(xlabel="load over that of the design [%]", ylabel="setting over that of the design [-]")
    return figure


def _per_cent(steady: Steady) -> float:
    return float("nan") if steady.speed_ripple is None else 100 * steady.speed_ripple
