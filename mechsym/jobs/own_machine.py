"""A mechanism of the user's own as a machine: one periodic coordinate, gas, load and a place for a hinge.

All that acts besides the gas (weights, springs, dampers and inputs of `[inputs]`) is taken at the speed of operation
and becomes a torque over the angle; its mean goes into the load. Several pistons become one torque on the shaft, which
a gas with one metre of travel a radian stands for.
"""

from collections.abc import Callable
from dataclasses import replace

import casadi as ca
import numpy as np

from mechsym import periodic
from mechsym.cases import Case
from mechsym.cycle.chamber import Chamber
from mechsym.cycle.dead_centres import motion_over
from mechsym.cycle.gas import Gas
from mechsym.cycle.pressure import ATMOSPHERE, Pressure
from mechsym.jobs import own, own_gas
from mechsym.machine.loads import ConstantLoad
from mechsym.machine.record import Machine
from mechsym.mechanisms.record import Mechanism
from mechsym.mechanisms.shaft_inertia import with_inertia
from mechsym.quantities import record

_HARMONICS = 4096  # samples a turn of what acts besides the gas


@record
class ShaftTorque(Gas):
    """A torque on the shaft in place of one piston's gas force."""

    curve: Callable[[np.ndarray], np.ndarray]  #: crank angle [rad] to torque [N*m]
    told: bool = True  #: whether a pressure is known

    __hash__ = object.__hash__

    @property
    def on_shaft(self) -> bool:
        """It is a torque."""
        return True

    @property
    def has_pressure(self) -> bool:
        """A torque from a table has none."""
        return self.told

    def force(self, phi: np.ndarray) -> np.ndarray:
        """The torque over the crank angle [rad]: [N*m] for each metre of travel."""
        return self.curve(np.asarray(phi, dtype=float))


def machine(case: Case) -> Machine:
    """The machine of a case, ready to turn.

    Parameters
    ----------
    case : Case
        With `[parameters]` and `[operation]`; `[cycle]` on the pistons, or `[torque]` on the shaft, or neither, where
        weights, springs, inertia and `[drive]` are all that acts
    """
    mechanism, omega = own.one_coordinate(case), case.need("operation").speed
    acting = own_gas.pistons(case, mechanism)
    flywheel = case.sections.get("flywheel")
    if len(acting) == 1 and acting[0].start == 0.0:
        gas, travel = acting[0].gas, own.roles(case, "piston")[0]["travel"]
    elif acting:
        gas, travel = _on_shaft(case, mechanism, acting), ""
    else:
        gas, travel = _without_gas(case, mechanism, omega), ""
    shaft = _shaft(case, mechanism, omega, travel)
    if flywheel is not None:
        shaft = with_inertia(shaft, flywheel.inertia)
    return Machine(mechanism=shaft, gas=gas, load=case.sections.get("load", ConstantLoad()), omega=omega)


def _on_shaft(case: Case, mechanism: Mechanism, acting: list[own_gas.Piston]) -> ShaftTorque:
    """Gas of all pistons as one torque; pressures and sizes told are those of the first."""
    first = acting[0].gas
    pressure = replace(
        first.pressure,
        period=own_gas.period_of(acting),
        kinks=own_gas.kinks_of(acting),
        facts=(*first.pressure.facts, f"the torque is that of {len(acting)} piston(s) on the shaft"),
    )
    return ShaftTorque(pressure=pressure, chamber=first.chamber, curve=own_gas.gas_torque(case, mechanism, acting))


def _without_gas(case: Case, mechanism: Mechanism, omega: float) -> ShaftTorque:
    """The torque of `[torque]` on the shaft, or none: no pressure is known of it."""
    curve, period = own_gas.shaft_curve(case, mechanism, omega)
    fact = "no gas acts" if "torque" not in case.sections else f"torque of {case.need('torque').file}"
    phi = ca.SX.sym("phi")
    nothing = Pressure(
        kind="none", period=period, kinks=(), absolute=lambda at: np.full(np.shape(at), ATMOSPHERE), p_max=ATMOSPHERE,
        phi_p_max=0.0, mean_indicated=0.0, facts=(fact,),
    )  # fmt: skip
    travel = ca.Function("travel", [phi], [1 - ca.cos(phi), ca.sin(phi)], ["phi"], ["x", "dx_dphi"])  # of nothing
    room = Chamber(
        motion=motion_over(travel), pistons=1, bore=0.0, area=0.0, stroke=0.0,
        clearance=0.0, displacement=0.0, compression_ratio=1.0, back_pressure=ATMOSPHERE,
    )  # fmt: skip
    return ShaftTorque(pressure=nothing, chamber=room, curve=curve, told=False)


