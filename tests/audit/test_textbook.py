"""The shipped theories against what textbooks print in closed form: every theory is asked, and is what they say."""

import tomllib
from pathlib import Path

import pytest

from mechsym.audit.hosts.formula import check_formula
from mechsym.audit.theory.catalogue import shipped, shipped_for, theory

FORMULAS = tomllib.loads((Path(__file__).parent / "textbook.toml").read_text())["formula"]
# Schmidt's own letters: phase of the pressure, and its swing
SCHMIDT = {
    "a": "atan((V_SC/V_SE)*sin(dx)/(t + (V_SC/V_SE)*cos(dx)))",
    "c": "sqrt(t**2 + 2*t*(V_SC/V_SE)*cos(dx) + (V_SC/V_SE)**2)"
    "/(t + 2*t*V_DE/V_SE + 4*t*V_R/V_SE/(1 + t) + V_SC/V_SE + 2*V_DC/V_SE)",
}


def test_anyone_finds_a_quantity():
    assert sum(len(theory(name).results) for name in shipped()) >= 150
    assert {f["against"].partition(".")[0] for f in FORMULAS} == set(shipped())
    assert all("\nsource = " in text for text in shipped().values())
    assert all(theory(name).data.endswith(f"{name}.toml") for name in shipped())  # and no other theory is called so


def test_words_of_texts_are_lists_in_small_letters():
    for text in shipped().values():
        content = tomllib.loads(text)
        said = [content[key] for key in ("only_of", "not_of") if key in content]
        assert all(isinstance(one, list) and all(word and word == word.lower() for word in one) for one in said)


def test_a_text_is_held_against_theories_of_which_it_has_a_word():
    assert "worm_gear" in shipped_for("the worm has two starts") and "worm_gear" not in shipped_for("a spur gear")
    assert "compression_ratio" not in shipped_for("an engine with opposed pistons")


@pytest.mark.slow
@pytest.mark.parametrize("formula", FORMULAS, ids=lambda f: f["against"])
def test_what_textbooks_print_is_right(formula):
    letters, assume = SCHMIDT if "schmidt" in formula else "", formula.get("assume", "")
    row = check_formula(formula["text"], formula["against"], letters=letters, assume=assume)
    assert row["verdict"] == formula["verdict"], row["note"]
