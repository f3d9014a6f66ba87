"""Bad input through the command line: exit status 2, one line on standard error with the value and the way out."""

import subprocess
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner

from mechsym import cases
from mechsym.cli import main, mechsym
from mechsym.errors import BadInput

# every row: what is wrong, the arguments, words that the line must contain (the value found, and what is allowed)
COMMAND_LINE = [
    ("unknown command", ["hing", "zotov-89"], ["'hing'", "mechsym --help"]),
    ("unknown option", ["hinge", "zotov-89", "--sett", "a=1"], ["--sett", "'--set'", "hinge --help"]),
    ("missing argument", ["hinge"], ["CASE", "hinge --help"]),
    ("too many arguments", ["hinge", "zotov-89", "zotov-142"], ["zotov-142", "hinge --help"]),
    ("unknown case", ["hinge", "zotov-98"], ["'zotov-98'", "did you mean 'zotov-89'?", "generator"]),
    ("unknown case, JSON wanted", ["hinge", "zotov-98", "--json"], ["'zotov-98'", "zotov-89"]),
    ("case is a folder", ["hinge", "/"], ["'/'", "directory"]),
    ("unknown mechanism", ["eval", "croshead"], ["'croshead'", "did you mean 'crosshead'?"]),
    ("unknown derivation", ["derive", "--check", "croshead"], ["'croshead'", "crosshead"]),
    ("derivation by path", ["derive", "../generated/crosshead"], ["'../generated/crosshead'", "crosshead"]),
    ("a folder for built-in code", ["derive", "crosshead", "--out", "x", "--check"], ["--out", "FILE.py"]),
    ("a word that is none", ["report", "zotov-89", "--parts", ","], ["--parts ','", "names nothing"]),
    ("a drawing of another kind", ["guide", "zotov-89", "--dxf", "a.svg"], ["--dxf a.svg", "write a.dxf"]),
    ("a certificate of another kind", ["audit", "--certificate", "mine.toml"], ["mine.toml", "write mine.v"]),
    ("a log of another kind", ["audit", "--code", ".", "--sarif", "mine.py"], ["mine.py", "write mine.sarif"]),
    ("a value twice", ["sweep", "zotov-89", "--over", "p0=4,4,5MPa"], ["p0=4,4,5MPa", "each of them once"]),
    ("a load twice", ["codesign", "zotov-89", "--loads", "0.5,0.5"], ["loads: give", "each of them once"]),
    ("a proof over budget", ["prove", "chmielewski", "--t-end", "3", "--budget", "1 s"], ["3 s takes about"]),
    ("a window backwards", ["prove", "chmielewski", "--window", "5..3 s"], ["--window 5..3 s", "up to 100 s"]),
    (
        "a window behind the end",
        ["prove", "chmielewski", "--t-end", "3", "--window", "5..9 s"],
        ["5..9 s", "up to 3 s"],
    ),
    ("no binary to compare", ["fmu", "zotov-89", "--platforms", "none", "--compare"], ["--compare", "--platforms"]),
    ("speeds that are none", ["cycle", "nunes-slider-crank", "--speeds", ""], ["--speeds", "1..5 rpm:9"]),
    ("no engine", ["forces", "chmielewski"], ["crankshaft_flywheel", "crosshead"]),
    ("nothing to optimise", ["optimise", "zotov-89"], ["zotov-89", "[optimise]", "mechsym cases"]),
    ("sizes of an engine at speeds", ["size", "chmielewski"], ["crankshaft_flywheel", "takes a mechanism with one"]),
    ("unknown source", ["reproduce", "zotov2042"], ["'zotov2042'", "zotov2024"]),
    ("formula without its theory", ["audit", "--formula", "r*sin(phi)"], ["--against", "crosshead"]),
    ("formula that would run", ["audit", "--formula", "__import__('os')", "--against", "crosshead.x"], ["__import__"]),
    ("no dampings", ["simulate", "chmielewski", "--dampings", ""], ["--dampings", "N*m*s/rad"]),
    ("half a value", ["sweep", "zotov-89", "--over", "spring.p0=3..8 MPa:2.5"], ["how many", "spring.p0=1..5 Pa:9"]),
    ("an option given twice", ["cycle", "generator", "--out", "a", "--out", "b"], ["--out", "2 times"]),
    ("a key given twice", ["cycle", "zotov-89", "--set", "g=9", "--set", "g=8"], ["g is given twice, '9' and '8'"]),
    (
        "a value by two keys",
        ["cycle", "zotov-89", "--set", "speed_rpm=90", "--set", "operation.speed=95 rpm"],
        ["--set speed_rpm and --set operation.speed give the same value operation.speed"],
    ),
    (
        "a value by an option and a key",
        ["simulate", "chmielewski", "--tolerance", "1e-9", "--set", "simulation.tolerance=1e-8"],
        ["simulation.tolerance is given twice, '1e-8' and '1e-9'"],
    ),
    ("equations of no mechanism", ["eval", "slider_crank", "--latex"], ["'slider_crank'", "allowed are crank_throw"]),
    (
        "a speed that is a comma",
        ["eval", "crosshead", "--case", "zotov-89", "--set", "phid=,"],
        ["phid = ','", "rad/s"],
    ),
    (
        "a doubt as a value",
        ["sweep", "zotov-89", "--over", "spring.p0=4..8MPa:3", "--set", "doubts.knock=1"],
        ["--set doubts.knock: no section [doubts] here; allowed are parameters"],
    ),
    ("diagram without gas", ["fmu", "chmielewski", "--diagram", "none.csv"], ["--diagram", "case generator"]),
    ("diagram that is not there", ["page", "opposed-pistons", "--diagram", "none.csv"], ["none.csv", "cannot be read"]),
    ("archive for a folder", ["hinge", "zotov-89", "--out", "none/x.zip"], ["x.zip", "folder; leave .zip away"]),
    ("archive for a unit", ["fmu", "zotov-89", "--out", "none/x.zip"], ["of kind .fmu; write none/x.fmu"]),
    ("trace of a train", ["identify", "opposed-pistons", "--trace", "none.csv", "--free", "r"], ["from lists"]),
    ("speeds backwards", ["cycle", "nunes-slider-crank", "--speeds", "900:100:50"], ["900:100:50", "a <= b"]),
]
# a command, the option that nothing reads there, and what stands beside it
IDLE = [
    (["cycle", "nunes-hypocycloid", "--loop", "2"], ["--speeds", "3000"]),
    (["cycle", "nunes-hypocycloid", "--loop", "2"], ["--over", "cycle.ignition=-30:-10:10"]),
    (["cycle", "generator"], ["--loop", "2"]),
    (["simulate", "chmielewski", "--rest"], ["--tolerance", "1e-9"]),
    (["simulate", "chmielewski", "--rest"], ["--no-check"]),
    (["simulate", "chmielewski", "--rest"], ["--dampings", "0.2,1"]),
    (["eval", "crosshead", "--latex"], ["--set", "phi=1"]),
    (["eval", "crosshead", "--latex"], ["--case", "zotov-89"]),
    (["export", "crosshead", "--to", "c"], ["--set", "parameters.r1=1"]),
    (["export", "crosshead", "--to", "c"], ["--diagram", "none.csv"]),
    (["sweep", "zotov-89", "--over", "spring.p0=4..6MPa:3"], ["--seed", "4"]),
    (["balance", "zotov-89", "--weights", "none"], ["--largest", "1 kg*m"]),
    (["balance", "zotov-89", "--weights", "none"], ["--least", "mains"]),
    (["balance", "zotov-89"], ["--apart", "150 mm"]),
    (["guide", "zotov-89", "--dxf", "a.dxf"], ["--thickness", "100 mm"]),
    (["prove", "chmielewski"], ["--samples", "10"]),
    (["prove", "chmielewski"], ["--range", "phi=0..1"]),
    (["prove", "crosshead"], ["--window", "1..2 s"]),
    (["prove", "crosshead"], ["--t-end", "1 s"]),
    (["audit", "--code", "."], ["--certificate", "a.v"]),
    (["audit", "."], ["--claim", "="]),
    (["audit", "."], ["--certificate", "a.v"]),
    (["derive", "crosshead", "--latex"], ["--check"]),
]
TWICE = [
    ["report", "zotov-89", "--parts", "cycle,cycle"],
    ["export", "crosshead", "--to", "c, julia,c"],
    ["fmu", "zotov-89", "--platforms", "linux64,linux64"],
    ["identify", "chmielewski", "--trace", "none.csv", "--free", "I2,I2"],
    ["balance", "zotov-89", "--shafts", "2,2"],
    ["codesign", "zotov-89", "--free", "spring.A,spring.A"],
]
OVERRIDES = [
    ("no equals sign", "spring.p0", ["'spring.p0'", "KEY=VALUE"]),
    ("no value", "spring.p0=", ["'spring.p0='", "KEY=VALUE"]),
    ("ambiguous bare key", "law=coil", ["law", "spring.law or rings.law or load.law"]),
    ("unknown bare key", "borre=0.3", ["borre", "did you mean bore?", "section.key"]),
    ("unknown dotted key", "cycle.boore=0.3", ["cycle.boore", "did you mean 'bore'?"]),
    ("unknown section", "sprng.p0=5e6", ["[sprng]", "did you mean 'spring'?"]),
    ("unknown unit", "spring.p0=5 furlong", ["spring.p0", "'furlong'", "MPa"]),
    ("unfinished unit", "spring.p0=5 MPa/", ["spring.p0", "'MPa/'", "kg*m^2"]),
    ("absurd power of a unit", "spring.p0=5 mm^-400", ["spring.p0", "'mm^-400'", "kg*m^2"]),
    ("wrong dimension", "spring.p0=5 m", ["spring.p0", "'5 m'", "Pa"]),
    ("length for an angle", "limits.pressure_angle=5 m", ["limits.pressure_angle", "'5 m'", "rad"]),
    ("not a number", "spring.p0=much", ["spring.p0", "'much'", '"1.5 Pa"']),
    ("nan", "spring.p0=nan", ["spring.p0", "'nan'", "Pa"]),
    ("infinite", "spring.p0=inf", ["spring.p0", "'inf'", "Pa"]),
    ("beyond the floats", "spring.p0=1e999", ["spring.p0", "'1e999'", "1e+20"]),
    ("beyond any machine", "m3=1e200", ["m3", "'1e200'", "1e+20"]),
    ("negative mass", "m3=-1 kg", ["m3 = -1 kg", ">= 0 kg"]),
    ("rod shorter than crank", "l1=-0.4", ["l1 = -0.4 m", ">= 0"]),
    ("crank longer than rod", "r2=1.5", ["rod too short", "1.7 m", "lengthen"]),
    ("speed of zero", "operation.speed=0 rpm", ["speed = 0 rad/s", ">= 0.1"]),
    ("compression ratio of one", "compression_ratio=1", ["compression_ratio = 1", "> 1"]),
    ("polytropic index below one", "spring.n=0.9", ["n = 0.9", ">= 1 and <= 2"]),
    ("unknown spring law", "spring.law=air_absolut", ["'air_absolut'", "did you mean 'air_absolute'?", "coil"]),
    ("another law without its keys", "spring.law=coil", ["spring.k", "missing", "N/m"]),
    ("unknown arrangement", "guide.arrangement=three_tracks", ["'three_tracks'", "two_tracks", "one_roller"]),
    ("margin beyond the spring", "guide.z_margin=2 m", ["z_margin = 2 m", "H = 1 m"]),
    ("track that does not close", "guide.shaft_ratio=0.7", ["shaft_ratio = 0.7", "does not close", "use 1"]),
    ("too few turns", "trials.turns=1", ["turns = 1", ">= 4"]),
    ("table without values", "load.law=table", ["load.speeds", "missing", "rad/s"]),
    ("number for a table", "load.speeds=5", ["load.speeds", "not known"]),
    ("other case unknown", "retune.case=zotov-143", ["'zotov-143'", "did you mean 'zotov-142'?"]),
]
EVALUATIONS = [
    ("missing parameters", ["--set", "r1=0.2"], ["r2, l1", "--set r2=...", "--case"]),
    ("unknown letter", ["--case", "zotov-89", "--set", "Phi=1"], ["Phi", "phi"]),
    ("wrong dimension of a coordinate", ["--case", "zotov-89", "--set", "phi=1 m"], ["phi", "'1 m'", "rad"]),
    ("impossible parameter", ["--case", "zotov-89", "--set", "m3=-1"], ["m3 = -1 kg", ">= 0"]),
    ("case of another mechanism", ["--case", "chmielewski"], ["crankshaft_flywheel", "--case"]),
]
# text of zotov-89 that is replaced, and what takes its place
EDITS = [
    ("missing key", 'm1 = "80 kg"', "", ["parameters.m1", "missing", "kg"]),
    ("misspelt key", "bore = ", "boore = ", ["cycle.boore", "did you mean 'bore'?"]),
    ("misspelt section", "[spring]", "[sprng]", ["[sprng]", "did you mean 'spring'?"]),
    ("missing section", '[operation]\nspeed = "89 rpm"', "", ["[operation]", "missing", "mechsym cases"]),
    ("section twice over", "[spring]", "[[spring]]", ["spring", "[spring]"]),
    ("key twice, once with its unit", 'speed = "89 rpm"', "speed = 9\nspeed_rpm = 89", ["operation.speed", "twice"]),
    ("key with a wrong unit", 'speed = "89 rpm"', "speed_kg = 3", ["speed_kg", "rad/s"]),
    ("mechanism misspelt", '"crosshead"', '"croshead"', ["'croshead'", "did you mean 'crosshead'?"]),
    ("mechanism of another case", '"crosshead"', '"rodless"', ["parameters.r1", "m_link"]),
    ("mechanism is a number", '"crosshead"', "3", ["mechanism = 3", "text"]),
    ("boolean for a number", 'm1 = "80 kg"', "m1 = true", ["parameters.m1", "True", "kg"]),
    ("list for a number", 'm1 = "80 kg"', "m1 = [80, 90]", ["parameters.m1", "[80, 90]", "one value"]),
    ("empty list for a number", 'm1 = "80 kg"', "m1 = []", ["parameters.m1", "one value"]),
    ("table for a number", 'm1 = "80 kg"', "m1 = {kg = 80}", ["parameters.m1", "kg"]),
    ("date for a number", 'm1 = "80 kg"', "m1 = 2020-01-01", ["parameters.m1", "kg"]),
    ("nan for a number", 'm1 = "80 kg"', "m1 = nan", ["parameters.m1", "nan", "kg"]),
    ("integer too large for a float", 'm1 = "80 kg"', f"m1 = {'9' * 400}", ["parameters.m1", "999...", "kg"]),
    ("integer too large for Python", 'm1 = "80 kg"', f"m1 = {'9' * 5000}", ["not valid TOML", "5000 digits"]),
    ("list for a name", 'law = "air_absolute"', 'law = ["coil"]', ["['coil']", "did you mean 'coil'?"]),
    ("number for a name", 'arrangement = "two_tracks"', "arrangement = 1", ["arrangement = 1", "two_tracks"]),
    ("number for a text", 'case = "zotov-142"', "case = 142", ["retune.case = 142", "text"]),
    ("zero byte in a path", 'case = "zotov-142"', 'case = "a\\u0000b"', ["case 'a", "zotov-142"]),
    ("other case of another mechanism", '"zotov-142"', '"chmielewski"', ["chmielewski", "crosshead"]),
]
FILES = [
    ("empty", b"", ["mechanism", "missing"]),
    ("no TOML", b"mechanism = = crosshead", ["not valid TOML", "line 1"]),
    ("no UTF-8", "mechanism = 'crosshe\xe4d'".encode("latin-1"), ["not UTF-8"]),
    ("zero bytes", b"\0\0\0", ["not valid TOML"]),
    ("nested lists", b"a = " + 5000 * b"[" + 5000 * b"]", ["nested too deeply"]),
    ("nested tables", b"a = " + 3000 * b"{a=" + b"1" + 3000 * b"}", ["nested too deeply"]),
    ("value for a section", b"mechanism='crosshead'\nsource='x'\nabout='y'\nspring=3", ["spring = 3", "[spring]"]),
]
DIAGRAMS = [
    ("empty", "", ["holds no data", "header"]),
    ("no unit of angle", "angle,pressure_bar\n0,1\n", ["line 1", "crank_angle_deg"]),
    ("no unit of pressure", "crank_angle_deg,pressure\n0,1\n", ["line 1", "pressure"]),
    ("no number", "crank_angle_deg,pressure_bar\n0,1\n1,x\n", ["line 3", "x"]),
    ("nan", "crank_angle_deg,pressure_bar\n0,1\n1,nan\n", ["line 3", "nan"]),
    ("too short a line", "crank_angle_deg,pressure_bar\n0,1\n1\n", ["line 3"]),
    ("angle repeated", "crank_angle_deg,pressure_bar\n0,1\n1,1\n1,1\n2,1\n", ["line 4"]),
    ("not a full turn", "crank_angle_deg,pressure_bar\n" + "".join(f"{i},1\n" for i in range(300)), ["299"]),
]


