"""What `check` says of commands and sections is what they do: who can run, who reads what, what nobody reads."""

import json
import re
from pathlib import Path

import click
import pytest
from click.testing import CliRunner

from mechsym import cases, cli
from mechsym.cases import schema
from mechsym.cases.check import check_file
from mechsym.cases.facts import facts_of
from mechsym.cases.needs import COMMANDS, commands_of, read_by
from mechsym.errors import BadInput
from mechsym.mechanisms import lists, own

EXAMPLES = sorted((Path(__file__).parents[2] / "examples" / "mechanisms").glob("*.toml"))
#: What takes a case under another name, or takes none to run on
OTHERS = {"audit", "check"}


def words(command, case, folder):
    """A command as typed on a case, with the options that it cannot do without."""
    more = {
        "compare": [case], "flywheel": ["--ripple", "2%"], "guide": ["--sheet", f"{folder}/g.svg"],
        "export": ["--to", "c", "--out", f"{folder}/text"], "fmu": ["--platforms", "none", "--out", f"{folder}/f.fmu"],
        "page": ["--out", f"{folder}/p.html"], "report": ["--out", f"{folder}/r.html"], "app": ["--check"],
        "prove": ["--t-end", "0.001"],
        "identify": ["--trace", f"{folder}/no-such.csv", "--free", "x"],
    }  # fmt: skip
    if command == "eval":
        return ["eval", cases.load(case).mechanism, "--case", case]
    if command == "sweep":
        values = vars(cases.load(case).need("parameters")).items()
        key, value = next((key, value) for key, value in values if isinstance(value, float) and value)
        return ["sweep", case, "--over", f"parameters.{key}={value!r},{1.0001 * value!r}", "--jobs", "1"]
    return [command, case, *more.get(command, [])]


@pytest.fixture
def ran(tmp_path, monkeypatch):
    """Runs a command on a case: its exit status, its error, and the sections of the case that it read."""

    def run(command, case):
        loaded, load = [], cases.load

        def kept(name, *more):
            loaded.append(load(name, *more))
            return loaded[-1]

        with monkeypatch.context() as patch:
            patch.setattr(cases, "load", kept)
            done = CliRunner().invoke(cli.mechsym, words(command, str(case), tmp_path))
        if done.exception is not None and not isinstance(done.exception, (SystemExit, BadInput)):
            raise done.exception
        refused = isinstance(done.exception, BadInput)
        read = {section for one in loaded if one.path == str(case) for section in one.read & one.sections.keys()}
        return 2 if refused else done.exit_code, str(done.exception if refused else done.output), read

    return run


def test_every_command_that_takes_a_case_is_listed():
    takes = set()
    for name in cli.COMMANDS:
        arguments = cli.mechsym.get_command(click.Context(cli.mechsym), name).params
        named = {a.name for a in arguments if isinstance(a, click.Argument)} & {"case", "case_name", "cases", "case_a"}
        takes |= {name} if named else set()
    assert takes - OTHERS | {"eval", "export", "prove"} == set(COMMANDS)  # these take a mechanism, too
    assert set(check_file("zotov-89").commands) == set(COMMANDS)


@pytest.mark.parametrize("name", cases.names())
def test_what_is_called_lacking_is_refused_with_these_words(name, ran):
    for command, missing in check_file(name).commands.items():
        if missing:
            if command in ("hinge", "guide", "codesign") and "[spring]" in missing and "[limits]" in missing:
                assert "this kind of engine has no hinge" in check_file(name).reasons[command]
            status, said, _ = ran(command, name)
            assert status == 2 and all(what in said for what in missing), (command, missing, said)


def without(case, section, folder):
    """A case without one of its sections."""
    text = re.sub(rf"(?ms)^\[{section}\][^\n]*$.*?(?=^\[|\Z)", "", cases.text(case))
    file = folder / f"no-{section}.toml"
    file.write_text(re.sub(r"(?ms)^\[doubts\][^\n]*$.*?(?=^\[|\Z)", "", text))
    return file


QUICK = ("cycle", "forces", "simulate", "export", "hinge", "guide")


@pytest.mark.parametrize(
    ("case", "section"),
    [("zotov-89", "rollers"), ("zotov-142", "cycle"), ("nunes-hypocycloid", "heat_transfer"), 
     ("balandin", "faces"), ("chmielewski", "drive"), ("chmielewski", "simulation"), ("moroianu", "cycle"),
     ("alpha-stirling", "cycle"), ("generator-breathing", "breathing")],
)  # fmt: skip
def test_a_case_without_a_section_is_refused_by_those_who_lack_it(case, section, ran, tmp_path):
    file = without(case, section, tmp_path)
    commands = check_file(str(file)).commands
    assert any(commands[command] for command in QUICK)
    for command in QUICK:
        assert (ran(command, file)[0] == 2) == bool(commands[command]), (command, commands[command])


