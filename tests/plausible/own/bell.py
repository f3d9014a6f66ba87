"""A church bell: the bell swings on its yoke, the clapper inside it on a pin below the yoke.

O (frame) -- bell m_b, centre at s below, theta from the vertical
     P, at p below O -- clapper m_k, centre at q below P, psi from the vertical
"""

from mechsym.derive import Mechanism, output, pi


def bell():
    m = Mechanism("bell", about="Bell with its clapper.")
    theta, psi = m.coordinates("theta psi")
    s, p, q = m.parameters("s p q", "m", above=0)
    m_b, m_k = m.parameters("m_b m_k", "kg", above=0)
    I_b, I_k = m.parameters("I_b I_k", "kg*m^2", above=0)
    b = m.parameters("b", "N*m*s/rad", low=0)
    M = m.inputs("M", "N*m")
    swinging = m.link("bell", turns=theta - pi / 2, mass=m_b, centre=(s, 0), inertia=I_b)
    clapper = m.link("clapper", turns=psi - pi / 2, mass=m_k, centre=(q, 0), inertia=I_k)
    m.pin("O", m.frame, swinging)
    m.pin("P", swinging.at(p), clapper)
    m.weight(0, -9.81)
    m.damper(b, stretch=theta)
    m.torque(M, along=theta)
    output(m, m.let("blow", psi - theta, "rad"), order=1)
    return m
