"""Picking arm in a vertical plane: two links with drives, a load in the hand.

S (frame) -- upper arm, length p -- E -- forearm, length n -- hand with the load; both angles from the horizontal.
"""

from mechsym.derive import Mechanism, output


def picker():
    m = Mechanism("picker", about="Picking arm.")
    alpha, beta = m.coordinates("alpha beta")
    p, n = m.parameters("p n", "m", above=0)
    u_mass, f_mass, load = m.parameters("u_mass f_mass load", "kg", low=0)
    u_inertia, f_inertia = m.parameters("u_inertia f_inertia", "kg*m^2", above=0)
    w = m.parameters("w", "N*m*s/rad", default=0)
    g = m.parameters("g", "m/s^2", default=9.81)
    shoulder, elbow = m.inputs("shoulder elbow", "N*m")
    upper = m.link("upper", turns=alpha, mass=u_mass, centre=(p / 2, 0), inertia=u_inertia)
    fore = m.link("fore", turns=beta, mass=f_mass, centre=(n / 2, 0), inertia=f_inertia)
    m.pin("S", m.frame, upper)
    m.pin("E", upper.at(p), fore)
    m.body("hand", mass=load, at=(fore.at(n).x, fore.at(n).y))
    m.weight(0, -g)
    m.torque(shoulder, along=alpha)
    m.torque(elbow, along=beta - alpha)
    m.damper(w, stretch=alpha)
    x = m.let("reach", fore.at(n).x, "m")
    output(m, x, order=2)
    return m
