"""V-twin with an articulated rod: the second rod hangs on the first, so its piston moves a little otherwise.

\\  2     1  /        cylinder 1 along x, cylinder 2 at the angle v from it; the second rod's pin K sits on the
 \\ K----A  /         master rod at the radius ra. Travels positive away from the heads, F net forces likewise.
    \\ O
"""

from mechsym.derive import Mechanism, cos, sin


def v_twin():
    m = Mechanism("v_twin", about="V-twin with articulated rod.")
    phi = m.coordinates("phi")
    r, l, l2, ra = m.parameters("r l l2 ra", "m", above=0)
    v = m.parameters("v", "rad", above=0, below=3.1)
    m_p, m_rod = m.parameters("m_p m_rod", "kg", above=0)
    I, I_rod = m.parameters("I I_rod", "kg*m^2", above=0)
    F1, F2 = m.inputs("F1 F2", "N")
    M_r = m.inputs("M_r", "N*m")
    crank = m.link("crank", turns=phi, inertia=I)
    master = m.link("master", mass=m_rod, centre=(l / 3, 0), inertia=I_rod)
    slave = m.link("slave", mass=m_rod / 2, centre=(l2 / 2, 0), inertia=I_rod / 3)
    one, two = m.link("piston1", mass=m_p), m.link("piston2", mass=m_p)
    m.pin("O", m.frame, crank)
    m.pin("A", crank.at(r), master)
    m.slider("G1", m.frame.line(), one)
    m.pin("B1", master.at(l), one)
    m.pin("K", master.at(ra * cos(v), ra * sin(v)), slave)
    m.slider("G2", m.frame.line(angle=v), two)
    m.pin("B2", slave.at(l2), two)
    for n, piston, angle, F in ((1, one, 0, F1), (2, two, v, F2)):
        p = piston.at()
        x = m.let(f"x{n}", r + l - p.x * cos(angle) - p.y * sin(angle), "m")
        m.force(F, along=x)
        m.piston(f"p{n}", travel=x, force=F)
        m.guide(f"side_force_{n}", reaction=f"R_n_G{n}", travel=x, at="guides")
        way = (p.x - r * cos(angle), p.y - r * sin(angle)), (p.x + r / 2 * cos(angle), p.y + r / 2 * sin(angle))
        m.draw_line(*way, role="piston")
    m.torque(-M_r, along=phi)
    m.rotor("crank", angle=phi, load=M_r)
    m.bearing("main_bearing", reactions=("R_x_O", "R_y_O"), turns=phi, at="main_bearings")
    m.bearing("crank_pin", reactions=("R_x_A", "R_y_A"), turns=master.angle - phi, at="crank_pins", throw=r)
    m.bearing("knuckle_pin", reactions=("R_x_K", "R_y_K"), turns=slave.angle - master.angle, at="piston_pins")
    m.bearing("piston_pin_1", reactions=("R_x_B1", "R_y_B1"), turns=master.angle, at="piston_pins")
    m.bearing("piston_pin_2", reactions=("R_x_B2", "R_y_B2"), turns=slave.angle, at="piston_pins")
    m.draw_line((0, 0), crank.at(r), role="crank")
    m.draw_line(crank.at(r), master.at(l), role="rod")
    m.draw_line(crank.at(r), slave.at(), slave.at(l2), role="rod")
    return m
