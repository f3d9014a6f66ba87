"""Pages of the docs site for who writes Python, and the messages of the program: read off the code."""

import ast
import importlib
import inspect
import re
from pathlib import Path

import equations
from pages import block, escaped, table, write

import mechsym

ROOMS = (
    "cases jobs hinge codesign machine cycle forces torsion simulate mechanisms derive sizing optimise sweep report "
    "papers audit convert native quantities page style plausible"
).split()
_ROOT = Path(mechsym.__file__).parent
_UNIT = re.compile(r"typing\.Annotated\[([^\[\],]+), '([^']+)'\]")  # of a number in a signature
_PLACE = re.compile(r"<([\w.]+)[^>]*>")
# what people get wrong, in the order in which they meet it: folders of the program whose messages belong together
TOPICS = {
    "Case files and values": ("cases", "quantities", "files"),
    "Options and commands": ("cli", "jobs", "report", "budget.py"),
    "Mechanisms of your own": ("derive", "mechanisms"),
    "Engines and gas": ("cycle", "machine", "sizing", "forces"),
    "Runs in time": ("simulate", "torsion", "native"),
    "Hinge, guide and co-design": ("hinge", "codesign", "optimise"),
    "Formulas and papers": ("audit", "papers", "convert.py"),
    "Sweeps and files for other programs": ("sweep", "out", "page", "app", "proof"),
}


def make(folder: Path) -> None:
    """Write them."""
    (folder / "python").mkdir(parents=True, exist_ok=True)
    for name in ROOMS:
        write(folder / "python" / f"{name}.md", room(name))
    write(folder / "python" / "index.md", rooms())
    write(folder / "messages.md", messages())


def rooms() -> str:
    """The list of all modules."""
    told = ((f"[mechsym.{name}]({name}.md)", _title(name), ", ".join(f"`{n}`" for n in _names(name))) for name in ROOMS)
    lines = "\n".join(f"| {link} | {escaped(about)} | {names} |" for link, about, names in told)
    tree = "\n".join(ROOMS)
    head = (
        "# Python\n\nEvery public name: what each module's `__all__` lists, with formula, units and errors. "
        "[Stability](../../stability.md) says what that promises. Begin with `cases` and `jobs`, the words of the "
        "commands; `machine`, `cycle`, `hinge`, `simulate` work without a case file.\n"
    )
    return f"{head}\n| module | about | names |\n|---|---|---|\n{lines}\n\n```{{toctree}}\n:hidden:\n\n{tree}\n```\n"


def _names(name: str) -> list[str]:
    module = importlib.import_module(f"mechsym.{name}")
    return [n for n in getattr(module, "__all__", ()) if not inspect.ismodule(getattr(module, n))]


def _title(name: str) -> str:
    return (inspect.getdoc(importlib.import_module(f"mechsym.{name}")) or "").partition("\n")[0]


def room(name: str) -> str:
    """What a module exports, with signatures and docstrings."""
    module = importlib.import_module(f"mechsym.{name}")
    parts = [f"# mechsym.{name}\n\n{escaped(_title(name))}\n"]
    for public in _names(name):
        value = getattr(module, public)
        doc = inspect.getdoc(value) or ""
        if not getattr(value, "__module__", "mechsym").startswith("mechsym"):  # sympy's, with examples of its own
            doc = f"{doc.partition(chr(10))[0]} As sympy has it."
        said = markdown(doc) if callable(value) else block(repr(value)[:600])
        parts.append(f"## {name}.{public}\n\n```python\n{public}{_signature(value)}\n```\n\n{said}")
    return "\n".join(parts) + "\n"


def markdown(doc: str) -> str:
    """A docstring as Markdown: its formulas set, its drawings and examples as they stand."""
    told = []
    for kind, text in equations.parts(doc):
        if kind == "math":
            told.append(f"```{{math}}\n{text}\n```\n")
        elif kind == "code":
            told.append(f"```python\n{text.rstrip()}\n```\n")
        else:
            told += [_paragraph(part) for part in re.split(r"\n\s*\n", text) if part.strip()]
    return "\n".join(told) + "\n"


def _paragraph(part: str) -> str:
    head, _, rest = part.strip("\n").partition("\n")
    if re.match(r"-{4,}$", rest.partition("\n")[0]):  # a section in the way of numpy
        entries = re.sub(r"\n\s+", " ", rest.partition("\n")[2])
        return f"**{head}**\n\n" + "\n".join(f"- {escaped(line)}" for line in entries.splitlines()) + "\n"
    if re.search(r"^ {4,}\S|\S {3,}\S", part, re.M):  # a drawing or a list in columns
        return block(part.strip("\n"))
    words = re.sub(r":math:`([^`]+)`", r"`\1`", " ".join(part.split()))
    return escaped(words) + "\n"


def _signature(value: object) -> str:
    if not callable(value):
        return ""
    try:
        text = str(inspect.signature(value))
    except (TypeError, ValueError):
        return "(..)"
    text = _UNIT.sub(lambda m: f"{'float' if m[1].startswith('~') else m[1]} [{m[2]}]", text)
    return _PLACE.sub(r"\1", text)


def messages() -> str:
    """What the program says of bad input: every message with its way out, by what it is about."""
    head = (
        "# Messages and their way out\n\nA message names file, key, value and unit, and behind a semicolon what to do. "
        "Here stand all of them, read off the program; `..` stands for what changes. Exit status 2 belongs to each.\n"
    )
    parts = [head]
    for topic, places in TOPICS.items():
        said = sorted(
            {one for place in places for one in _said(place)}, key=lambda one: one[0].lstrip(". :'[]-").lower()
        )
        parts.append(f"## {topic}\n\n{table(('message', 'way out'), said)}")
    return "\n".join(parts)


def _said(place: str) -> list[tuple[str, str]]:
    path = _ROOT / place
    files = [path] if path.suffix else sorted(path.rglob("*.py"))
    found = []
    for file in files:
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            if (
                isinstance(node, ast.Call)
                and getattr(node.func, "id", "") in ("BadInput", "MissingSection")
                and node.args
            ):
                words = [_words(one) for one in node.args]
                text, _, way = words[0].partition("; ")
                way = "; ".join(filter(None, [way, *words[1:]]))
                if len(re.findall(r"[a-z]{2,}", text)) >= 3:
                    found.append((text, way))
    return found


def _words(node: ast.expr) -> str:
    """A message with `..` for what changes."""
    if isinstance(node, ast.Constant):
        return " ".join(str(node.value).split())
    if isinstance(node, ast.JoinedStr):
        return "".join(str(v.value) if isinstance(v, ast.Constant) else ".." for v in node.values).strip()
    return ".."
