r"""Doubts of a run of a user's own mechanism by its equations: vibrations and push at its start, stretches, inertias.

.. math:: \ddot q = M^{-1}(Q - b), \qquad \lambda\left(\begin{smallmatrix} 0 & 1 \\ \partial\ddot q/\partial q &
    \partial\ddot q/\partial\dot q \end{smallmatrix}\right) = -\delta \pm \mathrm{i}\omega, \qquad
    \frac{M_{qq} - M_{qq}|_{I=0}}{M_{qq}|_{I=0}}
"""

import dataclasses
import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import casadi as ca
import numpy as np

from mechsym.cases import Case
from mechsym.cases.laws import value
from mechsym.cases.links import PLACES, STEP, value_of
from mechsym.mechanisms import own
from mechsym.mechanisms.plan import plan_of, roles_of
from mechsym.mechanisms.record import Mechanism, form_of
from mechsym.plausible import Doubt, proportion

NOTHING = 1e-12  #: Lever of a force [m], or share of a torque, that is rounding
_SEEN = 0.2  # of a period: five results show a vibration
_SHORT = 0.01  # of a run, that a result is apart from the next at the most
_BACK = 1e-9  # of a place that a turn brings back [m]
_STATES = 200  # of a run, at which forces are compared


def of_start(case: Case, mechanism: Mechanism, columns: Mapping[str, np.ndarray]) -> Iterator[Doubt]:
    """Doubts of a run; none of a mechanism that is built in, or whose loops constraints hold.

    columns: of the run, by coordinate and velocity [SI].
    """
    if not own.is_file(case.mechanism) or mechanism.dependents:
        return
    acts = dataclasses.asdict(case.need("inputs")) if "inputs" in case.sections else {}
    rotors = roles_of(case.mechanism).rotors
    if rotors and rotors[0].drive:
        acts[rotors[0].drive] = acts.get(rotors[0].drive, 0.0) + value(case.sections, "drive", "torque")
    acts = {name: acting for name, acting in acts.items() if acting and isinstance(acting, float)}
    at = {name: float(column[0]) for name, column in columns.items()} | acts
    listing = plan_of(case.mechanism).listing(None)
    hangs = listing.get("weight") and not acts and not rotors  # what is driven hardly swings by its weight
    if listing.get("springs") or hangs:
        yield from _swinging(case, mechanism, at, columns)
    yield from _still(listing["parameters"], mechanism, columns)
    for spring in listing.get("stretches", ()):
        yield from _stretched(spring, listing["parameters"], mechanism, columns)
    yield from of_inertia(case, mechanism, at)
    yield from _acting(acts, mechanism, columns)


def _still(units: Mapping[str, str], mechanism: Mechanism, columns: Mapping[str, np.ndarray]) -> Iterator[Doubt]:
    """How far the coordinate goes that goes farthest, by a radian, or by the longest letter in metres."""
    lengths = [abs(mechanism.parameters[name]) for name, unit in units.items() if unit == "m"]
    by = {"rad": 1.0, "m": max(lengths, default=0.0) or 1.0}
    going = {q: by.get(mechanism.units.get(q, "rad"), 0.0) for q in mechanism.coordinates}
    ways = [
        float(np.nanmax(np.abs(columns[q] - columns[q][0]), initial=0.0)) / scale for q, scale in going.items() if scale
    ]
    what = "farthest way of a coordinate / (a radian, or the longest letter)"
    yield from proportion("still_run", what, max(ways, default=1.0))


def _acting(acts: Mapping[str, float], mechanism: Mechanism, columns: Mapping[str, np.ndarray]) -> Iterator[Doubt]:
    r"""What each input and the drive do in a run beside all else that acts, along the coordinate where they do most.

    .. math:: \operatorname{med}_t |Q(u) - Q(0)| / \operatorname{med}_t |Q(0) - b|

    The middle of all times, so that a moment at which something falls or strikes hides nothing.
    """
    dynamics, last = mechanism.functions["dynamics"], len(columns[mechanism.coordinates[0]]) - 1
    some = np.unique(np.linspace(0, last, _STATES).astype(int))
    states = {name: columns[name][None, some] for name in dynamics.name_in() if name in columns}

    def driven(acting: Mapping[str, float]) -> np.ndarray:
        _, bias, force = dynamics(*({**states, **acting}.get(name, 0.0) for name in dynamics.name_in()))
        return np.asarray(force) - np.asarray(bias)

    together = driven(acts)
    for name in acts:
        rest = driven({other: acting for other, acting in acts.items() if other != name})
        own, beside = (np.nanmedian(np.abs(v), axis=1) for v in (together - rest, rest))
        moved = own > NOTHING * abs(acts[name])
        if np.nanmax(np.abs(together - rest), initial=0.0) <= NOTHING * abs(acts[name]):
            yield idle(name)
        elif moved.any() and (beside[moved] > 0).all():
            share = float((own[moved] / beside[moved]).max())
            yield from proportion("input_share", f"usual effect of {name} in the run / of all else that acts", share)


def idle(name: str) -> Doubt:
    """The doubt of an input that does nothing; the same before a run and after it, so that it is told once."""
    why = "what it acts on does not move: is the other branch of a joint meant, or another place?"
    return Doubt(code="idle_input", quantity=f"largest effect of inputs.{name}", value=0.0, usual="above 0", why=why)


