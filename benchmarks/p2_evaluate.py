"""P2: accelerations of one, two and seven coordinates, in batches of 256 to 1e6 points and one call at a time."""

import ctypes
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import casadi as ca
import numpy as np

from benchmarks import models, references, translate
from benchmarks.measure import PAIRS, Route, Row, take_turns
from mechsym import native

POINTS = 100_000
SIZES = (256, 2048, 1_000_000)  # beside that, against what is as fast
_ALLOWED = 1e-9


def rows(skipped: list[str]) -> list[Row]:
    """Measure all routes of all systems.

    Parameters
    ----------
    skipped : list of str
        Names of alternatives that are not installed are added

    Returns
    -------
    rows : list of Row
        Batch and scalar
    """
    found = []
    for system in models.SYSTEMS:
        function = models.acceleration(system)
        x = models.states(function, POINTS)
        found += take_turns("P2 batch", system, _batch(system, function, x, skipped))
        for points in SIZES:
            own = models.states(function, points)
            found += take_turns("P2 batch", f"{system}, {points}", _close(system, function, own, skipped))
        found += take_turns("P2 scalar", system, _scalar(function, [float(c[0]) for c in x], skipped))
    return found


def _batch(system: str, function: ca.Function, x: list[np.ndarray], skipped: list[str]) -> list[Route]:
    fast, strict = (native.compiled(function, mode).batch for mode in ("fast", "strict"))
    wanted = _reference(function, x)
    out = np.empty_like(wanted)
    routes: dict[str, tuple[Callable[[], Any], int]] = {
        "mechsym (fast)": (lambda: fast(*x, out=out), PAIRS),
        "mechsym (strict)": (lambda: strict(*x, out=out), PAIRS),
        "hand-written C": (_hand(system, x, out), PAIRS),
        "sympy lambdify (numpy, cse)": (_lambdified(function, x), 3),
        "casadi map, interpreted": (_mapped(function, x, compiled=False), 3),
        "casadi map, compiled": (_mapped(function, x, compiled=True), 3),
    }
    for name, make in (("numba on lambdify", _numba), ("heyoka", _heyoka)):
        try:
            routes[name] = (make(function, x), PAIRS)
        except ImportError:
            skipped.append(name)
    return [_checked(name, call, wanted, rounds) for name, (call, rounds) in routes.items()]


def _close(system: str, function: ca.Function, x: list[np.ndarray], skipped: list[str]) -> list[Route]:
    """The closest routes at other numbers of points; small batches show what a call costs."""
    wanted = _reference(function, x)
    out = np.empty_like(wanted)
    fast, strict = (native.compiled(function, mode).batch for mode in ("fast", "strict"))
    routes: dict[str, Callable[[], Any]] = {
        "mechsym (fast)": lambda: fast(*x, out=out),
        "mechsym (strict)": lambda: strict(*x, out=out),
        "hand-written C": _hand(system, x, out),
    }
    try:
        routes["heyoka"] = _heyoka(function, x)
    except ImportError:
        skipped.append("heyoka")
    return [_checked(name, call, wanted, PAIRS) for name, call in routes.items()]


def _reference(function: ca.Function, x: list[np.ndarray]) -> np.ndarray:
    pieces = [slice(start, start + POINTS) for start in range(0, len(x[0]), POINTS)]
    mapped = function.map(min(POINTS, len(x[0])))
    found = [np.asarray(mapped.call([c[None, piece] for c in x])[0]) for piece in pieces]
    return np.concatenate([f.reshape(function.numel_out(0), -1) for f in found], axis=1)


def _checked(name: str, call: Callable[[], Any], wanted: np.ndarray, rounds: int) -> Route:
    found = call()
    scale = np.maximum(np.abs(wanted), 1e-3 * np.max(np.abs(wanted), axis=1, keepdims=True))
    error = float(np.max(np.abs(np.asarray(found).reshape(wanted.shape) - wanted) / scale))
    if not error < _ALLOWED:
        raise AssertionError(f"{name} gives other numbers: relative difference {error:.3g}")
    return Route(name=name, call=call, size=wanted.shape[1], error=error, rounds=rounds)


def _hand(system: str, x: list[np.ndarray], out: np.ndarray) -> Callable[[], np.ndarray]:
    loaded = references.load("accelerations")
    columns, results = ([ctypes.c_void_p(c.ctypes.data) for c in group] for group in (x, out))
    n = ctypes.c_long(len(x[0]))
    name = {"1-DOF": "hand_one_dof", "2-DOF": "hand_two_dof"}.get(system, "hand_six_throws")
    call = loaded[name]
    if name == "hand_six_throws":
        arguments: list[Any] = [(ctypes.c_void_p * len(g))(*(c.value for c in g)) for g in (columns, results)]
    else:
        arguments = [*columns, *results]

    def run() -> np.ndarray:
        call(n, *arguments)
        return out

    return run


