r"""A rod that hangs on another rod: the slave rod of a V or radial engine, on a knuckle pin of the master rod, exact.

    y ^       K. . . _ l1+l2        x along the master's cylinder, as for the derived throw; A the crank pin, K the
      |   a .'  knuckle    ' - B    knuckle pin at the distance a from A and at the angle kappa from the rod's middle
      |   A'- - - - - - l - - - -   line A to piston pin, v the angle of the slave's cylinder from the master's. psi_s
      | .' phi             psi      is the slave's angle from its own cylinder, counted as psi is.
      O------------------------> x

.. math:: K = r\,e(\varphi) + a\,e(\kappa - \psi), \quad \sin\psi = (r \sin\varphi - e_m)/l, \qquad
          \sin\psi_s = (K\cdot n - e_s)/l_s, \quad x_s = top - (K\cdot t + l_s \cos\psi_s)

with e(.) a unit vector, t and n along and across the slave's cylinder. The master rod has no mass here: it is that of
the derived throw, and forces of both add up. Mass, forces and reactions follow from these places by differentiation: a
joint's reaction is the work of what hangs on it for a displacement of the joint.
"""

import functools
from collections.abc import Mapping
from typing import Any

import casadi as ca
import numpy as np

from mechsym.quantities.units import Metre, Radian

#: State of a throw, and the letters of a slave rod
STATE = ("phi", "phid", "phidd", "F")
LETTERS = (
    "r", "l", "offset_m", "a", "kappa", "v", "l1", "l2", "offset", "m_rod", "I_rod", "m_piston", "g", "axis_tilt",
    "top",
)  # fmt: skip
#: Displacements of the joints: frame on crank, crank on master, master on slave, slave on piston, its cylinder on the
#: piston; the master on its own piston, and that one's cylinder
_JOINTS = ("x_O", "y_O", "x_A", "y_A", "x_K", "y_K", "x_B", "y_B", "y_G", "y_Bm", "y_Gm")
OUTPUTS: Mapping[str, tuple[str, ...]] = {
    "kinematics": ("x", "dx_dphi", "d2x_dphi2", "psi", "dpsi_dphi", "knuckle", "dknuckle_dphi"),
    "dynamics": ("mass", "bias", "force"),
    "energy": ("kinetic_energy", "potential_energy"),
    "reactions": tuple(f"R_{name}" for name in _JOINTS),
    "momentum": ("momentum_rate_x", "momentum_rate_y", "angular_momentum_rate"),
}
_TRIES = 8  # steps of Newton from the angle at which the crank points to the head: its error squares each time


