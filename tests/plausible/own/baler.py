"""A hay baler: a crank with a heavy flywheel pushes the plunger against the hay through a rod.

O (frame) -- crank r -- A -- rod l -- B -- plunger on the line y = 0, loaded by Q
"""

from mechsym.derive import Mechanism, output


def baler():
    m = Mechanism("baler", about="Plunger of a hay baler.")
    phi = m.coordinates("phi")
    r, l, q = m.parameters("r l q", "m", above=0)
    m_r, m_p = m.parameters("m_r m_p", "kg", above=0)
    I_f, I_r = m.parameters("I_f I_r", "kg*m^2", above=0)
    d = m.parameters("d", "N*s/m", low=0)
    M, Q = m.inputs("M", "N*m"), m.inputs("Q", "N")
    crank = m.link("crank", turns=phi, inertia=I_f)
    rod = m.link("rod", mass=m_r, centre=(q, 0), inertia=I_r)
    m.pin("O", m.frame, crank)
    m.pin("A", crank.at(r), rod)
    m.slot("B", rod.at(l), m.frame.line(), branch=1)
    x = m.let("x", rod.at(l).x, "m")
    m.body("plunger", mass=m_p, at=(x, 0))
    m.damper(d, stretch=x)
    m.force(-Q, along=x)
    m.torque(M, along=phi)
    m.rotor("crank", angle=phi, drive=M)
    output(m, x, order=2)
    return m
