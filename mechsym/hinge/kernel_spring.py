"""A spring over a coordinate in which its energy is nearly straight, written out for symbols."""

from types import SimpleNamespace
from typing import Any

import numpy as np

from mechsym.hinge.law_path import LawSpring
from mechsym.hinge.springs import AirGauge, Coil, absolute_pressure, coil_force, gauge_pressure

_STRAIGHT = 1e-5  # least n - 1: nearer to the isotherm its energy would lose digits and the margins would not change
_NEWTON = 3  # steps from a start that is a per cent off


def coordinate(kind: type[LawSpring], s: SimpleNamespace) -> SimpleNamespace:
    """Force and energy of a spring over that coordinate: z of a coil, -ln(1 - z/H) of a gas."""
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
