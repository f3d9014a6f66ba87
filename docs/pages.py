"""Pages of the docs site that follow from the program: commands with real output, keys of cases, mechanisms, rooms."""

import hashlib
import importlib
import inspect
import json
import os
import re
import tempfile
from importlib import resources
from pathlib import Path

import gallery
import pictures
from click.testing import CliRunner

from mechsym import cases, mechanisms
from mechsym.app.told import KNOWN
from mechsym.cases.keys import keys
from mechsym.cli import COMMANDS, mechsym
from mechsym.cli.results import RESULTS, rows
from mechsym.jobs.export import drawing
from mechsym.quantities.display import key_words, without_unit

# one example a command whose output is shown; each runs in some seconds
EXAMPLES = {
    "app": "app zotov-89 --check",
    "audit": 'audit --formula "r*(1-cos(phi))+r**2/(4*l)*(1-cos(2*phi))" --against crosshead.x',
    "cases": "cases",
    "check": "check zotov-89",
    "codesign": "codesign zotov-89 --ripple 5%",
    "compare": "compare nunes-slider-crank nunes-hypocycloid --speeds 2000,6000",
    "cycle": "cycle nunes-slider-crank --speeds 2000:8000:2000",
    "derive": "derive --check crosshead",
    "eval": "eval crosshead --case zotov-89 --set phi=1",
    "flywheel": "flywheel zotov-89 --ripple 2%",
    "fmu": "fmu zotov-89 --out engine.fmu",
    "balance": "balance zotov-89 --shafts 1,2",
    "forces": "forces moroianu",
    "guide": "guide zotov-89 --dxf guide.dxf",
    "hinge": "hinge zotov-89",
    "identify": "identify chmielewski --trace run/series.csv --free I2,k1",
    "mechanisms": "mechanisms",
    "native": "native --info",
    "new": 'new engine mine --kind inline --bore "86 mm" --stroke "86 mm" --cylinders 6',
    "optimise": "optimise nunes-hypocycloid",
    "page": "page zotov-89 --out engine.html",
    "export": "export zotov-89 --to c --out engine",
    "prove": "prove crosshead --samples 1000",
    "reproduce": "reproduce moroianu2017",
    "report": "report nunes-slider-crank --parts cycle,forces",
    "sections": "sections spring",
    "study": "study nunes2017-chapter-6 --only compression",
    "sweep": 'sweep zotov-89 --of hinge --over "spring.p0=4..6 MPa:3"',
    "simulate": "simulate alpha-stirling --set simulation.turns=3",
    "size": "size nunes-hypocycloid",
}
# what has to have run before, in the same folder
BEFORE = {
    "identify": 'simulate chmielewski --set "simulation.t_end=3 s" --set "simulation.window=1 s" --out run',
}
# a built-in case that shows a mechanism with its sizes
SHOWN = {
    "crosshead": "zotov-89", "crank_throw": "opposed-pistons", "hypocycloid": "nunes-hypocycloid",
    "rodless": "balandin", "crankshaft_flywheel": "chmielewski",
}  # fmt: skip
EXAMPLE_FILES = Path(__file__).parents[1] / "examples" / "mechanisms"
ROOMS = (
    "quantities periodic style page plausible convert native mechanisms cycle sizing machine simulate hinge "
    "torsion forces optimise proof codesign cases jobs sweep audit papers out"
).split()
_COMMANDS = re.compile(r"```sh\n(?P<lines>(?:mechsym [^\n]+\n)+)```")
_SHOWN = 16  # lines of what a command prints
_MEANINGS = 4  # of one word, in different results
_UNIT = re.compile(r"typing\.Annotated\[([^\[\],]+), '([^']+)'\]")  # of a number in a signature


def make(folder: Path) -> None:
    """Write all of them; what a command printed is kept until the program changes."""
    folder.mkdir(exist_ok=True)
    pages = {
        "commands": commands(folder / "printed"),
        "sections": sections(),
        "mechanisms": equations(),
        "rooms": rooms(),
        "glossary": glossary(),
    }
    for name, text in pages.items():
        path = folder / f"{name}.md"
        if not path.exists() or path.read_text(encoding="utf-8") != text:
            path.write_text(text, encoding="utf-8")


