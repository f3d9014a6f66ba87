r"""The converged cycle at many operating points side by side, with its accuracy audited.

Every point goes through the same operations, so a whole performance map costs one call. The first law of the closed
period is then checked for each point by itself; where the residual is not below the tolerance the steps are doubled.
"""

import functools
from collections.abc import Mapping

import casadi as ca
import numpy as np
import scipy

from mechsym.cycle.closed.equations import Build
from mechsym.cycle.closed.phases import NODES, Map, closed_function, closed_map
from mechsym.errors import BadInput
from mechsym.quantities import RPM, record
from mechsym.quantities.units import Array, Kelvin, Pascal, Pure, Radian, Scalar

_STEPS, _MOST_STEPS = 120, 7680
MANY = 100  # points for which it pays to compile, or to read what is compiled
_SAME = 1e-12  # angles closer than this are one [rad]
TOLERANCE = 1e-10  # first-law residual of a cycle over the fuel's energy


@record
class ClosedRun:
    """The closed period at n operating points."""

    #: shape (n, k): crank angle from firing top dead centre [rad]; angles where the equations change stand twice
    phi: np.ndarray
    t: np.ndarray  #: shape (n, k): temperature [K]
    p: np.ndarray  #: shape (n, k): pressure [Pa]
    dt_dphi: np.ndarray  #: shape (n, k) [K/rad]
    dp_dphi: np.ndarray  #: shape (n, k) [Pa/rad]
    scalars: Mapping[str, np.ndarray]  #: shape (n,): `work`, `wall_heat` and the entries of `closed.SCALARS`
    residual: np.ndarray  #: shape (n,): First law: (change of energy - heat + losses + work)/heat released [-]


def run(build: Build, design: Mapping[str, Scalar], steps: int = _STEPS) -> ClosedRun:
    """Integrate the closed period at every operating point.

    build: callable, mapping of names to values -> Closed, for example `model.closed_period` with its engine bound.
    design: mapping of str to ndarray, shape (n,), values of the design at the n points; numbers are repeated. steps:
    steps to begin with, a multiple of 10. Returns run: all points with one number of steps, the smallest that closes
    the first law everywhere.
    """
    names = list(design)
    values = np.array(np.broadcast_arrays(*(np.atleast_1d(np.asarray(design[n], float)) for n in names)))
    while True:
        result = _run(build, tuple(names), values, steps)
        check_phases(result.scalars)
        worst = np.max(np.abs(result.residual))
        if worst < TOLERANCE:
            return result
        if not np.isfinite(worst) or steps >= _MOST_STEPS:
            bad = int(np.argmax(~(np.abs(result.residual) < TOLERANCE)))
            raise BadInput(_not_closed(result, names, values, bad))
        steps *= 2


def steps_needed(build: Build, design: Mapping[str, Scalar]) -> tuple[Pure[Array], dict[int, str]]:
    """Steps with which each point closes the first law, and why others never do.

    design: mapping of str to ndarray, shape (n,), values of the design at the n points; numbers are repeated. Returns
    steps: 0 at points that have no cycle; reasons: why they have none, by index.
    """
    names = list(design)
    values = np.array(np.broadcast_arrays(*(np.atleast_1d(np.asarray(design[n], float)) for n in names)))
    needed, open_, steps = np.zeros(values.shape[1], dtype=int), np.arange(values.shape[1]), _STEPS
    reasons: dict[int, str] = {}
    while open_.size:
        result = _run(build, tuple(names), values[:, open_], steps)
        faults = _phase_faults(result.scalars)
        size = np.abs(result.residual)
        hopeless = ~np.isfinite(size) | ((size >= TOLERANCE) & (steps >= _MOST_STEPS))
        faults |= {int(k): _not_closed(result, names, values[:, open_], int(k)) for k in np.flatnonzero(hopeless)
                   if k not in faults}  # fmt: skip
        reasons |= {int(open_[k]): reason for k, reason in faults.items()}
        closed = (size < TOLERANCE) & ~np.isin(np.arange(open_.size), list(faults))
        needed[open_[closed]] = steps
        open_ = np.setdiff1d(open_[~closed], list(reasons))
        steps *= 2
    return needed, reasons


def check_phases(scalars: Mapping[str, np.ndarray]) -> None:
    """Refuse points at which combustion does not fit. scalars: `omega` [rad/s], `closes`, `starts`, `ends`, `opens`."""
    for reason in _phase_faults(scalars).values():
        raise BadInput(reason)


