"""A case of a mechanism of the user's own: its mechanism, what acts on it, and its run in time.

Who acts is said by the roles of the declaration (`piston`, `rotor`) and by the case: `[cycle]` on the pistons,
`[drive]`, `[load]`, constants in `[inputs]`; `[start]` has coordinates, velocities and guesses.
"""

from collections.abc import Mapping
from dataclasses import asdict, replace
from functools import lru_cache
from typing import Any

import numpy as np

from mechsym import mechanisms
from mechsym.cases import Case
from mechsym.errors import BadInput
from mechsym.jobs.own_gas import Piston, kinks_of, mean_torque, period_of, pistons, shaft_curve
from mechsym.jobs.span import TURN_POINTS, count_times, count_turns, simulation_of
from mechsym.jobs.starts import guesses
from mechsym.machine.loads import PropellerLoad, settle
from mechsym.mechanisms import loops
from mechsym.mechanisms.own import is_file
from mechsym.mechanisms.record import Mechanism, listing
from mechsym.mechanisms.shaft_inertia import with_inertia
from mechsym.simulate.engine import load_value
from mechsym.simulate.problem import Kinks, Part, Periodic, Problem, Steps, Stop
from mechsym.simulate.settings import Simulation, StepTorque

_TURN = 2 * np.pi


def mechanism_of(case: Case) -> Mechanism:
    """The mechanism of a case, with the guesses that its `[start]` gives for dependent coordinates."""
    found = mechanisms.build(case.mechanism, case.need("parameters"))
    given = {k: v for k, v in guesses(case).items() if k in found.dependents}
    return replace(found, dependents={**found.dependents, **given})


def one_coordinate(case: Case) -> Mechanism:
    """The mechanism with its first coordinate alone, for what turns at constant speed."""
    found = mechanism_of(case)
    if found.dependents:
        return loops.reduced(found)[0]
    if len(found.coordinates) != 1:
        raise BadInput(f"{case.file}: {found.name} has {len(found.coordinates)} coordinates; this command takes one")
    return found


def constants(case: Case) -> dict[str, float]:
    """Constants of `[inputs]`."""
    section = case.sections.get("inputs")
    return {} if section is None else asdict(section)


def roles(case: Case, kind: str) -> list[dict[str, Any]]:
    """Parts of a kind in the declaration: `piston`, `rotor`, `bearing`, .."""
    known = mechanisms.listing(case.mechanism) if is_file(case.mechanism) else _listing(case.mechanism)
    return list(known.get("roles", {}).get(kind, []))


# the points of a sweep ask again and again; a file of the user's own may have changed since
_listing = lru_cache(maxsize=16)(mechanisms.listing)


def driving_input(case: Case) -> str:
    """The input that a `[drive]` without one turns: the rotor's, or the only torque on a coordinate."""
    named = [r["drive"] for r in roles(case, "rotor") if r["drive"]]
    units = listing(case.mechanism)["inputs"]
    torques = named or [n for n, unit in units.items() if unit == "N*m"]
    if len(torques) != 1:
        raise BadInput(f"{case.file}: key drive.input is missing; inputs are {', '.join(units) or 'none'}")
    return torques[0]


