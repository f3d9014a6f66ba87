r"""A machine over one cycle at constant speed: gas forces, exact reactions, and the power that they must balance.

At constant speed the load must take, at every angle, what gas and weight give and the moving masses do not store:

.. math:: M_\mathrm{load}\,\omega = P_\mathrm{gas} - \frac{d}{dt}(T + V)

The same torque follows from the forces on the crank alone; their difference is the power residual.
"""

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import casadi as ca
import numpy as np

from mechsym import mechanisms
from mechsym.errors import BadInput
from mechsym.mechanisms.arrays import along
from mechsym.mechanisms.chain import CrankChain
from mechsym.mechanisms.record import Mechanism
from mechsym.mechanisms.traits import traits_of, with_chain
from mechsym.quantities import record

if TYPE_CHECKING:
    from mechsym.cycle.gas import Gas

_STEPS_PER_TURN = 1440


@record
class CrankDrive:
    """A mechanism with pistons as its force chain sees it."""

    name: str
    parameters: Any  #: The mechanism's record
    mechanism: Mechanism  #: With one coordinate and all reactions
    #: Working faces, and how the parts of an overconstrained mechanism give way; None for the others
    faces: Any = None
    closing: Any = None


@record
class Turn:
    """One cycle at constant speed, evenly spaced angles without the last."""

    drive: CrankDrive
    gas: "Gas | None"
    #: Crank speed [rad/s], period of the cycle [rad]
    omega: float
    period: float
    phi: np.ndarray  #: shape (n,): Crank angles [rad]
    inputs: Mapping[str, np.ndarray]  #: shape (n,): Gas forces by the mechanism's input [N]
    #: shape (n,): Outputs of the mechanism at these angles
    kinematics: Mapping[str, np.ndarray]
    reactions: Mapping[str, np.ndarray]
    momentum: Mapping[str, np.ndarray]
    torque: np.ndarray  #: shape (n,): Torque for the load, from the energies [N*m]
    gas_power: np.ndarray  #: shape (n,): Power of the gas forces [W]

    # a turn is itself: what is computed of it is kept by identity
    __hash__ = object.__hash__


def turn(drive: CrankDrive, gas: "Gas | None", omega: float) -> Turn:
    """One cycle at a speed.

    Parameters
    ----------
    gas : Gas or None
        None: only inertia and weight act
    omega : float
        Crank speed [rad/s]
    """
    return at(drive, gas, omega, angles(gas))


def crank_drive(name: str, parameters: Any, faces: Any = None, closing: Any = None) -> CrankDrive:
    """A mechanism with one coordinate and every reaction determined.

    Parameters
    ----------
    parameters : record
        Of the mechanism of that name; a crank train stands on a rigid shaft
    faces : record, optional
        Where gas acts, for a mechanism that has a choice
    closing : closing rule, optional
        What an overconstrained mechanism needs besides
    """
    rigid = chain_named(name).rigid
    mechanism = mechanisms.build(name, parameters) if rigid is None else rigid(parameters, closing)
    return CrankDrive(name=name, parameters=parameters, mechanism=mechanism, faces=faces, closing=closing)


def chain_of(drive: CrankDrive) -> CrankChain:
    """What the module of a drive's mechanism says of its forces."""
    return chain_named(drive.name)


def chain_named(name: str) -> CrankChain:
    """What the module of a mechanism says of its forces.

    Raises
    ------
    BadInput
        It has none, or says nothing of them
    """
    known = traits_of(name)
    if known is None or known.chain is None:
        raise BadInput(f"forces of {name} are not known; there are {', '.join(with_chain())}")
    return known.chain


def at(drive: CrankDrive, gas: "Gas | None", omega: float, phi: np.ndarray) -> Turn:
    """Forces of a mechanism at given angles.

    Parameters
    ----------
    omega : float
        Crank speed [rad/s]
    phi : ndarray, shape (n,)
        Crank angles, evenly spaced over a period [rad]
    """
    inputs, mechanism = pushes(drive, gas, phi), drive.mechanism
    letters = _letters(mechanism, omega, phi) | inputs
    kinematics, reactions, momentum = (
        _along(mechanism.functions[name], letters) for name in ("kinematics", "reactions", "momentum")
    )
    work, slope = _work_and_slope(mechanism, letters)
    return Turn(
        drive=drive,
        gas=gas,
        omega=omega,
        period=gas.pressure.period if gas else 2 * math.pi,
        phi=phi,
        inputs=inputs,
        kinematics=kinematics,
        reactions=reactions,
        momentum=momentum,
        torque=work - slope,
        gas_power=work * omega,
    )


