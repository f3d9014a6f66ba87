"""What a sweep runs over: ranges on a grid, or distributions that samples are drawn from.

spring.p0=3..8 MPa:11        eleven even values, both ends included; speed_rpm=80:140:10 in steps
speed_rpm=89,120,142         a list; words such as simulation.hinge=designed,none too
spring.n=1.2..1.3            with samples: evenly distributed
k1=6500+-200 N*m/rad         with samples: normally distributed, mean and standard deviation

Values that follow from others at every point of a sweep: `chamber.bore=sqrt(4*V/(pi*4*parameters.e))`. A name is a key
of the case (SI, of this point), pi, or a letter that a tie before it defines: `V=2.94e-4`.
"""

import ast
import itertools
import math
import operator
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from mechsym import cases
from mechsym.cases import Case
from mechsym.cases.values import Place
from mechsym.errors import BadInput, shown, suggest
from mechsym.files import Json
from mechsym.quantities import parse, record
from mechsym.quantities.ranges import MOST, read_range

Value = str | float  # a number in the unit of its axis, or a word


@record
class Axis:
    """A value of the case and what it takes on."""

    key: str
    place: Place
    unit: str  #: Unit of the values; empty for words
    suffix: str  #: Unit that has to follow a value for `--set`; empty when the key or SI says it
    kind: str  #: `grid` (values), `even` or `normal` (two numbers)
    #: Values of a grid; ends of an even distribution; mean and standard deviation of a normal one [unit]
    values: tuple[Value, ...]


def split(text: str) -> tuple[str, str]:
    """Key and range of KEY=RANGE. Returns key, span: left and right of the first equals sign."""
    key, sign, span = (part.strip() for part in text.partition("="))
    if not sign or not key or not span:
        raise BadInput(f"--over {shown(text)} is not KEY=RANGE; write for example --over 'spring.p0=3..8 MPa:11'")
    return key, span


def parse_axis(text: str, place: Place) -> Axis:
    """An axis from KEY=RANGE. place: where the key belongs, see `mechsym.cases.locate`."""
    key, span = split(text)
    if place.unit is None:
        words = tuple(part.strip() for part in span.split(","))
        if not all(words) or len(set(words)) < len(words):
            raise BadInput(f"--over {shown(text)}: a word is empty or stands twice; write KEY=WORD,OTHER")
        return Axis(key=key, place=place, unit="", suffix="", kind="grid", values=words)
    written = read_range(span, "--over", place.written or place.unit, key)
    if written.kind == "grid" and len(set(written.values)) < len(written.values):
        raise BadInput(f"--over {shown(text)}: a value stands twice; give each of them once")
    if written.unit and place.written:
        why = f"the key names {place.written}"
        raise BadInput(f"--over {shown(text)}: unit {written.unit!r} is one too many, {why}; leave it away")
    if written.unit:  # of the right dimension
        parse(f"1 {written.unit}", place.unit or "-", f"--over {place.section}.{place.field}")
    unit = written.unit or place.written or place.unit or "-"
    suffix = "" if place.written or unit == place.unit or unit == "-" else unit
    return Axis(key=key, place=place, unit=unit, suffix=suffix, kind=written.kind, values=written.values)


_MOST_OF_GRID = 20_000_000  # points that are made when they are asked for


