r"""Gas exchange beside a closed period: blowdown through the exhaust valve, fresh gas at one pressure.

    exhaust opens .. dead centre  one ordinary differential equation, choked first, then subsonic, while volume moves
    dead centre .. p_0            what is left in the clearance expands, valves closed
    .. inlet closes               at the intake pressure p_0

.. math:: \frac{\mathrm{d}u}{\mathrm{d}\varphi} = \frac{\gamma - 1}{2}\,u\,\frac{\dot m}{m\,\omega}, \qquad
          u = (m/m_1)^{-(\gamma - 1)/2}, \qquad p = p_1\left(\frac{m V_1}{m_1 V}\right)^{\gamma}

While the flow is choked the right side holds no u, and with G = sqrt(g) (2/(g + 1))^((g + 1)/(2 (g - 1))) it is an
integral over the angle:

.. math:: u = 1 + \frac{\gamma - 1}{2}\,G\,\frac{\sqrt{R T_1}}{\omega V_1}
              \int A\,(V/V_1)^{-(\gamma + 1)/2}\,\mathrm{d}\varphi

Index 1 is the state when the exhaust opens. What stays behind expands without heat, with constant heat capacities; gas
that flows back has its entropy. Source: Heywood (1988), sections 6.5 and C.1, in this variable.

An engine as one record, and its closed period at any design.

A design is a mapping of dotted names to values that replace those of the record: `omega`, `cycle.ignition`,
`chamber.compression_ratio`, `parameters.e`, `heat_transfer.a`, ... The values may be numbers or CasADi symbols.
"""

import copy
import dataclasses
import math
from collections.abc import Mapping, Sequence
from typing import Any

import casadi as ca
import numpy as np

from mechsym.cycle.breathing.flow import curtain_area, orifice_flow, valve_lift
from mechsym.cycle.chamber import ChamberParameters, Motion, chamber, volume, volume_and_slope
from mechsym.cycle.closed.equations import Build, Closed, contents
from mechsym.cycle.friction import Friction
from mechsym.cycle.heat import ConstantGamma, Law, NasaMixture, properties
from mechsym.cycle.kinds.spark_ignition import SparkIgnition, charge, latent_heat, timing, vapour_energy
from mechsym.errors import BadInput
from mechsym.quantities import quantity, record
from mechsym.quantities.units import Pascal, Scalar

_STEPS = {"before": 240, "behind": 720}  # of the way to bottom dead centre, and of the exhaust stroke; even


@record
class Blowdown:
    """Section `[blowdown]`: the exhaust valve of a four-stroke cycle whose closed period is integrated."""

    exhaust_diameter: float = quantity("m", above=0, about="inner diameter of the exhaust valve's seat")
    exhaust_lift: float = quantity("m", above=0, about="largest lift of the exhaust valve")
    exhaust_closes: float = quantity(
        "rad", default=math.radians(375), above=3 * math.pi / 2, below=3 * math.pi, about="from firing TDC"
    )
    valves: float = quantity("-", default=1.0, low=1, high=4, about="exhaust valves of a cylinder")
    discharge: float = quantity("-", default=0.7, above=0, high=1, about="discharge coefficient of the valve")
    pressure: float = quantity("Pa", default=101325.0, above=0, about="absolute, behind the valve")


@record
class OpenPeriod:
    """The cylinder from exhaust opening to inlet closing at n operating points."""

    phi: np.ndarray  #: shape (n, k): crank angle from firing top dead centre, to that of gas exchange [rad]
    p: np.ndarray  #: shape (n, k): absolute pressure [Pa]
    work: np.ndarray  #: shape (n,): of the gas from exhaust opening to inlet closing [J]
    pumping: np.ndarray  #: shape (n,): of the two strokes of gas exchange [J]
    gamma: np.ndarray  #: shape (n,): ratio of the heat capacities of what expands [-]


