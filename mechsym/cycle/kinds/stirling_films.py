"""Films and friction of a Stirling engine's exchangers: tubes, bends, ends, woven screens.

Diameters of ducts are hydraulic, d = 4 V/A_w; friction factors are Darcy's. A flow that swings is laminar over the
whole turn or turbulent, by its largest Reynolds number and by Valensi's number; within the turn it follows the speed
of each instant.
"""

import math
from typing import Annotated

import numpy as np
import scipy

from mechsym.quantities.units import Kelvin, Metre, Pure, Radian, RadPerSecond, Scalar, Viscosity, Watt

_LAMINAR, _TURBULENT = 2300.0, 4000.0
Conductivity = Annotated[float, "W/(m*K)"]
Density = Annotated[float, "kg/m^3"]


def viscosity(mu_0: Viscosity, T_0: Kelvin, sutherland: Kelvin, T: Kelvin[Scalar]) -> Viscosity[Scalar]:
    r"""Dynamic viscosity of a gas.

    .. math:: \mu = \mu_0 \frac{T_0 + S}{T + S} \left(\frac{T}{T_0}\right)^{3/2}

    T_0, sutherland: temperature of reference, and constant S. Source: W. Sutherland, Phil. Mag. 36 (1893); constants as
    in Urieli and Berchowitz (1984), appendix A. Valid: dilute gas, 200 K to 1200 K.

    >>> round(viscosity(17.08e-6, 273.0, 112.0, 300.0) * 1e6, 2)  # air at 300 K; tables have 18.5
    18.39
    """
    return mu_0 * (T_0 + sutherland) / (T + sutherland) * (T / T_0) ** 1.5


def valensi(omega: RadPerSecond, d: Metre, rho: Density, mu: Viscosity) -> Pure:
    r"""Number of Valensi: how far friction at the wall lags behind a flow that swings.

    .. math:: Va = \frac{\omega\, d^2 \rho}{4\mu}

    d: hydraulic diameter; rho, mu: density and viscosity of the gas. Source: T. W. Simon, J. R. Seume, A Survey of
    Oscillating Flow in Stirling Engine Heat Exchangers, NASA CR-182108 (1988). Valid: any flow that swings once a turn.

    >>> round(valensi(262.0, 0.00302, 2.2, 4.3e-5), 1)
    30.6
    """
    return omega * d**2 * rho / (4 * mu)


def laminar_swing(Va: Pure) -> Pure:
    r"""Friction of a laminar flow that swings in a tube, by that of the steady flow at each instant, mean over a turn.

    .. math:: \frac{Va}{8}\,\mathrm{Re}\frac{i}{1 - F}, \qquad F = \frac{2 J_1(\zeta)}{\zeta J_0(\zeta)}, \quad
              \zeta = i^{3/2}\sqrt{Va}

    Va: number of Valensi, from 0 on. Returns ratio: 1 for a slow flow, towards sqrt(Va/2)/4 for a fast one.
    Source: S. Uchida, ZAMP 7 (1956) 403; Simon and Seume, NASA CR-182108 (1988). Valid: sinusoidal, developed, laminar.

    >>> [round(laminar_swing(Va), 3) for Va in (0.0, 10.0, 1000.0)]
    [1.0, 1.078, 5.976]
    """
    if Va < 1e-3:
        return 1.0
    zeta = np.exp(0.75j * math.pi) * math.sqrt(
        min(Va, 1e5)
    )  # the Bessel functions overflow beyond; the limit is reached
    F = 2 * scipy.special.jv(1, zeta) / (zeta * scipy.special.jv(0, zeta))
    return float(Va / 8 * (1j / (1 - F)).real) if Va <= 1e5 else math.sqrt(Va / 2) / 4


def turbulent_share(Re_max: Pure, Va: Pure = 0.0) -> Pure:
    r"""Whether a flow that swings is laminar (0) or turbulent (1); between, a straight line in log Re.

    .. math:: Re_{crit} = \max(2300,\; 882\sqrt{Va})

    Re_max: largest Reynolds number of the turn; Va: number of Valensi, 0 for a steady flow. Returns share: 1 from 1.74
    Re_crit on, which is 4000 in a steady flow. Source: M. Ohmi, M. Iguchi, Bull. JSME 25 (1982) 165, as in Simon and
    Seume, NASA CR-182108 (1988), not held against the print: a public program has 2300 sqrt(Va/10), 727 in place of
    882. Valid: smooth tubes; the width of the transition is that of steady flow.

    >>> [round(turbulent_share(Re, 30.0), 3) for Re in (4000.0, 6000.0, 9000.0)]
    [0.0, 0.392, 1.0]
    """
    critical = max(_LAMINAR, 882 * math.sqrt(Va))
    return float(np.clip(math.log(Re_max / critical) / math.log(_TURBULENT / _LAMINAR), 0.0, 1.0))


