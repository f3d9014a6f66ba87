"""Equations of the site where they already stand: in docstrings, in derivations, in records of theories; typed once.

```{formula} hinge/torque.py:torque     the formulas of a docstring, with letters, source and validity
```{derived} crosshead                  equations of a derivation, `:show:` names what stands on their left
```{theory} knife_cam                   definitions of a theory of the auditor
```{recorded} zotov-89/hinge            what a command printed, as tests/recorded keeps it; `:lines: 12`

LaTeX becomes MathML while the site is built, so that no script and no font has to be loaded.
"""

import ast
import functools
import html
import json
import re
import tomllib
from pathlib import Path

from docutils import nodes
from docutils.parsers.rst import Directive, directives
from latex2mathml.converter import convert

from mechsym.audit.read.mathml import formula

ROOT = Path(__file__).parents[1]
RECORDED = ROOT / "tests" / "recorded"
_MATH = re.compile(r"^\.\. math::(.*(?:\n[ \t]+\S.*|\n(?=\n[ \t]+\S))*)", re.M)
_SCROLL = '<div class="equation">{}</div>'


def mathml(latex: str, display: str = "block") -> str:
    """A formula as MathML; lines that are aligned keep their places."""
    text = " ".join(latex.split()).replace(r"\arg", r"\mathrm{arg}")
    if "&" in text or r"\\" in text:
        text = text if r"\begin" in text else rf"\begin{{aligned}}{text}\end{{aligned}}"
    # a backslash before a space is a space
    made = convert(text.replace("\\ ", r"\;"), display=display)
    if "<mi>\\" in made or "<mo>\\" in made:
        raise ValueError(f"not read: {latex}")
    return made


@functools.cache
def _tree(path: Path) -> ast.Module:
    return ast.parse(path.read_text(encoding="utf-8"))


def docstring(place: str) -> str:
    """Of a function or class `hinge/torque.py:torque`, or of a module `hinge/torque.py`."""
    file, _, name = place.partition(":")
    tree = _tree(ROOT / "mechsym" / file)
    if not name:
        return ast.get_docstring(tree) or ""
    for node in tree.body:
        if getattr(node, "name", None) == name:
            return ast.get_docstring(node) or ""
    raise ValueError(f"{file} has no {name}")


def signature(place: str) -> str:
    """Names of a function with their units, as its annotations say them: `rho [m], drho [m/rad]`."""
    file, _, name = place.partition(":")
    function = next((n for n in _tree(ROOT / "mechsym" / file).body if getattr(n, "name", "") == name), None)
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


class Formula(Directive):
    """The formulas of a docstring; below them, to unfold, what the docstring says besides."""

    required_arguments = 1
    option_spec = {"only": directives.nonnegative_int}

    def run(self):
        place = self.arguments[0]
        told = parts(docstring(place))
        maths = [text for kind, text in told if kind == "math"]
        maths = maths or re.findall(r":math:`([^`]+)`", docstring(place))
        if not maths:
            raise self.error(f"{place} has no formula")
        maths = [maths[self.options["only"]]] if "only" in self.options else maths
        title = docstring(place).partition("\n\n")[0].replace("\n", " ")
        caption = nodes.paragraph("", "", nodes.strong("", title.rstrip(".")), classes=["caption-of-formula"])
        shown = "".join(_SCROLL.format(mathml(text)) for text in maths)
        words = "\n\n".join(text.strip() for kind, text in told if kind == "text").partition("\n\n")[2]
        units = signature(place)
        units = f"<p class='units'>{html.escape(units)}</p>" if units else ""
        code = f"<code>mechsym.{place.replace('/', '.').replace('.py:', '.').removesuffix('.py')}</code>"
        told = f"{units}{_paragraphs(words)}<p>{code}</p>"
        more = f"<details><summary>letters, units, validity, source</summary>{told}</details>"
        return [caption, nodes.raw("", f'<div class="formula">{shown}{more}</div>', format="html")]


