"""Runs with events: a leg for each mode, from one zero of a guard to the next, with blows between.

    leg --- zero of a guard --- blow? --- which mode now? --- leg ...

The integrator ends a leg where a guard is zero to the last digit; one Newton step by the guard's own formula takes off
what its integration has lost. A bounce whose rest is shorter than 1e-7 of the run is summed up: the body stays.
"""

from dataclasses import replace

import numpy as np

from mechsym.errors import BadInput
from mechsym.mechanisms.roles import FrictionRole, StopRole
from mechsym.native.runs import Level
from mechsym.quantities.units import Array, Second
from mechsym.simulate import blows, constrained
from mechsym.simulate.equations import System
from mechsym.simulate.integrate import integrate as whole_run
from mechsym.simulate.laws import Model, model
from mechsym.simulate.modes import ZERO, Now, frictions, look, settle
from mechsym.simulate.phase import Raw
from mechsym.simulate.problem import Problem
from mechsym.simulate.result import Happened, RunEvent
from mechsym.simulate.settings import Settings

_ABOVE = 1e-300  # a guard that leaves zero: above it, so that a return within the first step is seen
_LEAVING = 1e-14  # of a gap that opens without speed: below it rounding could close it at once [m] or [rad]
_CHATTER = 1e-7  # of the run: a bounce that ends within this is over [-]
_MOST, _STUCK = 100_000, 60
_CLOSED = 1e-9  # a gap at the start, beyond which a stop is passed [m] or [rad]
_LOOKS = 12  # at the fixed point of a leg
_SINGULAR = 1e-6  # condition of loops that are singular [-]
_FALLS = 0.3  # of a determinant, after which other coordinates are chosen [-]
MARGIN = "margin"


def integrate(
    problem: Problem, settings: Settings, wanted: Second[Array], ends: list[Second]
) -> tuple[System, Raw, Happened]:
    """A whole run from event to event.

    ends: ends of the stretches in which nothing jumps. Returns equations, raw, happened: equations without guards.
    """
    known = model(problem, tuple(problem.mechanism.dependents))
    now = _start(problem, known)
    known = _chosen(problem, known, now)
    times, states, steps, end, failure, idle = [np.array([now.t])], [now.y[None]], 0, "t_end", "", 0
    missed, rested, done = np.inf, False, now.t
    for _ in range(_MOST):
        later = [min(next(e for e in ends if e > now.t), missed)]
        levels = _levels(known, now)
        turns = problem.turns and problem.turns - (now.y[0] - problem.q0[0]) / (2 * np.pi)
        n, due = known.system.size, wanted[(wanted > done) & (wanted <= later[0])]
        here = replace(
            problem, q0=tuple(now.y[:n]), u0=tuple(now.y[n : 2 * n]), t_start=now.t, t_end=later[0], turns=turns
        )
        equations = replace(known.system, fixed=tuple(now.mode))
        leg = whole_run(here, equations, settings, due, later, _guarded(known, now), levels)
        missed = _missed(known, leg)
        if missed < np.inf and missed < later[0]:
            continue
        reached = np.isin(leg.t, due)
        times.append(leg.t[reached])
        states.append(_closed(known, leg.y[reached, : known.base]))
        _require_contraction(known, now, leg)
        idle = idle + 1 if leg.t[-1] - now.t <= 1e-15 * abs(now.t) else 0
        now.t, now.y = float(leg.t[-1]), _closed(known, leg.y[-1:, : known.base])[0]
        steps, failure = steps + leg.steps, leg.failure
        if failure or leg.end not in (*levels, "t_end") or now.t >= problem.t_end:
            end = leg.end
            break
        done = max(done, now.t)  # an event made exact may lie before
        if leg.end == MARGIN:
            known = _chosen(problem, known, now)
            continue
        _pass(known, now, leg.end if leg.end in levels else "", problem)
        over = wanted[(wanted > done) & (wanted <= now.t)]  # by a bounce that is summed up
        times.append(over)
        states.append(np.repeat(now.y[None], len(over), axis=0))
        done = max(done, now.t)
        if idle > _STUCK and not rested:
            _stay(known, now)
            rested, idle = True, 0
        elif idle > _STUCK:
            failure = f"stopped at t = {now.t:.6g} s: {now.events[-1].name} changes again and again without time"
            break
        if now.t >= problem.t_end:
            break
    else:
        failure = (
            f"stopped at t = {now.t:.6g} s: {_MOST} events were not enough; raise restitution losses or end before"
        )
    all_t, all_y = np.concatenate(times), np.concatenate(states)
    if all_t[-1] < now.t:
        all_t, all_y = np.append(all_t, now.t), np.vstack([all_y, now.y])
    bare = replace(known.system, columns=known.system.columns[: known.base], units=known.system.units[: known.base])
    raw = Raw(t=all_t, y=all_y, steps=steps, end="failure" if failure else end, failure=failure)
    return bare, raw, Happened(events=tuple(now.events), contraction=now.contraction or None)


