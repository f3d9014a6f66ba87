"""Figures of chapters 3 and 5 of Nunes (2017) after its text, by the thesis's own one-degree march.

The thesis's drawings were not at hand: what is drawn is what its equations give, with their signs.
"""

from collections.abc import Mapping
from functools import partial

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from mechsym.cases import load
from mechsym.cycle.chamber import Chamber, travel, volume
from mechsym.cycle.chamber import chamber as make_chamber
from mechsym.cycle.closed.model import ClosedEngine
from mechsym.cycle.kinds.printed import March, crank_torque, marched
from mechsym.cycle.source import SHARES
from mechsym.jobs.cycle import engine
from mechsym.papers.nunes2017.numbers import MODELS, TOP_SPEED, curves_of
from mechsym.papers.page import turn_axis
from mechsym.quantities import RPM
from mechsym.style import BLUE, GREEN, ORANGE, RED, legend, panels

_SPEEDS_RPM = (2000, 4000, 6000, 8000)
_COLORS = (BLUE, RED, GREEN, ORANGE)
_ENGINES = {"OPSCE": "nunes-slider-crank", "OPGHE": "nunes-hypocycloid"}
_PERFORMANCE = (
    ("torque_avg", "average torque [N m]"),
    ("power_kw", "power [kW]"),
    ("sfc_g_kwh", "consumption [g/kWh]"),
    ("mep_kpa", "mean effective pressure [kPa]"),
    ("", "share of the fuel's energy [-]"),
    ("efficiency_percent", "thermal efficiency [%]"),
)


def figures() -> dict[str, Figure]:
    """All figures of chapter 3 from 3.1 on, and of chapter 5."""
    machines = {name: engine(load(case, {"cycle.method": "nunes2017_printed"})) for name, case in _ENGINES.items()}
    return {
        f"figure_{n.replace('.', '_')}": f for n, f in (_kinematics(machines) | _cycles(machines) | _maps()).items()
    }


def _kinematics(machines: Mapping[str, ClosedEngine]) -> dict[str, Figure]:
    theta = np.linspace(0, 2 * np.pi, 721)
    rooms = {name: make_chamber(m.chamber, m.motion) for name, m in machines.items()}
    moved = {name: travel(room.motion, theta) for name, room in rooms.items()}
    rate = (1e3, TOP_SPEED, TOP_SPEED**2)
    both = {name: [np.asarray(y) * k for y, k in zip(m, rate, strict=True)] for name, m in moved.items()}
    volumes = {name: 1e6 * volume(room, theta) for name, room in rooms.items()}
    drawn = {"3.1": _over_turn("3.1", {n: m[0] for n, m in both.items()}, "piston position [mm]")}
    for order, label in ((1, "piston velocity [m/s]"), (2, "piston acceleration [m/s$^2$]")):
        for k, name in enumerate(both):
            number = f"3.{2 * order + k}"
            # (2.58), (2.59), (2.69), (2.70): S counts outwards from the crank, so both are negative leaving the head
            drawn[number] = _over_turn(number, {name: -both[name][order]}, f"{label} at 8000 rpm")
    return drawn | {"3.6": _over_turn("3.6", volumes, "chamber volume [cm$^3$]")}


def _over_turn(number: str, curves: Mapping[str, np.ndarray], label: str) -> Figure:
    figure, (axis,) = panels(6.4, 3.6)
    for (name, y), color, line in zip(curves.items(), (BLUE, RED), ("-", "--"), strict=False):
        axis.plot(np.linspace(0, 360, y.size), y, color=color, linestyle=line, label=name)
    _finish(axis, number, label)
    turn_axis(axis)
    return figure


