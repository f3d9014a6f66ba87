"""The outputs of generated functions, each with a proven bound of its rounding and the largest error that was seen."""

import dataclasses
import heapq
import itertools
import math
import sys
from collections.abc import Callable, Mapping, Sequence
from typing import TypeAlias

import casadi as ca
import numpy as np

from mechsym import budget
from mechsym.errors import BadInput
from mechsym.hinge.kernel import DesignKernel
from mechsym.mechanisms.record import generated, listing
from mechsym.native import compiled
from mechsym.native.source import prepared
from mechsym.native.tape import Tape
from mechsym.proof.balls import Ball, arb, evaluate, outward
from mechsym.proof.rounding import VALUES, Rounded, bounds
from mechsym.proof.sampled import ALL, Exact, errors, exact_function, farthest, points_in
from mechsym.quantities import record
from mechsym.quantities.results import part, quantity, result

Box: TypeAlias = tuple[tuple[float, float], ...]
_PIECES = (64, 16)  # of a turn: where one angle turns, and where several do
_DEEPEST = 12  # how often a piece is halved before it is told as singular
_SEED = 20260
_NEAR = 9.5  # bound by the largest error seen, above which a box is halved
_ENOUGH = 1000  # samples, from which the largest error seen is near the largest that there is
_MOST = 1024  # parts of a box that are tried for a nearer bound
_PER_SAMPLE, _PER_FAR_SAMPLE = 1e-4, 2e-5  # of each function, in 60 digits and in extended precision [s]


@record
class Subject:
    """A function whose rounding is bounded, over boxes of its inputs."""

    name: str
    function: ca.Function
    exact: Exact | None = None  #: The same for balls, from another text than the tape; None takes the tape
    boxes: tuple[Box, ...]
    along: tuple[int, ...] = ()  #: Inputs along which a box is halved and which say where it is; none takes the widest
    places: tuple[str, ...] = ()  #: Of the boxes, where no input says it
    outputs: tuple[str, ...] = ()  #: Their names, where the function has others
    units: Mapping[str, str] = dataclasses.field(default_factory=dict)  #: Of outputs by name


@result
class ProvenOutput:
    """An output of machine code and how far it can be from its exact value."""

    name: str = part()
    unit: str = part()
    absolute: float | None = quantity("@unit")  #: Proven bound; None where no place has one
    relative: float | None = quantity("-")  #: The same by the largest value of the output
    where: str = part()  #: Where it is largest
    seen: float = quantity("@unit")  #: Largest error of the samples
    factor: float | None = quantity("-")  #: Bound by the largest error seen; None where none was seen
    singular: tuple[str, ...] = part()  #: Places without a bound


@result
class ProvenRounding:
    """The rounding of the generated functions of a mechanism."""

    subject: str = part()
    outputs: tuple[ProvenOutput, ...] = part()
    samples: int = quantity("-")  #: Random points of each function, half of their values at the ends of the ranges
    holds: bool = part()  #: Whether no sample is beyond its bound
    statement: str = part()
    trusted: tuple[str, ...] = part()


TRUSTED = (
    "the compiler: IEEE doubles, one rounding an operation, as -ffp-contract=off asks",
    "python-flint's balls",
    "the tape is the text: the samples come from the compiled text and are held against the plain generated function",
    "the stated bounds of elementary functions: sine and cosine 2 units in the last place, tan and asin 3, exp, log "
    "and powers 1.5; tests hold them against 60 digits",
)


def of_mechanism(name: str, ranges: Mapping[str, tuple[float, float]]) -> tuple[Subject, ...]:
    """The plain generated functions of a mechanism over ranges of all their letters [SI]; angles are cut in pieces."""
    module, angles = generated(name), [q for q, unit in listing(name)["coordinates"].items() if unit == "rad"]
    subjects = []
    for function, (letters, outputs) in module.FUNCTIONS.items():
        symbols = [ca.SX.sym(letter) for letter in letters]
        values = [ca.SX(v) for v in getattr(module, function)(*symbols)]
        options = {"allow_duplicate_io_names": True}
        built = ca.Function(f"{name}_{function}", symbols, values, list(letters), list(outputs), options)
        turning = tuple(i for i, letter in enumerate(letters) if letter in angles)
        pieces = _PIECES[0] if len(turning) == 1 else _PIECES[1]
        axes = [[ranges[letter]] for letter in letters]
        for i in turning:
            axes[i] = [*itertools.pairwise(np.linspace(*ranges[letters[i]], pieces + 1).tolist())]
        subjects.append(
            Subject(
                name=function, function=built, exact=exact_function(module, function), units=units_of(name),
                boxes=tuple(itertools.product(*axes)), along=turning,
            )
        )  # fmt: skip
    return tuple(subjects)


