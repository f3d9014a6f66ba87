"""`mechsym cycle --loop`: the cycle and the mechanism's motion integrated together."""

import sys
from pathlib import Path
from typing import Any

from mechsym.cli.common import emit, table


def show(case: Any, cycles: float, as_json: bool, out: Path | None) -> None:
    """Run a case's loop, print what it did, and write its time series; exit status 1 when it stalls or fails.

    Parameters
    ----------
    cycles : float
        Engine cycles to run [-]
    """
    from mechsym.files import write_quantities
    from mechsym.jobs.judged import of_limits
    from mechsym.jobs.loop import loop
    from mechsym.simulate.loop.run import run_loop
    from mechsym.simulate.loop.summary import series, summary

    machine = loop(case)
    result = run_loop(machine, case.need("operation").speed, cycles)
    found = summary(machine, result)
    files = [write_quantities(out / "loop.csv", series(machine, result))] if out else []
    emit(
        found | {"doubts": of_limits(case, found)},
        as_json,
        lambda: "\n".join([_text(found), *(f"written: {file}" for file in files)]),
    )
    if result.status != "done":
        sys.exit(1)


def _text(found: dict[str, Any]) -> str:
    lines = [
        f"{found['status']}: {found['reason']}",
        f"last two turns: {found['speed_mean_rpm']:.2f} rpm, ripple {found['speed_ripple']:.4g}, "
        f"from {found['speed_min_rpm']:.2f} to {found['speed_max_rpm']:.2f} rpm",
    ]
    if found["cycles"]:
        lines.append(table(found["cycles"][-12:], list(found["cycles"][0])))
    return "\n".join([*lines, f"energy of the motion closed to {abs(found['energy_residual']):.1g} of the gas work"])
