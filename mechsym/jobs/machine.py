"""Case -> machine: mechanism with its flywheel and one coordinate, gas on its pistons, what else acts, load, speed.

Weights and springs are the mechanism's own. What else acts beside the gas and hangs on speed or on constants (dampers,
`[inputs]`, a `[drive]`) is taken at the speed of operation and becomes a torque over the angle. Where a `[drive]` acts,
or no gas, its mean is part of what the load meets; beside gas alone it goes into the load.
"""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, replace
from functools import lru_cache
from typing import Any

import numpy as np

from mechsym import mechanisms
from mechsym.cases import Case
from mechsym.cases.settings import guesses
from mechsym.cycle.kinds import kind_of, with_diagram
from mechsym.errors import BadInput
from mechsym.forces.friction import FittedLaw, NoRings, fit
from mechsym.forces.turn import (
    Acting,
    CrankDrive,
    GasFace,
    Turn,
    acting,
    angles,
    at,
    drive_with,
    period_of,
    pushes,
    shaft_torque,
)
from mechsym.jobs.gas import at_recorded_speed, common_period, gas, kinks_of, of, pistons, shaft_curve
from mechsym.machine.loads import ConstantLoad, Load
from mechsym.machine.record import AngleForce, Machine, firing_of
from mechsym.mechanisms.loops import along_turn
from mechsym.mechanisms.own import content
from mechsym.mechanisms.plan import driving_inputs
from mechsym.mechanisms.record import Mechanism, evaluate
from mechsym.mechanisms.shaft import at_rest, is_damped, with_inertia, with_torque
from mechsym.quantities import record
from mechsym.quantities.records import Record
from mechsym.quantities.units import Inertia, RadPerSecond
from mechsym.simulate.settings import StepTorque

_GRID = np.arange(4096) * 2 * np.pi / 4096  # where the mean of what acts besides the gas is taken
_ROUNDING = 1e-12  # of the largest torque: a mean, or a swing about it, that is smaller is none


def machine(case: Case, diagram: str | None = None, inertia: Inertia = 0.0) -> Machine:
    """The engine of a case, ready to turn.

    case: with sections parameters and operation; `[cycle]` on the pistons, or `[torque]` on the shaft, or neither,
    where weights, springs, inertia and `[drive]` are all that acts; perhaps flywheel and load. diagram: CSV file of a
    measured diagram in place of the case's cycle. inertia: of a flywheel on top of what the case has. Raises BadInput:
    a mechanism with several free coordinates, or a cycle that cannot be made.

    >>> from mechsym import cases
    >>> round(machine(cases.load("zotov-89")).omega, 4)
    9.3201
    """
    if diagram is not None:
        cycle = with_diagram(case.need("cycle"), diagram)
        case = replace(case, sections={**case.sections, "cycle": cycle})
    case = at_recorded_speed(case)
    mechanism = turning(case, inertia)
    driven = "drive" in case.sections or "cycle" not in case.sections
    acting = _with_besides(turned_by(case, mechanism), acting_constants(case, mechanism), driven)
    return replace(acting, load=load(case))


def turned_by(case: Case, mechanism: Mechanism) -> Machine:
    """A mechanism with one coordinate under the gas of `[cycle]`, or the torque of `[torque]`, or nothing."""
    if "cycle" in case.sections:
        return _with_gas(case, mechanism)
    if "torque" not in case.sections:
        return _bare(case, mechanism)
    curve, period, kinks = shaft_curve(case, mechanism, case.need("operation").speed)
    name, sign = shaft_input(case, mechanism)
    force = AngleForce(name="torque", input=name, value=lambda phi: sign * curve(phi))
    return _bare(case, mechanism, forces=(force,), period=period, kinks=kinks)


def _bare(case: Case, mechanism: Mechanism, **acting: Any) -> Machine:
    taken = load_input(case)
    if not taken or sign_on_shaft(mechanism, taken) != -1:
        mechanism, taken = with_torque(mechanism, "M_r", -1.0), "M_r"
    return Machine(mechanism=mechanism, load_input=taken, omega=case.need("operation").speed, **acting)


