"""Rodless (Balandin) mechanism: parameters, runtime mechanism, closing rules. Drawing: derivations/rodless.py.

The rigid plane mechanism is overconstrained by one (`mechsym.constraints.solve` of `rodless_constraints`: rank 3 of
4). `build` gives what it determines; the guide reactions X_a, X_b and the pin force come only from `closed` with a
closing rule by name, which says how the parts give way.
"""

import dataclasses
import math
from collections.abc import Iterable
from typing import Any

import casadi as ca
import numpy as np

from mechsym import mechanisms
from mechsym.errors import BadInput
from mechsym.mechanisms import constraints
from mechsym.mechanisms.chain import (
    Alike,
    CrankChain,
    DriveSeen,
    GasFace,
    Loads,
    Peer,
    Pin,
    Pressures,
    Rubbing,
    TurnSeen,
)
from mechsym.mechanisms.drawn_parts import Circle, Line, cylinder, piston, turned
from mechsym.mechanisms.hypocycloid import HypocycloidParameters
from mechsym.mechanisms.proportions import Proportions, Reciprocating
from mechsym.mechanisms.record import Mechanism
from mechsym.mechanisms.rodless_clearance import Clearances, redundant_force
from mechsym.mechanisms.rodless_faces import RodlessFaces, axis_forces, four_faces
from mechsym.mechanisms.traits import Traits
from mechsym.quantities import quantity, record

Symbols = dict[str, ca.SX]


@record
class RodlessParameters:
    """Crank, link A-C-B, two sliders at right angles."""

    #: Crank radius; the sliders move with amplitude 2 r, stroke 4 r [m]
    r: float = quantity("m", above=0, about="crank radius")
    I1: float = quantity("kg*m^2", above=0, about="inertia of the crank about the shaft axis")
    #: Unbalance of the crank on the crank pin's side, negative for a counterweight [kg*m]
    u1: float = quantity("kg*m", default=0.0, about="unbalance of the crank on the pin's side")
    m_link: float = quantity("kg", low=0, about="mass of the link")
    I_link: float = quantity("kg*m^2", low=0, about="inertia of the link about its middle")
    m_a: float = quantity("kg", low=0, about="reciprocating mass on axis a")
    m_b: float = quantity("kg", low=0, about="reciprocating mass on axis b")


@record
class CrankFreeRadially:
    """Closing rule: the crank gives way along its radius and carries no radial pin force."""


@record
class Stiffnesses:
    """Closing rule: guides and crank pin are springs, stiff against the motion, whose strain energy is least."""

    k_a: float = quantity("N/m", above=0, about="stiffness of the guide of slider a")
    k_b: float = quantity("N/m", above=0, about="stiffness of the guide of slider b")
    k_c: float = quantity("N/m", above=0, about="stiffness of crank and pin along the radius")


ClosingRule = CrankFreeRadially | Stiffnesses | Clearances


def build(parameters: RodlessParameters) -> Mechanism:
    """The rodless mechanism with the reactions that the rigid mechanism determines.

    Returns
    -------
    mechanism : Mechanism
        Coordinate alpha; inputs F_a, F_b, M
    """
    return mechanisms.build("rodless", parameters)


