"""An own code of mechanisms in space: six coordinates a body, [M J'; J 0], joints as points, angles and planes.

It shares nothing with mechsym: every body has its centre and its rotation, every joint takes rows of twists, a pose is
closed by Newton's method on all bodies, and reactions are the multipliers; where J lacks rank the null space of J' says
which of them are determined.
"""

import numpy as np
import scipy.linalg

EYE = np.eye(3)


def hat(v):
    return np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])


def about(axis, angle):
    axis = np.asarray(axis, float) / np.linalg.norm(axis)
    return scipy.linalg.expm(hat(axis) * angle)


class Body:
    def __init__(self, mass, inertia, r=(0, 0, 0), R=EYE):
        self.mass, self.inertia = mass, np.asarray(inertia, float)
        if self.inertia.ndim == 1:
            self.inertia = np.diag(self.inertia)
        self.r, self.R = np.array(r, float), np.array(R, float)
        self.v, self.w = np.zeros(3), np.zeros(3)


GROUND = Body(np.inf, (1, 1, 1))


class Joint:
    """Rows between two bodies; a, b: points from the centres, in own axes."""

    def __init__(self, name, one, two, a=(0, 0, 0), b=(0, 0, 0), rows=()):
        self.name, self.one, self.two = name, one, two
        self.a, self.b = np.array(a, float), np.array(b, float)
        self.rows = list(rows)

    def states(self):
        for body, at in ((self.one, self.a), (self.two, self.b)):
            arm = body.R @ at
            yield body, arm, body.r + arm, body.v + np.cross(body.w, arm), np.cross(body.w, np.cross(body.w, arm))

    def equations(self):
        """For each row: gap, (v1, w1, v2, w2) coefficients, bias."""
        (o, arm1, P1, V1, A1), (t, arm2, P2, V2, A2) = self.states()
        for kind, *what in self.rows:
            if kind == "meet":
                e = np.asarray(what[0], float)
                yield e @ (P2 - P1), (-e, -np.cross(arm1, e), e, np.cross(arm2, e)), e @ (A2 - A1)
            elif kind == "plane":
                n = o.R @ np.asarray(what[0], float)
                D, Dd = P2 - P1, V2 - V1
                nd, ndd = np.cross(o.w, n), np.cross(o.w, np.cross(o.w, n))
                bias = ndd @ D + 2 * nd @ Dd + n @ (A2 - A1)
                yield n @ D, (-n, -np.cross(arm1, n) + np.cross(n, D), n, np.cross(arm2, n)), bias
            elif kind == "square":
                u, w = o.R @ np.asarray(what[0], float), t.R @ np.asarray(what[1], float)
                ud, wd = np.cross(o.w, u), np.cross(t.w, w)
                bias = np.cross(o.w, ud) @ w + 2 * ud @ wd + u @ np.cross(t.w, wd)
                zero = np.zeros(3)
                yield u @ w, (zero, np.cross(u, w), zero, np.cross(w, u)), bias


def normals(d):
    u, _, _ = np.linalg.svd(np.asarray(d, float).reshape(3, 1))
    return u[:, 1], u[:, 2]


def meet():
    return [("meet", e) for e in EYE]


def revolute(name, one, two, a, b, d1, d2):
    return Joint(name, one, two, a, b, [*meet(), *(("square", n, d2) for n in normals(d1))])


def prismatic(name, one, two, a, b, d):
    turns = [("square", EYE[0], EYE[1]), ("square", EYE[1], EYE[2]), ("square", EYE[2], EYE[0])]
    return Joint(name, one, two, a, b, [*(("plane", n) for n in normals(d)), *turns])


def universal(name, one, two, a, b, d1, d2):
    return Joint(name, one, two, a, b, [*meet(), ("square", d1, d2)])


def spherical(name, one, two, a, b):
    return Joint(name, one, two, a, b, meet())


