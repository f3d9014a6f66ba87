"""A vibrating conveyor: a trough on leaf springs, shaken along their stroke by a turning weight of its own.

trough m_t, s along the stroke -- spring k, damper c; shaft phi on the trough with its weight m_u at a radius e
"""

from mechsym.derive import Mechanism, cos, output, sin


def conveyor():
    m = Mechanism("conveyor", about="Trough shaken by a turning weight.")
    s, phi = m.coordinates("s", "m"), m.coordinates("phi")
    e = m.parameters("e", "m", above=0)
    m_t, m_u = m.parameters("m_t m_u", "kg", above=0)
    I_u = m.parameters("I_u", "kg*m^2", above=0)
    k, c = m.parameters("k", "N/m", above=0), m.parameters("c", "N*s/m", low=0)
    b = m.parameters("b", "N*m*s/rad", low=0)
    M = m.inputs("M", "N*m")
    m.body("trough", mass=m_t, at=(s, 0))
    m.body("weight", mass=m_u, at=(s + e * cos(phi), e * sin(phi)), turns=phi, inertia=I_u)
    m.spring(k, stretch=s)
    m.damper(c, stretch=s)
    m.damper(b, stretch=phi)
    m.torque(M, along=phi)
    m.rotor("weight", angle=phi, drive=M)
    output(m, m.let("stroke", s, "m"), order=2)
    return m
