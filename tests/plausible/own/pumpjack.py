"""Pumping unit of an oil well: a crank and its pitman rock a beam, the rod string hangs on the beam's other end.

E--tail--S---head---H      S saddle bearing on the post; O-A crank with its counterweight, A-E pitman;
|        |          |      H horse head; the well pulls the string down with the force P.
A - O  (post)     string
"""

from mechsym.derive import Mechanism, output


def pumpjack():
    m = Mechanism("pumpjack", about="Pumping unit of an oil well.")
    phi = m.coordinates("phi")
    r, q, tail, head, d, h, u = m.parameters("r q tail head d h u", "m", above=0)
    m_counter, m_pitman, m_beam, m_string = m.parameters("m_counter m_pitman m_beam m_string", "kg", low=0)
    J, J_pitman, J_beam = m.parameters("J J_pitman J_beam", "kg*m^2", above=0)
    g = m.parameters("g", "m/s^2", default=9.81)
    M, P = m.inputs("M", "N*m"), m.inputs("P", "N")
    crank = m.link("crank", turns=phi, mass=m_counter, centre=(u, 0), inertia=J)
    pitman = m.link("pitman", mass=m_pitman, centre=(q / 2, 0), inertia=J_pitman)
    beam = m.link("beam", mass=m_beam, centre=(0, 0), inertia=J_beam)
    m.pin("O", m.frame, crank)
    m.pin("A", crank.at(r), pitman)
    m.pin("S", m.frame.at(d, h), beam)
    m.pin("E", pitman.at(q), beam.at(-tail), branch=1)
    m.body("string", mass=m_string, at=(beam.at(head).x, beam.at(head).y))
    m.weight(0, -g)
    y = m.let("y", beam.at(head).y, "m")
    m.force(-P, along=y)
    m.torque(M, along=phi)
    m.rotor("crank", angle=phi, drive=M)
    m.draw_line((0, 0), crank.at(r), pitman.at(q), beam.at(head), role="rod")
    output(m, y, order=2)
    return m
