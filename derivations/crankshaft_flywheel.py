"""Crankshaft and flywheel on a torsional spring, one slider crank, exact (Chmielewski et al. 2015, equations 1 to 8).

    M -> [I0, phi0] --k1, c1-- [I2, phi2]        x0 = 0 at phi0 = 0 (top dead centre), positive away from the head,
            r \\_ l  _ [m0] -> x0 <- F            F the gas force on the piston, positive away from the head.

Massless rod, no gravity, no friction; c1 (torsional damping) is 0 in the paper. The rod force is positive in tension.
"""

from mechsym.derive import Mechanism, Rational, acceleration, cos, output, output_dynamic, sin


def letters(m):
    """Numbers of the shaft and its slider crank, and what they are for."""
    I0 = m.parameters("I0", "kg*m^2", above=0, about="inertia of the crankshaft")
    I2 = m.parameters("I2", "kg*m^2", above=0, about="inertia of the flywheel")
    r = m.parameters("r", "m", above=0, about="crank radius")
    l = m.parameters("l", "m", above=0, about="rod length")
    m0 = m.parameters("m0", "kg", low=0, about="reciprocating mass")
    k1 = m.parameters("k1", "N*m/rad", low=0, about="torsional stiffness")
    c1 = m.parameters("c1", "N*m*s/rad", default=0, low=0, about="torsional damping")
    m.require(l, above=r, unit="m", what="rod too short", way="lengthen l")
    m.shaft("shaft", discs=(I0, I2), stiffness=k1, damping=c1, masses=m0)
    m.rod("rod", throw=r, length=l, moving=m0)
    return I0, I2, r, l, m0, k1, c1


def crankshaft_flywheel():
    m = Mechanism("crankshaft_flywheel", source="002_d7297926d6c52225", about="Crankshaft and flywheel, exact.")
    phi0, phi2 = m.coordinates("phi0 phi2")
    I0, I2, r, l, m0, k1, c1 = letters(m)
    M = m.inputs("M", "N*m")
    F = m.inputs("F", "N")

    lam = m.let("lam", r / l, "-")  # (5)
    gamma0 = m.angle("gamma0", sine=lam * sin(phi0))  # (4)
    x0 = m.let("x0", r * (1 - cos(phi0)) + l * (1 - cos(gamma0)), "m")  # (8)
    twist = m.let("twist", phi0 - phi2, "rad")

    m.body("crank", turns=phi0, inertia=I0)
    m.body("flywheel", turns=phi2, inertia=I2)
    m.body("piston", mass=m0, at=(-x0, 0))
    m.spring(k1, stretch=twist)
    m.damper(c1, stretch=twist)
    m.torque(M, along=phi0)
    m.force(F, along=x0)
    output(m, x0, order=2)
    output(m, gamma0)
    output_dynamic(m, "rod_force", (m0 * acceleration(m, x0) - F) / cos(gamma0), "N")  # (3) with gas force
    sketch(m, r, l, phi0)
    return m


def sketch(m, r, l, phi0):
    """The flywheel behind the crank, rod, piston."""
    m.sketch("circle", (0, 0), radius=Rational(3, 2) * r, role="flywheel")
    m.sketch("slider_crank", r=r, l=l, offset=0, angle=phi0)
