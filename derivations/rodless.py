"""Connecting-rod-less (Balandin) mechanism: a link A-C-B on a crank, two sliders at right angles (Prymak).

          y ^                                      x along axis a, y along axis b, alpha = 0 with slider A outermost,
            B (slider b, X_b along x)              positive from x to y.
            |  . link, -alpha                      O-C crank r; A-C and C-B are r long, so A stays on x and B on y:
            |     C                                x_a = 2 r cos(alpha), x_b = 2 r sin(alpha).
            |   . r   .                            F_a, F_b on the sliders, positive outwards; M load, opposing.
            O - - - - - - A (slider a, X_a along y) - - x

Rigid links, no friction, no gravity. The mechanism is overconstrained by one: a radial pin force S on the link with
X_a = -S sin(alpha), X_b = -S cos(alpha) is in balance and does no work. Only what S does not change is derived here;
X_a, X_b and the pin force need a closing rule (mechsym/mechanisms/closing.py), and rodless_constraints.py gives the
rank. Each joint displacement below is therefore one that S does no work on.
"""

from mechsym.derive import Mechanism, Rational, acceleration, cos, output, pi, reaction, sin, sqrt


def letters(m):
    """Crank radius, inertias, masses: what the other declaration of this mechanism takes too."""
    return (
        m.parameters("r", "m", above=0, about="crank radius"),
        m.parameters("I1", "kg*m^2", above=0, about="inertia of the crank about the shaft axis"),
        m.parameters("u1", "kg*m", default=0, about="unbalance of the crank on the pin's side"),
        m.parameters("m_link", "kg", low=0, about="mass of the link"),
        m.parameters("I_link", "kg*m^2", low=0, about="inertia of the link about its middle"),
        m.parameters("m_a", "kg", low=0, about="reciprocating mass on axis a"),
        m.parameters("m_b", "kg", low=0, about="reciprocating mass on axis b"),
    )


def rodless():
    m = Mechanism("rodless", source="003_8746f5f4ad51b1d1", about="Crank, link and two sliders at right angles.")
    alpha = m.coordinates("alpha")
    r, I1, u1, m_link, I_link, m_a, m_b = letters(m)
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
    m.rotor("crank", angle=alpha, load=M, inertia=I1, unbalance=u1)

    tangential, y, x = reaction(m, t), reaction(m, d_y), reaction(m, d_x)
    S, X_a, X_b = m.closing("pin_force_radial", X_a=(y - tangential * c, -s), X_b=(x + tangential * s, -c))
    pin_x = m.closed("pin_force_x", S * c - tangential * s)
    pin_y = m.closed("pin_force_y", S * s + tangential * c)
    m.closed("pin_force", sqrt(pin_x**2 + pin_y**2))
    m.closed("journal_force_a_along", m_a * acceleration(m, x_a) - F_a)
    m.closed("journal_force_a_across", -X_a)
    m.closed("journal_force_b_along", m_b * acceleration(m, x_b) - F_b)
    m.closed("journal_force_b_across", -X_b)
    # the crank pin moves half as far as the sliders
    m.closed("main_bearing_force_x", pin_x + u1 / r / 2 * acceleration(m, x_a))
    m.closed("main_bearing_force_y", pin_y + u1 / r / 2 * acceleration(m, x_b))

    # the link turns at -alpha: against the sliders once, on the crank pin twice
    m.guide("side_force_a", reaction="X_a", travel=x_a, at="guides")
    m.guide("side_force_b", reaction="X_b", travel=x_b, at="guides", way=0)
    for axis, ways in (("a", ()), ("b", (pi / 2, 0))):
        across = (f"journal_force_{axis}_along", f"journal_force_{axis}_across")
        m.bearing(f"journal_{axis}", reactions=across, turns=(alpha,), at="piston_pins", ways=ways)
    m.bearing("crank_pin", reactions=("pin_force_x", "pin_force_y"), turns=(alpha, alpha), at="crank_pins", throw=r)
    m.bearing(
        "main_bearing", reactions=("main_bearing_force_x", "main_bearing_force_y"), turns=(alpha,), at="main_bearings"
    )
    m.face("a+", travel=x_a, force=F_a, sense=-1, closes=0, masses=m_a, stroke=4 * r)
    m.face("b+", travel=x_b, force=F_b, sense=-1, closes=pi / 2, masses=m_b, stroke=4 * r)
    m.face("a-", travel=x_a, force=F_a, sense=1, closes=pi, masses=m_a, stroke=4 * r)
    m.face("b-", travel=x_b, force=F_b, sense=1, closes=3 * pi / 2, masses=m_b, stroke=4 * r)
    m.part("link", inertia=I_link, mass=m_link, length=2 * r)
    sketch(m, r, alpha)
    m.alike("hypocycloid", e=r, I1=I1, m2=0, I2=0, m3=m_a, alpha_n=0)
    return m


def sketch(m, r, alpha):
    """Four cylinders, two rods with the link between them, the crank; reach of the rods: drawn, not a parameter."""
    reach, a, b, middle = 6 * r, 2 * r * cos(alpha), 2 * r * sin(alpha), (r * cos(alpha), r * sin(alpha))
    for sign in (-1, 1):
        for along, at in ((0 if sign > 0 else pi, a), (sign * pi / 2, b)):
            m.sketch("cylinder", (reach - 2 * r, 0), stroke=4 * r, turned=along)
            m.sketch("piston", (reach + sign * at, 0), stroke=4 * r, turned=along)
    m.sketch("line", (a - reach, 0), (a + reach, 0), role="rod")
    m.sketch("line", (0, b - reach), (0, b + reach), role="rod")
    m.sketch("line", (a, 0), (0, b), role="planet")
    m.sketch("line", (0, 0), middle, role="crank")
    m.sketch("circle", (0, 0), radius=Rational(14, 100) * r, role="crank")
    for point in (middle, (a, 0), (0, b)):
        m.sketch("circle", point, radius=r / 10, role="joint")
