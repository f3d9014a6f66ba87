"""Equations as papers write them: balanced, words upright, and the same in `eval`, `derive` and a notebook."""

import json
import re

import pytest
from click.testing import CliRunner

from mechsym import mechanisms
from mechsym.cli import mechsym
from mechsym.mechanisms.equations import equations


def run(*words):
    return CliRunner().invoke(mechsym, [*words], catch_exceptions=False).output


@pytest.mark.parametrize("name", mechanisms.names())
def test_equations_can_be_set(name):
    text = equations(name).latex
    assert text.count("{") == text.count("}") and text.count(r"\left") == text.count(r"\right")
    body = re.sub(r"\\(text|mathrm|begin|end)\{[^}]*\}", "", text)
    assert not re.search(r"(?<![\\A-Za-z])[A-Za-z]{2,}", body)  # no word is left that would read as a product
    lines = text.splitlines()
    assert lines[0] == r"\begin{align*}" and lines[-1] == r"\end{align*}"
    assert all("&=" in line or line.lstrip().startswith(r"\text") for line in lines[1:-1])


def test_one_text_for_all():
    text = equations("crosshead").latex
    assert run("eval", "crosshead", "--latex").rstrip("\n") == text == equations("crosshead")._repr_latex_()
    assert text in run("derive", "crosshead", "--latex")
    assert r"\sin{\left(\psi \right)} &= \lambda \sin{\left(\varphi \right)}" in text
    rows = json.loads(run("derive", "crosshead", "--latex", "--json"))["latex"]["crosshead"]
    assert {row["title"] for row in rows} >= {"kinematics", "motion of phi", "kinetic energy"}


@pytest.mark.slow
def test_every_equation_is_parsed_by_mathtext():
    """matplotlib's own reader of LaTeX takes each line, so no brace, prime or index is doubled."""
    from matplotlib.mathtext import MathTextParser

    parser = MathTextParser("path")
    for name in mechanisms.names():
        for row in equations(name).rows:
            parser.parse(f"${row['latex']}$")


def test_every_letter_of_a_motion_is_defined_and_words_stand_apart():
    text = equations("crankshaft_flywheel_printed").latex
    assert r"\mathrm{slope} &=" in text
    assert r"m_{0} \cdot r \cdot \mathrm{slope} \cdot \mathrm{transmission}" in text
    assert r"\ddot{\beta}" in equations("rodless_constraints").latex
