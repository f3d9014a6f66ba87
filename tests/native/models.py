"""Functions that the tests of emitted code share: the generated mechanisms and a crankshaft of N equal throws."""

import functools

import casadi as ca
import numpy as np

from mechsym import mechanisms
from mechsym.mechanisms import crank_throw, crank_train, crankshaft_flywheel, crosshead, hypocycloid, rodless
from mechsym.mechanisms.record import Mechanism, acceleration_function

CROSSHEAD = crosshead.CrossheadParameters(
    r1=0.2, r2=0.3, l1=0.8, l2=0.75, m1=80, m2=150, m3=150, m4=200, m5=110, I01=30, IC2=50, axis_tilt=0.4
)
FLYWHEEL = crankshaft_flywheel.CrankshaftFlywheelParameters(I0=0.26, I2=0.58, r=0.06, l=0.26, m0=1.1, k1=6500)
THROW = crank_throw.CrankThrowParameters(
    r=0.06, l1=0.1, l2=0.16, offset=0.01, m0=1.4, m_rod=0.8, m_piston=1.1, I_rod=0.01, I0=0.05, u0=0.02, g=9.81,
    axis_tilt=0.3,
)  # fmt: skip
TRAIN = crank_train.CrankTrainParameters(
    throw=(1, 1, 2, 2), phase=(0.0, 0.0, np.pi / 2, np.pi / 2), bank=(-0.5, 0.5, -0.5, 0.5), r=0.06, l1=0.1, l2=0.16,
    m_rod=0.8, m_piston=1.1, I_rod=0.01, I0=0.05, I_f=0.58, k=6500.0, c=0.1,
)  # fmt: skip
HYPOCYCLOID = hypocycloid.HypocycloidParameters(e=0.013, I1=2e-3, u1=4e-3, m2=0.31, I2=8e-5, m3=0.25, alpha_n=0.44)
RODLESS = rodless.RodlessParameters(r=0.05, I1=0.04, u1=0.02, m_link=1.3, I_link=2e-3, m_a=2.4, m_b=1.9)


@functools.cache
def mechanism(name: str) -> Mechanism:
    return {
        "crosshead": lambda: crosshead.build(CROSSHEAD),
        "crankshaft_flywheel": lambda: crankshaft_flywheel.build(FLYWHEEL),
        "crankshaft_flywheel_printed": lambda: mechanisms.build("crankshaft_flywheel_printed", FLYWHEEL),
        "crank_throw": lambda: crank_throw.build(THROW),
        "crank_train": lambda: crank_train.build(TRAIN),
        "hypocycloid": lambda: hypocycloid.build(HYPOCYCLOID),
        "rodless": lambda: rodless.build(RODLESS),
    }[name]()


MECHANISMS = (
    "crosshead", "crankshaft_flywheel", "crankshaft_flywheel_printed", "crank_throw", "crank_train", "hypocycloid",
    "rodless",
)  # fmt: skip


@functools.cache
def functions(name: str) -> dict[str, ca.Function]:
    """All functions of a mechanism with its accelerations and their Jacobian by the state."""
    built = mechanism(name)
    acceleration = acceleration_function(built)
    inputs = [ca.SX.sym(acceleration.name_in(i)) for i in range(acceleration.n_in())]
    state = ca.vertcat(*inputs[: 2 * len(built.coordinates)])
    jacobian = ca.jacobian(acceleration(*inputs), state)
    derivative = ca.Function("jacobian", inputs, [jacobian], acceleration.name_in(), ["jacobian"])
    return {**built.functions, "acceleration": acceleration, "jacobian": derivative}


def states(function: ca.Function, count: int, seed: int = 1) -> list[np.ndarray]:
    """Random arguments; the first angles are dead centres and whole turns."""
    rng = np.random.default_rng(seed)
    columns = []
    for name in function.name_in():
        if name.endswith("d"):
            column = rng.uniform(-20, 20, count)
        elif name.startswith(("phi", "theta", "alpha")):
            column = rng.uniform(-50, 50, count)
            dead = np.pi / 2 * np.arange(-6, 7)
            column[: dead.size] = dead
        else:
            column = rng.uniform(-1e4, 1e4, count)
        columns.append(column)
    return columns


def agree(found: np.ndarray, wanted: np.ndarray) -> float:
    """Largest difference of any output, relative to its value but at least to a thousandth of its largest value."""
    scale = np.maximum(np.abs(wanted), 1e-3 * np.max(np.abs(wanted), axis=1, keepdims=True))
    return float(np.max(np.abs(found - wanted) / np.where(scale == 0, 1, scale)))


def interpreted(function: ca.Function, columns: list[np.ndarray]) -> np.ndarray:
    """The same function by CasADi's interpreter, shape (outputs, n)."""
    n = columns[0].size
    values = function.map(n).call([ca.DM(c).T for c in columns])
    # column blocks of one point each, flattened by columns
    return np.concatenate([np.asarray(v).reshape(v.shape[0], n, -1).transpose(2, 0, 1).reshape(-1, n) for v in values])


def chain(throws: int) -> ca.Function:
    """Accelerations of a torsional chain of equal throws, evenly spaced, with a flywheel at its end."""
    single = acceleration_function(mechanism("crosshead"))
    q, u, F = (ca.SX.sym(name, n) for name, n in (("q", throws + 1), ("u", throws + 1), ("F", throws)))
    twist = [1e6 * (q[i] - q[i + 1]) for i in range(throws)]
    found = []
    for i in range(throws):
        torque = (twist[i - 1] if i else 0) - twist[i]
        found.append(single(q[i] + 2 * np.pi * (i + 0.5) / throws, u[i], F[i], 0, torque))
    flywheel = twist[-1] / 500.0
    return ca.Function("chain", [q, u, F], [ca.vertcat(*found, flywheel)], ["q", "u", "F"], ["acceleration"])


def rhs(name, n, p, formula) -> ca.Function:
    t, y, w = ca.SX.sym("t"), ca.SX.sym("y", n), ca.SX.sym("p", p)
    return ca.Function(name, [t, y, w], [ca.vertcat(*formula(t, ca.vertsplit(y), ca.vertsplit(w)))])


PENDULUM = rhs("pendulum", 2, 0, lambda t, y, p: (y[1], -ca.sin(y[0])))
