"""A travelling crane: the trolley on its rails, the load below it on a rope.

trolley m_t at x -- rope l, theta from the vertical -- load m_l
"""

from mechsym.derive import Mechanism, cos, output, sin


def gantry():
    m = Mechanism("gantry", about="Trolley with a load on its rope.")
    x = m.coordinates("x", "m")
    theta = m.coordinates("theta")
    l = m.parameters("l", "m", above=0)
    m_t, m_l = m.parameters("m_t m_l", "kg", above=0)
    c = m.parameters("c", "N*s/m", low=0)
    b = m.parameters("b", "N*m*s/rad", low=0)
    F = m.inputs("F", "N")
    m.body("trolley", mass=m_t, at=(x, 0))
    m.body("load", mass=m_l, at=(x + l * sin(theta), -l * cos(theta)))
    m.weight(0, -9.81)
    m.damper(c, stretch=x)
    m.damper(b, stretch=theta)
    m.force(F, along=x)
    output(m, m.let("reach", x + l * sin(theta), "m"), order=2)
    return m