def ids(rows):
    return [row[0] for row in rows]


@pytest.fixture
def refused(monkeypatch, capsys):
    """The one line with which a command line is refused."""

    def run(argv):
        monkeypatch.setattr(sys, "argv", ["mechsym", *argv])
        with pytest.raises(SystemExit) as end:
            main()
        printed = capsys.readouterr()
        assert end.value.code == 2
        return checked(printed.out, printed.err)

    return run


def checked(out, err):
    assert out == ""
    assert err.startswith("mechsym: ") and err.endswith("\n") and err.count("\n") == 1, err
    return err


def expect(line, words):
    for word in words:
        assert word in line, f"{word!r} is not in: {line}"


@pytest.mark.parametrize(("argv", "words"), [row[1:] for row in COMMAND_LINE], ids=ids(COMMAND_LINE))
def test_command_line(refused, argv, words):
    expect(refused(argv), words)


@pytest.mark.parametrize(("argv", "idle"), IDLE, ids=lambda row: " ".join(row))
def test_an_option_that_nothing_reads(refused, argv, idle):
    expect(refused([*argv, *idle]), [f"{idle[0]} does nothing", "leave it away"])


@pytest.mark.parametrize("argv", TWICE, ids=lambda row: row[0])
def test_a_word_that_is_given_twice(refused, argv):
    expect(refused(argv), [argv[-2], "names", "twice"])