def _with_gas(case: Case, mechanism: Mechanism) -> Machine:
    """A machine whose pistons the gas of `[cycle]` pushes."""
    burns = kind_of(case.need("cycle")).fired
    if not mechanisms.roles_of(case.mechanism).pistons:
        return _with_shared_gas(case, mechanism, burns)
    first, *others = acting = pistons(case, mechanism)
    # from a dead centre at the angle 0 on, a turn without combustion is known too
    if not others and first.start == 0.0:
        return _bare(case, mechanism, gas=first.gas, gas_input=first.input)
    names = [f"gas_{p.name}" if others else "gas" for p in acting]
    forces = tuple(
        AngleForce(name=n, input=p.input, value=p.force, formulas=p.gas.formulas(p.start))
        for n, p in zip(names, acting, strict=True)
    )
    several = tuple(firing_of(p.gas, p.input, p.start) for p in acting) if burns else ()
    period, kinks = common_period(acting), kinks_of(acting)
    by = {"period": period, "kinks": kinks, "several": several}
    return _bare(case, mechanism, gas=first.gas, gas_input="", forces=forces, **by)


def _with_shared_gas(case: Case, mechanism: Mechanism, burns: bool) -> Machine:
    """The same where the faces of a case, or the throws of a train, say which way the gas of one cylinder pushes."""
    acts = acting_on(case, drive_of(case))
    period = acts[0].gas.pressure.period
    starts = {one.face.fires for one in acts}
    kinks = sorted({(k + start) % period for start in starts for k in acts[0].gas.pressure.kinks})

    def force(key: str) -> AngleForce:
        return AngleForce(name=f"gas_{key}", input=key, value=lambda phi: pushes(acts, phi)[key])

    forces = tuple(map(force, pushes(acts, np.zeros(1))))
    fired = acts if burns else ()
    several = tuple(firing_of(a.gas, a.face.input, a.face.fires, a.face.area, a.face.sense) for a in fired)
    by = {"period": period, "kinks": tuple(kinks), "several": several}
    return _bare(case, mechanism, gas=acts[0].gas, gas_input="", forces=forces, **by)


def drive_of(case: Case) -> CrankDrive:
    """The mechanism of a case with every reaction determined."""
    parameters, roles = case.need("parameters"), mechanisms.roles_of(case.mechanism)
    closing = case.need("closing") if roles.closings else None
    faces = None
    if roles.chosen:
        faces = case.need("faces") if "cycle" in case.sections else case.sections.get("faces")
    mechanism = one_coordinate(case)
    with of(case):
        return drive_with(mechanism, case.mechanism, parameters, faces, closing)


def acting_on(case: Case, drive: CrankDrive) -> tuple[Acting, ...]:
    """The cylinders of a case with their gas: one for all that share it, else that of each piston."""
    if drive.roles.faces:
        gases = gas(case)
        with of(case):
            return acting(drive, gases)
    travels = {role.force: role.travel for role in drive.roles.pistons}
    return tuple(
        Acting(gas=one.gas, face=GasFace(input=one.input, travel=travels[one.input], fires=one.start))
        for one in pistons(case, drive.mechanism)
    )


def _with_besides(plain: Machine, inputs: Mapping[str, float], driven: bool) -> Machine:
    """The machine with constant inputs and dampers as a torque over the angle, and with its mean where that drives."""
    base = plain.mechanism
    if not any(inputs.values()) and not is_damped(base):
        return plain
    (q,) = base.coordinates

    def at_speed(phi: np.ndarray) -> np.ndarray:
        return evaluate(base, "dynamics", **{q: phi, f"{q}d": plain.omega}, **inputs)["generalized_force"]

    def extra(phi: np.ndarray) -> np.ndarray:
        return np.asarray(at_speed(phi) - evaluate(base, "dynamics", **{q: phi})["generalized_force"])

    torque = extra(_GRID)
    mean = float(np.mean(torque))
    mean = mean if abs(mean) > _ROUNDING * float(np.abs(torque).max()) else 0.0
    swings = float(np.abs(torque - mean).max()) > _ROUNDING * float(np.abs(at_speed(_GRID)).max())
    besides = AngleForce(name="besides", input="M_h", role="store", value=lambda phi: extra(phi) - mean)
    drive = AngleForce(name="drive", input="M_h", value=lambda phi: np.full(np.shape(phi), mean))
    forces = (*plain.forces, *((besides,) if swings else ()), *((drive,) if driven and mean else ()))
    return replace(plain, mechanism=with_torque(at_rest(base), "M_h"), forces=forces)


