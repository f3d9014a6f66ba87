"""Options and output that every command shares, and the ranges of a performance map."""

import functools
import sys
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import asdict, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
from click.core import ParameterSource

from mechsym import cases
from mechsym.cases import Case
from mechsym.cases.values import take
from mechsym.errors import BadInput
from mechsym.files import Json, publish, to_json, together, try_folder, write_summary
from mechsym.files.inputs import reads
from mechsym.mechanisms import own
from mechsym.plausible import Doubt, results, sifted
from mechsym.quantities import load
from mechsym.quantities.display import SMALLEST, choose, column_text, heading, key_words, ratio_text, shown_in
from mechsym.quantities.results import tell, units_of

if TYPE_CHECKING:
    from mechsym.page.finding import Finding
from mechsym.quantities.ranges import values
from mechsym.quantities.units import RadPerSecond

# endings of files: a folder of such a name is a slip, and so is a file of another kind
_ENDINGS = tuple(".csv .fmu .gz .html .json .nc .pdf .png .py .svg .tar .toml .txt .zip".split())
_CASES, _ABOUT, DOUBTED, _RUN = "mechsym.cases", "mechsym.about", "mechsym.doubted", "mechsym.run"
_JSON, WITH_UNITS = "mechsym.json", "mechsym.with_units"  #: with units JSON is {value, units}, for the workbench


def tried(ctx: click.Context, param: click.Parameter, path: Path | None, endings: tuple[str, ...] = ()) -> Path | None:
    """Refuse an --out that cannot be written before the work begins; what is written into a folder appears together.

    endings: of the one file that may be named in place of a folder.
    """
    if path is not None and not ctx.resilient_parsing:
        kind, takes = path.suffix.lower(), param.type
        only = isinstance(takes, click.Path) and not takes.dir_okay
        file = kind in endings or only
        if only and endings and kind not in endings:
            ways = " or ".join(endings)
            raise BadInput(f"{param.opts[0]} {path}: such a file ends in {ways}; write {path.with_suffix(endings[0])}")
        if not file and kind in _ENDINGS and not path.is_dir():
            way = f"several files are written into a folder; leave {path.suffix} away"
            way = f"the file is of kind {endings[0]}; write {path.with_suffix(endings[0])}" if endings else way
            raise BadInput(f"--out {path}: {way}")
        if file and path.is_dir():
            raise BadInput(f"--out {path} is a folder; give a file, or a folder of another name")
        try_folder(path.parent if file else path)
        ctx.with_resource(reads())  # what is read is not written over
        if not file:
            ctx.with_resource(together(path))
    return path


def ending(*endings: str) -> Callable[..., Any]:
    """As `tried`, for an option that names one file by its ending."""
    return functools.partial(tried, endings=endings)


def tried_run(ctx: click.Context, param: click.Parameter, path: Path | None) -> Path | None:
    """As `tried`, for a command whose folder gets a summary of the run."""
    if path is not None and not ctx.resilient_parsing:
        ctx.meta[_RUN] = path, ctx.with_resource(reads())
    return tried(ctx, param, path)


json_option = click.option(
    "--json", is_flag=True, expose_value=False, callback=lambda ctx, _, wanted: ctx.meta.update({_JSON: wanted}),
    help="Print one JSON value to standard output.",
)  # fmt: skip
_FOLDER = click.Path(path_type=Path, file_okay=False)
out_option = click.option(
    "--out",
    type=_FOLDER,
    callback=tried_run,
    help="Folder for the files of the run and summary.json; made when missing.",
)
folder_option = click.option("--out", type=_FOLDER, callback=tried, help="Folder for files; made when missing.")
set_option = click.option(
    "--set", "overrides", multiple=True, metavar="KEY=VALUE", help='Override a value, e.g. --set spring.p0="9.5 MPa".'
)
diagram_option = click.option(
    "--diagram", type=click.Path(dir_okay=False), help="CSV of a measured diagram in place of the cycle."
)
budget_option = click.option(
    "--budget", callback=lambda ctx, _, text: load("mechsym.budget:choose")(text or ""), expose_value=False,
    metavar="TEXT", help='What it may take, "10 min, 2 GB" without: what is forecast to take more does not begin.',
)  # fmt: skip


