"""Gas of a case: what answers for it, whatever kind of cycle it has, and how it acts on each piston of a mechanism.

A cycle of one cylinder acts on every piston, each from its own firing dead centre on; the two pistons of a Stirling
engine share one gas, the first declared being the hot piston or the displacer.
"""

import functools
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from typing import Any

import casadi as ca
import numpy as np

from mechsym.cases import Case
from mechsym.cases.settings import guesses
from mechsym.cycle.chamber import Chamber, motion_over, piston_area
from mechsym.cycle.closed.model import ClosedEngine
from mechsym.cycle.friction import Friction, NoFriction
from mechsym.cycle.gas import Gas
from mechsym.cycle.kinds import kind_of, source_of, with_diagram
from mechsym.cycle.measured.diagram import Diagram
from mechsym.cycle.motion import pistons_of, top_of, travel_of
from mechsym.cycle.pressure import ATMOSPHERE
from mechsym.cycle.source import EngineParts, GasSource
from mechsym.errors import BadInput
from mechsym.machine.torque_curve import TorqueCurve, read_torque, torque_at
from mechsym.mechanisms.own import content
from mechsym.mechanisms.plan import plan_of
from mechsym.mechanisms.record import Mechanism
from mechsym.mechanisms.roles import PistonRole
from mechsym.quantities import by_name, record
from mechsym.quantities.display import chosen
from mechsym.quantities.units import NewtonMetre, RadPerSecond

_FREE = NoFriction()


@contextmanager
def of(case: Case) -> Iterator[None]:
    """Puts the file of a case before what physics has to say about its data."""
    try:
        yield
    except BadInput as error:
        raise BadInput(f"{case.file}: {str(error).removeprefix(f'{case.file}: ')}") from None


def gas(case: Case) -> Gas | None:
    """Gas of a case at its speed of operation.

    Returns gas: None for a case without a cycle: only inertia and weight act.

    >>> from mechsym import cases
    >>> round(gas(cases.load("zotov-89")).pressure.mean_indicated)
    800000
    """
    if "cycle" not in case.sections:
        return None
    return gas_on(case if kind_of(case.need("cycle")).shared else one_cylinder(case))


def gas_on(case: Case, number: int = 0) -> Gas:
    """Gas on a piston by its place in the declaration, from its firing dead centre on."""
    cycle, parts = case.need("cycle"), parts_of(case, number=number)
    # a diagram is read from a file, which may have changed since
    at = _at.__wrapped__ if kind_of(cycle).measured else _at
    with of(case):
        return at(cycle, parts, case.need("operation").speed, chosen())


@functools.lru_cache(maxsize=8)
def _at(cycle: object, parts: EngineParts, omega: float, units: tuple[str, ...]) -> Gas:
    """Sweeps over springs and loads ask for one gas again and again; `units`: those of its sentences."""
    return _source(cycle, parts, units).at(omega)


def source(case: Case, friction: Friction = _FREE, number: int = 0) -> GasSource:
    """What answers for the gas of a case, on a piston by its place in the declaration."""
    cycle = case.need("cycle")
    known = _source.__wrapped__ if kind_of(cycle).measured else _source
    return known(cycle, parts_of(case, friction, number), chosen())


@functools.lru_cache(maxsize=8)
def _source(cycle: object, parts: EngineParts, units: tuple[str, ...]) -> GasSource:
    """Figures of a gas and the forces of its pistons ask for one engine; `units`: those of its sentences."""
    return source_of(cycle, parts)


def parts_of(case: Case, friction: Friction = _FREE, number: int = 0) -> EngineParts:
    """What stands around the gas of a case. Raises BadInput: a section is missing, or belongs to another kind."""
    kind = kind_of(case.need("cycle"))
    if kind.cylinder and not kind.measured and "scavenging" not in kind.reads and charged(case):
        raise BadInput(f"{case.file}: [scavenging] belongs to a cycle of kind two-stroke-marine; leave it out, or set "
                       "scavenging.source = 'given'")  # fmt: skip
    known = {name: case.need(name) for name in kind.needs}
    known |= {name: case.sections[name] for name in kind.reads if name in case.sections}
    return EngineParts(
        mechanism=case.mechanism,
        parameters=case.need("parameters"),
        guesses=tuple(guesses(case).items()),
        number=number,
        sections=tuple(known.items()),
        friction=friction,
        content=content(case.mechanism),
    )


def charged(case: Case) -> bool:
    """Whether a turbocharger says what the scavenge pressure of a case is."""
    section = case.sections.get("scavenging")
    return section is not None and section.source == "turbocharger"


def one_cylinder(case: Case) -> Case:
    """The case as one cylinder sees itself: its mechanism has one piston and its travel as `x`."""
    with of(case):
        name, parameters = plan_of(case.mechanism).alone(case.need("parameters"))
    return replace(case, mechanism=name, sections={**case.sections, "parameters": parameters})


