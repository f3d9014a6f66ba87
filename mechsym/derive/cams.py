r"""Cams: a profile turns, a follower is lifted by it and pressed against it by the reaction of its contact.

    cam = m.cam("cam", turns=phi, profile="cycloid", lift=h, rise="90 deg", fall="90 deg", base=r, follower="flat")
    m.body("valve", mass=m1, at=(0, cam.lift))

The lift s over the cam's angle :math:`\theta` is away from the cam, which turns from x to y; it is told with the angle
of pressure and the curvature of the cam, from the path of the follower's centre C(s) seen by the cam,

.. math:: P = R(-\theta)\,C,\qquad V = C' - J C,\qquad A = C'' - 2 J C' - C,\qquad \kappa = -V \times A/|V|^3

or, of a flat face, from the distance p of its line in the direction :math:`\chi`, the radius :math:`p + d^2p/d\chi^2`.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy
import sympy
from sympy import Abs, Expr, Integer, Mod, Piecewise, Rational, Symbol, acos, asin, atan2, cos, pi, sin, sqrt

from mechsym.derive.drawing import DrawnCam
from mechsym.derive.linkage import Pair
from mechsym.derive.printer import Lookup
from mechsym.derive.rates import output, output_dynamic
from mechsym.derive.refuse import file_of_declaration, refuse
from mechsym.derive.unilateral import Unilateral
from mechsym.errors import BadInput, suggest
from mechsym.files.inputs import sources
from mechsym.files.tables import columns_of
from mechsym.periodic.rises import RISES

_FOLLOWERS = ("knife", "flat", "roller")
_TURN = 2 * pi
_DEGREE = 5
_MOST = 1000  # rows of a profile: each costs about ten operations a step
_UNEVEN = 1e-9  # of a turn: a last row so near to it repeats the first


def lookup(name: str, breaks: np.ndarray, values: np.ndarray, at: Expr) -> Expr:
    """A table as a function of sympy, told by its name where it is shown.

    breaks: ascending [rad]; values: below the first break and behind each [unit of the table].
    """
    kind = type(name, (Lookup,), {"breaks": tuple(map(float, breaks)), "values": tuple(map(float, values)), "nargs": 1})
    return kind(at)


@dataclass(frozen=True, kw_only=True)
class Cam:
    """A cam as a declaration goes on with it: `lift` is where its follower is, an expression [m or rad]."""

    name: str
    lift: Expr


@dataclass(frozen=True, kw_only=True)
class _Follower:
    """How a follower moves with its lift."""

    place: Pair  # its contact, of a flat face, else its centre [m]
    lines: Callable[[Expr], tuple[tuple[Pair, ...], ...]]  # that draw it, at a gap, from its roller on [m]
    curvature: Expr  # of the cam [1/m]
    pressure_angle: Expr  # between the normal and the way of the follower [rad]
    lever: Expr  # of the normal force on the lift [-] or [m]


class Cams(Unilateral):
    """The part of a declaration that knows cams."""

    cams_drawn: list[DrawnCam]  # see `Drawing`

    def cam(
        self, name: str, *, turns: Expr | float, profile: object, base: object = None, follower: str = "roller",
        lift: object = None, rise: object = None, dwell: object = 0, fall: object = None, phase: object = 0,
        roller: object = None, offset: object = 0, arm: object = None, centres: object = None, face: object = 0,
        restitution: object = None,
    ) -> Cam:  # fmt: skip
        """A cam, and the contact with its follower; hang the follower's bodies and springs on the `lift` of what it
        gives.

        turns: its angle, positive from x to y [rad]. profile: a CSV file beside the declaration with the columns angle
        and lift over one turn, joined by a periodic spline of degree 5; or a law of `rise`, `dwell` and `fall` [rad] by
        `lift` [m or rad]: harmonic, cycloid, 3-4-5, 4-5-6-7, modified sine. phase: where the rise begins [rad]. base:
        radius of its base circle [m]. follower: knife, flat or roller, of radius `roller` [m]. It moves along y above
        the cam's centre, `offset` to the side [m]; or swings by `arm` [m] about a pivot at the distance `centres` along
        x, a flat one with its face `face` above the pivot [m]: its lift is an angle then. restitution: lets the
        follower fly, with events in runs and a coordinate of its own, `gap_` and the cam's name; without it the contact
        holds, and `force_` and its name tells by the sign when it could not.
        """
        self._usable(name)
        swings = self._kind_of(name, follower, roller, offset, arm, centres, face)
        unit = "rad" if swings else "m"
        turned = self._moving_angle(turns, name)
        start = self._sized(phase, "rad", f"{name}_phase", f"phase of {name}")
        angle = self.let(f"angle_{name}", Mod(turned - start, _TURN), "rad")
        self.tape.follow(angle, lambda v: self.tape.diff(turned, v))
        s, slope, bend = self._profile(name, angle, profile, unit, (lift, rise, dwell, fall))
        radii = self._radius(name, "base", base), self._radius(name, "roller", roller) if roller is not None else 0
        if follower == "flat":
            seen = self._flat(name, radii[0], (s, slope, bend), (centres, face) if swings else None)
        else:
            seen = self._pointed(name, radii, (s, slope, bend), (arm, centres) if swings else offset)
        for what, value, of in (
            ("pressure_angle", seen.pressure_angle, "rad"), ("curvature", seen.curvature, "1/m")
        ):  # fmt: skip
            output(self, self.let(f"{what}_{name}", value, of))
        output(self, s, order=2)
        facts: dict[str, object] = {"lift": s.name, "angle": angle.name, "flat": follower == "flat"}
        if radii[1] != 0:
            facts["roller"] = self._size_of(radii[1], "m", f"roller of {name}")
        if restitution is not None:
            gap = self.coordinates(self.free_name(f"gap_{name}"), unit)
            self._stop(name, gap, unit, restitution, None, None)
            self.cams_drawn.append(DrawnCam(*radii, turned, seen.place, seen.lines(gap)))
            self._role("cam", name=name, **facts)
            return Cam(name=name, lift=s + gap)
        self.cams_drawn.append(DrawnCam(*radii, turned, seen.place, seen.lines(Integer(0))))
        thrust = self.free_name(f"thrust_{name}")
        gap = self.joints(self.free_name(f"sn_{name}"), f"{name} on its follower", "N*m" if swings else "N", thrust)
        output_dynamic(self, f"force_{name}", self.reaction_of[gap] / seen.lever, "N")
        self._role("cam", name=name, force=f"force_{name}", **facts)
        return Cam(name=name, lift=s + gap)

    def _kind_of(self, name: str, follower: object, roller: object, offset: object, arm: object, centres: object,
                 face: object) -> bool:  # fmt: skip
        """Whether the follower swings; what does not belong to its kind is refused."""
        if follower not in _FOLLOWERS:
            refuse(f"follower = {follower!r} of the cam {name!r} is not known; there are {', '.join(_FOLLOWERS)}")
        if (follower == "roller") != (roller is not None):
            has = "needs the radius of its roller; give roller=.." if roller is None else "has no roller; leave it out"
            refuse(f"the {follower} follower of the cam {name!r} {has}")
        swings = centres is not None
        if follower == "flat" and (offset != 0 or arm is not None):
            refuse(
                f"the flat follower of the cam {name!r} has no offset and no arm; one that swings takes centres, face"
            )
        if follower != "flat" and (swings != (arm is not None) or face != 0):
            refuse(f"the {follower} follower of the cam {name!r} swings by arm and centres, both, and has no face")
        if swings and offset != 0 or not swings and face != 0:
            refuse(f"the cam {name!r} takes an offset where its follower slides, a face where it swings; leave one out")
        return swings

    def _moving_angle(self, turns: object, name: str) -> Expr:
        angle = self._checked(turns, "rad", f"turn of the cam {name}")
        if not angle.free_symbols & {*self.tape.variables, *self.tape.entries}:
            refuse(f"the cam {name!r} turns by {turns}, which moves with no coordinate; give turns=phi, or phi / 2")
        return angle

    def _radius(self, name: str, key: str, value: object) -> Expr:
        if value is None:
            refuse(f"the cam {name!r} needs the radius of its {key} circle; give {key}=..")
        return self._above(value, "m", f"{name}_{key}", f"{key} of the cam {name}")

    def _above(self, value: object, unit: str, name: str, what: str) -> Expr:
        size = self._constant(value, unit, name, what)
        if size == 0 or self.sizes.get(size, ("", "", 1.0))[2] == 0:
            refuse(f"{what} = {value} must be above 0")
        return size

    def _needs(self, value: Expr, above: Expr, unit: str, what: str, way: str) -> None:
        """Refuse numbers for which a size is not above another: here where all are known, else those of a case."""
        known = {letter: of[2] for letter, of in self.sizes.items()}
        if (value - above).free_symbols <= known.keys() and not float((value - above).subs(known)) > 0:
            refuse(f"{what}: {way}")
        self.require(value, above=above, unit=unit, what=what, way=way)

    def _profile(
        self, name: str, angle: Symbol, profile: object, unit: str, words: tuple[object, ...]
    ) -> tuple[Symbol, Symbol, Symbol]:
        """Lift, and its derivatives by the cam's angle, as names that know each other."""
        if not isinstance(profile, str):
            refuse(
                f"profile = {profile} of the cam {name!r} is neither a law nor a CSV file; there are {', '.join(RISES)}"
            )
        by = angle
        if profile.lower().endswith(".csv"):
            if any(w is not None and w != 0 for w in words):
                refuse(f"the cam {name!r} has its lift from {profile}; leave lift, rise, dwell and fall out")
            value, by = self._tabled(name, angle, profile, unit)
        elif profile in RISES:
            value = self._worded(name, angle, profile, unit, words)
        else:
            refuse(
                f"profile = {profile!r} of the cam {name!r} is no law; {suggest(profile, list(RISES))}, or name a .csv"
            )
        first = value.diff(by)
        s = self.let(f"lift_{name}", value, unit)
        slope = self.let(f"slope_{name}", first, f"{unit}/rad")
        bend = self.let(f"bend_{name}", first.diff(by), f"{unit}/rad^2")
        self.tape.follow(s, lambda v: slope * self.tape.derivative(angle, v))
        self.tape.follow(slope, lambda v: bend * self.tape.derivative(angle, v))
        return s, slope, bend

    def _worded(self, name: str, angle: Symbol, law: str, unit: str, words: tuple[object, ...]) -> Expr:
        """Rise, dwell, fall and rest by a law."""
        lift, rise, dwell, fall = words
        if lift is None or rise is None or fall is None:
            refuse(f"the cam {name!r} needs lift, rise and fall beside profile = {law!r}; give all three")
        h = self._above(lift, unit, f"{name}_lift", f"lift of the cam {name}")
        up = self._above(rise, "rad", f"{name}_rise", f"rise of the cam {name}")
        down = self._above(fall, "rad", f"{name}_fall", f"fall of the cam {name}")
        top = self._constant(dwell, "rad", f"{name}_dwell", f"dwell of the cam {name}")
        whole = up + top + down
        turn, what = _TURN * (1 + Rational(1, 10**9)), f"rise, dwell and fall of the cam {name}"
        self._needs(turn, whole, "rad", what, "together they are more than a turn: shorten them")
        pieces = [(h * share, when) for share, when in _pieces(law, angle / up)]
        if top != 0:
            pieces.append((h, angle < up + top))
        # each law is the same from its end as from its beginning
        pieces += [(h * (1 - share), when) for share, when in _pieces(law, (angle - up - top) / down)]
        return Piecewise(*pieces, (Integer(0), True))

    def _tabled(self, name: str, angle: Symbol, profile: str, unit: str) -> tuple[Expr, Symbol]:
        """A periodic spline of degree 5 through the rows of a file, and the angle from the last row on that it is of:
        polynomials whose coefficients are looked up."""
        source = file_of_declaration()
        file = source.parent / profile
        if file.is_file() and file not in sources(source):
            refuse(f"the file {profile!r} of the cam {name!r} must stand in the declaration as a text in quotes")
        try:
            knots, values = _rows(str(file), unit)
        except BadInput as error:
            refuse(str(error))
        curve = scipy.interpolate.make_interp_spline(knots, values, k=5, bc_type="periodic")
        starts = np.sort(knots[:-1] % (2 * np.pi))
        after = knots[:-1][np.argsort(knots[:-1] % (2 * np.pi))]
        # before the first row the last piece goes on
        rows = lookup(f"row_{name}", starts, np.array([starts[-1] - 2 * np.pi, *starts]), angle)
        local = self.let(f"beyond_row_{name}", angle - rows, "rad")
        value: Expr = Integer(0)
        for power in range(_DEGREE, -1, -1):
            of_rows = curve(after, nu=power) / math.factorial(power)
            coefficient = lookup(f"c{power}_{name}", starts, np.array([of_rows[-1], *of_rows]), angle)
            value = value * local + self.let(f"coefficient{power}_{name}", coefficient, unit)
        return value, local

    def _pointed(
        self, name: str, radii: tuple[Expr, Expr], motion: tuple[Symbol, Symbol, Symbol], way: object
    ) -> _Follower:
        """A knife or a roller: its centre runs along y beside the cam's centre, or swings about a pivot on x."""
        (base, roller), (s, slope, bend) = radii, motion
        pitch = base + roller
        if isinstance(way, tuple):
            arm = self._above(way[0], "m", f"{name}_arm", f"arm of the cam {name}")
            apart = self._above(way[1], "m", f"{name}_centres", f"centres of the cam {name}")
            for value, above, what in (
                (arm + pitch, apart, "they do not reach down to"),
                (apart + pitch, arm, "the arm reaches beyond"),
                (apart + arm, pitch, "they lie within"),
            ):
                self._needs(
                    value, above, "m", f"arm and centres of the cam {name}", f"{what} its base circle; correct them"
                )
            low = acos((arm**2 + apart**2 - pitch**2) / (2 * arm * apart))
            angle = low + s
            C: Pair = apart - arm * cos(angle), arm * sin(angle)
            C_s: Pair = arm * sin(angle), arm * cos(angle)
            C_ss: Pair = arm * cos(angle), -arm * sin(angle)
        else:
            aside = self._sized(way, "m", f"{name}_offset", f"offset of the cam {name}")
            self._needs(pitch, Abs(aside), "m", f"offset of the cam {name}", "it lies beyond its base circle: lower it")
            C = aside, sqrt(pitch**2 - aside**2) + s
            C_s, C_ss = (Integer(0), Integer(1)), (Integer(0), Integer(0))
        d1 = tuple(c * slope for c in C_s)
        d2 = tuple(c * bend + cc * slope**2 for c, cc in zip(C_s, C_ss, strict=True))
        V = d1[0] + C[1], d1[1] - C[0]
        A = d2[0] + 2 * d1[1] - C[0], d2[1] - 2 * d1[0] - C[1]
        speed = self.let(f"path_{name}", sqrt(V[0] ** 2 + V[1] ** 2), "m")
        bent = self.let(f"pitch_curvature_{name}", (V[1] * A[0] - V[0] * A[1]) / speed**3, "1/m")
        along, across = V[0] * C_s[0] + V[1] * C_s[1], V[0] * C_s[1] - V[1] * C_s[0]

        def lines(gap: Expr) -> tuple[tuple[Pair, ...], ...]:
            if isinstance(way, tuple):
                return (((apart - arm * cos(angle + gap), arm * sin(angle + gap)), (apart, Integer(0))),)
            return (((C[0], C[1] + gap), (C[0], C[1] + gap + 2 * base)),)

        return _Follower(
            place=C,
            lines=lines,
            curvature=bent / (1 - roller * bent),
            pressure_angle=atan2(along, across),
            lever=across / speed,
        )

    def _flat(self, name: str, base: Expr, motion: tuple[Symbol, Symbol, Symbol], pivot: object) -> _Follower:
        """A flat face across the way of its follower, or one that swings about a pivot on x."""
        s, slope, bend = motion
        if not isinstance(pivot, tuple):
            zero, foot = Integer(0), base + s
            return _Follower(
                place=(slope, foot),
                lines=lambda gap: (
                    ((-base, foot + gap), (base, foot + gap)),
                    ((zero, foot + gap), (zero, foot + gap + 2 * base)),
                ),
                curvature=1 / (foot + bend),
                pressure_angle=Integer(0),
                lever=Integer(1),
            )
        apart = self._above(pivot[0], "m", f"{name}_centres", f"centres of the cam {name}")
        face = self._sized(pivot[1], "m", f"{name}_face", f"face of the cam {name}")
        self._needs(
            apart, Abs(base - face), "m", f"centres of the cam {name}", "the pivot lies in its base circle: raise them"
        )
        angle = asin((base - face) / apart) + s
        distance = apart * sin(angle) + face
        turned = 1 + slope
        radius = distance + apart * (cos(angle) * bend - sin(angle) * slope**2 * turned) / turned**3
        lever = apart * cos(angle) / turned
        away = lever * slope  # the contact, from the foot of the cam's centre on the face

        def lines(gap: Expr) -> tuple[tuple[Pair, ...], ...]:
            c, s = cos(angle + gap), sin(angle + gap)
            foot = apart + face * s, face * c  # of the pivot on the face
            end = foot[0] - (apart + base) * c, foot[1] + (apart + base) * s
            return (((apart, Integer(0)), foot, end),)

        return _Follower(
            place=(distance * sin(angle) + away * cos(angle), distance * cos(angle) - away * sin(angle)),
            lines=lines,
            curvature=1 / radius,
            pressure_angle=atan2(face, lever),
            lever=lever,
        )


