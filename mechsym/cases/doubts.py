r"""What of a case is nonsense or unusual, and which doubts its author accepts.

[doubts]
twist = { up_to = "2 rad", why = "the source's model; a real shaft breaks" }

Values of a case by the size of its own machine: bore, crank, and the mass that moves.

.. math:: \frac{I}{m r^2}, \qquad \frac{I_C}{m_\mathrm{part}\,l^2}, \qquad \sqrt{k/I}, \qquad \frac{c}{2\sqrt{k I}}

A value in the wrong unit, or with a slip of three decimals, is out of proportion to the machine that it belongs to; an
absolute range wide enough for a model and a ship would let it pass. Zero leaves a part away and is never doubted.
"""

import csv
import dataclasses
import functools
import itertools
import math
from collections.abc import Iterable, Iterator, Mapping
from importlib import resources

from mechsym.cases import laws, links
from mechsym.cases.laws import Records, value
from mechsym.errors import BadInput, shown, suggest
from mechsym.mechanisms import own
from mechsym.mechanisms.plan import plan_of
from mechsym.mechanisms.proportions import Proportions
from mechsym.mechanisms.shaft import ElasticShaft, elastic
from mechsym.plausible import INPUTS, PROPORTIONS, RESULTS, Acceptance, Doubt, inputs, letters, moving_mass, proportion
from mechsym.quantities import parse
from mechsym.quantities.records import Field
from mechsym.quantities.units import Metre

# doubts about measured diagrams, in the units that they name
_MEASURED = (
    "compression_exponent dead_centre dead_centre_width drift early_heat even_angles expansion_exponent floor "
    "free_exponent heat loss_angle mechanical_efficiency peak_angle scale speed"
).split()
_UNITS = {k.code: k.unit for k in (*INPUTS, *RESULTS, *PROPORTIONS)} | dict.fromkeys((*_MEASURED, "unused"), "-")
_UNITS |= {"drive_start": "s", "massless": "kg*m^2", "idle_input": "-"}

_LETTERS = ("parameters", "inputs", "start")  # sections whose keys are the mechanism's letters


def acceptances(table: object) -> dict[str, Acceptance]:
    """The section `[doubts]` of a case file."""
    if not isinstance(table, dict):
        raise BadInput("doubts is no section; write [doubts] and codes below it")
    accepted = {}
    for code, row in table.items():
        if not isinstance(row, dict) or set(row) != {"up_to", "why"} or not isinstance(row["why"], str):
            raise BadInput(f'doubts.{code} = {shown(row)}: write {code} = {{ up_to = "..", why = ".." }}')
        if code not in _UNITS:
            raise BadInput(f"doubts.{code} is not known; {suggest(code, sorted(_UNITS))}")
        up_to = parse(row["up_to"], _UNITS[code], f"doubts.{code}.up_to")
        accepted[code] = Acceptance(code=code, up_to=up_to, why=row["why"])
    return accepted


def judged(sections: Records, mechanism: str) -> tuple[Doubt, ...]:
    """Doubts about the values of a case; nonsense is refused with its key.

    A letter of a mechanism is known by its name and its unit; any other may mean anything.
    """
    values = {}
    for section, record in sections.items():
        for key, name in _keys(section, record.__class__):
            number = getattr(record, name)
            if isinstance(number, tuple) and number and all(isinstance(v, float) for v in number):
                number = max(number, key=abs)
            if isinstance(number, float) and math.isfinite(number):
                values[key] = number
    doubts = inputs(values) + by_unit(sections, _LETTERS) + laws.by_law(sections)
    parameters = sections.get("parameters")
    # a file that nobody trusts yet has no content, and is not run
    if parameters is None or own.is_file(mechanism) and not own.content(mechanism):
        return doubts
    plan = plan_of(mechanism)
    sizes, area = plan.proportions(parameters), _piston_area(sections)
    if own.is_file(mechanism):
        doubts += tuple(links.by_sign(plan.listing(None), dataclasses.asdict(parameters)))
    if sizes is None:
        coordinates, speed = plan.listing(None)["coordinates"], getattr(sections.get("operation"), "speed", None)
        steady = dataclasses.asdict(sections["inputs"]) if "inputs" in sections else {}
        steady |= {next(iter(coordinates)): value(sections, "drive", "torque")}
        fast = dict.fromkeys(coordinates, speed) if speed else {}
        fast |= {q: rate for q in coordinates if (rate := value(sections, "start", f"{q}d"))}
        return doubts + links.by_links(plan.listing(None), dataclasses.asdict(parameters), steady, fast)
    bore = None if area is None else math.sqrt(4 * area / math.pi)
    alone, together = _sizes(sections, sizes, bore), by_size(sections, sizes, bore)
    if any(d.code == "reciprocating_mass" for d in alone):  # one slip is told once
        together = tuple(d for d in together if not d.quantity.startswith(MOVING) and d.code != "crank_inertia")
    doubts += (*alone, *together, *laws.by_firing(sections, parameters), *laws.by_throws(parameters))
    if not own.is_file(mechanism) and not any("mass" in d.code for d in doubts):
        doubts += links.by_mass(parameters)
    shaft = elastic(mechanism, parameters)
    if shaft is None:
        return doubts
    return doubts + by_shaft(shaft) + laws.by_twist(sections, shaft, sizes.stroke, area)


