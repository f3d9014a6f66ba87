"""A drawbridge: a motor on a gear lifts the leaf, a counterweight on its tail holds nearly all of it.

tail T (m_t) -- u -- pivot O -- p -- centre of the leaf m_l; motor I_m turns i times as far as the leaf.
"""

from sympy import cos, sin

from mechsym.derive import Mechanism, output


def bascule():
    m = Mechanism("bascule", about="Drawbridge with a counterweight.")
    theta = m.coordinates("theta")
    p, u = m.parameters("p u", "m", above=0)
    m_l, m_t = m.parameters("m_l m_t", "kg", above=0)
    I_l, I_m = m.parameters("I_l I_m", "kg*m^2", above=0)
    i = m.parameters("i", "-", above=0)
    b = m.parameters("b", "N*m*s/rad", low=0)
    M = m.inputs("M", "N*m")
    m.weight(0, -9.81)
    m.body("leaf", mass=m_l, at=(p * cos(theta), p * sin(theta)), turns=theta, inertia=I_l)
    m.body("tail", mass=m_t, at=(-u * cos(theta), -u * sin(theta)))
    m.body("motor", mass=0, at=(0, 0), turns=i * theta, inertia=I_m)
    m.damper(b, stretch=theta)
    m.torque(i * M, along=theta)
    y = m.let("y", 2 * p * sin(theta), "m")
    m.rotor("leaf", angle=theta, drive=M)
    output(m, y, order=2)
    return m