@pytest.mark.parametrize(("override", "words"), [row[1:] for row in OVERRIDES], ids=ids(OVERRIDES))
def test_override(refused, override, words):
    expect(refused(["hinge", "zotov-89", "--set", override]), words)


@pytest.mark.parametrize(("argv", "words"), [row[1:] for row in EVALUATIONS], ids=ids(EVALUATIONS))
def test_evaluation(refused, argv, words):
    expect(refused(["eval", "crosshead", *argv]), words)


@pytest.mark.parametrize(("old", "new", "words"), [row[1:] for row in EDITS], ids=ids(EDITS))
def test_edited_case(refused, tmp_path, old, new, words):
    text = cases.text("zotov-89")
    assert old in text
    file = tmp_path / "mine.toml"
    file.write_text(text.replace(old, new, 1), encoding="utf-8")
    expect(refused(["hinge", str(file)]), words)


@pytest.mark.parametrize(("content", "words"), [row[1:] for row in FILES], ids=ids(FILES))
def test_file(refused, tmp_path, content, words):
    file = tmp_path / "mine.toml"
    file.write_bytes(content)
    expect(refused(["hinge", str(file)]), ["mine.toml", *words])


@pytest.mark.parametrize("command", ["hinge", "forces"])
@pytest.mark.parametrize(("text", "words"), [row[1:] for row in DIAGRAMS], ids=ids(DIAGRAMS))
def test_diagram(refused, tmp_path, text, words, command):
    file = tmp_path / "diagram.csv"
    file.write_text(text, encoding="utf-8")
    expect(refused([command, "generator", "--diagram", str(file)]), ["diagram.csv", *words])


