r"""A machine as a block with ports: what an FMU, a page and a text export are written from.

    u (added to the inputs) --->|  x' = rates(t, x, u, p, w, s)       |---> y (kinematics, forces, reactions)
    p (tunable)             --->|  w: curves over a state, value and  |
                                |     slope; s: switches, 0 or 1      |

x holds coordinates and velocities. A curve is a piecewise polynomial, so its derivatives are exact; a switch goes from
0 to 1 at a time that is itself a parameter. `kinks` and `stops` are those of the problem.
"""

import dataclasses
from collections.abc import Callable, Mapping, Sequence

import casadi as ca
import scipy

from mechsym.errors import BadInput
from mechsym.hinge.guide import Guide, path, warmth
from mechsym.hinge.springs.face import Spring, lettered
from mechsym.jobs.problem import Ready
from mechsym.machine.loads import ConstantLoad, Load, PropellerLoad, TableLoad, propeller_torque
from mechsym.mechanisms import listing
from mechsym.mechanisms.projected import projected
from mechsym.mechanisms.record import Mechanism, acceleration_function, accelerations, bind, velocities
from mechsym.periodic.pieces import PPoly
from mechsym.quantities import record
from mechsym.simulate import Part, Problem, constrained
from mechsym.simulate.equations import fitted
from mechsym.simulate.problem import FormulaForce, Kinks, Periodic, Steps, Stop


@record
class Port:
    """A named scalar of a block, in SI."""

    name: str
    unit: str  #: of value and start
    start: float = 0.0  #: value at the start [unit]
    about: str = ""


@record
class Curve:
    """A piecewise polynomial over ratio times a state: periodic, or held beyond its ends."""

    name: str
    state: int  #: index in x
    ratio: float = 1.0  #: argument per unit of the state [-]
    poly: PPoly
    periodic: bool = True


@record
class LawPoint:
    """What a law is a function of."""

    t: ca.SX  #: Time [s]
    q: list[ca.SX]
    u: list[ca.SX]
    letters: Mapping[str, ca.SX]  #: Its parameters by name
    curves: list[tuple[ca.SX, ca.SX]]  #: Value and slope of each of its curves
    s: list[ca.SX]  #: Which of its switches have jumped


@record
class Law:
    """How a part of a problem depends on tunable parameters, where the part itself has only numbers.

    `outputs` gives what else is of interest, by name, with units in `units`.
    """

    part: str
    parameters: tuple[Port, ...] = ()
    curves: tuple[Curve, ...] = ()
    switches: tuple[str, ...] = ()  #: parameters that hold the times of its switches
    value: Callable[[LawPoint], ca.SX]
    outputs: Callable[[LawPoint], Mapping[str, ca.SX]] | None = None
    units: Mapping[str, str] = dataclasses.field(default_factory=dict)


@record
class Block:
    """A machine with its ports; functions take (t, x, u, p, w, s), w holds value and slope of each curve."""

    name: str
    about: str
    states: tuple[Port, ...]
    inputs: tuple[Port, ...]
    parameters: tuple[Port, ...]
    outputs: tuple[Port, ...]
    curves: tuple[Curve, ...]
    switches: tuple[str, ...]  #: parameters that hold the times of the switches
    kinks: tuple[Kinks, ...]
    stops: tuple[Stop, ...]
    t_end: float  #: of the run it was made from [s]
    rates: ca.Function
    observed: ca.Function
    #: x put on the loops, where some close by constraint: the others want it so
    closed: ca.Function | None = None

    def whole(self, function: ca.Function) -> ca.Function:
        """Rates or outputs of any x near the loops."""
        if self.closed is None:
            return function
        t, x, *rest = (ca.SX.sym(function.name_in(i), function.size1_in(i)) for i in range(function.n_in()))
        values = function(t, self.closed(t, x, *rest), *rest)
        return ca.Function(function.name(), [t, x, *rest], [values], {"cse": True})


