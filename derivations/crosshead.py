"""Crank, rod and crosshead with elastic hinge, exact (Zotov et al. 2024).

          y ^         A
            |       . ' - .  l1                      x from the shaft O towards the head, y across,
            |   r . '       C2 .  l2                 phi = 0 at top dead centre, positive from x to y,
            | . ' phi           ' - . psi            psi the rod's angle, sin psi = lam sin phi.
            O - - - - - - - - - - - - B ====[] x     F on the piston, positive away from the head (towards O).
             \\_ M_h on the crank                     travel x = 0 at top dead centre, positive away from the head.

Rigid links; friction is not in the equations. P_i of the paper are weights m_i g.
"""

from mechsym.derive import Mechanism, Rational, cos, output, sin, sqrt


def crosshead():
    m = Mechanism("crosshead", source="000_9f2b746dc1abd296", about="Crank, rod, crosshead and elastic hinge.")
    phi = m.coordinates("phi")
    r1 = m.parameters("r1", "m", low=0, about="shaft axis to the crank's centre of mass")
    r2 = m.parameters("r2", "m", low=0, about="crank's centre of mass to crank pin")
    l1 = m.parameters("l1", "m", low=0, about="crank pin to the rod's centre of mass")
    l2 = m.parameters("l2", "m", low=0, about="rod's centre of mass to crosshead pin")
    m1 = m.parameters("m1", "kg", low=0, about="mass of the crank")
    m2 = m.parameters("m2", "kg", low=0, about="mass of the rod")
    m3 = m.parameters("m3", "kg", low=0, about="mass of the crosshead")
    m4 = m.parameters("m4", "kg", low=0, about="mass of the piston rod")
    m5 = m.parameters("m5", "kg", low=0, about="mass of the piston")
    I01 = m.parameters("I01", "kg*m^2", above=0, about="inertia of the crank about the shaft axis")
    IC2 = m.parameters("IC2", "kg*m^2", low=0, about="inertia of the rod about its centre of mass")
    g = m.parameters("g", "m/s^2", default=9.81, low=0, about="acceleration of free fall")
    axis_tilt = m.parameters("axis_tilt", "rad", default=0, about="cylinder axis against the horizontal")
    F = m.inputs("F", "N")
    M_r, M_h = m.inputs("M_r M_h", "N*m")
    x_O, y_O = m.joints("x_O y_O", "frame on crank, main bearing")
    x_A, y_A = m.joints("x_A y_A", "crank on rod, crank pin")
    x_B, y_B = m.joints("x_B y_B", "rod on crosshead, crosshead pin")
    y_G = m.joints("y_G", "guide on crosshead")

    r, l = m.let("r", r1 + r2, "m"), m.let("l", l1 + l2, "m")
    m.require(r, above=0, unit="m", what="no crank", way="lengthen r1 or r2")
    m.require(l, above=r, unit="m", what="rod too short", way="lengthen l1 or l2")
    lam = m.let("lam", r / l, "-")
    psi = m.angle("psi", sine=lam * sin(phi) + (y_O + y_A + y_B - y_G) / l)  # closes the loop, |psi| < pi/2
    x = m.let("x", r * (1 - cos(phi)) + l * (1 - cos(psi)) - x_O - x_A - x_B, "m")

    m.body("crank", mass=m1, at=(r1 * cos(phi) + x_O, r1 * sin(phi) + y_O), turns=phi, inertia_about_axis=I01)
    m.body(
        "rod",
        mass=m2,
        at=(r * cos(phi) + l1 * cos(psi) + x_O + x_A, l2 * sin(psi) + y_G - y_B),
        turns=-psi,
        inertia=IC2,
    )
    m.body("crosshead", mass=m3 + m4 + m5, at=(r + l - x, y_G))
    m.weight(-g * sin(axis_tilt), -g * cos(axis_tilt))
    m.force(F, along=x)
    m.torque(M_h - M_r, along=phi)
    output(m, x, order=2)
    output(m, psi, order=1)
    m.piston("crosshead", travel=x, force=F, masses=(m3, m4, m5), stroke=2 * r)
    weight = -g * m1 * r1 * cos(phi + axis_tilt)
    m.rotor("crank", angle=phi, load=M_r, inertia=I01, hinge=M_h, weight=weight, unbalance=m1 * r1)
    m.guide("side_force", reaction="R_y_G", travel=x, at="guides")
    m.bearing("crosshead_pin", reactions=("R_x_B", "R_y_B"), turns=psi, at="piston_pins")
    m.bearing("crank_pin", reactions=("R_x_A", "R_y_A"), turns=(phi, psi), at="crank_pins", throw=r)
    m.bearing("main_bearing", reactions=("R_x_O", "R_y_O"), turns=(phi,), at="main_bearings")
    m.rod(
        "rod", swing=psi, throw=r, length=l, centre=l1, mass=m2, inertia=IC2, moving=m3 + m4 + m5, beyond=m4 + m5,
        unbalance=m1 * r1, gravity=g,
    )  # fmt: skip
    _sketch(m, r, l, phi)
    return m


def _sketch(m, r, l, phi):
    pin = (r * cos(phi), r * sin(phi))
    end = pin[0] + sqrt(l**2 - pin[1] ** 2)
    low, high, half = l - r - Rational(3, 10) * r, l + r + Rational(3, 10) * r, Rational(28, 100) * r
    length = 3 * r  # of the piston rod: drawn, not a parameter
    m.sketch("circle", (0, 0), radius=Rational(16, 100) * r, role="crank")
    m.sketch("line", (0, 0), pin, role="crank")
    m.sketch("line", pin, (end, 0), role="rod")
    m.sketch("line", (low, -half), (high, -half), role="frame")
    m.sketch("line", (low, half), (high, half), role="frame")
    m.sketch(
        "box", (end - Rational(22, 100) * r, -Rational(24, 100) * r), width=Rational(44, 100) * r,
        height=Rational(48, 100) * r, role="piston",
    )  # fmt: skip
    m.sketch("line", (end, 0), (end + length, 0), role="piston")
    m.sketch("circle", pin, radius=Rational(9, 100) * r, role="joint")
    m.sketch("circle", (end, 0), radius=Rational(9, 100) * r, role="joint")
    m.sketch("piston", (end + length, 0), stroke=2 * r)
    m.sketch("cylinder", (l - r + length, 0), stroke=2 * r)
