"""Pages of the docs site that follow from the program: commands with real output, keys of cases, mechanisms, words."""

import json
import re
import shlex
import tomllib
from importlib import resources
from pathlib import Path

import equations
import pictures

from mechsym import cases, mechanisms
from mechsym.app.told import KNOWN
from mechsym.audit.read.mathml import STYLE as FORMULAS
from mechsym.audit.theory import catalogue
from mechsym.cases.keys import keys
from mechsym.cli import COMMANDS, GROUPS
from mechsym.cli import mechsym as cli
from mechsym.cli.results import RESULTS, rows
from mechsym.jobs.export import drawing
from mechsym.quantities import load
from mechsym.quantities.display import key_words, without_unit

PRINTED = Path(__file__).parent / "printed"  # what examples print, held against the program by tests/test_docs_runs.py
# an example of each command: the name of a kept answer in tests/recorded, or a line whose answer docs/printed keeps
EXAMPLES = {
    "app": "app zotov-89 --check", "audit": "none/audit-formula", "balance": "zotov-89/balance",
    "cases": "none/cases", "check": "zotov-89/check", "cite": "cite nunes-hypocycloid",
    "codesign": "codesign zotov-89 --ripple 5%", "compare": "nunes-slider-crank/compare-two",
    "cycle": "nunes-hypocycloid/cycle-speeds", "derive": "derive --check crosshead", "eval": "none/eval-state",
    "export": "zotov-89/export", "flywheel": "zotov-89/flywheel",
    "fmu": "fmu zotov-89 --platforms none --out engine.fmu",
    "forces": "moroianu/forces", "guide": "zotov-89/guide", "hinge": "zotov-89/hinge",
    "identify": "identify chmielewski --trace run/series.csv --free I2,k1", "mechanisms": "none/mechanisms",
    "native": "native --info", "new": 'new engine mine --kind inline --bore "86 mm" --stroke "86 mm" --cylinders 6',
    "optimise": "optimise nunes-hypocycloid", "page": "page zotov-89 --out engine.html", "prove": "none/prove",
    "report": "report nunes-slider-crank --parts cycle,forces", "reproduce": "none/reproduce-moroianu",
    "sections": "sections spring", "simulate": "alpha-stirling/simulate", "size": "nunes-hypocycloid/size",
    "study": "study nunes2017-chapter-6 --only compression", "sweep": "nunes-hypocycloid/sweep-size",
}  # fmt: skip
#: What has to run before, in the same folder
BEFORE = {
    "identify": 'simulate chmielewski --set "simulation.t_end=3 s" --set "simulation.window=1 s" --out run',
}
MACHINE = ("native",)  # what it prints is said of the machine at hand: its page is not kept
# a built-in case that shows a mechanism with its sizes
SHOWN = {
    "crosshead": "zotov-89", "crank_throw": "opposed-pistons", "hypocycloid": "nunes-hypocycloid",
    "rodless": "balandin", "crankshaft_flywheel": "chmielewski",
}  # fmt: skip
EXAMPLE_FILES = Path(__file__).parents[1] / "examples" / "mechanisms"
WRITTEN: set[Path] = set()  # pages of this build
_SHOWN = 24  # lines of what a command prints
_MEANINGS = 4  # of one word, in different results


def make(folder: Path) -> None:
    """Write all of them."""
    (folder / "commands").mkdir(parents=True, exist_ok=True)
    (folder / "cases").mkdir(exist_ok=True)
    pages = {"sections": sections(), "mechanisms": derived(), "glossary": glossary(), "theories": theories()}
    pages |= {f"commands/{name}": command(name) for name in COMMANDS} | {"commands/index": commands()}
    pages |= {f"cases/{Path(name).stem}": case_page(name, folder / "cases") for name in every_case()}
    pages |= {"cases/index": case_index()}
    for name, text in pages.items():
        write(folder / f"{name}.md", text)


def write(path: Path, text: str) -> None:
    """Write a page that has changed; what has not is left alone, so that Sphinx does."""
    WRITTEN.add(path)
    if not path.exists() or path.read_text(encoding="utf-8") != text:
        path.write_text(text, encoding="utf-8")


def clear(folder: Path) -> None:
    """Take away pages that an earlier build wrote and this one did not."""
    for part in (folder, *(folder / name for name in ("commands", "cases", "python"))):
        for path in part.glob("*.md"):
            if path not in WRITTEN and path.name != "findings.md":
                path.unlink()


def block(text: str) -> str:
    return f"````text\n{text}\n````\n"


