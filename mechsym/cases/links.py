r"""Links of a user's own mechanism by what a bar of their length can weigh and hold.

l is the largest distance of two points of the link (joints, and what is watched of it), c its centre of mass, R the
reach from its pivot, b from the middle of its points to the farthest of what it may be made of. A zero leaves the part
away and is never doubted; a link that turns with a coordinate may carry a flywheel: where it is a rotor, or balanced.
A link with one joint reaches as far behind its centre; none is a wheel far wider than the longest link. A piston, with
one joint, is held against that. The section A is that of the stoutest link, a square bar of steel of its mass and
length.

.. math:: \frac{I}{m l^2} \le \frac{b^2 - |c - \bar p|^2}{l^2}, \qquad
    \frac{|c - \bar p|}{l}, \qquad \frac{m}{l^3}, \qquad \omega R, \qquad \frac{F}{A}
"""

import contextlib
import itertools
import math
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import fields
from typing import TYPE_CHECKING, Any

import numpy as np

from mechsym.files import Json
from mechsym.plausible import Doubt, proportion
from mechsym.quantities.units import Newton

if TYPE_CHECKING:
    from mechsym.derive.listing import Listing

STEEL = 7850.0  # its density [kg/m^3]
_BEYOND = 1.1  # how far links go beyond their joints, of their reach [-]
_WHEEL = 200.0  # inertia of a wheel by its mass and the longest link squared: fourteen times as wide as that [-]
_OF_ROD = 1.2  # farthest centre of what is no crank from the middle of its points, by its length [-]
_MIDDLE = 0.25  # how far the centre of a bar is from the middle of its points, by its length [-]
_SWINGS = 8.0  # inertia of what swings about its joint by mass and the longest link squared [-]
_CARRIES = 5.0  # inertia of a driven link by mass and length squared: a motor behind a gear adds some [-]
_DISC = 1e5  # inertia by l^5 of a disc of steel as thick as l, 1.6 l in radius: a wheel that carries planets [kg/m^3]
_HEAVY = 2e5  # mass by l^3 of a flywheel of steel as thick as l and 2.8 l in radius [kg/m^3]
_SLENDER = 1000.0  # a longer shaft, by its diameter, is a thread [-]
_DEEP = 3.0  # how far a link goes along its axis, by the longest link [-]
_BURSTS = 300.0  # speed of the radius of gyration at which discs of steel burst [m/s]
_BEHIND_GEARS = 1e4  # inertia of a load by that of its motor, seen through the gear [-]

STEP, PLACES = 1e-4, tuple(k * math.pi / 6 for k in range(12))  # of a slope, and where it is taken [rad]

_WORDS = {"pi": np.pi, "sqrt": np.sqrt, "sin": np.sin, "cos": np.cos, "tan": np.tan, "atan": np.arctan,
          "atan2": np.arctan2, "exp": np.exp, "log": np.log}  # fmt: skip


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
    moving = sum(value_of(link["mass"], letters) for link in links)
    of_links = (doubt for link in links for doubt in _judged(link, letters, speeds, rotors, (longest, moving)))
    pushes, turns = ([abs(given) for name, given in inputs.items() if acts.get(name) == unit] for unit in ("N", "N*m"))
    forces = max(pushes, default=0.0), max(turns, default=0.0)
    slides = "m" in listing["coordinates"].values()
    long = [length for link in links if len(link["points"]) > 1 and (length := _length(link, letters)) > 0]
    of = "link"
    if not links:
        of, long = "letter", [abs(letters[name]) for name, unit in units.items() if unit == "m" and letters[name]]
    spread = max(long, default=1.0) / min(long, default=1.0)
    together = (
        *proportion("link_spread", f"longest {of} / shortest", spread),
        *_masses(links, letters, units, slides, rotors, None if listing.get("roles", {}).get("piston") else _HEAVY),
        *_stress(links, letters, *forces),
        *_carried(listing, letters, speeds),
        *_solids(listing, letters, speeds, rotors),
        *_turning(listing, letters, forces[1], spread if links else 1.0),
    )
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
    return sum(value_of(link["mass"], letters) for link in listing.get("links", ()) if len(link["points"]) > 1)


def _carried(listing: "Listing", letters: Mapping[str, float], speeds: Mapping[str, float]) -> Iterator[Doubt]:
    """Speeds of bodies that are no links, as an angle moves them; none of what coordinates hold together."""
    # how far out a body slides nobody knows: lengths are those that it was assembled with
    start = {q: listing.get("pose", {}).get(q, 0.0) for q in listing["coordinates"]}
    angles = [q for q, unit in listing["coordinates"].items() if unit == "rad"]
    for name, place in listing.get("bodies", {}).items():
        fastest = 0.0
        for q, at in itertools.product([q for q in angles if q in speeds], PLACES):
            values = {**letters, **start, **dict.fromkeys(angles, at)}
            with contextlib.suppress(ZeroDivisionError):
                moved = math.dist(*(_point(place, {**values, q: at + step}) for step in (-STEP, STEP)))
                fastest = max(fastest, moved / (2 * STEP) * abs(speeds[q]))
        yield from proportion("point_speed", f"speed of {name}", fastest)


