"""Doubts of what a case gives: its gas, its motion, a run of it, its forces, its cycle."""

import math
from collections.abc import Callable, Iterator
from dataclasses import asdict, replace
from typing import TYPE_CHECKING

import numpy as np

from mechsym.cases import Case
from mechsym.cases.at_start import NOTHING, idle, of_inertia
from mechsym.cases.doubts import by_stroke
from mechsym.cases.laws import bore as bore_of
from mechsym.cases.laws import fired
from mechsym.cases.links import by_force, by_links, linked
from mechsym.cycle.gas import Gas
from mechsym.cycle.kinds import kind_of
from mechsym.cycle.motion import pistons_of, travel_of
from mechsym.errors import BadInput
from mechsym.files import Json
from mechsym.forces.result import Forces
from mechsym.mechanisms import own
from mechsym.mechanisms.plan import plan_of, roles_of
from mechsym.mechanisms.record import Mechanism
from mechsym.plausible import PROPORTIONS, Doubt, inputs, moving_mass, piston_speed, proportion, proportions, results
from mechsym.quantities.units import Metre, Pure
from mechsym.simulate.result import Result, RunNumbers

if TYPE_CHECKING:
    from mechsym.forces.driven import DrivenForces

# what commands tell of the gas, the key of its limit, and the unit it is told in [SI]
_LIMITED = (("p_max_mpa", "peak_pressure", 1e6), ("p_max_bar", "peak_pressure", 1e5),
            ("t_max_k", "peak_temperature", 1.0), ("knock", "knock", 1.0))  # fmt: skip
_LAST = 10  # of all results, the last tenth
PISTON_SPEED = next(kind.highest for kind in PROPORTIONS if kind.code == "piston_speed")  # what is refused [m/s]


def of_gas(case: Case, gas: Gas | None) -> tuple[Doubt, ...]:
    """Peak pressure, mean pressure and temperature of the gas that drives a machine; none without gas."""
    if gas is None:
        return ()
    pressure = gas.pressure
    figures = {"p_max_bar": pressure.p_max / 1e5, "mep_bar": pressure.mean_indicated / 1e5}
    figures |= {} if pressure.t_max is None else {"t_max_k": pressure.t_max}
    return results(figures) + of_limits(case, figures)


def of_limits(case: Case, columns: Json) -> tuple[Doubt, ...]:
    """Where the gas goes beyond what `[gas_limits]` of the case allows.

    columns: mapping of str to float or ndarray, any of `p_max_mpa`, `p_max_bar`, `t_max_k` and `knock`, and rows of
    cycles in `cycles` [MPa, bar, K, -].
    """
    limits, doubts = case.sections.get("gas_limits"), []
    for name, key, unit in _LIMITED if limits is not None else ():
        rows = [row[name] for row in columns.get("cycles", ()) if name in row]
        values = np.asarray(np.append(columns.get(name, ()), rows), float)
        limit = getattr(limits, key)
        if limit is None or not np.any(values[np.isfinite(values)] > limit / unit):
            continue
        why = f"gas_limits.{key} of the case; change the design, or the limit"
        worst = float(np.nanmax(values))
        usual = f"at most {limit / unit:g}"
        doubts.append(Doubt(code=f"limit_{key}", quantity=name, value=worst, usual=usual, why=why))
    return tuple(doubts)


