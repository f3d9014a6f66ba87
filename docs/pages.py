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
from click.testing import CliRunner

from mechsym import mechanisms
from mechsym.cases.keys import keys
from mechsym.cli import COMMANDS, mechsym

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
ROOMS = (
    "quantities periodic style page plausible convert native mechanisms cycle sizing machine simulate hinge "
    "torsion forces optimise codesign cases jobs sweep audit papers out"
).split()
_UNIT = re.compile(r"typing\.Annotated\[([^\[\],]+), '([^']+)'\]")  # of a number in a signature


def make(folder: Path) -> None:
    """Write all of them; what a command printed is kept until the program changes."""
    folder.mkdir(exist_ok=True)
    pages = {
        "commands": commands(folder / "printed"),
        "sections": sections(),
        "mechanisms": equations(),
        "rooms": rooms(),
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


def sections() -> str:
    """The case reference, from the records."""
    parts = ["# Sections of a case\n\nEvery key with unit, range and meaning, as `mechsym sections` prints it.\n"]
    rows = keys()
    for section in dict.fromkeys(row["section"] for row in rows):
        own = [row for row in rows if row["section"] == section]
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
        letters = [f"`{n} [{u}]`" for kind in ("coordinates", "parameters", "inputs") for n, u in stored[kind].items()]
        parts.append(f"Letters: {', '.join(letters)}.\n")
        rows = "".join(f"<p><math display='block'>{row['mathml']}</math></p>" for row in stored["equations"])
        parts.append(f"```{{raw}} html\n<div style='overflow-x:auto'>{rows}</div>\n```\n")
    return "\n".join(parts) + "\n"


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