def _sizes(sections: Records, sizes: Proportions, bore: float | None) -> tuple[Doubt, ...]:
    """Doubts about an engine by its stroke and the area of its pistons."""
    doubts = laws.by_speed(sections, sizes)
    guide, spring = getattr(sections.get("guide"), "rho0", None), getattr(sections.get("spring"), "A", None)
    if guide is not None and sizes.stroke:
        doubts += proportion("guide_size", "guide.rho0 / stroke", guide / sizes.stroke)
    faces = sections.get("faces")
    for part in sizes.moving:
        area = _piston_area(sections)
        if faces is not None:  # of the pistons on this axis
            each = zip(faces.sides, faces.areas, strict=True)
            area = sum(area for side, area in each if side.startswith(part.axis))
        if bore and area and part.mass:  # without mass is a model, not a mistake
            doubts += moving_mass(f"parameters.{part.letters}", part.mass, area, bore, sizes.stroke)
    if spring is not None and bore:
        share = proportion("spring_area", "spring.A / piston area", spring / (math.pi / 4 * bore**2))
        doubts += share
        if not share and (mean := value(sections, "cycle", "mean_indicated_pressure")):  # one slip is told once
            force = spring * value(sections, "spring", "p0") / (mean * math.pi / 4 * bore**2)
            what = "spring.p0 * A / (cycle.mean_indicated_pressure * piston area)"
            doubts += proportion("spring_force", what, force) if force else ()
    return doubts


@functools.lru_cache(maxsize=256)
def _keys(section: str, kind: object) -> tuple[tuple[str, str], ...]:
    """Dotted keys and names of the values of a section; of a mechanism's letters those that mean what they say."""
    fields = dataclasses.fields(kind) if dataclasses.is_dataclass(kind) else ()
    known = {(name, k.unit) for k in INPUTS if k.section == section for name in k.keys}
    every = section not in _LETTERS
    return tuple((f"{section}.{f.name}", f.name) for f in fields if every or (f.name, f.metadata.get("unit")) in known)


def _piston_area(sections: Records) -> float | None:
    return math.pi / 4 * laws.bore(sections) ** 2 or None


# absolute pressure of the charge, what each kind of cycle calls it
_CHARGE = ("intake_pressure", "p_s", "mean_pressure", "p_suction", "inlet_pressure", "exhaust_pressure")
MOVING = "moving mass"
_ATMOSPHERE = 101325.0  # [Pa]
_Told = tuple[str, str, float]  # kind, what it is, value


def by_size(sections: Records, sizes: Proportions, bore: Metre | None) -> tuple[Doubt, ...]:
    """What is out of proportion to the machine. bore: of the piston; None where it is not known."""
    doubtful = [*_inertias(sections, sizes), *_by_part(sections, sizes), *_fitted(sections)]
    if "cycle" in sections:  # what a press moves is as heavy as its flywheel carries
        volume = (bore or sizes.stroke) ** 2 * sizes.stroke  # without a bore the stroke stands for it
        doubtful.append(("mass_density", f"{MOVING} / (bore^2 * stroke)", sizes.mass / volume))
    if bore:
        doubtful.append(("stroke_ratio", "stroke / bore", sizes.stroke / bore))
        doubtful += [*_valves(sections, bore), *_areas(sections, sizes, bore)]
    return _doubts(doubtful) + by_stroke(sections, sizes.stroke, bore)


