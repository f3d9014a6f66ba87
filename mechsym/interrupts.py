"""Ctrl-C: a command ends within a second, whatever it is at, and keeps what is finished.

Python obeys an interrupt between two of its own steps. A solver in C may be long between them, and a library may catch
the exception or make another one of it. So a thread waits beside a command (`within_a_second`), and what must not be
cut in two puts the interrupt off (`whole`).
"""

import contextlib
import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator
from typing import Any

_PATIENCE = 0.7  # of the thread, from an interrupt to the end of the process [s]
_UNDER_WAY = 0.15  # for the points that are being computed [s]
STATUS = 130  # exit status
_WAIT = [signal.SIGINT, *([signal.SIGALRM] if hasattr(signal, "setitimer") else [])]  # of `asked_to_stop` too
WORDS = "mechsym: interrupted; files already named above are complete"

groups: set[int] = set()  #: Process groups that end with this process where the thread ends it
_moving = threading.RLock()  # held while files move into place, and while what is finished is written
_obeyed = threading.Event()  # an interrupt came, and what was computed since may be cut short


def check() -> None:
    """Interrupt again where a library caught the first one: its result is no result."""
    if _obeyed.is_set():
        raise KeyboardInterrupt


@contextlib.contextmanager
def whole() -> Iterator[None]:
    """A block that an interrupt waits for."""
    check()
    waiting: list[tuple[int, Any]] = []
    before = {number: signal.getsignal(number) for number in _WAIT} if _main() else {}
    ours = {number: handler for number, handler in before.items() if callable(handler)}
    with _moving:
        for number in ours:
            signal.signal(number, lambda *received: waiting.append(received))
        try:
            yield
        finally:
            for number, handler in ours.items():
                signal.signal(number, handler)
    for received in waiting[:1]:
        ours[signal.Signals(received[0])](*received)


@contextlib.contextmanager
def within_a_second(last: Callable[[], Any]) -> Iterator[None]:
    """A command: an interrupt that does not end it in time ends the process, `last` done before.

    What somebody else handles, or the shell told us to ignore, stays as it is.
    """
    usual = signal.getsignal(signal.SIGINT) is signal.default_int_handler
    if os.name != "posix" or not _main() or not usual:
        yield
        return
    _obeyed.clear()
    reading, writing = os.pipe()
    os.set_blocking(writing, False)
    signal.set_wakeup_fd(writing, warn_on_full_buffer=False)
    signal.signal(signal.SIGINT, _obey)
    sys.unraisablehook = _unraisable
    watch = threading.Thread(target=_watch, args=(reading, last), daemon=True)
    watch.start()
    try:
        yield
        check()
    except KeyboardInterrupt:
        raise  # the thread stays: what runs at the end of Python may take long as well
    except BaseException:
        if _obeyed.is_set():  # an error that a library made of the interrupt
            raise KeyboardInterrupt from None
        _unwatched(writing, watch)
        raise
    else:
        _unwatched(writing, watch)


def _unwatched(writing: int, watch: threading.Thread) -> None:
    signal.set_wakeup_fd(-1)
    sys.unraisablehook = sys.__unraisablehook__
    signal.signal(signal.SIGINT, signal.default_int_handler)
    os.close(writing)
    watch.join()


def _obey(number: int, frame: Any) -> None:
    _obeyed.set()
    raise KeyboardInterrupt


def _unraisable(lost: Any) -> None:
    if lost.exc_type is not KeyboardInterrupt:  # one that came where Python lets none out, and the thread obeys
        sys.__unraisablehook__(lost)


def _watch(reading: int, last: Callable[[], Any]) -> None:
    """Wait for the interrupt, which the system writes into a pipe whatever Python is at."""
    while number := os.read(reading, 1):
        if number[0] in (signal.SIGINT, signal.SIGTERM):
            break
    else:
        os.close(reading)
        return
    threading.Event().wait(_PATIENCE)
    with _moving:
        last()
        for group in tuple(groups):
            with contextlib.suppress(OSError):
                os.killpg(group, signal.SIGKILL)
        with contextlib.suppress(OSError):
            os.write(2, f"{WORDS}\n".encode())
        os._exit(STATUS)


@contextlib.contextmanager
def asked_to_stop() -> Iterator[threading.Event]:
    """An event that Ctrl-C or SIGTERM sets; what does not heed it at once, or a second one, is interrupted.

    As an exception the first would be lost or turned into another one wherever a library catches everything.
    """
    asked = threading.Event()
    timed = hasattr(signal, "setitimer")

    def note(number: int, frame: Any) -> None:
        if asked.is_set():
            raise KeyboardInterrupt
        asked.set()
        if timed:
            signal.setitimer(signal.ITIMER_REAL, _UNDER_WAY)

    usual: dict[int, Any] = {signal.SIGINT: (signal.default_int_handler, _obey), signal.SIGTERM: (signal.SIG_DFL,)}
    usual |= {signal.SIGALRM: (signal.SIG_DFL,)} if timed else {}
    before = {number: signal.getsignal(number) for number in usual} if _main() else {}
    ours = [number for number, handler in before.items() if handler in usual[number]]
    for number in ours:
        signal.signal(number, note)
    try:
        yield asked
    except KeyboardInterrupt:
        asked.set()
    finally:
        if timed and ours:
            signal.setitimer(signal.ITIMER_REAL, 0.0)
        for number in ours:
            signal.signal(number, before[number])


def _main() -> bool:
    return threading.current_thread() is threading.main_thread()
