"""A jaw crusher: an eccentric shaft moves the upper end of the jaw, a toggle plate holds its lower end to the frame.

O (frame) -- shaft, eccentric e -- A -- jaw, length j -- B -- toggle, length t -- D (frame, at u, -v)
"""

from mechsym.derive import Mechanism, output


def crusher():
    m = Mechanism("crusher", about="Jaw crusher with one toggle.")
    phi = m.coordinates("phi")
    e, j, t, u, v = m.parameters("e j t u v", "m", above=0)
    m_j, m_t = m.parameters("m_j m_t", "kg", above=0)
    I_s, I_j, I_t = m.parameters("I_s I_j I_t", "kg*m^2", above=0)
    M, Q = m.inputs("M", "N*m"), m.inputs("Q", "N")
    shaft = m.link("shaft", turns=phi, inertia=I_s)
    jaw = m.link("jaw", mass=m_j, centre=(j / 2, 0), inertia=I_j)
    toggle = m.link("toggle", mass=m_t, centre=(t / 2, 0), inertia=I_t)
    m.pin("O", m.frame, shaft)
    m.pin("A", shaft.at(e), jaw)
    m.pin("D", m.frame.at(u, -v), toggle)
    m.pin("B", jaw.at(j), toggle.at(t), branch=-1)
    m.weight(0, -9.81)
    gap = m.let("gap", jaw.at(j).x, "m")
    m.force(-Q, along=gap)
    m.torque(M, along=phi)
    m.rotor("shaft", angle=phi, drive=M)
    output(m, gap, order=2)
    return m
