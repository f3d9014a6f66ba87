"""Equations of the site where they already stand: in docstrings and in what commands printed."""

import ast
import functools
import json
import re
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[1]
RECORDED = ROOT / "tests" / "recorded"
_MATH = re.compile(r"^\.\. math::(.*(?:\n[ \t]+\S.*|\n(?=\n[ \t]+\S))*)", re.M)


class Place(NamedTuple):
    """A docstring of the package, from the words on that were asked for."""

    file: Path
    node: ast.AST
    doc: str

    @property
    def title(self) -> str:
        """Its first sentence."""
        return " ".join(self.doc.partition("\n\n")[0].split())

    @property
    def name(self) -> str:
        """Where it stands, as Python names it."""
        parts = self.file.relative_to(ROOT / "mechsym").with_suffix("").parts
        own = () if isinstance(self.node, ast.Module) else (self.node.name,)
        return ".".join(("mechsym", *parts, *own)).replace(".__init__", "")


@functools.cache
def _docstrings(room: str) -> tuple[Place, ...]:
    """All docstrings of a room that have a formula."""
    files = sorted((ROOT / "mechsym" / room).rglob("*.py")) or [ROOT / "mechsym" / f"{room}.py"]
    told = []
    for file in files:
        tree = ast.parse(file.read_text(encoding="utf-8"))
        for node in (tree, *(n for n in tree.body if isinstance(n, (ast.FunctionDef, ast.ClassDef)))):
            doc = ast.get_docstring(node) or ""
            told += [Place(file, node, doc)] if "math" in doc else []
    return tuple(told)


def placed(words: str) -> Place:
    """`hinge:torque` is a function of a room, `hinge: The linear spring` what a module says with these words."""
    room, _, wanted = words.partition(":")
    fit = []
    for place in _docstrings(room):
        if wanted == getattr(place.node, "name", None):
            fit.append(place)
        elif wanted.startswith(" ") and isinstance(place.node, ast.Module):
            flat = re.search(r"(?:\A|\n\n)" + r"\s+".join(map(re.escape, wanted.split())), place.doc)
            fit += [place._replace(doc=place.doc[flat.start() :].strip())] if flat else []
    if len(fit) != 1:
        raise ValueError(f"{words}: {len(fit)} places say it: {[place.name for place in fit]}")
    return fit[0]


def signature(place: Place) -> str:
    """Names of a function with their units, as its annotations say them: `rho [m], drho [m/rad]`."""
    function = place.node
    if not isinstance(function, ast.FunctionDef):
        return ""
    told = [(a.arg, _unit(a.annotation)) for a in (*function.args.args, *function.args.kwonlyargs)]
    back = _unit(function.returns)
    letters = ", ".join(f"{letter} [{unit}]" for letter, unit in told if unit)
    return letters + (f"; result [{back}]" if back else "")


def _unit(annotation: ast.expr | None) -> str:
    from mechsym.quantities import units

    text = "" if annotation is None else ast.unparse(annotation)
    if written := re.search(r"Annotated\[.*, '([^']+)'\]", text):
        return written[1]
    name = re.match(r"\w+", text)
    alias = getattr(units, name[0], None) if name else None
    meta = getattr(alias, "__metadata__", None)
    return str(meta[0]) if meta else ""


def parts(doc: str) -> list[tuple[str, str]]:
    """A docstring in pieces: `text` and `math`, in their order; what doctest runs is `code`."""
    pieces, end = [], 0
    for match in _MATH.finditer(doc):
        pieces += [("text", doc[end : match.start()]), ("math", match[1].strip())]
        end = match.end()
    pieces.append(("text", doc[end:]))
    told = []
    for kind, text in pieces:
        head, mark, code = text.partition(">>> ") if kind == "text" else (text, "", "")
        told += [(kind, head)] if head.strip() else []
        told += [("code", mark + code)] if mark else []
    return told


def recorded(name: str, lines: int = 0) -> str:
    """A kept answer as a shell shows it, of many lines the first."""
    kept = json.loads((RECORDED / f"{name}.json").read_text(encoding="utf-8"))
    said = [line for line in kept["text"] if not line.startswith("written: ")]
    short = said[:lines] + ["..."] * (len(said) > lines) if lines else said
    return "\n".join([f"$ {kept['typed'].removesuffix(' --out run')}", *short])
