"""What a sweep runs over: ranges on a grid, or distributions that samples are drawn from.

spring.p0=3..8 MPa:11        eleven even values, both ends included
speed_rpm=89,120,142         a list; texts such as simulation.hinge=designed,none too
spring.n=1.2..1.3            with samples: evenly distributed
k1=6500+-200 N*m/rad         with samples: normally distributed, mean and standard deviation
"""

import dataclasses
import itertools
import math
import re
from typing import Any

import numpy as np

from mechsym.errors import BadInput

_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
_RANGE = re.compile(rf"\s*({_NUMBER})\s*\.\.\s*({_NUMBER})\s*([^:]*?)\s*(?::\s*(\d+))?\s*$")
_NORMAL = re.compile(rf"\s*({_NUMBER})\s*\+-\s*({_NUMBER})\s*(.*?)\s*$")
_ONE = re.compile(rf"\s*({_NUMBER})\s*(.*?)\s*$")
_MOST = 1_000_000


@dataclasses.dataclass(frozen=True, kw_only=True)
class Axis:
    """A value of the case and what it takes on.

    Parameters
    ----------
    key : str
        Key as for `--set`
    unit : str
        Unit as written, empty for SI
    kind : str
        `grid` (values), `even` or `normal` (two numbers)
    values : tuple of float or of str
        Values of a grid; ends of an even distribution; mean and standard deviation of a normal one [unit]
    """

    key: str
    unit: str
    kind: str
    values: tuple[Any, ...]


def parse_axis(text: str) -> Axis:
    """An axis from KEY=RANGE.

    Parameters
    ----------
    text : str
        See the module's description

    Returns
    -------
    axis : Axis
        What it says

    Raises
    ------
    BadInput
        Not of that form
    """
    key, sign, span = (part.strip() for part in text.partition("="))
    if not sign or not key or not span:
        raise BadInput(f"--over {text!r} is not KEY=RANGE; write for example --over 'spring.p0=3..8 MPa:11'")
    if found := _RANGE.match(span):
        first, last, count = float(found[1]), float(found[2]), found[4]
        if count is None:
            return Axis(key=key, unit=found[3], kind="even", values=(first, last))
        if not 1 <= int(count) <= _MOST:
            raise BadInput(f"--over {text!r}: {count} values; allowed are 1 to {_MOST}")
        return Axis(key=key, unit=found[3], kind="grid", values=tuple(np.linspace(first, last, int(count)).tolist()))
    if found := _NORMAL.match(span):
        return Axis(key=key, unit=found[3], kind="normal", values=(float(found[1]), float(found[2])))
    return _listed(key, [part.strip() for part in span.split(",")], text)


def _listed(key: str, parts: list[str], text: str) -> Axis:
    found = [_ONE.match(part) for part in parts]
    if not any(found):
        return Axis(key=key, unit="", kind="grid", values=tuple(parts))
    # the unit may stand once, at the end
    units = {f[2] for f in found if f} - {""}
    if not all(found) or len(units) > 1:
        raise BadInput(f"--over {text!r}: write a list of numbers in one unit, such as {key}=3,5,8 MPa")
    return Axis(key=key, unit="".join(units), kind="grid", values=tuple(float(f[1]) for f in found if f))


def points(axes: tuple[Axis, ...], samples: int | None, seed: int) -> tuple[dict[str, int], list[tuple[Any, ...]]]:
    """All points of a grid, or samples that fill the space evenly (Sobol's sequence).

    Parameters
    ----------
    axes : tuple of Axis
        What to run over
    samples : int or None
        Number of samples; None runs the grid
    seed : int
        Of the samples

    Returns
    -------
    dims : dict of str to int
        Name and length of each dimension
    points : list of tuple
        Values in the axes' order, the last axis fastest

    Raises
    ------
    BadInput
        No axis or one twice, a distribution without samples, or values without a distribution
    """
    if not axes or len({a.key for a in axes}) < len(axes):
        raise BadInput("--over must name at least one key, and each key once")
    wrong = [a for a in axes if (a.kind == "grid") == (samples is not None)]
    if wrong:
        way = "give a range a..b or a distribution m+-s" if samples else "say how many, a..b:n, or ask for --samples"
        raise BadInput(f"--over {wrong[0].key}: {way}")
    count = math.prod(len(a.values) for a in axes) if samples is None else samples
    if not 1 <= count <= _MOST:
        raise BadInput(f"the sweep has {count} points; allowed are 1 to {_MOST}")
    if samples is None:
        return {a.key: len(a.values) for a in axes}, list(itertools.product(*(a.values for a in axes)))
    return {"sample": samples}, _drawn(axes, samples, seed)


def _drawn(axes: tuple[Axis, ...], samples: int, seed: int) -> list[tuple[Any, ...]]:
    from scipy.stats import norm, qmc

    # the sequence is balanced in powers of two; what is over is left out
    shares = qmc.Sobol(len(axes), seed=seed).random_base2(math.ceil(math.log2(samples)))[:samples]
    columns = [
        a.values[0] + (a.values[1] - a.values[0]) * u
        if a.kind == "even"
        else norm.ppf(np.clip(u, 1e-12, 1 - 1e-12), a.values[0], a.values[1])
        for a, u in zip(axes, shares.T, strict=True)
    ]
    return list(zip(*(c.tolist() for c in columns), strict=True))


def override(axis: Axis, value: Any) -> str | float:
    """A value as `--set` takes it.

    Parameters
    ----------
    axis : Axis
        Where it belongs
    value : float or str
        One of its values [unit]

    Returns
    -------
    text : str or float
        With the unit, if there is one
    """
    return f"{value!r} {axis.unit}" if axis.unit else value
