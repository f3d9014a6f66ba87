"""Drag-link coupling: two cranks on parallel shafts, both turn all the way round, the second unevenly.

O-A crank a, A-B coupler f, C-B crank b, C on the frame at the distance e from O, and e the shortest.
"""

from mechsym.derive import Mechanism, output


def drag_link():
    m = Mechanism("drag_link", about="Drag-link coupling.")
    phi = m.coordinates("phi")
    a, f, b, e = m.parameters("a f b e", "m", above=0)
    m_a, m_f, m_b = m.parameters("m_a m_f m_b", "kg", low=0)
    I_a, I_f, I_b = m.parameters("I_a I_f I_b", "kg*m^2", above=0)
    d = m.parameters("d", "N*m*s/rad", default=0)
    M, Q = m.inputs("M Q", "N*m")
    one = m.link("one", turns=phi, mass=m_a, centre=(a / 2, 0), inertia=I_a)
    coupler = m.link("coupler", mass=m_f, centre=(f / 2, 0), inertia=I_f)
    two = m.link("two", mass=m_b, centre=(b / 2, 0), inertia=I_b)
    m.pin("O", m.frame, one)
    m.pin("A", one.at(a), coupler)
    m.pin("C", m.frame.at(e, 0), two)
    m.pin("B", coupler.at(f), two.at(b), branch=1)
    m.damper(d, stretch=two.angle)
    m.torque(M, along=phi)
    m.torque(-Q, along=two.angle)
    m.rotor("crank", angle=phi, drive=M)
    m.draw_line((0, 0), one.at(a), two.at(b), m.frame.at(e, 0), role="rod")
    output(m, m.let("second", two.angle, "rad"), order=1)
    return m
