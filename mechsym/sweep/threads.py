"""How many processors there are to compute on."""

import os


def cores() -> int:
    """Processors that this process may use.

    Returns
    -------
    cores : int
        At least 1
    """
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
