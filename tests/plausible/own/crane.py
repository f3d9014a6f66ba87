"""Overhead crane: a trolley on its girder, the load swings below it on a rope of fixed length.

=====[trolley]=====  s along the girder, theta of the rope from the vertical, F pulls the trolley.
        \\ p
         (load)
"""

from mechsym.derive import Mechanism, cos, output, sin


def crane():
    m = Mechanism("crane", about="Overhead crane.")
    s, theta = m.coordinates("s", "m"), m.coordinates("theta")
    p = m.parameters("p", "m", above=0)
    m_trolley, m_load = m.parameters("m_trolley m_load", "kg", above=0)
    c, b = m.parameters("c", "N*s/m", default=0), m.parameters("b", "N*m*s/rad", default=0)
    g = m.parameters("g", "m/s^2", default=9.81)
    F = m.inputs("F", "N")
    x = s + p * sin(theta)
    m.body("trolley", mass=m_trolley, at=(s, 0))
    m.body("load", mass=m_load, at=(x, -p * cos(theta)))
    m.weight(0, -g)
    m.damper(c, stretch=s)
    m.damper(b, stretch=theta)
    m.force(F, along=s)
    output(m, m.let("reach", x, "m"), order=2)
    return m
