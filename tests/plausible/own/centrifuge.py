"""A drum on a slender shaft: its weight lies a little off the axis, bearings with damping hold the shaft.

drum m at (x, y) + e (cos phi, sin phi) -- shaft k, c to the frame
"""

from mechsym.derive import Mechanism, cos, output, sin


def centrifuge():
    m = Mechanism("centrifuge", about="Drum on a slender shaft.")
    x, y = m.coordinates("x y", "m")
    phi = m.coordinates("phi")
    e = m.parameters("e", "m", low=0)
    mass = m.parameters("m", "kg", above=0)
    J = m.parameters("J", "kg*m^2", above=0)
    k = m.parameters("k", "N/m", above=0)
    c = m.parameters("c", "N*s/m", low=0)
    d = m.parameters("d", "N*m*s/rad", low=0)
    M = m.inputs("M", "N*m")
    m.body("drum", mass=mass, at=(x + e * cos(phi), y + e * sin(phi)), turns=phi, inertia=J)
    m.spring(k, stretch=x)
    m.spring(k, stretch=y)
    m.damper(c, stretch=x)
    m.damper(c, stretch=y)
    m.damper(d, stretch=phi)
    m.torque(M, along=phi)
    m.rotor("drum", angle=phi, drive=M)
    output(m, x, order=1)
    output(m, y, order=1)
    return m
