r"""What crank, rod and speed say together.

.. math:: c_m = 2 S n, \qquad S = 2 r \text{ (slider crank)}, \quad 4 e \text{ or } 4 r \text{ (hypocycloid, rodless)}
"""

import math

from mechsym.errors import BadInput
from mechsym.plausible.judge import Doubt

_FAST, _IMPOSSIBLE = 30.0, 100.0  # mean piston speed: racing engines reach 27 m/s [m/s]
_SHORT, _LONG = 1.8, 8.0  # rod length over crank radius [-]


def proportions(stroke: float | None, ratio: float | None, omega: float | None) -> tuple[Doubt, ...]:
    """Mean piston speed and rod ratio of an engine.

    Parameters
    ----------
    stroke : float or None
        Travel of the piston between its dead centres; None where it is not known [m]
    ratio : float or None
        Rod length over crank radius; None without a rod [-]
    omega : float or None
        Speed of operation [rad/s]

    Returns
    -------
    doubts : tuple of Doubt
        `piston_speed` above 30 m/s, `rod_ratio` outside 1.8 to 8

    Raises
    ------
    BadInput
        A mean piston speed above 100 m/s

    Notes
    -----
    Source: Heywood (1988), Internal combustion engine fundamentals, sections 2.2 and 2.6.

    Examples
    --------
    >>> [f"{d.code} {d.value:.0f} m/s" for d in proportions(0.1, 3.5, 1000.0)]
    ['piston_speed 32 m/s']
    """
    found = []
    if stroke is not None and omega is not None:
        speed = 2 * stroke * abs(omega) / (2 * math.pi)
        if speed > _IMPOSSIBLE:
            mean = f"speed = {omega:g} rad/s with a stroke of {stroke:g} m is a mean piston speed of {speed:.4g} m/s"
            raise BadInput(f"operation.{mean}; engines stay below {_FAST:g} m/s: check speed, crank and units")
        if speed > _FAST:
            why = "racing engines reach 27 m/s"
            found.append(Doubt(code="piston_speed", quantity="mean piston speed [m/s]", value=speed,
                               usual=f"at most {_FAST:g} m/s", why=why))  # fmt: skip
    if ratio is not None and not _SHORT <= ratio <= _LONG:
        why, usual = "rods of engines are 3 to 5 crank radii long", f"{_SHORT:g} to {_LONG:g}"
        found.append(Doubt(code="rod_ratio", quantity="rod length / crank radius", value=ratio, usual=usual, why=why))
    return tuple(found)
