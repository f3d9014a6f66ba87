"""Text, tables of files, the workbench and sweeps say of each number what the JSON says of it: its unit, its digits."""

import contextlib
import json
import re

import pytest
from matrix.agree import by_dimension, head, is_told, leaves, texts, told
from matrix.entries import entries, words
from matrix.record import answer
from matrix.test_matrix import QUICK, RECORDS

from mechsym.app.told import pretty_words
from mechsym.app.told import told as rows_of
from mechsym.cli import results

NUMBERS = [e for e in entries() if e.line.split()[0] in results.RESULTS and "json" in RECORDS.get(e.name, {})]
WHOLE = ("audit", "reproduce")  # their texts are tables of words; the unit of a row stands in it
#: What a text says beside the numbers of its JSON: the way, and not what came of it
BESIDE = {"guide": ("limits:",), "compare": ("quantity ",)}


@pytest.fixture(scope="module")
def live(prepared):
    """JSON of a command with the unit of each number by its path."""
    known = {}

    def ask(entry):
        if entry.name not in known:
            typed = words(entry, prepared)
            if "--out" in typed and typed[typed.index("--out") + 1] == "run":
                del typed[typed.index("--out") :][:2]
            with contextlib.chdir(prepared):
                known[entry.name] = json.loads(answer([*typed, "--json", "--with-units"])[1])
        return known[entry.name]["value"], known[entry.name]["units"]

    return ask


def each(wanted):
    heavy = [pytest.mark.slow, pytest.mark.heavy]
    return pytest.mark.parametrize(
        "entry", [pytest.param(e, id=e.name, marks=[] if e.name in QUICK else heavy) for e in wanted]
    )


def known_of(value, units):
    """Numbers of a JSON value by what they measure."""
    return by_dimension(
        (number, units.get(path) or units.get(_whole(path), "-")) for path, number in leaves(value) if _is_result(path)
    )


def _is_result(path):
    return not path.startswith(("doubts", "accepted", "headline"))


def _whole(path):
    """The path of the list of lists that a list stands in."""
    return re.sub(r"(\[\d+\])+$", "", path)


@each(NUMBERS)
def test_every_number_has_its_unit_for_programs(entry, live):
    value, units = live(entry)
    assert [path for path, _ in leaves(value) if _is_result(path) and not {path, _whole(path)} & {*units}] == []


@each([e for e in NUMBERS if e.line.split()[0] not in WHOLE])
def test_what_a_text_says_with_a_unit_is_a_number_of_the_json(entry, live):
    value, units = live(entry)
    known, said = known_of(value, units), " ".join(texts(value))
    silent = ("doubt", "accepted", *BESIDE.get(entry.line.split()[0], ()))
    # the level of an interval is no result
    lines = [line.replace("95 %: ", "") for line in RECORDS[entry.name]["text"] if not line.startswith(silent)]
    strange = [(number, unit, line) for line in lines for number, unit in told(line)
               if f"{number} {unit}" not in said and not is_told(number, unit, known)]  # fmt: skip
    assert strange == []


@each([e for e in NUMBERS if e.line.split()[0] not in WHOLE])
def test_the_workbench_says_it_in_the_same_unit(entry, live):
    value, units = live(entry)
    known, said = known_of(value, units), " ".join(texts(value))
    sentences = {pretty_words(text) for text in texts(value)}
    strange = [(name, text) for name, text in rows_of(value, units)
               if name not in ("doubt", "accepted") and text not in sentences
               for number, unit in told(text)
               if f"{number} {unit}" not in said and not is_told(number, unit, known)]  # fmt: skip
    assert strange == []


@each(
    [e for e in NUMBERS if any(name.endswith(".csv") and one for name, one in RECORDS[e.name].get("files", {}).items())]
)
def test_columns_of_files_have_the_units_of_the_json(entry, live):
    value, units = live(entry)
    by_name = {}
    for path, unit in units.items():
        by_name.setdefault(path, set()).add(unit)
        # what stands deeper has its name from what it is a share or a figure of; a count of points that of its axis
        if path.count(".") < 2 and not path.startswith("dims."):
            by_name.setdefault(path.rpartition(".")[2].partition("[")[0], set()).add(unit)
    files = RECORDS[entry.name]["files"]
    heads = {column for name, one in files.items() if name.endswith(".csv") and one for column in one}
    wrong = [(name, unit, by_name[name]) for name, unit in map(head, heads)
             if name in by_name and unit and unit not in by_name[name]]  # fmt: skip
    assert wrong == []
