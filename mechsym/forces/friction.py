r"""First-order friction losses: Coulomb's law on the reactions of the frictionless machine.

.. math:: P = \sum \mu\,|N|\,|v| + \sum \mu\,r\,|R|\,|\omega_{rel}| + P_\mathrm{mesh} + P_\mathrm{rings}

The losses are taken as small: they change neither the reactions nor the speed. Every source claims less friction
without a rod or a side force; with the same coefficients everywhere that can be judged.

Rings go by a named rule: `patton1989` is a mean pressure fitted to small spark-ignition engines; `contact_pressure` is
Coulomb's law with the pressure of the rings on the wall, elastic and from the gas behind them.

The cycle knows friction as a mean pressure by a named correlation, `[friction_pressure]`. `fit` makes Chen and Flynn's
form of it from the friction that joints and rings have at several speeds; the record can be used wherever the cycle
takes a correlation, or written into the case. Where a case has both, the correlation is the whole: what it has beyond
joints and rings stands beside them as auxiliaries, so that there is one sum and one mechanical efficiency.
"""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
import scipy

from mechsym.cycle.friction import ChenFlynn, friction_pressure
from mechsym.cycle.friction import Friction as CycleFriction
from mechsym.errors import BadInput
from mechsym.forces.turn import Turn, main_roles
from mechsym.mechanisms.amounts import amount
from mechsym.mechanisms.roles import BearingRole
from mechsym.quantities import quantity, record
from mechsym.quantities.units import Array, MetrePerSecond, Newton, Pascal, Radian, RadPerSecond, Volume, Watt

if TYPE_CHECKING:
    from mechsym.cycle.gas import Gas


@record
class NoRings:
    """Section `[rings]`, `law = "none"`: sealing without friction."""


@record
class Patton1989:
    """Section `[rings]`, `law = "patton1989"`."""

    intake_ratio: float = quantity("-", default=1.0, above=0, about="intake over atmospheric pressure")


@record
class ContactPressure:
    """Section `[rings]`, `law = "contact_pressure"`."""

    mu: float = quantity("-", low=0, about="coefficient of friction of the rings")
    heights: tuple[float, ...] = quantity("m", above=0, about="axial height of each ring")
    gas_shares: tuple[float, ...] = quantity("-", low=0, high=1, about="part of the gas pressure behind each ring")
    #: Pressure of a ring's own tension on the wall [Pa]
    elastic: float = quantity("Pa", low=0, about="pressure of a ring's own tension")

    def __post_init__(self) -> None:
        if not self.heights or len(self.heights) != len(self.gas_shares):
            listed = f"{len(self.heights)} heights and {len(self.gas_shares)} gas_shares"
            raise BadInput(f'{listed}: rings need one of each, at least one; law = "none" leaves rings away')


Rings = NoRings | Patton1989 | ContactPressure


def ring_power(
    law: Rings, gas: "Gas", phi: Radian[Array], speed: MetrePerSecond[Array], omega: RadPerSecond
) -> Watt[Array]:
    r"""Power lost at the rings of one piston.

    .. math::
        \text{Patton:}\; & f = 4.06\cdot10^4 \Bigl(1 + \frac{500}{n}\Bigr)\frac{1}{B^2}
            + 6.89\,\frac{p_i}{p_a}\bigl(0.088\,r_c + 0.182\,r_c^{\,1.33 - 0.0238\,\bar S_p}\bigr) \;\text{kPa},\\
        \text{contact:}\; & P = \mu\,\pi B \sum_i h_i\,(p_{el} + \kappa_i (p - p_{back}))\,|\dot x|

    phi: angles from the piston's firing dead centre, evenly spaced over a period. Returns power: a mean rule is spread
    over the cycle like the speed of the piston.
    Source: Patton, Nitschke, Heywood, SAE 890836 (1989), n in rpm, B in mm; four-stroke, bore 70 to 110 mm.
    """
    if isinstance(law, NoRings):
        return np.zeros_like(phi)
    if isinstance(law, ContactPressure):
        excess = np.maximum(gas.pressure.absolute(phi) - gas.p_back, 0.0)
        rows = zip(law.heights, law.gas_shares, strict=True)
        press = sum((h * (law.elastic + share * excess) for h, share in rows), np.zeros_like(phi))
        return law.mu * np.pi * gas.chamber.bore * press * np.abs(speed)
    mean = patton_pressure(law, gas, omega) * gas.chamber.area * gas.chamber.stroke * omega / gas.pressure.period
    return mean * np.abs(speed) / np.abs(speed).mean()


