"""Conveyor trough on two rockers, shaken by a crank through a rod: a four-bar whose rocker carries the trough.

O-A crank, A-B rod, D-B rocker; the trough hangs at B and moves with it.
"""

from mechsym.derive import Mechanism, output


def feeder():
    m = Mechanism("feeder", about="Shaking conveyor.")
    phi = m.coordinates("phi")
    c, b, k, f = m.parameters("c b k f", "m", above=0)
    m_b, m_k, m_t = m.parameters("m_b m_k m_t", "kg", above=0)
    J_c, J_b, J_k = m.parameters("J_c J_b J_k", "kg*m^2", above=0)
    d = m.parameters("d", "N*s/m", low=0)
    g = m.parameters("g", "m/s^2", default=9.81)
    M = m.inputs("M", "N*m")
    crank = m.link("crank", turns=phi, inertia=J_c)
    rod = m.link("rod", mass=m_b, centre=(b / 2, 0), inertia=J_b)
    rocker = m.link("rocker", mass=m_k, centre=(k / 2, 0), inertia=J_k)
    m.pin("O", m.frame, crank)
    m.pin("A", crank.at(c), rod)
    m.pin("D", m.frame.at(f), rocker)
    m.pin("B", rod.at(b), rocker.at(k), branch=1)
    m.body("trough", mass=m_t, at=(rocker.at(k).x, rocker.at(k).y))
    x = m.let("x", rocker.at(k).x, "m")
    m.damper(d, stretch=x)
    m.weight(0, -g)
    m.torque(M, along=phi)
    m.rotor("crank", angle=phi, drive=M)
    m.bearing("main", reactions=("R_x_O", "R_y_O"), turns=phi, at="main_bearings")
    output(m, x, order=2)
    return m
