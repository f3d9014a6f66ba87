"""`mechsym codesign`: guide, pressures and a small flywheel for a range of speeds and loads."""

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from mechsym.cases import Case
from mechsym.cli.common import budget_option, case_command, emit, heads, listed, out_option, progress, table
from mechsym.quantities import RPM
from mechsym.quantities.display import figure, quantity_text

if TYPE_CHECKING:
    from mechsym.codesign.realise import RealisedNumbers
    from mechsym.codesign.result import CoDesignLosses, CoDesignNumbers
    from mechsym.codesign.settings import CoDesignSettings
    from mechsym.jobs.codesign import CoDesignAnswer

_MOST = 100  # values of one option
_UNITS = {"speed": "rad/s", "mep": "Pa", "p0": "Pa", "p0 1": "Pa", "p0 2": "Pa", "p0 3": "Pa"}


@case_command("Guide, pressures and flywheel for a range of speeds and loads.", out_option)
@click.option("--speeds", metavar="N,N..", help="Speeds in rpm: 60,75,89.")
@click.option("--curve", help="propeller or constant_speed.")
@click.option("--loads", metavar="A,B..", help="Shares of the full load, at each speed.")
@click.option("--ripple", metavar="D", help="Allowed (max - min) / mean of the speed: 2%.")
@click.option("--springs", type=click.IntRange(1, 3), help="Guides with a spring and a pressure of their own.")
@click.option("--schedule", type=click.Choice(["each_point", "one"]), help="Pressures set at each point, or one.")
@click.option(
    "--losses",
    type=click.Choice(["inside", "beside", "none"]),
    help="Friction and heat in the programme (default with a section [losses]), beside it, or left out.",
)
@click.option("--robust", metavar="spring.p0=E", help="Error of every pressure that the ripple must bear: 1%.")
@click.option("--misfire-speed", metavar="S", help="Share of the speed that a lost combustion must leave: 0.5.")
@click.option("--free", metavar="KEY,KEY..", help="Chosen too: spring.A, spring.H, guide.rho0, rollers.radius, ..")
@click.option("--pareto", metavar="D,D..", help="Ripples of a front: 1,2,5,8%.")
@click.option("--cylinders", type=click.IntRange(1, 24), help="Also what 1 to N of these cylinders on a shaft need.")
@click.option("--realise", metavar="GOAL", help="Hardware of least bearing_loss, roller_reaction, gas_volume, ..")
@click.option("--peers", is_flag=True, help="Also coil springs, noncircular gears and two springs at the same ripples.")
@budget_option
def codesign(case: Case, out: Path | None, **options: Any) -> None:
    """Design guide, pressures of the spring and a small flywheel together, for all speeds and loads of CASE.

    A case without [codesign] is designed at its own speed and load; --speeds and --loads ask for more.

    Exit status 1 when there is no such design; the bound says what no guide with so many springs can do better than.
    A design may miss the ripple with losses: the first line says so, `target` in JSON, and --strict ends with 3.

    \b
    Examples: mechsym codesign zotov-89 --ripple 5%
              mechsym codesign zotov-89 --speeds 75,89,105,120,142 --springs 2 --pareto 1,2,5% --out demo
    """
    from mechsym.codesign.certificate import hidden
    from mechsym.codesign.realise import check_goal
    from mechsym.codesign.result import numbers_of
    from mechsym.files import make_folder
    from mechsym.jobs.codesign import STEPS, CoDesignAnswer, beside, compared, for_report, settings_of
    from mechsym.jobs.codesign import codesign as design
    from mechsym.quantities.results import tell

    settings, ripples = _settings(settings_of(case), options)
    cylinders, goal = options["cylinders"] or 0, check_goal(options["realise"]) if options["realise"] else ""
    if out is not None:
        make_folder(out)
    steps = STEPS + len(ripples) + bool(cylinders) + bool(goal) + bool(out) + 2 * options["peers"]
    with progress(steps, f"co-design of {case.name}") as bar:
        result = design(case, settings, ripples, lambda: bar.update(1))
        if options["peers"]:
            result = compared(result, lambda: bar.update(1))
        numbers, files = numbers_of(result), []
        more = beside(result, cylinders, goal, lambda: bar.update(1))
        answer, doubts = CoDesignAnswer(numbers=numbers, beside=more), {"doubts": hidden(result.design, result.given)}
        if out is not None:
            from mechsym.codesign.shown import write

            files = write(for_report(case, settings, result), numbers, tell(answer) | doubts, out)
            bar.update(1)
    emit(answer, lambda: _text(answer), beside=doubts, files=files, findings=result.view.findings())
    if not numbers.feasible:
        sys.exit(1)