def _paragraphs(text: str) -> str:
    return "".join(_paragraph(part) for part in re.split(r"\n\s*\n", text) if part.strip())


def _paragraph(part: str) -> str:
    if part.startswith("    ") or re.search(r"^ {3,}\S", part, re.M):
        return f"<pre>{html.escape(part)}</pre>"
    return f"<p>{inline(' '.join(part.split()))}</p>"


def inline(text: str) -> str:
    """Words of a docstring as HTML: its formulas set, its names as code."""
    out, end = [], 0
    for match in re.finditer(r":math:`([^`]+)`|``([^`]+)``|`([^`]+)`", text):
        out.append(html.escape(text[end : match.start()]))
        out.append(mathml(match[1], "inline") if match[1] else f"<code>{html.escape(match[2] or match[3])}</code>")
        end = match.end()
    return "".join([*out, html.escape(text[end:])])


class Derived(Directive):
    """Equations of a derivation, as `generated/equations` keeps them."""

    required_arguments = 1
    option_spec = {"show": directives.unchanged}

    def run(self):
        file = ROOT / "generated" / "equations" / f"{self.arguments[0]}.json"
        rows = json.loads(file.read_text(encoding="utf-8"))["equations"]
        for wanted in filter(None, (w.strip() for w in self.options.get("show", "").split(";"))):
            if not any(_shown(row, wanted) for row in rows):
                raise self.error(f"{file.name} has no equation of {wanted}")
        if "show" in self.options:
            chosen = [w.strip() for w in self.options["show"].split(";")]
            rows = [row for w in chosen for row in rows if _shown(row, w)]
        body = "".join(_SCROLL.format(f'<math display="block">{row["mathml"]}</math>') for row in rows)
        return [nodes.raw("", f'<div class="formula">{body}</div>', format="html")]


def _shown(row: dict, wanted: str) -> bool:
    left = row["latex"].partition(" = ")[0]
    return wanted in (row["title"], left, re.sub(r"[{}\\ ]|left|right", "", left))


class OfTheory(Directive):
    """Definitions of a theory that is a file."""

    required_arguments = 1

    def run(self):
        file = ROOT / "mechsym" / "audit" / "theories" / f"{self.arguments[0]}.toml"
        return [nodes.raw("", definitions(file.read_text(encoding="utf-8")), format="html")]


def definitions(text: str) -> str:
    """The definitions of a theory's file as equations."""
    rows = tomllib.loads(text).get("define", {})
    shown = [
        _SCROLL.format(f"{formula(name)} = {formula(said)}") for name, said in rows.items() if isinstance(said, str)
    ]
    return f'<div class="formula">{"".join(shown)}</div>'


class Recorded(Directive):
    """What a command printed when it was last run by the tests that keep it."""

    required_arguments = 1
    option_spec = {"lines": directives.positive_int}

    def run(self):
        text = recorded(self.arguments[0], self.options.get("lines", 0))
        return [nodes.literal_block(text, text, language="text")]


def recorded(name: str, lines: int = 0) -> str:
    """A kept answer as a shell shows it, of many lines the first."""
    kept = json.loads((RECORDED / f"{name}.json").read_text(encoding="utf-8"))
    said = [line for line in kept["text"] if not line.startswith("written: ")]
    short = said[:lines] + ["..."] * (len(said) > lines) if lines else said
    return "\n".join([f"$ {kept['typed'].removesuffix(' --out run')}", *short])


def _visit_math(self, node):
    self.body.append(mathml(node.astext(), "inline"))
    raise nodes.SkipNode


def _visit_block(self, node):
    self.body.append(_SCROLL.format(mathml(node.astext())))
    raise nodes.SkipNode


def setup(app):
    app.add_directive("formula", Formula)
    app.add_directive("derived", Derived)
    app.add_directive("theory", OfTheory)
    app.add_directive("recorded", Recorded)
    app.add_html_math_renderer("mathml", (_visit_math, None), (_visit_block, None))
    return {"parallel_read_safe": True}
