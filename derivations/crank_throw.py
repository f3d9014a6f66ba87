"""One throw of a crank train: crank, rod with its own inertia, piston on an offset axis, exact.

          y ^         A                            x from the shaft O along the cylinder towards the head, y across,
            |       . ' - .  l1                    phi = 0 where the crank points to the head, positive from x to y.
            |   r . '       C2 .  l2               psi the rod's angle, sin psi = (r sin phi - offset) / l.
            | . ' phi           ' - . psi          offset: the piston pin's path lies at y = offset.
            O                         B ====[] x   Travel x = 0 at top dead centre (sin phi = offset / (r + l)),
            (u0 on the pin's side)                 positive away from the head; F on the piston positive likewise.

mechsym/mechanisms/crank_train puts any number of these on an elastic shaft; M is the shaft's torque on the throw.
Rigid links; friction is not in the equations.
"""

from mechsym.derive import Abs, Mechanism, cos, output, sin, sqrt


def crank_throw():
    m = Mechanism(
        "crank_throw", source="002_d7297926d6c52225", about="One throw: crank, rod, piston on an offset axis."
    )
    phi = m.coordinates("phi")
    r = m.parameters("r", "m", above=0, about="crank radius")
    l1 = m.parameters("l1", "m", low=0, about="crank pin to the rod's centre of mass")
    l2 = m.parameters("l2", "m", low=0, about="rod's centre of mass to piston pin")
    offset = m.parameters("offset", "m", default=0, about="offset of the cylinder axis")
    m0 = m.parameters("m0", "kg", default=0, low=0, about="mass of the crank")
    m_rod = m.parameters("m_rod", "kg", low=0, about="mass of the rod")
    m_piston = m.parameters("m_piston", "kg", low=0, about="mass of the piston")
    I_rod = m.parameters("I_rod", "kg*m^2", low=0, about="inertia of the rod about its centre of mass")
    I0 = m.parameters("I0", "kg*m^2", above=0, about="inertia of the crank about the shaft axis")
    u0 = m.parameters("u0", "kg*m", default=0, about="unbalance of the crank on the pin's side")
    g = m.parameters("g", "m/s^2", default=0, low=0, about="acceleration of free fall")
    axis_tilt = m.parameters("axis_tilt", "rad", default=0, about="cylinder axis against the horizontal")
    F = m.inputs("F", "N")
    M = m.inputs("M", "N*m")
    x_O, y_O = m.joints("x_O y_O", "frame on crank, main bearings")
    x_A, y_A = m.joints("x_A y_A", "crank on rod, crank pin")
    x_B, y_B = m.joints("x_B y_B", "rod on piston, piston pin")
    y_G = m.joints("y_G", "cylinder on piston")

    l = m.let("l", l1 + l2, "m")
    m.require(l, above=r + Abs(offset), unit="m", what="rod too short", way="lengthen l1 or l2")
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
    m.piston("piston", travel=x, force=F, masses=m_piston, stroke=2 * r)
    m.rotor("crank", angle=phi, drive=M, inertia=I0, weight=-g * u0 * cos(phi + axis_tilt), unbalance=u0)
    m.guide("side_force", reaction="R_y_G", travel=x, at="guides")
    m.bearing("piston_pin", reactions=("R_x_B", "R_y_B"), turns=psi, at="piston_pins")
    m.bearing("crank_pin", reactions=("R_x_A", "R_y_A"), turns=(phi, psi), at="crank_pins", throw=r)
    m.bearing("main_bearing", reactions=("R_x_O", "R_y_O"), turns=(phi,), at="main_bearings")
    m.rod(
        "rod", swing=psi, throw=r, length=l, centre=l1, mass=m_rod, inertia=I_rod, moving=m_piston, unbalance=u0,
        gravity=g,
    )  # fmt: skip
    m.sketch("slider_crank", r=r, l=l, offset=offset, angle=phi)
    return m
