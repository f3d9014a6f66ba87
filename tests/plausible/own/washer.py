"""A washing machine: a drum with laundry beside its axis, in a tub on springs and dampers.

tub m_t, x, y, on k, c to the housing -- drum I_d, phi, laundry m_l at e
"""

from sympy import cos, sin

from mechsym.derive import Mechanism, output


def washer():
    m = Mechanism("washer", about="Washing machine that spins.")
    phi = m.coordinates("phi")
    x, y = m.coordinates("x y", "m")
    m_t, m_l = m.parameters("m_t m_l", "kg", above=0)
    I_d = m.parameters("I_d", "kg*m^2", above=0)
    e = m.parameters("e", "m", above=0)
    k = m.parameters("k", "N/m", above=0)
    c = m.parameters("c", "N*s/m", low=0)
    g = m.parameters("g", "m/s^2", default=9.81)
    M = m.inputs("M", "N*m")
    m.weight(0, -g)
    m.body("tub", mass=m_t, at=(x, y))
    m.body("drum", mass=0, at=(0, 0), turns=phi, inertia=I_d)
    m.body("laundry", mass=m_l, at=(x + e * cos(phi), y + e * sin(phi)))
    m.spring(k, stretch=x)
    m.spring(k, stretch=y)
    m.damper(c, stretch=x)
    m.damper(c, stretch=y)
    m.torque(M, along=phi)
    m.rotor("drum", angle=phi, drive=M)
    output(m, x, order=2)
    return m
