"""Windscreen wiper: a motor's crank pulls a rod, the rod swings the arm with its blade.

O-A crank, A-B rod, C-B lever; the arm is one piece with the lever. The blade's friction is a torque on it.
"""

from mechsym.derive import Mechanism


def wiper():
    m = Mechanism("wiper", about="Windscreen wiper.")
    theta = m.coordinates("theta")
    e, f, h, j = m.parameters("e f h j", "m", above=0)
    W_rod, W_arm = m.parameters("W_rod W_arm", "kg", low=0)
    q = m.parameters("q", "m", low=0)
    Y_motor, Y_rod, Y_arm = m.parameters("Y_motor Y_rod Y_arm", "kg*m^2", above=0)
    b = m.parameters("b", "N*m*s/rad", default=0)
    U, V = m.inputs("U V", "N*m")
    crank = m.link("crank", turns=theta, inertia=Y_motor)
    rod = m.link("rod", mass=W_rod, centre=(f / 2, 0), inertia=Y_rod)
    arm = m.link("arm", mass=W_arm, centre=(q, 0), inertia=Y_arm)
    m.pin("O", m.frame, crank)
    m.pin("A", crank.at(e), rod)
    m.pin("C", m.frame.at(j, 0), arm)
    m.pin("B", rod.at(f), arm.at(h), branch=1)
    m.torque(U, along=theta)
    m.torque(-V, along=arm.angle)
    m.damper(b, stretch=arm.angle)
    m.rotor("crank", angle=theta, drive=U)
    m.draw_line((0, 0), crank.at(e), arm.at(h), m.frame.at(j, 0), role="rod")
    return m
