"""An eccentric press: flywheel on a belt that gives way, crank, rod and ram, which a blank holds back.

motor I_m, psi -- belt k, c (ratio i) -- crank I_f, phi, r -- rod l -- ram m_s
"""

from mechsym.derive import Mechanism, output


def punch():
    m = Mechanism("punch", about="Eccentric press with a belt.")
    phi, psi = m.coordinates("phi psi")
    r, l = m.parameters("r l", "m", above=0)
    m_p, m_s = m.parameters("m_p m_s", "kg", above=0)
    I_m, I_f, J_p = m.parameters("I_m I_f J_p", "kg*m^2", above=0)
    i = m.parameters("i", "-", above=0)
    k = m.parameters("k", "N*m/rad", above=0)
    c = m.parameters("c", "N*m*s/rad", low=0)
    M, F = m.inputs("M", "N*m"), m.inputs("F", "N")
    crank = m.link("crank", turns=phi, inertia=I_f)
    rod = m.link("rod", mass=m_p, centre=(l / 3, 0), inertia=J_p)
    ram = m.link("ram", mass=m_s)
    m.pin("O", m.frame, crank)
    m.pin("A", crank.at(r), rod)
    m.slider("S", m.frame.line(angle=0), ram)
    m.pin("B", rod.at(l), ram)
    m.body("motor", mass=0, at=(0, 0), turns=psi, inertia=I_m)
    m.spring(k, stretch=psi / i - phi)
    m.damper(c, stretch=psi / i - phi)
    x = m.let("x", ram.at().x, "m")
    m.force(-F, along=x)
    m.torque(M, along=psi)
    m.rotor("motor", angle=psi, drive=M)
    output(m, x, order=2)
    return m