_SHARED = """What all of them share:

- CASE is the name of a built-in case or a path to a TOML file; `--set KEY=VALUE` replaces one of its values, with a
  unit if you like, as often as you like: `--set spring.p0="9.5 MPa"`.
- Ranges and lists are written alike everywhere: `80,85 rpm`, `a..b:n` for n points, `a:b:step`; one unit behind the
  last number, or one behind each.
- `--budget "10 min, 2 GB"` is the limit of time and memory where a command has it: what is forecast to take more does
  not begin.
- `--json` prints one JSON value to standard output and nothing else there; numbers are SI unless the key names another
  unit, and never NaN. `--units "mm, bar, kN, deg"` sets text, tables and reports.
- `--out` names a folder; its files appear together or not at all. Progress goes to standard error, and only on a
  terminal.
- `--strict` ends with 3 where there are doubts; [exit statuses](../../stability.md) are the same for all.
"""


def commands() -> str:
    """All commands by what they are for."""
    head = "# Commands\n\nEach has its help, an example with what it printed, and the fields of its `--json`.\n"
    parts = [head, _SHARED]
    for title, names in GROUPS.items():
        parts.append(f"## {title}\n\n| command | does |\n|---|---|")
        parts += [f"| [{name}]({name}.md) | {load(COMMANDS[name]).get_short_help_str(120)} |" for name in names]
        parts.append("")
    tree = "\n".join(COMMANDS)
    return "\n".join([*parts, f"```{{toctree}}\n:hidden:\n\n{tree}\n```"]) + "\n"


def command(name: str) -> str:
    """Help of a command, what an example prints, and every number of its JSON."""
    import click

    shown = cli.get_command(click.Context(cli), name)  # with the options that all commands have
    context = click.Context(shown, info_name=f"mechsym {name}", max_content_width=100)
    parts = [f"# mechsym {name}\n\n{block(shown.get_help(context))}", example(name)]
    if name in RESULTS:
        schema = f"`mechsym sections --results --schema {name}` prints them as JSON Schema"
        parts.append(f"## JSON\n\nFields of `--json`, a `*` for names, `[]` for places of a list; {schema}.\n")
        parts.append(
            table(("path", "unit", "meaning"), ((f"`{r['path']}`", r["unit"], r["about"]) for r in rows(name)))
        )
    return "\n".join(parts)


def example(name: str) -> str:
    """What an example of a command printed."""
    kept = EXAMPLES[name]
    if name in MACHINE:
        words = "It names the compiler, its options and the cache of the machine."
        return f"## Example\n\n{block(f'$ mechsym {kept}')}{words}"
    if shlex.split(kept)[0] == name:
        before = [f"$ mechsym {BEFORE[name]}"] if name in BEFORE else []
        text = "\n".join([*before, printed(kept)])
    else:
        text = equations.recorded(kept, _SHOWN)
    return f"## Example\n\n{block(text)}"


def printed(line: str) -> str:
    """What docs/printed keeps of a command, below its line."""
    return f"$ mechsym {line}\n" + (PRINTED / f"{slug(line)}.txt").read_text(encoding="utf-8").rstrip()


def slug(line: str) -> str:
    """The name of a file for what a command prints."""
    return re.sub(r"[^a-z0-9]+", "-", line.lower()).strip("-")[:80]


def table(heads: tuple[str, ...], lines) -> str:
    """A table of Markdown; what would end a cell or set a formula is escaped."""
    cells = (" | ".join(escaped(str(cell)) for cell in line) for line in lines)
    return "\n".join([f"| {' | '.join(heads)} |", "|" + "---|" * len(heads), *(f"| {line} |" for line in cells)]) + "\n"


def escaped(text: str) -> str:
    """Words as Markdown shows them; what stands between backticks stays."""
    return "".join(
        piece.replace("|", "/") if k % 2 else re.sub(r"([*_\[\]<>|$])", r"\\\1", piece)
        for k, piece in enumerate(re.split(r"(`[^`]*`)", text))
    )


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
        parts.append(f"{word}\n  {escaped(told)}. {f'Unit {units}. ' if units else ''}"
                     f"Told by {', '.join(f'`{by}`' for by in entry['by'])}.\n")  # fmt: skip
    head = "# Glossary\n\nWhat the numbers of results mean, from the results themselves. Units are those of `--json`.\n"
    return "\n".join([head, ":::{glossary}", *parts, ":::"]) + "\n"


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


