"""Options and output that every command shares."""

import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

import click

from mechsym import cases
from mechsym.cases import Case
from mechsym.errors import BadInput
from mechsym.files import appear, to_json, together, try_folder, write_summary
from mechsym.plausible import Doubt, results, sifted
from mechsym.quantities.display import SMALLEST, choose, column_text, heading, ratio_text, shown_in

_CASES, DOUBTED, _RUN = "mechsym.cases", "mechsym.doubted", "mechsym.run"


def tried(ctx: click.Context, param: click.Parameter, path: Path | None) -> Path | None:
    """Refuse an --out that cannot be written before the work begins; what is written into a folder appears together."""
    if path is not None and not ctx.resilient_parsing:
        file = isinstance(param.type, click.Path) and not param.type.dir_okay
        try_folder(path.parent if file else path)
        if not file:
            ctx.with_resource(together(path))
    return path


def tried_run(ctx: click.Context, param: click.Parameter, path: Path | None) -> Path | None:
    """As `tried`, for a command whose folder gets a summary of the run."""
    if path is not None and not ctx.resilient_parsing:
        ctx.meta[_RUN] = path
    return tried(ctx, param, path)


json_option = click.option("--json", "as_json", is_flag=True, help="Print one JSON value to standard output.")
out_option = click.option(
    "--out",
    type=click.Path(path_type=Path, file_okay=False),
    callback=tried_run,
    help="Folder for the files of the run and summary.json; made when missing.",
)
folder_option = click.option(
    "--out",
    type=click.Path(path_type=Path, file_okay=False),
    callback=tried,
    help="Folder for files; made when missing.",
)
set_option = click.option(
    "--set", "overrides", multiple=True, metavar="KEY=VALUE", help='Override a value, e.g. --set spring.p0="9.5 MPa".'
)


def file_option(usual: str) -> Callable[..., Any]:
    """The option --out of a command that writes one file; `usual` says which where it is left away."""
    kind = click.Path(path_type=Path, dir_okay=False)
    return click.option("--out", type=kind, callback=tried, help=f"File to write; {usual}")


def pairs(texts: tuple[str, ...], option: str = "--set") -> dict[str, str]:
    """KEY=VALUE texts as a mapping.

    Parameters
    ----------
    option : str
        The option's name, for the message

    Returns
    -------
    values : dict of str to str
        Key to text, in the order given
    """
    values: dict[str, str] = {}
    for text in texts:
        key, sign, value = text.partition("=")
        if not sign or not key.strip() or not value.strip():
            raise BadInput(f"{option} {text!r} is not KEY=VALUE; write for example {option} operation.speed='142 rpm'")
        if key.strip() in values:
            raise BadInput(f"{option} {key.strip()} is given twice, {values[key.strip()]!r} and {value.strip()!r}")
        values[key.strip()] = value.strip()
    return values


def case_of(name: str, overrides: Mapping[str, Any]) -> Case:
    """The case that a command is about; its doubts go into what the command prints."""
    case = cases.load(name, overrides)
    if "report" in case.sections and not click.get_current_context().meta.get("mechsym.units"):
        choose(case.need("report").units)
    click.get_current_context().meta.setdefault(_CASES, []).append(case)
    return case


def judge_ends(case: Case, key: str, values: Sequence[float]) -> None:
    """Put the doubts of a case at the smallest and largest of some values into what the command prints.

    Parameters
    ----------
    key : str
        `section.field`; a case without that section is not judged
    values : sequence of float
        What the command computes it for [SI]

    Raises
    ------
    BadInput
        A value that no such engine has
    """
    section, _, field = key.partition(".")
    if section in case.sections:
        others = {k: v for k, v in case.overrides.items() if k.rpartition(".")[2] not in (field, f"{field}_rpm")}
        for value in {min(values), max(values)}:
            case_of(case.path, {**others, key: value})


