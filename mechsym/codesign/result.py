"""What the job of a co-design gives, design, bound, rivals, checks, costs, dangers, and what is told of it."""

from collections.abc import Mapping

import numpy as np

from mechsym.codesign.certificate import Floor, proving, rollers_inertia
from mechsym.codesign.front import CutForOne, RippleMap, Rival
from mechsym.codesign.loss import KINDS, Lossy
from mechsym.codesign.rank import Bound
from mechsym.codesign.scenarios import Scenario
from mechsym.codesign.task import Active, CoDesign
from mechsym.codesign.verify import GuideLoads, Spread, Verified
from mechsym.hinge.guide import setting_of
from mechsym.hinge.result import Target, design_words
from mechsym.hinge.rollers import HingeLosses, LossTorques
from mechsym.page import Shown
from mechsym.quantities import RPM, record
from mechsym.quantities.display import quantity_text, unit_for
from mechsym.quantities.results import part, quantity, result
from mechsym.quantities.units import scale


@record
class CoDesignResult(Shown):
    """Everything that the report of a co-design shows."""

    name: str  #: of the case
    about: str
    design: CoDesign
    given: CoDesign | None  #: the same with the hardware of the case, where some of it is free
    bound: Bound
    floor: Floor
    bare: float = quantity("kg*m^2", about="flywheel without a hinge")
    cut: CutForOne  #: the guide of the middle point used for all
    verified: Verified
    losses: tuple[LossTorques, ...]  #: at each point
    assumed: HingeLosses  #: friction and heat that they were computed with
    lossy: tuple[Lossy, ...]  #: each point with them, its springs filled anew
    taken: str  #: where friction and heat are: `inside` the programme, `beside` it, or `none`
    misfire: tuple[float | None, ...]  #: lowest speed after a lost combustion by the mean, at each point; 0 stalls [-]
    front: tuple[CoDesign, ...]
    peers: tuple[Rival, ...] = ()  #: computed where they are asked for only
    #: what follows is computed for the report only
    scenarios: tuple[Scenario, ...] = ()
    spread: Spread | None = None
    map: RippleMap | None = None
    #: least flywheel with which a lost combustion leaves half the speed, these guides [kg*m^2]; None if not known
    misfire_floor: float | None = None

    @property
    def target(self) -> Target:
        """The ripple that was asked for, and whether every point keeps it with losses."""
        held = self.design.status == "optimal" and not self.verified.broken
        ripples = tuple(at.ripple for at in self.lossy)
        return Target(ripple=self.design.task.ripple, with_losses=ripples, held=held, losses=self.taken != "none")

    @property
    def answer(self) -> str:
        """The verdict in a sentence."""
        return design_words(self.target, self.design.status, "; ".join(self.verified.broken) or self.design.reason)


Shares = tuple[float | None, ...]


@result
class VerifiedNumbers:
    """The design found again by other ways, at each point."""

    steady_ripple: Shares = quantity("-")  #: Speed ripple over the angle; None where there is no steady motion
    time_ripple: Shares = quantity("-")  #: Speed ripple of a run in time; None after a stall
    energy_residual: Shares = quantity("-")  #: What the balance of energy leaves open in that run
    difference: float = quantity("-")  #: Largest difference of three ways, by the largest ripple
    broken: tuple[str, ...] = part()  #: Limits that are passed
    used: Mapping[str, float] = quantity("-")  #: Share of each limit that is used


@result
class CoDesignGuide:
    """Dimensions of one guide, and what it asks of its rollers at all points together."""

    A: float = quantity("m^2")  #: Piston area of its spring
    H: float = quantity("m")  #: Free height of the gas column
    rho0: float = quantity("m")  #: Roller centre to shaft axis at free height
    roller_radius: float = quantity("m")  #: Of a roller
    roller_width: float = quantity("m")  #: Width of contact
    moving_mass: float = quantity("kg")  #: Mass that moves with each roller
    rho_min: float = quantity("m")  #: Smallest radius of the path
    rho_max: float = quantity("m")  #: Largest radius of the path
    z_min: float = quantity("m")  #: Smallest closing of the spring
    z_max: float = quantity("m")  #: Largest closing of the spring
    pressure_angle_max: float = quantity("rad")  #: Largest magnitude
    spring_pressure_max: float | None = quantity("Pa")  #: Excess over the air outside; None without gas
    roller_reaction_max: float = quantity("N")  #: Largest contact force of a roller
    roller_reaction_min: float = quantity("N")  #: Smallest; a roller leaves its track where it is not positive
    hertz_stress_max: float = quantity("Pa")  #: Largest contact pressure
    side_force_max: float = quantity("N")  #: Of a piston on its guide


