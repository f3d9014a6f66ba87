"""What `mechsym cycle` shows of an engine whose gas exchange is followed."""

from pathlib import Path
from typing import Any

from mechsym.cli.common import emit, table
from mechsym.quantities.display import ratio_text

_SPEEDS = ("speed_rpm", "torque_avg", "power_kw", "mep_kpa", "pumping_mep_kpa", "sfc_g_kwh", "efficiency", "p_max_mpa")
_BREATH = ("speed_rpm", "volumetric_efficiency", "residual_gas", "air_kg_h", "p_in_kpa", "t_in_k", "p_out_kpa",
           "t_exhaust_k", "knock")  # fmt: skip
_BRAKE = ("speed_rpm", "friction_mep_kpa", "brake_torque", "brake_power_kw", "brake_sfc_g_kwh", "brake_efficiency")


def show(case: Any, omega: Any, as_json: bool, out: Path | None) -> None:
    """Print the figures over the speeds, and write curves of the first of them.

    Parameters
    ----------
    omega : ndarray, shape (n,)
        Crank speeds [rad/s]
    """
    from mechsym.cycle.breathing.engine import figures
    from mechsym.jobs.cycle import breathing
    from mechsym.jobs.judged import of_limits
    from mechsym.jobs.whole_engine import of_engine

    run = breathing(case, omega)
    found = of_engine(case, figures(run), omega)
    files = _write(out, run, found) if out else []
    emit(
        found | {"doubts": of_limits(case, found)},
        as_json,
        lambda: "\n".join([_text(found), *(f"written: {file}" for file in files)]),
    )


def _text(found: dict[str, Any]) -> str:
    count = len(found["speed_rpm"])
    every = max(1, -(-count // 20))

    def rows(names: tuple[str, ...]) -> str:
        return table([{n: float(found[n][i]) for n in names} for i in range(0, count, every)], list(names))

    lines = ["indicated, gas exchange included", rows(_SPEEDS), "", "gas exchange", rows(_BREATH), "", "brake",
             rows(_BRAKE)]  # fmt: skip
    if every > 1:
        lines.append(f"{len(range(0, count, every))} of {count} points shown; all with --json or --out")
    mass, energy = (float(found[f"{name}_residual"].max()) for name in ("mass", "energy"))
    closed = f"mass closed to {ratio_text(mass, 1)} of the charge, first law to {ratio_text(energy, 1)} of its energy"
    return "\n".join([*lines, "", closed])


def _write(out: Path, run: Any, found: dict[str, Any]) -> list[Path]:
    from mechsym.cycle.breathing.engine import curves
    from mechsym.cycle.plots import performance_picture
    from mechsym.cycle.plots_breathing import breathing_picture
    from mechsym.files import write_quantities

    one = curves(run)
    flat = {k: v for k, v in found.items() if k not in ("fractions", "loads", "cylinders", "each", "per_cylinder")}
    flat |= {f"fraction_{k}": v for k, v in found["fractions"].items()}
    files = [
        write_quantities(out / "performance.csv", flat),
        write_quantities(out / "cycle.csv", one),
        breathing_picture(out / "cycle.svg", one, run.engine.breathing),
    ]
    if len(found["speed_rpm"]) > 1:
        files.append(performance_picture(out / "performance.svg", {"": found}))
    return files
