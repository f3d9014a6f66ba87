r"""C files that integrate in lanes with steps that look back: x'' = f by a predictor and a corrector of high order.

.. math:: x_{n+1} = x_n + h v_n + h^2 \sum_j b_j f_{n-j}, \qquad v_{n+1} = v_n + h \sum_j a_j f_{n-j}

The polynomial through the last rates is integrated once and twice; with the rate at the predicted point it is made
again. Two evaluations a step, whatever the order. DOP853 starts a stretch, and goes on where one ends.
"""

import functools
from collections.abc import Collection
from fractions import Fraction

import casadi
import numpy as np

from mechsym.native import source
from mechsym.native.arc import Arcs, Form, arcs, form
from mechsym.native.integrators import dop853
from mechsym.native.kernels import constant_table
from mechsym.native.source import Program, header, program
from mechsym.quantities import record

BACK = 11  # rates that a step looks back at
STRIDES = 16  # steps between two looks at errors, ends, wanted times and levels
GROWTH = Fraction(5, 4)  # of a step
_MOST = 200  # inputs of the rates
# what the corrector leaves of the difference to the predictor, by Milne's device about 1/50
STRICT = 0.02

_Row = list[Fraction]


@record
class FormPrograms:
    """The programs of a form."""

    form: Form
    forces: Program
    works: Program


@record
class LookingBack:
    """What a batch of runs needs to look back."""

    parts: FormPrograms
    arcs: Arcs


def ready(rates: casadi.Function, held: np.ndarray, states: Collection[int], mode: str) -> LookingBack | None:
    """What runs need to look back, with surfaces of `states`. held: values [SI], shape (runs, segments, p)."""
    parts = _parts(rates.serialize(), mode)
    if parts is None or len(parts.works.tape.inputs) > _MOST:
        return None
    if not set(states) <= {*parts.form.angles, *parts.form.speeds}:
        return None
    series = arcs(parts.form, np.ascontiguousarray(held).tobytes(), held.shape)
    return None if series is None else LookingBack(parts=parts, arcs=series)


@functools.lru_cache(maxsize=256)
def _parts(stored: str, mode: str) -> FormPrograms | None:
    of = form(stored)
    if of is None:
        return None
    return FormPrograms(form=of, forces=program(of.forces, mode), works=program(of.works, mode))


def constants(of: Program, back: LookingBack) -> list[np.ndarray]:
    """Tables of constants, one a run: of the rates, of the programs of the form, of the series [SI]."""
    same = [constant_table(p.kernels) for p in (of, back.parts.forces, back.parts.works)]
    series, scale = back.arcs.series, back.arcs.scale
    runs = scale.shape[1]
    rows = [np.concatenate([s.reshape(-1, runs), c[None]]) for s, c in zip(series, scale, strict=True)]
    return [np.concatenate([*same, *(r[:, i] for r in rows)]) for i in range(runs)]


def text(rates: Program, lanes: int, back: LookingBack) -> str:
    """A file that exports `ms_adams`, see `c/run.h` for its argument."""
    return _text(rates, lanes, back.parts, (back.arcs.terms, back.arcs.even, back.arcs.turns))


@functools.lru_cache(maxsize=64)
def _text(rates: Program, lanes: int, parts: FormPrograms, terms: tuple[int, bool, bool]) -> str:
    of, before = parts.form, [len(constant_table(p.kernels)) for p in (rates, parts.forces, parts.works)]
    sizes = {
        "MS_A": len(of.angles), "MS_RO": len(of.read), "MS_UO": len(of.unread), "MS_TURNS": int(terms[2]),
        "MS_SERIES": sum(before), "MS_FORCES_AT": before[0], "MS_WORKS_AT": sum(before[:2]),
    }  # fmt: skip
    lists = {"ms_angle": of.angles, "ms_speed": of.speeds, "ms_other": (*of.read, *of.unread)}
    return "\n".join(
        [
            dop853(rates, lanes),
            *(_rows(p, lanes) for p in (parts.forces, parts.works)),
            f"#define MS_FORCES(k, x, y) {parts.forces.tape.name}_rows{lanes}(k, x, y)",
            f"#define MS_WORKS(k, x, y) {parts.works.tape.name}_rows{lanes}(k, x, y)",
            "enum { " + ", ".join(f"{name} = {value}" for name, value in sizes.items()) + " };",
            # C has no empty arrays
            *(f"static const long {k}[] = {{{', '.join(map(str, v or (0,)))}}};" for k, v in lists.items()),
            _bent(of, *terms[:2]),
            numbers(),
            header("adams.h"),
        ]
    )


def _rows(program: Program, lanes: int) -> str:
    name = program.tape.name
    if not program.tape.outputs:
        head = f"MS_INLINE void {name}_rows{lanes}(const double *k, const double *x, double *y)"
        return head + " { (void)k, (void)x, (void)y; }"
    return source.bodies(program.kernels, name) + "\n" + source.rows(program.kernels, name, lanes)


