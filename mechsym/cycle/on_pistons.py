"""Gas pressure on the pistons of a case, whatever kind of cycle it has.

The gas knows one cylinder of the mechanism. Mechanisms whose pistons move alike share a view of it: the rodless slider
moves as the piston of a hypocycloid with e = r, and a crank train's cylinder as that of a single throw.
"""

import dataclasses
import math
from collections.abc import Callable
from typing import Any

import casadi as ca
import numpy as np
from numpy.polynomial import Chebyshev

from mechsym import mechanisms
from mechsym.cases import Case
from mechsym.cycle.cylinder import piston_area
from mechsym.cycle.kinds import back_pressure, cylinder_pressure, with_diagram
from mechsym.cycle.kinds.schmidt import Schmidt, schmidt_pressure
from mechsym.cycle.kinds.spark_ignition import SparkIgnition
from mechsym.cycle.measured.diagram import Diagram
from mechsym.cycle.pressure import periodic
from mechsym.errors import BadInput
from mechsym.mechanisms.crank_throw import CrankThrowParameters
from mechsym.mechanisms.crank_train.parameters import CrankTrainParameters, build_rigid, each
from mechsym.mechanisms.hypocycloid import HypocycloidParameters
from mechsym.mechanisms.rodless import RodlessParameters
from mechsym.quantities import record

_STEP = math.radians(0.25)  # of the tabulated cycle
_DEGREE = 60  # round-off for rods down to 1.2 crank radii


@record
class Gas:
    """Pressure on one piston over the angle from its firing dead centre."""

    absolute: Callable[[Any], Any]  #: Angle, ndarray, to absolute pressure [Pa]
    p_back: float  #: Absolute pressure on the other side of the piston [Pa]
    period: float  #: 2 pi or 4 pi [rad]
    bore: float  #: Of one piston [m]
    area: float  #: [m^2]
    stroke: float  #: [m]
    compression_ratio: float  #: Largest over smallest volume of one cylinder [-]
    facts: tuple[str, ...]  #: What was assumed, one sentence each
    #: Angles in [0, period) where the pressure is not smooth; empty where none are known [rad]
    kinks: tuple[float, ...] = ()


def gas(case: Case) -> Gas | None:
    """Gas of a case.

    Returns
    -------
    gas : Gas or None
        None for a case without a cycle: only inertia and weight act
    """
    if "cycle" not in case.sections:
        return None
    if isinstance(case.sections["cycle"], Schmidt):
        return _schmidt(case)
    seen = one_cylinder(case)
    if isinstance(case.sections["cycle"], SparkIgnition):
        return _spark(seen)
    cycle = seen.sections["cycle"]
    pressure, cylinder = cylinder_pressure(cycle, travel(seen))
    return Gas(
        absolute=pressure.absolute,
        p_back=back_pressure(cycle),
        period=pressure.period,
        bore=cylinder.bore,
        area=piston_area(cylinder.bore),
        stroke=cylinder.stroke,
        compression_ratio=cylinder.compression_ratio,
        facts=pressure.facts,
        kinks=pressure.kinks,
    )


def measured(case: Case, file: str) -> Case:
    """The case with a measured diagram in place of its cycle.

    Parameters
    ----------
    case : Case
        With `[cycle]`; of spark ignition `[chamber]` gives the cylinder
    """
    cycle = case.need("cycle")
    if isinstance(cycle, SparkIgnition):
        room = case.need("chamber")
        cycle = Diagram(
            bore=room.bore,
            compression_ratio=room.compression_ratio,
            working_cycle="four-stroke",
            inlet_pressure=cycle.intake_pressure,
            p_back=room.back_pressure,
        )
    return dataclasses.replace(case, sections={**case.sections, "cycle": with_diagram(cycle, file)})


def _spark(case: Case) -> Gas:
    from mechsym.cycle.chamber import chamber
    from mechsym.jobs import cycle

    engine, omega = cycle.engine(case), case.need("operation").speed
    found, room, charge = cycle.curves(engine, omega, _STEP), chamber(engine.chamber, engine.motion), engine.cycle
    phi = np.radians(found["phi_deg"])

    def closed_or_open(angle: np.ndarray) -> np.ndarray:
        return np.interp(angle, phi, found["p_pa"], left=charge.intake_pressure, right=charge.intake_pressure)

    return Gas(
        absolute=periodic(closed_or_open, 4 * math.pi, -2 * math.pi),
        p_back=room.back_pressure,
        period=4 * math.pi,
        bore=room.bore,
        area=float(room.area),
        stroke=float(room.stroke),
        compression_ratio=engine.chamber.compression_ratio,
        facts=("gas exchange takes place at intake pressure: assumed, the cycle models the closed period only",),
    )


