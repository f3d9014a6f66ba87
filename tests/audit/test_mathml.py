"""Typeset formulas: read back by another reader they have the values of the print; the smallest slip is marked."""

import math
import random
import re
from pathlib import Path
from xml.etree import ElementTree

import pytest

from mechsym.audit.read.mathml import corrected, formula, letter

ERRATA = (Path(__file__).parents[2] / "docs" / "errata.md").read_text(encoding="utf-8")
PRINTED = sorted(set(re.findall(r"^    (\S.*)$", ERRATA, re.M)))
OWN = ["-2*a**2", "-(a + b)*c", "(-a)**3", "a - (b - c)", "a/(b*c)/d", "2*(3*a)", "sin(a + b)**2", "-a*b + c", "a**-b",
       "sqrt(a**2 + b**2)", "1e-3*a", r"\frac{a}{b} - \left(c - d\right)^2", "abs(a - b)*log(c)",
       "exp(-a)/(1 - b)"]  # fmt: skip
NAMES = {"arcsin": math.asin, "arccos": math.acos, "arctan": math.atan, "ln": math.log, "exp": math.exp,
         "sin": math.sin, "cos": math.cos, "tan": math.tan, "sqrt": math.sqrt, "abs": abs, "π": math.pi}  # fmt: skip
SIGNS = {"\u2062": "*", "·": "*", "−": "-", "+": "+", "(": "(", ")": ")"}


def text_of(node):
    """MathML as a Python expression."""
    kind, inner = node.tag, [text_of(child) for child in node]
    if kind == "mo":
        return SIGNS[node.text]
    if kind in ("mn", "mtext"):
        return node.text.replace("−", "-")
    if kind == "mi":
        return "lam" if node.text == "λ" else node.text
    if kind == "mfrac":
        return f"(({inner[0]})/({inner[1]}))"
    if kind == "msqrt":
        return f"sqrt({''.join(inner)})"
    if kind == "msub":
        return f"{inner[0]}_{inner[1]}"
    if kind == "msup":
        return f"({inner[0]})**({inner[1]})"
    if kind == "mover":
        return f"{inner[0]}_dot{'s' if node[1].text == '¨' else ''}"
    assert kind in ("mrow", "math", "span")
    calls = [i for i, child in enumerate(node) if child.tag == "mo" and child.text == "\u2061"]
    bars = [i for i, child in enumerate(node) if child.tag == "mo" and child.text == "|"]
    if bars:
        return f"abs({''.join(inner[1:-1])})"
    if calls:
        name, argument = node[0], inner[2]
        if name.tag == "msup":
            return f"({text_of(name[0])}({argument})**({text_of(name[1])}))"
        return f"{inner[0]}({argument})"
    return "".join(inner)


SIGNS |= {"\u2061": "", "|": "", "˙": "", "¨": ""}


def numbers(text):
    """The value of a typeset formula, at values that hang on how its letters look."""
    source = text_of(ElementTree.fromstring(text.replace("\u200b", "").replace("&#8203;", "")))
    letters = {n: random.Random(n).uniform(0.1, 0.6) for n in re.findall(r"[^\W\d]\w*", source)}
    return eval(source, letters | NAMES), source  # noqa: S307 of our own text


def value(text):
    """The value of a printed formula, its letters by the way they are set."""
    looks = {n: text_of(ElementTree.fromstring(f"<math>{re.search('<math>(.*)</math>', formula(n))[1]}</math>"))
             for n in re.findall(r"[^\W\d]\w*", text)}  # fmt: skip
    known = {n: random.Random(looks[n]).uniform(0.1, 0.6) for n in looks}
    calls = {"sin", "cos", "tan", "sqrt", "abs", "exp", "log", "pi", "asin", "acos", "atan", "e"}
    return eval(text, vars(math) | {k: v for k, v in known.items() if k not in calls} | {"abs": abs})  # noqa: S307


@pytest.mark.parametrize("text", [t for t in (*PRINTED, *OWN) if "\\" not in t and "sum(" not in t])
def test_a_typeset_formula_has_the_value_of_the_print(text):
    if "piecewise" in text or "=" in text:
        pytest.skip("no single value")
    assert numbers(formula(text))[0] == pytest.approx(value(text), rel=1e-12)


@pytest.mark.parametrize("text", [*PRINTED, *OWN])
def test_every_printed_formula_is_typeset_and_well_formed(text):
    shown = formula(text)
    assert shown.startswith('<span class="formula"') and "<code>" not in shown
    ElementTree.fromstring(shown)


def marked(printed, correction):
    """What is marked in both, as text."""
    roots = [ElementTree.fromstring(one) for one in corrected(printed, correction)]
    return tuple(["".join(n.itertext()) for n in root.iter() if n.get("class") == "slip"] for root in roots)


@pytest.mark.parametrize(
    ("printed", "correction", "slip"),
    [
        ("a*(b + c) + d", "a*(b - c) + d", (["+"], ["−"])),
        ("a + b + c", "a + c", (["b"], [])),
        ("a*b", "a*b*c", ([], ["c"])),
        ("a*sin(phi)", "a*cos(phi)", (["sin\u2061φ"], ["cos\u2061φ"])),
        ("a*sin(2*phi)", "a*sin(phi)", (["2"], [])),
        ("a*b**2", "a*b**3", (["2"], ["3"])),
        ("a + b", "a + b", ([], [])),
    ],
)
def test_the_smallest_part_that_differs_is_marked(printed, correction, slip):
    assert marked(printed, correction) == slip


@pytest.mark.parametrize(("name", "index", "dotted"), [
    ("eta_mixed", "<mi>mixed</mi>", False), ("m_rod", "<mi>rod</mi>", False), ("x_Bd", "<mi>B</mi>", True),
    ("phi_fdd", "<mi>f</mi>", True), ("psi2d", "<mn>2</mn>", True),
])  # fmt: skip
def test_an_index_that_ends_in_d_is_no_rate(name, index, dotted):
    assert index in letter(name) and ("<mover>" in letter(name)) is dotted


def test_what_cannot_be_read_stands_as_text_and_nothing_of_it_acts():
    shown = formula("<script>alert(1)</script>")
    assert shown == "<code>&lt;script&gt;alert(1)&lt;/script&gt;</code>"
    assert "<b>" not in formula('a_"<b>"') and '"<' not in corrected("x", 'y"<b>')[1]


@pytest.mark.parametrize(
    ("plain", "shown"),
    [
        ("dx_dphi", "dx/dφ"),
        ("d2x_dphi2", "d2x/dφ2"),
        ("d2x_dphi12", "d2x/dφ12"),
        ("Deltatheta", "Δθ"),
        ("DeltaW", "ΔW"),
    ],
)
def test_slopes_and_changes_are_set_as_people_write_them(plain, shown):
    fraction = letter(plain).replace("</mrow><mrow>", "/")
    assert re.sub("<[^<>]*>", "", fraction) == shown
