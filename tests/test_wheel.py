"""What is shipped: the wheel holds everything that is needed at run time, and works where it is installed."""

import json
import math
import re
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

import mechsym

ROOT = Path(__file__).parent.parent
# folders of the source tree that go into the wheel, and where they go
SHIPPED = {"mechsym": "mechsym", "generated": "mechsym/generated", "derivations": "mechsym/derivations"}


def expected():
    for folder, place in SHIPPED.items():
        for file in (ROOT / folder).rglob("*"):
            if file.is_file() and "__pycache__" not in file.parts:
                yield f"{place}/{file.relative_to(ROOT / folder).as_posix()}"


def run(*command, **options):
    done = subprocess.run(command, capture_output=True, text=True, check=False, **options)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    """The wheel, built from a copy so that nothing is left behind in the source tree."""
    source = tmp_path_factory.mktemp("source") / "mechsym"
    kept_out = shutil.ignore_patterns(".*", "build", "dist", "*.egg-info", "__pycache__", "demo", "tests")
    shutil.copytree(ROOT, source, ignore=kept_out)
    out = source.parent / "dist"
    run(sys.executable, "-m", "build", "--wheel", "--no-isolation", "--outdir", out, source)
    return next(out.glob("*.whl"))


@pytest.mark.slow
def test_wheel_holds_every_file_and_nothing_else(wheel):
    names = {n for n in zipfile.ZipFile(wheel).namelist() if ".dist-info/" not in n}
    assert names == set(expected())


@pytest.fixture(scope="module")
def installed(wheel, tmp_path_factory):
    """Packages and Python of an environment with the wheel; numpy and the rest come from that of the tests."""
    home = tmp_path_factory.mktemp("installed") / "venv"
    run(sys.executable, "-m", "venv", "--without-pip", home)
    packages = next((home / "lib").glob("python*")) / "site-packages"
    zipfile.ZipFile(wheel).extractall(packages)
    (packages / "dependencies.pth").write_text(str(Path(pytest.__file__).parent.parent) + "\n")
    return packages, home / "bin" / "python"


@pytest.mark.slow
def test_wheel_runs_where_it_is_installed(installed, tmp_path):
    packages, python = installed
    assert str(packages) in run(python, "-c", "import mechsym; print(mechsym.__file__)", cwd=tmp_path)
    assert "zotov-89" in run(python, "-m", "mechsym", "cases", cwd=tmp_path)
    state = run(python, "-m", "mechsym", "eval", "crosshead", "--case", "zotov-89", "--set", "phi=1.0", cwd=tmp_path)
    assert re.search(r"inertia +179\.5415961 ", state)
    assert "phi" in run(python, "-m", "mechsym", "mechanisms", "--json", cwd=tmp_path)


def test_citation_is_of_this_version():
    version = mechsym.__version__
    citation = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    assert re.search(rf"^version: {re.escape(version)}$", citation, re.M)
    assert "\nlicense: MIT\n" in citation


def test_licences_of_files_of_others_are_named():
    """Whatever carries a notice of somebody else stands in LICENSE-VENDORED, and nothing there is gone."""
    named = (ROOT / "LICENSE-VENDORED").read_text(encoding="utf-8")
    kinds = (".h", ".c", ".js", ".css", ".html", ".py", ".toml")
    files = [p for p in (ROOT / "mechsym").rglob("*") if p.suffix in kinds and "__pycache__" not in p.parts]
    foreign = [p for p in files if re.search(r"Copyright \((?:C|c)\) \d", p.read_text(encoding="utf-8"))]
    assert len(foreign) == len(re.findall(r"\w+\.(?:h|js)\b", named)) == 7
    assert [p.name for p in foreign if p.name not in named] == []


@pytest.mark.slow
def test_the_wheel_is_small_and_has_its_licences(wheel):
    assert wheel.stat().st_size < 3_000_000
    names = zipfile.ZipFile(wheel).namelist()
    assert {"LICENSE", "LICENSE-VENDORED"} <= {Path(name).name for name in names if ".dist-info/licenses/" in name}


