"""A sewing machine's needle bar: an offset crank and rod drive it, a spring holds it up, the cloth holds it back.

O crank r -- A -- rod l -- B needle bar m_n on a line e beside the shaft, which turns the hand wheel I_w.
"""

from mechsym.derive import Mechanism, output


def sewing():
    m = Mechanism("sewing", about="Needle bar of a sewing machine.")
    phi = m.coordinates("phi")
    r, l, e, s0 = m.parameters("r l e s0", "m", above=0)
    m_r, m_n = m.parameters("m_r m_n", "kg", above=0)
    I_w, I_r = m.parameters("I_w I_r", "kg*m^2", above=0)
    k = m.parameters("k", "N/m", low=0)
    c = m.parameters("c", "N*s/m", low=0)
    M, F = m.inputs("M", "N*m"), m.inputs("F", "N")
    crank = m.link("crank", turns=phi, inertia=I_w)
    rod = m.link("rod", mass=m_r, centre=(l / 2, 0), inertia=I_r)
    bar = m.link("bar", mass=m_n)
    m.pin("O", m.frame, crank)
    m.pin("A", crank.at(r), rod)
    m.slider("S", m.frame.line(0, e), bar)
    m.pin("B", rod.at(l), bar)
    x = m.let("x", bar.at().x, "m")
    m.spring(k, stretch=x - s0)
    m.damper(c, stretch=x)
    m.force(-F, along=x)
    m.torque(M, along=phi)
    m.rotor("crank", angle=phi, drive=M)
    output(m, x, order=2)
    return m
