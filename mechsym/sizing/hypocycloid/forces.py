"""Forces of the derived hypocycloid mechanism over the speeds, for given moving masses."""

import dataclasses
from collections.abc import Callable

import casadi as ca
import numpy as np

from mechsym.mechanisms.hypocycloid import HypocycloidParameters, build
from mechsym.sizing.hypocycloid.masses import Moving
from mechsym.sizing.hypocycloid.parts import PartForces
from mechsym.sizing.pressures import Pressures


def hypocycloid_forces(gas: Pressures, parameters: HypocycloidParameters) -> Callable[[Moving], PartForces]:
    """Moving masses -> forces over the speeds."""

    def forces_of(moving: Moving) -> PartForces:
        masses = dataclasses.replace(parameters, m2=moving.planet, m3=moving.axis, u1=-moving.planet * parameters.e)
        out = _reactions(masses, gas)
        share = moving.rod / moving.axis
        return PartForces(
            omega=gas.omega, theta=gas.theta, dp_max=gas.dp_max, net=out["pin_force"],
            rod=gas.net - share * (gas.net - out["pin_force"]), tooth=out["tooth_force"],
            radial=out["tooth_force_radial"], torque=out["piston_torque"],
            spin=moving.planet * parameters.e * gas.omega**2, e=parameters.e,
            bore=gas.bore, stroke=gas.stroke, head_heat=gas.head_heat, gap=gas.gap,
        )  # fmt: skip

    return forces_of


def _reactions(parameters: HypocycloidParameters, gas: Pressures) -> dict[str, np.ndarray]:
    function, shape = build(parameters).functions["reactions"], gas.net.shape
    rows = {
        "theta": np.broadcast_to(gas.theta, shape),
        "thetad": np.broadcast_to(gas.omega[:, None], shape),
        "F": gas.net,
    }
    inputs = [ca.DM(np.reshape(rows.get(name, np.zeros(shape)), (1, -1))) for name in function.name_in()]
    values = function.call(inputs)
    return {name: np.asarray(v).reshape(shape) for name, v in zip(function.name_out(), values, strict=True)}
