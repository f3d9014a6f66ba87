"""P5: the four-stroke cycle of Nunes (2017), marched in steps of one degree at 800 speeds, as a performance map.

All routes give peak pressure, mean torque of both pistons and largest torque of one. Formulas: the printed cycle of
the thesis, eqs. (2.30) to (2.66) and (3.1) to (3.14).
"""

import ctypes
from collections.abc import Callable
from typing import Any

import casadi as ca
import numpy as np

from benchmarks import references, translate
from benchmarks.measure import PAIRS, Route, Row, take_turns
from mechsym.native.march import marcher

SPEEDS = 800
_B, _S, _R_CRANK, _L, _M_P = 0.06, 0.052, 0.026, 0.09, 0.25  # two pistons of stroke _S
_AREA = np.pi / 4 * _B**2
_VD = _AREA * 2 * _S
_VC = _VD / 9
_R, _T0, _P0, _TW = 287.0, 288.15, 101325.0, 350.0
_FUEL = _P0 * _VD / (_R * _T0) / 15.06
_HEAT = 0.86967 * _FUEL * 43.5e6
_GAS = _P0 * (_VD + _VC) / (_R * _T0)


def rows(skipped: list[str]) -> list[Row]:
    """Measure all routes.

    Parameters
    ----------
    skipped : list of str
        Names of alternatives that are not installed are added

    Returns
    -------
    rows : list of Row
        Time of one map
    """
    omega = np.linspace(500, 8000, SPEEDS) * np.pi / 30
    stages = _stages()
    calls: dict[str, tuple[Callable[[], np.ndarray], int]] = {
        "numpy over speeds": (lambda: _numpy(stages, omega), 5),
        "mechsym (fast)": (_mechsym(stages, omega, "fast"), PAIRS),
        "mechsym (strict)": (_mechsym(stages, omega, "strict"), PAIRS),
        "hand-written C": (lambda: _hand(stages, omega), PAIRS),
        "casadi interpreted": (_casadi(stages, omega), 3),
    }
    try:
        calls["numba"] = (_numba(stages, omega), 5)
    except ImportError:
        skipped.append("numba")
    routes, wanted = [], None
    for name, (call, rounds) in calls.items():
        found = call()
        wanted = found if wanted is None else wanted
        error = float(np.max(np.abs(found / wanted - 1)))
        if not error < 1e-9:
            raise AssertionError(f"{name} gives another map: relative difference {error:.3g}")
        routes.append(Route(name=name, call=call, error=error, rounds=rounds))
    return take_turns("P5 cycle map", f"{SPEEDS} speeds", routes)


def _stages() -> np.ndarray:
    """End of each step [deg], volumes at its start and end [m^3], dx/dphi and d2x/dphi2 at its end [m]."""
    theta = np.radians(np.arange(180, 541))
    s, c = np.sin(theta), np.cos(theta)
    q = np.sqrt(_L**2 - (_R_CRANK * s) ** 2)
    x = _L + _R_CRANK - _R_CRANK * c - q
    dx = _R_CRANK * s + _R_CRANK**2 * s * c / q
    d2x = _R_CRANK * c + _R_CRANK**2 * (c**2 - s**2) / q + _R_CRANK**4 * s**2 * c**2 / q**3
    v = _VC + 2 * _AREA * x
    return np.stack([np.arange(181.0, 541.0), v[:-1], v[1:], dx[1:], d2x[1:]], axis=1)


