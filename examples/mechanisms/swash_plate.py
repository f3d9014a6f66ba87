"""Swash-plate compressor: three pistons in a ring, moved by a plate that stands slanting on the shaft.

    ___ /   x1        Its motion is in space: the plate, tilted by the angle tilt, turns with the shaft and has at the
   |___/    x2        ring's radius R the height R tan(tilt) cos. That is written down here, x_k positive away from the
==== /====  x3        head; pistons only slide along the shaft, so their masses have one velocity and the formulas of
   |/__               the plane apply. Reactions R_1.. are the plate's axial push; across it a piston takes side_k.
"""

from mechsym.derive import Mechanism, cos, output_dynamic, pi, reaction, tan


def swash_plate():
    m = Mechanism("swash_plate", about="Swash-plate compressor with three pistons.")
    phi = m.coordinates("phi")
    R = m.parameters("R", "m", above=0)
    tilt = m.parameters("tilt", "rad", above=0, below=0.8)
    m_p = m.parameters("m_p", "kg", above=0)
    I = m.parameters("I", "kg*m^2", above=0)
    forces, M_r = m.inputs("F1 F2 F3", "N"), m.inputs("M_r", "N*m")
    ends = []
    gaps = m.joints("s_1 s_2 s_3", "plate on piston, along the shaft", "N", "R_1 R_2 R_3")
    m.body("shaft", inertia=I, turns=phi)
    for k, (F, s) in enumerate(zip(forces, gaps, strict=True), 1):
        place = 2 * pi * (k - 1) / 3
        x = m.let(f"x{k}", R * tan(tilt) * (1 - cos(phi - place)), "m")
        m.body(f"piston{k}", mass=m_p, at=(x + s, R * (k - 2)))
        m.force(F, along=x + s)
        m.piston(f"p{k}", travel=x, force=F)
        m.draw_box((x, R * (k - 2)), R / 2, R / 2, role="piston")
        m.draw_line((x + R / 4, R * (k - 2)), (x + R, R * (k - 2)), role="rod")
        ends.append((x + R, R * (k - 2)))
        output_dynamic(m, f"side{k}", reaction(m, s) * tan(tilt), "N")
    m.draw_line(*ends, role="crank")
    m.torque(-M_r, along=phi)
    m.rotor("shaft", angle=phi, load=M_r)
    return m
