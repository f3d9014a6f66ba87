"""What a formula as printed is, by two truths that must agree: right, approximate, impure or wrong.

Right: equal at random states, at constant speed where only that makes it so; `rounded` where a constant of the print
is (3.14). Approximate: every power of crank/rod is right or left out, the first one right. Impure: right up to the
second power beyond the first and not in a later one. All else is wrong.
"""

import random
from collections.abc import Iterator, Mapping
from functools import cache
from typing import Any

import mpmath
from audit.public import laws, more, points
from mpmath import mpf

DIGITS, TOLERANCE = 40, mpf("1e-9")
ROUNDED = mpf("1e-3")
RANGES = {
    "cylinder_volume": {
        "B": (0.06, 0.1), "r": (0.03, 0.06), "l": (0.14, 0.24), "r_c": (7, 20), "phi": (0.3, 2.8), "phid": (50, 300),
        "phidd": (200, 900),
    },
    "slider_crank": {
        "r": (0.03, 0.06), "l": (0.14, 0.24), "m": (0.3, 2), "F": (500, 9000), "phi": (0.3, 2.8), "phid": (50, 300),
        "phidd": (200, 900),
    },
    "scotch_yoke": {"r": (0.03, 0.06), "phi": (0.3, 2.8), "phid": (50, 300), "phidd": (200, 900)},
    "four_bar": {
        "a": (0.03, 0.05), "b": (0.11, 0.13), "c": (0.075, 0.085), "d0": (0.095, 0.105), "alpha": (0.3, 2.8),
        "alphad": (5, 30), "alphadd": (20, 90),
    },
    "trochoid": {"R": (0.07, 0.11), "q": (0.02, 0.03), "b": (0.01, 0.02), "phi": (0.3, 2.8)},
    "wiebe": {
        "theta": (0.3, 1), "theta_s": (0.05, 0.2), "duration": (0.9, 1.2), "a": (4, 7), "m": (1, 3), "Q": (500, 900),
    },
    "air_cycles": {
        "T_1": (280, 330), "p_1": (9e4, 2e5), "r_c": (8, 20), "alpha": (1.2, 2), "beta": (1.3, 2.5),
        "gamma": (1.25, 1.45), "c_v": (700, 800),
    },
    "nozzle": {
        "C_d": (0.6, 0.9), "A": (1e-4, 9e-4), "p_0": (1e5, 3e5), "x": (0.6, 0.97), "T_0": (280, 400),
        "gamma": (1.25, 1.45), "R": (250, 300),
    },
    "helical_spring": {
        "d": (0.004, 0.006), "D": (0.03, 0.05), "n": (5, 12), "G": (7e10, 9e10), "F": (100, 500), "rho": (7000, 8000),
    },
    "strength": {
        "p": (1e6, 9e6), "r_i": (0.04, 0.05), "r_o": (0.06, 0.08), "R_1": (0.02, 0.03), "R_2": (0.04, 0.05),
        "F": (1e3, 9e3), "L": (0.1, 0.4), "E_1": (2e11, 2.2e11), "E_2": (1e11, 1.2e11), "nu_1": (0.25, 0.32),
        "nu_2": (0.3, 0.35),
    },
    "epicyclic": {"z_s": (20, 40), "z_p": (12, 20), "module": (0.001, 0.003), "w_s": (50, 150), "w_c": (20, 60)},
    "piston_speed": {"stroke": (0.07, 0.12), "omega": (100, 400)},
    "flywheel": {"T_a": (100, 300), "n": (1, 4), "w": (90, 200)},
    "inline_balance": {"m": (0.3, 1), "r": (0.03, 0.06), "lam": (0.2, 0.3), "phi": (0.3, 2.8), "phid": (50, 300)},
    "knife_cam": {"h": (0.005, 0.02), "phi": (0.3, 2.8)},
    "schmidt_alpha": {
        "V_SE": (1e-4, 2e-4), "V_SC": (1e-4, 2e-4), "V_DE": (1e-5, 2e-5), "V_DC": (1e-5, 2e-5), "dx": (1.2, 1.9),
        "phi": (0.3, 2.8),
    },
    "heat_transfer": {
        "B": (0.07, 0.1), "S": (0.07, 0.1), "speed": (20, 80), "p": (4e6, 6e6), "p_m": (1e6, 3e6), "p_r": (1e5, 2e5),
        "V": (5e-5, 5e-4), "V_d": (4e-4, 6e-4), "V_r": (6e-4, 7e-4), "T": (900, 2000), "T_r": (320, 400),
        "C_1": (2, 3), "C_2": (0.001, 0.005),
    },
}  # fmt: skip
RODS = ("cylinder_volume", "slider_crank")
FUNCTIONS = {
    k: getattr(mpmath, k) for k in ("sin", "cos", "tan", "asin", "acos", "atan", "atan2", "sqrt", "exp", "log")
}