def of_own(case: Case, turning: Callable[[Case], Mechanism]) -> tuple[Doubt, ...]:
    r"""Whether a mechanism can turn; one that says no stroke, by its pistons: speed, stroke, mass that the crank feels.

    .. math:: I(\varphi) \approx I_0 + m \sum_i x_i'(\varphi)^2

    turning: gives the mechanism with one coordinate; asked where there is something to judge.
    """
    if "operation" not in case.sections:
        return ()
    try:
        mechanism = turning(case)
    except BadInput:  # one that cannot turn is refused by the command itself
        return ()
    phi = np.linspace(0.0, math.tau, 361)[None, :-1]
    inwards = tuple(_inwards(case, mechanism, phi))
    if plan_of(case.mechanism).proportions(case.need("parameters")) is not None:
        return inwards
    dynamics = mechanism.functions["dynamics"]
    inertia = np.asarray(dynamics(phi, *[0.0] * (dynamics.n_in() - 1))[0]).ravel()
    closed = np.isfinite(inertia)
    if not closed.all():
        return proportion("open_loop", "operation: share of a turn in which the loops close", float(closed.mean()))
    inner = (*inwards, *_borne(case, mechanism, phi))
    if own.is_file(case.mechanism):
        inner += (*of_inertia(case, mechanism, {}), *_idle(case, mechanism, phi))
    bore = bore_of(case.sections)
    if not bore:
        return inner
    travels = [travel_of(mechanism, piston.travel)(phi) for piston in pistons_of(case.mechanism)]
    x, dx = (np.array([np.asarray(travel[k]).ravel() for travel in travels]) for k in (0, 1))
    stroke, area, omega = float(np.ptp(x, axis=1).max()), math.pi / 4 * bore**2, case.need("operation").speed
    raised = inner + proportions(stroke, None, omega, fired(case.sections))
    raised += proportion("stroke_ratio", "stroke of the pistons / bore", stroke / bore)
    raised += by_stroke(case.sections, stroke, bore)
    squares = (dx**2).sum(axis=0)
    columns = np.stack([np.ones(inertia.size), squares], axis=1)
    least, mass = (float(v) for v in np.linalg.lstsq(columns, inertia)[0])
    # beams and rods, which are judged by themselves, move with the pistons by a share between nothing and all
    links = linked(plan_of(case.mechanism).listing(None), asdict(case.need("parameters"))) / len(x)
    # the squares of many pistons add up to nearly a constant, which tells nothing of one
    if mass > links and np.ptp(squares) > 0.1 * squares.mean():
        what = "mass that the crank feels with a piston"
        doubts = moving_mass(what, mass - links, area, bore, stroke)
        raised += doubts if doubts and moving_mass(what, mass, area, bore, stroke) else ()
    work = 1e6 * area * stroke * len(x)  # at ten bar, about full load
    return raised + (proportion("shaft_energy", "work of a turn / energy of the shaft", work / (least * omega**2))
                    if least > 0 and omega else ())  # fmt: skip


def _inwards(case: Case, mechanism: Mechanism, phi: np.ndarray) -> Iterator[Doubt]:
    """The first piston whose pin is nearest to the only shaft where its gas has the least room: on its inner side."""
    pins = plan_of(case.mechanism).listing(None).get("pins", {})
    if "cycle" not in case.sections or not pins:
        return
    function = mechanism.functions["drawing"]
    drawn = dict(zip(function.name_out(), function.call([phi]), strict=True))
    places = [[np.asarray(drawn[name]).ravel() for name in pair] for pair in pins.values() if len(pair) == 2]
    at = [x + 1j * y for x, y in places]
    shafts = [one[0] for one in at if np.ptp(one.real) + np.ptp(one.imag) == 0]
    for piston in pistons_of(case.mechanism) if len(shafts) == 1 else ():
        x = np.asarray(travel_of(mechanism, piston.travel)(phi)[0]).ravel()
        for pin in at:
            rides = np.abs(np.abs(pin - pin[np.argmin(x)]) - (x - x.min())).max() < 1e-9 * np.ptp(x)
            inner, outer = (abs(pin[k(x)] - shafts[0]) for k in (np.argmin, np.argmax))
            if rides and inner < outer:
                what = f"{piston.name}: distance from the shaft at top dead centre by that at the bottom"
                yield from proportion("inwards", what, float(inner / outer))
                return


def _idle(case: Case, mechanism: Mechanism, phi: np.ndarray) -> Iterator[Doubt]:
    """Constants of `[inputs]` that do nothing at any angle: what they act on does not move."""
    given = asdict(case.need("inputs")) if "inputs" in case.sections else {}
    dynamics, (q,) = mechanism.functions["dynamics"], mechanism.coordinates
    *_, rest = dynamics(*({q: phi}.get(name, 0.0) for name in dynamics.name_in()))
    for name, acting in given.items():
        if not isinstance(acting, float) or not acting:
            continue
        *_, driven = dynamics(*({q: phi, name: acting}.get(one, 0.0) for one in dynamics.name_in()))
        if np.nanmax(np.abs(np.asarray(driven) - np.asarray(rest)), initial=0.0) < NOTHING * abs(acting):
            yield idle(name)


def _borne(case: Case, mechanism: Mechanism, phi: np.ndarray) -> tuple[Doubt, ...]:
    """What joints bear at the speed of operation by inertia alone, by the stoutest link; none where none is known."""
    reactions, q = mechanism.functions.get("reactions"), mechanism.coordinates[0]
    listing = plan_of(case.mechanism).listing(None)
    if reactions is None or any(doubt.code == "point_speed" for doubt in case.doubts):  # one slip is told once
        return ()
    at = {q: phi, f"{q}d": case.need("operation").speed}
    forces = reactions(*(at.get(name, 0.0) for name in reactions.name_in()))
    pairs = zip(reactions.name_out(), forces if isinstance(forces, (tuple, list)) else [forces], strict=True)
    borne = [float(np.nanmax(np.abs(np.asarray(v)))) for name, v in pairs if name in listing.get("reactions", {})]
    return by_force(listing, asdict(case.need("parameters")), max(borne, default=0.0))


