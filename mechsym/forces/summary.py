"""The forces of a turn in numbers: largest and smallest, orders, losses, claims, and what contacts of cams carry."""

import math
from collections.abc import Iterator, Mapping

import casadi as ca
import numpy as np

from mechsym import mechanisms
from mechsym.forces import textbook
from mechsym.forces.friction import NO_PLACE, Losses
from mechsym.forces.loads import Harmonics, Shaking, power_residual, under_own_name
from mechsym.forces.mains import Orbit, beyond, specific_load
from mechsym.forces.result import ComparedMechanism, Forces, angle_of_largest, claims, extremes, left_out
from mechsym.forces.turn import Turn
from mechsym.mechanisms.amounts import amount
from mechsym.mechanisms.arrays import along
from mechsym.mechanisms.roles import CamRole
from mechsym.page.finding import NOT_MET, Finding
from mechsym.periodic.roots import minimum
from mechsym.quantities.display import quantity_text
from mechsym.quantities.results import Columns, part, quantity, result

_POINTS = 2880  # over two turns of the shaft, which a camshaft at half speed takes for one
_SHARE = 1e-9  # of the largest force: below it a contact that only touches is none


@result
class CamNumbers:
    """A cam over two turns of the shaft at constant speed, its follower held on it."""

    name: str = quantity("-")  #: In the declaration
    force_min: float = quantity("N")  #: Least contact force; below 0 the follower lifts off
    force_max: float = quantity("N")  #: Largest contact force
    angle_of_min_deg: float = quantity("deg")  #: Shaft angle of the least
    #: From this speed of the shaft on the follower lifts off; null where it does at no speed
    jump_speed_rpm: float | None = quantity("rpm")
    pressure_angle_max_deg: float = quantity("deg")  #: Largest, to either side
    curvature_max: float = quantity("1/m")  #: Of the sharpest place of the cam that bulges
    curvature_min: float = quantity("1/m")  #: Below 0: of the hollowest place
    undercut: bool = quantity("-")  #: Whether a cutter could not leave the flank standing


def cams(turn: Turn) -> tuple[CamNumbers, ...]:
    """The cams of a mechanism whose followers are held."""
    return tuple(_numbers(turn, role) for role in turn.drive.roles.cams if role.force)


def findings(turn: Turn) -> Iterator[Finding]:
    """What has to be known of them first."""
    for one in cams(turn):
        if one.force_min < -_SHARE * one.force_max:
            least, at = quantity_text(one.force_min, "N", 4), f"{one.angle_of_min_deg:.4g} deg"
            jump = "at any speed" if one.jump_speed_rpm is None else f"from {one.jump_speed_rpm:.4g} rpm on"
            words = f"the follower of the cam {one.name} lifts off {jump}: {least} at {at}; more spring, or less mass"
            yield Finding(rank=NOT_MET, words=words, value=one.force_min, unit="N")
        if one.undercut:
            words = f"the cam {one.name} is undercut: no flank is left where it turns sharply; a larger base circle"
            yield Finding(rank=NOT_MET, words=words)


def _numbers(turn: Turn, role: CamRole) -> CamNumbers:
    mechanism = turn.drive.mechanism
    kinematics, reactions = (mechanism.functions[name] for name in ("kinematics", "reactions"))
    q = mechanism.coordinates[0]
    phi = np.arange(_POINTS) * 4 * math.pi / _POINTS
    outputs = [kinematics.name_out().index(n) for n in (f"pressure_angle_{role.name}", f"curvature_{role.name}")]
    at_angle = ca.Function(
        "cam", [x := ca.SX.sym(q)], [kinematics.call([x])[k] for k in outputs], [q], ["angle", "bend"]
    )
    shape = along(at_angle, {q: phi})

    carried_at = _one(reactions, role.force)

    def force(at: np.ndarray, omega: float) -> np.ndarray:
        letters = {q: at, f"{q}d": np.full_like(at, omega)}
        letters |= {n: np.interp(at, turn.phi, values, period=turn.period) for n, values in turn.inputs.items()}
        return along(carried_at, letters)["force"]

    def jump(at: np.ndarray) -> np.ndarray:
        """The share of the speed at which the force is zero, which changes with the speed and its square."""
        still, once, twice = (force(at, k * turn.omega) for k in range(3))
        square = (twice - 2 * once + still) / 2
        half = (once - still - square) / 2
        with np.errstate(invalid="ignore", divide="ignore"):
            root = (-half - np.sqrt(half**2 - square * still)) / square
        return np.where((square < 0) & (root > 0), root, np.inf)

    carried, shares = force(phi, turn.omega), jump(phi)
    least, share = int(np.argmin(carried)), float(np.min(shares))
    if np.isfinite(share):
        near, step = phi[int(np.argmin(shares))], phi[1]
        share = min(minimum(lambda at: float(jump(np.array([at]))[0]), near - step, near + step, 1e-10)[1], share)
    bend = shape["bend"]
    radius = amount(role.roller, mechanism.parameters) if role.roller is not None else 0.0
    undercut = bool((bend <= 0).any()) if role.flat else bool(radius and (bend < -1 / radius).any())
    return CamNumbers(
        name=role.name, force_min=float(carried[least]), force_max=float(carried.max()),
        angle_of_min_deg=math.degrees(phi[least]), undercut=undercut,
        jump_speed_rpm=None if math.isinf(share) else share * turn.omega * 30 / math.pi,
        pressure_angle_max_deg=math.degrees(np.abs(shape["angle"]).max()), curvature_max=float(bend.max()),
        curvature_min=float(bend.min()),
    )  # fmt: skip


