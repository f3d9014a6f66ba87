"""The rodless (Balandin) mechanism with its link free, held by four constraints of which three are independent.

Letters and drawing as in rodless.py. The link has the coordinates x_C, y_C and beta (= -alpha); the multipliers are the
pin force of the crank on the link (pin_x, pin_y) and the guide reactions on the sliders (guide_a along y, guide_b
along x). Rank 3 of 4: no multiplier is determined by the rigid mechanism alone.
"""

from mechsym.derivations.rodless import letters, sketch

from mechsym.derive import Mechanism, cos, output, sin


def rodless_constraints():
    m = Mechanism(
        "rodless_constraints",
        source="003_8746f5f4ad51b1d1",
        about="The rodless mechanism with constraints, for its rank.",
    )
    alpha = m.coordinates("alpha")
    x_C, y_C = m.coordinates("x_C y_C", "m")
    beta = m.coordinates("beta")
    r, I1, u1, m_link, I_link, m_a, m_b = letters(m)
    F_a, F_b = m.inputs("F_a F_b", "N")
    M = m.inputs("M", "N*m")

    x_a = m.let("x_a", x_C + r * cos(beta), "m")
    y_a = m.let("y_a", y_C + r * sin(beta), "m")
    x_b = m.let("x_b", y_C - r * sin(beta), "m")
    y_b = m.let("y_b", x_C - r * cos(beta), "m")

    m.body("crank", mass=u1 / r, at=(r * cos(alpha), r * sin(alpha)), turns=alpha, inertia_about_axis=I1)
    m.body("link", mass=m_link, at=(x_C, y_C), turns=beta, inertia=I_link)
    m.body("slider_a", mass=m_a, at=(x_a, y_a))
    m.body("slider_b", mass=m_b, at=(y_b, x_b))
    m.force(F_a, along=x_a)
    m.force(F_b, along=x_b)
    m.torque(-M, along=alpha)
    m.constraint("pin_x", x_C - r * cos(alpha))
    m.constraint("pin_y", y_C - r * sin(alpha))
    m.constraint("guide_a", y_a)
    m.constraint("guide_b", y_b)
    output(m, x_a, order=1)
    output(m, x_b, order=1)
    sketch(m, r, alpha)
    return m
