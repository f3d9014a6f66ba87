"""Single-cylinder compressor with a balance shaft that turns against the crank at its speed.

[piston]   x travel from the head, O main bearing, A crank pin, B piston pin; the crank carries a balance mass
   | B     opposite to its pin, the shaft W beside it carries the other half.
   A
   O   W
"""

from mechsym.derive import Mechanism


def thumper():
    m = Mechanism("thumper", about="Single-cylinder compressor with balance shaft.")
    phi = m.coordinates("phi")
    r, l, w, s = m.parameters("r l w s", "m", above=0)
    m_p, m_rod, m_c, m_s = m.parameters("m_p m_rod m_c m_s", "kg", above=0)
    I, I_rod, I_s = m.parameters("I I_rod I_s", "kg*m^2", above=0)
    F, M_r = m.inputs("F", "N"), m.inputs("M_r", "N*m")
    crank = m.link("crank", turns=phi, mass=m_c, centre=(-w, 0), inertia=I)
    rod = m.link("rod", mass=m_rod, centre=(l / 3, 0), inertia=I_rod)
    piston = m.link("piston", mass=m_p)
    shaft = m.link("shaft", turns=-phi, mass=m_s, centre=(-w, 0), inertia=I_s)
    m.pin("O", m.frame, crank)
    m.pin("W", m.frame.at(0, s), shaft)
    m.pin("A", crank.at(r), rod)
    m.slider("G", m.frame.line(), piston)
    m.pin("B", rod.at(l), piston)
    x = m.let("x", r + l - piston.at().x, "m")
    m.force(F, along=x)
    m.torque(-M_r, along=phi)
    m.piston("piston", travel=x, force=F)
    m.rotor("crank", angle=phi, load=M_r)
    m.guide("side_force", reaction="R_n_G", travel=x, at="guides")
    m.bearing("main_bearing", reactions=("R_x_O", "R_y_O"), turns=phi, at="main_bearings")
    m.bearing("crank_pin", reactions=("R_x_A", "R_y_A"), turns=rod.angle - phi, at="crank_pins", throw=r)
    m.bearing("piston_pin", reactions=("R_x_B", "R_y_B"), turns=rod.angle, at="piston_pins")
    m.draw_line((0, 0), crank.at(r), rod.at(l), role="rod")
    return m
