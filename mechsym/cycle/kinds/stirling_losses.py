"""What a Stirling engine loses past its piston, around its hot dome and in the gas behind the piston.

Powers and heats are in watts, positive where they cost.
"""

import math


def shuttle_loss(stroke: float, gap: float, length: float, bore: float, k: float, dT: float) -> float:
    r"""Heat that a moving piston carries from the hot to the cold end.

    .. math:: \dot Q = \frac{\pi}{8}\,\frac{s^2\,k\,D}{\delta\,L}\,\Delta T

    Parameters
    ----------
    stroke, gap, length, bore : float
        Stroke s, radial gap, length of the part with the fall of temperature, diameter D [m]
    k : float
        Conductivity of the gas in the gap [W/(m*K)]
    dT : float
        Difference of temperature of the ends [K]

    Returns
    -------
    loss : float
        Heat to the cold end [W]

    Notes
    -----
    Source: W. R. Martini, Stirling Engine Design Manual, 2nd ed., NASA CR-168088 (1983), section 5.4, after Zimmerman
    and Longsworth (factor 0.4 there; pi/8 for a sinusoidal stroke). Valid: walls that keep their temperature, gap small
    against the bore.

    Examples
    --------
    >>> round(shuttle_loss(0.031, 0.00028, 0.043, 0.07, 0.2, 600.0), 1)
    263.3
    """
    return math.pi / 8 * stroke**2 * k * bore / (gap * length) * dT


def leakage_loss(dp_squared: float, gap: float, length: float, bore: float, mu: float) -> float:
    r"""Power that is lost in the flow past a piston.

    .. math:: \dot W = \frac{\pi D \delta^3}{12\,\mu\,L}\,\overline{(p - p_b)^2}

    Parameters
    ----------
    dp_squared : float
        Mean of the squared difference of pressure over a turn [Pa^2]
    gap, length, bore : float
        Radial gap, length of the seal, diameter [m]
    mu : float
        Viscosity [Pa*s]

    Returns
    -------
    loss : float
        Flow times difference of pressure [W]

    Notes
    -----
    Source: laminar flow between plates (Poiseuille). Valid: gap * rho * speed/mu < 1000, gap small against the
    bore; the same gas comes back in the other half of the turn.

    Examples
    --------
    >>> round(leakage_loss(1e12, 10e-6, 0.02, 0.07, 2e-5), 1)
    45.8
    """
    return math.pi * bore * gap**3 / (12 * mu * length) * dp_squared


def seal_reynolds(dp: float, gap: float, length: float, rho: float, mu: float) -> float:
    r"""Reynolds number of the laminar flow past a piston, which tells whether `leakage_loss` holds.

    .. math:: Re = \frac{\rho\,\delta^3\,\Delta p}{12\,\mu^2 L}

    Parameters
    ----------
    dp : float
        Difference of pressure [Pa]
    gap, length : float
        Radial gap and length of the seal [m]
    rho : float
        Density of the gas [kg/m^3]
    mu : float
        Viscosity [Pa*s]

    Returns
    -------
    Re : float
        With the gap and the mean speed in it [-]

    Notes
    -----
    Source: laminar flow between plates (Poiseuille), mean speed dp gap^2/(12 mu L). Valid: up to about 1000, beyond
    which less flows than the laminar law says.

    Examples
    --------
    >>> round(seal_reynolds(1e6, 10e-6, 0.02, 5.0, 2e-5), 1)
    52.1
    """
    return rho * gap**3 * dp / (12 * mu**2 * length)


def gas_spring_loss(omega: float, gamma: float, wall: float, p_mean: float, k: float, ratio: float,
                    area: float) -> float:  # fmt: skip
    r"""Power that a gas spring loses in heat that comes too late.

    .. math:: \dot W = \sqrt{\tfrac{1}{32}\,\omega\,\gamma^3 (\gamma - 1)\,T_w\,\bar p\,k}\,
              \left(\frac{\Delta V}{2 V}\right)^2 A_w

    Parameters
    ----------
    omega : float
        Shaft speed [rad/s]
    gamma : float
        Ratio of the heat capacities [-]
    wall : float
        Temperature of the wall [K]
    p_mean : float
        Mean pressure [Pa]
    k : float
        Conductivity of the gas [W/(m*K)]
    ratio : float
        Swept volume by mean volume [-]
    area : float
        Wall of the space [m^2]

    Returns
    -------
    loss : float
        Power [W]

    Notes
    -----
    Source: Urieli and Berchowitz (1984), section 7.3 (boundary layer thin against the space). Valid: small
    swings of the volume, ratio < 1.

    Examples
    --------
    >>> round(gas_spring_loss(262.0, 5 / 3, 300.0, 4e6, 0.15, 0.25, 0.03), 2)
    31.61
    """
    return math.sqrt(omega * gamma**3 * (gamma - 1) * wall * p_mean * k / 32) * (ratio / 2) ** 2 * area
