"""A declaration of the package, copied beside a case, is the same mechanism: its numbers are the built-in ones."""

import json
import re
import shutil
from importlib import resources
from pathlib import Path

import pytest
from click.testing import CliRunner

from mechsym import cases
from mechsym.cli import mechsym
from mechsym.errors import BadInput

DERIVATIONS = Path(__file__).parents[2] / "derivations"
SPRUNG = """
[spring]
law = "air_absolute"
A = "20 cm^2"
H = "120 mm"
p0 = "4 MPa"
n = 1.35
[guide]
arrangement = "two_tracks"
start = "placed"
rho0 = "120 mm"
z_margin = "2 mm"
shaft_ratio = 0.5
balance = "whole_cycle"
[rollers]
radius = "20 mm"
width = "25 mm"
plane_offset = "30 mm"
E = "206 GPa"
nu = 0.3
friction = "none"
rolling_arm = "1e-6 m"
[limits]
spring_pressure = "25 MPa"
closing_share = 0.9
pressure_angle = "30 deg"
profile_radius = "1 mm"
roller_reaction = "40 kN"
hertz_stress = "1500 MPa"
"""
SHORT = ["--set", "simulation.turns=2", "--no-check"]
HINGE = ["hinge", "--set", "trials.turns=4"]
FLYWHEEL = ["flywheel", "--ripple", "2%"]
GUIDE = ["guide", "--sheet", "sheet.svg"]
OUT = (["export", "--to", "c,modelica,julia", "--out", "run"], ["page", "--out", "run/page.html"])
HEAVY = (["fmu", "--platforms", "none", "--out", "run/machine.fmu"], ["report", "--out", "run/report.html"])
SWEEP = ["sweep", "--over", "operation.speed=100,110rpm", "--jobs", "1"]
START = ["simulate", "--set", "t_end=2", "--set", "simulation.window=1", "--dampings", "1,5"]
DAMPED = ["sweep", "--over", "c1=1,5", "--set", "t_end=2", "--set", "simulation.window=1", "--jobs", "1"]
#: Values that are refused, and such that are doubted
WRONG = {
    "moroianu": ("l2=0.1", "r1=0,r2=0", "IC2=14", "m3=60000", "axis_tilt=90", "g=30"),
    "nunes-hypocycloid": ("alpha_n=60deg", "alpha_n=2", "m2=500", "m3=90", "e=-1mm", "u1=30"),
    "balandin": ("I_link=50", "m_a=900", "r=0", "I1=1e4"),
    "chmielewski": ("l=0.01", "k1=1e-3", "c1=1e6", "m2=500", "m0=-1"),
    "throw": ("l2=0.1", "offset=1.2", "I_rod=14", "m_piston=60000"),
}
TRIED = {
    "zotov-89": ("crosshead", "", (["check"], ["cycle"], FLYWHEEL, ["simulate", *SHORT], HINGE, GUIDE)),
    "moroianu": ("crosshead", "", (["check"], ["cycle"], FLYWHEEL, ["simulate", *SHORT], SWEEP, *OUT, *HEAVY)),
    "generator-breathing": ("crosshead", "", (["cycle"], ["simulate", *SHORT])),
    "nunes-hypocycloid": ("hypocycloid", SPRUNG, (
        ["check"], ["cycle"], FLYWHEEL, ["simulate", *SHORT], HINGE, GUIDE, OUT[0], *HEAVY,
    )),  # a page of its hinge takes minutes to compile
    "balandin": ("rodless", "", (["check"], ["cycle"], FLYWHEEL, ["simulate", *SHORT], *OUT, *HEAVY)),
    "chmielewski": ("crankshaft_flywheel", "", (["check"], START, DAMPED, *OUT, *HEAVY)),
    "throw": ("crank_throw", "", (["check"], ["cycle"], ["forces"], FLYWHEEL, ["simulate", *SHORT], *OUT, *HEAVY)),
}  # fmt: skip
OPTIMISED = """
[optimise]
objective = "mep"
goal = "maximise"
[optimise.variables]
"{name}" = {{ low = "{low}", high = "{high}" }}
"""
STROKE = OPTIMISED.format(name="parameters.r", low="0.9 m", high="1 m")
IGNITION = OPTIMISED.format(name="cycle.ignition", low="-40 deg", high="0 deg")
CODESIGN = ["codesign", "--losses", "none", "--ripple", "5%"]
#: Mechanism, what is added to the case, command
DESIGNED = {
    "throw optimise": ("crank_throw", STROKE, ["optimise"]),
    "nunes-slider-crank optimise": ("crosshead", IGNITION, ["optimise"]),
    "nunes-hypocycloid optimise": ("hypocycloid", "", ["optimise"]),
    "zotov-89 codesign": ("crosshead", "", [*CODESIGN, "--speeds", "89"]),
    "nunes-hypocycloid codesign": ("hypocycloid", SPRUNG, CODESIGN),
    "throw codesign": ("crank_throw", SPRUNG, CODESIGN),
}
#: Mechanism, a letter that is looked for, what acts in the run
MEASURED = {
    "moroianu": ("crosshead", "I01", ""),
    "nunes-hypocycloid": ("hypocycloid", "I1", ""),
    "balandin": ("rodless", "I1", "[inputs]\nM = 0.2\n"),
    "throw": ("crank_throw", "r", ""),
    "chmielewski": ("crankshaft_flywheel", "I2", ""),
}
SLOW = ("hinge", "flywheel", "simulate", "guide", "fmu", "report", "page", "sweep", "export")
LONG = ("nunes-hypocycloid report", "balandin report", "throw report")  # the others' reports are asked for the same
QUICK = (
    "moroianu export",
    "chmielewski simulate",
    "chmielewski sweep",
    "throw export",
    "zotov-89 simulate",
    "zotov-89 guide",
)


