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

from mechsym.derive import Abs, Mechanism, acceleration, cos, output, output_dynamic, reaction, sin, tan


def hypocycloid():
    m = Mechanism("hypocycloid", source="004_e00ef50339108dab", about="Crank, planet of half the ring's size, piston.")
    theta = m.coordinates("theta")
    e = m.parameters("e", "m")
    I1 = m.parameters("I1", "kg*m^2")
    u1 = m.parameters("u1", "kg*m")
    m2 = m.parameters("m2", "kg")
    I2 = m.parameters("I2", "kg*m^2")
    m3 = m.parameters("m3", "kg")
    alpha_n = m.parameters("alpha_n", "rad")
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
    m.piston("piston", travel=x, force=F, masses=m3, loads="tooth_force")
    m.rotor("crank", angle=theta, load=M, inertia=I1)
    output_dynamic(m, "piston_torque", (F - m3 * acceleration(m, x)) * m.tape.diff(x, theta), "N*m")
    return m
