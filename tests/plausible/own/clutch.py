"""Engine and gearbox on a torsional spring with a damper; the gearbox drives the car through its ratio.

engine I_e, phi -- k, c -- gearbox I_g, psi -- load M_l
"""

from mechsym.derive import Mechanism, output


def clutch():
    m = Mechanism("clutch", about="Driveline of two inertias.")
    phi, psi = m.coordinates("phi psi")
    I_e, I_g = m.parameters("I_e I_g", "kg*m^2", above=0)
    k = m.parameters("k", "N*m/rad", above=0)
    c = m.parameters("c", "N*m*s/rad", low=0)
    m_car = m.parameters("m_car", "kg", above=0)
    i, R = m.parameters("i", "-", above=0), m.parameters("R", "m", above=0)
    M_e, M_l = m.inputs("M_e M_l", "N*m")
    m.body("engine", mass=0, at=(0, 0), turns=phi, inertia=I_e)
    m.body("gearbox", mass=0, at=(0, 0), turns=psi, inertia=I_g)
    m.body("car", mass=m_car, at=(R * psi / i, 0))
    m.spring(k, stretch=phi - psi)
    m.damper(c, stretch=phi - psi)
    m.torque(M_e, along=phi)
    m.torque(-M_l, along=psi)
    m.rotor("engine", angle=phi, drive=M_e, load=M_l)
    output(m, psi, order=2)
    return m
