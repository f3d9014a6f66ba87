r"""What an engine does at its operating points: torque, power, consumption, energy shares, peaks.

Work of a cycle is the integral of p dV over the closed period; the ideal gas exchange adds p_0 times the difference
of the volumes at its ends, one with a blowdown what `open_period` integrates. Powers count one power stroke in two
revolutions.

`design_function` runs the very operations of `run` and `performance` as one differentiable function of the design. A
peak (pressure, force, a load of the mechanism) is given as the vector of its values along the cycle: a bound on the
peak is a bound on each of them, which stays smooth where the place of the peak jumps.
"""

import functools
from collections.abc import Mapping, Sequence
from functools import partial

import casadi as ca
import numpy as np

from mechsym.cycle.chamber import Chamber, chamber, piston_force, travel
from mechsym.cycle.closed.model import ClosedEngine, at_design, check_design, closed_period, open_function, open_period
from mechsym.cycle.closed.run import MANY, ClosedRun, closed_function, dense, run
from mechsym.cycle.friction import Friction, friction_pressure
from mechsym.cycle.kinds.spark_ignition import SparkIgnition, timing
from mechsym.cycle.knock import knock_integral, knock_of_runs
from mechsym.cycle.wiebe import BURNT, burnt_at
from mechsym.files import Json
from mechsym.native import compiled
from mechsym.quantities import record
from mechsym.quantities.units import Array, Pascal, Pure, Radian, RadPerSecond, Scalar

_CYCLE_ANGLE = 4 * np.pi


@record
class Performance:
    """Figures of n operating points; every entry an array of shape (n,)."""

    omega: np.ndarray  #: Crank speed [rad/s]
    torque_avg: np.ndarray  #: Mean torque of the gas on all pistons, and less friction [N*m]
    torque_max: np.ndarray  #: Largest torque of one piston on its crank, from absolute pressure and inertia [N*m]
    power: np.ndarray  #: Mean power [W]
    mep: np.ndarray  #: Mean indicated pressure and friction mean pressure [Pa]
    pumping_mep: np.ndarray  #: Work of the two strokes of gas exchange by the swept volume [Pa]
    sfc: np.ndarray  #: Fuel by work [kg/J]
    efficiency: np.ndarray  #: Work by heating value of the fuel [-]
    brake_torque: np.ndarray  #: Mean torque of the gas on all pistons, and less friction [N*m]
    brake_power: np.ndarray  #: Mean power [W]
    friction_mep: np.ndarray  #: Mean indicated pressure and friction mean pressure [Pa]
    brake_sfc: np.ndarray  #: Fuel by work [kg/J]
    brake_efficiency: np.ndarray  #: Work by heating value of the fuel [-]
    #: Peak pressure [Pa] and its angle from firing top dead centre [rad]
    p_max: np.ndarray
    p_max_angle: np.ndarray
    burnt: Mapping[str, np.ndarray]  #: Angles from firing top dead centre by the names of `wiebe.BURNT` [deg]
    t_max: np.ndarray  #: Highest mean temperature of the gas [K]
    knock: np.ndarray  #: Livengood and Wu's integral, 1 where the end gas ignites by itself; nan where not known [-]
    force_max: np.ndarray  #: Largest force of one piston, from absolute pressure and inertia [N]
    #: Shares of the heating value [-]
    heat: np.ndarray
    work: np.ndarray
    exhaust: np.ndarray
    unburnt: np.ndarray
    energy_residual: np.ndarray  #: What the first law leaves over the closed period, by the fuel's heating value [-]
    loads: Mapping[str, np.ndarray]  #: Largest magnitude of each load of the mechanism over a revolution


