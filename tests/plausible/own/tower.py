"""A mast that sways, with a pendulum hung in it to still it.

mast m, x, on k, c -- pendulum m_p at the rope l, theta, with the damper c_p at its joint
"""

from sympy import cos, sin

from mechsym.derive import Mechanism, output


def tower():
    m = Mechanism("tower", about="Mast with a pendulum damper.")
    x = m.coordinates("x", "m")
    theta = m.coordinates("theta")
    m_m, m_p = m.parameters("m_m m_p", "kg", above=0)
    l = m.parameters("l", "m", above=0)
    k = m.parameters("k", "N/m", above=0)
    c = m.parameters("c", "N*s/m", low=0)
    c_p = m.parameters("c_p", "N*m*s/rad", low=0)
    F = m.inputs("F", "N")
    m.weight(0, -9.81)
    m.body("mast", mass=m_m, at=(x, 0))
    m.body("pendulum", mass=m_p, at=(x + l * sin(theta), -l * cos(theta)))
    m.spring(k, stretch=x)
    m.damper(c, stretch=x)
    m.damper(c_p, stretch=theta)
    m.force(F, along=x)
    output(m, x, order=2)
    return m
