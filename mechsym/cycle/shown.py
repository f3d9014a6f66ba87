"""What of a gas on a piston is worth seeing."""

from typing import TYPE_CHECKING

import numpy as np

from mechsym.cycle.chamber import volume
from mechsym.cycle.gas import Gas
from mechsym.page import Card, Picture, View, shows
from mechsym.quantities.display import quantity_text

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@shows(Gas)
def gas_view(gas: Gas) -> View:
    """Pressures of a gas and its indicator diagram."""
    pressure = gas.pressure
    cards = [
        Card(name="peak pressure", value=quantity_text(pressure.p_max, "Pa", 4), about="absolute"),
        Card(name="mean indicated pressure", value=quantity_text(pressure.mean_indicated, "Pa", 4)),
    ]
    if pressure.t_max is not None:
        cards.append(Card(name="peak temperature", value=quantity_text(pressure.t_max, "K", 4)))
    see = f"Absolute pressure over the {_angle(gas)}, and over the volume: the area is the work."
    drawn = () if gas.on_shaft else (Picture(name="indicator", see=see, draw=lambda: indicator(gas)),)
    return View(title=f"Gas, {pressure.kind}", cards=tuple(cards), pictures=drawn, columns=lambda: _columns(gas))


def _angle(gas: Gas) -> str:
    """The angle of a pressure in words: nothing fires in a Stirling engine, whose pistons share a gas, or a pump."""
    fires = not gas.pistons and gas.pressure.kind != "compressor"
    return "angle from firing dead centre" if fires else "crank angle"


def _columns(gas: Gas) -> dict[str, np.ndarray]:
    phi = np.unique(np.append(np.linspace(0, gas.pressure.period, 1441), gas.pressure.kinks))
    told = {"phi": phi, "pressure": gas.pressure.absolute(phi), "piston_force": gas.force(phi)}
    return told if gas.on_shaft else told | {"volume [m^3]": np.asarray(volume(gas.chamber, phi)).ravel()}


def indicator(gas: Gas) -> "Figure":
    """Pressure over the angle and over the volume, in the units that were chosen."""
    from mechsym.style import BLUE, axis_unit, over_angle, panels

    figure, (left, right) = panels(9, 3.2, 1, 2, "Pressure over angle and volume")
    columns = _columns(gas)
    p, room = columns["pressure"], columns["volume [m^3]"]
    (factor, unit), (scale, room_unit) = axis_unit("Pa", p), axis_unit("m^3", room)
    angle = over_angle(left, gas.pressure.period, _angle(gas))
    left.plot(columns["phi"] * angle, p * factor, color=BLUE)
    left.set_ylabel(f"absolute pressure [{unit}]")
    right.plot(room * scale, p * factor, color=BLUE)
    right.set(xlabel=f"volume [{room_unit}]", ylabel=f"absolute pressure [{unit}]")
    return figure