def open_period(build: Build, design: Mapping[str, np.ndarray], t_end: np.ndarray) -> OpenPeriod:
    """The open period at every operating point.

    build: mapping of names to values -> Closed, with a blowdown. design: values of the design at the n points. t_end:
    temperature when the exhaust opens, shape (n,) [K].
    """
    values = np.array(np.broadcast_arrays(*(np.atleast_1d(np.asarray(v, float)) for v in design.values()), t_end))
    function = open_function(build, tuple(design))
    outputs = {k: np.asarray(v) for k, v in function.call({"design": values[:-1], "t_end": values[-1:]}).items()}
    n = values.shape[1]
    return OpenPeriod(
        phi=outputs["phi"].T.reshape(n, -1), p=outputs["p"].T.reshape(n, -1), work=outputs["work"].ravel(),
        pumping=outputs["pumping"].ravel(), gamma=outputs["gamma"].ravel(),
    )  # fmt: skip


def open_function(build: Build, names: Sequence[str]) -> ca.Function:
    """The open period as a differentiable function of a design.

    Returns function: (design (k,), t_end [K]) -> `phi` [rad], `p` [Pa], columns; `work`, `pumping` [J], `gamma` [-].
    """
    z, t, s, u = (ca.SX.sym(name, size) for name, size in (("z", len(names)), ("t", 1), ("s", 1), ("u", 1)))
    closed = build({name: z[k] for k, name in enumerate(names)})
    assert (valve := closed.blowdown) is not None
    design, t_end = ca.MX.sym("design", len(names)), ca.MX.sym("t_end")
    state = ca.MX(1)
    angles: list[ca.MX] = []
    pressures: list[ca.MX] = []
    works: list[ca.MX] = []
    for first, last, steps in ((closed.opens, math.pi, _STEPS["before"]), (math.pi, 2 * math.pi, _STEPS["behind"])):
        here = first + (last - first) * s
        slope = ca.Function("slope", [s, u, z, t], [_slope(closed, valve, here, u, t) * (last - first)])
        sweep = volume_and_slope(closed.chamber, here)[1] * (last - first)
        node = ca.Function("node", [s, u, z, t], [here, _pressure(closed, here, u, t)[0], sweep])
        fold = _step(slope, 1 / steps).mapaccum("fold", steps)
        at = ca.DM(np.arange(steps + 1) / steps).T
        history = fold(state, at[:-1], ca.repmat(design, 1, steps), ca.repmat(t_end, 1, steps))
        history = ca.horzcat(state, history)
        every = ca.repmat(design, 1, steps + 1), ca.repmat(t_end, 1, steps + 1)
        phi, p, swept = node.map(steps + 1)(at, history, *every)
        angles, pressures = [*angles, phi.T], [*pressures, p.T]
        weights = np.where(np.arange(steps + 1) % 2, 4.0, 2.0)
        weights[[0, -1]] = 1.0
        works.append(ca.dot(ca.DM(weights / (3 * steps)).T, p * swept))
        state = history[:, -1]
    # work of the stroke that draws in, from the pressure at its start, and on to inlet closing [J]; gamma [-]
    gamma, least, full = _expanding(closed, t)[1], closed.chamber.clearance, volume(closed.chamber, math.pi)
    filled = least * (u / closed.pressure) ** (1 / gamma)
    drawn = (u * least - closed.pressure * filled) / (gamma - 1) + closed.pressure * (full - filled)
    rest = ca.Function(
        "rest", [z, t, u], [drawn, closed.pressure * (volume(closed.chamber, closed.closes) - full), gamma]
    )
    drawn, closing, gamma = rest(design, t_end, pressures[-1][-1])
    outputs = [ca.vertcat(*angles), ca.vertcat(*pressures), works[0] + works[1] + drawn + closing, works[1] + drawn,
               gamma]  # fmt: skip
    return ca.Function("open", [design, t_end], outputs, ["design", "t_end"], ["phi", "p", "work", "pumping", "gamma"])


