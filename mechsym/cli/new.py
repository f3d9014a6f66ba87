"""`mechsym new`: a commented start for something of one's own."""

from pathlib import Path

import click

from mechsym.cases.new_engine import KINDS
from mechsym.cli.common import emit, json_option
from mechsym.errors import BadInput
from mechsym.quantities import parse


@click.command(short_help="Write a commented start for something of your own.")
@click.argument("what", type=click.Choice(["mechanism", "engine"]))
@click.argument("name", required=False)
@click.option("--kind", type=click.Choice(KINDS), help="Kind of the engine.")
@click.option("--bore", help='Bore of a cylinder, e.g. "86 mm".')
@click.option("--stroke", help='Stroke of a piston, e.g. "86 mm".')
@click.option("--cylinders", type=int, help="Number of cylinders; usual for the kind when left out.")
@click.option("--out", type=click.Path(path_type=Path), default=Path("."), help="Folder, or FILE.toml of an engine.")
@json_option
def new(what: str, name: str | None, kind: str | None, bore: str | None, stroke: str | None, cylinders: int | None,
        out: Path, as_json: bool) -> None:  # fmt: skip
    """Write a new mechanism (declaration, case, test) or the case of a new engine.

    An engine gets sizes by similarity, a firing order and the angles that belong to it, every value with a comment;
    NAME is the name of its file. `opposed` has two pistons in each cylinder. Check it with 'mechsym check FILE'.

    \b
    Examples: mechsym new mechanism toggle_press
              mechsym new engine --kind inline --bore "86 mm" --stroke "86 mm" --cylinders 6
              mechsym new engine ship --kind two-stroke-crosshead --bore 0.5 --stroke "2 m"
    """
    files = _mechanism(name, out) if what == "mechanism" else _engine(name, kind, (bore, stroke), cylinders, out)
    shown = [str(path) for path in files]
    emit({"written": shown}, as_json, lambda: "\n".join(f"wrote {file}" for file in shown))


def _mechanism(name: str | None, out: Path) -> list[Path]:
    from mechsym.cases import new_mechanism

    if out.suffix or out.is_file():
        raise BadInput(f"--out {out}: a mechanism is written as three files; give a folder, and its NAME before it")
    if name is None:
        raise BadInput("a mechanism needs a NAME: mechsym new mechanism toggle_press")
    return new_mechanism.write(name, out)


def _engine(
    name: str | None, kind: str | None, sizes: tuple[str | None, str | None], cylinders: int | None, out: Path
) -> list[Path]:
    from mechsym.cases.new_engine import write_engine

    bore, stroke = (_length(text, key) for text, key in zip(sizes, ("--bore", "--stroke"), strict=True))
    if kind is None:
        raise BadInput(f"an engine needs --kind: {', '.join(KINDS)}")
    if out.suffix == ".toml" and not out.is_dir():
        if name is not None and name.removesuffix(".toml") != out.stem:
            raise BadInput(f"NAME {name} and --out {out} both name the file, differently; leave one away")
        out, name = out.parent, out.stem
    if out.is_file():
        raise BadInput(f"--out {out} is a file that exists; give a folder, or a file that ends in .toml")
    return write_engine(kind, bore, stroke, cylinders, out, (name or "").removesuffix(".toml"))


def _length(text: str | None, key: str) -> float:
    if text is None:
        raise BadInput(f'an engine needs {key}, for example {key} "86 mm"')
    length = parse(text, "m", key)
    if not 1e-3 <= length <= 10:
        raise BadInput(f"{key} = {text} is out of range; it must be 1 mm to 10 m")
    return length
