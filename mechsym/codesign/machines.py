"""A machine at one speed and load as a point of a co-design, the hardware of its hinge, a torque curve as a point."""

import dataclasses
from collections.abc import Callable, Sequence
from typing import Any

import casadi as ca
import numpy as np
import scipy

from mechsym import periodic
from mechsym.codesign.hardware import Hardware
from mechsym.codesign.points import Function, Point
from mechsym.cycle.unfired import unfired, unfired_kinks
from mechsym.errors import BadInput
from mechsym.hinge.choices import ROLLERS, GuideParameters
from mechsym.hinge.rollers import RollerParameters
from mechsym.hinge.springs.face import Spring
from mechsym.hinge.torque import EngineTorques, Hinge, engine_torques, torque
from mechsym.machine.record import Machine, lever, only_gas
from mechsym.quantities.units import Array, Inertia, NewtonMetre, Pascal, Pure, Radian, RadPerSecond

_KEPT = 6  # angles of a function that is remembered


def point(machine: Machine, load: Pascal, law: str = "propeller", weight: Pure = 1.0) -> Point:
    """An engine at its speed of operation as a point of a co-design.

    load: mean indicated pressure, for the record. law: how the load follows the speed: `propeller` or `constant`.
    weight: share of the time at this point.
    """
    torques, wanted = engine_torques(machine), torque(machine)
    found = dataclasses.replace(_point(wanted, torques, load, law, weight), **_formulas(machine))
    gas = only_gas(machine)
    # of a torque alone no turn without combustion is known, and what takes work has none to lose
    if gas is None or wanted.load_torque <= 0:
        return found
    without = unfired(gas.force, torques.period)

    def misfire(phi: np.ndarray) -> np.ndarray:
        arm = lever(machine.mechanism, machine.gas_input)(phi)
        return np.asarray(without(phi) * arm + torques.gravity_torque(phi))

    return dataclasses.replace(
        found, misfire=_remembered(misfire), misfire_kinks=unfired_kinks(torques.kinks, torques.period)
    )


def _formulas(machine: Machine) -> dict[str, Any]:
    """Torque and inertia as formulas of the angle, where gas by formulas and weight are all that acts."""
    gas = only_gas(machine)
    if gas is None or machine.forces or not gas.pressure.formulas:
        return {}
    dynamics, (q,) = machine.mechanism.functions["dynamics"], machine.mechanism.coordinates
    letters = {name: ca.SX(0) for name in dynamics.name_in()}
    phi = letters[q] = ca.SX.sym("phi")

    def torque_of(pressure: Callable[[Any], Any]) -> Any:
        force = (pressure(phi) - gas.p_back) * gas.chamber.area
        return dynamics(**letters | {machine.gas_input: force})["generalized_force"]

    pieces = ((a, b, ca.Function("torque", [phi], [torque_of(law)])) for a, b, law in gas.pressure.formulas)
    inertia = ca.Function("inertia", [phi], [dynamics(**letters)["mass_matrix"]])
    return {"formulas": tuple(pieces), "inertia_formula": inertia}


def _remembered(function: Function) -> Function:
    """The function with its last values kept: the same angles are asked for again and again."""
    kept: dict[bytes, np.ndarray] = {}

    def remembered(phi: np.ndarray) -> np.ndarray:
        angle = np.ascontiguousarray(phi, dtype=float)
        key = angle.tobytes()
        if key not in kept:
            if len(kept) >= _KEPT:
                kept.pop(next(iter(kept)))
            kept[key] = np.asarray(function(angle))
        return kept[key].copy()

    return remembered


def _point(wanted: Hinge, torques: EngineTorques, load: float, law: str, weight: float) -> Point:
    return Point(
        omega=wanted.omega, load=load, load_torque=wanted.load_torque, weight=weight,
        law=law if wanted.load_torque > 0 else "constant",  # what takes work is driven by a steady torque
        period=wanted.period, work=wanted.work, inertia=wanted.inertia, kinks=tuple(torques.kinks),
        torque=_remembered(lambda phi: torques.gas_torque(phi) + torques.gravity_torque(phi)),
    )  # fmt: skip


def from_curve(
    phi: Sequence[Radian] | Radian[Array],
    torque: Sequence[NewtonMetre] | NewtonMetre[Array],
    inertia: Inertia,
    omega: RadPerSecond,
    period: Radian = 2 * np.pi,
) -> Point:
    """Any machine of one degree of freedom as a point: its torque over the angle, its mean inertia, a governor's speed.

    phi: ascending angles of one period. torque: on the shaft, positive driving: an engine's mean is positive, a
    compressor's negative. inertia: of all that turns.
    """
    angle, value = np.asarray(phi, dtype=float), np.asarray(torque, dtype=float)
    if angle.ndim != 1 or angle.shape != value.shape or angle.size < 8 or np.any(np.diff(angle) <= 0):
        raise BadInput("a torque curve needs ascending angles, at least eight, and as many torques")
    if angle[-1] - angle[0] >= period:
        raise BadInput(f"the angles span {np.degrees(angle[-1] - angle[0]):g} deg; leave the end of the period out")
    spline = scipy.interpolate.CubicSpline(
        np.append(angle, angle[0] + period), np.append(value, value[0]), bc_type="periodic"
    )
    driving = periodic.fit(lambda x: spline((x - angle[0]) % period + angle[0]), angle, period, 1e-10)
    mean = periodic.mean(driving)
    wanted = scipy.interpolate.PPoly(-driving.c, driving.x, extrapolate="periodic")
    wanted.c[-1] += mean
    constant = scipy.interpolate.PPoly(np.array([[inertia]]), np.array([0.0, period]), extrapolate="periodic")
    return Point(omega=omega, load_torque=mean, law="constant", period=period, work=periodic.antiderivative(wanted),
                 inertia=constant, torque=driving, kinks=())  # fmt: skip


def hardware(spring: Spring, guide: GuideParameters, rollers: RollerParameters, moving_mass: float) -> Hardware:
    """Spring, guide and rollers as the sections of a case have them, with a mass [kg] on each roller."""
    if spring.state:
        raise BadInput(
            "a co-design takes a spring whose force follows from its closing alone; of the law air_thermal take "
            "air_absolute, and give the heat as [losses]"
        )
    return Hardware(
        spring=spring, rho0=guide.rho0, z_margin=guide.z_margin, count=ROLLERS[guide.arrangement],
        shaft_ratio=guide.shaft_ratio, radius=rollers.radius, width=rollers.width, E=rollers.E, nu=rollers.nu,
        moving_mass=moving_mass,
    )  # fmt: skip