def _settings(settings: "CoDesignSettings", options: dict[str, Any]) -> tuple["CoDesignSettings", list[float]]:
    """The case's settings with the options in their place, and the ripples of a front."""
    import dataclasses

    from mechsym.errors import BadInput
    from mechsym.quantities import parse
    from mechsym.quantities.ranges import values

    given = {name: value for name, value in options.items() if value is not None}
    changed: dict[str, Any] = {
        name: given[name] for name in ("curve", "springs", "schedule", "losses") if name in given
    }
    if "speeds" in given:
        changed["speeds"] = tuple(values(given["speeds"], "rad/s", "--speeds", "rpm", most=_MOST))
    if "loads" in given:
        changed["loads"] = tuple(values(given["loads"], "-", "--loads", most=_MOST))
    if "robust" in given:
        key, _, given["robust"] = given["robust"].rpartition("=")
        if key not in ("", "spring.p0", "p0"):
            raise BadInput(f"--robust {options['robust']!r}: only spring.p0 can be made robust; write spring.p0=1%")
    for name in ("ripple", "misfire_speed", "robust"):
        if name in given:
            changed[name] = parse(given[name].strip(), "-", "--" + name.replace("_", "-"))
    if "free" in given:
        changed["free"] = tuple(listed(given["free"], "--free")) if given["free"] else ()
    ripples = values(given["pareto"], "-", "--pareto", most=_MOST) if "pareto" in given else []
    if any(not 0 < r < 1 for r in ripples) or len(set(ripples)) < len(ripples):
        raise BadInput(f"--pareto {options['pareto']!r}: ripples between 0 and 1, each of them once, such as 1,2,5%")
    return dataclasses.replace(settings, **changed), ripples


def _percent(share: float | None) -> str | None:
    return None if share is None else f"{100 * share:.4g}"


def _text(answer: "CoDesignAnswer") -> str:
    from mechsym.codesign.result import prices
    from mechsym.quantities.results import tell

    numbers, more = answer.numbers, answer.beside
    checked, lost = numbers.verified, numbers.losses
    names = ["p0"] if len(numbers.p0) == 1 else [f"p0 {s + 1}" for s in range(len(numbers.p0))]
    rows = [
        {
            "speed": speed * RPM,
            "mep": numbers.load[k],
            **{name: pressures[k] for name, pressures in zip(names, numbers.p0, strict=True)},
            "ripple [%]": _percent(numbers.speed_ripple[k]),
            "steady [%]": _percent(checked.steady_ripple[k]),
            "in time [%]": _percent(checked.time_ripple[k]),
            "with losses [%]": _percent(lost.speed_ripple[k]),
            "losses [%]": _percent(lost.share[k]),
            "after misfire [%]": _percent(numbers.misfire_speed_share[k]),
        }
        for k, speed in enumerate(numbers.speed_rpm)
    ]
    lines = [
        numbers.verdict,
        f"solver           {numbers.reason}, {figure(numbers.wall_s, 2)} s",
        f"flywheel         {_inertia(numbers.flywheel_inertia)} added; bare "
        f"{_inertia(numbers.flywheel_inertia_bare)}, guide cut for one speed "
        f"{_inertia(numbers.flywheel_inertia_cut_for_one)}",
        *_turning(numbers),
        f"losses           {_losses(lost)}",
        f"three ways       differ by {figure(100 * checked.difference, 2)} % of the largest ripple",
        "",
        table(rows, list(rows[0]), _UNITS),
        "",
        *(f"{what}: {worth}" for what, worth in prices(numbers)),
        *(f"limit passed: {words}" for words in checked.broken),
    ]
    if numbers.pareto:
        # of these the ripple with losses is not known
        front = [tell(row) | {"status": "found" if row.status == "optimal" else row.status} for row in numbers.pareto]
        lines += ["", table(front, ["ripple", "flywheel_inertia", "status"], heads(type(numbers.pareto[0])))]
    if more.peers:
        rows, columns = [tell(p) for p in more.peers], ["name", "ripple", "flywheel_inertia", "about"]
        lines += ["", "other machines at the same points", table(rows, columns, heads(type(more.peers[0])))]
    if more.cylinders:
        counts = [tell(count) for count in more.cylinders]
        title = "flywheel of several cylinders that fire evenly, bare and with one spring (an estimate)"
        lines += ["", title, table(counts, list(counts[0]), heads(type(more.cylinders[0])))]
    if more.realised is not None:
        lines += ["", *_realised(more.realised)]
    return "\n".join(lines)


