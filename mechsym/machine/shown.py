"""What of a machine that is ready to turn is worth seeing."""

from typing import TYPE_CHECKING

import numpy as np

from mechsym import mechanisms
from mechsym.machine.loads import ConstantLoad, PropellerLoad, TableLoad, load_torque
from mechsym.machine.record import Machine, acting, kinks_of, period_of
from mechsym.page import Card, Picture, View, shows
from mechsym.quantities.display import quantity_text
from mechsym.quantities.results import Columns

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_LOADS = {ConstantLoad: "constant torque", PropellerLoad: "propeller", TableLoad: "table over the speed"}


@shows(Machine)
def machine_view(machine: Machine) -> View:
    """What turns, how fast, against which load, and what acts on it over the angle."""
    cards = [Card(name="mechanism", value=machine.mechanism.name, about=", ".join(machine.mechanism.coordinates))]
    if machine.omega:
        cards.append(Card(name="speed", value=quantity_text(machine.omega, "rad/s", 4)))
    takes = "takes what the gas gives at the speed of operation"  # where it is not known before a run
    if machine.omega and getattr(machine.load, "torque", 0.0) is not None:
        takes = f"{quantity_text(float(load_torque(machine.load, machine.omega)), 'N*m', 4)} at that speed"
    cards.append(Card(name="load", value=_LOADS[type(machine.load)], about=takes))
    if machine.gas is not None:
        cards += machine.gas.view.cards
    drawn = machine.gas.view.pictures if machine.gas is not None else ()
    see = "Forces and torques over one period of all that acts."
    if acting(machine):
        drawn = (Picture(name="acting", see=see, draw=lambda: _drawn(machine)), *drawn)
    return View(title="Machine", cards=tuple(cards), pictures=drawn, columns=lambda: _columns(machine))


def _columns(machine: Machine) -> Columns:
    phi = np.unique(np.append(np.linspace(0, period_of(machine), 1441), kinks_of(machine)))
    units = _units(machine)
    forces = {force.name: np.asarray(force.value(phi)) for force in acting(machine)}
    own = {force.name: units.get(force.input, "N*m") for force in acting(machine)}
    return Columns({"phi": phi, **forces}, {"phi": "rad", **own})


def _units(machine: Machine) -> dict[str, str]:
    return mechanisms.listing(machine.mechanism.name, machine.mechanism)["inputs"]


def _drawn(machine: Machine) -> "Figure":
    from mechsym.style import BLUE, axis_unit, over_angle, panels

    forces, units = acting(machine), _units(machine)
    title = "What acts on the machine over the angle"
    figure, axes = panels(8, 2.4 * len(forces) + 0.4, len(forces), 1, title, sharex=True)
    for axis, force in zip(axes, forces, strict=True):
        angle = over_angle(axis, period_of(machine))
        phi = np.linspace(0, period_of(machine), 1441)
        values = np.asarray(force.value(phi))
        factor, unit = axis_unit(units.get(force.input, "N*m"), values)
        axis.plot(phi * angle, values * factor, color=BLUE)
        axis.set_ylabel(f"{force.name} [{unit}]")
        axis.set_xlabel(axis.get_xlabel() if axis is axes[-1] else "")
    return figure