def derived() -> str:
    """The derived mechanisms: letters with units, and their equations set by the browser."""
    parts = ["# Mechanisms\n\nEquations as they were derived; `mechsym eval NAME --latex` prints them as LaTeX.\n"]
    for name in mechanisms.names():
        if name == "crank_train":
            continue
        stored = json.loads((resources.files("mechsym.generated") / "equations" / f"{name}.json").read_text())
        parts.append(f"## {name}\n\n{stored['about']}\n")
        if name in SHOWN and (Path(__file__).parent / "made" / "cases" / f"{SHOWN[name]}.svg").exists():
            picture = f"![{name}, turning](cases/{SHOWN[name]}.svg){{.machine}}"
            parts.append(f"{picture}\n\nTo scale: [{SHOWN[name]}](cases/{SHOWN[name]}.md).\n")
        letters = [f"`{n} [{u}]`" for kind in ("coordinates", "parameters", "inputs") for n, u in stored[kind].items()]
        parts.append(f"Letters: {', '.join(letters)}.\n")
        parts.append(f"```{{derived}} {name}\n```\n")
    parts.append(
        "Those of files are among the [cases](cases/index.md): each is declared as [your own](../own-mechanism.md).\n"
    )
    return "\n".join(parts) + "\n"


def theories() -> str:
    """What formulas can be held against: every theory with its letters and quantities."""
    parts = ["# Theories of the auditor\n\nWhat `mechsym audit --formula TEXT --against THEORY.QUANTITY` knows. A "
             "theory of a mechanism has all names of its derivation; slopes (`dx_dphi`), rates (`x_d`, `x_dd`) and "
             "harmonics (`x_mean`, `x_cos2`) come by themselves.\n\n"
             f"```{{raw}} html\n<style>{FORMULAS}</style>\n```\n"]  # fmt: skip
    shipped = catalogue.shipped()
    for name in catalogue.names():
        theory = catalogue.theory(name)
        letters = ", ".join(f"`{letter}` [{one.unit}]" for letter, one in theory.letters.items())
        source = tomllib.loads(shipped[name]).get("source") if name in shipped else theory.data
        parts.append(f"## {name}\n\n{source or ''}\n\nLetters: {escaped(letters)}.\n")
        known = [n for n in theory.results if not n.startswith("_")]
        parts.append(
            "Quantities: "
            + ", ".join(f"`{n}`" for n in known[:_MOST])
            + (" and more" if len(known) > _MOST else "")
            + ".\n"
        )
        if name in shipped:
            parts.append(f"```{{theory}} {name}\n```\n")
    return "\n".join(parts) + "\n"


_MOST = 60  # quantities of a theory that are listed


def every_case() -> list[str]:
    """Built-in cases, and those of the examples by their files."""
    return [*cases.names(), *(str(file) for file in sorted(EXAMPLE_FILES.glob("*.toml")))]


def case_page(name: str, folder: Path) -> str:
    """A case: its machine turning, what commands say of it, and its text to copy."""
    case, stem = cases.load(name), Path(name).stem
    parts = [f"# {stem.replace('-', ' ') if name.endswith('.toml') else stem}\n\n{escaped(case.about)}.\n"]
    if seen := drawing(case):
        write(folder / f"{stem}.svg", pictures.moving(seen[0], f"{stem}, turning", {}))
        parts.append(f"![{stem}, turning]({stem}.svg){{.machine}}\n")
    for one in ("hinge", "cycle", "forces", "simulate"):
        kept = equations.RECORDED / stem / f"{one}.json"
        if kept.exists() and json.loads(kept.read_text(encoding="utf-8"))["exit"] == 0:
            parts.append(f"```{{recorded}} {stem}/{one}\n:lines: 12\n```\n")
    parts.append(f"## Its text\n\n{_how_to_open(name)}\n\n````toml\n{cases.text(name).rstrip()}\n````\n")
    declared = Path(name).with_name(f"{stem.replace('-', '_')}.py")
    if declared.exists():
        parts.append(f"## Its mechanism\n\n````python\n{declared.read_text(encoding='utf-8').rstrip()}\n````\n")
    return "\n".join(parts)


def _how_to_open(name: str) -> str:
    stem = Path(name).stem
    if name.endswith(".toml"):
        file = f"examples/mechanisms/{stem}.toml"
        return f"`{file}`; `mechsym app {file}` opens it in the workbench."
    return f"`mechsym cases {stem} > mine.toml` copies it; `mechsym app {stem}` opens it in the workbench."


def case_index() -> str:
    """The list of all cases."""
    told = ((f"[{Path(n).stem}]({Path(n).stem}.md)", cases.load(n).about) for n in every_case())
    lines = "\n".join(f"| {link} | {escaped(about)} |" for link, about in told)
    tree = "\n".join(Path(n).stem for n in every_case())
    head = "# Cases\n\nData to start from: built in, and of `examples/mechanisms`.\n\n| case | about |\n|---|---|"
    return f"{head}\n{lines}\n\n```{{toctree}}\n:hidden:\n\n{tree}\n```\n"
