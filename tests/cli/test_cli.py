"""Every command explains itself, and the numbers that the interface fixes come out of the command line."""

import json
import sys

import pytest

from mechsym.cli import COMMANDS, main


@pytest.fixture
def output(monkeypatch, capsys):
    """Standard output of a command that succeeds and says nothing else."""

    def run(*argv):
        monkeypatch.setattr(sys, "argv", ["mechsym", *argv])
        with pytest.raises(SystemExit) as end:
            main()
        printed = capsys.readouterr()
        assert not end.value.code and printed.err == ""
        return printed.out

    return run


def test_help_lists_the_commands(output):
    text = output("--help")
    titles = [line[:-1] for line in text.splitlines() if line.endswith(":") and line[0] != " "]
    assert titles == ["Options", "Start", "Analyse", "Design", "Many", "Give", "Verify"]
    listed = [line.split()[0] for line in text.split("Start:")[1].splitlines() if line[:3].strip() and line[0] == " "]
    assert listed == [*COMMANDS] and len(set(listed)) == len(listed)


@pytest.mark.parametrize("command", COMMANDS)
def test_help_of_a_command_has_an_example(output, command):
    text = output(command, "--help")
    assert "Example" in text and f"mechsym {command}" in text.split("Example")[1]
    assert "--json" in text


def test_without_a_command_the_help_is_printed(monkeypatch, capsys):
    monkeypatch.setattr(sys, "argv", ["mechsym"])
    with pytest.raises(SystemExit) as end:
        main()
    assert end.value.code == 0 and capsys.readouterr().out.startswith("Usage: mechsym")


def test_version(output):
    assert output("--version").startswith("mechsym")


def test_mechanisms(output):
    rows = json.loads(output("mechanisms", "--json"))
    keys = {"name", "coordinates", "parameters", "inputs", "outputs", "source"}
    assert all(row.keys() >= keys for row in rows)
    crosshead = next(row for row in rows if row["name"] == "crosshead")
    assert {"x", "dx_dphi", "d2x_dphi2", "psi", "inertia", "dinertia_dphi"} <= set(crosshead["outputs"])


def test_cases(output):
    rows = json.loads(output("cases", "--json"))
    assert all(row[key] for row in rows for key in ("name", "mechanism", "source", "about"))
    assert {"zotov-89", "zotov-142", "chmielewski", "generator"} <= {row["name"] for row in rows}


def test_case_is_printed_to_be_edited(output, tmp_path):
    file = tmp_path / "mine.toml"
    file.write_text(output("cases", "zotov-89"), encoding="utf-8")
    assert json.loads(output("cases", str(file), "--json"))["operation"] == {"speed": "89 rpm"}


def test_crosshead_at_one_angle(output):
    found = json.loads(output("eval", "crosshead", "--case", "zotov-89", "--set", "phi=1.0", "--json"))["outputs"]
    assert found["inertia"] == pytest.approx(179.541596065, rel=1e-10)
    assert found["dinertia_dphi"] == pytest.approx(113.073677067, rel=1e-10)
    assert found["dx_dphi"] == pytest.approx(0.49692654381, rel=1e-10)


def test_acceleration_of_the_crosshead(output):
    state = ["phi=1.0", "phid=9.32", "F=1e5", "M_r=9000", "M_h=-20000", "g=9.81"]
    options = [word for text in state for word in ("--set", text)]
    found = json.loads(output("eval", "crosshead", "--case", "zotov-89", *options, "--json"))
    assert found["acceleration"] == [pytest.approx(86.3564288685, rel=1e-10)]


def test_acceleration_of_crankshaft_and_flywheel(output):
    state = ["I0=0.26", "I2=0.58", "r=0.06", "l=0.26", "m0=1.1", "k1=6500", "phi0=1", "phi2=0.99"]
    state += ["phi0d=50", "phi2d=51", "M=1.5"]
    options = [word for text in state for word in ("--set", text)]
    found = json.loads(output("eval", "crankshaft_flywheel", *options, "--json"))
    assert found["acceleration"] == pytest.approx([-256.786541504, 112.068965517], rel=1e-10)


def test_a_case_gives_its_mechanism_and_parameters_to_a_state(output):
    state = ("--set", "phi=1.0")
    assert output("eval", "zotov-89", *state) == output("eval", "crosshead", "--case", "zotov-89", *state)
