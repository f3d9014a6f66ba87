"""`mechsym hinge`: design the elastic hinge of an engine and prove it by simulation."""

import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import click

from mechsym.cases import Case
from mechsym.cli.common import case_command, diagram_option, emit, out_option, progress, table
from mechsym.hinge.result import ripple_text
from mechsym.quantities.display import figure, quantity_text, residual_text

if TYPE_CHECKING:
    from mechsym.hinge.summary import HingeLossNumbers, HingeNumbers

_MOST = 10.0  # times the load of the case; beyond that it is a slip of the pen


@case_command("Design hinge and guide, prove them by simulation.", out_option)
@diagram_option
@click.option("--loads", metavar="A,B..", help="Try the guide at other loads too, as shares of the case's: 0.5,0.75,1.")
def hinge(case: Case, diagram: str | None, loads: str | None, out: Path | None) -> None:
    """Design hinge and guide, simulate the engine with them, write the report.

    Exit status 1 when the guide cannot be built; everything is computed and written all the same. A guide that can be
    cut may miss the ripple of 2 % with losses: the first line says so, `target` in JSON, and --strict ends with 3. At
    other loads the guide stays as it was cut, the spring as designed and with the setting that fits that load best.
    With the extra web the report simulates the engine at its end; without, it says so.

    \b
    Examples: mechsym hinge zotov-89 --set spring.p0="8 MPa" --out demo
              mechsym hinge zotov-89 --loads 0.5,0.75,0.9,1
    """
    from mechsym.cases.outcomes import of_gas
    from mechsym.files import make_folder
    from mechsym.hinge.guide import setting_text
    from mechsym.hinge.result import LATER, complete
    from mechsym.hinge.summary import HingeNumbers
    from mechsym.jobs.hinge import hinge as design

    shares = _shares(loads)
    if out is not None:
        make_folder(out)
    with progress(len(LATER) + bool(out), f"hinge of {case.name}") as bar:
        result = complete(design(case, diagram, shares), lambda: bar.update(1))
        files: list[Path] = []
        if out is not None:
            from mechsym.hinge.shown import write
            from mechsym.jobs.export import ready
            from mechsym.out.web import LiveRun, with_live

            live = LiveRun(name=case.name, about=case.about, ready=partial(ready, case, diagram))
            files = write(result, out, partial(with_live, runs=[live]))
            bar.update(1)
    numbers = HingeNumbers(judged=result)
    setting = partial(setting_text, case.need("spring"))
    doubts = of_gas(case, result.machine.gas)
    text = partial(_text, numbers, setting)
    emit(numbers, text, beside={"doubts": doubts}, files=files, findings=result.view.findings())
    if not numbers.guide.feasible:
        sys.exit(1)


def _shares(loads: str | None) -> list[float]:
    from mechsym.errors import BadInput
    from mechsym.quantities.ranges import values

    shares = values(loads, "-", "--loads", most=100) if loads is not None else []
    if len(set(shares)) < len(shares):
        raise BadInput(f"--loads {loads}: each share once")
    for share in shares:
        if not 0 < share <= _MOST:
            raise BadInput(f"--loads {share:g}: shares of the case's load must be above 0 and at most {_MOST:g}")
    return shares


def _text(numbers: "HingeNumbers", setting: Callable[[float], str]) -> str:
    from mechsym.hinge.limits import ALL_KEPT
    from mechsym.hinge.summary import RetunedNumbers
    from mechsym.quantities.results import tell, units_of

    guide, check, again = numbers.guide, numbers.check, numbers.retune
    torque = [quantity_text(M, "N*m") for M in (numbers.hinge_torque_min, numbers.hinge_torque_max)]
    mean = numbers.hinge_torque_mean / max(abs(numbers.hinge_torque_max), abs(numbers.hinge_torque_min))
    how = "with losses" if check.losses else "without losses"
    peak = (
        ""
        if numbers.p_max_bar is None
        else f", peak pressure {quantity_text(1e5 * numbers.p_max_bar, 'Pa', 4)} absolute"
    )
    lines = [
        numbers.verdict,
        f"speed            {numbers.speed_rpm:.6g} rpm{peak}",
        f"load torque      {quantity_text(numbers.load_torque, 'N*m')}",
        f"hinge torque     {torque[0]} to {torque[1]}, mean {residual_text(mean)} of its peak",
        f"limits           {guide.reason.removeprefix(ALL_KEPT)}",
        f"speed ripple     {ripple_text(check.speed_ripple, 4)} simulated {how}, "
        f"energy residual {residual_text(check.energy_residual)}",
        f"flywheel saved   {figure(numbers.flywheel_inertia_saved, 4)} kg*m^2 by an ideal hinge: what "
        f"{figure(100 * numbers.ripple_wanted)} % needs without one",
        *_left_out(numbers),
    ]
    for offer in numbers.offers[1:]:
        lines.append(
            f"instead          balance = {offer.balance!r} with shaft_ratio = {offer.shaft_ratio:g}: ripple "
            f"{ripple_text(offer.ripple_constant_load)} under constant, "
            f"{ripple_text(offer.ripple_propeller_load)} under propeller load"
        )
    if isinstance(again, RetunedNumbers):
        lines.append(
            f"{'at ' + figure(again.speed_rpm, 4) + ' rpm':17}best setting {setting(again.p0)} "
            f"({again.p0_ratio:.3g} times), ripple {ripple_text(again.speed_ripple, 3)}"
        )
    if numbers.loads:
        rows = [tell(row) | {"setting": setting(row.p0)} for row in numbers.loads]
        columns = ["share", "mep_bar", "speed_ripple", "setting", "p0_ratio", "speed_ripple_reset"]
        lines += ["", table(rows, columns, units_of(type(numbers.loads[0])))]
        for row in numbers.loads:  # why there is no ripple, once for each load
            if row.speed_ripple is None:
                lines.append(f"share {row.share:g}, as cut: {row.reason}")
            if row.speed_ripple_reset is None:
                lines.append(f"share {row.share:g}, reset: {row.reason_reset}")
    return "\n".join(lines)


def _left_out(numbers: "HingeNumbers") -> list[str]:
    """What the ideal hinge does not say, beside the flywheel that it saves."""
    lost, share, run = numbers.losses, numbers.misfire_speed_share, numbers.check.losses
    if lost is None:
        return []
    after = "not known" if share is None else f"{share:.2g} of the speed" if share > 0 else "the shaft stops"
    ripple = "no steady motion" if lost.speed_ripple is None else f"ripple {ripple_text(lost.speed_ripple)}"
    label, counted = "not counted ", []
    if run is not None:
        each = ", ".join(f"{kind} {quantity_text(torque, 'N*m', 3)}" for kind, torque in run.items())
        label, counted = "by the angle", [f"lost in the run  {each} over its last period"]
    return [
        *counted,
        f"{label}     losses of {_lost_shares(lost)}; assumed unless [losses] says otherwise); with them {ripple}",
        f"one misfire      with the flywheel that is kept: {after}",
    ]


def _lost_shares(lost: "HingeLossNumbers") -> str:
    """Losses by the load torque, or as torques where there is no load."""
    if lost.share is None:
        kinds = ", ".join(f"{kind} {quantity_text(getattr(lost.torques, kind), 'N*m', 2)}" for kind in lost.shares)
        return f"{quantity_text(lost.torques.total, 'N*m', 3)} ({kinds}"
    kinds = ", ".join(f"{kind} {100 * (share or 0.0):.2g}" for kind, share in lost.shares.items())
    return f"{100 * lost.share:.3g} % of the load torque ({kinds} %"
