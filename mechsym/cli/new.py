"""`mechsym new`: a commented start for something of one's own."""

from pathlib import Path

import click

from mechsym.cases.new_engine import GASES, KINDS, RODS
from mechsym.cli.common import emit, json_option
from mechsym.errors import BadInput
from mechsym.plausible import Doubt
from mechsym.quantities import load, parse


@click.command(short_help="Write a commented start for something of your own.")
@click.argument("what", type=click.Choice(["mechanism", "engine", "diagram"]))
@click.argument("name", required=False)
@click.option("--kind", type=click.Choice(KINDS), help="Kind of the engine.")
@click.option("--bore", help='Bore of a cylinder, e.g. "86 mm".')
@click.option("--stroke", help='Stroke of a piston, e.g. "86 mm".')
@click.option("--cylinders", type=int, help="Number of cylinders; usual for the kind when left out.")
@click.option(
    "--gas", type=click.Choice(list(GASES)), help="Of a four-stroke engine: gas exchange, or closed period only."
)
@click.option(
    "--rods", type=click.Choice(RODS), help="Of a v or radial: all on the crank pin, or hung on a master rod."
)
@click.option("--trace", type=click.Path(dir_okay=False), help="CSV of a measured cylinder pressure, of a diagram.")
@click.option("--rod", help="Length of the connecting rod, of a diagram.")
@click.option("--compression", type=click.FloatRange(1.5, 30), help="Compression ratio, of a diagram.")
@click.option("--speed", help='Speed of a record without times, e.g. "1500 rpm".')
@click.option("--out", type=click.Path(path_type=Path), default=Path("."), help="Folder, or FILE.toml of an engine.")
@json_option
def new(what: str, name: str | None, kind: str | None, bore: str | None, stroke: str | None, cylinders: int | None,
        gas: str | None, rods: str | None, trace: str | None, rod: str | None, compression: float | None,
        speed: str | None, out: Path) -> None:  # fmt: skip
    """Write a new mechanism (declaration, case, test), the case of a new engine, or that of a measured pressure.

    An engine gets sizes by similarity, a firing order and the angles that belong to it, every value with a comment;
    NAME is the name of its file. `opposed` has two pistons in each cylinder. Check it with 'mechsym check FILE'.
    A diagram gets the case of the CSV file of --trace (angle or time, pressure; units in the headings), which
    'mechsym cycle' takes apart at once.

    \b
    Examples: mechsym new mechanism toggle_press
              mechsym new engine --kind inline --bore "86 mm" --stroke "86 mm" --cylinders 6
              mechsym new engine ship --kind two-stroke-crosshead --bore 0.5 --stroke "2 m"
              mechsym new diagram --trace p.csv --bore "68 mm" --stroke "55 mm" --rod "84 mm" --compression 8.5
    """
    traced = {"--trace": trace, "--rod": rod, "--compression": compression, "--speed": speed}
    if what != "diagram" and (named := [option for option, value in traced.items() if value is not None]):
        raise BadInput(f"only a diagram has {', '.join(named)}; leave it away, or write: mechsym new diagram")
    sizes = {"--kind": kind, "--bore": bore, "--stroke": stroke, "--cylinders": cylinders, "--gas": gas, "--rods": rods}
    if what == "mechanism" and (given := [option for option, value in sizes.items() if value is not None]):
        raise BadInput(f"only an engine has {', '.join(given)}; leave it away, or write: mechsym new engine")
    doubts: tuple[Doubt, ...] = ()
    if what == "mechanism":
        if out.suffix or out.is_file():
            raise BadInput(f"--out {out}: a mechanism is written as three files; give a folder, and its NAME before it")
        if name is None:
            raise BadInput("a mechanism needs a NAME: mechsym new mechanism toggle_press")
        files = load("mechsym.cases.new_diagram:write")(name, out)
    elif what == "diagram":
        if (kind, cylinders, gas, rods) != (None, None, None, None):
            raise BadInput("--kind, --cylinders, --gas and --rods belong to an engine; a diagram is of one cylinder")
        files, doubts = _diagram(name, trace, (bore, stroke, rod), compression, speed, out)
    else:
        from mechsym.cases.new_engine import judged, write_engine

        wide, long = _length(bore, "--bore"), _length(stroke, "--stroke")
        if kind is None:
            raise BadInput(f"an engine needs --kind: {', '.join(KINDS)}")
        out, name = _place(name, out)
        files = write_engine(kind, wide, long, cylinders, out, name, gas or "exchange", rods)
        doubts = judged(kind, wide, long)
    shown = [str(path) for path in files]
    emit({"written": shown, "doubts": doubts}, lambda: "", files=shown)


def _diagram(
    name: str | None, trace: str | None, sizes: tuple[str | None, str | None, str | None], compression: float | None,
    speed: str | None, out: Path,
) -> tuple[list[Path], tuple[Doubt, ...]]:  # fmt: skip
    from mechsym.cases.new_diagram import TraceSizes, write_diagram
    from mechsym.jobs.measured import case_of_trace

    if trace is None:
        raise BadInput("a diagram needs --trace FILE, the CSV file of a measured cylinder pressure")
    bore, stroke, rod = (
        _length(text, key, "diagram") for text, key in zip(sizes, ("--bore", "--stroke", "--rod"), strict=True)
    )
    if rod <= stroke / 2:
        raise BadInput(f"--rod {sizes[2]}: a rod is longer than the crank radius, half of --stroke {sizes[1]}")
    out, name = _place(name, out)
    omega = None if speed is None else parse(speed, "rad/s", "--speed")
    known = TraceSizes(bore=bore, stroke=stroke, rod=rod, compression=compression, speed=omega)
    text, doubts = case_of_trace(Path(trace), known, out)
    return write_diagram(text, out, name or Path(trace).stem), doubts


def _place(name: str | None, out: Path) -> tuple[Path, str]:
    """Folder and stem of the file; no stem where none is named."""
    if out.suffix == ".toml" and not out.is_dir():
        if name is not None and name.removesuffix(".toml") != out.stem:
            raise BadInput(f"NAME {name} and --out {out} both name the file, differently; leave one away")
        out, name = out.parent, out.stem
    if out.is_file():
        raise BadInput(f"--out {out} is a file that exists; give a folder, or a file that ends in .toml")
    return out, (name or "").removesuffix(".toml")


def _length(text: str | None, key: str, of: str = "engine") -> float:
    if text is None:
        raise BadInput(f'{"an" if of == "engine" else "a"} {of} needs {key}, for example {key} "86 mm"')
    length = parse(text, "m", key)
    if not 1e-3 <= length <= 10:
        raise BadInput(f"{key} = {text} is out of range; it must be 1 mm to 10 m")
    return length
