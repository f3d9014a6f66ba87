"""A gyroscope on a point: it precesses by psi, leans by theta, spins by phi; free on a quaternion in `top`."""

from mechsym.derive import Mechanism


def _wheel(m):
    mass, l = m.parameters("mass", "kg", above=0), m.parameters("l", "m")
    A, C = m.parameters("A C", "kg*m^2", above=0)  # about the centre, across and along the axis
    m.weight(0, 0, -m.parameters("g", "m/s^2", default=9.81))
    return m.link("wheel", mass=mass, centre=(0, 0, l), inertia=(A, A, C))


def gyroscope():
    m = Mechanism("gyroscope", space=3, about="A gyroscope by its angles; upright it has a pole.")
    angles = m.coordinates("psi theta phi")
    wheel = _wheel(m)
    m.spherical("O", m.frame, wheel, sequence="zxz", turns=angles)
    m.watch(wheel.at(0, 0, wheel.centre[2]), "tip")
    return m


def top():
    m = Mechanism("top", space=3, about="The same by a quaternion, which has no pole.")
    wheel = _wheel(m)
    m.spherical("O", m.frame, wheel)
    m.watch(wheel.at(0, 0, wheel.centre[2]), "tip")
    return m


def tumbling():
    m = Mechanism("tumbling", space=3, about="A body that nothing holds.")
    mass, I = m.parameters("mass", "kg", above=0), m.parameters("I1 I2 I3", "kg*m^2", above=0)
    m.free("P", m.link("box", mass=mass, inertia=I))
    return m


def screw():
    m = Mechanism("screw", space=3, about="A nut that its weight drives down a screw.")
    phi = m.coordinates("phi")
    mass, I = m.parameters("mass", "kg", above=0), m.parameters("I", "kg*m^2", above=0)
    nut = m.link("nut", mass=mass, inertia=(I, I, I))
    m.screw("S", m.frame, nut, axis="z", lead=m.parameters("lead", "m"), turns=phi)
    m.weight(0, 0, -m.parameters("g", "m/s^2", default=9.81))
    return m


def pendulum():
    m = Mechanism("pendulum", space=3, about="A pendulum on a universal joint.")
    angles = m.coordinates("alpha beta")
    mass, l = m.parameters("mass", "kg", above=0), m.parameters("l", "m", above=0)
    A, C = m.parameters("A C", "kg*m^2", above=0)
    bob = m.link("bob", mass=mass, centre=(0, 0, -l), inertia=(A, A, C))
    m.universal("U", m.frame.axis("x"), bob.axis("y"), turns=angles)
    m.weight(0, 0, -m.parameters("g", "m/s^2", default=9.81))
    return m
