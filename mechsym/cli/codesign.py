"""`mechsym codesign`: guide, pressures and a small flywheel for a range of speeds and loads."""

import sys
from pathlib import Path
from typing import Any

import click

from mechsym.cli.common import case_of, emit, json_option, out_option, pairs, progress, set_option, table
from mechsym.quantities import RPM
from mechsym.quantities.display import figure, quantity_text

_MOST = 100  # values of one option
_UNITS = {"speed": "rad/s", "mep": "Pa", "p0": "Pa", "p0 1": "Pa", "p0 2": "Pa", "p0 3": "Pa"}
_INERTIAS = dict.fromkeys(("flywheel_inertia", "flywheel_inertia_bare", "flywheel_inertia_bound"), "kg*m^2")
_HARDWARE = {"A": "m^2", "H": "m", "p0": "Pa", "rho0": "m", "radius": "m", "width": "m"}


@click.command(short_help="Guide, pressures and flywheel for a range of speeds and loads.")
@click.argument("case_name", metavar="CASE")
@click.option("--speeds", metavar="N,N..", help="Speeds in rpm: 60,75,89.")
@click.option("--curve", help="propeller or constant_speed.")
@click.option("--loads", metavar="A,B..", help="Shares of the full load, at each speed.")
@click.option("--ripple", metavar="D", help="Allowed (max - min) / mean of the speed: 2%.")
@click.option("--springs", type=click.IntRange(1, 3), help="Guides with a spring and a pressure of their own.")
@click.option("--schedule", type=click.Choice(["each_point", "one"]), help="Pressures set at each point, or one.")
@click.option(
    "--losses", type=click.Choice(["beside", "inside"]), help="Friction and heat beside the programme, or in it."
)
@click.option("--robust", metavar="spring.p0=E", help="Error of every pressure that the ripple must bear: 1%.")
@click.option("--misfire-speed", metavar="S", help="Share of the speed that a lost combustion must leave: 0.5.")
@click.option("--free", metavar="KEY,KEY..", help="Chosen too: spring.A, spring.H, guide.rho0, rollers.radius, ..")
@click.option("--pareto", metavar="D,D..", help="Ripples of a front: 1,2,5,8%.")
@click.option("--cylinders", type=click.IntRange(1, 24), help="Also what 1 to N of these cylinders on a shaft need.")
@click.option("--realise", metavar="GOAL", help="Hardware of least bearing_loss, roller_reaction, gas_volume, ..")
@click.option("--peers", is_flag=True, help="Also coil springs, noncircular gears and two springs at the same ripples.")
@out_option
@set_option
@json_option
def codesign(case_name: str, out: Path | None, overrides: tuple[str, ...], as_json: bool, **options: Any) -> None:
    """Design guide, pressures of the spring and a small flywheel together, for all speeds and loads of CASE.

    A case without [codesign] is designed at its own speed and load; --speeds and --loads ask for more.

    Exit status 1 when there is no such design; the bound says what no guide with so many springs can do better than.

    \b
    Examples: mechsym codesign zotov-89 --ripple 5%
              mechsym codesign zotov-89 --speeds 75,89,105,120,142 --springs 2 --pareto 1,2,5% --out demo
    """
    from mechsym.codesign.realise import check_goal
    from mechsym.codesign.summary import summary
    from mechsym.files import make_folder
    from mechsym.jobs.codesign import STEPS, beside, compared, for_report, settings_of
    from mechsym.jobs.codesign import codesign as design

    case = case_of(case_name, pairs(overrides))
    settings, ripples = _settings(settings_of(case), options)
    cylinders, goal = options["cylinders"] or 0, check_goal(options["realise"]) if options["realise"] else ""
    if out is not None:
        make_folder(out)
    with progress(
        STEPS + len(ripples) + bool(cylinders) + bool(goal) + bool(out) + 2 * options["peers"],
        f"co-design of {case.name}",
    ) as bar:
        found = design(case, settings, ripples, lambda: bar.update(1))
        if options["peers"]:
            found = compared(found, lambda: bar.update(1))
        numbers, files = summary(found) | beside(found, cylinders, goal, lambda: bar.update(1)), []
        if out is not None:
            from mechsym.codesign.report import write

            files = write(for_report(case, settings, found), numbers, out)
            bar.update(1)
    emit(numbers, as_json, lambda: _text(numbers, files))
    if not numbers["feasible"]:
        sys.exit(1)