def patton_pressure(law: Patton1989, gas: "Gas", omega: RadPerSecond) -> Pascal:
    """Mean pressure of ring friction after Patton, Nitschke and Heywood (1989).

    Returns fmep: friction mean effective pressure of the rings. A bore of 80 mm at 3000 rpm: ring tension alone costs
    7.4 kPa.
    """
    rpm, bore = omega * 30 / np.pi, gas.chamber.bore * 1e3
    mean_speed = gas.chamber.stroke * omega / np.pi
    tension = 4.06e4 * (1 + 500 / rpm) / bore**2
    ratio = gas.chamber.compression_ratio
    loading = 6.89 * law.intake_ratio * (0.088 * ratio + 0.182 * ratio ** (1.33 - 0.0238 * mean_speed))
    return float(1e3 * (tension + loading))


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

    #: Mean power lost at guides, piston pins, crank pins, main bearings, teeth, rings, and auxiliaries [W]
    places: dict[str, float]
    curves: dict[str, np.ndarray]  #: shape (n,): The same over the angle [W]
    indicated_power: float  #: Mean power of the gas [W]
    #: Brake by net indicated power, (indicated - lost) / indicated; None where the gas gives no power [-]
    mechanical_efficiency: float | None
    friction_mean_pressure: float | None  #: Work lost in a cycle over the swept volume; None without a cylinder [Pa]


AUXILIARIES = "auxiliaries"  #: Place of what a law of friction pressure has beyond the joints that are counted
NO_PLACE = "none counted: declare m.bearing(name, reactions=(..), turns=..) or m.guide(name, reaction=.., travel=..)"
_PINS = {"piston_pins": "radius_piston_pin", "crank_pins": "radius_crank_pin"}
_TEETH = "teeth"


@record
class Rubbing:
    """Two parts that slide or turn on each other."""

    place: str  #: Of `[friction]`: `guides`, `piston_pins`, `crank_pins`, `main_bearings`, `teeth`; else its own name
    force: np.ndarray  #: shape (n,): Between them [N]
    speed: np.ndarray  #: shape (n,): Speed of one against the other: [m/s] in a guide, else [rad/s]
    #: Values of `[friction]` that act here
    reads: tuple[str, ...]
    radius: float | None = None  #: Of a bearing whose declaration says it [m]


def rubbing(turn: Turn) -> list[Rubbing]:
    """Where parts of a mechanism rub: guides, pins, teeth, main bearings."""
    roles, none = turn.drive.roles, np.zeros_like(turn.phi)
    places = []
    for guide in roles.guides:
        force, speed = none if guide.reaction is None else turn.reactions[guide.reaction], turn.rate(guide.travel)
        places.append(Rubbing(place=guide.at or guide.name, force=force, speed=speed, reads=("mu_guide",)))
    places += [_turning(turn, role) for role in roles.bearings if role.at != "main_bearings"]
    for mesh in roles.teeth:
        if mesh.turns:
            force, reads = turn.reactions[mesh.force], ("mu_mesh", "module", "contact_ratio")
            places.append(Rubbing(place=_TEETH, force=force, speed=turn.rate(mesh.turns), reads=reads))
    return places + [_turning(turn, role) for role in main_roles(turn)]


def _turning(turn: Turn, role: BearingRole) -> Rubbing:
    parts = [turn.reactions[name] for name in role.reactions]
    force = np.hypot(*parts) if len(parts) == 2 else np.abs(parts[0])
    radius = None if role.radius is None else float(amount(role.radius, turn.drive.mechanism.parameters))
    main = role.at == "main_bearings"
    named = "radius_main" if main else _PINS.get(role.at, "radius_crank_pin")
    reads = ("mu_main" if main else "mu_pin", *(() if radius is not None else (named,)))
    return Rubbing(place=role.at or role.name, force=force, speed=turn.rate(role.turns), reads=reads, radius=radius)


def losses(turn: Turn, friction: Friction, rings: Rings, whole: CycleFriction | None = None) -> Losses:
    """Friction losses of a turn, by place, and what they cost.

    whole: law of the friction of the whole engine; what it has beyond the places counted is the place `auxiliaries`.
    """
    curves: dict[str, np.ndarray] = {}
    powers = [(rubs.place, _power(friction, rubs)) for rubs in rubbing(turn)]
    for one in turn.acting:
        phi, speed = turn.phi - one.face.fires, turn.rate(one.face.travel)
        powers.append(("rings", ring_power(rings, one.gas, phi, speed, turn.omega)))
    for place, power in powers:
        curves[place] = curves[place] + power if place in curves else power
    beyond = _law_power(turn, whole) - sum(float(curve.mean()) for curve in curves.values())
    if beyond > 0:
        curves[AUXILIARIES] = np.full(turn.phi.shape, beyond)
    places = {name: float(curve.mean()) for name, curve in curves.items()}
    lost, gained = sum(places.values()), float(turn.gas_power.mean())
    return Losses(
        places=places,
        curves=curves,
        indicated_power=gained,
        mechanical_efficiency=1 - lost / gained if gained > 0 else None,
        friction_mean_pressure=lost * turn.period / turn.omega / swept_volume(turn) if turn.acting else None,
    )