def _lambdified(function: ca.Function, x: list[np.ndarray]) -> Callable[[], np.ndarray]:
    import sympy

    symbols, expressions = translate.sympy_expressions(function)
    call = sympy.lambdify(symbols, expressions, "numpy", cse=True)
    return lambda: np.array(call(*x))


def _mapped(function: ca.Function, x: list[np.ndarray], compiled: bool) -> Callable[[], np.ndarray]:
    inner = _generated(function) if compiled else function
    mapped = inner.map(POINTS)
    buffer: Any
    buffer, call = mapped.buffer()
    out = np.empty((POINTS, function.numel_out(0)))
    for i, column in enumerate(x):
        buffer.set_arg(i, column.data)
    buffer.set_res(0, out.data)

    def run(_alive: Any = buffer) -> np.ndarray:
        call()
        return out.T

    return run


def _generated(function: ca.Function) -> ca.Function:
    """The function as C that casadi writes itself, compiled with the same options."""
    from mechsym.native import compiler

    folder = Path(tempfile.mkdtemp())
    name = f"{function.name()}_casadi"
    symbols = [ca.SX.sym(function.name_in(i)) for i in range(function.n_in())]
    own = ca.Function(name, symbols, function.call(symbols))
    writer = ca.CodeGenerator(f"{name}.c")
    writer.add(own)
    writer.generate(f"{folder}/")
    options = tuple(o for o in compiler.flags("fast") if o != "-fvisibility=hidden" and not o.startswith("-D"))
    compiler.compile_file(compiler.find(), folder / f"{name}.c", folder / f"{name}.so", options)
    return ca.external(name, str(folder / f"{name}.so"))


def _numba(function: ca.Function, x: list[np.ndarray]) -> Callable[[], np.ndarray]:
    import numba
    import sympy

    symbols, expressions = translate.sympy_expressions(function)
    point = numba.njit(fastmath=True)(sympy.lambdify(symbols, tuple(expressions), "math", cse=True))
    text = "\n".join(
        [
            f"def batch({', '.join(f'x{i}' for i in range(len(x)))}, out):",
            "    for i in range(out.shape[1]):",
            f"        y = point({', '.join(f'x{i}[i]' for i in range(len(x)))})",
            *(f"        out[{j}, i] = y[{j}]" for j in range(len(expressions))),
        ]
    )
    scope: dict[str, Any] = {"point": point}
    exec(text, scope)
    batch = numba.njit(fastmath=True)(scope["batch"])
    out = np.empty((len(expressions), POINTS))

    def run() -> np.ndarray:
        batch(*x, out)
        return out

    return run


def _heyoka(function: ca.Function, x: list[np.ndarray]) -> Callable[[], np.ndarray]:
    import heyoka as hy

    names = [f"x{i:02}" for i in range(len(x))]
    variables = hy.make_vars(*names)
    call = hy.cfunc(translate.heyoka_expressions(function, list(variables)), vars=list(variables), fast_math=True)
    table = np.array(x)
    out = np.empty((function.numel_out(0), table.shape[1]))
    return lambda: call(table, outputs=out)


def _scalar(function: ca.Function, x: list[float], skipped: list[str]) -> list[Route]:
    import sympy

    symbols, expressions = translate.sympy_expressions(function)
    calls: dict[str, Callable[..., Any]] = {
        "mechsym (fast)": native.compiled(function).scalar,
        "sympy lambdify (numpy, cse)": sympy.lambdify(symbols, expressions, "numpy", cse=True),
        "sympy lambdify (math, cse)": sympy.lambdify(symbols, expressions, "math", cse=True),
        "casadi call": function,
    }
    try:
        import numba

        calls["numba on lambdify"] = numba.njit(sympy.lambdify(symbols, tuple(expressions), "math", cse=True))
    except ImportError:
        skipped.append("numba on lambdify")
    wanted = np.asarray(function(*x)).ravel()
    routes = []
    for name, call in calls.items():
        found = np.asarray(call(*x), dtype=float).ravel()
        error = float(np.max(np.abs(found - wanted) / np.maximum(np.abs(wanted), 1e-3 * np.max(np.abs(wanted)))))
        if not error < _ALLOWED:
            raise AssertionError(f"{name} gives other numbers: relative difference {error:.3g}")
        routes.append(Route(name=name, call=_hundred(call, x), size=100, error=error))
    return routes


def _hundred(call: Callable[..., Any], x: list[float]) -> Callable[[], None]:
    # written out as text so that the arguments cost what they cost in a real loop and nothing more
    names = ", ".join(f"x{i}" for i in range(len(x)))
    scope: dict[str, Any] = {f"x{i}": v for i, v in enumerate(x)} | {"call": call}
    values = ", ".join(f"{n}={n}" for n in [f"x{i}" for i in range(len(x))])
    exec(f"def hundred(call=call, {values}):\n    for _ in range(100):\n        call({names})", scope)
    return scope["hundred"]