@pytest.mark.parametrize("command", ["hinge", "forces"])
@pytest.mark.parametrize("path", ["nowhere.csv", "."], ids=["missing", "folder"])
def test_diagram_that_cannot_be_read(refused, path, command):
    expect(refused([command, "generator", "--diagram", path]), [path])


def test_diagram_of_bytes(refused, tmp_path):
    file = tmp_path / "diagram.csv"
    file.write_bytes(b"crank_angle_deg,pressure_bar\n0,\xff\xfe\n")
    expect(refused(["hinge", "generator", "--diagram", str(file)]), ["diagram.csv", "not UTF-8", "CSV"])


@pytest.mark.parametrize("command", ["hinge", "forces"])
def test_measured_cycle_without_its_diagram(refused, command, tmp_path):
    kept = [line for line in cases.text("generator").splitlines() if not line.startswith("file =")]
    (tmp_path / "engine.toml").write_text("\n".join(kept))
    expect(refused([command, str(tmp_path / "engine.toml")]), ["no file", "--diagram FILE"])


@pytest.mark.parametrize(
    ("command", "words"),
    [
        ("hinge", ["2 coordinates", "takes a mechanism with one", "crosshead"]),
        ("cycle", ["section [", "missing", "no piston"]),
    ],
)
def test_what_a_command_needs(refused, command, words):
    expect(refused([command, "chmielewski"]), ["chmielewski", *words, "mechsym cases"])