def _law_power(turn: Turn, law: CycleFriction | None) -> Watt:
    """What a law of friction pressure takes of the engine."""
    if not turn.acting or law is None:
        return 0.0
    gas = turn.acting[0].gas
    lost = friction_pressure(law, gas.pressure.p_max, gas.chamber.stroke * turn.omega / np.pi, turn.omega)
    return float(lost * swept_volume(turn) * turn.omega / gas.pressure.period)


def swept_volume(turn: Turn) -> Volume:
    """Volume that all pistons sweep together."""
    return sum((one.gas.chamber.area if one.gas.pistons else one.area) * one.gas.chamber.stroke for one in turn.acting)


def _power(f: Friction, rubs: Rubbing) -> np.ndarray:
    """Power lost over the angle [W]."""
    if rubs.place == _TEETH:
        return mesh_power(f, rubs.force, rubs.speed)
    mu = float(getattr(f, rubs.reads[0]))
    if rubs.reads == ("mu_guide",):
        return mu * np.abs(rubs.force * rubs.speed)
    radius = float(getattr(f, rubs.reads[1])) if rubs.radius is None else rubs.radius
    return mu * (rubs.force * radius * np.abs(rubs.speed))


def mesh_power(
    friction: Friction, tooth_force: Newton[Array], omega_rel: RadPerSecond | RadPerSecond[Array]
) -> Watt[Array]:
    r"""Power lost between teeth.

    .. math:: P = \mu\,|W_t|\,\omega_{rel}\,\pi m\,\epsilon / 4

    The flanks slide with omega_rel times the distance from the pitch point, on average a quarter of the length of
    contact eps pi m cos(alpha_n); the normal force is W_t / cos(alpha_n). tooth_force: tangential force; omega_rel:
    speed of one gear against the other. Valid: pitch point in the middle of the path of contact, load spread evenly
    over the path.
    """
    slide = np.pi * friction.module * friction.contact_ratio / 4
    return friction.mu_mesh * np.abs(tooth_force) * omega_rel * slide


@record
class FittedLaw:
    """A correlation fitted to a mechanism's friction."""

    law: ChenFlynn  #: For `[friction_pressure]` of the case
    #: shape (k,): Speeds [rad/s], friction mean pressure of the mechanism and of the law [Pa]
    omega: np.ndarray
    computed: np.ndarray
    fitted: np.ndarray
    misfit: float  #: Largest difference over the largest value [-]


def fit(turns: Sequence[Turn], friction: Friction, rings: Rings) -> FittedLaw:
    r"""Chen and Flynn's coefficients, none negative, that come closest to a mechanism's friction.

    .. math:: p_{mf} \approx A + B\,p_{max} + C\,\bar S_p + D\,\bar S_p^2

    turns: one machine with gas at several speeds; a single one gives a constant. Returns fitted: law and how close it
    comes.
    """
    omega = np.array([one.omega for one in turns])
    pressures = [losses(one, friction, rings).friction_mean_pressure for one in turns]
    if None in pressures:
        raise BadInput("a friction mean pressure needs a gas on the pistons")
    computed = np.array(pressures, dtype=float)
    p_max = np.array([one.gas.pressure.absolute(one.phi).max() for one in turns if one.gas])
    piston_speed = np.array([one.gas.chamber.stroke * one.omega / math.pi for one in turns if one.gas])
    columns = np.array([np.ones_like(p_max), p_max, piston_speed, piston_speed**2])
    columns = columns if len(turns) > 1 else columns * [[1], [0], [0], [0]]
    scale = np.maximum(columns.max(axis=1), 1e-300)
    coefficients = scipy.optimize.nnls((columns / scale[:, None]).T, computed)[0] / scale
    names = ("constant", "per_peak_pressure", "per_speed", "per_speed_squared")
    law = ChenFlynn(**dict(zip(names, coefficients.tolist(), strict=True)))
    fitted = friction_pressure(law, p_max, piston_speed, omega)
    misfit = float(np.abs(fitted - computed).max() / computed.max()) if computed.max() > 0 else 0.0
    return FittedLaw(law=law, omega=omega, computed=computed, fitted=fitted, misfit=misfit)
