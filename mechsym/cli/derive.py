"""`mechsym derive`: regenerate the code, or check that it is what the derivations give."""

import sys

import click

from mechsym.cli.common import emit, json_option, progress


@click.command()
@click.argument("names", nargs=-1)
@click.option("--check", is_flag=True, help="Write nothing; exit 1 when generated/ is not what the derivations give.")
@json_option
def derive(names: tuple[str, ...], check: bool, as_json: bool) -> None:
    """Regenerate generated/ from derivations/.

    \b
    Example: mechsym derive crosshead
    """
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
    emit({"written": written, "differs": sorted(differs)}, as_json, lambda: _text(written, differs, check))
    if differs:
        sys.exit(1)


def _text(written: list[str], differs: dict[str, str], check: bool) -> str:
    if differs:
        return "\n".join(
            [*differs.values(), "generated/ is not what the derivations give: run `make derive` and commit"]
        )
    if check:
        return "generated/ is what the derivations give"
    return "\n".join(f"wrote generated/{file}" for file in written) or "nothing to write: generated/ is up to date"
