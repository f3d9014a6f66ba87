"""What a Stirling engine loses past its pistons, in the gap around its hot dome, and in heat that comes too late.

Powers and heats are in watts, positive where they cost.
"""

import math
from typing import Annotated

from mechsym.quantities.units import Area, Kelvin, MassFlow, Metre, Pascal, Pure, RadPerSecond, Viscosity, Volume, Watt

Conductivity = Annotated[float, "W/(m*K)"]


def shuttle_loss(
    stroke: Metre, gap: Metre, length: Metre, bore: Metre, k: Annotated[float, "W/(m*K)"], dT: Kelvin
) -> Watt:
    r"""Heat that a moving piston carries from the hot to the cold end.

    .. math:: \dot Q = \frac{\pi}{8}\,\frac{s^2\,k\,D}{\delta\,L}\,\Delta T

    stroke, gap, length, bore: stroke s, radial gap, length of the part with the fall of temperature, diameter D; k:
    conductivity of the gas in the gap; dT: difference of temperature of the ends. Source: W. R. Martini, Stirling
    Engine Design Manual, 2nd ed., NASA CR-168088 (1983), section 5.4, after Zimmerman and Longsworth (factor 0.4 there;
    pi/8 for a sinusoidal stroke). Valid: walls that keep their temperature, gap small against the bore.

    >>> round(shuttle_loss(0.031, 0.00028, 0.043, 0.07, 0.2, 600.0), 1)
    263.3
    """
    return math.pi / 8 * stroke**2 * k * bore / (gap * length) * dT


def gap_enthalpy_loss(
    work: Annotated[float, "Pa*m/s"], gap: Metre, bore: Metre, gamma: Pure, T_hot: Kelvin, T_cold: Kelvin
) -> Watt:
    r"""Heat that the gas of the gap carries away as it is pressed in and out while the piston's dome moves.

    .. math:: \dot Q = \pi D \delta\, \overline{p \dot x} \left[\frac{\gamma}{2(\gamma - 1)} \ln\frac{T_h}{T_c}
              - \frac12\right], \qquad \overline{p \dot x} = \tfrac14\,\omega\,\Delta p\, s \sin\varphi

    work: mean over a turn of pressure times speed of the dome; gap, bore: radial gap delta, diameter D; gamma: ratio of
    the heat capacities; T_hot, T_cold: at the ends of the gap. Returns heat: negative where the hot space takes work.
    Source: P. A. Rios, J. Eng. Power 93 (1971) 177, in the form of I. Urieli, D. M. Berchowitz, Stirling Cycle Engine
    Analysis (1984), chapter 7 (there with pressure and stroke as sines, phi apart). Valid: gas at the temperature of
    the walls beside it, walls that keep theirs (the term of their conduction is below 2 % for steel).

    >>> round(gap_enthalpy_loss(2e6, 0.00028, 0.07, 5 / 3, 977.0, 288.0), 1)
    126.5
    """
    return math.pi * bore * gap * work * (gamma / (2 * (gamma - 1)) * math.log(T_hot / T_cold) - 0.5)


def pumping_loss(
    swing: Pascal,
    frequency: Annotated[float, "Hz"],
    gap: Metre,
    length: Metre,
    bore: Metre,
    k: Conductivity,
    gamma: Pure,
    T_hot: Kelvin,
    T_cold: Kelvin,
) -> Watt:
    r"""Heat that the gas of the gap brings back too cold: enthalpy pumping of the appendix gap.

    .. math:: \dot Q = \left(\frac{\pi D}{k}\right)^{0.6} \frac{2 L\,(T_h - T_c)}{1.5}
              \left(\frac{\gamma}{\gamma - 1}\,\frac{2 f\,(p_{max} - p_{min})}{T_h + T_c}\right)^{1.6} \delta^{2.6}

    swing: largest less smallest pressure; frequency: turns by second; gap, length, bore: radial gap, its length,
    diameter; k: conductivity of the gas in the gap; gamma: ratio of the heat capacities; T_hot, T_cold: at its ends.
    Source: B. Leo (1970), as in W. R. Martini, Stirling Engine Design Manual, 2nd ed., NASA CR-168088 (1983). Valid:
    gas that nearly follows the walls, gap closed at its cold end.

    >>> round(pumping_loss(2.8e6, 41.7, 0.00028, 0.0436, 0.07, 0.25, 5 / 3, 900.0, 340.0), 1)
    20.8
    """
    return (
        (math.pi * bore / k) ** 0.6 * 2 * length * (T_hot - T_cold) / 1.5
        * (gamma / (gamma - 1) * 2 * frequency * swing / (T_hot + T_cold)) ** 1.6 * gap**2.6
    )  # fmt: skip


def leakage_loss(dp_squared: Annotated[float, "Pa^2"], gap: Metre, length: Metre, bore: Metre, mu: Viscosity) -> Watt:
    r"""Power that is lost in the flow past a piston.

    .. math:: \dot W = \frac{\pi D \delta^3}{12\,\mu\,L}\,\overline{(p - p_b)^2}

    dp_squared: mean of the squared difference of pressure over a turn; gap, length, bore: radial gap, length of the
    seal, diameter; mu: viscosity. Returns loss: flow times difference of pressure.
    Source: laminar flow between plates (Poiseuille). Valid: gap * rho * speed/mu < 1000, gap small against the bore;
    the same gas comes back in the other half of the turn.

    >>> round(leakage_loss(1e12, 10e-6, 0.02, 0.07, 2e-5), 1)
    45.8
    """
    return math.pi * bore * gap**3 / (12 * mu * length) * dp_squared


