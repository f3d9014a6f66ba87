"""Linkages of the textbooks from joints and one rough pose, with their numbers."""

from mechsym.derive import Mechanism, pi


def _begin(name):
    m = Mechanism(name)
    phi = m.coordinates("phi")
    M = m.inputs("M", "N*m")
    m.torque(M, along=phi)
    return m, phi


def _bar(m, name):
    return m.link(name, mass="1 kg", centre=("40 mm", "10 mm"), inertia="0.01 kg*m^2")


def chebyshev():
    m, phi = _begin("chebyshev")
    crank = m.link("crank", turns=phi, inertia=0.1)
    coupler, rocker = _bar(m, "coupler"), _bar(m, "rocker")
    m.pose(phi=1.2, coupler="-10 deg", rocker="110 deg")
    m.pin("O", m.frame, crank)
    m.pin("A", crank.at(0.5), coupler)
    m.pin("D", m.frame.at(0.4), rocker)
    m.pin("B", coupler.at(0.2), rocker.at(0.5))
    m.watch(coupler.at(0.1), "P")
    return m


def hoeken():
    m, phi = _begin("hoeken")
    crank = m.link("crank", turns=phi, inertia=0.1)
    coupler, rocker = _bar(m, "coupler"), _bar(m, "rocker")
    m.pose(phi="90 deg", coupler="30 deg", rocker="95 deg")
    m.pin("O", m.frame, crank)
    m.pin("A", crank.at(0.1), coupler)
    m.pin("D", m.frame.at(0.2), rocker)
    m.pin("B", coupler.at(0.25), rocker.at(0.25))
    m.watch(coupler.at(0.5), "P")
    return m


def peaucellier():
    m, phi = _begin("peaucellier")
    crank = m.link("crank", turns=phi, inertia=0.1)
    l1, l2 = _bar(m, "l1"), _bar(m, "l2")
    s1, s2, s3, s4 = (_bar(m, n) for n in ("s1", "s2", "s3", "s4"))
    m.pose(phi="20 deg", l1="20 deg", l2="-10 deg", s1="60 deg", s2="-50 deg", s3="-40 deg", s4="50 deg")
    m.pin("C", m.frame.at(0.2), crank)
    m.pin("O1", m.frame, l1)
    m.pin("O2", m.frame, l2)
    m.pin("B1", crank.at(0.2), s1)
    m.pin("B2", crank.at(0.2), s2)
    m.pin("E1", s1.at(0.25), l1.at(0.6))
    m.pin("E2", s2.at(0.25), l2.at(0.6))
    m.pin("F1", l1.at(0.6), s3)
    m.pin("F2", l2.at(0.6), s4)
    m.pin("P", s3.at(0.25), s4.at(0.25))
    m.watch(s3.at(0.25), "tip")
    return m


def toggle():
    m, phi = _begin("toggle")
    crank = m.link("crank", turns=phi, inertia=0.1)
    rod, upper, lower, ram = (_bar(m, n) for n in ("rod", "upper", "lower", "ram"))
    m.pose(phi="90 deg", rod="10 deg", upper="-70 deg", lower="-110 deg")
    m.pin("O", m.frame, crank)
    m.pin("A", crank.at(0.05), rod)
    m.pin("D", m.frame.at(0.5, 0.4), upper)
    m.pin("B", rod.at(0.6), upper.at(0.35))
    m.pin("K", upper.at(0.35), lower)
    m.slider("G", m.frame.line(0.5, 0, angle=-pi / 2), ram)
    m.pin("P", lower.at(0.35), ram)
    m.watch(ram, "R")
    return m


def shaper():
    m, phi = _begin("shaper")
    crank = m.link("crank", turns=phi, inertia=0.1)
    rocker, link, ram = (_bar(m, n) for n in ("rocker", "link", "ram"))
    m.pose(phi="0 deg", rocker="75 deg", link="170 deg")
    m.pin("O", m.frame, crank)
    m.pin("D", m.frame.at(0, -0.3), rocker)
    m.slot("A", rocker.line(), crank.at(0.1))
    m.pin("E", rocker.at(0.6), link)
    m.slider("G", m.frame.line(0, 0.3, angle=pi), ram)
    m.pin("F", link.at(0.3), ram)
    return m


