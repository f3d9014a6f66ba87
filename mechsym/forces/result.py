"""Everything about the forces of one turn, in one record; and mechanisms side by side.

Slider crank, hypocycloid and rodless are compared at equal stroke, reciprocating mass and gas force. Equal gas force
means the same indicator diagram: equal pressure at equal travel of the piston, so that every mechanism gets the same
work from the gas. Equal pressure at equal crank angle would not: the pistons move differently. Rods, planets, links and
cranks have no mass here, so that only the arrangement differs. The rodless mechanism stands there with one piston and
with four (two on each axis), each under both closing rules: what the guides carry depends on how the parts give way.

What the sources claim about friction and loads is judged by it (`claims`). A claim holds only as far as the
coefficients of the case do; each verdict names the numbers it rests on.
"""

import dataclasses
import math
import re
from collections.abc import Mapping, Sequence
from typing import Annotated

import numpy as np

from mechsym import mechanisms
from mechsym.cycle.friction import Friction as CycleFriction
from mechsym.cycle.gas import at_same_travel
from mechsym.cycle.motion import piston_travel
from mechsym.errors import BadInput
from mechsym.forces import textbook
from mechsym.forces.friction import Friction, Losses, NoRings, Rings, losses
from mechsym.forces.loads import (
    BalanceWanted,
    Harmonics,
    Loads,
    Shaking,
    loads,
    orders,
    power_residual,
    radial,
    roll_moment,
    shaking,
    tangential,
    under_own_name,
    verdict,
    whole,
    with_resultants,
)
from mechsym.forces.mains import Journal, MainShaft, Orbit, journals, orbit
from mechsym.forces.textbook import Chain
from mechsym.forces.turn import CrankDrive, Turn, at, crank_drive, faces_of
from mechsym.mechanisms import crosshead, hypocycloid
from mechsym.mechanisms.peers import Alike, peers
from mechsym.mechanisms.plan import plan_of
from mechsym.page import Shown
from mechsym.quantities import quantity, record
from mechsym.quantities.results import Columns, part, result
from mechsym.quantities.units import Array, Kilogram, Pure, Radian


@record
class ComparisonSettings:
    """Section `[comparison]`: what the compared mechanisms need besides the case."""

    #: Crank radius over rod length of the slider crank [-]
    lam: float = quantity("-", default=26 / 90, above=0, below=1, about="crank radius over rod length")
    #: Pressure angle of the hypocycloid's teeth [rad]
    alpha_n: float = quantity("rad", default=math.radians(25), low=0, below=math.pi / 2, about="pressure angle")


@result
class ComparedFriction:
    """What friction takes of a mechanism in the comparison."""

    friction_per_piston: float = quantity("W")  #: Mean power lost
    friction_places: Mapping[str, float] = quantity("W")  #: The same by place
    mechanical_efficiency: float | None = quantity("-")  #: Null where the gas gives no power
    friction_mean_pressure: float | None = quantity("Pa")  #: Work lost in a cycle over the swept volume


@result
class ComparedMechanism:
    """A mechanism of the comparison, at the stroke, mass and gas of all."""

    mechanism: str = part()
    pistons: int = quantity("-")  #: How many of them act
    side_force_max: float = quantity("N")  #: Largest on any guide
    crank_pin_max: float = quantity("N")  #: Largest load of the crank pin
    crank_pin_mean: float = quantity("N")  #: Mean load of the crank pin
    main_bearing_max: float = quantity("N")  #: Largest load of the main bearing
    tooth_force_max: float | None = quantity("N")  #: Largest, where it has teeth
    torque_max: float = quantity("N*m")  #: Largest torque on the shaft
    torque_mean: float = quantity("N*m")  #: Mean torque on the shaft
    shaking_order_1: float = quantity("N")  #: Shaking force once a turn, the larger of both directions
    shaking_order_2: float = quantity("N")  #: The same twice a turn
    shaking_rms_after_counterweight: float = quantity("N")  #: Root mean square of what the best counterweight leaves
    power_residual: float = quantity("-")  #: Gap of two ways to the power of the load, over the largest power
    friction: ComparedFriction | None = part(inline=True, optional=True)  #: Where the case has coefficients


def compare(
    turn: Turn, friction: Friction | None, rings: Rings, settings: ComparisonSettings
) -> list[ComparedMechanism]:
    """The mechanisms with the stroke, mass and gas of a machine. friction: the same for all; None leaves it out."""
    if turn.gas is None:
        raise BadInput("a comparison at equal gas force needs a [cycle]")
    if turn.gas.pistons:
        raise BadInput("a comparison at equal gas force needs a gas of each cylinder; here all pistons share one")
    alike = Alike(
        stroke=turn.gas.chamber.stroke,
        mass=reciprocating_mass(turn),
        area=turn.gas.chamber.area,
        period=turn.gas.pressure.period,
        lam=settings.lam,
        alpha_n=settings.alpha_n,
    )
    rows = []
    for peer in peers(alike):
        machine = crank_drive(peer.mechanism, peer.parameters, peer.faces, peer.closing)
        rows.append(_row(peer.label, turn, machine, friction, rings))
    return rows