def _bent(of: Form, terms: int, even: bool) -> str:
    """The angles and slopes of all arc lengths as `ms_unbend`, and what turns a torque into a rate as `ms_bend`."""
    unbend, bend, place = [], [], 0
    for i, (q, u, inertia) in enumerate(zip(of.angles, of.speeds, of.inertia, strict=True)):
        if inertia is None:
            unbend.append(f"MS_EACH x[1 + {q}][l] = arc[{i}][l], x[1 + {u}][l] = speed[{i}][l];")
            unbend.append(f"MS_EACH slope[{i}][l] = 1.0, bend[{i}][l] = 0.0;")
            continue
        texts = [_polynomial(place + j * terms, terms) for j in range(6)]
        # an even inertia has cosines in G, sines in q - x and dG/dx
        slope, angle, change = (
            texts[2 * j + (j > 0)]
            if even and j == 0
            else f"s * ({texts[2 * j + 1]})"
            if even
            else f"({texts[2 * j]}) + s * ({texts[2 * j + 1]})"
            for j in range(3)
        )
        unbend.append(
            f"MS_EACH\n    {{\n        double s, c;\n        ms_sincos(arc[{i}][l], &s, &c);\n"
            f"        const double z = c * c;\n        slope[{i}][l] = {slope};\n        bend[{i}][l] = {change};\n"
            f"        x[1 + {q}][l] = arc[{i}][l] + {angle};\n"
            f"        x[1 + {u}][l] = speed[{i}][l] * slope[{i}][l];\n    }}"
        )
        bend.append(f"MS_EACH f[{i}][l] *= slope[{i}][l] * k[{place + 6 * terms} * MS_L + l];")
        place += 6 * terms + 1
    rows = "const ms_row *restrict arc, const ms_row *restrict speed, ms_row *restrict x, ms_row *restrict slope"
    return "\n".join(
        [
            _function("ms_unbend", f"{rows}, ms_row *restrict bend", unbend),
            _function("ms_bend", "const ms_row *restrict slope, ms_row *restrict f", ["(void)slope, (void)f;", *bend]),
        ]
    )


def _function(name: str, rows: str, lines: list[str]) -> str:
    body = "\n    ".join(["(void)k;", *lines])
    return f"static void {name}(const double *restrict k, {rows})\n{{\n    {body}\n}}"


def _polynomial(place: int, terms: int) -> str:
    """A polynomial in c as two in z = c^2, which do not wait for each other."""
    halves = []
    for first in (0, 1):
        chosen = [f"k[{place + j} * MS_L + l]" for j in range(first, terms, 2)]
        text = chosen[-1]
        for k in reversed(chosen[:-1]):
            text = f"({text} * z + {k})"
        halves.append(text)
    return f"{halves[0]} + c * {halves[1]}"


def lagrange(nodes: list[int]) -> list[_Row]:
    """Polynomials that are 1 at one node and 0 at the others, lowest power first."""
    polynomials = []
    for j, own in enumerate(nodes):
        row, below = [1], 1
        for other in nodes[:j] + nodes[j + 1 :]:
            row = [a - other * b for a, b in zip([0, *row], [*row, 0], strict=True)]
            below *= own - other
        polynomials.append([Fraction(a, below) for a in row])
    return polynomials


def integrals(rows: list[_Row]) -> tuple[list[_Row], list[_Row]]:
    """The first and second integrals from 0 of polynomials."""
    once = [[Fraction(0), *(a / (i + 1) for i, a in enumerate(row))] for row in rows]
    twice = [[Fraction(0), *(a / (i + 1) for i, a in enumerate(row))] for row in once]
    return once, twice


@functools.cache
def numbers() -> str:
    """Weights as macros MS_ONCE, MS_TWICE, MS_AHEAD of the last rates MS_PAST(j), and tables."""
    behind = [-j for j in range(BACK)]
    around = [1 - j for j in range(BACK + 1)]
    polynomials = lagrange(behind)
    once, twice = ([float(sum(row)) for row in rows] for rows in integrals(polynomials))
    ahead = [float(sum(row)) for row in polynomials]
    inside_once, inside_twice = integrals(lagrange(around))
    longer = int(-(-(BACK - 1) * GROWTH // 1)) + 1
    shrink = [[_at(row, -j / GROWTH) for row in polynomials] for j in range(BACK)]
    grow = [[_at(row, -j * GROWTH) for row in lagrange([-m for m in range(longer)])] for j in range(BACK)]
    macros = {"MS_ONCE": once, "MS_TWICE": twice, "MS_AHEAD": ahead}
    tables = {"ms_inside_once": inside_once, "ms_inside_twice": inside_twice, "ms_shrunk": shrink, "ms_grown": grow}
    lines = [f"enum {{ MS_BACK = {BACK}, MS_LONGER = {longer}, MS_STRIDES = {STRIDES} }};"]
    for name, row in macros.items():  # the newest rate is what a step waits for: it comes last
        lines.append(f"#define {name} " + " + ".join(f"{row[j]!r} * MS_PAST({j})" for j in reversed(range(len(row)))))
    lines += [
        f"#define MS_NEW_ONCE {float(sum(inside_once[0]))!r}",
        f"#define MS_NEW_TWICE {float(sum(inside_twice[0]))!r}",
    ]
    lines += [f"#define MS_STRICT {STRICT!r}", f"#define MS_GROWTH {float(GROWTH)!r}"]
    for name, rows in tables.items():
        text = ", ".join("{" + ", ".join(repr(float(a)) for a in row) + "}" for row in rows)
        lines.append(f"static const double {name}[{len(rows)}][{len(rows[0])}] = {{{text}}};")
    return "\n".join(lines)


def _at(row: _Row, x: Fraction) -> Fraction:
    return sum((a * x**i for i, a in enumerate(row)), Fraction(0))
