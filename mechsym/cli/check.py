"""`mechsym check`: all problems of a case at once, and what each command still lacks."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

import click

from mechsym.cases import Case
from mechsym.cli.common import case_of, emit, json_option
from mechsym.errors import BadInput
from mechsym.files import Json

if TYPE_CHECKING:
    from mechsym.cases.check import CaseProblem


@click.command(short_help="All problems of a case at once.")
@click.argument("case")
@json_option
@click.pass_context
def check(ctx: click.Context, case: str) -> None:
    """Every problem of CASE with key, reason and what is allowed; and what each command still lacks to run on it.

    Exit status 2 when there are problems. A mechanism file of the user's own is not run without --trust; its letters
    are then left unchecked.

    \b
    Example: mechsym check mine.toml
    """
    import dataclasses

    from mechsym.cases.check import check_file

    checked = check_file(case, ctx.meta["mechsym.trust"])
    whole = not checked.problems and not checked.skipped
    problems = [*checked.problems]
    if whole:
        one = case_of(case, {})  # its doubts are told as every command tells them
        problems += _pistons(one) if not checked.commands["cycle"] else []
        one.read.clear()
    report: Json = {
        "problems": [dataclasses.asdict(problem) for problem in problems],
        "commands": dict(checked.commands),
        "skipped": list(checked.skipped),
        **({} if whole else {"doubts": checked.doubts}),
    }
    emit(report, lambda: _text(report, checked.reasons))
    ctx.exit(2 if problems else 0)


def _pistons(case: Case) -> "list[CaseProblem]":
    """What a declaration of the user's own says of its pistons and its motion denies."""
    from mechsym.cases.check import CaseProblem
    from mechsym.jobs.gas import require_pistons
    from mechsym.jobs.machine import one_coordinate
    from mechsym.mechanisms import own, roles_of

    if not own.is_file(case.mechanism) or not roles_of(case.mechanism).pistons:
        return []
    try:
        require_pistons(case, one_coordinate(case))
    except BadInput as error:
        return [CaseProblem(key="mechanism", why=str(error).removeprefix(f"{case.file}: "))]
    return []


def _text(report: Json, reasons: Mapping[str, str]) -> str:
    problems, commands = report["problems"], report["commands"]
    lines = [f"{len(problems)} problem{'s' * (len(problems) != 1)}" if problems else "no problems"]
    lines += [f"  {row['key'] or 'file'}: {_told(row)}" for row in problems]
    if report["skipped"]:
        lines.append(f"not checked: {', '.join(f'[{name}]' for name in report['skipped'])}")
    ready = [name for name, missing in commands.items() if not missing]
    lines += ["", f"can run{' once mended' * bool(problems)}: {', '.join(ready) or 'nothing'}"] if commands else []
    for reason in dict.fromkeys(reasons.values()):
        names = [name for name, why in reasons.items() if why == reason]
        lacks = f" lack{'s' * (len(names) == 1)}" if reason.startswith(("[", "drive.")) else ":"
        lines.append(f"  {', '.join(names)}{lacks} {reason}")
    return "\n".join(lines)


def _told(row: dict[str, str]) -> str:
    said = any(words in row["why"] for words in ("must be", "give it in", "write for example", "options are"))
    return row["why"] + (f"; {row['allowed']}" if row["allowed"] and not said else "")
