"""An engine put together from a case: mechanism, cylinder pressure, what the hinge has to balance, and what runs."""

import functools
from collections.abc import Callable
from typing import Any

import numpy as np

from mechsym import mechanisms
from mechsym.cases import Case
from mechsym.cycle.cylinder import Cylinder, piston_area
from mechsym.cycle.kinds import back_pressure, cylinder_pressure, with_diagram
from mechsym.cycle.measured.diagram import Diagram
from mechsym.cycle.pressure import Pressure, piston_force
from mechsym.errors import BadInput
from mechsym.hinge import torque as hinge
from mechsym.hinge.guide import Guide, Spring, crank_torque, torque_function
from mechsym.hinge.torque import EngineTorques, Hinge
from mechsym.machine.loads import ConstantLoad, Load, settle
from mechsym.mechanisms.crosshead import with_flywheel
from mechsym.mechanisms.record import Mechanism
from mechsym.quantities import record
from mechsym.simulate.engine import AngleForce, Engine


@record
class Assembly:
    """An engine of a case."""

    case: Case
    mechanism: Mechanism  #: Crosshead engine, with the flywheel of the case
    pressure: Pressure
    cylinder: Cylinder
    #: Absolute pressure under the piston [Pa], piston area [m^2]
    p_back: float
    area: float
    force: Callable[[np.ndarray], np.ndarray]  #: phi, ndarray (n,), to the net gas force F on the piston [N]
    torques: EngineTorques  #: What the hinge has to balance
    omega: float  #: Speed of operation [rad/s]


def assemble(case: Case, diagram: str | None = None) -> Assembly:
    """Put an engine together.

    Parameters
    ----------
    case : Case
        With sections parameters, operation, cycle and perhaps flywheel
    diagram : str, optional
        CSV file of a measured diagram in place of the case's cycle

    Raises
    ------
    BadInput
        Another mechanism, or a cycle that cannot be made
    """
    if case.mechanism != "crosshead":
        raise BadInput(f"{case.file}: a hinge is designed for the mechanism crosshead, not for {case.mechanism}")
    cycle = case.need("cycle")
    if diagram is not None:
        cycle = with_diagram(cycle, diagram)
    parameters = with_flywheel(case.need("parameters"), kept_flywheel(case))
    # a diagram is read from a file, which may have changed since
    make = _parts.__wrapped__ if isinstance(cycle, Diagram) else _parts
    return Assembly(case=case, omega=case.need("operation").speed, **make(case.mechanism, parameters, cycle))


@functools.lru_cache(maxsize=8)
def _parts(name: str, parameters: Any, cycle: Any) -> dict[str, Any]:
    """What the cycle and the masses decide; sweeps over springs and loads ask for it again and again."""
    mechanism = mechanisms.build(name, parameters)
    pressure, cylinder = cylinder_pressure(cycle, mechanism.functions["kinematics"])
    p_back, area = back_pressure(cycle), piston_area(cycle.bore)

    def force(phi: np.ndarray) -> np.ndarray:
        return piston_force(pressure, p_back, area, phi)

    return {
        "mechanism": mechanism,
        "pressure": pressure,
        "cylinder": cylinder,
        "p_back": p_back,
        "area": area,
        "force": force,
        "torques": hinge.engine_torques(mechanism, force, pressure.kinks, pressure.period),
    }


def kept_flywheel(case: Case) -> float:
    """Inertia of the flywheel that a case keeps.

    Returns
    -------
    inertia : float
        0 without that section [kg*m^2]
    """
    section = case.sections.get("flywheel")
    return 0.0 if section is None else section.inertia


def running(
    assembly: Assembly, wanted: Hinge, load: Any, guide: Guide | None = None, spring: Spring | None = None
) -> Engine:
    """The engine ready to run, with or without hinge; the hinge's torque comes from guide and spring.

    Parameters
    ----------
    wanted : Hinge
        Gives the mean torque for a load law without numbers
    guide : Guide, optional
        Guide that could be cut; none runs the engine without hinge
    spring : record of mechsym.springs, optional
        Spring in the guide; by default the one it was cut for
    """
    forces = [AngleForce(name="gas", input="F", role="drive", value=assembly.force)]
    if guide is not None:
        inside = guide.spring if spring is None else spring
        value = torque_function(guide, inside)
        torque = AngleForce(
            name="hinge", input="M_h", role="store", value=lambda phi: crank_torque(guide, inside, phi), point=value
        )
        forces.append(torque)
    return Engine(
        mechanism=assembly.mechanism,
        forces=tuple(forces),
        load=settle(load, wanted.load_torque, assembly.omega),
        period=assembly.pressure.period,
        kinks=assembly.pressure.kinks,
    )


def load_of(case: Case) -> Load:
    """The load law of a case.

    Returns
    -------
    load : record of mechsym.loads
        Constant load at the mean torque without that section
    """
    return case.sections.get("load", ConstantLoad())