YOKE = """from mechsym.derive import Mechanism, pi


def yoke():
    m = Mechanism("yoke", about="Scotch yoke")
    phi = m.coordinates("phi")
    r = m.parameters("r", "m", above=0)
    m_p = m.parameters("m_p", "kg", low=0)
    I = m.parameters("I", "kg*m^2", above=0)
    F, M_r = m.inputs("F", "N"), m.inputs("M_r", "N*m")
    crank, slide = m.link("crank", turns=phi, inertia=I), m.link("slide", mass=m_p)
    m.pin("O", m.frame, crank)
    m.slider("G", m.frame, slide)
    m.slot("S", crank.at(r), slide.line(angle=pi / 2))
    x = m.let("x", r - slide.at().x, "m")
    m.force(F, along=x)
    m.torque(-M_r, along=phi)
    m.piston("piston", travel=x, force=F, masses=m_p)
    m.rotor("crank", angle=phi, load=M_r)
    m.draw_line((0, 0), crank.at(r), role="crank")
    m.draw_box(slide.at(2 * r), r / 2, r)
    return m
"""


def yoke_case():
    """The yoke with cycle, hinge and stroke of a built-in engine."""
    text = (ROOT / "mechsym" / "cases" / "zotov-89.toml").read_text()
    parameters = '[parameters]\nr = "0.5 m"\nm_p = "460 kg"\nI = 60\n'
    rest = re.sub(r"(?ms)^\[retune\].*?(?=^\[)", "", text[text.index("[operation]") :])  # to a case of that engine
    return f'mechanism = "./yoke.py"\n{parameters}{rest}'


@pytest.mark.slow
def test_a_mechanism_of_ones_own_goes_through_the_commands(installed, tmp_path):
    def mechsym(*arguments):
        return json.loads(run(installed[1], "-m", "mechsym", *arguments, "--json", cwd=tmp_path))

    assert len(YOKE.splitlines()) <= 40
    (tmp_path / "yoke.py").write_text(YOKE)
    (tmp_path / "yoke.toml").write_text(yoke_case())
    assert len(mechsym("derive", "./yoke.py", "--out", "code")["written"]) == 2
    assert mechsym("derive", "./yoke.py", "--out", "code", "--check")["differs"] == []
    at = mechsym("eval", "./yoke.py", "--case", "yoke.toml", "--set", "phi=1", "--set", "phid=9")
    inertia = 60 + 460 * (0.5 * math.sin(1)) ** 2
    assert at["mass_matrix"][0][0] == pytest.approx(inertia, rel=1e-12)
    assert at["kinetic_energy"] == pytest.approx(inertia * 81 / 2, rel=1e-12)
    assert mechsym("cycle", "yoke.toml")["mep_kpa"][0] == pytest.approx(800, rel=1e-9)
    forces = mechsym("forces", "yoke.toml", "--out", "forces")
    assert forces["power_residual"] < 1e-12
    assert {"forces.csv", "mechanism.svg", "mechanism.html"} <= {Path(file).name for file in forces["files"]}
    running = mechsym("simulate", "yoke.toml", "--set", "simulation.turns=2")
    assert running["status"] == "converged" and abs(running["energy_residual"]) < 1e-8
    hinge = mechsym("hinge", "yoke.toml")
    assert hinge["guide"]["feasible"] and hinge["check"]["speed_ripple"] < 1e-6
    row = mechsym("audit", "--formula", "r*(1 - cos(phi))", "--against", "./yoke.py:x")
    assert row["verdict"] == "exact"
    swept = mechsym("sweep", "yoke.toml", "--over", "spring.p0=5..6 MPa:2")
    assert swept["shape"] == [2] and not swept["failed"]


@pytest.mark.slow
def test_a_package_brings_a_mechanism(installed, tmp_path):
    packages, python = installed
    (packages / "yokes").mkdir()
    (packages / "yokes" / "__init__.py").write_text("")
    (packages / "yokes" / "yoke.py").write_text(YOKE)
    told = packages / "yokes-1.dist-info"
    told.mkdir()
    (told / "METADATA").write_text("Metadata-Version: 2.1\nName: yokes\nVersion: 1\n")
    (told / "entry_points.txt").write_text("[mechsym.mechanisms]\nscotch = yokes.yoke\n")
    found = json.loads(run(python, "-m", "mechsym", "mechanisms", "--json", cwd=tmp_path))
    assert "scotch" in {row["name"] for row in found} or "yoke" in {row["name"] for row in found}
    (tmp_path / "brought.toml").write_text(yoke_case().replace("./yoke.py", "scotch"))
    forces = json.loads(run(python, "-m", "mechsym", "forces", "brought.toml", "--json", cwd=tmp_path))
    assert forces["max"]["x"] == pytest.approx(1.0, rel=1e-9)
    row = run(python, "-m", "mechsym", "audit", "--formula", "r*(1 - cos(phi))", "--against", "scotch.x", "--json",
              cwd=tmp_path)  # fmt: skip
    assert json.loads(row)["verdict"] == "exact"
