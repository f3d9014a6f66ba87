"""P1: from the description of a crankshaft with N throws to a function that gives its accelerations.

mechsym has derived one throw before and stored it; warm means that the compiled file is in the cache too. The others
start from the Lagrangian of the whole machine, which is what their users do.
"""

import functools
import os
import tempfile
from collections.abc import Callable
from typing import Any

import casadi as ca
import numpy as np

from benchmarks import models
from benchmarks.measure import PAIRS, Route, Row, take_turns
from mechsym import native
from mechsym.mechanisms import crank_train
from mechsym.mechanisms.record import acceleration_function
from mechsym.native import cache, source

THROWS = (1, 2, 3, 6, 12, 96)
_SLOW = 12  # the largest machine that sympy is given


def rows(skipped: list[str]) -> list[Row]:
    """Measure all routes for N = 1 to 96.

    Parameters
    ----------
    skipped : list of str
        Names of alternatives that are not installed are added

    Returns
    -------
    rows : list of Row
        Time from parameters to a callable that has been called once
    """
    found = []
    for throws in THROWS:
        routes = {
            "mechsym (warm)": (functools.partial(_warm, throws), PAIRS),
            "mechsym (compiling)": (functools.partial(_cold, throws), 5),
            "casadi autodiff, interpreted": (functools.partial(_casadi, throws), PAIRS),
        }
        if throws in (1, _SLOW):
            routes["sympy LagrangesMethod + lambdify"] = (functools.partial(_sympy, throws), 1)
        found += take_turns("P1 derive + callable", f"N = {throws}", _checked(throws, routes))
    # the template alone, which happens once in the life of a mechanism
    template = Route(name="mechsym (deriving the throw)", call=_template, rounds=1)
    return found + take_turns("P1 derive + callable", "template", [template])


def _checked(throws: int, routes: dict[str, tuple[Callable[[], Any], int]]) -> list[Route]:
    x = np.random.default_rng(throws).uniform(-3, 3, 3 * throws + 3)
    made, wanted = [], None
    for name, (make, rounds) in routes.items():
        found = np.asarray(make()(*x), dtype=float).ravel()
        wanted = found if wanted is None else wanted
        error = float(np.max(np.abs(found - wanted)) / np.max(np.abs(wanted)))
        if not error < 1e-9:
            raise AssertionError(f"{name} at N = {throws} gives other accelerations: {error:.3g}")
        made.append(Route(name=name, call=functools.partial(_called, make, x), error=error, rounds=rounds))
    return made


def _called(make: Callable[[], Any], x: np.ndarray) -> None:
    make()(*x)


def _warm(throws: int) -> Callable[..., Any]:
    cache.forget()
    source.stored_program.cache_clear()
    mechanism = crank_train.build(models.train(throws))
    return native.compiled(acceleration_function(mechanism)).scalar


def _cold(throws: int) -> Callable[..., Any]:
    before = os.environ.get("XDG_CACHE_HOME")
    with tempfile.TemporaryDirectory() as empty:
        os.environ["XDG_CACHE_HOME"] = empty
        try:
            return _warm(throws)
        finally:
            if before is None:
                del os.environ["XDG_CACHE_HOME"]
            else:
                os.environ["XDG_CACHE_HOME"] = before


def _template() -> None:
    from mechsym.derive import build

    build.build("crank_throw")


def _lagrangian(throws: int, q: list[Any], u: list[Any], maths: Any) -> tuple[Any, Any, list[Any]]:
    """Kinetic and potential energy of the machine of `models.train`, and the travel of each piston."""
    p = models.train(throws)
    r, l1, l2 = p.r, p.l1, p.l2
    l = l1 + l2
    kinetic, potential, travels = p.I_f * u[-1] ** 2 / 2, 0, []
    for i in range(throws):
        angle = q[i] + p.phase[i]
        s, c = maths.sin(angle), maths.cos(angle)
        sine = r / l * s
        cosine = maths.sqrt(1 - sine**2)
        rate = r / l * c / cosine  # dpsi/dphi
        x_rod, y_rod = -r * s - l1 * sine * rate, l2 * cosine * rate
        dx = r * s + l * sine * rate
        square = p.m_rod * (x_rod**2 + y_rod**2) + p.I_rod * rate**2 + p.m_piston * dx**2 + p.I0
        kinetic += square * u[i] ** 2 / 2
        potential += p.k * (q[i] - q[i + 1]) ** 2 / 2
        travels.append(r * (1 - c) + l * (1 - cosine))
    return kinetic, potential, travels


def _casadi(throws: int) -> Callable[..., Any]:
    n = throws + 1
    q, u, force, load = ca.SX.sym("q", n), ca.SX.sym("u", n), ca.SX.sym("F", throws), ca.SX.sym("M")
    kinetic, potential, travels = _lagrangian(throws, ca.vertsplit(q), ca.vertsplit(u), ca)
    momentum = ca.gradient(kinetic, u)
    mass = ca.jacobian(momentum, u)
    applied = ca.jtimes(ca.vertcat(*travels), q, force, True) - _damping(throws, u)
    applied[-1] -= load
    rest = ca.jtimes(momentum, q, u) - ca.gradient(kinetic - potential, q)
    inputs = [*ca.vertsplit(q), *ca.vertsplit(u), *ca.vertsplit(force), load]
    return ca.Function("a", inputs, [ca.solve(mass, applied - rest)])


def _damping(throws: int, u: Any) -> Any:
    c = models.train(throws).c
    torque = [c * (u[i] - u[i + 1]) for i in range(throws)]
    zero = [0 * torque[0]]
    return ca.vertcat(*(a - b for a, b in zip([*torque, *zero], [*zero, *torque], strict=True)))


def _sympy(throws: int) -> Callable[..., Any]:
    import sympy
    from sympy.physics.mechanics import LagrangesMethod, Point, ReferenceFrame, dynamicsymbols

    n = throws + 1
    q = dynamicsymbols(f"q:{n}")
    u = [a.diff() for a in q]
    forces, load = sympy.symbols(f"F:{throws}"), sympy.Symbol("M")
    kinetic, potential, travels = _lagrangian(throws, list(q), u, sympy)
    frame, torques, c = ReferenceFrame("N"), [0] * n, models.train(throws).c
    for i, (travel, force) in enumerate(zip(travels, forces, strict=True)):
        torque = c * (u[i] - u[i + 1])
        torques[i] += force * travel.diff(q[i]) - torque
        torques[i + 1] += torque
    torques[-1] -= load
    # a generalised force on each coordinate: a point that moves with unit speed per coordinate
    points = []
    for i in range(n):
        point = Point(f"P{i}")
        point.set_vel(frame, u[i] * frame.x)
        points.append((point, torques[i] * frame.x))
    method = LagrangesMethod(kinetic - potential, list(q), forcelist=points, frame=frame)
    method.form_lagranges_equations()
    plain = sympy.symbols(f"a:{n}"), sympy.symbols(f"b:{n}")
    swap = dict(zip([*u, *q], [*plain[1], *plain[0]], strict=True))
    matrices = [m.subs(swap) for m in (method.mass_matrix, method.forcing)]
    call = sympy.lambdify([*plain[0], *plain[1], *forces, load], matrices, "numpy", cse=True)

    def accelerations(*x: float) -> np.ndarray:
        mass, forcing = call(*x)
        return np.linalg.solve(mass, forcing)

    return accelerations
