"""Two shafts at an angle with a universal joint between them, and a machine behind a soft coupling.

driving shaft J_1, phi -- joint at the angle a -- driven shaft J_2, psi -- coupling k, c -- machine J_3, theta
"""

from mechsym.derive import Mechanism, atan2, cos, output, sin


def cardan():
    m = Mechanism("cardan", about="Universal joint between two shafts.")
    phi, theta = m.coordinates("phi theta")
    a = m.parameters("a", "rad", low=0)
    J_1, J_2, J_3 = m.parameters("J_1 J_2 J_3", "kg*m^2", above=0)
    k = m.parameters("k", "N*m/rad", above=0)
    c, b = m.parameters("c b", "N*m*s/rad", low=0)
    M, T = m.inputs("M T", "N*m")
    psi = m.let("psi", phi + atan2((cos(a) - 1) * sin(phi) * cos(phi), cos(phi) ** 2 + cos(a) * sin(phi) ** 2), "rad")
    m.body("driving", turns=phi, inertia=J_1)
    m.body("driven", turns=psi, inertia=J_2)
    m.body("machine", turns=theta, inertia=J_3)
    twist = m.let("twist", psi - theta, "rad")
    m.spring(k, stretch=twist)
    m.damper(c, stretch=twist)
    m.damper(b, stretch=theta)
    m.torque(M, along=phi)
    m.torque(-T, along=theta)
    output(m, twist, order=1)
    return m
