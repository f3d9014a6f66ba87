"""The crank drive: forces along the rod, crankpin between two webs, shafts on both sides, pins and shoes.

             d_bearing
        |<-------------->|
        R       F        R        F on the middle of the pin, R = F/2 at the bearings
        ^   |===|====|   ^
     ---+---|web|pin |---+---     l_pin, d_pin;  web t x w

Straight beam statics. The pin of a crosshead only swings, and in a two-stroke engine its load never turns round: what
carries it is the film that the load squeezes and the swing renews.
Source: Nunes (2017), ch. 4.5 and 4.6, after Khurmi and Gupta (2005).
"""

from typing import Annotated

import numpy as np

from mechsym.quantities.units import (
    Array,
    Metre,
    MetrePerSecond,
    Newton,
    NewtonMetre,
    Pascal,
    Radian,
    Scalar,
    Second,
    Viscosity,
)
from mechsym.sizing.checks import require


def slider_crank_chain(F: Newton[Array], theta: Radian[Array], r: Metre, l: Metre) -> dict[str, Newton[Array]]:
    r"""Forces of a slider crank with mass on the piston only.

    .. math:: \sin\psi = \tfrac{r}{l}\sin\theta, \quad S = F/\cos\psi, \quad N = F\tan\psi, \quad
              T_t = S\sin(\theta + \psi), \quad T_r = S\cos(\theta + \psi)

    F: force on the piston pin, positive away from the head, shape (k, n); theta: crank angle from top dead centre; r,
    l: crank radius and rod length. Returns chain: `rod`, `side`, `tangential`, `radial`, shape (k, n).
    Source: Nunes (2017), eqs. 2.65 to 2.67. Valid: r < l.

    >>> chain = slider_crank_chain(np.array([[1000.0]]), np.array([np.pi / 2]), 0.026, 0.09)
    >>> round(float(chain["tangential"][0, 0])), round(float(chain["side"][0, 0]))
    (1000, 302)
    """
    require("ratio r/l", r / l, "-", above=0, below=1, hint="the rod must be longer than the crank")
    psi = np.arcsin(r / l * np.sin(theta))
    rod = np.asarray(F) / np.cos(psi)
    return {
        "rod": rod,
        "side": np.asarray(F) * np.tan(psi),
        "tangential": rod * np.sin(theta + psi),
        "radial": rod * np.cos(theta + psi),
    }


def bearing_reaction(F: Newton, d_force: Metre, d_bearing: Metre) -> Newton:
    r"""Reaction of a bearing on the crankpin's load.

    .. math:: R = F\,d_{force}/d_{bearing}

    d_force: from the other bearing to the load; d_bearing: between the two bearings.
    Source: Nunes (2017), eq. 4.31. Print: F = 27410 N has two digits exchanged; it is 27140 N, R = 13570 N. Valid: two
    bearings, each free to tilt, all loads in one plane.

    >>> bearing_reaction(27140.0, 0.043, 0.086)
    13570.0
    """
    require("distance between bearings", d_bearing, "m", above=0)
    require("distance of the load", d_force, "m", low=0, high=d_bearing, hint="the load must be between the bearings")
    return F * d_force / d_bearing


def crankpin_diameter(R: Newton, arm: Metre, sigma_b: Pascal) -> Metre:
    r"""Diameter of a crankpin in bending.

    .. math:: d = \sqrt[3]{\frac{32 R\,a}{\pi\sigma_b}}

    R: reaction at the bearing; arm: from the bearing to the middle of the pin; sigma_b: allowable bending stress.
    Source: Nunes (2017), eq. 4.32. Valid: crank at dead centre, no torsion in the pin.

    >>> [f"{crankpin_diameter(F / 2, 0.043, 454.7125e6) * 1e3:.2f}" for F in (27410.0, 27140.0)]
    ['23.63', '23.56']
    """
    require("reaction R", R, "N", low=0)
    require("arm", arm, "m", above=0)
    require("allowable stress sigma_b", sigma_b, "Pa", above=0)
    return (32 * R * arm / (np.pi * sigma_b)) ** (1 / 3)


