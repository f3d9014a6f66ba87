"""What of a case is nonsense or unusual, and which doubts its author accepts.

[doubts]
twist = { up_to = "2 rad", why = "the source's model; a real shaft breaks" }
"""

import dataclasses
import functools
import math
from collections.abc import Mapping
from typing import Any

from mechsym.cases.scales import MOVING, by_shaft, by_size, by_unit
from mechsym.errors import BadInput, shown, suggest
from mechsym.mechanisms import own
from mechsym.mechanisms.proportions import Proportions
from mechsym.mechanisms.traits import traits_of
from mechsym.plausible import INPUTS, PROPORTIONS, RESULTS, Acceptance, Doubt, inputs, proportion, proportions, scaled
from mechsym.quantities import parse

# doubts about measured diagrams, in the units that they name
_MEASURED = (
    "compression_exponent",
    "dead_centre",
    "dead_centre_width",
    "drift",
    "early_heat",
    "even_angles",
    "expansion_exponent",
    "floor",
    "free_exponent",
    "heat",
    "loss_angle",
    "mechanical_efficiency",
    "peak_angle",
    "scale",
    "speed",
)
_UNITS = (
    {k.code: k.unit for k in (*INPUTS, *RESULTS, *PROPORTIONS)} | {"drive_start": "s"} | dict.fromkeys(_MEASURED, "-")
)

_LETTERS = ("parameters", "inputs", "start")  # sections whose keys are the mechanism's letters


def acceptances(table: Any) -> dict[str, Acceptance]:
    """The section `[doubts]` of a case file."""
    if not isinstance(table, dict):
        raise BadInput("doubts is no section; write [doubts] and codes below it")
    return {code: _acceptance(code, row) for code, row in table.items()}


def _acceptance(code: str, row: Any) -> Acceptance:
    if not isinstance(row, dict) or set(row) != {"up_to", "why"} or not isinstance(row["why"], str):
        raise BadInput(f'doubts.{code} = {shown(row)}: write {code} = {{ up_to = "..", why = ".." }}')
    if code not in _UNITS:
        raise BadInput(f"doubts.{code} is not known; {suggest(code, sorted(_UNITS))}")
    return Acceptance(code=code, up_to=parse(row["up_to"], _UNITS[code], f"doubts.{code}.up_to"), why=row["why"])


def judged(sections: Mapping[str, Any], mechanism: str) -> tuple[Doubt, ...]:
    """Doubts about the values of a case; nonsense is refused with its key.

    The letters of a user's own mechanism may mean anything: they are left out.
    """
    values = {
        key: value
        for section, record in sections.items()
        if not (section in _LETTERS and own.is_file(mechanism))
        for key, name in _keys(section, record.__class__)
        if isinstance(value := _largest(getattr(record, name)), float) and math.isfinite(value)
    }
    found = inputs(values) + by_unit(sections, _LETTERS) + _run(sections)
    known, parameters = traits_of(mechanism), sections.get("parameters")
    if known is None or known.proportions is None or parameters is None:
        return found
    sizes, area = known.proportions(parameters), _piston_area(sections)
    bore = None if area is None else math.sqrt(4 * area / math.pi)
    alone, together = _sizes(sections, sizes), by_size(sections, sizes, bore)
    if any(d.code == "reciprocating_mass" for d in alone):  # one slip is told once
        together = tuple(d for d in together if not d.quantity.startswith(MOVING))
    found += alone + together
    return found + (() if known.shaft is None else by_shaft(known.shaft, parameters))


def _largest(value: Any) -> Any:
    """A number, or of a list the one that is farthest from zero."""
    numbers = value if isinstance(value, tuple) and value and all(isinstance(v, float) for v in value) else (value,)
    return max(numbers, key=abs) if len(numbers) > 1 else numbers[0]


def _sizes(sections: Mapping[str, Any], sizes: Proportions) -> tuple[Doubt, ...]:
    """Doubts about an engine by its stroke and the area of its pistons."""
    found = proportions(sizes.stroke, sizes.rod_ratio, getattr(sections.get("operation"), "speed", None))
    for section, name in (("speeds", "highest"), ("codesign", "full_speed"), ("codesign", "speeds")):
        fastest = _largest(getattr(sections.get(section), name, None))
        what = f"mean piston speed at {section}.{name}"
        found += proportion("piston_speed", what, sizes.stroke * fastest / math.pi) if fastest else ()
    guide, spring = getattr(sections.get("guide"), "rho0", None), getattr(sections.get("spring"), "A", None)
    if guide is not None and sizes.stroke:
        found += proportion("guide_size", "guide.rho0 / stroke", guide / sizes.stroke)
    areas = {part.letters: (part.mass, _driven(sections, part.axis)) for part in sizes.moving}
    masses = {letters: (mass, area) for letters, (mass, area) in areas.items() if area}
    return found + scaled(masses, spring, _piston_area(sections))


def _driven(sections: Mapping[str, Any], axis: str) -> float | None:
    """Area of the pistons on an axis; of the only one where the mechanism has no axes [m^2]."""
    faces = sections.get("faces")
    if faces is None:
        return _piston_area(sections)
    return sum(area for side, area in zip(faces.sides, faces.areas, strict=True) if side.startswith(axis))


@functools.lru_cache(maxsize=256)
def _keys(section: str, kind: Any) -> tuple[tuple[str, str], ...]:
    """Dotted keys and names of the values of a section."""
    fields = dataclasses.fields(kind) if dataclasses.is_dataclass(kind) else ()
    return tuple((f"{section}.{f.name}", f.name) for f in fields)


def _piston_area(sections: Mapping[str, Any]) -> float | None:
    bores = [getattr(sections.get(name), "bore", None) for name in ("chamber", "cycle")]
    return next((math.pi / 4 * bore**2 for bore in bores if bore), None)


def _run(sections: Mapping[str, Any]) -> tuple[Doubt, ...]:
    simulation, drive = sections.get("simulation"), sections.get("drive")
    end, claim = getattr(simulation, "t_end", None), getattr(sections.get("startup"), "claim_time", None)
    found = proportion("window", "startup.claim_time / simulation.t_end", claim / end) if claim and end else ()
    if drive is None or end is None or drive.time < end:
        return found
    why = "the run ends before the drive is switched on: nothing happens in it"
    late = Doubt(code="drive_start", quantity="drive.time", value=drive.time, usual=f"below {end:g} s", why=why)
    return (*found, late)
