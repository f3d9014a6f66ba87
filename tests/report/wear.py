"""A card of a report that lives in the tests: how far the piston goes in an hour, and how long a ring lasts."""

import math

import numpy as np

from mechsym.cases import Case
from mechsym.jobs.cycle import piston_travels
from mechsym.page import View, cards
from mechsym.quantities.results import quantity, result, tell
from mechsym.report.part import ReportPart
from mechsym.report.parts import PartKind

_RATE = 1e-12  # of wear: a ring loses so much for each metre [-]
_RING = 0.1e-3  # until it is worn [m]


@result
class Wear:
    """Wear of the rings."""

    speed: float = quantity("m/s", card="mean piston speed", digits=3)  #: Over a turn
    life: float = quantity("s", card="life of a ring")  #: Until its coating is gone


def wear(case: Case) -> ReportPart:
    """The part of the report."""
    stroke = max(float(np.ptp(travel)) for travel in piston_travels(case).values())
    speed = 2 * stroke * case.need("operation").speed / (2 * math.pi)
    found = Wear(speed=speed, life=_RING / (_RATE * speed))
    return ReportPart(name="wear", title=ROW.title, view=View(title=ROW.title, cards=cards(found)), numbers=tell(found),
                      verdict="A ring wears.")  # fmt: skip


ROW = PartKind("Wear of rings", wear)
