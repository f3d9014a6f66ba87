r"""First-order friction losses: Coulomb's law on the reactions of the frictionless machine.

.. math:: P = \sum \mu\,|N|\,|v| + \sum \mu\,r\,|R|\,|\omega_{rel}| + P_\mathrm{mesh} + P_\mathrm{rings}

The losses are taken as small: they change neither the reactions nor the speed. Every source claims less friction
without a rod or a side force; with the same coefficients everywhere that can be judged.
"""

from collections.abc import Callable

import numpy as np

from mechsym.forces.loads import Loads
from mechsym.forces.rings import Rings, ring_power
from mechsym.forces.turn import Turn, faces_of
from mechsym.mechanisms.crank_train.parameters import each
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
    curves = _PLACES[turn.drive.name](turn, found, friction)
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
    q = turn.drive.mechanism.coordinates[0]
    if turn.drive.name == "rodless":
        faces = faces_of(turn.drive)
        rows = zip(faces.sides, faces.firing, strict=True)
        return [(turn.phi - fires, turn.kinematics[f"dx_{side[0]}_d{q}"] * turn.omega) for side, fires in rows]
    if turn.drive.name == "crank_train":
        p = turn.drive.parameters
        firing = each(p, "firing") or (0.0,) * len(p.throw)
        return [(turn.phi - f, turn.kinematics[f"dx_{i}_d{q}"] * turn.omega) for i, f in enumerate(firing, 1)]
    return [(turn.phi, turn.kinematics[f"dx_d{q}"] * turn.omega)]


def swept_volume(turn: Turn) -> float:
    """Volume that all pistons sweep together.

    Returns
    -------
    volume : float
        Swept volume [m^3]
    """
    assert turn.gas is not None
    if turn.drive.name == "rodless":
        return sum(faces_of(turn.drive).areas) * turn.gas.chamber.stroke
    return turn.gas.chamber.area * turn.gas.chamber.stroke * len(pistons(turn))


def _rings(turn: Turn, law: Rings) -> np.ndarray:
    assert turn.gas is not None
    faces = pistons(turn)
    return sum((ring_power(law, turn.gas, phi, v, turn.omega) for phi, v in faces), np.zeros_like(turn.phi))


def _slider_crank(turn: Turn, found: Loads, f: Friction) -> Powers:
    R, w = turn.reactions, turn.omega
    swing = turn.kinematics["dpsi_dphi"] * w
    speed = turn.kinematics["dx_dphi"] * w
    piston_pin = np.hypot(R["R_x_B"], R["R_y_B"]) * f.radius_piston_pin * np.abs(swing)
    crank_pin = np.hypot(R["R_x_A"], R["R_y_A"]) * f.radius_crank_pin * np.abs(w + swing)
    return {
        "guides": f.mu_guide * np.abs(found.guides["side_force"] * speed),
        "piston_pins": f.mu_pin * piston_pin,
        "crank_pins": f.mu_pin * crank_pin,
    }


def _hypocycloid(turn: Turn, found: Loads, f: Friction) -> Powers:
    R, w, pin = turn.reactions, turn.omega, found.pins[0]
    # the planet turns at -omega: against the rod at omega, in the crank at 2 omega, against the ring at omega
    return {
        "guides": np.zeros_like(turn.phi),
        "piston_pins": f.mu_pin * f.radius_piston_pin * np.abs(R["pin_force"]) * w,
        "crank_pins": f.mu_pin * f.radius_crank_pin * np.hypot(pin.x, pin.y) * 2 * w,
        "teeth": mesh_power(f, R["tooth_force"], w),
    }


def mesh_power(friction: Friction, tooth_force: np.ndarray, omega_rel: float) -> np.ndarray:
    r"""Power lost between teeth.

    .. math:: P = \mu\,|W_t|\,\omega_{rel}\,\pi m\,\epsilon / 4

    The flanks slide with omega_rel times the distance from the pitch point, on average a quarter of the length of
    contact eps pi m cos(alpha_n); the normal force is W_t / cos(alpha_n).

    Parameters
    ----------
    tooth_force : ndarray, shape (n,)
        Tangential force [N]
    omega_rel : float
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


def _rodless(turn: Turn, found: Loads, f: Friction) -> Powers:
    R, w, pin = turn.reactions, turn.omega, found.pins[0]
    # the link turns at -omega: against the sliders at omega, on the crank pin at 2 omega
    guides, journals = np.zeros_like(turn.phi), np.zeros_like(turn.phi)
    for axis in "ab":
        guides = guides + np.abs(found.guides[f"side_force_{axis}"] * turn.kinematics[f"dx_{axis}_dalpha"] * w)
        journals = journals + np.hypot(R[f"journal_force_{axis}_along"], R[f"journal_force_{axis}_across"])
    return {
        "guides": f.mu_guide * guides,
        "piston_pins": f.mu_pin * f.radius_piston_pin * journals * w,
        "crank_pins": f.mu_pin * f.radius_crank_pin * np.hypot(pin.x, pin.y) * 2 * w,
    }


def _crank_train(turn: Turn, found: Loads, f: Friction) -> Powers:
    R, K, w = turn.reactions, turn.kinematics, turn.omega
    powers = {name: np.zeros_like(turn.phi) for name in ("guides", "piston_pins", "crank_pins")}
    for i, pin in enumerate(found.pins, 1):
        swing = K[f"dpsi_{i}_dphi"] * w
        piston_pin = np.hypot(R[f"piston_pin_force_along_{i}"], R[f"piston_pin_force_across_{i}"])
        powers["guides"] += f.mu_guide * np.abs(found.guides[f"side_force_{i}"] * K[f"dx_{i}_dphi"] * w)
        powers["piston_pins"] += f.mu_pin * f.radius_piston_pin * piston_pin * np.abs(swing)
        powers["crank_pins"] += f.mu_pin * f.radius_crank_pin * np.hypot(pin.x, pin.y) * np.abs(w + swing)
    return powers


_PLACES: dict[str, Callable[[Turn, Loads, Friction], Powers]] = {
    "crosshead": _slider_crank,
    "crank_throw": _slider_crank,
    "hypocycloid": _hypocycloid,
    "rodless": _rodless,
    "crank_train": _crank_train,
}
