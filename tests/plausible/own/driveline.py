"""A tractor's driveline: engine, elastic shaft, gearbox and axle, wheels that roll without slip under the tractor.

engine I_e, alpha -- k, c -- gear i, wheels I_w, theta, radius R -- tractor m_v, drag F at the hook
"""

from mechsym.derive import Mechanism, output


def driveline():
    m = Mechanism("driveline", about="Engine, shaft, axle and tractor.")
    alpha, theta = m.coordinates("alpha theta")
    I_e, I_w = m.parameters("I_e I_w", "kg*m^2", above=0)
    R = m.parameters("R", "m", above=0)
    m_v = m.parameters("m_v", "kg", above=0)
    i = m.parameters("i", "-", above=0)
    k, c = m.parameters("k", "N*m/rad", above=0), m.parameters("c", "N*m*s/rad", low=0)
    b = m.parameters("b", "N*s/m", low=0)
    M, F = m.inputs("M", "N*m"), m.inputs("F", "N")
    x = m.let("x", R * theta, "m")
    m.body("engine", mass=0, at=(0, 0), turns=alpha, inertia=I_e)
    m.body("tractor", mass=m_v, at=(x, 0))
    m.body("wheels", mass=0, at=(0, 0), turns=theta, inertia=I_w)
    twist = m.let("twist", alpha - i * theta, "rad")
    m.spring(k, stretch=twist)
    m.damper(c, stretch=twist)
    m.damper(b, stretch=x)
    m.torque(M, along=alpha)
    m.force(-F, along=x)
    m.rotor("engine", angle=alpha, drive=M)
    output(m, x, order=1)
    output(m, twist, order=1)
    return m
