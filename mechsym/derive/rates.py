"""What declarations take besides positions: velocities, accelerations and reactions, as expressions in names."""

from sympy import Expr, Integer, Symbol

from mechsym.derive.declare import Declaration


def velocities(m: Declaration) -> list[Symbol]:
    """Symbols of the velocities, `phid` for `phi`.

    Parameters
    ----------
    m : Declaration
        The declaration

    Returns
    -------
    symbols : list of Symbol
        In the order of the coordinates
    """
    return [Symbol(f"{v.name}d", real=True) for v in m.q]


def accelerations(m: Declaration) -> list[Symbol]:
    """Symbols of the accelerations, `phidd` for `phi`.

    Parameters
    ----------
    m : Declaration
        The declaration

    Returns
    -------
    symbols : list of Symbol
        In the order of the coordinates
    """
    return [Symbol(f"{v.name}dd", real=True) for v in m.q]


def velocity(m: Declaration, value: Expr) -> Expr:
    r"""Rate of an expression, :math:`\dot s = \sum (\partial s/\partial q) \dot q`.

    Parameters
    ----------
    m : Declaration
        The declaration
    value : Expr
        Expression in names and coordinates

    Returns
    -------
    rate : Expr
        Expression with the velocities
    """
    return sum((m.tape.diff(value, v) * u for v, u in zip(m.q, velocities(m), strict=True)), Integer(0))


def acceleration(m: Declaration, value: Expr) -> Expr:
    """Second time derivative of an expression.

    Parameters
    ----------
    m : Declaration
        The declaration
    value : Expr
        Expression in names and coordinates

    Returns
    -------
    acceleration : Expr
        Expression with the velocities and accelerations
    """
    linear = (m.tape.diff(value, v) * a for v, a in zip(m.q, accelerations(m), strict=True))
    return sum(linear, curvature(m, value))


def curvature(m: Declaration, value: Expr) -> Expr:
    """The part of the second time derivative that is quadratic in the velocities.

    Parameters
    ----------
    m : Declaration
        The declaration
    value : Expr
        Expression in names and coordinates

    Returns
    -------
    acceleration : Expr
        Expression with the velocities
    """
    first = [m.tape.diff(value, v) for v in m.q]
    pairs = zip(first, velocities(m), strict=True)
    return sum((velocity(m, f) * u for f, u in pairs), Integer(0)).expand()


def reaction(m: Declaration, joint: Symbol) -> Symbol:
    """The reaction of a joint, for forces that depend on it and for outputs.

    Parameters
    ----------
    m : Declaration
        The declaration
    joint : Symbol
        Joint displacement

    Returns
    -------
    symbol : Symbol
        Its reaction; `derive` puts the derived expression in its place
    """
    return m.reaction_of[joint]