def of_run(case: Case, gas: Gas | None, result: Result, run: RunNumbers) -> tuple[Doubt, ...]:
    """Doubts of a run in time, and of the gas that drives it. run: the numbers of the result."""
    wanted, doubts = case.sections.get("simulation"), of_gas(case, gas)
    sizes = plan_of(case.mechanism).proportions(case.need("parameters"))
    if sizes is not None:
        # refused before a run, doubted as the outcome of one
        speed = min(abs(run.speed_max), PISTON_SPEED * math.pi / sizes.stroke)
        doubts += piston_speed("highest mean piston speed of the run", sizes.stroke, speed, fired(case.sections))
    else:
        listing = plan_of(case.mechanism).listing(None)
        links = by_links(listing, asdict(case.need("parameters")), {}, _fastest(run))
        doubts += tuple(doubt for doubt in links if doubt.code == "point_speed")
    doubts += _motion(case, result, run)
    length = float(result.t[-1] - result.t[0])
    if wanted is None or wanted.window is None or not length > 0:
        return doubts
    return doubts + proportion("window", "simulation.window / length of the run", wanted.window / length)


def _fastest(run: RunNumbers) -> dict[str, float]:
    """Highest speed of each coordinate either way, over the window [its unit]."""
    return {q: max(abs(speed["min"]), abs(speed["max"])) for q, speed in run.speeds.items()}


