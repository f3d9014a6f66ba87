"""Cams of a machine at constant speed: what their contacts carry, from which speed on they lift off, how they curve."""

import math
from collections.abc import Iterator

import casadi as ca
import numpy as np
import scipy

from mechsym.forces.turn import Turn
from mechsym.mechanisms.amounts import amount
from mechsym.mechanisms.arrays import along
from mechsym.mechanisms.roles import CamRole
from mechsym.page.finding import NOT_MET, Finding
from mechsym.quantities.display import quantity_text
from mechsym.quantities.results import quantity, result

_POINTS = 2880  # over two turns of the shaft, which a camshaft at half speed takes for one
_SHARE = 1e-9  # of the largest force: below it a contact that only touches is none


@result
class CamNumbers:
    """A cam over two turns of the shaft at constant speed, its follower held on it."""

    name: str = quantity("-")  #: In the declaration
    force_min: float = quantity("N")  #: Least contact force; below 0 the follower lifts off
    force_max: float = quantity("N")  #: Largest contact force
    angle_of_min_deg: float = quantity("deg")  #: Shaft angle of the least
    #: From this speed of the shaft on the follower lifts off; null where it does at no speed
    jump_speed_rpm: float | None = quantity("rpm")
    pressure_angle_max_deg: float = quantity("deg")  #: Largest, to either side
    curvature_max: float = quantity("1/m")  #: Of the sharpest place of the cam that bulges
    curvature_min: float = quantity("1/m")  #: Below 0: of the hollowest place
    undercut: bool = quantity("-")  #: Whether a cutter could not leave the flank standing


def cams(turn: Turn) -> tuple[CamNumbers, ...]:
    """The cams of a mechanism whose followers are held."""
    return tuple(_numbers(turn, role) for role in turn.drive.roles.cams if role.force)


def findings(turn: Turn) -> Iterator[Finding]:
    """What has to be known of them first."""
    for one in cams(turn):
        if one.force_min < -_SHARE * one.force_max:
            least, at = quantity_text(one.force_min, "N", 4), f"{one.angle_of_min_deg:.4g} deg"
            jump = "at any speed" if one.jump_speed_rpm is None else f"from {one.jump_speed_rpm:.4g} rpm on"
            words = f"the follower of the cam {one.name} lifts off {jump}: {least} at {at}; more spring, or less mass"
            yield Finding(rank=NOT_MET, words=words, value=one.force_min, unit="N")
        if one.undercut:
            words = f"the cam {one.name} is undercut: no flank is left where it turns sharply; a larger base circle"
            yield Finding(rank=NOT_MET, words=words)


def _numbers(turn: Turn, role: CamRole) -> CamNumbers:
    mechanism = turn.drive.mechanism
    kinematics, reactions = (mechanism.functions[name] for name in ("kinematics", "reactions"))
    q = mechanism.coordinates[0]
    phi = np.arange(_POINTS) * 4 * math.pi / _POINTS
    outputs = [kinematics.name_out().index(n) for n in (f"pressure_angle_{role.name}", f"curvature_{role.name}")]
    told = ca.Function("cam", [x := ca.SX.sym(q)], [kinematics.call([x])[k] for k in outputs], [q], ["angle", "bend"])
    shape = along(told, {q: phi})

    carried_at = _one(reactions, role.force)

    def force(at: np.ndarray, omega: float) -> np.ndarray:
        letters = {q: at, f"{q}d": np.full_like(at, omega)}
        letters |= {n: np.interp(at, turn.phi, values, period=turn.period) for n, values in turn.inputs.items()}
        return along(carried_at, letters)["force"]

    def jump(at: np.ndarray) -> np.ndarray:
        """The share of the speed at which the force is zero, which changes with the speed and its square."""
        still, once, twice = (force(at, k * turn.omega) for k in range(3))
        square = (twice - 2 * once + still) / 2
        half = (once - still - square) / 2
        with np.errstate(invalid="ignore", divide="ignore"):
            root = (-half - np.sqrt(half**2 - square * still)) / square
        return np.where((square < 0) & (root > 0), root, np.inf)

    carried, shares = force(phi, turn.omega), jump(phi)
    least, share = int(np.argmin(carried)), float(np.min(shares))
    if np.isfinite(share):
        near, step = phi[int(np.argmin(shares))], phi[1]
        best = scipy.optimize.minimize_scalar(
            lambda at: float(jump(np.array([at]))[0]), bounds=(near - step, near + step), method="bounded",
            options={"xatol": 1e-10},
        )  # fmt: skip
        share = min(float(best.fun), share)
    bend = shape["bend"]
    radius = amount(role.roller, mechanism.parameters) if role.roller is not None else 0.0
    undercut = bool((bend <= 0).any()) if role.flat else bool(radius and (bend < -1 / radius).any())
    return CamNumbers(
        name=role.name, force_min=float(carried[least]), force_max=float(carried.max()),
        angle_of_min_deg=math.degrees(phi[least]), undercut=undercut,
        jump_speed_rpm=None if math.isinf(share) else share * turn.omega * 30 / math.pi,
        pressure_angle_max_deg=math.degrees(np.abs(shape["angle"]).max()), curvature_max=float(bend.max()),
        curvature_min=float(bend.min()),
    )  # fmt: skip


def _one(function: ca.Function, output: str) -> ca.Function:
    letters = [ca.SX.sym(n) for n in function.name_in()]
    value = function.call(letters)[function.name_out().index(output)]
    return ca.Function("of_cam", letters, [value], function.name_in(), ["force"])
