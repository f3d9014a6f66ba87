"""Modes of a run with stops and friction: which close, stick and slide at a state."""

from dataclasses import dataclass, field
from itertools import product

import numpy as np

from mechsym.errors import BadInput
from mechsym.mechanisms.roles import FrictionRole, StopRole
from mechsym.simulate.equations import held
from mechsym.simulate.laws import Model
from mechsym.simulate.result import RunEvent

ZERO = 1e-11  # speeds and gaps below it, by those of the run, are zero after an event [-]


@dataclass
class Now:
    """Where a run stands."""

    t: float
    y: np.ndarray  # without guards
    mode: np.ndarray
    touching: set[int] = field(default_factory=set)  # stops without gap and speed
    still: set[int] = field(default_factory=set)  # friction without speed
    turned: set[int] = field(default_factory=set)  # stops whose speed, or rate of force, has just passed zero
    opened: set[int] = field(default_factory=set)  # the stop that has just let go: it leaves as slowly as can be
    events: list[RunEvent] = field(default_factory=list)
    floor: float = -np.inf  # to which the determinant of the loops may fall, by its logarithm
    contraction: float = 0.0  # largest rate of the fixed point of normal forces


@dataclass
class Seen:
    """What the formulas say of a state."""

    p: np.ndarray
    v: np.ndarray
    v_rate: np.ndarray
    limit: np.ndarray
    guards: np.ndarray
    rates: np.ndarray
    gain: np.ndarray


def look(known: Model, now: Now, mode: np.ndarray | None = None) -> Seen:
    """What the formulas say where a run stands, in its mode or in another [-]."""
    w = np.concatenate([held(known.system, now.t)[: len(known.system.values)], now.mode if mode is None else mode])
    y = np.concatenate([now.y, np.zeros(len(known.system.columns) - known.base)])
    *flat, gain = (np.asarray(o) for o in known.look.call([now.t, y, w]))
    p, v, v_rate, limit, guards, rates = (o.ravel() for o in flat)
    return Seen(p=p, v=v, v_rate=v_rate, limit=limit, guards=guards, rates=rates, gain=gain)


def frictions(known: Model) -> set[int]:
    """Which elements are friction."""
    return {i for i, one in enumerate(known.elements) if isinstance(one.role, FrictionRole)}


def settle(known: Model, now: Now, banned: int = -1, way: str = "") -> None:
    """The mode in which the run goes on: the first whose forces and accelerations agree with it."""
    n, m, seen = known.system.size, len(known.elements), look(known, now)
    slow = ZERO * max(1.0, float(np.abs(now.y[n : 2 * n]).max()))
    set_valued = [i for i in frictions(known) if getattr(known.elements[i].role, "law", "") != "smooth"]
    now.still |= {i for i in set_valued if abs(seen.guards[known.places[i]]) <= slow}
    if known.holds and np.abs(now.y[n : 2 * n]).max() <= slow and now.still:
        now.y[n : 2 * n] = 0.0
        now.mode = _rest_or_not(known, now, way)
        return
    choices: list[tuple[tuple[float, float], ...]] = []
    for i, (one, place) in enumerate(zip(known.elements, known.places, strict=True)):
        if isinstance(one.role, StopRole):
            choices.append(((1, 0), (0, 0)) if i in now.touching and i != banned else ((0, now.mode[m + i]),))
        elif one.role.law == "smooth":
            choices.append(((0, 1),))
        elif i in now.still:
            choices.append(((1, 0), (0, 0), (0, 1), (0, -1))[2 * (i == banned) :])
        else:
            choices.append(((0, np.sign(seen.guards[place])),))
    for chosen in product(*choices):
        mode = np.array([*(k for k, _ in chosen), *(d for _, d in chosen), 0.0], dtype=float)
        for i, one in enumerate(known.elements):
            pressed = one.contact < 0 or mode[one.contact] or mode[m + one.contact]
            if isinstance(one.role, FrictionRole) and not pressed:
                mode[i] = mode[m + i] = 0.0
        if _agrees(known, now, mode, banned):
            now.mode = mode
            return
    names = ", ".join(known.elements[i].role.name for i in sorted(now.touching | now.still))
    raise BadInput(
        f"no mode of {names} goes on from t = {now.t:.6g} s: the friction locks itself, or contact and friction "
        "contradict each other (Painleve); lower mu, or give the stop stiffness and damping"
    )


def _agrees(known: Model, now: Now, mode: np.ndarray, banned: int) -> bool:
    """Whether forces have the right sign and what opens or begins to slide does so."""
    m, seen = len(known.elements), look(known, now, mode)
    if not np.isfinite(seen.p).all():
        return False
    force = 1e-9 * max(float(np.abs(seen.p).max(initial=0.0)), float(np.abs(seen.limit).max(initial=0.0)), 1e-300)
    rate = 1e-9 * max(float(np.abs(seen.v_rate).max(initial=0.0)), 1.0)
    for i, one in enumerate(known.elements):
        if isinstance(one.role, StopRole):
            if mode[i] and seen.p[i] < -force or not mode[i] and i in now.touching and seen.v_rate[i] < -rate:
                return False
        elif mode[i]:
            if abs(seen.p[i]) > seen.limit[i] + force:
                return False
        elif i in now.still and one.role.law != "smooth":
            way = mode[m + i]  # one of several that hold the same freedom may carry nothing
            loose = one.contact >= 0 and not mode[one.contact]
            if way * seen.v_rate[i] < -rate or not (way or loose) and abs(seen.v_rate[i]) > rate:
                return False
    return True


def _rest_or_not(known: Model, now: Now, way: str) -> np.ndarray:
    """The mode of a mechanism of one freedom without speed: friction holds it, or it goes the way that it is pushed."""
    n, m = known.system.size, len(known.elements)
    W = np.asarray(known.blow.call([now.y[:n]])[3])[0]
    rubbing = np.array([isinstance(e.role, FrictionRole) for e in known.elements])
    mode = np.concatenate([np.zeros(m), np.where(rubbing, np.sign(W), now.mode[m : 2 * m]), [1.0]])
    forwards, backwards = look(known, now, mode).guards[-2:]
    if not way and forwards <= 0 <= backwards:
        return mode
    sign = 1.0 if way == "slip+" or (not way and forwards > 0) else -1.0
    mode[m : 2 * m] = np.where(rubbing, sign * mode[m : 2 * m], mode[m : 2 * m])
    mode[-1] = 0.0
    for i in sorted(now.touching):
        mode[i] = 1.0
        if look(known, now, mode).p[i] < 0:
            mode[i] = 0.0
    return mode