def _motion(case: Case, result: Result, run: RunNumbers) -> tuple[Doubt, ...]:
    """Speeds of what slides, sense of rotation, whether the drive drives, and turns between two results."""
    wanted, work = case.sections.get("simulation"), run.energy.work
    doubts: tuple[Doubt, ...] = ()
    for number, (name, fastest) in enumerate(_fastest(run).items()):
        if run.speeds[name].units["max"] == "m/s":
            doubts += proportion("point_speed", f"highest speed along {name}", fastest)
        elif number:  # the first is judged by itself
            beyond = results({"speed_max": fastest})
            doubts += tuple(replace(doubt, quantity=f"highest speed of {name}") for doubt in beyond)
    rotors = (str(rotor.angle) for rotor in roles_of(case.mechanism).rotors)
    shaft = next((angle for angle in rotors if angle in run.speeds), next(iter(run.speeds)))
    turning = run.speeds[shaft]
    if turning.units["mean"] != "rad/s":
        return doubts
    if wanted is not None and wanted.output_step:
        what = "simulation.output_step in turns of the run"
        doubts += proportion("aliasing", what, wanted.output_step * _fastest(run)[shaft] / math.tau)
    driven, mean = "drive" in work or "cycle" in case.sections, turning["mean"]  # what swings by itself goes either way
    if driven and (getattr(wanted, "speed_start", None) or 0.0) >= 0:
        doubts += proportion("backwards", "mean speed at the end of the run", mean)
        first = asdict(case.sections["start"]) if "start" in case.sections else {}
        start = getattr(wanted, "speed_start", None) or first.get(f"{shaft}d")
        if start and start > 0 and mean >= 0 and work.get("drive", 0.0) > 0:
            last = result.columns[f"{shaft}d"][-max(1, len(result.t) // _LAST) :]
            what = "mean speed of the last results of the run / speed at its start"
            doubts += proportion("stall", what, float(np.mean(last)) / start) if np.isfinite(last).all() else ()
    return doubts + (proportion("drive_work", "work of [drive] in the run", work["drive"]) if "drive" in work else ())


def of_forces(case: Case, forces: Forces) -> tuple[Doubt, ...]:
    """Doubts of the forces of a turn: its gas, and pins, bearings and guides by the largest gas force."""
    pushes = [float(np.abs(push).max()) for push in forces.turn.inputs.values()]
    vectors = [*((pin.x, pin.y) for pin in forces.loads.pins), *forces.loads.bearings.values()]
    largest = max((float(np.hypot(x, y).max()) for x, y in vectors), default=0.0)
    largest = max([largest, *(float(np.abs(side).max()) for side in forces.loads.guides.values())])
    listing = plan_of(case.mechanism).listing(None)
    borne = [
        float(np.abs(forces.columns[name]).max()) for name in listing.get("reactions", {}) if name in forces.columns
    ]
    stress = by_force(listing, asdict(case.need("parameters")), max(borne, default=0.0))
    doubts = of_gas(case, forces.turn.gas) + _driven(case, forces)
    if forces.turn.gas is None and any(rotor.drive for rotor in roles_of(case.mechanism).rotors):
        mean = -float(np.mean(forces.turn.torque))
        # what only swings to and fro takes nothing but rounding
        swing = 1e-9 * float(np.abs(forces.turn.torque).max())
        doubts += proportion("driven_drive", "mean torque of the drive over a turn", mean) if mean < -swing else ()
    doubts += stress
    if stress or forces.turn.gas is None or not max(pushes, default=0.0) > 0:
        return doubts
    beyond = _inertia(case, forces, max(pushes))
    # one slip is told once
    return doubts + (beyond or proportion("force_ratio", "largest bearing force / gas force", largest / max(pushes)))


def _inertia(case: Case, forces: Forces, push: float) -> tuple[Doubt, ...]:
    r"""Largest inertia of what goes to and fro by the largest gas force.

    .. math:: m\,\tfrac S2\,\omega^2 / F
    """
    sizes = plan_of(case.mechanism).proportions(case.need("parameters"))
    doubted = any(
        doubt.code in ("reciprocating_mass", "piston_speed") for doubt in case.doubts
    )  # one slip is told once
    if doubted or sizes is None or not fired(case.sections):
        return ()
    mass = max((part.mass for part in sizes.moving), default=0.0)
    force = mass * sizes.stroke / 2 * forces.turn.omega**2
    return proportion("inertia_force", "inertia of the reciprocating mass / gas force", force / push)


def _driven(case: Case, forces: Forces) -> tuple[Doubt, ...]:
    """Whether the gas of a Stirling engine takes work: then its cold piston leads."""
    if "cycle" not in case.sections or not kind_of(case.need("cycle")).shared:
        return ()
    turn = forces.turn
    return proportion("driven", "work of the gas in a turn", float(np.mean(turn.gas_power)) / turn.omega * turn.period)


def of_shafts(case: Case, apart: Metre) -> tuple[Doubt, ...]:
    """Doubts about the distance of both balancer shafts of a pair, by the stroke."""
    sizes = plan_of(case.mechanism).proportions(case.need("parameters"))
    if sizes is None or not apart:
        return ()
    return proportion("shaft_distance", "--apart / stroke", apart / sizes.stroke)


def of_motion(case: Case, motion: "DrivenForces") -> tuple[Doubt, ...]:
    """Doubts of a driven motion: how far its words move, results by what moves, speeds of links, torques that bend."""
    from mechsym.forces.driven import word_of  # splines, which no other case needs

    section, table, listing = case.need("motion"), motion.columns, plan_of(case.mechanism).listing(None)
    angles = [q for q, unit in listing["coordinates"].items() if unit == "rad"]
    named = [q for q in motion.one.driven if word_of(getattr(section, q))[0]]
    driven = [q for q in motion.one.driven if q in angles]
    # what a file moves on and on may turn as often as it likes
    sways = [q for q in driven if q in named or 2 * abs(table[q][-1] - table[q][0]) < np.ptp(table[q])]
    rise = max((float(np.ptp(table[q])) for q in sways), default=0.0)
    speeds = {q: float(np.abs(table[f"{q}d"]).max()) for q in angles}
    torques = {q: float(np.abs(table[f"driving_{q}"]).max()) for q in driven}
    lengths = [q for q, unit in listing["coordinates"].items() if unit == "m"]
    slides = {q: float(np.abs(table[f"{q}d"]).max()) for q in lengths}
    step = float(table["t"][1] - table["t"][0])
    turns = step * max(speeds.values(), default=0.0) / math.tau
    doubts = inputs({"motion.rise": rise}) if rise else ()
    for q, fastest in slides.items():
        doubts += proportion("point_speed", f"highest speed along {q}", fastest)
    if named:
        doubts += proportion("sampling", "time between two results / motion.duration", step / section.duration)
    doubts += proportion("aliasing", "turns between two results", turns, 0.5)
    links = by_links(listing, asdict(case.need("parameters")), torques, speeds)
    return doubts + tuple(doubt for doubt in links if doubt.code in ("point_speed", "link_stress"))


def of_cycle(case: Case, columns: Json, bound: Pure | None) -> tuple[Doubt, ...]:
    r"""Efficiency by the bound of its cycle.

    .. math:: \eta \le 1 - \varepsilon^{1 - \gamma} \text{ (Otto)}, \qquad \eta \le 1 - T_c/T_e \text{ (Carnot)}

    columns: with `efficiency`; nan where no fuel is known [-]. bound: of its gas, None where it has none.
    """
    best = float(np.nanmax(np.append(columns["efficiency"], -np.inf)))
    beyond = of_limits(case, columns)
    if "work_j" in columns:  # a Stirling engine whose cold piston leads is none
        beyond += proportion("driven", "work of the gas in a turn", float(np.min(columns["work_j"])))
    if best > 0 and bound:
        beyond += proportion("efficiency_bound", "efficiency / its bound", best / bound)
    return beyond
