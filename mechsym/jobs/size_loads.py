"""The sizing of an engine from its case: case -> cycle over the speeds -> forces of the mechanism -> parts and checks.

pressures(machine, speeds) -> forces_of(moving masses) -> design -> rows
"""

import dataclasses
from collections.abc import Callable
from functools import partial
from typing import Any

import casadi as ca
import numpy as np

from mechsym.cases import Case, load
from mechsym.cycle.chamber import chamber
from mechsym.cycle.closed.model import ClosedEngine, closed_period
from mechsym.cycle.closed.performance import Performance
from mechsym.cycle.closed.run import dense, run
from mechsym.cycle.engine import over_speeds
from mechsym.errors import BadInput
from mechsym.jobs.cycle import engine, speed_range
from mechsym.mechanisms.hypocycloid import HypocycloidParameters, build
from mechsym.mechanisms.record import bind, curves
from mechsym.quantities import record
from mechsym.sizing.hypocycloid.masses import Moving, PrintedMasses
from mechsym.sizing.hypocycloid.parts import PartForces, Parts, Stock
from mechsym.sizing.loads import over_period
from mechsym.sizing.rules import bearing_data, materials
from mechsym.sizing.rules.cylinder import tdc_gap
from mechsym.sizing.rules.piston import head_heat
from mechsym.sizing.slider_crank.parts import SliderForces
from mechsym.sizing.wants import Wants

_STEPS = 720  # angles over a period of 4 pi; divisible by 4 for the teeth's returns


@record
class Job:
    """A case ready for sizing."""

    case: Case  #: The case, with the cycle settings that its section `[sizing]` asks for
    machine: ClosedEngine
    wants: Wants  #: Section `[sizing]`
    stock: Stock


@record
class Pressures:
    """Pressure over the period at every speed."""

    #: shape (k,), (n,): Crank speeds [rad/s], crank angles from firing top dead centre [rad]
    omega: np.ndarray
    theta: np.ndarray
    p: np.ndarray  #: shape (k, n): Absolute pressure [Pa]
    back: float  #: Pressure behind the piston [Pa]


def job(name: str, overrides: dict[str, Any]) -> Job:
    """Read a case for sizing.

    Parameters
    ----------
    name : str
        Name of a built-in case or a path
    overrides : dict
        Values to replace; they win over the settings of `[sizing]`

    Raises
    ------
    BadInput
        A section is missing or a setting is no KEY=VALUE
    """
    first = load(name, overrides)
    wants = first.sections.get("sizing", Wants())
    settings = dict(_setting(text, first.file) for text in wants.settings)
    case = load(name, settings | overrides) if settings else first
    stock = Stock(materials=materials.load(wants.materials_file or None),
                  bearings=bearing_data.catalogue(wants.bearings_file or None))  # fmt: skip
    return Job(case=case, machine=engine(case), wants=wants, stock=stock)


def speeds(found: Job) -> np.ndarray:
    """Crank speeds at which the parts are sized and checked.

    Returns
    -------
    omega : ndarray, shape (k,)
        The range of `[speeds]` in steps of `sizing.speed_step`, the highest included [rad/s]
    """
    given = found.case.need("speeds")
    coarse = dataclasses.replace(given, step=max(given.step, found.wants.speed_step))
    return np.unique(np.append(speed_range(coarse), given.highest))


def pressures(found: Job, omega: np.ndarray) -> Pressures:
    """The cycle at every speed, gas exchange at the surroundings' pressure.

    Parameters
    ----------
    omega : ndarray, shape (k,)
        Crank speeds [rad/s]

    Returns
    -------
    pressures : Pressures
        Over a period of 4 pi
    """
    theta = np.arange(_STEPS) * 4 * np.pi / _STEPS
    phi, p, _ = dense(run(partial(closed_period, found.machine), {"omega": omega}))
    around = found.machine.cycle.intake_pressure
    return Pressures(omega=omega, theta=theta, p=over_period(theta, phi, p, around),
                     back=found.machine.chamber.back_pressure)  # fmt: skip


