from mechsym.derive import Mechanism, cos, pi, sin


def radial_engine():
    m = Mechanism("radial_engine", about="Three-cylinder radial engine with articulated rods.")
    phi = m.coordinates("phi")
    r, l, la, ra = m.parameters("r l la ra", "m", above=0)
    mp, mr = m.parameters("mp mr", "kg", above=0)
    I, Ir = m.parameters("I Ir", "kg*m^2", above=0)
    F1, F2, F3 = m.inputs("F1 F2 F3", "N")
    M_r = m.inputs("M_r", "N*m")
    crank = m.link("crank", turns=phi, inertia=I)
    master = m.link("master", mass=mr, centre=(l / 3, 0), inertia=Ir)
    m.pin("O", m.frame, crank)
    m.pin("A", crank.at(r), master)
    for n, F in ((1, F1), (2, F2), (3, F3)):
        angle = (n - 1) * 2 * pi / 3
        piston = m.link(f"piston{n}", mass=mp)
        m.slider(f"G{n}", m.frame.line(angle=angle), piston)
        if n == 1:
            rod = master
            m.pin("B1", master.at(l), piston)
        else:
            rod = m.link(f"rod{n}", mass=mr / 2, centre=(la / 2, 0), inertia=Ir / 3)
            m.pin(f"K{n}", master.at(ra * cos(angle), ra * sin(angle)), rod)
            m.pin(f"B{n}", rod.at(la), piston)
            turns = rod.angle - master.angle
            m.bearing(f"knuckle_pin_{n}", reactions=(f"R_x_K{n}", f"R_y_K{n}"), turns=turns, at="piston_pins")
        p = piston.at()
        x = m.let(f"x{n}", r + l - (p.x * cos(angle) + p.y * sin(angle)), "m")
        m.force(F, along=x)
        m.draw_line(rod.at(), p, role="rod")
        m.draw_circle(p, r / 3, role="piston")
        m.piston(f"p{n}", travel=x, force=F)
        m.guide(f"side_force_{n}", reaction=f"R_n_G{n}", travel=x, at="guides")
        m.bearing(f"piston_pin_{n}", reactions=(f"R_x_B{n}", f"R_y_B{n}"), turns=rod.angle, at="piston_pins")
    m.torque(-M_r, along=phi)
    m.rotor("crank", angle=phi, load=M_r)
    m.bearing("main_bearing", reactions=("R_x_O", "R_y_O"), turns=phi, at="main_bearings")
    m.bearing("crank_pin", reactions=("R_x_A", "R_y_A"), turns=master.angle - phi, at="crank_pins", throw=r)
    m.draw_line((0, 0), crank.at(r), role="crank")
    return m
