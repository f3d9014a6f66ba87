r"""What an engine does as one differentiable CasADi function of its design, for gradients and optimisation.

The function runs the very operations of `run` and `performance`. A peak (pressure, force, a load of the mechanism) is
given as the vector of its values along the cycle: a bound on the peak is a bound on each of them, which stays smooth
where the place of the peak jumps.
"""

from collections.abc import Mapping, Sequence
from functools import partial

import casadi as ca
import numpy as np

from mechsym.cycle.closed.blowdown import open_function
from mechsym.cycle.closed.model import ClosedEngine, at_design, closed_period
from mechsym.cycle.closed.performance import force_function
from mechsym.cycle.closed.phases import closed_function
from mechsym.cycle.friction import Friction, friction_pressure
from mechsym.cycle.knock import knock_integral

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
    found = dict(zip(closed.name_out(), closed.call([design]), strict=True))
    points = found["phi"].numel()
    along = force_function(engine, tuple(names)).map(points)
    values = along.call([ca.repmat(design, 1, points), found["phi"], found["p"]])
    forces = {name: value.T for name, value in zip(along.name_out(), values, strict=True)}
    peaks = {
        "p_max": found["p"].T,
        "t_max": found["t"].T,
        "force_max": forces.pop("force"),
        "torque_max": forces.pop("torque"),
        **forces,
    }
    if engine.blowdown is not None:
        exchange = open_function(partial(closed_period, engine), names)
        found["exchange_work"] = exchange(design, found["t"][-1])[2]
    here = at_design(engine, {name: design[k] for k, name in enumerate(names)})
    knock = knock_integral(found, steps, here.gas, here.cycle.octane)
    outputs = _scalars(found, here.friction_pressure) | {"knock": knock} | peaks
    return ca.Function("engine", [design], list(outputs.values()), ["design"], list(outputs))


def _scalars(found: Mapping[str, ca.MX], friction: Friction) -> dict[str, ca.MX]:
    omega, fuel, displacement = found["omega"], found["fuel"], found["displacement"]
    work = found["work"] + found["exchange_work"]
    speed = found["stroke"] * omega / np.pi
    brake = work - displacement * friction_pressure(friction, ca.mmax(found["p"]), speed, omega)
    outputs = {"displacement": displacement, "piston_speed": speed, "stroke": found["stroke"]}
    for prefix, energy in (("", work), ("brake_", brake)):
        torque = energy / (4 * np.pi)
        outputs |= {
            f"{prefix}efficiency": energy / found["fuel_heat"],
            "brake_torque" if prefix else "torque_avg": torque,
            f"{prefix}power": torque * omega,
            f"{prefix}mep": energy / displacement,
            f"{prefix}sfc": fuel / energy,
        }
    return {name: outputs[name] for name in SCALAR_UNITS if name in outputs}
