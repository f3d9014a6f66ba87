"""Rodless (Balandin) mechanism: parameters, runtime mechanism, closing rules. Drawing: derivations/rodless.py.

The rigid plane mechanism is overconstrained by one (`mechsym.constraints.solve` of `rodless_constraints`: rank 3 of
4). `build` gives what it determines; the guide reactions X_a, X_b and the pin force come only from `closed` with a
closing rule by name, which says how the parts give way.
"""

import dataclasses

import casadi as ca

from mechsym import mechanisms
from mechsym.mechanisms.record import Mechanism
from mechsym.mechanisms.rodless_clearance import Clearances, redundant_force
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
