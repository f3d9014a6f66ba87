r"""Springs, dampers and motors by their laws: what stores energy is told by it, the rest by its force.

    m.gas_spring("g", x, pressure="8 bar", area="3 cm^2", length="120 mm")      closes by x
    m.belleville("b", x, outer="50 mm", inner="25.4 mm", height="1.4 mm", thickness="1.5 mm")
    m.table_spring("s", x, file="spring.csv")       m.table_damper("d", x, file="damper.csv")
    m.motor("E", phi, k="0.1 N*m/A", R="2 ohm", U="24 V", J="1e-4 kg*m^2")     or file="motor.csv"

A table of a spring goes through its rows by a natural cubic spline, one of speeds by monotone cubics; both go on
straight beyond their ends.
"""

import re
from collections.abc import Callable

import numpy as np
import scipy
from sympy import Expr, Integer, log, pi

from mechsym.derive.cams import Cams, lookup
from mechsym.derive.rates import velocity
from mechsym.derive.refuse import file_of_declaration, refuse
from mechsym.errors import BadInput
from mechsym.files.inputs import sources
from mechsym.files.tables import columns_of
from mechsym.periodic.pieces import PPoly

#: Units of what a motor is bought by, in N*m/A, ohm and V
_ELECTRIC = {"k": {"N*m/A": 1.0, "mN*m/A": 1e-3, "V*s/rad": 1.0, "V*s": 1.0}, "R": {"ohm": 1.0, "mohm": 1e-3},
             "U": {"V": 1.0, "mV": 1e-3, "kV": 1e3}}  # fmt: skip
_NUMBER = re.compile(r"\s*([-+]?[\d.]+(?:[eE][-+]?\d+)?)\s*(.*?)\s*$")


