"""Hinges at many points: guides that differ in numbers only are judged side by side, see `hinge.side_by_side`.

Which guides can be built at all is asked of thousands at once, see `hinge.kernel`; `judge` decides again what is near
to a limit, and gives the numbers of the best guide of a call.
"""

import dataclasses
import math
from collections.abc import Callable, Collection, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from mechsym import cases
from mechsym.cases import Case
from mechsym.cases.values import Place
from mechsym.errors import BadInput, suggest
from mechsym.files import Json
from mechsym.quantities import parse, record
from mechsym.quantities.results import Columns, names_of, some
from mechsym.sweep.axes import Value
from mechsym.sweep.outcomes import ARITHMETIC, Gap, Outcome, Outcomes, guarded, known

if TYPE_CHECKING:
    from mechsym.hinge.balance import Balance
    from mechsym.hinge.side_by_side import GuideDesign
    from mechsym.hinge.torque import Hinge
    from mechsym.machine.record import Machine

BLOCK = 64  # points in one call: enough to hide what is done once, few enough for the progress to move


@record
class _Wanted:
    """A torque, and what shall give it."""

    machine: "Machine"
    hinge: "Hinge"
    balance: "Balance"
    design: "GuideDesign"


def check_keys(show: Collection[str]) -> None:
    """Refuse names that are no result of a hinge."""
    from mechsym.hinge.summary import HingeNumbers

    keys = names_of(HingeNumbers)
    for name in show:
        if name != "all" and name.partition(".")[0] not in keys:
            raise BadInput(f"--show {name} is no result here; {suggest(name, [*keys, 'all'])}")


def runs(show: Collection[str]) -> bool:
    """Whether results that are shown ask how the hinge runs."""
    from mechsym.hinge.summary import QUICK

    return not {name.partition(".")[0] for name in show} <= set(QUICK)


def designed(show: Collection[str]) -> Callable[[Case], Columns]:
    """Designs with what is shown; how they run is computed only where a name asks for it."""

    def one(case: Case) -> Columns:
        from mechsym.hinge.summary import HingeNumbers
        from mechsym.jobs.hinge import hinge

        names = names_of(HingeNumbers) if "all" in show else {name.partition(".")[0] for name in show}
        return some(HingeNumbers(judged=hinge(case)), names)

    return one


def judged(points: Sequence[Case], show: Collection[str]) -> list[Outcome]:
    """Guides and verdicts; what they run like is not asked.

    show: results that are wanted; none for those of `hinge.summary.QUICK`. Returns outcomes: keys of the command
    `hinge`, in the same order.
    """
    from mechsym.hinge.result import JudgedHinge
    from mechsym.hinge.summary import QUICK, HingeNumbers

    only = {name.partition(".")[0] for name in show} or QUICK
    outcomes: dict[int, Outcome] = {}
    groups: dict[Balance, list[tuple[int, _Wanted]]] = {}
    for i, case in enumerate(points):
        wanted = guarded(_wanted, case)
        if isinstance(wanted, Gap):
            outcomes[i] = wanted
        else:
            groups.setdefault(wanted.balance, []).append((i, wanted))
    for balance, members in groups.items():
        verdict = _verdicts(balance, [w.design for _, w in members])
        for (i, w), one in zip(members, verdict, strict=True):
            outcomes[i] = one
            if not isinstance(one, Gap):
                hinge = JudgedHinge(machine=w.machine, hinge=w.hinge, verdict=one)
                outcomes[i] = guarded(lambda judged: some(HingeNumbers(judged=judged), only), hinge)
    return [outcomes[i] for i in range(len(points))]


def _wanted(case: Case) -> _Wanted:
    from mechsym.hinge.balance import balance
    from mechsym.hinge.side_by_side import GuideDesign
    from mechsym.hinge.torque import torque
    from mechsym.jobs.machine import machine

    spring, choices, rollers, limits = (case.need(name) for name in ("spring", "guide", "rollers", "limits"))
    engine = machine(case)
    hinge = torque(engine)
    design = GuideDesign(spring=spring, choices=choices, rollers=rollers, limits=limits)
    return _Wanted(machine=engine, hinge=hinge, balance=balance(hinge, choices.balance), design=design)


def _verdicts(balance: "Balance", designs: "Sequence[GuideDesign]") -> list[Outcome]:
    """Verdicts, or gaps; what has no guide, or upsets the others, is judged by itself."""
    from mechsym.hinge.guide import cut
    from mechsym.hinge.limits import judge
    from mechsym.hinge.side_by_side import verdicts

    try:
        checks = verdicts(balance, designs)
    except ARITHMETIC:
        checks = [None] * len(designs)
    return [
        guarded(lambda d: judge(cut(balance, d.spring, d.choices), d.rollers, d.limits), d) if one is None else one
        for one, d in zip(checks, designs, strict=True)
    ]


MANY = 10_000  # guides in one call: enough to hide the making of the kernel, few enough for the progress to move
_OF_A_GUIDE = ("spring", "guide", "rollers", "limits")
_KERNEL = 1e-3  # margins of the kernel differ from those of `judge` by less; nearer to a limit than this is not decided