def performance(engine: ClosedEngine, design: Mapping[str, Scalar]) -> Performance:
    r"""Figures of the converged cycle.

    .. math:: \bar T = W/(4\pi), \quad p_{mi} = W/V_d, \quad \eta = W/(m_f Q_{HV})

    design: mapping of str to ndarray, shape (n,), operating points; must hold `omega` [rad/s]. Raises BadInput: a value
    is out of range, or combustion does not fit into the closed period.
    """
    check_design(engine, design)
    result = run(functools.partial(closed_period, engine), design)
    scalars, pumping = dict(result.scalars), np.zeros(len(result.t))
    if engine.blowdown is not None:
        exchange = open_period(functools.partial(closed_period, engine), design, result.t[:, -1])
        scalars["exchange_work"], pumping = exchange.work, exchange.pumping
    scalars["work"] = scalars["work"] + scalars["exchange_work"]
    phi, p, t = dense(result)
    p_max, p_max_angle = peak(phi, p)
    here = at_design(engine, {k: np.asarray(v, float) for k, v in design.items()})
    columns = [np.repeat(np.broadcast_to(np.asarray(v, float), phi.shape[:1]), phi.shape[1]) for v in design.values()]
    function = force_function(engine, tuple(design))
    points = [*columns, phi.ravel(), p.ravel()]
    if phi.shape[0] >= MANY:
        values = compiled(function).batch(*points)
    else:
        values = np.array([np.asarray(v) for v in function.call([np.array(columns), *(a[None] for a in points[-2:])])])
    along = {k: v.reshape(phi.shape) for k, v in zip(function.name_out(), values, strict=True)}
    largest = {name: peak(phi, values)[0] for name, values in along.items()}
    angles = burnt_angles(here.cycle, scalars["omega"])
    fuel, released, heat = (scalars[k] for k in ("fuel_heat", "heat_released", "latent_heat"))
    carried = scalars["energy_end"] - scalars["energy_start"] - scalars["exchange_work"]
    return Performance(
        **figures(here.friction_pressure, scalars, p_max), heat=(scalars["wall_heat"] + heat) / fuel,
        work=scalars["work"] / fuel, exhaust=(carried - scalars["fuel_energy"] - heat) / fuel,
        unburnt=1 - released / fuel, pumping_mep=pumping / scalars["displacement"],
        p_max=p_max, p_max_angle=p_max_angle, burnt=angles, t_max=t.max(axis=1), knock=_knock(engine, design, result),
        torque_max=largest.pop("torque"), force_max=largest.pop("force"),
        energy_residual=result.residual * released / fuel, loads=largest,
    )  # fmt: skip


def figures(friction: Friction, scalars: Mapping[str, np.ndarray], p_max: Pascal[Array]) -> Json:
    r"""Figures that follow from the work of a cycle.

    .. math:: \bar T = W/(4\pi), \quad P = \bar T\omega, \quad b = m_f/W, \quad W_b = W - p_{mf} V_d

    scalars: mapping of str to ndarray, shape (n,), `omega` [rad/s], `work`, `fuel_heat` [J], `fuel` [kg],
    `displacement` [m^3], `stroke` [m]; p_max: peak pressure. Returns figures: dict of str to ndarray, entries of
    `Performance`, for a power stroke in two revolutions.
    """
    omega, work, fuel, room = (scalars[k] for k in ("omega", "work", "fuel", "displacement"))
    lost = friction_pressure(friction, p_max, scalars["stroke"] * omega / np.pi, omega)
    brake = work - lost * room
    figures = {"omega": omega, "mep": work / room, "friction_mep": lost}
    for prefix, energy in (("", work), ("brake_", brake)):
        torque = energy / _CYCLE_ANGLE
        figures |= {
            "torque_avg" if not prefix else "brake_torque": torque,
            f"{prefix}power": torque * omega,
            f"{prefix}sfc": fuel / np.where(energy > 0, energy, np.nan),
            f"{prefix}efficiency": energy / scalars["fuel_heat"],
        }
    return figures


def peak(phi: Radian[Array], y: Pure[Array]) -> tuple[Pure[Array], Radian[Array]]:
    """Largest value of each row and where it lies, by the parabola through the three points around it.

    phi: crank angles, increasing along a row, shape (n, k); y: values, any unit, shape (n, k). Returns largest: largest
    value, unit of `y`.
    """
    row, top = np.arange(y.shape[0]), np.argmax(y, axis=1)
    k = np.clip(top, 1, y.shape[1] - 2)
    (x0, x1, x2), (y0, y1, y2) = ([a[row, k + j] for j in (-1, 0, 1)] for a in (phi, y))
    slope = (y1 - y0) / (x1 - x0)
    bend = ((y2 - y1) / (x2 - x1) - slope) / (x2 - x0)
    vertex = np.clip((x0 + x1) / 2 - slope / (2 * np.where(bend < 0, bend, -np.inf)), x0, x2)
    value = y0 + (vertex - x0) * (slope + (vertex - x1) * bend)
    higher = value > y[row, top]
    return np.where(higher, value, y[row, top]), np.where(higher, vertex, phi[row, top])


def burnt_angles(cycle: SparkIgnition, omega: RadPerSecond[Array]) -> dict[str, np.ndarray]:
    """CA10, CA50 and CA90 of a spark-ignition cycle, whose values may be arrays over the speeds [deg]."""
    start, duration = timing(cycle, omega)
    return {
        name: np.degrees(start + duration * burnt_at(share, cycle.wiebe_a, cycle.wiebe_m))
        for name, share in BURNT.items()
    }


def _knock(engine: ClosedEngine, design: Mapping[str, Scalar], result: ClosedRun) -> np.ndarray:
    here = at_design(engine, {k: np.atleast_1d(np.asarray(v, float))[:, None] for k, v in design.items()})
    nodes = {"p": result.p, "t": result.t, **result.scalars}
    return knock_of_runs(nodes, here.gas, np.ravel(here.cycle.octane))


