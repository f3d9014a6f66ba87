"""Records check themselves when they are made, and show themselves in short."""

from dataclasses import FrozenInstanceError

import numpy as np
import pytest

from mechsym import cases, jobs
from mechsym.errors import BadInput
from mechsym.quantities import choice, quantity, record


@record
class Rod:
    """A rod."""

    length: float = quantity("m", above=0)
    end: str = choice("round", "flat", default="round")
    points: np.ndarray | None = None  #: [m]

    def __post_init__(self):
        if self.length > 10:
            raise BadInput("a rod this long bends")


def test_a_record_is_frozen_and_checked_before_its_own_rules():
    with pytest.raises(BadInput, match="length = -1 m is out of range"):
        Rod(length=-1.0)
    with pytest.raises(BadInput, match="options are round, flat"):
        Rod(length=20.0, end="bent")
    with pytest.raises(BadInput, match="bends"):
        Rod(length=20.0)
    with pytest.raises(FrozenInstanceError):
        Rod(length=1.0).length = 2.0
    with pytest.raises(TypeError):
        Rod(1.0)


def test_a_record_shows_itself_in_short():
    assert repr(Rod(length=2.0)) == "Rod(length=2.0, end='round', points=None)"
    assert repr(Rod(length=2.0, points=np.zeros((400, 3)))) == "Rod(length=2.0, end='round', points=array(400, 3))"


def test_public_results_are_short_to_look_at():
    case = cases.load("zotov-89", {"trials.turns": "4"})
    design = jobs.hinge(case)
    machine = design.machine
    shown = [case, machine, machine.gas, machine.mechanism, design, design.hinge, design.guide, design.verdict]
    shown += [design.flywheels, design.retuned, *design.trials, design.trials[0].result]
    assert max(len(repr(one)) for one in shown) < 500
