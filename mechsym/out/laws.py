"""Parts of an engine with their numbers as tunable parameters: the hinge with its spring, and the load."""

import dataclasses

import casadi as ca
import scipy

from mechsym.hinge.guide import Guide, path, warmth
from mechsym.hinge.springs.face import Spring, lettered
from mechsym.jobs.problem import Ready
from mechsym.machine.loads import ConstantLoad, Load, PropellerLoad, TableLoad, propeller_torque
from mechsym.out.block import Block, Curve, Law, LawPoint, Port, block

_RHO0 = "distance of the roller centres with the spring at its free height"


def block_of(name: str, about: str, ready: Ready) -> Block:
    """The block of a run, with the numbers of its spring and its load as parameters."""
    problem = ready.problem
    laws: list[Law] = []
    if ready.guide is not None:
        laws.append(hinge_law("hinge", ready.guide, ready.guide.spring))
    if ready.load is not None:
        n = len(problem.mechanism.coordinates)
        # the flywheel comes last on a shaft that twists, the shaft first of what loops hold
        laws.append(load_law("load", ready.load, n if problem.mechanism.dependents else 2 * n - 1))
    return block(name, about, problem, laws)


def hinge_law(part: str, guide: Guide, spring: Spring, state: int = 0) -> Law:
    r"""A guide and its spring: the path of the rollers is a curve, the numbers of the spring are parameters.

    .. math:: M_h = \text{shaft ratio}\; c\, F(c(\rho_0 - \rho))\, \rho'(\theta)
    """
    ports = []
    for field in (f for f in dataclasses.fields(spring) if f.name in spring.tunable):
        about, start = f"spring: {field.metadata.get('about', '')}", float(getattr(spring, field.name))
        ports.append(Port(name=field.name, unit=field.metadata["unit"], start=start, about=about))
    ports.append(Port(name="rho0", unit="m", start=guide.parameters.rho0, about=_RHO0))
    ratio, c = guide.parameters.shaft_ratio, guide.rollers
    drawn = [Curve(name="rho", state=state, ratio=ratio, poly=path(guide))]
    if spring.state:  # its temperature is that of steady running at the speed of the design
        drawn.append(Curve(name="warmth", state=state, ratio=ratio, poly=warmth(guide)))

    def motion(at: LawPoint) -> tuple[ca.SX, ca.SX, ca.SX, ca.SX]:
        rho, slope = at.curves[0]
        return rho, slope, c * (at.letters["rho0"] - rho), at.curves[-1][0]

    def value(at: LawPoint) -> ca.SX:
        _, slope, z, warm = motion(at)
        return ratio * c * lettered(spring, at.letters).force(z, warm) * slope

    def outputs(at: LawPoint) -> dict[str, ca.SX]:
        rho, _, z, warm = motion(at)
        symbols = lettered(spring, at.letters)
        outward = {"rho": rho, "spring_closing": z, "spring_force": symbols.force(z, warm)}
        return outward | ({"spring_pressure": symbols.pressure(z, warm)} if spring.gas else {})

    units = {"rho": "m", "spring_closing": "m", "spring_force": "N", "spring_pressure": "Pa"}
    return Law(part=part, parameters=tuple(ports), curves=tuple(drawn), value=value, outputs=outputs, units=units)


def load_law(part: str, load: Load, speed: int) -> Law:
    """A settled load law of the speed with that index in x; its numbers are parameters, a table is a curve."""
    torque = "torque of the load"
    match load:
        case ConstantLoad(torque=float(number)):
            port = Port(name="load_torque", unit="N*m", start=number, about=torque)
            return Law(part=part, parameters=(port,), value=lambda at: at.letters["load_torque"])
        case PropellerLoad(torque=float(number), speed=float(reference)):
            ports = (
                Port(name="load_torque", unit="N*m", start=number, about=f"{torque} at its speed of reference"),
                Port(name="load_speed", unit="rad/s", start=reference, about="speed of reference of the load"),
            )

            def propeller(at: LawPoint) -> ca.SX:
                return propeller_torque((*at.q, *at.u)[speed], at.letters["load_torque"], at.letters["load_speed"])

            return Law(part=part, parameters=ports, value=propeller)
        case TableLoad():
            fitted = scipy.interpolate.PchipInterpolator(load.speeds, load.torques)
            poly = scipy.interpolate.PPoly(fitted.c, fitted.x)
            curve = Curve(name=part, state=speed, poly=poly, periodic=False)
            return Law(part=part, curves=(curve,), value=lambda at: at.curves[0][0])
    raise ValueError(f"load {load!r} is not settled")
