"""C files that integrate y' = f(t, y, p) in lanes: the emitted right-hand side, a method, its step control.

DOP853 is the explicit Runge-Kutta method of order 8 with error estimates of orders 5 and 3. Source: E. Hairer, S. P.
Norsett, G. Wanner, Solving Ordinary Differential Equations I, 2nd ed., Springer 1993, section II.5, and the program
dop853.f that goes with it. Stages count from 1; stage 13 is the derivative at the end of the step, stages 14 to 16 are
made only for dense output. The numbers are in `dop853.toml`; `tests/native/test_integrate.py` checks the conditions of
order.
"""

import functools
import tomllib
from collections.abc import Mapping
from importlib import resources

import numpy as np
from numpy.polynomial import legendre

from mechsym.errors import BadInput
from mechsym.native import source
from mechsym.native.source import Program, header, preamble
from mechsym.quantities.units import Array, Pure

_TABLE = tomllib.loads(resources.files("mechsym.native").joinpath("dop853.toml").read_text("utf-8"))


def _row(numbers: Mapping[str, float]) -> dict[int, float]:
    """Coefficients by earlier stage."""
    return {int(stage): number for stage, number in numbers.items()}


NODES: tuple[float, ...] = tuple(_TABLE["nodes"])
A = {int(stage): _row(row) for stage, row in _TABLE["stages"].items()}
ERROR_5, WEIGHTS_3 = _row(_TABLE["error_5"]), _row(_TABLE["weights_3"])
DENSE = tuple(map(_row, _TABLE["dense"]))


# of the collocation method: one vector register of doubles
STAGES = 8


def sizes(program: Program) -> tuple[int, int]:
    """Numbers of states and of held values of a program with inputs t, y, p and one output of the shape of y."""
    n = len(program.tape.outputs)
    if len(program.tape.inputs) < 1 + n:
        raise BadInput(
            f"{program.tape.name}: a right-hand side takes t, y and p and returns the derivative of y; it has "
            f"{len(program.tape.inputs)} inputs and {n} outputs"
        )
    return n, len(program.tape.inputs) - 1 - n


def dop853(program: Program, lanes: int, followed: tuple[int, ...] = ()) -> str:
    """A file that exports `ms_dop853`, see `c/run.h` for its argument. followed: states that tables are read at."""
    n, _ = sizes(program)
    used = {args[0] for op, args in program.tape.nodes if op == "input"} | {1 + i for i in followed}
    # up to the last state that the rates read: works and losses, which nothing reads, stand behind it
    last = max((i for i in used if i <= n), default=0)
    read_states = f"#define MS_READ_STATES for (int i = 0; i < {last}; i++) MS_EACH"
    speeds = _array("ms_rate_of", np.array([_state_rates(program).get(i, -1) for i in range(n)]))
    parts = [system(program, lanes), read_states, speeds, dop853_numbers(), header("dop853.h"), header("advance.h")]
    return "\n".join(parts)


def system(program: Program, lanes: int) -> str:
    """What the file of any method begins with: elementary functions, the right-hand side MS_RATES, sizes."""
    name, (n, p) = program.tape.name, sizes(program)
    return "\n".join(
        [
            preamble(),
            source.bodies(program.kernels, name),
            source.rows(program.kernels, name, lanes),
            f"enum {{ MS_N = {n}, MS_P = {p}, MS_L = {lanes} }};",
            f"#define MS_RATES(k, x, y) {name}_rows{lanes}(k, x, y)",
            header("run.h"),
        ]
    )


def weighted(weights: dict[int, Pure]) -> str:
    """A weighted sum of the rates of stages as C; stage j is MS_Q(j)."""
    return " + ".join(f"{value!r} * MS_Q({stage})" for stage, value in weights.items())


@functools.cache
def dop853_numbers() -> str:
    """Numbers of DOP853 as macros: MS_STAGES, MS_EXTRA_STAGES, MS_WEIGHTS, MS_ERROR_5, MS_ERROR_3, MS_DENSE_1..4."""
    lower = {stage: A[13].get(stage, 0.0) - WEIGHTS_3.get(stage, 0.0) for stage in A[13]}
    stages = {s: f"F({s}, {NODES[s - 1]!r}, {weighted(A[s])})" for s in A if s != 13}
    first = " \\\n    ".join(text for s, text in stages.items() if s < 13)
    extra = " \\\n    ".join(text for s, text in stages.items() if s > 13)
    lines = [
        f"#define MS_STAGES(F) \\\n    {first}",
        f"#define MS_EXTRA_STAGES(F) \\\n    {extra}",
        f"#define MS_WEIGHTS {weighted(A[13])}",
        f"#define MS_ERROR_5 {weighted(ERROR_5)}",
        f"#define MS_ERROR_3 {weighted(lower)}",
        *(f"#define MS_DENSE_{i} {weighted(row)}" for i, row in enumerate(DENSE, 1)),
    ]
    return "\n".join(lines)


