r"""The force that a mechanism overconstrained by one leaves open, by a rule that says how the parts give way.

The rigid mechanism determines its reactions but for one force S along the crank, in balance with the guides:
X_i = X_i^0 + s_i S. The declaration says X_i^0 and s_i (`m.closing`); the rule chooses S.

With X_a = -S sin(alpha), X_b = -S cos(alpha) play and elasticity close it: a part that carries X gives way by X/k and
by its play towards the side that it lies on,

.. math:: u(X) = X/k + g\,\mathrm{sgn} X, \qquad u_c(S) - u_a(X_a)\sin\alpha - u_b(X_b)\cos\alpha = e

where e is how much the crank is longer than half the link. At X = 0 the part floats anywhere within its play. The left
side only grows with S, so there is one S, the least point of a convex function, and it is a median.

Which working faces drive a rodless engine: any number, single or double acting, two-stroke or four-stroke. Each face of
a piston that closes a chamber counts. Side "a+" is the face whose chamber the outward travel of slider a compresses
(dead centre at alpha = 0); "b+" has its dead centre at pi/2, "a-" at pi, "b-" at 3 pi/2. An opposite piston on the same
rod and the inner face of a double-acting piston both have a "-" side.
"""

import dataclasses
import math

import casadi as ca

from mechsym.errors import BadInput
from mechsym.mechanisms.amounts import amount
from mechsym.mechanisms.record import Mechanism
from mechsym.mechanisms.roles import ClosingRole
from mechsym.quantities import check, quantity, record
from mechsym.quantities.units import Newton, Pure, Scalar

_FLAT = 1e-9  # sine or cosine below which a guide has no part in the redundant force


@record
class CrankFreeRadially:
    """Closing rule: the crank gives way along its radius and carries no radial pin force."""


@record
class _Springs:
    """Springs between the parts that close the motion twice."""

    k_a: float = quantity("N/m", above=0, about="stiffness of the guide of slider a")
    k_b: float = quantity("N/m", above=0, about="stiffness of the guide of slider b")
    k_c: float = quantity("N/m", above=0, about="stiffness of crank and pin along the radius")


@record
class Stiffnesses(_Springs):
    """Closing rule: guides and crank pin are springs, stiff against the motion, whose strain energy is least."""


@record
class Clearances(_Springs):
    """Closing rule: guides and crank pin are springs with play, the crank may be cut wrong."""

    gap_a: float = quantity("m", default=0.0, low=0, about="play of slider a to each side of its guide")
    gap_b: float = quantity("m", default=0.0, low=0, about="play of slider b to each side of its guide")
    gap_c: float = quantity("m", default=0.0, low=0, about="radial play of the crank pin")
    radius_error: float = quantity("m", default=0.0, about="crank longer than half the link by")


ClosingRule = CrankFreeRadially | Stiffnesses | Clearances


def closed(mechanism: Mechanism, role: ClosingRole, rule: ClosingRule) -> Mechanism:
    """The mechanism with all reactions, by a closing rule.

    Returns mechanism: reactions also the open force, those of the guides, and what the declaration makes of them [N].
    """
    reactions, kinematics = mechanism.functions["reactions"], mechanism.functions["kinematics"]
    letters = {n: ca.SX.sym(n) for n in reactions.name_in()}
    forces = reactions(**letters)
    known = {**mechanism.parameters, **kinematics(**{n: letters[n] for n in kinematics.name_in()}), **letters, **forces}
    free, shares = ([amount(getattr(g, what), known) for g in role.guides] for what in ("free", "share"))
    force = _open_force(rule, free, shares)
    pushes = {g.name: at + share * force for g, at, share in zip(role.guides, free, shares, strict=True)}
    pushes[role.name] = force
    for name, text in role.gives.items():
        pushes[name] = amount(text, known | pushes)
    everything = forces | pushes
    function = ca.Function(
        "reactions", list(letters.values()), list(everything.values()), list(letters), list(everything)
    )
    return dataclasses.replace(mechanism, functions={**mechanism.functions, "reactions": function})


def _open_force(rule: ClosingRule, free: list[ca.SX], shares: list[ca.SX]) -> ca.SX:
    if isinstance(rule, CrankFreeRadially):
        return ca.SX(0)
    (X_a, X_b), (s, c) = free, (-share for share in shares)
    if isinstance(rule, Clearances):
        return redundant_force(rule, X_a, X_b, s, c)
    # least X_a^2 / k_a + X_b^2 / k_b + S^2 / k_c over S
    return (X_a * s / rule.k_a + X_b * c / rule.k_b) / (1 / rule.k_c + s**2 / rule.k_a + c**2 / rule.k_b)


