"""`mechsym forces`: the forces of a case over one cycle at constant speed."""

import dataclasses
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from mechsym.cases import Case
from mechsym.cases.facts import facts_of
from mechsym.cases.needs import require
from mechsym.cases.runs import guesses
from mechsym.cycle.friction import Friction, MechanismFriction
from mechsym.cycle.kinds import kind_of
from mechsym.errors import BadInput
from mechsym.files import Json, to_json, write_quantities, write_text
from mechsym.forces import driven, result, shown
from mechsym.forces.friction import NoRings
from mechsym.forces.result import ComparisonSettings, Forces, compare
from mechsym.forces.summary import ForceNumbers, summary
from mechsym.forces.turn import Turn
from mechsym.jobs.gas import of
from mechsym.jobs.machine import constants, fitted_law, mechanism_of, turn
from mechsym.mechanisms import listing
from mechsym.page import Finding
from mechsym.quantities.results import part, quantity
from mechsym.quantities.results import result as result_record
from mechsym.quantities.units import RadPerSecond
from mechsym.torsion import twist
from mechsym.torsion.twist import ShaftLimits, TrainVibration, operating_range
from mechsym.torsion.twist import vibration as vibration_of


@result_record
class FrictionLaw:
    """The mechanism's friction as a law of the cycle, for `[friction_pressure]`."""

    law: str = part()
    constant: float = quantity("Pa")  #: Whatever the speed
    per_peak_pressure: float = quantity("-")  #: Of the largest pressure
    per_speed: float = quantity("Pa*s/m")  #: Of the mean piston speed
    per_speed_squared: float = quantity("Pa*s^2/m^2")  #: Of its square
    misfit: float = quantity("-")  #: Largest difference over the largest value


@result_record
class ForceReport:
    """What `mechsym forces` tells of a case."""

    numbers: ForceNumbers = part(inline=True)
    vibration: TrainVibration | None = part()  #: Criticals of a crank train
    friction_law: FrictionLaw | None = part()  #: Fitted over speeds that are asked for


def forces(case: Case, comparison: bool = False) -> Forces:
    """Forces of a case over one cycle at constant speed.

    case: see `turn`; `[friction]`, `[rings]`, `[friction_pressure]`, `[shaking]` and `[comparison]` are read where they
    stand. comparison: whether the mechanisms are put side by side as well.

    >>> from mechsym import cases
    >>> found = forces(cases.load("zotov-89"))
    >>> round(float(found.columns["crank_pin_load"].max()) / 1e3, 1)
    485.8
    """
    require(case, "forces")
    one, given = turn(case), case.sections
    friction, rings = given.get("friction"), given.get("rings", NoRings())
    found = result.forces(one, friction, rings, given.get("shaking"), given.get("shaft"), _whole(case))
    if not comparison:
        return found
    with of(case):
        rows = compare(one, friction, rings, given.get("comparison", ComparisonSettings()))
    return dataclasses.replace(found, comparison=rows)


def motion(case: Case) -> driven.DrivenForces:
    """Forces of a case over time, by its `[motion]`. Raises BadInput: what is driven, or the path, cannot be."""
    require(case, "forces")
    mechanism, units = mechanism_of(case), listing(case.mechanism)["outputs"]
    try:
        return driven.forces(mechanism, case.need("motion"), guesses(case), constants(case), units)
    except BadInput as error:
        raise BadInput(f"{case.file}: {error}") from None


def _whole(case: Case) -> Friction | None:
    """The law of the friction of the whole engine; none where it is the sum of the joints."""
    kind = kind_of(case.need("cycle")) if "cycle" in case.sections else None
    if kind is None or kind.shared or kind.measured:
        return None
    law = case.sections.get("friction_pressure")
    return None if isinstance(law, MechanismFriction) else law


def told(case: Case, found: Forces, law: Sequence[RadPerSecond] | None = None) -> ForceReport:
    """The forces of a case in numbers. law: speeds over which the friction is fitted as a law of the cycle."""
    numbers, shaking = summary(found, case.name, case.source), vibration(case, found.turn)
    if shaking is not None:
        numbers = dataclasses.replace(numbers, facts=[*numbers.facts, *twist.words(shaking)])
    return ForceReport(numbers=numbers, vibration=shaking, friction_law=None if law is None else _law(case, law))


def _law(case: Case, speeds: Sequence[float]) -> FrictionLaw:
    found = fitted_law(case, speeds)
    return FrictionLaw(law="chen_flynn", misfit=found.misfit, **dataclasses.asdict(found.law))


def write(case: Case, found: Forces, numbers: Json, folder: Path, findings: Sequence[Finding] = ()) -> list[Path]:
    """Write page, tables, summary and pictures into a folder. findings: what has to be known first."""
    about = case.about or listing(case.mechanism)["about"] or case.name
    return shown.write(found, numbers, folder, about, findings)


def write_motion(found: driven.DrivenForces, numbers: Json, folder: Path) -> list[Path]:
    """Write table and summary of a motion."""
    return [
        write_quantities(folder / "forces.csv", found.columns, found.columns.units),
        write_text(folder / "summary.json", to_json(numbers) + "\n"),
    ]


def vibration(case: Case, one: Turn | None = None) -> TrainVibration | None:
    """Natural frequencies, criticals and steady vibration of a crank train; None for every other mechanism.

    case: with `[operation]`; `[cycle]` excites beside the masses, `[speeds]` is the operating range, `[shaft]` its
    limits. one: a cycle of it at constant speed, when there is one already.
    """
    if not facts_of(case.mechanism, case.sections).vibrates or "operation" not in case.sections:
        return None
    one, given, wanted = one or turn(case), case.sections.get("speeds"), case.sections.get("simulation")
    span = None if given is None else (given.lowest, given.highest)
    gas = {name: _over(one, push) for name, push in one.inputs.items()}
    speeds = operating_range(one.omega, getattr(wanted, "speed_start", None), span)
    limits = case.sections.get("shaft", ShaftLimits())
    return vibration_of(case.mechanism, case.need("parameters"), gas, one.period, speeds, limits)


def _over(one: Turn, push: np.ndarray) -> Callable[[np.ndarray], np.ndarray]:
    return lambda phi: np.interp(phi, one.phi, push, period=one.period)
