"""Can the guide be built? One turn of it in numbers, each limit checked: reason and margin of the answer."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Annotated

import numpy as np

from mechsym import periodic
from mechsym.hinge import rollers
from mechsym.hinge.choices import CENTRE, ROOM, GuideLimit, GuideParameters, Limits, Station, asked
from mechsym.hinge.guide import Guide, path, warmth
from mechsym.hinge.rollers import RollerParameters
from mechsym.hinge.springs.face import Spring
from mechsym.quantities import record
from mechsym.quantities.results import part, quantity, result
from mechsym.quantities.units import Array, Metre, NewtonMetre, Pure, Radian, RadPerSecond, Scalar


@record
class Contact:
    """Arrays of shape (n,) over one period of the track."""

    #: Angle of the guide's shaft and of the crank [rad]
    theta: np.ndarray
    phi: np.ndarray
    #: Path of the roller centres [m], [m/rad], [m/rad^2]
    rho: np.ndarray
    drho: np.ndarray
    d2rho: np.ndarray
    #: Closing [m] and force [N] of the spring
    z: np.ndarray
    force: np.ndarray
    pressure: np.ndarray | None  #: Excess pressure in the spring [Pa]; None without gas
    pressure_angle: np.ndarray  #: Of the path [rad]
    curvature: np.ndarray  #: [1/m]
    #: Contact forces N1 and N2; the second is on the spring seat for `one_roller` [N]
    reaction_1: np.ndarray
    reaction_2: np.ndarray
    hertz_stress: np.ndarray  #: Contact pressure [Pa]
    tilting_couple: np.ndarray  #: Of tracks in offset planes, 0 for other arrangements [N*m]
    #: Radial force for each kilogram that moves with a roller; in the contact forces only with `moving_mass` [N/kg]
    inertia_force: np.ndarray
    #: On the guide's shaft: driving, and lost to rolling resistance of all rollers [N*m]
    torque: np.ndarray
    loss_torque: np.ndarray
    station: Station  #: The same, as limits ask it


def at_angles(guide: Guide, parameters: RollerParameters, theta: Radian[Array]) -> Contact:
    """The turn at given angles, for tables and plots. theta: angles of the guide's shaft."""
    rho = path(guide)
    values = [rho(theta), rho.derivative()(theta), rho.derivative(2)(theta)]
    return _contact(guide, parameters, np.asarray(theta, dtype=float), values)


def at_pieces(guide: Guide, parameters: RollerParameters) -> Contact:
    """The turn at points dense enough for extremes; each kink appears twice, with the values of both its sides.

    Returns contact: arrays of shape (n,), angles not decreasing.
    """
    rho = path(guide)
    theta = periodic.piece_points(rho, 65)
    values = [periodic.piece_values(p, theta).ravel() for p in (rho, rho.derivative(), rho.derivative(2))]
    return _contact(guide, parameters, theta.ravel(), values)


def station_of(
    spring: Spring, choices: GuideParameters, rollers: RollerParameters, omega: RadPerSecond,
    values: Sequence[Metre[Array]], warm: Pure[Array] | None = None,
) -> Station:  # fmt: skip
    """A guide at angles of its track. omega: of the crank. values: path and derivatives. warm: state of the gas."""
    count = choices.rollers
    rho, drho, d2rho = values
    z = count * (choices.rho0 - rho)
    return Station(
        spring=spring, rollers=rollers, count=count, rho0=choices.rho0, omega=omega * choices.shaft_ratio,
        rho=rho, drho=drho, d2rho=d2rho, z=z, force=spring.force(z, warm), warm=warm,
    )  # fmt: skip


def end_stations(along: Station, extremes: Metre[Array]) -> Station:
    """Both ends of the path by its largest and smallest radius; a gas with a state has no force of its closing."""
    z, spring = along.count * (along.rho0 - extremes), along.spring
    force = None if spring.state else spring.force(z)
    return replace(along, rho=extremes, drho=0.0, d2rho=0.0, z=z, force=force, warm=None)


def _contact(guide: Guide, parameters: RollerParameters, theta: np.ndarray, values: Sequence[np.ndarray]) -> Contact:
    rho, drho, d2rho = values
    chosen = guide.parameters
    warm = warmth(guide)(theta) if guide.spring.state else None
    at = station_of(guide.spring, chosen, parameters, guide.omega, values, warm)
    offset = parameters.plane_offset if chosen.arrangement == "two_tracks" else 0.0
    return Contact(
        theta=theta,
        phi=theta / chosen.shaft_ratio,
        rho=rho,
        drho=drho,
        d2rho=d2rho,
        z=at.z,
        force=at.force,
        pressure=at.pressure,
        pressure_angle=at.pressure_angle,
        curvature=at.curvature,
        reaction_1=at.reaction,
        reaction_2=at.force if guide.rollers == 1 else at.reaction,
        hertz_stress=at.hertz_stress,
        tilting_couple=rollers.tilting_couple(at.reaction, offset),
        inertia_force=rollers.inertia_force(rho, d2rho, at.omega),
        torque=guide.rollers * at.force * drho,
        loss_torque=guide.rollers * rollers.loss_torque(at.reaction, rho, drho, parameters),
        station=at,
    )


