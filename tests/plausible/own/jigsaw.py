"""A jigsaw: a pin on a gear drives the blade's yoke, a weight on a second pin goes the other way.

gear I_g, phi -- pin r -- yoke and blade m_s; pin r_w opposite -- weight m_w; F of the wood on the blade
"""

from mechsym.derive import Mechanism, output, pi


def jigsaw():
    m = Mechanism("jigsaw", about="Blade on a yoke with its counterweight.")
    phi = m.coordinates("phi")
    r, r_w = m.parameters("r r_w", "m", above=0)
    m_s, m_w = m.parameters("m_s m_w", "kg", above=0)
    I_g, I_a = m.parameters("I_g I_a", "kg*m^2", above=0)
    i = m.parameters("i", "-", above=0)
    c = m.parameters("c", "N*s/m", low=0)
    M, F = m.inputs("M", "N*m"), m.inputs("F", "N")
    gear = m.link("gear", turns=phi, inertia=I_g)
    blade, weight = m.link("blade", mass=m_s), m.link("weight", mass=m_w)
    m.pin("O", m.frame, gear)
    m.slider("G", m.frame, blade)
    m.slot("S", gear.at(r), blade.line(angle=pi / 2))
    m.slider("H", m.frame, weight)
    m.slot("T", gear.at(-r_w), weight.line(angle=pi / 2))
    m.body("armature", mass=0, at=(0, 0), turns=i * phi, inertia=I_a)
    x = m.let("x", blade.at().x, "m")
    m.damper(c, stretch=x)
    m.force(F, along=x)
    m.torque(i * M, along=phi)
    m.rotor("gear", angle=phi, drive=M)
    output(m, x, order=2)
    return m
