"""A case of a mechanism of the user's own: its mechanism, what acts on it, and its run in time.

Who acts is said by the roles of the declaration (`piston`, `rotor`) and by the case: `[cycle]` on the pistons,
`[drive]`, `[load]`, constants in `[inputs]`; `[start]` has coordinates, velocities and guesses.
"""

from collections.abc import Callable
from dataclasses import asdict, replace
from functools import lru_cache
from typing import Any

import casadi as ca
import numpy as np
from scipy.optimize import minimize_scalar

from mechsym import mechanisms
from mechsym.cases import Case
from mechsym.cycle.gas import Gas, gas_in_cylinder
from mechsym.errors import BadInput
from mechsym.machine.loads import PropellerLoad, settle
from mechsym.mechanisms import loops
from mechsym.mechanisms.record import Mechanism, listing
from mechsym.quantities import record
from mechsym.simulate.engine import load_value
from mechsym.simulate.problem import Kinks, Part, Periodic, Problem, Steps, Stop
from mechsym.simulate.settings import Simulation, StepTorque

_TURN = 2 * np.pi
_TURN_POINTS = 360  # results a turn


def mechanism_of(case: Case) -> Mechanism:
    """The mechanism of a case, with the guesses that its `[start]` gives for dependent coordinates."""
    found = mechanisms.build(case.mechanism, case.need("parameters"))
    given = {k: v for k, v in _start(case).items() if k in found.dependents}
    return replace(found, dependents={**found.dependents, **given})


def one_coordinate(case: Case) -> Mechanism:
    """The mechanism with its first coordinate alone, for what turns at constant speed."""
    found = mechanism_of(case)
    if found.dependents:
        return loops.reduced(found)[0]
    if len(found.coordinates) != 1:
        raise BadInput(f"{case.file}: {found.name} has {len(found.coordinates)} coordinates; this command takes one")
    return found


def _start(case: Case) -> dict[str, float]:
    section = case.sections.get("start")
    return {} if section is None else {k: v for k, v in asdict(section).items() if v is not None}


def constants(case: Case) -> dict[str, float]:
    """Constants of `[inputs]`."""
    section = case.sections.get("inputs")
    return {} if section is None else asdict(section)


def roles(case: Case, kind: str) -> list[dict[str, Any]]:
    """Parts of a kind in the declaration: `piston`, `rotor`, `bearing`, .."""
    return list(listing(case.mechanism).get("roles", {}).get(kind, []))