def block(name: str, about: str, problem: Problem, laws: Sequence[Law] = ()) -> Block:
    """The block of a problem; `laws` say how its parts depend on parameters."""
    if "constraints" in problem.mechanism.functions and not problem.mechanism.dependents:
        why = "its constraints name no dependent coordinates"
        raise BadInput(f"{problem.mechanism.name} cannot run in time: {why}; declare them with m.dependents(..)")
    if problem.unilateral:
        why = f"{problem.unilateral[0].name} makes events, and an export has none"
        raise BadInput(f"{problem.mechanism.name}: {why}; simulate it with mechsym")
    given = {law.part: law for law in laws}
    chosen = [given.get(part.name) or law_of(problem, part) for part in problem.parts]
    mechanism, own = _tunable(problem.mechanism)
    ports = (*own, *(port for law in chosen for port in law.parameters))
    names = [p.name for p in ports]
    if twins := sorted({n for n in names if names.count(n) > 1}):
        raise BadInput(f"two parameters have the name {', '.join(twins)}; rename a part")
    n, curves = len(problem.mechanism.coordinates), sum(len(law.curves) for law in chosen)
    sizes = {"x": 2 * n, "u": len(problem.mechanism.inputs), "p": len(ports), "w": 2 * curves}
    sizes["s"] = sum(len(law.switches) for law in chosen)
    symbols = {"t": ca.SX.sym("t"), **{letter: ca.SX.sym(letter, size) for letter, size in sizes.items()}}
    loops = projected(mechanism, len(own)) if mechanism.dependents else None
    rates, outputs = _expressions(problem, mechanism, len(own), chosen, symbols, loops)
    units = _units(problem.mechanism) | {u: v for law in chosen for u, v in law.units.items()}
    units |= {f"{part.name}_on_{part.input}": units[part.input] for part in problem.parts}
    arguments = list(symbols.values())
    q, u = problem.mechanism.coordinates, velocities(problem.mechanism)
    closed = constrained.start(problem) if problem.mechanism.dependents else (problem.q0, problem.u0)
    starts = zip((*q, *u), (*closed[0], *closed[1]), strict=True)
    return Block(
        name=name, about=about,
        states=tuple(Port(name=n, unit=units[n], start=float(start)) for n, start in starts),
        inputs=tuple(Port(name=n, unit=units[n], about=f"added to what acts on {n}") for n in problem.mechanism.inputs),
        parameters=ports, outputs=tuple(Port(name=n, unit=units.get(n, "")) for n in outputs),
        curves=tuple(c for law in chosen for c in law.curves), kinks=problem.kinks, stops=problem.stops,
        switches=tuple(s for law in chosen for s in law.switches), t_end=problem.t_end,
        rates=ca.Function("rates", arguments, [ca.densify(rates)]),
        observed=ca.Function("observed", arguments, [ca.densify(ca.vertcat(*outputs.values()))]),
        closed=loops and _on_loops(loops[0], symbols, len(own)),
    )  # fmt: skip


def law_of(problem: Problem, part: Part) -> Law:
    """A part as it stands: a formula, a curve with a scale, or steps whose values and times are parameters."""
    value = part.value
    match value:
        case FormulaForce():
            return Law(part=part.name, value=lambda at: value.function(at.t, at.q, at.u, *value.numbers))
        case Periodic():
            state = problem.mechanism.coordinates.index(value.coordinate)
            return curve_law(part.name, Curve(name=part.name, state=state, poly=fitted(value)))
        case Steps():
            return _steps_law(problem, part, value)
    raise BadInput(f"part {part.name} is a plain function, which cannot be exported; give it as a formula or a table")


def curve_law(part: str, curve: Curve) -> Law:
    """A part that is a curve, with a factor on it as its parameter."""
    scale = Port(name=f"{part}_scale", unit="-", start=1.0, about=f"factor on {part}")
    name = scale.name
    return Law(part=part, parameters=(scale,), curves=(curve,), value=lambda at: at.letters[name] * at.curves[0][0])


def _steps_law(problem: Problem, part: Part, value: Steps) -> Law:
    unit = _units(problem.mechanism)[part.input]
    levels, times = [], []
    for i, level in enumerate(value.values):
        about = f"{part.name} after jump {i}" if i else "before any jump"
        levels.append(Port(name=f"{part.name}_{i}", unit=unit, start=level, about=about))
    for i, time in enumerate(value.times, 1):
        times.append(Port(name=f"{part.name}_time_{i}", unit="s", start=time, about=f"time of jump {i} of {part.name}"))

    def total(at: LawPoint) -> ca.SX:
        values = [at.letters[level.name] for level in levels]
        return values[0] + sum((at.s[i] * (values[i + 1] - values[i]) for i in range(len(times))), ca.SX(0))

    return Law(part=part.name, parameters=(*levels, *times), switches=tuple(p.name for p in times), value=total)


