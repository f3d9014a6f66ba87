"""Beam compressor: a walking beam between crank and piston, as Newcomen and Watt had it, the other way round.

E ------- D ------- B     O-A crank, A-B rod, B-D-E beam on the frame at D; at E a link down to the piston, whose
|   beam            |     axis is vertical through the beam's end at its middle position.
P [] head below     A-O
"""

from mechsym.derive import Mechanism, pi


def beam_compressor():
    m = Mechanism("beam_compressor", about="Compressor with a walking beam.")
    phi = m.coordinates("phi")
    t, n, u, v, y, s = m.parameters("t n u v y s", "m", above=0)
    G_rod, G_beam, G_piston = m.parameters("G_rod G_beam G_piston", "kg", low=0)
    T_crank, T_rod, T_beam = m.parameters("T_crank T_rod T_beam", "kg*m^2", above=0)
    F, Q = m.inputs("F", "N"), m.inputs("Q", "N*m")
    crank = m.link("crank", turns=phi, inertia=T_crank)
    rod = m.link("rod", mass=G_rod, centre=(n / 2, 0), inertia=T_rod)
    beam = m.link("beam", mass=G_beam, inertia=T_beam)
    link, piston = m.link("link"), m.link("piston", mass=G_piston)
    m.pin("O", m.frame.at(u, -y), crank)
    m.pin("A", crank.at(t), rod)
    m.pin("D", m.frame, beam)
    m.pin("B", rod.at(n), beam.at(u), branch=-1)
    m.pin("E", beam.at(-v), link)
    m.slider("G", m.frame.line(-v, 0, angle=-pi / 2), piston)
    m.pin("P", link.at(s), piston)
    x = m.let("x", s + t * v / u + piston.at().y, "m")
    m.force(F, along=x)
    m.torque(-Q, along=phi)
    m.piston("piston", travel=x, force=F)
    m.rotor("crank", angle=phi, load=Q)
    m.draw_line(m.frame.at(u, -y), crank.at(t), beam.at(u), beam.at(-v), link.at(s), role="rod")
    return m