def _one(function: ca.Function, output: str) -> ca.Function:
    letters = [ca.SX.sym(n) for n in function.name_in()]
    value = function.call(letters)[function.name_out().index(output)]
    return ca.Function("of_cam", letters, [value], function.name_in(), ["force"])


_FIRST_ORDER = 0.9  # below this efficiency the frictionless reactions are no longer good for friction


@result
class OrderTable:
    """Harmonics of one quantity."""

    unit: str  #: Of the quantity
    order: list[float] = quantity("-")  #: Oscillations per turn, 0 first
    amplitude: list[float] = quantity("@unit")  #: The mean for order 0, with its sign
    phase: list[float] = quantity("rad")  #: Where the oscillation has its crest


@result
class CounterweightNumbers:
    """The counterweight on the crank that leaves the least mean square of the shaking force."""

    unbalance: float = quantity("kg*m")  #: Mass times radius
    rms_before: float = quantity("N", card="shaking force")  #: Root mean square of the shaking force without it
    rms_after: float = quantity("N")  #: The same with it
    angle_deg: float = quantity("deg")  #: Where it stands on the crank, in the sense of rotation


@result
class PlaneNumbers:
    """One of two counterweights that balance force and couple together."""

    z: float = quantity("m")  #: Place along the shaft
    unbalance: float = quantity("kg*m")  #: Mass times radius
    angle_deg: float = quantity("deg")  #: Where it stands at shaft angle 0, in the sense of rotation


@result
class JournalNumbers:
    """A main bearing and what the shaft presses on it."""

    z: float = quantity("m")  #: Place along the shaft
    load_max: float = quantity("N")  #: Largest over the cycle
    load_mean: float = quantity("N")  #: Mean over the cycle
    angle_of_max_deg: float = quantity("deg")  #: Crank angle of the largest
    #: Largest load over width times diameter; null where `[shaft]` does not give them
    specific_load: float | None = quantity("Pa")
    film_min: float | None = quantity("m")  #: Least oil film of a short bearing; null where `[shaft]` gives no oil
    eccentricity_max: float | None = quantity("-")  #: Largest, over the clearance
    film_power: float | None = quantity("W")  #: Shear of a full film and squeezing: an upper estimate of the heat


@result
class ShakingNumbers:
    """What shakes the frame."""

    orders: Mapping[str, OrderTable] = part()  #: Of forces and moments on the frame
    counterweight: CounterweightNumbers = part()
    planes: tuple[PlaneNumbers, ...] = part()  #: A pair for force and couple; empty for a single throw


@result
class FrictionNumbers:
    """Friction of a machine at constant speed, of the first order."""

    power: float = quantity("W")  #: Mean power lost
    places: Mapping[str, float] = quantity("W")  #: The same by place
    indicated_power: float = quantity("W")  #: Mean power of the gas
    mechanical_efficiency: float | None = quantity("-")  #: Null where the gas gives no power
    friction_mean_pressure: float | None = quantity("Pa")  #: Work lost in a cycle over the swept volume
    note: str | None = part()  #: What to declare where no place is named


@result
class ClosingNumbers:
    """How an overconstrained mechanism was closed, and what its masses do to the frame."""

    constraint_rank: int = quantity("-")  #: Independent ones of its constraints
    constraint_count: int = quantity("-")  #: All of its constraints
    closing_rule: str = part()
    inertia_resultant_max: float = quantity("N")  #: Of all that moves but the crank's own unbalance
    inertia_resultant_min: float = quantity("N")  #: The same, least
    resultant_off_crank_deg: float = quantity("deg")  #: Largest angle between it and the crank


