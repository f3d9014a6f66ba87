"""A lift: motor and drum, a rope over it from the counterweight to the cabin, which hangs on its own springs.

motor I_m, phi = i psi -- drum I_d, psi, R -- rope k_r, c_r -- cabin m_c, z; counterweight m_w at -R psi
"""

from mechsym.derive import Mechanism, output


def lift():
    m = Mechanism("lift", about="A lift with counterweight.")
    psi, z = m.coordinates("psi"), m.coordinates("z", "m")
    I_m, I_d = m.parameters("I_m I_d", "kg*m^2", above=0)
    m_c, m_w = m.parameters("m_c m_w", "kg", above=0)
    i, R = m.parameters("i", "-", above=0), m.parameters("R", "m", above=0)
    k_r, c_r = m.parameters("k_r", "N/m", above=0), m.parameters("c_r", "N*s/m", low=0)
    M = m.inputs("M", "N*m")
    m.weight(0, -9.81)
    m.body("motor", mass=0, at=(0, 0), turns=i * psi, inertia=I_m)
    m.body("drum", mass=0, at=(0, 0), turns=psi, inertia=I_d)
    m.body("counterweight", mass=m_w, at=(-R, -R * psi))
    m.body("cabin", mass=m_c, at=(R, z))
    m.spring(k_r, stretch=R * psi - z)
    m.damper(c_r, stretch=R * psi - z)
    m.torque(M, along=psi)
    m.rotor("drum", angle=psi, drive=M)
    output(m, psi, order=2)
    return m
