r"""Numbers by name against the ranges of their kind; what a case accepts is told apart from what is doubted.

What crank, rod, masses, spring and speed say together.

.. math:: c_m = 2 S n, \qquad S = 2 r \text{ (slider crank)}, \quad 4 e \text{ or } 4 r \text{ (hypocycloid, rodless)}

Ranges by kind of value: beyond the hard one lies nonsense, beyond the usual one a doubt. The usual ranges are those of
reciprocating engines, from large marine two-strokes to models, after Heywood (1988), Internal combustion engine
fundamentals, chapters 2 and 15, and the data sheets of the materials; they are wide on purpose. The hard ranges are a
factor of about three to ten beyond, or a law of physics.

Ranges of what several values say together: one number each, in proportion to the machine. The table is `ranges.csv`;
an angle stands there with `deg`, and an empty limit is none.
"""

import csv
import functools
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from importlib import resources

from mechsym.errors import BadInput
from mechsym.quantities import record
from mechsym.quantities.units import Metre, Pure, RadPerSecond


@record
class Usual:
    """One kind of value."""

    code: str  #: One word by which a case can accept a doubt
    keys: tuple[str, ...]  #: Names of the values, the last word of a dotted key
    unit: str  #: SI unit of the values, or the unit that a result's name says
    low: float = -math.inf  #: Least usual value [unit]
    high: float = math.inf  #: Largest usual value [unit]
    lowest: float = -math.inf  #: Least possible value [unit]
    highest: float = math.inf  #: Largest possible value [unit]
    why: str
    section: str = ""  #: Section of a case that it is meant for; empty for any


def _limit(text: str, missing: float) -> float:
    """A limit of the table; angles may be given in degrees."""
    if not text:
        return missing
    return math.radians(float(text.removesuffix(" deg"))) if text.endswith(" deg") else float(text)


def _table() -> dict[str, tuple[Usual, ...]]:
    rows: dict[str, list[Usual]] = {"input": [], "result": [], "proportion": []}
    text = resources.files("mechsym.plausible").joinpath("ranges.csv").read_text("utf-8")
    for row in csv.DictReader(text.splitlines()):
        low, lowest = (_limit(row[name], -math.inf) for name in ("low", "lowest"))
        high, highest = (_limit(row[name], math.inf) for name in ("high", "highest"))
        rows[row["table"]].append(
            Usual(
                code=row["code"],
                section=row["section"],
                keys=tuple(row["keys"].split()),
                unit=row["unit"],
                low=low,
                high=high,
                lowest=lowest,
                highest=highest,
                why=row["why"],
            )
        )
    return {name: tuple(usuals) for name, usuals in rows.items()}


_ROWS = _table()
INPUTS = _ROWS["input"]  #: Values of a case by their names
RESULTS = _ROWS["result"]  #: Numbers of a report by their names
PROPORTIONS = _ROWS["proportion"]  #: What several values say together, by code


_USUAL_RATIO = {"scale": 1.0}  # kinds of other rooms that are doubted on both sides of this [-]
# how large a letter of any mechanism usually is, by its unit; the largest machines are ships' engines and presses
_LARGEST = {
    "m": 100.0, "kg": 1e6, "kg*m": 1e6, "kg*m^2": 1e8, "rad": 1e5, "rad/s": 1e4, "m/s": 1e4, "N": 1e9, "N*m": 1e9,
    "N/m": 1e12, "N*m/rad": 1e12, "N*s/m": 1e10, "N*m*s/rad": 1e10, "m/s^2": 1e5,
}  # fmt: skip
_DEGREES = "few angles are a whole number of radians, and a number without a unit is in radians: '90 deg'"
_BY_CODE = {kind.code: kind for kind in PROPORTIONS}


@record
class Doubt:
    """A value that is possible and not usual."""

    code: str  #: One word by which a case can accept it
    quantity: str
    value: float  #: In the unit that `quantity` names, else SI [unit]
    usual: str
    why: str


@record
class Acceptance:
    """A doubt that a case accepts up to a value, with its reason."""

    code: str
    up_to: float  #: Farthest value from the usual range that is accepted, in the unit of the quantity [unit]
    why: str


def inputs(values: Mapping[str, float], refusing: bool = True) -> tuple[Doubt, ...]:
    """Values of a case against hard and usual ranges.

    values: by dotted key, `section.field` [SI]. refusing: whether nonsense is refused; else it is doubted, as what
    follows from values is. Raises BadInput: a value that no engine has, with what is possible.

    >>> [d.code for d in inputs({"cycle.compression_ratio": 60.0, "cycle.bore": 0.08})]
    ['compression_ratio']
    """
    doubts = []
    for key, value in values.items():
        for kind in _kinds_of_input(key):
            if refusing:
                _refuse(key, value, kind)
            doubts += [_doubt(key, value, kind)] if not kind.low <= value <= kind.high else []
    return tuple(doubts)


