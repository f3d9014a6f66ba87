"""Linkages in space: RSSR, RSSP, Hooke's joint, a wobble plate, an axial pump, a door on two hinges."""

from mechsym.derive import Mechanism, cos, pi, sin


def rssr():
    m = Mechanism("rssr", space=3, about="Crank and rocker on crossing axes, a rod between them.")
    phi = m.coordinates("phi")
    a, b, c, d, h = m.parameters("a b c d h", "m", above=0)  # crank, rod, rocker; places of its axis
    m2, m3 = m.parameters("m2 m3", "kg", above=0)
    I1, I2, J2, I3 = m.parameters("I1 I2 J2 I3", "kg*m^2", above=0)  # J2: of the rod about its own line
    M = m.inputs("M", "N*m")
    crank, rocker = m.link("crank", inertia=I1), m.link("rocker", mass=m3, centre=(0, 0, c / 2), inertia=(I3, I3, I3))
    rod = m.link("rod", mass=m2, centre=(b / 2, 0, 0), inertia=(J2, I2, I2))
    m.revolute("A", m.frame, crank, axis="z", turns=phi)
    m.revolute("D", m.frame.at(d, h, 0), rocker, axis="x", pose="10 deg")
    m.universal("B", crank.axis("z", at=(a, 0, 0)), rod.axis("y"), pose=("60 deg", "-30 deg"))
    m.spherical("C", rod.at(b, 0, 0), rocker.at(0, 0, c))
    m.torque(M, along=phi)
    m.rotor("shaft", angle=phi, drive=M)
    m.weight(0, 0, -m.parameters("g", "m/s^2", default=9.81))
    return m


def rssp():
    m = Mechanism("rssp", space=3, about="A crank drives a slider whose way crosses its axis.")
    phi = m.coordinates("phi")
    r, l, e = m.parameters("r l e", "m", above=0)
    m_p, m_r = m.parameters("m_p m_r", "kg", above=0)
    I, I_r, J_r = m.parameters("I I_r J_r", "kg*m^2", above=0)
    F, M_r = m.inputs("F", "N"), m.inputs("M_r", "N*m")
    crank, piston = m.link("crank", inertia=(I, I, I)), m.link("piston", mass=m_p)
    rod = m.link("rod", mass=m_r, centre=(0, 0, l / 2), inertia=(I_r, I_r, J_r))
    m.revolute("A", m.frame, crank, axis="x", turns=phi)
    m.universal("B", crank.axis("x", at=(0, 0, r)), rod.axis("y"))
    slide = m.prismatic("P", m.frame.at(e, 0, 0), piston, axis="z", pose="0.5 m")
    m.spherical("C", rod.at(0, 0, l), piston)
    m.force(-F, along=slide.slide)
    m.torque(-M_r, along=phi)
    m.piston("p", travel=r + l - slide.slide, force=F)
    m.rotor("shaft", angle=phi, load=M_r)
    return m


def hooke():
    m = Mechanism("hooke", space=3, about="Hooke's joint between two shafts at an angle.")
    phi = m.coordinates("phi")
    beta = m.parameters("beta", "rad", low=0, below=1.4)
    I1, I2 = m.parameters("I1 I2", "kg*m^2", above=0)
    M, L = m.inputs("M L", "N*m")
    one, other = m.link("shaft1", inertia=I1), m.link("shaft2", inertia=(I2, I2, I2))
    m.revolute("A", m.frame, one, axis="z", turns=phi)
    out = m.revolute("B", m.frame.axis((sin(beta), 0, cos(beta))), other.axis("z"))
    m.universal("U", one.axis("x"), other.axis("y"))
    m.torque(M, along=phi)
    m.torque(-L, along=out.turn)
    return m


def wobble():
    m = Mechanism("wobble", space=3, about="A plate that wobbles on a slanting crank, kept from turning by a guide.")
    phi = m.coordinates("phi")
    tilt, R, l, s = m.parameters("tilt", "rad", above=0, below=0.6), *m.parameters("R l s", "m", above=0)
    I, A, C = m.parameters("I A C", "kg*m^2", above=0)
    m_p, m_w = m.parameters("m_p m_w", "kg", above=0)
    J = m.parameters("J", "kg*m^2", above=0)
    F, M = m.inputs("F", "N"), m.inputs("M", "N*m")
    shaft = m.link("shaft", inertia=I)
    plate = m.link("plate", mass=m_w, inertia=(A, A, C))
    rod, piston = m.link("rod", mass=m_p / 4, centre=(0, 0, l / 2), inertia=(J, J, J / 9)), m.link("piston", mass=m_p)
    m.revolute("A", m.frame, shaft, axis="z", turns=phi)
    m.revolute("B", shaft.axis((sin(tilt), 0, cos(tilt))), plate.axis("z"))
    m.plane("G", m.frame.axis("x"), plate.at(0, -s, 0))  # a pin of the plate in a slot along the shaft
    m.prismatic("P", m.frame.at(R, 0, 0), piston, axis="z", pose="0.1 m")
    m.universal("C", plate.axis("x", at=(R, 0, 0)), rod.axis("y"))
    m.spherical("D", rod.at(0, 0, l), piston)
    m.force_at((0, 0, -F), piston)
    m.torque(M, along=phi)
    return m


def pump():
    m = Mechanism(
        "pump", space=3, about="An axial pump: pistons in a barrel that turns, their shoes on a plate that stands."
    )
    phi = m.coordinates("phi")
    tilt, R = m.parameters("tilt", "rad", above=0, below=0.6), m.parameters("R", "m", above=0)
    m_p, l = m.parameters("m_p", "kg", above=0), m.parameters("l", "m")  # of a piston, its centre above the shoe
    I, A, C = m.parameters("I A C", "kg*m^2", above=0)  # barrel; a piston across and along
    M = m.inputs("M", "N*m")
    barrel, plate = m.link("barrel", inertia=I), m.frame.axis((-sin(tilt), 0, cos(tilt)))
    m.revolute("A", m.frame, barrel, axis="z", turns=phi)
    for k, F in enumerate(m.inputs("F1 F2 F3", "N")):
        place = 2 * pi * k / 3
        piston = m.link(f"piston{k + 1}", mass=m_p, centre=(0, 0, l), inertia=(A, A, C))
        bore = m.prismatic(f"G{k + 1}", barrel.at(R * cos(place), R * sin(place), 0), piston, axis="z")
        m.plane(f"S{k + 1}", plate, piston)
        m.force(-F, along=bore.slide)  # the pressure acts on the barrel's bottom too
    m.torque(M, along=phi)
    m.rotor("shaft", angle=phi, drive=M)
    return m


def door():
    m = Mechanism("door", space=3, about="A door on two hinges, one of which would do.")
    phi = m.coordinates("phi")
    w, h = m.parameters("w h", "m", above=0)
    mass, I = m.parameters("mass", "kg", above=0), m.parameters("Ix Iy Iz", "kg*m^2", above=0)
    leaf = m.link("leaf", mass=mass, centre=(w / 2, 0, h / 2), inertia=I)
    tilt = m.parameters("tilt", "rad")  # of the hinges, so that the door falls shut
    m.revolute("lower", m.frame, leaf, axis="z", turns=phi)
    m.revolute("upper", m.frame.at(0, 0, h), leaf.at(0, 0, h), axis="z")
    g = m.parameters("g", "m/s^2", default=9.81)
    m.weight(g * sin(tilt), 0, -g * cos(tilt))
    return m
