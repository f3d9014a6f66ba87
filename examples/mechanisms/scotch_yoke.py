"""Scotch yoke: a crank pin in the slot of a yoke that slides; its travel is x = r (1 - cos phi).

    |   |                         x from the shaft O towards the head, phi = 0 at top dead centre.
 .--|-. |                         The pin slides across in the slot (reaction R_n_S on the yoke), the yoke in its
/ O-|-P |====[] x                 guide (R_n_G, M_G). F on the piston, positive away from the head.
`---|-' |
"""

from mechsym.derive import Mechanism, pi


def scotch_yoke():
    m = Mechanism("scotch_yoke", about="Scotch yoke with a piston.")
    phi = m.coordinates("phi")
    r = m.parameters("r", "m", above=0)
    m_yoke = m.parameters("m_yoke", "kg", low=0)
    I_crank = m.parameters("I_crank", "kg*m^2", above=0)
    F, M_r = m.inputs("F", "N"), m.inputs("M_r", "N*m")
    crank = m.link("crank", turns=phi, inertia=I_crank)
    yoke = m.link("yoke", mass=m_yoke)
    m.pin("O", m.frame, crank)
    m.slider("G", m.frame, yoke)
    m.slot("S", crank.at(r), yoke.line(angle=pi / 2))
    x = m.let("x", r - yoke.at().x, "m")
    m.force(F, along=x)
    m.torque(-M_r, along=phi)
    m.piston("piston", travel=x, force=F)
    m.rotor("crank", angle=phi, load=M_r)
    m.draw_line((0, 0), crank.at(r), role="crank")
    m.draw_line(yoke.at(0, -r), yoke.at(0, r), role="rod")
    m.draw_box(yoke.at(2 * r), r / 2, r, role="piston")
    return m
