"""Mechanisms in space and their numbers, as the own code of spatial.py has them: poses in closed form."""

from pathlib import Path

import numpy as np
from spatial import EYE, GROUND, Body, Machine, about, prismatic, revolute, spherical, universal
from spatial import Joint as Rows

FILE = str(Path(__file__).parents[1] / "examples/space/spatial_linkages.py")
G = (0, 0, -9.81)


def rssr(phi, phid, p):
    crank, rocker = Body(0.0, (0, 0, p["I1"])), Body(p["m3"], [p["I3"]] * 3)
    rod = Body(p["m2"], (p["J2"], p["I2"], p["I2"]))
    crank.R = about((0, 0, 1), phi)
    X, Y = p["d"] - p["a"] * np.cos(phi), p["h"] - p["a"] * np.sin(phi)
    rocker.R = about((1, 0, 0), np.arcsin((p["c"] ** 2 + X**2 + Y**2 - p["b"] ** 2) / (2 * Y * p["c"])))
    rocker.r = np.array([p["d"], p["h"], 0]) + rocker.R @ [0, 0, p["c"] / 2]
    B, C = crank.R @ [p["a"], 0, 0], rocker.r + rocker.R @ [0, 0, p["c"] / 2]
    # the pose that the pin B allows: its axis along z of the crank and y of the rod
    x = (C - B) / np.linalg.norm(C - B)
    y = np.cross(crank.R[:, 2], x)
    y /= np.linalg.norm(y)
    rod.R = np.column_stack([x, -y, np.cross(x, -y)])
    rod.r = (B + C) / 2
    half = [p["b"] / 2, 0, 0]
    joints = [
        revolute("A", GROUND, crank, (0, 0, 0), (0, 0, 0), EYE[2], EYE[2]),
        revolute("D", GROUND, rocker, (p["d"], p["h"], 0), (0, 0, -p["c"] / 2), EYE[0], EYE[0]),
        universal("B", crank, rod, (p["a"], 0, 0), np.negative(half), EYE[2], EYE[1]),
        spherical("C", rod, rocker, half, (0, 0, p["c"] / 2)),
    ]
    machine = Machine([crank, rod, rocker], joints, G).close().move([0, 0, 0, 0, 0, phid])
    return machine, [(crank, np.zeros(3), np.array([0, 0, p["M"]]), (0, 0, 0))]


def rssp(phi, phid, p):
    crank, piston = Body(0.0, [p["I"]] * 3), Body(p["m_p"], (1e-9, 1e-9, 1e-9))
    rod = Body(p["m_r"], (p["I_r"], p["I_r"], p["J_r"]))
    crank.R = about((1, 0, 0), phi)
    B = crank.R @ [0, 0, p["r"]]
    z = B[2] + np.sqrt(p["l"] ** 2 - B[1] ** 2 - p["e"] ** 2)
    C = np.array([p["e"], 0, z])
    piston.r = C
    line = (C - B) / p["l"]
    y = np.cross(line, crank.R[:, 0])
    y /= np.linalg.norm(y)
    rod.R, rod.r = np.column_stack([np.cross(y, line), y, line]), (B + C) / 2
    half = (0, 0, p["l"] / 2)
    joints = [
        revolute("A", GROUND, crank, (0, 0, 0), (0, 0, 0), EYE[0], EYE[0]),
        universal("B", crank, rod, (0, 0, p["r"]), np.negative(half), EYE[0], EYE[1]),
        prismatic("P", GROUND, piston, (p["e"], 0, 0), (0, 0, 0), EYE[2]),
        spherical("C", rod, piston, half, (0, 0, 0)),
    ]
    machine = Machine([crank, rod, piston], joints).close().move([0, 0, 0, phid, 0, 0])
    loads = [(piston, np.array([0, 0, -p["F"]]), np.zeros(3), (0, 0, 0))]
    return machine, [*loads, (crank, np.zeros(3), np.array([-p["M_r"], 0, 0]), (0, 0, 0))]


def hooke(phi, phid, p):
    one, two = Body(0.0, (0, 0, p["I1"])), Body(0.0, [p["I2"]] * 3)
    one.R = about((0, 0, 1), phi)
    d = np.array([np.sin(p["beta"]), 0, np.cos(p["beta"])])
    # x of the one and y of the other are square to one another
    y = np.cross(d, one.R[:, 0])
    y /= np.linalg.norm(y)
    two.R = np.column_stack([np.cross(y, d), y, d])
    zero = (0, 0, 0)
    joints = [
        revolute("A", GROUND, one, zero, zero, EYE[2], EYE[2]),
        revolute("B", GROUND, two, zero, zero, d, EYE[2]),
        universal("U", one, two, zero, zero, EYE[0], EYE[1]),
    ]
    machine = Machine([one, two], joints).close().move([0, 0, 0, 0, 0, phid])
    return machine, [(one, np.zeros(3), np.array([0, 0, p["M"]]), zero), (two, np.zeros(3), -p["L"] * d, zero)]