def closed(mechanism: Mechanism, rule: ClosingRule) -> Mechanism:
    r"""The mechanism with all reactions, by a closing rule.

    With the radial pin force S the reactions are :math:`X_a = X_a^0 - S \sin\alpha`,
    :math:`X_b = X_b^0 - S \cos\alpha`; the rule chooses S.

    Returns
    -------
    mechanism : Mechanism
        Reactions also X_a (along y on slider a), X_b (along x on slider b), pin_force, its radial part and its
        components on the link, journal forces on the sliders, main-bearing force on the crank [N]
    """
    reactions, kinematics = mechanism.functions["reactions"], mechanism.functions["kinematics"]
    letters = {n: ca.SX.sym(n) for n in reactions.name_in()}
    found = reactions(**letters)
    alpha = letters[mechanism.coordinates[0]]
    s, c, tangential = ca.sin(alpha), ca.cos(alpha), found["pin_force_tangential"]
    X_a, X_b = found["pin_and_guide_y"] - tangential * c, found["pin_and_guide_x"] + tangential * s
    radial = _radial_force(rule, X_a, X_b, s, c)
    X_a, X_b = X_a - radial * s, X_b - radial * c
    pin_x, pin_y = radial * c - tangential * s, radial * s + tangential * c
    kinematic = kinematics(**{n: letters[n] for n in kinematics.name_in()})
    found |= {"X_a": X_a, "X_b": X_b, "pin_force": ca.hypot(pin_x, pin_y), "pin_force_radial": radial}
    found |= {"pin_force_x": pin_x, "pin_force_y": pin_y}
    found |= _journals(mechanism, letters, kinematic, (X_a, X_b))
    found |= _main_bearing(mechanism, letters, kinematic, (pin_x, pin_y))
    closed_reactions = ca.Function(
        "reactions", list(letters.values()), list(found.values()), list(letters), list(found)
    )
    return dataclasses.replace(mechanism, functions={**mechanism.functions, "reactions": closed_reactions})


def _radial_force(rule: ClosingRule, X_a: ca.SX, X_b: ca.SX, s: ca.SX, c: ca.SX) -> ca.SX:
    if isinstance(rule, CrankFreeRadially):
        return ca.SX(0)
    if isinstance(rule, Clearances):
        return redundant_force(rule, X_a, X_b, s, c)
    # least X_a^2 / k_a + X_b^2 / k_b + S^2 / k_c over S
    return (X_a * s / rule.k_a + X_b * c / rule.k_b) / (1 / rule.k_c + s**2 / rule.k_a + c**2 / rule.k_b)


def _journals(
    mechanism: Mechanism, letters: Symbols, kinematic: Symbols, guides: tuple[ca.SX, ca.SX]
) -> dict[str, ca.SX]:
    found: dict[str, ca.SX] = {}
    rate, acceleration = letters["alphad"], letters["alphadd"]
    for axis, guide in zip("ab", guides, strict=True):
        x = f"x_{axis}"
        travel = kinematic[f"d{x}_dalpha"] * acceleration + kinematic[f"d2{x}_dalpha2"] * rate**2
        along = mechanism.parameters[f"m_{axis}"] * travel - letters[f"F_{axis}"]
        found |= {f"journal_force_{axis}_along": along, f"journal_force_{axis}_across": -guide}
    return found


def _main_bearing(
    mechanism: Mechanism, letters: Symbols, kinematic: Symbols, pin: tuple[ca.SX, ca.SX]
) -> dict[str, ca.SX]:
    # the crank pin moves half as far as the sliders
    rate, acceleration = letters["alphad"], letters["alphadd"]
    half = mechanism.parameters["u1"] / mechanism.parameters["r"] / 2
    inertia = [
        half * (kinematic[f"d{x}_dalpha"] * acceleration + kinematic[f"d2{x}_dalpha2"] * rate**2)
        for x in ("x_a", "x_b")
    ]
    return {f"main_bearing_force_{axis}": p + i for axis, p, i in zip("xy", pin, inertia, strict=True)}


def drawing(p: Any, angle: float, bore: float | None) -> Iterable[Line | Circle]:
    """Shapes at a crank angle [rad]; a bore [m], or None for one in proportion."""
    r, c, s = p.r, math.cos(angle), math.sin(angle)
    middle, a, b = (r * c, r * s), (2 * r * c, 0.0), (0.0, 2 * r * s)
    reach = 6 * r  # of the sliders' rods: drawn, not a parameter
    for sign in (-1, 1):
        for along, at in ((0.0 if sign > 0 else math.pi, a[0]), (sign * math.pi / 2, b[1])):
            yield from turned(cylinder(0.0, reach - 2 * r, 4 * r, bore), along)
            yield from turned(piston((reach + sign * at, 0.0), 4 * r, bore), along)
    yield Line(role="rod", points=((a[0] - reach, 0.0), (a[0] + reach, 0.0)))
    yield Line(role="rod", points=((0.0, b[1] - reach), (0.0, b[1] + reach)))
    yield Line(role="planet", points=(a, b))
    yield Line(role="crank", points=((0.0, 0.0), middle))
    yield Circle(role="crank", centre=(0.0, 0.0), radius=0.14 * r)
    for point in (middle, a, b):
        yield Circle(role="joint", centre=point, radius=0.1 * r)


