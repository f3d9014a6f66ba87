"""From a mechanism to the motion that the engine cycle needs: the one place where the two meet.

The engine knows the travel of a piston and nothing else. Which output is a travel, which input takes the gas force and
which masses move with the piston, the declaration says with `m.piston(..)`. Angles here count from the piston's top
dead centre. Mechanisms whose pistons move alike share a view of it: the rodless slider moves as the piston of a
hypocycloid with e = r, and a crank train's cylinder as that of a single throw.
"""

import math
from collections.abc import Mapping

import casadi as ca
import numpy as np

from mechsym import mechanisms
from mechsym.cycle.chamber import Motion, check_motion, with_bottom
from mechsym.errors import BadInput
from mechsym.mechanisms.loops import one_coordinate
from mechsym.mechanisms.record import Mechanism, bind
from mechsym.mechanisms.roles import PistonRole
from mechsym.periodic.roots import minimum, root
from mechsym.quantities.records import Record
from mechsym.quantities.units import Radian

_TURN = 2 * math.pi


def piston_motion(
    name: str, parameters: Mapping[str, float], guesses: Mapping[str, float] | None = None, number: int = 0
) -> Motion:
    """The motion of a mechanism's piston, with the mechanism's parameters still free.

    name: name of a mechanism with one coordinate, or one left by its loops, and a piston. guesses: of dependent
    coordinates; the numbers of a mechanism with loops are bound [rad] or [m]. number: place of its role in the
    declaration, from 0. Returns motion: travel and its derivatives, and the loads that limit a design.
    """
    role = pistons_of(name)[number]
    symbols = {key: ca.SX.sym(key) for key in parameters}
    mechanism = bind(name, symbols)
    if mechanism.dependents:
        mechanism = one_coordinate(bind(name, parameters), guesses or {})
    elif len(mechanism.coordinates) != 1:
        raise BadInput(f"mechanism {name} has {len(mechanism.coordinates)} coordinates; a cycle needs one crank angle")
    motion = Motion(
        name=name,
        function=from_top(slopes(mechanism, role.travel, symbols), parameters),
        parameters=dict(parameters),
        masses=role.masses,
        loads=_loads(mechanism, symbols, role, parameters) if role.loads else None,
    )
    motion = with_bottom(motion)
    check_motion(motion)
    return motion


def pistons_of(name: str) -> tuple[PistonRole, ...]:
    """What the declaration of a mechanism says of its pistons. Raises BadInput: it has none."""
    pistons = mechanisms.roles_of(name).pistons
    if not pistons:
        raise BadInput(
            f"mechanism {name!r} has no piston for an engine cycle; declare one with m.piston(name, travel=x, force=F)"
        )
    return pistons


def top_of(travel: ca.Function) -> Radian:
    """Angle of top dead centre. travel: angle [rad] to travel [m] and its slope [m/rad]. Returns phi: in [0, 2 pi)."""
    return dead_centre(travel, 1.0)


def dead_centre(travel: ca.Function, sign: float) -> float:
    """Angle of the least (sign 1) or greatest (-1) travel, in [0, 2 pi) [rad]; function as for `top_of`."""
    grid = np.linspace(0, _TURN, 721)[:-1]
    values = sign * np.asarray(travel(grid[None, :])[0]).ravel()
    if not np.isfinite(values).all():
        at = math.degrees(grid[int(np.argmin(np.isfinite(values)))])
        raise BadInput(
            f"the loop opens at a crank angle of {at:g} deg: links too short, or a wrong branch; it cannot turn round"
        )
    best = float(grid[int(np.argmin(values))])
    low, high = best - _TURN / 720, best + _TURN / 720

    def slope(angle: float) -> float:
        return sign * float(travel(angle)[1])

    if slope(low) < 0 < slope(high):
        best = root(slope, low, high, xtol=1e-15)
    else:
        best, _ = minimum(lambda a: sign * float(travel(a)[0]), low, high)
    return best % _TURN if abs(best) > 1e-12 and abs(best - _TURN) > 1e-12 else 0.0