@result
class BalanceNumbers:
    """The balance that `[shaking]` asks for."""

    reached: bool = quantity("-")  #: Whether all that was asked for is balanced
    reasons: list[str] = part()


@result
class ForceNumbers:
    """Forces of a machine over one cycle at constant speed."""

    case: str = part()
    mechanism: str = part()
    speed_rpm: float = quantity("rpm")  #: Of the crank
    max: Columns = part()  #: Largest value of every column of the table
    min: Columns = part()  #: Smallest value of every column of the table
    angle_of_max_deg: Mapping[str, float] = quantity("deg")  #: Where each is largest
    power_residual: float = quantity("-")  #: Gap of two ways to the power of the load, over the largest power
    torque_mean: float = quantity("N*m")  #: Of the load
    driving_torque_mean: float = quantity("N*m")  #: What drives it beside the gas
    torque_orders: OrderTable = part()
    journals: tuple[JournalNumbers, ...] = part()  #: Main bearings; empty where their places are not known
    shaking: ShakingNumbers | None = part()
    friction: FrictionNumbers | None = part()  #: Where the case has coefficients
    #: Error of the chains of the sources by force, of a slider crank
    two_mass: Mapping[str, Mapping[str, float]] | None = quantity("-")
    weight: Mapping[str, float] | None = quantity("-")  #: What the weights do to the forces of a slider crank
    closing: Mapping[str, ClosingNumbers | None] = part(inline=True)  #: By overconstrained mechanism
    cams: Mapping[str, tuple[CamNumbers, ...]] = part(inline=True)  #: Whose followers are held, where there are any
    balance: BalanceNumbers = part()
    comparison: list[ComparedMechanism] | None = part()  #: At equal stroke, mass and gas
    claims: list[dict[str, str]] = part()  #: Of the source, judged
    facts: list[str] = part()
    units: Mapping[str, str] = part()  #: Of the columns
    reactions: Mapping[str, str] = part()  #: Which body acts on which


def summary(forces: Forces, case: str, source: str = "") -> ForceNumbers:
    """The result in numbers. case, source: name of the case, and the source whose claims are judged."""
    one, table = forces.turn, forces.columns
    largest, smallest = extremes(table)
    name = mechanisms.listing(one.drive.name)["name"]
    # of the package, what a closing rule has to close
    closing: dict[str, ClosingNumbers | None] = {}
    for other in mechanisms.names():
        if not mechanisms.own.is_file(other) and mechanisms.roles_of(other).closings:
            closing[other] = None
    if one.drive.closing:
        closing[name] = _closing(one)
    judged, shares = [] if forces.comparison is None else claims(forces.comparison), None
    if forces.chains:
        shares = textbook.weight_shares(one)
        judged.append(left_out(shares, None if forces.losses is None else forces.losses.mechanical_efficiency))
    return ForceNumbers(
        case=case,
        mechanism=name,
        speed_rpm=one.omega * 30 / math.pi,
        max=Columns(largest, table.units),
        min=Columns(smallest, table.units),
        angle_of_max_deg={k: angle_of_largest(one.phi, v) for k, v in table.items() if k != "phi_deg"},
        power_residual=power_residual(one, forces.loads),
        torque_mean=float(one.torque.mean()),
        driving_torque_mean=float(one.driving.mean()),
        torque_orders=_order_table(forces.torque_orders, "N*m"),
        journals=_journals(forces),
        shaking=None if forces.shaking is None else _shaking(forces.shaking),
        friction=None if forces.losses is None else _friction(forces, forces.losses),
        two_mass={name: textbook.errors(one, chain) for name, chain in forces.chains.items()} or None,
        weight=shares,
        closing=closing,
        cams={"cams": held} if (held := cams(one)) else {},
        balance=BalanceNumbers(reached=not forces.unbalanced, reasons=forces.unbalanced),
        comparison=forces.comparison,
        claims=[row for row in judged if row["source"] == source],
        facts=_facts(forces),
        units={"phi": "rad", **table.units},
        reactions={name: on for name, on in one.drive.roles.joints.items() if name in table},
    )


