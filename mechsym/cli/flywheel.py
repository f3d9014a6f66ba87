"""`mechsym flywheel`: the flywheel for a wanted ripple of the speed, and the run that proves it."""

from pathlib import Path

import click

from mechsym.cases import Case
from mechsym.cli.common import case_command, emit, out_option
from mechsym.errors import BadInput
from mechsym.files import Json
from mechsym.quantities.display import SMALLEST, figure, quantity_text, residual_text
from mechsym.quantities.results import tell


@case_command("Flywheel for a wanted ripple of the speed.", out_option)
@click.option(
    "--ripple", default="2%", show_default=True, metavar="SHARE", help="Wanted (max - min)/mean of the speed."
)
def flywheel(case: Case, ripple: str, out: Path | None) -> None:
    """Size the flywheel of CASE for a wanted ripple, for its cycle, load and cylinders, and run it in time.

    The shaft is rigid. Inertia is what must be added to the case. Exit status 1 when no flywheel does it.

    \b
    Examples: mechsym flywheel zotov-89 --ripple 2%
              mechsym flywheel opposed-pistons --ripple 0.005 --set load.law=constant
    """
    import numpy as np

    from mechsym.files import write_quantities
    from mechsym.jobs.flywheel import flywheel as size
    from mechsym.quantities import parse

    share = parse(ripple, "-", "--ripple")
    if not 1e-6 <= share < 1:
        raise BadInput(f"--ripple = {ripple}: give a share from 1e-6 to below 1, such as 0.02 or 2%")
    wheel = size(case, share)
    files = []
    if out:
        columns = {"phi_deg": np.degrees(wheel.steady.phi), "omega_rad_s": wheel.steady.omega}
        files = [write_quantities(out / "flywheel.csv", columns)]
    result = tell(wheel)
    emit(wheel, lambda: _text(result), files=files, findings=wheel.findings)
    if wheel.inertia is None:
        raise click.exceptions.Exit(1)


def _text(result: Json) -> str:
    bare, check, swing = result["ripple_bare"], result["check"], result["work_swing"]
    mean = result["torque_mean"] if abs(result["torque_mean"]) > SMALLEST * swing else 0.0  # else round-off
    swing = swing if swing > SMALLEST * abs(mean) else 0.0
    lines = [
        f"mean torque {quantity_text(mean, 'N*m')}, work that swings {quantity_text(swing, 'J')}",
        f"without a further flywheel: {'the shaft does not turn' if bare is None else f'ripple {_percent(bare, 4)}'}",
    ]
    if result["inertia"] is None:
        return "\n".join(lines)
    turning = f"the {figure(result['inertia_kept'])} kg*m^2 that turn"
    lines.append(
        f"no flywheel is needed: {turning} keep {100 * result['ripple_wanted']:.4g} %"
        if result["inertia"] == 0
        else f"flywheel {figure(result['inertia'])} kg*m^2 besides {turning} "
        f"(rule of thumb: {figure(result['estimate'])} kg*m^2)"
    )
    if check["speed_ripple"] is not None:
        residual = residual_text(check["energy_residual"], 1)
        lines.append(f"run in time: ripple {_percent(check['speed_ripple'], 5)}, energy residual {residual}")
    return "\n".join(lines)


def _percent(share: float, digits: int) -> str:
    return f"{100 * share:.{digits}g} %" if share > SMALLEST else f"below {100 * SMALLEST:.0e} %"
