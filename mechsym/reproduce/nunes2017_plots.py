"""The engine figures of the thesis (chapters 3 and 5), drawn again with its own one-degree march."""

from collections.abc import Callable
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from mechsym.cases import load
from mechsym.cycle import RPM, engine, over_speeds, speed_range
from mechsym.engine.chamber import chamber, piston_force, travel
from mechsym.engine.march import crank_torque
from mechsym.engine.model import Engine
from mechsym.engine.performance import Performance
from mechsym.engine.printed import marched

_PRINTED = {"cycle.method": "nunes2017_printed"}
_ENGINES = {"OPSCE": ("nunes-slider-crank", "tab:blue"), "OPGHE": ("nunes-hypocycloid", "tab:red")}
_SPEEDS = np.array([1000.0, 2000.0, 4000.0, 6000.0, 8000.0])
_MASS = 13.4066  # of the engine, section 5.1.2 [kg]
_SHARES = ("heat", "work", "exhaust", "unburnt")
_CURVES: list[tuple[str, str, Callable[[Performance], Any]]] = [
    ("5.1, 5.7, 5.14", "average torque [N m]", lambda p: p.torque_avg),
    ("5.2, 5.8, 5.15", "power [kW]", lambda p: p.power / 1e3),
    ("5.3, 5.9, 5.16", "specific fuel consumption [g/(kW h)]", lambda p: p.sfc * 3.6e9),
    ("5.4, 5.10, 5.17", "mean effective pressure [kPa]", lambda p: p.mep / 1e3),
    ("5.6, 5.12, 5.19", "thermal efficiency [%]", lambda p: 100 * p.efficiency),
    ("5.13", "power to weight [kW/kg]", lambda p: p.power / 1e3 / _MASS),
]


def nunes2017() -> dict[str, Figure]:
    """Figures 3.1 to 3.13 and 5.1 to 5.19, several to a sheet.

    Returns
    -------
    figures : dict of str to Figure
        By file stem
    """
    machines = {name: engine(load(case, _PRINTED)) for name, (case, _) in _ENGINES.items()}
    omega = speed_range(load("nunes-slider-crank").need("speeds"))
    found = {name: over_speeds(machine, omega) for name, machine in machines.items()}
    return {
        "nunes2017-fig3-kinematics": _kinematics(machines),
        "nunes2017-fig3-cycle": _cycles(machines),
        "nunes2017-fig5-performance": _performance(found),
        "nunes2017-fig5-energy": _energy(found),
    }


def _sheet(rows: int, columns: int, width: float = 4.0) -> tuple[Figure, np.ndarray]:
    figure = Figure(figsize=(width * columns, 3.1 * rows), layout="constrained")
    axes = np.atleast_1d(figure.subplots(rows, columns)).ravel()
    for axis in axes:
        axis.grid(True, color="#dddddd", linewidth=0.6)
    return figure, axes


def _kinematics(machines: dict[str, Engine]) -> Figure:
    figure, axes = _sheet(1, 4)
    degrees = np.arange(0, 361)
    for name, machine in machines.items():
        room, color = chamber(machine.chamber, machine.motion), _ENGINES[name][1]
        x, dx, d2x = travel(room.motion, np.radians(degrees))
        top = 8000 * RPM
        volume = (room.clearance + room.pistons * room.area * x) * 1e6
        for axis, y in zip(axes, (-x * 1e3, -dx * top, -d2x * top**2, volume), strict=True):
            axis.plot(degrees, y, color=color, label=name)
    titles = ("3.1: piston position [mm]", "3.2, 3.3: velocity at 8000 rpm [m/s]",
              "3.4, 3.5: acceleration at 8000 rpm [m/s$^2$]", "3.6: chamber volume [cm$^3$]")  # fmt: skip
    for axis, title in zip(axes, titles, strict=True):
        axis.set(xlabel="crank angle [deg]", title=f"Fig. {title}")
    axes[0].legend()
    return figure


def _cycles(machines: dict[str, Engine]) -> Figure:
    figure, axes = _sheet(2, 4)
    for row, (name, machine) in zip((axes[:4], axes[4:]), machines.items(), strict=True):
        room, result = chamber(machine.chamber, machine.motion), marched(machine, _SPEEDS * RPM)
        phi = np.radians(result.theta_deg - 360.0)[:, None]
        force = piston_force(room, phi, result.omega, result.p)
        torque = crank_torque(room, result)
        for k, rpm in enumerate(_SPEEDS):
            row[0].plot(result.v * 1e6, result.p[:, k] / 1e6, label=f"{rpm:.0f} rpm")
            row[1].plot(result.theta_deg, force[:, k] / 1e3)
            row[2].plot(result.theta_deg, torque[:, k])
            if name == "OPGHE":
                row[3].plot(result.theta_deg, force[:, k] * np.sin(phi[:, 0]) / 1e3)
        numbers = ("3.7", "3.8", "3.9", "") if name == "OPSCE" else ("3.10", "3.11", "3.12", "3.13")
        labels = ("pressure [MPa]", "force on the piston [kN]", "torque of one piston [N m]", "tooth load [kN]")
        for axis, number, label in zip(row, numbers, labels, strict=True):
            axis.set(title=f"Fig. {number}, {name}: {label}", xlabel="crank angle [deg]")
        row[0].set(xlabel="volume [cm$^3$]")
        row[0].legend(fontsize=7)
    axes[3].set_visible(False)
    return figure


def _performance(found: dict[str, Performance]) -> Figure:
    figure, axes = _sheet(2, 3)
    for axis, (number, label, value) in zip(axes, _CURVES, strict=True):
        for name, performance in found.items():
            if number != "5.13" or name == "OPGHE":
                axis.plot(performance.omega / RPM, value(performance), color=_ENGINES[name][1], label=name)
        axis.set(xlabel="speed [rpm]", ylabel=label, title=f"Figs. {number}")
    axes[0].legend()
    return figure


def _energy(found: dict[str, Performance]) -> Figure:
    figure, axes = _sheet(1, 3)
    for axis, number, (name, performance) in zip(axes, ("5.5", "5.11"), found.items(), strict=False):
        for share in _SHARES:
            axis.plot(performance.omega / RPM, getattr(performance, share), label=share)
        axis.set(xlabel="speed [rpm]", ylabel="share of the fuel's energy", title=f"Fig. {number}, {name}")
        axis.legend(fontsize=7)
    a, b = found.values()
    for share in _SHARES:
        axes[2].plot(a.omega / RPM, 100 * (getattr(b, share) / getattr(a, share) - 1), label=share)
    axes[2].set(xlabel="speed [rpm]", ylabel="OPGHE over OPSCE - 1 [%]", title="Fig. 5.18")
    axes[2].legend(fontsize=7)
    return figure
