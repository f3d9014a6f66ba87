"""What a command may take without being asked: ten minutes of a processor and 2 GB; `--budget` says otherwise."""

import re
from contextvars import ContextVar

from mechsym.errors import BadInput
from mechsym.quantities import record
from mechsym.quantities.units import Second, parse


@record
class Budget:
    """Time and memory that a command may take."""

    seconds: float = 600.0  #: Of a processor [s]
    size: float = 2e9  #: Of memory [B]


_CHOSEN: ContextVar[Budget | None] = ContextVar("budget", default=None)
_SIZE = re.compile(r"(\d+(?:\.\d+)?)\s*(MB|GB)")
_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?")
_BYTES = {"MB": 1e6, "GB": 1e9}


def choose(text: str) -> None:
    """Set the budget of this command: time, memory or both, `2 h, 8 GB`. Raises BadInput: neither of them."""
    seconds, size = Budget().seconds, Budget().size
    for part in filter(None, (p.strip() for p in text.split(","))):
        if memory := _SIZE.fullmatch(part):
            size = float(memory[1]) * _BYTES[memory[2]]
        elif _NUMBER.fullmatch(part):
            raise BadInput(f"--budget {text!r}: {part} of what? write --budget '{part} min' or '{part} GB'")
        else:
            seconds = parse(part, "s", "--budget")
    if not (seconds > 0 and size > 0):
        raise BadInput(f"--budget {text!r}: time and memory must be above 0, for example --budget '2 h, 8 GB'")
    _CHOSEN.set(Budget(seconds=seconds, size=size))


def allowed() -> Budget:
    """The budget of this command."""
    return _CHOSEN.get() or Budget()


def require(what: str, seconds: Second, size: float, way_out: str) -> None:
    """Refuse work beyond the budget before it begins.

    what: the work with its size, for the message; seconds: forecast of its time on a processor; size: of its memory
    [B]. Raises BadInput: with what it would take and how to allow it.
    """
    chosen = allowed()
    if seconds <= chosen.seconds and size <= chosen.size:
        return
    hours = f"{seconds / 3600:.2g} h" if seconds >= 3600 else f"{seconds / 60:.2g} min"
    needs = f"about {hours}" + f" and {size / 1e9:.2g} GB" * (size > 0)
    limits = f"{chosen.seconds / 60:.3g} min and {chosen.size / 1e9:.3g} GB are allowed"
    asked = f"--budget '{1.5 * seconds / 60:.2g} min, {max(1.5 * size, 2e9) / 1e9:.2g} GB'"
    raise BadInput(f"{what} takes {needs}; {limits}: {way_out}, or say {asked}")
