"""A bar that swings about a pin at its end; phi = 0 level, positive counter-clockwise."""

from mechsym.derive import Mechanism, sin


def swing():
    m = Mechanism("swing", about="A bar that swings about a pin at its end.")
    phi = m.coordinates("phi")
    l, mass = m.parameters("l", "m", above=0), m.parameters("mass", "kg", above=0)
    g = m.parameters("g", "m/s^2", default=9.81)
    M = m.inputs("M", "N*m")
    bar = m.link("bar", turns=phi, mass=mass, inertia=mass * l**2 / 12, centre=(l / 2, 0))
    m.pin("O", m.frame, bar)
    m.weight(0, -g)
    m.let("height", l / 2 * sin(phi), "m")
    m.torque(M, along=phi)
    m.draw_line(m.frame.at(), bar.at(l), role="rod")
    return m
