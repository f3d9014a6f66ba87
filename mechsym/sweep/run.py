"""Many runs of a case: points in chunks, finished points kept whatever happens to the others.

Chunks go to processes of this machine or to a cluster: any scheduler of dask.distributed, here or far away. A worker
computes what a process would, one chunk at a time. It must run the same program; a case file of one's own must lie at
the same path there.
"""

import contextlib
import dataclasses
import functools
import os
import threading
from collections.abc import Callable, Generator, Iterator, Mapping, Sequence
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from mechsym import cases
from mechsym.cases.values import take
from mechsym.errors import BadInput, MissingExtra, suggest
from mechsym.files import inputs
from mechsym.interrupts import asked_to_stop
from mechsym.quantities import record
from mechsym.quantities.ranges import MOST
from mechsym.quantities.units import Second
from mechsym.sweep import store, work
from mechsym.sweep.axes import Axis, Ties, Value, along, override, parse_axis, points, saltelli, split, ties
from mechsym.sweep.outcomes import Gap, Outcomes, asked
from mechsym.sweep.points import ANALYSES, Route, route

if TYPE_CHECKING:
    from distributed import Client, Future


Progress = Callable[[int], object]
INTERRUPTED = Gap(reason="interrupted")
_WORTH = 10.0  # seconds of work from which processes pay for their start


@record
class Plan:
    """What is to be swept."""

    case: str  #: Name of a built-in case or path of a file
    over: tuple[str, ...]  #: What to run over, each KEY=RANGE as in `axes`
    overrides: Mapping[str, object] = dataclasses.field(default_factory=dict)  #: Values that hold at all points
    analysis: str | None = None  #: A name of `points.ANALYSES`; None takes what the case is for
    samples: int | None = None  #: Number of samples instead of a grid
    seed: int = 0
    sobol: int | None = None  #: Base samples of Sobol indices, a power of two; in place of `samples`
    tied: tuple[str, ...] = ()  #: Values that follow from others, each KEY=FORMULA as in `ties`
    show: tuple[str, ...] = ()  #: Results to compute and show in place of the main ones; `all` of them

    def __post_init__(self) -> None:
        if self.analysis not in (None, *ANALYSES):
            raise BadInput(f"analysis = {self.analysis!r} is not an option; options are {', '.join(ANALYSES)}")
        if self.seed < 0:
            raise BadInput(f"seed = {self.seed} is out of range; it must be >= 0")
        if self.sobol is None:
            return
        if self.samples is not None or not 2 <= self.sobol <= MOST or self.sobol & (self.sobol - 1):
            raise BadInput(f"sobol = {self.sobol}: give a power of two from 2 on, such as 256, and no samples besides")


@record
class Means:
    """How a plan is computed; the results are the same."""

    #: Processes; 0 for as many as there are cores where the work is worth their start
    jobs: int = 1
    folder: Path | None = None  #: Where finished points are kept as they come, see `store`
    fresh: bool = False  #: Forget what was kept
    scheduler: str = ""  #: Address of a dask cluster that computes in place of this machine


@record
class Sweep:
    """What came out at every point."""

    case: str
    analysis: str
    axes: tuple[Axis, ...]
    dims: Mapping[str, int]
    points: Sequence[tuple[Value, ...]]  #: Values of the axes at each point, the last axis fastest
    outcomes: Outcomes  #: Results of each point by name, or why there are none
    show: tuple[str, ...] = ()  #: Results to compute and show in place of the main ones
    sobol: int = 0  #: Base samples of Sobol indices; 0 where none were asked for
    interrupted: bool = False  #: Whether it was asked to stop; points not reached are gaps
    kept: int = 0  #: Points that were finished before, in the store of the same sweep
    aside: str = ""  #: Where the folder's points of another sweep went

    @functools.cached_property
    def by_name(self) -> dict[str, np.ndarray]:
        """Results by name, one for each point; see `data.columns` [SI, or as the name says]."""
        names = dict.fromkeys(name.partition(" [")[0] for name in self.outcomes.names)
        return {name: self.outcomes.column(name) for name in names}

    @functools.cached_property
    def units(self) -> dict[str, str]:
        """Unit of each result, that its name carries or tells; `-` of a pure number, empty of a word."""
        units = {name: name.partition(" [")[::2] for name in self.outcomes.names}
        return {stem: unit.rstrip("]") for stem, unit in units.values()}


@record
class Layout:
    """The points of a plan."""

    axes: tuple[Axis, ...]
    dims: Mapping[str, int]
    points: Sequence[tuple[Value, ...]]  #: Values of the axes, the last axis fastest
    ties: Ties  #: Values that follow from those of the axes