class Elements(Cams):
    """The part of a declaration that knows laws of springs, dampers and motors."""

    damper: Callable[..., None]  # see `Declaration`
    body: Callable[..., None]
    stores: list[Expr]

    def gas_spring(
        self, name: str, closes: Expr, *, pressure: object, area: object, length: object, exponent: object = "1.4",
        ambient: object = 0,
    ) -> None:  # fmt: skip
        r"""A gas that a displacement closes [m], from its free length [m] and absolute pressure [Pa] on, by a piston of
        an area [m^2] against an ambient pressure [Pa]: :math:`F = A\,(p\,(L/(L - x))^n - p_a)`."""
        x = self._length(closes, name)
        A, L = (
            self._above(area, "m^2", f"{name}_area", f"area of {name}"),
            self._above(length, "m", f"{name}_length", f"length of {name}"),
        )
        p = self._above(pressure, "Pa", f"{name}_pressure", f"pressure of {name}")
        n = self._above(exponent, "-", f"{name}_exponent", f"exponent of {name}")
        outside = self._sized(ambient, "Pa", f"{name}_ambient", f"ambient pressure of {name}")
        if n == 1:
            refuse(f"the exponent of {name} = 1 has no power law; write 1.0001, or 1.4 for quick strokes of air")
        self.stores.append(p * A * L / (n - 1) * ((1 - x / L) ** (1 - n) - 1) - outside * A * x)

    def belleville(
        self, name: str, along: Expr, *, outer: object, inner: object, height: object, thickness: object,
        E: object = "206 GPa", nu: object = "0.3",
    ) -> None:  # fmt: skip
        r"""A disc spring by its diameters, the height of its cone and its thickness [m], after Almen and Laszlo (1936):
        :math:`F = \frac{4E}{1-\nu^2}\frac{t^4}{K_1 D^2}\,\xi\,((\eta-\xi)(\eta-\xi/2)+1)`, with the deflection
        :math:`\xi` and the height :math:`\eta` in thicknesses."""
        s = self._length(along, name)
        D, d, h, t = (
            self._above(value, "m", f"{name}_{key}", f"{key} of {name}")
            for key, value in (("outer", outer), ("inner", inner), ("height", height), ("thickness", thickness))
        )
        known = {letter: size[2] for letter, size in self.sizes.items()}
        if (D - d).free_symbols <= known.keys() and not float((D - d).subs(known)) > 0:
            refuse(f"the disc spring {name}: inner is not below outer; exchange them")
        self.require(D, above=d, unit="m", what=f"outer diameter of {name}", way="it lies within the inner one")
        modulus = self._above(E, "Pa", f"{name}_E", f"E of {name}")
        ratio = self._sized(nu, "-", f"{name}_nu", f"nu of {name}")
        share = D / d
        K1 = ((share - 1) / share) ** 2 / ((share + 1) / (share - 1) - 2 / log(share)) / pi
        scale = 4 * modulus / (1 - ratio**2) * t**4 / (K1 * D**2)
        x, high = s / t, h / t
        self.stores.append(scale * t * (high**2 * x**2 / 2 - high * x**3 / 2 + x**4 / 8 + x**2 / 2))

    def table_spring(self, name: str, stretch: Expr, *, file: str) -> None:
        """A spring by a file beside the declaration: columns stretch [m] or [rad] and force [N] or [N*m] against it."""
        kind = self._moves(stretch, "spring")
        x, y = self._columns(name, file, ("stretch", kind), ("force", "N" if kind == "m" else "N*m"))
        force = scipy.interpolate.CubicSpline(x, y, bc_type="natural")
        self.stores.append(self._piecewise(name, self._checked(stretch, "", name), _straight(force), stored=True))

    def table_damper(self, name: str, stretch: Expr, *, file: str) -> None:
        """A damper by a file beside the declaration: columns speed [m/s] or [rad/s] and force [N] or [N*m]
        against it."""
        kind = self._moves(stretch, "damper")
        x, y = self._columns(name, file, ("speed", f"{kind}/s"), ("force", "N" if kind == "m" else "N*m"))
        rate = velocity(self, stretch)
        self.force(-self._piecewise(name, rate, _straight(scipy.interpolate.PchipInterpolator(x, y))), along=stretch)

    def motor(
        self, name: str, angle: Expr, *, k: object = None, R: object = None, U: object = None, J: object = 0,
        file: str = "",
    ) -> None:  # fmt: skip
        r"""A motor on an angle [rad]: of direct current, by the constant k [N*m/A], the resistance R [ohm] and the
        voltage U [V], :math:`M = k\,(U - k\,\omega)/R`; or a file with the columns speed [rpm] and torque [N*m]. J is
        the inertia of its rotor [kg*m^2]."""
        turned = self._moving_angle(angle, name)
        if (file == "") != all(value is not None for value in (k, R, U)):
            refuse(
                f"the motor {name!r} needs k and R, or a file: k, R and the voltage U of direct current, or file='..'"
            )
        if file:
            x, y = self._columns(name, file, ("speed", "rad/s"), ("torque", "N*m"))
            curve = _straight(scipy.interpolate.PchipInterpolator(x, y))
            self.force(self._piecewise(name, velocity(self, turned), curve), along=turned)
        else:
            constant, resistance, voltage = (_electric(name, key, v) for key, v in (("k", k), ("R", R), ("U", U)))
            if resistance <= 0:
                refuse(f"R of the motor {name} = {resistance:g} ohm must be above 0")
            stall = self._sized(constant * voltage / resistance, "N*m", f"{name}_stall", f"stall torque of {name}")
            drag = self._sized(constant**2 / resistance, "N*m*s/rad", f"{name}_drag", f"drag of {name}")
            self.force(stall, along=turned)
            self.damper(drag, stretch=turned)
        if J != 0:
            self.body(name, turns=turned, inertia=J)

    def _length(self, along: object, name: str) -> Expr:
        if self._moves(along, "spring") != "m":
            refuse(f"the spring {name!r} is along {along}, which is an angle; it must be in m")
        return self._checked(along, "m", name)

    def _columns(self, name: str, file: str, *wanted: tuple[str, str]) -> tuple[np.ndarray, np.ndarray]:
        source = file_of_declaration()
        path = source.parent / file
        try:
            columns, lines = columns_of(str(path), dict(wanted), f"is none of {name}")
        except BadInput as error:
            refuse(str(error))
        if path not in sources(source):
            refuse(f"the file {file!r} of {name!r} must stand in the declaration as a text in quotes")
        if missing := [key for key, _ in wanted if key not in columns]:
            refuse(f"{path}: no column {missing[0]}; it has {wanted[0][0]} and {wanted[1][0]}, with units in brackets")
        x, y = (columns[key] for key, _ in wanted)
        bad = np.flatnonzero(np.diff(x) <= 0)
        if bad.size or len(x) < 2:
            at = lines[int(bad[0]) + 1] if bad.size else lines[-1]
            refuse(f"{path}, line {at}: {wanted[0][0]} must rise row by row, and there must be two rows; mend the file")
        return x, y

    def _piecewise(self, name: str, at: Expr, curve: PPoly, stored: bool = False) -> Expr:
        """Polynomials between breaks, the first below the second of them; or their integral from 0 on."""
        if stored:
            curve = curve.antiderivative()
            curve.c[-1] -= curve(0.0)
        breaks = curve.x[1:-1]
        place = self.let(f"reach_{name}", at)
        left = self.let(f"beyond_{name}", place - lookup(f"row_{name}", breaks, curve.x[:-1], place))
        value: Expr = Integer(0)
        for power, row in zip(range(len(curve.c) - 1, -1, -1), curve.c, strict=True):
            value = value * left + lookup(f"c{power}_{name}", breaks, row, place)
        return value


def _straight(curve: PPoly) -> PPoly:
    """The same, gone on straight beyond its ends."""
    (a, b), far = curve.x[[0, -1]], 1.0
    ends = [
        np.array([*[0.0] * (len(curve.c) - 2), curve(at, 1), curve(at) - shift * curve(at, 1)])
        for at, shift in ((a, far), (b, 0.0))
    ]
    c = np.column_stack([ends[0], curve.c, ends[1]])
    return PPoly(c, np.array([a - far, *curve.x, b + far]))


def _electric(name: str, key: str, value: object) -> float:
    """A number in N*m/A, ohm or V."""
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        return float(value)
    match = _NUMBER.match(value) if isinstance(value, str) else None
    units = _ELECTRIC[key]
    if match is None or match[2] not in units:
        refuse(f"{key} of the motor {name} = {value!r} is no number in {', '.join(units)}")
    return float(match[1]) * units[match[2]]
