"""Crank, rod and crosshead with elastic hinge, exact (Zotov et al. 2024).

          y ^         A
            |       . ' - .  l1                      x from the shaft O towards the head, y across,
            |   r . '       C2 .  l2                 phi = 0 at top dead centre, positive from x to y,
            | . ' phi           ' - . psi            psi the rod's angle, sin psi = lam sin phi.
            O - - - - - - - - - - - - B ====[] x     F on the piston, positive away from the head (towards O).
             \\_ M_h on the crank                     travel x = 0 at top dead centre, positive away from the head.

Rigid links; friction is not in the equations. P_i of the paper are weights m_i g.
"""

from mechsym.derive import Mechanism, cos, output, sin


def crosshead():
    m = Mechanism("crosshead", source="000_9f2b746dc1abd296", about="Crank, rod, crosshead and elastic hinge.")
    phi = m.coordinates("phi")
    r1, r2, l1, l2 = m.parameters("r1 r2 l1 l2", "m")
    m1, m2, m3, m4, m5 = m.parameters("m1 m2 m3 m4 m5", "kg")
    I01, IC2 = m.parameters("I01 IC2", "kg*m^2")
    g = m.parameters("g", "m/s^2")
    axis_tilt = m.parameters("axis_tilt", "rad")
    F = m.inputs("F", "N")
    M_r, M_h = m.inputs("M_r M_h", "N*m")
    x_O, y_O = m.joints("x_O y_O", "frame on crank, main bearing")
    x_A, y_A = m.joints("x_A y_A", "crank on rod, crank pin")
    x_B, y_B = m.joints("x_B y_B", "rod on crosshead, crosshead pin")
    y_G = m.joints("y_G", "guide on crosshead")

    r, l = m.let("r", r1 + r2, "m"), m.let("l", l1 + l2, "m")
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
    m.piston("crosshead", travel=x, force=F, masses=(m3, m4, m5))
    m.rotor("crank", angle=phi, load=M_r, inertia=I01)
    return m
