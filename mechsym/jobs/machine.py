"""Case -> machine: mechanism with the flywheel that is kept, gas of the cycle, load, speed of operation."""

import functools
from dataclasses import replace
from typing import Any

from mechsym import mechanisms
from mechsym.cases import Case
from mechsym.cycle.gas import Gas, gas_in_cylinder
from mechsym.cycle.kinds import kind_of, with_diagram
from mechsym.errors import BadInput
from mechsym.jobs import own, own_machine
from mechsym.jobs.gas import at_recorded_speed, gas
from mechsym.jobs.own import is_own
from mechsym.jobs.scavenge import scavenged, told
from mechsym.machine.loads import ConstantLoad, Load
from mechsym.machine.record import Machine
from mechsym.mechanisms.record import Mechanism
from mechsym.mechanisms.traits import with_chain, with_hinge


def machine(case: Case, diagram: str | None = None) -> Machine:
    """The engine of a case, ready to turn.

    Parameters
    ----------
    case : Case
        With sections parameters, operation, cycle and perhaps flywheel and load
    diagram : str, optional
        CSV file of a measured diagram in place of the case's cycle

    Raises
    ------
    BadInput
        Another mechanism, or a cycle that cannot be made

    Examples
    --------
    >>> from mechsym import cases
    >>> round(machine(cases.load("zotov-89")).omega, 4)
    9.3201
    """
    if is_own(case.mechanism):
        return own_machine.machine(case)
    if case.mechanism not in with_hinge():
        raise BadInput(
            f"{case.file}: a hinge is designed for the mechanism {' or '.join(with_hinge())}, not for {case.mechanism}"
        )
    cycle = case.need("cycle")
    if diagram is not None:
        cycle = with_diagram(cycle, diagram)
    case = at_recorded_speed(replace(case, sections={**case.sections, "cycle": cycle}))
    parameters = heavier(case)[0].need("parameters")
    if kind_of(cycle).given == "breathing":
        found = gas(case)
        assert found is not None
        mechanism = mechanisms.build(case.mechanism, parameters)
        return Machine(mechanism=mechanism, gas=found, load=load(case), omega=case.need("operation").speed)
    at, state = scavenged(case)
    # a diagram is read from a file, which may have changed since
    make = _parts.__wrapped__ if kind_of(cycle).measured else _parts
    mechanism, found = make(case.mechanism, parameters, at.need("cycle"))
    return Machine(mechanism=mechanism, gas=told(found, state), load=load(case), omega=case.need("operation").speed)


@functools.lru_cache(maxsize=8)
def _parts(name: str, parameters: Any, cycle: Any) -> tuple[Mechanism, Gas]:
    """What masses and cycle decide; sweeps over springs and loads ask for it again and again."""
    mechanism = mechanisms.build(name, parameters)
    return mechanism, gas_in_cylinder(cycle, mechanism.functions["kinematics"])


def kept_flywheel(case: Case) -> float:
    """Inertia of the flywheel that a case keeps.

    Returns
    -------
    inertia : float
        0 without that section [kg*m^2]
    """
    section = case.sections.get("flywheel")
    return 0.0 if section is None else section.inertia


def heavier(case: Case, inertia: float = 0.0) -> tuple[Case, str]:
    """The case with its flywheel, and a further one, in the inertia of its shaft; and the input that brakes it.

    Parameters
    ----------
    inertia : float
        Of a flywheel on top of what the case has [kg*m^2]

    Raises
    ------
    BadInput
        A mechanism whose shaft is not known
    """
    rotor = next((r for r in own.roles(case, "rotor") if "inertia" in r), None)
    if rotor is None or case.mechanism not in with_chain():
        raise BadInput(f"{case.file}: a flywheel is sized for the mechanisms {', '.join(with_chain())}")
    name, load_input = rotor["inertia"], rotor["load"] or rotor["drive"]
    parameters = case.need("parameters")
    heavy = replace(parameters, **{name: getattr(parameters, name) + inertia + kept_flywheel(case)})
    return replace(case, sections={**case.sections, "parameters": heavy}), load_input


def load(case: Case) -> Load:
    """The load law of a case: a constant load at the mean torque without that section."""
    return case.sections.get("load", ConstantLoad())
