"""A spring, its guide and their limits at one angle, written out for symbols; see `kernel`."""

from types import SimpleNamespace
from typing import Any

import casadi as ca
import numpy as np

from mechsym.hinge import rollers as _rollers
from mechsym.hinge.law_path import FULL, LawSpring
from mechsym.hinge.springs import AirGauge, Coil, absolute_pressure, coil_force, gauge_pressure

track: Any = _rollers  # its formulas take symbols too
_STRAIGHT = 1e-5  # least n - 1: nearer to the isotherm its energy would lose digits and the margins would not change
_NEWTON = 3  # steps from a start that is a per cent off


def coordinate(kind: type[LawSpring], s: SimpleNamespace) -> SimpleNamespace:
    """Force and energy over the coordinate in which the energy is nearly straight: z of a coil, -ln(1 - z/H) of gas."""
    if kind is Coil:

        def closed(U: Any) -> Any:
            return 2 * U / (s.F0 + np.sqrt(s.F0**2 + 2 * s.k * U))

        return SimpleNamespace(
            z=lambda x: x, of_closing=lambda z: z, energy=lambda x: s.F0 * x + s.k * x**2 / 2, at=closed,
            force=lambda z: coil_force(z, s.k, s.F0), pressure=None,
        )  # fmt: skip
    pa, e = 0.0 if kind is AirGauge else s.pa, np.maximum(s.n - 1, _STRAIGHT)
    full, outside = s.A * (s.p0 + pa) * s.H, s.A * pa * s.H

    def energy(x: Any) -> Any:
        # exp - 1 and not expm1, which would be computed one design at a time
        return full * (np.exp(e * x) - 1) / e + outside * (np.exp(-x) - 1)

    def at(U: Any) -> Any:
        x = np.log(1 + e * (U + outside) / full) / e
        for _ in range(0 if kind is AirGauge else _NEWTON):
            x = x - (energy(x) - U) / (full * np.exp(e * x) - outside * np.exp(-x))
        return x

    def pressure(z: Any) -> Any:
        return gauge_pressure(z, s.H, s.p0, s.n) if kind is AirGauge else absolute_pressure(z, s.H, s.p0, s.n, s.pa)

    return SimpleNamespace(
        z=lambda x: s.H * (1 - np.exp(-x)), of_closing=lambda z: -np.log(1 - z / s.H), at=at, pressure=pressure,
        energy=energy, force=lambda z: s.A * pressure(z),
    )  # fmt: skip


def over_the_turn(
    stage: ca.SX, air: SimpleNamespace, at_start: Any, c: int, letters: dict[str, SimpleNamespace]
) -> list[Any]:
    """What has its largest value somewhere around the turn."""
    M, dM, W = stage[0], stage[1], stage[2]
    z, at = ca.SX.sym("z"), air.z(air.at(at_start - W))
    law = air.force(z)
    F, F_z = (ca.substitute(of, z, at) for of in (law, ca.gradient(law, z)))
    rho, drho = letters["guide"].rho0 - at / c, M / (c * F)
    d2rho = dM / (c * F) + M * F_z * drho / F**2
    rollers: Any = letters["rollers"]
    kappa = track.curvature(rho, drho, d2rho)
    inertia = rollers.moving_mass * track.inertia_force(rho, d2rho, letters["torque"].omega)
    N = track.reaction(F + inertia, rho, drho)
    return [np.abs(drho) / rho, -kappa, N, track.hertz_stress(N, kappa, rollers)]


def of_limits(
    kind: type[LawSpring], c: int, air: SimpleNamespace, most: Any, least: Any, peaks: ca.SX,
    letters: dict[str, SimpleNamespace],
) -> dict[str, Any]:  # fmt: skip
    """Margins by the names of the checks, and under `cut` a number above 0 where there is a guide."""
    s, guide, rollers, limits = (letters[name] for name in ("spring", "guide", "rollers", "limits"))
    z_max, z_min = air.z(air.at(most)), air.z(air.at(least))
    rho_min = guide.rho0 - z_max / c

    def left(value: Any, limit: Any) -> Any:
        return (limit - value) / ca.if_else(limit > 0, limit, value)

    found = {
        "free_height": ca.if_else(z_min < -1e-12 * s.H, z_min / s.H, ca.inf),
        "closing": left(z_max / s.H, limits.closing_share),
        "pressure_angle": left(track.pressure_angle(1.0, peaks[0]), limits.pressure_angle),
        "undercut": ca.if_else(peaks[1] > 0, 1 - (rollers.radius + limits.profile_radius) * peaks[1], ca.inf),
        "roller_reaction": left(peaks[2], limits.roller_reaction),
        "centre": left(rollers.radius, rho_min),
        "hertz_stress": left(peaks[3], limits.hertz_stress),
        "cut": ca.fmin(ca.fmin(air.force(z_min), FULL * s.H - z_max), rho_min),
    }
    if air.pressure is not None:
        found["spring_pressure"] = left(air.pressure(z_max), limits.spring_pressure)
        if c == 2:
            found["room"] = left(rollers.radius, guide.rho0 - s.H / 2)
    return {name: ca.SX(value) for name, value in sorted(found.items(), key=lambda pair: pair[0] == "cut")}
