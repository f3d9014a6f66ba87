"""Crankshaft and flywheel exactly as equation (6) with (11) and (2) print it (Chmielewski et al. 2015).

The transmission in (6) is exact, the piston's acceleration (11) is truncated: the model is the Lagrange equation of
neither kinematics, so it is declared by its equations and has no energies. The trailing "= 0" of (6) is a misprint.
"""

from mechsym.derivations.crankshaft_flywheel import letters, sketch

from mechsym.derive import Mechanism, Rational, cos, given_equations, output, sin, sqrt, velocities


def crankshaft_flywheel_printed():
    m = Mechanism(
        "crankshaft_flywheel_printed", source="002_d7297926d6c52225", about="Crankshaft and flywheel, as (6) prints it."
    )
    phi0, phi2 = m.coordinates("phi0 phi2")
    I0, I2, r, l, m0, k1, c1 = letters(m)
    M = m.inputs("M", "N*m")
    phi0d, phi2d = velocities(m)

    lam = m.let("lam", r / l, "-")
    s, c = sin(phi0), cos(phi0)
    transmission = m.let("transmission", s + lam * s * c / sqrt(1 - lam**2 * s**2), "-")  # bracket of (6)
    x0 = m.let("x0", r * ((1 - c) + lam / 4 * (1 - cos(2 * phi0))), "m")  # (9)
    slope = m.let("slope", r * (s + lam / 2 * sin(2 * phi0)), "m")  # (10)
    curvature = m.let("curvature", r * (c + lam * cos(2 * phi0)), "m")  # (11)
    shaft = m.let("shaft", k1 * (phi0 - phi2) + c1 * (phi0d - phi2d), "N*m")

    given_equations(
        m,
        mass_matrix=[[I0 + transmission * r * m0 * slope, Rational(0)], [Rational(0), I2]],
        bias=[transmission * r * m0 * curvature * phi0d**2, Rational(0)],
        force=[M - shaft, shaft],
    )
    output(m, x0)
    sketch(m, r, l, phi0)
    return m
