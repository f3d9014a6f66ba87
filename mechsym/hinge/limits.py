"""Can the guide be built? Each limit is checked with its number; the answer carries the reason and the margin."""

import math
from dataclasses import replace
from typing import Any

import numpy as np

from mechsym import periodic
from mechsym.hinge.choices import ROLLERS, GuideParameters, Limits
from mechsym.hinge.contact import Contact, at_pieces
from mechsym.hinge.guide import Guide, Spring, closing, path
from mechsym.hinge.rollers import RollerParameters
from mechsym.hinge.springs import Coil, law
from mechsym.hinge.thermal import AirThermal
from mechsym.quantities import record

_CLOSURE = 1e-9  # gap of the path after a period, as a share of rho0
_ROUNDING = 1e-12  # equal values may differ in the last digits


@record
class LimitCheck:
    """One limit."""

    #: What is checked, and value against limit in words
    name: str
    text: str
    kept: bool
    #: Share of the limit that is left, negative beyond it; None if a kept check knows no degree [-]
    margin: float | None

    @property
    def shown_margin(self) -> float | None:
        """The margin for people: none where round-off stands beside the limit [-]."""
        return None if self.margin is not None and self.margin > 1 - 1e-5 else self.margin


@record
class Verdict:
    """Whether a guide can be built; the numbers are None where there is no guide."""

    feasible: bool
    reason: str  #: The limits that are not kept, or the tightest one
    margin: float  #: Smallest margin of all checks, negative when infeasible [-]
    checks: tuple[LimitCheck, ...]
    rho_min: float | None = None  #: Path and closing [m]
    rho_max: float | None = None  #: Path and closing [m]
    z_min: float | None = None  #: Path and closing [m]
    z_max: float | None = None  #: Path and closing [m]
    #: [N], [Pa]; pressure None without gas
    spring_force_max: float | None = None
    spring_pressure_max: float | None = None
    pressure_angle_max: float | None = None  #: Largest magnitude [rad]
    curvature_radius_min: float | None = None  #: Smallest radius of curvature of the path, bending either way [m]
    #: Roller radius from which the profile is undercut; None if the path never bends inwards [m]
    undercut_radius: float | None = None
    roller_reaction_max: float | None = None  #: [N]
    hertz_stress_max: float | None = None  #: [Pa]
    tilting_couple_max: float | None = None  #: [N*m]
    #: For each kilogram that moves with a roller, at the speed the guide was cut for; left out of all above [N/kg]
    inertia_force_max: float | None = None
    loss_torque_mean: float | None = None  #: Mean over the turn, on the guide's shaft [N*m]
    closure: float = 0.0  #: Gap of the path after a period [m]


def judge(guide: Guide, rollers: RollerParameters, limits: Limits) -> Verdict:
    """Check a guide with the spring that is in it against all limits."""
    if guide.rho is None:
        failed = LimitCheck(name="spring", text=guide.reason, kept=False, margin=-1.0)
        return Verdict(feasible=False, reason=guide.reason, margin=-1.0, checks=(failed,))
    return verdict(_numbers(guide, at_pieces(guide, rollers)), guide.spring, guide.parameters, rollers, limits)


def verdict(
    numbers: dict[str, Any], spring: Spring, parameters: GuideParameters, rollers: RollerParameters, limits: Limits
) -> Verdict:
    """What the numbers of a guide say of the limits, by the names of `Verdict`."""
    track = _track_checks(numbers, spring, parameters, rollers, limits)
    checks = (*_spring_checks(numbers, spring, limits), *track)
    return Verdict(
        feasible=all(c.kept for c in checks),
        reason=_reason(checks),
        margin=min(c.margin for c in checks if c.margin is not None),
        checks=checks,
        **numbers,
    )


def undercut_radius(curvature: np.ndarray) -> float | None:
    """Largest roller radius before the cut profile is undercut.

    Parameters
    ----------
    curvature : ndarray, shape (n,)
        Curvature of the path of the roller centres [1/m]

    Returns
    -------
    radius : float or None
        Smallest radius of curvature where the path bends inwards [m]; None if it never does
    """
    lowest = float(curvature.min())
    return -1 / lowest if lowest < 0 else None