@pytest.mark.slow
@pytest.mark.parametrize(
    "case",
    [pytest.param(case, marks=[pytest.mark.heavy] * (Path(case).stem == "walking-leg"))
     for case in (*cases.names(), *EXAMPLES)],
    ids=lambda case: Path(case).stem,
)  # fmt: skip
def test_prove_takes_what_check_says(case, ran):
    """Of the other commands tests/matrix says it."""
    found, loaded = check_file(str(case), trust=True), cases.load(str(case))
    assert "unused" not in {doubt.code for doubt in found.doubts} or case in EXAMPLES
    status, message, read = ran("prove", case)
    assert (status == 2) == bool(found.commands["prove"]), message
    assert status == 2 or read - {"report"} <= read_by(facts_of(loaded.mechanism, loaded.sections))["prove"]


#: A section that no built-in case has, or that says more than it needs to in its own
SECTIONS = {
    "trials": "turns = 10", "losses": "", "gas_limits": 'peak_pressure = "10 MPa"', "boost": "", "shaft": "",
    "combustion": "", "measured": 'torque = "10 N*m"', "comparison": "", "torque": 'file = "curve.csv"', "inputs": "",
    "blowdown": 'exhaust_diameter = "30 mm"\nexhaust_lift = "8 mm"',
    "start": "", "report": "", "drive": 'torque = "1 N*m"', "startup": "",
    "optimise": 'objective = "power"\ngoal = "maximise"\nvariables = { e = { low = 0.01, high = 0.02 } }',
}  # fmt: skip
ALWAYS = {"parameters", "report", "flywheel", "drive", "simulation", "inputs", "start", "motion"}  # read of every case


def text_of(section):
    """A section as some case has it."""
    if section in SECTIONS:
        return f"\n[{section}]\n{SECTIONS[section]}\n"
    for name in cases.names():
        found = re.search(rf"(?ms)^\[{section}\][^\n]*$.*?(?=^\[|\Z)", cases.text(name))
        if found:
            return f"\n{found[0]}\n"
    raise AssertionError(f"no text for [{section}]")


def hosts(section):
    """Built-in cases that do without a section and whose commands would not read it."""
    for name in cases.names():
        case = cases.load(name)
        if section in schema.LETTERS and lists(case.mechanism):
            continue  # it has none, and says so
        more = facts_of(case.mechanism, {**case.sections, section: None}, kind=str(vars(case).get("kind", "")))
        if section not in case.sections and section not in set().union(*read_by(more).values()):
            yield name


def checked(file):
    return json.loads(CliRunner().invoke(cli.mechsym, ["check", str(file), "--json"], catch_exceptions=False).stdout)


@pytest.mark.parametrize("section", [name for name in schema.sections() if name not in ALWAYS])
def test_a_section_that_nothing_reads_is_told(section, ran, tmp_path):
    host = next(hosts(section))
    file = tmp_path / "more.toml"
    file.write_text(cases.text(host) + text_of(section))
    told = [doubt for doubt in checked(file)["doubts"] if doubt["code"] == "unused"]
    assert f"unread keys: [{section}]" in {doubt["quantity"] for doubt in told}, (host, told)
    for command in ("cycle", "forces"):  # as they record it
        assert section not in ran(command, file)[2], command


@pytest.mark.parametrize("name", cases.names())
def test_of_a_shipped_case_every_section_is_read(name):
    assert checked(name)["doubts"] == []


def test_what_reads_a_section_with_one_more_is_named(tmp_path):
    text = cases.text("chmielewski")
    (tmp_path / "c.toml").write_text(text + text_of("limits"))
    (tmp_path / "z.toml").write_text(without("zotov-89", "rollers", tmp_path).read_text())
    assert "leave it out" in checked(tmp_path / "c.toml")["doubts"][0]["why"]
    told = {doubt["quantity"]: doubt["why"] for doubt in checked(tmp_path / "z.toml")["doubts"]}
    assert "lacks [rollers]" in told["unread keys: [limits]"] and "unread keys: [spring]" not in told


