"""Parts of an engine with their numbers as tunable parameters: the hinge with its spring, and the load."""

import dataclasses
from typing import Any

import scipy

from mechsym.hinge.guide import Guide, Spring, path, warmth
from mechsym.hinge.springs import AirGauge, Coil, absolute_pressure, coil_force, gauge_pressure
from mechsym.hinge.thermal import AirThermal, thermal_pressure
from mechsym.jobs.export import Ready
from mechsym.machine.loads import ConstantLoad, Load, PropellerLoad, TableLoad, propeller_torque
from mechsym.out.block import Block, Curve, Law, Port, block

_GAS = ("A", "H", "p0", "pa")  # numbers of a gas that exchanges heat which may be tuned; its temperature is a curve
_ABOUT = {"rho0": "distance of the roller centres with the spring at its free height"}


def block_of(name: str, about: str, ready: Ready) -> Block:
    """The block of a run, with the numbers of its spring and its load as parameters."""
    problem = ready.problem
    laws: list[Law] = []
    if ready.guide is not None:
        laws.append(hinge_law("hinge", ready.guide, ready.guide.spring))
    if ready.load is not None:
        laws.append(load_law("load", ready.load, 2 * len(problem.mechanism.coordinates) - 1))
    return block(name, about, problem, laws)


def hinge_law(part: str, guide: Guide, spring: Spring, state: int = 0) -> Law:
    r"""A guide and its spring: the path of the rollers is a curve, the numbers of the spring are parameters.

    .. math:: M_h = \text{shaft ratio}\; c\, F(c(\rho_0 - \rho))\, \rho'(\theta)
    """
    fields = [f for f in dataclasses.fields(spring) if not isinstance(spring, AirThermal) or f.name in _GAS]
    ports = [_port(f, float(getattr(spring, f.name))) for f in fields]
    ports.append(Port(name="rho0", unit="m", start=guide.parameters.rho0, about=_ABOUT["rho0"]))
    ratio, c = guide.parameters.shaft_ratio, guide.rollers
    drawn = [Curve(name="rho", state=state, ratio=ratio, poly=path(guide))]
    if isinstance(spring, AirThermal):  # its temperature is that of steady running at the speed of the design
        drawn.append(Curve(name="warmth", state=state, ratio=ratio, poly=warmth(guide, spring)))

    def motion(letters: Any, curves: Any) -> tuple[Any, Any, Any, Any]:
        rho, slope = curves[0]
        return rho, slope, c * (letters["rho0"] - rho), curves[-1][0]

    def value(t: Any, q: Any, u: Any, letters: Any, curves: Any, s: Any) -> Any:
        _, slope, z, warm = motion(letters, curves)
        return ratio * c * _force(spring, z, letters, warm) * slope

    def outputs(t: Any, q: Any, u: Any, letters: Any, curves: Any, s: Any) -> dict[str, Any]:
        rho, _, z, warm = motion(letters, curves)
        pressure = {} if isinstance(spring, Coil) else {"spring_pressure": _pressure(spring, z, letters, warm)}
        return {"rho": rho, "spring_closing": z, "spring_force": _force(spring, z, letters, warm), **pressure}

    units = {"rho": "m", "spring_closing": "m", "spring_force": "N", "spring_pressure": "Pa"}
    return Law(part=part, parameters=tuple(ports), curves=tuple(drawn), value=value, outputs=outputs, units=units)


def _port(field: dataclasses.Field[Any], value: float) -> Port:
    about = field.metadata.get("about", "")
    return Port(name=field.name, unit=field.metadata["unit"], start=value, about=f"spring: {about}")


def _pressure(spring: Spring, z: Any, letters: Any, warm: Any) -> Any:
    H, p0 = letters["H"], letters["p0"]
    if isinstance(spring, AirThermal):
        return thermal_pressure(z, H, p0, letters["pa"], warm)
    if isinstance(spring, AirGauge):
        return gauge_pressure(z, H, p0, letters["n"])
    return absolute_pressure(z, H, p0, letters["n"], letters["pa"])


def _force(spring: Spring, z: Any, letters: Any, warm: Any) -> Any:
    if isinstance(spring, Coil):
        return coil_force(z, letters["k"], letters["F0"])
    return letters["A"] * _pressure(spring, z, letters, warm)


def load_law(part: str, load: Load, speed: int) -> Law:
    """A settled load law of the speed with that index in x; its numbers are parameters, a table is a curve."""
    torque = "torque of the load"
    match load:
        case ConstantLoad(torque=float(number)):
            port = Port(name="load_torque", unit="N*m", start=number, about=torque)
            return Law(part=part, parameters=(port,), value=lambda t, q, u, p, w, s: p["load_torque"])
        case PropellerLoad(torque=float(number), speed=float(reference)):
            ports = (
                Port(name="load_torque", unit="N*m", start=number, about=f"{torque} at its speed of reference"),
                Port(name="load_speed", unit="rad/s", start=reference, about="speed of reference of the load"),
            )
            return Law(
                part=part, parameters=ports,
                value=lambda t, q, u, p, w, s: propeller_torque(_speed(q, u, speed), p["load_torque"], p["load_speed"]),
            )  # fmt: skip
        case TableLoad():
            curve = Curve(name=part, state=speed, poly=_table(load), periodic=False)
            return Law(part=part, curves=(curve,), value=lambda t, q, u, p, w, s: w[0][0])
    raise ValueError(f"load {load!r} is not settled")


def _speed(q: Any, u: Any, index: int) -> Any:
    return (*q, *u)[index]


def _table(load: TableLoad) -> "scipy.interpolate.PPoly":
    curve = scipy.interpolate.PchipInterpolator(load.speeds, load.torques)
    return scipy.interpolate.PPoly(curve.c, curve.x)
