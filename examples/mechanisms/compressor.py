"""Reciprocating compressor: a slider crank whose cylinder axis passes the shaft at the offset e.

  .-A                             x from the shaft towards the head, phi = 0 with the crank along it; the travel is
 r   ` - . l                      measured from the outermost point that rod and crank can reach. The gas force F
O          ` - . P [] ==| head    comes from the p-V cycle of the case, the motor's torque against -M_r.
- - - - - - - - - - - - - -> x
"""

from mechsym.derive import Mechanism, sqrt


def compressor():
    m = Mechanism("compressor", about="Reciprocating compressor with an offset cylinder.")
    phi = m.coordinates("phi")
    r, l, e = *m.parameters("r l", "m", above=0), m.parameters("e", "m", low=0)
    m_rod, m_piston = m.parameters("m_rod m_piston", "kg", low=0)
    I, I_rod = m.parameters("I I_rod", "kg*m^2", above=0)
    F, M_r = m.inputs("F", "N"), m.inputs("M_r", "N*m")
    crank = m.link("crank", turns=phi, inertia=I)
    rod = m.link("rod", mass=m_rod, centre=(l / 3, 0), inertia=I_rod)
    piston = m.link("piston", mass=m_piston)
    m.pin("O", m.frame, crank)
    m.pin("A", crank.at(r), rod)
    m.slider("G", m.frame.line(0, e), piston)
    m.pin("P", rod.at(l), piston)
    x = m.let("x", sqrt((r + l) ** 2 - e**2) - piston.at().x, "m")
    m.force(F, along=x)
    m.torque(-M_r, along=phi)
    m.piston("piston", travel=x, force=F)
    m.rotor("crank", angle=phi, load=M_r)
    m.draw_circle((0, 0), r / 4, role="frame")
    m.draw_line((0, 0), crank.at(r), role="crank")
    m.draw_line(crank.at(r), rod.at(l), role="rod")
    m.draw_box(piston.at(r / 2), r, 3 * r / 2, role="piston")
    return m