def tube_friction(Re: Pure[Scalar], Va: Pure = 0.0) -> Pure[Scalar]:
    r"""Friction factor of Darcy in a smooth tube, at each instant of a turn.

    .. math:: f = 64/Re \cdot \text{swing} \ \text{(laminar)}, \qquad f = \max(64/Re,\, 0.316\,Re^{-1/4}) \
              \text{(turbulent)}

    Re: Reynolds numbers of a turn, of diameter and mean speed, above 0; Va: number of Valensi, 0 for a steady flow.
    Returns f: friction factor, shape of Re; see `laminar_swing`, `turbulent_share`.
    Source: Hagen and Poiseuille; P. R. H. Blasius, VDI-Forschungsheft 131 (1913); swinging flow after Simon and Seume,
    NASA CR-182108 (1988). Valid: Re < 1e5.

    >>> [round(float(tube_friction(Re)), 5) for Re in (640.0, 1e4)]
    [0.1, 0.0316]
    """
    Re = np.asarray(Re, dtype=float)
    share = turbulent_share(float(Re.max()), Va)
    return (1 - share) * 64 / Re * laminar_swing(Va) + share * np.maximum(64 / Re, 0.316 * Re**-0.25)


def tube_nusselt(Re: Pure[Scalar], Pr: Pure, Va: Pure = 0.0) -> Pure[Scalar]:
    r"""Nusselt number in a tube of constant wall temperature, at each instant of a turn.

    .. math:: Nu = 3.66\,\max\left(1, \tfrac16\sqrt{2 Va Pr}\right), \qquad
              Nu = \frac{(f/8)(Re - 1000)\,Pr}{1 + 12.7\sqrt{f/8}\,(Pr^{2/3} - 1)}, \quad f = (0.79 \ln Re - 1.64)^{-2}

    Re: Reynolds numbers of a turn, above 0; Pr: Prandtl number; Va: number of Valensi, 0 for a steady flow. Returns Nu:
    Nusselt number, shape of Re: laminar, turbulent (no less than laminar), see `turbulent_share`.
    Source: V. Gnielinski, Int. Chem. Eng. 16 (1976) 359; swinging laminar flow: D. Gedeon, J. Heat Transfer 108 (1986)
    513, as in Simon and Seume, NASA CR-182108 (1988). Valid: developed flow, 0.5 < Pr < 2000, Re < 5e6.

    >>> [round(float(tube_nusselt(Re, 0.7)), 2) for Re in (1000.0, 1e4)]
    [3.66, 29.82]
    """
    Re = np.asarray(Re, dtype=float)
    share, safe = turbulent_share(float(Re.max()), Va), np.maximum(Re, 1000.0)
    f = (0.79 * np.log(safe) - 1.64) ** -2
    turbulent = f / 8 * (safe - 1000) * Pr / (1 + 12.7 * np.sqrt(f / 8) * (Pr ** (2 / 3) - 1))
    laminar = 3.66 * max(1.0, math.sqrt(2 * Va * Pr) / 6)
    return (1 - share) * laminar + share * np.maximum(3.66, turbulent)


def bend_heads(angle: Radian, radius: Pure) -> Pure:
    r"""Velocity heads that a smooth bend takes beside the friction of its length.

    .. math:: \zeta = A\,\frac{0.21}{\sqrt{R/d}}, \qquad A = 0.9 \sin\alpha \ (\alpha \le 70°), \quad
              A = 0.7 + 0.35\,\alpha/90° \ (\alpha \ge 90°)

    angle: by which the flow turns, up to pi; radius: of the bend's middle line, by the diameter, from 1 on. Returns
    heads: straight between 70 and 90 degrees, of which the law speaks as 1.05. Source: I. E. Idelchik, Handbook of
    Hydraulic Resistance, diagram 6-1. Valid: round tubes, Re > 2e5; below it the handbook has more, up to twice.

    >>> [round(bend_heads(angle, 4.0), 4) for angle in (0.0, math.pi / 2, math.pi)]
    [0.0, 0.1102, 0.147]
    """
    degrees = math.degrees(angle)
    if degrees <= 70:
        share = 0.9 * math.sin(angle)
    else:
        at_70 = 0.9 * math.sin(math.radians(70))
        share = at_70 + (degrees - 70) / 20 * (1.05 - at_70) if degrees < 90 else 0.7 + 0.35 * degrees / 90
    return share * 0.21 / math.sqrt(radius)


