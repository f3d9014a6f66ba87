"""A trebuchet: a heavy box falls on the short arm of a beam, the long arm throws a stone from its sling.

box m_c -- p -- pivot -- q -- tip -- sling s -- stone m_p; theta of the beam, sigma of the sling, from the upright
"""

from sympy import cos, sin

from mechsym.derive import Mechanism, output


def trebuchet():
    m = Mechanism("trebuchet", about="Beam, box and sling.")
    theta, sigma = m.coordinates("theta sigma")
    p, q, s = m.parameters("p q s", "m", above=0)
    m_c, m_p, m_b = m.parameters("m_c m_p m_b", "kg", above=0)
    I_b = m.parameters("I_b", "kg*m^2", above=0)
    b = m.parameters("b", "N*m*s/rad", low=0)
    m.weight(0, -9.81)
    tip = (-q * sin(theta), q * cos(theta))
    m.body("beam", mass=m_b, at=(-(q - p) / 2 * sin(theta), (q - p) / 2 * cos(theta)), turns=theta, inertia=I_b)
    m.body("box", mass=m_c, at=(p * sin(theta), -p * cos(theta)))
    m.body("stone", mass=m_p, at=(tip[0] - s * sin(sigma), tip[1] + s * cos(sigma)))
    m.damper(b, stretch=theta)
    y = m.let("y", tip[1] + s * cos(sigma), "m")
    output(m, y, order=2)
    return m