def units_of(name: str) -> dict[str, str]:
    """Units of the outputs of a mechanism's functions; of a constraint's none is told."""
    known, along = listing(name), {"rad": "N*m", "m": "N"}
    units = dict.fromkeys(("kinetic_energy", "potential_energy"), "J") | {"angular_momentum_rate": "N*m"}
    units |= dict.fromkeys(("momentum_rate_x", "momentum_rate_y"), "N")
    for a, unit in known["coordinates"].items():
        units |= {f"bias_{a}": along[unit], f"force_{a}": along[unit]}
        for b, other in known["coordinates"].items():
            units[f"mass_{a}_{b}"] = ("kg", "kg*m", "kg*m^2")[(unit, other).count("rad")]
    return units | known["outputs"]


def of_guides(kernel: DesignKernel, share: float) -> tuple[Subject, ...]:
    """The limits of guides: shares around the turn, and the margins, with all numbers +- a share [-]."""
    around, ends = kernel.functions
    lanes: Box = tuple(widened(v, share) for v in kernel.lanes.values())
    shares = compiled(around, "strict").batch(*kernel.stages.T, *kernel.lanes.values())
    peaks = tuple(widened(float(row.max()), share) for row in shares)
    return (
        Subject(
            name="around_the_turn", function=around,
            boxes=tuple((*zip(stage, stage, strict=True), *lanes) for stage in kernel.stages.tolist()),
            places=tuple(f"angle of the guide = {angle:.4g}" for angle in kernel.angles),
            outputs=kernel.around,
        ),
        Subject(
            name="margins", function=ends, boxes=((*lanes, *peaks),), places=("the whole turn",),
            outputs=(*kernel.limits, "cut"),
        ),
    )  # fmt: skip


def widened(value: float, share: float) -> tuple[float, float]:
    """A range with a share of a value [SI] to both sides."""
    return value - share * abs(value), value + share * abs(value)


def prove(
    subject: Subject, samples: int, code: Callable[..., np.ndarray] | None = None,
    progress: Callable[[int], object] = lambda _: None,
) -> tuple[ProvenOutput, ...]:  # fmt: skip
    """Bounds of all outputs of a function, beside the largest error of its machine code at random points.

    code: what is held against the bound, in place of the strict build of the function.
    """
    tape = prepared(subject.function, "strict")
    exact = subject.exact or (lambda *values: evaluate(tape, VALUES | _MORE, values))
    code = code or compiled(subject.function, "strict").batch
    points = farthest(code, tape, points_in(subject.boxes, samples, _SEED))
    progress(samples - points.shape[1])
    off, sizes = errors(code, exact, points, progress)
    most = sys.float_info.max
    goals = [min(_NEAR * row.max(), most) or most if samples >= _ENOUGH else most for row in off]
    rows = [_bounded(tape, box, subject.along, goals) for box in subject.boxes]

    def place(k: int, box: Box) -> str:
        ends = (f"{tape.inputs[j]} = {box[j][0]:.4g}..{box[j][1]:.4g}" for j in subject.along)
        return subject.places[k] if subject.places else ", ".join(ends)

    proven = []
    for i, name in enumerate(subject.outputs or tape.outputs):
        parts = [(place(k, box), box, value) for k, row in enumerate(rows) for box, value in row[i]]
        finite = [(value.error, where) for where, _, value in parts if math.isfinite(value.error)]
        absolute, where = max(finite, key=lambda row: row[0], default=(None, ""))
        singular = [(where, box) for where, box, value in parts if not math.isfinite(value.error)]
        inside = np.all([~_within(points, box) for _, box in singular] or [np.full(points.shape[1], True)], axis=0)
        seen = float(off[i][inside].max(initial=0.0))
        least = (float(value.ball.abs_lower()) for *_, value in parts if value.ball.is_finite())
        size = max((float(sizes[i][inside].max(initial=0.0)), *least))
        proven.append(
            ProvenOutput(
                name=f"{subject.name}.{name}",
                unit=subject.units.get(name, ""),
                absolute=absolute,
                relative=None if absolute is None else absolute / size if size else 0.0,
                where=where if absolute else "",
                seen=seen,
                factor=absolute / seen if absolute is not None and seen else None,
                singular=tuple(dict.fromkeys(where for where, _ in singular)),
            )
        )
    return tuple(proven)


