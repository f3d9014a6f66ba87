"""What of a gas, of figures of a cycle and of two engines is worth seeing, and what has to be known first."""

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from mechsym.cycle.chamber import volume
from mechsym.cycle.columns import AFTER_FRICTION, UNITS, CycleColumns, CycleFigures, EngineComparison
from mechsym.cycle.gas import Gas
from mechsym.cycle.pressure import Pressure
from mechsym.files import Json
from mechsym.page import Card, Picture, View, card, shows
from mechsym.quantities.display import figure, quantity_text
from mechsym.quantities.results import Columns

if TYPE_CHECKING:
    from matplotlib.figure import Figure
import math
from collections.abc import Iterator

from mechsym.page.finding import LOOK_AT, Finding
from mechsym.periodic import even_angles
from mechsym.quantities import RPM
from mechsym.quantities.units import Pascal, RadPerSecond, Volume, Watt


@shows(Gas)
def gas_view(gas: Gas) -> View:
    """Pressures of a gas and its indicator diagram."""
    pressure = gas.pressure
    cards = [
        card(Pressure, "p_max", pressure.p_max, "absolute"),
        card(Pressure, "mean_indicated", pressure.mean_indicated),
    ]
    if pressure.t_max is not None:
        cards.append(card(Pressure, "t_max", pressure.t_max))
    most = quantity_text(pressure.p_max, "Pa", 4)
    see = f"Absolute pressure, at most {most}, over the {_angle(gas)}, and over the volume: the area is the work."
    drawn = (Picture(name="indicator", see=see, draw=lambda: indicator(gas)),)
    return View(title=f"Gas, {pressure.kind}", cards=tuple(cards), pictures=drawn, columns=lambda: _columns(gas))


def _angle(gas: Gas) -> str:
    """The angle of a pressure in words: nothing fires in a Stirling engine, whose pistons share a gas, or a pump."""
    fires = not gas.pistons and gas.pressure.kind != "compressor"
    return "angle from firing dead centre" if fires else "crank angle"


def _columns(gas: Gas) -> Columns:
    phi = np.unique(np.append(np.linspace(0, gas.pressure.period, 1441), gas.pressure.kinks))
    columns = {
        "phi": phi,
        "pressure": gas.pressure.absolute(phi),
        "piston_force": gas.force(phi),
        "volume": np.asarray(volume(gas.chamber, phi)).ravel(),
    }
    return Columns(columns, {"phi": "rad", "pressure": "Pa", "piston_force": "N", "volume": "m^3"})


def indicator(gas: Gas) -> "Figure":
    """Pressure over the angle and over the volume, in the units that were chosen."""
    from mechsym.style import BLUE, axis_unit, over_angle, panels

    figure, (left, right) = panels(9, 3.2, 1, 2, "Pressure over angle and volume")
    columns = _columns(gas)
    p, room = columns["pressure"], columns["volume"]
    (factor, unit), (scale, room_unit) = axis_unit("Pa", p), axis_unit("m^3", room)
    angle = over_angle(left, gas.pressure.period, _angle(gas))
    left.plot(columns["phi"] * angle, p * factor, color=BLUE)
    left.set_ylabel(f"absolute pressure [{unit}]")
    right.plot(room * scale, p * factor, color=BLUE)
    right.set(xlabel=f"volume [{room_unit}]", ylabel=f"absolute pressure [{unit}]")
    return figure


_SHOWN = ("brake_power_kw", "brake_mep_kpa", "brake_sfc_g_kwh", "brake_torque", "power_kw", "mep_kpa", "sfc_g_kwh",
          "torque_avg", "p_max_mpa", "brake_efficiency", "efficiency", "mechanical_efficiency", "ca50_deg")  # fmt: skip
_LEAST = ("brake_sfc_g_kwh", "sfc_g_kwh")  # of several speeds the least is shown, of others the largest
_OF_ONE_SPEED = ("ca50_deg",)


@shows(CycleFigures)
def cycle_view(figures: CycleFigures) -> View:
    """Brake figures first, indicated ones beside them; of several speeds each where it is best."""
    rpm = np.asarray(figures["speed_rpm"])
    one, rubs = rpm.size == 1, np.any(figures.get("friction_mep_kpa", 0.0))
    words = {} if figures.source is None else figures.source.page.words
    cards = [card(CycleColumns, "speed_rpm", rpm[0])] if one else []
    cylinders = figures.get("cylinders", 1)
    for key in _SHOWN:
        values = np.asarray(figures.get(key, np.nan), dtype=float)
        unknown = not rubs and key in AFTER_FRICTION
        if unknown or not np.isfinite(values).any() or not one and key in _OF_ONE_SPEED:
            continue
        k = int((np.nanargmin if key in _LEAST else np.nanargmax)(values))
        about = [] if one else [f"{'least' if key in _LEAST else 'largest'}, at {figure(float(rpm[k]), 4)} rpm"]
        if cylinders > 1 and key in figures.get("per_cylinder", {}):
            about.append(f"of {cylinders} {figures.get('each', 'cylinder')}s together")
        if key == "p_max_mpa" and one:
            about.append(f"at {figure(float(np.ravel(figures['p_max_angle_deg'])[k]), 3)} deg")
        if key in _ABOUT:
            about.append(_ABOUT[key] if "heat_in_j" not in figures else "of the heat from the hot side")
        shown = card(CycleColumns, key, values.flat[k], ", ".join(about))
        cards.append(replace(shown, name=words.get(key, shown.name)))
    drawn = (
        () if one else (Picture(name="speeds", see="Torque and power over the speed.", draw=lambda: _speeds(figures)),)
    )
    return View(title="Engine cycle", cards=tuple(cards), pictures=drawn, columns=lambda: _flat(figures, rpm.size),
                findings=lambda: of_cycle(figures))  # fmt: skip