def layout(plan: Plan) -> Layout:
    """The points of a plan, keys and units checked. Raises BadInput: an axis is wrong, or a value named twice."""
    taken: dict[tuple[str, str], str] = {}
    for key in plan.overrides:
        take(taken, cases.locate(plan.case, key, plan.overrides), f"--set {key}")
    axes = []
    for text in plan.over:
        key = split(text)[0]
        axis = parse_axis(text, cases.locate(plan.case, key, plan.overrides, option="--over"))
        take(taken, axis.place, f"--over {key}")
        axes.append(axis)
    tied = ties(plan.case, plan.overrides, plan.tied, {axis.key: axis.place for axis in axes})
    for tie in tied.ties:
        if tie.place is not None:
            take(taken, tie.place, f"--tie {tie.key}")
    dims, values = points(tuple(axes), plan.sobol or plan.samples, plan.seed)
    if plan.sobol:
        values = saltelli(tuple(axes), plan.sobol, plan.seed)
        dims = {"sample": len(values)}
    return Layout(axes=tuple(axes), dims=dims, points=values, ties=tied)


def ends(laid: Layout) -> list[dict[str, str | float]]:
    """Overrides that set one value to its smallest or largest, for doubts about the case there."""
    overrides = []
    for i, axis in enumerate(laid.axes):
        values = along(laid.points, i).tolist() if "sample" in laid.dims else axis.values
        overrides += [{axis.key: override(axis, value)} for value in (min(values), max(values))]
    return overrides


def forecast(plan: Plan, count: int) -> Second:
    """How long a plan takes on one processor, by what a point of its analysis usually does.

    count: how many points `layout` found for the plan. Returns seconds: rough, of a usual machine.

    >>> forecast(Plan(case="nunes-slider-crank", over=("speed_rpm=1000..8000:5",)), 5)
    0.01
    """
    return count * route(cases.load(plan.case, plan.overrides), plan.analysis, plan.show).seconds