def _solids(
    listing: "Listing", letters: Mapping[str, float], speeds: Mapping[str, float], rotors: Collection[str]
) -> Iterator[Doubt]:
    """Bodies that are no links: the speed of their radius of gyration, and their inertia by their mass and the longest
    letter squared, or the edge of their cube of steel where that is longer, as beside an unbalance.
    """
    longest = max((abs(letters[name]) for name, unit in listing["parameters"].items() if unit == "m"), default=0.0)
    for mass, inertia, angle, *_ in listing.get("solids", ()) if longest > 0 else ():
        weighed, turned = value_of(mass, letters), value_of(inertia, letters)
        if not (weighed > 0 and turned > 0):
            continue
        yield from _thin(inertia, weighed, turned)
        if angle in speeds:
            about, radius = f"speed of {angle}d at the radius sqrt({inertia}/{mass})", math.sqrt(turned / weighed)
            yield from proportion("point_speed", about, abs(speeds[angle]) * radius, _BURSTS)
        edge = (weighed / STEEL) ** (1 / 3)
        of, size = ("longest letter", longest) if longest > edge else ("edge in steel", edge)
        ratio = turned / (weighed * size**2)
        if ratio > 1:
            what = f"inertia {inertia} / ({mass} * ({of})^2)"
            yield from proportion("link_inertia", what, ratio, _WHEEL if angle in rotors else _SWINGS)


def _thin(of: str, mass: float, inertia: float, high: float | None = None) -> Iterator[Doubt]:
    r"""How long a shaft of steel is that has a mass and an inertia about its axis: no body is a thread.

    .. math:: L = \frac{m^2}{2\pi\rho I}
    """
    if mass > 0 and inertia > 0:
        what = f"length of a steel shaft with the mass and the inertia of {of}"
        length = mass**2 / (2 * math.pi * STEEL * inertia)
        thread = _SLENDER * math.sqrt(4 * mass / (math.pi * STEEL * length))
        yield from proportion("shaft_length", what, length, high or thread)


def _turning(listing: "Listing", letters: Mapping[str, float], torque: float, longer: float) -> Iterator[Doubt]:
    """How far the largest torque winds up the softest spring that turns, M/k, and inertias beside one another.

    longer: longest of its links by the shortest [-].
    """
    units = listing["parameters"]
    springs = [letters[text] for text in listing.get("springs", ()) if units.get(text) == "N*m/rad"]
    if any(k > 0 for k in springs):
        what = "largest torque of [drive] and [inputs] / softest spring that turns"
        yield from proportion("spring_wound", what, torque / min(k for k in springs if k > 0))
    inertias = [letters[name] for name, unit in units.items() if unit == "kg*m^2" and letters[name] > 0]
    if len(inertias) > 1:
        ratios = [letters[name] for name, unit in units.items() if unit == "-" and letters[name] > 0]
        geared = max((max(ratio, 1 / ratio) for ratio in ratios), default=1.0)
        spread = max(inertias) / min(inertias) / longer**2
        by = " / (longest link / shortest)^2" if longer > 1 else ""
        if geared > 1:  # a motor turns by the ratio faster than its load
            what = f"largest inertia / (smallest * square of the ratio){by}"
            yield from proportion("inertia_spread", what, spread / geared**2, _BEHIND_GEARS)
        else:
            yield from proportion("inertia_spread", f"largest inertia / smallest{by}", spread)


def _length(link: Json, letters: Mapping[str, float]) -> float:
    points = [_point(pair, letters) for pair in link["points"]]
    if len(points) == 1:
        return 2 * math.dist(points[0], _point(link["centre"], letters))
    return max(math.dist(p, q) for p, q in itertools.combinations(points, 2))


def _masses(
    links: Sequence[Json],
    letters: Mapping[str, float],
    units: Mapping[str, str],
    slides: bool,
    rotors: Collection[str],
    most: float | None,
) -> Iterator[Doubt]:
    """Letters in kg by the longest link, or twice the longest crank or letter: none is heavier than a cube of steel of
    it, and by one another.

    A body that slides where its coordinate says is as wide as no letter tells; the ram of a press is wider than its
    crank. most: of a mass by the cube of that length, where it is not the usual one [kg/m^3].
    """
    lengths = [] if slides else [2 * abs(letters[name]) for name, unit in units.items() if unit == "m"]
    # what a crank moves may be as long as its stroke
    sizes = [_length(link, letters) * (1 + (link["turns"] in rotors)) for link in links]
    longest = max(sizes or lengths, default=0.0)
    for name, unit in units.items() if longest > 0 else ():
        if unit == "kg" and letters[name] > 0:
            what = f"parameters.{name} / ({'longest link' if links else 'twice the longest letter'})^3"
            yield from proportion("link_density", what, letters[name] / longest**3, most)
    yield from _spread(letters[name] for name, unit in units.items() if unit == "kg")


