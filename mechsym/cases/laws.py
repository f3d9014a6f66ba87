r"""Values of a case by the laws of its machine: speeds, timing at speed, fire, load, shaft, firing order, run, links.

.. math:: c_m = S\omega/\pi, \qquad \varphi + \varphi'\omega, \qquad 1 - \mathrm{e}^{-a}, \qquad M/k, \qquad h/T

Of the links of a user's own mechanism, what a bar of their length can weigh and hold: l is the largest distance of two
joints of the link, c its centre of mass, R the reach from its pivot, b from the middle of its joints to the farthest of
what it may be made of. A zero leaves the part away and is never doubted; a link that turns with a coordinate may carry
a flywheel: where it is a rotor, or balanced. A link with one joint reaches as far behind its centre; it is no wheel far
wider than the longest link. A piston, with one joint, is held against the longest link.

.. math:: \frac{I}{m l^2} \le \frac{b^2 - |c - \bar p|^2}{l^2}, \qquad
    \frac{|c - \bar p|}{l}, \qquad \frac{m}{l^3}, \qquad \omega R
"""

import dataclasses
import itertools
import math
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from mechsym.cycle.kinds import four_stroke, kind_of
from mechsym.files import Json
from mechsym.machine.loads import Load, PropellerLoad, TableLoad
from mechsym.mechanisms.proportions import Proportions
from mechsym.mechanisms.shaft import ElasticShaft
from mechsym.plausible import Doubt, inputs, piston_speed, proportion, proportions
from mechsym.quantities.units import Newton, NewtonMetre

if TYPE_CHECKING:
    from mechsym.derive.listing import Listing

Records = Mapping[str, Any]  # of a case, by section
# charge pressure by the cycle's name for it, and how many times as much drives the piston at full load
_DRIVING = (("intake_pressure", 10.0), ("p_s", 10.0), ("mean_pressure", 1.0), ("p_delivery", 1.0))
_ALL_WAYS = 12  # firing orders of more cylinders are too many to try
_STEEL = 7850.0  # its density [kg/m^3]
_BEYOND = 1.1  # how far links go beyond their joints, of their reach [-]
_RPM = 30 / math.pi  # rpm of one rad/s
_DIGITS = 1e-3  # within which two numbers have the same digits, of the larger
_WHEEL = 200.0  # inertia of a wheel by its mass and the longest link squared: fourteen times as wide as that [-]
_OF_ROD = 1.2  # farthest centre of what is no crank from the middle of its joints, by its length [-]
_CARRIES = 10.0  # inertia of a driven link by mass and length squared: a motor behind a gear adds some [-]
_LEADS = math.pi / 4  # how far pistons of one chamber lead and lag at the most [rad]
_LATE = 0.9  # of a run, from when on a drive has no time to show what it does


def value(sections: Records, section: str, name: str) -> float:
    """A number of a section, 0 where it is not given [SI]."""
    return getattr(sections.get(section), name, None) or 0.0


def fired(sections: Records) -> bool:
    """Whether fuel burns in the machine of a case; one without a cycle is taken for an engine."""
    return "cycle" not in sections or kind_of(sections["cycle"]).fired


def driven(sections: Records) -> bool:
    """Whether the gas of a case takes work."""
    return "cycle" in sections and kind_of(sections["cycle"]).driven


def by_law(sections: Records) -> tuple[Doubt, ...]:
    """Doubts that need no size of the mechanism."""
    return (*_timing(sections), *_burning(sections), *_power(sections), *_run(sections))


def by_speed(sections: Records, sizes: Proportions) -> tuple[Doubt, ...]:
    """Mean piston speeds at the speeds of a case; the rod of an engine, since presses and pumps have longer ones."""
    burns, engine = fired(sections), "cycle" in sections
    omega = getattr(sections.get("operation"), "speed", None)
    doubts = proportions(sizes.stroke, sizes.rod_ratio if engine else None, omega, burns)
    for section, name in (("speeds", "highest"), ("codesign", "full_speed"), ("codesign", "speeds")):
        given = value(sections, section, name)
        fastest = max(given) if isinstance(given, tuple) else given
        if fastest:
            doubts += piston_speed(f"mean piston speed at {section}.{name}", sizes.stroke, fastest, burns)
    return doubts


