"""Newton and Euler for every link of a declared linkage: an oracle that knows no virtual work and no tape derivative.

Positions come from the declaration's closed forms, velocities and accelerations from CasADi's differentiation of them.
"""

import casadi as ca
import numpy as np

from mechsym.derive import velocities
from mechsym.derive.printer import to_casadi
from mechsym.derive.rates import accelerations


class Oracle:
    """A linkage at a state; values by letter."""

    def __init__(self, equations, values):
        self.m = m = equations.mechanism
        self.values = values
        q, u, a = (list(g) for g in (m.q, velocities(m), accelerations(m)))
        self.symbols = {s.name: ca.SX.sym(s.name) for s in [*q, *u, *a]}
        self.q, self.u, self.a = (ca.vertcat(*(self.symbols[s.name] for s in g)) for g in (q, u, a))
        self.known = {**values, **self.symbols, **{j.name: ca.SX(0) for j in m.joint_list}}
        for name in m.tape.entries:
            free = {s.name for s in m.tape.entries[name].free_symbols}
            if free <= self.known.keys():
                self.known[name.name] = to_casadi(m.tape.entries[name], self.known)

    def number(self, expression):
        state = [
            ca.vertcat(*(self.values[n] for n in map(str, g)))
            for g in (
                [s.name for s in self.m.q],
                [s.name for s in velocities(self.m)],
                [s.name for s in accelerations(self.m)],
            )
        ]
        return float(ca.Function("f", [self.q, self.u, self.a], [expression])(*state))

    def value(self, expression):
        return self.number(ca.SX(to_casadi(expression, self.known)))

    def acceleration(self, expression):
        f = ca.SX(to_casadi(expression, self.known))
        first = ca.jtimes(f, self.q, self.u)
        second = ca.jtimes(first, self.q, self.u) + ca.jtimes(f, self.q, self.a)
        return self.number(second)

    def forces(self, joint, reactions):
        """Force and moment of the first link on the second, and where the force acts."""
        r = {
            n: reactions.get(f"{s}_{joint.name}", 0.0)
            for n, s in {"x": "R_x", "y": "R_y", "n": "R_n", "t": "R_t", "M": "M"}.items()
        }
        if joint.kind == "pin":
            return np.array([r["x"], r["y"]]), 0.0, self.pair(joint.second.xy)
        if joint.kind == "gear":
            one, other = self.pair(joint.first.xy), self.pair(joint.second.xy)
            way = (other - one) / np.linalg.norm(other - one)
            radius = self.value(joint.radii[0])
            return r["t"] * np.array([-way[1], way[0]]), 0.0, one + radius * way
        line = joint.first if joint.kind == "slider" or hasattr(joint.first, "tilt") else joint.second
        point = joint.second if line is joint.first else joint.first
        angle = self.value(line.link.turns + line.tilt)
        normal = np.array([-np.sin(angle), np.cos(angle)])
        if joint.kind == "slider":  # the moment is about the reference point of the second link's line
            own = joint.second
            return r["n"] * normal, r["M"], self.pair(own.link.out((own.u, own.v)))
        return r["n"] * normal, 0.0, self.pair(point.link.out((point.u, point.v)))

    def pair(self, pair):
        return np.array([self.value(e) for e in pair])

    def residuals(self, reactions, torque):
        """For each link (sum of forces less m a, moments about the centre less I alpha), and a size to compare with."""
        m, found, size = self.m, {}, 0.0
        gravity = np.array([self.value(g) for g in m.gravity])
        for link in m.links:
            mass, inertia = self.value(link.mass), self.value(link.inertia)
            centre = link.out(link.centre)
            at, acc = self.pair(centre), np.array([self.acceleration(e) for e in centre])
            force, moment = mass * (gravity - acc), -inertia * self.acceleration(link.turns)
            for joint in m.link_joints:
                for sign, side in ((-1, joint.first), (1, joint.second)):
                    if side.link is link:
                        f, M, point = self.forces(joint, reactions)
                        arm = point - at
                        force = force + sign * f
                        moment += sign * (M + arm[0] * f[1] - arm[1] * f[0])
                        size = max(size, np.abs(f).max())
            if link.given and link.turns in m.q:
                moment += torque
            found[link.name] = (*force, moment)
        return found, size