def emit(value: Any, as_json: bool, text: Callable[[], str], leave_out: tuple[str, ...] = ()) -> None:
    """Print a result with its doubts, as JSON or as text for people.

    Parameters
    ----------
    value : object
        The result with its documented keys; an object gets `doubts` and `accepted` besides, of a list they go to
        standard error
    text : callable
        Makes the text for people; called only when needed
    leave_out : tuple of str
        Keys that `summary.json` does without, since the other files of the run have them
    """
    doubts, accepted = _doubts(value)
    told = [f"doubt: {_told(d)}" for d in doubts] + [f"accepted: {_told(d)}" for d in accepted]
    carries = isinstance(value, Mapping) and not isinstance(value.get("doubts"), Mapping)  # as a printed case does
    if carries:
        value = {**value, "doubts": [asdict(d) for d in doubts], "accepted": [asdict(d) for d in accepted]}
    folder = click.get_current_context().meta.get(_RUN)
    if folder is not None:
        of_all = value if carries else {"rows": value, "doubts": doubts, "accepted": accepted}
        write_summary(folder, {key: numbers for key, numbers in of_all.items() if key not in leave_out})
    appear()  # files that the text names are in place before it is printed
    if told and not carries:
        click.echo("\n".join(told), err=True)
        told = []
    click.echo(to_json(value) if as_json else "\n".join([text(), *told]))
    click.get_current_context().meta[DOUBTED] = bool(doubts)


def _doubts(value: Any) -> tuple[tuple[Doubt, ...], tuple[Doubt, ...]]:
    """Doubts of the cases of this command and of its results; a result may bring doubts of its own."""
    loaded = click.get_current_context().meta.get(_CASES, [])
    acceptances = {code: a for case in loaded for code, a in case.acceptances.items()}
    found = [d for case in loaded for d in case.doubts]
    if loaded:
        found += results(value)
    own = value.get("doubts", ()) if isinstance(value, Mapping) else ()
    found += [d if isinstance(d, Doubt) else Doubt(**d) for d in (() if isinstance(own, Mapping) else own)]
    return sifted(tuple(dict.fromkeys(found)), acceptances)


def _told(doubt: Doubt) -> str:
    return f"{doubt.quantity} = {doubt.value:g}, usual is {doubt.usual}: {doubt.why}"


def progress(total: int, label: str) -> Any:
    """A progress bar on standard error, silent when that is no terminal.

    Returns
    -------
    bar : context manager
        Call `update(1)` on it after each step
    """
    return click.progressbar(length=total, label=label, file=sys.stderr, hidden=not sys.stderr.isatty())


def table(
    rows: list[dict[str, Any]], columns: list[str], units: Mapping[str, str] | None = None, digits: int = 4
) -> str:
    """Rows as an aligned text table, units in the headings, each column in the unit that suits it.

    Parameters
    ----------
    units : mapping of str to str, optional
        SI unit of columns whose name does not tell it
    digits : int
        At least so many; more where neighbours differ in them only

    Returns
    -------
    text : str
        Header line and one line a row
    """
    headed = [heading(c, [row.get(c) for row in rows], unit=(units or {}).get(c)) for c in columns]
    shown = [column_text(values, digits) for _, values in headed]
    cells = [[name for name, _ in headed], *([column[i] for column in shown] for i in range(len(rows)))]
    widths = [max(len(line[i]) for line in cells) for i in range(len(columns))]
    return "\n".join("  ".join(c.ljust(w) for c, w in zip(line, widths, strict=True)).rstrip() for line in cells)


def in_rows(rows: list[dict[str, Any]], keys: tuple[str, ...], unit: str = "unit") -> list[dict[str, Any]]:
    """Rows that each have a unit of their own, their numbers in the unit that suits them.

    Parameters
    ----------
    keys : tuple of str
        The numbers of a row; None stays None
    unit : str
        The key under which a row has its SI unit
    """
    found = []
    for row in rows:
        values = [row.get(key) for key in keys]
        values, name = shown_in(values, row[unit]) if row[unit] else (values, "")
        if name == "-" and all(abs(v) < SMALLEST for v in values if isinstance(v, float)):
            values = [ratio_text(v) if isinstance(v, float) and v else v for v in values]
        found.append(row | dict(zip(keys, values, strict=True)) | {unit: name})
    return found
