"""Whitworth quick return: a crank pin in the slot of a rocker, a link from the rocker to a ram.

D (frame, below O)      crank O-A turns, its pin A slides in the rocker about D (reaction R_n_A);
                        link E-C drives the ram along x; the way back is shorter than the way there.
"""

from mechsym.derive import Mechanism, output, pi


def whitworth():
    m = Mechanism("whitworth", about="Whitworth quick return with ram.")
    phi = m.coordinates("phi")
    r, h, s, l, y = m.parameters("r h s l y", "m", above=0)
    m_rocker, m_ram = m.parameters("m_rocker m_ram", "kg", above=0)
    I, I_rocker = m.parameters("I I_rocker", "kg*m^2", above=0)
    g = m.parameters("g", "m/s^2", default=9.81)
    M, F = m.inputs("M", "N*m"), m.inputs("F", "N")
    crank = m.link("crank", turns=phi, inertia=I)
    rocker = m.link("rocker", mass=m_rocker, centre=(s / 2, 0), inertia=I_rocker)
    m.pin("O", m.frame, crank)
    m.pin("D", m.frame.at(0, -h), rocker)
    m.slot("A", rocker.line(), crank.at(r))
    link, ram = m.link("link"), m.link("ram", mass=m_ram)
    m.pin("E", rocker.at(s), link)
    m.slider("G", m.frame.line(0, y), ram)
    m.pin("C", link.at(l), ram)
    m.weight(0, -g)
    m.torque(M, along=phi)
    m.rotor("crank", angle=phi, drive=M)
    x = m.let("x", ram.at().x, "m")
    m.force(-F, along=x)
    m.draw_line((0, 0), crank.at(r), role="crank")
    m.draw_line(rocker.at(), rocker.at(s), link.at(l), role="rod")
    m.draw_box(ram.at(), l, y / 3, role="piston")
    output(m, x, m.let("rocker_angle", rocker.angle - pi / 2, "rad"), order=2)
    return m
