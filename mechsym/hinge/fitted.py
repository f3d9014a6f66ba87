"""A machine with its hinge: the load settled at what the engine can drive, the torque from guide and spring."""

from dataclasses import replace

from mechsym.hinge.guide import Guide, crank_torque, kept_torque, torque_function
from mechsym.hinge.thermal import AirThermal
from mechsym.hinge.torque import Hinge
from mechsym.machine.loads import settle
from mechsym.machine.record import AngleForce, Machine


def fitted(machine: Machine, wanted: Hinge, guide: Guide | None = None, lost: float = 0.0) -> Machine:
    """The machine ready to run, with or without hinge.

    Parameters
    ----------
    wanted : Hinge
        Gives the mean torque for a load law without numbers
    guide : Guide, optional
        Guide that could be cut, with the spring that works in it; none leaves the machine without hinge
    lost : float
        Mean torque that friction of the hinge takes from such a load [N*m]
    """
    if guide is None:
        return replace(machine, load=settle(machine.load, wanted.load_torque, machine.omega))
    if isinstance(guide.spring, AirThermal):  # its gas runs at the speed of the machine, whatever the guide was cut for
        guide = replace(guide, omega=machine.omega)
    load = settle(machine.load, wanted.load_torque - kept_torque(guide) - lost, machine.omega)
    hinge = AngleForce(
        name="hinge",
        input="M_h",
        role="store",
        value=lambda phi: crank_torque(guide, phi),
        point=torque_function(guide),
    )
    return replace(machine, load=load, forces=(*machine.forces, hinge))