def reciprocating_mass(turn: Turn) -> Kilogram:
    """Mass that moves with one piston."""
    first, *others = faces_of(turn.drive)
    return first.mass / (1 + sum(one.travel == first.travel for one in others))


def _row(name: str, turn: Turn, drive: CrankDrive, friction: Friction | None, rings: Rings) -> ComparedMechanism:
    travels = (piston_travel(*plan_of(d.name).alone(d.parameters)) for d in (turn.drive, drive))
    machine = at(drive, at_same_travel(turn.gas, *travels) if turn.gas else None, turn.omega, turn.phi)
    borne, shake, count = loads(machine), shaking(machine), len(machine.acting)
    assert shake is not None  # every peer tells its momentum
    pin = np.hypot(borne.pins[0].x, borne.pins[0].y)
    main = np.hypot(*borne.bearings["main_bearing"])
    teeth = machine.reactions.get("tooth_force")
    rubbed = None
    if friction is not None:
        lost = losses(machine, friction, rings)
        rubbed = ComparedFriction(
            friction_per_piston=sum(lost.places.values()) / count,
            friction_places={place: power / count for place, power in lost.places.items()},
            mechanical_efficiency=lost.mechanical_efficiency,
            friction_mean_pressure=lost.friction_mean_pressure,
        )
    return ComparedMechanism(
        mechanism=name,
        pistons=count,
        side_force_max=max(float(np.abs(v).max()) for v in borne.guides.values()),
        crank_pin_max=float(pin.max()),
        crank_pin_mean=float(pin.mean()),
        main_bearing_max=float(main.max()),
        tooth_force_max=None if teeth is None else float(np.abs(teeth).max()),
        torque_max=float(machine.torque.max()),
        torque_mean=float(machine.torque.mean()),
        shaking_order_1=_amplitude(shake, 1),
        shaking_order_2=_amplitude(shake, 2),
        shaking_rms_after_counterweight=shake.counterweight.rms_after,
        power_residual=power_residual(machine, borne),
        friction=rubbed,
    )


def _amplitude(shake: Shaking, order: int) -> float:
    return max(abs(whole(shake.orders[n], order)) for n in ("force_x", "force_y"))


_PRYMAK, _NUNES, _MOROIANU = "003_8746f5f4ad51b1d1", "004_e00ef50339108dab", "001_a140ef4f7e005dde"
_ROD, _PLANET = crosshead.LABEL, hypocycloid.LABEL
_ALIKE = 1e-9  # of the largest value, by which rounding tells equal peaks apart
_SMALL = 0.1  # "much smaller" is read as below a tenth


def claims(rows: Sequence[ComparedMechanism]) -> list[dict[str, str]]:
    """Claims on friction and loads that the comparison can judge.

    Returns claims: keys source, claim, verdict (`supported claim` or `unsupported claim`), note; those on friction only
    where the case has coefficients.
    """
    by_name = {row.mechanism: row for row in rows}
    rod, planet = by_name[_ROD], by_name[_PLANET]
    links = [row for name, row in by_name.items() if name.startswith("rodless, four")]
    judged = [_side_force(rod, links), _pin_load(rod, links)]
    if rod.friction is not None:
        judged += [_less_friction(rod, links), _planet_friction(rod, planet)]
    return judged


def left_out(weight: Mapping[str, Pure], efficiency: Pure | None) -> dict[str, str]:
    """Whether a chain of forces may leave weights and friction out, as Moroianu (2017) does.

    weight: of `textbook.weight_shares`. efficiency: mechanical efficiency; None where the case has no coefficients.
    """
    worst = max(weight, key=lambda name: weight[name])
    friction = 0.0 if efficiency is None else 1 - efficiency
    note = f"weights change {worst} most, by {100 * weight[worst]:.2g} % of its peak"
    if efficiency is not None:
        note += f"; friction takes {100 * friction:.2g} % of the indicated power"
    claim = "weight and friction are much smaller than pressure and inertia forces"
    return _judged(_MOROIANU, claim, max(weight[worst], friction) < _SMALL, note)


