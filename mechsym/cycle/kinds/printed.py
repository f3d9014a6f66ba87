r"""Figures of the thesis's march, averaged and shared out as the thesis did it: `nunes2017_printed`.

Kept apart from `performance`: where the two differ, the thesis slipped (`docs/errata.md`), and the slips are the point.
"""

import numpy as np

from mechsym.cycle.chamber import chamber, piston_force
from mechsym.cycle.closed.model import ClosedEngine
from mechsym.cycle.closed.performance import Performance, figures
from mechsym.cycle.kinds.march import March, crank_torque, march, mean_torque
from mechsym.cycle.mixture import ConstantGamma
from mechsym.errors import BadInput

_TWO_PI = 6.28  # eq. (2.51)
_CV = 718.0  # table 3.2 [J/(kg K)]; R/(gamma - 1) is 717.5
_LAST = -1  # the energy shares end at 539 degrees, one step before the exhaust opens


def marched(engine: ClosedEngine, omega: np.ndarray) -> March:
    """The thesis's march of an engine.

    Parameters
    ----------
    omega : ndarray, shape (n,)
        Crank speeds [rad/s]
    """
    cycle = engine.cycle
    if abs(cycle.inlet_closes + np.pi) > 1e-12 or abs(cycle.exhaust_opens - np.pi) > 1e-12:
        raise BadInput(
            "method = 'nunes2017_printed' marches from -180 to 180 degrees; set cycle.inlet_closes and "
            "cycle.exhaust_opens to these"
        )
    return march(chamber(engine.chamber, engine.motion), cycle, _gas(engine), engine.heat_transfer, omega)


def performance_printed(engine: ClosedEngine, omega: np.ndarray) -> Performance:
    r"""Figures of the thesis at its one-degree march.

    .. math:: p_{mi} = 6.28\cdot 2\,\bar T/V_d, \quad \eta = 4\pi\bar T/(m_f Q_{HV}),
        \quad \text{exhaust} = m\,718\,(T_{539} - T_0)/(m_f Q_{HV})

    Parameters
    ----------
    engine : ClosedEngine
        The engine; its gas must be `ConstantGamma`, its closed period two whole strokes
    omega : ndarray, shape (n,)
        Crank speeds [rad/s]

    Returns
    -------
    performance : Performance
        Same entries as the converged figures; `unburnt` is the thesis's remainder (erratum E3)

    Notes
    -----
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
    found = figures(engine.friction_pressure, scalars, p_max) | {"mep": _TWO_PI * 2 * torque / room.displacement}
    work = np.sum((result.p[1:] + result.p[:-1]) / 2 * np.diff(result.v)[:, None], axis=0)
    shares = {
        "heat": (result.wall_heat + result.latent_heat)[:_LAST].sum(axis=0) / fuel_heat,
        "work": work / fuel_heat,
        "exhaust": result.mass * _CV * (result.t[:_LAST][-1] - engine.cycle.intake_temperature) / fuel_heat,
    }
    angle = np.radians(result.theta_deg - 360.0)[:, None]
    force = piston_force(room, angle, omega, result.p)
    return Performance(
        **found, **shares, unburnt=1 - sum(shares.values()), p_max=p_max, p_max_angle=angle[top, 0],
        t_max=result.t.max(axis=0), knock=np.full(omega.shape, np.nan),
        torque_max=crank_torque(room, result).max(axis=0), force_max=force.max(axis=0),
        energy_residual=_residual(result, gas, work) / fuel_heat, loads=_loads(engine, angle, omega, result),
    )  # fmt: skip


def _gas(engine: ClosedEngine) -> ConstantGamma:
    if not isinstance(engine.gas, ConstantGamma):
        raise BadInput("method = 'nunes2017_printed' marches with a constant gamma; set gas.model = 'constant_gamma'")
    return engine.gas


def _residual(result: March, gas: ConstantGamma, work: np.ndarray) -> np.ndarray:
    energy = (result.p[-1] * result.v[-1] - result.p[0] * result.v[0]) / (gas.gamma - 1)
    heat = result.heat_released - result.wall_heat - result.latent_heat
    return energy + work - heat.sum(axis=0)


def _loads(engine: ClosedEngine, angle: np.ndarray, omega: np.ndarray, result: March) -> dict[str, np.ndarray]:
    loads = engine.motion.loads
    if loads is None:
        return {}
    net = (result.p - engine.chamber.back_pressure) * np.pi / 4 * engine.chamber.bore**2
    rows = [np.broadcast_to(a, net.shape).reshape(1, -1) for a in (angle, omega, net)]
    parameters = np.array(list(engine.motion.parameters.values())).reshape(-1, 1)
    found = loads.call([rows[0], parameters, rows[1], rows[2]])
    largest = (np.abs(np.asarray(v)).reshape(net.shape).max(axis=0) for v in found)
    return dict(zip(loads.name_out(), largest, strict=True))