def by_stroke(sections: Records, stroke: Metre, bore: Metre | None) -> tuple[Doubt, ...]:
    """Sizes of sections by stroke and bore of the piston, times by that of a turn."""
    measures = {"stroke": stroke}
    if omega := value(sections, "operation", "speed"):
        measures["time of a turn"] = math.tau / abs(omega)
    if bore:
        area = math.pi / 4 * bore**2
        measures |= {"bore": bore, "bore^3": bore**3, "piston area": area, "swept volume": area * stroke}
        measures["that of solid copper"] = 400 * area / stroke  # a block of the piston's width [W/K]
    return _doubts(_by_measure(sections, measures))


@functools.cache
def _measured() -> tuple[dict[str, str], ...]:
    """Rows of `scales.csv`: code of the doubt, section, names of its keys (all where none is named), measure."""
    text = resources.files("mechsym.cases").joinpath("scales.csv").read_text("utf-8")
    return tuple(csv.DictReader(text.splitlines()))


def _by_measure(sections: Records, measures: Mapping[str, float]) -> Iterator[_Told]:
    for row in _measured():
        section, by = row["section"], row["by"]
        if section not in sections or by not in measures:
            continue
        every = [f.name for f in _fields(sections[section]) if "unit" in f.metadata]
        for name in row["names"].split() or every:
            size = value(sections, section, name)
            for one in set(size) if isinstance(size, tuple) else (size,):
                yield row["code"], f"{section}.{name} / {by}", one / measures[by]


def by_shaft(shaft: ElasticShaft) -> tuple[Doubt, ...]:
    r"""Stiffness and damping of each section of an elastic shaft, by what swings against each other on its two sides.

    .. math:: \omega = \sqrt{k/I}, \quad \zeta = c / (2\sqrt{k I}), \quad 1/I = 1/I_1 + 1/I_2
    """
    doubtful: list[_Told] = []
    sides = list(itertools.accumulate(shaft.discs))
    for one, k, c in zip(sides, shaft.k, shaft.c, strict=False):
        inertia = one * (1 - one / sides[-1])
        if k == 0 or inertia <= 0:  # nothing swings
            continue
        doubtful.append(("shaft_frequency", "sqrt(stiffness / inertia of both sides), rad/s", math.sqrt(k / inertia)))
        doubtful.append(("shaft_damping", "damping / (2 sqrt(stiffness * inertia))", c / (2 * math.sqrt(k * inertia))))
    return _doubts(doubtful)


def by_unit(sections: Records, names: tuple[str, ...]) -> tuple[Doubt, ...]:
    """What is beyond the largest machines, in sections of letters that may mean anything."""
    groups = {}
    for section in names:
        for field in _fields(sections.get(section)):
            value = getattr(sections[section], field.name)
            values = [v for v in (value if isinstance(value, tuple) else (value,)) if isinstance(v, float)]
            groups[f"{section}.{field.name}"] = (max(values, key=abs, default=0.0), field.metadata.get("unit", ""))
    return letters(groups)


def _doubts(doubtful: Iterable[_Told]) -> tuple[Doubt, ...]:
    return tuple(d for code, name, value in doubtful if value for d in proportion(code, name, value))


def _fields(record: object) -> tuple[Field, ...]:
    return dataclasses.fields(record) if dataclasses.is_dataclass(record) else ()


def _inertias(sections: Records, sizes: Proportions) -> Iterator[_Told]:
    for letter, (inertia, like) in sizes.parts.items():
        if like > 0:
            yield "part_inertia", f"parameters.{letter} / (mass * length^2)", inertia / like
    for letter, ratio in sizes.ends.items():
        yield "rod_ends", f"parameters.{letter} / (mass * l1 * l2)", ratio
    scale = sizes.mass * (sizes.stroke / 2) ** 2
    if scale <= 0:
        return
    about = "(moving mass * half stroke^2)"
    kept = value(sections, "flywheel", "inertia") / scale
    beside = kept > 1 or sizes.shafts.get(sizes.flywheel, 0.0) > scale
    for letter, inertia in sizes.shafts.items():  # a crank with a flywheel beside it carries none
        code = "crank_inertia" if beside and letter != sizes.flywheel else "inertia"
        yield code, f"parameters.{letter} / {about}", inertia / scale
    for letter, moment in sizes.unbalances.items():
        yield "unbalance", f"parameters.{letter} / (moving mass * half stroke)", abs(moment) * sizes.stroke / 2 / scale
    if kept > 1:  # a small one is as good as none
        yield "inertia", f"flywheel.inertia / {about}", kept
    if (turning := sum(sizes.shafts.values())) > 0:
        yield "flywheel_share", "flywheel.inertia / inertia of the shaft", kept * scale / turning
    if "cycle" not in sections:
        yield "carried", f"inertia of the shaft / {about}", sum(sizes.shafts.values()) / scale + kept


