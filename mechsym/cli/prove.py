"""`mechsym prove`: numbers that come with a theorem."""

import math
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import click

from mechsym.cli import common
from mechsym.cli.common import case_of, emit, in_rows, only_of, pairs, progress, refuse_idle, table
from mechsym.errors import BadInput

if TYPE_CHECKING:
    from mechsym.jobs.prove import ProvenMotion
    from mechsym.proof.outputs import ProvenRounding


@click.command(short_help="Prove bounds: rounding of machine code, the motion of a case.")
@click.argument("name", metavar="NAME or CASE")
@click.option("--case", "case_name", help="Case that gives parameters, speeds and forces; a built-in one without.")
@click.option("--range", "given", multiple=True, metavar="KEY=A..B", help="Range of a letter, e.g. --range phid=0..20.")
@click.option("--samples", default=10_000, show_default=True, help="Random points that the bounds are held against.")
@click.option(
    "--mode", type=click.Choice(["strict", "fast"]), default="strict", help="Build of the code; fast is refused."
)
@click.option("--t-end", metavar="TIME", help="How far the motion of CASE is enclosed; to its own end without.")
@click.option("--window", metavar="A..B", help="Times that the statement about CASE is for, e.g. 55..93 s.")
@common.out_option
@common.set_option
@common.budget_option
@common.json_option
def prove(
    name: str, case_name: str | None, given: tuple[str, ...], samples: int, mode: str, t_end: str | None,
    window: str | None, out: Path | None, overrides: tuple[str, ...],
) -> None:  # fmt: skip
    """Bound the rounding of every output of the generated C of the mechanism NAME, or of the limits of guides (hinge).

    Parameters at the case's values +-1 %, a full turn of each angle, speeds and inputs within the case's extremes. The
    bound is proven in balls; samples of the compiled code against 60 digits show how near it is. Exit status 1 when a
    sample is beyond its bound: the code is not what was proven.

    Of a CASE (chmielewski) the motion is enclosed instead: an interval for each state at each second that holds every
    solution of its equations. --out keeps the proof and goes on from where it was broken off.

    \b
    Examples: mechsym prove crosshead --case zotov-89 --samples 1000
              mechsym prove chmielewski --t-end 3 --out proof
    """
    from mechsym import cases, mechanisms
    from mechsym.jobs.prove import GUIDES, subjects_of, usual_case
    from mechsym.proof.outputs import rounding

    if name != GUIDES and name not in mechanisms.names() and name in cases.names() or name.endswith(".toml"):
        refuse_idle(f"for the motion of the case {name}", "case_name", "given", "samples", "mode")
        _motion(name, t_end, window, out, pairs(overrides))
        return
    refuse_idle(f"for the rounding of {name}", "t_end", "window")
    if mode == "fast":
        raise BadInput("--mode fast contracts products and shares reciprocals: no bound is proven of it; use strict")
    if name != GUIDES:
        mechanisms.parameters_class(name)  # refuses what is none
    case = only_of(case_of(case_name or usual_case(name), pairs(overrides)), "prove")
    from mechsym.quantities.ranges import read_range

    ranges = {}
    for key, text in pairs(given, "--range").items():
        span = read_range(text, "--range", key=key)
        if span.kind != "even" or span.unit or not span.values[0] <= span.values[1]:
            raise BadInput(f"--range {key}={text}: two ascending SI numbers with two dots between, such as phid=0..20")
        ranges[key] = (span.values[0], span.values[1])
    subjects, words = subjects_of(name, case, ranges)
    with progress(samples * len(subjects), f"samples of {name}") as bar:
        proven = rounding(name, subjects, samples, words, bar.update)
    emit(proven, lambda: _text(proven))
    if not proven.holds:
        sys.exit(1)


def _motion(name: str, t_end: str | None, window: str | None, out: Path | None, overrides: dict[str, str]) -> None:
    from mechsym.cases.settings import simulation_of
    from mechsym.jobs.prove import motion_of
    from mechsym.quantities import parse
    from mechsym.quantities.ranges import read_range

    case = only_of(case_of(name, overrides), "prove")
    until = None if t_end is None else parse(t_end, "s", "--t-end")
    if until is not None and not until > 0:
        raise BadInput(f"--t-end {t_end}: a time above 0 s")
    ends = None if window is None else read_range(window, "--window", "s").values
    last = until or simulation_of(case).t_end or 0.0
    if ends is not None and not (len(ends) == 2 and ends[0] < ends[1] <= last):
        raise BadInput(f"--window {window}: two ascending times up to {last:g} s, with two dots between: 55..93 s")
    with progress(math.ceil(last), f"seconds of {case.name}") as bar:
        proven = motion_of(case, until, out, None if ends is None else (ends[0], ends[1]), bar.update)
    emit(proven, lambda: _motion_text(proven))


def _motion_text(proven: "ProvenMotion") -> str:
    from mechsym.proof.balls import outward

    rows = [
        {"t": t, "state": name, "from": outward(proven.least[name][k], 6, False),
         "to": outward(proven.largest[name][k], 6), "half-width at t": outward(proven.half_width[name][k], 2)}
        for k, t in enumerate(proven.t) for name in proven.least
        if k == len(proven.t) - 1 or k % max(1, len(proven.t) // 10) == 0
    ]  # fmt: skip
    trusted = (f"trusted: {one}" for one in proven.trusted)
    how = f"{proven.steps} steps at {proven.bits} bits; {proven.digits:.3g} digits were forecast"
    return "\n".join([proven.statement, "", table(rows, list(rows[0])), how, "", *trusted])


def _text(proven: "ProvenRounding") -> str:
    from mechsym.quantities.results import tell

    rows = in_rows([tell(row) for row in proven.outputs], ("absolute", "seen"))
    columns = ["name", "absolute", "seen", "unit", "relative", "factor", "where"]
    singular = [f"no bound of {row.name} at {', '.join(row.singular)}" for row in proven.outputs if row.singular]
    return "\n".join(
        [proven.statement, "", table(rows, columns), *singular, "", *(f"trusted: {one}" for one in proven.trusted)]
    )
