"""Fatigue of shafts: endurance limit, notches, mean stress, and the factor of a load history (Goodman).

Source: Budynas and Nisbett, Shigley's Mechanical Engineering Design, ch. 6 and 7; notch factors: fits of Peterson's
charts in R. L. Norton, Machine Design, appendix.
"""

from collections.abc import Mapping

import numpy as np

from mechsym.errors import BadInput
from mechsym.quantities.units import Array, Metre, NewtonMetre, Pascal, Pure, Scalar
from mechsym.sizing.checks import require

# k_a = a * (S_ut/MPa)^b
SURFACES = {"ground": (1.58, -0.085), "machined": (4.51, -0.265), "as-forged": (272.0, -0.995)}
# D/d: (A, b) of K_t = A (r/d)^b for a shoulder fillet
_BENDING = {1.2: (0.97098, -0.21796), 1.5: (0.93836, -0.25759), 2.0: (0.90879, -0.28598), 3.0: (0.89334, -0.30860)}
_TORSION = {1.2: (0.83425, -0.21649), 1.33: (0.84897, -0.23161), 2.0: (0.86331, -0.23865)}


def endurance_limit(S_ut: Pascal, d: Metre, surface: str) -> Pascal:
    r"""Endurance limit of a steel shaft in rotating bending.

    .. math:: S_e = k_a k_b \min(0.5\,S_{ut}, 700\,\mathrm{MPa}), \quad k_a = a (S_{ut}/\mathrm{MPa})^b

    with k_b = (d/7.62 mm)^-0.107 up to 51 mm, 1.51 (d/mm)^-0.157 above, and at most 1. S_ut: ultimate strength, up to
    2400 MPa; d: diameter, up to 254 mm.
    Source: Shigley, eqs. 6-8, 6-18 to 6-20. Valid: steels, 50 % reliability, room temperature.

    Shigley, example 7-1: k_a = 0.787, k_b = 0.870 and S_ut = 105 kpsi give 35.95 kpsi before the reliability; the
    factors unrounded give 35.99.

    >>> f"{endurance_limit(105 * 6.894757e6, 1.1 * 0.0254, 'machined') / 6.894757e6:.1f}"
    '36.0'
    """
    require("ultimate strength S_ut", S_ut, "Pa", low=200e6, high=2400e6, hint="the rule is for steels")
    require("diameter d", d, "m", low=2e-3, high=0.254)
    if surface not in SURFACES:
        raise BadInput(f"surface = {surface!r} is not an option; options are {', '.join(SURFACES)}")
    a, b = SURFACES[surface]
    size = (d / 7.62e-3) ** -0.107 if d <= 0.051 else 1.51 * (d * 1e3) ** -0.157
    return min(1.0, a * (S_ut / 1e6) ** b) * min(1.0, size) * min(0.5 * S_ut, 700e6)


def fillet_factor_bending(r: Metre, d: Metre, D: Metre) -> Pure:
    """Stress concentration of a shoulder fillet in bending.

    .. math:: K_t = A (r/d)^b

    r: radius of the fillet, 0.01 to 0.3 of d; d, D: smaller and larger diameter. Returns K_t: factor; used for K_f,
    which is on the safe side.
    Source: Norton's fit of Peterson's chart; D/d is taken at the next larger line of the chart, above 3 as 3.

    >>> f"{fillet_factor_bending(0.11, 1.1, 1.65):.2f}"  # Shigley, example 7-1, reads 1.68
    '1.70'
    """
    return _fillet(r, d, D, _BENDING)


def fillet_factor_torsion(r: Metre, d: Metre, D: Metre) -> Pure:
    """Stress concentration of a shoulder fillet in torsion.

    .. math:: K_{ts} = A (r/d)^b

    r: radius of the fillet, 0.01 to 0.3 of d; d, D: smaller and larger diameter. Returns K_ts: factor; used for K_fs.
    Source: Norton's fit of Peterson's chart; D/d is taken at the next larger line of the chart, above 2 as 2.

    >>> f"{fillet_factor_torsion(0.11, 1.1, 1.33 * 1.1):.2f}"  # Shigley, example 7-1, reads 1.42
    '1.45'
    """
    return _fillet(r, d, D, _TORSION)