def highest(theta: np.ndarray, values: np.ndarray) -> float:
    """Highest value of a curve given by points, at the top of the parabola through the three points around it.

    Parameters
    ----------
    theta : ndarray, shape (n,)
        Angles, not decreasing; an angle that stands twice is a kink [rad]
    values : ndarray, shape (n,)
        Values [any unit]

    Returns
    -------
    highest : float
        Never below the highest point [unit of the values]
    """
    i = int(values.argmax())
    before, after = np.diff(theta[max(i - 1, 0) : i + 2]) if 0 < i < theta.size - 1 else (0.0, 0.0)
    if before <= 0 or after <= 0 or not np.isfinite(values[i]):
        return float(values[i])
    rise, fall = (values[i] - values[i - 1]) / before, (values[i + 1] - values[i]) / after
    bend = (fall - rise) / (before + after)
    slope = rise + bend * before
    return float(values[i] - slope**2 / (4 * bend)) if bend < 0 else float(values[i])


def _numbers(guide: Guide, contact: Contact) -> dict[str, Any]:
    rho_min, _, rho_max, _ = periodic.extremes(path(guide))
    z_min, z_max = closing(guide, np.array([rho_max, rho_min])).tolist()
    force_max, pressure_max = _largest(guide, contact, z_max)
    return {
        "rho_min": rho_min,
        "rho_max": rho_max,
        "z_min": z_min,
        "z_max": z_max,
        "spring_force_max": force_max,
        "spring_pressure_max": pressure_max,
        "pressure_angle_max": highest(contact.theta, np.abs(contact.pressure_angle)),
        "curvature_radius_min": 1 / highest(contact.theta, np.abs(contact.curvature)),
        "undercut_radius": undercut_radius(contact.curvature),
        "roller_reaction_max": highest(contact.theta, contact.reaction_1),
        "hertz_stress_max": highest(contact.theta, contact.hertz_stress),
        "tilting_couple_max": highest(contact.theta, contact.tilting_couple),
        "inertia_force_max": highest(contact.theta, np.abs(contact.inertia_force)),
        "loss_torque_mean": float(np.trapezoid(contact.loss_torque, contact.theta) / np.ptp(contact.theta)),
        "closure": guide.closure,
    }


def _largest(guide: Guide, contact: Contact, z_max: float) -> tuple[float, float | None]:
    """Largest force [N] and excess pressure [Pa] of the spring; with a law of the closing that of the largest one."""
    if isinstance(guide.spring, AirThermal):
        assert contact.pressure is not None
        return highest(contact.theta, contact.force), highest(contact.theta, contact.pressure)
    functions = law(guide.spring)
    pressure = None if functions.pressure is None else float(functions.pressure(z_max))
    return float(functions.force(z_max)), pressure


def _spring_checks(numbers: dict[str, Any], spring: Spring, limits: Limits) -> list[LimitCheck]:
    z_min = numbers["z_min"]
    # the march of a gas that exchanges heat refuses a path on which it would pull
    force_min = math.inf if isinstance(spring, AirThermal) else float(law(spring).force(z_min))
    longer = f"the spring is {-z_min * 1e3:.3g} mm longer than its free height; place the start"
    checks = [
        LimitCheck(
            name="free_height",
            text=longer if z_min < 0 else f"smallest closing {z_min * 1e3:.3g} mm",
            kept=z_min >= -_ROUNDING * spring.H,
            margin=z_min / spring.H if z_min < 0 else None,
        ),
        _at_most("closing", "closing z/H", numbers["z_max"] / spring.H, limits.closing_share, ""),
        LimitCheck(
            name="spring_force",
            text=f"smallest spring force {force_min / 1e3:.4g} kN" if force_min < math.inf else "the spring pushes",
            kept=force_min > 0,
            margin=None if force_min > 0 else -1.0,
        ),
    ]
    if numbers["spring_pressure_max"] is not None:
        mpa = numbers["spring_pressure_max"] / 1e6, limits.spring_pressure / 1e6
        checks.append(_at_most("spring_pressure", "spring pressure", *mpa, "MPa"))
    return checks


