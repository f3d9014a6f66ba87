"""Which guides can be built: the limits of many springs at once by one compiled function, see `hinge.kernel`.

`judge` decides again what is near to a limit, and gives the numbers of the best guide of a call.
"""

import dataclasses
import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from mechsym import cases
from mechsym.cases import Case
from mechsym.cases.values import Place
from mechsym.errors import BadInput
from mechsym.quantities import parse
from mechsym.sweep.outcomes import Outcome, known

BLOCK = 2000  # points in one call: enough to hide the making of the kernel, few enough for the progress to move
_SECTIONS = ("spring", "guide", "rollers", "limits")
_KERNEL = 1e-3  # margins of the kernel differ from those of `judge` by less; nearer to a limit than this is not decided


def guides(case: str, overrides: Mapping[str, Any], heres: Sequence[Mapping[str, Any]]) -> list[Outcome]:
    """Margins of the guide at each point, by limit.

    Parameters
    ----------
    case : str
        Name of a built-in case or path of a file
    overrides : mapping
        Values that hold at all points
    heres : sequence of mapping
        Values of the axes at each point, as `--set` takes them

    Returns
    -------
    outcomes : list of dict or Gap
        `feasible`, `margin` (the smallest), `judged` (1 for numbers of `judge`, 0 within 1e-4 of them), `margins` [-]
    """
    places = {key: cases.locate(case, key, overrides) for key in heres[0]}
    numbers = {key: place for key, place in places.items() if _is_number(place)}
    groups: dict[tuple[tuple[str, Any], ...], list[int]] = {}
    for i, here in enumerate(heres):
        groups.setdefault(tuple((k, v) for k, v in here.items() if k not in numbers), []).append(i)
    outcomes: dict[int, Outcome] = {}
    for rest, members in groups.items():
        at = {**overrides, **dict(rest)}
        free = [{key: heres[i][key] for key in numbers} for i in members]
        try:
            found = _margins(cases.load(case, at), numbers, free)
        except (BadInput, ArithmeticError, ValueError, RuntimeError) as error:
            found = [known(error)] * len(members)
        outcomes |= dict(zip(members, found, strict=True))
    return [outcomes[i] for i in range(len(heres))]


def _is_number(place: Place) -> bool:
    return place.section in _SECTIONS and place.unit is not None and place.field != "shaft_ratio"


def _margins(case: Case, places: Mapping[str, Place], heres: Sequence[Mapping[str, Any]]) -> list[Outcome]:
    from mechsym.hinge.balance import balance
    from mechsym.hinge.kernel import design_kernel
    from mechsym.hinge.torque import torque
    from mechsym.jobs.machine import machine

    given = {name: case.need(name) for name in _SECTIONS}
    wanted = balance(torque(machine(case)), given["guide"].balance)
    # a map over speeds alone has one design at each of them
    names = [f"{p.section}.{p.field}" for p in places.values()] or ["limits.closing_share"]
    designs = [_design(case, given, places, here) for here in heres]
    good = [i for i, design in enumerate(designs) if isinstance(design, dict)]
    spring, choices, rollers, limits = given.values()
    kernel = design_kernel(wanted, spring, choices, rollers, limits, names)
    values = [[getattr(designs[i][s], f) for s, _, f in (n.partition(".") for n in names)] for i in good]
    outcomes = dict(enumerate(designs))
    margins = kernel.margins(np.array(values).reshape(len(good), len(names)))
    least = margins.min(axis=1, initial=np.inf)
    again = (np.abs(least) < _KERNEL) | (least == least.max(initial=-1.0))
    for k, i in enumerate(good):
        told = dict(zip(kernel.limits, margins[k].tolist(), strict=True))
        outcomes[i] = _judged(wanted, designs[i], kernel.limits) if again[k] else _told(told)
    return [outcomes[i] for i in range(len(heres))]


def _design(case: Case, given: Mapping[str, Any], places: Mapping[str, Place], here: Mapping[str, Any]) -> Any:
    """Records of a point by section, or the gap that an impossible value leaves."""
    changed: dict[str, dict[str, float]] = {name: {} for name in given}
    try:
        for key, place in places.items():
            text = f"{here[key]} {place.written}" if place.written else here[key]
            changed[place.section][place.field] = parse(text, place.unit or "-", key)
        return {name: dataclasses.replace(found, **changed[name]) for name, found in given.items()}
    except BadInput as error:
        return known(BadInput(f"{case.file}: {error}"))


def _judged(wanted: Any, design: Mapping[str, Any], limits: Sequence[str]) -> Outcome:
    from mechsym.hinge.guide import cut
    from mechsym.hinge.limits import judge

    verdict = judge(cut(wanted, design["spring"], design["guide"]), design["rollers"], design["limits"])
    margins = {c.name: math.nan if c.margin is None else c.margin for c in verdict.checks if c.name in limits}
    return {"feasible": float(verdict.feasible), "margin": verdict.margin, "judged": 1.0, "margins": margins}


def _told(margins: Mapping[str, float]) -> Outcome:
    """What the kernel says, a limit that asks nothing as not a number; -1 throughout where there is no guide."""
    least = min(margins.values())
    found = {name: m if math.isfinite(m) else math.nan for name, m in margins.items()}
    return {"feasible": float(least >= 0), "margin": least, "judged": 0.0, "margins": found}