def stress_cycle(stress: Pascal[Array]) -> tuple[Pascal[Array], Pascal[Array]]:
    r"""Amplitude and mean of a stress history.

    .. math:: \sigma_a = \tfrac12(\sigma_{max} - \sigma_{min}), \qquad \sigma_m = \tfrac12(\sigma_{max} + \sigma_{min})

    stress: signed stress over a period, shape (..., n). Returns amplitude, mean: of the largest cycle in the history,
    shape (...).
    Source: Shigley, eq. 6-36. The largest cycle of a period decides infinite life; smaller ones lie inside it.

    >>> [float(x) for x in stress_cycle(np.array([0.0, 3.0, -1.0]))]
    [2.0, 1.0]
    """
    stress = np.asarray(stress, dtype=float)
    high, low = stress.max(axis=-1), stress.min(axis=-1)
    return (high - low) / 2, (high + low) / 2


def goodman_factor(sigma_a: Pascal[Scalar], sigma_m: Pascal[Scalar], S_e: Pascal, S_ut: Pascal) -> Pure[Scalar]:
    r"""Fatigue safety factor on the modified Goodman line.

    .. math:: \frac1n = \frac{\sigma_a}{S_e} + \frac{\sigma_m}{S_{ut}}

    sigma_a, sigma_m: amplitude and mean of the equivalent stress, notches included; a mean of compression counts as 0.
    S_e: endurance limit. S_ut: ultimate strength. Returns n: safety factor against load, both parts growing alike.
    Source: Shigley, eqs. 6-46 and 7-7 (DE-Goodman).

    Shigley, problem 7-1 (8th ed.), d = 1.073 in for n = 2: both parts as 16/(pi d^3) times 2920 and 2391 lbf.in.

    >>> per = 16 / (np.pi * 1.073**3)
    >>> f"{goodman_factor(per * 2920, per * 2391, 30e3, 100e3):.2f}"
    '2.00'
    """
    require("strengths S_e, S_ut", [S_e, S_ut], "Pa", above=0)
    require("amplitude sigma_a", sigma_a, "Pa", low=0)
    with np.errstate(divide="ignore"):
        return 1 / np.asarray(np.asarray(sigma_a) / S_e + np.maximum(sigma_m, 0) / S_ut)


def shaft_diameter_goodman(
    moments: tuple[NewtonMetre, NewtonMetre, NewtonMetre, NewtonMetre],
    S_e: Pascal,
    S_ut: Pascal,
    n: Pure,
    K_f: Pure = 1.0,
    K_fs: Pure = 1.0,
) -> Metre:
    r"""Diameter of a shaft in bending and torsion for a wanted fatigue factor.

    .. math:: d = \left[\frac{16 n}{\pi}\left(\frac{\sqrt{4 (K_f M_a)^2 + 3 (K_{fs} T_a)^2}}{S_e}
              + \frac{\sqrt{4 (K_f M_m)^2 + 3 (K_{fs} T_m)^2}}{S_{ut}}\right)\right]^{1/3}

    moments: M_a, M_m, T_a, T_m: amplitude and mean of bending moment and torque. S_e, S_ut: endurance limit and
    ultimate strength. n: wanted safety factor. K_f, K_fs: notch factors in bending and torsion.
    Source: Shigley, eq. 7-8 (DE-Goodman).

    Shigley, problem 7-1 (8th ed.): d = 1.073 in (in pounds and inches).

    >>> f"{shaft_diameter_goodman((600, 500, 400, 300), 30e3, 100e3, 2.0, K_f=2.2, K_fs=1.8):.3f}"
    '1.073'
    """
    require("wanted factor n", n, "-", above=0)
    require("notch factors", [K_f, K_fs], "-", low=1)
    M_a, M_m, T_a, T_m = moments
    A = np.sqrt(4 * (K_f * M_a) ** 2 + 3 * (K_fs * T_a) ** 2)
    B = np.sqrt(4 * (K_f * M_m) ** 2 + 3 * (K_fs * T_m) ** 2)
    return (16 * n / np.pi * (A / S_e + B / S_ut)) ** (1 / 3)


def _fillet(r: Metre, d: Metre, D: Metre, chart: Mapping[Pure, tuple[Pure, Pure]]) -> Pure:
    require("diameter d", d, "m", above=0)
    require("ratio D/d", D / d, "-", above=1, hint="without a shoulder there is no fillet")
    require("ratio r/d", r / d, "-", low=0.01, high=0.3, hint="the chart ends there")
    line = next((ratio for ratio in chart if ratio >= D / d - 1e-12), max(chart))
    A, b = chart[line]
    return max(1.0, A * (r / d) ** b)
