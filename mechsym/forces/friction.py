r"""First-order friction losses: Coulomb's law on the reactions of the frictionless machine.

.. math:: P = \sum \mu\,|N|\,|v| + \sum \mu\,r\,|R|\,|\omega_{rel}| + P_\mathrm{mesh} + P_\mathrm{rings}

The losses are taken as small: they change neither the reactions nor the speed. Every source claims less friction
without a rod or a side force; with the same coefficients everywhere that can be judged.
"""

import numpy as np

from mechsym.forces.rings import Rings, ring_power
from mechsym.forces.turn import Turn, chain_of
from mechsym.mechanisms.chain import Loads, Rubbing
from mechsym.quantities import quantity, record


@record
class Friction:
    """Section `[friction]`: coefficients and radii."""

    mu_guide: float = quantity("-", low=0, about="friction of piston or slider on its guide")
    mu_pin: float = quantity("-", low=0, about="friction of piston and crank pins")
    mu_main: float = quantity("-", low=0, about="friction of the main bearings")
    mu_mesh: float = quantity("-", default=0.0, low=0, about="friction of the teeth")
    radius_piston_pin: float = quantity("m", above=0, about="radius of the piston pin")
    radius_crank_pin: float = quantity("m", above=0, about="radius of the crank pin")
    radius_main: float = quantity("m", above=0, about="radius of the main bearings")
    module: float = quantity("m", default=0.0, low=0, about="module of the teeth")
    contact_ratio: float = quantity("-", default=1.6, low=1, about="contact ratio of the teeth")


@record
class Losses:
    """Friction of a machine at constant speed."""

    places: dict[str, float]  #: Mean power lost at guides, piston pins, crank pins, main bearings, teeth, rings [W]
    curves: dict[str, np.ndarray]  #: shape (n,): The same over the angle [W]
    indicated_power: float  #: Mean power of the gas [W]
    mechanical_efficiency: float | None  #: (indicated - lost) / indicated; None where the gas gives no power [-]
    friction_mean_pressure: float | None  #: Work lost in a cycle over the swept volume; None without a cylinder [Pa]


Powers = dict[str, np.ndarray]


def losses(turn: Turn, found: Loads, friction: Friction, rings: Rings) -> Losses:
    """Friction losses of a turn.

    Returns
    -------
    losses : Losses
        By place, and what they cost
    """
    curves = _rubbed(turn, found, friction)
    shaft = sum((np.hypot(x, y) for x, y in found.bearings.values()), np.zeros_like(turn.phi))
    curves["main_bearings"] = friction.mu_main * friction.radius_main * shaft * turn.omega
    if turn.gas is not None:
        curves["rings"] = _rings(turn, rings)
    places = {name: float(power.mean()) for name, power in curves.items()}
    lost, gained = sum(places.values()), float(turn.gas_power.mean())
    return Losses(
        places=places,
        curves=curves,
        indicated_power=gained,
        mechanical_efficiency=1 - lost / gained if gained > 0 else None,
        friction_mean_pressure=lost * turn.period / turn.omega / swept_volume(turn) if turn.gas else None,
    )


def pistons(turn: Turn) -> list[tuple[np.ndarray, np.ndarray]]:
    """Working faces of a machine.

    Returns
    -------
    faces : list of (ndarray, ndarray)
        For each face the angle from its firing dead centre [rad] and the speed of its piston [m/s]
    """
    return chain_of(turn.drive).faces(turn)


def swept_volume(turn: Turn) -> float:
    """Volume that all pistons sweep together.

    Returns
    -------
    volume : float
        Swept volume [m^3]
    """
    assert turn.gas is not None
    areas = chain_of(turn.drive).areas
    if areas is not None:
        return sum(areas(turn.drive)) * turn.gas.chamber.stroke
    return turn.gas.chamber.area * turn.gas.chamber.stroke * len(pistons(turn))


def _rings(turn: Turn, law: Rings) -> np.ndarray:
    assert turn.gas is not None
    faces = pistons(turn)
    return sum((ring_power(law, turn.gas, phi, v, turn.omega) for phi, v in faces), np.zeros_like(turn.phi))


def _rubbed(turn: Turn, found: Loads, f: Friction) -> Powers:
    """Power lost over the angle, by place [W]."""
    powers: Powers = {}
    for rubs in chain_of(turn.drive).rubbing(turn, found):
        lost = _law(f, rubs)
        powers[rubs.place] = powers[rubs.place] + lost if rubs.place in powers else lost
    return powers


def _law(f: Friction, rubs: Rubbing) -> np.ndarray:
    if rubs.place == "teeth":
        return mesh_power(f, rubs.force, rubs.speed)
    if rubs.place == "guides":
        return f.mu_guide * np.abs(rubs.force * rubs.speed)
    radius = {"piston_pins": f.radius_piston_pin, "crank_pins": f.radius_crank_pin}[rubs.place]
    return f.mu_pin * (rubs.force * radius * np.abs(rubs.speed))


def mesh_power(friction: Friction, tooth_force: np.ndarray, omega_rel: float | np.ndarray) -> np.ndarray:
    r"""Power lost between teeth.

    .. math:: P = \mu\,|W_t|\,\omega_{rel}\,\pi m\,\epsilon / 4

    The flanks slide with omega_rel times the distance from the pitch point, on average a quarter of the length of
    contact eps pi m cos(alpha_n); the normal force is W_t / cos(alpha_n).

    Parameters
    ----------
    tooth_force : ndarray, shape (n,)
        Tangential force [N]
    omega_rel : float or ndarray, shape (n,)
        Speed of one gear against the other [rad/s]

    Returns
    -------
    power : ndarray, shape (n,)
        Lost power [W]

    Notes
    -----
    Valid: pitch point in the middle of the path of contact, load spread evenly over the path.
    """
    slide = np.pi * friction.module * friction.contact_ratio / 4
    return friction.mu_mesh * np.abs(tooth_force) * omega_rel * slide