def wobble(phi, phid, p):
    shaft, plate = Body(0.0, (0, 0, p["I"])), Body(p["m_w"], (p["A"], p["A"], p["C"]))
    rod, piston = Body(p["m_p"] / 4, (p["J"], p["J"], p["J"] / 9)), Body(p["m_p"], [1e-9] * 3)
    shaft.R = about((0, 0, 1), phi)
    d = shaft.R @ [np.sin(p["tilt"]), 0, np.cos(p["tilt"])]
    y = np.cross(d, EYE[0])
    y /= np.linalg.norm(y)  # so that the plate's point (0, -s, 0) has no x
    plate.R = np.column_stack([np.cross(y, d), y, d])
    P = plate.R @ [p["R"], 0, 0]
    z = P[2] + np.sqrt(p["l"] ** 2 - (P[0] - p["R"]) ** 2 - P[1] ** 2)
    D = np.array([p["R"], 0, z])
    piston.r = D
    line = (D - P) / p["l"]
    e = np.cross(line, plate.R[:, 0])
    e /= np.linalg.norm(e)
    rod.R, rod.r = np.column_stack([np.cross(e, line), e, line]), (P + D) / 2
    zero, half = (0, 0, 0), (0, 0, p["l"] / 2)
    tilted = (np.sin(p["tilt"]), 0, np.cos(p["tilt"]))
    joints = [
        revolute("A", GROUND, shaft, zero, zero, EYE[2], EYE[2]),
        revolute("B", shaft, plate, zero, zero, tilted, EYE[2]),
        Rows("G", GROUND, plate, zero, (0, -p["s"], 0), [("plane", EYE[0])]),
        prismatic("P", GROUND, piston, (p["R"], 0, 0), zero, EYE[2]),
        universal("C", plate, rod, (p["R"], 0, 0), np.negative(half), EYE[0], EYE[1]),
        spherical("D", rod, piston, half, zero),
    ]
    machine = Machine([shaft, plate, rod, piston], joints).close().move([0, 0, 0, 0, 0, phid])
    loads = [(piston, np.array([0, 0, -p["F"]]), np.zeros(3), zero)]
    return machine, [*loads, (shaft, np.zeros(3), np.array([0, 0, p["M"]]), zero)]


def pump(phi, phid, p):
    barrel, zero, tip = Body(0.0, (0, 0, p["I"])), (0, 0, 0), (0, 0, -p["l"])
    barrel.R = about((0, 0, 1), phi)
    joints, bodies, loads = [revolute("A", GROUND, barrel, zero, zero, EYE[2], EYE[2])], [barrel], []
    for k in range(3):
        bore = p["R"] * about((0, 0, 1), 2 * np.pi * k / 3)[:, 0]
        piston = Body(p["m_p"], (p["A"], p["A"], p["C"]), R=barrel.R)
        shoe = barrel.R @ bore
        shoe[2] = np.tan(p["tilt"]) * shoe[0]
        piston.r = shoe + [0, 0, p["l"]]
        joints.append(prismatic(f"G{k + 1}", barrel, piston, bore, tip, EYE[2]))
        normal = [-np.sin(p["tilt"]), 0, np.cos(p["tilt"])]
        joints.append(Rows(f"S{k + 1}", GROUND, piston, zero, tip, [("plane", normal)]))
        bodies.append(piston)
        pressed = np.array([0, 0, p[f"F{k + 1}"]])  # between piston and barrel, whose bottom bears it
        loads += [(piston, -pressed, np.zeros(3), zero), (barrel, pressed, np.zeros(3), bore)]
    machine = Machine(bodies, joints).close().move([0, 0, 0, 0, 0, phid])
    return machine, [*loads, (barrel, np.zeros(3), np.array([0, 0, p["M"]]), zero)]


def door(phi, phid, p):
    leaf = Body(p["mass"], (p["Ix"], p["Iy"], p["Iz"]))
    leaf.R = about((0, 0, 1), phi)
    leaf.r = leaf.R @ [p["w"] / 2, 0, p["h"] / 2]
    joints = [
        revolute("lower", GROUND, leaf, (0, 0, 0), (-p["w"] / 2, 0, -p["h"] / 2), EYE[2], EYE[2]),
        revolute("upper", GROUND, leaf, (0, 0, p["h"]), (-p["w"] / 2, 0, p["h"] / 2), EYE[2], EYE[2]),
    ]
    g = 9.81 * np.array([np.sin(p["tilt"]), 0, -np.cos(p["tilt"])])
    return Machine([leaf], joints, g).close().move([*np.cross([0, 0, phid], leaf.r), 0, 0, phid]), []


NUMBERS = {
    "rssr": (
        rssr,
        dict(a=0.1, b=0.5, c=0.32, d=0.35, h=0.2, m2=0.8, m3=0.6, I1=0.02, I2=0.013, J2=3e-4, I3=0.006, M=1.7),
    ),
    "rssp": (rssp, dict(r=0.08, l=0.4, e=0.07, m_p=0.9, m_r=0.5, I=0.02, I_r=0.006, J_r=2e-4, F=300.0, M_r=4.0)),
    "hooke": (hooke, dict(beta=0.6, I1=0.03, I2=0.05, M=2.0, L=0.7)),
    "wobble": (
        wobble,
        dict(tilt=0.35, R=0.06, l=0.1, s=0.07, I=0.01, A=0.002, C=0.003, m_p=0.4, m_w=0.9, J=2e-4, F=150.0, M=3.0),
    ),
    "pump": (
        pump,
        dict(tilt=0.3, R=0.04, m_p=0.15, l=0.02, I=0.003, A=5e-5, C=1e-5, F1=800.0, F2=150.0, F3=900.0, M=6.0),
    ),
    "door": (door, dict(w=0.9, h=2.0, mass=25.0, Ix=8.0, Iy=10.0, Iz=2.0, tilt=0.05)),
}  # fmt: skip
