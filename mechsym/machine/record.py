"""What is ready to turn: a mechanism with the gas on its piston, what else acts over the angle, a load, and a speed.

gas ---F---> [ mechanism ] <---M_r--- load
                  ^
                  '---- forces over the angle: gas of further pistons, a drive, a hinge
"""

from collections.abc import Callable
from functools import lru_cache

import casadi as ca
import numpy as np

from mechsym.cycle.gas import Gas
from mechsym.cycle.pressure import Pieces
from mechsym.errors import BadInput
from mechsym.machine.loads import ConstantLoad, Load
from mechsym.mechanisms.arrays import along
from mechsym.mechanisms.record import Mechanism
from mechsym.page import Shown
from mechsym.quantities import choice, quantity, record
from mechsym.quantities.units import Area, Pure, Radian

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
    formulas: Pieces = ()  #: The same over a period for a CasADi symbol; none where a table or an integration makes it


@record
class Firing:
    """A cylinder whose combustion can be lost."""

    input: str  #: Takes its force
    force: Callable[[np.ndarray], np.ndarray]  #: Over the angle from its firing dead centre, grows with pressure [N]
    period: float  #: Of its cycle [rad]
    start: float = 0.0  #: Crank angle of that dead centre [rad]
    sense: float = 1.0  #: 1 where the input takes the force as it is, -1 where against it [-]
    kinks: tuple[float, ...] = ()  #: Where the force is not smooth [rad]


def firing_of(gas: Gas, name: str, start: Radian, area: Area | None = None, sense: Pure = 1.0) -> Firing:
    """A cylinder by its gas; name: of the input, start: of its firing, area: of its face where not the piston's."""
    pressure, face = gas.pressure, gas.chamber.area if area is None else area
    return Firing(
        input=name, force=lambda phi: (pressure.absolute(phi) - gas.p_back) * face, period=pressure.period, start=start,
        sense=sense, kinks=tuple(pressure.kinks),
    )  # fmt: skip


@record
class Machine(Shown):
    """A mechanism with one coordinate, what drives it and what it drives."""

    mechanism: Mechanism  #: No dampers; a flywheel belongs into it
    gas: Gas | None = None  #: Of its only piston, or of the first of several
    gas_input: str = "F"  #: Input that takes the gas force; empty where `forces` has the gas, piston by piston
    forces: tuple[AngleForce, ...] = ()  #: What acts besides the gas
    load: Load = ConstantLoad()
    load_input: str = "M_r"  #: Input that takes the load torque, positive against the motion
    omega: float = quantity("rad/s", default=0.0, low=0, about="speed of operation, 0 where none is meant")
    period: float = quantity("rad", default=_TURN, above=0, about="period of the forces besides the gas")
    kinks: tuple[float, ...] = ()  #: Where one of them is not smooth, in [0, period) [rad]
    several: tuple[Firing, ...] = ()  #: Cylinders in which fuel burns, where there is more than `gas_input` takes

    def __post_init__(self) -> None:
        mechanism = self.mechanism
        if len(mechanism.coordinates) != 1:
            raise BadInput(f"{mechanism.name} has {len(mechanism.coordinates)} coordinates; an engine has one")
        for name in (self.load_input, *(f.input for f in acting(self))):
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
    if machine.gas is None or not machine.gas_input:
        return machine.forces
    gas = AngleForce(name="gas", input=machine.gas_input, value=machine.gas.force, formulas=machine.gas.formulas())
    return (gas, *machine.forces)


def only_gas(machine: Machine) -> Gas | None:
    """The gas where nothing else drives: one piston, whose compression line about angle 0 is known."""
    alone = machine.gas_input and all(force.role != "drive" for force in machine.forces)
    return machine.gas if alone else None


def firings(machine: Machine) -> tuple[Firing, ...]:
    """The cylinders whose combustion can be lost; none where no compression line is known."""
    gas = only_gas(machine)
    if gas is None or not machine.gas_input:
        return machine.several
    pressure = gas.pressure
    return (Firing(input=machine.gas_input, force=gas.force, period=pressure.period, kinks=tuple(pressure.kinks)),)


@lru_cache(maxsize=64)
def lever(mechanism: Mechanism, name: str) -> Callable[[np.ndarray], np.ndarray]:
    r"""What an input gives the shaft by the principle of virtual work: a torque 1 [-], a force its x' [m/rad].

    .. math:: \partial Q / \partial F = \mathrm{d}x / \mathrm{d}\varphi
    """
    dynamics, (q,) = mechanism.functions["dynamics"], mechanism.coordinates
    letters = {n: ca.SX.sym(n) for n in dynamics.name_in()}
    slope = ca.jacobian(dynamics(**letters)["generalized_force"], letters[name])
    others = ca.vertcat(*(symbol for n, symbol in letters.items() if n != q))
    slope = ca.substitute(slope, others, ca.DM.zeros(others.shape))
    function = ca.Function("lever", [letters[q]], [slope], [q], ["lever"])
    return lambda phi: along(function, {q: phi})["lever"]


def shaft_torque(machine: Machine, role: str, phi: np.ndarray) -> np.ndarray:
    """Torque on the shaft of the forces with a role, in the sense of rotation, over crank angles [rad]: [N*m]."""
    of_role = (force for force in acting(machine) if force.role == role)
    shares = (force.value(phi) * lever(machine.mechanism, force.input)(phi) for force in of_role)
    return np.asarray(sum(shares, np.zeros(np.shape(phi))))


def period_of(machine: Machine) -> Radian:
    """Period of all that acts: that of the gas on the only piston, which the other forces share; else their own."""
    return machine.gas.pressure.period if machine.gas is not None and machine.gas_input else machine.period


def kinks_of(machine: Machine) -> tuple[Radian, ...]:
    """Angles at which what acts is not smooth. Returns kinks: in [0, period)."""
    own = machine.gas.pressure.kinks if machine.gas is not None and machine.gas_input else ()
    return tuple(sorted({*own, *machine.kinks}))
