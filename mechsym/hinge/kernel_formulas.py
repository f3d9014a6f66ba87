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
_HALLEY = 3  # steps, each with three times the digits of the last, from a start that is a thousandth off


def coordinate(kind: type[LawSpring], s: SimpleNamespace) -> SimpleNamespace:
    """Force and energy over the coordinate in which the energy is nearly straight: z of a coil, -ln(1 - z/H) of gas."""
    return _coil(s) if kind is Coil else _gas(s, kind is AirGauge)


def _coil(s: SimpleNamespace) -> SimpleNamespace:
    def at(U: Any) -> Any:
        return 2 * U / (s.F0 + np.sqrt(s.F0**2 + 2 * s.k * U))

    def along(U: Any) -> tuple[Any, Any, Any]:
        return at(U), coil_force(at(U), s.k, s.F0), s.k

    return SimpleNamespace(
        z=lambda x: x, of_closing=lambda z: z, energy=lambda x: s.F0 * x + s.k * x**2 / 2, at=at, along=along,
        force=lambda z: coil_force(z, s.k, s.F0), pressure=None,
    )  # fmt: skip


def _gas(s: SimpleNamespace, gauge: bool) -> SimpleNamespace:
    pa, e = 0.0 if gauge else s.pa, np.maximum(s.n - 1, _STRAIGHT)
    full, outside = s.A * (s.p0 + pa) * s.H, s.A * pa * s.H
    # products with these are cheaper than quotients, and the kernel computes them once
    per_e, per_H = 1 / e, 1 / s.H
    near, step = _inverse(full, outside, e)

    def energy(x: Any) -> Any:
        # exp - 1 and not expm1, which would be computed one design at a time
        return full * (np.exp(e * x) - 1) * per_e + outside * (np.exp(-x) - 1)

    def at(U: Any) -> Any:
        x = np.log(near(U)) * per_e
        for _ in range(0 if gauge else _HALLEY):
            x = x + step(np.exp(e * x), np.exp(-x), U)
        return x

    def along(U: Any) -> tuple[Any, Any, Any]:
        """Closing, force and its slope: the exponentials are computed once and follow two steps by their series."""
        E = near(U)
        V = np.exp(-per_e * np.log(E))
        for _ in range(0 if gauge else 2):
            d = step(E, V, U)
            E, V = E * _exp(e * d), V * _exp(-d)
        per_V = 1 / V
        pressed = (full * per_H) * E * per_V
        return s.H * (1 - V), pressed - outside * per_H, (s.n * per_H) * pressed * per_V

    def pressure(z: Any) -> Any:
        return gauge_pressure(z, s.H, s.p0, s.n) if gauge else absolute_pressure(z, s.H, s.p0, s.n, s.pa)

    return SimpleNamespace(
        z=lambda x: s.H * (1 - np.exp(-x)), of_closing=lambda z: -np.log(1 - z / s.H), at=at, along=along,
        pressure=pressure, energy=energy, force=lambda z: s.A * pressure(z),
    )  # fmt: skip


def _inverse(full: Any, outside: Any, e: Any) -> tuple[Any, Any]:
    """From the energy U to x: nearly exp(e x), and a step of Halley from where exp(e x) is E and exp(-x) is V."""
    per_e, per_full = 1 / e, 1 / full

    def near(U: Any) -> Any:
        # what the outside takes of the energy, by the force that the free spring has
        D = full - outside + U / 2
        share = D**2 / (D**2 + D * U + U**2 / 2)
        return 1 + (e * per_full) * (U + outside * (1 - share))

    def step(E: Any, V: Any, U: Any) -> Any:
        over = (full * per_e) * (E - 1) + outside * (V - 1) - U
        slope, bend = full * E - outside * V, e * full * E + outside * V
        return -2 * over * slope / (2 * slope**2 - over * bend)

    return near, step


def _exp(d: Any) -> Any:
    """Series of exp(d) for small d."""
    return 1 + d * (1 + d * (1 / 2 + d * (1 / 6 + d / 24)))


def over_the_turn(
    stage: ca.SX, air: SimpleNamespace, at_start: Any, c: int, letters: dict[str, SimpleNamespace]
) -> list[Any]:
    """What has its largest value somewhere around the turn."""
    M, dM, W = stage[0], stage[1], stage[2]
    z, F, F_z = air.along(at_start - W)
    rho, drho = letters["guide"].rho0 - z / c, M / (c * F)
    d2rho = dM / (c * F) + M * F_z * drho / F**2
    rollers: Any = letters["rollers"]
    kappa = track.curvature(rho, drho, d2rho)
    inertia = rollers.moving_mass * track.inertia_force(rho, d2rho, letters["torque"].omega)
    N = track.reaction(F + inertia, rho, drho)
    return [np.abs(drho / rho), -kappa, N, track.hertz_stress(N, kappa, rollers)]


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
