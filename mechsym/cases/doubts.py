"""What of a case is nonsense or unusual, and which doubts its author accepts.

[doubts]
twist = { up_to = "2 rad", why = "the source's model; a real shaft breaks" }
"""

import dataclasses
import functools
import math
from collections.abc import Mapping
from typing import Any

from mechsym.errors import BadInput, shown, suggest
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


def judged(sections: Mapping[str, Any], own: bool = False) -> tuple[Doubt, ...]:
    """Doubts about the values of a case; nonsense is refused with its key.

    Parameters
    ----------
    own : bool
        Whether the mechanism is the user's own, whose letters may mean anything
    """
    values = {
        key: value
        for section, record in sections.items()
        for key, name in _keys(section, record.__class__)
        if isinstance(value := getattr(record, name), float) and math.isfinite(value)
    }
    if own:
        known = {key: value for key, value in values.items() if key.partition(".")[0] not in _LETTERS}
        return inputs(known) + _run(sections)
    found = inputs(values) + _run(sections)
    stroke, ratio = _crank(sections.get("parameters"))
    area, spring = _piston_area(sections), getattr(sections.get("spring"), "A", None)
    found += proportions(stroke, ratio, getattr(sections.get("operation"), "speed", None))
    guide = getattr(sections.get("guide"), "rho0", None)
    if guide is not None and stroke:
        found += proportion("guide_size", "guide.rho0 / stroke", guide / stroke)
    return found + scaled(_masses(sections, area), spring, area)


@functools.lru_cache(maxsize=256)
def _keys(section: str, kind: Any) -> tuple[tuple[str, str], ...]:
    """Dotted keys and names of the values of a section."""
    fields = dataclasses.fields(kind) if dataclasses.is_dataclass(kind) else ()
    return tuple((f"{section}.{f.name}", f.name) for f in fields)


def _piston_area(sections: Mapping[str, Any]) -> float | None:
    bores = [getattr(sections.get(name), "bore", None) for name in ("chamber", "cycle")]
    return next((math.pi / 4 * bore**2 for bore in bores if bore), None)


def _masses(sections: Mapping[str, Any], area: float | None) -> dict[str, tuple[float, float]]:
    """What moves to and fro with the piston, by the letters of the mechanisms, and the area of what drives it."""
    parameters: Any = sections.get("parameters")
    faces = sections.get("faces")
    if faces is not None and hasattr(parameters, "m_link"):  # rodless: all pistons of an axis on one slider
        sizes = {axis: sum(a for s, a in zip(faces.sides, faces.areas, strict=True) if s[0] == axis) for axis in "ab"}
        return {f"m_{axis}": (getattr(parameters, f"m_{axis}"), size) for axis, size in sizes.items() if size}
    if area is None:
        return {}
    if hasattr(parameters, "m_piston"):
        masses = parameters.m_piston if isinstance(parameters.m_piston, tuple) else (parameters.m_piston,)
        return {f"m_piston[{i}]" if masses[1:] else "m_piston": (m, area) for i, m in enumerate(masses)}
    names = ("m3", "m4", "m5") if hasattr(parameters, "m5") else ("m3",) if hasattr(parameters, "alpha_n") else ()
    return {" + ".join(names): (sum(getattr(parameters, name) for name in names), area)} if names else {}


def _crank(parameters: Any) -> tuple[float | None, float | None]:
    """Stroke and rod ratio by the letters that mechanisms use: r, or r1 + r2, or e; l, or l1 + l2."""

    def letter(*names: str) -> float | None:
        found = [getattr(parameters, name, None) for name in names]
        numbers = [max(v) if isinstance(v, tuple) else v for v in found]
        return sum(numbers) if all(isinstance(v, float) for v in numbers) else None  # type: ignore[arg-type]

    if (throw := letter("e")) is not None:
        return 4 * throw, None
    if hasattr(parameters, "m_link"):  # rodless: the sliders move twice as far as a crank of that radius
        return 4 * parameters.r, None
    crank = letter("r") if hasattr(parameters, "r") else letter("r1", "r2")
    rod = letter("l") if hasattr(parameters, "l") else letter("l1", "l2")
    return (None if crank is None else 2 * crank), (rod / crank if crank and rod is not None else None)


def _run(sections: Mapping[str, Any]) -> tuple[Doubt, ...]:
    simulation, drive = sections.get("simulation"), sections.get("drive")
    end = getattr(simulation, "t_end", None)
    if drive is None or end is None or drive.time < end:
        return ()
    why = "the run ends before the drive is switched on: nothing happens in it"
    return (Doubt(code="drive_start", quantity="drive.time", value=drive.time, usual=f"below {end:g} s", why=why),)
