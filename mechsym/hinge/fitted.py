"""A machine with its hinge: the load settled at what the engine can drive, the torque from guide and spring."""

from dataclasses import replace

from mechsym.hinge.guide import Guide, crank_torque, kept_torque, torque_function
from mechsym.hinge.torque import Hinge
from mechsym.machine.loads import settle
from mechsym.machine.record import AngleForce, Machine
from mechsym.mechanisms.shaft_inertia import with_torque
from mechsym.quantities.units import NewtonMetre


def fitted(machine: Machine, wanted: Hinge, guide: Guide | None = None, lost: NewtonMetre = 0.0) -> Machine:
    """The machine ready to run, with or without hinge.

    wanted: gives the mean torque for a load law without numbers. guide: guide that could be cut, with the spring that
    works in it; none leaves the machine without hinge. lost: mean torque that friction of the hinge takes from such a
    load.
    """
    if guide is None:
        return replace(machine, load=settle(machine.load, wanted.load_torque, machine.omega))
    # a gas with a state runs at the speed of the machine, whatever the guide was cut for
    guide = replace(guide, omega=machine.omega)
    load = settle(machine.load, wanted.load_torque - kept_torque(guide) - lost, machine.omega)
    hinge = AngleForce(
        name="hinge",
        input="M_h",
        role="store",
        value=lambda phi: crank_torque(guide, phi),
        point=torque_function(guide),
    )
    place = with_torque(machine.mechanism, hinge.input)
    return replace(machine, mechanism=place, load=load, forces=(*machine.forces, hinge))
