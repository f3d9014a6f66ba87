"""Gas on the pistons of a mechanism of the user's own, as `[cycle]` and the roles of the declaration say.

A cycle of one cylinder acts on every piston, each from its own firing dead centre on; the two pistons of a Stirling
engine share one gas, the first declared being the hot piston or the displacer.
"""

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import casadi as ca
import numpy as np

from mechsym import cycle as cycles
from mechsym.cases import Case
from mechsym.cycle.breathing.engine import pressure as breathing_pressure
from mechsym.cycle.breathing.engine import run as run_breathing
from mechsym.cycle.chamber import Chamber, piston_area
from mechsym.cycle.dead_centres import motion_over
from mechsym.cycle.friction import NoFriction
from mechsym.cycle.gas import Gas, gas_in_cylinder
from mechsym.cycle.kinds import kind_of
from mechsym.cycle.kinds.stirling import StirlingEngine, stirling_engine, stirling_pressure
from mechsym.cycle.kinds.stirling_spaces import areas
from mechsym.cycle.motion import from_top, piston_roles, slopes, top_of
from mechsym.errors import BadInput
from mechsym.jobs.gas import breathing_with, engine_with, of
from mechsym.jobs.scavenge import scavenged, told
from mechsym.machine.torque_curve import TorqueCurve, read_torque, torque_at
from mechsym.mechanisms.record import Mechanism
from mechsym.quantities import record

_TURN = 2 * np.pi
_OFF = 1e-4  # of the stroke, below a top dead centre where a piston may fire: about a degree


@record
class Piston:
    """A piston of the case with its gas."""

    name: str
    input: str  #: Takes the net gas force [N]
    start: float  #: Crank angle of its firing dead centre [rad]
    gas: Gas  #: Over the angle from there

    def force(self, phi: Any) -> np.ndarray:
        """Net gas force over the crank angle [rad], positive away from the head [N]."""
        return np.asarray(self.gas.force(np.asarray(phi) - self.start))


def pistons(case: Case, mechanism: Mechanism) -> list[Piston]:
    """Pistons with the gas of `[cycle]`; none without that section.

    Raises
    ------
    BadInput
        The declaration has no piston, or one goes out and back more than once in a turn
    """
    if "cycle" not in case.sections:
        return []
    if "torque" in case.sections:
        raise BadInput(f"{case.file}: [torque] stands in place of [cycle]; leave one of them out")
    with of(case):
        roles = piston_roles(case.mechanism)
    for role in roles:
        _require_force(case, mechanism, role)
    if kind_of(case.sections["cycle"]).given == "train":
        return _sharing(case, mechanism, roles)
    return [_piston(case, mechanism, role, number) for number, role in enumerate(roles)]


def _require_force(case: Case, mechanism: Mechanism, role: Mapping[str, Any]) -> None:
    """Refuse a piston whose force does not act along its travel: forgotten, or with its sign turned."""
    dynamics = mechanism.functions["dynamics"]
    at = dict.fromkeys(dynamics.name_in(), 0.0)
    slope = travel_of(mechanism, role["travel"])
    for angle in (0.7, 2.3, 4.1):
        pose = at | {mechanism.coordinates[0]: angle}
        without, pushed = (float(dynamics(**pose | {role["force"]: F})["generalized_force"]) for F in (0.0, 1.0))
        wanted = float(slope(angle)[1])
        if abs(pushed - without - wanted) > 1e-6 * max(1.0, abs(wanted), abs(without)):
            raise BadInput(
                f"{case.file}: the force {role['force']} of the piston {role['name']} does not act along its travel "
                f"{role['travel']}; write m.force({role['force']}, along={role['travel']}), positive away from the head"
            )


def _piston(case: Case, mechanism: Mechanism, role: dict[str, Any], number: int) -> Piston:
    travel = travel_of(mechanism, role["travel"])
    start = firing(case, role, travel)
    phi = ca.SX.sym("phi")
    shifted = ca.Function("travel", [phi], from_top(travel).call([phi])[:2], ["phi"], ["x", "dx_dphi"])
    cycle = case.sections["cycle"]
    if kind_of(cycle).given == "engine":
        engine = engine_with(case, NoFriction(), number)
        gas = cycles.gas_of_engine(engine, case.need("operation").speed)
        # the tabulated pressure jumps to that of the gas exchange
        valves = tuple(sorted(v % gas.pressure.period for v in (cycle.exhaust_opens, cycle.inlet_closes)))
        gas = replace(gas, pressure=replace(gas.pressure, kinks=valves))
    elif kind_of(cycle).given == "breathing":
        with of(case):
            run = run_breathing(breathing_with(case, NoFriction(), number), [case.need("operation").speed])
        gas = Gas(pressure=breathing_pressure(run), chamber=run.chamber)
    else:
        try:
            at, state = scavenged(case)
            gas = told(gas_in_cylinder(at.need("cycle"), shifted), state)
        except (BadInput, TypeError) as error:
            raise BadInput(f"{case.file}: [cycle]: {error}") from None
    return Piston(name=role["name"], input=role["force"], start=start, gas=gas)


def firing(case: Case, role: Mapping[str, Any], travel: ca.Function) -> float:
    """Angle at which a piston fires, which has to be a top dead centre of its own [rad]."""
    top, later = top_of(travel), float(role.get("fires", 0.0))
    x = np.asarray(travel(np.array([[top, top + later, *np.linspace(0, _TURN, 91)]]))[0]).ravel()
    below, stroke = float(x[1] - x[0]), float(np.ptp(x[2:]))
    if below > _OFF * stroke:
        raise BadInput(
            f"{case.file}: the piston {role['name']} fires {np.degrees(later):.4g} deg after its own top dead centre "
            f"at {np.degrees(top):.4g} deg, where it stands {1e3 * below:.4g} mm below it; `fires` counts from there: "
            "write fires=0 or fires=2*pi"
        )
    return top + later


