"""What every single slider crank says of its forces: one pin, one main bearing, one guide, and where they rub."""

import numpy as np

from mechsym.mechanisms.chain import Loads, Pin, Rubbing, TurnSeen


def single(turn: TurnSeen, radius: float, weight: np.ndarray) -> Loads:
    """Loads of a slider crank by its joint reactions.

    Parameters
    ----------
    radius : float
        Of the crank [m]
    weight : ndarray, shape (n,)
        Torque of the crank's own weight [N*m]
    """
    R = turn.reactions
    pin = Pin(name="crank_pin", angle=turn.phi, radius=radius, sense=1.0, x=-R["R_x_A"], y=-R["R_y_A"])
    return Loads(
        pins=(pin,), bearings={"main_bearing": (R["R_x_O"], R["R_y_O"])}, guides={"side_force": R["R_y_G"]},
        weight_torque=weight,
    )  # fmt: skip


def rubbing(turn: TurnSeen, found: Loads) -> tuple[Rubbing, ...]:
    """Guide, piston pin and crank pin of a slider crank."""
    R, w = turn.reactions, turn.omega
    swing = turn.kinematics["dpsi_dphi"] * w
    return (
        Rubbing(place="guides", force=found.guides["side_force"], speed=turn.kinematics["dx_dphi"] * w),
        Rubbing(place="piston_pins", force=np.hypot(R["R_x_B"], R["R_y_B"]), speed=swing),
        Rubbing(place="crank_pins", force=np.hypot(R["R_x_A"], R["R_y_A"]), speed=w + swing),
    )
