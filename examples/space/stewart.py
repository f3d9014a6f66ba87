"""A Stewart platform: six legs that lengthen between universal joints below and spheres above move a plate."""

from mechsym.derive import Mechanism, cos, pi, sin


def stewart():
    m = Mechanism("stewart", space=3, about="A Stewart platform.")
    R, r, half = m.parameters("R r half", "m", above=0)  # of the joints' circles; half a leg's parts
    gap = m.parameters("gap", "rad", above=0, below=1)  # between the joints of a pair, and the middle of it
    plate_mass, low, up = m.parameters("plate_mass low up", "kg", above=0)
    I, A, C = m.parameters("I A C", "kg*m^2", above=0)  # plate; a part of a leg across and along it
    forces = m.inputs("F1 F2 F3 F4 F5 F6", "N")
    plate = m.link("plate", mass=plate_mass, inertia=(I, I, 2 * I))
    m.free("P", plate, pose=(0, 0, "1 m", 0, 0, 0))
    for k, F in enumerate(forces):
        side = 1 if k % 2 else -1
        foot, head = (2 * k + 1 - side) * pi / 6 + side * gap, (2 * k + 1 + side) * pi / 6 - side * gap
        below = m.link(f"below{k + 1}", mass=low, centre=(0, 0, half), inertia=(A, A, C))
        above = m.link(f"above{k + 1}", mass=up, centre=(0, 0, -half), inertia=(A, A, C))
        m.universal(f"U{k + 1}", m.frame.axis("x", at=(R * cos(foot), R * sin(foot), 0)), below.axis("y"))
        leg = m.prismatic(f"L{k + 1}", below, above, axis="z", pose="1 m")
        m.spherical(f"S{k + 1}", above, plate.at(r * cos(head), r * sin(head), 0))
        m.force(F, along=leg.slide)
    m.weight(0, 0, -m.parameters("g", "m/s^2", default=9.81))
    return m
