"""Two wagons on a spring: the first one's axle is driven, and its wheels roll.

locomotive m_1, x_1, wheels I_w of radius R -- coupling k, c -- wagon m_2, x_2, which the track holds back by d
"""

from mechsym.derive import Mechanism, output


def wagon():
    m = Mechanism("wagon", about="Locomotive and wagon.")
    q, s = m.coordinates("q"), m.coordinates("s", "m")
    m_1, m_2 = m.parameters("m_1 m_2", "kg", above=0)
    I_w = m.parameters("I_w", "kg*m^2", above=0)
    R = m.parameters("R", "m", above=0)
    k = m.parameters("k", "N/m", above=0)
    c, d = m.parameters("c d", "N*s/m", low=0)
    M = m.inputs("M", "N*m")
    m.body("locomotive", mass=m_1, at=(R * q, 0), turns=-q, inertia=I_w)
    m.body("wagon", mass=m_2, at=(s, 0))
    m.spring(k, stretch=R * q - s)
    m.damper(c, stretch=R * q - s)
    m.damper(d, stretch=s)
    m.torque(M, along=q)
    m.rotor("axle", angle=q, drive=M)
    output(m, s, order=2)
    return m
