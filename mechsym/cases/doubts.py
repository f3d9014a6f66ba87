"""What of a case is nonsense or unusual, and which doubts its author accepts.

[doubts]
twist = { up_to = "2 rad", why = "the source's model; a real shaft breaks" }
"""

import dataclasses
import functools
import math
from typing import TYPE_CHECKING

from mechsym.cases.laws import Records, by_firing, by_law, by_links, by_sign, by_speed, by_throws, by_twist, value
from mechsym.cases.scales import MOVING, by_shaft, by_size, by_unit
from mechsym.errors import BadInput, shown, suggest
from mechsym.mechanisms import own
from mechsym.mechanisms.plan import plan_of
from mechsym.mechanisms.proportions import Proportions
from mechsym.mechanisms.shaft import elastic
from mechsym.plausible import INPUTS, PROPORTIONS, RESULTS, Acceptance, Doubt, inputs, moving_mass, proportion
from mechsym.quantities import parse
from mechsym.quantities.records import Field

if TYPE_CHECKING:
    from mechsym.derive.listing import Listing

# doubts about measured diagrams, in the units that they name
_MEASURED = (
    "compression_exponent dead_centre dead_centre_width drift early_heat even_angles expansion_exponent floor "
    "free_exponent heat loss_angle mechanical_efficiency peak_angle scale speed"
).split()
_UNITS = {k.code: k.unit for k in (*INPUTS, *RESULTS, *PROPORTIONS)} | dict.fromkeys((*_MEASURED, "unused"), "-")
_UNITS |= {"drive_start": "s", "massless": "kg*m^2"}

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
            value = getattr(record, name)
            if isinstance(value, tuple) and value and all(isinstance(v, float) for v in value):
                value = max(value, key=abs)
            if isinstance(value, float) and math.isfinite(value):
                values[key] = value
    doubts = inputs(values) + by_unit(sections, _LETTERS) + by_law(sections)
    parameters = sections.get("parameters")
    # a file that nobody trusts yet has no content, and is not run
    if parameters is None or own.is_file(mechanism) and not own.content(mechanism):
        return doubts
    plan = plan_of(mechanism)
    sizes, area = plan.proportions(parameters), _piston_area(sections)
    if own.is_file(mechanism):
        doubts += tuple(by_sign(plan.listing(None), dataclasses.asdict(parameters)))
    if sizes is None:
        return doubts + _of_links(sections, plan.listing(None))
    bore = None if area is None else math.sqrt(4 * area / math.pi)
    alone, together = _sizes(sections, sizes, bore), by_size(sections, sizes, bore)
    if any(d.code == "reciprocating_mass" for d in alone):  # one slip is told once
        together = tuple(d for d in together if not d.quantity.startswith(MOVING))
    doubts += (*alone, *together, *by_firing(sections, parameters), *by_throws(parameters))
    shaft = elastic(mechanism, parameters)
    if shaft is None:
        return doubts
    return doubts + by_shaft(shaft) + by_twist(sections, shaft, sizes.stroke, area)


def _of_links(sections: Records, listing: "Listing") -> tuple[Doubt, ...]:
    """Doubts about the links of a mechanism that says no stroke."""
    letters, steady = (
        dataclasses.asdict(sections[name]) if name in sections else {} for name in ("parameters", "inputs")
    )
    steady |= {next(iter(listing["coordinates"])): value(sections, "drive", "torque")}
    speed = getattr(sections.get("operation"), "speed", None)
    return by_links(listing, letters, steady, dict.fromkeys(listing["coordinates"], speed) if speed else {})


def _sizes(sections: Records, sizes: Proportions, bore: float | None) -> tuple[Doubt, ...]:
    """Doubts about an engine by its stroke and the area of its pistons."""
    doubts = by_speed(sections, sizes)
    guide, spring = getattr(sections.get("guide"), "rho0", None), getattr(sections.get("spring"), "A", None)
    if guide is not None and sizes.stroke:
        doubts += proportion("guide_size", "guide.rho0 / stroke", guide / sizes.stroke)
    for part in sizes.moving:
        area = _driven(sections, part.axis)
        if bore and area and part.mass:  # without mass is a model, not a mistake
            doubts += moving_mass(f"parameters.{part.letters}", part.mass, area, bore, sizes.stroke)
    if spring is not None and bore:
        doubts += proportion("spring_area", "spring.A / piston area", spring / (math.pi / 4 * bore**2))
    return doubts


def _driven(sections: Records, axis: str) -> float | None:
    """Area of the pistons on an axis; of the only one where the mechanism has no axes [m^2]."""
    faces = sections.get("faces")
    if faces is None:
        return _piston_area(sections)
    return sum(area for side, area in zip(faces.sides, faces.areas, strict=True) if side.startswith(axis))


@functools.lru_cache(maxsize=256)
def _keys(section: str, kind: object) -> tuple[tuple[str, str], ...]:
    """Dotted keys and names of the values of a section."""
    fields = dataclasses.fields(kind) if dataclasses.is_dataclass(kind) else ()
    return tuple((f"{section}.{f.name}", f.name) for f in fields if section not in _LETTERS or _known(section, f))


def _known(section: str, letter: Field) -> bool:
    """Whether a letter of a mechanism is meant for what its name and its unit say."""
    unit = letter.metadata.get("unit")
    return any(k.section == section and letter.name in k.keys and k.unit == unit for k in INPUTS)


def _piston_area(sections: Records) -> float | None:
    bores = [getattr(sections.get(name), "bore", None) for name in ("chamber", "cycle")]
    return next((math.pi / 4 * bore**2 for bore in bores if bore), None)
