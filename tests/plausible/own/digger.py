"""Boom and stick of a digger: two links, each moved by a hydraulic cylinder, a bucket at the end.

O (frame) -- boom, length b -- E -- stick, length s -- bucket m_k; boom cylinder from (d, 0) to f on the boom,
stick cylinder from the middle of the boom to the stick's tail q behind E.
"""

from sympy import cos, sin, sqrt

from mechsym.derive import Mechanism, output


def digger():
    m = Mechanism("digger", about="Boom and stick of a digger.")
    alpha, beta = m.coordinates("alpha beta")
    b, s, d, f, q = m.parameters("b s d f q", "m", above=0)
    m_b, m_s, m_k = m.parameters("m_b m_s m_k", "kg", above=0)
    J_b, J_s = m.parameters("J_b J_s", "kg*m^2", above=0)
    w = m.parameters("w", "N*s/m", low=0)
    F_1, F_2 = m.inputs("F_1 F_2", "N")
    boom = m.link("boom", turns=alpha, mass=m_b, centre=(b / 2, 0), inertia=J_b)
    stick = m.link("stick", turns=beta, mass=m_s, centre=(s / 3, 0), inertia=J_s)
    m.pin("O", m.frame, boom)
    m.pin("E", boom.at(b), stick)
    m.body("bucket", mass=m_k, at=(stick.at(s).x, stick.at(s).y))
    m.weight(0, -9.81)
    lift = m.let("lift", sqrt(d**2 + f**2 - 2 * d * f * cos(alpha)), "m")
    tail = stick.at(-q)
    middle = boom.at(b / 2)
    push = m.let("push", sqrt((tail.x - middle.x) ** 2 + (tail.y - middle.y) ** 2), "m")
    m.force(F_1, along=lift)
    m.force(F_2, along=push)
    m.damper(w, stretch=lift)
    m.damper(w, stretch=push)
    h = m.let("h", b * sin(alpha) + s * sin(beta), "m")
    output(m, h, order=2)
    return m