def engine_with(case: Case, friction: Friction, number: int = 0) -> ClosedEngine:
    """The engine that a case describes, with a friction law whose numbers are known.

    case: with a cycle whose closed period is integrated, and what that needs; number: place of its role in the
    declaration, from 0. Raises BadInput: a section is missing, or the cycle is of another kind.
    """
    if not kind_of(case.need("cycle")).closed:
        why = "[cycle] kind must be 'spark-ignition' for this command; 'mechsym check' tells which take the case"
        raise BadInput(f"{case.file}: {why}")
    source_engine: Any = source(case, friction, number)
    with of(case):
        engine: ClosedEngine = source_engine.engine
    return engine


def at_recorded_speed(case: Case) -> Case:
    """The case at the speed that the times of its measured diagram tell, unless the user has set another.

    case: with a cycle of any kind; one without times, or without a file, stays as it is.
    """
    cycle = case.sections.get("cycle")
    recorded = "" if cycle is None else kind_of(cycle).recorded
    overridden = any(key.rpartition(".")[2].startswith("speed") for key in case.overrides)
    if not recorded or overridden or "operation" not in case.sections:
        return case
    omega = by_name.load(recorded)(cycle)
    if omega is None:
        return case
    return replace(case, sections={**case.sections, "operation": replace(case.need("operation"), speed=omega)})


def measured(case: Case, file: str) -> Case:
    """The case with a measured diagram in place of its cycle.

    case: with `[cycle]`; where that needs `[chamber]`, it gives the cylinder.
    """
    cycle = case.need("cycle")
    if kind_of(cycle).chambered:
        room = case.need("chamber")
        cycle = Diagram(
            bore=room.bore,
            compression_ratio=room.compression_ratio,
            working_cycle="four-stroke",
            inlet_pressure=getattr(cycle, "intake_pressure", ATMOSPHERE),
            p_back=room.back_pressure,
        )
    return at_recorded_speed(replace(case, sections={**case.sections, "cycle": with_diagram(cycle, file)}))


_TURN = 2 * np.pi
_OFF = 1e-4  # of the stroke, below a top dead centre where a piston may fire: about a degree


@record
class Piston:
    """A piston of the case with its gas."""

    name: str
    input: str  #: Takes the net gas force [N]
    start: float  #: Crank angle of its firing dead centre [rad]
    gas: Gas  #: Over the angle from there

    def force(self, phi: object) -> np.ndarray:
        """Net gas force over the crank angle [rad], positive away from the head [N]."""
        return np.asarray(self.gas.force(np.asarray(phi) - self.start))


def pistons(case: Case, mechanism: Mechanism) -> list[Piston]:
    """Pistons with the gas of `[cycle]`; none without that section.

    Raises BadInput: the declaration has no piston, or one goes out and back more than once in a turn.
    """
    if "cycle" not in case.sections:
        return []
    if "torque" in case.sections:
        raise BadInput(f"{case.file}: [torque] stands in place of [cycle]; leave one of them out")
    roles = require_pistons(case, mechanism)
    if kind_of(case.sections["cycle"]).shared:  # each piston has the area by which the common gas pushes it
        shared, pushed = gas_on(case), []
        for role, area in zip(roles, shared.pistons, strict=True):
            room = _room(case, travel_of(mechanism, role.travel), area)
            own = Gas(pressure=shared.pressure, chamber=room)
            pushed.append(Piston(name=role.name, input=role.force, start=0.0, gas=own))
        return pushed
    return [_piston(case, mechanism, role, number) for number, role in enumerate(roles)]


def require_pistons(case: Case, mechanism: Mechanism) -> tuple[PistonRole, ...]:
    """Pistons of a case with gas. Raises BadInput: a force does not act along its travel, or one fires elsewhere."""
    with of(case):
        roles = pistons_of(case.mechanism)
    for role in roles:
        _require_force(case, mechanism, role)
        if not kind_of(case.need("cycle")).shared:
            firing(case, role, travel_of(mechanism, role.travel))
    return roles


def _require_force(case: Case, mechanism: Mechanism, role: PistonRole) -> None:
    """Refuse a piston whose force does not act along its travel: forgotten, or with its sign turned."""
    dynamics = mechanism.functions["dynamics"]
    at = dict.fromkeys(dynamics.name_in(), 0.0)
    slope = travel_of(mechanism, role.travel)
    for angle in (0.7, 2.3, 4.1):
        pose = at | {mechanism.coordinates[0]: angle}
        without, pushed = (float(dynamics(**pose | {role.force: F})["generalized_force"]) for F in (0.0, 1.0))
        wanted = float(slope(angle)[1])
        if abs(pushed - without - wanted) > 1e-6 * max(1.0, abs(wanted), abs(without)):
            raise BadInput(
                f"{case.file}: the force {role.force} of the piston {role.name} does not act along its travel "
                f"{role.travel}; write m.force({role.force}, along={role.travel}), positive away from the head"
            )