@result
class WithGivenHardware:
    """The same with the hardware of the case, where some of it is free."""

    status: str = part()
    flywheel_inertia: float = quantity("kg*m^2")  #: Flywheel to add
    rollers_inertia: float = quantity("kg*m^2")  #: Mean inertia of the rollers


@result
class BoundNumbers:
    """What no guide does without; lists are for 1, 2, 3 springs."""

    singular_values: tuple[float, ...] = quantity("-")  #: Of the works by the square of the speed, by the first
    swing: tuple[float, ...] = quantity("kg*m^2")  #: What the best shapes leave of the works
    swing_bare: float = quantity("kg*m^2")  #: The same without a spring
    springs_that_pay: int = quantity("-")  #: Up to which each one more at least halves the swing
    total_inertia: tuple[float, ...] = quantity("kg*m^2")  #: Least that has to turn in all
    proven: bool = quantity("-")  #: Of this design, in balls
    kind: str = part()  #: `proven`, or what it is instead and why
    ripple: float = quantity("-")  #: For which it holds
    speeds_rpm: tuple[float, ...] = quantity("rpm")  #: Points that prove it for the design's number of springs
    assumes: tuple[str, ...] = part()
    estimate: tuple[float, ...] = quantity("kg*m^2")  #: Total inertia that weak ripple needs


@result
class AssumedFriction:
    """Friction and heat as they were taken."""

    bearing_mu: float = quantity("-")  #: Friction of the rollers' bearings
    bearing_radius: float = quantity("m")  #: Where it acts
    seal_mu: float = quantity("-")  #: Friction of the seals by the spring's force
    guide_mu: float = quantity("-")  #: Friction of the spring's piston on its guide
    tau: Shares = quantity("s")  #: Time of the gas to take the wall's temperature, at each point; None of no such gas


@result
class CoDesignLosses:
    """What friction and heat take at each point."""

    bearing: tuple[float, ...] = quantity("N*m")  #: Bearings of the rollers
    seal: tuple[float, ...] = quantity("N*m")  #: Seals of the springs
    guide: tuple[float, ...] = quantity("N*m")  #: Guides of the springs' pistons
    rolling: tuple[float, ...] = quantity("N*m")  #: Rolling resistance
    gas: tuple[float, ...] = quantity("N*m")  #: Heat exchange of the gas
    share: tuple[float, ...] = quantity("-")  #: All of them by the load's torque
    shaft_efficiency: tuple[float, ...] = quantity("-")  #: What is left of it
    extra_fuel: tuple[float, ...] = quantity("-")  #: More gas work for the same load
    taken: str = part()  #: `inside` the programme, `beside` it, or `none`
    in_programme: bool = quantity("-")  #: Whether they were in the programme
    speed_ripple: Shares = quantity("-")  #: Over the angle, with them; None where there is no steady motion
    time_ripple: Shares = quantity("-")  #: Of a run in time, with them
    energy_residual: Shares = quantity("-")  #: Of that run
    fill: tuple[float, ...] = quantity("-")  #: Fill of the springs by that of the schedule, for the least ripple
    assumed: AssumedFriction | None = part()


@result
class FrontRow:
    """The design for another ripple."""

    ripple: float = quantity("-")  #: Allowed (max - min) / mean of the speed
    flywheel_inertia: float = quantity("kg*m^2")  #: Flywheel to add
    status: str = part()
    reason: str = part()