def by_twist(sections: Records, shaft: ElasticShaft, stroke: float, area: float | None) -> tuple[Doubt, ...]:
    """Twist of the softest section under the torque that drives, and the stiffest by a solid shaft of steel.

    stroke, area: of a piston; the area is None where it is not known [m, m^2].
    """
    stiffness = [k for k in shaft.k if k > 0]
    if not stiffness:
        return ()
    given = ((share * value(sections, "cycle", name), name) for name, share in _DRIVING)
    pressure = next((p for p, _ in given if p), 0.0)
    torque = max(abs(value(sections, "drive", "torque")), pressure * (area or 0.0) * stroke / 2)
    what = f"twist of the softest section under {torque:.3g} N*m"
    doubts = proportion("shaft_twist", what, torque / min(stiffness))
    if area:
        solid = 80e9 * math.pi / 32 * (4 * area / math.pi) ** 1.5  # G pi d^4 / (32 l), both the bore
        doubts += proportion("shaft_stiffness", "stiffest section / solid shaft of the bore", max(stiffness) / solid)
    return doubts


def by_firing(sections: Records, parameters: object) -> tuple[Doubt, ...]:
    """Largest angle without a firing, by the least that cylinders reach which may fire a turn later."""
    section, angles = "parameters", getattr(parameters, "firing", ())
    if "faces" in sections:
        section, angles = "faces", sections["faces"].firing
    cycle = sections.get("cycle")
    if cycle is None or not isinstance(angles, tuple) or not 1 < len(angles) <= _ALL_WAYS or not four_stroke(cycle):
        return ()
    later = itertools.product((0.0, 2 * math.pi), repeat=len(angles) - 1)
    best = min(_gap([angles[0], *(a + b for a, b in zip(angles[1:], turns, strict=True))]) for turns in later)
    what = f"{section}.firing: largest angle without a firing / the least with these cranks"
    return proportion("firing_gap", what, _gap(angles) / best)


def by_throws(parameters: Any) -> Iterator[Doubt]:
    """Cylinders that fire beside their dead centre, and throws of a bank that do not follow one another."""
    if not hasattr(parameters, "throw"):
        return
    from mechsym.mechanisms.crank_train.firing import lateness  # not every command needs a train
    from mechsym.mechanisms.crank_train.parameters import each

    angles = each(parameters, "firing") if parameters.firing else ()
    # two pistons of one chamber fire together, one of them a little before its dead centre and the other behind
    late = tuple(zip(angles, lateness(parameters), strict=True)) if angles else ()
    alone = [beside for angle, beside in late if angles.count(angle) == 1]
    together = [abs(beside) for angle, beside in late if angles.count(angle) > 1]
    what = "parameters.firing from the dead centre of the piston, rad"
    yield from proportion("firing_off", what, max(alone, key=abs, default=0.0))
    yield from proportion("firing_off", f"{what}, of pistons that fire together", max(together, default=0.0), _LEADS)
    places, banks = each(parameters, "z"), each(parameters, "bank")
    for bank in sorted(set(banks)):
        throws = sorted({t for t, b in zip(parameters.throw, banks, strict=True) if b == bank})
        steps = [places[b - 1] - places[a - 1] for a, b in itertools.pairwise(throws)]
        back = sum(a * b < 0 for a, b in itertools.pairwise(steps))
        yield from proportion("throw_order", "turns back of parameters.z along the throws of a bank", back)


def _gap(angles: Sequence[float]) -> float:
    period = 4 * math.pi
    ranked = sorted(a % period for a in angles)
    return max(b - a for a, b in itertools.pairwise([*ranked, ranked[0] + period]))


