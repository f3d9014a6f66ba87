"""What comes out at a point of a sweep: results by name, or a gap with a reason."""

import json
import math
import operator
import tempfile
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from mechsym.cases import Case
from mechsym.cases.owned import letter_of
from mechsym.errors import BadInput
from mechsym.files import Json
from mechsym.mechanisms.shaft import ElasticShaft
from mechsym.quantities import record, results
from mechsym.quantities.results import Columns, names_of, part, some, units_of, walk
from mechsym.simulate import Result
from mechsym.simulate.result import RunNumbers
from mechsym.torsion.twist import ShaftSection, sections

if TYPE_CHECKING:
    from mechsym.forces.driven import DrivenNumbers
    from mechsym.forces.summary import ForceNumbers

_IN_MEMORY = 100_000  # numbers of a column

# results that are words worth keeping
WORDS = ("status", "end", "guide.reason")
# the clock tells nothing of the machine, and an event is told by its parts
_NO_RESULT = ("wall_s", "event")
# what impossible values run into where no record refuses them; anything else is a mistake of the program
ARITHMETIC = (ArithmeticError, ValueError, RuntimeError)


@record
class Gap:
    """Why there is no result at a point."""

    reason: str
    of_input: bool = False  #: Whether the case was refused, not its run


UNREACHED = Gap(reason="not reached")

Outcome = Any  # a result, numbers by dotted names, or a Gap


