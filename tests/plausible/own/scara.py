"""A robot in the plane: two arms with their drives at the joints, a tool that carries a load at the end.

S (frame) -- arm a -- E -- arm b -- tool; psi1 of the first arm, psi2 of the second against the first
"""

from mechsym.derive import Mechanism


def scara():
    m = Mechanism("scara", about="Robot of two arms in a level plane.")
    psi1, psi2 = m.coordinates("psi1 psi2")
    a, b = m.parameters("a b", "m", above=0)
    m_a, m_b, m_l = m.parameters("m_a m_b m_l", "kg", low=0)
    I_a, I_b = m.parameters("I_a I_b", "kg*m^2", above=0)
    d1, d2 = m.parameters("d1 d2", "N*m*s/rad", low=0)
    M1, M2 = m.inputs("M1 M2", "N*m")
    first = m.link("first", turns=psi1, mass=m_a, centre=(a / 2, 0), inertia=I_a)
    second = m.link("second", turns=psi1 + psi2, mass=m_b, centre=(b / 2, 0), inertia=I_b)
    m.pin("S", m.frame, first)
    m.pin("E", first.at(a), second)
    m.body("tool", mass=m_l, at=(second.at(b).x, second.at(b).y))
    m.damper(d1, stretch=psi1)
    m.damper(d2, stretch=psi2)
    m.torque(M1, along=psi1)
    m.torque(M2, along=psi2)
    m.watch(second.at(b), "P")
    return m
