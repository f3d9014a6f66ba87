r"""What crank, rod, masses, spring and speed say together.

.. math:: c_m = 2 S n, \qquad S = 2 r \text{ (slider crank)}, \quad 4 e \text{ or } 4 r \text{ (hypocycloid, rodless)}
"""

import math
from collections.abc import Mapping

from mechsym.plausible.judge import Doubt, proportion


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
    found: tuple[Doubt, ...] = ()
    if stroke is not None and omega is not None:
        what = f"mean piston speed (operation.speed = {omega:g} rad/s, stroke {stroke:g} m)"
        found += proportion("piston_speed", what, stroke * abs(omega) / math.pi)
    if ratio is not None:
        found += proportion("rod_ratio", "rod length / crank radius", ratio)
    return found


def scaled(masses: Mapping[str, tuple[float, float]], spring: float | None, piston: float | None) -> tuple[Doubt, ...]:
    """Masses and spring of an engine by the area of its piston.

    Parameters
    ----------
    masses : mapping of str to tuple of float
        Name of what moves to and fro, to its mass and the area of its pistons [kg, m^2]
    spring : float or None
        Piston area of the spring of a hinge; None without one [m^2]
    piston : float or None
        Piston area of the engine; None where it is not known [m^2]

    Returns
    -------
    doubts : tuple of Doubt
        `reciprocating_mass` outside 20 to 20,000 kg/m^2, `spring_area` outside 0.01 to 3

    Raises
    ------
    BadInput
        More than a factor of fifty to a hundred beyond

    Notes
    -----
    Source: masses by area of engines in Heywood (1988), chapter 2, and of slow marine engines with crosshead.

    Examples
    --------
    >>> [f"{d.code} {d.value:.0f}" for d in scaled({"m5": (250.0, 2.83e-3)}, 0.031, 0.0707)]
    ['reciprocating_mass 88339']
    """
    found: tuple[Doubt, ...] = ()
    for name, (mass, area) in masses.items():
        if mass:  # without mass is a model, not a mistake
            found += proportion("reciprocating_mass", f"parameters.{name} / piston area", mass / area)
    if spring is not None and piston:
        found += proportion("spring_area", "spring.A / piston area", spring / piston)
    return found