def _piston(case: Case, mechanism: Mechanism, role: PistonRole, number: int) -> Piston:
    travel = travel_of(mechanism, role.travel)
    start = firing(case, role, travel)
    try:
        gas = gas_on(case, number)
    except (BadInput, TypeError) as error:
        raise BadInput(f"{case.file}: [cycle]: {str(error).removeprefix(f'{case.file}: ')}") from None
    return Piston(name=role.name, input=role.force, start=start, gas=gas)


def firing(case: Case, role: PistonRole, travel: ca.Function) -> float:
    """Angle at which a piston fires, which has to be a top dead centre of its own [rad]."""
    top, later = top_of(travel), role.fires
    x = np.asarray(travel(np.array([[top, top + later, *np.linspace(0, _TURN, 91)]]))[0]).ravel()
    below, stroke = float(x[1] - x[0]), float(np.ptp(x[2:]))
    if below > _OFF * stroke:
        raise BadInput(
            f"{case.file}: the piston {role.name} fires {np.degrees(later):.4g} deg after its own top dead centre "
            f"at {np.degrees(top):.4g} deg, where it stands {1e3 * below:.4g} mm below it; `fires` counts from there: "
            "write fires=0 or fires=2*pi"
        )
    return top + later


def _room(case: Case, travel: ca.Function, area: float) -> Chamber:
    cycle = case.need("cycle")
    values = np.asarray(travel(np.linspace(0, _TURN, 721)[None, :])[0])
    stroke, whole = float(np.ptp(values)), piston_area(cycle.bore)
    ratio = 1 + whole * stroke / cycle.dead_hot if cycle.dead_hot else np.inf
    return Chamber(
        motion=motion_over(travel), pistons=1, bore=cycle.bore, area=area, stroke=stroke, clearance=cycle.dead_hot,
        displacement=whole * stroke, back_pressure=cycle.p_back, compression_ratio=ratio,
    )  # fmt: skip


def mean_torque(case: Case, mechanism: Mechanism, acting: list[Piston]) -> NewtonMetre:
    """Mean torque of the gas on the shaft. Returns torque: over a period."""
    return float(np.mean(gas_torque(case, mechanism, acting)(np.linspace(0, common_period(acting), 7201)[:-1])))


def gas_torque(case: Case, mechanism: Mechanism, acting: list[Piston]) -> Callable[[np.ndarray], np.ndarray]:
    """Torque of the gas of all pistons on the shaft, over the crank angle [rad]: [N*m]."""
    travels = {r.force: travel_of(mechanism, r.travel) for r in pistons_of(case.mechanism)} if acting else {}

    def torque(phi: np.ndarray) -> np.ndarray:
        row = np.asarray(phi, dtype=float)[None, :]
        parts = (p.force(phi) * np.asarray(travels[p.input](row)[1]).ravel() for p in acting)
        return sum(parts, np.zeros(row.shape[1]))

    return torque


def common_period(acting: list[Piston]) -> float:
    """Period of the gas of all pistons [rad]."""
    return max((p.gas.pressure.period for p in acting), default=_TURN)


def kinks_of(acting: list[Piston]) -> tuple[float, ...]:
    """Crank angles at which the gas of a piston is not smooth [rad]."""
    period = common_period(acting)
    angles = (
        (k + p.start + turn * p.gas.pressure.period) % period
        for p in acting
        for k in p.gas.pressure.kinks
        for turn in range(2)
    )
    return tuple(sorted({round(a, 14) for a in angles}))


def shaft_curve(
    case: Case, mechanism: Mechanism, omega: RadPerSecond
) -> tuple[Callable[[np.ndarray], np.ndarray], float, tuple[float, ...]]:
    """The torque that `[torque]` puts on the shaft over the angle, 0 without it, its period and where it is not smooth.

    omega: speed of operation. Returns curve, period, kinks: angle [rad] to torque, positive driving [N*m]; [rad].
    """
    if "torque" not in case.sections:
        return (lambda phi: np.zeros(np.shape(phi))), 2 * np.pi, ()
    asked: TorqueCurve = case.need("torque")
    (q,) = mechanism.coordinates
    inertia, phi = mechanism.functions["dynamics"], ca.SX.sym(q)
    over = ca.Function("slope", [phi], [ca.jacobian(inertia(phi, *[0.0] * (inertia.n_in() - 1))[0], phi)])

    def slope(at: np.ndarray) -> np.ndarray:
        return np.asarray(over(np.reshape(at, (1, -1)))).reshape(np.shape(at))

    table = read_torque(asked.file)
    return torque_at(table, omega, asked.load, slope), table.period, table.kinks