def _pieces(law: str, x: Expr) -> list[tuple[Expr, Expr]]:
    """A rise from 0 to 1, piece by piece, with where each holds."""
    return [(share, x <= Rational(end, 8)) for share, end in RISES[law](x, sympy)]


def _rows(file: str, unit: str) -> tuple[np.ndarray, np.ndarray]:
    """Angles [rad] and lifts of a profile, the first row again a turn later."""
    columns, lines = columns_of(file, {"angle": "rad", "lift": unit}, "is no angle and no lift")
    if len(columns) < 2:
        raise BadInput(f"{file}: a profile has the columns angle [deg] and lift [mm]")
    angle, lift = columns["angle"], columns["lift"]
    bad = np.flatnonzero(np.diff(angle) <= 0)
    if bad.size:
        raise BadInput(f"{file}, line {lines[int(bad[0]) + 1]}: angle must rise row by row; mend the file")
    if not 7 <= len(angle) <= _MOST:
        raise BadInput(f"{file}: {len(angle)} rows; a profile has 7 to {_MOST}")
    span = (angle[-1] - angle[0]) / (2 * np.pi)
    closes = abs(span - 1) < _UNEVEN
    if span > 1 + _UNEVEN or closes and abs(lift[-1] - lift[0]) > 1e-6 * np.ptp(lift):
        raise BadInput(f"{file}: the profile does not close after a turn; let its last lift be its first")
    if closes:
        angle, lift = angle[:-1], lift[:-1]
    return np.append(angle, angle[0] + 2 * np.pi), np.append(lift, lift[0])
