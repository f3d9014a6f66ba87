"""Hinges at many points: guides that differ in numbers only are judged side by side, see `hinge.side_by_side`."""

from collections.abc import Callable, Collection, Sequence
from typing import Any

from mechsym.cases import Case
from mechsym.errors import BadInput, suggest
from mechsym.quantities import record
from mechsym.sweep.outcomes import ARITHMETIC, Gap, Outcome, guarded

BLOCK = 64  # points in one call: enough to hide what is done once, few enough for the progress to move


@record
class _Wanted:
    """A torque, and what shall give it."""

    machine: Any
    hinge: Any
    balance: Any
    design: Any


def check_keys(show: Collection[str]) -> None:
    """Refuse names that are no result of a hinge."""
    from mechsym.hinge.summary import KEYS

    for name in show:
        if name != "all" and name.partition(".")[0] not in KEYS:
            raise BadInput(f"--show {name} is no result here; {suggest(name, [*KEYS, 'all'])}")


def runs(show: Collection[str]) -> bool:
    """Whether results that are shown ask how the hinge runs."""
    from mechsym.hinge.summary import QUICK

    return not {name.partition(".")[0] for name in show} <= set(QUICK)


def designed(show: Collection[str]) -> Callable[[Case], dict[str, Any]]:
    """Designs with what is shown; how they run is computed only where a name asks for it."""

    def one(case: Case) -> dict[str, Any]:
        from mechsym.hinge.springs import Coil
        from mechsym.hinge.summary import KEYS, summary
        from mechsym.jobs.hinge import hinge

        found = summary(hinge(case), KEYS if "all" in show else {name.partition(".")[0] for name in show})
        if "retune" in found:
            unit = "N" if isinstance(case.need("spring"), Coil) else "Pa"
            found["retune"] = {f"p0 [{unit}]" if key == "p0" else key: v for key, v in found["retune"].items()}
        return found

    return one


def judged(found: Sequence[Case], show: Collection[str]) -> list[Outcome]:
    """Guides and verdicts; what they run like is not asked.

    Parameters
    ----------
    show : collection of str
        Results that are wanted; none for those of `hinge.summary.QUICK`

    Returns
    -------
    outcomes : list of dict or Gap
        Keys of the command `hinge`, in the same order
    """
    from mechsym.hinge.result import JudgedHinge
    from mechsym.hinge.summary import QUICK, summary

    only = {name.partition(".")[0] for name in show} or QUICK
    outcomes: dict[int, Outcome] = {}
    groups: dict[Any, list[tuple[int, _Wanted]]] = {}
    for i, case in enumerate(found):
        wanted = guarded(_wanted, case)
        if isinstance(wanted, Gap):
            outcomes[i] = wanted
        else:
            groups.setdefault(wanted.balance, []).append((i, wanted))
    for balance, members in groups.items():
        verdict = _verdicts(balance, [w.design for _, w in members])
        for (i, w), one in zip(members, verdict, strict=True):
            outcomes[i] = one if isinstance(one, Gap) else guarded(
                lambda known: summary(known, only), JudgedHinge(machine=w.machine, hinge=w.hinge, verdict=one)
            )  # fmt: skip
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


def _verdicts(balance: Any, designs: Sequence[Any]) -> list[Any]:
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
