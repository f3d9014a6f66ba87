"""Geometry factor J for bending of spur teeth cut by a rack: Lewis parabola in the fillet, stress correction.

                 load line
                   \\ |            r_L  height where the load line meets the tooth's middle
                    \\|
                   / \\            h_F  from there down to the critical section
                  /   \\           s_F  thickness of the critical section, where the
             ____/_____\\____           parabola from r_L touches the fillet

The fillet is the envelope of the tool's tip circle rolling on the pitch circle. All lengths are in modules.
Source: AGMA 908-B89, section 5. It gives 226 of the 237 values of I and J in the source's annex to half a unit of the
last printed digit and the rest to 0.7 (tests/sizing/test_agma908.py).

The tables of AGMA 908-B89 in the source's annex, as data, and the interpolation that the source made in them.

`agma908.csv` holds tables A.2 to A.4 (25 degrees, whole depth 2.350, tool edge radius 0.270, thinning 0.024, load at
the highest point of single tooth contact): I, J of pinion and gear, and how each line could be read. A scan error is
named under `reading` with what the scan shows; the value stands as `gear_bending` and `gear_geometry` give it.
Source: Nunes (2017), annex A.2 to A.4 and table 4.8. AGMA 908 advises against interpolating; the formulas need none.
"""

import csv
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cache
from importlib import resources

import numpy as np

from mechsym.errors import BadInput
from mechsym.files import Json
from mechsym.periodic.roots import root
from mechsym.quantities.units import Pure, Radian
from mechsym.sizing.checks import require
from mechsym.sizing.rules.gear_geometry import Pair, action_line, contact_ratio, tooth_thickness


def bending_geometry_factor(pair: Pair, member: int) -> Pure:
    r"""Geometry factor for bending strength, load at the highest point of single tooth contact.

    .. math:: J = \frac{Y}{K_f m_N}, \qquad
              Y = \left[\frac{\cos\varphi_L}{\cos\varphi}\left(\frac{6 h_F}{s_F^2}
                  - \frac{\tan\varphi_L}{s_F}\right)\right]^{-1}

    pair: the pair; a ring gear counts as an external gear of the same teeth, which is on the safe side. Raises
    BadInput: Contact ratio outside 1 to 2, or no critical section in the fillet (undercut or pointed tooth).
    Source: AGMA 908-B89, section 5 (spur gears, m_N = 1, C_psi = K_psi = 1).

    >>> pair = Pair(kind="external", module=1e-3, teeth_1=26, teeth_2=55, pressure_angle=0.4363323129985824)
    >>> [round(bending_geometry_factor(pair, member), 2) for member in (1, 2)]
    [0.44, 0.49]
    """
    require(
        "contact ratio", contact_ratio(pair), "-", low=1, below=2, hint="the factor holds for one to two tooth pairs"
    )
    phi = pair.pressure_angle
    phi_L, _ = load_height(pair, member)
    h_F, s_F = critical_section(pair, member)
    Y = 1 / (np.cos(phi_L) / np.cos(phi) * (6 * h_F / s_F**2 - np.tan(phi_L) / s_F))
    return float(Y / stress_correction_factor(pair, member))


def load_height(pair: Pair, member: int) -> tuple[Radian, Pure]:
    r"""Load angle and height of the load point on the tooth's middle.

    .. math:: \varphi_L = \frac{\rho_{start} + p_b}{R_b} - \mathrm{inv}\,\varphi - \frac{s}{z}, \qquad
              r_L = R_b/\cos\varphi_L

    Returns phi_L: angle between the load and the tooth's normal; r_L: distance of the load point from the gear's
    centre, in modules. Source: AGMA 908-B89, section 5 (highest point of single tooth contact).

    >>> pair = Pair(kind="external", module=1e-3, teeth_1=26, teeth_2=55, pressure_angle=0.4363323129985824)
    >>> "{:.3f} {:.3f}".format(*load_height(pair, 1))
    '0.432 12.972'
    """
    phi = pair.pressure_angle
    start, end, pitch = action_line(_loaded(pair, member))
    teeth = pair.teeth_1 if member == 1 else pair.teeth_2
    base = teeth / 2 * np.cos(phi)
    rho = start + pitch if member == 1 else (pair.teeth_1 + pair.teeth_2) / 2 * np.sin(phi) - end + pitch
    phi_L = rho / base - (np.tan(phi) - phi) - tooth_thickness(pair, member) / teeth
    return float(phi_L), float(base / np.cos(phi_L))


