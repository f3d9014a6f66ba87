"""What bodies, forces, springs and dampers are to the derivation."""

from dataclasses import dataclass

from sympy import Expr


@dataclass(frozen=True, kw_only=True)
class Body:
    """A rigid body: mass at a point, and an inertia that turns.

    Parameters
    ----------
    name : str
        Name of the body
    mass, inertia : Expr
        Mass, and inertia about the centre of mass or, with `about_axis`, about the fixed axis
    at : tuple of Expr
        Centre of mass, (x, y)
    turns : Expr
        Angle, positive from x to y
    about_axis : bool
        Whether the inertia is about a fixed axis that the centre of mass turns round
    """

    name: str
    mass: Expr
    at: tuple[Expr, Expr]
    turns: Expr
    inertia: Expr
    about_axis: bool


@dataclass(frozen=True, kw_only=True)
class Element:
    """A force, spring or damper that acts along a displacement.

    Parameters
    ----------
    value : Expr
        Force or torque, stiffness, or damping
    along : Expr
        The displacement or angle that it works on
    """

    value: Expr
    along: Expr
