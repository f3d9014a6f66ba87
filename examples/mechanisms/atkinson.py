"""Atkinson's linkage engine: four strokes in one turn of the crank, the expansion longer than the compression.

O                crank O-A, link A-B, rocker D-B on the frame at D; the piston's rod hangs on the rocker at
| \\ A            B. The rocker swings across the cylinder's axis x twice in a turn: two equal top dead
|   \\            centres, and bottoms as deep as it swings to either side, so that two strokes are long and
D----B----[] x   two are short. F net force on the piston, positive away from the head.
"""

from mechsym.derive import Mechanism


def atkinson():
    m = Mechanism("atkinson", about="Atkinson's linkage engine.")
    phi = m.coordinates("phi")
    r, l2, l3, l, h = m.parameters("r l2 l3 l h", "m", above=0)
    m_link, m_rod, m_p = m.parameters("m_link m_rod m_p", "kg", low=0)
    I, I_link, I_rocker, I_rod = m.parameters("I I_link I_rocker I_rod", "kg*m^2", above=0)
    F, M_r = m.inputs("F", "N"), m.inputs("M_r", "N*m")
    crank = m.link("crank", turns=phi, inertia=I)
    link = m.link("link", mass=m_link, centre=(l2 / 2, 0), inertia=I_link)
    rocker = m.link("rocker", inertia=I_rocker)
    rod, piston = m.link("rod", mass=m_rod, centre=(l / 3, 0), inertia=I_rod), m.link("piston", mass=m_p)
    m.pin("O", m.frame.at(0, h), crank)
    m.pin("A", crank.at(r), link)
    m.pin("D", m.frame, rocker)
    m.pin("B", link.at(l2), rocker.at(l3), branch=1)
    m.pin("K", rocker.at(l3), rod)
    m.slider("G", m.frame, piston)
    m.pin("P", rod.at(l), piston)
    x = m.let("x", l3 + l - piston.at().x, "m")
    m.force(F, along=x)
    m.torque(-M_r, along=phi)
    m.piston("piston", travel=x, force=F)
    m.rotor("crank", angle=phi, load=M_r)
    m.draw_line(m.frame.at(0, h), crank.at(r), role="crank")
    m.draw_line(crank.at(r), link.at(l2), rod.at(l), role="rod")
    m.draw_line(m.frame.at(), rocker.at(l3), role="planet")
    m.draw_box(piston.at(l3 / 4), l3 / 2, l3, role="piston")
    return m