def stirling(case: Case, mechanism: Mechanism, omega: float) -> StirlingEngine:
    """The Stirling engine of a case over one turn of its shaft, on its mechanism with one coordinate.

    Parameters
    ----------
    omega : float
        Shaft speed, for a cycle that depends on it [rad/s]

    Raises
    ------
    BadInput
        The declaration has not two pistons, or the cycle needs more
    """
    roles = piston_roles(case.mechanism)
    if len(roles) != 2:
        raise BadInput(
            f"{case.file}: a Stirling cycle needs two pistons, hot one or displacer first; {len(roles)} declared"
        )
    travels = [slopes(mechanism, role["travel"], {}) for role in roles]
    first, second = (lambda phi, f=f: f(phi)[0] for f in travels)
    with of(case):
        return stirling_engine(case.need("cycle"), (first, second), omega, case.sections.get("stirling"))


def _sharing(case: Case, mechanism: Mechanism, roles: list[dict[str, Any]]) -> list[Piston]:
    """Pistons of a Stirling engine, each with the area by which the common gas pushes it."""
    pressure = stirling_pressure(stirling(case, mechanism, case.need("operation").speed))
    return [
        Piston(name=role["name"], input=role["force"], start=0.0, gas=Gas(
            pressure=pressure, chamber=_room(case, travel_of(mechanism, role["travel"]), float(area))))
        for role, area in zip(roles, areas(case.need("cycle")).sum(axis=0), strict=True)
    ]  # fmt: skip


def _room(case: Case, travel: ca.Function, area: float) -> Chamber:
    cycle = case.need("cycle")
    values = np.asarray(travel(np.linspace(0, _TURN, 721)[None, :])[0])
    stroke, whole = float(np.ptp(values)), piston_area(cycle.bore)
    ratio = 1 + whole * stroke / cycle.dead_hot if cycle.dead_hot else np.inf
    return Chamber(
        motion=motion_over(travel), pistons=1, bore=cycle.bore, area=area, stroke=stroke, clearance=cycle.dead_hot,
        displacement=whole * stroke, back_pressure=cycle.p_back, compression_ratio=ratio,
    )  # fmt: skip


def travel_of(mechanism: Mechanism, name: str) -> ca.Function:
    """Travel of a piston and its derivative over the crank angle [rad]: [m], [m/rad]."""
    phi = ca.SX.sym("phi")
    found = slopes(mechanism, name, {})
    return ca.Function("travel", [phi], found.call([phi]), ["phi"], ["x", "dx_dphi", "d2x_dphi2"])


def mean_torque(case: Case, mechanism: Mechanism, acting: list[Piston]) -> float:
    """Mean torque of the gas on the shaft.

    Returns
    -------
    torque : float
        Over a period [N*m]
    """
    return float(np.mean(gas_torque(case, mechanism, acting)(np.linspace(0, period_of(acting), 7201)[:-1])))


def gas_torque(case: Case, mechanism: Mechanism, acting: list[Piston]) -> Callable[[np.ndarray], np.ndarray]:
    """Torque of the gas of all pistons on the shaft, over the crank angle [rad]: [N*m]."""
    travels = {r["force"]: travel_of(mechanism, r["travel"]) for r in piston_roles(case.mechanism)} if acting else {}

    def torque(phi: np.ndarray) -> np.ndarray:
        row = np.asarray(phi, dtype=float)[None, :]
        parts = (p.force(phi) * np.asarray(travels[p.input](row)[1]).ravel() for p in acting)
        return sum(parts, np.zeros(row.shape[1]))

    return torque


def period_of(acting: list[Piston]) -> float:
    """Period of the gas of all pistons [rad]."""
    return max((p.gas.pressure.period for p in acting), default=_TURN)


def kinks_of(acting: list[Piston]) -> tuple[float, ...]:
    """Crank angles at which the gas of a piston is not smooth [rad]."""
    period = period_of(acting)
    found = (
        (k + p.start + turn * p.gas.pressure.period) % period
        for p in acting
        for k in p.gas.pressure.kinks
        for turn in range(2)
    )
    return tuple(sorted({round(a, 14) for a in found}))


def shaft_curve(case: Case, mechanism: Mechanism, omega: float) -> tuple[Callable[[np.ndarray], np.ndarray], float]:
    """The torque that `[torque]` puts on the shaft over the angle, 0 without it, and its period [rad].

    Parameters
    ----------
    omega : float
        Speed of operation [rad/s]

    Returns
    -------
    curve, period : callable, float
        Angle [rad] to torque, positive driving [N*m]; period [rad]
    """
    if "torque" not in case.sections:
        return (lambda phi: np.zeros(np.shape(phi))), 2 * np.pi
    asked: TorqueCurve = case.need("torque")
    (q,) = mechanism.coordinates
    inertia, phi = mechanism.functions["dynamics"], ca.SX.sym(q)
    slope = ca.jacobian(inertia(phi, *[0.0] * (inertia.n_in() - 1))[0], phi)
    over = ca.Function("slope", [phi], [slope])
    table = read_torque(asked.file)
    curve = torque_at(table, omega, asked.load, lambda at: _shaped(over, at))
    return curve, table.period


def _shaped(function: ca.Function, at: np.ndarray) -> np.ndarray:
    return np.asarray(function(np.reshape(at, (1, -1)))).reshape(np.shape(at))