def case_command(short_help: str, *out: Callable[..., Any]) -> Callable[[Callable[..., None]], click.Command]:
    """A command on one CASE, with --set and --json: its function gets the case as read, and what `out` brings."""

    def command(function: Callable[..., None]) -> click.Command:
        @functools.wraps(function)
        def run(case: str, overrides: tuple[str, ...], **options: Any) -> None:
            function(case_of(case, pairs(overrides)), **options)

        given: Any = run
        for option in (json_option, *out, set_option, click.argument("case")):
            given = option(given)
        return click.command(short_help=short_help)(given)

    return command


def file_option(usual: str, *endings: str) -> Callable[..., Any]:
    """The option --out of a command that writes one file: a folder for it, or the file itself by its ending."""

    help_ = f"Folder for {usual}, made when missing; or the file itself, which ends in {endings[0]}."
    return click.option("--out", type=click.Path(path_type=Path), callback=ending(*endings), help=help_)


def file_in(out: Path | None, usual: str, *endings: str) -> Path:
    """The file of a command that writes one: as named by --out, or with its usual name in that folder."""
    return out if out is not None and out.suffix.lower() in endings else (out or Path()) / usual


def pairs(texts: tuple[str, ...], option: str = "--set") -> dict[str, str]:
    """KEY=VALUE texts as a mapping, in the order given. option: the option's name, for the message."""
    values: dict[str, str] = {}
    for text in texts:
        key, sign, value = text.partition("=")
        if not sign or not key.strip() or not value.strip():
            raise BadInput(f"{option} {text!r} is not KEY=VALUE; write for example {option} operation.speed='142 rpm'")
        if key.strip() in values:
            raise BadInput(f"{option} {key.strip()} is given twice, {values[key.strip()]!r} and {value.strip()!r}")
        values[key.strip()] = value.strip()
    return values


def listed(text: str, option: str) -> list[str]:
    """Words between commas, each of which is given once; at least one."""
    given = [word.strip() for word in text.split(",") if word.strip()]
    if not given:
        raise BadInput(f"{option} {text!r} names nothing; give words with commas between them, or leave it away")
    twice = next((word for word in given if given.count(word) > 1), None)
    if twice is not None:
        raise BadInput(f"{option} {text!r} names {twice} twice")
    return given


def refuse_idle(where: str, *names: str) -> None:
    """Refuse options of the command line that nothing reads there, by the names of their values."""
    context = click.get_current_context()
    given = [name for name in names if context.get_parameter_source(name) is ParameterSource.COMMANDLINE]
    for param in context.command.params:
        if param.name in given:
            raise BadInput(f"{param.opts[0]} does nothing {where}; leave it away")


def case_of(name: str, overrides: Mapping[str, object]) -> Case:
    """The case that a command is about; its doubts, and what of it is not read, go into what the command prints."""
    case = doubted(name, overrides)
    click.get_current_context().meta.setdefault(_ABOUT, []).append(case)
    return case


def doubted(name: str, overrides: Mapping[str, object]) -> Case:
    """A case whose doubts go into what the command prints."""
    case, taken = cases.load(name, overrides), dict[tuple[str, str], str]()
    for key in overrides if len(overrides) > 1 else ():
        take(taken, cases.locate(name, key, overrides), f"--set {key}")
    if own.is_file(case.mechanism):
        from mechsym.cases.outcomes import of_own
        from mechsym.jobs.machine import one_coordinate

        case = replace(case, doubts=(*case.doubts, *of_own(case, one_coordinate)))
    if "report" in case.sections and not click.get_current_context().meta.get("mechsym.units"):
        choose(case.need("report").units)
    case.read.clear()  # who judges a case does not run on it
    click.get_current_context().meta.setdefault(_CASES, []).append(case)
    return case


def only_of(case: Case, command: str) -> Case:
    """The case with the doubts of sections that a command reads, in what it prints too: others are another page's."""
    from mechsym.cases.facts import facts_of
    from mechsym.cases.needs import read_by

    read = read_by(facts_of(case.mechanism, case.sections)).get(command, case.sections.keys())
    seen = replace(case, doubts=tuple(d for d in case.doubts if d.quantity.partition(".")[0] in read))
    meta = click.get_current_context().meta
    meta[_CASES] = [seen if one is case else one for one in meta[_CASES]]
    return seen


def judge_ends(case: Case, key: str, values: Sequence[float]) -> None:
    """Put the doubts of a case at the smallest and largest of some values into what the command prints.

    key: `section.field`; a case without that section is not judged. values: what the command computes it for [SI].
    Raises BadInput: a value that no such engine has.
    """
    section, _, field = key.partition(".")
    if section in case.sections:
        others = {k: v for k, v in case.overrides.items() if k.rpartition(".")[2] not in (field, f"{field}_rpm")}
        for value in {min(values), max(values)}:
            doubted(case.path, {**others, key: value})