def web_width(d_pin: Metre) -> Metre:
    r"""Usual width of a crank web.

    .. math:: w = 1.125\,d + 12.7\,\mathrm{mm}

    d_pin: diameter of the crankpin.
    Source: Nunes (2017), eq. 4.33. Valid: a start for small forged crankshafts; the stress decides (`web_stress`).

    >>> f"{web_width(0.025) * 1e3:.2f}"
    '40.83'
    """
    require("crankpin diameter", d_pin, "m", above=0)
    return 1.125 * d_pin + 12.7e-3


def web_stress(R: Newton, arm: Metre, l_pin: Metre, t: Metre, w: Metre) -> Pascal:
    r"""Bending and direct stress of a crank web.

    .. math:: \sigma = \frac{6 R\left(a - \frac{l}{2} - \frac{t}{2}\right)}{w t^2} + \frac{R}{w t}

    R: reaction at the bearing; arm: from the bearing to the middle of the pin; l_pin: length of the crankpin; t, w:
    thickness and width of the web. Source: Nunes (2017), eq. 4.34. Print: 118.074 MPa holds for F = 27410 N and w = 65
    mm; the printed mass of the crankshaft leaves webs of 614 mm2: the outline of pin and shaft (`masses.web_outline`),
    not a disc of 65 mm. Valid: crank at dead centre, rectangular web, fillets without effect.

    >>> f"{web_stress(27410.0 / 2, 0.043, 0.034, 0.015, 0.065) / 1e6:.3f}"
    '118.074'
    """
    require("web t and w", [t, w], "m", above=0)
    lever = arm - l_pin / 2 - t / 2
    require("lever of the web", lever, "m", low=0, hint="the bearing must stand outside the web")
    return rectangle_stress(R * lever, R, w, t)


def shaft_diameter(T: NewtonMetre, tau: Pascal) -> Metre:
    r"""Diameter of a round shaft in torsion.

    .. math:: d = \sqrt[3]{\frac{16 T}{\pi\tau}}

    T: largest torque; tau: allowable shear stress. Source: Nunes (2017), eq. 4.35. Print: 7.82 mm is not what 243.6 N.m
    and 1250/1.5 MPa give; 78.2 N.m would. Valid: round solid shaft, torsion alone, elastic.

    >>> [f"{shaft_diameter(T, 1250e6 / 1.5) * 1e3:.2f}" for T in (243.6, 78.2)]
    ['11.42', '7.82']
    """
    require("torque T", T, "N*m", low=0)
    require("allowable stress tau", tau, "Pa", above=0)
    return (16 * T / (np.pi * tau)) ** (1 / 3)


def bending_stress(M: NewtonMetre[Scalar], d: Metre) -> Pascal[Scalar]:
    r"""Bending stress of a round shaft.

    .. math:: \sigma = \frac{32 M}{\pi d^3}

    M: bending moment; d: diameter. Returns sigma: stress at the surface.
    Source: beam theory; eq. 4.32 of Nunes (2017) solved for the stress. Valid: round solid section, elastic.

    >>> f"{bending_stress(13570 * 0.043, 0.025) / 1e6:.1f}"
    '380.4'
    """
    require("diameter d", d, "m", above=0)
    return 32 * M / (np.pi * d**3)


def torsion_stress(T: NewtonMetre[Scalar], d: Metre) -> Pascal[Scalar]:
    r"""Shear stress of a round shaft in torsion.

    .. math:: \tau = \frac{16 T}{\pi d^3}

    d: diameter. Returns tau: stress at the surface. Source: eq. 4.35 of Nunes (2017) solved for the stress: his 8 mm
    shaft has 2423 MPa against 1250 MPa ultimate. Valid: round solid section, elastic.

    >>> f"{torsion_stress(243.6, 0.008) / 1e6:.0f}"
    '2423'
    """
    require("diameter d", d, "m", above=0)
    return 16 * T / (np.pi * d**3)