def equal_loss_coefficient(rod: ComparedMechanism, other: ComparedMechanism, mu_guide: Pure) -> Pure | None:
    r"""Friction coefficient of the guides with which a mechanism loses as little as the slider crank.

    .. math:: \mu = \mu_\mathrm{guide}\,\frac{P_\mathrm{rod} - (P - P_\mathrm{guide})}{P_\mathrm{guide}}

    rod, other: rows of the comparison with friction: the slider crank, and a mechanism with guides. mu_guide:
    coefficient of all guides in the comparison. Returns mu: None where it loses more without any friction of its
    guides.
    """
    lost = _friction(other)
    guides = lost.friction_places["guides"]
    spare = _friction(rod).friction_per_piston - (lost.friction_per_piston - guides)
    return float(mu_guide * spare / guides) if guides > 0 and spare >= 0 else None


def _friction(row: ComparedMechanism) -> ComparedFriction:
    assert row.friction is not None  # asked of a comparison with coefficients
    return row.friction


def _judged(source: str, claim: str, supported: bool, note: str) -> dict[str, str]:
    verdict = "supported claim" if supported else "unsupported claim"
    return {"source": source, "claim": claim, "verdict": verdict, "note": note}


def _side_force(rod: ComparedMechanism, links: Sequence[ComparedMechanism]) -> dict[str, str]:
    ratios = [row.side_force_max / rod.side_force_max for row in links]
    note = f"the guides of the rods take it, {min(ratios):.2g} to {max(ratios):.2g} times that of a slider crank"
    return _judged(_PRYMAK, "no side force presses the piston of a rodless engine on its cylinder", True, note)


def _pin_load(rod: ComparedMechanism, links: Sequence[ComparedMechanism]) -> dict[str, str]:
    ratios = [row.crank_pin_mean / row.pistons / rod.crank_pin_mean for row in links]
    note = f"of the crank pin: mean load per piston {_range(ratios)} of the slider crank's, at twice the rubbing speed"
    return _judged(_PRYMAK, "a rodless engine loads its joints less for the same power", max(ratios) < 1, note)


def _less_friction(rod: ComparedMechanism, links: Sequence[ComparedMechanism]) -> dict[str, str]:
    ratios = [_friction(row).friction_per_piston / _friction(rod).friction_per_piston for row in links]
    equal = [equal_loss_coefficient(rod, row, 1.0) for row in links]
    note = f"with equal coefficients it loses {_range(ratios)} of what a slider crank loses, by closing rule; "
    if None in equal:
        note += "more even with guides free of friction"
    else:
        note += f"as little with guides at {_range([share for share in equal if share is not None])} of the coefficient"
    return _judged(_PRYMAK, "a rodless engine loses less by friction than one with rods", max(ratios) < 1, note)


def _planet_friction(rod: ComparedMechanism, planet: ComparedMechanism) -> dict[str, str]:
    ratio = _friction(planet).friction_per_piston / _friction(rod).friction_per_piston
    note = (
        f"its journal and teeth cost more than the side force saves: {100 * ratio:.3g} % of the slider crank's loss"
        if ratio >= 1
        else f"it loses {100 * ratio:.3g} % of what a slider crank loses"
    )
    return _judged(_NUNES, "a hypocycloid engine without side force loses less by friction", ratio < 1, note)


def _range(ratios: Sequence[float]) -> str:
    return f"{100 * min(ratios):.3g} to {100 * max(ratios):.3g} %"


_MOTION = ("x", "psi")
_UNITS = {"phi_deg": "deg", "p": "Pa", "torque": "N*m", "roll_moment": "N*m", "driving_torque": "N*m"}


def columns(turn: Turn, loads: Loads, chains: Mapping[str, Chain] | None = None) -> Columns:
    """The table of a turn: angle, gas, motion, loads, torque, SI units unless the name says otherwise.

    chains: chains of the sources by name.

    Returns columns: `phi_deg` first, then `p`, what acts, motion, pins, bearings, guides, reactions, `torque`, chains,
    and all other inputs and outputs of the declaration; each of shape (n,).
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
    named = under_own_name(turn.drive.roles)
    borne = {n: v for n, v in turn.reactions.items() if n.startswith(("R_", "M_")) and n not in named}
    table |= {name: values for name, values in with_resultants(borne).items() if name not in table}
    table["torque"] = turn.torque
    if (roll := roll_moment(turn)) is not None:
        table["roll_moment"] = roll
    for name, chain in (chains or {}).items():
        table |= {f"{name}_{f.name}": getattr(chain, f.name) for f in dataclasses.fields(chain)}
    idle = {name: np.zeros_like(turn.phi) for name in turn.drive.mechanism.inputs}
    table["driving_torque"] = turn.driving
    table |= {n: v for n, v in {**idle, **turn.kinematics}.items() if n not in table}
    listed = mechanisms.listing(turn.drive.name, turn.drive.mechanism)
    known = _UNITS | dict(listed["inputs"]) | {n: "N*m" for n in table if n.startswith("M_")}
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
    # cylinders that are alike have peaks that only rounding tells apart: the first of them
    return math.degrees(phi[int(np.argmax(values >= np.max(values) - _ALIKE * np.abs(values).max()))])


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