def _schmidt(case: Case) -> Gas:
    cycle, parameters = case.sections["cycle"], case.need("parameters")
    if not isinstance(parameters, CrankTrainParameters) or len(parameters.throw) != 2:
        raise BadInput(f"{case.file}: [cycle] of kind 'schmidt' needs a crank_train with two cylinders, hot and cold")
    kinematics, phi = build_rigid(parameters).functions["kinematics"], ca.SX.sym("phi")
    found = dict(zip(kinematics.name_out(), kinematics(phi), strict=True))
    travels = [_vectorised(ca.Function("x", [phi], [found[f"x_{i}"]])) for i in (1, 2)]
    pressure = schmidt_pressure(cycle, *travels)
    stroke = 2 * each(parameters, "r")[0]
    area = piston_area(cycle.bore)
    return Gas(
        absolute=pressure.absolute,
        p_back=cycle.p_back,
        period=pressure.period,
        bore=cycle.bore,
        area=area,
        stroke=stroke,
        compression_ratio=1 + area * stroke / cycle.dead_hot if cycle.dead_hot else math.inf,
        facts=pressure.facts,
    )


def _vectorised(function: ca.Function) -> Callable[[np.ndarray], np.ndarray]:
    return lambda phi: np.asarray(function(np.reshape(phi, (1, -1)))).reshape(np.shape(phi))


def one_cylinder(case: Case) -> Case:
    """The case as one cylinder of it sees itself.

    Returns
    -------
    case : Case
        With a mechanism that has one piston and its travel as `x`
    """
    parameters = case.need("parameters")
    if isinstance(parameters, RodlessParameters):
        p = parameters
        return _seen(case, "hypocycloid", HypocycloidParameters(e=p.r, I1=p.I1, m2=0, I2=0, m3=p.m_a, alpha_n=0))
    if isinstance(parameters, CrankTrainParameters):
        letters = {n: each(parameters, n)[0] for n in ("r", "l1", "l2", "offset", "m_rod", "I_rod", "m_piston")}
        parameters = CrankThrowParameters(**letters, I0=each(parameters, "I0")[0])
        case = _seen(case, "crank_throw", parameters)
    if isinstance(parameters, CrankThrowParameters) and parameters.offset != 0:
        raise BadInput(
            f"{case.file}: offset = {parameters.offset:g} m: the cycles know dead centres half a turn apart; "
            "set offset = 0 or leave [cycle] out"
        )
    return case


def _seen(case: Case, mechanism: str, parameters: Any) -> Case:
    return dataclasses.replace(case, mechanism=mechanism, sections={**case.sections, "parameters": parameters})


def travel(case: Case) -> ca.Function:
    """Travel of the piston of a mechanism with one coordinate.

    Returns
    -------
    function : casadi.Function
        phi to `x` [m] and `dx_dphi` [m/rad]
    """
    mechanism = mechanisms.build(case.mechanism, case.need("parameters"))
    kinematics, phi = mechanism.functions["kinematics"], ca.SX.sym("phi")
    if len(mechanism.coordinates) != 1 or "x" not in kinematics.name_out():
        raise BadInput(f"{case.file}: mechanism {case.mechanism} has no piston that a cycle could drive")
    found = kinematics(phi)
    values = dict(zip(kinematics.name_out(), found, strict=True))
    outputs = [values["x"], values[f"dx_d{mechanism.coordinates[0]}"]]
    return ca.Function("travel", [phi], outputs, ["phi"], ["x", "dx_dphi"])


def at_same_travel(found: Gas, own: ca.Function, other: ca.Function) -> Gas:
    r"""The same indicator diagram over another motion of equal stroke: equal pressure at equal travel, so equal work.

    .. math:: p_{other}(\theta) = p(\varphi), \quad x_{own}(\varphi) = x_{other}(\theta)

    Parameters
    ----------
    own, other : casadi.Function
        Travels of `travel`, both with dead centres at 0 and pi

    Returns
    -------
    gas : Gas
        Over the motion `other`, whose kinks are not looked for
    """

    # travel is even in the angle, so one cosine is a smooth function of the other: a polynomial found once
    cosine = Chebyshev.interpolate(lambda c: np.cos(_angle_at(own, _travelled(other, np.arccos(c)))), _DEGREE)

    def absolute(theta: np.ndarray) -> np.ndarray:
        theta = np.asarray(theta, dtype=float)
        half = np.ceil(theta / math.pi) - 1  # a valve that opens at the dead centre opens after it
        angle = np.arccos(np.clip(cosine(np.cos(theta)), -1.0, 1.0))
        return found.absolute(np.where(half % 2 == 0, half * math.pi + angle, (half + 1) * math.pi - angle))

    return dataclasses.replace(found, absolute=absolute, kinks=())


def _travelled(motion: ca.Function, phi: np.ndarray) -> np.ndarray:
    return np.asarray(motion(phi.reshape(1, -1))[0]).reshape(phi.shape)


def _angle_at(motion: ca.Function, x: np.ndarray) -> np.ndarray:
    # between the dead centres the travel only grows: bisection to the last digit, with no slope to divide by
    low, high = np.zeros_like(x), np.full_like(x, math.pi)
    for _ in range(54):
        middle = (low + high) / 2
        short = _travelled(motion, middle) < x
        low, high = np.where(short, middle, low), np.where(short, high, middle)
    return (low + high) / 2
