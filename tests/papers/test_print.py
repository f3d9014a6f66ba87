"""Every published number that is reproduced stands in the text of its source."""

import os
import re
from decimal import Decimal
from pathlib import Path

import pytest

from mechsym.papers import rows as record
from mechsym.papers import sources

SEEDS = os.environ.get("MECHSYM_TEST_SEEDS") or str(
    Path(os.environ.get("MECHSYM_TEST_DATA", "/nowhere")).parent / "seeds"
)
sources_only = pytest.mark.skipif(
    not Path(SEEDS).is_dir(), reason="the sources' texts need MECHSYM_TEST_SEEDS, the folder that holds them"
)
# cells of tables 4.8 and 4.12 whose digits the text has lost: "49.03 11111", "10.04 11111", "47.04 [1][1]", "27.7Z MM"
LOST = {
    "table 4.8: J_gear, x = 0.25, 52/104 teeth",
    "table 4.12: face width, bending, pinion, x = 0.25, 52/104 teeth [mm]",
    "table 4.12: face width, contact, gear, x = 0.25, 52/104 teeth [mm]",
    "table 4.12: face width, bending, pinion, x = 0.5, 52/104 teeth [mm]",
    "table 4.12: face width, contact, pinion, x = 0.5, 52/104 teeth [mm]",
    "table 4.12: face width, contact, gear, x = 0.5, 52/104 teeth [mm]",
}
RAISED = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "0123456789-")


def numbers(text):
    """All numbers of a text by their size, `2.9405x10 ⁻⁴` and `9,5` too."""
    text = re.sub("[⁰¹²³⁴⁵⁶⁷⁸⁹⁻]+", lambda m: f"^{m[0].translate(RAISED)}", text.replace("−", "-"))
    text = re.sub(r"(?<=\d)\s*(?:\\times|×|x)\s*10\s*\^?\s*\{?\s*(-?\d+)\s*\}?", r"e\1", text)
    return {abs(Decimal(m.replace(",", "."))) for m in re.findall(r"\d*[.,]?\d+(?:e-?\d+)?", text)}


def test_numbers_of_a_text():
    text = "from 5 MPa to 9,5 MPa, 2.9405x10 ⁻⁴ m, Z = 1.8703\\times 10^{5}, .278 and -0.0004*N"
    assert numbers(text) == {Decimal(n) for n in ("5", "9.5", "2.9405e-4", "1.8703e5", ".278", "0.0004")}


@sources_only
@pytest.mark.parametrize("source", sources(), ids=lambda source: source.name)
def test_every_published_number_is_printed(source):
    there = numbers((Path(SEEDS) / f"{source.stem}.txt").read_text(encoding="utf-8"))
    rows = [r for r in record.stored("mechsym.papers") if r["source"] == source.stem]
    assert rows
    missing = set()
    for row in rows:
        try:
            printed = abs(Decimal(row["printed"] or "words"))
        except ArithmeticError:
            continue  # words, or no value at all
        if printed not in there:
            missing.add(row["item"])
    assert missing == (LOST if source.name == "nunes2017" else set())


@sources_only
def test_a_number_that_is_not_printed_is_noticed():
    assert Decimal(833) not in numbers((Path(SEEDS) / "004_e00ef50339108dab.txt").read_text(encoding="utf-8"))
