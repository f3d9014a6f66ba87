"""The JSON Schema of every output, made from the fields of the results, holds for what the commands gave."""

import copy
import functools
import json

import jsonschema
import pytest
from matrix.record import MASK
from matrix.test_matrix import RECORDS

from mechsym.cli import COMMANDS
from mechsym.cli.results import RESULTS, WORDS, rows, schema

# what a command tells beside its result: names of files; of a formula where it stands
BESIDE = {"files", "written", "doubts", "accepted", "headline", "source", "equation", "claim"}


def closed(value):
    """A schema that takes no name which it does not list: stricter than the one that is printed."""
    if isinstance(value, dict):
        inner = {name: closed(one) for name, one in value.items()}
        listed = "properties" in value and "anyOf" not in value and value["properties"]
        return inner | {"additionalProperties": False} if listed and "additionalProperties" not in value else inner
    return [closed(one) for one in value] if isinstance(value, list) else value


def as_given(value, masked=0.0):
    """A kept answer with lists in place of the figures that stand for long ones."""
    if isinstance(value, dict):
        if "count" in value and value.keys() <= {"count", "first", "last", "min", "max"}:
            return [value[name] for name in ("first", "last") if name in value]
        if value.keys() == {"count", "some"}:
            return as_given(value["some"])
        return {name: as_given(one) for name, one in value.items()}
    if isinstance(value, list):
        return [as_given(one) for one in value]
    return masked if value == MASK else value


def objects(kept):
    """The objects that a command may tell, or whose rows."""
    for one in kept.get("anyOf", ()):
        yield from objects(one)
    if "items" in kept:
        yield from objects(kept["items"])
    if "properties" in kept:
        yield kept


@functools.cache
def checker(command):
    kept = copy.deepcopy(schema(command))
    for one in objects(kept):
        one["properties"] |= {name: {} for name in BESIDE if name not in one["properties"]}
    return jsonschema.Draft7Validator(closed(kept) if command in RESULTS else kept)


ANSWERS = {name: one for name, one in RECORDS.items() if "json" in one}


@pytest.mark.parametrize("command", sorted({one["typed"].split()[1] for one in ANSWERS.values()}))
def test_every_answer_keeps_its_schema(command):
    wrong = {}
    for name, one in ANSWERS.items():
        words = one["typed"].split()
        if words[1] == command and not {"--schema", "--latex"} & {*words} and words[1:-1] != ["cases"]:
            errors = [*checker(command).iter_errors(as_given(one["json"]))]
            if errors:
                worst = jsonschema.exceptions.best_match(errors)
                wrong[name] = f"{worst.json_path}: {worst.message[:300]}"
    assert wrong == {}


def test_every_command_has_a_schema_and_it_knows_every_number():
    assert {*RESULTS, *WORDS} == {*COMMANDS}
    for command in RESULTS:
        jsonschema.Draft7Validator.check_schema(schema(command))
        text = json.dumps(schema(command))
        listed = [row for row in rows(command) if row["about"] and row["unit"] != "of its key"]
        assert [row["path"] for row in listed if json.dumps(row["about"]) not in text] == []


def test_a_wrong_answer_does_not_keep_it():
    one = as_given(ANSWERS["zotov-89/hinge"]["json"])
    assert checker("hinge").is_valid(one)
    assert not checker("hinge").is_valid(one | {"load_torque": "9 kN"})
    assert not checker("hinge").is_valid(one | {"load_torqe": 9.0})
    assert not checker("hinge").is_valid({k: v for k, v in one.items() if k != "guide"})