def load_torques(sections: Records) -> Iterator[tuple[str, NewtonMetre]]:
    """Torques that a load takes at the speed of operation, or of its table the one that tells most."""
    load: Load | None = sections.get("load")
    if isinstance(load, TableLoad):
        yield "load.torques", min(load.torques) if min(load.torques) < 0 else max(load.torques)
    elif load is not None and load.torque is not None:
        there = value(sections, "operation", "speed")
        share = (there / load.speed) ** 2 if isinstance(load, PropellerLoad) and load.speed and there else 1.0
        yield "load.torque" + " at operation.speed" * (share != 1.0), load.torque * share


def _timing(sections: Records) -> Iterator[Doubt]:
    """Angles that are straight lines over the speed, at the speeds of the case."""
    cycle = sections.get("cycle")
    keys = ("speeds.highest", "operation.speed")  # of two that are alike the last is told
    at = {value(sections, *key.split(".")): key for key in keys}
    for name in ("ignition", "duration"):
        slope = getattr(cycle, f"{name}_slope", 0.0)
        for omega, key in at.items() if slope else ():
            angle = getattr(cycle, name) + slope * omega
            for doubt in inputs({f"cycle.{name}": angle}, refusing=False):
                yield replace(doubt, quantity=f"cycle.{name} + {name}_slope * {key}, rad")


def _burning(sections: Records) -> Iterator[Doubt]:
    """Share of the fuel that has burnt when the duration ends, and what a kilogram of air burns."""
    cycle: Any = sections.get("cycle")
    burnt = "share of the fuel burnt after cycle.duration"
    if hasattr(cycle, "wiebe_a"):
        yield from proportion("burnt_fraction", burnt, 1 - math.exp(-cycle.wiebe_a))
    elif hasattr(cycle, "a_p"):
        left = (1 - cycle.b) * math.exp(-cycle.a_p) + cycle.b * math.exp(-cycle.a_d)
        yield from proportion("burnt_fraction", burnt, 1 - left)
    duration, omega = getattr(cycle, "duration", 0.0), abs(value(sections, "operation", "speed"))
    if hasattr(cycle, "octane") and omega and duration > 0 and (bore := value(sections, "chamber", "bore")):
        lasts = (duration + getattr(cycle, "duration_slope", 0.0) * omega) / omega
        yield from proportion("flame_speed", "chamber.bore / 2 / (cycle.duration at operation.speed)", bore / 2 / lasts)
    if hasattr(cycle, "octane") and (ratio := value(sections, "chamber", "compression_ratio")):
        yield from proportion("spark_compression", "chamber.compression_ratio of an engine with a spark", ratio)
    if shares := getattr(sections.get("rings"), "gas_shares", ()):
        yield from proportion("ring_shares", "sum of rings.gas_shares", sum(shares))
    if hasattr(cycle, "stoichiometric_ratio"):
        what = "cycle.heating_value / cycle.stoichiometric_ratio"
        yield from proportion("fuel_heat", what, cycle.heating_value / cycle.stoichiometric_ratio)


def _power(sections: Records) -> Iterator[Doubt]:
    """How far a compressor compresses, and whether a load takes what the gas gives, or gives what it takes."""
    if suction := value(sections, "cycle", "p_suction"):
        what = "cycle.p_delivery / cycle.p_suction"
        yield from proportion("pressure_ratio", what, value(sections, "cycle", "p_delivery") / suction)
    cycle = sections.get("cycle")
    if cycle is not None and kind_of(cycle).measured:  # of an engine, or motored
        return
    for name, torque in load_torques(sections):
        yield from proportion("driven_load" if driven(sections) else "braking_load", name, torque)