def guides(case: str, overrides: Mapping[str, object], heres: Sequence[Mapping[str, Value]]) -> Outcomes:
    """Margins of the guide at each point, by limit.

    case: name of a built-in case or path of a file; overrides: values that hold at all points; heres: sequence of
    mapping, values of the axes at each point, as `--set` takes them. Returns outcomes: `feasible`, `margin` (the
    smallest), `judged` (1 for numbers of `judge`, 0 within 1e-4 of them), and `margins.limit` of each [-].
    """
    places = {key: cases.locate(case, key, overrides) for key in heres[0]}
    numbers = {
        key: place
        for key, place in places.items()
        if place.section in _OF_A_GUIDE and place.unit is not None and place.field != "shaft_ratio"
    }
    groups: dict[tuple[tuple[str, Value], ...], list[int]] = {}
    for i, here in enumerate(heres):
        groups.setdefault(tuple((k, v) for k, v in here.items() if k not in numbers), []).append(i)
    outcomes = Outcomes(len(heres))
    for rest, members in groups.items():
        at = {**overrides, **dict(rest)}
        free = [{key: heres[i][key] for key in numbers} for i in members]
        try:
            outcomes.merge(members, _margins(cases.load(case, at), numbers, free))
        except (BadInput, ArithmeticError, ValueError, RuntimeError) as error:
            outcomes.put(members, [known(error)] * len(members))
    return outcomes


def _margins(case: Case, places: Mapping[str, Place], heres: Sequence[Mapping[str, Value]]) -> Outcomes:
    from mechsym.hinge.balance import balance
    from mechsym.hinge.kernel import design_kernel
    from mechsym.hinge.torque import torque
    from mechsym.jobs.machine import machine

    given = {name: case.need(name) for name in _OF_A_GUIDE}
    wanted = balance(torque(machine(case)), given["guide"].balance)
    # a map over speeds alone has one design at each of them
    names = [f"{p.section}.{p.field}" for p in places.values()] or ["limits.closing_share"]
    columns = [_column(case, given, key, place, [here[key] for here in heres]) for key, place in places.items()]
    columns = columns or [[given["limits"].closing_share] * len(heres)]
    gaps: dict[int, Gap] = {}
    for column in reversed(columns):  # the first value that is impossible gives the reason
        gaps |= {i: value for i, value in enumerate(column) if isinstance(value, Gap)}
    good = [i for i in range(len(heres)) if i not in gaps] if gaps else range(len(heres))
    values = np.array([[column[i] for i in good] for column in columns]).reshape(len(names), len(good)).T
    spring, choices, rollers, limits = given.values()
    kernel = design_kernel(wanted, spring, choices, rollers, limits, names)
    margins = kernel.margins(values)
    least = margins.min(axis=1, initial=np.inf)
    again = np.flatnonzero((np.abs(least) < _KERNEL) | (least == least.max(initial=-1.0)))
    outcomes = Outcomes(len(heres))
    outcomes.put(list(gaps), list(gaps.values()))
    outcomes.merge(good, _told(margins, least, kernel.limits))
    nearer = [_one(wanted, _design(given, names, values[k].tolist()), kernel.limits) for k in again.tolist()]
    outcomes.put([good[k] for k in again.tolist()], nearer)
    return outcomes


def _column(case: Case, given: Json, key: str, place: Place, texts: Sequence[Value]) -> list[float | Gap]:
    """Values of an axis at each point [SI], each checked once, or the gap that an impossible one leaves."""

    def value(text: Value) -> float | Gap:
        try:
            number = parse(f"{text} {place.written}" if place.written else text, place.unit or "-", key)
            # the records of these sections check each value by itself
            return getattr(dataclasses.replace(given[place.section], **{place.field: number}), place.field)
        except BadInput as error:
            return known(BadInput(f"{case.file}: {error}"))

    values = {text: value(text) for text in dict.fromkeys(texts)}
    return [values[text] for text in texts]


def _design(given: Json, names: Sequence[str], values: Sequence[float]) -> Json:
    """Records of a point by section."""
    changed: dict[str, dict[str, float]] = {name: {} for name in given}
    for name, value in zip(names, values, strict=True):
        section, _, field = name.partition(".")
        changed[section][field] = value
    return {name: dataclasses.replace(given_value, **changed[name]) for name, given_value in given.items()}


def _one(wanted: "Balance", design: Json, limits: Sequence[str]) -> Outcome:
    from mechsym.hinge.guide import cut
    from mechsym.hinge.limits import judge

    verdict = judge(cut(wanted, design["spring"], design["guide"]), design["rollers"], design["limits"])
    margins = {c.name: math.nan if c.margin is None else c.margin for c in verdict.checks}
    known = {"feasible": float(verdict.feasible), "margin": verdict.margin, "judged": 1.0}
    known |= {f"margins.{name}": margins[name] for name in limits if name in margins}
    return {f"{name} [-]": value for name, value in known.items()}


def _told(margins: np.ndarray, least: np.ndarray, limits: Sequence[str]) -> Outcomes:
    """What the kernel says, a limit that asks nothing as not a number; -1 throughout where there is no guide."""
    names = [f"{name} [-]" for name in ("feasible", "margin", "judged", *(f"margins.{name}" for name in limits))]
    finite = np.where(np.isfinite(margins), margins, math.nan)
    return Outcomes.table(names, np.column_stack([least >= 0, least, np.zeros_like(least), finite]))