_MORE: dict[str, Callable[..., Ball]] = {
    "lt": lambda a, b: arb(int(a < b)), "le": lambda a, b: arb(int(a <= b)), "not": lambda a: arb(int(a.is_zero())),
    "eq": lambda a, b: arb(int(a == b)), "ne": lambda a, b: arb(int(a != b)), "sign": lambda a: a.sgn(),
    "and": lambda a, b: arb(int(a != 0 and b != 0)), "or": lambda a, b: arb(int(a != 0 or b != 0)),
    "if_else_zero": lambda c, a: a if c != 0 else arb(0),
}  # fmt: skip


def _bounded(tape: Tape, box: Box, along: Sequence[int], goals: Sequence[float]) -> list[list[tuple[Box, Rounded]]]:
    """For each output the parts of a box with what holds there; the part farthest above its goal is halved first."""
    parts: list[list[tuple[Box, Rounded]]] = [[] for _ in goals]
    waiting: list[tuple[float, int, int, Box, Callable[[], int], list[Rounded], list[int]]] = []
    count = itertools.count()

    def enter(part: Box, outputs: Sequence[int], depth: int) -> None:
        values, widest = bounds(tape, part, along, outputs)
        above = [i for i in outputs if values[i].error > goals[i]]
        for i in set(outputs) - set(above):
            parts[i].append((part, values[i]))
        if above:
            worst = max(values[i].error / goals[i] for i in above)
            heapq.heappush(waiting, (-worst, next(count), depth, part, widest, values, above))

    enter(box, range(len(goals)), 0)
    while waiting:
        worst, number, depth, part, widest, values, above = heapq.heappop(waiting)
        if depth == _DEEPEST or (number >= _MOST and math.isfinite(worst)):
            for i in above:
                parts[i].append((part, values[i]))
            continue
        k = widest()
        low, high = part[k]
        for half in itertools.pairwise((low, (low + high) / 2, high)):
            enter((*part[:k], half, *part[k + 1 :]), above, depth + 1)
    return parts


def _within(points: np.ndarray, box: Box) -> np.ndarray:
    low, high = np.array(box).T[:, :, None]
    return np.all((low <= points) & (points <= high), axis=0)


def rounding(
    name: str, subjects: Sequence[Subject], samples: int, words: str,
    progress: Callable[[int], object] = lambda _: None,
) -> ProvenRounding:  # fmt: skip
    """All outputs of some functions. words: over which ranges. Raises BadInput: no samples."""
    if samples < 1:
        raise BadInput(f"--samples {samples}: a bound is held against at least 1 point")
    seconds = len(subjects) * (min(samples, ALL) * _PER_SAMPLE + samples * _PER_FAR_SAMPLE)
    budget.require(f"{samples} samples", seconds, 1e3 * samples, "give fewer --samples")
    outputs = tuple(row for s in subjects for row in prove(s, samples, progress=progress))
    holds = all(row.absolute is None or row.seen <= row.absolute for row in outputs)
    largest = max((row.relative for row in outputs if row.relative is not None), default=0.0)
    statement = (
        f"what the strict build of {name} returns in doubles is within its bound of the exact value, at most "
        f"{outward(largest, 2)} of the largest value of an output, for {words}"
        if holds
        else f"the code of {name} is not what was proven: a sample is beyond its bound"
    )
    return ProvenRounding(
        subject=name, outputs=outputs, samples=samples, holds=holds, statement=statement, trusted=TRUSTED
    )