def _run(sections: Records) -> Iterator[Doubt]:
    """Spacing of the results, claims and drives by the length of a run."""
    simulation, drive = sections.get("simulation"), sections.get("drive")
    start, usual = value(sections, "simulation", "speed_start"), value(sections, "operation", "speed")
    if start and usual:
        ratio = abs(start / usual)
        yield from proportion("start_speed", "simulation.speed_start / operation.speed", ratio)
        if min(abs(ratio * _RPM - 1), abs(ratio / _RPM - 1)) < _DIGITS:
            why = "one is the other with rpm taken for rad/s: a number without a unit is in rad/s"
            what = "simulation.speed_start / operation.speed, the digits of one speed in two units"
            yield Doubt(code="speed_unit", quantity=what, value=ratio, usual="another ratio", why=why)
    first = sections.get("start")
    for field in dataclasses.fields(first) if first is not None else ():
        angle = getattr(first, field.name)
        if field.metadata.get("unit") == "rad" and isinstance(angle, float):  # as that of any machine
            for doubt in inputs({"simulation.phi_start": angle}, refusing=False):
                yield replace(doubt, quantity=f"start.{field.name}")
    end = getattr(simulation, "t_end", None)
    if simulation is None or not end:
        return
    if turning := abs(start or usual):
        yield from proportion("short_run", "turns of the run at the speed of its start", end * turning / math.tau)
    if simulation.output_step:
        what = "simulation.output_step / simulation.t_end"
        yield from proportion("sampling", what, simulation.output_step / end)
    if claim := value(sections, "startup", "claim_time"):
        yield from proportion("window", "startup.claim_time / simulation.t_end", claim / end)
    if drive is not None and drive.time >= _LATE * end:
        why = "the run ends before the drive is switched on, or right behind: next to nothing happens in it"
        yield Doubt(code="drive_start", quantity="drive.time", value=drive.time, usual=f"below {end:g} s", why=why)


_WORDS = {name: getattr(math, name) for name in ("pi", "sqrt", "sin", "cos", "tan", "atan", "atan2", "exp", "log")}


def by_links(
    listing: "Listing", letters: Mapping[str, float], inputs: Mapping[str, float], speeds: Mapping[str, float]
) -> tuple[Doubt, ...]:
    """What is out of proportion to a link, of each kind the worst.

    listing: as stored of the declaration. letters, inputs: values of the parameters and of what acts, a torque along a
    coordinate under its name [SI]. speeds: of coordinates, where they are known [rad/s].
    """
    links, units = listing.get("links", ()), listing["parameters"]
    rotors = {str(role.get("angle")) for role in listing.get("roles", {}).get("rotor", ())}

    def far(doubt: Doubt) -> float:
        return abs(math.log(doubt.value)) if doubt.value > 0 else math.inf

    worst: dict[str, Doubt] = {}
    acts = {q: "N*m" for q, unit in listing["coordinates"].items() if unit == "rad"} | dict(listing["inputs"])
    longest = max((_length(link, letters) for link in links), default=0.0)
    moving = sum(_number(link["mass"], letters) for link in links)
    of_links = (doubt for link in links for doubt in _of(link, letters, speeds, rotors, (longest, moving)))
    pushes, turns = ([abs(given) for name, given in inputs.items() if acts.get(name) == unit] for unit in ("N", "N*m"))
    forces = max(pushes, default=0.0), max(turns, default=0.0)
    slides = "m" in listing["coordinates"].values()
    together = (*_masses(links, letters, units, slides), *_stress(links, letters, *forces))
    for doubt in (*of_links, *together):
        if doubt.code not in worst or far(doubt) > far(worst[doubt.code]):
            worst[doubt.code] = doubt
    return tuple(worst.values())


def by_force(listing: "Listing", letters: Mapping[str, float], force: Newton) -> tuple[Doubt, ...]:
    """The largest force that joints bear by the stoutest link.

    listing: as stored of the declaration. letters: values of the parameters [SI].
    """
    return tuple(_stress(listing.get("links", ()), letters, force, 0.0, "of the joints"))


def linked(listing: "Listing", letters: Mapping[str, float]) -> float:
    """Mass of all links with two joints and more [kg].

    listing: as stored of the declaration. letters: values of the parameters [SI].
    """
    return sum(_number(link["mass"], letters) for link in listing.get("links", ()) if len(link["points"]) > 1)


