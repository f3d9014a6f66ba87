"""Hinges at many points: guides that differ in numbers only are judged side by side, see `hinge.side_by_side`."""

from collections.abc import Callable, Collection, Sequence
from typing import TYPE_CHECKING

from mechsym.cases import Case
from mechsym.errors import BadInput, suggest
from mechsym.quantities import record
from mechsym.quantities.results import Columns, names_of, some
from mechsym.sweep.outcomes import ARITHMETIC, Gap, Outcome, guarded

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


def judged(found: Sequence[Case], show: Collection[str]) -> list[Outcome]:
    """Guides and verdicts; what they run like is not asked.

    show: results that are wanted; none for those of `hinge.summary.QUICK`. Returns outcomes: keys of the command
    `hinge`, in the same order.
    """
    from mechsym.hinge.result import JudgedHinge
    from mechsym.hinge.summary import QUICK, HingeNumbers

    only = {name.partition(".")[0] for name in show} or QUICK
    outcomes: dict[int, Outcome] = {}
    groups: dict[Balance, list[tuple[int, _Wanted]]] = {}
    for i, case in enumerate(found):
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
    return [outcomes[i] for i in range(len(found))]


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
        found = verdicts(balance, designs)
    except ARITHMETIC:
        found = [None] * len(designs)
    return [
        guarded(lambda d: judge(cut(balance, d.spring, d.choices), d.rollers, d.limits), d) if one is None else one
        for one, d in zip(found, designs, strict=True)
    ]
