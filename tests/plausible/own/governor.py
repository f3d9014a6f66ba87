"""Watt's governor: two balls on arms turn with a spindle; as they rise they lift a sleeve, its weight and a spring.

spindle J, phi; arms of length a, beta from the spindle's line; the sleeve m_s hangs on links of the same length.
"""

from sympy import cos

from mechsym.derive import Mechanism, output


def governor():
    m = Mechanism("governor", space=3, about="Governor with two balls and a sleeve.")
    phi, beta = m.coordinates("phi beta")
    a = m.parameters("a", "m", above=0)
    m_b, m_s = m.parameters("m_b m_s", "kg", above=0)
    J, I_b = m.parameters("J I_b", "kg*m^2", above=0)
    k = m.parameters("k", "N/m", low=0)
    h0 = m.parameters("h0", "m", low=0)
    c = m.parameters("c", "N*s/m", low=0)
    M = m.inputs("M", "N*m")
    m.weight(0, 0, -m.parameters("g", "m/s^2", default=9.81))
    spindle = m.link("spindle", inertia=(J, J, J))
    m.revolute("O", m.frame, spindle, axis="z", turns=phi)
    for name, side in (("left", 1), ("right", -1)):
        arm = m.link(name, mass=m_b, centre=(0, 0, -a), inertia=(I_b, I_b, I_b))
        m.revolute(f"P_{name}", spindle.axis("y"), arm.axis("y"), turns=side * beta)
    h = m.let("h", 2 * a * (1 - cos(beta)), "m")
    sleeve = m.link("sleeve", mass=m_s)
    m.prismatic("S", m.frame, sleeve, axis="z", slides=h - 2 * a)
    m.spring(k, stretch=h - h0)
    m.damper(c, stretch=h)
    m.torque(M, along=phi)
    m.rotor("spindle", angle=phi, drive=M)
    output(m, h, order=2)
    return m