def _length(link: Json, letters: Mapping[str, float]) -> float:
    points = [_point(pair, letters) for pair in link["points"]]
    if len(points) == 1:
        return 2 * math.dist(points[0], _point(link["centre"], letters))
    return max(math.dist(p, q) for p, q in itertools.combinations(points, 2))


def _masses(
    links: Sequence[Json], letters: Mapping[str, float], units: Mapping[str, str], slides: bool
) -> Iterator[Doubt]:
    """Letters in kg by the longest link, or twice the longest letter: none is heavier than a cube of steel of it.

    A body that slides where its coordinate says is as wide as no letter tells.
    """
    lengths = [] if slides else [2 * abs(letters[name]) for name, unit in units.items() if unit == "m"]
    longest = max([_length(link, letters) for link in links] or lengths, default=0.0)
    for name, unit in units.items() if longest > 0 else ():
        if unit == "kg" and letters[name] > 0:
            what = f"parameters.{name} / ({'longest link' if links else 'twice the longest letter'})^3"
            yield from proportion("link_density", what, letters[name] / longest**3)


def _stress(
    links: Sequence[Json], letters: Mapping[str, float], force: float, torque: float, of: str = "of [inputs]"
) -> Iterator[Doubt]:
    r"""A force and a torque by the section A of the stoutest link, a square bar of steel of its mass and length.

    .. math:: F/A, \qquad 6 M / A^{3/2}
    """
    lengths = [(_number(link["mass"], letters), _length(link, letters)) for link in links]
    section = max((mass / (_STEEL * length) for mass, length in lengths if length > 0), default=0.0)
    if section > 0:
        what = f"largest force {of} / section of the stoutest link"
        yield from proportion("link_stress", what, force / section)
        what = "largest torque that bends / section modulus of the stoutest link"
        yield from proportion("link_stress", what, 6 * torque / section**1.5)


def by_sign(listing: "Listing", letters: Mapping[str, float]) -> Iterator[Doubt]:
    """Springs and dampers of a declaration with the sign of what drives, and loops with a side that nobody chose.

    listing: as stored of it. letters: values of the parameters [SI].
    """
    for kind, texts in (("spring", listing.get("springs", ())), ("damper", listing.get("dampers", ()))):
        for text in texts:
            yield from proportion(f"{kind}_sign", f"{kind} {text}", _number(text, letters))
    yield from _swinging(listing, letters)
    for name, (xx, yy, zz, xy, xz, yz) in listing.get("tensors", {}).items():
        rows = [[_number(entry, letters) for entry in row] for row in ((xx, xy, xz), (xy, yy, yz), (xz, yz, zz))]
        moments = np.linalg.eigvalsh(rows)
        if moments[0] > 0:
            about = f"largest principal moment of {name} / sum of the other two"
            yield from proportion("principal_moments", about, moments[2] / (moments[0] + moments[1]))
    if joints := listing.get("open_sides", ()):
        yield from proportion("open_side", f"loops of pins whose side nobody chose ({', '.join(joints)})", len(joints))


def _swinging(listing: "Listing", letters: Mapping[str, float]) -> Iterator[Doubt]:
    """The heaviest mass on the softest spring, m g/k, and the strongest damper beside them, c/(2 sqrt(k m))."""
    units = listing["parameters"]

    def values(texts: Collection[str], unit: str) -> list[float]:
        return [letters[text] for text in texts if units.get(text) == unit and letters[text] > 0]

    masses, springs = values(units, "kg"), values(listing.get("springs", ()), "N/m")
    if masses and springs and not listing.get("links"):  # links carry what no spring does
        yield from proportion("spring_rest", "heaviest mass * g / softest spring", 9.81 * max(masses) / min(springs))
    for damping in values(listing.get("dampers", ()), "N*s/m") if masses and springs else ():
        share = damping / (2 * math.sqrt(max(springs) * max(masses)))
        yield from proportion("damping_share", f"damper {damping:g} N*s/m / (2 sqrt(spring * mass))", share)