def _cycles(machines: Mapping[str, ClosedEngine]) -> dict[str, Figure]:
    drawn: dict[str, Figure] = {}
    for first, (name, machine) in zip((7, 10), machines.items(), strict=True):
        room = make_chamber(machine.chamber, machine.motion)
        result = marched(machine, RPM * np.array(_SPEEDS_RPM, float))
        degrees = result.theta_deg - 180.0
        figure, (axis,) = panels(6.4, 3.8)
        for k, speed in enumerate(_SPEEDS_RPM):
            axis.plot(1e6 * result.v, result.p[:, k] / 1e6, color=_COLORS[k], label=f"{speed} rpm")
        axis.set_xlabel("volume [cm$^3$]")
        _finish(axis, f"3.{first}", f"{name}: pressure [MPa]")
        drawn[f"3.{first}"] = figure
        drawn[f"3.{first + 1}"] = _piston_forces(f"3.{first + 1}", name, machine, room, result)
        torques = crank_torque(room, result)
        drawn[f"3.{first + 2}"] = _over_cycle(f"3.{first + 2}", degrees, torques, f"{name}: torque of one crank [N m]")
    tooth = crank_torque(room, result) / (2 * machines["OPGHE"].motion.parameters["e"])
    drawn["3.13"] = _over_cycle("3.13", degrees, tooth, "OPGHE: tangential tooth load [N]")
    return drawn


def _piston_forces(number: str, name: str, machine: ClosedEngine, room: Chamber, result: March) -> Figure:
    figure, axes = panels(6.4, 6, 2, 1, sharex=True)
    phi, degrees = np.radians(result.theta_deg - 360.0), result.theta_deg - 180.0
    mass = sum(machine.motion.parameters[m] for m in machine.motion.masses)
    for axis, speed in zip(axes, (4000, 8000), strict=True):
        k = _SPEEDS_RPM.index(speed)
        pressure = (result.p[:, k] - machine.chamber.back_pressure) * room.area
        inertia = -mass * travel(room.motion, phi)[2] * result.omega[k] ** 2
        for y, color, label in (
            (pressure, BLUE, "pressure"),
            (inertia, GREEN, "inertia"),
            (pressure + inertia, RED, "sum"),
        ):
            axis.plot(degrees, y / 1e3, color=color, label=label)
        _finish(axis, f"{number}, {speed} rpm", f"{name}: force [kN]")
    axes[-1].set_xlabel("crank angle from the start of compression [deg]")
    return figure


def _over_cycle(number: str, degrees: np.ndarray, curves: np.ndarray, label: str) -> Figure:
    figure, (axis,) = panels(6.4, 3.8)
    for k, speed in enumerate(_SPEEDS_RPM):
        axis.plot(degrees, curves[:, k], color=_COLORS[k], label=f"{speed} rpm")
    _finish(axis, number, label)
    axis.set_xlabel("crank angle from the start of compression [deg]")
    return figure


def _maps() -> dict[str, Figure]:
    curves = curves_of(MODELS["printed"])
    short, own = curves["slider_crank_74"], curves["hypocycloid"]
    drawn: dict[str, Figure] = {}
    for k, (key, label) in enumerate(_PERFORMANCE):
        one = partial(_over_speeds, key=key, label=label)
        a = curves["slider_crank"] if key == "" else short  # the shares were computed with the rod of 90 mm
        drawn[f"5.{1 + k}"] = one(f"5.{1 + k}", {"OPSCE": a})
        drawn[f"5.{7 + k}"] = one(f"5.{7 + k}", {"OPGHE": own})
        drawn[f"5.{14 + k}"] = one(f"5.{14 + k}", {"OPSCE": a, "OPGHE": own})
    weight = "power to weight [kW/kg]"
    return drawn | {"5.13": _over_speeds("5.13", {"OPGHE": own}, key="power_to_weight", label=weight)}


def _over_speeds(number: str, engines: Mapping[str, Mapping[str, np.ndarray]], key: str, label: str) -> Figure:
    figure, (axis,) = panels(6.4, 3.8)
    for (name, curves), line in zip(engines.items(), ("-", "--"), strict=False):
        for quantity, color in zip((key,) if key else SHARES, _COLORS, strict=False):
            shade = color if key == "" or line == "-" else RED
            axis.plot(
                curves["speed_rpm"], curves[quantity], line, color=shade, label=f"{name} {quantity if not key else ''}"
            )
    axis.set_xlabel("speed [rpm]")
    _finish(axis, number, label)
    if not key:
        axis.set_ylim(0, 0.8)
        axis.legend(fontsize=8, ncols=len(engines), loc="upper right")
    return figure


def _finish(axis: Axes, number: str, label: str) -> None:
    axis.set_ylabel(label)
    axis.set_title(f"Fig. {number}, after the text", loc="left", fontsize=10)
    legend(axis)