def driving_input(case: Case) -> str:
    """The input that a `[drive]` without one turns: the rotor's, or the only torque on a coordinate."""
    named = [r["drive"] for r in roles(case, "rotor") if r["drive"]]
    units = listing(case.mechanism)["inputs"]
    torques = named or [n for n, unit in units.items() if unit == "N*m"]
    if len(torques) != 1:
        raise BadInput(f"{case.file}: key drive.input is missing; inputs are {', '.join(units) or 'none'}")
    return torques[0]


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
        The declaration has no piston, or its dead centres are not half a turn apart
    """
    if "cycle" not in case.sections:
        return []
    named = roles(case, "piston")
    if not named:
        raise BadInput(f"{case.file}: [cycle] needs a piston; declare one with m.piston(name, travel=x, force=F)")
    return [_piston(case, mechanism, role) for role in named]


def _piston(case: Case, mechanism: Mechanism, role: dict[str, Any]) -> Piston:
    travel = travel_of(mechanism, role["travel"])
    top = _extreme(travel, 1.0)
    start = top + float(role.get("fires", 0.0))
    phi, lowest = ca.SX.sym("phi"), float(travel(top)[0])
    x, dx = travel(phi + top)
    shifted = ca.Function("travel", [phi], [x - lowest, dx], ["phi"], ["x", "dx_dphi"])
    bottom = _extreme(shifted, -1.0)
    if abs((bottom - np.pi + np.pi) % _TURN - np.pi) > 1e-6:
        apart = f"dead centres {np.degrees(bottom % _TURN):.3f} deg apart"
        raise BadInput(
            f"{case.file}: piston {role['name']} has {apart}; the cycles know 180 deg: give [torque] a curve"
        )
    try:
        gas = gas_in_cylinder(case.sections["cycle"], shifted)
    except (BadInput, TypeError) as error:
        raise BadInput(f"{case.file}: [cycle]: {error}") from None
    return Piston(name=role["name"], input=role["force"], start=start, gas=gas)


def travel_of(mechanism: Mechanism, name: str) -> ca.Function:
    """Travel of a piston and its derivative over the crank angle [rad]: [m], [m/rad]."""
    kinematics = mechanism.functions["kinematics"]
    phi = ca.SX.sym("phi")
    x = dict(zip(kinematics.name_out(), kinematics.call([phi]), strict=True))[name]
    outputs = [x, ca.jacobian(x, phi)]
    return ca.Function("travel", [phi], outputs, ["phi"], ["x", "dx_dphi"])


def _extreme(travel: ca.Function, sign: float) -> float:
    """Angle of the least (sign 1) or greatest (-1) travel, in [0, 2 pi) [rad]."""
    grid = np.linspace(0, _TURN, 721)[:-1]
    values = sign * np.asarray(travel(grid[None, :])[0]).ravel()
    best = float(grid[int(np.argmin(values))])
    low, high = best - _TURN / 720, best + _TURN / 720
    slope = [sign * float(travel(a)[1]) for a in (low, high)]
    if slope[0] < 0 < slope[1]:
        from scipy.optimize import brentq

        best = float(brentq(lambda a: sign * float(travel(a)[1]), low, high, xtol=1e-15))
    else:
        best = float(minimize_scalar(lambda a: sign * float(travel(a)[0]), bounds=(low, high), method="bounded").x)
    return best % _TURN if abs(best) > 1e-12 and abs(best - _TURN) > 1e-12 else 0.0


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
    travels = {r["force"]: travel_of(mechanism, r["travel"]) for r in roles(case, "piston")}

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


def problem(case: Case) -> Problem:
    """The run in time that a case describes.

    Parameters
    ----------
    case : Case
        With `[simulation]`; without it an engine runs 20 turns from its speed of operation
    """
    wanted = simulation_of(case)
    mechanism = mechanism_of(case)
    acting = pistons(case, one_coordinate(case)) if "cycle" in case.sections else []
    mean = mean_torque(case, one_coordinate(case), acting) if acting else 0.0
    values = {q: mechanism.dependents.get(q, wanted.phi_start) for q in mechanism.coordinates} | _start(case)
    speed = _speed(case, wanted, bool(acting))
    rates = {f"{q}d": 0.0 if q in mechanism.dependents else speed for q in mechanism.coordinates} | _start(case)
    u0 = tuple(rates[f"{q}d"] for q in mechanism.coordinates)
    t_end, output = _end(case, wanted, u0[0])
    return Problem(
        mechanism=mechanism,
        parts=_parts(case, mechanism, acting, mean),
        q0=tuple(values[q] for q in mechanism.coordinates),
        u0=u0,
        t_end=t_end,
        turns=wanted.turns,
        kinks=_kinks(mechanism, acting),
        stops=(Stop(name="stall", of=f"{mechanism.coordinates[0]}d", direction="falling"),) if acting else (),
        output=output,
    )


def simulation_of(case: Case) -> Simulation:
    """Section `[simulation]`, or 20 turns from the speed of operation."""
    if "simulation" in case.sections or "operation" not in case.sections:
        return case.need("simulation")
    return Simulation(turns=20.0)


def _speed(case: Case, wanted: Simulation, engine: bool) -> float:
    if wanted.speed_start is not None:
        return wanted.speed_start
    return case.need("operation").speed if engine else 0.0


def _end(case: Case, wanted: Simulation, speed: float) -> tuple[float, float]:
    if wanted.t_end is not None:
        return wanted.t_end, wanted.output_step
    if speed <= 0 or wanted.turns is None:
        raise BadInput(f"{case.file}: turns need a start speed above 0 rad/s; give simulation.speed_start or t_end")
    return 10 * wanted.turns * _TURN / speed, _TURN / speed / _TURN_POINTS


def _parts(case: Case, mechanism: Mechanism, acting: list[Piston], mean: float) -> tuple[Part, ...]:
    q = mechanism.coordinates[0]
    found = [
        Part(name=f"gas_{p.name}", input=p.input, value=Periodic(
            coordinate=q, value=p.force, period=p.gas.pressure.period,
            kinks=tuple(sorted((k + p.start) % p.gas.pressure.period for k in p.gas.pressure.kinks))))
        for p in acting
    ]  # fmt: skip
    if "drive" in case.sections:
        drive: StepTorque = case.need("drive")
        steps = (
            Steps(times=(drive.time,), values=(0.0, drive.torque)) if drive.time > 0 else Steps(values=(drive.torque,))
        )
        found.append(Part(name="drive", input=drive.input or driving_input(case), value=steps))
        mean += drive.torque
    taken = {p.input for p in found}
    given = {n: v for n, v in constants(case).items() if v and n not in taken}
    found += [Part(name=f"input_{n}", input=n, value=Steps(values=(v,))) for n, v in given.items()]
    return (*found, *_load(case, mean, bool(acting)))


def _load(case: Case, mean: float, engine: bool) -> tuple[Part, ...]:
    inputs = [r["load"] for r in roles(case, "rotor") if r["load"]]
    if not inputs or not ("load" in case.sections or engine):
        return ()
    law = case.sections.get("load", PropellerLoad())
    speed = case.need("operation").speed if "operation" in case.sections else np.nan
    return (Part(name="load", input=inputs[0], role="load", value=load_value(settle(law, mean, speed))),)


def _kinks(mechanism: Mechanism, acting: list[Piston]) -> tuple[Kinks, ...]:
    angles = kinks_of(acting)
    return (Kinks(coordinate=mechanism.coordinates[0], angles=angles, period=period_of(acting)),) if angles else ()


@lru_cache(maxsize=8)
def is_own(name: str) -> bool:
    """Whether a mechanism comes from a file or another package."""
    from mechsym.mechanisms import own

    return own.is_file(name)