class Outcomes(Sequence[Any]):
    """What came out at each point: a column for each name, the names that each point has, gaps."""

    def __init__(self, count: int, gap: Gap = UNREACHED) -> None:
        self._unreached = gap
        self._kind = np.full(count, -1, dtype=np.int32)  # which names a point has; -1 of a gap
        self._names: list[tuple[str, ...]] = []
        self._columns: dict[str, np.ndarray] = {}
        self._gaps: dict[int, Gap] = {}

    @classmethod
    def of(cls, outcomes: Sequence[Outcome]) -> "Outcomes":
        """Outcomes of all points, as they are."""
        whole = cls(len(outcomes))
        whole.put(range(len(outcomes)), outcomes)
        return whole

    @classmethod
    def table(cls, names: Sequence[str], values: np.ndarray) -> "Outcomes":
        """Outcomes of points that have the same names. values: shape (n, k) for n points and k names [by name]."""
        whole = cls(len(values))
        whole._enter(tuple(names), np.arange(len(values)), list(values.T))
        return whole

    def put(self, members: Sequence[int], outcomes: Sequence[Outcome]) -> None:
        """Outcomes of points by their numbers, in place of what stood there."""
        by_names: dict[tuple[str, ...], tuple[list[int], list[Sequence[object]]]] = {}
        for i, outcome in zip(members, outcomes, strict=True):
            if isinstance(outcome, Gap):
                self._gaps[i] = outcome
                self._leave([i])
            else:
                places, rows = by_names.setdefault(tuple(outcome), ([], []))
                places.append(i)
                rows.append(tuple(outcome.values()))
        for names, (places, rows) in by_names.items():
            self._enter(names, np.array(places), list(zip(*rows, strict=True)))

    def merge(self, members: Sequence[int], other: "Outcomes") -> None:
        """As `put`, of outcomes that are a table already."""
        places = np.asarray(members)
        for number, names in enumerate(other._names):
            there = other._kind == number
            self._enter(names, places[there], [other._columns[name][there] for name in names])
        self._leave(places[other._kind < 0])
        self._gaps |= {int(places[i]): gap for i, gap in other.gaps.items()}

    def _enter(self, names: tuple[str, ...], places: np.ndarray, columns: Sequence[Any]) -> None:
        if names not in self._names:
            self._names.append(names)
        self._kind[places] = self._names.index(names)
        for name, values in zip(names, columns, strict=True):
            if name not in self._columns:
                self._columns[name] = _column(len(self), name)
            self._columns[name][places] = values
        self._clear(places, names)

    def _leave(self, places: Sequence[int] | np.ndarray) -> None:
        """Points become gaps."""
        self._kind[places] = -1
        self._clear(places, ())

    def _clear(self, places: Sequence[int] | np.ndarray, names: tuple[str, ...]) -> None:
        """Columns have nothing where a point does not have their name."""
        for name, column in self._columns.items():
            if name not in names:
                column[places] = "" if name in WORDS else math.nan

    def shown(self, show: Sequence[str]) -> "Outcomes":
        """The results that are shown; all where none is named.

        show: names, groups (`guide` for `guide.z_max` and its like), or `all`.
        """
        if not show or "all" in show:
            return self
        few = Outcomes(len(self), self._unreached)
        few._kind, few._gaps = self._kind, self._gaps
        few._names = [tuple(name for name in names if any(asked(name, s) for s in show)) for names in self._names]
        few._columns = {name: self._columns[name] for names in few._names for name in names}
        return few

    def packed(self) -> tuple[str, bytes]:
        """Names, words and gaps as JSON, and the numbers as they are, each column as long as there are points."""
        numbers = [name for name in self._columns if name not in WORDS]
        told = {
            "names": self._names,
            "numbers": numbers,
            "words": {name: self._columns[name].tolist() for name in self._columns if name in WORDS},
            "gaps": {i: [gap.reason, gap.of_input] for i, gap in self.gaps.items()},
        }
        parts = [self._kind.astype("<i4"), *(self._columns[name].astype("<f8") for name in numbers)]
        return json.dumps(told), b"".join(part.tobytes() for part in parts)

    @classmethod
    def unpacked(cls, count: int, text: str, numbers: bytes) -> "Outcomes":
        """What `packed` has packed of `count` points."""
        told, whole = json.loads(text), cls(count)
        whole._kind = np.frombuffer(numbers, "<i4", count)
        whole._names = [tuple(names) for names in told["names"]]
        columns = np.frombuffer(numbers, "<f8", offset=4 * count).reshape(-1, count)
        whole._columns = dict(zip(told["numbers"], columns, strict=True))
        whole._columns |= {name: np.array(words, dtype=object) for name, words in told["words"].items()}
        whole._gaps = {int(i): Gap(reason=reason, of_input=bad) for i, (reason, bad) in told["gaps"].items()}
        return whole

    def __len__(self) -> int:
        return len(self._kind)

    def __getitem__(self, i: Any) -> Any:
        if isinstance(i, slice):
            return [self[k] for k in range(*i.indices(len(self)))]
        number = int(self._kind[i])
        if number < 0:
            return self._gaps.get(range(len(self))[i], self._unreached)
        return {name: self._columns[name].item(i) for name in self._names[number]}

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Outcomes) and len(self) == len(other) and all(map(operator.eq, self, other))

    __hash__ = None  # type: ignore[assignment]

    @property
    def gaps(self) -> dict[int, Gap]:
        """The points without a result, in their order."""
        return {i: self._gaps.get(i, self._unreached) for i in np.flatnonzero(self._kind < 0).tolist()}

    @property
    def names(self) -> list[str]:
        """Names of all results, as the points tell them one after the other."""
        order = sorted(range(len(self._names)), key=lambda number: int(np.argmax(self._kind == number)))
        return list(dict.fromkeys(name for number in order for name in self._names[number]))

    def column(self, name: str) -> np.ndarray:
        """A result at all points: not a number, or an empty word, where there is none [unit of the result].

        name: without its unit.
        """
        named = [full for full in self._columns if full.partition(" [")[0] == name]
        if len(named) == 1 and name not in WORDS:
            return self._columns[named[0]]
        values = np.full(len(self), "" if name in WORDS else math.nan, dtype=object if name in WORDS else float)
        for full in named:  # of two units, in which a name may be told at different points
            there = np.isin(self._kind, [number for number, names in enumerate(self._names) if full in names])
            values[there] = self._columns[full][there]
        return values.astype(str) if name in WORDS else values


def _column(count: int, name: str) -> np.ndarray:
    """A column without results; many numbers lie in a file that is nowhere to be seen, not in memory."""
    if name in WORDS or count <= _IN_MEMORY:
        return np.full(count, *(("", object) if name in WORDS else (math.nan, float)))
    with tempfile.TemporaryFile() as file:
        column = np.memmap(file, dtype=float, mode="w+", shape=(count,))
    column[:] = math.nan
    return column


def known(error: Exception) -> Gap:
    """The gap that an error leaves. error: bad input, or an error of arithmetic that only this point met."""
    words = " ".join(str(error).split())
    if isinstance(error, BadInput):
        return Gap(reason=words, of_input=True)
    return Gap(reason=f"{type(error).__name__}: {words}")