def quantities(forces: Forces) -> list[str]:
    """Columns that a reader wants to see the extremes of: without motion, printed chains, and reactions that a part
    of the mechanism has under its own name."""
    one = forces.turn
    named = {name for name in under_own_name(one.drive.roles) if name.startswith("R_")}
    hidden = named | {"phi_deg", "driving_torque", *one.kinematics}
    hidden |= set(one.drive.mechanism.inputs) - set(one.inputs)
    return [name for name in forces.columns if name not in hidden and not name.startswith(tuple(forces.chains))]


def _order_table(of: Harmonics, unit: str) -> OrderTable:
    return OrderTable(unit=unit, order=of.order.tolist(), amplitude=of.amplitude.tolist(), phase=of.phase.tolist())


def _journals(forces: Forces) -> tuple[JournalNumbers, ...]:
    orbits: tuple[Orbit | None, ...] = forces.orbits or (None,) * len(forces.journals)
    return tuple(
        JournalNumbers(
            z=journal.z,
            load_max=float(journal.load.max()),
            load_mean=float(journal.load.mean()),
            angle_of_max_deg=angle_of_largest(forces.turn.phi, journal.load),
            specific_load=specific_load(journal, forces.bearings),
            film_min=None if orbit is None else orbit.thinnest,
            eccentricity_max=None if orbit is None else float(np.abs(orbit.eccentricity).max()),
            film_power=None if orbit is None else orbit.power,
        )
        for journal, orbit in zip(forces.journals, orbits, strict=True)
    )


def _shaking(shaking: Shaking) -> ShakingNumbers:
    weight = shaking.counterweight
    return ShakingNumbers(
        orders={n: _order_table(o, "N" if n.startswith("force") else "N*m") for n, o in shaking.orders.items()},
        counterweight=CounterweightNumbers(
            unbalance=weight.unbalance, rms_before=weight.rms_before, rms_after=weight.rms_after,
            angle_deg=math.degrees(weight.angle),
        ),
        planes=tuple(
            PlaneNumbers(z=p.z, unbalance=p.unbalance, angle_deg=math.degrees(p.angle)) for p in shaking.planes
        ),
    )  # fmt: skip


def _friction(forces: Forces, lost: Losses) -> FrictionNumbers:
    return FrictionNumbers(
        power=sum(lost.places.values()),
        places=lost.places,
        indicated_power=lost.indicated_power,
        mechanical_efficiency=lost.mechanical_efficiency,
        friction_mean_pressure=lost.friction_mean_pressure,
        note=None if lost.places.keys() - {"rings"} else NO_PLACE,
    )


def half(forces: Forces) -> bool:
    """Whether the turn is that of one piston of two that share a chamber."""
    gas = forces.turn.gas
    return gas is not None and len({one.face.input for one in forces.turn.acting}) < gas.chamber.pistons


def _facts(forces: Forces) -> list[str]:
    gas, lost = forces.turn.gas, forces.losses
    facts = list(gas.pressure.facts) if gas else ["no gas acts: the case has no [cycle]"]
    if half(forces):
        facts.append("loads, torque and friction are those of one piston with its crank; the engine has two of them")
    if lost is not None and lost.mechanical_efficiency is not None and lost.mechanical_efficiency < _FIRST_ORDER:
        share = 100 * (1 - lost.mechanical_efficiency)
        facts.append(f"friction takes {share:.3g} %: first order only, it would change the reactions by about as much")
    for journal, orbit in zip(forces.journals, forces.orbits, strict=False):
        if why := beyond(forces.bearings, orbit):
            facts.append(f"film of the main bearing at z = {quantity_text(journal.z, 'm', 4)}: {why}")
    return facts


def _closing(one: Turn) -> ClosingNumbers:
    count, roles = len(mechanisms.listing(one.drive.name)["reactions"]), one.drive.roles
    letters = one.drive.mechanism.parameters
    # of link, sliders and pistons; the crank's own unbalance is there to balance it
    rate = one.momentum["momentum_rate_x"] + 1j * one.momentum["momentum_rate_y"]
    own = sum(float(amount(rotor.unbalance, letters)) for rotor in roles.rotors)
    in_crank = -rate * np.exp(-1j * one.phi) - own * one.omega**2
    size = np.abs(in_crank)
    return ClosingNumbers(
        constraint_rank=count - len(roles.closings),
        constraint_count=count,
        closing_rule=type(one.drive.closing).__name__,
        inertia_resultant_max=float(size.max()),
        inertia_resultant_min=float(size.min()),
        resultant_off_crank_deg=math.degrees(float(np.abs(np.angle(in_crank)).max())),
    )