def hypocycloid_forces(found: Job, gas: Pressures) -> Callable[[Moving], PartForces]:
    """Forces of the derived hypocycloid mechanism for given moving masses.

    Returns
    -------
    forces_of : callable
        Moving masses -> forces over the speeds
    """
    room = chamber(found.machine.chamber, found.machine.motion)
    parameters: HypocycloidParameters = found.case.need("parameters")
    net = (gas.p - gas.back) * float(room.area)
    heat = head_heat(fuel_flow(found, gas.omega.max()) / 2, found.machine.cycle.heating_value, found.wants.heat_share)
    around = found.machine.cycle.intake_pressure

    def forces_of(moving: Moving) -> PartForces:
        masses = dataclasses.replace(parameters, m2=moving.planet, m3=moving.axis, u1=-moving.planet * parameters.e)
        out = _reactions(masses, gas, net)
        share = moving.rod / moving.axis
        return PartForces(
            omega=gas.omega, theta=gas.theta, dp_max=gas.p.max(axis=1) - around, net=out["pin_force"],
            rod=net - share * (net - out["pin_force"]), tooth=out["tooth_force"], radial=out["tooth_force_radial"],
            torque=out["piston_torque"], spin=moving.planet * parameters.e * gas.omega**2, e=parameters.e,
            bore=float(room.bore), stroke=float(room.stroke), head_heat=heat,
            gap=tdc_gap(float(room.clearance), float(room.area)),
        )  # fmt: skip

    return forces_of


def fuel_flow(found: Job, omega: float) -> float:
    """Fuel that the cylinder burns.

    Parameters
    ----------
    omega : float
        Crank speed [rad/s]

    Returns
    -------
    flow : float
        Mass flow, one charge in two turns [kg/s]
    """
    figures = over_speeds(found.machine, np.array([omega]))
    return float(figures.sfc[0] * figures.power[0])


def printed(case: Case) -> PrintedMasses:
    """The parts that a case prints, with their masses.

    Parameters
    ----------
    case : Case
        With sections `[part_piston]`, `[part_cylinder]`, `[part_gears]`, `[part_crank]`, `[part_bearings]`,
        `[part_masses]`

    Returns
    -------
    printed : PrintedMasses
        Reference of the mass model, and what `--as-printed` checks

    Raises
    ------
    BadInput
        A section is missing
    """
    parts = Parts(piston=case.need("part_piston"), cylinder=case.need("part_cylinder"), gears=case.need("part_gears"),
                  crank=case.need("part_crank"), bearings=case.need("part_bearings"))  # fmt: skip
    return PrintedMasses(parts=parts, masses=case.need("part_masses"), bore=case.need("chamber").bore,
                   e=case.need("parameters").e)  # fmt: skip


def performance(found: Job, omega: np.ndarray) -> Performance:
    """Figures of the job's cycle.

    Parameters
    ----------
    omega : ndarray, shape (k,)
        Crank speeds [rad/s]
    """
    return over_speeds(found.machine, omega)


def _reactions(parameters: HypocycloidParameters, gas: Pressures, net: np.ndarray) -> dict[str, np.ndarray]:
    function = build(parameters).functions["reactions"]
    rows = {
        "theta": np.broadcast_to(gas.theta, net.shape),
        "thetad": np.broadcast_to(gas.omega[:, None], net.shape),
        "F": net,
    }
    inputs = [ca.DM(np.reshape(rows.get(name, np.zeros(net.shape)), (1, -1))) for name in function.name_in()]
    values = function.call(inputs)
    return {name: np.asarray(v).reshape(net.shape) for name, v in zip(function.name_out(), values, strict=True)}


def _setting(text: str, file: str) -> tuple[str, str]:
    key, sign, value = text.partition("=")
    if not sign or not key.strip() or not value.strip():
        raise BadInput(f"{file}: sizing.settings {text!r} is not KEY=VALUE")
    return key.strip(), value.strip()


def slider_crank_forces(found: Job, gas: Pressures) -> Callable[[float], SliderForces]:
    """Forces of the derived crank mechanism for a given reciprocating mass.

    Parameters
    ----------
    found : Job
        The case; mechanism `crosshead` without offset

    Returns
    -------
    forces_of : callable
        Reciprocating mass [kg] -> forces over the speeds
    """
    room = chamber(found.machine.chamber, found.machine.motion)
    parameters = found.case.need("parameters")
    moved = curves(bind("crosshead", dataclasses.asdict(parameters)), gas.theta)
    net = (gas.p - gas.back) * float(room.area)
    heat = head_heat(fuel_flow(found, gas.omega.max()) / 2, found.machine.cycle.heating_value, found.wants.heat_share)

    def forces_of(mass: float) -> SliderForces:
        force = net - mass * moved["d2x_dphi2"] * gas.omega[:, None] ** 2
        return SliderForces(
            omega=gas.omega, theta=gas.theta, dp_max=gas.p.max(axis=1) - found.machine.cycle.intake_pressure,
            net=force, torque=force * moved["dx_dphi"], r=parameters.r1 + parameters.r2,
            l=parameters.l1 + parameters.l2, bore=float(room.bore), stroke=float(room.stroke), head_heat=heat,
            gap=tdc_gap(float(room.clearance), float(room.area)),
        )  # fmt: skip

    return forces_of
