"""Two planar robots for tests: a five-bar with two motors, a 3-RRR platform with three."""

from mechsym.derive import Mechanism, pi

#: Mass [kg], centre along the link [m], inertia about the centre [kg*m^2] and length [m] of each link of the five-bar
FIVE_BAR = {
    "left": (0.9, 0.11, 0.004, 0.25), "right": (0.8, 0.1, 0.003, 0.22),
    "left_rod": (0.5, 0.16, 0.005, 0.35), "right_rod": (0.6, 0.18, 0.006, 0.37),
}  # fmt: skip
BASE = 0.3  #: distance of the motors of the five-bar [m]
#: The same of the 3-RRR: cranks, rods; the platform's mass and inertia; radii of motors and pins [m]
RRR = {"crank": (0.7, 0.09, 0.003, 0.2), "rod": (0.5, 0.12, 0.004, 0.28)}
PLATFORM, MOTORS, PINS = (1.3, 0.01), 0.4, 0.12
SQUARE = 3**0.5 / 2
SIDE = -1
CORNERS = ((1.0, 0.0), (-0.5, SQUARE), (-0.5, -SQUARE))
CRANK_POSE, ROD_POSE = (249, 9, 129), (138, -102, 18)  # roughly, of the 3-RRR [deg]


def five_bar():
    m = Mechanism("five_bar")
    left, right = m.coordinates("left_turn right_turn")
    torques = m.inputs("M_left M_right", "N*m")
    for torque, along in zip(torques, (left, right), strict=True):
        m.torque(torque, along=along)
    m.weight(0, -m.parameters("g", "m/s^2"))
    turns = {"left": left, "right": right}
    links = {
        name: m.link(
            name, mass=mass, centre=(centre, 0), inertia=inertia, **({"turns": turns[name]} if name in turns else {})
        )
        for name, (mass, centre, inertia, _) in FIVE_BAR.items()
    }
    m.pose(left_turn="120 deg", right_turn="60 deg", left_rod="50 deg", right_rod="130 deg")
    m.pin("O", m.frame, links["left"])
    m.pin("Q", m.frame.at(BASE), links["right"])
    m.pin("A", links["left"].at(FIVE_BAR["left"][3]), links["left_rod"])
    m.pin("B", links["right"].at(FIVE_BAR["right"][3]), links["right_rod"])
    m.pin("P", links["left_rod"].at(FIVE_BAR["left_rod"][3]), links["right_rod"].at(FIVE_BAR["right_rod"][3]))
    m.watch(links["left_rod"].at(FIVE_BAR["left_rod"][3]), "tip")
    return m


def three_rrr():
    """Joints M1..M3 on the frame, A1..A3 between crank and rod, P1..P3 at the platform."""
    m = Mechanism("three_rrr")
    turns = m.coordinates("q_1 q_2 q_3")
    for number, turn in enumerate(turns, 1):
        m.torque(m.inputs(f"M_{number}", "N*m"), along=turn)
    m.weight(0, -m.parameters("g", "m/s^2"))
    parts = {}
    for number, turn in enumerate(turns, 1):
        for kind, more in (
            ("crank", {"turns": turn}),
            ("rod", {} if number == 2 else {"guess": pi * ROD_POSE[number - 1] / 180}),
        ):
            mass, centre, inertia, _ = RRR[kind]
            parts[kind, number] = m.link(f"{kind}{number}", mass=mass, centre=(centre, 0), inertia=inertia, **more)
    mass, inertia = PLATFORM
    platform = m.link("platform", mass=mass, inertia=inertia)
    for number, (x, y) in enumerate(CORNERS, 1):
        crank, rod = parts["crank", number], parts["rod", number]
        m.pin(f"M{number}", m.frame.at(MOTORS * x, MOTORS * y), crank)
        m.pin(f"A{number}", crank.at(RRR["crank"][3]), rod)
        m.pin(
            f"P{number}",
            rod.at(RRR["rod"][3]),
            platform.at(PINS * x, PINS * y),
            **({"branch": SIDE} if number == 2 else {}),
        )
    m.watch(platform.at(0, 0), "tip")
    return m
