r"""The thesis's explicit march in whole degrees, exactly as it must have been programmed: `nunes2017_printed`.

The thesis counts theta = 0 at intake, 360 degrees at firing top dead centre; that count is kept in this module alone.
One step from theta_1 to theta_2 = theta_1 + 1 degree, all speeds side by side:

    p_2 = [2 (dQ_R - dQ_L - dQ_vap) + p_1 (6 V_1 - V_2)]/(6 V_2 - V_1),  T_2 = p_2 V_2/(m_2 R),  6 = (gamma+1)/(gamma-1)

What the print leaves open, and what alone gives all 28 numbers of its chapter 3: the heat loss takes the gas at the
start of the step and the area at its end; fuel evaporates in steps that end at or before ignition, adds its mass to m
and its latent heat to the losses; the burnt fraction is looked up only at whole degrees inside the combustion, so the
burn of the last broken degree is lost; the mean torque sums the 721 points of 0, 1, .., 720 degrees and divides by 721.

Source: Nunes (2017), sections 2.3 and 3.4.1.
"""

import casadi as ca
import numpy as np

from mechsym.cycle.chamber import Chamber, piston_force, travel, volume, wall_area
from mechsym.cycle.heat import GasAtWall, Law, heat_flux
from mechsym.cycle.kinds.spark_ignition import Charge, SparkIgnition, charge, timing
from mechsym.cycle.mixture import ConstantGamma
from mechsym.cycle.values import Value
from mechsym.native.march import marcher
from mechsym.quantities import record

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
    mass: Value
    fuel: Value
    #: shape (360, n): Heats of the steps [J]
    heat_released: np.ndarray
    wall_heat: np.ndarray
    latent_heat: np.ndarray


def march(chamber: Chamber, cycle: SparkIgnition, gas: ConstantGamma, law: Law, omega: np.ndarray) -> March:
    r"""March the closed period in steps of one degree.

    .. math:: p_2 = \frac{2(\delta Q_R - \delta Q_L - \delta Q_{vap}) + p_1(G_6 V_1 - V_2)}{G_6 V_2 - V_1}

    Parameters
    ----------
    omega : ndarray, shape (n,)
        Crank speeds [rad/s]

    Notes
    -----
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


def crank_torque(chamber: Chamber, result: March) -> np.ndarray:
    r"""Torque of one piston on its crank in the closed period.

    .. math:: T = (p A + m a)\,dx/d\theta, \quad a = -x''\omega^2

    Returns
    -------
    torque : ndarray, shape (361, n)
        From absolute pressure and inertia [N*m]

    Notes
    -----
    Source: Nunes (2017), eqs. (2.62) to (2.65) and (2.73).
    """
    phi = np.radians(result.theta_deg - _FIRING)[:, None]
    return piston_force(chamber, phi, result.omega, result.p) * travel(chamber.motion, phi)[1]


def mean_torque(chamber: Chamber, result: March) -> np.ndarray:
    r"""Average torque as the thesis took it.

    .. math:: \bar T = n \sum_i T_i/721

    Returns
    -------
    torque : ndarray, shape (n,)
        All pistons together, over the 721 points of four strokes of which the gas exchange adds nothing [N*m]

    Notes
    -----
    Source: Nunes (2017), eq. (2.66); 720 steps would be right (erratum E6).
    """
    return chamber.pistons * crank_torque(chamber, result).sum(axis=0) / _POINTS


def _loss(chamber: Chamber, law: Law, gas: ConstantGamma, state: tuple[Value, Value, Value], omega: Value) -> Value:
    p, t, v_end = state
    speed = chamber.stroke * omega / np.pi
    flux = heat_flux(law, GasAtWall(p, t, v_end, gas.gas_constant, chamber.bore, speed))
    return flux * wall_area(chamber, v_end) * np.radians(1.0) / omega
