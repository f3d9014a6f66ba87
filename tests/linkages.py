"""Planar linkages of every kind of joint and dyad, for tests: each a function that declares one, with values."""

from mechsym.derive import Mechanism, pi

MASSES = {"m1": 0.8, "m2": 1.3, "m3": 0.6, "I1": 0.02, "I2": 0.015, "I3": 0.011, "g": 9.81}


def start(name, by_constraint=False):
    m = Mechanism(name)
    m.guessed = by_constraint  # a closed form takes no guess
    phi = m.coordinates("phi")
    a, b, c, d, e = m.parameters("a b c d e", "m", above=0)
    m1, m2, m3 = m.parameters("m1 m2 m3", "kg", low=0)
    I1, I2, I3 = m.parameters("I1 I2 I3", "kg*m^2", low=0)
    g = m.parameters("g", "m/s^2")
    m.inputs("M", "N*m")
    m.torque(m.input_list[0], along=phi)
    m.weight(g / 3, -g)
    crank = m.link("crank", turns=phi, mass=m1, centre=(a / 3, e / 5), inertia=I1)
    m.pin("O", m.frame.at(0, 0), crank)
    return m, crank, (a, b, c, d, e), ((m2, I2), (m3, I3))


def link(m, name, mass, centre, guess=0.0):
    return m.link(name, mass=mass[0], inertia=mass[1], centre=centre, guess=guess if m.guessed else None)


def rrr(by_constraint=False, flip=False):
    m, crank, (a, b, c, d, e), (one, two) = start("rrr", by_constraint)
    rod, rocker = link(m, "rod", one, (b / 2, e), guess=0.5), link(m, "rocker", two, (c / 3, -e), guess=1.2)
    m.pin("B", crank.at(a, e / 7), rod)
    m.pin("D", *((rocker, m.frame.at(d, e)) if flip else (m.frame.at(d, e), rocker)))
    if by_constraint:
        rod.settle(), rocker.settle()
    ends = rod.at(b, e / 4), rocker.at(c, e / 9)
    m.pin("C", *(reversed(ends) if flip else ends), branch=1)
    return m


def rrp(by_constraint=False, flip=False):
    m, crank, (a, b, c, d, e), (one, two) = start("rrp", by_constraint)
    rod, block = link(m, "rod", one, (b / 2, e), guess=-0.2), link(m, "block", two, (e / 2, e / 3), guess=0.5)
    m.pin("B", crank.at(a), rod)
    lines = m.frame.line(0, e, angle=pi / 12), block.line(e / 8, e / 6, angle=pi / 9)
    m.slider("G", *(reversed(lines) if flip else lines))
    if by_constraint:
        rod.settle(), block.settle()
    m.pin("C", rod.at(b), block.at(e / 4, -e / 5))
    return m


def rpr(by_constraint=False, flip=False):
    m, crank, (a, b, c, d, e), (one, two) = start("rpr", by_constraint)
    block, rocker = link(m, "block", one, (e / 3, e / 2), guess=-0.5), link(m, "rocker", two, (c / 3, e / 4), guess=2.5)
    m.pin("B", crank.at(a), block.at(e / 7, e / 9))
    m.pin("D", m.frame.at(d, e), rocker)
    if by_constraint:
        block.settle(), rocker.settle()
    lines = rocker.line(0, e / 3, angle=pi / 20), block.line(e / 6, 0, angle=pi / 15)
    m.slider("S", *(reversed(lines) if flip else lines), branch=-1 if flip else 1)
    return m


def prp(by_constraint=False, flip=False):
    m, crank, (a, b, c, d, e), (one, two) = start("prp", by_constraint)
    one_, two_ = link(m, "across", one, (e, 0)), link(m, "up", two, (0, e), guess=0.2)
    m.slider("G", crank.line(0, e, angle=pi / 3), one_.line(0, e / 3))
    m.slider("H", m.frame.line(d, 0, angle=pi / 2), two_)
    if by_constraint:
        one_.settle(), two_.settle()
    ends = one_.at(e / 2, e / 3), two_.at(e / 5, e / 7)
    m.pin("C", *(reversed(ends) if flip else ends))
    return m


def rpp(by_constraint=False, flip=False):
    m, crank, (a, b, c, d, e), (one, two) = start("rpp", by_constraint)
    block, yoke = link(m, "block", one, (e / 2, e / 3)), link(m, "yoke", two, (c / 2, e))
    m.pin("B", crank.at(a), block.at(e / 8, 0))
    m.slider("G", m.frame.line(0, e / 4), yoke.line(0, e / 2))
    if by_constraint:
        block.turns = m.dependents("theta_block", guess=1.6)
        block.settle(), yoke.settle()
    lines = yoke.line(0, 0, angle=pi / 2), block.line(e / 5, e / 9, angle=pi / 11)
    m.slider("S", *(reversed(lines) if flip else lines))
    return m


def slotted(by_constraint=False, flip=False):
    m, crank, (a, b, c, d, e), (one, two) = start("slotted", by_constraint)
    rocker, yoke = link(m, "rocker", one, (c / 2, e), guess=2.6), link(m, "yoke", two, (c / 2, e / 2), guess=0.2)
    m.pin("D", m.frame.at(d, e), rocker)
    m.slider("G", m.frame.line(0, 2 * d, angle=pi / 10), yoke)
    if by_constraint:
        rocker.settle(), yoke.settle()
    pair = rocker.line(0, e / 4, angle=pi / 18), crank.at(a)
    m.slot("S", *(reversed(pair) if flip else pair))
    other = yoke.line(e, 0, angle=pi / 2), rocker.at(b, e / 6)
    m.slot("T", *(reversed(other) if flip else other))
    return m


def pins_in_grooves(by_constraint=False, flip=False):
    m, crank, (a, b, c, d, e), (one, two) = start("pins_in_grooves", by_constraint)
    rod, yoke = link(m, "rod", one, (b / 2, e), guess=-0.2), link(m, "yoke", two, (e, e), guess=0.5)
    m.pin("B", crank.at(a), rod)
    m.slider("G", m.frame.line(0, -d, angle=pi / 15), yoke)
    if by_constraint:
        rod.settle(), yoke.settle()
    groove = m.frame.line(0, e, angle=pi / 14), rod.at(b, e / 8)
    m.slot("S", *(reversed(groove) if flip else groove))
    other = crank.line(0, d, angle=pi / 5), yoke.at(e / 3, e / 4)
    m.slot("T", *(reversed(other) if flip else other))
    return m


def gears(inside=False):
    m, crank, (a, b, c, d, e), (one, two) = start("gears")
    planet, wheel = link(m, "planet", one, (e / 2, e / 3)), link(m, "wheel", two, (0, e / 4))
    r1, r2 = (a + e, e) if inside else (a - e, e)
    m.pin("C", crank.at(a), planet)
    m.gear("T", m.frame, planet, radii=(r1, r2), inside=inside)
    m.pin("D", m.frame.at(0, 0), wheel)
    m.gear("U", planet, wheel, radii=(e, a - e)) if inside else m.gear("U", planet, wheel, radii=(e / 3, a - e / 3))
    return m


ALL = {f.__name__: f for f in (rrr, rrp, rpr, prp, rpp, slotted, pins_in_grooves)}
VALUES = {"a": 0.1, "b": 0.35, "c": 0.27, "d": 0.31, "e": 0.03, **MASSES}
