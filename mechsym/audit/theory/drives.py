"""Theories of mechanisms: any derived one, and the drives of sources 000 and 002 with what their papers speak of."""

from collections.abc import Mapping

from sympy import Rational, cos

from mechsym.audit.theory.mechanisms import Results, mechanism_theory, residuals, solved_accelerations, without
from mechsym.audit.theory.record import Theory
from mechsym.derive import Equations, Mechanism, acceleration, derive, output, velocities, velocity
from mechsym.derive.build import declared
from mechsym.derive.rates import accelerations

# no source prints these; they only set the scale of an error
_LOADS = {"F": 1e5, "M_r": 9000.0, "M_h": -20000.0, "phi": 1.0, "phidd": 0.5}
_SHAFT = {"phi0": 1.0, "phi2": 0.99, "phi0d": 194.0, "phi2d": 194.0, "phi0dd": 3.0, "phi2dd": 1.5, "M": 1.5, "F": 30.0}


def mechanism(name: str, values: Mapping[str, float], data: str) -> Theory:
    """Any derived mechanism, without results of its own.

    Parameters
    ----------
    values : mapping of str to float
        Parameters of a case and its speed

    Returns
    -------
    theory : Theory
        Lengths that begin with l count as rods
    """
    return equations_theory(derive(declared(name)), values, data)


def equations_theory(
    equations: Equations, values: Mapping[str, float], data: str, more: Results | None = None
) -> Theory:
    """The theory of derived equations, with further results or none; arguments as for `mechanism`."""
    m = equations.mechanism
    rods = tuple(p.name for p in m.parameter_list if p.name.startswith("l") and m.units[p.name] == "m")
    speeds = {u.name: values.get("speed", 10.0) for u in velocities(m)}
    return mechanism_theory(equations, dict.fromkeys(rods, 4.0) | speeds | dict(values), rods, data, more or {})


def crosshead(values: Mapping[str, float], data: str) -> Theory:
    """Crank, rod and crosshead with elastic hinge, exact.

    Parameters
    ----------
    values : mapping of str to float
        Parameters of a case and its speed

    Returns
    -------
    theory : Theory
        With the hinge torque for constant speed, and the parts of the generalised force
    """
    equations = derive(declared("crosshead"))
    m, (force,), (bias,) = equations.mechanism, equations.generalized_force, equations.bias
    inertia = equations.mass_matrix[0][0]
    more = {
        "hinge_torque": (bias - without(force, "M_h"), "N*m"),
        "gravity_torque": (without(force, "F", "M_r", "M_h"), "N*m"),
        "gas_torque": (without(force, "g", "M_r", "M_h"), "N*m"),
        "inertia_rate": (velocity(m, inertia), "kg*m^2/s"),
        "inertia_torque": (m.tape.diff(inertia, m.q[0]) * velocities(m)[0] ** 2 / 2, "N*m"),
    }
    known = _LOADS | {"phid": values.get("speed", 10.0)} | dict(values)
    return mechanism_theory(equations, known, ("l1", "l2"), data, more)


def crankshaft_flywheel(values: Mapping[str, float], data: str) -> Theory:
    """Crankshaft and flywheel on a torsional spring, exact.

    Returns
    -------
    theory : Theory
        With the piston's motion, the equations of motion as sums, and the torque that drives a given motion
    """
    return _shaft(derive(declared("crankshaft_flywheel")), values, data)


def crankshaft_flywheel_truncated(values: Mapping[str, float], data: str) -> Theory:
    """The Lagrange equation of the truncated travel (9) of source 002.

    Returns
    -------
    theory : Theory
        Same names as the exact one
    """
    m = Mechanism("crankshaft_flywheel_truncated", source="002_d7297926d6c52225")
    phi0, phi2 = m.coordinates("phi0 phi2")
    I0, I2 = m.parameters("I0 I2", "kg*m^2")
    r, l = m.parameters("r l", "m")
    m0, k1 = m.parameters("m0", "kg"), m.parameters("k1", "N*m/rad")
    M = m.inputs("M", "N*m")
    lam = m.let("lam", r / l, "-")
    x0 = m.let("x0", r * ((1 - cos(phi0)) + lam * Rational(1, 4) * (1 - cos(2 * phi0))), "m")
    m.body("crank", turns=phi0, inertia=I0)
    m.body("flywheel", turns=phi2, inertia=I2)
    m.body("piston", mass=m0, at=(-x0, 0))
    m.spring(k1, stretch=m.let("twist", phi0 - phi2, "rad"))
    m.torque(M, along=phi0)
    output(m, x0, order=2)
    return _shaft(derive(m), values, data)


def _shaft(equations: Equations, values: Mapping[str, float], data: str) -> Theory:
    m = equations.mechanism
    x0 = next(s for s in m.kinematic_outputs if s.name == "x0")
    solved = solved_accelerations(equations)
    x0dd = acceleration(m, x0)
    torque = next(s for s in m.input_list if s.name == "M") - residuals(equations)["residual_phi0"]
    more = {
        "x0d": (velocity(m, x0), "m/s"),
        "x0dd": (x0dd, "m/s^2"),
        "x0dd_solved": (x0dd.xreplace(dict(zip(accelerations(m), solved, strict=True))), "m/s^2"),
        "acceleration_phi0": (solved[0], "rad/s^2"),
        "acceleration_phi2": (solved[1], "rad/s^2"),
        "driving_torque": (torque, "N*m"),
    }
    return mechanism_theory(equations, _SHAFT | dict(values), ("l",), data, more)