class _Hung:
    """A slave rod with its piston, in symbols."""

    def __init__(self) -> None:
        self.state, self.letters = ca.SX.sym("state", len(STATE)), ca.SX.sym("letters", len(LETTERS) + 1)
        self.q, self.u, self.qdd, self.F = ca.vertsplit(self.state)
        self.d = ca.SX.sym("d", len(_JOINTS))
        d = dict(zip(_JOINTS, ca.vertsplit(self.d), strict=True))
        p = dict(zip((*LETTERS, "shift"), ca.vertsplit(self.letters), strict=True))
        self.p, phi = p, self.q + p["shift"]
        pin = p["r"] * _unit(phi) + ca.vertcat(d["x_O"] + d["x_A"], d["y_O"] + d["y_A"])
        psi = ca.asin((pin[1] - p["offset_m"] + d["y_Bm"] - d["y_Gm"]) / p["l"])
        knuckle = pin + p["a"] * _unit(p["kappa"] - psi) + ca.vertcat(d["x_K"], d["y_K"])
        t, n, l = _unit(p["v"]), ca.vertcat(-ca.sin(p["v"]), ca.cos(p["v"])), p["l1"] + p["l2"]
        self.psi = ca.asin((ca.dot(knuckle, n) - p["offset"] + d["y_B"] - d["y_G"]) / l)
        along = ca.dot(knuckle, t) + l * ca.cos(self.psi) + d["x_B"]
        self.x, self.turn = p["top"] - along, psi - self.psi
        self.knuckle = ca.vertcat(ca.dot(knuckle, t), ca.dot(knuckle, n))
        # in the slave's axes turned into the master's: rod and piston with mass, the rod with inertia
        rod = knuckle + p["l1"] * (ca.cos(self.psi) * t - ca.sin(self.psi) * n)
        piston = along * t + (p["offset"] + d["y_G"]) * n
        self.bodies = [(p["m_rod"], rod), (p["m_piston"], piston)]
        self.weight = p["g"] * ca.vertcat(-ca.sin(p["axis_tilt"]), -ca.cos(p["axis_tilt"]))

    def group(self, name: str) -> ca.Function:
        values = ca.vertcat(*getattr(self, name)())
        placed = ca.substitute(values, self.d, ca.DM.zeros(len(_JOINTS)))
        return ca.Function(f"hung_{name}", [self.state, self.letters], [placed])

    def _by_angle(self, value: ca.SX) -> tuple[ca.SX, ca.SX]:
        slope = ca.jacobian(value, self.q)
        return slope, ca.jacobian(slope, self.q)

    def _accelerations(self, value: ca.SX) -> ca.SX:
        slope, curve = self._by_angle(value)
        return curve * self.u**2 + slope * self.qdd

    def pose(self) -> list[ca.SX]:
        return [self.knuckle, self.p["top"] - self.x, self.p["offset"]]

    def kinematics(self) -> list[ca.SX]:
        x, psi, turn = (self._by_angle(value) for value in (self.x, self.psi, self.turn))
        return [self.x, *x, self.psi, psi[0], self.turn, turn[0]]

    def dynamics(self) -> list[ca.SX]:
        mass = self.p["I_rod"] * self._by_angle(self.psi)[0] ** 2
        force = self.F * self._by_angle(self.x)[0]
        for m, place in self.bodies:
            slope = self._by_angle(place)[0]
            mass += m * ca.dot(slope, slope)
            force += m * ca.dot(self.weight, slope)
        return [mass, ca.jacobian(mass, self.q) * self.u**2 / 2, force]

    def energy(self) -> list[ca.SX]:
        stored = -sum((m * ca.dot(self.weight, place) for m, place in self.bodies), ca.SX(0))
        return [self.dynamics()[0] * self.u**2 / 2, stored]

    def reactions(self) -> list[ca.SX]:
        work = self.p["I_rod"] * self._accelerations(self.psi) * ca.jacobian(self.psi, self.d).T
        work -= self.F * ca.jacobian(self.x, self.d).T
        for m, place in self.bodies:
            work += m * ca.jacobian(place, self.d).T @ (self._accelerations(place) - self.weight)
        return [work]

    def momentum(self) -> list[ca.SX]:
        rates = [(place, m * self._accelerations(place)) for m, place in self.bodies]
        about = sum((place[0] * rate[1] - place[1] * rate[0] for place, rate in rates), ca.SX(0))
        total = sum((rate for _, rate in rates), ca.SX(0))
        return [total, about - self.p["I_rod"] * self._accelerations(self.psi)]


def _unit(angle: ca.SX) -> ca.SX:
    return ca.vertcat(ca.cos(angle), ca.sin(angle))


@functools.cache
def hung(group: str) -> ca.Function:
    """A group of functions of a slave rod with its piston, from the state of its throw and its letters with `shift`."""
    return _Hung().group(group)


def top(letters: Mapping[str, float]) -> tuple[Radian, Metre]:
    """Top dead centre of a slave's piston.

    letters: its letters but for `top`, numbers or symbols. Returns phi and distance: angle of the crank from the
    master's cylinder [rad], and distance of the piston pin from the shaft there [m].
    """
    values = ca.vertcat(*(letters[name] for name in LETTERS if name != "top"), 0.0, 0.0)
    phi: Any = letters["v"]
    for _ in range(_TRIES):
        _, slope, curve, *_rest = ca.vertsplit(hung("kinematics")(ca.vertcat(phi, 0, 0, 0), values))
        phi = phi - slope / curve
    away: Any = -hung("kinematics")(ca.vertcat(phi, 0, 0, 0), values)[0]
    place: tuple[Any, Any] = (phi, away) if isinstance(phi, ca.SX) else (float(phi), float(away))
    return place


def pose(letters: Mapping[str, float], angle: Radian) -> tuple[tuple[Metre, Metre], tuple[Metre, Metre]]:
    """Knuckle pin and piston pin along and across the slave's cylinder [m]; angle: of the crank from the master's."""
    values = [letters[name] for name in LETTERS if name != "top"]
    place = np.asarray(hung("pose")([angle, 0, 0, 0], [*values, 0.0, 0.0])).ravel().tolist()
    return (place[0], place[1]), (place[2], place[3])
