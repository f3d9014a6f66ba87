"""Crank, rod, crosshead and elastic hinge: parameters and runtime mechanism (Zotov et al. 2024, section 2)."""

import dataclasses
import math
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from mechsym import mechanisms
from mechsym.errors import BadInput
from mechsym.mechanisms.chain import Alike, CrankChain, DriveSeen, Loads, Peer, SliderCrank, TurnSeen
from mechsym.mechanisms.drawn_parts import Circle, Line, box, cylinder, piston
from mechsym.mechanisms.proportions import Proportions, Reciprocating
from mechsym.mechanisms.proportions import slider_crank as crank_and_rod
from mechsym.mechanisms.record import Mechanism
from mechsym.mechanisms.slider_crank import rubbing, single
from mechsym.mechanisms.traits import Traits
from mechsym.quantities import quantity, record

LABEL = "slider crank"  # in a comparison


@record
class CrossheadParameters:
    """Geometry and masses; r = r1 + r2 is the crank radius, l = l1 + l2 the rod's length."""

    r1: float = quantity("m", low=0, about="shaft axis to the crank's centre of mass")
    r2: float = quantity("m", low=0, about="crank's centre of mass to crank pin")
    l1: float = quantity("m", low=0, about="crank pin to the rod's centre of mass")
    l2: float = quantity("m", low=0, about="rod's centre of mass to crosshead pin")
    m1: float = quantity("kg", low=0, about="mass of the crank")
    m2: float = quantity("kg", low=0, about="mass of the rod")
    m3: float = quantity("kg", low=0, about="mass of the crosshead")
    m4: float = quantity("kg", low=0, about="mass of the piston rod")
    m5: float = quantity("kg", low=0, about="mass of the piston")
    I01: float = quantity("kg*m^2", above=0, about="inertia of the crank about the shaft axis")
    IC2: float = quantity("kg*m^2", low=0, about="inertia of the rod about its centre of mass")
    g: float = quantity("m/s^2", default=9.81, low=0, about="acceleration of free fall")
    #: Angle of the cylinder axis against the horizontal, 0 lying, pi/2 upright [rad]
    axis_tilt: float = quantity("rad", default=0.0, about="cylinder axis against the horizontal")

    def __post_init__(self) -> None:
        r, l = self.r1 + self.r2, self.l1 + self.l2
        if r <= 0:
            raise BadInput(f"r1 + r2 = {r:g} m leaves no crank; it must be > 0 m")
        if l <= r:
            raise BadInput(f"rod too short: l1 + l2 = {l:g} m, needs more than r1 + r2 = {r:g} m; lengthen l1 or l2")


def build(parameters: CrossheadParameters) -> Mechanism:
    """The crosshead engine's mechanism.

    Returns
    -------
    mechanism : Mechanism
        Coordinate phi; inputs F, M_r, M_h
    """
    return mechanisms.build("crosshead", parameters)


def with_flywheel(parameters: CrossheadParameters, inertia: float) -> CrossheadParameters:
    """The same engine with a flywheel rigidly on the shaft.

    Parameters
    ----------
    inertia : float
        Inertia of the flywheel about the shaft [kg*m^2]
    """
    return dataclasses.replace(parameters, I01=parameters.I01 + inertia)


def _drawing(p: Any, angle: float, bore: float | None) -> Iterable[Line | Circle]:
    r, l = p.r1 + p.r2, p.l1 + p.l2
    pin = (r * math.cos(angle), r * math.sin(angle))
    end = (pin[0] + math.sqrt(l**2 - pin[1] ** 2), 0.0)
    length, stroke = 1.5 * 2 * r, 2 * r  # of the piston rod: drawn, not a parameter
    top = (end[0] + length, 0.0)
    yield Circle(role="crank", centre=(0.0, 0.0), radius=0.16 * r)
    yield Line(role="crank", points=((0.0, 0.0), pin))
    yield Line(role="rod", points=(pin, end))
    yield Line(role="frame", points=((l - r - 0.3 * r, -0.28 * r), (l + r + 0.3 * r, -0.28 * r)))
    yield Line(role="frame", points=((l - r - 0.3 * r, 0.28 * r), (l + r + 0.3 * r, 0.28 * r)))
    yield box("piston", (end[0] - 0.22 * r, -0.24 * r), (0.44 * r, 0.48 * r))
    yield Line(role="piston", points=(end, top))
    yield Circle(role="joint", centre=pin, radius=0.09 * r)
    yield Circle(role="joint", centre=end, radius=0.09 * r)
    yield from piston(top, stroke, bore)
    yield from cylinder(0.0, l - r + length, stroke, bore)


def _loads(turn: TurnSeen) -> Loads:
    p = turn.drive.mechanism.parameters
    weight = -p["g"] * p["m1"] * p["r1"] * np.cos(turn.phi + p["axis_tilt"])
    return single(turn, p["r1"] + p["r2"], weight)


def _mass(drive: DriveSeen) -> float:
    p = drive.mechanism.parameters
    return float(p["m3"] + p["m4"] + p["m5"])


def _letters(p: Mapping[str, float]) -> SliderCrank:
    return SliderCrank(R=p["r1"] + p["r2"], L=p["l1"] + p["l2"], L_m=p["l1"], m_b=p["m2"], I_b=p["IC2"],
                       m_p=p["m3"] + p["m4"] + p["m5"], u_c=p["m1"] * p["r1"])  # fmt: skip


def _proportions(p: CrossheadParameters) -> Proportions:
    moving = Reciprocating(letters="m3 + m4 + m5", mass=p.m3 + p.m4 + p.m5)
    rod = p.l1 + p.l2
    return crank_and_rod(
        p.r1 + p.r2, rod, (moving,), mass=p.m1 + p.m2 + moving.mass, shafts={"I01": p.I01},
        parts={"IC2": (p.IC2, p.m2 * rod**2)},
    )  # fmt: skip


def _peers(alike: Alike) -> tuple[Peer, ...]:
    """A slider crank without masses but the piston's."""
    l = alike.stroke / 2 / alike.lam
    nothing = {"r1": 0.0, "l1": l / 2, "l2": l / 2, "m1": 0.0, "m2": 0.0, "m3": 0.0, "m4": 0.0, "IC2": 0.0, "g": 0.0}
    # at constant speed the crank's inertia is without effect
    parameters = CrossheadParameters(**nothing, r2=alike.stroke / 2, m5=alike.mass, I01=1.0)
    return (Peer(label=LABEL, parameters=parameters),)


TRAITS = Traits(
    parameters=CrossheadParameters,
    drawing=_drawing,
    proportions=_proportions,
    rules="slider crank",
    chain=CrankChain(loads=_loads, rubbing=rubbing, mass=_mass, letters=_letters, peers=_peers, hinged=True),
)