def critical_section(pair: Pair, member: int) -> tuple[Pure, Pure]:
    r"""Height and thickness of the section where the Lewis parabola touches the fillet.

    .. math:: \frac{\mathrm{d}\eta}{\mathrm{d}\xi}\,\xi + 2 (r_L - \eta) = 0

    Returns h_F, s_F: height of the load point above the section, thickness of the section, in modules. Raises BadInput:
    the fillet has no such point.
    Source: AGMA 908-B89, section 5. (xi, eta) are half thickness and height of a point of the fillet.

    >>> pair = Pair(kind="external", module=1e-3, teeth_1=26, teeth_2=55, pressure_angle=0.4363323129985824)
    >>> "{:.3f} {:.3f}".format(*critical_section(pair, 1))
    '1.184 2.201'
    """
    _, r_L = load_height(pair, member)

    def touching(t: Radian) -> float:
        (xi, eta), (xi_b, eta_b) = fillet(pair, member, t - 1e-6), fillet(pair, member, t + 1e-6)
        return (eta_b - eta) * (xi + xi_b) / 2 + 2 * (r_L - (eta + eta_b) / 2) * (xi_b - xi)

    angles = np.linspace(0.02, np.pi / 2 - pair.pressure_angle, 60)
    values = np.array([touching(t) for t in angles])
    crossing = np.flatnonzero(values[:-1] * values[1:] < 0)
    if crossing.size == 0:
        teeth = f"{pair.teeth_1:g}/{pair.teeth_2:g}"
        raise BadInput(
            f"teeth = {teeth}, shift = {pair.shift:g}: no critical section; the tooth is undercut or pointed"
        )
    xi, eta = fillet(pair, member, root(touching, angles[crossing[0]], angles[crossing[0] + 1], xtol=1e-12))
    return float(r_L - eta), float(2 * xi)


def fillet(pair: Pair, member: int, t: Radian) -> tuple[Pure, Pure]:
    r"""A point of the fillet that the tool's tip circle cuts.

    .. math:: r\,e^{i\delta}, \qquad \delta = \frac{\pi}{z} + \frac{D(t)}{R} - \arg(\text{contact point})

    t: angle of the contact normal against the tooth's height, 0 at the root to pi/2 - phi at the flank. Returns xi,
    eta: half thickness there and height above the gear's centre, in modules.
    Source: rack generation (AGMA 908-B89, section 5): the contact normal passes through the pitch point.

    >>> pair = Pair(kind="external", module=1e-3, teeth_1=26, teeth_2=55, pressure_angle=0.4363323129985824)
    >>> "{:.3f} {:.3f}".format(*fillet(pair, 1, 0.02))
    '1.408 11.539'
    """
    phi, rho = pair.pressure_angle, pair.tip_radius
    teeth = pair.teeth_1 if member == 1 else pair.teeth_2
    R, deep = teeth / 2, _tool_depth(pair, member) - rho
    corner = (np.pi - tooth_thickness(pair, member)) / 2 - deep * np.tan(phi) - rho / np.cos(phi)
    side, length = deep * np.tan(t), deep / np.cos(t)
    x, y = side * (1 + rho / length), R - deep * (1 + rho / length)
    delta = (side - corner) / R + np.pi / teeth - np.arctan2(x, y)
    return np.hypot(x, y) * np.sin(delta), np.hypot(x, y) * np.cos(delta)


