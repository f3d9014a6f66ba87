"""Chunks of points, computed here or on processes of this machine.

A worker that dies (killed, out of memory, a crash in compiled code) takes no other point with it: its chunk is tried
once more, then its points one by one, and the one that kills again is a gap with the reason.
"""

import collections
import contextlib
import dataclasses
import multiprocessing as mp
import os
import signal
import socket
import sys
import threading
import time
import traceback
import types
from collections.abc import Callable, Generator, Iterator, Mapping, Sequence
from multiprocessing import connection
from multiprocessing.context import ForkServerContext, SpawnContext
from multiprocessing.process import BaseProcess

from mechsym import cases
from mechsym.errors import BadInput
from mechsym.files import inputs
from mechsym.quantities import record
from mechsym.sweep.axes import Value, ties
from mechsym.sweep.outcomes import Gap, Outcome, Outcomes, flat, known
from mechsym.sweep.points import READS, Route, route

Here = Mapping[str, Value]  # values of the axes at a point, as `--set` takes them
_PAUSE = 0.2  # between two looks at a request to end [s]
_ONE_THREAD = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")


@record
class SweepOrder:
    """What a worker has to know."""

    case: str
    overrides: Mapping[str, object]
    analysis: str
    show: tuple[str, ...]
    tied: tuple[str, ...] = ()  #: KEY=FORMULA as in `ties`


@record
class Done:
    """A finished chunk."""

    members: Sequence[int]
    outcomes: Outcomes
    seconds: float  #: Of a processor for one point [s]
    host: str
    reads: Mapping[str, str] = dataclasses.field(default_factory=dict)  #: Files that were read, see `inputs.reads`


@record
class Chunk:
    """Points that are computed in one call."""

    members: Sequence[int]
    heres: tuple[Here, ...]
    died: int = 0  #: How many workers it has killed


def prepared(order: SweepOrder) -> Callable[[Chunk], Done]:
    """The function that computes chunks of an order."""
    chosen = route(cases.load(order.case, order.overrides), order.analysis, order.show)

    def work(chunk: Chunk) -> Done:
        start = time.process_time()  # a clock would count what else the machine does
        with inputs.reads() as read:
            outcomes = tied(order, chosen, chunk.heres)
        seconds, host = (time.process_time() - start) / len(chunk.members), socket.gethostname()
        return Done(members=chunk.members, outcomes=outcomes, seconds=seconds, host=host, reads=read)

    return work


def tied(order: SweepOrder, chosen: Route, heres: Sequence[Here]) -> Outcomes:
    """Results of points whose tied values are worked out first; a formula without a value leaves a gap."""
    if not order.tied or not heres:
        return computed(order, chosen, heres)
    places = {key: cases.locate(order.case, key, order.overrides) for key in heres[0]}
    rules = ties(order.case, order.overrides, order.tied, places)
    ready: dict[int, Here] = {}
    gaps: dict[int, Gap] = {}
    for i, here in enumerate(heres):
        try:
            ready[i] = rules.at(here)
        except BadInput as error:
            gaps[i] = known(error)
    outcomes = Outcomes(len(heres))
    outcomes.put(list(gaps), list(gaps.values()))
    if ready:
        outcomes.merge(list(ready), computed(order, chosen, list(ready.values())))
    return outcomes


def computed(order: SweepOrder, chosen: Route, heres: Sequence[Here]) -> Outcomes:
    """Results of points by name, or why there are none."""
    if chosen.at is not None:
        return chosen.at(order.case, order.overrides, heres)
    outcomes: dict[int, Outcome] = {}
    loaded = {}
    for i, here in enumerate(heres):
        try:
            loaded[i] = cases.load(order.case, {**order.overrides, **here})
        except BadInput as error:
            outcomes[i] = known(error)
    outcomes |= dict(zip(loaded, chosen.run(list(loaded.values())), strict=True))
    return Outcomes.of([o if isinstance(o, Gap) else flat(o) for o in (outcomes[i] for i in range(len(heres)))])


def here(order: SweepOrder, chunks: Sequence[Chunk], asked: threading.Event) -> Generator[Done, None, None]:
    """Chunks one after the other in this process."""
    work = prepared(order)
    for chunk in chunks:
        if asked.is_set():
            return
        yield work(chunk)


