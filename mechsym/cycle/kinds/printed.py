r"""The thesis's explicit march in whole degrees, exactly as it must have been programmed: `nunes2017_printed`.

The thesis counts theta = 0 at intake, 360 degrees at firing top dead centre; that count is kept in this module alone.
One step from theta_1 to theta_2 = theta_1 + 1 degree, all speeds side by side:

    p_2 = [2 (dQ_R - dQ_L - dQ_vap) + p_1 (6 V_1 - V_2)]/(6 V_2 - V_1),  T_2 = p_2 V_2/(m_2 R),  6 = (gamma+1)/(gamma-1)

What the print leaves open, and what alone gives all 28 numbers of its chapter 3: the heat loss takes the gas at the
start of the step and the area at its end; fuel evaporates in steps that end at or before ignition, adds its mass to m
and its latent heat to the losses; the burnt fraction is looked up only at whole degrees inside the combustion, so the
burn of the last broken degree is lost; the mean torque sums the 721 points of 0, 1, .., 720 degrees and divides by 721.

Source: Nunes (2017), sections 2.3 and 3.4.1.

Figures are averaged and shared out as the thesis did it. Kept apart from `performance`: where the two differ, the
thesis slipped (`docs/errata.md`), and the slips are the point.
"""

import casadi as ca
import numpy as np

from mechsym.cycle.chamber import Chamber, chamber, piston_force, travel, volume, wall_area
from mechsym.cycle.closed.model import ClosedEngine
from mechsym.cycle.closed.performance import Performance, burnt_angles, figures
from mechsym.cycle.heat import ConstantGamma, GasAtWall, Law, heat_flux
from mechsym.cycle.kinds.spark_ignition import Charge, SparkIgnition, charge, timing
from mechsym.errors import BadInput
from mechsym.native.march import marcher
from mechsym.quantities import record
from mechsym.quantities.units import Array, NewtonMetre, RadPerSecond, Scalar

_CLOSES, _FIRING, _OPENS = 180, 360, 540
_POINTS = 721


@record
class March:
    """States of the closed period at whole degrees, one column for each speed."""

    theta_deg: np.ndarray  #: shape (361,): 180, 181, .., 540, from intake top dead centre [deg]
    omega: np.ndarray  #: shape (n,): Crank speeds [rad/s]
    #: shape (361, n): Pressure [Pa] and temperature [K]
    p: np.ndarray
    t: np.ndarray
    v: np.ndarray  #: shape (361,): Volume [m^3]
    #: shape (n,) and float: Gas when the inlet closes with all of the fuel, and the fuel [kg]
    mass: Scalar
    fuel: Scalar
    #: shape (360, n): Heats of the steps [J]
    heat_released: np.ndarray
    wall_heat: np.ndarray
    latent_heat: np.ndarray


def march(chamber: Chamber, cycle: SparkIgnition, gas: ConstantGamma, law: Law, omega: RadPerSecond[Array]) -> March:
    r"""March the closed period in steps of one degree.

    .. math:: p_2 = \frac{2(\delta Q_R - \delta Q_L - \delta Q_{vap}) + p_1(G_6 V_1 - V_2)}{G_6 V_2 - V_1}

    Source: Nunes (2017), eqs. (3.5) to (3.14).
    """
    theta = np.arange(_CLOSES, _OPENS + 1)
    v = volume(chamber, np.radians(theta - _FIRING))
    held = charge(chamber, cycle, gas.gas_constant)
    start = np.array([[cycle.intake_pressure], [cycle.intake_temperature], [held.gas], [0.0]]) + 0.0 * omega
    stages = np.stack([theta[1:], v[:-1], v[1:]], axis=1)
    lanes = np.array([omega, *(np.degrees(a) + 0.0 * omega for a in timing(cycle, omega))])
    # each operation rounded by itself, as the thesis's program did it
    record = marcher(_degree(chamber, cycle, gas, law, held), mode="strict")(start, stages, lanes)[1]
    p, t = (np.vstack([start[i], record[:, i]]) for i in (0, 1))
    return March(
        theta_deg=theta, omega=omega, p=p, t=t, v=v, mass=held.gas + held.fuel, fuel=held.fuel,
        heat_released=record[:, 2], wall_heat=record[:, 3], latent_heat=record[:, 4],
    )  # fmt: skip


