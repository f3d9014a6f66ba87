"""Geared hypocycloid: a planet of half the ring's radius drives the rod along a straight line (Nunes 2017).

          y ^      T                               x from the shaft O towards the head, y across,
            |    /                                 theta = 0 at top dead centre, positive from x to y.
            |  C . e                               O-C crank throw e = pitch radius of the planet; ring radius 2 e,
            | / e  ' .  -theta                     T their pitch point. The planet's angle is -theta, so its pin P
            O - - - - - P - - - ====[] x           stays on the axis: travel x = 2 e (1 - cos theta).
             \\_ M (load, opposing)                 F on the piston, positive away from the head (towards O).

Rigid links, no friction, no gravity. The mechanism is overconstrained by one: a side force of the piston and the tooth
force can balance each other without work. Assumed here: no side force on the piston (its rod is not guided), so the
pin force lies on the axis. The tooth force is positive in the sense of rotation of the crank, on the planet; the
flanks press the planet towards O with tan(alpha_n) of its size.
"""

from mechsym.derive import Abs, Mechanism, Rational, acceleration, cos, output, output_dynamic, pi, reaction, sin, tan


def hypocycloid():
    m = Mechanism("hypocycloid", source="004_e00ef50339108dab", about="Crank, planet of half the ring's size, piston.")
    theta = m.coordinates("theta")
    e = m.parameters("e", "m", above=0, about="crank throw, pitch radius of the planet")
    I1 = m.parameters("I1", "kg*m^2", above=0, about="inertia of crank and shaft about the axis")
    u1 = m.parameters("u1", "kg*m", default=0, about="unbalance of crank and shaft on the throw's side")
    m2 = m.parameters("m2", "kg", low=0, about="mass at the planet's centre")
    I2 = m.parameters("I2", "kg*m^2", low=0, about="inertia of the planet about its centre")
    m3 = m.parameters("m3", "kg", low=0, about="reciprocating mass")
    alpha_n = m.parameters("alpha_n", "rad", low=0, below=pi / 2, about="pressure angle of the gears")
    F = m.inputs("F", "N")
    M = m.inputs("M", "N*m")
    s_T = m.joints("s_T", "ring on planet, tangential", reactions="tooth_force")
    x_C, y_C = m.joints("x_C y_C", "crank on planet, journal", reactions="journal_force_x journal_force_y")
    x_O, y_O = m.joints("x_O y_O", "frame on crank", reactions="main_bearing_force_x main_bearing_force_y")
    x_P = m.joints("x_P", "planet on rod, pin", reactions="pin_force")

    s, c = sin(theta), cos(theta)
    dx, dy = x_O + x_C, y_O + y_C  # displacement of the planet's centre
    roll = m.let("roll", (s_T + dx * s - dy * c) / e, "rad")  # turn that keeps the teeth together at T
    radial = m.let("radial", dx * c + dy * s, "m")
    x = m.let("x", 2 * e * (1 - c) - dx - e * s * roll - x_P, "m")

    # only the product u1 = mass times radius enters, so the unbalance is put at the throw
    m.body("crank", mass=u1 / e, at=(e * c + x_O, e * s + y_O), turns=theta, inertia_about_axis=I1)
    m.body("planet", mass=m2, at=(e * c + dx, e * s + dy), turns=roll - theta, inertia=I2)
    m.body("piston", mass=m3, at=(2 * e - x, 0))
    m.force(F, along=x)
    m.torque(-M, along=theta)
    separating = Abs(reaction(m, s_T)) * tan(alpha_n)
    m.force(-separating, along=radial)
    output(m, x, order=2)
    output_dynamic(m, "tooth_force_radial", separating, "N")
    m.piston("piston", travel=x, force=F, masses=m3, loads="tooth_force", stroke=4 * e)
    m.part("planet", inertia=I2, mass=m2, length=e)
    m.rotor("crank", angle=theta, load=M, inertia=I1, unbalance=u1)
    # the planet turns at -theta: against the rod once, in the crank twice, against the ring once
    m.guide("side_force", reaction=None, travel=x, at="guides")
    m.bearing("piston_pin", reactions=("pin_force",), turns=(theta,), at="piston_pins")
    m.bearing(
        "crank_pin", reactions=("journal_force_x", "journal_force_y"), turns=(theta, theta), at="crank_pins", throw=e
    )
    m.teeth("teeth", force="tooth_force", radius=e, turns=(theta,), planet=m2, flank=alpha_n)
    m.bearing(
        "main_bearing", reactions=("main_bearing_force_x", "main_bearing_force_y"), turns=(theta,), at="main_bearings"
    )
    _sketch(m, e, theta)
    output_dynamic(m, "piston_torque", (F - m3 * acceleration(m, x)) * m.tape.diff(x, theta), "N*m")
    return m


def _sketch(m, e, theta):
    centre, pin, length = (e * cos(theta), e * sin(theta)), 2 * e * cos(theta), 5 * e  # the rod's length is drawn only
    m.sketch("circle", (0, 0), radius=2 * e, role="frame")
    m.sketch("circle", centre, radius=e, role="planet")
    m.sketch("line", (0, 0), centre, role="crank")
    m.sketch("circle", (0, 0), radius=Rational(14, 100) * e, role="crank")
    m.sketch("line", centre, (pin, 0), role="planet")
    m.sketch("line", (pin, 0), (pin + length, 0), role="rod")
    m.sketch("circle", centre, radius=e / 10, role="joint")
    m.sketch("circle", (pin, 0), radius=e / 10, role="joint")
    m.sketch("piston", (pin + length, 0), stroke=4 * e)
    m.sketch("cylinder", (length - 2 * e, 0), stroke=4 * e)