def _chosen(problem: Problem, known: Model, now: Now) -> Model:
    """The equations for the best choice of the coordinates that loops hold, and how far its determinant may fall.

    Raises BadInput: the loops are singular there.
    """
    if known.margin is None:
        return known
    choice = constrained.choose(problem.mechanism, now.y[: known.system.size], known.dependents)
    if choice.condition < _SINGULAR:
        why = f"{problem.mechanism.name} comes to a singular pose of its loops at t = {now.t:.6g} s"
        raise BadInput(f"{why}, and stops and friction go through none; end before, or start otherwise")
    if choice.determinant < 0.5 * choice.best_determinant:
        known = model(problem, choice.best)
    now.floor = float(look(known, now).guards[known.margin or 0] + np.log(_FALLS))
    return known


def _closed(known: Model, y: np.ndarray) -> np.ndarray:
    """States with coordinates and velocities put on the closure of the loops."""
    n = known.system.size
    if known.margin is None or not len(y):
        return y.copy()
    q_u = known.pose.map(len(y))(y[:, :n].T, y[:, n : 2 * n].T)
    return np.hstack([*(np.asarray(v).T for v in q_u), y[:, 2 * n :]])


def _missed(known: Model, leg: Raw) -> Second:
    """When a gap that a step has jumped over is deepest, or a force least; infinity where none is below 0."""
    kind, _, number = leg.end.partition(" ")
    if kind not in ("turn", "dip"):
        return np.inf
    value = leg.y[-1, known.base + known.places[int(number)] + (0 if kind == "turn" else 2)]
    return float(leg.t[-1]) if value < (-ZERO if kind == "turn" else 0.0) else np.inf


def _require_contraction(known: Model, now: Now, leg: Raw) -> None:
    r"""Keep the largest rate at which iteration of the normal forces would converge; refuse one that would not.

    .. math:: \rho(\partial f/\partial p) < 1
    """
    if not any(getattr(one.role, "reactions", ()) for one in known.elements):
        return
    here = Now(t=now.t, y=now.y, mode=now.mode)
    for row in np.unique(np.linspace(0, len(leg.t) - 1, _LOOKS).astype(int)):
        here.t, here.y = float(leg.t[row]), leg.y[row, : known.base]
        gain = look(known, here).gain
        rate = float(np.abs(np.linalg.eigvals(gain)).max()) if np.isfinite(gain).all() else np.inf
        if rate >= 1:
            raise BadInput(
                f"the friction locks itself at t = {here.t:.6g} s: its normal forces grow by {rate:.3g} in each turn "
                "of the fixed point; lower mu or radius"
            )
        now.contraction = max(now.contraction, rate)


