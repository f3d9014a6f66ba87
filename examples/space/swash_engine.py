r"""Swash-plate engine: three pistons along the shaft rest by balls on a plate that stands slanting on it.

      |\    <- plate, its normal tilted against the shaft        F_k away from the head, along -z
   ===|=\=====[ piston k ]| head        z along the shaft, pistons in a ring of the radius R about it
      |  \

Everything is in space: the plate's push has a part across the shaft, which bends piston and bearing.
"""

from mechsym.derive import Mechanism, cos, pi, sin, tan


def swash_engine():
    m = Mechanism("swash_engine", space=3, about="Swash-plate engine with three cylinders.")
    phi = m.coordinates("phi")
    R, offset = m.parameters("R offset", "m", above=0)  # of the cylinders' ring; from the bearing to the plate
    tilt = m.parameters("tilt", "rad", above=0, below=0.8)
    m_p, m_plate = m.parameters("m_p m_plate", "kg", above=0)
    I, A, C = m.parameters("I A C", "kg*m^2", above=0)  # shaft about its axis; plate across and along its normal
    M_r = m.inputs("M_r", "N*m")
    shaft, plate = m.link("shaft", inertia=I), m.link("plate", mass=m_plate, inertia=(A, A, C))
    m.revolute("A", m.frame, shaft, axis="z", turns=phi)
    normal = shaft.axis((-sin(tilt), 0, cos(tilt)), at=(0, 0, offset))
    m.fixed("B", normal, plate.axis("z"))
    for k, F in enumerate(m.inputs("F1 F2 F3", "N"), 1):
        place = 2 * pi * (k - 1) / 3
        piston = m.link(f"piston{k}", mass=m_p)
        guide = m.prismatic(f"G{k}", m.frame.at(R * cos(place), R * sin(place), offset), piston, axis="z")
        m.plane(f"S{k}", plate.axis("z"), piston)
        x = m.let(f"x{k}", R * tan(tilt) - guide.slide, "m")
        m.force(F, along=x)
        m.piston(f"p{k}", travel=x, force=F, stroke=2 * R * tan(tilt))
        m.draw_drum(piston.axis("z"), R / 3, R / 2)
    m.torque(-M_r, along=phi)
    m.rotor("shaft", angle=phi, load=M_r)
    m.bearing("main_bearing", reactions=("R_x_A", "R_y_A"), turns=phi, at="main_bearings")
    m.draw_drum(plate.axis("-z"), 4 * R / 3, R / 8, role="planet")
    m.draw_drum(shaft.axis("z", at=(0, 0, -R)), R / 6, R + offset, role="flywheel")
    return m
