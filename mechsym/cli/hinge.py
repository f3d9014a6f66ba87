"""`mechsym hinge`: design the elastic hinge of an engine and prove it by simulation."""

import sys
from pathlib import Path
from typing import Any

import click

from mechsym.cli.common import emit, json_option, out_option, pairs, progress, set_option


@click.command()
@click.argument("case_name", metavar="CASE")
@click.option("--diagram", type=click.Path(dir_okay=False), help="CSV of a measured diagram in place of the cycle.")
@out_option
@set_option
@json_option
def hinge(case_name: str, diagram: str | None, out: Path | None, overrides: tuple[str, ...], as_json: bool) -> None:
    """Design hinge and guide, simulate the engine with them, write the report.

    Exit status 1 when the guide cannot be built; everything is computed and written all the same.

    \b
    Example: mechsym hinge zotov-89 --set spring.p0="8 MPa" --out demo
    """
    from mechsym import cases, design
    from mechsym.files import make_folder
    from mechsym.summary import summary

    case = cases.load(case_name, pairs(overrides))
    if out is not None:
        make_folder(out)
    with progress(design.STEPS + bool(out), f"hinge of {case.name}") as bar:
        found = design.design(case, diagram, lambda: bar.update(1))
        files: list[Path] = []
        if out is not None:
            from mechsym.report import write

            files = write(found, out)
            bar.update(1)
    numbers = summary(found)
    emit(numbers, as_json, lambda: _text(numbers, files))
    if not numbers["guide"]["feasible"]:
        sys.exit(1)


def _text(numbers: dict[str, Any], files: list[Path]) -> str:
    guide, check, again = numbers["guide"], numbers["check"], numbers["retune"]
    lines = [
        f"speed            {numbers['speed_rpm']:.6g} rpm, peak pressure {numbers['p_max_bar']:.4g} bar absolute",
        f"load torque      {numbers['load_torque']:.6g} N*m",
        f"hinge torque     {numbers['hinge_torque_min']:.6g} to {numbers['hinge_torque_max']:.6g} N*m, "
        f"mean {numbers['hinge_torque_mean']:.1e}",
        f"guide            {'can' if guide['feasible'] else 'CANNOT'} be built: {guide['reason']}",
        f"speed ripple     {_number(check['speed_ripple'])} simulated, "
        f"energy residual {_number(check['energy_residual'])}",
        f"flywheel saved   {_number(numbers['flywheel_inertia_saved'])} kg*m^2 (ripple 1/50 without hinge)",
    ]
    for offer in numbers["offers"][1:]:
        lines.append(
            f"instead          balance = {offer['balance']!r} with shaft_ratio = {offer['shaft_ratio']:g}: ripple "
            f"{_number(offer['ripple_constant_load'])} under constant, {_number(offer['ripple_propeller_load'])} under "
            "propeller load"
        )
    if again["p0"] is not None:
        lines.append(
            f"at {again['speed_rpm']:.4g} rpm       best setting {again['p0']:.5g} ({again['p0_ratio']:.3g} times), "
            f"ripple {_number(again['speed_ripple'])}"
        )
    return "\n".join([*lines, *(f"wrote {file}" for file in files)])


def _number(value: float | None) -> str:
    return "-" if value is None else f"{value:.4g}"