def emit(
    value: object,
    text: Callable[[], str],
    *,
    beside: Mapping[str, object] | None = None,
    leave_out: tuple[str, ...] = (),
    files: Sequence[Path | str] = (),
    findings: Iterable["Finding"] | None = None,
) -> None:
    """Print a result with its doubts, as JSON or as text for people.

    value: the result with its documented keys; an object gets `doubts` and `accepted` besides, of a list they go to
    standard error. text: makes the text for people; called only when needed. beside: mapping, optional, what stands
    among the keys of the result: names of files, doubts that it brings. leave_out: keys that `summary.json` does
    without, since the other files of the run have them. files: what was written, named behind the text. findings: what
    has to be known first, of a command that has any; `headline` in JSON.
    """
    context = click.get_current_context()
    data, doubts, accepted, first = answered(value, beside, findings)
    lines = [f"doubt: {_told(d)}" for d in doubts] + [f"accepted: {_told(d)}" for d in accepted]
    carries = _carries(data)
    if run := context.meta.get(_RUN):
        folder, read = run
        of_all = data if carries else {"rows": data, "doubts": doubts, "accepted": accepted}
        numbers = {key: inner for key, inner in of_all.items() if key not in leave_out}
        write_summary(folder, numbers, context.info_name or "", read)
    publish()  # files that the text names are in place before it is printed
    if lines and not carries:
        click.echo("\n".join(lines), err=True)
        lines = []
    missed = isinstance(data, Mapping) and data.get("target", {}).get("met") is False
    context.meta[DOUBTED] = bool(doubts) or missed
    if context.meta.get(_JSON):
        if context.meta.get(WITH_UNITS):
            from mechsym.cli.results import units_by_path

            data = {"value": data, "units": units_by_path(value, context.info_name or "")}
        click.echo(to_json(data))
        return
    said = text()  # it keeps its first line where that is one of what has to be known first
    head, _, rest = said.partition("\n")
    others = [one.line for one in first if one.words not in head]
    said = "\n".join([*others, said] if len(others) == len(first) else [head, *others, rest])
    named = (f"written: {file}" for file in files)
    click.echo("\n".join([*filter(None, [said]), *named, *lines]))


def answered(
    value: object, beside: Mapping[str, object] | None = None, findings: Iterable["Finding"] | None = None
) -> tuple[Any, tuple[Doubt, ...], tuple[Doubt, ...], "Sequence[Finding]"]:
    """A result as programs get it, its doubts, those that are accepted, and what has to be known first."""
    data = value if isinstance(value, Mapping) else tell(value)
    data = {**data, **beside} if beside else data
    first = () if findings is None else load("mechsym.page.finding:ranked")(findings)
    if findings is not None and isinstance(data, Mapping):  # of a list of rows the text tells it
        data = {**data, "headline": [asdict(one) for one in first]}
    doubts, accepted = _doubts(data)
    if _carries(data):
        data = {**data, "doubts": [asdict(d) for d in doubts], "accepted": [asdict(d) for d in accepted]}
    return data, doubts, accepted, first


def _carries(data: object) -> bool:
    return isinstance(data, Mapping) and not isinstance(data.get("doubts"), Mapping)  # as a printed case does


def _doubts(value: object) -> tuple[tuple[Doubt, ...], tuple[Doubt, ...]]:
    """Doubts of the cases of this command and of its results; a result may bring doubts of its own."""
    loaded = click.get_current_context().meta.get(_CASES, [])
    acceptances = {code: a for case in loaded for code, a in case.acceptances.items()}
    doubts = [d for case in loaded for d in case.doubts]
    if loaded:
        doubts += [*results(value), *_unread()]
    own = value.get("doubts", ()) if isinstance(value, Mapping) else ()
    doubts += [d if isinstance(d, Doubt) else Doubt(**d) for d in (() if isinstance(own, Mapping) else own)]
    remaining, accepted = sifted(tuple(dict.fromkeys(doubts)), acceptances)
    return _once(remaining), _once(accepted)


def _once(doubts: Sequence[Doubt]) -> tuple[Doubt, ...]:
    """Of both ends of a range the first that is told."""
    return tuple({(d.code, d.quantity): d for d in reversed(doubts)}.values())[::-1]


