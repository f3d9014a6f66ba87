"""Everything about the forces of one turn, in one record."""

import dataclasses
import math
import re
from collections.abc import Mapping
from typing import Annotated

import numpy as np

from mechsym import mechanisms
from mechsym.cycle.friction import Friction as CycleFriction
from mechsym.forces import textbook
from mechsym.forces.comparison import ComparedMechanism
from mechsym.forces.friction import Friction, Losses, NoRings, Rings, losses
from mechsym.forces.loads import Loads, loads, radial, tangential
from mechsym.forces.mains import Journal, MainShaft, Orbit, journals, orbit
from mechsym.forces.shaking import BalanceWanted, Harmonics, Shaking, orders, roll_moment, shaking, verdict
from mechsym.forces.textbook import Chain
from mechsym.forces.turn import Turn
from mechsym.page import Shown
from mechsym.quantities import record
from mechsym.quantities.results import Columns
from mechsym.quantities.units import Array, Pure, Radian

_MOTION = ("x", "psi")
_UNITS = {"phi_deg": "deg", "p": "Pa", "torque": "N*m", "roll_moment": "N*m", "driving_torque": "N*m"}


def columns(turn: Turn, loads: Loads, chains: Mapping[str, Chain] | None = None) -> Columns:
    """The table of a turn: angle, gas, motion, loads, torque, SI units unless the name says otherwise.

    chains: chains of the sources by name.

    Returns
    -------
    columns : Columns
        `phi_deg` first, then `p`, what acts, motion, pins, bearings, guides, reactions, `torque`, chains, and all other
        inputs and outputs of the declaration; each of shape (n,)
    """
    table: dict[str, np.ndarray] = {"phi_deg": np.degrees(turn.phi)}
    if turn.acting:
        first = turn.acting[0]
        table["p"] = first.gas.pressure.absolute(turn.phi - first.face.fires)
    table |= dict(turn.inputs) | {n: v for n, v in turn.kinematics.items() if n.startswith(_MOTION)}
    for pin in loads.pins:
        table |= {f"{pin.name}_radial": radial(pin), f"{pin.name}_tangential": tangential(pin)}
        table[f"{pin.name}_load"] = np.hypot(pin.x, pin.y)
    for name, (x, y) in loads.bearings.items():
        table |= {f"{name}_x": x, f"{name}_y": y, f"{name}_load": np.hypot(x, y)}
    table |= dict(loads.guides) | {n: v for n, v in turn.reactions.items() if n not in table}
    table["torque"] = turn.torque
    if (roll := roll_moment(turn)) is not None:
        table["roll_moment"] = roll
    for name, chain in (chains or {}).items():
        table |= {f"{name}_{f.name}": getattr(chain, f.name) for f in dataclasses.fields(chain)}
    idle = {name: np.zeros_like(turn.phi) for name in turn.drive.mechanism.inputs}
    table["driving_torque"] = turn.driving
    table |= {n: v for n, v in {**idle, **turn.kinematics}.items() if n not in table}
    listed = mechanisms.listing(turn.drive.name, turn.drive.mechanism)
    known = _UNITS | dict(listed["inputs"]) | {name: "N*m" for name in turn.reactions if name.startswith("M_")}
    known |= {name: unit for name, unit in listed["outputs"].items() if unit}
    known |= {name: _of_slope(name, listed["coordinates"]) for name in turn.kinematics if name not in known}
    # what is left are forces of parts and chains
    chained = ("two_mass_M", "terskih_M")
    units = {n: known.get(n, "N*m" if n.endswith(chained) else "N") for n in table}
    shown = {n: turn.drive.mechanism.shown.get(n, n) for n in table}
    return Columns({shown[n]: v for n, v in table.items()}, {shown[n]: unit for n, unit in units.items()})


def _of_slope(name: str, coordinates: Mapping[str, str]) -> str:
    """Unit of an output that closing a loop adds: a dependent coordinate, the inertia, or a slope by the angle."""
    if slope := re.fullmatch(r"d2?(\w+)_d\w+?(2?)", name):
        by = "(rad*rad)" if slope[2] else "rad"
        return f"{_of_slope(slope[1], coordinates)}/{by}"
    return coordinates.get(name, "kg*m^2" if name == "inertia" else "m")


def extremes(columns: Mapping[str, np.ndarray]) -> tuple[dict[str, float], dict[str, float]]:
    """Largest and smallest value of every column."""
    return {k: float(np.max(v)) for k, v in columns.items()}, {k: float(np.min(v)) for k, v in columns.items()}


def angle_of_largest(phi: Radian[Array], values: Pure[Array]) -> Annotated[float, "deg"]:
    """Crank angle within a period, in degrees, at which a column in any unit is largest."""
    return math.degrees(phi[int(np.argmax(values))])


@record
class Forces(Shown):
    """Everything that `mechsym forces` reports."""

    turn: Turn
    loads: Loads
    columns: Columns  #: shape (n,): The table `forces.csv`
    torque_orders: Harmonics
    shaking: Shaking | None  #: Forces and moments on the frame; None where the momentum is not known
    losses: Losses | None  #: Friction, where the case has coefficients
    chains: dict[str, textbook.Chain]  #: For a slider crank: rod as two masses, and Terskih's rule
    journals: tuple[Journal, ...]  #: Main bearings at their places; none where these are not known
    bearings: MainShaft  #: How the shaft lies on them
    orbits: tuple[Orbit, ...]  #: Of the journals in their oil; none where `[shaft]` does not give the film
    unbalanced: list[str]  #: Why balance that was asked for is not reached
    comparison: list[ComparedMechanism] | None


def forces(
    turn: Turn,
    friction: Friction | None = None,
    rings: Rings | None = None,
    wanted: BalanceWanted | None = None,
    shaft: MainShaft | None = None,
    whole: CycleFriction | None = None,
) -> Forces:
    """Forces of a turn, friction where coefficients are given. whole: law of friction, see `friction.losses`."""
    carried, shake, chains = loads(turn), shaking(turn), {}
    if textbook.rod_of(turn) is not None:
        rod = textbook.slider_crank(turn)
        ratios = {"two_mass": rod.L_m / rod.L, "terskih": textbook.terskih(turn.omega)}
        chains = {name: textbook.chain(turn, ratio) for name, ratio in ratios.items()}
    shaft = shaft or MainShaft()
    borne = journals(turn, shaft)
    return Forces(
        turn=turn,
        loads=carried,
        columns=columns(turn, carried, chains),
        torque_orders=orders(turn.torque, turn.period),
        shaking=shake,
        losses=losses(turn, friction, rings or NoRings(), whole) if friction else None,
        chains=chains,
        journals=borne,
        bearings=shaft,
        orbits=tuple(orbit(one, shaft, turn.omega, turn.phi, turn.period) for one in borne) if shaft.oiled else (),
        unbalanced=verdict(turn, shake, wanted) if wanted and shake else [],
        comparison=None,
    )