def _expanding(closed: Closed, t: Scalar) -> tuple[Scalar, Scalar, Scalar]:
    """Mass [kg], ratio of the heat capacities [-] and gas constant [J/(kg K)] of what expands."""
    gas = properties(closed.gas, t, 1.0)
    mass = contents(closed, "after", closed.opens).mass
    return mass, 1 + gas.gas_constant / gas.heat_capacity, gas.gas_constant


def _pressure(closed: Closed, phi: Scalar, u: Scalar, t: Scalar) -> tuple[Scalar, Scalar, Scalar]:
    """Pressure [Pa], temperature [K] and mass [kg]."""
    mass, gamma, R = _expanding(closed, t)
    now, room = mass * u ** (-2 / (gamma - 1)), volume(closed.chamber, phi)
    there = t * (now / mass * volume(closed.chamber, closed.opens) / room) ** (gamma - 1)
    return now * R * there / room, there, now


def _slope(closed: Closed, valve: Blowdown, phi: Scalar, u: Scalar, t: Scalar) -> Scalar:
    p, there, now = _pressure(closed, phi, u, t)
    _, gamma, R = _expanding(closed, t)
    lift = valve_lift(phi, closed.opens, valve.exhaust_closes, valve.exhaust_lift)
    area = valve.valves * curtain_area(lift, valve.exhaust_diameter, valve.discharge)
    # gas that flows back has left with the entropy of what stayed
    outside = there * (valve.pressure / p) ** ((gamma - 1) / gamma)
    flow = orifice_flow(area, (p, there), (valve.pressure, outside), gamma, R)
    return (gamma - 1) / 2 * u * flow / (now * closed.omega)


def _step(slope: ca.Function, h: float) -> ca.Function:
    r"""One step of Rodas3 for one state: of order three, L-stable, so that a wide valve needs no short steps.

    Source: Sandu et al. (1997), "Benchmarking stiff ODE solvers for atmospheric chemistry problems II", Atmos.
    Environ. 31.
    """
    u, s, z, t = ca.SX.sym("u"), ca.SX.sym("s"), ca.SX.sym("z", slope.numel_in(2)), ca.SX.sym("t")
    at = slope(s, u, z, t)
    by_u, by_s = ca.jacobian(at, u), ca.jacobian(at, s)
    stages: list[ca.SX] = []
    for a, c, alpha, gamma in _RODAS3:
        here = u + sum((x * k for x, k in zip(a, stages, strict=False)), ca.SX(0))
        right = slope(s + alpha * h, here, z, t) + sum((x * k / h for x, k in zip(c, stages, strict=False)), ca.SX(0))
        stages.append((right + h * gamma * by_s) / (2 / h - by_u))
    return ca.Function("step", [u, s, z, t], [u + 2 * stages[0] + stages[2] + stages[3]])


# of each stage: weights of the stages before it in the state and in the slope, place in the step, share of df/ds
_RODAS3 = (
    ((), (), 0.0, 0.5),
    ((0.0,), (4.0,), 0.0, 1.5),
    ((2.0, 0.0), (1.0, -1.0), 1.0, 0.0),
    ((2.0, 0.0, 1.0), (1.0, -1.0, -8 / 3), 1.0, 0.0),
)


def check_blowdown(valve: Blowdown, intake_pressure: Pascal) -> None:
    """Refuse an exhaust that draws fresh gas through the cylinder."""
    if valve.pressure < intake_pressure:
        raise BadInput(
            f"blowdown.pressure = {valve.pressure:g} Pa is below cycle.intake_pressure = {intake_pressure:g} Pa: fresh "
            "gas would blow through; raise it, or follow the gas exchange with cycle.kind = 'gas-exchange'"
        )


_SECTIONS = ("chamber", "cycle", "gas", "heat_transfer", "friction_pressure")