ALL_KEPT = "within all limits; "  #: How the words of a verdict begin that breaks none
_CLOSURE = 1e-9  # gap of the path after a period, as a share of rho0
_ROUNDING = 1e-12  # equal values may differ in the last digits
_ENDS = np.array([0.0, 1.0])  # stand for the angles of both ends of a path


@record
class LimitCheck:
    """One limit."""

    name: str  #: What is checked
    text: str  #: Value against limit in words
    kept: bool
    #: Share of the limit that is left, negative beyond it; None if a kept check knows no degree [-]
    margin: float | None

    @property
    def shown_margin(self) -> float | None:
        """The margin for people: none where round-off stands beside the limit [-]."""
        return None if self.margin is not None and self.margin > 1 - 1e-5 else self.margin


@result
class Verdict:
    """Whether a guide can be built; the numbers are None where there is no guide."""

    feasible: bool = quantity("-")  #: Whether all limits are kept
    reason: str = part()  #: The limits that are not kept, or the tightest one
    margin: float = quantity("-")  #: Smallest margin of all checks, negative when infeasible
    rho_min: float | None = quantity("m", default=None)  #: Smallest radius of the path
    rho_max: float | None = quantity("m", default=None)  #: Largest radius of the path
    z_min: float | None = quantity("m", default=None)  #: Smallest closing of the spring
    z_max: float | None = quantity("m", default=None)  #: Largest closing of the spring
    pressure_angle_max: float | None = quantity("rad", default=None)  #: Largest magnitude
    curvature_radius_min: float | None = quantity("m", default=None)  #: Smallest of the path, bending either way
    #: Largest contact force of a roller
    roller_reaction_max: float | None = quantity("N", default=None, card="force on a roller")
    spring_force_max: float | None = quantity("N", default=None)  #: Largest force of the spring
    #: Largest excess over the air outside; None without gas
    spring_pressure_max: float | None = quantity("Pa", default=None)
    hertz_stress_max: float | None = quantity("Pa", default=None)  #: Largest contact pressure
    tilting_couple_max: float | None = quantity("N*m", default=None)  #: Of tracks in offset planes
    #: Roller radius from which the profile is undercut; None if the path never bends inwards
    undercut_radius: float | None = quantity("m", default=None)
    #: Share of each limit that is used; negative where a path never bends inwards
    used: Mapping[str, float] | None = quantity("-", default=None)
    checks: tuple[LimitCheck, ...]
    #: For each kilogram that moves with a roller, at the speed the guide was cut for; left out of all above [N/kg]
    inertia_force_max: float | None = None
    loss_torque_mean: float | None = None  #: Mean over the turn, on the guide's shaft [N*m]
    closure: float = 0.0  #: Gap of the path after a period [m]


def judge(guide: Guide, rollers: RollerParameters, limits: Limits) -> Verdict:
    """Check a guide with the spring that is in it against all limits."""
    if guide.rho is None:
        failed = LimitCheck(name="spring", text=guide.reason, kept=False, margin=-1.0)
        return Verdict(feasible=False, reason=guide.reason, margin=-1.0, checks=(failed,))
    contact = at_pieces(guide, rollers)
    rho_min, _, rho_max, _ = periodic.extremes(path(guide))
    return verdict(
        contact.station, np.array([rho_max, rho_min]), contact.theta, guide.closure, guide.parameters, limits,
        inertia_force=highest(contact.theta, np.abs(contact.inertia_force)),
        loss_torque=float(np.trapezoid(contact.loss_torque, contact.theta) / np.ptp(contact.theta)),
    )  # fmt: skip