def _losses(lost: "CoDesignLosses") -> str:
    if lost.taken == "none":
        return "left out, as asked"
    ends = dict.fromkeys(f"{100 * share:.1f} %" for share in (min(lost.share), max(lost.share)))
    where = "in" if lost.in_programme else "beside"
    return (
        f"{' to '.join(ends)} of the torque, friction assumed; {where} the programme; an index below gamma costs heat"
    )


def _turning(numbers: "CoDesignNumbers") -> list[str]:
    """All inertia that turns, and the least that has to."""
    from mechsym.codesign.result import bound_words

    bound, given = numbers.bound, numbers.with_given_hardware
    springs = ("one spring", "two springs", "three springs")
    estimates = ", ".join(f"{_inertia(value)} with {of}" for of, value in zip(springs, bound.estimate, strict=False))
    pays = bound.springs_that_pay
    further = f"each one up to {pays} at least halves what turns" if pays > 1 else "a second one does not halve it"
    lines = [
        f"total inertia    {_inertia(numbers.total_inertia)} turns: engine, flywheel, rollers "
        f"({_inertia(numbers.rollers_inertia)} in the mean)",
        f"bound            {bound_words(numbers)}{'; it holds for' * bool(bound.speeds_rpm)}",
        *(f"                 - {words}" for words in bound.assumes if bound.speeds_rpm),
        f"estimate         {estimates} in all, by weak ripple, shapes of any kind and rollers without mass",
        f"                 - {further if pays else 'no spring halves what a bare flywheel asks for'}",
    ]
    if given is not None:
        now = _inertia(numbers.flywheel_inertia + numbers.rollers_inertia)
        before = _inertia(given.flywheel_inertia + given.rollers_inertia)
        lines.append(
            f"hardware free    flywheel and rollers together {now}, {before} with that of the case: their sum is made "
            f"small; flywheel {_inertia(given.flywheel_inertia)} and rollers {_inertia(given.rollers_inertia)} then"
        )
    return lines


def _realised(other: "RealisedNumbers") -> list[str]:
    from mechsym.quantities.results import units_of

    goal = other.goal.replace("_", " ")
    before, after = (", ".join(quantity_text(v, other.unit) for v in values) for values in (other.before, other.after))
    guides = [
        ", ".join(f"{name} {quantity_text(getattr(guide, name), unit)}" for name, unit in units_of(guide).items())
        for guide in other.guides
    ]
    status = "found" if other.status == "optimal" else other.status
    return [f"hardware of least {goal}: {status}, {before} -> {after}; the same works within all limits", *guides]


def _inertia(value: float | None) -> str:
    return "none" if value is None else quantity_text(value, "kg*m^2")