def _unread() -> list[Doubt]:
    """What a case says and no command reads, and what was set of it and this command did not read."""
    from mechsym.cases.check import doubt, unused
    from mechsym.cases.facts import facts_of

    meta = click.get_current_context().meta
    doubts: list[Doubt] = []
    for case in {case.path: case for case in meta[_CASES]}.values():
        doubts += unused(facts_of(case.mechanism, case.sections), cases.written(case))
    known = {doubt.quantity for doubt in doubts}
    for case in meta.get(_ABOUT, ()):
        read = set().union(*(other.read for other in meta[_ABOUT] if other.path == case.path))
        for place in (cases.locate(case.path, key, case.overrides) for key in case.overrides):
            why = f"{place.section}.{place.field} was set, and this command does not read it"
            one = doubt(f"[{place.section}]", 1, why)
            if place.section in case.sections.keys() - read and one.quantity not in known:
                doubts.append(one)
    return doubts


def _told(doubt: Doubt) -> str:
    return f"{doubt.quantity} = {doubt.value:g}, usual is {doubt.usual}: {doubt.why}"


def progress(total: int, label: str) -> Any:
    """A progress bar on standard error, silent where that is no terminal; call `update(1)` on it after each step."""
    return click.progressbar(length=total, label=label, file=sys.stderr, hidden=not sys.stderr.isatty())


def table(
    rows: list[Json], columns: list[str], units: Mapping[str, str] | None = None, digits: int = 4,
    named: Collection[str] = (),
) -> str:  # fmt: skip
    """Rows as an aligned text table, units in the headings, each column in the unit that suits it.

    units: SI unit of columns whose name does not tell it. digits: at least so many; more where neighbours differ in
    them only. named: columns of keys, which are told in words. Returns text: header line and one line a row.
    """
    from mechsym.cycle.columns import WORDS

    rows = [row | {c: key_words(row[c], WORDS) for c in named} for row in rows]
    headed = [heading(c, [row.get(c) for row in rows], unit=(units or {}).get(c)) for c in columns]
    shown = [column_text(values, digits) for _, values in headed]
    names = []
    for name, _ in headed:
        stem, bracket, unit = name.partition(" [")
        names.append(f"{key_words(stem) if '_' in stem else stem}{bracket}{unit}")
    cells = [names, *([column[i] for column in shown] for i in range(len(rows)))]
    widths = [max(len(line[i]) for line in cells) for i in range(len(columns))]
    return "\n".join("  ".join(c.ljust(w) for c, w in zip(line, widths, strict=True)).rstrip() for line in cells)


def heads(rows: type) -> dict[str, str]:
    """Units for the heads of a table of results of a class; counts and exponents stand without one."""
    return {name: unit for name, unit in units_of(rows).items() if unit != "-"}


def in_rows(rows: list[Json], keys: tuple[str, ...], unit: str = "unit") -> list[Json]:
    """Rows that each have a unit of their own, their numbers in the unit that suits them.

    keys: the numbers of a row; None stays None. unit: the key under which a row has its SI unit.
    """
    lines = []
    for row in rows:
        values = [row.get(key) for key in keys]
        values, name = shown_in(values, row[unit]) if row[unit] else (values, "")
        if name == "-" and all(abs(v) < SMALLEST for v in values if isinstance(v, float)):
            values = [ratio_text(v) if isinstance(v, float) and v else v for v in values]
        lines.append(row | dict(zip(keys, values, strict=True)) | {unit: name})
    return lines


def parse_speeds(text: str, option: str = "--speeds") -> list[RadPerSecond]:
    """Speeds from a list or a range, in rpm where no unit is written."""
    omega = values(text, "rad/s", option, "rpm", most=20_000)
    if min(omega) <= 0:
        raise BadInput(f"{option} {text}: speeds must be > 0 rpm")
    return omega


def parse_over(text: str, units: Mapping[str, str]) -> tuple[str, list[float]]:
    """A value and what it runs over from NAME=RANGE, with or without units.

    text: `compression_ratio=8:14:0.5` or `cycle.ignition=-30..0 deg:7`; the section may be left out where only one
    value has the name. units: known names and their SI units. Returns values: in the SI unit of the name [-].
    """
    written, _, span = text.partition("=")
    bare = [known for known in units if known.rpartition(".")[2] == written]
    name = bare[0] if len(bare) == 1 else written
    if name not in units:
        raise BadInput(f"--over {text}: {name!r} is not known; names are {', '.join(units)}")
    return name, values(span, units[name], "--over", key=name)
