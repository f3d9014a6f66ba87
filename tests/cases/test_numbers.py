"""Numbers by letter for who has a mechanism and no case: the case must be of that mechanism."""

import math

import pytest

from mechsym.cases.numbers import numbers, usual
from mechsym.errors import BadInput


def test_the_numbers_of_a_case():
    values = numbers("zotov-89", "crosshead")
    assert values["speed"] == pytest.approx(89 * math.pi / 30, rel=1e-12)
    assert numbers("zotov-89") == values
    assert all(isinstance(v, float) for v in values.values())


def test_a_case_of_another_mechanism_is_refused():
    with pytest.raises(BadInput, match="of the mechanism crosshead, not of rodless"):
        numbers("zotov-89", "rodless")


def test_the_usual_case_of_a_mechanism():
    assert usual("crosshead") and numbers(usual("crosshead"), "crosshead")
    assert usual("rodless") != usual("crosshead")
    assert usual("nothing") == ""


@pytest.mark.parametrize(
    ("said", "asked", "found"),
    [
        ("arm.py", "arm.py", True),
        ("arm.py:first", "arm.py", True),
        ("arm.py", "arm.py:first", True),
        ("arm.py:first", "arm.py:first", True),
        ("arm.py:second", "arm.py:first", False),
        ("other.py", "arm.py", False),
        ("crosshead", "arm.py", False),
    ],
)
def test_the_case_beside_the_file_of_a_mechanism(tmp_path, said, asked, found):
    for name in ("arm.py", "other.py"):
        (tmp_path / name).write_text("")
    (tmp_path / "a.toml").write_text("no case: [")
    (tmp_path / "mine.toml").write_text(f'mechanism = "{said}"\n')
    assert usual(str(tmp_path / asked)) == (str(tmp_path / "mine.toml") if found else "")
