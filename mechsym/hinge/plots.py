"""Figures of a hinge design. matplotlib is imported in plot modules only; a figure is never shown."""

import numpy as np
from matplotlib.figure import Figure

from mechsym.cycle.chamber import volume
from mechsym.hinge.contact import Contact
from mechsym.hinge.result import Design
from mechsym.hinge.rollers import parallel
from mechsym.machine.record import gas_of
from mechsym.mechanisms.record import velocities
from mechsym.style import BLUE, GREEN, GREY, ORANGE, RED, angle_axis, panels

_DEG = 180 / np.pi


def unit_of(peak: float, unit: str) -> tuple[float, str]:
    """Unit in which numbers of a size read well: thousands of it where they are large.

    Parameters
    ----------
    peak : float
        Largest magnitude [SI unit]
    unit : str
        The SI unit as it is written

    Returns
    -------
    factor : float
        To be multiplied with [-]
    unit : str
        The unit, perhaps with a k
    """
    return (1e-3, f"k{unit}") if abs(peak) >= 1e3 else (1.0, unit)


def pressure(design: Design) -> Figure:
    """Cylinder pressure over the crank angle with the angles of its events, and over the volume."""
    room = gas_of(design.machine)
    gas = room.pressure
    figure, (left, right) = panels(9, 3.2, 1, 2)
    phi = np.unique(np.append(np.linspace(0, gas.period, 1441), gas.kinks))
    p = gas.absolute(phi) / 1e5
    left.plot(phi * _DEG, p, color=BLUE)
    for name, angle in gas.phases.items():
        at = angle % gas.period
        left.axvline(at * _DEG, color=GREY, linewidth=0.7, linestyle=":")
        label = name.replace("_", " ")
        left.text(at * _DEG, 0.98 * p.max(), f" {label}", rotation=90, va="top", fontsize=7, color=GREY)
    left.set_xlabel("crank angle [deg]")
    left.set_ylabel("absolute pressure [bar]")
    angle_axis(left, gas.period * _DEG)
    right.plot(1e3 * volume(room.chamber, phi), p, color=BLUE)
    right.set_xlabel("volume [L]")
    right.set_ylabel("absolute pressure [bar]")
    return figure


def torque(design: Design) -> Figure:
    """The hinge torque with its parts, and its work.

    Returns
    -------
    figure : Figure
        Two panels over the crank angle
    """
    hinge = design.hinge
    figure, (upper, lower) = panels(9, 5.0, 2, 1, sharex=True, height_ratios=[2, 1])
    phi = np.linspace(0, hinge.period, 1441)
    factor, unit = unit_of(max(hinge.torque_max, -hinge.torque_min), "N m")
    work_factor, work_unit = unit_of(max(hinge.work_max, -hinge.work_min), "J")
    parts = [
        ("gas and load", hinge.gas_part, RED),
        ("inertia", hinge.inertia_part, GREEN),
        ("gravity", hinge.gravity_part, ORANGE),
    ]
    for name, part, color in parts:
        upper.plot(phi * _DEG, part(phi) * factor, color=color, linewidth=1, label=name)
    upper.plot(phi * _DEG, hinge.torque(phi) * factor, color=BLUE, linewidth=2, label="hinge torque $M_h$")
    upper.axhline(0, color="black", linewidth=0.6)
    upper.set_ylabel(f"torque on the crank [{unit}]")
    upper.legend(fontsize=8, ncols=4, loc="lower center", bbox_to_anchor=(0.5, 1.0), frameon=False)
    lower.plot(phi * _DEG, hinge.work(phi) * work_factor, color=BLUE)
    lower.set_ylabel(f"work $W$ [{work_unit}]")
    lower.set_xlabel("crank angle [deg]")
    angle_axis(lower, hinge.period * _DEG)
    return figure


def track(design: Design, turn: Contact, radius: float) -> Figure:
    """The path of the roller centres and the cut profile, to scale, with spring and rollers at a quarter turn.

    Parameters
    ----------
    turn : Contact
        The guide in numbers over a whole turn of its shaft
    radius : float
        Roller radius [m]
    """
    figure, (axis,) = panels(5.2, 5.2)
    x, y = parallel(turn.rho, turn.drho, turn.theta, radius)
    circle = design.guide.parameters.rho0 * np.exp(1j * np.linspace(0, 2 * np.pi, 361))
    axis.plot(
        circle.real, circle.imag, color=GREY, linewidth=0.8, linestyle="--", label=r"$\rho_0$, spring at free height"
    )
    axis.plot(
        turn.rho * np.cos(turn.theta), turn.rho * np.sin(turn.theta), color=BLUE, label="path of the roller centre"
    )
    axis.plot(x, y, color=RED, label="cut profile, first track")
    if design.guide.rollers == 2:
        axis.plot(-x, -y, color=RED, linewidth=0.8, linestyle=":", label="second track, turned by 180 deg")
    axis.plot(0, 0, marker="+", color="black", markersize=10)
    axis.set_aspect("equal")
    axis.set_xlabel("x [m]")
    axis.set_ylabel("y [m]")
    axis.legend(fontsize=7, loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2, frameon=False)
    return figure


