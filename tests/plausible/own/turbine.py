"""Turbine, gear and generator on two torsional springs; the generator brakes with its speed.

turbine I_t, alpha -- k_1 -- gear I_g (ratio u), beta -- k_2 -- generator I_e, gamma
"""

from mechsym.derive import Mechanism, output


def turbine():
    m = Mechanism("turbine", about="Train of a turbine and a generator.")
    alpha, beta, gamma = m.coordinates("alpha beta gamma")
    I_t, I_g, I_e = m.parameters("I_t I_g I_e", "kg*m^2", above=0)
    k_1, k_2 = m.parameters("k_1 k_2", "N*m/rad", above=0)
    c_1, c_2, d = m.parameters("c_1 c_2 d", "N*m*s/rad", low=0)
    u = m.parameters("u", "-", above=0)
    M = m.inputs("M", "N*m")
    m.body("turbine", mass=0, at=(0, 0), turns=alpha, inertia=I_t)
    m.body("gear", mass=0, at=(0, 0), turns=beta, inertia=I_g)
    m.body("generator", mass=0, at=(0, 0), turns=gamma, inertia=I_e)
    m.spring(k_1, stretch=alpha - beta)
    m.damper(c_1, stretch=alpha - beta)
    m.spring(k_2, stretch=beta / u - gamma)
    m.damper(c_2, stretch=beta / u - gamma)
    m.damper(d, stretch=gamma)
    m.torque(M, along=alpha)
    m.rotor("turbine", angle=alpha, drive=M)
    output(m, alpha, order=2)
    return m