def gauss(program: Program, lanes: int, stages: int = 4) -> str:
    """A file that exports `ms_gauss`, see `c/run.h` for its argument. stages: order is twice the number of stages."""
    return "\n".join([system(program, lanes), _gauss_numbers(stages), header("gauss.h")])


def gauss_tableau(stages: int) -> tuple[Pure[Array], Pure[Array], Pure[Array], Pure[Array]]:
    r"""Numbers of the Gauss-Legendre method.

    .. math:: a_{ij} = \int_0^{c_i} \ell_j(x)\,dx, \qquad b_j = \int_0^1 \ell_j(x)\,dx, \qquad e_{ij} = \ell_j(1 + c_i)

    Returns a, b, c, ahead: coefficients (s, s), weights (s,), nodes (s,), and the values e (s, s) that continue a
    step's polynomial.
    Source: E. Hairer, Ch. Lubich, G. Wanner, Geometric Numerical Integration, 2nd ed., Springer 2006, section II.1.3.
    """
    roots, weights = legendre.leggauss(stages)
    to_series = legendre_coefficients(stages)
    integrals = np.array([legendre.legval(roots, legendre.legint(row, lbnd=-1)) for row in np.eye(stages)])
    ahead = legendre.legvander(roots + 2, stages - 1) @ to_series
    return integrals.T @ to_series / 2, weights / 2, (1 + roots) / 2, ahead


@functools.cache
def _gauss_numbers(stages: int) -> str:
    a, b, c, ahead = gauss_tableau(stages)
    named = {"ms_gauss_b": b, "ms_gauss_c": c, "ms_gauss_a": a, "ms_gauss_ahead": ahead}
    return "\n".join([f"enum {{ MS_S = {stages} }};", *(_array(name, values) for name, values in named.items())])


def _array(name: str, values: np.ndarray) -> str:
    shape = "".join(f"[{n}]" for n in values.shape)
    rows = ["{" + ", ".join(map(repr, row)) + "}" for row in np.atleast_2d(values).tolist()]
    text = rows[0] if values.ndim == 1 else "{" + ", ".join(rows) + "}"
    kind = "long" if values.dtype.kind == "i" else "double"
    return f"static const {kind} {name}{shape} __attribute__((aligned(64))) = {text};"


def collocation(program: Program, lanes: int = STAGES) -> str:
    """A file that exports `ms_collocation`, see `c/run.h`. lanes: stages of the one run, always `STAGES`."""
    parts = [system(program, lanes), _collocation_numbers(lanes), _structure(program)]
    return "\n".join([*parts, header("collocation.h"), header("collocation_run.h")])


@functools.cache
def _collocation_numbers(stages: int) -> str:
    a, b, c, _ = gauss_tableau(stages)
    # a row of stages is a vector, so matrices are transposed: weights[j] belongs to k_j in all stages
    named = {
        "ms_nodes": c, "ms_weights": b, "ms_double_weights": b @ a, "ms_once": a.T, "ms_twice": (a @ a).T,
        "ms_to_series": legendre_coefficients(stages).T,
    }  # fmt: skip
    return "\n".join([f"enum {{ MS_S = {stages} }};", *(_array(name, values) for name, values in named.items())])


def legendre_coefficients(stages: int) -> Pure[Array]:
    r"""Matrix from values at Gauss points to coefficients of Legendre polynomials.

    .. math:: c_n = \tfrac{2 n + 1}{2} \sum_j w_j P_n(x_j) f_j

    Returns matrix: row n gives the coefficient of P_n, shape (s, s).
    """
    roots, weights = legendre.leggauss(stages)
    values = legendre.legvander(roots, stages - 1).T
    return (np.arange(stages)[:, None] + 0.5) * weights * values


def _state_rates(program: Program) -> dict[int, int]:
    """States whose rate is another state, with that one."""
    n, tape = len(program.tape.outputs), program.tape
    rates = [tape.nodes[r] for r in tape.results]
    return {i: args[0] - 1 for i, (op, args) in enumerate(rates) if op == "input" and 1 <= args[0] <= n}


def _structure(program: Program) -> str:
    """Which states are angles, which are their speeds, and which others the rates depend on."""
    n, tape, same = len(program.tape.outputs), program.tape, _state_rates(program)
    # a speed has a rate of its own: of position, speed and acceleration only the speed is an angle here
    speeds = {i: speed for i, speed in same.items() if speed not in same}
    used = {args[0] for op, args in tape.nodes if op == "input"}
    others = [i for i in range(n) if i not in speeds and 1 + i in used]
    lists = {"ms_angle": list(speeds), "ms_speed": list(speeds.values()), "ms_other": others}
    # C has no empty arrays
    sizes = (
        f"ms_angles = {len(speeds)}, ms_others = {len(others)}",
        f"MS_ANGLES = {len(speeds) or 1}, MS_OTHERS = {len(others) or 1}",
    )
    return "\n".join([f"enum {{ {', '.join(sizes)} }};", *(_array(k, np.array(v or [0])) for k, v in lists.items())])
