"""What is ready to turn: a mechanism with the gas on its piston, what else acts over the angle, a load, and a speed.

gas ---F---> [ mechanism ] <---M_r--- load
                  ^
                  '---- forces over the angle: a hinge, a drive
"""

from collections.abc import Callable

import numpy as np

from mechsym.cycle.gas import Gas
from mechsym.errors import BadInput
from mechsym.machine.loads import ConstantLoad, Load
from mechsym.mechanisms.record import Mechanism
from mechsym.page import Shown
from mechsym.quantities import choice, quantity, record

_TURN = 2 * np.pi


@record
class AngleForce:
    """A force or torque that depends on the crank angle only."""

    name: str
    input: str  #: The mechanism's input it acts on
    #: `drive` counts as work in, `store` (a spring) does not
    role: str = choice("drive", "store", default="drive", about="side of the energy balance")
    value: Callable[[np.ndarray], np.ndarray]  #: phi, ndarray (n,), to values (n,) in the unit of the input
    #: The same for one float, where there is a fast way; without it a polynomial is fitted to round-off
    point: Callable[[float], float] | None = None


@record
class Machine(Shown):
    """A mechanism with one coordinate, what drives it and what it drives."""

    mechanism: Mechanism  #: No dampers; a flywheel belongs into its parameters
    gas: Gas | None = None
    gas_input: str = "F"  #: Input that takes the gas force
    forces: tuple[AngleForce, ...] = ()  #: What acts besides the gas
    load: Load = ConstantLoad()
    load_input: str = "M_r"  #: Input that takes the load torque, positive against the motion
    omega: float = quantity("rad/s", default=0.0, low=0, about="speed of operation, 0 where none is meant")
    period: float = quantity("rad", default=_TURN, above=0, about="period of the forces besides the gas")
    kinks: tuple[float, ...] = ()  #: Where one of them is not smooth, in [0, period) [rad]

    def __post_init__(self) -> None:
        mechanism = self.mechanism
        if len(mechanism.coordinates) != 1:
            raise BadInput(f"{mechanism.name} has {len(mechanism.coordinates)} coordinates; an engine has one")
        used = [self.load_input, *(f.input for f in self.forces), *([self.gas_input] if self.gas else [])]
        for name in used:
            if name not in mechanism.inputs:
                known = ", ".join(mechanism.inputs)
                raise BadInput(f"{mechanism.name} has no input {name!r}; its inputs are {known}")


def gas_of(machine: Machine) -> Gas:
    """The gas of a machine that cannot do without."""
    if machine.gas is None:
        raise BadInput(f"{machine.mechanism.name}: no gas drives it; give a cycle")
    return machine.gas


def acting(machine: Machine) -> tuple[AngleForce, ...]:
    """All forces over the angle, the gas first."""
    if machine.gas is None:
        return machine.forces
    gas = AngleForce(name="gas", input=machine.gas_input, role="drive", value=machine.gas.force)
    return (gas, *machine.forces)


def period_of(machine: Machine) -> float:
    """Period of all that acts.

    Returns
    -------
    period : float
        That of the gas, which the other forces share; without gas their own [rad]
    """
    return machine.period if machine.gas is None else machine.gas.pressure.period


def kinks_of(machine: Machine) -> tuple[float, ...]:
    """Angles at which what acts is not smooth.

    Returns
    -------
    kinks : tuple of float
        In [0, period) [rad]
    """
    own = () if machine.gas is None else machine.gas.pressure.kinks
    return tuple(sorted({*own, *machine.kinks}))