def _advance(state: Any, stage: Any, omega: Any, maths: Any) -> list[Any]:
    """One degree: p, T, m, burnt share, and so far peak pressure, sum of torque, largest torque."""
    p, t, m, burnt, top, total, most = state
    end, v1, v2, dx, d2x = stage
    rpm = omega * (30 / np.pi)
    begin, duration = 350.93 - 0.0004 * rpm, 30.663 + 0.0027 * rpm
    y = (end - begin) / duration
    share = 1 - maths.exp(-5 * maths.fmax(y, 0.0) ** 3)
    now = maths.fmax(burnt, maths.where(y <= 1, share, 0.0))
    vapour = maths.where(end <= begin, _FUEL / (begin - 180), 0.0)
    mu = 7.457e-6 + 4.1547e-8 * t - 7.4793e-12 * t**2
    k = 6.1944e-3 + 7.3814e-5 * t - 1.2491e-8 * t**2
    reynolds = p / (_R * t) * (_S * omega / np.pi) * _B / mu
    flux = k / _B * 0.49 * reynolds**0.7 * (t - _TW) + 4.25e-9 * (t**4 - _TW**4)
    loss = flux * (2 * _AREA + 4 * v2 / _B) * (np.pi / 180) / omega
    heat = _HEAT * (now - burnt) - loss - 4e5 * vapour
    p2 = (2 * heat + p * (6 * v1 - v2)) / (6 * v2 - v1)
    m2 = m + vapour
    torque = (p2 * _AREA - _M_P * d2x * omega**2) * dx
    return [p2, p2 * v2 / (m2 * _R), m2, now, maths.fmax(top, p2), total + torque, maths.fmax(most, torque)]


def _start(omega: np.ndarray) -> np.ndarray:
    return np.array([np.full_like(omega, v) for v in (_P0, _T0, _GAS, 0.0, _P0, 0.0, 0.0)])


def _map(state: Any) -> np.ndarray:
    return np.array([state[4], 2 * state[5] / 721, state[6]])


class _Numpy:
    exp, fmax, where = np.exp, np.maximum, np.where


class _Casadi:
    exp, fmax, where = ca.exp, ca.fmax, ca.if_else


def _numpy(stages: np.ndarray, omega: np.ndarray) -> np.ndarray:
    state: Any = _start(omega)
    for stage in stages.tolist():
        state = _advance(state, stage, omega, _Numpy)
    return _map(state)


def _step() -> ca.Function:
    state, stage, omega = ca.SX.sym("state", 7), ca.SX.sym("stage", 5), ca.SX.sym("omega")
    following = _advance(ca.vertsplit(state), ca.vertsplit(stage), omega, _Casadi)
    return ca.Function("cycle", [state, stage, omega], [ca.vertcat(*following)])


def _mechsym(stages: np.ndarray, omega: np.ndarray, mode: str) -> Callable[[], np.ndarray]:
    march = marcher(_step(), mode)
    return lambda: _map(march(_start(omega), stages, omega[None])[0])


def _hand(stages: np.ndarray, omega: np.ndarray) -> np.ndarray:
    result = np.empty((3, len(omega)))
    constants = np.array([_P0, _T0, _GAS, _FUEL, _HEAT, _B, _AREA, _M_P, _S / np.pi])
    places = [ctypes.c_void_p(a.ctypes.data) for a in (stages, omega, constants, result)]
    references.load("cycle").hand_cycle(ctypes.c_long(len(stages)), ctypes.c_long(len(omega)), *places)
    return result


def _casadi(stages: np.ndarray, omega: np.ndarray) -> Callable[[], np.ndarray]:
    many = _step().fold(len(stages)).map(len(omega))
    start, speeds = _start(omega), np.repeat(omega, len(stages))[None]
    table = np.tile(stages.T, len(omega))

    def run() -> np.ndarray:
        return _map(np.asarray(many(start, table, speeds)))

    return run


def _numba(stages: np.ndarray, omega: np.ndarray) -> Callable[[], np.ndarray]:
    import math

    import numba

    scope: dict[str, Any] = {"math": math}
    exec(translate.python_text(_step(), "point"), scope)
    point = numba.njit(fastmath=True)(scope["point"])
    names = [f"y{i}" for i in range(7)]
    text = f"""
def run(start, stages, omega, out):
    for j in range(omega.shape[0]):
        {", ".join(names)} = {", ".join(f"start[{i}, j]" for i in range(7))}
        for k in range(stages.shape[0]):
            {", ".join(names)} = point({", ".join([*names, *(f"stages[k, {i}]" for i in range(5)), "omega[j]"])})
        {", ".join(f"out[{i}, j]" for i in range(7))} = {", ".join(names)}
"""
    scope = {"point": point}
    exec(text, scope)
    compiled = numba.njit(fastmath=True)(scope["run"])
    start, out = _start(omega), np.empty((7, len(omega)))

    def run() -> np.ndarray:
        compiled(start, stages, omega, out)
        return _map(out)

    return run
