"""Forces of the derived hypocycloid mechanism over the speeds, for given moving masses."""

import dataclasses
import math
from collections.abc import Callable

import numpy as np

from mechsym.mechanisms.hypocycloid import HypocycloidParameters, build
from mechsym.mechanisms.record import evaluate
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
    # at constant speed each is a part that follows the net force and one that follows the speed squared, so one turn of
    # each says all of every speed; only the radial force has a sign of its own: the teeth push apart on both flanks
    one, mechanism = np.ones(gas.theta.size), build(parameters)
    pushed, turning = (
        evaluate(mechanism, "reactions", theta=gas.theta, thetad=speed * one, F=force * one)
        for speed, force in ((0.0, 1.0), (1.0, 0.0))
    )
    square = gas.omega[:, None] ** 2
    found = {
        name: pushed[name] * gas.net + turning[name] * square for name in ("pin_force", "tooth_force", "piston_torque")
    }
    return found | {"tooth_force_radial": np.abs(found["tooth_force"]) * math.tan(parameters.alpha_n)}
