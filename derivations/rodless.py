"""Connecting-rod-less (Balandin) mechanism: a link A-C-B on a crank, two sliders at right angles (Prymak).

          y ^                                      x along axis a, y along axis b, alpha = 0 with slider A outermost,
            B (slider b, X_b along x)              positive from x to y.
            |  . link, -alpha                      O-C crank r; A-C and C-B are r long, so A stays on x and B on y:
            |     C                                x_a = 2 r cos(alpha), x_b = 2 r sin(alpha).
            |   . r   .                            F_a, F_b on the sliders, positive outwards; M load, opposing.
            O - - - - - - A (slider a, X_a along y) - - x

Rigid links, no friction, no gravity. The mechanism is overconstrained by one: a radial pin force S on the link with
X_a = -S sin(alpha), X_b = -S cos(alpha) is in balance and does no work. Only what S does not change is derived here;
X_a, X_b and the pin force need a closing rule (mechsym/mechanisms/rodless.py), and rodless_constraints.py gives the
rank. Each joint displacement below is therefore one that S does no work on.
"""

from mechsym.derive import Mechanism, cos, output, sin


def rodless():
    m = Mechanism("rodless", source="003_8746f5f4ad51b1d1", about="Crank, link and two sliders at right angles.")
    alpha = m.coordinates("alpha")
    r = m.parameters("r", "m")
    I1 = m.parameters("I1", "kg*m^2")
    u1 = m.parameters("u1", "kg*m")
    m_link = m.parameters("m_link", "kg")
    I_link = m.parameters("I_link", "kg*m^2")
    m_a, m_b = m.parameters("m_a m_b", "kg")
    F_a, F_b = m.inputs("F_a F_b", "N")
    M = m.inputs("M", "N*m")
    t = m.joints("t_C", "crank on link, along the crank pin's path", reactions="pin_force_tangential")
    g = m.joints("g", "guides on sliders, X_a cos(alpha) - X_b sin(alpha)", reactions="guide_combination")
    d_x = m.joints("d_x", "crank and guide b on link and sliders", reactions="pin_and_guide_x")
    d_y = m.joints("d_y", "crank and guide a on link and sliders", reactions="pin_and_guide_y")

    s, c = sin(alpha), cos(alpha)
    x_C, y_C = r * c + d_x - t * s, r * s + d_y + t * c
    x_a = m.let("x_a", r * c + x_C + (g - t) * s, "m")
    x_b = m.let("x_b", r * s + y_C - (g - t) * c, "m")

    # only the product u1 = mass times radius enters, so the unbalance is put at the crank pin
    m.body("crank", mass=u1 / r, at=(r * c, r * s), turns=alpha, inertia_about_axis=I1)
    m.body("link", mass=m_link, at=(x_C, y_C), turns=(g - t) / r - alpha, inertia=I_link)
    m.body("slider_a", mass=m_a, at=(x_a, g * c + d_y))
    m.body("slider_b", mass=m_b, at=(d_x - g * s, x_b))
    m.force(F_a, along=x_a)
    m.force(F_b, along=x_b)
    m.torque(-M, along=alpha)
    output(m, x_a, order=2)
    output(m, x_b, order=2)
    m.rotor("crank", angle=alpha, load=M, inertia=I1)
    return m
