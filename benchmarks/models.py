"""The three systems of the benchmark: one, two and seven coordinates."""

import functools
import math

import casadi as ca
import numpy as np

from mechsym.mechanisms import crank_train, crankshaft_flywheel, crosshead
from mechsym.mechanisms.record import acceleration_function

CROSSHEAD = crosshead.CrossheadParameters(
    r1=0.2, r2=0.3, l1=0.8, l2=0.75, m1=80, m2=150, m3=150, m4=200, m5=110, I01=30, IC2=50
)
FLYWHEEL = crankshaft_flywheel.CrankshaftFlywheelParameters(I0=0.26, I2=0.58, r=0.06, l=0.26, m0=1.1, k1=6500)
SYSTEMS = ("1-DOF", "2-DOF", "N = 6")


def train(throws: int) -> crank_train.CrankTrainParameters:
    """Equal throws, evenly spaced.

    Parameters
    ----------
    throws : int
        Number of throws

    Returns
    -------
    parameters : CrankTrainParameters
        Data
    """
    return crank_train.CrankTrainParameters(
        throw=tuple(range(1, throws + 1)), phase=tuple(2 * math.pi * i / throws for i in range(throws)), r=0.06, l1=0.1,
        l2=0.16, m_rod=0.8, m_piston=1.1, I_rod=0.01, I0=0.05, I_f=0.58, k=6500.0, c=0.1,
    )  # fmt: skip


@functools.cache
def acceleration(system: str) -> ca.Function:
    """Accelerations of a system.

    Parameters
    ----------
    system : str
        One of `SYSTEMS`

    Returns
    -------
    function : casadi.Function
        Coordinates, velocities and inputs, all scalars, to the accelerations
    """
    match system:
        case "1-DOF":
            return _renamed(acceleration_function(crosshead.build(CROSSHEAD)), "one_dof")
        case "2-DOF":
            return _renamed(acceleration_function(crankshaft_flywheel.build(FLYWHEEL)), "two_dof")
        case _:
            return _renamed(acceleration_function(crank_train.build(train(6))), "six_throws")


def _renamed(function: ca.Function, name: str) -> ca.Function:
    symbols = [ca.SX.sym(function.name_in(i)) for i in range(function.n_in())]
    return ca.Function(name, symbols, function.call(symbols), function.name_in(), function.name_out())


def states(function: ca.Function, count: int) -> list[np.ndarray]:
    """Random arguments of a system.

    Parameters
    ----------
    function : casadi.Function
        Accelerations
    count : int
        Number of points

    Returns
    -------
    columns : list of ndarray, shape (count,)
        One for each input
    """
    rng = np.random.default_rng(1)
    spans = {True: (-20.0, 20.0), False: (-1e3, 1e3)}
    columns = []
    for name in function.name_in():
        low, high = (0.0, 50.0) if name.startswith("phi") and not name.endswith("d") else spans[name.endswith("d")]
        columns.append(rng.uniform(low, high, count))
    return columns


def start_up() -> ca.Function:
    """The two-degree model from rest, its torque as the held value.

    Returns
    -------
    function : casadi.Function
        (t, y, p) to dy/dt
    """
    t, y, p = ca.SX.sym("t"), ca.SX.sym("y", 4), ca.SX.sym("p")
    two = acceleration("2-DOF")(*ca.vertsplit(y), p, 0)
    return ca.Function("start_up", [t, y, p], [ca.vertcat(y[2], y[3], two)], ["t", "y", "p"], ["ydot"])


def energy() -> ca.Function:
    """Energies of the two-degree model.

    Returns
    -------
    function : casadi.Function
        Coordinates and velocities to kinetic and potential energy
    """
    return crankshaft_flywheel.build(FLYWHEEL).functions["energy"]
