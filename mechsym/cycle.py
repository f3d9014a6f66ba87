"""The engine of a case and what it does over the speeds: case -> motion -> engine -> performance."""

from dataclasses import asdict
from typing import Any

import numpy as np

from mechsym.cases import Case
from mechsym.engine.friction import NoFriction
from mechsym.engine.gas import ConstantGamma
from mechsym.engine.model import Engine
from mechsym.engine.performance import Performance, performance
from mechsym.engine.printed import performance_printed
from mechsym.engine.spark_ignition import SparkIgnition
from mechsym.errors import BadInput
from mechsym.motion import motion

RPM = np.pi / 30


def engine(case: Case) -> Engine:
    """The engine that a case describes.

    Parameters
    ----------
    case : Case
        With sections `[parameters]`, `[chamber]`, `[cycle]` and `[heat_transfer]`; `[gas]` and `[friction_pressure]`
        default to a constant gamma and no friction

    Returns
    -------
    engine : Engine
        Ready for `performance`

    Raises
    ------
    BadInput
        A section is missing, or the cycle is of another kind
    """
    cycle = case.need("cycle")
    if not isinstance(cycle, SparkIgnition):
        raise BadInput(f"{case.file}: [cycle] is not of kind 'spark-ignition', which this command needs")
    return Engine(
        chamber=case.need("chamber"),
        motion=motion(case.mechanism, asdict(case.need("parameters"))),
        cycle=cycle,
        gas=case.sections.get("gas", ConstantGamma()),
        heat_transfer=case.need("heat_transfer"),
        friction_pressure=case.sections.get("friction_pressure", NoFriction()),
    )


def over_speeds(engine: Engine, omega: np.ndarray) -> Performance:
    """Figures over the speeds, by the method that the cycle names.

    Parameters
    ----------
    engine : Engine
        The engine
    omega : ndarray, shape (n,)
        Crank speeds [rad/s]

    Returns
    -------
    performance : Performance
        Figures at the n speeds
    """
    if engine.cycle.method == "nunes2017_printed":
        return performance_printed(engine, omega)
    return performance(engine, {"omega": omega})


def columns(found: Performance) -> dict[str, Any]:
    """Figures under the names and units of the command line.

    Parameters
    ----------
    found : Performance
        Figures at n points

    Returns
    -------
    columns : dict
        `speed_rpm`, `torque_avg`, ...; `fractions` and `loads` are mappings
    """
    shares = {name: getattr(found, name) for name in ("heat", "work", "exhaust", "unburnt")}
    return {
        "speed_rpm": found.omega / RPM,
        "torque_avg": found.torque_avg,
        "torque_max": found.torque_max,
        "power_kw": found.power / 1e3,
        "mep_kpa": found.mep / 1e3,
        "sfc_g_kwh": found.sfc * 3.6e9,
        "efficiency": found.efficiency,
        "p_max_mpa": found.p_max / 1e6,
        "p_max_angle_deg": np.degrees(found.p_max_angle),
        "force_max": found.force_max,
        "fractions": shares,
        "loads": found.loads,
        "friction_mep_kpa": found.friction_mep / 1e3,
        "brake_torque": found.brake_torque,
        "brake_power_kw": found.brake_power / 1e3,
        "brake_sfc_g_kwh": found.brake_sfc * 3.6e9,
        "brake_efficiency": found.brake_efficiency,
        "energy_residual": found.energy_residual,
    }
