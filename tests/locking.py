"""A four-bar linkage whose crank locks, or whose links lie flat, with a case of it, for tests."""

FOURBAR = """from mechsym.derive import Mechanism


def fourbar():
    m = Mechanism("fourbar")
    phi = m.coordinates("phi")
    a, b, c, d = m.parameters("a b c d", "m", above=0)
    J = m.parameters("J", "kg*m^2", above=0)
    M = m.inputs("M", "N*m")
    crank, rod, rocker = m.link("crank", turns=phi, inertia=J), m.link("rod", inertia=J), m.link("rocker", inertia=J)
    m.pin("A", m.frame, crank)
    m.pin("B", crank.at(a), rod)
    m.pin("D", m.frame.at(d), rocker)
    m.pin("C", rod.at(b), rocker.at(c), branch=1)
    m.torque(M, along=phi)
    return m
"""
CASE = """mechanism = "./fourbar.py"
[parameters]
a = 0.2
b = 0.25
c = 0.2
d = 0.4
J = 0.01
[simulation]
t_end = 5
speed_start = {speed}
phi_start = {start}
[drive]
torque = {torque}
"""
