r"""Friction and shaking of a mechanism of the user's own over one cycle at constant speed, by the roles declared.

.. math:: P = \sum_\mathrm{bearings} \mu\,r\,|R|\,|\omega_{rel}| + \sum_\mathrm{guides} \mu\,|N|\,|v|, \qquad
          F = -\frac{d}{dt}\sum m\,v

First order: the losses change neither reactions nor speed. The shaking force is that of all masses on the frame.
"""

import cmath
import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from mechsym.cases import Case
from mechsym.cycle.motion import slopes
from mechsym.forces.harmonics import orders
from mechsym.jobs import own
from mechsym.mechanisms.record import Mechanism

_HIGHEST = 6.0  # order of the shaking force that is told
_NO_PLACE = "none counted: declare m.bearing(name, reactions=(..), turns=..) or m.guide(name, reaction=.., travel=..)"


def friction(
    case: Case, mechanism: Mechanism, omega: float, phi: np.ndarray, columns: Mapping[str, np.ndarray]
) -> dict[str, Any] | None:
    """Mean power lost at every bearing and guide that the declaration names; None without `[friction]`.

    Parameters
    ----------
    omega : float
        Speed [rad/s]
    phi : ndarray, shape (n,)
        Crank angles over a cycle [rad]
    columns : mapping of str to ndarray
        Reactions at these angles by name [N]

    Returns
    -------
    friction : dict or None
        `places` and `power` [W]; a `note` where the declaration names no place
    """
    asked = case.sections.get("friction")
    if asked is None:
        return None
    bearings, guides = own.roles(case, "bearing"), own.roles(case, "guide")
    if not bearings and not guides:
        return {"places": {}, "power": 0.0, "note": _NO_PLACE}

    def rate(name: str) -> np.ndarray:
        return np.abs(np.asarray(slopes(mechanism, name, {})(phi[None, :])[1]).ravel()) * omega

    lost = {b["name"]: asked.mu_pin * _radius(case, b, asked) * np.hypot(*(columns[r] for r in b["reactions"]))
            * rate(b["turns"]) for b in bearings}  # fmt: skip
    lost |= {g["name"]: asked.mu_guide * np.abs(columns[g["reaction"]]) * rate(g["travel"]) for g in guides}
    places = {name: float(power.mean()) for name, power in lost.items()}
    return {"places": places, "power": sum(places.values())}


def _radius(case: Case, bearing: Mapping[str, Any], asked: Any) -> float:
    letter = bearing["radius"]
    if letter is None:
        return float(asked.radius_crank_pin)
    return float(getattr(case.need("parameters"), letter))


def shaking(omega: float, phi: np.ndarray, rates: Mapping[str, np.ndarray]) -> dict[str, Any]:
    """Shaking force on the frame by orders, and the counterweight on the shaft that lessens it most.

    Parameters
    ----------
    omega : float
        Speed [rad/s]
    phi : ndarray, shape (n,)
        Crank angles over a cycle, evenly spaced without its end [rad]
    rates : mapping of str to ndarray
        Rates of momentum along x and y, in this order [N]

    Returns
    -------
    shaking : dict
        `orders` of `force_x` and `force_y` [N]; `counterweight` with `unbalance` [kg*m] at `angle_deg` from the crank,
        `rms_before` and `rms_after` [N]
    """
    x, y = (-values for values in list(rates.values())[:2])
    force, period = x + 1j * y, float(phi[1] - phi[0]) * len(phi)
    turning = complex(np.mean(force * np.exp(-1j * phi)))
    rest = force - turning * np.exp(1j * phi)
    found = {name: orders(values, period, _HIGHEST) for name, values in (("force_x", x), ("force_y", y))}
    return {
        "orders": {n: {"order": o.order.tolist(), "amplitude": o.amplitude.tolist()} for n, o in found.items()},
        "counterweight": {
            "unbalance": abs(turning) / omega**2,
            "angle_deg": math.degrees(cmath.phase(-turning)) % 360 if turning else 0.0,
            "rms_before": float(np.sqrt(np.mean(np.abs(force) ** 2))),
            "rms_after": float(np.sqrt(np.mean(np.abs(rest) ** 2))),
        },
    }