def contact(turn: Contact) -> Figure:
    """Roller reactions, pressure angle, spring pressure and curvature around the turn.

    Parameters
    ----------
    turn : Contact
        The guide in numbers over a whole turn of its shaft

    Returns
    -------
    figure : Figure
        Four panels over the angle of the guide's shaft
    """
    figure, axes = panels(9, 5, 2, 2, sharex=True)
    theta = turn.theta * _DEG
    axes[0].plot(theta, turn.reaction_1 / 1e3, color=BLUE, label="$N_1$")
    axes[0].plot(theta, turn.reaction_2 / 1e3, color=RED, linestyle="--", label="$N_2$")
    axes[0].legend(fontsize=8)
    axes[0].set_ylabel("roller reaction [kN]")
    axes[1].plot(theta, turn.pressure_angle * _DEG, color=BLUE)
    axes[1].set_ylabel("pressure angle [deg]")
    if turn.pressure is None:
        axes[2].plot(theta, turn.force / 1e3, color=BLUE)
        axes[2].set_ylabel("spring force [kN]")
    else:
        axes[2].plot(theta, turn.pressure / 1e6, color=BLUE)
        axes[2].set_ylabel("excess pressure in the spring [MPa]")
    axes[3].plot(theta, turn.curvature, color=BLUE)
    axes[3].set_ylabel("curvature of the path [1/m]")
    for axis in axes[2:]:
        axis.set_xlabel("angle of the guide's shaft [deg]")
    angle_axis(axes[3], 2 * np.pi * _DEG)
    return figure


def speeds(design: Design) -> Figure:
    """Crank speed of the trials side by side.

    Returns
    -------
    figure : Figure
        Two panels: with hinge, and all
    """
    figure, (left, right) = panels(9, 3.4, 1, 2)
    colors = {
        "without": GREY,
        "flywheel": "black",
        "hinge_constant": BLUE,
        "hinge_propeller": GREEN,
        "off_constant": RED,
        "off_propeller": ORANGE,
    }
    (q,), (u,) = design.machine.mechanism.coordinates, velocities(design.machine.mechanism)
    for trial in design.trials:
        turns = trial.result.columns[q] / (2 * np.pi)
        share = trial.result.columns[u] / design.machine.omega
        for axis in (right,) if trial.name in ("without", "flywheel") else (left, right):
            axis.plot(turns, share, color=colors[trial.name], linewidth=1.1, label=trial.about)
    left.set_title("with the hinge", fontsize=9)
    right.set_title("all, first two turns", fontsize=9)
    right.set_xlim(0, 2)
    right.legend(fontsize=7)
    for axis in (left, right):
        axis.set_xlabel("turns of the crank")
        axis.set_ylabel("speed over design speed")
    return figure


def retuning(design: Design) -> Figure:
    """Torque that the other speed needs, and what the same guide gives there with the best pressure."""
    from mechsym.hinge.guide import crank_torque, refit

    again = design.retuned
    if again is None:
        raise ValueError("the design was not retuned")
    figure, (left, right) = panels(9, 3.2, 1, 2)
    phi = np.linspace(0, again.wanted.period, 1441)
    left.plot(phi * _DEG, design.hinge.torque(phi) / 1e3, color=GREY, label="wanted at the design speed")
    left.plot(phi * _DEG, again.wanted.torque(phi) / 1e3, color=BLUE, label="wanted at the other speed")
    left.plot(
        phi * _DEG,
        crank_torque(refit(design.guide, again.spring), phi) / 1e3,
        color=RED,
        label="same guide, best pressure",
    )
    left.legend(fontsize=7)
    left.set_xlabel("crank angle [deg]")
    left.set_ylabel("hinge torque [kN m]")
    angle_axis(left, again.wanted.period * _DEG)
    for steady, color, name in ((again.steady, RED, "best pressure"), (again.paper, GREY, "paper's factor 1.9")):
        if steady.speed_mean is not None:
            right.plot(steady.phi * _DEG, steady.omega / steady.speed_mean, color=color, label=name)
    right.legend(fontsize=7)
    right.set_xlabel("crank angle [deg]")
    right.set_ylabel("speed over its mean")
    angle_axis(right, again.wanted.period * _DEG)
    return figure
