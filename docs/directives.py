"""Equations of the site where they already stand: in docstrings, in derivations, in records of theories; typed once.

```{formula} hinge:torque              the formulas of a docstring, with letters, source and validity
```{formula} hinge: The linear spring   the same of a module, by the words with which it begins
```{derived} crosshead                  equations of a derivation, `:show:` names what stands on their left
```{theory} knife_cam                   definitions of a theory of the auditor
```{recorded} zotov-89/hinge            what a command printed, as tests/recorded keeps it; `:lines: 12`

LaTeX becomes MathML while the site is built, so that no script and no font has to be loaded.
"""

import html
import json
import re
import tomllib

from docutils import nodes
from docutils.parsers.rst import Directive, directives
from equations import ROOT, parts, placed, recorded, signature
from latex2mathml.converter import convert

from mechsym.audit.read.mathml import formula

_SCROLL = '<div class="equation">{}</div>'


def mathml(latex: str, display: str = "block") -> str:
    """A formula as MathML; lines that are aligned keep their places."""
    text = " ".join(latex.split()).replace(r"\arg", r"\mathrm{arg}").replace("{aligned}", "{align*}")
    if "&" in text or r"\\" in text:
        text = text if r"\begin" in text else rf"\begin{{align*}}{text}\end{{align*}}"
    # a backslash before a space is a space, two are the end of a line
    made = convert(re.sub(r"(?<!\\)\\ ", r"\\;", text), display=display)
    if any(f"<{kind}>{sign}" in made for kind in ("mi", "mo") for sign in ("\\", "&<")):
        raise ValueError(f"not read: {latex}")
    return made


def apart(latex: str) -> list[str]:
    """Formulas of one line that a space sets apart, each by itself, so that a narrow page can break between them."""
    if "&" in latex or r"\begin" in latex:
        return [latex]
    pieces, depth = [""], 0
    for token in re.split(r"(\\qquad\b|\\[a-zA-Z]+|\\.|[{}])", latex):
        depth += (token == "{") - (token == "}")
        if token == r"\qquad" and depth == 0 and r"\left" not in pieces[-1].split(r"\right")[-1]:
            pieces.append("")
        else:
            pieces[-1] += token
    return [piece.strip().removesuffix(",") for piece in pieces if piece.strip(" ,\n")]


class Formula(Directive):
    """The formulas of a docstring; below them, to unfold, what the docstring says besides."""

    required_arguments, optional_arguments, final_argument_whitespace = 1, 0, True
    option_spec = {"only": directives.nonnegative_int}

    def run(self):
        try:
            place = placed(self.arguments[0])
        except ValueError as error:
            raise self.error(str(error)) from None
        told = parts(place.doc)
        maths = [text for kind, text in told if kind == "math"] or re.findall(r":math:`([^`]+)`", place.doc)
        maths = [maths[self.options["only"]]] if "only" in self.options else maths
        caption = nodes.strong("", place.title.rstrip("."))
        rows = ("".join(_SCROLL.format(mathml(piece)) for piece in apart(text)) for text in maths)
        shown = "".join(f'<div class="row">{row}</div>' for row in rows)
        words = "\n\n".join(text.strip() for kind, text in told if kind == "text").partition("\n\n")[2]
        units = signature(place)
        units = f"<p class='units'>{html.escape(units)}</p>" if units else ""
        told = f"{units}{_paragraphs(words)}<p><code>{place.name}</code></p>"
        more = f"<details><summary>letters, units, validity, source</summary>{told}</details>"
        body = nodes.raw("", f'<div class="derived">{shown}{more}</div>', format="html")
        return [nodes.paragraph("", "", caption, classes=["caption-of-formula"]), body]


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
        return [nodes.raw("", f'<div class="derived">{body}</div>', format="html")]


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
    return f'<div class="derived">{"".join(shown)}</div>'


class Recorded(Directive):
    """What a command printed when it was last run by the tests that keep it."""

    required_arguments = 1
    option_spec = {"lines": directives.positive_int}

    def run(self):
        text = recorded(self.arguments[0], self.options.get("lines", 0))
        return [nodes.literal_block(text, text, language="text")]


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