# the points of a sweep have the same keys
@functools.lru_cache(maxsize=4096)
def _kinds_of_input(key: str) -> tuple[Usual, ...]:
    section, _, name = key.rpartition(".")
    return tuple(kind for kind in INPUTS if name in kind.keys and kind.section in ("", section))


def proportion(code: str, quantity: str, value: float, high: float | None = None) -> tuple[Doubt, ...]:
    """A number that several values make together, against the range of its kind.

    quantity: what it is, with the values that make it, for messages; value: in the unit of its kind [unit]; high: upper
    end of the usual range, where it depends on the machine's size [unit]. Raises BadInput: a value that no engine has.

    >>> [d.usual for d in proportion("spring_area", "spring area / piston area", 4.0)]
    ['at least 0.01 and at most 3']
    """
    kind = _BY_CODE[code] if high is None else replace(_BY_CODE[code], high=high)
    _refuse(quantity, value, kind)
    return () if kind.low <= value <= kind.high else (_doubt(quantity, value, kind),)


def letters(values: Mapping[str, tuple[float, str]]) -> tuple[Doubt, ...]:
    """Letters of any mechanism, whose meaning is not known, against the size of the largest machines.

    values: by letter, the value and its SI unit [SI].

    >>> [d.quantity for d in letters({"phid": (1e12, "rad/s"), "phi": (1.0, "rad"), "phase": (45.0, "rad")})]
    ['phid', 'phase']
    """
    why, doubts = _BY_CODE["magnitude"].why, []
    for name, (value, unit) in values.items():
        if abs(value) > _LARGEST.get(unit, math.inf):
            usual = f"at most {_LARGEST[unit]:g} {unit}"
            doubts.append(Doubt(code="magnitude", quantity=name, value=value, usual=usual, why=why))
        elif unit == "rad" and abs(value) > math.pi and value == round(value):  # no angle of degrees is a whole number
            usual = "at most half a turn, where it is a whole number of radians"
            doubts.append(Doubt(code="angle", quantity=name, value=value, usual=usual, why=_DEGREES))
    return tuple(doubts)


def results(report: object) -> tuple[Doubt, ...]:
    """Numbers of a report, wherever they stand in it, against the usual ranges of results; `a.b` is a b."""
    worst: dict[tuple[str, str], Doubt] = {}
    for name, value in _numbers(report):
        for kind in _kinds(name):
            if not kind.low <= value <= kind.high:
                known = worst.get((kind.code, name))
                if known is None or abs(value) > abs(known.value):
                    worst[kind.code, name] = _doubt(name, value, kind)
    return tuple(worst.values())


def sifted(
    doubts: Sequence[Doubt], acceptances: Mapping[str, Acceptance]
) -> tuple[tuple[Doubt, ...], tuple[Doubt, ...]]:
    """Doubts that remain, and those that a case accepts."""
    accepted = tuple(d for d in doubts if d.code in acceptances and _within(d, acceptances[d.code]))
    return tuple(d for d in doubts if d not in accepted), accepted


def _within(doubt: Doubt, acceptance: Acceptance) -> bool:
    kind = next((k for k in (*INPUTS, *RESULTS, *PROPORTIONS) if k.code == doubt.code), None)
    low_side = doubt.value < (kind.low if kind is not None else _USUAL_RATIO.get(doubt.code, -math.inf))
    slack = 1e-9 * abs(acceptance.up_to)
    return doubt.value >= acceptance.up_to - slack if low_side else abs(doubt.value) <= abs(acceptance.up_to) + slack


@functools.lru_cache(maxsize=4096)
def _kinds(name: str) -> tuple[Usual, ...]:
    """Usual ranges of a result."""
    last = name.rpartition(".")[2]
    return tuple(kind for kind in RESULTS if last in kind.keys)


def _numbers(report: object, name: str = "") -> Iterator[tuple[str, float]]:
    """Numbers of which a usual range is known."""
    if isinstance(report, Mapping):
        for key, value in report.items():
            yield from _numbers(value, str(key))
    elif hasattr(report, "tolist"):
        yield from _numbers(report.tolist(), name)
    elif isinstance(report, (list, tuple)):
        # a map has millions, most of them nothing that is looked for
        known = bool(_kinds(name))
        for value in report:
            if known or value is not None and type(value) is not float:
                yield from _numbers(value, name)
    elif isinstance(report, (int, float)) and not isinstance(report, bool) and math.isfinite(report) and _kinds(name):
        yield name, float(report)


