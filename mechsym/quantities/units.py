"""Units: as types, so that a signature says them, and at the border, where texts become SI.

    def hertz(N: Newton, length: Metre) -> Pascal: ...                              # floats
    def reaction(force: Newton[Scalar], rho: Metre[Array]) -> Newton[Scalar]: ...   # what is in brackets has the unit

A rarer unit is written out, `Annotated[float, "W/(m*K)"]`. The unit of an `Array` is that of each element, and an array
of which no word says the shape is (n,), a value for each angle or time of the others.

Inside the package every number is SI, angles in radians. A case file or an option may write `"142 rpm"` or `"5 MPa"`;
`parse` turns that into SI and refuses a wrong dimension.
"""

import functools
import math
import re
from typing import TYPE_CHECKING, Annotated, Any, TypeAlias

from mechsym.errors import BadInput, shown
from mechsym.quantities.by_name import lazily

if TYPE_CHECKING:
    import numpy as np
    from typing_extensions import TypeVar

    V = TypeVar("V", default=float)
    Array: TypeAlias = np.ndarray
else:
    from typing import TypeVar

    V = TypeVar("V")
    __getattr__ = lazily(__name__, {"Array": "numpy:ndarray"})  # `--help` waits for no numpy
Scalar: TypeAlias = Any  #: What a formula takes: a float, an array, or a symbol of CasADi, which has no types

Pure = Annotated[V, "-"]  #: A pure number
Radian = Annotated[V, "rad"]
Metre = Annotated[V, "m"]
Area = Annotated[V, "m^2"]
Volume = Annotated[V, "m^3"]
Second = Annotated[V, "s"]
Kelvin = Annotated[V, "K"]
Kilogram = Annotated[V, "kg"]
KilogramMetre = Annotated[V, "kg*m"]
Inertia = Annotated[V, "kg*m^2"]
Newton = Annotated[V, "N"]
NewtonMetre = Annotated[V, "N*m"]
Pascal = Annotated[V, "Pa"]
Joule = Annotated[V, "J"]
Watt = Annotated[V, "W"]
RadPerSecond = Annotated[V, "rad/s"]
MetrePerSecond = Annotated[V, "m/s"]
MetrePerRadian = Annotated[V, "m/rad"]
MetrePerRadian2 = Annotated[V, "m/rad^2"]
Viscosity = Annotated[V, "Pa*s"]
MassFlow = Annotated[V, "kg/s"]

# unit: (factor to SI, exponents of kg, m, s, K, rad). Angles carry a dimension of their own so that
# "5 m" is refused where radians are wanted, and "50 Hz" where rad/s are: nobody says whether of turns or of radians.
_BASE: dict[str, tuple[float, tuple[int, ...]]] = {
    "kg": (1.0, (1, 0, 0, 0, 0)), "g": (1e-3, (1, 0, 0, 0, 0)), "t": (1e3, (1, 0, 0, 0, 0)),
    "m": (1.0, (0, 1, 0, 0, 0)), "mm": (1e-3, (0, 1, 0, 0, 0)), "cm": (1e-2, (0, 1, 0, 0, 0)),
    "um": (1e-6, (0, 1, 0, 0, 0)), "km": (1e3, (0, 1, 0, 0, 0)), "L": (1e-3, (0, 3, 0, 0, 0)),
    "s": (1.0, (0, 0, 1, 0, 0)), "ms": (1e-3, (0, 0, 1, 0, 0)), "us": (1e-6, (0, 0, 1, 0, 0)),
    "min": (60.0, (0, 0, 1, 0, 0)), "h": (3600.0, (0, 0, 1, 0, 0)),
    "K": (1.0, (0, 0, 0, 1, 0)),
    "rad": (1.0, (0, 0, 0, 0, 1)), "deg": (math.pi / 180, (0, 0, 0, 0, 1)),
    "rpm": (2 * math.pi / 60, (0, 0, -1, 0, 1)), "rev": (2 * math.pi, (0, 0, 0, 0, 1)),
    "rps": (2 * math.pi, (0, 0, -1, 0, 1)),
    "Hz": (1.0, (0, 0, -1, 0, 0)),
    "N": (1.0, (1, 1, -2, 0, 0)), "kN": (1e3, (1, 1, -2, 0, 0)), "MN": (1e6, (1, 1, -2, 0, 0)),
    "Pa": (1.0, (1, -1, -2, 0, 0)), "kPa": (1e3, (1, -1, -2, 0, 0)), "MPa": (1e6, (1, -1, -2, 0, 0)),
    "GPa": (1e9, (1, -1, -2, 0, 0)), "bar": (1e5, (1, -1, -2, 0, 0)),
    "J": (1.0, (1, 2, -2, 0, 0)), "kJ": (1e3, (1, 2, -2, 0, 0)), "MJ": (1e6, (1, 2, -2, 0, 0)),
    "W": (1.0, (1, 2, -3, 0, 0)), "kW": (1e3, (1, 2, -3, 0, 0)), "MW": (1e6, (1, 2, -3, 0, 0)),
    "%": (1e-2, (0, 0, 0, 0, 0)),
    "inch": (0.0254, (0, 1, 0, 0, 0)), "in": (0.0254, (0, 1, 0, 0, 0)), "ft": (0.3048, (0, 1, 0, 0, 0)),
    "lb": (0.45359237, (1, 0, 0, 0, 0)),
    "lbf": (4.4482216152605, (1, 1, -2, 0, 0)), "kgf": (9.80665, (1, 1, -2, 0, 0)),
    "psi": (6894.757293168361, (1, -1, -2, 0, 0)), "hp": (745.6998715822702, (1, 2, -3, 0, 0)),
    "PS": (735.49875, (1, 2, -3, 0, 0)),
}  # fmt: skip
# as people type them
_SIGNS = str.maketrans(
    {"µ": "u", "μ": "u", "·": "*", "⋅": "*", "×": "*", "°": "deg", "²": "^2", "³": "^3", "⁴": "^4", "¹": "1", "⁻": "^-"}
)
_CELSIUS, _ZERO_CELSIUS = ("degC", "Celsius"), 273.15
_GAUGE = ("barg", "bar(g)", "psig", "atu", "atü")
RPM = _BASE["rpm"][0]  #: One revolution a minute [rad/s]
#: Half width of the 95 % interval of a normal distribution, in standard deviations [-]
NORMAL_95 = 1.959963984540054
_NUMBER = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(.*?)\s*$")
_FACTOR = re.compile(r"([A-Za-z%]+)(?:\^?(-?\d))?$")
# no length, mass or pressure of a machine lies outside; inside, squares and products of several stay far from overflow
_SMALLEST, _LARGEST = 1e-20, 1e20