def seal_flow(
    dp: Pascal, gap: Metre, length: Metre, bore: Metre, rho: Annotated[float, "kg/m^3"], mu: Viscosity
) -> MassFlow:
    r"""Flow past a piston.

    .. math:: \dot m = \frac{\pi D \delta^3 \rho\,\Delta p}{12\,\mu\,L}

    dp: difference of pressure; gap, length, bore: radial gap, length of the seal, diameter; rho, mu: of the gas there.
    Source: laminar flow between plates (Poiseuille). Valid: as `leakage_loss`.

    >>> round(seal_flow(1e5, 20e-6, 0.02, 0.07, 6.6, 2e-5) * 1e3, 4)
    0.2419
    """
    return math.pi * bore * gap**3 * rho * dp / (12 * mu * length)


def bypass_loss(flow: MassFlow, cp: Annotated[float, "J/(kg*K)"], dT: Kelvin) -> Watt:
    r"""Heat of gas that goes from the hot to the cold space past the displacer and not through the matrix.

    .. math:: \dot Q = \tfrac12\,\overline{|\dot m|}\, c_p\,\Delta T

    flow: mean of the flow's size over a turn, half of it each way; dT: difference of temperature of the spaces.
    Source: first law. Valid: nothing of the heat comes back from the walls of the gap: an upper bound.

    >>> round(bypass_loss(1e-4, 5193.0, 550.0), 1)
    142.8
    """
    return flow * cp * dT / 2


def seal_reynolds(dp: Pascal, gap: Metre, length: Metre, rho: Annotated[float, "kg/m^3"], mu: Viscosity) -> Pure:
    r"""Reynolds number of the laminar flow past a piston, which tells whether `leakage_loss` holds.

    .. math:: Re = \frac{\rho\,\delta^3\,\Delta p}{12\,\mu^2 L}

    dp: difference of pressure; gap, length: radial gap and length of the seal; rho: density of the gas; mu: viscosity.
    Returns Re: with the gap and the mean speed in it. Source: laminar flow between plates (Poiseuille), mean speed dp
    gap^2/(12 mu L). Valid: up to about 1000, beyond which less flows than the laminar law says.

    >>> round(seal_reynolds(1e6, 10e-6, 0.02, 5.0, 2e-5), 1)
    52.1
    """
    return rho * gap**3 * dp / (12 * mu**2 * length)


def lagging_share(Pe: Pure) -> Pure:
    r"""How much of a space's gas exchanges heat with its walls too late, as `hysteresis_loss` counts it.

    .. math:: \Gamma = \frac1y \frac{\sinh y - \sin y}{\cosh y + \cos y}, \quad y = \sqrt{Pe/2}, \qquad
              \Gamma = \frac{n Pe}{n^2 + (n + Pe)^2}, \quad n = 0.56\,Pe^{0.69}

    Pe: number of Peclet, omega d^2/(4 alpha), d = 4 V/A, above 0. Returns Gamma: the first law, of gas at rest; where
    the second, measured with gas that the motion stirs, is larger (above Pe of 130), that; never above 0.42.
    Source: K. P. Lee, IECEC 1983, paper 839116; A. A. Kornhauser, J. L. Smith, J. Heat Transfer 116 (1994) 536, with
    the complex Nusselt number n (1 + i). Valid: small swings of the pressure; the second law is of gas springs.

    >>> [round(lagging_share(Pe), 4) for Pe in (1.0, 100.0, 1784.0)]
    [0.0825, 0.1411, 0.0493]
    """
    y = math.sqrt(Pe / 2)
    grown = math.exp(-y)  # sinh and cosh by half of e^y, which would overflow
    rest = (1 - grown**2 - 2 * grown * math.sin(y)) / (y * (1 + grown**2 + 2 * grown * math.cos(y)))
    n = 0.56 * Pe**0.69
    stirred = n * Pe / (n**2 + (n + Pe) ** 2)
    return max(rest, stirred) if Pe > 10 else rest


def hysteresis_loss(
    omega: RadPerSecond,
    p_mean: Pascal,
    amplitude: Pascal,
    volume: Volume,
    area: Area,
    gamma: Pure,
    alpha: Annotated[float, "m^2/s"],
) -> Watt:
    r"""Power lost in heat that comes too late between a gas of swinging pressure and the walls of its space.

    .. math:: \dot W = \frac{\omega}{2}\,\bar p\,V \left(\frac{\Delta p}{\bar p}\right)^2 \frac{\gamma - 1}{\gamma}\,
              \Gamma\left(\frac{\omega\,d^2}{4\alpha}\right), \qquad d = \frac{4 V}{A}

    amplitude: half of what the pressure swings; volume, area: mean volume of the space, and its wall; gamma: ratio of
    the heat capacities; alpha: diffusivity of the gas in the space; Gamma is `lagging_share`.
    Source: Lee (1983); Kornhauser and Smith (1994). Valid: sinusoidal pressure, amplitude below about a third of the
    mean; the gas that flows in and out is taken to lie at rest in the mean volume.

    >>> round(hysteresis_loss(262.0, 4.13e6, 1.36e6, 90e-6, 0.0128, 5 / 3, 2.9e-5), 1)
    104.0
    """
    Pe = omega * (4 * volume / area) ** 2 / (4 * alpha)
    return omega / 2 * p_mean * volume * (amplitude / p_mean) ** 2 * (gamma - 1) / gamma * lagging_share(Pe)