def shaft_torque(drive: CrankDrive, gas: "Gas | None", omega: float) -> np.ndarray:
    """Torque for the load over a cycle, without the reactions.

    Parameters
    ----------
    omega : float
        Crank speed [rad/s]

    Returns
    -------
    torque : ndarray, shape (n,)
        As `Turn.torque` [N*m]
    """
    phi = angles(gas)
    work, slope = _work_and_slope(drive.mechanism, _letters(drive.mechanism, omega, phi) | pushes(drive, gas, phi))
    return work - slope


def angles(gas: "Gas | None") -> np.ndarray:
    """Evenly spaced angles of a cycle without the last [rad]."""
    period = gas.pressure.period if gas else 2 * math.pi
    steps = round(_STEPS_PER_TURN * period / (2 * math.pi))
    return np.arange(steps) * period / steps


def _work_and_slope(mechanism: Mechanism, letters: Mapping[str, np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    work = _along(_virtual_work(mechanism), letters)["gas"]
    return work, _along(_energy_slope(mechanism), letters)["slope"]


def _letters(mechanism: Mechanism, omega: float, phi: np.ndarray) -> dict[str, np.ndarray]:
    q = mechanism.coordinates[0]
    none = np.zeros_like(phi)
    return {q: phi, f"{q}d": none + omega, f"{q}dd": none} | dict.fromkeys(mechanism.inputs, none)


def pushes(drive: CrankDrive, gas: "Gas | None", phi: np.ndarray) -> dict[str, np.ndarray]:
    """Gas forces by the input of the mechanism that takes them [N].

    Parameters
    ----------
    phi : ndarray, shape (n,)
        Crank angles [rad]
    """
    if gas is None:
        return {}

    def net(angle: np.ndarray) -> np.ndarray:
        return gas.pressure.absolute(angle) - gas.p_back

    if gas.pistons:
        return {f"F{i + 1}": net(phi) * area for i, area in enumerate(gas.pistons)}
    return chain_of(drive).pushes(drive, net, gas.chamber.area, phi, gas.pressure.period)


def _along(function: ca.Function, letters: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    return along(function, {name: letters[name] for name in function.name_in()})


def _virtual_work(mechanism: Mechanism) -> ca.Function:
    """Torque of the gas forces alone: generalised force with them less without them."""
    dynamics = mechanism.functions["dynamics"]
    letters = {n: ca.SX.sym(n) for n in dynamics.name_in()}
    force = dynamics(**letters)["generalized_force"]
    loads = [n for n in mechanism.inputs if n not in gas_inputs(mechanism)]
    given = ca.substitute(force, ca.vertcat(*(letters[n] for n in loads)), ca.DM.zeros(len(loads)))
    names = gas_inputs(mechanism)
    idle = ca.substitute(given, ca.vertcat(*(letters[n] for n in names)), ca.DM.zeros(len(names)))
    return ca.Function("work", list(letters.values()), [given - idle], list(letters), ["gas"])


def _energy_slope(mechanism: Mechanism) -> ca.Function:
    """d(T + V)/dphi at constant speed."""
    energy = mechanism.functions["energy"]
    letters = {n: ca.SX.sym(n) for n in energy.name_in()}
    found = energy(**letters)
    slope = ca.gradient(found["kinetic_energy"] + found["potential_energy"], letters[mechanism.coordinates[0]])
    return ca.Function("slope", list(letters.values()), [slope], list(letters), ["slope"])


def gas_inputs(mechanism: Mechanism) -> list[str]:
    """Inputs of a mechanism that are gas forces.

    Returns
    -------
    names : list of str
        All inputs that start with F
    """
    return [n for n in mechanism.inputs if n.startswith("F")]