def _degree(chamber: Chamber, cycle: SparkIgnition, gas: ConstantGamma, law: Law, held: Charge) -> ca.Function:
    """One step: (p, T, m, burnt), (angle at its end [deg], V_1, V_2), (omega, ignition, duration [deg])."""
    state, stage, lane = ca.SX.sym("state", 4), ca.SX.sym("stage", 3), ca.SX.sym("lane", 3)
    p, t, mass, burnt = ca.vertsplit(state)
    theta, v1, v2 = ca.vertsplit(stage)
    omega, ignition, duration = ca.vertsplit(lane)
    y = (theta - _FIRING - ignition) / duration
    share = 1 - ca.exp(-cycle.wiebe_a * ca.fmax(y, 0) ** (cycle.wiebe_m + 1))
    now = ca.fmax(burnt, ca.if_else(y <= 1, share, 0))
    evaporates = theta <= ignition + _FIRING
    vapour = ca.if_else(evaporates, held.fuel / (ignition + _FIRING - _CLOSES), 0)
    released, lost = held.heat * (now - burnt), _loss(chamber, law, gas, (p, t, v2), omega)
    latent = cycle.latent_heat * vapour
    g6 = (gas.gamma + 1) / (gas.gamma - 1)
    p2 = (2 * (released - lost - latent) + p * (g6 * v1 - v2)) / (g6 * v2 - v1)
    t2 = p2 * v2 / ((mass + vapour) * gas.gas_constant)
    following, record = ca.vertcat(p2, t2, mass + vapour, now), ca.vertcat(p2, t2, released, lost, latent)
    return ca.Function("degree", [state, stage, lane], [following, record])


def crank_torque(chamber: Chamber, result: March) -> NewtonMetre[Array]:
    r"""Torque of one piston on its crank in the closed period.

    .. math:: T = (p A + m a)\,dx/d\theta, \quad a = -x''\omega^2

    Returns torque: from absolute pressure and inertia, shape (361, n).
    Source: Nunes (2017), eqs. (2.62) to (2.65) and (2.73).
    """
    phi = np.radians(result.theta_deg - _FIRING)[:, None]
    return piston_force(chamber, phi, result.omega, result.p) * travel(chamber.motion, phi)[1]


def mean_torque(chamber: Chamber, result: March) -> NewtonMetre[Array]:
    r"""Average torque as the thesis took it.

    .. math:: \bar T = n \sum_i T_i/721

    Returns torque: all pistons together, over the 721 points of four strokes of which the gas exchange adds nothing.
    Source: Nunes (2017), eq. (2.66); 720 steps would be right (erratum E6).
    """
    return chamber.pistons * crank_torque(chamber, result).sum(axis=0) / _POINTS


def _loss(
    chamber: Chamber, law: Law, gas: ConstantGamma, state: tuple[Scalar, Scalar, Scalar], omega: Scalar
) -> Scalar:
    p, t, v_end = state
    speed = chamber.stroke * omega / np.pi
    flux = heat_flux(law, GasAtWall(p, t, v_end, gas.gas_constant, chamber.bore, speed))
    return flux * wall_area(chamber, v_end) * np.radians(1.0) / omega


_TWO_PI = 6.28  # eq. (2.51)
_CV = 718.0  # table 3.2 [J/(kg K)]; R/(gamma - 1) is 717.5
_LAST = -1  # the energy shares end at 539 degrees, one step before the exhaust opens


def marched(engine: ClosedEngine, omega: RadPerSecond[Array]) -> March:
    """The thesis's march of an engine."""
    cycle = engine.cycle
    if engine.blowdown is not None:
        raise BadInput("method = 'nunes2017_printed' has its gas exchange at intake pressure; leave [blowdown] out")
    if abs(cycle.inlet_closes + np.pi) > 1e-12 or abs(cycle.exhaust_opens - np.pi) > 1e-12:
        raise BadInput(
            "method = 'nunes2017_printed' marches from -180 to 180 degrees; set cycle.inlet_closes and "
            "cycle.exhaust_opens to these"
        )
    return march(chamber(engine.chamber, engine.motion), cycle, _gas(engine), engine.heat_transfer, omega)