def force_function(engine: ClosedEngine, names: tuple[str, ...]) -> ca.Function:
    """Force and torque of one piston, and the mechanism's loads, at a point of a cycle as a function of the design.

    Returns function: (design (k,), phi [rad], p [Pa]) -> `torque` [N*m], `force` [N] and the magnitude of each load.
    """
    z, phi, p = ca.SX.sym("z", len(names)), ca.SX.sym("phi"), ca.SX.sym("p")
    design = {name: z[k] for k, name in enumerate(names)}
    here = at_design(engine, design)
    forces = _forces(here, chamber(here.chamber, here.motion), design["omega"], phi, p)
    return ca.Function("forces", [z, phi, p], list(forces.values()), ["design", "phi", "p"], list(forces))


def _forces(engine: ClosedEngine, room: Chamber, omega: Scalar, phi: Scalar, p: Scalar) -> dict[str, ca.SX]:
    force = piston_force(room, phi, omega, p)
    outputs = {"torque": force * travel(engine.motion, phi)[1], "force": force}
    loads = engine.motion.loads
    if loads is None:
        return outputs
    net = (p - room.back_pressure) * room.area
    forces = loads.call([phi, ca.vertcat(*engine.motion.parameters.values()), omega, net])
    return outputs | {name: ca.fabs(value) for name, value in zip(loads.name_out(), forces, strict=True)}


STEPS = 120
# scalar outputs of `design_function` and their units
SCALAR_UNITS = {
    "efficiency": "-", "brake_efficiency": "-", "torque_avg": "N*m", "brake_torque": "N*m", "power": "W",
    "brake_power": "W", "mep": "Pa", "brake_mep": "Pa", "sfc": "kg/J", "brake_sfc": "kg/J", "displacement": "m^3",
    "piston_speed": "m/s", "stroke": "m", "knock": "-",
}  # fmt: skip
# outputs along the cycle, bounded or minimised as peaks; loads of the mechanism come on top and are in N
PEAK_UNITS = {"p_max": "Pa", "t_max": "K", "force_max": "N", "torque_max": "N*m"}


def design_function(engine: ClosedEngine, names: Sequence[str], steps: int = STEPS) -> ca.Function:
    """Figures of the engine as a function of some of its values.

    names: design variables, see `model.design_names`; must hold `omega`. steps: steps of the integration, a multiple of
    10. Returns function: (design (k,)) -> the scalars of `SCALAR_UNITS`, and the columns of `PEAK_UNITS` and the
    mechanism's loads, whose largest entries are the peaks.
    """
    design = ca.MX.sym("design", len(names))
    closed = closed_function(partial(closed_period, engine), names, steps)
    outcome = dict(zip(closed.name_out(), closed.call([design]), strict=True))
    points = outcome["phi"].numel()
    along = force_function(engine, tuple(names)).map(points)
    values = along.call([ca.repmat(design, 1, points), outcome["phi"], outcome["p"]])
    forces = {name: value.T for name, value in zip(along.name_out(), values, strict=True)}
    peaks = {
        "p_max": outcome["p"].T,
        "t_max": outcome["t"].T,
        "force_max": forces.pop("force"),
        "torque_max": forces.pop("torque"),
        **forces,
    }
    if engine.blowdown is not None:
        exchange = open_function(partial(closed_period, engine), names)
        outcome["exchange_work"] = exchange(design, outcome["t"][-1])[2]
    here = at_design(engine, {name: design[k] for k, name in enumerate(names)})
    knock = knock_integral(outcome, steps, here.gas, here.cycle.octane)
    outputs = _scalars(outcome, here.friction_pressure) | {"knock": knock} | peaks
    return ca.Function("engine", [design], list(outputs.values()), ["design"], list(outputs))


def _scalars(values: Mapping[str, ca.MX], friction: Friction) -> dict[str, ca.MX]:
    omega, fuel, displacement = values["omega"], values["fuel"], values["displacement"]
    work = values["work"] + values["exchange_work"]
    speed = values["stroke"] * omega / np.pi
    brake = work - displacement * friction_pressure(friction, ca.mmax(values["p"]), speed, omega)
    outputs = {"displacement": displacement, "piston_speed": speed, "stroke": values["stroke"]}
    for prefix, energy in (("", work), ("brake_", brake)):
        torque = energy / (4 * np.pi)
        outputs |= {
            f"{prefix}efficiency": energy / values["fuel_heat"],
            "brake_torque" if prefix else "torque_avg": torque,
            f"{prefix}power": torque * omega,
            f"{prefix}mep": energy / displacement,
            f"{prefix}sfc": fuel / energy,
        }
    return {name: outputs[name] for name in SCALAR_UNITS if name in outputs}
