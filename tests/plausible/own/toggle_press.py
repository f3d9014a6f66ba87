"""Toggle press: a crank and its rod straighten two toggle links, the lower one pushes the slide down.

D (frame, fixed)         O-A crank, A-B rod; D-B upper and B-C lower toggle link; C slide along the vertical through D.
 \\ upper                 A counterbalance spring and the guide's film act on the slide.
  B ------- A - O
 / lower
C [slide]
"""

from mechsym.derive import Mechanism, output, pi


def toggle_press():
    m = Mechanism("toggle_press", about="Toggle press.")
    alpha = m.coordinates("alpha")
    r, q, a, b, d, h = m.parameters("r q a b d h", "m", above=0)
    w_rod, w_upper, w_lower, w_slide = m.parameters("w_rod w_upper w_lower w_slide", "kg", low=0)
    J, J_rod, J_upper, J_lower = m.parameters("J J_rod J_upper J_lower", "kg*m^2", above=0)
    k, c = m.parameters("k", "N/m", default=0), m.parameters("c", "N*s/m", default=0)
    g = m.parameters("g", "m/s^2", default=9.81)
    M, P = m.inputs("M", "N*m"), m.inputs("P", "N")
    crank = m.link("crank", turns=alpha, inertia=J)
    rod = m.link("rod", mass=w_rod, centre=(q / 2, 0), inertia=J_rod)
    upper = m.link("upper", mass=w_upper, centre=(a / 2, 0), inertia=J_upper)
    lower = m.link("lower", mass=w_lower, centre=(b / 2, 0), inertia=J_lower)
    slide = m.link("slide", mass=w_slide)
    m.pin("O", m.frame.at(d, -h), crank)
    m.pin("A", crank.at(r), rod)
    m.pin("D", m.frame, upper)
    m.pin("B", rod.at(q), upper.at(a), branch=1)
    m.pin("K", upper.at(a), lower)
    m.slider("G", m.frame.line(angle=-pi / 2), slide)
    m.pin("C", lower.at(b), slide)
    m.weight(0, -g)
    s = m.let("s", -slide.at().y, "m")
    m.force(-P, along=s)
    m.spring(k, stretch=s)
    m.damper(c, stretch=s)
    m.torque(M, along=alpha)
    m.rotor("crank", angle=alpha, drive=M)
    m.draw_line(m.frame.at(d, -h), crank.at(r), upper.at(a), role="rod")
    m.draw_line((0, 0), upper.at(a), lower.at(b), role="planet")
    output(m, s, order=2)
    return m