def on_processes(
    order: SweepOrder, chunks: Sequence[Chunk], count: int, asked: threading.Event
) -> Generator[Done, None, None]:
    """Chunks on `count` processes, as they are finished."""
    fresh, waiting = iter(chunks), collections.deque[Chunk]()
    workers = [_started(order) for _ in range(min(count, len(chunks)))]
    busy: dict[int, Chunk] = {}
    try:
        while True:
            if asked.is_set():
                fresh, waiting = iter(()), collections.deque()
            for k in (k for k in range(len(workers)) if k not in busy):
                chunk = waiting.popleft() if waiting else next(fresh, None)
                if chunk is not None:
                    busy[k] = _sent(workers, k, chunk, order)
            if not busy:
                return
            ready = connection.wait([workers[k].pipe for k in busy], timeout=_PAUSE)
            for k in [k for k in busy if workers[k].pipe in ready]:
                chunk, answer = busy.pop(k), None
                with contextlib.suppress(EOFError, OSError):
                    answer = workers[k].pipe.recv()
                if answer is None:
                    again = _after_death(chunk, workers[k])
                    workers[k] = _started(order)
                    waiting.extendleft(reversed(again[0]))
                    yield from again[1]
                elif isinstance(answer, Exception):
                    raise answer
                else:
                    yield answer
    finally:
        for worker in workers:
            _ended(worker)


@dataclasses.dataclass
class _Worker:
    process: BaseProcess
    pipe: connection.Connection


def _context(analysis: str) -> SpawnContext | ForkServerContext:
    """Workers are forked by a process that has read the program once and has one thread, so that this is safe."""
    if "forkserver" not in mp.get_all_start_methods():
        return mp.get_context("spawn")
    context = mp.get_context("forkserver")
    context.set_forkserver_preload([__name__, *READS[analysis]])
    return context


def _started(order: SweepOrder) -> _Worker:
    context = _context(order.analysis)
    ours, theirs = context.Pipe()
    process = context.Process(target=_serve, args=(theirs, order), daemon=True, name="sweep")
    # two workers with two threads each would only wait for each other
    with _environment(dict.fromkeys(_ONE_THREAD, "1")), _no_interrupts(), _no_main():
        process.start()
    theirs.close()  # so that the end of the worker is the end of the pipe
    return _Worker(process=process, pipe=ours)


def _sent(workers: list[_Worker], k: int, chunk: Chunk, order: SweepOrder) -> Chunk:
    """Hand a chunk to a worker; one that died while it was idle is replaced."""
    try:
        workers[k].pipe.send(chunk)
    except OSError:
        _ended(workers[k])
        workers[k] = _started(order)
        workers[k].pipe.send(chunk)
    return chunk


def _after_death(chunk: Chunk, worker: _Worker) -> tuple[list[Chunk], list[Done]]:
    """What is tried again, and the points that are given up."""
    worker.process.join()
    again = dataclasses.replace(chunk, died=chunk.died + 1)
    if again.died < 2:
        return [again], []
    if len(chunk.members) > 1:
        pairs = zip(chunk.members, chunk.heres, strict=True)
        return [Chunk(members=(i,), heres=(place,), died=1) for i, place in pairs], []
    status = worker.process.exitcode
    cause = f"signal {signal.Signals(-status).name}" if status is not None and status < 0 else f"exit status {status}"
    gap = Gap(reason=f"the process that computed it died twice ({cause})")
    return [], [Done(members=chunk.members, outcomes=Outcomes.of([gap]), seconds=0.0, host=socket.gethostname())]


def _ended(worker: _Worker) -> None:
    worker.pipe.close()
    worker.process.kill()
    worker.process.join()


def _serve(pipe: connection.Connection, order: SweepOrder) -> None:
    """A worker: chunks in, what became of them out, until the pipe ends."""
    # the parent decides when to stop; a terminal sends Ctrl-C to everybody
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    threading.Thread(target=_end_with_parent, daemon=True).start()
    work = prepared(order)
    while True:
        try:
            chunk = pipe.recv()
        except (EOFError, OSError):
            return
        try:
            answer: Done | Exception = work(chunk)
        except Exception as error:
            error.add_note("".join(traceback.format_exception(error)))
            answer = error
        pipe.send(answer)


def _end_with_parent() -> None:
    parent = mp.parent_process()
    if parent is not None:
        connection.wait([parent.sentinel])
        os._exit(1)


@contextlib.contextmanager
def _no_interrupts() -> Iterator[None]:
    """What is started meanwhile never gets a Ctrl-C or a request to end: the parent decides when to stop."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    from multiprocessing import resource_tracker

    resource_tracker.ensure_running()  # its own start would end the block
    before = signal.pthread_sigmask(signal.SIG_BLOCK, (signal.SIGINT, signal.SIGTERM))
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


@contextlib.contextmanager
def _no_main() -> Iterator[None]:
    """A worker needs nothing of the script that sweeps, and would run it once more if it asks for no name."""
    script = sys.modules["__main__"]
    sys.modules["__main__"] = types.ModuleType("__main__")
    try:
        yield
    finally:
        sys.modules["__main__"] = script


@contextlib.contextmanager
def _environment(values: Mapping[str, str]) -> Iterator[None]:
    before = {name: os.environ.get(name) for name in values}
    os.environ.update(values)
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value