@result
class CoDesignNumbers:
    """The numbers of a co-design; lists are for its points of speed and load."""

    status: str = part()  #: `optimal`, `infeasible` or `not converged`
    reason: str = part()
    feasible: bool = quantity("-")  #: Whether there is a design within all limits
    flywheel_inertia: float = quantity("kg*m^2")  #: Flywheel to add
    speed_rpm: tuple[float, ...] = quantity("rpm")  #: Speeds of the points
    load: tuple[float, ...] = quantity("Pa")  #: Mean indicated pressures of the points
    load_torque: tuple[float, ...] = quantity("N*m")  #: Mean torques that the load takes
    speed_ripple: tuple[float, ...] = quantity("-")  #: As the programme sees it
    p0: tuple[tuple[float, ...], ...] = quantity("Pa")  #: Pressures of each spring
    active: tuple[Active, ...] = part()  #: Limits that are met
    verified: VerifiedNumbers = part()
    guides: tuple[CoDesignGuide, ...] = part()
    iterations: int = quantity("-")  #: Of the solver
    wall_s: float = quantity("s")  #: Time of building and solving
    verdict: str = part()
    target: Target = part()
    total_inertia: float = quantity("kg*m^2")  #: Largest of engine, flywheel and rollers over the turn
    rollers_inertia: float = quantity("kg*m^2")  #: Mean inertia of the rollers
    flywheel_inertia_bare: float = quantity("kg*m^2")  #: Flywheel without a hinge
    flywheel_inertia_cut_for_one: float | None = quantity("kg*m^2")  #: Beside the guide of the middle point
    with_given_hardware: WithGivenHardware | None = part()
    bound: BoundNumbers = part()
    losses: CoDesignLosses = part()
    misfire_speed_share: Shares = quantity("-")  #: Lowest speed after a lost combustion, by the mean; 0 stalls
    pareto: tuple[FrontRow, ...] = part()


def numbers_of(result: CoDesignResult) -> CoDesignNumbers:
    """The numbers of a co-design."""
    design, given = result.design, result.given
    points = design.task.points
    return CoDesignNumbers(
        status=design.status,
        reason=design.reason,
        feasible=design.status == "optimal" and not result.verified.broken,
        flywheel_inertia=design.flywheel,
        speed_rpm=tuple(p.omega / RPM for p in points),
        load=tuple(p.load for p in points),
        load_torque=tuple(p.load_torque for p in points),
        speed_ripple=tuple(design.ripple.tolist()),
        p0=tuple(tuple(track.p0.tolist()) for track in design.tracks),
        active=design.active,
        verified=_verified(result.verified),
        guides=tuple(_guide(c, design, s) for s, c in enumerate(result.verified.contacts)),
        iterations=design.iterations,
        wall_s=design.wall,
        verdict=result.answer,
        target=result.target,
        total_inertia=result.floor.total_inertia,
        rollers_inertia=result.floor.rollers,
        flywheel_inertia_bare=result.bare,
        flywheel_inertia_cut_for_one=result.cut.flywheel,
        with_given_hardware=None
        if given is None
        else WithGivenHardware(
            status=given.status, flywheel_inertia=given.flywheel, rollers_inertia=rollers_inertia(given)
        ),
        bound=_bound(result),
        losses=_losses(result),
        misfire_speed_share=result.misfire,
        pareto=tuple(
            FrontRow(ripple=d.task.ripple, flywheel_inertia=d.flywheel, status=d.status, reason=d.reason)
            for d in result.front
        ),
    )


def _verified(verified: Verified) -> VerifiedNumbers:
    return VerifiedNumbers(
        steady_ripple=_or_none(verified.steady_ripple),
        time_ripple=_or_none(verified.time_ripple),
        energy_residual=_or_none(verified.energy_residual),
        difference=verified.difference,
        broken=verified.broken,
        used=verified.used,
    )


def _or_none(values: np.ndarray) -> Shares:
    return tuple(float(v) if np.isfinite(v) else None for v in values)


