"""A cyclist: pedal crank, chain and wheel drive a mass along the road, drag and a spring of the chain between.

pedals I_p, phi -- chain k, c (teeth ratio i) -- wheel I_w, psi, radius R -- rider and bicycle m along s = R psi
"""

from mechsym.derive import Mechanism, output


def pedal():
    m = Mechanism("pedal", about="Cyclist on a chain that gives way.")
    phi, psi = m.coordinates("phi psi")
    R = m.parameters("R", "m", above=0)
    mass = m.parameters("m_c", "kg", above=0)
    I_p, I_w = m.parameters("I_p I_w", "kg*m^2", above=0)
    i = m.parameters("i", "-", above=0)
    k = m.parameters("k", "N*m/rad", above=0)
    c = m.parameters("c", "N*m*s/rad", low=0)
    d = m.parameters("d", "N*s/m", low=0)
    M = m.inputs("M", "N*m")
    m.body("pedals", mass=0, at=(0, 0), turns=phi, inertia=I_p)
    m.body("wheel", mass=0, at=(0, 0), turns=psi, inertia=I_w)
    s = m.let("s", R * psi, "m")
    m.body("rider", mass=mass, at=(s, 0))
    m.spring(k, stretch=phi - psi / i)
    m.damper(c, stretch=phi - psi / i)
    m.damper(d, stretch=s)
    m.torque(M, along=phi)
    m.rotor("pedals", angle=phi, drive=M)
    output(m, s, order=2)
    return m
