"""Engines of files of the user's own: declarations and sections of cases, as texts."""

SLIDER = """from mechsym.derive import Mechanism, cos, sin


def slider():
    m = Mechanism("slider")
    phi = m.coordinates("phi")
    r, l = m.parameters("r l", "m", above=0)
    m_p = m.parameters("m_p", "kg", low=0)
    I = m.parameters("I", "kg*m^2", above=0)
    F, M_r = m.inputs("F", "N"), m.inputs("M_r", "N*m")
    crank = m.link("crank", turns=phi, inertia=I)
    rod, piston = m.link("rod"), m.link("piston", mass=m_p)
    m.pin("O", m.frame, crank)
    m.pin("A", crank.at(r), rod)
    m.slider("G", m.frame.line(angle=TILT), piston)
    m.pin("B", rod.at(l), piston)
    p = piston.at()
    x = m.let("x", r + l - p.x * cos(TILT) - p.y * sin(TILT), "m")
    m.force(F, along=x)
    m.torque(-M_r, along=phi)
    m.piston("p", travel=x, force=F, masses=m_p, loads="R_n_G")
    m.rotor("crank", angle=phi, load=M_r)
    return m
"""
RHOMBIC = """from mechsym.derive import Mechanism, pi


def rhombic():
    m = Mechanism("rhombic")
    phi = m.coordinates("phi")
    r, l, c = m.parameters("r l c", "m", above=0)
    m_p, m_d = m.parameters("m_p m_d", "kg", low=0)
    I = m.parameters("I", "kg*m^2", above=0)
    F_d, F_p = m.inputs("F_d F_p", "N")
    M_r = m.inputs("M_r", "N*m")
    right, left = m.link("right", turns=phi, inertia=I), m.link("left", turns=pi - phi, inertia=I)
    m.pin("O1", m.frame.at(c, 0), right)
    m.pin("O2", m.frame.at(-c, 0), left)
    axis = m.frame.line(angle=pi / 2)
    for name, mass, force, side in (("displacer", m_d, F_d, -1), ("power", m_p, F_p, 1)):
        yoke, rod = m.link(name, mass=mass), m.link(f"rod_{name}")
        m.slider(f"G_{name}", axis, yoke)
        m.pin(f"A_{name}", right.at(r), rod)
        m.pin(f"B_{name}", rod.at(l), yoke, branch=side)
        x = m.let(f"x_{name}", -yoke.at().y, "m")
        m.force(force, along=x)
        m.piston(name, travel=x, force=force)
    m.torque(-M_r, along=phi)
    m.rotor("crank", angle=phi, load=M_r)
    return m
"""
STIRLING = """mechanism = "./rhombic.py"
[parameters]
r = 0.02
l = 0.07
c = 0.04
m_p = 0.5
m_d = 0.3
I = 0.01
[operation]
speed = "1000 rpm"
[cycle]
kind = "schmidt"
arrangement = "beta"
bore = 0.06
rod_diameter = 0.01
dead_hot = 2e-5
dead_cold = 2e-5
dead_regenerator = 2e-5
T_e = 900
T_c = 330
mean_pressure = 5e5
p_back = 5e5
"""
RADIAL = """from mechsym.derive import Mechanism, cos, pi, sin


def radial():
    m = Mechanism("radial")
    phi = m.coordinates("phi")
    r, l = m.parameters("r l", "m", above=0)
    m_p = m.parameters("m_p", "kg", above=0)
    I = m.parameters("I", "kg*m^2", above=0)
    F, M_r = m.inputs("F1 F2 F3", "N"), m.inputs("M_r", "N*m")
    crank = m.link("crank", turns=phi, inertia=I)
    m.pin("O", m.frame, crank)
    for n in range(3):
        angle = 2 * pi * n / 3
        rod, piston = m.link(f"rod{n}"), m.link(f"piston{n}", mass=m_p)
        m.pin(f"A{n}", crank.at(r), rod)
        m.slider(f"G{n}", m.frame.line(angle=angle), piston)
        m.pin(f"B{n}", rod.at(l), piston)
        p = piston.at()
        x = m.let(f"x{n}", r + l - p.x * cos(angle) - p.y * sin(angle), "m")
        m.force(F[n], along=x)
        m.piston(f"p{n}", travel=x, force=F[n])
    m.torque(-M_r, along=phi)
    m.rotor("crank", angle=phi, load=M_r)
    return m
"""
OPPOSED = """from mechsym.derive import Mechanism, pi


def opposed():
    m = Mechanism("opposed")
    phi = m.coordinates("phi")
    r, l = m.parameters("r l", "m", above=0)
    m_p = m.parameters("m_p", "kg", low=0)
    I = m.parameters("I", "kg*m^2", above=0)
    F, M_r = m.inputs("F", "N"), m.inputs("M_r", "N*m")
    apart = 0
    for name, side, turn in (("left", -1, phi), ("right", 1, pi - phi)):
        crank = m.link(f"crank_{name}", turns=turn, inertia=I / 2)
        rod, piston = m.link(f"rod_{name}"), m.link(f"piston_{name}", mass=m_p)
        m.pin(f"O_{name}", m.frame.at(side * (r + l), 0), crank)
        m.pin(f"A_{name}", crank.at(r), rod)
        m.slider(f"G_{name}", m.frame.line(), piston)
        m.pin(f"B_{name}", rod.at(l), piston, branch=-side)
        apart += side * piston.at().x
    x = m.let("x", apart, "m")
    m.force(F, along=x)
    m.torque(-M_r, along=phi)
    m.piston("chamber", travel=x, force=F)
    m.rotor("crank", angle=phi, load=M_r)
    return m
"""
COMPRESSOR = """[parameters]
r = "26 mm"
l = "90 mm"
m_p = 0.25
I = 0.002
[operation]
speed = "1000 rpm"
[cycle]
kind = "compressor"
bore = "50 mm"
compression_ratio = 12
p_suction = "1 bar"
p_delivery = "5 bar"
n_c = 1.3
n_e = 1.25
"""
