"""How cylinders stand around a crankshaft, and when they fire: in line, V, boxer, radial, opposed."""

import math

from mechsym.errors import BadInput
from mechsym.mechanisms.crank_train.firing import crank_phases, firing_angles
from mechsym.quantities import record

# usual orders of engines in line; others go up through the odd cylinders and down through the even ones
_ORDERS = {
    1: (1,), 2: (1, 2), 3: (1, 3, 2), 4: (1, 3, 4, 2), 5: (1, 2, 4, 5, 3), 6: (1, 5, 3, 6, 2, 4),
    8: (1, 6, 2, 5, 8, 3, 7, 4),
}  # fmt: skip
# of two-strokes, whose cranks stand in the order of firing: the couples of first and second order on the frame are
# small, as in the engines of the large builders (of six none of first order)
_TWO_STROKE_ORDERS = {
    4: (1, 3, 2, 4), 5: (1, 4, 3, 2, 5), 6: (1, 5, 3, 4, 2, 6), 7: (1, 7, 2, 5, 4, 3, 6), 8: (1, 8, 3, 4, 7, 2, 5, 6),
    9: (1, 9, 2, 7, 4, 5, 6, 3, 8), 10: (1, 8, 5, 7, 2, 9, 4, 6, 3, 10), 11: (1, 10, 3, 8, 6, 5, 7, 4, 9, 2, 11),
    12: (1, 8, 12, 4, 2, 9, 10, 5, 3, 7, 11, 6),
}  # fmt: skip
# of a V whose order is not twice that of a bank: eight on pins a quarter of a turn apart, with no second-order force
_V_ORDERS = {8: (1, 5, 4, 2, 6, 3, 7, 8)}
_BANKS = {2: 90, 4: 90, 6: 60, 8: 90, 10: 72, 12: 60}  # angle between the banks of a V engine [deg]


@record
class CylinderLayout:
    """Cylinders of a crank train: angles in degrees, one a cylinder, and one place along the shaft for each throw."""

    throw: tuple[int, ...]  #: which each cylinder stands on, from 1
    bank: tuple[float, ...]  #: where the axis of each cylinder points [deg]
    firing: tuple[float, ...]  #: of each cylinder [deg]
    phase: tuple[float, ...]  #: angle of the pin of each cylinder [deg]
    period: float  #: of a cycle [deg]
    opposed: bool = False
    pitch: float = 1.2  #: from throw to throw, by the bore [-]
    master: tuple[int, ...] = ()  #: cylinder on whose rod that of each hangs, 0 for the crank pin; empty: none hangs
    turned: float = 0.0  #: share of the pistons' mass on a throw that its counterweight carries as well [-]


def in_line(count: int, turns: int) -> CylinderLayout:
    """Cylinders in line, evenly fired, one throw each. turns: 1 for two-stroke, 2 for four-stroke."""
    usual = _ORDERS.get(count, (*range(1, count + 1, 2), *range(count - count % 2, 0, -2)))
    order = _TWO_STROKE_ORDERS.get(count, usual) if turns == 1 else usual
    firing, bank = firing_angles(order, turns * 2 * math.pi), (0.0,) * count
    throw, phase = tuple(range(1, count + 1)), _degrees(crank_phases(firing, bank))
    return CylinderLayout(throw=throw, bank=bank, firing=_degrees(firing), phase=phase, period=360.0 * turns)


def in_v(count: int, hangs: bool = False) -> CylinderLayout:
    """A four-stroke V: cylinders i and i + n/2 on one throw, its pin split where even firing asks for it.

    hangs: the rod of the second on that of the first, which leaves one pin for both. A twin has one pin for both rods
    anyway, as usual, and fires unevenly; eight have a cross-plane crank.
    """
    if count not in _BANKS:
        raise BadInput(f"--cylinders {count}: a V engine here has {', '.join(map(str, _BANKS))}")
    half, bank = count // 2, float(_BANKS[count])
    if cross_plane := count in _V_ORDERS:
        firing = _degrees(firing_angles(_V_ORDERS[count], 4 * math.pi))
    else:
        first = _degrees(firing_angles(_ORDERS.get(half, (1,)), 4 * math.pi))
        later = bank + 360.0 if count == 2 else bank if hangs else 720.0 / count
        firing = (*first, *((f + later) % 720 for f in first))
    banks = (-bank / 2,) * half + (bank / 2,) * half
    phase = tuple((b - f) % 360 for b, f in zip(banks, firing, strict=True))
    master = (0,) * half + tuple(range(1, half + 1)) if hangs else ()
    return CylinderLayout(
        throw=tuple(range(1, half + 1)) * 2, bank=banks, firing=firing, phase=phase, period=720.0, master=master,
        # at a right angle two pistons on one pin have a first order that turns with it
        turned=0.5 if cross_plane else 0.0,
    )  # fmt: skip


def boxer(count: int) -> CylinderLayout:
    """A four-stroke boxer: facing cylinders i and i + 1 on throws half a turn apart, which fire a turn apart.

    Fires evenly, and from side to side in turn where half of the cylinders are an odd number.
    """
    if count % 2:
        raise BadInput(f"--cylinders {count}: a boxer has pairs of cylinders, 2, 4, 6, 8, 10 or 12")
    pairs = count // 2
    firing: list[float] = []
    for top in _degrees(firing_angles(_ORDERS.get(pairs, (1,)), 2 * math.pi)):
        late = 360.0 * (pairs % 2 and round(top * count / 720) % 2)
        firing += [top + late, top + 360.0 - late]
    bank = (90.0, -90.0) * pairs
    phase = tuple((b - f) % 360 for b, f in zip(bank, firing, strict=True))
    throw = tuple(range(1, count + 1))
    return CylinderLayout(throw=throw, bank=bank, firing=tuple(firing), phase=phase, period=720.0, pitch=0.6)


def radial(count: int, hangs: bool = True) -> CylinderLayout:
    """A four-stroke star on one throw: every second cylinder fires, which takes an odd number for even firing.

    hangs: all rods but the first on that of cylinder 1; else all on the crank pin.
    """
    if count < 3 or not count % 2:
        raise BadInput(f"--cylinders {count}: a four-stroke radial has an odd number of cylinders, 3, 5, 7, 9 or 11")
    bank = tuple(round(360.0 / count * i, 9) for i in range(count))
    firing = tuple(b + 360.0 * (i % 2) for i, b in enumerate(bank))
    master = (0,) + (1,) * (count - 1) if hangs else ()
    # half of all pistons turning with the pin is their whole first order
    return CylinderLayout(
        throw=(1,) * count, bank=bank, firing=firing, phase=(0.0,) * count, period=720.0, master=master, turned=0.5
    )


def opposed(count: int) -> CylinderLayout:
    """Two-stroke cylinders with two pistons each, on two cranks that gears keep together."""
    one = in_line(count, turns=1)
    bank = one.bank + (180.0,) * count
    phase = (*one.phase, *((180 - f) % 360 for f in one.firing))
    throw = tuple(range(1, 2 * count + 1))
    return CylinderLayout(throw=throw, bank=bank, firing=one.firing * 2, phase=phase, period=360.0, opposed=True)


def _degrees(angles: tuple[float, ...]) -> tuple[float, ...]:
    return tuple(round(math.degrees(a), 9) % 720 for a in angles)