class GridPoints(Sequence[tuple[Value, ...]]):
    """Points of a grid, the last axis fastest, each made when it is asked for."""

    def __init__(self, values: Iterable[Sequence[Value]]) -> None:
        self._values = [tuple(v) for v in values]
        self._shape = tuple(map(len, self._values))

    def __len__(self) -> int:
        return math.prod(self._shape)

    def __getitem__(self, k: Any) -> Any:
        if isinstance(k, slice):
            places = np.unravel_index(np.arange(*k.indices(len(self))), self._shape)
            return list(zip(*([v[i] for i in at] for v, at in zip(self._values, places, strict=True)), strict=True))
        at = np.unravel_index(range(len(self))[k], self._shape)
        return tuple(v[i] for v, i in zip(self._values, at, strict=True))

    def __iter__(self) -> Iterator[tuple[Value, ...]]:
        return itertools.product(*self._values)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Sequence) and len(self) == len(other) and all(map(operator.eq, self, other))

    __hash__ = None  # type: ignore[assignment]

    def along(self, i: int) -> np.ndarray:
        """Values of an axis at all points [unit of the axis]."""
        inner = math.prod(self._shape[i + 1 :])
        return np.tile(np.repeat(np.array(self._values[i]), inner), len(self) // inner // self._shape[i])


def along(points: Sequence[tuple[Value, ...]], i: int) -> np.ndarray:
    """Values of an axis at all points [unit of the axis]."""
    return points.along(i) if isinstance(points, GridPoints) else np.array([p[i] for p in points])


def points(
    axes: tuple[Axis, ...], samples: int | None, seed: int
) -> tuple[dict[str, int], Sequence[tuple[Value, ...]]]:
    """All points of a grid, or samples that fill the space evenly (Sobol's sequence).

    samples: number of samples; None runs the grid. Returns dims: dict of str to int, name and length of each dimension;
    points: values in the axes' order, the last axis fastest.
    """
    if not axes:
        raise BadInput("--over must name at least one key, for example --over 'spring.p0=3..8 MPa:11'")
    for axis in axes:
        if axis.kind == "grid" and samples is not None:
            raise BadInput(f"--over {axis.key}: with --samples give a range a..b or a distribution m+-s, or use --set")
        if axis.kind != "grid" and samples is None:
            raise BadInput(f"--over {axis.key}: say how many values, a..b:n, or ask for --samples N")
    count = math.prod(len(a.values) for a in axes) if samples is None else samples
    most = MOST if samples else _MOST_OF_GRID
    if not 1 <= count <= most:
        raise BadInput(f"the sweep has {count} points; allowed are 1 to {most}")
    if samples is None:
        return {a.key: len(a.values) for a in axes}, GridPoints(a.values for a in axes)
    return {"sample": samples}, drawn(axes, samples, seed)


def drawn(axes: tuple[Axis, ...], samples: int, seed: int) -> list[tuple[Value, ...]]:
    """Samples of the ranges and distributions, of Sobol's sequence [unit of the axis]."""
    from scipy.stats import norm, qmc

    # the sequence is balanced in powers of two; what is over is left out
    shares = qmc.Sobol(len(axes), seed=seed).random_base2(math.ceil(math.log2(samples)))[:samples]
    columns = []
    for a, u in zip(axes, shares.T, strict=True):
        one, two = map(float, a.values)
        columns.append(one + (two - one) * u if a.kind == "even" else norm.ppf(np.clip(u, 1e-12, 1 - 1e-12), one, two))
    return list(zip(*(c.tolist() for c in columns), strict=True))


def saltelli(axes: tuple[Axis, ...], count: int, seed: int) -> list[tuple[Value, ...]]:
    """Points A, B, AB_1 .. AB_d for `count` base samples, a power of two.

    Returns points: list of tuple, (d + 2) times `count` values in the axes' order [unit of the axis].
    """
    d = len(axes)
    both = np.array(drawn((*axes, *axes), count, seed))
    a, b = both[:, :d], both[:, d:]
    mixed = [np.where(np.arange(d) == i, b, a) for i in range(d)]
    return [tuple(row) for row in np.concatenate([a, b, *mixed]).tolist()]


def override(axis: Axis, value: Value) -> str | float:
    """One of its values as `--set` takes it, with the unit as a text if the key needs it [unit]."""
    return f"{value!r} {axis.suffix}" if axis.suffix else value


_OPERATORS: dict[type, Callable[..., float]] = {
    ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: operator.truediv,
    ast.Pow: operator.pow, ast.USub: operator.neg, ast.UAdd: operator.pos,
}  # fmt: skip
_FUNCTIONS: dict[str, Callable[..., float]] = {
    name: getattr(math, name)
    for name in ("sqrt", "exp", "log", "sin", "cos", "tan", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh")
} | {"abs": abs, "min": min, "max": max}


@record
class Tie:
    """One value that follows from others."""

    key: str  #: As it was written
    text: str  #: Formula, SI
    place: Place | None  #: Where the value belongs; None for a letter
    tree: ast.expr


@record
class Ties:
    """What ties need at every point."""

    base: Case
    ties: tuple[Tie, ...]
    #: Keys of the axes and of the formulas by the way they are written
    places: Mapping[str, Place]

    def at(self, here: Mapping[str, Value]) -> Json:
        """Values of a point with those that are tied.

        here: values of the axes, as `--set` takes them. Returns values: `here` and every tied value by `section.field`
        [SI]. Raises BadInput: a formula has no value here.
        """
        values: dict[str, Value] = {
            _name(self.places[key]): _si(self.places[key], value) for key, value in here.items()
        }
        point = dict(here)
        for tie in self.ties:
            values[tie.key if tie.place is None else _name(tie.place)] = value = self._value(tie, values)
            if tie.place is not None:
                point[_name(tie.place)] = value
        return point

    def _value(self, tie: Tie, values: Mapping[str, Value]) -> float:
        try:
            value = _worked_out(tie.tree, lambda name: self._of(name, values))
        except (ArithmeticError, ValueError) as error:
            raise BadInput(f"--tie {tie.key} = {tie.text} has no value here: {error}") from None
        if isinstance(value, complex) or not math.isfinite(value):
            raise BadInput(f"--tie {tie.key} = {tie.text} has no value here: {value}")
        return float(value)

    def _of(self, name: str, values: Mapping[str, Value]) -> float:
        if name not in self.places:
            return math.pi if name == "pi" and name not in values else float(values[name])
        place = self.places[name]
        value = values.get(_name(place))
        if value is None:
            value = getattr(self.base.need(place.section), place.field, None)
        if value is None or isinstance(value, str | tuple):
            raise BadInput(f"--tie: {name} = {shown(value)} is no number to reckon with")
        return float(value)


def ties(case: str, overrides: Mapping[str, object], texts: tuple[str, ...], axes: Mapping[str, Place]) -> Ties:
    """Ties that are written KEY=FORMULA.

    axes: keys that the sweep runs over. Raises BadInput: no formula, a name that neither the case nor a tie before it
    has, or a letter that nothing uses.
    """
    places, letters, tied = dict(axes), {"pi"}, []
    for text in texts:
        key, tree, written = _split(text)
        place = _located(case, key, overrides)
        for name in _names(tree):
            if name not in letters and name not in places:
                places[name] = _number(cases.locate(case, name, overrides, option=f"--tie {key}:"), name)
        if place is None:
            letters.add(key)
        tied.append(Tie(key=key, text=written, place=place, tree=tree))
    used = {name for tie in tied for name in _names(tie.tree)}
    for tie in tied:
        if tie.place is None and tie.key not in used:
            cases.locate(case, tie.key, overrides, option="--tie")
    return Ties(base=cases.load(case, overrides), ties=tuple(tied), places=places)


def _split(text: str) -> tuple[str, ast.expr, str]:
    key, sign, formula = (part.strip() for part in text.partition("="))
    if not sign or not key or not formula:
        raise BadInput(f"--tie {shown(text)} is not KEY=FORMULA; write for example --tie 'bore=sqrt(4*V/(pi*stroke))'")
    try:
        tree = ast.parse(formula.replace("^", "**"), mode="eval").body
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        way = "write for example sqrt(4*V/(pi*stroke))"
        raise BadInput(f"--tie {key}: {shown(formula)} is no formula; {way}") from None
    _checked(key, tree)
    return key, tree, formula


def _checked(key: str, tree: ast.expr) -> None:
    """Refuse what a formula cannot be made of."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Call):
            name = ast.unparse(node.func)
            if name not in _FUNCTIONS or node.keywords:
                raise BadInput(f"--tie {key}: {shown(name)} is no function; {suggest(name, _FUNCTIONS)}")
        elif isinstance(node, ast.Constant):
            if isinstance(node.value, bool) or not isinstance(node.value, int | float):
                raise BadInput(f"--tie {key}: {shown(node.value)} is no number")
        elif isinstance(node, ast.BinOp | ast.UnaryOp):
            if type(node.op) not in _OPERATORS:
                raise BadInput(f"--tie {key}: {shown(ast.unparse(node))} is no sum, product or power")
        elif not isinstance(node, ast.Name | ast.Attribute | ast.operator | ast.unaryop | ast.expr_context):
            raise BadInput(f"--tie {key}: {shown(ast.unparse(node))} has no place in a formula")


def _names(tree: ast.expr) -> list[str]:
    """Names that a formula reckons with: letters and dotted keys, not its functions."""
    if isinstance(tree, ast.Name | ast.Attribute):
        return [ast.unparse(tree)]
    parts = tree.args if isinstance(tree, ast.Call) else ast.iter_child_nodes(tree)
    return [name for part in parts if isinstance(part, ast.expr) for name in _names(part)]


def _worked_out(tree: ast.expr, of: Callable[[str], float]) -> float:
    if isinstance(tree, ast.Constant) and isinstance(tree.value, int | float):
        return tree.value
    if isinstance(tree, ast.Name | ast.Attribute):
        return of(ast.unparse(tree))
    if isinstance(tree, ast.BinOp):
        return _OPERATORS[type(tree.op)](float(_worked_out(tree.left, of)), float(_worked_out(tree.right, of)))
    if isinstance(tree, ast.UnaryOp):
        return _OPERATORS[type(tree.op)](_worked_out(tree.operand, of))
    assert isinstance(tree, ast.Call) and isinstance(tree.func, ast.Name)
    return _FUNCTIONS[tree.func.id](*(_worked_out(part, of) for part in tree.args))


def _located(case: str, key: str, overrides: Mapping[str, object]) -> Place | None:
    """Where a tied value belongs; None for a plain name that the case does not have."""
    try:
        return _number(cases.locate(case, key, overrides, option="--tie"), key)
    except BadInput:
        if not key.isidentifier() or key in _FUNCTIONS or key == "pi":
            raise
        return None


def _number(place: Place, key: str) -> Place:
    if place.unit is None:
        raise BadInput(f"--tie: {key} is a word, no number")
    return place


def _name(place: Place) -> str:
    return f"{place.section}.{place.field}"


def _si(place: Place, value: Value) -> Value:
    """A value of an axis in SI; a word as it is."""
    if place.unit is None:
        return value
    return parse(f"{value} {place.written}" if place.written else value, place.unit, _name(place))