def verdict(
    along: Station, extremes: Metre[Array], theta: Radian[Array], gap: Metre, parameters: GuideParameters,
    limits: Limits, inertia_force: Annotated[float | None, "N/kg"] = None, loss_torque: NewtonMetre | None = None,
) -> Verdict:  # fmt: skip
    """Check what a guide bears at angles of its track against all limits.

    extremes: largest and smallest radius of the path. theta: angles, see `highest`. gap: of the path after a period,
    before it is closed. inertia_force, loss_torque: largest and mean, where they are known.
    """
    spring = along.spring
    ends = end_stations(along, extremes)
    z_min, z_max = ends.z.tolist()
    # the march of a gas with a state knows its force along the track only
    closed = (along, theta) if spring.state else (ends, _ENDS)
    pressure = closed[0].pressure
    reaction = highest(theta, along.reaction)
    checks = [*_checks_of_spring(z_min, spring), _closure_check(gap, parameters.rho0)]
    used = {}
    for key, limit, setting in asked(limits, CENTRE, ROOM):
        if not limit.holds(spring, along.count):
            continue
        share, most = _top(limit, setting, *(closed if limit.by_closing else (along, theta)))
        if math.isfinite(share):  # the contact pressure of an undercut profile is said by the undercut
            margin = 1 - share
            value = share * most if most > 0 else float(limit.value(ends, setting))
            checks.append(
                LimitCheck(
                    name=limit.name,
                    text=limit.told(value, most, setting, ends),
                    kept=margin >= -_ROUNDING,
                    margin=None if limit.signed and share <= 0 else margin,
                )
            )
            used[key] = share
    return Verdict(
        feasible=all(c.kept for c in checks),
        reason=_reason(checks),
        margin=min(c.margin for c in checks if c.margin is not None),
        rho_min=float(extremes[1]),
        rho_max=float(extremes[0]),
        z_min=z_min,
        z_max=z_max,
        spring_force_max=highest(closed[1], closed[0].force),
        spring_pressure_max=None if pressure is None else highest(closed[1], pressure),
        pressure_angle_max=highest(theta, np.abs(along.pressure_angle)),
        curvature_radius_min=1 / highest(theta, np.abs(along.curvature)),
        undercut_radius=undercut_radius(along.curvature),
        roller_reaction_max=reaction,
        hertz_stress_max=highest(theta, along.hertz_stress),
        tilting_couple_max=reaction * (along.rollers.plane_offset if parameters.arrangement == "two_tracks" else 0.0),
        closure=gap,
        used=used,
        checks=tuple(checks),
        inertia_force_max=inertia_force,
        loss_torque_mean=loss_torque,
    )


def _top(limit: GuideLimit, setting: Scalar, at: Station, theta: Radian[Array]) -> tuple[float, float]:
    """Largest share of a limit that is used around the turn [-], and the limit there [SI]."""
    share = np.broadcast_to(limit.share(at, setting), theta.shape)
    most = np.broadcast_to(limit.most(at, setting), theta.shape)
    return highest(theta, share), float(most[int(share.argmax())])


def undercut_radius(curvature: Annotated[Array, "1/m"]) -> Metre | None:
    """Largest roller radius before the cut profile is undercut.

    curvature: curvature of the path of the roller centres. Returns radius: smallest radius of curvature where the path
    bends inwards; None if it never does.
    """
    lowest = float(curvature.min())
    return -1 / lowest if lowest < 0 else None


def highest(theta: Radian[Array], values: np.ndarray) -> float:
    """Highest value of a curve given by points, at the top of the parabola through the three points around it.

    theta: angles, not decreasing; an angle that stands twice is a kink. values: values [any unit]. Returns highest:
    never below the highest point [unit of the values].
    """
    i = int(values.argmax())
    before, after = np.diff(theta[max(i - 1, 0) : i + 2]) if 0 < i < theta.size - 1 else (0.0, 0.0)
    if before <= 0 or after <= 0 or not np.isfinite(values[i]):
        return float(values[i])
    rise, fall = (values[i] - values[i - 1]) / before, (values[i + 1] - values[i]) / after
    bend = (fall - rise) / (before + after)
    slope = rise + bend * before
    return float(values[i] - slope**2 / (4 * bend)) if bend < 0 else float(values[i])


def _checks_of_spring(z_min: float, spring: Spring) -> list[LimitCheck]:
    # the march of a gas that exchanges heat refuses a path on which it would pull
    force_min = math.inf if spring.state else float(spring.force(z_min))
    longer = f"the spring is {-z_min * 1e3:.3g} mm longer than its free height; place the start"
    return [
        LimitCheck(
            name="free_height",
            text=longer if z_min < 0 else f"smallest closing {z_min * 1e3:.3g} mm",
            kept=z_min >= -_ROUNDING * spring.H,
            margin=z_min / spring.H if z_min < 0 else None,
        ),
        LimitCheck(
            name="spring_force",
            text=f"smallest spring force {force_min / 1e3:.4g} kN" if force_min < math.inf else "the spring pushes",
            kept=force_min > 0,
            margin=None if force_min > 0 else -1.0,
        ),
    ]


def _closure_check(gap: float, rho0: float) -> LimitCheck:
    margin = 1 - gap / (_CLOSURE * rho0)
    text = f"gap of the path {gap:.4g} of at most {_CLOSURE * rho0:.4g} m"
    if margin >= -_ROUNDING:
        return LimitCheck(
            name="closure", text="the path closes within a billionth of its radius", kept=True, margin=margin
        )
    return LimitCheck(name="closure", text=text, kept=False, margin=margin)


def _reason(checks: Sequence[LimitCheck]) -> str:
    failed = [c.text for c in checks if not c.kept]
    if failed:
        return "; ".join(failed)
    tightest = min((c for c in checks if c.margin is not None), key=lambda c: c.margin or 0.0)
    return f"{ALL_KEPT}tightest: {tightest.text}"
