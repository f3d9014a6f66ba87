"""Machines at speeds and loads as points of a co-design, of the family of `[codesign]` too; its hardware."""

import ast
import csv
import dataclasses
import io
import itertools
import math
from collections.abc import Callable, Sequence
from typing import Any

import casadi as ca
import numpy as np

from mechsym import periodic
from mechsym.codesign.points import Function, Point
from mechsym.codesign.settings import CoDesignSettings
from mechsym.codesign.task import Hardware
from mechsym.cycle.kinds import kind_of
from mechsym.cycle.pressure import unfired, unfired_kinks
from mechsym.errors import BadInput, shown
from mechsym.files.inputs import read_text
from mechsym.hinge.choices import GuideParameters
from mechsym.hinge.rollers import RollerParameters
from mechsym.hinge.springs.face import Spring
from mechsym.hinge.torque import EngineTorques, Hinge, engine_torques, torque
from mechsym.machine.record import Machine, acting, lever, only_gas
from mechsym.periodic.pieces import PPoly
from mechsym.quantities import parse, quantity, record
from mechsym.quantities.records import Record
from mechsym.quantities.units import Array, Inertia, NewtonMetre, Pascal, Pure, Radian, RadPerSecond

_KEPT = 6  # angles of a function that is remembered


def point(machine: Machine, load: Pascal, law: str = "propeller", weight: Pure = 1.0) -> Point:
    """An engine at its speed of operation as a point of a co-design.

    load: mean indicated pressure, for the record. law: how the load follows the speed: `propeller` or `constant`.
    weight: share of the time at this point.
    """
    torques, wanted = engine_torques(machine), torque(machine)
    shaped = dataclasses.replace(_point(wanted, torques, load, law, weight), **_formulas(machine, torques.period))
    gas = only_gas(machine)
    # of a torque alone no turn without combustion is known, and what takes work has none to lose
    if gas is None or wanted.load_torque <= 0:
        return shaped
    without = unfired(gas.force, torques.period)

    def misfire(phi: np.ndarray) -> np.ndarray:
        arm = lever(machine.mechanism, machine.gas_input)(phi)
        return np.asarray(without(phi) * arm + torques.gravity_torque(phi))

    return dataclasses.replace(
        shaped, misfire=_remembered(misfire), misfire_kinks=unfired_kinks(torques.kinks, torques.period)
    )


def _formulas(machine: Machine, period: float) -> dict[str, Any]:
    """Torque and inertia as formulas of the angle, where gas by formulas and weight are all that acts."""
    forces = acting(machine)
    if not forces or not all(force.formulas for force in forces):
        return {}
    dynamics, (q,) = machine.mechanism.functions["dynamics"], machine.mechanism.coordinates
    phi = ca.SX.sym("phi")
    letters = {name: ca.SX(0) for name in dynamics.name_in()} | {q: phi}
    start = forces[0].formulas[0][0]
    start -= period * math.ceil(start / period)
    end = start + period
    laws = [(f.input, a + k * own, b + k * own, law, k * own) for f in forces
            for own in (f.formulas[-1][1] - f.formulas[0][0],)
            for a, b, law in f.formulas for k in range(-2, round(period / own) + 3)]  # fmt: skip
    edges = sorted({start, end, *(a for _, a, *_ in laws if start + 1e-12 < a < end - 1e-12)})
    pieces = []
    for a, b in itertools.pairwise(edges):
        pushed = dict[str, Any]()
        for name, low, high, law, shift in laws:
            if low < (a + b) / 2 < high:
                pushed[name] = pushed.get(name, 0) + law(phi - shift)
        torque_there = dynamics(**letters | pushed)["generalized_force"]
        pieces.append((a, b, ca.Function("torque", [phi], [torque_there])))
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
    spline = PPoly.spline(np.append(angle, angle[0] + period), np.append(value, value[0]), periodic=True)
    driving = periodic.fit(spline, angle, period, 1e-10)
    mean = periodic.mean(driving)
    wanted = PPoly(-driving.c, driving.x, extrapolate="periodic")
    wanted.c[-1] += mean
    constant = PPoly(np.array([[inertia]]), np.array([0.0, period]), extrapolate="periodic")
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
        spring=spring, rho0=guide.rho0, z_margin=guide.z_margin, count=guide.rollers,
        shaft_ratio=guide.shaft_ratio, radius=rollers.radius, width=rollers.width, E=rollers.E, nu=rollers.nu,
        moving_mass=moving_mass,
    )  # fmt: skip


_COMBUSTION = ("a_p", "m_p", "a_d", "m_d", "b")  # of the double Wiebe function
_COLUMNS = {"speed": "rad/s", "load": "Pa", "weight": "-"}
_FUNCTIONS: dict[str, Callable[..., float]] = {"max": max, "min": min}

_MOST = 100  # points; each brings about 200 unknowns and 800 constraints


@record
class SpeedAndLoad:
    """One speed and load of a family."""

    omega: float = quantity("rad/s", above=0, about="speed")
    mep: float = quantity("Pa", above=0, about="mean indicated pressure")
    weight: float = quantity("-", default=1.0, low=0, about="share of the time")


def places(settings: CoDesignSettings) -> list[SpeedAndLoad]:
    """Speeds and loads of the curve `propeller` or `constant_speed`, or of a CSV file."""
    pairs = _places(settings)
    if not 0 < len(pairs) <= _MOST:
        raise BadInput(f"{len(pairs)} points of speed and load; allowed are 1 to {_MOST} in one design")
    return pairs