def _impulses(known: Model, now: Now) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Mass matrix, generalised forces of the elements, and the velocities that their impulses change."""
    mass, W, along, _ = (np.asarray(o) for o in known.blow.call([now.y[: known.system.size]]))
    return mass, W, along


def _slow(known: Model, now: Now, short: Second) -> bool:
    """Whether all that touches goes no faster than in so short a time, so that blows from stop to stop are over."""
    seen = look(known, now)
    near = [
        i
        for i, (one, place) in enumerate(zip(known.elements, known.places, strict=True))
        if isinstance(one.role, StopRole) and abs(seen.guards[place]) < _CLOSED
    ]
    if any(known.elements[i].sizes.get("restitution", 0.0) for i in near):
        return False
    return float(np.abs(seen.v[near]).max(initial=0.0)) < 10 * short * float(np.abs(seen.v_rate).max(initial=0.0))


def _stay(known: Model, now: Now) -> None:
    """Bounces from stop to stop that take no time any more: the body stays on all that it touches."""
    n, seen = known.system.size, look(known, now)
    for i, (one, place) in enumerate(zip(known.elements, known.places, strict=True)):
        if isinstance(one.role, StopRole) and "stiffness" not in one.sizes and abs(seen.guards[place]) < _CLOSED:
            now.touching.add(i)
    if not now.touching:
        return
    quick = [one for one in now.events if one.kind in ("hit", "rest") or one.t < now.t]
    now.events = quick  # what changed again and again without time is no event
    mass, W, along = _impulses(known, now)
    rubbing = {k for k in frictions(known) if known.elements[k].contact in now.touching}
    u = now.y[n : 2 * n].copy()
    held = sorted(now.touching | rubbing)
    now.y[n : 2 * n] = blows.stay(W[:, held], along[:, held], u)
    lost = float(u @ mass @ u - now.y[n : 2 * n] @ mass @ now.y[n : 2 * n]) / 2
    now.y[known.base - 1] += lost
    names = " and ".join(known.elements[i].role.name for i in sorted(now.touching))
    now.events.append(RunEvent(name=names, kind="rest", t=now.t, lost=lost))
    settle(known, now)


def _start(problem: Problem, known: Model) -> Now:
    q_u = constrained.start(problem) if known.dependents else (problem.q0, problem.u0)
    y = np.concatenate([*q_u, np.zeros(known.base - 2 * known.system.size)])
    now = Now(t=problem.t_start, y=y, mode=np.zeros(2 * len(known.elements) + 1))
    seen = look(known, now)
    for i, (one, place) in enumerate(zip(known.elements, known.places, strict=True)):
        if isinstance(one.role, FrictionRole):
            if one.role.law != "smooth" and abs(seen.guards[place]) <= ZERO:
                now.still.add(i)
            continue
        gap, speed = seen.guards[place : place + 2]
        if "stiffness" in one.sizes:
            now.mode[len(known.elements) + i] = float(gap < 0)
        elif gap < -_CLOSED:
            why = f"{one.role.name} is passed at the start: its gap is {gap:g}"
            raise BadInput(f"{why}; start on its free side, or turn its side about")
        elif gap <= ZERO and speed <= ZERO:
            now.touching.add(i)
    _hit(known, now)
    settle(known, now)
    return now


def _levels(known: Model, now: Now) -> dict[str, Level]:
    """Guards that end a leg of the mode, by what they mean."""
    m, base, levels, seen = len(known.elements), known.base, {}, look(known, now)

    def watch(what: str, i: int, place: int, direction: int) -> None:
        levels[f"{what} {i}"] = Level(state=base + place, level=0.0, direction=direction)

    if known.margin is not None:
        levels[MARGIN] = Level(state=base + known.margin, level=now.floor, direction=-1)
    if now.mode[-1]:
        watch("slip+", 0, len(seen.guards) - 2, 1)
        watch("slip-", 0, len(seen.guards) - 1, -1)
    for i, (one, place) in enumerate(zip(known.elements, known.places, strict=True)):
        sticks, way = now.mode[i], int(now.mode[m + i])
        if isinstance(one.role, StopRole):
            if sticks:
                watch("release", i, place + 2, -1)
                if known.dips:
                    watch("dip", i, place + 3, 1)
            elif way:
                watch("release", i, place, 1)
            else:
                watch("hit", i, place, -1)
                if max(abs(seen.guards[place + 1]), abs(seen.v_rate[i])) > ZERO:  # a gap may stay as it is
                    watch("turn", i, place + 1, 1)
        elif one.role.law != "smooth" and not now.mode[-1]:
            if sticks:
                watch("slip-", i, place + 1, -1)
                watch("slip+", i, place + 2, -1)
            elif way:
                watch("stick", i, place, -way)
    return levels


def _guarded(known: Model, now: Now) -> np.ndarray:
    """The state with its guards; those that have just been zero start beyond it."""
    m, seen = len(known.elements), look(known, now)
    guards = seen.guards.copy()
    for i, (one, place) in enumerate(zip(known.elements, known.places, strict=True)):
        if isinstance(one.role, StopRole):
            if now.mode[i]:
                guards[place + 2] = max(guards[place + 2], _ABOVE)
                if i in now.turned:
                    guards[place + 3] = max(guards[place + 3], _ABOVE)
            elif "stiffness" not in one.sizes and -_CLOSED < guards[place] <= ZERO:
                guards[place] = max(guards[place], _LEAVING if i in now.opened else _ABOVE)
            if i in now.turned and not now.mode[i]:
                guards[place + 1] = np.copysign(_ABOVE, seen.v_rate[i])
        elif one.role.law != "smooth":
            guards[place + 1 : place + 3] = np.maximum(guards[place + 1 : place + 3], _ABOVE)
            if i in now.still and not now.mode[i]:
                guards[place] = now.mode[m + i] * _ABOVE
    if now.mode[-1]:
        guards[-2:] = min(guards[-2], -_ABOVE), max(guards[-1], _ABOVE)
    return np.concatenate([now.y, guards])


def _pass(known: Model, now: Now, met: str, problem: Problem) -> None:
    """Go through an event: the time made exact, blows, and the mode behind it."""
    kind, _, number = met.partition(" ")
    i, m, n = int(number or 0), len(known.elements), known.system.size
    if met:
        _polish(known, now, kind, i)
    now.turned, now.still = (
        {i} if kind in ("turn", "dip") else set(),
        {k for k in range(m) if now.mode[k]} & frictions(known),
    )
    now.opened = {i} if kind == "release" else set()
    now.touching = {k for k in range(m) if now.mode[k]} - frictions(known)
    banned = i if kind in ("release", "slip+", "slip-") and not now.mode[-1] else -1
    if kind in ("turn", "dip"):
        return
    if now.mode[-1]:
        now.still |= frictions(known)
    if kind == "stick":
        now.still.add(i)
    one = known.elements[i]
    if kind in ("hit", "release") and "stiffness" in one.sizes:
        now.mode[m + i] = float(kind == "hit")
        now.events.append(RunEvent(name=one.role.name, kind="touch" if kind == "hit" else kind, t=now.t))
    elif kind == "hit":
        now.touching.add(i)
        last = next((one.t for one in reversed(now.events) if one.kind == "hit"), -np.inf)
        _hit(known, now)
        short = _CHATTER * (problem.t_end - problem.t_start)
        if now.t - last < short and _slow(known, now, short):
            _stay(known, now)
            return
        _chatter(known, now, problem)
    elif kind in ("release", "slip+", "slip-"):
        if kind == "release":  # what integration has left of its speed would close it again at once
            _, W, along = _impulses(known, now)
            now.y[n : 2 * n] = blows.stay(W[:, [i]], along[:, [i]], now.y[n : 2 * n])
        now.events.append(RunEvent(name=one.role.name, kind=kind.rstrip("+-"), t=now.t))
    settle(known, now, banned, kind if now.mode[-1] and kind.startswith("slip") else "")
    if kind == "stick":
        sticks = now.mode[i] or now.mode[-1]
        now.events.append(RunEvent(name=one.role.name, kind="stick" if sticks else "turn", t=now.t))


def _polish(known: Model, now: Now, kind: str, i: int) -> None:
    """One Newton step in time to the zero of a guard by its own formula."""
    place, seen = known.places[i], look(known, now)
    stop = isinstance(known.elements[i].role, StopRole)
    if now.mode[-1] and kind in ("slip+", "slip-"):
        place = len(seen.guards) - (2 if kind == "slip+" else 1)
    elif stop:
        place += {"turn": 1, "dip": 3, "release": 2 if now.mode[i] else 0}.get(kind, 0)
    else:
        place += {"slip-": 1, "slip+": 2}.get(kind, 0)
    rate = seen.rates[known.base + place]
    step = -seen.guards[place] / rate if rate else 0.0
    if abs(step) < 1e-6 * max(abs(now.t), 1e-3):  # what is longer is no rest of integration
        now.t, now.y = float(now.t + step), now.y + step * seen.rates[: known.base]


def _hit(known: Model, now: Now) -> None:
    """The blow of all stops that close; none where nothing closes."""
    n, seen = known.system.size, look(known, now)
    speed = max(1.0, float(np.abs(now.y[n : 2 * n]).max()))
    for i, (one, place) in enumerate(zip(known.elements, known.places, strict=True)):
        if isinstance(one.role, StopRole) and "stiffness" not in one.sizes and not now.mode[i]:
            gap, v = seen.guards[place : place + 2]
            if gap <= ZERO and v < -ZERO * speed:
                now.touching.add(i)
    closing = {i for i in now.touching if seen.v[i] < -ZERO * speed}
    if not closing:
        return
    mass, W, along = _impulses(known, now)
    blow = blows.solve(known.elements, now.touching, seen.v, mass, W, along)
    now.y[n : 2 * n] += blow.change
    now.y[known.base - 1] += blow.lost
    names = " and ".join(known.elements[i].role.name for i in sorted(closing))
    now.events.append(RunEvent(name=names, kind="hit", t=now.t, lost=blow.lost))


def _chatter(known: Model, now: Now, problem: Problem) -> None:
    r"""A bounce that is nearly over is summed up: its time is :math:`2 v/(a (1 - e))`, and the body stays."""
    n = known.system.size
    open_mode = now.mode.copy()
    open_mode[[*now.touching]] = 0.0
    after = look(known, now, open_mode)
    speed, longest = max(1.0, float(np.abs(now.y[n : 2 * n]).max())), 0.0
    for i in sorted(now.touching):
        v, a, e = after.v[i], after.v_rate[i], known.elements[i].sizes.get("restitution", 0.0)
        if v <= ZERO * speed and (e == 0 or a < 0):
            continue
        rest = 2 * v / (-a * (1 - e)) if a < 0 and e < 1 else np.inf
        if rest > _CHATTER * (problem.t_end - problem.t_start):
            now.touching.discard(i)
        else:
            longest = max(longest, rest)
    if not longest:
        return
    mass, W, along = _impulses(known, now)
    u = now.y[n : 2 * n].copy()
    held = sorted(now.touching)
    now.y[n : 2 * n] = blows.stay(W[:, held], along[:, held], u)
    lost = float(u @ mass @ u - now.y[n : 2 * n] @ mass @ now.y[n : 2 * n]) / 2
    now.y[known.base - 1] += lost
    settle(known, now)
    now.t, now.y = float(now.t + longest), now.y + longest * look(known, now).rates[: known.base]
    names = " and ".join(known.elements[i].role.name for i in sorted(now.touching))
    now.events.append(RunEvent(name=names, kind="rest", t=now.t, lost=lost))
