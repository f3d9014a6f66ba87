"""A wind pump: wheel, gear and crank lift a rod with its piston through a yoke; water hangs on it on the way up.

wheel I_w, alpha = i phi -- crank I_c, phi, radius r -- yoke and rod m_rod, water F upwards
"""

from mechsym.derive import Mechanism, output, pi


def windpump():
    m = Mechanism("windpump", about="Wind wheel that lifts a pump rod.")
    phi = m.coordinates("phi")
    r = m.parameters("r", "m", above=0)
    m_rod = m.parameters("m_rod", "kg", above=0)
    I_c, I_w = m.parameters("I_c I_w", "kg*m^2", above=0)
    i = m.parameters("i", "-", above=0)
    c = m.parameters("c", "N*s/m", low=0)
    M, F = m.inputs("M", "N*m"), m.inputs("F", "N")
    crank = m.link("crank", turns=phi, inertia=I_c)
    rod = m.link("rod", mass=m_rod)
    m.pin("O", m.frame, crank)
    m.slider("G", m.frame.line(angle=pi / 2), rod)
    m.slot("Y", crank.at(r), rod.line(angle=pi / 2))
    m.body("wheel", mass=0, at=(0, 0), turns=i * phi, inertia=I_w)
    m.weight(0, -9.81)
    h = m.let("h", rod.at().y, "m")
    m.damper(c, stretch=h)
    m.force(-F, along=h)
    m.torque(i * M, along=phi)
    m.rotor("crank", angle=phi, drive=M)
    output(m, h, order=2)
    return m
