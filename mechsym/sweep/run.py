"""Many runs of a case: points in chunks, finished points kept whatever happens to the others."""

import contextlib
import dataclasses
import signal
import threading
from collections.abc import Callable, Iterator, Mapping
from typing import Any

from mechsym import cases
from mechsym.errors import BadInput, suggest
from mechsym.quantities import record
from mechsym.sweep.axes import Axis, override, parse_axis, points, split
from mechsym.sweep.outcomes import Gap, Outcome, asked, flat, kept, known
from mechsym.sweep.points import ANALYSES, Route, route

Progress = Callable[[int], Any]
INTERRUPTED = Gap(reason="interrupted")


@record
class Plan:
    """What is to be swept."""

    case: str  #: Name of a built-in case or path of a file
    over: tuple[str, ...]  #: What to run over, each KEY=RANGE as in `axes`
    overrides: Mapping[str, Any] = dataclasses.field(default_factory=dict)  #: Values that hold at all points
    analysis: str | None = None  #: `simulate`, `hinge` or `cycle`; None takes what the case is for
    samples: int | None = None  #: Number of samples instead of a grid
    seed: int = 0
    show: tuple[str, ...] = ()  #: Results to compute and show in place of the main ones; `all` of them

    def __post_init__(self) -> None:
        if self.analysis not in (None, *ANALYSES):
            raise BadInput(f"analysis = {self.analysis!r} is not an option; options are {', '.join(ANALYSES)}")
        if self.seed < 0:
            raise BadInput(f"seed = {self.seed} is out of range; it must be >= 0")


@record
class Sweep:
    """What came out at every point."""

    case: str
    analysis: str
    axes: tuple[Axis, ...]
    dims: Mapping[str, int]
    points: tuple[tuple[Any, ...], ...]  #: Values of the axes at each point, the last axis fastest
    outcomes: tuple[Outcome, ...]  #: Results of each point by name, or why there are none
    show: tuple[str, ...] = ()  #: Results to compute and show in place of the main ones
    interrupted: bool = False  #: Whether it was stopped before its end; points not reached are gaps


@record
class Layout:
    """The points of a plan."""

    axes: tuple[Axis, ...]
    dims: Mapping[str, int]
    points: tuple[tuple[Any, ...], ...]  #: Values of the axes, the last axis fastest


def layout(plan: Plan) -> Layout:
    """The points of a plan, every key and unit checked against the case.

    Raises
    ------
    BadInput
        An axis is wrong, or a value is named twice
    """
    taken = {}
    for key in plan.overrides:
        found = cases.locate(plan.case, key, plan.overrides)
        taken[found.section, found.field] = f"--set {key}"
    axes = []
    for text in plan.over:
        key = split(text)[0]
        axis = parse_axis(text, cases.locate(plan.case, key, plan.overrides, option="--over"))
        place, name = (axis.place.section, axis.place.field), f"--over {key}"
        if place in taken:
            raise BadInput(f"{taken[place]} and {name} give the same value {'.'.join(place)}; keep one")
        taken[place] = name
        axes.append(axis)
    dims, values = points(tuple(axes), plan.samples, plan.seed)
    return Layout(axes=tuple(axes), dims=dims, points=tuple(values))


def sweep(plan: Plan, progress: Progress = lambda done: None) -> Sweep:
    """Run a case at every point.

    An interrupt from the keyboard ends the sweep after the points that are being computed and keeps what is finished,
    see `Sweep.interrupted`; a second one ends it at once.

    Parameters
    ----------
    progress : callable
        Called with the number of points that were done

    Raises
    ------
    BadInput
        The case or an axis is bad, or every point fails for one and the same reason
    """
    base, place = cases.load(plan.case, plan.overrides), layout(plan)
    chosen = route(base, plan.analysis, plan.show)
    outcomes: list[Outcome] = [INTERRUPTED] * len(place.points)
    with _asked_to_stop() as asked:
        for members in _chunks(len(place.points), chosen.together):
            if asked.is_set():
                break
            found = _run(plan, place, chosen, members)
            _check_shown(plan.show, found)
            outcomes[members.start : members.stop] = [o if isinstance(o, Gap) else kept(o, plan.show) for o in found]
            progress(len(members))
        else:
            asked.clear()  # too late to change anything
    interrupted = asked.is_set()
    if not interrupted:
        _check_reasons(outcomes)
    return Sweep(
        case=base.name, analysis=chosen.analysis, axes=place.axes, dims=place.dims, points=place.points,
        outcomes=tuple(outcomes), show=plan.show, interrupted=interrupted,
    )  # fmt: skip


@contextlib.contextmanager
def _asked_to_stop() -> Iterator[threading.Event]:
    """An event that an interrupt from the keyboard sets; a second one is raised at once.

    As an exception the first would be lost or turned into another one wherever a library catches everything.
    """
    asked = threading.Event()

    def note(number: int, frame: Any) -> None:
        if asked.is_set():
            raise KeyboardInterrupt
        asked.set()

    usual = signal.getsignal(signal.SIGINT)
    ours = threading.current_thread() is threading.main_thread() and usual is signal.default_int_handler
    if ours:
        signal.signal(signal.SIGINT, note)
    try:
        yield asked
    except KeyboardInterrupt:
        asked.set()
    finally:
        if ours:
            signal.signal(signal.SIGINT, usual)


def _chunks(count: int, together: int) -> list[range]:
    """Chunks of nearly one size, none longer than wanted."""
    parts = -(-count // together)
    ends = [count * i // parts for i in range(parts + 1)]
    return [range(a, b) for a, b in zip(ends, ends[1:], strict=False)]


def _run(plan: Plan, place: Layout, chosen: Route, members: range) -> list[Outcome]:
    outcomes: dict[int, Outcome] = {}
    loaded = {}
    for i in members:
        here = {a.key: override(a, v) for a, v in zip(place.axes, place.points[i], strict=True)}
        try:
            loaded[i] = cases.load(plan.case, {**plan.overrides, **here})
        except BadInput as error:
            outcomes[i] = known(error)
    outcomes |= dict(zip(loaded, chosen.run(list(loaded.values())), strict=True))
    return [o if isinstance(o, Gap) else flat(o) for o in (outcomes[i] for i in members)]


def _check_shown(show: tuple[str, ...], found: list[Outcome]) -> None:
    """Refuse a name that no result has, before the time of the whole sweep is spent."""
    names = {name for outcome in found if not isinstance(outcome, Gap) for name in outcome}
    for name in show if names else ():
        if name != "all" and not any(asked(n, name) for n in names):
            raise BadInput(f"--show {name} is no result here; {suggest(name, sorted(names))}")


def _check_reasons(outcomes: list[Outcome]) -> None:
    """What fails everywhere for one reason does not depend on the axes: bad input, not gaps."""
    reasons = {outcome.reason for outcome in outcomes if isinstance(outcome, Gap) and outcome.of_input}
    if len(reasons) == 1 and all(isinstance(outcome, Gap) and outcome.of_input for outcome in outcomes):
        raise BadInput(reasons.pop())
