"""A crank train drawn: at its end, and where cylinders stand behind each other also along its shaft.

         along a bank                     at the end
     ||   ||   ||   ||                      \\\\  //
     ||_  ||_  ||_  ||_    flywheel          \\\\//        one shaft stands upright, two lie as the
    _| |__| |__| |__| |_____[ ]              (  )         reference axis does

Cylinders of a bank stand at their places along the shaft; where the case gives none, side by side at an even pitch.
"""

import dataclasses
import functools
import math
from collections.abc import Iterable, Sequence

import numpy as np

from mechsym.mechanisms.crank_train.articulated import pose, top
from mechsym.mechanisms.crank_train.parameters import each, hung_letters, local_shift
from mechsym.mechanisms.drawn_parts import (
    Circle,
    Line,
    Point,
    Shapes,
    box,
    cylinder,
    extent_of,
    piston,
    slider_crank,
    turned,
    width_of,
)
from mechsym.quantities.units import Scalar


def crank_train(p: Scalar, angle: float, bore: float | None) -> Iterable[Line | Circle]:
    """Shapes at a shaft angle [rad]; a bore [m], or None for one in proportion."""
    end = tuple(_at_the_end(p, angle, bore))
    if not _one_shaft(p):
        yield from end
        return
    yield from turned(end, math.pi / 2)
    start = _right_of_end(p, bore)
    for bank in _banks(p):
        if len(bank) > 1:
            places = _places(p, bank, bore)
            yield from _along(p, bank, [start + place for place in places], angle, bore)
            start += places[-1] + 1.2 * places[0]


def _one_shaft(p: Scalar) -> bool:
    return len(set(zip(each(p, "axis_x"), each(p, "axis_y"), strict=True))) == 1


def _banks(p: Scalar) -> list[list[int]]:
    """Cylinders that would hide each other at the end, in the order along the shaft."""
    banks: dict[tuple[float, float], list[int]] = {}
    for i in sorted(range(len(p.throw)), key=lambda i: (p.throw[i], each(p, "z_rod")[i])):
        banks.setdefault((round(each(p, "bank")[i], 6), each(p, "offset")[i]), []).append(i)
    return list(banks.values())


def _at_the_end(p: Scalar, angle: float, bore: float | None) -> Iterable[Line | Circle]:
    """Every crank, but one piston a bank; of two shafts every piston."""
    shown = {bank[0] for bank in _banks(p)} if _one_shaft(p) else set(range(len(p.throw)))
    for i, k in enumerate(p.throw):
        r, l1, l2, offset, bank = (each(p, n)[i] for n in ("r", "l1", "l2", "offset", "bank"))
        sense, origin = each(p, "sense")[k - 1], (each(p, "axis_x")[k - 1], each(p, "axis_y")[k - 1])
        if each(p, "master")[i]:
            own = tuple(_hung(p, i, angle, bore)) if i in shown else ()
        else:
            own = tuple(slider_crank(r, l1 + l2, offset, angle + local_shift(p)[i], bore))
        if i not in shown:
            own = tuple(s for s in own if s.role == "crank") + tuple(s for s in own if s.role == "joint")[:1]
        yield from turned(_numbered(own, i), bank, sense, origin)


def _numbered(shapes: Iterable[Line | Circle], i: int) -> Iterable[Line | Circle]:
    return (dataclasses.replace(shape, of=i + 1) for shape in shapes)


def _hung(p: Scalar, i: int, angle: float, bore: float | None) -> Iterable[Line | Circle]:
    """A rod that hangs on another with its piston and cylinder, in the axes of its own cylinder."""
    (knuckle, end, reach), r = _rod(p, i, angle), each(p, "r")[i]
    own = angle + local_shift(p)[i]
    # from the crank pin over the knuckle pin, which the other's rod carries
    yield Line(role="rod", points=((r * math.cos(own), r * math.sin(own)), knuckle, end))
    yield Circle(role="joint", centre=knuckle, radius=0.09 * r)
    yield from piston(end, 2 * r, bore)
    yield from cylinder(end[1], reach - 2 * r, 2 * r, bore)
    yield Circle(role="joint", centre=end, radius=0.09 * r)


@functools.lru_cache(maxsize=64)
def _right_of_end(p: Scalar, bore: float | None) -> float:
    def end(angle: float) -> Shapes:
        return tuple(turned(_at_the_end(p, angle, bore), math.pi / 2))

    return extent_of(end)[1]


def _places(p: Scalar, bank: Sequence[int], bore: float | None) -> list[float]:
    """Where the cylinders of a bank stand along the shaft, from a margin on [m]."""
    width = max(width_of(bore, 2 * each(p, "r")[i]) for i in bank)
    z = [each(p, "z")[p.throw[i] - 1] + each(p, "z_rod")[i] for i in bank]
    if np.min(np.diff(z)) < 1.06 * width:  # none given, or pistons that would overlap
        z = [1.3 * width * k for k in range(len(bank))]
    return [place - z[0] + width for place in z]


def _along(
    p: Scalar, bank: Sequence[int], places: Sequence[float], angle: float, bore: float | None
) -> Iterable[Line | Circle]:
    """One bank in its own plane: x along the shaft, y along the cylinders."""
    pitch = places[1] - places[0]
    first, last = places[0] - 0.6 * pitch, places[-1] + 0.6 * pitch
    largest = max(each(p, "r")[i] for i in bank)
    yield Line(role="frame", points=((first, 0.0), (last, 0.0)))
    yield box("flywheel", (last, -1.3 * largest), (0.25 * pitch, 2.6 * largest))
    for i, z in zip(bank, places, strict=True):
        r, own = each(p, "r")[i], angle + local_shift(p)[i]
        height, half = r * math.cos(own), 0.2 * width_of(bore, 2 * r)
        (hangs, _), (end, _), reach = _rod(p, i, angle)
        points = ((z - 1.8 * half, 0.0), (z - half, 0.0), (z - half, height), (z + half, height), (z + half, 0.0))
        yield Line(role="crank", points=(*points, (z + 1.8 * half, 0.0)))
        rod = Line(role="rod", points=((z, hangs), (z, end)))
        yield from _numbered((rod, *_cylinder_along(z, end, reach, 2 * r, bore)), i)


def _rod(p: Scalar, i: int, angle: float) -> tuple[Point, Point, float]:
    """Both ends of a rod in the axes of its cylinder, and the largest distance of the piston pin from the shaft [m]."""
    if master := int(each(p, "master")[i]):
        letters = hung_letters(p, i)
        return *pose(letters, angle + local_shift(p)[master - 1]), top(letters)[1]
    r, l, offset = each(p, "r")[i], each(p, "l1")[i] + each(p, "l2")[i], each(p, "offset")[i]
    own = angle + local_shift(p)[i]
    pin = (r * math.cos(own), r * math.sin(own))
    return pin, (pin[0] + math.sqrt(l**2 - (pin[1] - offset) ** 2), offset), math.sqrt((r + l) ** 2 - offset**2)


def _cylinder_along(z: float, end: float, top: float, stroke: float, bore: float | None) -> Iterable[Line | Circle]:
    width = width_of(bore, stroke)
    yield box("piston", (z - width / 2, end - 0.12 * stroke), (width, 0.36 * stroke))
    half, low, high = 0.53 * width, top - 1.12 * stroke, top + 0.32 * stroke
    yield Line(role="frame", points=((z - half, low), (z - half, high), (z + half, high), (z + half, low)))
    yield Circle(role="joint", centre=(z, end), radius=0.045 * stroke)
