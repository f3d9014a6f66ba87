"""Engine cycles at many points: what differs in numbers only is one map, integrated side by side."""

import dataclasses
import functools
from collections.abc import Mapping, Sequence

import numpy as np

from mechsym.cases import Case
from mechsym.cycle.columns import UNITS
from mechsym.cycle.kinds import kind_of
from mechsym.files import Json
from mechsym.quantities.records import Record
from mechsym.quantities.results import Columns
from mechsym.quantities.units import Scalar
from mechsym.sweep.outcomes import Gap, Outcome

BLOCK = 500  # cycles in one map: enough to hide the making of its function, few enough for the progress to move
_SECTIONS = ("parameters", "chamber", "cycle", "gas", "heat_transfer", "friction_pressure")


def mapped(case: Case) -> bool:
    """Whether the cycles of a case with `[cycle]` come as maps; False for those solved one by one."""
    return kind_of(case.need("cycle")).closed


def single(case: Case) -> Columns:
    """Figures of one cycle of the engine, each with one value."""
    from mechsym.jobs.cycle import cycle

    return _of_the_engine(cycle(case))


def _of_the_engine(found: Mapping[str, object]) -> Columns:
    inner = ("cylinders", "each", "per_cylinder", "pistons")
    return Columns({name: values for name, values in found.items() if name not in inner}, UNITS)


def families(found: Sequence[Case]) -> list[list[int]]:
    """Cases that one map may hold: all but numbers of the engine and the speed are equal."""
    families: dict[object, list[int]] = {}
    for i, case in enumerate(found):
        families.setdefault(_form(case), []).append(i)
    return list(families.values())


def _form(case: Case) -> tuple[object, ...]:
    from mechsym.cycle.friction import MechanismFriction

    friction, cycle = case.sections.get("friction_pressure"), case.need("cycle")
    # the law is fitted around the speed of operation, so another speed is another engine
    fitted = case.need("operation").speed if isinstance(friction, MechanismFriction) else None
    records = [case.sections.get(name) for name in _SECTIONS]
    if fitted is not None:
        records += [case.sections.get("friction"), case.sections.get("rings")]
    alone = fitted is not None or getattr(cycle, "method", None) == "nunes2017_printed"
    return case.mechanism, fitted, tuple(_text(record, numbers=alone) for record in records)


def _text(record: Record | None, numbers: bool) -> str:
    """A record without the numbers that a map may vary, as a text to compare."""
    if record is None:
        return ""
    values = {f.name: getattr(record, f.name) for f in dataclasses.fields(record)}
    return repr((type(record), {k: v for k, v in values.items() if numbers or not isinstance(v, float)}))


def map_of(family: Sequence[Case]) -> list[Outcome]:
    """Figures of one family, each with the steps that it would take alone.

    Returns figures: as `mechsym.jobs.cycle` of the engine, each with one value; a gap where there is no cycle.
    """
    from mechsym.cycle.closed.model import closed_period
    from mechsym.cycle.closed.run import steps_needed
    from mechsym.cycle.engine import columns, over_design
    from mechsym.jobs.cycle import engine, of_engine
    from mechsym.jobs.gas import one_cylinder

    seen = [one_cylinder(case) for case in family]
    design = {"omega": np.array([case.need("operation").speed for case in seen])} | _varied(seen)
    machine = engine(seen[0])
    steps, reasons = np.ones(design["omega"].size, dtype=int), dict[int, str]()
    if machine.cycle.method != "nunes2017_printed":
        steps, reasons = steps_needed(functools.partial(closed_period, machine), design)
    outcomes: dict[int, Outcome] = {i: Gap(reason=reason, of_input=True) for i, reason in reasons.items()}
    for group in (np.flatnonzero(steps == count) for count in set(steps[steps > 0])):
        found = columns(over_design(machine, {name: values[group] for name, values in design.items()}))
        for k, i in enumerate(group.tolist()):
            outcomes[i] = _of_the_engine(of_engine(family[i], _at(found, k), design["omega"][[i]]))
    return [outcomes[i] for i in range(len(family))]


def _varied(seen: Sequence[Case]) -> dict[str, np.ndarray]:
    """Numbers of the engine that are not the same in all cases."""
    found = {}
    for section in _SECTIONS:
        first = seen[0].sections.get(section)
        for field in dataclasses.fields(first) if first is not None else ():
            values = [getattr(case.sections[section], field.name) for case in seen]
            if isinstance(values[0], float) and len(set(values)) > 1:
                found[f"{section}.{field.name}"] = np.array(values)
    return found


def _at(columns: Mapping[str, Scalar], index: int) -> Json:
    return {
        name: _at(values, index) if isinstance(values, Mapping) else float(values[index])
        for name, values in columns.items()
    }
