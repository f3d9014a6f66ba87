"""What a sweep runs over: ranges on a grid, or distributions that samples are drawn from.

spring.p0=3..8 MPa:11        eleven even values, both ends included; speed_rpm=80:140:10 in steps
speed_rpm=89,120,142         a list; words such as simulation.hinge=designed,none too
spring.n=1.2..1.3            with samples: evenly distributed
k1=6500+-200 N*m/rad         with samples: normally distributed, mean and standard deviation
"""

import itertools
import math

import numpy as np

from mechsym.cases.values import Place
from mechsym.errors import BadInput, shown
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
        _check_words(text, words)
        return Axis(key=key, place=place, unit="", suffix="", kind="grid", values=words)
    found = read_range(span, "--over", place.written or place.unit, key)
    unit = _unit(text, found.unit, place)
    suffix = "" if place.written or unit == place.unit or unit == "-" else unit
    return Axis(key=key, place=place, unit=unit, suffix=suffix, kind=found.kind, values=found.values)


def _unit(text: str, written: str, place: Place) -> str:
    """The unit of an axis, of the right dimension."""
    if written and place.written:
        why = f"the key names {place.written}"
        raise BadInput(f"--over {shown(text)}: unit {written!r} is one too many, {why}; leave it away")
    if written:
        parse(f"1 {written}", place.unit or "-", f"--over {place.section}.{place.field}")
    return written or place.written or place.unit or "-"


def _check_words(text: str, words: tuple[str, ...]) -> None:
    if not all(words) or len(set(words)) < len(words):
        raise BadInput(f"--over {shown(text)}: a word is empty or stands twice; write KEY=WORD,OTHER")


def points(axes: tuple[Axis, ...], samples: int | None, seed: int) -> tuple[dict[str, int], list[tuple[Value, ...]]]:
    """All points of a grid, or samples that fill the space evenly (Sobol's sequence).

    samples: number of samples; None runs the grid. Returns dims: dict of str to int, name and length of each dimension;
    points: list of tuple, values in the axes' order, the last axis fastest.
    """
    if not axes:
        raise BadInput("--over must name at least one key, for example --over 'spring.p0=3..8 MPa:11'")
    for axis in axes:
        if axis.kind == "grid" and samples is not None:
            raise BadInput(f"--over {axis.key}: with --samples give a range a..b or a distribution m+-s, or use --set")
        if axis.kind != "grid" and samples is None:
            raise BadInput(f"--over {axis.key}: say how many values, a..b:n, or ask for --samples N")
    count = math.prod(len(a.values) for a in axes) if samples is None else samples
    if not 1 <= count <= MOST:
        raise BadInput(f"the sweep has {count} points; allowed are 1 to {MOST}")
    if samples is None:
        return {a.key: len(a.values) for a in axes}, list(itertools.product(*(a.values for a in axes)))
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