def _settings(settings: Any, options: dict[str, Any]) -> tuple[Any, list[float]]:
    """The case's settings with the options in their place, and the ripples of a front."""
    import dataclasses

    from mechsym.errors import BadInput
    from mechsym.quantities.ranges import values

    changed: dict[str, Any] = {}
    if options["speeds"] is not None:
        changed["speeds"] = tuple(values(options["speeds"], "rad/s", "--speeds", "rpm", most=_MOST))
    if options["loads"] is not None:
        changed["loads"] = tuple(values(options["loads"], "-", "--loads", most=_MOST))
    for name in ("curve", "springs", "schedule", "losses"):
        if options[name] is not None:
            changed[name] = options[name]
    for name in ("ripple", "misfire_speed"):
        if options[name] is not None:
            changed[name] = _one(options[name], "--" + name.replace("_", "-"))
    if options["robust"] is not None:
        key, _, value = options["robust"].rpartition("=")
        if key not in ("", "spring.p0", "p0"):
            raise BadInput(f"--robust {options['robust']!r}: only spring.p0 can be made robust; write spring.p0=1%")
        changed["robust"] = _one(value, "--robust")
    if options["free"] is not None:
        changed["free"] = tuple(name.strip() for name in options["free"].split(",") if name.strip())
    ripples = values(options["pareto"], "-", "--pareto", most=_MOST) if options["pareto"] is not None else []
    if any(not 0 < r < 1 for r in ripples) or len(set(ripples)) < len(ripples):
        raise BadInput(f"--pareto {options['pareto']!r}: ripples between 0 and 1, each of them once, such as 1,2,5%")
    return dataclasses.replace(settings, **changed), ripples


def _one(text: str, option: str) -> float:
    from mechsym.quantities import parse

    return parse(text.strip(), "-", option)


def _percent(share: float | None) -> str | None:
    return None if share is None else f"{100 * share:.4g}"


def _text(numbers: dict[str, Any], files: list[Path]) -> str:
    from mechsym.codesign.summary import prices

    bound, found, lost = numbers["bound"], numbers["verified"], numbers["losses"]
    names = ["p0"] if len(numbers["p0"]) == 1 else [f"p0 {s + 1}" for s in range(len(numbers["p0"]))]
    rows = [
        {"speed": n * RPM, "mep": load, **{name: p[k] for name, p in zip(names, numbers["p0"], strict=True)},
         "ripple [%]": numbers["speed_ripple"][k], "steady [%]": found["steady_ripple"][k],
         "in time [%]": found["time_ripple"][k], "with losses [%]": numbers["losses"]["speed_ripple"][k],
         "losses [%]": numbers["losses"]["share"][k], "after misfire [%]": numbers["misfire_speed_share"][k]}
        for k, (n, load) in enumerate(zip(numbers["speed_rpm"], numbers["load"], strict=True))
    ]  # fmt: skip
    rows = [{key: _percent(v) if key.endswith("[%]") else v for key, v in row.items()} for row in rows]
    floors = ", ".join(f"{r + 1}: {_inertia(j)}" for r, j in enumerate(bound["flywheel"]))
    pays = bound["springs_that_pay"]
    lines = [
        f"status           {numbers['status']} ({numbers['reason']}), {figure(numbers['wall_s'], 2)} s",
        f"flywheel         {_inertia(numbers['flywheel_inertia'])} added; bare "
        f"{_inertia(numbers['flywheel_inertia_bare'])}, guide cut for one speed "
        f"{_inertia(numbers['flywheel_inertia_cut_for_one'])}",
        f"no guide better  {floors} by the number of springs; up to {pays} pay{'s' * (pays == 1)}",
        f"losses           {min(lost['share']):.1%} to {max(lost['share']):.1%} of the torque, friction assumed; "
        f"{'in' if lost['in_programme'] else 'beside'} the programme; an index below gamma costs heat",
        f"three ways       differ by {figure(100 * found['difference'], 2)} % of the largest ripple",
        "",
        table(rows, list(rows[0]), _UNITS),
        "",
        *(f"{what}: flywheel {worth}" for what, worth in prices(numbers)),
        *(f"limit passed: {words}" for words in found["broken"]),
    ]  # fmt: skip
    if numbers["pareto"]:
        lines += ["", table(numbers["pareto"], ["ripple", "flywheel_inertia", "status"], _INERTIAS)]
    if "peers" in numbers:
        lines += ["", "other machines at the same points",
                  table(numbers["peers"], ["name", "ripple", "flywheel_inertia", "about"], _INERTIAS)]  # fmt: skip
    if "cylinders" in numbers:
        lines += ["", "flywheel of several cylinders that fire evenly, bare and the least that a hinge leaves",
                  table(numbers["cylinders"], list(numbers["cylinders"][0]), _INERTIAS)]  # fmt: skip
    if "realised" in numbers:
        lines += ["", *_realised(numbers["realised"])]
    return "\n".join([*lines, *(f"wrote {file}" for file in files)])


def _realised(made: dict[str, Any]) -> list[str]:
    from mechsym.codesign.realise import GOAL_UNITS

    goal, unit = made["goal"].replace("_", " "), GOAL_UNITS[made["goal"]]
    before, after = (", ".join(quantity_text(v, unit) for v in made[key]) for key in ("before", "after"))
    told = [", ".join(f"{k} {quantity_text(v, _HARDWARE[k])}" for k, v in guide.items()) for guide in made["guides"]]
    return [f"hardware of least {goal}: {made['status']}, {before} -> {after}; the same works within all limits", *told]


def _inertia(value: float | None) -> str:
    return "none" if value is None else quantity_text(value, "kg*m^2")