def redundant_force(
    rule: Clearances, X_a: Newton[Scalar], X_b: Newton[Scalar], s: Pure[Scalar], c: Pure[Scalar]
) -> Newton[Scalar]:
    r"""Radial pin force of a mechanism with play.

    .. math:: m S + \sum_i G_i\,\mathrm{sgn}(S - b_i) = e + \frac{X_a^0 s}{k_a} + \frac{X_b^0 c}{k_b}, \qquad
              m = \frac1{k_c} + \frac{s^2}{k_a} + \frac{c^2}{k_b}

    with G = g_c, g_a|s|, g_b|c| and b = 0, X_a^0/s, X_b^0/c; S is the median of the b in ascending order and of the
    four S that the equation gives with the first 0, 1, 2, 3 signs positive. X_a, X_b: guide reactions at S = 0; s, c:
    sine and cosine of alpha. Returns S: along the crank, positive away from the shaft.
    Source: principle of virtual forces with the one self-balanced state of the mechanism. Valid: contacts without
    friction or impact, deflections small against the crank radius, the play taken up at each instant.

    >>> rule = Clearances(k_a=1e8, k_b=1e8, k_c=1e8, radius_error=1e-5)
    >>> round(float(redundant_force(rule, 0.0, 0.0, 0.6, 0.8)), 6)
    500.0
    """
    stiffness = 1 / rule.k_c + s**2 / rule.k_a + c**2 / rule.k_b
    right = rule.radius_error + X_a * s / rule.k_a + X_b * c / rule.k_b
    points = [(0.0, rule.gap_c), _point(X_a, s, rule.gap_a), _point(X_b, c, rule.gap_b)]
    pairs = list(points)
    for i, j in ((0, 1), (1, 2), (0, 1)):
        (b_i, G_i), (b_j, G_j) = pairs[i], pairs[j]
        swap = b_i > b_j
        pairs[i] = (ca.fmin(b_i, b_j), ca.if_else(swap, G_j, G_i))
        pairs[j] = (ca.fmax(b_i, b_j), ca.if_else(swap, G_i, G_j))
    b, G = ([b for b, _ in pairs], [G for _, G in pairs])
    candidates = [(right + sum(G[k:]) - sum(G[:k])) / stiffness for k in range(4)]
    return _median([*b, *candidates])


def _point(X: Scalar, sine: ca.SX, gap: float) -> tuple[Scalar, Scalar]:
    flat = ca.fabs(sine) < _FLAT
    return ca.if_else(flat, 0.0, X / ca.if_else(flat, 1.0, sine)), gap * ca.fabs(sine)


def _median(values: list[ca.SX]) -> ca.SX:
    ordered = list(values)
    for end in range(len(ordered) - 1, 0, -1):
        for i in range(end):
            ordered[i], ordered[i + 1] = ca.fmin(ordered[i], ordered[i + 1]), ca.fmax(ordered[i], ordered[i + 1])
    return ordered[len(ordered) // 2]


DEAD_CENTRES = {"a+": 0.0, "b+": math.pi / 2, "a-": math.pi, "b-": 3 * math.pi / 2}


@record
class RodlessFaces:
    """Section `[faces]`: the working faces of one link."""

    sides: tuple[str, ...]  #: Side of each face, of a+, a-, b+, b-
    #: Area of each working face; less by the rod's where a rod passes through [m^2]
    areas: tuple[float, ...] = quantity("m^2", above=0, about="area of each working face")
    #: Crank angle at which the chamber of each face fires, a dead centre of its side, within one cycle [rad]
    firing: tuple[float, ...] = quantity("rad", about="crank angle at which each face's chamber fires")

    def __post_init__(self) -> None:
        lengths = {name: len(getattr(self, name)) for name in ("sides", "areas", "firing")}
        if len(set(lengths.values())) != 1 or not self.sides:
            raise BadInput(f"sides, areas and firing need one value a face; found {lengths}")
        check(self)
        for side, fires in zip(self.sides, self.firing, strict=True):
            if side not in DEAD_CENTRES:
                raise BadInput(f"side {side!r} is not an option; options are {', '.join(DEAD_CENTRES)}")
            late = math.remainder(fires - DEAD_CENTRES[side], 2 * math.pi)
            if abs(late) > 1e-9:
                centre = math.degrees(DEAD_CENTRES[side])
                raise BadInput(
                    f"firing = {math.degrees(fires):g} deg is no dead centre of side {side}; "
                    f"give {centre:g} deg or {centre + 360:g} deg"
                )


def four_faces(area: float, period: float) -> RodlessFaces:
    """Two faces on each axis that fire as evenly as they can; area [m^2], period of the cycle [rad]."""
    # a four-stroke star of four dead centres a quarter turn apart: gaps 270, 180, 90, 180
    late = {"a+": 0, "b-": 270, "b+": 450, "a-": 540} if period > 7 else {"a+": 0, "b+": 90, "a-": 180, "b-": 270}
    firing = tuple(math.radians(d) for d in late.values())
    return RodlessFaces(sides=tuple(late), areas=(area,) * 4, firing=firing)
