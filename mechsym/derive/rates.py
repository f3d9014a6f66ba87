"""What declarations take besides positions (velocities, accelerations, reactions), and what shall come out of them."""

from sympy import Add, Expr, Symbol

from mechsym.derive.letters import Letters
from mechsym.derive.refuse import refuse, require_declaration

_LONG = 1000  # operations: to multiply out a longer formula takes minutes and makes it longer still


def velocities(m: Letters) -> list[Symbol]:
    """Symbols of the velocities, `phid` for `phi`. Returns symbols: in the order of the coordinates."""
    return [Symbol(f"{v.name}d", real=True) for v in m.q]


def accelerations(m: Letters) -> list[Symbol]:
    """Symbols of the accelerations, `phidd` for `phi`. Returns symbols: in the order of the coordinates."""
    return [Symbol(f"{v.name}dd", real=True) for v in m.q]


def velocity(m: Letters, value: Expr) -> Expr:
    r"""Rate of an expression, :math:`\dot s = \sum (\partial s/\partial q) \dot q`.

    value: expression in names and coordinates. Returns rate: expression with the velocities.
    """
    require_declaration(m, "velocity(m, x)")
    return _rate(m, m._checked(value, "", "what moves"))


def _rate(m: Letters, value: Expr) -> Expr:
    slopes = zip((m.tape.diff(value, v) for v in m.q), velocities(m), strict=True)
    return Add(*(slope * u for slope, u in slopes if slope != 0))


def acceleration(m: Letters, value: Expr) -> Expr:
    """Second time derivative of an expression in names and coordinates, with velocities and accelerations."""
    require_declaration(m, "acceleration(m, x)")
    value = m._checked(value, "", "what moves")
    linear = (m.tape.diff(value, v) * a for v, a in zip(m.q, accelerations(m), strict=True))
    return Add(curvature(m, value), *linear)


def curvature(m: Letters, value: Expr) -> Expr:
    """The part of the second time derivative that is quadratic in the velocities.

    value: expression in names and coordinates. Returns acceleration: expression with the velocities.
    """
    if value not in m.tape.curvatures:
        first = [m.tape.diff(value, v) for v in m.q]
        pairs = zip(first, velocities(m), strict=True)
        curved = Add(*(_rate(m, slope) * u for slope, u in pairs))
        m.tape.curvatures[value] = curved.expand() if curved.count_ops() < _LONG else curved
    return m.tape.curvatures[value]


def reaction(m: Letters, joint: Symbol) -> Symbol:
    """The reaction of a joint, for forces that depend on it and for outputs.

    joint: joint displacement. Returns symbol: its reaction; `derive` puts the derived expression in its place.
    """
    require_declaration(m, "reaction(m, x_A)")
    if joint not in m.reaction_of:
        known = ", ".join(s.name for s in m.reaction_of) or "none, declare m.joints('x_A y_A', 'frame on crank')"
        refuse(f"{joint!r} is no joint displacement of {m.name}; there are {known}")
    return m.reaction_of[joint]


def output(m: Letters, *symbols: Symbol, order: int = 0) -> None:
    """Make names of the tape kinematic outputs, with derivatives by the coordinates up to an order of 0 to 2."""
    require_declaration(m, "output(m, x, order=2)")
    if order not in (0, 1, 2) or not symbols:
        refuse(f"output takes names and derivatives of order 0, 1 or 2, not {len(symbols)} names of order {order!r}")
    for symbol in symbols:
        if not isinstance(symbol, Symbol) or symbol not in {*m.tape.entries, *m.q}:
            refuse(f"output takes names of the declaration, and {symbol} is none; name it: x = m.let('x', .., 'm')")
        symbols_of_order = [symbol]
        for _ in range(order):
            m.kinematic_outputs += symbols_of_order
            symbols_of_order = [d for f in symbols_of_order for v in m.q if (d := _named(m, f, v)).is_Symbol]
        m.kinematic_outputs += symbols_of_order
    m.kinematic_outputs = list(dict.fromkeys(m.kinematic_outputs))


def _named(m: Letters, symbol: Symbol, v: Symbol) -> Expr:
    """A derivative by its own name, also where it is another name, or one with its sign turned."""
    value = m.tape.derivative(symbol, v)
    return m.tape.name_derivative(symbol, v, value) if value.is_Symbol or (-value).is_Symbol else value


def output_dynamic(m: Letters, name: str, value: Expr, unit: str) -> None:
    """Add an output that needs velocities, accelerations or inputs.

    value: expression in names, `velocity` and `acceleration` of names, reactions, inputs and parameters.
    """
    require_declaration(m, "output_dynamic(m, 'pull', value, 'N')")
    expression = m._checked(value, unit, str(name))
    m._take(name, unit)
    m.dynamic_outputs[name] = m.tape.named(expression)