@record
class ClosedEngine:
    """A four-stroke engine: sections of a case, and the motion of its pistons."""

    chamber: ChamberParameters
    motion: Motion  #: Travel of one piston; its parameters are the names `parameters.*` of a design
    cycle: SparkIgnition
    gas: ConstantGamma | NasaMixture
    heat_transfer: Law
    friction_pressure: Friction
    blowdown: Blowdown | None = None


def at_design(engine: ClosedEngine, design: Mapping[str, Scalar]) -> ClosedEngine:
    """The engine with some of its values replaced.

    design: mapping of str to value, dotted names; `omega` belongs to no section and is passed over. Returns engine: a
    copy; values that are CasADi symbols are not checked.
    """
    parts = {f.name: getattr(engine, f.name) for f in dataclasses.fields(engine)}
    for name, value in design.items():
        if name == "omega":
            continue
        section, _, key = name.partition(".")
        if section == "parameters" and key in parts["motion"].parameters:
            parameters = {**parts["motion"].parameters, key: value}
            parts["motion"] = dataclasses.replace(parts["motion"], parameters=parameters)
        elif isinstance(getattr(parts.get(section), key, None), (int, float)) and section != "motion":
            # dataclasses.replace would run the range checks, which cannot compare symbols
            twin = copy.copy(parts[section])
            object.__setattr__(twin, key, value)
            parts[section] = twin
        else:
            raise BadInput(f"{name!r} is not a number of the engine; names are {', '.join(design_names(engine))}")
    return ClosedEngine(**parts)


def check_design(engine: ClosedEngine, design: Mapping[str, Scalar]) -> None:
    """Refuse a design with numbers that the engine's own records would refuse.

    design: mapping of str to float or ndarray, dotted names to numbers; each is tried at its smallest and its largest
    value.
    """
    for name, values in design.items():
        section, _, key = name.partition(".")
        numbers = np.asarray(values, float)
        if name == "omega" and not np.all(numbers > 0):
            raise BadInput(f"omega = {numbers.min():g} rad/s is out of range; it must be > 0 rad/s")
        record: Any = getattr(engine, section, None)
        if section in _SECTIONS and hasattr(record, key):
            for value in (numbers.min(), numbers.max()):
                dataclasses.replace(record, **{key: float(value)})


def design_names(engine: ClosedEngine) -> list[str]:
    """Names that a design may hold."""
    names = ["omega", *(f"parameters.{key}" for key in engine.motion.parameters)]
    for section in _SECTIONS:
        record = getattr(engine, section)
        names += [f"{section}.{f.name}" for f in dataclasses.fields(record) if "unit" in f.metadata]
    return names


def closed_period(engine: ClosedEngine, design: Mapping[str, Scalar]) -> Closed:
    """The closed period at a design of `omega` [rad/s] and of names that replace values of the engine."""
    engine, omega = at_design(engine, design), design["omega"]
    cycle, room = engine.cycle, chamber(engine.chamber, engine.motion)
    held = charge(room, cycle, properties(engine.gas, cycle.intake_temperature, 0.0).gas_constant)
    starts, duration = timing(cycle, omega)
    return Closed(
        chamber=room, gas=engine.gas, law=engine.heat_transfer, omega=omega, closes=cycle.inlet_closes,
        starts=starts, duration=duration, opens=cycle.exhaust_opens, pressure=cycle.intake_pressure,
        temperature=cycle.intake_temperature, mass=held.gas, fuel=held.fuel, heat=held.heat,
        fuel_heat=held.fuel * cycle.heating_value, latent_heat=held.fuel * latent_heat(cycle),
        fuel_energy=vapour_energy(cycle, engine.gas),
        fuel_entry="premixed" if cycle.vaporisation == "none" else "vaporised",
        wiebe=(cycle.wiebe_a, cycle.wiebe_m, 1.0, 0.0, 0.0), blowdown=engine.blowdown,
    )  # fmt: skip