def test_a_drive_that_names_no_input_of_several_is_lacking_and_told_once(tmp_path):
    file = tmp_path / "driven.toml"
    file.write_text(cases.text("zotov-89") + text_of("drive"))
    lacking = {
        name for name, missing in checked(file)["commands"].items() if missing == ["drive.input, one of F, M_r, M_h"]
    }
    assert lacking >= {"hinge", "flywheel", "simulate", "export", "sweep"} and not lacking & {"forces", "cycle", "size"}
    assert checked(file)["doubts"] == []
    done = CliRunner().invoke(cli.mechsym, ["flywheel", str(file)])
    assert "flywheel needs drive.input, one of F, M_r, M_h" in str(done.exception)
    file.write_text(cases.text("zotov-89") + text_of("drive") + '\ninput = "M_h"')
    assert not any("drive.input" in " ".join(missing) for missing in checked(file)["commands"].values())


def doubts_of(*argv):
    return json.loads(CliRunner().invoke(cli.mechsym, [*argv, "--json"], catch_exceptions=False).stdout)["doubts"]


def test_what_is_set_and_not_read_is_told():
    told = doubts_of("cycle", "zotov-89", "--set", "limits.closing_share=0.3", "--set", "speed_rpm=100")
    assert [(d["code"], d["quantity"]) for d in told] == [("unused", "unread keys: [limits]")]
    assert "limits.closing_share was set" in told[0]["why"]
    assert doubts_of("forces", "zotov-89", "--set", "speed_rpm=100") == []
    done = CliRunner().invoke(cli.mechsym, ["cycle", "zotov-89", "--set", "limits.closing_share=0.3", "--strict"])
    assert done.exit_code == 3


def test_a_section_that_is_not_read_may_be_accepted(tmp_path):
    file = tmp_path / "more.toml"
    text = cases.text("opposed-pistons") + text_of("limits")
    file.write_text(text)
    assert [doubt["code"] for doubt in doubts_of("forces", str(file))] == ["unused"]
    file.write_text(f'{text}\n[doubts]\nunused = {{ up_to = 6, why = "for the engine that follows" }}\n')
    assert doubts_of("forces", str(file)) == []


KEYS = [
    ("zotov-89", {"cycle.crank_side": "scavenge"}, "cycle.p_back", "1.2 bar", "forces"),
    ("zotov-89", {}, "rollers.rolling_arm", "1e-4 m", "hinge"),
    ("zotov-89", {"guide.start": "as_printed"}, "guide.z_margin", "20 mm", "guide"),
    ("nunes-hypocycloid", {"cycle.vaporisation": "none"}, "cycle.latent_heat", "300 kJ/kg", "cycle"),
    ("alpha-stirling", {}, "cycle.piston_bore", "50 mm", "cycle"),
]


def answer(command, case, settings, folder):
    words = [word for key, value in settings.items() for word in ("--set", f"{key}={value}")]
    more = ["--sheet", f"{folder}/g.svg"] if command == "guide" else []
    done = CliRunner().invoke(cli.mechsym, [command, case, *words, *more, "--json"])
    return None if done.exit_code == 2 or done.exception and done.exit_code != 1 else json.loads(done.stdout)


@pytest.mark.parametrize(("case", "choice", "key", "value", "command"), KEYS, ids=[row[2] for row in KEYS])
def test_a_key_that_a_choice_leaves_unread_is_told_and_changes_nothing(case, choice, key, value, command, tmp_path):
    said = answer(command, case, {**choice, key: value}, tmp_path)
    if said is None:  # what is printed cannot be cut of this case
        pytest.skip(f"{command} refuses {choice}")
    assert f"unread keys: {key}" in {doubt["quantity"] for doubt in said.pop("doubts")}
    plain = answer(command, case, choice, tmp_path)
    plain.pop("doubts")
    assert said == plain


def test_letters_of_a_train_are_not_taken_by_themselves(tmp_path):
    file = tmp_path / "train.toml"
    file.write_text(cases.text("opposed-pistons") + "\n[inputs]\nM = 1.0\n")
    with pytest.raises(BadInput, match=r"\[inputs\] crank_train has as many letters as throws"):
        cases.load(str(file))


def test_sections_say_who_reads_them():
    assert commands_of("codesign") == ["codesign"] and commands_of("report") == ["all"]
    assert set(commands_of("limits")) == {"codesign", "guide", "hinge"}
    assert {"cycle", "forces", "simulate"} <= set(commands_of("heat_transfer"))
    assert all(commands_of(section) for section in schema.sections())
    assert own.is_file("own.py")  # by which mechanisms of one's own are asked
