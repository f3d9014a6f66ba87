"""Co-designs that several tests share; made once."""

import dataclasses
from functools import cache

from mechsym import cases
from mechsym.codesign import front as fronts
from mechsym.codesign.front import cut_for_one
from mechsym.codesign.programme import programme, solve
from mechsym.codesign.rank import rank
from mechsym.codesign.verify import verify
from mechsym.jobs.codesign import task_of


@cache
def task(**changes):
    """The built-in family: 60 to 142 rpm on the propeller curve, 2 %, one spring."""
    case = cases.load("zotov-89")
    made = task_of(case, case.need("codesign"))
    hardware = {k: changes.pop(k) for k in ("moving_mass",) if k in changes}
    made = dataclasses.replace(made, hardware=dataclasses.replace(made.hardware, **hardware))
    if "at" in changes:
        made = dataclasses.replace(made, points=tuple(made.points[k] for k in changes.pop("at")))
    return dataclasses.replace(made, **changes)


@cache
def ready(**changes):
    return programme(task(**changes))


@cache
def design(ripple=0.02, **changes):
    return solve(task(ripple=ripple, **changes), ready(**changes))


@cache
def verified(ripple=0.02, **changes):
    return verify(design(ripple, **changes))


@cache
def bound():
    return rank(task().points)


@cache
def cut():
    return cut_for_one(task(), 2)


@cache
def front():
    return fronts(task(), (0.02, 0.05, 0.12), ready())