def _by_part(sections: Records, sizes: Proportions) -> Iterator[_Told]:
    """What belongs to the gears, rollers and cranks of the mechanism."""
    radius = value(sections, "part_gears", "module") * value(sections, "part_gears", "teeth_pinion") / 2
    yield "gear_pitch", "part_gears.module * teeth_pinion / 2 / (stroke / 4)", 4 * radius / sizes.stroke
    if roller := value(sections, "rollers", "radius"):
        share = value(sections, "losses", "bearing_radius") / roller
        yield "bearing_share", "losses.bearing_radius / rollers.radius", share
        width = value(sections, "rollers", "width")
        yield "track_planes", "rollers.plane_offset / width", value(sections, "rollers", "plane_offset") / width
        steel = links.STEEL * math.pi * roller**2 * width
        for section in ("rollers", "codesign"):
            what = f"{section}.moving_mass / that of a roller of steel"
            yield "roller_mass", what, value(sections, section, "moving_mass") / steel
    for letter, ratio in sizes.unequal.items():
        yield "unequal", f"largest parameters.{letter} / least", ratio
    if sizes.span is not None:
        yield "opposed_span", "distance of the shafts / (r + l1 + l2 of both)", sizes.span


def _fitted(sections: Records) -> Iterator[_Told]:
    """Constants of fitted laws by the law's own."""
    for section, names in (("heat_transfer", ("c1", "c2")), ("friction_pressure", ())):
        for field in _fields(sections.get(section)):
            own = field.default
            if isinstance(own, float) and own and (field.name in names or not names):
                about = f"{section}.{field.name} / the law's own {own:g}"
                yield "fitted_constant", about, value(sections, section, field.name) / own


def _areas(sections: Records, sizes: Proportions, bore: float) -> Iterator[_Told]:
    """Pressures, forces and stiffnesses by the area of a piston."""
    area = math.pi / 4 * bore**2
    charge = next((p for p in (value(sections, "cycle", name) for name in _CHARGE) if p), _ATMOSPHERE)
    for section, name in (("cycle", "p_back"), ("chamber", "back_pressure")):
        share = value(sections, section, name) / max(charge, _ATMOSPHERE)  # a throttled charge has less
        yield "back_pressure_share", f"{section}.{name} / charge", share
    faces = getattr(sections.get("faces"), "areas", ())
    swept = (sum(faces) or area * sizes.pistons) * sizes.stroke * (value(sections, "chamber", "pistons") or 1)
    for name, torque in laws.load_torques(sections):
        yield "load_pressure", f"{name} * 2 pi / swept volume", 2 * math.pi * torque / swept
    for name in ("k_a", "k_b", "k_c"):
        about = f"closing.{name} * bore / (1 MPa * piston area)"
        yield "joint_stiffness", about, value(sections, "closing", name) * bore / (1e6 * area)
    if sizes.pitch is not None:
        least, largest = sizes.pitch
        yield "cylinder_pitch", "least distance of two cylinders / bore", least / bore or 1e-9
        yield "cylinder_pitch", "largest distance of a cylinder from its next / bore", largest / bore or 1e-9


def _valves(sections: Records, bore: float) -> Iterator[_Told]:
    """Valves by each other, and together by the bore."""
    for section, valve in (("breathing", "inlet"), ("breathing", "exhaust"), ("scavenging", "valve")):
        if width := value(sections, section, f"{valve}_diameter"):
            about = f"{section}.{valve}_lift / {valve}_diameter"
            yield "lift_share", about, value(sections, section, f"{valve}_lift") / width
    squares = sum(value(sections, "breathing", f"{valve}_diameter") ** 2 for valve in ("inlet", "exhaust"))
    about = "breathing.valves * (inlet_diameter^2 + exhaust_diameter^2) / bore^2"
    yield "valve_area", about, value(sections, "breathing", "valves") * squares / bore**2
