"""The linkage and the platform of space.py in Exudyn, body by body: `pip install exudyn`.

Bodies move by Euler parameters, joints are rows on them, the step is implicit. Each machine starts in the pose and at
the speeds of ours; accelerations are those that Exudyn solves for at the start, at which the two are compared.
"""

import time
from dataclasses import dataclass

import exudyn as exu
import exudyn.itemInterface as item
import numpy as np
from exudyn.utilities import RigidBodyInertia

X, Y, Z = np.eye(3)
ALIKE = np.eye(3)
TURNS, UNIVERSAL, SLIDES, SPHERE = [1, 1, 1, 1, 1, 0], [1, 1, 1, 1, 0, 0], [1, 1, 0, 1, 1, 1], [1, 1, 1, 0, 0, 0]


def about(axis, angle):
    """Rotation matrix about a unit vector."""
    x, y, z = axis
    K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * K @ K


def frame(**columns):
    """A rotation matrix of which one or two columns are given, by their names."""
    known = {n: np.asarray(c, dtype=float) for n, c in columns.items()}
    if len(known) == 1:
        ((name, axis),) = known.items()
        other = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
        known["xyz"[("xyz".index(name) + 1) % 3]] = other / np.linalg.norm(other)
    (missing,) = set("xyz") - set(known)
    k = "xyz".index(missing)
    known[missing] = np.cross(known["xyz"[(k + 1) % 3]], known["xyz"[(k + 2) % 3]])
    return np.column_stack([known[n] for n in "xyz"])


@dataclass
class Body:
    """Where a body starts: its index, rotation, place and angular velocity."""

    number: int
    R: np.ndarray
    r: np.ndarray
    w: np.ndarray
    v: np.ndarray


class Machine:
    """A system of bodies that is made, run and read."""

    def __init__(self, g):
        self.container = exu.SystemContainer()  # must outlive its system
        self.mbs = self.container.AddSystem()
        self.g = [0, 0, -g]
        zero = np.zeros(3)
        self.ground = Body(self.mbs.CreateGround(), np.eye(3), zero, zero, zero)

    def body(self, mass, inertia, R, r, w, v):
        """Add a body by its centre of mass."""
        whole = RigidBodyInertia(mass=mass, inertiaTensor=np.diag(inertia))
        number = self.mbs.CreateRigidBody(
            inertia=whole, referencePosition=r, referenceRotationMatrix=R, initialVelocity=v,
            initialAngularVelocity=w, gravity=self.g,
        )  # fmt: skip
        return Body(number, R, r, w, v)

    def marker(self, body, at):
        """A point of a body, to which joints and loads are fastened."""
        return self.mbs.AddMarker(item.MarkerBodyRigid(bodyNumber=body.number, localPosition=list(at)))

    def joint(self, holds, first, second, at, on, frames=(ALIKE, ALIKE)):
        """Join two points; `holds` says which ways and turns of the first frame are held."""
        markers = [self.marker(first, at), self.marker(second, on)]
        self.mbs.AddObject(
            item.GenericJoint(
                markerNumbers=markers, constrainedAxes=holds, rotationMarker0=frames[0], rotationMarker1=frames[1]
            )
        )

    def push(self, body, force, at=(0, 0, 0)):
        """A force on a point of a body, along the body's axes."""
        self.mbs.AddLoad(item.Force(markerNumber=self.marker(body, at), loadVector=list(force), bodyFixed=True))

    def solve(self, t_end, step, order=3):
        """Run it by the generalised alpha method, constraints in positions (3) or velocities (2); returns seconds."""
        settings = exu.SimulationSettings()
        run = settings.timeIntegration
        run.numberOfSteps, run.endTime, run.verboseMode = max(round(t_end / step), 1), t_end, 0
        run.newton.useModifiedNewton = True
        run.generalizedAlpha.computeInitialAccelerations = True
        settings.linearSolverType = exu.LinearSolverType.EigenSparse
        settings.solution.file.write = False
        kind = exu.DynamicSolverType.GeneralizedAlpha if order == 3 else exu.DynamicSolverType.TrapezoidalIndex2
        start = time.process_time()
        self.mbs.SolveDynamic(settings, solverType=kind, updateInitialValues=True)
        return time.process_time() - start

    @property
    def states(self):
        """Coordinates and speeds of all bodies."""
        return 2 * len(self.mbs.systemData.GetODE2Coordinates())

    def energy(self, p, bodies):
        """Kinetic and potential energy of crank, rod and rocker of the RSSR [J]."""
        total = 0.0
        rows = zip(
            bodies, (1.0, p["m2"], p["m3"]), ([p["I1"]] * 3, [p["J2"], p["I2"], p["I2"]], [p["I3"]] * 3), strict=True
        )
        for body, mass, inertia in rows:
            v, w = self.read(body, "Velocity"), self.read(body, "AngularVelocityLocal")
            height = self.read(body, "Position")[2]
            total += mass * (v @ v / 2 + p["g"] * height) + w * inertia @ w / 2
        return total

    def read(self, body, what, at=(0, 0, 0)):
        """A quantity of a point of a body."""
        return np.asarray(self.mbs.GetObjectOutputBody(body.number, getattr(exu.OutputVariableType, what), list(at)))


