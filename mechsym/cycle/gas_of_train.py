"""The gas that the cylinders of a crank train share: Stirling engines."""

import math
from collections.abc import Callable
from typing import Any

import casadi as ca

from mechsym.cycle.chamber import Chamber, piston_area
from mechsym.cycle.dead_centres import motion_over
from mechsym.cycle.gas import Gas
from mechsym.cycle.kinds.stirling import StirlingEngine, stirling_engine, stirling_pressure
from mechsym.cycle.kinds.stirling_second_order import StirlingLosses
from mechsym.cycle.kinds.stirling_spaces import StirlingCylinders, areas
from mechsym.errors import BadInput
from mechsym.mechanisms.crank_train import build_rigid
from mechsym.mechanisms.crank_train.parameters import CrankTrainParameters, each
from mechsym.mechanisms.traits import is_train, name_of, with_trait


def gas_of_train(
    cycle: StirlingCylinders, train: CrankTrainParameters, omega: float, losses: StirlingLosses | None = None
) -> Gas:
    """Gas that the two cylinders of a crank train share; its chamber is the hot one.

    Parameters
    ----------
    omega : float
        Shaft speed, for a cycle that depends on it [rad/s]
    """
    return gas_of_engine_on(engine_of_train(cycle, train, omega, losses), cycle, train)


def gas_of_engine_on(engine: StirlingEngine, cycle: StirlingCylinders, train: CrankTrainParameters) -> Gas:
    """Gas of a Stirling engine whose turn is known, on its crank train."""
    kinematics, phi = build_rigid(train).functions["kinematics"], ca.SX.sym("phi")
    found = dict(zip(kinematics.name_out(), kinematics(phi), strict=True))
    hot = ca.Function("hot", [phi], [found["x_1"], found["dx_1_dphi"]], ["phi"], ["x", "dx_dphi"])
    area, stroke = piston_area(cycle.bore), 2 * each(train, "r")[0]
    room = Chamber(
        motion=motion_over(hot), pistons=1, bore=cycle.bore, area=area, stroke=stroke, clearance=cycle.dead_hot,
        displacement=area * stroke, back_pressure=cycle.p_back,
        compression_ratio=1 + area * stroke / cycle.dead_hot if cycle.dead_hot else math.inf,
    )  # fmt: skip
    pistons = areas(cycle).sum(axis=0).tolist()
    return Gas(pressure=stirling_pressure(engine), chamber=room, pistons=tuple(pistons))


def engine_of_train(
    cycle: StirlingCylinders, train: CrankTrainParameters, omega: float, losses: StirlingLosses | None = None
) -> StirlingEngine:
    """The Stirling engine on a crank train.

    Parameters
    ----------
    omega : float
        Shaft speed, for a cycle that depends on it [rad/s]
    """
    if not is_train(name_of(type(train))) or len(train.throw) != 2:
        trains = " or ".join(with_trait(lambda known: known.assembled))
        raise BadInput(f"[cycle] of a Stirling engine needs a {trains} with two cylinders, hot and cold")
    kinematics = build_rigid(train).functions["kinematics"]

    def travel(name: str) -> Callable[[Any], Any]:
        return lambda phi: kinematics.call([phi])[kinematics.name_out().index(name)]

    return stirling_engine(cycle, (travel("x_1"), travel("x_2")), omega, losses)
