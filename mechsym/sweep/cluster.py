"""Chunks of points on a cluster: any scheduler of dask.distributed, on this machine or far away.

A worker computes what a process of this machine would, one chunk at a time. It must run the same program; a case file
of one's own must lie at the same path there.
"""

import functools
import threading
from collections.abc import Callable, Generator, Sequence
from typing import TYPE_CHECKING

from mechsym.errors import BadInput, MissingExtra
from mechsym.sweep import store, work
from mechsym.sweep.outcomes import Gap

if TYPE_CHECKING:
    from distributed import Client, Future

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
        return work.Done(members=chunk.members, outcomes=(gap,) * len(chunk.members), seconds=0.0, host="")
    return done