def piston_travel(
    name: str, parameters: Record, guesses: Mapping[str, float] | None = None, number: int = 0
) -> ca.Function:
    """Travel of a piston of a mechanism, from its top dead centre on.

    guesses: of dependent coordinates [rad] or [m]; number: place of its role in the declaration, from 0. Returns
    function: phi to `x` [m] and `dx_dphi` [m/rad].
    """
    mechanism = mechanisms.build(name, parameters)
    if mechanism.dependents:
        mechanism = one_coordinate(mechanism, guesses or {})
    if len(mechanism.coordinates) != 1:
        raise BadInput(f"mechanism {name} has no piston that a cycle could drive")
    travel = from_top(slopes(mechanism, pistons_of(name)[number].travel, {}))
    phi = ca.SX.sym("phi")
    return ca.Function("travel", [phi], travel.call([phi])[:2], ["phi"], ["x", "dx_dphi"])


def slopes(mechanism: Mechanism, name: str, symbols: Mapping[str, ca.SX]) -> ca.Function:
    """A kinematic output of a mechanism with one coordinate, and its derivatives by it.

    Returns function: angle, and a second input of the parameters in `symbols` if any are still free, to value, slope
    and curvature.
    """
    q, phi = mechanism.coordinates[0], ca.SX.sym("phi")
    kinematics = mechanism.functions["kinematics"]
    values = kinematics(**{q: phi}, **{k: v for k, v in symbols.items() if k in kinematics.name_in()})
    x = values[name]
    first = values.get(f"d{name}_d{q}", ca.jacobian(x, phi))
    second = values.get(f"d2{name}_d{q}2", ca.jacobian(first, phi))
    given = [ca.vertcat(*symbols.values())] if symbols else []
    return ca.Function("slopes", [phi, *given], [x, first, second])


def travel_of(mechanism: Mechanism, name: str) -> ca.Function:
    """Travel of a piston and its derivative over the crank angle [rad]: [m], [m/rad]."""
    phi = ca.SX.sym("phi")
    travel = slopes(mechanism, name, {})
    return ca.Function("travel", [phi], travel.call([phi]), ["phi"], ["x", "dx_dphi", "d2x_dphi2"])


def from_top(function: ca.Function, parameters: Mapping[str, float] | None = None) -> ca.Function:
    """A travel from its top dead centre on, which is found for the numbers of the parameters."""
    phi = ca.SX.sym("phi")
    given = [ca.SX.sym("parameters", len(parameters))] if parameters else []
    numbers = [ca.DM(list(parameters.values()))] if parameters else []
    top = top_of(ca.Function("travel", [phi], function.call([phi, *numbers])[:2]))
    if top == 0.0 and abs(float(function.call([0.0, *numbers])[0])) == 0.0:
        return function
    start = function.call([ca.SX(top), *given])[0]
    x, first, second = function.call([phi + top, *given])
    return ca.Function("travel", [phi, *given], [x - start, first, second])


def _loads(
    mechanism: Mechanism, symbols: Mapping[str, ca.SX], role: PistonRole, parameters: Mapping[str, float]
) -> ca.Function:
    q, phi, omega, force = mechanism.coordinates[0], *(ca.SX.sym(n) for n in ("phi", "omega", "F"))
    reactions, numbers = mechanism.functions["reactions"], ca.DM(list(parameters.values()))
    travel = slopes(mechanism, role.travel, symbols)
    top = top_of(ca.Function("travel", [phi], travel.call([phi, numbers])[:2]))
    state = {q: phi + top if top else phi, f"{q}d": omega, role.force: force}
    values = reactions(**{n: state.get(n, symbols.get(n, 0)) for n in reactions.name_in()})
    outputs = [values[n] for n in role.loads]
    return ca.Function("loads", [phi, ca.vertcat(*symbols.values()), omega, force], outputs,
                       ["phi", "parameters", "omega", "F"], list(role.loads))  # fmt: skip
