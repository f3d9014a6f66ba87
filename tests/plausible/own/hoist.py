"""Mine hoist: a drum winds a rope up, the cage hangs on the rope's elastic length and is braked by its guides.

(drum R, phi) -- rope k -- [cage, y upwards], y = 0 at rest of the unstretched rope with phi = 0.
"""

from mechsym.derive import Mechanism, output


def hoist():
    m = Mechanism("hoist", about="Mine hoist.")
    phi, y = m.coordinates("phi"), m.coordinates("y", "m")
    R = m.parameters("R", "m", above=0)
    m_cage = m.parameters("m_cage", "kg", above=0)
    I_drum = m.parameters("I_drum", "kg*m^2", above=0)
    k, c = m.parameters("k", "N/m", above=0), m.parameters("c", "N*s/m", low=0)
    g = m.parameters("g", "m/s^2", default=9.81)
    M = m.inputs("M", "N*m")
    m.body("drum", mass=0, at=(0, 0), turns=phi, inertia=I_drum)
    m.body("cage", mass=m_cage, at=(R, y))
    m.spring(k, stretch=R * phi - y)
    m.damper(c, stretch=R * phi - y)
    m.weight(0, -g)
    m.torque(M, along=phi)
    m.rotor("drum", angle=phi, drive=M)
    output(m, y, order=2)
    return m
