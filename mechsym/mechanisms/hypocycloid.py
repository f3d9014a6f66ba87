"""Geared hypocycloid: parameters and runtime mechanism (Nunes 2017). Drawing and letters: derivations/hypocycloid.py.

The planar mechanism is overconstrained by one; the reactions hold under the assumption of no side force on the piston
(its rod is not guided).
"""

import math
from collections.abc import Iterable
from typing import Any

import numpy as np

from mechsym import mechanisms
from mechsym.mechanisms.chain import Alike, CrankChain, Loads, Peer, Pin, Rubbing, TurnSeen
from mechsym.mechanisms.drawn_parts import Circle, Line, cylinder, piston
from mechsym.mechanisms.proportions import Proportions, Reciprocating
from mechsym.mechanisms.record import Mechanism
from mechsym.mechanisms.traits import Traits
from mechsym.quantities import quantity, record

LABEL = "hypocycloid"  # in a comparison


@record
class HypocycloidParameters:
    """Crank, planet of half the ring's radius, reciprocating mass."""

    #: Crank throw, the planet's pitch radius; the stroke is 4 e [m]
    e: float = quantity("m", above=0, about="crank throw, pitch radius of the planet")
    I1: float = quantity("kg*m^2", above=0, about="inertia of crank and shaft about the axis")
    #: Unbalance of crank and shaft on the throw's side, negative for a counterweight [kg*m]
    u1: float = quantity("kg*m", default=0.0, about="unbalance of crank and shaft on the throw's side")
    m2: float = quantity("kg", low=0, about="mass at the planet's centre")
    I2: float = quantity("kg*m^2", low=0, about="inertia of the planet about its centre")
    m3: float = quantity("kg", low=0, about="reciprocating mass")
    alpha_n: float = quantity("rad", low=0, below=math.pi / 2, about="pressure angle of the gears")


def build(parameters: HypocycloidParameters) -> Mechanism:
    """The hypocycloid mechanism, with no side force on the piston."""
    return mechanisms.build("hypocycloid", parameters)


def _drawing(p: Any, angle: float, bore: float | None) -> Iterable[Line | Circle]:
    e, c, s = p.e, math.cos(angle), math.sin(angle)
    centre, pin, length = (e * c, e * s), (2 * e * c, 0.0), 5 * e
    yield Circle(role="frame", centre=(0.0, 0.0), radius=2 * e)
    yield Circle(role="planet", centre=centre, radius=e)
    yield Line(role="crank", points=((0.0, 0.0), centre))
    yield Circle(role="crank", centre=(0.0, 0.0), radius=0.14 * e)
    yield Line(role="planet", points=(centre, pin))
    yield Line(role="rod", points=(pin, (pin[0] + length, 0.0)))
    yield Circle(role="joint", centre=centre, radius=0.1 * e)
    yield Circle(role="joint", centre=pin, radius=0.1 * e)
    yield from piston((pin[0] + length, 0.0), 4 * e, bore)
    yield from cylinder(0.0, length - 2 * e, 4 * e, bore)


def _loads(turn: TurnSeen) -> Loads:
    R, none, e = turn.reactions, np.zeros_like(turn.phi), turn.drive.mechanism.parameters["e"]
    pin = Pin(name="crank_pin", angle=turn.phi, radius=e, sense=1.0, x=-R["journal_force_x"], y=-R["journal_force_y"])
    return Loads(
        pins=(pin,), bearings={"main_bearing": (R["main_bearing_force_x"], R["main_bearing_force_y"])},
        guides={"side_force": none}, weight_torque=none,
    )  # fmt: skip


def _rubbing(turn: TurnSeen, found: Loads) -> tuple[Rubbing, ...]:
    R, pin, none = turn.reactions, found.pins[0], np.zeros_like(turn.phi)
    once = none + turn.omega
    # the planet turns at -omega: against the rod at omega, in the crank at 2 omega, against the ring at omega
    return (
        Rubbing(place="guides", force=none, speed=none),
        Rubbing(place="piston_pins", force=np.abs(R["pin_force"]), speed=once),
        Rubbing(place="crank_pins", force=np.hypot(pin.x, pin.y), speed=2 * once),
        Rubbing(place="teeth", force=R["tooth_force"], speed=once),
    )


def _peers(alike: Alike) -> tuple[Peer, ...]:
    """A planet without mass; at constant speed the crank's inertia is without effect."""
    parameters = HypocycloidParameters(e=alike.stroke / 4, I1=1.0, m2=0, I2=0, m3=alike.mass, alpha_n=alike.alpha_n)
    return (Peer(label=LABEL, parameters=parameters),)


TRAITS = Traits(
    parameters=HypocycloidParameters,
    drawing=_drawing,
    proportions=lambda p: Proportions(
        stroke=4 * p.e,
        moving=(Reciprocating(letters="m3", mass=p.m3),),
        mass=p.m2 + p.m3,
        shafts={"I1": p.I1},
        parts={"I2": (p.I2, p.m2 * p.e**2)},
        unbalances={"u1": p.u1},
    ),
    rules="planet",
    chain=CrankChain(
        loads=_loads, rubbing=_rubbing, peers=_peers, mass=lambda drive: float(drive.mechanism.parameters["m3"])
    ),
)
