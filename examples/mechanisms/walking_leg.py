from mechsym.derive import Mechanism, output


def walking_leg():
    m = Mechanism("walking_leg", about="Theo Jansen's leg.")
    phi = m.coordinates("phi")
    a, l, b, c, d, e, f, g_, h, i, j, k, r = m.parameters("a l b c d e f g_ h i j k r", "m", above=0)
    rho = m.parameters("rho", "kg", above=0)
    J = m.parameters("J", "kg*m^2", above=0)
    g = m.parameters("g", "m/s^2", default=9.81)
    M = m.inputs("M", "N*m")
    crank = m.link("crank", turns=phi, inertia=J)
    bars = {n: m.link(f"bar_{n}", mass=rho, inertia=J / 10) for n in "jbdekcfghi"}
    m.pin("O", m.frame, crank)
    m.pin("Z", crank.at(r), bars["j"])
    m.pin("Y", m.frame.at(-a, -l), bars["b"])
    m.pin("X", bars["j"].at(j), bars["b"].at(b), branch=-1)
    m.pin("Y1", m.frame.at(-a, -l), bars["d"])
    m.pin("X1", bars["b"].at(b), bars["e"])
    m.pin("W", bars["e"].at(e), bars["d"].at(d), branch=1)
    m.pin("Z1", crank.at(r), bars["k"])
    m.pin("Y2", m.frame.at(-a, -l), bars["c"])
    m.pin("V", bars["k"].at(k), bars["c"].at(c), branch=1)
    m.pin("W1", bars["d"].at(d), bars["f"])
    m.pin("V1", bars["c"].at(c), bars["g"])
    m.pin("U", bars["f"].at(f), bars["g"].at(g_), branch=-1)
    m.pin("U1", bars["f"].at(f), bars["h"])
    m.pin("V2", bars["c"].at(c), bars["i"])
    m.pin("T", bars["h"].at(h), bars["i"].at(i), branch=-1)
    m.weight(0, -g)
    m.torque(M, along=phi)
    m.draw_line(m.frame.at(), crank.at(r), role="crank")
    for n, end in {"j": j, "b": b, "d": d, "e": e, "k": k, "c": c, "f": f, "g": g_, "h": h, "i": i}.items():
        m.draw_line(bars[n].at(), bars[n].at(end), role="rod")
    x = m.let("x_foot", bars["h"].at(h).x, "m")
    output(m, x, order=1)
    return m
