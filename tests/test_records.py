"""Records check themselves when they are made, and show themselves in short."""

import copy
import dataclasses
import inspect
import pickle
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


@record
class Drill(Rod):
    """A rod with a tip."""

    tip: list[float] = dataclasses.field(default_factory=list)  #: [m]
    seen: dict[str, float] = dataclasses.field(default_factory=dict, init=False, compare=False)


@dataclasses.dataclass(frozen=True, kw_only=True)
class PlainDrill:
    """The same by dataclass alone."""

    length: float
    end: str = "round"
    points: np.ndarray | None = None
    tip: list[float] = dataclasses.field(default_factory=list)
    seen: dict[str, float] = dataclasses.field(default_factory=dict, init=False, compare=False)


def test_a_record_is_made_compared_and_copied_as_a_frozen_dataclass_is():
    one, plain = Drill(length=1.0, tip=[0.1]), PlainDrill(length=1.0, tip=[0.1])
    assert vars(one) == vars(plain) and dataclasses.asdict(one) == dataclasses.asdict(plain)
    one.seen["here"] = 1.0
    for same in (copy.copy(one), copy.deepcopy(one), pickle.loads(pickle.dumps(one)), dataclasses.replace(one)):
        assert same == one and same is not one
    other = dataclasses.replace(one, end="flat")
    assert other != one and other.tip is one.tip and other.seen == {} and one != plain and one != Rod(length=1.0)
    assert hash(Rod(length=2.0)) == hash(Rod(length=2.0)) != hash(Rod(length=3.0))
    with pytest.raises(TypeError, match="unhashable"):
        hash(one)
    with pytest.raises(FrozenInstanceError, match="'tip'"):
        del one.tip
    assert Drill(length=1.0).tip is not Drill(length=1.0).tip


def test_a_record_names_the_argument_that_is_missing_or_too_many():
    with pytest.raises(TypeError, match="Drill.*'length'"):
        Drill(end="flat")
    with pytest.raises(TypeError, match="unexpected keyword argument 'lenght'"):
        Rod(length=1.0, lenght=2.0)
    with pytest.raises(TypeError, match="unexpected keyword argument 'seen'"):
        Drill(length=1.0, seen={})
    with pytest.raises(ValueError, match="init=False"):
        dataclasses.replace(Drill(length=1.0), seen={})


def test_help_tells_the_fields_of_a_record():
    assert list(inspect.signature(Drill).parameters) == ["length", "end", "points", "tip"]
    assert str(inspect.signature(Rod)) == "(*, length: float, end: str = 'round', points: numpy.ndarray | None = None)"


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