def _phase_faults(scalars: Mapping[str, np.ndarray]) -> dict[int, str]:
    """Points at which combustion does not fit, and why."""
    closes, starts, ends, opens = (scalars[k] for k in ("closes", "starts", "ends", "opens"))
    faults: dict[int, str] = {}
    for angle, bound, bad, reason in (
        (starts, closes, starts <= closes, "ignition is before the inlet closes"),
        (starts, opens, starts >= opens, "ignition is after the exhaust opens"),
        (ends, starts, ends <= starts, "the end of combustion is not after its start"),
        (ends, opens, ends > opens, "combustion ends after the exhaust opens"),
    ):
        for k in np.flatnonzero(bad):
            at, limit = np.degrees(angle[k]), np.degrees(bound[k])
            faults.setdefault(
                int(k),
                f"{reason}: {at:.2f} deg against {limit:.2f} deg from firing TDC at "
                f"{scalars['omega'][k] / RPM:.5g} rpm; change ignition or duration",
            )
    return faults


def dense(result: ClosedRun, parts: int = 4) -> tuple[Radian[Array], Pascal[Array], Kelvin[Array]]:
    """Pressure and temperature at the nodes and between them, by cubic Hermite polynomials; every angle stands once.

    result: the closed period at n points; parts: parts that each step is cut into. Returns phi: crank angle, shape (n,
    k); p: pressure, shape (n, k); t: temperature, shape (n, k).
    """
    u = np.arange(parts) / parts
    h = np.diff(result.phi, axis=1)[..., None]
    phi = _close(result.phi[:, :-1, None] + u * h, result.phi)
    once = np.append(np.any(np.diff(phi, axis=1) > _SAME, axis=0), True)
    p, t = _hermite(result.p, result.dp_dphi, h, u), _hermite(result.t, result.dt_dphi, h, u)
    return phi[:, once], p[:, once], t[:, once]


def at_angles(result: ClosedRun, step: Radian) -> tuple[Radian[Array], Pascal[Array], Kelvin[Array]]:
    """Pressure and temperature of the first point on even angles.

    step: distance of the angles. Returns phi: from inlet closing to exhaust opening, both included, shape (k,); p:
    pressure, shape (k,); t: temperature, shape (k,).
    """
    once = np.append(np.diff(result.phi[0]) > _SAME, True)
    nodes = result.phi[0, once]
    phi = np.linspace(nodes[0], nodes[-1], round((nodes[-1] - nodes[0]) / step) + 1)
    curves = ((result.p, result.dp_dphi), (result.t, result.dt_dphi))
    p, t = (scipy.interpolate.CubicHermiteSpline(nodes, y[0, once], slope[0, once])(phi) for y, slope in curves)
    return phi, p, t


def _run(build: Build, names: tuple[str, ...], values: np.ndarray, steps: int) -> ClosedRun:
    found = _mapped(build, names)(values, steps) if values.shape[1] >= MANY else _called(build, names, values, steps)
    scalars = {k: v[:, 0] for k, v in found.items() if k not in NODES}
    gain = scalars["energy_end"] - scalars["energy_start"] + scalars["work"] + scalars["wall_heat"]
    with np.errstate(divide="ignore", invalid="ignore"):  # where nothing burns, `run` refuses
        residual = (gain - scalars["heat_released"] - scalars["fuel_energy"]) / scalars["heat_released"]
    return ClosedRun(**{k: found[k] for k in NODES}, scalars=scalars, residual=residual)


def _called(build: Build, names: tuple[str, ...], values: np.ndarray, steps: int) -> dict[str, np.ndarray]:
    found = _function(build, names, steps).call({"design": values})
    return {k: np.asarray(v).reshape(values.shape[1], -1) for k, v in found.items()}


@functools.lru_cache(maxsize=8)
def _mapped(build: Build, names: tuple[str, ...]) -> Map:
    return closed_map(build, names)


@functools.lru_cache(maxsize=8)
def _function(build: Build, names: tuple[str, ...], steps: int) -> ca.Function:
    # searches call `run` again and again with one `build`; making the function costs more than evaluating it
    return closed_function(build, names, steps)


def _not_closed(result: ClosedRun, names: list[str], values: np.ndarray, k: int) -> str:
    point = ", ".join(f"{name} = {value:.5g}" for name, value in zip(names, values[:, k], strict=True))
    return (f"the cycle does not converge at {point}: first-law residual {result.residual[k]:.2g} of the heat released "
            f"with {_MOST_STEPS} steps; very low speeds lose all heat to the walls, raise the speed")  # fmt: skip


def _hermite(y: np.ndarray, slope: np.ndarray, h: np.ndarray, u: np.ndarray) -> np.ndarray:
    y0, y1, d0, d1 = (a[..., None] for a in (y[:, :-1], y[:, 1:], slope[:, :-1], slope[:, 1:]))
    rise = y1 - y0
    bend = u * (1 - u) * ((1 - u) * (d0 * h - rise) - u * (d1 * h - rise))
    return _close(y0 + u * rise + bend, y)


def _close(inner: np.ndarray, nodes: np.ndarray) -> np.ndarray:
    return np.concatenate([inner.reshape(nodes.shape[0], -1), nodes[:, -1:]], axis=1)