def _tunable(mechanism: Mechanism) -> tuple[Mechanism, tuple[Port, ...]]:
    """The mechanism with symbols for its parameters, where it has letters of its own."""
    try:
        units = listing(mechanism.name)["parameters"]
        symbols = {name: ca.SX.sym(name) for name in mechanism.parameters}
        bound = bind(mechanism.name, symbols)
    except (BadInput, ModuleNotFoundError, KeyError):
        # a crank train is put together from many instances of one throw; its numbers are bound
        return mechanism, ()
    if bound.inputs != mechanism.inputs or bound.coordinates != mechanism.coordinates:
        return mechanism, ()
    ports = [Port(name=n, unit=units[n], start=float(v)) for n, v in mechanism.parameters.items()]
    return bound, tuple(ports)


def _units(mechanism: Mechanism) -> dict[str, str]:
    known = listing(mechanism.name, mechanism)
    units = {n: unit for key in ("coordinates", "inputs", "outputs") for n, unit in known[key].items()}
    q = mechanism.coordinates
    # a machine may add a hinge torque to what its mechanism declares
    units = dict.fromkeys(mechanism.inputs, "N*m") | units
    units |= {n: f"{units[c]}/s" for n, c in zip(velocities(mechanism), q, strict=True)}
    return units | {n: f"{units[c]}/s^2" for n, c in zip(accelerations(mechanism), q, strict=True)}


def _on_loops(closed: ca.Function, symbols: Mapping[str, ca.SX], own: int) -> ca.Function:
    n = symbols["x"].numel() // 2
    both = closed.call([symbols["x"][:n], symbols["x"][n:], symbols["p"][:own]])
    return ca.Function("closed", list(symbols.values()), [ca.vertcat(*both)], {"cse": True})


def _expressions(
    problem: Problem,
    mechanism: Mechanism,
    own: int,
    laws: Sequence[Law],
    symbols: Mapping[str, ca.SX],
    loops: tuple[ca.Function, ca.Function] | None,
) -> tuple[ca.SX, dict[str, ca.SX]]:
    n = len(mechanism.coordinates)
    x, p = symbols["x"], ca.vertsplit(symbols["p"])
    letters = p[:own]
    q, u = ca.vertsplit(x[:n]), ca.vertsplit(x[n:])
    totals = dict(zip(mechanism.inputs, ca.vertsplit(symbols["u"]), strict=True))
    outputs: dict[str, ca.SX] = {}
    further: dict[str, ca.SX] = {}
    w, s, done = ca.vertsplit(symbols["w"]), ca.vertsplit(symbols["s"]), own
    for part, law in zip(problem.parts, laws, strict=True):
        named = {port.name: p[done + i] for i, port in enumerate(law.parameters)}
        curves = [(w[2 * i], w[2 * i + 1]) for i in range(len(law.curves))]
        at = LawPoint(t=symbols["t"], q=q, u=u, letters=named, curves=curves, s=s)
        value = law.value(at)
        totals[part.input] = totals[part.input] + value
        outputs[f"{part.name}_on_{part.input}"] = value
        further |= law.outputs(at) if law.outputs else {}
        done, w, s = done + len(law.parameters), w[2 * len(law.curves) :], s[len(law.switches) :]
    forces = list(totals.values())
    multipliers: list[ca.SX] = []
    if loops is None:
        qdd = acceleration_function(mechanism)(*q, *u, *forces, *letters)
    else:
        qdd, mu = loops[1](ca.vertcat(*q), ca.vertcat(*u), ca.vertcat(*forces), ca.vertcat(*letters))
        multipliers = ca.vertsplit(mu)
    outputs |= dict(zip(accelerations(mechanism), ca.vertsplit(qdd), strict=True)) | further
    seen = _observed(mechanism, "kinematics", [*q, *letters])
    # a bearing or a guide may put a coordinate out, which is a state by its name
    outputs |= {name: value for name, value in seen.items() if name not in mechanism.coordinates}
    group = "joints" if multipliers else "reactions"
    if group in mechanism.functions:
        outputs |= _observed(mechanism, group, [*q, *u, *ca.vertsplit(qdd), *forces, *multipliers, *letters])
    return ca.vertcat(*u, qdd), outputs


def _observed(mechanism: Mechanism, group: str, arguments: Sequence[ca.SX]) -> dict[str, ca.SX]:
    function = mechanism.functions[group]
    values = function.call(list(arguments[: function.n_in()]))
    return dict(zip(function.name_out(), values, strict=True))


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
            poly = PPoly(fitted.c, fitted.x)
            curve = Curve(name=part, state=speed, poly=poly, periodic=False)
            return Law(part=part, curves=(curve,), value=lambda at: at.curves[0][0])
    raise ValueError(f"load {load!r} is not settled")