def klann():
    m, phi = _begin("klann")
    crank = m.link("crank", turns=phi, inertia=0.1)
    conn, low, up, leg = (_bar(m, n) for n in ("conn", "low", "up", "leg"))
    m.pose(phi="90 deg", conn="170 deg", low="100 deg", up="160 deg", leg="230 deg")
    m.pin("O", m.frame, crank)
    m.pin("M", crank.at(0.11), conn)
    m.pin("A", m.frame.at(-0.266, 0.133), low)
    m.pin("B", m.frame.at(-0.1, 0.45), up)
    m.pin("C", conn.at(0.3), low.at(0.13))
    m.pin("D", conn.at(0.5, 0.05), leg)
    m.pin("E", leg.at(-0.2), up.at(0.35))
    m.watch(leg.at(0.5), "foot")
    return m


def scissor():
    m, phi = _begin("scissor")
    a = m.link("a", turns=phi, inertia=0.1)
    b, c, d = (_bar(m, n) for n in "bcd")
    top = m.link("top", mass="10 kg")
    foot = m.link("foot", mass="1 kg")
    m.pose(phi="30 deg", b="150 deg", c="150 deg", d="30 deg", top="0 deg")
    m.pin("O", m.frame, a)
    m.slider("F", m.frame, foot)
    m.pin("J", foot, b)
    m.pin("X", a.at(0.5), b.at(0.5))
    m.pin("U", a.at(1.0), c)
    m.pin("V", b.at(1.0), d)
    m.pin("Y", c.at(0.5), d.at(0.5))
    m.pin("W", c.at(1.0), top)
    m.slot("Z", top.line(), d.at(1.0))
    m.watch(top, "T")
    return m


def fivebar():
    m = Mechanism("fivebar")
    a1, a2 = m.coordinates("a1 a2")
    M1, M2 = m.inputs("M1 M2", "N*m")
    m.torque(M1, along=a1)
    m.torque(M2, along=a2)
    one, two = m.link("one", turns=a1, inertia=0.1), m.link("two", turns=a2, inertia=0.1)
    left, right = _bar(m, "left"), _bar(m, "right")
    m.pose(a1="120 deg", a2="60 deg", left="45 deg", right="135 deg")
    m.pin("O", m.frame, one)
    m.pin("Q", m.frame.at(0.2), two)
    m.pin("A", one.at(0.3), left)
    m.pin("B", two.at(0.3), right)
    m.pin("P", left.at(0.4), right.at(0.4))
    m.watch(left.at(0.4), "tip")
    return m


def jansen():
    m, phi = _begin("jansen")
    crank = m.link("crank", turns=phi, inertia=0.1)
    j, b, k, c, d, e, f, g, h, i = (
        _bar(m, n) for n in ("bar_j", "bar_b", "bar_k", "bar_c", "bar_d", "bar_e", "bar_f", "bar_g", "bar_h", "bar_i")
    )
    m.pose(
        phi=0.0,
        bar_j="145 deg",
        bar_b="60 deg",
        bar_k="-135 deg",
        bar_c="-80 deg",
        bar_d="160 deg",
        bar_e="-155 deg",
        bar_f="-80 deg",
        bar_g="-170 deg",
        bar_h="-100 deg",
        bar_i="-140 deg",
    )
    m.pin("Z", m.frame.at(0.38, 0.078), crank)
    m.pin("Y1", crank.at(0.15), j)
    m.pin("Y2", crank.at(0.15), k)
    m.pin("O1", m.frame, b)
    m.pin("O2", m.frame, c)
    m.pin("O3", m.frame, d)
    m.pin("X", j.at(0.5), b.at(0.415))
    m.pin("V", k.at(0.619), c.at(0.393))
    m.pin("X2", b.at(0.415), e)
    m.pin("W", e.at(0.558), d.at(0.401))
    m.pin("W2", d.at(0.401), f)
    m.pin("V2", c.at(0.393), g)
    m.pin("U", f.at(0.394), g.at(0.367))
    m.pin("U2", f.at(0.394), h)
    m.pin("V3", c.at(0.393), i)
    m.pin("T", h.at(0.657), i.at(0.49))
    m.watch(h.at(0.657), "foot")
    return m
