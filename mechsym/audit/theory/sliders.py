"""Theory of the force chain of a slider crank with a massless rod (sources 001, 003, 004), and of the two-mass rod."""

from collections.abc import Mapping
from typing import Any

import sympy
from sympy import Symbol, cos, sin, solve

from mechsym.audit.theory.conversion import tape_of
from mechsym.audit.theory.mechanisms import mechanism_theory
from mechsym.audit.theory.record import Letter, Theory
from mechsym.derive import Mechanism, acceleration, derive, output


def slider_crank(values: Mapping[str, float], data: str) -> Theory:
    """A crank, a massless rod and a reciprocating mass, with the joint forces that the derivation gives.

    Parameters
    ----------
    values : mapping of str to float
        Parameters of a crosshead engine: its lengths and reciprocating masses set the scale

    Returns
    -------
    theory : Theory
        `total_force`, `rod_force` (compression), `normal_force`, `tangential_force`, `radial_force` (towards the
        shaft), `torque`
    """
    m = Mechanism("slider_crank", source="001_a140ef4f7e005dde")
    phi = m.coordinates("phi")
    r, l = m.parameters("r l", "m")
    mass: Any = m.parameters("m", "kg")
    F = m.inputs("F", "N")
    x_A, y_A = m.joints("x_A y_A", "crank on rod")
    y_G = m.joints("y_G", "guide on piston")
    lam = m.let("lam", r / l, "-")
    beta = m.angle("beta", sine=lam * sin(phi) + (y_A - y_G) / l)
    x = m.let("x", r * (1 - cos(phi)) + l * (1 - cos(beta)) - x_A, "m")
    m.body("piston", mass=mass, at=(r + l - x, y_G))
    m.force(F, along=x)
    output(m, x, order=2)
    output(m, beta)
    equations = derive(m)
    pin_x, pin_y, guide = (equations.reactions[f"R_{j}"] for j in ("x_A", "y_A", "y_G"))
    s, c = sin(phi), cos(phi)
    piston = acceleration(m, x)
    more = {
        "piston_acceleration": (piston, "m/s^2"),
        "inertia_force": (-mass * piston, "N"),
        "total_force": (F - mass * piston, "N"),
        "rod_force": (pin_x * cos(beta) - pin_y * sin(beta), "N"),
        "normal_force": (guide, "N"),
        "tangential_force": (pin_x * s - pin_y * c, "N"),
        "radial_force": (pin_x * c + pin_y * s, "N"),
        "torque": ((F - mass * piston) * m.tape.diff(x, phi), "N*m"),
    }
    named = {k: (m.tape.named(e), unit) for k, (e, unit) in more.items()}
    known = {"r": 0.5, "l": 1.55, "m": 460.0, "F": 1e5, "phi": 1.0, "phid": values.get("speed", 10.0), "phidd": 0.5}
    return mechanism_theory(equations, known, ("l",), data, named)


def two_mass_rod(values: Mapping[str, float], data: str) -> Theory:
    """A rod replaced by two masses at its ends, with the same mass and centre of mass.

    Returns
    -------
    theory : Theory
        `mass_on_piston`, `mass_on_crank`, and `inertia_missing`, by which its inertia differs from that of the rod
    """
    m_b, L, L_m, I_C = (Symbol(k, positive=True) for k in ("m_b", "L", "L_m", "I_C"))
    piston, crank = sympy.symbols("piston crank", positive=True)
    # same mass; same moment about the crank pin, L_m from there to the centre of mass
    masses = solve([piston + crank - m_b, piston * L - m_b * L_m], [piston, crank], dict=True)[0]
    missing = I_C - (masses[piston] * (L - L_m) ** 2 + masses[crank] * L_m**2)
    expressions = {
        "mass_on_piston": masses[piston],
        "mass_on_crank": masses[crank],
        "inertia_missing": sympy.factor(missing),
    }
    l1, l2 = values.get("l1", 0.8), values.get("l2", 0.75)
    letters = {
        "m_b": Letter(unit="kg", value=values.get("m2", 150.0)),
        "L": Letter(unit="m", value=l1 + l2),
        "L_m": Letter(unit="m", value=l1),
        "I_C": Letter(unit="kg*m^2", value=values.get("IC2", 50.0)),
    }
    units = {"mass_on_piston": "kg", "mass_on_crank": "kg", "inertia_missing": "kg*m^2"}
    return Theory(
        name="two_mass_rod",
        letters=letters,
        tape=tape_of(expressions),
        results=tuple(expressions),
        units=units,
        data=data,
    )