class Machine:
    def __init__(self, bodies, joints, gravity=(0, 0, 0), driver=0):
        self.bodies, self.joints, self.g, self.driver = bodies, joints, np.array(gravity, float), driver

    def system(self):
        n = 6 * len(self.bodies)
        index = {id(b): 6 * i for i, b in enumerate(self.bodies)}
        gaps, J, bias, owner = [], [], [], []
        for joint in self.joints:
            for gap, (v1, w1, v2, w2), b in joint.equations():
                row = np.zeros(n)
                for body, v, w in ((joint.one, v1, w1), (joint.two, v2, w2)):
                    if body is not GROUND:
                        i = index[id(body)]
                        row[i : i + 3] += v
                        row[i + 3 : i + 6] += w
                gaps.append(gap), J.append(row), bias.append(b), owner.append(joint)
        return np.array(gaps), np.array(J), np.array(bias), owner

    def close(self):
        """Close the loops with the driver's pose as it is."""
        held = [i for i in range(6 * len(self.bodies)) if i // 6 != self.driver]
        for _ in range(50):
            gaps, J, _, _ = self.system()
            step = np.zeros(6 * len(self.bodies))
            step[held] = -np.linalg.lstsq(J[:, held], gaps, rcond=1e-10)[0]
            step *= min(1.0, 0.3 / max(np.abs(step).max(), 1e-300))
            for i, body in enumerate(self.bodies):
                body.r += step[6 * i : 6 * i + 3]
                turn = step[6 * i + 3 : 6 * i + 6]
                body.R = scipy.linalg.expm(hat(turn)) @ body.R
            if np.abs(step).max() < 1e-15:
                break
        assert np.abs(self.system()[0]).max() < 1e-13
        return self

    def move(self, twist):
        """Velocities of all from the driver's (v, w)."""
        _, J, _, _ = self.system()
        held = [i for i in range(6 * len(self.bodies)) if i // 6 != self.driver]
        here = [i for i in range(6 * len(self.bodies)) if i // 6 == self.driver]
        speeds = np.zeros(6 * len(self.bodies))
        speeds[here] = twist
        speeds[held] = -np.linalg.lstsq(J[:, held], J[:, here] @ speeds[here], rcond=1e-10)[0]
        assert np.abs(J @ speeds).max() < 1e-11 * np.abs(speeds).max()
        for i, body in enumerate(self.bodies):
            body.v, body.w = speeds[6 * i : 6 * i + 3], speeds[6 * i + 3 : 6 * i + 6]
        return self

    def solve(self, loads=()):
        """Accelerations (n, 6), reactions by joint (force, moment on the second at its point), and what is open.

        loads: (body, force, moment, arm in own axes).
        """
        n = len(self.bodies)
        M, f = np.zeros((6 * n, 6 * n)), np.zeros(6 * n)
        for i, b in enumerate(self.bodies):
            I = b.R @ b.inertia @ b.R.T
            M[6 * i : 6 * i + 3, 6 * i : 6 * i + 3] = b.mass * EYE
            M[6 * i + 3 : 6 * i + 6, 6 * i + 3 : 6 * i + 6] = I
            f[6 * i : 6 * i + 3] = b.mass * self.g
            f[6 * i + 3 : 6 * i + 6] = -np.cross(b.w, I @ b.w)
        for body, force, moment, arm in loads:
            if body is GROUND:
                continue
            i = 6 * self.bodies.index(body)
            f[i : i + 3] += force
            f[i + 3 : i + 6] += moment + np.cross(body.R @ np.asarray(arm, float), force)
        _, J, bias, owner = self.system()
        k = len(J)
        whole = np.block([[M, J.T], [J, np.zeros((k, k))]])
        x = np.linalg.lstsq(whole, np.concatenate([f, -bias]), rcond=1e-12)[0]
        lam, null = -x[6 * n :], scipy.linalg.null_space(J.T, rcond=1e-9)
        reactions, open_ = {}, {}
        for joint in self.joints:
            rows = [i for i, o in enumerate(owner) if o is joint]
            share = np.zeros((6, k))
            _, (_, _, P2, _, _) = joint.states()
            for i, (_, (_, _, v2, w2), _) in zip(rows, joint.equations(), strict=True):
                share[:3, i], share[3:, i] = v2, w2 - np.cross(joint.two.R @ joint.b, v2)
            reactions[joint.name] = share @ lam
            open_[joint.name] = np.abs(share @ null).max(axis=1, initial=0.0) > 1e-8
        return x[: 6 * n].reshape(n, 6), reactions, open_