def _stretched(
    spring: Sequence[str], units: Mapping[str, str], mechanism: Mechanism, columns: Mapping[str, np.ndarray]
) -> Iterator[Doubt]:
    """How far a run stretches a spring, and whether its two ends start at one speed where both move."""
    stiffness, stretch = spring
    code = "spring_wound" if units.get(stiffness) == "N*m/rad" else "spring_stretch"
    values = {**mechanism.parameters, **{q: columns[q] for q in mechanism.coordinates}}
    farthest = np.nanmax(np.abs(value_of(stretch, values)), initial=0.0)
    yield from proportion(code, f"stretch of spring {stiffness} in the run", float(farthest))
    start, rates = {**values, **{q: columns[q][0] for q in mechanism.coordinates}}, []
    for q in mechanism.coordinates:
        before, behind = (float(value_of(stretch, {**start, q: start[q] + step})) for step in (-STEP, STEP))
        rates.append((behind - before) / (2 * STEP) * float(columns[f"{q}d"][0]))
    if np.isfinite(rates).all() and np.count_nonzero(rates) > 1:
        what = f"speed at which spring {stiffness} is stretched at the start / that of its faster end"
        yield from proportion("start_speeds", what, abs(sum(rates)) / float(np.max(np.abs(rates))))


def _swinging(
    case: Case, mechanism: Mechanism, at: Mapping[str, float], columns: Mapping[str, np.ndarray]
) -> Iterator[Doubt]:
    """Accelerations along what slides, the strongest damper by what swings, and by the time between two results what
    acts and the fastest vibration.
    """
    dynamics, n = mechanism.functions["dynamics"], len(mechanism.coordinates)
    given = [ca.SX.sym(name) for name in dynamics.name_in()]
    mass, bias, force = dynamics(*given)
    pushed = ca.solve(mass, force - bias)
    local = ca.Function("local", given, [pushed, ca.jacobian(pushed, ca.vertcat(*given[: 2 * n]))])
    first, slope = (np.asarray(v) for v in local(*(at.get(name, 0.0) for name in dynamics.name_in())))
    for q, acceleration in zip(mechanism.coordinates, first.ravel(), strict=True):
        if mechanism.units.get(q) == "m":
            yield from proportion("start_push", f"acceleration along {q} at the start", abs(float(acceleration)))
    if np.isfinite(slope).all():
        rates = np.linalg.eigvals(np.vstack([np.eye(n, 2 * n, n), slope]))
        swings = np.sqrt(np.maximum(-np.linalg.eigvals(slope[:, :n]).real, 0.0))
        if swings.max() > 0:
            what = "fastest decay at the start / (2 * fastest vibration without dampers)"
            yield from proportion("damping_share", what, float(-rates.real.min() / (2 * swings.max())))
    wanted = case.sections.get("simulation")
    if wanted is None:  # a report runs what says nothing of it
        return
    # a short run with results that nobody asked for so far apart shows nothing, which is no jolt
    step = 0.0 if wanted.t_end is None else min(wanted.step, max(wanted.output_step or 0.0, _SHORT * wanted.t_end))
    for q, acceleration in zip(mechanism.coordinates, first.ravel(), strict=True):
        if (fastest := float(np.nanmax(np.abs(columns[f"{q}d"]), initial=0.0))) > 0:
            what = f"change of {q}d between two results at the start / its largest in the run"
            yield from proportion("start_jolt", what, abs(float(acceleration)) * step / fastest)
    if not wanted.output_step or not np.isfinite(slope).all():
        return
    # of what is no vibration less than a fifth is left after one swing
    fastest = max((abs(rate.imag) for rate in rates if abs(rate.imag) > 4 * abs(rate.real)), default=0.0)
    what = "simulation.output_step in periods of the fastest vibration"
    yield from proportion("aliasing", what, step * fastest / math.tau, _SEEN)


def of_inertia(case: Case, mechanism: Mechanism, at: Mapping[str, float]) -> Iterator[Doubt]:
    """What turns with an angle by the masses that the angle moves on, at the angle where these are most; but for what
    goes round its own axis, whose unbalance says nothing of its size.

    at: coordinates of the state, by their names; those that it does not name are 0 [SI].
    """
    form, listing = form_of(mechanism), plan_of(case.mechanism).listing(None)
    still = {**mechanism.parameters, **dict.fromkeys(mechanism.coordinates, 0.0)}

    def goes_round(angle: str, place: Sequence[str]) -> bool:
        try:
            ways = [abs(value_of(x, {**still, angle: math.tau}) - value_of(x, still)) for x in place]
        except ZeroDivisionError:  # a place that has no value where all coordinates are 0
            return False
        return bool(ways) and angle in still and all(way < _BACK for way in ways)

    own_axis = {inertia for _, inertia, angle, *place in listing.get("solids", ()) if goes_round(angle, place)}
    units = listing["parameters"]
    massless = {name: 0.0 for name, unit in units.items() if unit == "kg*m^2" and name not in own_axis}
    if form is None or not massless:
        return
    bare = form.bound({**mechanism.parameters, **massless})
    for place, q in enumerate(mechanism.coordinates):
        if mechanism.units.get(q, "rad") != "rad":
            continue
        all_, moved = (_inertia(one, place, {**at, q: np.array([PLACES])}) for one in (mechanism, bare))
        if (most := float(moved.max())) > 0:
            what = f"inertia that turns with {q} / mass that it moves * its lever^2"
            yield from proportion("turning_share", what, float((all_ - moved).max()) / most)


def _inertia(mechanism: Mechanism, place: int, at: Mapping[str, Any]) -> np.ndarray:
    """A diagonal entry of the mass matrix at each of `PLACES`; what `at` does not name is 0 [kg*m^2]."""
    dynamics, n = mechanism.functions["dynamics"], len(mechanism.coordinates)
    matrices = np.asarray(dynamics(*(at.get(name, 0.0) for name in dynamics.name_in()))[0])
    return matrices.reshape(n, -1, n)[place, :, place]