def linkage(p, q, qd):
    """The RSSR by its coordinates phi, turn_D, turn1_B, turn2_B and their rates."""
    machine, zero = Machine(p["g"]), np.zeros(3)
    a, b, c = p["a"], p["b"], p["c"]
    A, D = about(Z, q["phi"]), about(X, q["turn_D"])
    R1 = A @ about(Z, q["turn1_B"])
    B = R1 @ about(Y, q["turn2_B"])
    wa, wd = qd["phi"] * Z, qd["turn_D"] * X
    wb = wa + qd["turn1_B"] * Z + R1 @ Y * qd["turn2_B"]
    at, foot = A @ [a, 0, 0], np.array([p["d"], p["h"], 0])
    half, up = B @ [b / 2, 0, 0], D @ [0, 0, c / 2]
    crank = machine.body(1.0, [p["I1"]] * 3, A, zero, wa, zero)
    rod = machine.body(p["m2"], [p["J2"], p["I2"], p["I2"]], B, at + half, wb, np.cross(wa, at) + np.cross(wb, half))
    rocker = machine.body(p["m3"], [p["I3"]] * 3, D, foot + up, wd, np.cross(wd, up))
    ground = machine.ground
    machine.joint(TURNS, ground, crank, zero, zero)
    machine.joint(TURNS, ground, rocker, foot, (0, 0, -c / 2), (frame(z=X), frame(z=X)))
    machine.joint(UNIVERSAL, crank, rod, (a, 0, 0), (-b / 2, 0, 0), (frame(y=Z), frame(z=Y)))
    machine.joint(SPHERE, rod, rocker, (b / 2, 0, 0), (0, 0, c / 2))
    machine.mbs.Assemble()
    return machine, crank, rod, rocker


def platform(p, q, qd, forces, feet):
    """The Stewart platform by the places and turns of its plate and legs; feet: its joints below and on the plate."""
    machine, half = Machine(p["g"]), p["half"]
    e = np.array([q[f"e{k}_P"] for k in range(4)])
    ed = np.array([qd[f"e{k}_P"] for k in range(4)])
    angle, size = 2 * np.arctan2(np.linalg.norm(e[1:]), e[0]), np.linalg.norm(e[1:])
    R = about(e[1:] / size, angle)
    w = 2 * (e[0] * ed[1:] - ed[0] * e[1:] - np.cross(e[1:], ed[1:]))  # in the plate's axes
    place, speed = ([v[f"{n}_P"] for n in "xyz"] for v in (q, qd))
    plate = machine.body(p["plate_mass"], p["I"] * np.array([1, 1, 2]), R, place, R @ w, speed)
    inertia = [p["A"], p["A"], p["C"]]
    for k, ((foot, head), force) in enumerate(zip(feet, forces, strict=True), 1):
        R1 = about(X, q[f"turn1_U{k}"])
        L = R1 @ about(Y, q[f"turn2_U{k}"])
        w = qd[f"turn1_U{k}"] * X + R1 @ Y * qd[f"turn2_U{k}"]
        low, high = L @ [0, 0, half], L @ [0, 0, q[f"slide_L{k}"] - half]
        below = machine.body(p["low"], inertia, L, foot + low, w, np.cross(w, low))
        way = L @ Z * qd[f"slide_L{k}"]
        above = machine.body(p["up"], inertia, L, foot + high, w, np.cross(w, high) + way)
        machine.joint(UNIVERSAL, machine.ground, below, foot, (0, 0, -half), (frame(y=X), frame(z=Y)))
        machine.joint(SLIDES, below, above, (0, 0, 0), (0, 0, 0))
        machine.joint(SPHERE, above, plate, (0, 0, half), head)
        machine.push(above, (0, 0, force))
        machine.push(below, (0, 0, -force))
    machine.mbs.Assemble()
    return machine, plate