def end_heads(share: Pure) -> Pure:
    r"""Velocity heads lost where a flow enters and leaves a bundle of tubes or a matrix.

    .. math:: \zeta = \tfrac12 (1 - \sigma) + (1 - \sigma)^2

    share: free area by area in front, 0 to 1. Returns heads: of the speed inside; 1.5 into and out of a wide header.
    Source: contraction and expansion of sharp edges (Borda and Carnot), as in W. M. Kays, A. L. London, Compact Heat
    Exchangers, 2nd ed. 1964, chapter 5. Valid: turbulent flow.

    >>> [round(end_heads(share), 3) for share in (0.0, 0.7, 1.0)]
    [1.5, 0.24, 0.0]
    """
    return 0.5 * (1 - share) + (1 - share) ** 2


def screen_friction(Re: Pure[Scalar]) -> Pure[Scalar]:
    r"""Friction factor of Darcy in a stack of woven screens, measured in flow that swings.

    .. math:: f = 129/Re + 2.91\,Re^{-0.103}

    Re: Reynolds number of hydraulic diameter and speed in the free area V/L, above 0.
    Source: D. Gedeon, J. G. Wood, Oscillating-Flow Regenerator Test Rig: Hardware and Theory with Derived Correlations
    for Screens and Felts, NASA CR-198442 (1996). Valid: porosity 0.62 to 0.78, 0.45 < Re < 6100.

    >>> round(float(screen_friction(100.0)), 3)
    3.101
    """
    Re = np.asarray(Re, dtype=float)
    return 129 / Re + 2.91 * Re**-0.103


def screen_nusselt(Re: Pure[Scalar], Pr: Pure, porosity: Pure) -> Pure[Scalar]:
    r"""Nusselt number in a stack of woven screens, measured in flow that swings.

    .. math:: Nu = (1 + 0.99\,Pe^{0.66})\,\beta^{1.79}, \qquad Pe = Re\,Pr

    Re: Reynolds number as for `screen_friction`; Pr: Prandtl number; porosity: share beta of gas.
    Source: Gedeon and Wood, NASA CR-198442 (1996), not held against the print: a public program has their friction as
    here and (1 + 0.64 Pe^0.72) in this place. Valid: porosity 0.62 to 0.78, 0.45 < Re < 6100.

    >>> round(float(screen_nusselt(100.0, 0.7, 0.7)), 2)
    9.16
    """
    return (1 + 0.99 * (np.asarray(Re, dtype=float) * Pr) ** 0.66) * porosity**1.79


def screen_mixing(Re: Pure[Scalar], Pr: Pure, porosity: Pure) -> Pure[Scalar]:
    r"""Conductivity along a stack of woven screens by eddies in the gas, by that of the gas.

    .. math:: N_k = 0.73 + 0.50\,Pe^{0.62}\,\beta^{-2.91}

    Re, Pr, porosity: as for `screen_nusselt`. Returns N_k: of the free area.
    Source: Gedeon and Wood, NASA CR-198442 (1996), the third of the laws taken from the same runs. Valid: as there.

    >>> round(float(screen_mixing(100.0, 0.7, 0.7)), 1)
    20.4
    """
    return 0.73 + 0.5 * (np.asarray(Re, dtype=float) * Pr) ** 0.62 * porosity**-2.91


def screen_conductivity(gas: Conductivity, wire: Conductivity, porosity: Pure) -> Conductivity:
    r"""Conductivity along a stack of woven screens at rest, of its whole front.

    .. math:: k = k_g \left(\frac{k_w}{k_g}\right)^{(1 - \beta)^{0.59}}

    gas, wire: conductivities of both; porosity: share beta of gas.
    Source: B. F. Alexander, thesis, Catholic University of America (1972). Valid: screens pressed on each other.

    >>> round(screen_conductivity(0.25, 20.0, 0.7), 3)
    2.154
    """
    return gas * (wire / gas) ** ((1 - porosity) ** 0.59)


def regenerator_effectiveness(ntu: Pure) -> Pure:
    r"""Effectiveness of a balanced regenerator with a heavy matrix.

    .. math:: \varepsilon = \frac{NTU}{1 + NTU}, \qquad NTU = \tfrac12\,St\,A_w/A

    ntu: transfer units of matrix to matrix, half of those of one blow. Returns effectiveness: share of the heat that
    comes back. Source: Kays and London (1964), balanced counter flow; Urieli and Berchowitz (1984), section 5.2. Valid:
    heat capacity of the matrix large against that of the gas of a blow.

    >>> regenerator_effectiveness(99.0)
    0.99
    """
    return ntu / (1 + ntu)


def along_matrix(k: Conductivity, area: Annotated[float, "m^2"], length: Metre, dT: Kelvin) -> Watt:
    r"""Heat along a matrix, by gas or by wire.

    .. math:: \dot Q = k A\,\Delta T / L

    k, area: conductivity and the area that it counts for; dT: difference of temperature of the ends.
    Source: Fourier's law. Valid: straight profile of temperature.

    >>> round(along_matrix(2.2, 0.0032, 0.0226, 543.0), 1)
    169.1
    """
    return k * area * dT / length