def performance_printed(engine: ClosedEngine, omega: RadPerSecond[Array]) -> Performance:
    r"""Figures of the thesis at its one-degree march.

    .. math:: p_{mi} = 6.28\cdot 2\,\bar T/V_d, \quad \eta = 4\pi\bar T/(m_f Q_{HV}),
        \quad \text{exhaust} = m\,718\,(T_{539} - T_0)/(m_f Q_{HV})

    engine: the engine; its gas must be `ConstantGamma`, its closed period two whole strokes. Returns performance: same
    entries as the converged figures; `unburnt` is the thesis's remainder (erratum E3).
    Source: Nunes (2017), eqs. (2.51) to (2.53), (2.62) to (2.66), sections 5.1 and 5.2.
    """
    room = chamber(engine.chamber, engine.motion)
    result, gas = marched(engine, omega), _gas(engine)
    fuel_heat = np.full(omega.shape, result.fuel * engine.cycle.heating_value)
    torque = mean_torque(room, result)
    top = np.argmax(result.p, axis=0)
    p_max = result.p[top, np.arange(omega.size)]
    scalars = {
        "omega": omega, "work": 4 * np.pi * torque, "fuel": result.fuel, "fuel_heat": fuel_heat,
        "displacement": room.displacement, "stroke": room.stroke,
    }  # fmt: skip
    printed = figures(engine.friction_pressure, scalars, p_max) | {"mep": _TWO_PI * 2 * torque / room.displacement}
    work = np.sum((result.p[1:] + result.p[:-1]) / 2 * np.diff(result.v)[:, None], axis=0)
    shares = {
        "heat": (result.wall_heat + result.latent_heat)[:_LAST].sum(axis=0) / fuel_heat,
        "work": work / fuel_heat,
        "exhaust": result.mass * _CV * (result.t[:_LAST][-1] - engine.cycle.intake_temperature) / fuel_heat,
    }
    angle = np.radians(result.theta_deg - 360.0)[:, None]
    force = piston_force(room, angle, omega, result.p)
    energy = (result.p[-1] * result.v[-1] - result.p[0] * result.v[0]) / (gas.gamma - 1)
    heat = result.heat_released - result.wall_heat - result.latent_heat
    return Performance(
        **printed, **shares, unburnt=1 - sum(shares.values()), p_max=p_max, p_max_angle=angle[top, 0],
        pumping_mep=np.zeros(omega.shape), burnt=burnt_angles(engine.cycle, omega),
        t_max=result.t.max(axis=0), knock=np.full(omega.shape, np.nan),
        torque_max=crank_torque(room, result).max(axis=0), force_max=force.max(axis=0),
        energy_residual=(energy + work - heat.sum(axis=0)) / fuel_heat, loads=_loads(engine, angle, omega, result),
    )  # fmt: skip


def _gas(engine: ClosedEngine) -> ConstantGamma:
    if not isinstance(engine.gas, ConstantGamma):
        raise BadInput("method = 'nunes2017_printed' marches with a constant gamma; set gas.model = 'constant_gamma'")
    return engine.gas


def _loads(engine: ClosedEngine, angle: np.ndarray, omega: np.ndarray, result: March) -> dict[str, np.ndarray]:
    loads = engine.motion.loads
    if loads is None:
        return {}
    net = (result.p - engine.chamber.back_pressure) * np.pi / 4 * engine.chamber.bore**2
    rows = [np.broadcast_to(a, net.shape).reshape(1, -1) for a in (angle, omega, net)]
    parameters = np.array(list(engine.motion.parameters.values())).reshape(-1, 1)
    forces = loads.call([rows[0], parameters, rows[1], rows[2]])
    largest = (np.abs(np.asarray(v)).reshape(net.shape).max(axis=0) for v in forces)
    return dict(zip(loads.name_out(), largest, strict=True))
