"""An interrupt or a request to end, noted and obeyed between two points."""

import contextlib
import signal
import threading
from collections.abc import Iterator
from typing import Any


@contextlib.contextmanager
def asked_to_stop() -> Iterator[threading.Event]:
    """An event that Ctrl-C or SIGTERM sets; a second one is raised at once.

    As an exception the first would be lost or turned into another one wherever a library catches everything.
    """
    asked = threading.Event()

    def note(number: int, frame: Any) -> None:
        if asked.is_set():
            raise KeyboardInterrupt
        asked.set()

    # what somebody else handles, or the shell told us to ignore, stays as it is
    usual: dict[int, Any] = {signal.SIGINT: signal.default_int_handler, signal.SIGTERM: signal.SIG_DFL}
    ours = [n for n, handler in usual.items() if signal.getsignal(n) is handler] if _main() else []
    for number in ours:
        signal.signal(number, note)
    try:
        yield asked
    except KeyboardInterrupt:
        asked.set()
    finally:
        for number in ours:
            signal.signal(number, usual[number])


def _main() -> bool:
    return threading.current_thread() is threading.main_thread()