def mechanism_of(case: Case) -> Mechanism:
    """The mechanism of a case with all its coordinates and its flywheel; `[start]` gives the dependent ones guesses."""
    parameters, more = _weighed(case)
    mechanism = mechanisms.build(case.mechanism, parameters)
    given = {k: v for k, v in guesses(case).items() if k in mechanism.dependents}
    mechanism = replace(mechanism, dependents={**mechanism.dependents, **given}) if given else mechanism
    return with_inertia(mechanism, more) if more else mechanism


def one_coordinate(case: Case) -> Mechanism:
    """The mechanism with its first coordinate alone, for what turns at constant speed."""
    return turning(replace(case, sections={k: v for k, v in case.sections.items() if k != "flywheel"}))


def turning(case: Case, inertia: float = 0.0) -> Mechanism:
    """The mechanism of a case with one coordinate and its flywheel, and a further one [kg*m^2]."""
    parameters, more = _weighed(case, inertia)
    known = case.mechanism, content(case.mechanism), parameters, tuple(guesses(case).items())
    try:
        mechanism = _turning(*known)
    except BadInput as error:
        raise BadInput(f"{case.file}: {error}") from None
    return with_inertia(mechanism, more) if more else mechanism


def _weighed(case: Case, inertia: float = 0.0) -> tuple[Any, float]:
    """Parameters with flywheels in the inertia of the shaft, and what no parameter takes [kg*m^2]."""
    parameters = case.need("parameters")
    name = next((r.inertia for r in mechanisms.roles_of(case.mechanism).rotors if r.inertia), None)
    if name is None:
        return parameters, inertia + kept_flywheel(case)
    return replace(parameters, **{name: getattr(parameters, name) + inertia + kept_flywheel(case)}), 0.0


# what masses decide; sweeps over springs and loads ask for it again and again
@lru_cache(maxsize=16)
def _turning(name: str, _content: str, parameters: Record, guesses: tuple[tuple[str, float], ...]) -> Mechanism:
    return mechanisms.rigid(name, parameters, dict(guesses))


def kept_flywheel(case: Case) -> float:
    """Inertia of the flywheel that a case keeps, 0 without that section [kg*m^2]."""
    section = case.sections.get("flywheel")
    return 0.0 if section is None else section.inertia


def load(case: Case) -> Load:
    """The load law of a case: a constant load at the mean torque without that section."""
    return case.sections.get("load", ConstantLoad())


def load_input(case: Case) -> str:
    """The input that takes the load of a case, empty where its declaration names none."""
    return mechanisms.roles_of(case.mechanism).load


def constants(case: Case) -> dict[str, float]:
    """Constants of `[inputs]` [unit of the input]."""
    section = case.sections.get("inputs")
    return {} if section is None else asdict(section)


def acting_constants(case: Case, mechanism: Mechanism) -> dict[str, float]:
    """Constants of `[inputs]`, and the `[drive]` as it is at the end, by input [unit of the input]."""
    acting = constants(case)
    if "drive" in case.sections:
        drive = drive_on(case, mechanism)
        acting[drive.input] = drive.value
    return acting


@record
class DriveInput:
    """Where a `[drive]` acts."""

    input: str
    value: float  #: There [unit of the input]
    driving: float  #: Torque that this gives the shaft [N*m]


def drive_on(case: Case, mechanism: Mechanism) -> DriveInput:
    """The input that `[drive]` acts on, its value there, and the torque that this gives the shaft.

    A drive that names its input has its value there. One that does not drives: where the only torque is that of a load,
    which counts against the motion, it is the load's with the other sign.
    """
    drive: StepTorque = case.need("drive")
    name = drive.input or driving_input(case)
    sign = sign_on_shaft(mechanism, name) or 1.0
    value = drive.torque if drive.input else sign * drive.torque
    return DriveInput(input=name, value=value, driving=sign * value)


def driving_input(case: Case) -> str:
    """The input that a `[drive]` without one turns: the rotor's, or the only torque on a coordinate."""
    torques = driving_inputs(case.mechanism)
    if len(torques) != 1:
        units = mechanisms.listing(case.mechanism)["inputs"]
        raise BadInput(f"{case.file}: key drive.input is missing; inputs are {', '.join(units) or 'none'}")
    return torques[0]