def text_of(name):
    """A case of the package, or one of a single throw with its cylinder off the axis."""
    if name != "throw":
        return (resources.files("mechsym.cases") / f"{name}.toml").read_text()
    text = (resources.files("mechsym.cases") / "moroianu.toml").read_text().replace('"crosshead"', '"crank_throw"')
    head, _, tail = text.partition("[parameters]")
    letters = """r = 0.955
l1 = 0.85
l2 = 1.22
offset = 0.1
m_rod = 1700
m_piston = 2100
I_rod = 1400
I0 = 2200
"""
    return f"{head}[parameters]\n{letters}\n[operation]{tail.partition('[operation]')[2].partition('[part_')[0]}"


@pytest.fixture(scope="module")
def cache(tmp_path_factory):
    """What is derived and compiled, once for all copies of a declaration."""
    return tmp_path_factory.mktemp("cache")


@pytest.fixture
def both(tmp_path, monkeypatch, cache):
    """Folders with a case of the built-in mechanism, and of a copy of its declaration."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(cache))

    def written(name, mechanism, more):
        text = text_of(name) + more
        for folder in ("built_in", "copied"):
            (tmp_path / folder).mkdir()
            (tmp_path / folder / f"{name}.toml").write_text(text)
        shutil.copy(DERIVATIONS / f"{mechanism}.py", tmp_path / "copied")
        copied = text.replace(f'mechanism = "{mechanism}"', f'mechanism = "./{mechanism}.py"')
        (tmp_path / "copied" / f"{name}.toml").write_text(copied)
        return tmp_path / "built_in", tmp_path / "copied"

    return written


def numbers(folder, words, name, monkeypatch):
    """Exit status, JSON or error, and files of a command, without the time that it took."""
    monkeypatch.chdir(folder)
    trust = ["--trust"] if words[0] == "check" else []
    done = CliRunner().invoke(mechsym, [words[0], f"{name}.toml", *words[1:], *trust, "--json"])
    if isinstance(done.exception, BadInput):
        return 2, str(done.exception), {}
    assert done.exception is None or isinstance(done.exception, SystemExit), done.exception
    told = json.loads(done.stdout)
    if isinstance(told, dict):
        told.pop("wall_s", None)
    files = {p.relative_to(folder).as_posix(): p for p in sorted((folder / "run").rglob("*")) if p.is_file()}
    texts = {n: p.read_text() for n, p in files.items() if p.suffix in (".c", ".h", ".mo", ".jl", ".html")}
    return done.exit_code, json.dumps(told), {**dict.fromkeys(files), **texts}


def plain(answer, mechanism):
    """An answer with the built-in name in place of the copy's, and no digest of the case file that says it."""
    code, told, files = answer

    def named(text):
        same = text and text.replace(f"./{mechanism}.py", mechanism).replace(f"{mechanism}.py", mechanism)
        same = same and same.replace(f"<code>{mechanism}</code>", mechanism)  # a path is not set as a name is
        return same and re.sub(r'(sha256"?:? "?)[0-9a-f]{12}', r"\1", same)

    return code, named(told), {name: named(text) for name, text in files.items()}


