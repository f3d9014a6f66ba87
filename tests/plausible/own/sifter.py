"""Vibrating sifter: a trough on soft springs, shaken by a rotor with an unbalanced mass.

[ trough  (phi) o-- ]      the rotor turns in the trough, its mass m_u stands at the radius e;
  \\/\\/ k  c |             the trough moves along y only, y = 0 where the springs are at ease.
"""

from mechsym.derive import Mechanism, cos, output, sin


def sifter():
    m = Mechanism("sifter", about="Vibrating sifter.")
    phi, y = m.coordinates("phi"), m.coordinates("y", "m")
    e = m.parameters("e", "m", above=0)
    m_t, m_u = m.parameters("m_t m_u", "kg", above=0)
    J = m.parameters("J", "kg*m^2", above=0)
    k, c = m.parameters("k", "N/m", above=0), m.parameters("c", "N*s/m", low=0)
    b = m.parameters("b", "N*m*s/rad", default=0)
    g = m.parameters("g", "m/s^2", default=9.81)
    M = m.inputs("M", "N*m")
    m.body("trough", mass=m_t, at=(0, y))
    m.body("unbalance", mass=m_u, at=(e * cos(phi), y + e * sin(phi)))
    m.body("rotor", mass=0, at=(0, y), turns=phi, inertia=J)
    m.spring(k, stretch=y)
    m.damper(c, stretch=y)
    m.damper(b, stretch=phi)
    m.weight(0, -g)
    m.torque(M, along=phi)
    m.rotor("rotor", angle=phi, drive=M)
    output(m, y, order=2)
    return m