def _guide(contact: GuideLoads, design: CoDesign, s: int) -> CoDesignGuide:
    h = design.tracks[s].hardware
    return CoDesignGuide(
        A=h.spring.area,
        H=h.spring.H,
        rho0=h.rho0,
        roller_radius=h.radius,
        roller_width=h.width,
        moving_mass=h.moving_mass,
        rho_min=contact.rho_min,
        rho_max=contact.rho_max,
        z_min=contact.z_min,
        z_max=contact.z_max,
        pressure_angle_max=contact.pressure_angle_max,
        spring_pressure_max=None if contact.pressure_max is None else float(contact.pressure_max.max()),
        roller_reaction_max=float(contact.reaction_max.max()),
        roller_reaction_min=float(contact.reaction_min.min()),
        hertz_stress_max=float(contact.hertz_max.max()),
        side_force_max=float(contact.side_force_max.max()),
    )


def _bound(result: CoDesignResult) -> BoundNumbers:
    bound, floor = result.bound, result.floor
    return BoundNumbers(
        singular_values=tuple(bound.singular_values.tolist()),
        swing=bound.swing,
        swing_bare=bound.bare,
        springs_that_pay=bound.pays,
        total_inertia=tuple(proof.total_inertia for proof in floor.proofs),
        proven=floor.proven,
        kind=floor.kind,
        ripple=floor.ripple,
        speeds_rpm=proving(floor, result.design),
        assumes=floor.assumes,
        estimate=floor.estimate,
    )


def _losses(result: CoDesignResult) -> CoDesignLosses:
    design, assumed = result.design, result.assumed
    points, hardware = design.task.points, design.tracks[0].hardware
    loads = np.array([abs(p.load_torque) for p in points])
    torques = {kind: np.array([getattr(at, kind) for at in result.losses]) for kind in KINDS}
    total = np.sum(list(torques.values()), axis=0)
    taken = AssumedFriction(
        bearing_mu=assumed.bearing_mu,
        bearing_radius=assumed.bearing_at(hardware.radius),
        seal_mu=assumed.seal_mu,
        guide_mu=assumed.guide_mu,
        tau=tuple(getattr(hardware.walled(setting_of(hardware.spring), assumed, p.omega), "tau", None) for p in points),
    )
    return CoDesignLosses(
        **{kind: tuple(values.tolist()) for kind, values in torques.items()},
        share=tuple((total / loads).tolist()),
        shaft_efficiency=tuple((1 - total / loads).tolist()),
        extra_fuel=tuple((total / np.maximum(loads - total, 1e-30)).tolist()),
        taken=result.taken,
        in_programme=design.task.losses is not None,
        speed_ripple=tuple(at.ripple for at in result.lossy),
        time_ripple=tuple(at.time_ripple for at in result.lossy),
        energy_residual=tuple(at.energy_residual for at in result.lossy),
        fill=tuple(at.fill for at in result.lossy),
        assumed=None if result.taken == "none" else taken,
    )


def bound_words(numbers: CoDesignNumbers) -> str:
    """The bound of a design's number of springs in one sentence; what it stands on is `bound.assumes`."""
    bound, springs = numbers.bound, len(numbers.p0)
    least = bound.total_inertia[springs - 1]
    if least == 0:
        return f"with {springs} spring{'s' * (springs > 1)} nothing is proven: these points may need no flywheel"
    speeds = " and ".join(f"{speed:.4g}" for speed in bound.speeds_rpm)
    comma = "" if bound.proven else ","
    return (
        f"no guide does with less than {quantity_text(least, 'kg*m^2', 4)} in all, {bound.kind}{comma} by {speeds} rpm"
    )


def prices(numbers: CoDesignNumbers) -> list[tuple[str, str]]:
    """Each limit that is met with a unit of it for people, and what one such unit more saves or costs in inertia."""
    rows, of = [], "flywheel" if numbers.with_given_hardware is None else "flywheel and rollers"
    for active in numbers.active:
        unit = "%" if active.unit == "-" else unit_for(active.unit, 1e3)
        worth = active.multiplier * (0.01 if unit == "%" else scale(unit) / scale(active.unit))
        amount = quantity_text(abs(worth), "kg*m^2", 4)
        change = "saves" if worth < 0 else "costs"
        rows.append((f"{active.limit.replace('_', ' ')}, 1 {unit} more", f"{change} {amount} of {of}"))
    return rows
