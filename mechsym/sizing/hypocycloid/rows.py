"""Rows of a hypocycloid engine: its parts, their masses and the headline figures."""

import dataclasses
from collections.abc import Callable
from typing import Any

import numpy as np

from mechsym.sizing.hypocycloid.checks import fastest_run, holding
from mechsym.sizing.hypocycloid.engine import bending_moment, shaft
from mechsym.sizing.hypocycloid.masses import Moving, PrintedMasses, part_masses
from mechsym.sizing.hypocycloid.parts import PartForces, Parts, Stock
from mechsym.sizing.rows import fact, size_rows
from mechsym.sizing.rules.masses import power_to_weight
from mechsym.sizing.rules.materials import get
from mechsym.sizing.rules.shaft_beam import inner_slope
from mechsym.sizing.wants import Wants


def part_rows(parts: Parts, rule: str) -> list[dict[str, Any]]:
    """Every size of every part."""
    return [
        row
        for field in dataclasses.fields(parts)
        for row in size_rows(field.name, getattr(parts, field.name), rule)
    ]  # fmt: skip


def mass_rows(parts: Parts, printed: PrintedMasses, wants: Wants, stock: Stock) -> list[dict[str, Any]]:
    """The mass of one of each part."""
    return [
        fact(part, "mass of one", m, "kg", "mass model", note=f"{n} in the engine")
        for part, (m, n) in part_masses(parts, printed, wants, stock).items()
    ]


def engine_rows(
    parts: Parts, forces: PartForces, moving: Moving, mass: float, power: float, wants: Wants, stock: Stock,
    reciprocating: float,
) -> list[dict[str, Any]]:  # fmt: skip
    """The headline figures.

    Parameters
    ----------
    mass : float
        Of the whole engine [kg]
    power : float
        At the highest speed [W]
    reciprocating : float
        Mass on the cylinder axis that the case gives [kg]
    """
    steel = get(dict(stock.materials), wants.crankshaft)
    slope = inner_slope(shaft(parts, stock), steel.youngs_modulus, bending_moment(parts, forces, stock))
    return [
        fact("engine", "moving mass on the cylinder axis", moving.axis, "kg", "mass model",
             note=f"the case has {reciprocating:.3f} kg"),
        fact("engine", "largest force on a piston rod", float(np.abs(forces.rod).max()), "N", "force chain"),
        fact("engine", "largest tooth load of a crank", float(np.abs(forces.tooth).max()), "N", "force chain"),
        fact("engine", "slope at the inner journal", float(slope.max()), "rad", "beam, not rated",
             "Shigley table 7-2", "0.0008 to 0.0012 are usual for rollers under a steady load"),
        fact("engine", "mass without belt", mass, "kg", "mass roll-up", "ch. 5.1.2"),
        fact("engine", "power at the highest speed", power, "W", "cycle", "eq. 2.46"),
        fact("engine", "power to weight", power_to_weight(power, mass), "W/kg", "mass roll-up", "fig. 5.13"),
    ]  # fmt: skip


def nearest_rows(
    parts: Parts, forces: PartForces, wants: Wants, stock: Stock, power: Callable[[float], float]
) -> list[dict[str, Any]]:
    """Speeds at which these parts may run at full load, when they may not at all.

    Parameters
    ----------
    power : callable
        Crank speed [rad/s] -> power of the engine [W]
    """
    held = holding(parts, forces, wants, stock)
    if not held.any():
        return []
    low, high = fastest_run(held)
    at = "full load only inside this range; the nearest engine that holds"
    return [
        fact("engine", "lowest speed at full load", forces.omega[low], "rad/s", "all checks", note=at),
        fact("engine", "highest speed", forces.omega[high], "rad/s", "all checks", note=at),
        fact("engine", "power at that speed", power(forces.omega[high]), "W", "cycle", note=at),
    ]