def stress_correction_factor(pair: Pair, member: int) -> Pure:
    r"""Stress correction factor of Dolan and Broghamer.

    .. math:: K_f = H + \left(\frac{s_F}{\rho_F}\right)^L\left(\frac{s_F}{h_F}\right)^M, \quad
              \rho_F = \rho_a + \frac{(h - \rho_a)^2}{R + h - \rho_a}

    with H = 0.331 - 0.436 phi, L = 0.324 - 0.492 phi, M = 0.261 + 0.545 phi.
    Source: AGMA 908-B89, section 5; h is the depth of the tool below the pitch circle.

    >>> pair = Pair(kind="external", module=1e-3, teeth_1=26, teeth_2=55, pressure_angle=0.4363323129985824)
    >>> f"{stress_correction_factor(pair, 1):.3f}"
    '1.803'
    """
    phi, rho = pair.pressure_angle, pair.tip_radius
    R = (pair.teeth_1 if member == 1 else pair.teeth_2) / 2
    deep = _tool_depth(pair, member) - rho
    h_F, s_F = critical_section(pair, member)
    H, L, M = 0.331 - 0.436 * phi, 0.324 - 0.492 * phi, 0.261 + 0.545 * phi
    return float(H + (s_F / (rho + deep**2 / (R + deep))) ** L * (s_F / h_F) ** M)


def _tool_depth(pair: Pair, member: int) -> Pure:
    shift = pair.shift if member == 1 else -pair.shift
    return pair.whole_depth - 1 - shift + pair.thinning / (2 * np.tan(pair.pressure_angle))


def _loaded(pair: Pair, member: int) -> Pair:
    """The pair whose contact loads this member: a ring's tooth is taken as that of an external gear."""
    if pair.kind == "external" or member == 1:
        return pair
    return replace(pair, kind="external")


@cache
def table() -> tuple[Json, ...]:
    """The lines of the three tables.

    Returns lines: tuple of dict, keys `shift_pinion, teeth_pinion, teeth_gear, I, J_pinion, J_gear` (numbers, None
    where the table marks the pair undercut or pointed) and `reading`. Source: Nunes (2017), annex A.2 to A.4.

    >>> len(table()), sum(line["reading"] == "clear" for line in table())
    (108, 69)
    """
    text = (resources.files("mechsym.sizing.rules") / "agma908.csv").read_text(encoding="utf-8")
    lines = []
    for row in csv.DictReader(text.splitlines()):
        reading = row.pop("reading")
        lines.append({key: float(value) if value else None for key, value in row.items()} | {"reading": reading})
    return tuple(lines)


def interpolated(quantity: str, shift: Pure, teeth_1: Pure, teeth_2: Pure) -> Pure:
    """A geometry factor by linear interpolation in both tooth numbers, as the source did.

    shift: addendum modification of the pinion: 0, 0.25 or 0.5. teeth_1, teeth_2: teeth of pinion and gear, inside the
    table. Raises BadInput: Outside the tables, or next to a pair that they mark undercut or pointed.
    Source: Nunes (2017), table 4.8: this gives its 18 values.

    >>> f"{interpolated('J_pinion', 0.0, 26, 52):.4f}"  # table 4.8
    '0.4385'
    """
    values = {(r["teeth_pinion"], r["teeth_gear"]): r[quantity] for r in table() if r["shift_pinion"] == shift}
    if not values:
        raise BadInput(f"shift = {shift:g} has no table; there are 0, 0.25 and 0.5 (gear_bending computes the rest)")
    teeth = sorted({gear for _, gear in values})
    require("teeth", [teeth_1, teeth_2], "-", low=teeth[0], high=teeth[-1], hint="gear_bending computes the rest")
    along = {
        one: _linear(teeth_2, teeth, {gear: v for (pinion, gear), v in values.items() if pinion == one})
        for one in teeth
    }
    value = _linear(teeth_1, teeth, along)
    if value is None:
        raise BadInput(f"teeth = {teeth_1:g}/{teeth_2:g}: next to a pair that the table marks undercut or pointed")
    return value


def _linear(at: Pure, nodes: Sequence[float], values: Mapping[float, Pure | None]) -> Pure | None:
    """Linear interpolation that is None where a neighbour it needs is None."""
    right = int(np.clip(np.searchsorted(nodes, at), 1, len(nodes) - 1))
    low, high = nodes[right - 1], nodes[right]
    weight = (at - low) / (high - low)
    needed = [(values.get(node), share) for node, share in ((low, 1 - weight), (high, weight)) if share > 0]
    total = 0.0
    for neighbour, share in needed:
        if neighbour is None:
            return None
        total += neighbour * share
    return total