def both(theory: str, state: Mapping[str, mpf]) -> tuple[dict[str, mpf], dict[str, mpf]]:
    """Quantities of a theory by either truth."""
    return _both(theory, tuple(state.items()), mpmath.mp.dps)


@cache
def _both(theory: str, letters: tuple[tuple[str, mpf], ...], _digits: int) -> tuple[dict[str, mpf], dict[str, mpf]]:
    # the rows of a theory ask at the same states
    state = dict(letters)
    if hasattr(points, theory):
        return getattr(points, theory)(state), getattr(laws, theory)(state)
    return getattr(more, theory)(state)  # type: ignore[no-any-return]


def states(theory: str, count: int, seed: int) -> Iterator[dict[str, mpf]]:
    """Random states within a theory's ranges."""
    generator = random.Random(seed)
    for _ in range(count):
        yield {k: mpf(generator.uniform(*ends)) for k, ends in RANGES[theory].items()}


def assumed(state: dict[str, mpf], text: str) -> dict[str, mpf]:
    """A state with what the source takes for granted, `b = q, alpha = 1`."""
    for relation in filter(None, map(str.strip, text.split(","))):
        name, _, value = (part.strip() for part in relation.partition("="))
        state = {**state, name: state[value] if value in state else mpf(value)}
    return state


def printed(text: str, names: Mapping[str, mpf], letters: str) -> Any:
    """Value of a formula in plain Python, in its author's letters and the theory's names."""
    known = {"pi": +mpmath.pi, **FUNCTIONS, **names}
    own = dict(known)
    for pair in filter(None, map(str.strip, letters.split(", "))):
        name, _, meaning = pair.partition("=")
        if name.isidentifier() and name != "lambda":
            own[name] = eval(meaning.replace("^", "**"), {"__builtins__": {}}, known)  # noqa: S307
    return eval(text.replace("^", "**"), {"__builtins__": {}}, own)  # noqa: S307


def label(row: Mapping[str, Any]) -> str:
    """What a row of the bench is.

    Raises
    ------
    AssertionError
        The two truths differ
    """
    with mpmath.workdps(DIGITS):
        error = _error(row, still=False)
        if error > TOLERANCE and any(k.endswith("dd") for k in RANGES[_theory(row)]):
            error = min(error, _error(row, still=True))
        if error <= TOLERANCE:
            return "right"
        if error <= ROUNDED and any(c in row["text"] for c in ("3.14", ".7854")):
            return "rounded"
        return _powers(row) if _theory(row) in RODS else "wrong"


def _theory(row: Mapping[str, Any]) -> str:
    return str(row["against"]).partition(".")[0]


def _pair(row: Mapping[str, Any], state: dict[str, mpf]) -> tuple[mpf, mpf]:
    # printed and true value at one state
    theory, _, quantity = row["against"].partition(".")
    state = assumed(state, row.get("assume", ""))
    first, second = both(theory, state)
    scale = max(abs(first[quantity]), abs(second[quantity]))
    assert abs(first[quantity] - second[quantity]) <= TOLERANCE * scale, (row["against"], first[quantity], second)
    plain = row.get("plain") or row["text"]
    return printed(plain, {**state, **second}, "" if row.get("plain") else row.get("letters", "")), second[quantity]


def _error(row: Mapping[str, Any], still: bool) -> mpf:
    worst = mpf(0)
    for state in states(_theory(row), 3, seed=7):
        if still:
            state = {k: mpf(0) if k.endswith("dd") else v for k, v in state.items()}
        is_printed, is_true = _pair(row, state)
        worst = max(worst, abs(is_printed - is_true) / abs(is_true))
    return worst


def _powers(row: Mapping[str, Any]) -> str:
    # coefficients of powers of crank/rod at three angles, from values at small ratios
    found: list[list[tuple[bool, bool]]] = []
    for state in states(_theory(row), 3, seed=11):
        nodes = [mpf(j) / 200 for j in range(1, 11)]
        pairs = [_pair(row, {**state, "phidd": mpf(0), "l": state["r"] / lam}) for lam in nodes]
        p, e = (_coefficients(nodes, [pair[i] * lam for pair, lam in zip(pairs, nodes, strict=True)]) for i in (0, 1))
        size = max(map(abs, e[:2]))
        found.append(
            [(abs(x - y) < mpf("1e-5") * size, abs(x) < mpf("1e-5") * size) for x, y in zip(p, e, strict=True)]
        )
    same, none = ([all(at[j][i] for at in found) for j in range(6)] for i in (0, 1))
    first = next(j for j in range(6) if not none[j] or not same[j])
    if not same[first]:
        return "wrong"
    if all(a or b for a, b in zip(same, none, strict=True)):
        return "approximate"
    return "impure" if all(a or b for a, b in list(zip(same, none, strict=True))[: first + 3]) else "wrong"


def _coefficients(at: list[mpf], values: list[mpf]) -> list[mpf]:
    a = mpmath.matrix([[x**k for k in range(len(at))] for x in at])
    return list(mpmath.lu_solve(a, mpmath.matrix(values)))[:6]