def specific_pressure(F: Newton, length: Metre, width: Metre) -> Pascal:
    r"""Load by projected area of a pin, a journal or a shoe.

    .. math:: p = \frac{F}{l\,b}

    F: largest load; length, width: length, and diameter of a pin or width of a shoe. Returns p: specific pressure.
    Source: definition; usual limits after K. Maass, H. Klier, Kraefte, Momente und deren Ausgleich in der
    Verbrennungskraftmaschine (1981), and Woodyard, Pounder's Marine Diesel Engines (2009), ch. 9. Valid: load spread
    over the whole length.

    >>> round(specific_pressure(500e3, 0.3, 0.2) / 1e6, 2)
    8.33
    """
    require("length", length, "m", above=0)
    require("width", width, "m", above=0)
    return F / (length * width)


def squeeze_time(
    F: Newton, length: Metre, diameter: Metre, arc: Radian, mu: Viscosity, h_1: Metre, h_2: Metre
) -> Second:
    r"""Time in which a steady load squeezes the film of a pin from one thickness to another.

    .. math:: t = k\,\frac{\mu\,l\,b^3}{2 F}\left(\frac{1}{h_2^2} - \frac{1}{h_1^2}\right), \qquad
        k = 1 - \frac{192\,b}{\pi^5\,l} \sum_{n = 1, 3, ..} \frac{\tanh(n \pi l/2 b)}{n^5}, \qquad b = d\,\alpha/2

    arc: angle of the bearing shell that carries; mu: viscosity of the oil; h_1, h_2: film at the start and at the end,
    h_1 above h_2. Source: O. Reynolds (1886), parallel plates l by b; k for the oil that leaves at the ends: Poisson's
    equation on a rectangle, D. F. Hays, J. Basic Eng. 83 (1961) 579; 1 for a long pin, 0.42 for l = b. Valid: film even
    over the arc (clearance small against h_2: a pin in a wider shell is squeezed sooner), rigid surfaces.

    >>> round(squeeze_time(500e3, 0.3, 0.2, 2.0, 0.03, 60e-6, 10e-6), 3)
    0.411
    """
    require("load F", F, "N", above=0)
    require("film h_2", h_2, "m", above=0, below=h_1)
    width = diameter * arc / 2
    n, ratio = np.arange(1, 60, 2), length / width
    ends = 1 - 192 / (np.pi**5 * ratio) * float(np.sum(np.tanh(n * np.pi * ratio / 2) / n**5))
    return ends * mu * length * width**3 / (2 * F) * (1 / h_2**2 - 1 / h_1**2)


def rectangle_stress(moment: NewtonMetre, F: Newton, width: Metre, thickness: Metre) -> Pascal:
    r"""Largest stress in a crank web of rectangular section.

    .. math:: \sigma = \frac{6 M}{w t^2} + \frac{F}{w t}

    moment: bending moment about the web's weak axis. F: force along the web. width, thickness: section: w across, t
    along the shaft. Returns sigma: nominal stress. Source: beam theory; R. S. Khurmi, J. K. Gupta, A Textbook of
    Machine Design (2005), ch. 32. Valid: fillets are left out, so the wanted factor must hold their notch effect.

    >>> round(rectangle_stress(40e3, 250e3, 0.4, 0.12) / 1e6, 2)
    46.88
    """
    require("width", width, "m", above=0)
    require("thickness", thickness, "m", above=0)
    return 6 * abs(moment) / (width * thickness**2) + abs(F) / (width * thickness)


def wear_index(p: Pascal[Array], sliding: MetrePerSecond[Array], phi: Radian[Array]) -> Annotated[float, "Pa*m/s"]:
    r"""Mean over a turn of pressure times sliding speed.

    .. math:: W = \frac{1}{\Delta\varphi}\int p\,|v|\,\mathrm{d}\varphi

    p: specific pressure over the turn; phi: crank angles of a whole turn, first and last point the same. Returns index:
    mean product; wear of a given pair grows with it and the hours. Source: J. F. Archard, J. Appl. Phys. 24 (1953) 981:
    worn depth is k p s. Valid for comparing designs of the same pair and lubrication.

    >>> turn = np.linspace(0, 2 * np.pi, 721)
    >>> round(wear_index(np.full(721, 1e6), np.sin(turn), turn) / 1e6, 4)
    0.6366
    """
    return float(np.trapezoid(np.abs(p) * np.abs(sliding), phi) / (phi[-1] - phi[0]))