def problem(case: Case) -> Problem:
    """The run in time that a case describes.

    Parameters
    ----------
    case : Case
        With `[simulation]`; without it an engine runs 20 turns from its speed of operation
    """
    wanted = simulation_of(case)
    mechanism = mechanism_of(case)
    if "flywheel" in case.sections:
        mechanism = with_inertia(mechanism, case.need("flywheel").inertia)
    acting = pistons(case, one_coordinate(case)) if "cycle" in case.sections else []
    curve, mean = _curve(case, mechanism) if "torque" in case.sections else (None, 0.0)
    mean = mean_torque(case, one_coordinate(case), acting) if acting else mean
    values = {q: mechanism.dependents.get(q, wanted.phi_start) for q in mechanism.coordinates} | guesses(case)
    engine = bool(acting) or curve is not None
    speed = _speed(case, wanted, engine)
    rates = {f"{q}d": 0.0 if q in mechanism.dependents else speed for q in mechanism.coordinates} | guesses(case)
    u0 = tuple(rates[f"{q}d"] for q in mechanism.coordinates)
    t_end, output = _end(case, wanted, u0[0])
    _require_closed(case, mechanism, values)
    return Problem(
        mechanism=mechanism,
        parts=(*_parts(case, mechanism, acting, mean, engine), *([curve] if curve else [])),
        q0=tuple(values[q] for q in mechanism.coordinates),
        u0=u0,
        t_end=t_end,
        turns=wanted.turns,
        kinks=_kinks(mechanism, acting),
        stops=(Stop(name="stall", of=f"{mechanism.coordinates[0]}d", direction="falling"),) if engine else (),
        output=output,
    )


def _require_closed(case: Case, mechanism: Mechanism, start: Mapping[str, float]) -> None:
    dynamics = mechanism.functions["dynamics"]
    values = [start.get(n, 0.0) for n in dynamics.name_in()]
    if not np.isfinite(np.asarray(dynamics.call(values)[0])).all():
        at = ", ".join(f"{q} = {start[q]:g}" for q in mechanism.coordinates)
        raise BadInput(
            f"{case.file}: the loop is open at the start ({at}): links too short there; give [start] another pose"
        )


def _speed(case: Case, wanted: Simulation, engine: bool) -> float:
    if wanted.speed_start is not None:
        return wanted.speed_start
    return case.need("operation").speed if engine else 0.0


def _end(case: Case, wanted: Simulation, speed: float) -> tuple[float, float]:
    if wanted.t_end is not None:
        count_times(case, wanted.t_end, wanted.step)
        return wanted.t_end, wanted.step
    if speed <= 0 or wanted.turns is None:
        raise BadInput(f"{case.file}: turns need a start speed above 0 rad/s; give simulation.speed_start or t_end")
    count_turns(case, wanted.turns)
    return 10 * wanted.turns * _TURN / speed, _TURN / speed / TURN_POINTS


def _parts(case: Case, mechanism: Mechanism, acting: list[Piston], mean: float, engine: bool) -> tuple[Part, ...]:
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
    return (*found, *_load(case, mean, engine))


def _curve(case: Case, mechanism: Mechanism) -> tuple[Part, float]:
    """The torque of `[torque]` at the speed of operation, on an input that turns the shaft, and its mean [N*m]."""
    name, sign = shaft_input(case, mechanism)
    curve, period = shaft_curve(case, one_coordinate(case), case.need("operation").speed)
    even = np.arange(7200) * period / 7200
    return Part(name="torque", input=name, value=Periodic(
        coordinate=mechanism.coordinates[0], value=lambda phi: sign * curve(phi), period=period,
    )), float(np.mean(curve(even)))  # fmt: skip


def shaft_input(case: Case, mechanism: Mechanism) -> tuple[str, float]:
    """An input that is a torque on the first coordinate, and its sign there."""
    dynamics = mechanism.functions["dynamics"]
    at = {n: 0.3 for n in dynamics.name_in()}
    rotors = [r[key] for key in ("drive", "load") for r in roles(case, "rotor") if r[key]]
    for name in dict.fromkeys([*rotors, *mechanism.inputs]):
        one, other = (np.asarray(dynamics(**{**at, name: v})["generalized_force"]).ravel() for v in (0.0, 1.0))
        change = np.round(other - one, 9)
        if abs(change[0]) == 1 and not change[1:].any():
            return name, float(change[0])
    raise BadInput(
        f"{case.file}: [torque] needs an input on the shaft; declare M = m.inputs('M', 'N*m') and "
        f"m.torque(M, along={mechanism.coordinates[0]})"
    )


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
    """Whether the roles of its declaration are all that is known of a mechanism: of a file, or without a module."""
    return mechanisms.by_roles(name)