def commands(kept: Path) -> str:
    """Each command with its help, and what an example prints."""
    kept.mkdir(exist_ok=True)
    package = gallery.digest_of_package()
    parts = ["# Commands\n\nThe output stands as the program printed it when this page was made.\n"]
    for name in COMMANDS:
        parts.append(f"## {name}\n\n{_block(_printed(kept, package, f'{name} --help'))}\n")
        if name in EXAMPLES:
            lines = [line for line in (BEFORE.get(name), EXAMPLES[name]) if line]
            shown = "\n".join(f"$ mechsym {line}" for line in lines)
            parts.append(_block(f"{shown}\n{_printed(kept, package, *lines)}"))
    return "\n".join(parts) + "\n"


def _printed(kept: Path, package: str, *lines: str) -> str:
    """What the last of some commands prints, from the last time where neither it nor the program has changed."""
    file = kept / f"{hashlib.sha256(repr(lines).encode()).hexdigest()[:16]}.txt"
    if file.exists() and file.read_text(encoding="utf-8").startswith(f"{package}\n"):
        return file.read_text(encoding="utf-8").partition("\n")[2]
    text = _run(*lines)
    file.write_text(f"{package}\n{text}", encoding="utf-8")
    return text


def _run(*lines: str) -> str:
    import shlex

    here = os.getcwd()
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        try:
            for line in lines:
                done = CliRunner().invoke(mechsym, shlex.split(line), prog_name="mechsym", catch_exceptions=False)
                if done.exit_code not in (0, 1):
                    raise RuntimeError(f"mechsym {line} ended with {done.exit_code}: {done.output}")
        finally:
            os.chdir(here)
    return str(done.output).rstrip().replace(str(Path.home()), "~")


def _block(text: str) -> str:
    return f"````text\n{text}\n````\n"


def with_results(text: str, kept: Path) -> str:
    """A page with what each of its commands prints below it; the first one makes what the others read."""
    kept.mkdir(exist_ok=True, parents=True)
    package, first = gallery.digest_of_package(), ""

    def shown(found: re.Match[str]) -> str:
        nonlocal first
        parts = [found[0]]
        for line in found["lines"].splitlines():
            command = line.removeprefix("mechsym ")
            printed = _printed(kept, package, *dict.fromkeys(c for c in (first, command) if c)).splitlines()
            first = first or command
            short = printed[:_SHOWN] + ["..."] * (len(printed) > _SHOWN)
            parts.append(_block("\n".join((f"$ {line}", *short))))
        return "\n\n".join(parts)

    return _COMMANDS.sub(shown, text)


def glossary() -> str:
    """Every number that a command tells: word, meaning, unit and who tells it, from the fields of the results."""
    entries: dict[str, dict[str, list[str]]] = {}
    for command in RESULTS:
        for row in rows(command):
            if row["about"] and row["unit"]:
                stem = without_unit(row["path"].rpartition(".")[2].partition("[")[0], row["unit"])
                if not stem[1:].isidentifier() or row["unit"].startswith(("of ", "in ")):
                    continue  # columns of any name
                entry = entries.setdefault(key_words(stem, KNOWN).strip() or stem, {"about": [], "unit": [], "by": []})
                for name, value in (("about", row["about"]), ("unit", row["unit"]), ("by", command)):
                    entry[name] += [value] * (value not in entry[name])
    parts = []
    for word, entry in sorted({w.lower(): (w, e) for w, e in entries.items()}.values(), key=lambda one: one[0].lower()):
        units = ", ".join(f"`{unit}`" for unit in entry["unit"] if unit != "-")
        told = "; ".join(about.rstrip(".") for about in entry["about"][:_MEANINGS])
        parts.append(f"{word}\n  {_escaped(told)}. {f'Unit {units}. ' if units else ''}"
                     f"Told by {', '.join(f'`{by}`' for by in entry['by'])}.\n")  # fmt: skip
    head = "# Glossary\n\nWhat the numbers of results mean, from the results themselves. Units are those of `--json`.\n"
    return "\n".join([head, ":::{glossary}", *parts, ":::"]) + "\n"


def _escaped(text: str) -> str:
    return re.sub(r"([*_\[\]<>|])", r"\\\1", text)