def _rigid(parameters: RodlessParameters, closing: ClosingRule | None) -> Mechanism:
    if closing is None:
        raise BadInput("a rodless engine is overconstrained: give the closing rule")
    return closed(build(parameters), closing)


def _faces_of(drive: DriveSeen) -> RodlessFaces:
    if drive.faces is None:
        raise BadInput("gas acts on the faces of a rodless engine; give them")
    return drive.faces


def _pushes(drive: DriveSeen, net: Pressures, area: float, phi: np.ndarray, period: float) -> dict[str, np.ndarray]:
    return dict(zip(("F_a", "F_b"), axis_forces(_faces_of(drive), net, phi), strict=True))


def _faces(turn: TurnSeen) -> list[tuple[np.ndarray, np.ndarray]]:
    faces = _faces_of(turn.drive)
    rows = zip(faces.sides, faces.firing, strict=True)
    return [(turn.phi - fires, turn.kinematics[f"dx_{side[0]}_dalpha"] * turn.omega) for side, fires in rows]


def _cylinders(parameters: RodlessParameters, faces: RodlessFaces) -> tuple[GasFace, ...]:
    """One cylinder a face; gas over a slider's outer face pushes against its outward travel."""
    return tuple(
        GasFace(input=f"F_{side[0]}", fires=fires, area=area, sense=-1.0 if side[1] == "+" else 1.0)
        for side, area, fires in zip(faces.sides, faces.areas, faces.firing, strict=True)
    )


def _mass(drive: DriveSeen) -> float:
    on_a = sum(side[0] == "a" for side in _faces_of(drive).sides)
    return float(drive.mechanism.parameters["m_a"]) / max(on_a, 1)


def _inertia(turn: TurnSeen) -> float:
    stroke = np.ptp(turn.kinematics["x_a"])
    return float(turn.drive.mechanism.parameters["m_a"] * stroke / 2 * turn.omega**2)


def _loads(turn: TurnSeen) -> Loads:
    R, r = turn.reactions, turn.drive.mechanism.parameters["r"]
    pin = Pin(name="crank_pin", angle=turn.phi, radius=r, sense=1.0, x=-R["pin_force_x"], y=-R["pin_force_y"])
    return Loads(
        pins=(pin,), bearings={"main_bearing": (R["main_bearing_force_x"], R["main_bearing_force_y"])},
        guides={"side_force_a": R["X_a"], "side_force_b": R["X_b"]}, weight_torque=np.zeros_like(turn.phi),
    )  # fmt: skip


def _rubbing(turn: TurnSeen, found: Loads) -> tuple[Rubbing, ...]:
    R, pin, once = turn.reactions, found.pins[0], np.zeros_like(turn.phi) + turn.omega
    rows = []
    # the link turns at -omega: against the sliders at omega, on the crank pin at 2 omega
    for axis in "ab":
        speed = turn.kinematics[f"dx_{axis}_dalpha"] * turn.omega
        journal = np.hypot(R[f"journal_force_{axis}_along"], R[f"journal_force_{axis}_across"])
        rows += [
            Rubbing(place="guides", force=found.guides[f"side_force_{axis}"], speed=speed),
            Rubbing(place="piston_pins", force=journal, speed=once),
        ]
    return (*rows, Rubbing(place="crank_pins", force=np.hypot(pin.x, pin.y), speed=2 * once))