_ABOUT = {
    "efficiency": "of the fuel's heating value",
    "brake_efficiency": "of the fuel's heating value",
    "mechanical_efficiency": "brake by net indicated power",
    "ca50_deg": "half of the heat is released, from firing dead centre",
}


def _flat(figures: Json, size: int) -> Columns:
    return Columns({k: v for k, v in figures.items() if isinstance(v, np.ndarray) and v.shape == (size,)}, UNITS)


def _speeds(figures: Json) -> "Figure":
    from mechsym.style import BLUE, RED, axis_unit, legend, panels

    figure, axes = panels(9, 3.2, 1, 2, "Torque and power over the speed")
    omega = np.asarray(figures["speed_rpm"]) * np.pi / 30
    rubs = np.any(figures.get("friction_mep_kpa", 0.0))
    curves = (("torque", "brake_torque", "torque_avg", 1.0, "N*m"), ("power", "brake_power_kw", "power_kw", 1e3, "W"))
    for axis, (name, brake, indicated, times, si) in zip(axes, curves, strict=True):
        keys = {**({"brake": brake} if rubs else {}), "indicated": indicated}
        (across, rpm), (factor, unit) = axis_unit("rad/s", omega), axis_unit(si, times * np.asarray(figures[indicated]))
        for (label, key), look, color in zip(keys.items(), ("-", "--"), (BLUE, RED), strict=False):
            axis.plot(omega * across, times * factor * np.asarray(figures[key]), look, color=color, label=label)
        axis.set(xlabel=f"speed [{rpm}]", ylabel=f"{name} [{unit}]")
        legend(axis)
    return figure


@shows(EngineComparison)
def comparison_view(comparison: EngineComparison) -> View:
    """Where the torque curves of two engines cross."""
    crossing = ", ".join(quantity_text(float(v) * np.pi / 30, "rad/s") for v in comparison.numbers.crossover_rpm)
    where = Card(name="mean torque crosses at", value=crossing or "no speed")
    names = ("quantity", "speed_rpm", "a", "b", "difference", "unit")
    columns = {name: [getattr(row, name) for row in comparison.numbers.table] for name in names}
    return View(title="Two engines", cards=(where,), columns=lambda: columns)


_SAME = 1e-6  # of an efficiency: nearer to Carnot's no model with losses comes
_TEMPERATURES = ("T_e_max_k", "T_c_min_k")
_BEALE = 0.15  # of machines as built, heater at about 900 K [-]


def beale_power(mean_pressure: Pascal, swept: Volume, omega: RadPerSecond) -> Watt:
    r"""Shaft power that Stirling engines as built give, by the rule of Beale.

    .. math:: P = 0.15\, \bar p V \omega / 2\pi

    mean_pressure: of the gas over a turn; swept: volume that the hot piston sweeps. By G. Walker, Stirling
    Engines, Oxford University Press, 1980.

    >>> round(beale_power(5e5, 763e-6, 62.83), 1)
    572.2
    """
    return _BEALE * mean_pressure * swept * omega / (2 * math.pi)


def of_cycle(figures: CycleFigures) -> Iterator[Finding]:
    r"""Unequal strokes, and Carnot's efficiency :math:`1 - T_c/T_e`, whose power is therefore an upper bound."""
    if figures.apart:
        words = (
            f"strokes differ by up to {figure(100 * figures.apart, 2)} %: every cylinder has the pressure of the first "
            "at the same share of its stroke"
        )
        yield Finding(rank=LOOK_AT, words=words, value=figures.apart)
    if not all(name in figures for name in (*_TEMPERATURES, "efficiency")):
        return
    hot, cold = (np.asarray(figures[name], dtype=float) for name in _TEMPERATURES)
    ceiling = 1.0 - cold / hot
    at = int(np.argmax(figures["efficiency"]))
    if abs(float(np.asarray(figures["efficiency"])[at] - ceiling[at])) <= _SAME:
        power = quantity_text(1e3 * float(np.max(figures["power_kw"])), "W", 4)
        words = (
            f"{figure(100 * ceiling[at], 4)} % is Carnot's efficiency between {figure(cold[at], 4)} and "
            f"{figure(hot[at], 4)} K: the model has no losses, and {power} is an upper bound{_as_built(figures)}"
        )
        yield Finding(rank=LOOK_AT, words=words, value=float(ceiling[at]))


def _as_built(figures: CycleFigures) -> str:
    """What such machines give as they are built, where the gas is known."""
    if figures.source is None:
        return ""
    best = int(np.argmax(figures["power_kw"]))
    omega = RPM * float(np.asarray(figures["speed_rpm"])[best])
    gas = figures.source.at(omega)
    mean = float(np.mean(gas.pressure.absolute(even_angles(gas.pressure.period))))
    power = figures.get("cylinders", 1) * beale_power(mean, gas.chamber.displacement, omega)
    return f"; machines as built give about {quantity_text(power, 'W', 2)} (Beale's rule, 0.15 p f V)"
