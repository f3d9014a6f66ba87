"""One throw of a crank train: crank, rod with its own inertia, piston on an offset axis, exact.

          y ^         A                            x from the shaft O along the cylinder towards the head, y across,
            |       . ' - .  l1                    phi = 0 where the crank points to the head, positive from x to y.
            |   r . '       C2 .  l2               psi the rod's angle, sin psi = (r sin phi - offset) / l.
            | . ' phi           ' - . psi          offset: the piston pin's path lies at y = offset.
            O                         B ====[] x   Travel x = 0 at top dead centre (sin phi = offset / (r + l)),
            (u0 on the pin's side)                 positive away from the head; F on the piston positive likewise.

mechsym/mechanisms/crank_train.py puts any number of these on an elastic shaft; M is the shaft's torque on the throw.
Rigid links; friction is not in the equations.
"""

from mechsym.derive import Mechanism, cos, output, sin, sqrt


def crank_throw():
    m = Mechanism(
        "crank_throw", source="002_d7297926d6c52225", about="One throw: crank, rod, piston on an offset axis."
    )
    phi = m.coordinates("phi")
    r, l1, l2, offset = m.parameters("r l1 l2 offset", "m")
    m0, m_rod, m_piston = m.parameters("m0 m_rod m_piston", "kg")
    I_rod, I0 = m.parameters("I_rod I0", "kg*m^2")
    u0 = m.parameters("u0", "kg*m")
    g = m.parameters("g", "m/s^2")
    axis_tilt = m.parameters("axis_tilt", "rad")
    F = m.inputs("F", "N")
    M = m.inputs("M", "N*m")
    x_O, y_O = m.joints("x_O y_O", "frame on crank, main bearings")
    x_A, y_A = m.joints("x_A y_A", "crank on rod, crank pin")
    x_B, y_B = m.joints("x_B y_B", "rod on piston, piston pin")
    y_G = m.joints("y_G", "cylinder on piston")

    l = m.let("l", l1 + l2, "m")
    psi = m.angle("psi", sine=(r * sin(phi) - offset + y_O + y_A + y_B - y_G) / l)  # |psi| < pi/2
    height = sqrt((r + l) ** 2 - offset**2)  # of the piston pin at top dead centre
    x = m.let("x", height - r * cos(phi) - l * cos(psi) - x_O - x_A - x_B, "m")

    # the unbalance u0 = mass times radius is put at the crank pin, the rest of m0 on the axis
    m.body("shaft", mass=m0 - u0 / r, at=(x_O, y_O))
    m.body("crank", mass=u0 / r, at=(r * cos(phi) + x_O, r * sin(phi) + y_O), turns=phi, inertia_about_axis=I0)
    m.body(
        "rod",
        mass=m_rod,
        at=(r * cos(phi) + l1 * cos(psi) + x_O + x_A, offset + l2 * sin(psi) + y_G - y_B),
        turns=-psi,
        inertia=I_rod,
    )
    m.body("piston", mass=m_piston, at=(height - x, offset + y_G))
    m.weight(-g * sin(axis_tilt), -g * cos(axis_tilt))
    m.force(F, along=x)
    m.torque(M, along=phi)
    output(m, x, order=2)
    output(m, psi, order=1)
    m.piston("piston", travel=x, force=F, masses=m_piston)
    m.rotor("crank", angle=phi, drive=M, inertia=I0)
    return m