def by_mass(parameters: Any) -> tuple[Doubt, ...]:
    """The masses of a mechanism that comes with the program, by one another."""
    every = (getattr(parameters, f.name) for f in fields(parameters) if f.metadata.get("unit") == "kg")
    return _spread(m for mass in every for m in (mass if isinstance(mass, tuple) else (mass,)))


def _spread(masses: Iterable[float]) -> tuple[Doubt, ...]:
    weighed = [mass for mass in masses if mass > 0]
    return proportion("mass_spread", "heaviest mass / lightest", max(weighed) / min(weighed)) if weighed else ()


def _stress(
    links: Sequence[Json], letters: Mapping[str, float], force: float, torque: float, of: str = "of [inputs]"
) -> Iterator[Doubt]:
    r"""A force and a torque by the section A of the stoutest link, a square bar of steel of its mass and length.

    .. math:: F/A, \qquad 6 M / A^{3/2}
    """
    lengths = [(value_of(link["mass"], letters), _length(link, letters)) for link in links]
    section = max((mass / (STEEL * length) for mass, length in lengths if length > 0), default=0.0)
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
            yield from proportion(f"{kind}_sign", f"{kind} {text}", value_of(text, letters))
    yield from _swinging(listing, letters)
    yield from _falling(listing.get("weight", ()), letters)
    for name, (xx, yy, zz, xy, xz, yz) in listing.get("tensors", {}).items():
        rows = [[value_of(entry, letters) for entry in row] for row in ((xx, xy, xz), (xy, yy, yz), (xz, yz, zz))]
        moments = np.linalg.eigvalsh(rows)
        if moments[0] > 0:
            about = f"largest principal moment of {name} / sum of the other two"
            yield from proportion("principal_moments", about, moments[2] / (moments[0] + moments[1]))
    if joints := listing.get("open_sides", ()):
        yield from proportion("open_side", f"loops of pins whose side nobody chose ({', '.join(joints)})", len(joints))


def _falling(weight: Sequence[str], letters: Mapping[str, float]) -> Iterator[Doubt]:
    """Free fall of a declaration: how fast, and whether up, y or in space z; a letter g is judged by itself."""
    if not weight:
        return
    fall = [value_of(text, letters) for text in weight]
    if "weight" in "".join(weight):  # the letters of numbers
        yield from proportion("weight", "free fall of the declaration", math.hypot(*fall))
    if fall[-1] > 0 and not any(fall[:-1]):
        yield from proportion("weight_up", "share of the weight that points up", 1.0)


def _swinging(listing: "Listing", letters: Mapping[str, float]) -> Iterator[Doubt]:
    """The heaviest mass on the softest spring, m g/k; the strongest damper beside, c/(2 sqrt(k m)); also turning."""
    units = listing["parameters"]

    def values(texts: Collection[str], unit: str) -> list[float]:
        return [letters[text] for text in texts if units.get(text) == unit and letters[text] > 0]

    masses, springs = values(units, "kg"), values(listing.get("springs", ()), "N/m")
    if masses and springs and not listing.get("links"):  # links carry what no spring does
        yield from proportion("spring_rest", "heaviest mass * g / softest spring", 9.81 * max(masses) / min(springs))
    for mass, stiffness, unit in (("kg", "N/m", "N*s/m"), ("kg*m^2", "N*m/rad", "N*m*s/rad")):
        masses, springs = values(units, mass), values(listing.get("springs", ()), stiffness)
        for damping in values(listing.get("dampers", ()), unit) if masses and springs else ():
            share = damping / (2 * math.sqrt(max(springs) * max(masses)))
            yield from proportion("damping_share", f"damper {damping:g} {unit} / (2 sqrt(spring * mass))", share)


_OfAll = tuple[float, float]  # longest link [m], and what all weigh [kg]


def _judged(
    link: Json, letters: Mapping[str, float], speeds: Mapping[str, float], rotors: Collection[str], all_: _OfAll
) -> Iterator[Doubt]:
    """All doubts of a link; its depth only where no other law has told of its inertia."""
    doubts = [*_of(link, letters, speeds, rotors, all_)]
    yield from doubts
    if not {doubt.code for doubt in doubts} & {"link_inertia", "link_needle"}:
        mass, inertia = (value_of(link[name], letters) for name in ("mass", "inertia"))
        yield from _thin(link["name"], mass, inertia, None if link["turns"] in rotors else _DEEP * all_[0] or None)