def _track_checks(
    numbers: dict[str, Any], spring: Spring, parameters: GuideParameters, rollers: RollerParameters, limits: Limits
) -> list[LimitCheck]:
    angle, stress = math.degrees(numbers["pressure_angle_max"]), numbers["hertz_stress_max"]
    reaction, centre = numbers["roller_reaction_max"] / 1e3, (1e3 * rollers.radius, 1e3 * numbers["rho_min"])
    checks = [
        _at_most("pressure_angle", "pressure angle", angle, math.degrees(limits.pressure_angle), "deg"),
        _undercut_check(numbers["undercut_radius"], rollers.radius, limits.profile_radius),
        _at_most("roller_reaction", "roller reaction", reaction, limits.roller_reaction / 1e3, "kN"),
        _closure_check(numbers["closure"], _CLOSURE * parameters.rho0),
        _at_most("centre", "roller radius beside the path's smallest radius", *centre, "mm"),
    ]
    if math.isfinite(stress):
        checks.append(_at_most("hertz_stress", "contact pressure", stress / 1e6, limits.hertz_stress / 1e6, "MPa"))
    if ROLLERS[parameters.arrangement] == 2 and not isinstance(spring, Coil):
        checks.append(_room_check(parameters.rho0, spring.H, rollers.radius))
    return checks


def _closure_check(gap: float, limit: float) -> LimitCheck:
    check = _at_most("closure", "gap of the path", gap, limit, "m")
    return replace(check, text="the path closes within a billionth of its radius") if check.kept else check


def _room_check(rho0: float, free_height: float, radius: float) -> LimitCheck:
    # between the roller centres lie 2 rho = H - z + (2 rho0 - H); the rest beside the gas must hold both rollers
    room = (2 * rho0 - free_height) / 2
    kept = _at_most("room", "roller radius beside the gas column", 1e3 * radius, 1e3 * room, "mm")
    if room > 0:
        return kept
    text = (
        f"between the rollers is no room for the gas column: 2 rho0 = {2 * rho0:.4g} m, it is H = {free_height:.4g} m "
        f"long; with rollers of {radius:.4g} m radius rho0 must be at least {free_height / 2 + radius:.4g} m"
    )
    return replace(kept, text=text)


def _undercut_check(largest: float | None, radius: float, profile_radius: float) -> LimitCheck:
    if largest is None:
        text = f"the path never bends inwards; a bulge may have {profile_radius * 1e3:.4g} mm"
        return LimitCheck(name="undercut", text=text, kept=True, margin=None)
    left = largest - radius - profile_radius
    text = (
        f"the path bends inwards with a radius of {largest * 1e3:.4g} mm, which leaves the profile "
        f"{(largest - radius) * 1e3:.4g} mm at a roller radius of {radius * 1e3:.4g} mm"
        + (" (undercut)" if largest <= radius else "")
        + f"; at least {profile_radius * 1e3:.4g} mm"
    )
    return LimitCheck(name="undercut", text=text, kept=left >= 0, margin=left / largest)


def _at_most(name: str, words: str, value: float, limit: float, unit: str) -> LimitCheck:
    text = f"{words} {value:.4g} of at most {limit:.4g} {unit}".rstrip()
    margin = (limit - value) / (limit if limit > 0 else value)
    return LimitCheck(name=name, text=text, kept=margin >= -_ROUNDING, margin=margin)


def _reason(checks: tuple[LimitCheck, ...]) -> str:
    failed = [c.text for c in checks if not c.kept]
    if failed:
        return "; ".join(failed)
    tightest = min((c for c in checks if c.margin is not None), key=lambda c: c.margin or 0.0)
    return f"within all limits; tightest: {tightest.text}"
