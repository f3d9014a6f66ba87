"""A fan on rubber with an absorber: its casing moves up and down, a small mass hangs on that by a spring.

casing m_c, y on k, c -- rotor phi, its weight m_r at e -- absorber m_a, z against the casing on k_a, c_a
"""

from mechsym.derive import Mechanism, cos, output, sin


def absorber():
    m = Mechanism("absorber", about="Fan on rubber with an absorber.")
    phi = m.coordinates("phi")
    y, z = m.coordinates("y z", "m")
    e = m.parameters("e", "m", above=0)
    m_c, m_r, m_a = m.parameters("m_c m_r m_a", "kg", above=0)
    J = m.parameters("J", "kg*m^2", above=0)
    k, k_a = m.parameters("k k_a", "N/m", above=0)
    c, c_a = m.parameters("c c_a", "N*s/m", low=0)
    d = m.parameters("d", "N*m*s/rad", low=0)
    M = m.inputs("M", "N*m")
    m.body("casing", mass=m_c, at=(0, y))
    m.body("rotor", mass=m_r, at=(e * cos(phi), y + e * sin(phi)), turns=phi, inertia=J)
    m.body("tuned", mass=m_a, at=(0, y + z))
    m.spring(k, stretch=y)
    m.damper(c, stretch=y)
    m.spring(k_a, stretch=z)
    m.damper(c_a, stretch=z)
    m.damper(d, stretch=phi)
    m.torque(M, along=phi)
    m.rotor("rotor", angle=phi, drive=M)
    output(m, y, order=2)
    output(m, z, order=1)
    return m
