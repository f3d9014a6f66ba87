"""Quarter of a car on a road of one wave: body on spring and damper, wheel on its tyre, both vertical from their rest.

[ body m_b  z ]
   k_s   c_s
[ wheel m_w u ]
   k_t            road: h sin(2 pi v t / wave), v the speed of the car
"""

from mechsym.derive import Mechanism, output, pi, sin


def suspension():
    m = Mechanism("suspension", about="Quarter of a car.")
    s, z, u = m.coordinates("s", "m"), m.coordinates("z", "m"), m.coordinates("u", "m")
    m_b, m_w, m_x = m.parameters("m_b m_w m_x", "kg", above=0)
    k_s, k_t = m.parameters("k_s k_t", "N/m", above=0)
    c_s = m.parameters("c_s", "N*s/m", low=0)
    h, wave = m.parameters("h wave", "m", above=0)
    road = m.let("road", h * sin(2 * pi * s / wave), "m")
    m.body("sled", mass=m_x, at=(s, 0))
    m.body("chassis", mass=m_b, at=(s, z))
    m.body("wheel", mass=m_w, at=(s, u))
    m.spring(k_s, stretch=z - u)
    m.damper(c_s, stretch=z - u)
    m.spring(k_t, stretch=u - road)
    output(m, z, order=2)
    return m