def guarded(one: Callable[[Any], Any], case: object) -> Any:
    """What a function of the case, or of what stands for it, gives, or the gap that its error leaves."""
    try:
        return one(case)
    except ARITHMETIC as error:
        return known(error)


def flat(result: object) -> dict[str, float | str]:
    """The numbers of a result by dotted names, `speed_mean [rad/s]` where it knows its units.

    Returns numbers: None becomes not a number; longer lists and most words are left out.
    """
    values: dict[str, float | str] = {}
    for path, value, unit in walk(result):
        name = f"{path} [{unit}]" if unit else path
        if isinstance(value, str):
            values |= {path: value} if path in WORDS else {}
        elif path.rpartition(".")[2] in _NO_RESULT:
            continue
        elif value is None:
            values[name] = math.nan
        elif (numbers := np.asarray(value)).size == 1 and numbers.dtype.kind in "bif":
            values[name] = float(numbers.ravel()[0])
    return values


def asked(name: str, show: str) -> bool:
    """Whether a name or group that is shown means a result, whose name may carry its unit."""
    name = name.partition(" [")[0]
    return name == letter_of(show, {name}) or name.startswith(f"{show}.")


def forces(case: Case) -> "ForceNumbers | DrivenNumbers":
    """Figures of `mechsym forces`, over a turn or of a motion."""
    from mechsym.forces.driven import numbers
    from mechsym.forces.summary import summary
    from mechsym.jobs.forces import forces as run
    from mechsym.jobs.forces import motion

    if "motion" in case.sections:
        return numbers(motion(case), case.name)
    return summary(run(case), case.name, case.source)


def size(case: Case) -> Json:
    """Rows of `mechsym size` as component.quantity with its unit, and .limit and .safety_factor of a check."""
    from mechsym.jobs.size import size as sized

    sizing = sized(case)
    numbers: dict[str, object] = {"failing [-]": len(sizing.failing), "converged [-]": sizing.converged}
    for row in sizing.rows:
        name = f"{row['component']}.{row['quantity']}".replace(" ", "_")
        # one quantity may be held against several rules
        unit = f" [{row['unit'] or '-'}]"
        name = name if name + unit not in numbers else f"{name}.{row['rule']}".replace(" ", "_")
        numbers[name + unit] = row["value"]
        if row["limit"] is not None:
            numbers |= {f"{name}.limit{unit}": row["limit"], f"{name}.safety_factor [-]": row["safety_factor"]}
    return numbers


def codesign(case: Case) -> Columns:
    """Figures of `mechsym codesign`; of a list over speeds and loads the smallest and the largest value."""
    from mechsym.codesign.result import CoDesignNumbers, numbers_of
    from mechsym.jobs.codesign import codesign as design
    from mechsym.jobs.codesign import settings_of

    every = some(numbers_of(design(case, settings_of(case))), names_of(CoDesignNumbers))
    values: dict[str, object] = {}
    for name, value in every.items():
        numbers = [v for v in value if isinstance(v, float | int)] if isinstance(value, Sequence) else []
        several, unit = len(numbers) > 1 and not isinstance(value, str), every.units[name]
        ends = {"min": min(numbers), "max": max(numbers)} if several else {}
        values[name] = Columns(ends, dict.fromkeys(ends, unit)) if several else value
    return Columns(values, every.units)


_PEAKS = ("twist_peak", "torque_peak")


@results.result
class SweptRun:
    """A run at a point of a sweep."""

    numbers: RunNumbers = part(inline=True)
    peaks: Columns = part(inline=True)  #: Largest of all sections of an elastic shaft
    twist: Mapping[str, ShaftSection] = part()
    #: Ends of the outputs of a user's machine that is no engine
    outputs: Mapping[str, Columns] = part(optional=True)


def swept(shaft: ElasticShaft | None, result: Result, numbers: RunNumbers, outputs: Mapping[str, Columns]) -> SweptRun:
    """A finished run with its numbers, the twist of its shaft, and what its declaration has as outputs."""
    twists = () if shaft is None else sections(shaft, result, result.t[-1] - numbers.window)
    peaks = {name: max(getattr(section, name) for section in twists) for name in (_PEAKS if twists else ())}
    named = {section.section: section for section in twists}
    return SweptRun(numbers=numbers, peaks=Columns(peaks, units_of(ShaftSection)), twist=named, outputs=outputs)
