"""Watt's six-bar linkage: two four-bar loops in a row, the second closed by constraint (its pin is named C and G).

   B ------- C                   crank O-B on the frame at O, coupler B-C with a further point E,
  /  ' E      \\        G         rocker D-C on the frame at D; link E-G and rocker F-G on the frame at F.
 / phi  \\_____ \\ _ _ / |         Both loops close near the guesses in the case.
O               D       F
"""

from mechsym.derive import Mechanism, output


def watt_six_bar():
    m = Mechanism("watt_six_bar", about="Watt's six-bar linkage, loops closed by constraint.")
    phi = m.coordinates("phi")
    theta2, theta4 = m.dependents("theta2 theta4", guess=0.6)
    theta3, theta5 = m.dependents("theta3 theta5", guess=1.8)
    r, l2, l3, l4, l5 = m.parameters("r l2 l3 l4 l5", "m", above=0)
    x_D, y_D, x_F, y_F, u_E, v_E = m.parameters("x_D y_D x_F y_F u_E v_E", "m")
    m2, m3, m4, m5 = m.parameters("m2 m3 m4 m5", "kg", above=0)
    I1, I2, I3, I4, I5 = m.parameters("I1 I2 I3 I4 I5", "kg*m^2", above=0)
    g = m.parameters("g", "m/s^2", default=9.81)
    M = m.inputs("M", "N*m")
    crank = m.link("crank", turns=phi, inertia=I1)
    coupler = m.link("coupler", turns=theta2, mass=m2, centre=(l2 / 2, v_E / 3), inertia=I2)
    rocker = m.link("rocker", turns=theta3, mass=m3, centre=(l3 / 2, 0), inertia=I3)
    link = m.link("link", turns=theta4, mass=m4, centre=(l4 / 2, 0), inertia=I4)
    last = m.link("last", turns=theta5, mass=m5, centre=(l5 / 2, 0), inertia=I5)
    m.pin("O", m.frame, crank)
    m.pin("B", crank.at(r), coupler)
    m.pin("D", m.frame.at(x_D, y_D), rocker)
    m.pin("E", coupler.at(u_E, v_E), link)
    m.pin("F", m.frame.at(x_F, y_F), last)
    m.pin("C", coupler.at(l2), rocker.at(l3))
    m.pin("G", link.at(l4), last.at(l5))
    m.weight(0, -g)
    m.torque(M, along=phi)
    m.rotor("crank", angle=phi, drive=M)
    m.draw_line(m.frame.at(), crank.at(r), role="crank")
    m.draw_line(crank.at(r), coupler.at(l2), coupler.at(u_E, v_E), crank.at(r), role="planet")
    m.draw_line(m.frame.at(x_D, y_D), rocker.at(l3), role="rod")
    m.draw_line(coupler.at(u_E, v_E), link.at(l4), m.frame.at(x_F, y_F), role="rod")
    output(m, m.let("x_E_out", coupler.at(u_E, v_E).x, "m"), m.let("y_E_out", coupler.at(u_E, v_E).y, "m"), order=1)
    return m
