"""The batten of a loom: a crank, its rod, and the sley that beats up the weft about a pin below.

O (frame) -- crank r -- A -- rod l -- B -- sley h, pinned at S (frame, at a, -b); a spring k holds the sley back
"""

from mechsym.derive import Mechanism, output, pi


def loom():
    m = Mechanism("loom", about="Batten of a loom.")
    phi = m.coordinates("phi")
    r, l, h, a, b = m.parameters("r l h a b", "m", above=0)
    m_l, m_s = m.parameters("m_l m_s", "kg", above=0)
    I_c, I_l, I_s = m.parameters("I_c I_l I_s", "kg*m^2", above=0)
    k, d = m.parameters("k", "N*m/rad", low=0), m.parameters("d", "N*m*s/rad", low=0)
    M = m.inputs("M", "N*m")
    crank = m.link("crank", turns=phi, inertia=I_c)
    rod = m.link("rod", mass=m_l, centre=(l / 2, 0), inertia=I_l)
    sley = m.link("sley", mass=m_s, centre=(h * 4 / 5, 0), inertia=I_s)
    m.pin("O", m.frame, crank)
    m.pin("A", crank.at(r), rod)
    m.pin("S", m.frame.at(a, -b), sley)
    m.pin("B", rod.at(l), sley.at(h), branch=1)
    m.weight(0, -9.81)
    beat = m.let("beat", sley.angle, "rad")
    m.spring(k, stretch=beat - pi / 2)
    m.damper(d, stretch=beat)
    m.torque(M, along=phi)
    m.rotor("crank", angle=phi, drive=M)
    output(m, beat, order=2)
    return m
