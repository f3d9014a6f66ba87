"""Mechanisms with stops and friction, for the tests of their runs."""

from sympy import pi

from mechsym.derive import Mechanism, cos, sin


def ball():
    m = Mechanism("ball", about="A ball that bounces.")
    y = m.coordinates("y", "m")
    m1, e, g = m.parameters("m1", "kg", above=0), m.parameters("e", "-"), m.parameters("g", "m/s^2")
    m.body("ball", mass=m1, at=(0, y))
    m.weight(0, -g)
    m.stop(y, restitution=e)
    return m


def cushion():
    m = Mechanism("cushion", about="A mass that meets a cushion.")
    y = m.coordinates("y", "m")
    m1, k, c = m.parameters("m1", "kg", above=0), m.parameters("k", "N/m"), m.parameters("c", "s/m")
    m.body("ball", mass=m1, at=(0, y))
    m.stop(y, stiffness=k, damping=c)
    return m


def belt():
    m = Mechanism("belt", about="A block on a belt, held by a spring.")
    x = m.coordinates("x", "m")
    m1, k, N = m.parameters("m1", "kg", above=0), m.parameters("k", "N/m"), m.parameters("N", "N")
    mu_s, mu_k, v = *m.parameters("mu_s mu_k", "-"), m.parameters("v", "m/s")
    m.body("block", mass=m1, at=(x, 0))
    m.spring(k, stretch=x)
    m.friction(x, mu=(mu_s, mu_k), normal=N, speed=v)
    return m


def block():
    m = Mechanism("block", about="A block that rocks on two corners.")
    x, y = m.coordinates("x y", "m")
    th = m.coordinates("th")
    m1, b, h = m.parameters("m1", "kg", above=0), *m.parameters("b h", "m", above=0)
    g, mu = m.parameters("g", "m/s^2"), m.parameters("mu", "-")
    m.body("block", mass=m1, inertia=m1 * (b**2 + h**2) / 3, turns=th, at=(x, y))
    m.weight(0, -g)
    for name, side in (("left", -1), ("right", 1)):
        corner = x + side * b * cos(th) + h * sin(th), y + side * b * sin(th) - h * cos(th)
        m.contact(name, corner, m.frame.line(), restitution=0, friction=mu)
    return m


def press():
    m = Mechanism("press", about="A toggle press with friction in every joint.")
    phi = m.coordinates("phi")
    mu, M, F = m.parameters("mu", "-"), m.inputs("M", "N*m"), m.inputs("F", "N")
    crank = m.link("crank", turns=phi, inertia=0.1)
    bars = (m.link(n, mass=1.5, inertia=0.02, centre=(0.15, 0)) for n in ("rod", "upper", "lower", "ram"))
    rod, upper, lower, ram = bars
    m.pose(phi="90 deg", rod="10 deg", upper="-70 deg", lower="-110 deg")
    m.pin("O", m.frame, crank)
    m.pin("A", crank.at(0.05), rod)
    m.pin("D", m.frame.at(0.5, 0.4), upper)
    m.pin("B", rod.at(0.6), upper.at(0.35))
    m.pin("K", upper.at(0.35), lower)
    m.slider("G", m.frame.line(0.5, 0, angle=-pi / 2), ram)
    m.pin("P", lower.at(0.35), ram)
    m.torque(M, along=phi)
    m.force(F, along=ram.at().y)
    for joint in "OADBKP":
        m.friction(joint, mu=mu, radius=0.02)
    m.friction("G", mu=mu)
    return m