def _places(settings: CoDesignSettings) -> list[SpeedAndLoad]:
    if settings.curve.endswith(".csv"):
        return _from_file(settings.curve)
    if settings.curve == "propeller":
        shares = [(s, (s / settings.full_speed) ** 2) for s in settings.speeds]
        pairs = [(s, share * load) for s, share in shares for load in settings.loads]
    else:
        pairs = [(s, load) for s in settings.speeds for load in settings.loads]
    return [SpeedAndLoad(omega=s, mep=share * settings.full_load) for s, share in pairs]


def _from_file(name: str) -> list[SpeedAndLoad]:
    """Points of a CSV file with the headings speed, load and perhaps weight, each with its unit: `speed [rpm]`."""
    rows = list(csv.reader(io.StringIO(read_text(name, "codesign.curve =", "give a CSV file of points"), newline="")))
    heads = [head.strip().partition("[") for head in rows[0]] if rows else []
    columns = {head.strip(): (i, unit.rstrip("] ")) for i, (head, _, unit) in enumerate(heads)}
    if not {"speed", "load"} <= set(columns) <= set(_COLUMNS):
        raise BadInput(f"{name}: the headings are speed [rpm], load [bar] and perhaps weight, not {rows[:1]}")
    pairs = []
    for number, row in enumerate(rows[1:], start=2):
        if len(row) != len(heads):
            raise BadInput(f"{name}, line {number}: {len(row)} values below {len(heads)} headings")
        values = {key: parse(f"{row[i].strip()} {unit}".strip(), _COLUMNS[key], f"{name}, line {number}: {key}")
                  for key, (i, unit) in columns.items()}  # fmt: skip
        pairs.append(SpeedAndLoad(omega=values["speed"], mep=values["load"], weight=values.get("weight", 1.0)))
    return pairs


def cycle_at(cycle: Record, high: Record | None, settings: CoDesignSettings, mep: float) -> Record:
    """The cycle of a case at another mean indicated pressure [Pa]; what else follows it is in the settings.

    high: record, optional, cycle at the upper end; combustion is linear in mep between the two and constant outside.
    """
    kind = kind_of(cycle)
    if not kind.load:
        if abs(mep - settings.full_load) > 1e-9 * settings.full_load:
            raise BadInput(
                "[cycle] has no mean_indicated_pressure that could be changed; it has one load: "
                "take --curve constant_speed and --loads 1, at any speeds"
            )
        return cycle
    changed: dict[str, float] = {kind.load: mep}
    if kind.scavenge and settings.scavenge:
        changed[kind.scavenge] = scavenge_pressure(settings.scavenge, mep)
    if high is not None:
        low_mep, high_mep = getattr(cycle, kind.load), getattr(high, kind.load)
        share = float(np.clip((mep - low_mep) / (high_mep - low_mep), 0, 1)) if high_mep != low_mep else 0.0
        for name in _COMBUSTION:
            changed[name] = (1 - share) * getattr(cycle, name) + share * getattr(high, name)
    return dataclasses.replace(cycle, **changed)


def scavenge_pressure(text: str, mep: float) -> float:
    """Absolute scavenge pressure [Pa] at a mean indicated pressure [Pa], from a text such as `1.6 + (mep-8)/6 bar`.

    The text holds numbers, mep in bar, + - * / **, max and min; its value is in bar.
    """
    formula = text.rpartition("=")[2].strip().removesuffix("bar").strip()
    try:
        value = _value(ast.parse(formula, mode="eval").body, {"mep": mep / 1e5})
    except (SyntaxError, ValueError, ZeroDivisionError, OverflowError, TypeError) as error:
        raise BadInput(
            f"codesign.scavenge = {shown(text)} cannot be read ({error}); write for example "
            '"p_s = max(1.05, 1.6 + (mep-8)/6) bar", mep in bar'
        ) from None
    if not math.isfinite(value) or value <= 0:
        raise BadInput(
            f"codesign.scavenge = {shown(text)} gives {value:g} bar at mep = {mep / 1e5:g} bar; it must be > 0"
        )
    return 1e5 * value


def _value(node: ast.AST, names: dict[str, float]) -> float:
    match node:
        case ast.Constant(value=int() | float() as number) if not isinstance(number, bool):
            return float(number)
        case ast.Name(id=name) if name in names:
            return names[name]
        case ast.UnaryOp(op=ast.USub(), operand=inner):
            return -_value(inner, names)
        case ast.BinOp(left=left, op=op, right=right):
            return _binary(op, _value(left, names), _value(right, names))
        case ast.Call(func=ast.Name(id=name), args=args, keywords=[]) if name in _FUNCTIONS and args:
            return float(
                _FUNCTIONS[name](*(_value(a, names) for a in args)) if len(args) > 1 else _value(args[0], names)
            )
    raise ValueError("it may hold numbers, mep, + - * / **, max and min")


def _binary(op: ast.operator, a: float, b: float) -> float:
    match op:
        case ast.Add():
            return a + b
        case ast.Sub():
            return a - b
        case ast.Mult():
            return a * b
        case ast.Div():
            return a / b
        case ast.Pow() if abs(b) <= 10:
            return float(a**b)
    raise ValueError("it may hold + - * / and small powers")