def _of(
    link: Json, letters: Mapping[str, float], speeds: Mapping[str, float], rotors: Collection[str], all_: _OfAll
) -> Iterator[Doubt]:
    name, (longest, moving) = link["name"], all_
    points = [_point(pair, letters) for pair in link["points"]]
    length = _length(link, letters)
    mass, inertia = (value_of(link[name], letters) for name in ("mass", "inertia"))
    if length <= 0:
        return
    if len(points) == 1:  # its size is that of its centre's distance: a disc beside its axis is wider, a bob thinner
        if mass > 0 and inertia:
            about = f"inertia of {name} / (mass * (twice its centre from its joint)^2)"
            yield from proportion("link_needle", about, inertia / (mass * length**2))
            about, wide = f"inertia of {name} / (mass * (longest link)^2)", inertia / (mass * longest**2)
            if wide > 1:  # a wheel as wide as the machine; a flywheel is not so much wider
                hangs = link["centre"] != list(link["pivot"] or ()) and link["turns"] not in rotors
                yield from proportion("link_inertia", about, wide, _SWINGS if hangs else _WHEEL)
        return
    share = inertia / (moving * length**2) if moving > 0 and not mass else 0.0
    if link["turns"] in rotors and 0 < share < 1:  # a crank that is given by its inertia alone, and no heavy flywheel
        yield from proportion("inertia", f"inertia of {name} / (moving mass * throw^2)", share)
    if link["turns"] in rotors and mass > 0 and inertia > mass * longest**2:
        about = f"inertia of {name} / (mass * (longest link)^2)"
        yield from proportion("link_inertia", about, inertia / (mass * longest**2), _WHEEL)
    if inertia > 0 and not mass:  # of a flywheel any, but not less than a thread's
        yield from proportion("link_thread", f"inertia of {name} / (distance of its points)^5", inertia / length**5)
    if link["turns"] in rotors or link["turns"] and link["centre"] == list(link["pivot"] or ()):
        inertia = 0.0  # of a flywheel
    # webs, discs and counterweights of a crank are wider than its throw
    size, of = (longest, "longest link") if link["turns"] else (length, "distance of its points")
    if mass > 0:
        wide = _HEAVY if link["turns"] in rotors else None  # a flywheel on a crank
        yield from proportion("link_density", f"mass of {name} / ({of})^3", mass / size**3, wide)
        middle = tuple(sum(axis) / len(points) for axis in zip(*points, strict=True))
        away = math.dist(_point(link["centre"], letters), middle)
        what = f"centre of {name} from the middle of its points / {of}"
        yield from proportion("link_centre", what, away / size, None if link["turns"] else _OF_ROD)
        about, ratio = f"inertia of {name} / (mass * ({of})^2)", inertia / (mass * size**2)
        if inertia and link["turns"]:
            yield from proportion("link_needle", about, ratio, _CARRIES)
            if away < _MIDDLE * length:  # else its mass may sit at one end
                thin = f"inertia of {name} / (mass * (distance of its points)^2)"
                yield from proportion("link_inertia", thin, inertia / (mass * length**2), math.inf)
        elif inertia:
            # of all that weighs m within a circle about the middle, whose centre of mass lies beside it
            reach = _BEYOND * (max(math.dist(middle, p) for p in points) + away)
            yield from proportion("link_inertia", about, ratio, (reach**2 - away**2) / length**2)
    elif inertia and link["pivot"] and not link["turns"]:  # about its bearing in the frame no mass is needed
        about = f"inertia of {name} / (distance of its points)^5"
        yield from proportion("link_density", about, inertia / length**5, _DISC)
    elif inertia and not link["turns"]:
        why = "what has no mass has no inertia: give it a mass, or leave its inertia away"
        yield Doubt(code="massless", quantity=f"inertia of {name}", value=inertia, usual="0 without a mass", why=why)
    if link["turns"] in speeds:
        reach = max(math.dist(_point(link["pivot"], letters), p) for p in points) if link["pivot"] else length
        speed = abs(speeds[link["turns"]]) * reach
        yield from proportion("point_speed", f"speed of the outermost joint of {name}", speed)


def _point(place: Sequence[str], letters: Mapping[str, float]) -> tuple[float, ...]:
    return tuple(value_of(text, letters) for text in place)


def value_of(text: str, letters: Mapping[str, Any]) -> Any:
    """What a formula that the derivation has written is for numbers or columns; nan where a root has no value."""
    with np.errstate(all="ignore"):
        return eval(text, {"__builtins__": {}}, {**_WORDS, **letters})
