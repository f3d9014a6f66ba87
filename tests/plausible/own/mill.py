"""A rolling mill: motor, gear, spindle and rolls, the strip holds them back.

motor I_m, alpha -- gear i -- spindle k, c -- rolls I_r, theta, radius R, force F of the strip
"""

from mechsym.derive import Mechanism, output


def mill():
    m = Mechanism("mill", about="Rolling mill on a long spindle.")
    alpha, theta = m.coordinates("alpha theta")
    I_m, I_r = m.parameters("I_m I_r", "kg*m^2", above=0)
    R = m.parameters("R", "m", above=0)
    i = m.parameters("i", "-", above=0)
    k = m.parameters("k", "N*m/rad", above=0)
    c = m.parameters("c", "N*m*s/rad", low=0)
    M, F = m.inputs("M", "N*m"), m.inputs("F", "N")
    m.body("motor", mass=0, at=(0, 0), turns=alpha, inertia=I_m)
    m.body("rolls", mass=0, at=(0, 0), turns=theta, inertia=I_r)
    twist = m.let("twist", alpha / i - theta, "rad")
    m.spring(k, stretch=twist)
    m.damper(c, stretch=twist)
    m.torque(M, along=alpha)
    m.torque(-F * R, along=theta)
    m.rotor("motor", angle=alpha, drive=M)
    output(m, twist, order=1)
    return m
