"""`mechsym check` tells every problem at once, and truly which command lacks what; `sections` and the schema agree."""

import json
import math
import tomllib

import jsonschema
import pytest
from click.testing import CliRunner

from mechsym import cases
from mechsym.cases import schema
from mechsym.cases.check import check_file
from mechsym.cases.keys import json_schema, keys
from mechsym.cli import mechsym
from mechsym.errors import BadInput

BAD = """
mechanism = "crosshead"
about = 3

[parameters]
r1 = "0.2 kg"
r3 = 1

[spring]
law = "coil"
k = "abc"
F0 = -1
H_mm = 500

[operations]
speed = 3

[guide]
arrangement = "three_tracks"
rho0 = 1

[load]
law = "propellor"
"""


@pytest.fixture(scope="module")
def validator():
    found = jsonschema.Draft7Validator(json_schema())
    found.check_schema(found.schema)
    return found


@pytest.fixture
def bad(tmp_path):
    path = tmp_path / "bad.toml"
    path.write_text(BAD)
    return str(path)


def run(*words):
    return CliRunner().invoke(mechsym, [*words], catch_exceptions=False)


def test_every_problem_is_told_at_once(bad):
    done = run("check", bad, "--json")
    assert done.exit_code == 2
    told = {row["key"]: row["why"] + "; " + row["allowed"] for row in json.loads(done.output)["problems"]}
    wanted = {
        "source": "missing", "about": "not a text", "parameters.r1": "wrong dimension", "parameters.r3": "not known",
        "parameters.r2": "missing; number in m, >= 0", "spring.k": "not a number in N/m", "spring.F0": "out of range",
        "operations": "did you mean 'operation'", "guide.arrangement": "options are", "load.law": "did you mean",
    }  # fmt: skip
    assert all(words in told[key] for key, words in wanted.items())
    assert "spring.H" not in told and "spring.H_mm" not in told  # a key may name its unit
    assert sum(key.startswith("parameters.") for key in told) == 12


@pytest.mark.parametrize("name", cases.names())
def test_built_in_cases_are_without_problems(name, validator):
    assert check_file(name).problems == ()
    assert list(validator.iter_errors(tomllib.loads(cases.text(name)))) == []


def test_the_schema_refuses_what_check_refuses(validator, bad):
    where = {".".join(map(str, error.path)) for error in validator.iter_errors(tomllib.loads(BAD))}
    assert {"about", "parameters", "spring.k", "spring.F0", "guide.arrangement", "load.law"} <= where


def test_a_mechanism_of_ones_own_is_not_run_without_trust(tmp_path):
    (tmp_path / "mine.py").write_text("raise SystemExit('was run')\n")
    case = tmp_path / "mine.toml"
    case.write_text('mechanism = "./mine.py"\n[parameters]\nr = 1\n')
    found = check_file(str(case))
    assert found.problems == () and found.skipped == ("parameters",)


def test_what_is_no_toml_is_one_problem(tmp_path):
    path = tmp_path / "no.toml"
    path.write_text("[spring\n")
    assert "not valid TOML" in check_file(str(path)).problems[0].why


def test_every_key_has_a_meaning_or_a_name_that_tells():
    rows = keys()
    assert {row["section"] for row in rows} == set(schema.sections())
    assert all(row["about"] for row in rows if row["unit"] and row["section"] not in schema.LETTERS)
    bore = next(row for row in keys("chamber") if row["key"] == "bore")
    assert bore["unit"] == "m" and bore["above"] == 0 and bore["required"] and "cycle" in bore["commands"]


def test_sections_in_words():
    assert "[m] > 0" in run("sections", "chamber").output and "chamber" in run("sections").output
    with pytest.raises(BadInput, match="did you mean 'spring'"):
        run("sections", "sprong")
    assert json.loads(run("sections", "--schema").output)["title"] == "mechsym case"


def test_a_command_that_is_not_known_is_suggested():
    assert "did you mean 'forces'" in run("forcs").output


@pytest.mark.parametrize(("written", "rpm"), [("80,85 rpm", (80, 85)), ("80..90rpm:3", (80, 85, 90))])
def test_a_list_is_set_as_options_write_it(written, rpm):
    speeds = cases.load("zotov-89", {"codesign.speeds": written}).need("codesign").speeds
    assert speeds == pytest.approx([n * math.pi / 30 for n in rpm], rel=1e-12)


@pytest.mark.parametrize("written", ["80,85 m", "a,b", "80"])
def test_what_is_no_list_of_speeds_is_refused(written):
    with pytest.raises(BadInput, match=r"codesign\.speeds"):
        cases.load("zotov-89", {"codesign.speeds": written})
