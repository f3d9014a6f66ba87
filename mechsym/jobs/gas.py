"""Gas of a case: its engine as one cylinder sees it, and the pressure on the pistons, whatever kind of cycle it has."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import asdict, replace

from mechsym import cycle as cycles
from mechsym.cases import Case
from mechsym.cycle.breathing.engine import BreathingEngine
from mechsym.cycle.breathing.engine import pressure as breathing_pressure
from mechsym.cycle.breathing.engine import run as run_breathing
from mechsym.cycle.closed.model import ClosedEngine
from mechsym.cycle.friction import Friction, NoFriction
from mechsym.cycle.gas import Gas, gas_in_cylinder
from mechsym.cycle.heat import Adiabatic
from mechsym.cycle.kinds import kind_of, with_diagram
from mechsym.cycle.measured.diagram import Diagram, period_of
from mechsym.cycle.measured.file import read_diagram
from mechsym.cycle.measured.timing import recorded_speed
from mechsym.cycle.mixture import ConstantGamma
from mechsym.cycle.motion import one_cylinder as seen_by_one
from mechsym.cycle.motion import piston_motion, piston_travel
from mechsym.cycle.pressure import ATMOSPHERE
from mechsym.errors import BadInput
from mechsym.jobs.scavenge import scavenged, told
from mechsym.jobs.starts import guesses


@contextmanager
def of(case: Case) -> Iterator[None]:
    """Puts the file of a case before what physics has to say about its data."""
    try:
        yield
    except BadInput as error:
        raise BadInput(f"{case.file}: {error}") from None


def gas(case: Case) -> Gas | None:
    """Gas of a case.

    Returns
    -------
    gas : Gas or None
        None for a case without a cycle: only inertia and weight act

    Examples
    --------
    >>> from mechsym import cases
    >>> round(gas(cases.load("zotov-89")).pressure.mean_indicated)
    800000
    """
    if "cycle" not in case.sections:
        return None
    cycle = case.sections["cycle"]
    given = kind_of(cycle).given
    if given == "train":
        with of(case):
            speed = case.need("operation").speed
            from mechsym.cycle.gas_of_train import gas_of_train

            return gas_of_train(cycle, case.need("parameters"), speed, case.sections.get("stirling"))
    seen = one_cylinder(case)
    if given == "engine":
        return cycles.gas_of_engine(engine_with(seen, NoFriction()), case.need("operation").speed)
    if given == "breathing":
        with of(case):
            found = run_breathing(breathing_with(seen, NoFriction()), [case.need("operation").speed])
        return Gas(pressure=breathing_pressure(found), chamber=found.chamber)
    with of(case):
        travel = piston_travel(seen.mechanism, seen.need("parameters"), guesses(case))
    at, state = scavenged(case)
    return told(gas_in_cylinder(at.need("cycle"), travel), state)


def one_cylinder(case: Case) -> Case:
    """The case as one cylinder of it sees itself.

    Returns
    -------
    case : Case
        With a mechanism that has one piston and its travel as `x`
    """
    parameters = case.need("parameters")
    with of(case):
        name, parameters = seen_by_one(case.mechanism, parameters)
    return replace(case, mechanism=name, sections={**case.sections, "parameters": parameters})


def engine_with(case: Case, friction: Friction, number: int = 0) -> ClosedEngine:
    """The engine that a case describes, with a friction law whose numbers are known.

    Parameters
    ----------
    case : Case
        With sections `[parameters]`, `[chamber]`, `[cycle]` and `[heat_transfer]`; `[gas]` defaults to a constant gamma
    number : int
        Place of its role in the declaration, from 0

    Raises
    ------
    BadInput
        A section is missing, or the cycle is of another kind
    """
    cycle = case.need("cycle")
    if kind_of(cycle).given != "engine":
        why = "[cycle] kind must be 'spark-ignition' for this command; 'mechsym check' tells which take the case"
        raise BadInput(f"{case.file}: {why}")
    with of(case):
        motion = piston_motion(case.mechanism, asdict(case.need("parameters")), guesses(case), number)
    return ClosedEngine(
        chamber=case.need("chamber"),
        motion=motion,
        cycle=cycle,
        gas=case.sections.get("gas", ConstantGamma()),
        heat_transfer=case.need("heat_transfer"),
        friction_pressure=friction,
    )


def breathing_with(case: Case, friction: Friction, number: int = 0) -> BreathingEngine:
    """The engine with gas exchange that a case describes, with a friction law whose numbers are known.

    Parameters
    ----------
    case : Case
        With sections `[parameters]`, `[chamber]`, `[cycle]` and `[breathing]`; `[boost]` is a turbocharger, and without
        `[heat_transfer]` no heat is lost
    number : int
        Place of its role in the declaration, from 0
    """
    return BreathingEngine(
        chamber=case.need("chamber"),
        motion=piston_motion(case.mechanism, asdict(case.need("parameters")), guesses(case), number),
        cycle=case.need("cycle"),
        breathing=case.need("breathing"),
        boost=case.sections.get("boost"),
        heat_transfer=case.sections.get("heat_transfer", Adiabatic()),
        friction_pressure=friction,
    )


def at_recorded_speed(case: Case) -> Case:
    """The case at the speed that the times of its measured diagram tell, unless the user has set another.

    Parameters
    ----------
    case : Case
        With a cycle of any kind; one without times, or without a file, stays as it is
    """
    cycle = case.sections.get("cycle")
    overridden = any(key.rpartition(".")[2].startswith("speed") for key in case.overrides)
    if not isinstance(cycle, Diagram) or not cycle.file or overridden or "operation" not in case.sections:
        return case
    omega = recorded_speed(read_diagram(cycle.file, period_of(cycle), cycle.angle_column, cycle.pressure_column))
    if omega is None:
        return case
    return replace(case, sections={**case.sections, "operation": replace(case.need("operation"), speed=omega)})


def measured(case: Case, file: str) -> Case:
    """The case with a measured diagram in place of its cycle.

    Parameters
    ----------
    case : Case
        With `[cycle]`; of spark ignition `[chamber]` gives the cylinder
    """
    cycle = case.need("cycle")
    if kind_of(cycle).given in ("engine", "breathing"):
        room = case.need("chamber")
        cycle = Diagram(
            bore=room.bore,
            compression_ratio=room.compression_ratio,
            working_cycle="four-stroke",
            inlet_pressure=getattr(cycle, "intake_pressure", ATMOSPHERE),
            p_back=room.back_pressure,
        )
    return at_recorded_speed(replace(case, sections={**case.sections, "cycle": with_diagram(cycle, file)}))
