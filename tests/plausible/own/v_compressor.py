"""Two-cylinder compressor, cylinders at a right angle, both rods on one crank pin.

[1]     [2]     x1, x2 travels from the heads; axes at +-45 deg from the vertical
   \\   /
    A        O main bearing, A crank pin, B1 and B2 piston pins
    O
"""

from mechsym.derive import Mechanism, cos, pi, sin


def v_compressor():
    m = Mechanism("v_compressor", about="Two-cylinder compressor at a right angle.")
    phi = m.coordinates("phi")
    r, l, a = m.parameters("r l a", "m", above=0)
    m_rod, m_pis, m_cw = m.parameters("m_rod m_pis m_cw", "kg", above=0)
    J_rod, J_crank = m.parameters("J_rod J_crank", "kg*m^2", above=0)
    F1, F2 = m.inputs("F1 F2", "N")
    M_b = m.inputs("M_b", "N*m")
    crank = m.link("crank", turns=phi, mass=m_cw, centre=(-a, 0), inertia=J_crank)
    m.pin("O", m.frame, crank)
    for i, angle, F in ((1, pi / 4, F1), (2, -pi / 4, F2)):
        rod = m.link(f"rod{i}", mass=m_rod, centre=(l / 3, 0), inertia=J_rod)
        piston = m.link(f"piston{i}", mass=m_pis)
        m.pin(f"A{i}", crank.at(r), rod)
        m.slider(f"G{i}", m.frame.line(angle=angle), piston)
        m.pin(f"B{i}", rod.at(l), piston)
        x = m.let(f"x{i}", r + l - piston.at().x * cos(angle) - piston.at().y * sin(angle), "m")
        m.force(F, along=x)
        m.piston(f"piston{i}", travel=x, force=F)
        m.bearing(f"piston_pin{i}", reactions=(f"R_x_B{i}", f"R_y_B{i}"), turns=rod.angle, at="piston_pins")
    m.torque(-M_b, along=phi)
    m.rotor("crank", angle=phi, load=M_b)
    m.bearing("main_bearing", reactions=("R_x_O", "R_y_O"), turns=phi, at="main_bearings")
    return m