def sections() -> str:
    """The case reference, from the records."""
    parts = ["# Sections of a case\n\nEvery key with unit, range and meaning, as `mechsym sections` prints it.\n"]
    listed = keys()
    for section in dict.fromkeys(row["section"] for row in listed):
        own = [row for row in listed if row["section"] == section]
        readers = ", ".join(own[0]["commands"]) or "no command by itself"
        parts.append(f"## [{section}]\n\nRead by: {readers}.\n")
        for variant in dict.fromkeys(row["variant"] for row in own):
            if variant:
                parts.append(f"### {section}: {variant}\n")
            parts.append("| key | unit | range | usual | meaning |\n|---|---|---|---|---|")
            parts += [_row(row) for row in own if row["variant"] == variant]
            parts.append("")
    return "\n".join(parts) + "\n"


def _row(row: dict) -> str:
    bounds = (("above", "\\>"), ("low", "≥"), ("below", "\\<"), ("high", "≤"))
    limits = ", ".join(f"{sign} {row[name]:g}" for name, sign in bounds if row[name] is not None)
    limits = limits or ", ".join(row["options"] or ()) or (row["kind"] if row["unit"] is None else "")
    usual = "**needed**" if row["required"] else "" if row["default"] in (None, [], "") else f"`{row['default']}`"
    unit = (row["unit"] or "").replace("*", "\\*")
    return f"| `{row['key']}` | {unit} | {limits} | {usual} | {row['about'].replace('|', '/')} |"


def equations() -> str:
    """The derived mechanisms: letters with units, and their equations set by the browser."""
    parts = ["# Mechanisms\n\nEquations as they were derived; `mechsym eval NAME --latex` prints them as LaTeX.\n"]
    for name in mechanisms.names():
        if name == "crank_train":
            continue
        stored = json.loads((resources.files("mechsym.generated") / "equations" / f"{name}.json").read_text())
        parts.append(f"## {name}\n\n{stored['about']}\n")
        if name in SHOWN:
            parts.append(_turning(SHOWN[name]))
        letters = [f"`{n} [{u}]`" for kind in ("coordinates", "parameters", "inputs") for n, u in stored[kind].items()]
        parts.append(f"Letters: {', '.join(letters)}.\n")
        rows = "".join(f"<p><math display='block'>{row['mathml']}</math></p>" for row in stored["equations"])
        parts.append(f"```{{raw}} html\n<div style='overflow-x:auto'>{rows}</div>\n```\n")
    parts.append(
        "## Of files\n\nEach is [declared in a file](../own-mechanism.md) of examples/mechanisms and drawn from it.\n"
    )
    for case in sorted(EXAMPLE_FILES.glob("*.toml")):
        if turning := _turning(str(case)):
            parts.append(f"### {case.stem.replace('-', ' ')}\n\n{turning}")
    return "\n".join(parts) + "\n"


def _turning(name: str) -> str:
    """The machine of a case, turning to scale."""
    case = cases.load(name)
    shapes = drawing(case)
    if shapes is None:
        return ""
    picture = pictures.moving(shapes, f"{case.mechanism}, turning".rpartition("/")[2], {})
    return f"{case.about}, to scale:\n\n```{{raw}} html\n<div style='max-width:34rem'>{picture}</div>\n```\n"


def rooms() -> str:
    """What each room exports, with signature and docstring."""
    parts = ["# Rooms\n\nThe public interface of Python is what each room's `__all__` names.\n"]
    for room in ROOMS:
        module = importlib.import_module(f"mechsym.{room}")
        parts.append(f"## mechsym.{room}\n\n{_block(inspect.getdoc(module) or '')}\n")
        for name in getattr(module, "__all__", ()):
            found = getattr(module, name)
            if inspect.ismodule(found):
                continue
            told = inspect.getdoc(found) if callable(found) else repr(found)
            parts.append(
                f"### {room}.{name}\n\n{_block(f'{name}{_signature(found)}{chr(10)}{chr(10)}{told or str()}')}\n"
            )
    return "\n".join(parts) + "\n"


def _signature(found: object) -> str:
    if not callable(found):
        return ""
    try:
        return _UNIT.sub(
            lambda m: f"{'float' if m[1].startswith('~') else m[1]} [{m[2]}]", str(inspect.signature(found))
        )
    except (TypeError, ValueError):
        return "(..)"
