"""Mechanisms with cams, for the tests of their geometry, forces and flights."""

from mechsym.derive import Mechanism

LAW = {"lift": "12 mm", "rise": "100 deg", "dwell": "40 deg", "fall": "90 deg", "phase": "20 deg"}
SLIDES = {
    "knife": {"follower": "knife", "base": "30 mm", "offset": "4 mm"},
    "roller": {"follower": "roller", "base": "30 mm", "roller": "8 mm", "offset": "-5 mm"},
    "flat": {"follower": "flat", "base": "30 mm"},
}
SWINGS = {
    "knife": {"follower": "knife", "base": "30 mm", "arm": "70 mm", "centres": "80 mm"},
    "roller": {"follower": "roller", "base": "30 mm", "roller": "8 mm", "arm": "70 mm", "centres": "80 mm"},
    "flat": {"follower": "flat", "base": "30 mm", "centres": "80 mm", "face": "3 mm"},
}
TURNED = {"lift": "9 deg", "rise": "100 deg", "dwell": "40 deg", "fall": "90 deg", "phase": "20 deg"}


def slide(profile="cycloid", kind="roller", **more):
    """A follower of 0.2 kg on a spring, lifted by a cam on a shaft."""
    m = Mechanism(f"slide_{kind}")
    phi = m.coordinates("phi")
    M = m.inputs("M", "N*m")
    m.torque(M, along=phi)
    m.body("shaft", inertia="0.01 kg*m^2", turns=phi)
    cam = m.cam("cam", turns=phi, profile=profile, **SLIDES[kind], **({} if profile.endswith("csv") else LAW), **more)
    m.body("tappet", mass="0.2 kg", at=(0, cam.lift))
    m.spring("5e4 N/m", stretch=cam.lift + m.parameters("s0", "m", default="8 mm"))
    return m


def swing(profile="cycloid", kind="roller", **more):
    """A rocker of 0.001 kg m^2 on a torsion spring, swung by a cam."""
    m = Mechanism(f"swing_{kind}")
    phi = m.coordinates("phi")
    M = m.inputs("M", "N*m")
    m.torque(M, along=phi)
    m.body("shaft", inertia="0.01 kg*m^2", turns=phi)
    cam = m.cam(
        "cam", turns=phi, profile=profile, **SWINGS[kind], **({} if profile.endswith("csv") else TURNED), **more
    )
    m.body("rocker", inertia="0.001 kg*m^2", turns=-cam.lift)
    m.spring("80 N*m/rad", stretch=cam.lift + m.parameters("s0", "rad", default="10 deg"))
    return m


def harmonic(restitution=None):
    """y = e (1 - cos phi) under a flat face, on a shaft whose speed nothing changes."""
    m = Mechanism("harmonic_free" if restitution is not None else "harmonic")
    phi = m.coordinates("phi")
    m.body("shaft", inertia=m.parameters("I", "kg*m^2"), turns=phi)
    m1, k = m.parameters("m1", "kg", above=0), m.parameters("k", "N/m")
    F0, e = m.parameters("F0", "N"), m.parameters("e", "m", above=0)
    cam = m.cam("cam", turns=phi, profile="harmonic", lift=2 * e, rise="180 deg", fall="180 deg", base="30 mm",
                follower="flat", restitution=restitution)  # fmt: skip
    m.body("tappet", mass=m1, at=(0, cam.lift))
    m.spring(k, stretch=cam.lift)
    m.force(-F0, along=cam.lift)
    return m


def harmonic_free():
    return harmonic(restitution=0)