def shaft_input(case: Case, mechanism: Mechanism) -> tuple[str, float]:
    """An input that is a torque on the first coordinate, and its sign there [-]."""
    declared = mechanisms.roles_of(case.mechanism).rotors
    rotors = [name for names in ([r.drive for r in declared], [r.load for r in declared]) for name in names if name]
    for name in dict.fromkeys([*rotors, *mechanism.inputs]):
        if sign := sign_on_shaft(mechanism, name):
            return name, sign
    raise BadInput(
        f"{case.file}: [torque] needs an input on the shaft; declare M = m.inputs('M', 'N*m') and "
        f"m.torque(M, along={mechanism.coordinates[0]})"
    )


def sign_on_shaft(mechanism: Mechanism, name: str) -> float:
    """1 for an input that is a torque on the first coordinate, -1 for one against it, 0 for any other [-]."""
    dynamics = mechanism.functions["dynamics"]
    if name not in dynamics.name_in():
        return 0.0
    at = {n: 0.3 for n in dynamics.name_in()}
    one, other = (np.asarray(dynamics(**{**at, name: v})["generalized_force"]).ravel() for v in (0.0, 1.0))
    change = np.round(other - one, 9)
    return float(change[0]) if abs(change[0]) == 1 and not change[1:].any() else 0.0


def turn(case: Case) -> Turn:
    """One cycle of a case.

    case: with `[operation]`; `[cycle]` gives the gas, `[torque]` a torque in its place, `[inputs]` what else acts;
    `[faces]` and `[closing]` belong to an overconstrained mechanism. Raises BadInput: a loop of the mechanism opens.
    """
    return _turn(at_recorded_speed(case))


def _turn(case: Case) -> Turn:
    drive, omega = drive_of(case), case.need("operation").speed
    acts, period, held = _what_acts(case, drive, omega)
    whole = at(drive, acts, omega, angles(period), held, period)
    curves: Mapping[str, np.ndarray] = {**whole.kinematics, **whole.reactions, "torque": whole.torque}
    opened = ~np.all([np.isfinite(v) for v in curves.values()], axis=0)
    if opened.any():
        (q,) = drive.mechanism.coordinates
        at_angle = f"{q} = {np.degrees(whole.phi[np.argmax(opened)]):.3f} deg"
        raise BadInput(
            f"{case.file}: the loop opens at {at_angle}: links too short, or a wrong branch; it cannot turn round"
        )
    return whole


def torque(case: Case) -> np.ndarray:
    """Torque for the load over one cycle of a case, without the reactions: shape (n,) [N*m]."""
    drive, omega = drive_of(case), case.need("operation").speed
    acts, period, held = _what_acts(case, drive, omega)
    return shaft_torque(drive, acts, omega, angles(period), held)


def _what_acts(case: Case, drive: CrankDrive, omega: float) -> tuple[tuple[Acting, ...], float, dict[str, np.ndarray]]:
    """Cylinders, the period of all that acts [rad], and what acts besides by input."""
    acts, (curve, of_curve, _) = acting_on(case, drive), shaft_curve(case, drive.mechanism, omega)
    # a mechanism with loops may repeat after several turns of its first coordinate only
    looped = mechanisms.listing(case.mechanism).get("dependents")
    period = max(period_of(acts), of_curve) * (along_turn(mechanism_of(case))[1] if looped else 1)
    phi = angles(period)
    held = {name: np.full_like(phi, value) for name, value in constants(case).items() if value}
    if "torque" in case.sections:
        name, sign = shaft_input(case, drive.mechanism)
        held[name] = held.get(name, np.zeros_like(phi)) + sign * curve(phi)
    return acts, period, held


def fitted_law(case: Case, omega: Sequence[RadPerSecond]) -> FittedLaw:
    """The friction of a case's joints and rings as a law of the cycle.

    case: with `[cycle]` and `[friction]`, perhaps `[rings]`. omega: crank speeds; a single one gives a constant. Raises
    BadInput: the case has no cycle.
    """
    if "cycle" not in case.sections:
        raise BadInput(f"{case.file}: a friction mean pressure needs a [cycle]")
    operation = case.need("operation")
    cases = [replace(case, sections={**case.sections, "operation": replace(operation, speed=w)}) for w in omega]
    return fit([_turn(one) for one in cases], case.need("friction"), case.sections.get("rings", NoRings()))
