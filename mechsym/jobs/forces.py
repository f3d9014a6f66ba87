"""`mechsym forces` and `balance`: the forces of a case over one cycle at constant speed, and what balances them.

What shakes the frame, and the counterweights and balancer shafts that leave the least of it.
"""

import dataclasses
import math
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import numpy as np

from mechsym.cases import Case
from mechsym.cases.facts import facts_of
from mechsym.cases.needs import require
from mechsym.cases.settings import guesses
from mechsym.cycle.friction import MechanismFriction
from mechsym.cycle.kinds import kind_of
from mechsym.errors import BadInput
from mechsym.files import Json, write_quantities, write_text
from mechsym.forces import balance as physics
from mechsym.forces import driven, result, shown
from mechsym.forces.balance import BalancedEngine, Shaken, Weight, amplitudes, length
from mechsym.forces.friction import NoRings
from mechsym.forces.loads import orders
from mechsym.forces.mains import MainShaft
from mechsym.forces.result import ComparisonSettings, Forces, compare
from mechsym.forces.summary import ForceNumbers, summary
from mechsym.forces.turn import Turn
from mechsym.jobs.gas import of
from mechsym.jobs.machine import constants, fitted_law, mechanism_of, turn
from mechsym.mechanisms import listing
from mechsym.page import Finding
from mechsym.quantities.results import part, quantity
from mechsym.quantities.results import result as result_record
from mechsym.quantities.units import KilogramMetre, Metre, RadPerSecond
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
    speeds: int = quantity("-")  #: That it is fitted to; up to four, its constants, tell nothing of how well it fits


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
    >>> result = forces(cases.load("zotov-89"))
    >>> round(float(result.columns["crank_pin_load"].max()) / 1e3, 1)
    485.8
    """
    require(case, "forces")
    one, given = turn(case), case.sections
    friction, rings = given.get("friction"), given.get("rings", NoRings())
    kind, law = kind_of(case.need("cycle")) if "cycle" in given else None, None
    if kind is not None and not (kind.shared or kind.measured):
        law = given.get("friction_pressure")
    if isinstance(law, MechanismFriction):
        law = None  # the friction of the whole engine is the sum of its joints
    loads = result.forces(one, friction, rings, given.get("shaking"), given.get("shaft"), law)
    if not comparison:
        return loads
    with of(case):
        rows = compare(one, friction, rings, given.get("comparison", ComparisonSettings()))
    return dataclasses.replace(loads, comparison=rows)


def motion(case: Case) -> driven.DrivenForces:
    """Forces of a case over time, by its `[motion]`. Raises BadInput: what is driven, or the path, cannot be."""
    require(case, "forces")
    mechanism, units = mechanism_of(case), listing(case.mechanism)["outputs"]
    try:
        return driven.forces(mechanism, case.need("motion"), guesses(case), constants(case), units)
    except BadInput as error:
        raise BadInput(f"{case.file}: {error}") from None


def reported(case: Case, loads: Forces, law: Sequence[RadPerSecond] | None = None) -> ForceReport:
    """The forces of a case in numbers. law: speeds over which the friction is fitted as a law of the cycle."""
    numbers, shaking = summary(loads, case.name, case.source), vibration(case, loads.turn)
    more = [*listing(case.mechanism).get("redundant", ()), *(() if shaking is None else twist.words(shaking))]
    if more:
        numbers = dataclasses.replace(numbers, facts=[*numbers.facts, *more])
    fitted = None
    if law is not None:
        found_law = fitted_law(case, law)
        numbers_of_law = dataclasses.asdict(found_law.law)
        fitted = FrictionLaw(law="chen_flynn", misfit=found_law.misfit, speeds=len(law), **numbers_of_law)
    return ForceReport(numbers=numbers, vibration=shaking, friction_law=fitted)


def write(case: Case, loads: Forces, numbers: Json, folder: Path, findings: Sequence[Finding] = ()) -> list[Path]:
    """Write page, tables, summary and pictures into a folder. findings: what has to be known first."""
    about = case.about or listing(case.mechanism)["about"] or case.name
    return shown.write(loads, numbers, folder, about, findings)


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


_NO_ANGLE = 1e-6  # deg
_ROUNDING = 1e-9  # of the largest value of a curve: an amplitude that is not larger is 0


@result_record
class ShakenNumbers:
    """What shakes the frame, and what its main bearings carry."""

    force: Mapping[str, float] = quantity("N")  #: Largest value of each whole order, and of those between that act
    couple: Mapping[str, float] = quantity("N*m")  #: The same of the couple about the shaft's middle
    #: The same of the moment about the shaft; empty where the mechanism does not tell it
    roll: Mapping[str, float] = quantity("N*m")
    force_max: float = quantity("N")  #: Of all orders together
    couple_max: float = quantity("N*m")  #: Likewise
    roll_max: float | None = quantity("N*m")  #: Likewise, half orders too; null where the mechanism does not tell it
    #: Largest load of a main bearing; null where the places of the bearings are not known
    main_bearing_max: float | None = quantity("N")


@result_record
class WeightNumbers:
    """A weight on the crankshaft or on a balancer shaft."""

    order: int = quantity("-")  #: Its speed over the crank's, negative against it
    z: float = quantity("m")  #: Place along the shaft
    x: float = quantity("m")  #: Of a balancer shaft, along the reference axis from the middle of its pair
    unbalance: float = quantity("kg*m")  #: Mass times radius
    angle_deg: float = quantity("deg")  #: Where it stands at crank angle 0, from the reference axis


@result_record
class BalanceOfEngine:
    """Forces and couples on the frame before and after."""

    case: str = part()
    speed_rpm: float = quantity("rpm")  #: Of the crank
    before: ShakenNumbers = part()
    after: ShakenNumbers = part()
    counterweights: tuple[WeightNumbers, ...] = part()
    shafts: tuple[WeightNumbers, ...] = part()  #: Weights of the balancer shafts, two a shaft


def balance(
    case: Case,
    weights: str = "ends",
    shafts: Sequence[int] = (),
    least: str = "frame",
    largest: KilogramMetre | None = None,
    apart: Metre = 0.0,
) -> BalancedEngine:
    """Counterweights and balancer shafts of a case at its speed of operation; arguments as in `forces.balance`.

    >>> from mechsym import cases
    >>> one = balance(cases.load("zotov-89"))
    >>> round(one.counterweights[0].unbalance, 1)
    186.6
    """
    require(case, "balance")
    settings = case.sections.get("shaft") or MainShaft()
    return physics.balance(turn(case), weights, shafts, least, largest, settings, apart)


def numbers(case: Case, one: BalancedEngine) -> BalanceOfEngine:
    """A balance in numbers."""
    return BalanceOfEngine(
        case=case.name,
        speed_rpm=one.turn.omega * 30 / math.pi,
        before=_shaken(one, one.before),
        after=_shaken(one, one.after),
        counterweights=tuple(map(_weight, one.counterweights)),
        shafts=tuple(map(_weight, one.shafts)),
    )


def _shaken(one: BalancedEngine, shaken: Shaken) -> ShakenNumbers:
    least, turn_of = shaken.rounding * one.turn.omega**2, one.turn
    at_ends = least * length(turn_of)

    def by_order(curve: np.ndarray, size: float) -> dict[str, float]:
        return {f"{k:.6g}": value for k, value in amplitudes(curve, turn_of, size).items()}

    def largest(curve: np.ndarray, size: float) -> float:
        peak = float(np.abs(curve).max())
        return peak if peak > size else 0.0

    roll = shaken.roll
    return ShakenNumbers(
        force=by_order(shaken.force, least),
        couple=by_order(shaken.couple, at_ends),
        roll={} if roll is None else by_order(roll, max(at_ends, _ROUNDING * float(np.abs(roll).max()))),
        force_max=largest(shaken.force, least),
        couple_max=largest(shaken.couple, at_ends),
        roll_max=None if roll is None else largest(roll, at_ends),
        main_bearing_max=max((float(journal.load.max()) for journal in shaken.journals), default=None),
    )


def _weight(one: Weight) -> WeightNumbers:
    angle = math.degrees(one.angle) % 360.0
    angle = 0.0 if 360.0 - angle < _NO_ANGLE else angle  # just below a whole turn by rounding
    return WeightNumbers(order=one.order, z=one.z, x=one.x, unbalance=one.unbalance, angle_deg=angle)


def write_balance(one: BalancedEngine, balanced: BalanceOfEngine, folder: Path, about: str) -> list[Path]:
    """Write the page, its picture, and the spectra that an engine's mounts feel, by order."""
    from mechsym.forces.plots import balance_orders
    from mechsym.page import page
    from mechsym.style import svg

    curves: dict[str, np.ndarray] = {}
    for when, shaken in (("before", one.before), ("after", one.after)):
        for name, both in (("force", shaken.force), ("couple", shaken.couple)):
            curves |= {f"{name}_x_{when}": both.real, f"{name}_y_{when}": both.imag}
    for when, shaken in (("before", one.before), ("after", one.after)):
        if shaken.roll is not None:
            curves[f"roll_{when}"] = shaken.roll
    spectra = {name: orders(values, one.turn.period) for name, values in curves.items()}
    columns = {"order": next(iter(spectra.values())).order}
    for name, spectrum in spectra.items():
        least = _ROUNDING * float(np.abs(curves[name.replace("_after", "_before")]).max())
        columns[name] = np.where(np.abs(spectrum.amplitude) > least, spectrum.amplitude, 0.0)
    units = {name: "N" if name.startswith("force") else "N*m" for name in curves} | {"order": "-"}
    picture = svg(balance_orders(one))
    return [
        write_text(folder / "report.html", page("balance.html", numbers=balanced, picture=picture, about=about)),
        write_quantities(folder / "mounts.csv", columns, units),
        write_text(folder / "orders.svg", picture),
    ]
