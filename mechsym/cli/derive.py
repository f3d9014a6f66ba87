"""`mechsym derive`: regenerate the code, or check that it is what the derivations give."""

import sys
from pathlib import Path

import click

from mechsym.cli.common import emit, folder_option, json_option, progress, refuse_idle
from mechsym.errors import BadInput
from mechsym.files import Json, write_text


@click.command()
@click.argument("names", nargs=-1)
@click.option("--check", is_flag=True, help="Write nothing; exit 1 when the code is not what the derivations give.")
@click.option("--show", is_flag=True, help="Print the code of mechanisms of your own.")
@click.option("--explain", is_flag=True, help="Print how the loops of your own mechanisms close, write nothing.")
@click.option("--draw", is_flag=True, help="Draw your own mechanisms in their pose as NAME.svg, in --out or here.")
@click.option("--latex", is_flag=True, help="Print the equations as LaTeX and write nothing.")
@folder_option
@json_option
def derive(
    names: tuple[str, ...], check: bool, show: bool, explain: bool, draw: bool, latex: bool, out: Path | None
) -> None:
    """Regenerate generated/ from derivations/, or derive a mechanism of your own from its file.

    The code of FILE.py or FILE.py:NAME goes to the cache by its content, with --out to a folder.

    \b
    Examples: mechsym derive crosshead
              mechsym derive ./scotch.py --out derived
              mechsym derive ./scotch.py --explain
              mechsym derive crosshead --latex
    """
    from mechsym.derive import build
    from mechsym.mechanisms import own
    from mechsym.mechanisms.equations import equations
    from mechsym.mechanisms.plots import assembled

    files = [name for name in dict.fromkeys(names) if own.is_file(name)]
    given = {"--latex": latex, "--explain": explain, "--draw": draw, "--show": show, "--check": check, "--out": out}
    first = next((option for option, value in given.items() if value), "")
    if first in ("--latex", "--explain", "--draw"):
        silent = {"latex", "explain", "draw", "show", "check", "out"} - {first[2:], "out" if first == "--draw" else ""}
        refuse_idle(f"beside {first}", *silent)
    if not files and (idle := [option for option in ("--explain", "--draw", "--show", "--out") if given[option]]):
        raise BadInput(f"{idle[0]} is for a mechanism of your own: name its FILE.py, or leave {idle[0]} out")
    if latex:
        found_equations = [equations(name) for name in names or tuple(build.scripts())]
        text = "\n\n".join(f"% {one.name}\n{one.latex}" for one in found_equations)
        emit({"latex": {one.name: one.rows for one in found_equations}}, lambda: text)
        return
    if explain:
        steps = {name: own.explained(name) for name in files}
        emit({"closing": steps}, lambda: "\n".join(line for lines in steps.values() for line in lines))
        return
    if draw:
        drawn = (assembled(name) for name in files)
        pictures = [str(write_text((out or Path()) / f"{called}.svg", picture)) for called, picture in drawn]
        _refuse_same(pictures)
        emit({"written": pictures}, lambda: "", files=pictures)
        return
    result = _files(files, check, out) if files else {"written": [], "differs": {}, "code": [], "redundant": []}
    others = tuple(name for name in names if name not in files)
    if not files or others:
        built_in = _built_in(others, check)
        result |= {k: v | result[k] if isinstance(v, dict) else result[k] + v for k, v in built_in.items()}
    shown = {"code": result["code"]} if show else {}
    shown |= {"redundant": result["redundant"]} if result["redundant"] else {}
    report = {"written": result["written"], "differs": sorted(result["differs"]), **shown}
    emit(report, lambda: _text(result, check, show), files=[] if check or show else result["written"])
    if result["differs"]:
        sys.exit(1)


def _files(names: list[str], check: bool, out: Path | None) -> Json:
    from mechsym.mechanisms import own

    result: Json = {"written": [], "differs": {}, "code": [], "redundant": []}
    with progress(len(names), "deriving") as bar:
        for name in names:
            if check:
                result["differs"] |= own.differences(name, out)
            else:
                mechanism = own.load(name)
                result["code"].append(mechanism.code)
                result["written"] += [str(p) for p in own.write(mechanism, out)]
                result["redundant"] += mechanism.listing.get("redundant", [])
            bar.update(1)
    if out is not None:
        _refuse_same(result["written"])
    return result


def _refuse_same(written: list[str]) -> None:
    """Refuse two mechanisms whose names are one: the second would take the place of the first."""
    twice = next((path for path in written if written.count(path) > 1), None)
    if twice is not None:
        raise BadInput(f"{twice} would be of two mechanisms, which have one name; derive each into a folder of its own")


def _built_in(names: tuple[str, ...], check: bool) -> Json:
    from mechsym.derive import build

    differs: dict[str, str] = {}
    written: list[str] = []
    chosen = names or tuple(build.scripts())
    with progress(len(chosen), "deriving") as bar:
        for name in chosen:
            if check:
                differs |= build.differences([name])
            else:
                written += build.write([name])
            bar.update(1)
    if not names and check:
        differs |= {file: f"generated/{file} has no derivation" for file in build.orphans()}
    elif not names:
        written += build.write([])
    return {"written": written, "differs": differs, "code": []}


def _text(data: Json, check: bool, show: bool) -> str:
    if data["differs"]:
        way = "the code is not what the derivations give: run `make derive` (or `mechsym derive FILE.py`) and commit"
        return "\n".join([*data["differs"].values(), way])
    if check:
        return "the code is what the derivations give"
    if show:
        return "\n".join(data["code"])
    return "\n".join(data["redundant"]) if data["written"] else "nothing to write: generated/ is up to date"