class Chunks(Sequence[work.Chunk]):
    """Chunks of nearly one size, none longer than wanted, made when they are asked for: their bounds are the same
    whatever was finished before, and those that are finished are left out."""

    def __init__(self, place: Layout, together: int, finished: np.ndarray) -> None:
        self._place, count = place, len(place.points)
        parts = -(-count // together)
        ends = [count * i // parts for i in range(parts + 1)]
        self._spans = [(a, b) for a, b in pairwise(ends) if not finished[a:b].all()]

    def __len__(self) -> int:
        return len(self._spans)

    def __getitem__(self, k: Any) -> Any:
        a, b = self._spans[k]
        axes, points = self._place.axes, self._place.points[a:b]
        heres = tuple({axis.key: override(axis, v) for axis, v in zip(axes, point, strict=True)} for point in points)
        return work.Chunk(members=range(a, b), heres=heres)

    @property
    def points(self) -> int:
        """How many there are in all."""
        return sum(b - a for a, b in self._spans)


def sweep(plan: Plan, progress: Progress = lambda done: None, means: Means | None = None) -> Sweep:
    """Run a case at every point.

    An interrupt from the keyboard or a request to end (SIGTERM) ends the sweep after the points that are being computed
    and keeps what is finished, see `Sweep.interrupted`; a second one ends it at once. progress: called with the number
    of points that were done. means: processes and store; in this process without a store where it is left away. Raises
    BadInput: the case or an axis is bad, or every point fails for one and the same reason.
    """
    means = means or Means()
    with inputs.reads() as read:
        base, place = cases.load(plan.case, plan.overrides), layout(plan)
        chosen = route(base, plan.analysis, plan.show)
    order = work.SweepOrder(
        case=plan.case, overrides=plan.overrides, analysis=chosen.analysis, show=plan.show, tied=plan.tied
    )
    outcomes = Outcomes(len(place.points), INTERRUPTED)
    before = np.zeros(len(place.points), dtype=bool)
    with inputs.reads() as read_there, _stored(plan, read, means) as kept_in, asked_to_stop() as asked_to:
        for members, rows in store.known(kept_in) if kept_in else ():
            outcomes.merge(members, rows)
            before[list(members)] = True
            progress(len(members))
        inputs.tell(store.files_read(kept_in) if kept_in else {})
        chunks = Chunks(place, chosen.together, before)
        with contextlib.closing(_computed(order, chosen, chunks, means, asked_to)) as results:
            for done in results:
                inputs.tell(done.reads)
                for name, content in done.reads.items():  # points of two contents of one file are refused
                    if (read | read_there).get(name, content) != content:
                        way = "the same command computes all points as it is now"
                        raise BadInput(f"{name} has changed while the sweep ran; {way}")
                _check_shown(plan.show, done.outcomes.names)
                outcomes.merge(done.members, shown := done.outcomes.shown(plan.show))
                if kept_in:
                    store.keep(kept_in, done, shown)
                progress(len(done.members))
    interrupted = asked_to.is_set()  # in its last points too: a study would go on with the next sweep
    refused = [gap for gap in outcomes.gaps.values() if gap.of_input]
    reasons = {outcome.reason for outcome in refused}
    # what fails everywhere for one reason does not depend on the axes: bad input, not gaps
    if not interrupted and len(reasons) == 1 and len(refused) == len(outcomes):
        raise BadInput(reasons.pop())
    return Sweep(
        case=base.name, analysis=chosen.analysis, axes=place.axes, dims=place.dims, points=place.points,
        outcomes=outcomes, show=plan.show, sobol=plan.sobol or 0,
        interrupted=interrupted, kept=int(before.sum()), aside=str((kept_in and kept_in.aside) or ""),
    )  # fmt: skip


@contextlib.contextmanager
def _stored(plan: Plan, read: Mapping[str, str], means: Means) -> Iterator[store.Store | None]:
    """The store of a plan, if it has a folder for one."""
    if means.folder is None:
        yield None
        return
    key = store.identity(
        read, case=plan.case, over=plan.over, overrides={k: str(v) for k, v in plan.overrides.items()},
        analysis=plan.analysis, samples=plan.samples, seed=plan.seed, show=sorted(set(plan.show)), sobol=plan.sobol,
        tied=plan.tied,
    )  # fmt: skip
    with store.opened(means.folder, key, means.fresh) as storage:
        yield storage


def _computed(
    order: work.SweepOrder, chosen: Route, chunks: Chunks, means: Means, asked_to: threading.Event
) -> Generator[work.Done, None, None]:
    if means.scheduler:
        return on_cluster(order, chunks, means.scheduler, asked_to)
    jobs = means.jobs
    if not jobs:  # as many as there are cores, or none where they would take longer to start than to work
        seconds = chosen.seconds * chunks.points
        pays = hasattr(os, "sched_getaffinity") and seconds > _WORTH
        jobs = len(os.sched_getaffinity(0)) if pays else 1
    if jobs > 1 and len(chunks) > 1:
        return work.on_processes(order, chunks, jobs, asked_to)
    return work.here(order, chunks, asked_to)


def _check_shown(show: tuple[str, ...], found: Sequence[str]) -> None:
    """Refuse a name that no result has, before the time of the whole sweep is spent."""
    names = {name.partition(" [")[0] for name in found} if show else ()
    for name in show if names else ():
        if name != "all" and not any(asked(n, name) for n in names):
            raise BadInput(f"--show {name} is no result here; {suggest(name, sorted(names))}")


_AHEAD = 4  # chunks that wait at each worker
_PAUSE = "200ms"  # between two looks at a request to end
_ALONE = threading.Lock()  # a worker with several threads computes with one


def on_cluster(
    order: work.SweepOrder, chunks: Sequence[work.Chunk], address: str, asked: threading.Event
) -> Generator[work.Done, None, None]:
    """Chunks on workers of a scheduler as they finish. Raises BadInput: none answers, or runs another program."""
    client = _client(address)
    try:
        waiting, program = list(reversed(chunks)), store.program()
        pending: dict[Future, work.Chunk] = {}
        while waiting or pending:
            if asked.is_set():
                waiting.clear()
            room = max(1, _AHEAD * len(client.nthreads())) - len(pending)
            for _ in range(min(room, len(waiting))):
                chunk = waiting.pop()
                pending[client.submit(remote, order, chunk, program, pure=False)] = chunk
            for future in _finished(list(pending)):
                yield _result(future, pending.pop(future))
    finally:
        client.close()


def remote(order: work.SweepOrder, chunk: work.Chunk, program: str) -> work.Done:
    """A chunk, computed by a worker."""
    if store.program() != program:
        raise BadInput("a worker of the cluster runs another mechsym, numpy, scipy or casadi; install the same there")
    with _ALONE:
        return _prepared(_Same(order))(chunk)


class _Same:
    """An order, equal to another one with the same content."""

    def __init__(self, order: work.SweepOrder) -> None:
        self.order = order

    def __hash__(self) -> int:
        return hash(repr(vars(self.order)))

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Same) and self.order == other.order


@functools.lru_cache(maxsize=4)
def _prepared(same: _Same) -> Callable[[work.Chunk], work.Done]:
    return work.prepared(same.order)


def _client(address: str) -> "Client":
    try:
        from distributed import Client
    except ImportError as error:
        why = f"--scheduler needs dask.distributed ({error})"
        raise MissingExtra(f"{why}; install it with pip install 'mechsym[cluster]'") from None
    try:
        return Client(address, timeout="10s")
    except (OSError, ValueError) as error:
        words = " ".join(str(error).split())
        raise BadInput(f"--scheduler {address}: no scheduler answers ({words}); write tcp://HOST:8786") from None


def _finished(pending: list["Future"]) -> list["Future"]:
    from distributed import wait

    try:
        return list(wait(pending, timeout=_PAUSE, return_when="FIRST_COMPLETED").done)
    except TimeoutError:
        return []


def _result(future: "Future", chunk: work.Chunk) -> work.Done:
    from distributed import KilledWorker

    try:
        done: work.Done = future.result()
    except KilledWorker:
        # the scheduler has tried it elsewhere before it gave up
        gap = Gap(reason="the workers of the cluster that computed it died")
        return work.Done(members=chunk.members, outcomes=Outcomes.of([gap] * len(chunk.members)), seconds=0.0, host="")
    return done