def _shaft(case: Case, base: Mechanism, omega: float, travel: str) -> Mechanism:
    """The mechanism with the inputs F, M_r and M_h, and all else as a torque over the angle without a mean."""
    (q,) = base.coordinates
    phi, u = ca.SX.sym(q), ca.SX.sym(f"{q}d")
    F, M_r, M_h = (ca.SX.sym(n) for n in ("F", "M_r", "M_h"))
    constants = own.constants(case)
    if "drive" in case.sections:
        drive = case.need("drive")
        constants = {**constants, drive.input or own.driving_input(case): drive.torque}
    inputs = [constants.get(n, 0.0) for n in base.inputs]
    mass, bias, _ = base.functions["dynamics"](phi, u, *inputs)
    at_speed = base.functions["dynamics"](phi, omega, *inputs)[2]
    grid = np.arange(_HARMONICS) * 2 * np.pi / _HARMONICS
    mean = float(np.mean(np.asarray(ca.Function("rest", [phi], [at_speed])(grid[None, :]))))
    found = dict(zip(base.functions["kinematics"].name_out(), base.functions["kinematics"].call([phi]), strict=True))
    motion = {"x": phi, f"dx_d{q}": ca.SX(1), f"d2x_d{q}2": ca.SX(0)}
    if travel:
        top = float(np.min(np.asarray(own_gas.travel_of(base, travel)(grid[None, :])[0])))
        first = ca.jacobian(found[travel], phi)
        motion = {"x": found[travel] - top, f"dx_d{q}": first, f"d2x_d{q}2": ca.jacobian(first, phi)}
    force = at_speed - mean + F * motion[f"dx_d{q}"] - M_r + M_h
    dynamics = ca.Function(
        "dynamics", [phi, u, F, M_r, M_h], [mass, bias, force], [q, f"{q}d", "F", "M_r", "M_h"],
        ["mass_matrix", "bias", "generalized_force"],
    )  # fmt: skip
    kinematic = {k: v for k, v in found.items() if k not in motion and k != q} | motion
    kinematics = ca.Function("kinematics", [phi], list(kinematic.values()), [q], list(kinematic))
    kept = {n: base.functions[n] for n in ("drawing",) if n in base.functions}
    energy = _energy(base, at_speed - mean, phi, u)
    functions = kept | {"kinematics": kinematics, "dynamics": dynamics, "energy": energy}
    return replace(base, inputs=("F", "M_r", "M_h"), functions=functions)


def _energy(base: Mechanism, rest: ca.SX, phi: ca.SX, u: ca.SX) -> ca.Function:
    """Kinetic energy, and the potential of the torque over the angle: its integral, from its Fourier series."""
    (q,) = base.coordinates
    torque = ca.Function("rest", [phi], [rest])
    poly = periodic.fit(lambda a: np.asarray(torque(np.asarray(a)[None, :])).ravel(), (), 2 * np.pi)
    grid = np.arange(_HARMONICS) * 2 * np.pi / _HARMONICS
    series = np.fft.rfft(poly(grid)) / _HARMONICS
    size = np.abs(series)
    # harmonics that no torque reaches hold the noise of rounding; what is as small is noise too
    floor = max(4 * size[len(size) // 2 :].max(), 1e-16 * size.max())
    kept = [k for k in range(1, len(series) // 2) if size[k] > floor]
    # 2 Re(c e^{ik phi}) of the torque is the slope of 2 Re(c / (ik) e^{ik phi})
    potential = -_series({k: 2 * series[k] / (1j * k) for k in kept}, phi)
    kinetic = base.functions["energy"](phi, u)[0]
    return ca.Function("energy", [phi, u], [kinetic, potential], [q, f"{q}d"], ["kinetic_energy", "potential_energy"])


def _series(terms: dict[int, complex], phi: ca.SX) -> ca.SX:
    r"""Real part of a Fourier series :math:`\mathrm{Re} \sum c_k e^{ik\varphi}` by Horner's rule.

    One sine and one cosine in all: a compiler takes seconds for some hundreds of them.
    """
    c, s = ca.cos(phi), ca.sin(phi)
    x, y = ca.SX(0), ca.SX(0)
    for k in range(max(terms, default=0), -1, -1):
        found = terms.get(k, 0j)
        x, y = x * c - y * s + found.real, x * s + y * c + found.imag
    return x
