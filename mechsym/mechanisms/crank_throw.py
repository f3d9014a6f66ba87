"""One throw of a crank train: parameters and runtime mechanism. Drawing and letters: derivations/crank_throw.py."""

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from mechsym import mechanisms
from mechsym.errors import BadInput
from mechsym.mechanisms.chain import CrankChain, Loads, SliderCrank, TurnSeen
from mechsym.mechanisms.drawn_parts import Circle, Line, slider_crank
from mechsym.mechanisms.proportions import Reciprocating
from mechsym.mechanisms.proportions import slider_crank as crank_and_rod
from mechsym.mechanisms.record import Mechanism
from mechsym.mechanisms.slider_crank import rubbing, single
from mechsym.mechanisms.traits import Traits
from mechsym.quantities import quantity, record


@record
class CrankThrowParameters:
    """Crank, rod with its own inertia, piston on an offset axis."""

    r: float = quantity("m", above=0, about="crank radius")
    l1: float = quantity("m", low=0, about="crank pin to the rod's centre of mass")
    l2: float = quantity("m", low=0, about="rod's centre of mass to piston pin")
    #: Distance of the piston pin's path from the shaft axis, on the side of phi = 90 deg [m]
    offset: float = quantity("m", default=0.0, about="offset of the cylinder axis")
    m0: float = quantity("kg", default=0.0, low=0, about="mass of the crank")
    m_rod: float = quantity("kg", low=0, about="mass of the rod")
    m_piston: float = quantity("kg", low=0, about="mass of the piston")
    I0: float = quantity("kg*m^2", above=0, about="inertia of the crank about the shaft axis")
    I_rod: float = quantity("kg*m^2", low=0, about="inertia of the rod about its centre of mass")
    #: Unbalance of the crank on the pin's side, negative for a counterweight [kg*m]
    u0: float = quantity("kg*m", default=0.0, about="unbalance of the crank on the pin's side")
    g: float = quantity("m/s^2", default=0.0, low=0, about="acceleration of free fall")
    #: Angle of the cylinder axis against the horizontal [rad]
    axis_tilt: float = quantity("rad", default=0.0, about="cylinder axis against the horizontal")

    def __post_init__(self) -> None:
        refuse_short_rod(self.l1 + self.l2, self.r, self.offset)


def refuse_short_rod(l: float, r: float, offset: float) -> None:
    """Refuse a rod that cannot pass through its extreme angle.

    Parameters
    ----------
    l : float
        Length of the rod [m]
    r : float
        Crank radius [m]
    offset : float
        Offset of the cylinder axis [m]
    """
    if l <= r + abs(offset):
        raise BadInput(
            f"rod too short: l1 + l2 = {l:g} m, needs more than r + |offset| = {r + abs(offset):g} m; lengthen l1 or l2"
        )


def build(parameters: CrankThrowParameters) -> Mechanism:
    """A single throw on its own shaft.

    Returns
    -------
    mechanism : Mechanism
        Coordinate phi; inputs F, M (torque of the shaft on the throw)
    """
    return mechanisms.build("crank_throw", parameters)


def _drawing(p: Any, angle: float, bore: float | None) -> Iterable[Line | Circle]:
    return slider_crank(p.r, p.l1 + p.l2, p.offset, angle, bore)


def _loads(turn: TurnSeen) -> Loads:
    p = turn.drive.mechanism.parameters
    return single(turn, p["r"], -p["g"] * p["u0"] * np.cos(turn.phi + p["axis_tilt"]))


def _letters(p: Mapping[str, float]) -> SliderCrank:
    return SliderCrank(R=p["r"], L=p["l1"] + p["l2"], L_m=p["l1"], m_b=p["m_rod"], I_b=p["I_rod"],
                       m_p=p["m_piston"], u_c=p["u0"])  # fmt: skip


def _alone(parameters: CrankThrowParameters) -> tuple[str, CrankThrowParameters]:
    """The throw itself, where its dead centres stand half a turn apart."""
    if parameters.offset != 0:
        raise BadInput(
            f"offset = {parameters.offset:g} m: the cycles know dead centres half a turn apart; "
            "set offset = 0 or leave [cycle] out"
        )
    return "crank_throw", parameters


TRAITS = Traits(
    parameters=CrankThrowParameters,
    drawing=_drawing,
    proportions=lambda p: crank_and_rod(
        p.r,
        p.l1 + p.l2,
        (Reciprocating(letters="m_piston", mass=p.m_piston),),
        mass=p.m0 + p.m_rod + p.m_piston,
        shafts={"I0": p.I0},
        parts={"I_rod": (p.I_rod, p.m_rod * (p.l1 + p.l2) ** 2)},
        unbalances={"u0": p.u0},
    ),
    chain=CrankChain(
        loads=_loads, rubbing=rubbing, letters=_letters, mass=lambda drive: drive.mechanism.parameters["m_piston"]
    ),
    alone=_alone,
)