def units() -> list[str]:
    """The units that texts may use, besides products and quotients of them."""
    return sorted(_BASE)


@functools.lru_cache(maxsize=256)
def _unit(text: str) -> tuple[float, tuple[int, ...]]:
    factor, dims = 1.0, [0] * 5
    sign = 1
    text = text.translate(_SIGNS).replace("^-^", "^-").replace("^-1", "^-1")
    known = f"{', '.join(units())} and their products like kg*m^2"
    unknown = BadInput(f"unit {shown(text)} is not known; units are {known}")
    for part in re.split(r"([*/ ])", text.strip().replace("**", "^")):
        if part in ("*", " ", "", "-", "1"):
            continue
        if part == "/":
            sign = -1
            continue
        match = _FACTOR.match(part)
        if match is None or match[1] not in _BASE:
            raise unknown
        power = int(match[2] or 1) * sign
        scale, exponents = _BASE[match[1]]
        factor *= scale**power
        dims = [d + e * power for d, e in zip(dims, exponents, strict=True)]
        sign = 1
    if sign < 0:
        raise unknown
    return factor, tuple(dims)


def scale(unit: str) -> float:
    """How many SI units one of a unit is [-].

    >>> scale("bar")
    100000.0
    """
    return _unit(unit)[0]


def exponents(unit: str) -> tuple[int, ...]:
    """Exponents of kg, m, s, K and rad in a unit.

    >>> exponents("rpm")
    (0, 0, -1, 0, 1)
    """
    return _unit(unit)[1]


def dimension(unit: str) -> tuple[int, ...]:
    """Exponents of kg, m, s and K in a unit; angles are pure numbers.

    unit: product of units, `"-"` for a pure number.

    >>> dimension("N*m")
    (1, 2, -2, 0)
    """
    return _unit(unit)[1][:4]


def parse(value: object, unit: str, key: str = "value") -> float:
    """A number in SI [unit] from a number or a text with a unit.

    value: a plain number is taken as SI, a text may end in a unit; unit: the SI unit wanted, `"-"` for a pure number;
    key: name of the value, for the message. Raises BadInput: not a number, not of magnitude 1e-20 to 1e20 (or 0),
    unknown unit, or a unit of another dimension.

    >>> round(parse("142 rpm", "rad/s"), 6)
    14.870205
    """
    wanted = f"a number in {unit}" if unit != "-" else "a pure number"
    if isinstance(value, bool) or not isinstance(value, (int, float, str)):
        raise BadInput(f"{key} = {shown(value)} is not {wanted}")
    if isinstance(value, str):
        match = _NUMBER.match(value)
        if match is None:
            example = "1.5" if unit == "-" else f'1.5 or "1.5 {unit}"'
            raise BadInput(f"{key} = {shown(value)} is not {wanted}; write for example {example}")
        number = float(match[1])
        if match[2].translate(_SIGNS).replace(" ", "") in _CELSIUS:
            if unit != "K":
                why = f"degC is for temperatures only, and not in products; give it in {unit}"
                raise BadInput(f"{key} = {shown(value)}: {why}")
            number += _ZERO_CELSIUS
        elif match[2]:
            number *= _scale(value, match[2], unit, key)
    else:
        # a whole number may be too large for a float
        number = float(value) if abs(value) <= _LARGEST else math.inf
    if not (number == 0 or _SMALLEST <= abs(number) <= _LARGEST):
        size = f"0 or of magnitude {_SMALLEST:g} to {_LARGEST:g}"
        raise BadInput(f"{key} = {shown(value)} is beyond any machine; give {wanted}, {size}")
    return number


def _scale(value: str, text: str, unit: str, key: str) -> float:
    if text.replace(" ", "") in _GAUGE:
        raise BadInput(
            f"{key} = {shown(value)}: a gauge pressure; give the absolute pressure, 1.01325 bar or 14.696 psi more, "
            "or plain bar or psi where the key asks for an excess pressure"
        )
    try:
        factor, dims = _unit(text)
    except BadInput as error:
        raise BadInput(f"{key} = {shown(value)}: {error}") from None
    wanted = _unit(unit)[1]
    # a torque per angle is written N*m/rad or N*m: the radian counts only where it stands alone or per second
    angular = wanted[:4] in ((0, 0, 0, 0), (0, 0, -1, 0))
    if not (dims == wanted if angular else dims[:4] == wanted[:4]):
        way_out = f"{unit} or a multiple of that unit"
        if wanted == (0, 0, -1, 0, 1) and dims == (0, 0, -1, 0, 0):
            way_out = "rps, turns a second, in rpm, or in rad/s"
        raise BadInput(f"{key} = {shown(value)} has the wrong dimension; give it in {way_out}")
    return factor