def test_out_is_a_file(refused, tmp_path):
    file = tmp_path / "taken"
    file.write_text("")
    expect(refused(["hinge", "zotov-89", "--out", str(file)]), ["taken", "is a file"])


def test_out_cannot_be_made(refused, tmp_path):
    (tmp_path / "taken").write_text("")
    expect(refused(["hinge", "zotov-89", "--out", str(tmp_path / "taken" / "below")]), ["taken", "--out"])


PROCESSES = [
    (["hinge", "zotov-89", "--set", "spring.p0=5 m"], "wrong dimension"),
    (["hinge", "nowhere/mine.toml"], "nowhere/mine.toml"),
    (["eval", "croshead"], "did you mean 'crosshead'?"),
    (["hing"], "did you mean 'hinge'?"),
]


@pytest.mark.parametrize(("argv", "words"), PROCESSES, ids=[row[1] for row in PROCESSES])
def test_as_a_process(argv, words):
    command = [Path(sys.executable).parent / "mechsym", *argv]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert words in checked(done.stdout, done.stderr)


@pytest.mark.parametrize("words", ["hinge zotov-89 --diagram none.csv", "forces chmielewski"])
def test_a_refusal_leaves_no_empty_folder(words, tmp_path):
    there = tmp_path / "there"
    there.mkdir()
    for out in (tmp_path / "new" / "below", there):
        done = CliRunner().invoke(mechsym, [*words.split(), "--out", str(out)])
        assert isinstance(done.exception, BadInput), done.output
    assert list(tmp_path.iterdir()) == [there]