@pytest.mark.parametrize(
    ("name", "command"),
    [
        pytest.param(
            name, command, id=f"{name} {command[0]}",
            marks=[pytest.mark.slow] * (command[0] in SLOW and f"{name} {command[0]}" not in QUICK)
            + [pytest.mark.heavy] * (f"{name} {command[0]}" in LONG),
        )
        for name, (_, _, commands) in TRIED.items()
        for command in commands
    ],
)  # fmt: skip
def test_a_copy_gives_what_the_built_in_mechanism_gives(both, monkeypatch, name, command):
    mechanism, more, _ = TRIED[name]
    built_in, copied = (numbers(folder, command, name, monkeypatch) for folder in both(name, mechanism, more))
    assert built_in[0] in (0, 1), built_in
    assert plain(copied, mechanism) == plain(built_in, mechanism)


@pytest.mark.parametrize("what", [
    name if "optimise" in name and "hypo" not in name else pytest.param(name, marks=pytest.mark.slow)
    for name in DESIGNED
])  # fmt: skip
def test_a_copy_is_designed_as_the_built_in_mechanism(both, monkeypatch, what):
    name, (mechanism, more, command) = what.partition(" ")[0], DESIGNED[what]
    built_in, copied = (numbers(folder, command, name, monkeypatch) for folder in both(name, mechanism, more))
    assert built_in[0] == 0
    assert plain(copied, mechanism) == plain(built_in, mechanism)


@pytest.mark.parametrize(
    "name", [n if n != "chmielewski" else pytest.param(n, marks=pytest.mark.slow) for n in MEASURED]
)
def test_a_copy_is_identified_as_the_built_in_mechanism(both, monkeypatch, name):
    """The letter that the run was made with comes back, and the same of both."""
    mechanism, letter, acts = MEASURED[name]
    folders = both(name, mechanism, "")
    for folder in folders:
        head, _, tail = (folder / f"{name}.toml").read_text().partition("[parameters]")
        letters = re.split(r"^\[", tail, flags=re.M)[0]
        free = f'[simulation]\nt_end = "0.5 s"\nspeed_start = "100 rpm"\noutput_step = "2 ms"\n{acts}'
        (folder / f"{name}.toml").write_text(f"{head}[parameters]{letters}\n{free}")
    status, why, _ = numbers(folders[0], ["simulate", "--no-check", "--out", "run"], name, monkeypatch)
    assert status == 0, why
    shutil.copytree(folders[0] / "run", folders[1] / "run")
    truth = getattr(cases.load(str(folders[0] / f"{name}.toml")).need("parameters"), letter)
    command = ["identify", "--trace", "run/series.csv", "--free", letter, "--set", f"{letter}={0.95 * truth}"]
    built_in, copied = (numbers(folder, command, name, monkeypatch) for folder in folders)
    assert built_in[0] == 0, built_in[1]
    assert plain(copied, mechanism) == plain(built_in, mechanism)
    assert json.loads(built_in[1])["parameters"][letter]["value"] == pytest.approx(truth, rel=1e-4)


@pytest.mark.parametrize(("name", "values"), [(name, values) for name, rows in WRONG.items() for values in rows])
def test_a_copy_is_judged_and_refused_as_the_built_in_mechanism(both, monkeypatch, name, values):
    """A value that cannot be is refused in the same words, one that is not usual is doubted under the same code."""
    mechanism, more, _ = TRIED[name]
    sets = [word for value in values.split(",") for word in ("--set", value)]
    command = ["simulate", *sets, "--set", "t_end=1.5", "--no-check"] if name == "chmielewski" else ["forces", *sets]
    built_in, copied = (numbers(folder, command, name, monkeypatch) for folder in both(name, mechanism, more))
    assert built_in[0] == 2 or json.loads(built_in[1])["doubts"]
    assert plain(copied, mechanism) == plain(built_in, mechanism)


@pytest.mark.parametrize(
    ("name", "more"), [("v-twin", ""), pytest.param("radial-engine", SPRUNG, marks=pytest.mark.slow)]
)
def test_a_hinge_holds_an_engine_of_ones_own_at_its_speed(tmp_path, monkeypatch, name, more):
    """Gas on several pistons with articulated rods: with the guide the speed stands still, without it swings."""
    folder = DERIVATIONS.parent / "examples/mechanisms"
    (tmp_path / f"{name}.toml").write_text((folder / f"{name}.toml").read_text() + more)
    shutil.copy(folder / f"{name.replace('-', '_')}.py", tmp_path)
    status, told, _ = numbers(tmp_path, HINGE, name, monkeypatch)
    bare, flywheel, _ = numbers(tmp_path, FLYWHEEL, name, monkeypatch)
    design, free = json.loads(told), json.loads(flywheel)
    assert (status, bare) == (0, 0) and design["guide"]["feasible"]
    assert abs(design["check"]["energy_residual"]) < 1e-9
    assert design["check"]["speed_ripple"] < 1e-6 * free["ripple_bare"] and free["ripple_bare"] > 0.01
    assert design["flywheel_inertia_saved"] > 0
