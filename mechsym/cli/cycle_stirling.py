"""What `mechsym cycle` shows of a Stirling engine: work, heats, efficiency, losses, and both diagrams."""

from pathlib import Path
from typing import Any

from mechsym.cli.common import emit, table
from mechsym.quantities.display import ratio_text

_SPEEDS = ("speed_rpm", "torque_avg", "torque_max", "power_kw", "efficiency", "p_max_mpa")
_TURN = ("work_j", "work_hot_j", "work_cold_j", "heat_in_j", "heat_out_j", "heat_regenerator_j",
         "indicated_efficiency")  # fmt: skip


def show(case: Any, omega: Any, as_json: bool, out: Path | None) -> None:
    """Print the figures over the speeds, and write curves of the first of them.

    Parameters
    ----------
    omega : ndarray, shape (n,)
        Shaft speeds [rad/s]
    """
    from mechsym.jobs.cycle import columns_of_stirling
    from mechsym.jobs.judged import of_cycle

    found = columns_of_stirling(case, omega)
    files = _write(out, case, found, float(omega[0])) if out else []
    emit(
        found | {"doubts": of_cycle(case, found)},
        as_json,
        lambda: "\n".join([_text(found), *(f"written: {file}" for file in files)]),
    )


def _text(found: dict[str, Any]) -> str:
    count = len(found["speed_rpm"])
    every = max(1, -(-count // 20))
    shown = range(0, count, every)

    def rows(names: Any, columns: Any) -> str:
        return table([{name: float(columns[name][i]) for name in names} for i in shown], list(names))

    lines = [rows(_SPEEDS, found), "", "a turn", rows(_TURN, found)]
    if found["losses"]:
        lines += ["", "lost [W]: work, and heat past the cycle", rows(tuple(found["losses"]), found["losses"])]
    if every > 1:
        lines.append(f"{len(shown)} of {count} points shown; all with --json or --out")
    worst = float(abs(found["energy_residual"]).max())
    return "\n".join([*lines, "", f"first law closed to {ratio_text(worst, 1)} of the heat from the hot side"])


def _write(out: Path, case: Any, found: dict[str, Any], omega: float) -> list[Path]:
    from mechsym.cycle.plots_stirling import stirling_picture
    from mechsym.files import write_quantities
    from mechsym.jobs.cycle import stirling_curves

    curves = stirling_curves(case, omega)
    flat = {k: v for k, v in found.items() if k not in ("fractions", "loads", "losses")}
    flat |= {f"fraction_{k}": v for k, v in found["fractions"].items()}
    flat |= {f"loss_{name}_w": values for name, values in found["losses"].items()}
    return [
        write_quantities(out / "performance.csv", flat),
        write_quantities(out / "cycle.csv", curves),
        stirling_picture(out / "cycle.svg", curves),
    ]