def _refuse(key: str, value: float, kind: Usual) -> None:
    if not kind.lowest <= value <= kind.highest:
        size, unit = (
            (math.radians(1.0), " deg") if kind.unit == "rad" else (1.0, "" if kind.unit == "-" else f" {kind.unit}")
        )
        possible = _ends(kind.lowest / size, kind.highest / size)
        why = f"{key} = {value / size:g}{unit}: possible is {possible}{unit} ({kind.why})"
        raise BadInput(why, key="" if " " in key else key)  # with words it is made of several


def _doubt(key: str, value: float, kind: Usual) -> Doubt:
    unit = "" if kind.unit == "-" else f" {kind.unit}"
    return Doubt(code=kind.code, quantity=key, value=value, usual=f"{_ends(kind.low, kind.high)}{unit}", why=kind.why)


def _ends(low: float, high: float) -> str:
    return " and ".join([f"at least {low:g}"] * math.isfinite(low) + [f"at most {high:g}"] * math.isfinite(high))


_RACING, _LARGE = 33.0, 12.5  # fastest mean piston speed of small engines, and of those of half a metre [m/s]
_SMALL = 0.1  # stroke up to which engines race [m]
_LONG = 2.0  # stroke by bore from which a piston has a rod and a crosshead [-]
_GUIDED = 5e4  # what moves with such a piston, by its area and bore [kg/m^3]


def proportions(
    stroke: Metre | None, ratio: Pure | None, omega: RadPerSecond | None, fired: bool = True
) -> tuple[Doubt, ...]:
    """Mean piston speed and rod ratio of an engine.

    stroke: travel of the piston between its dead centres; None where it is not known. ratio: rod length over crank
    radius; None without a rod. omega: speed of operation. fired: whether fuel burns in it; compressors and Stirling
    engines are slower. Returns doubts: `piston_speed`, `process_speed`, `slow_piston`, `rod_ratio` outside 1.8 to 8.
    Raises BadInput: a mean piston speed above 100 m/s.
    Source: Heywood (1988), Internal combustion engine fundamentals, sections 2.2 and 2.6.

    >>> [f"{d.code} {d.value:.0f} m/s" for d in proportions(0.1, 3.5, 1100.0)]
    ['piston_speed 35 m/s']
    """
    doubts: tuple[Doubt, ...] = ()
    if stroke is not None and omega is not None:
        what = f"mean piston speed (operation.speed = {omega:g} rad/s, stroke {stroke:g} m)"
        doubts += piston_speed(what, stroke, omega, fired)
        if fired and omega:
            doubts += proportion("slow_piston", what, stroke * abs(omega) / math.pi)
    if ratio is not None:
        doubts += proportion("rod_ratio", "rod length / crank radius", ratio)
    return doubts


def piston_speed(what: str, stroke: float, omega: float, fired: bool = True) -> tuple[Doubt, ...]:
    r"""Mean piston speed by the size and the kind of a machine.

    .. math:: c_m = S \omega / \pi \le 33\,\mathrm{m/s}\,\sqrt{0.1\,\mathrm{m}/S}, \text{ at least } 12.5

    stroke, omega: travel of the piston and speed [m, rad/s]. Raises BadInput: more than 100 m/s.
    Source: data sheets: Formula 1, stroke 40 mm, 26 m/s; drag racers, 114 mm, 30.5; aircraft, 165 mm, 18; medium-speed
    diesels, 0.6 m, 10.3; slow ones, 3.5 m, 9.2 m/s.

    >>> [d.usual for d in piston_speed("speed", 0.4, 135.0)]
    ['at most 16.5 m/s']
    """
    mean = stroke * abs(omega) / math.pi
    if not fired:
        return proportion("process_speed", what, mean)
    return proportion("piston_speed", what, mean, max(_LARGE, _RACING * math.sqrt(min(1.0, _SMALL / stroke))))


def moving_mass(what: str, mass: float, area: float, bore: Metre, stroke: Metre) -> tuple[Doubt, ...]:
    r"""What moves to and fro with a piston, by the piston's area and bore.

    .. math:: \rho = m / (A B), \text{ at most 6000, of a long stroke with its crosshead 50,000 kg/m}^3

    mass, area: mass, and area of the pistons that drive it [kg, m^2]. Raises BadInput: a mass that no piston has.
    Source: masses of engines in Heywood (1988), chapter 2, and of slow marine engines with crosshead.

    >>> [f"{d.code} {d.value:.0f}" for d in moving_mass("parameters.m5", 2.5, 2.83e-3, 0.06, 0.052)]
    ['reciprocating_mass 14723']
    """
    high = _GUIDED if stroke > _LONG * bore else None
    return proportion("reciprocating_mass", f"{what} / (piston area * bore)", mass / (area * bore), high)
