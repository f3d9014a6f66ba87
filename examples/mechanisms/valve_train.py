from mechsym.derive import Mechanism


def valve_train():
    """A valve under a bucket tappet, held on its cam: forces tell when it could not stay there."""
    return _train("valve_train")


def valve_float():
    """The same with a tappet that may fly: a coordinate of its own, and events in runs."""
    return _train("valve_float", restitution="0.3")


def _train(name, **flight):
    m = Mechanism(name, about="A valve on a cam with a flat tappet.")
    phi = m.coordinates("phi")
    mass, I = m.parameters("mass", "kg", above=0), m.parameters("I", "kg*m^2", above=0)
    k, F0 = m.parameters("k", "N/m", above=0), m.parameters("F0", "N", low=0)
    M = m.inputs("M", "N*m")
    m.body("camshaft", inertia=I, turns=phi)
    m.torque(M, along=phi)
    cam = m.cam("cam", turns=phi, profile="valve-lift.csv", base="22 mm", follower="flat", **flight)
    m.body("valve", mass=mass, at=(0, cam.lift))
    m.spring(k, stretch=cam.lift + F0 / k)
    return m