_OfAll = tuple[float, float]  # longest link [m], and what all weigh [kg]


def _of(
    link: Json, letters: Mapping[str, float], speeds: Mapping[str, float], rotors: Collection[str], all_: _OfAll
) -> Iterator[Doubt]:
    name, (longest, moving) = link["name"], all_
    points = [_point(pair, letters) for pair in link["points"]]
    length = _length(link, letters)
    mass, inertia = (_number(link[name], letters) for name in ("mass", "inertia"))
    if length <= 0:
        return
    if len(points) == 1:  # its size is that of its centre's distance: a disc beside its axis is wider, a bob thinner
        if mass > 0 and inertia:
            about = f"inertia of {name} / (mass * (twice its centre from its joint)^2)"
            yield from proportion("link_needle", about, inertia / (mass * length**2))
            about, wide = f"inertia of {name} / (mass * (longest link)^2)", inertia / (mass * longest**2)
            if wide > 1:  # a wheel as wide as the machine; a flywheel is not so much wider
                yield from proportion("link_inertia", about, wide, _WHEEL)
        return
    share = inertia / (moving * length**2) if moving > 0 and not mass else 0.0
    if link["turns"] in rotors and 0 < share < 1:  # a crank that is given by its inertia alone, and no heavy flywheel
        yield from proportion("inertia", f"inertia of {name} / (moving mass * throw^2)", share)
    if link["turns"] in rotors and mass > 0 and inertia > mass * longest**2:
        yield from proportion("link_inertia", f"inertia of {name} / (mass * (longest link)^2)",
                              inertia / (mass * longest**2), _WHEEL)  # fmt: skip
    if link["turns"] in rotors or link["turns"] and link["centre"] == list(link["pivot"] or ()):
        inertia = 0.0  # of a flywheel
    # webs, discs and counterweights of a crank are wider than its throw
    size, of = (longest, "longest link") if link["turns"] else (length, "distance of its joints")
    if mass > 0:
        yield from proportion("link_density", f"mass of {name} / ({of})^3", mass / size**3)
        middle = tuple(sum(axis) / len(points) for axis in zip(*points, strict=True))
        away = math.dist(_point(link["centre"], letters), middle)
        what = f"centre of {name} from the middle of its joints / {of}"
        yield from proportion("link_centre", what, away / size, None if link["turns"] else _OF_ROD)
        about, ratio = f"inertia of {name} / (mass * ({of})^2)", inertia / (mass * size**2)
        if inertia and link["turns"]:
            yield from proportion("link_needle", about, ratio, _CARRIES)
        elif inertia:
            # of all that weighs m within a circle about the middle, whose centre of mass lies beside it
            reach = _BEYOND * (max(math.dist(middle, p) for p in points) + away)
            yield from proportion("link_inertia", about, ratio, (reach**2 - away**2) / length**2)
    elif inertia and link["pivot"] and not link["turns"]:  # about its bearing in the frame no mass is needed
        yield from proportion("link_density", f"inertia of {name} / (distance of its joints)^5", inertia / length**5)
    elif inertia and not link["turns"]:
        why = "what has no mass has no inertia: give it a mass, or leave its inertia away"
        yield Doubt(code="massless", quantity=f"inertia of {name}", value=inertia, usual="0 without a mass", why=why)
    if link["turns"] in speeds:
        reach = max(math.dist(_point(link["pivot"], letters), p) for p in points) if link["pivot"] else length
        speed = abs(speeds[link["turns"]]) * reach
        yield from proportion("point_speed", f"speed of the outermost joint of {name}", speed)


def _point(place: Sequence[str], letters: Mapping[str, float]) -> tuple[float, ...]:
    return tuple(_number(text, letters) for text in place)


def _number(text: str, letters: Mapping[str, float]) -> float:
    """Value of an expression that the derivation has written, in its letters."""
    return float(eval(text, {"__builtins__": {}}, {**_WORDS, **letters}))