def _advice(turn: TurnSeen, name: str, order: int) -> str:
    p: RodlessParameters = turn.drive.parameters
    if p.m_a != p.m_b:
        return (
            f"m_a = {p.m_a:g} kg and m_b = {p.m_b:g} kg: a force (m_a - m_b) r omega^2 turns against the crank, and no "
            "counterweight on it takes that; make the two axes equally heavy"
        )
    return (
        f"the resultant turns with the crank: a counterweight of u1 = {-(2 * p.m_a + p.m_link) * p.r:.4g} kg m on the "
        f"crank takes all of it, the case has {p.u1:.4g} kg m"
    )


def _peers(alike: Alike) -> tuple[Peer, ...]:
    """One piston, and four on both axes, each under two closing rules; links and crank without mass."""
    one = RodlessParameters(r=alike.stroke / 4, I1=1.0, m_link=0, I_link=0, m_a=alike.mass, m_b=0)
    four = dataclasses.replace(one, m_a=2 * alike.mass, m_b=2 * alike.mass)
    single = RodlessFaces(sides=("a+",), areas=(alike.area,), firing=(0.0,))
    equal = Stiffnesses(k_a=1.0, k_b=1.0, k_c=1.0)  # only their ratios matter
    rules = {"crank free radially": CrankFreeRadially(), "equal stiffnesses": equal}
    rows = {"one piston": (one, single), "four pistons": (four, four_faces(alike.area, alike.period))}
    return tuple(
        Peer(label=f"rodless, {count}, {name}", parameters=parameters, faces=faces, closing=rule)
        for name, rule in rules.items()
        for count, (parameters, faces) in rows.items()
    )


def _told(turn: TurnSeen) -> dict[str, Any]:
    p: RodlessParameters = turn.drive.parameters
    rigid = mechanisms.build("rodless_constraints", p)
    solution = constraints.solve(rigid, constraints.close(rigid, {"alpha": 0.6, "alphad": turn.omega}))
    # of link, sliders and pistons; the crank's own unbalance is there to balance it
    rate = turn.momentum["momentum_rate_x"] + 1j * turn.momentum["momentum_rate_y"]
    in_crank = -rate * np.exp(-1j * turn.phi) - p.u1 * turn.omega**2
    size, wandering = np.abs(in_crank), np.abs(np.angle(in_crank)).max()
    return {
        "constraint_rank": solution.rank,
        "constraint_count": solution.count,
        "closing_rule": type(turn.drive.closing).__name__,
        "inertia_resultant_max": float(size.max()),
        "inertia_resultant_min": float(size.min()),
        "resultant_off_crank_deg": math.degrees(float(wandering)),
    }


def _alone(p: RodlessParameters) -> tuple[str, HypocycloidParameters]:
    """A slider moves as the piston of a hypocycloid with e = r."""
    return "hypocycloid", HypocycloidParameters(e=p.r, I1=p.I1, m2=0, I2=0, m3=p.m_a, alpha_n=0)


TRAITS = Traits(
    parameters=RodlessParameters,
    drawing=drawing,
    proportions=lambda p: Proportions(stroke=4 * p.r, moving=tuple(
        Reciprocating(letters=f"m_{axis}", mass=mass, axis=axis) for axis, mass in (("a", p.m_a), ("b", p.m_b))),
        mass=p.m_link + p.m_a + p.m_b, shafts={"I1": p.I1}, parts={"I_link": (p.I_link, 4 * p.m_link * p.r**2)},
        unbalances={"u1": p.u1}),
    chain=CrankChain(
        loads=_loads, rubbing=_rubbing, mass=_mass, rigid=_rigid, overconstrained=True, pushes=_pushes, faces=_faces,
        cylinders=_cylinders, areas=lambda drive: _faces_of(drive).areas, inertia=_inertia, advice=_advice,
        fires=lambda drive: _faces_of(drive).firing, peers=_peers, told=_told,
    ),
    alone=_alone,
)  # fmt: skip
