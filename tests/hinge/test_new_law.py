"""A spring law is one file and one row: a law that lives in the tests goes through every command."""

import re
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

import mechsym
from mechsym import cases, jobs
from mechsym.cases import schema
from mechsym.cli import mechsym as command
from mechsym.codesign.loss import losses
from mechsym.codesign.programme import solve
from mechsym.codesign.verify import verify
from mechsym.errors import BadInput
from mechsym.hinge.rollers import HingeLosses
from mechsym.jobs.codesign import codesign_task
from mechsym.out.cad.sheet import spring_text

ROOT = Path(mechsym.__file__).parent
SPRING = '[spring]\nlaw = "isotherm"\nA = "0.031 m^2"\nH = "1 m"\np0 = "5 MPa"\n'


@pytest.fixture
def case(monkeypatch, tmp_path):
    """The marine engine with a spring of that law."""
    monkeypatch.setitem(schema.ENTRIES["spring"][1], "isotherm", "hinge.isotherm:Isotherm")
    text = (ROOT / "cases/zotov-89.toml").read_text(encoding="utf-8")
    path = tmp_path / "isotherm.toml"
    path.write_text(re.sub(r"^\[spring\]\n.*?(?=^\[)", SPRING + "\n", text, flags=re.S | re.M), encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    return str(path)


def done(line, status=0):
    ended = CliRunner().invoke(command, line.split())
    assert ended.exit_code == status, (line, ended.output, ended.exception)
    return ended.output


def test_it_is_the_polytrope_of_index_one(case):
    """The gauge law at n = 1 is the same spring."""
    own = jobs.hinge(cases.load(case))
    air = jobs.hinge(cases.load("zotov-89", {"spring.law": "air_gauge", "spring.n": 1.0}))
    phi = np.linspace(0, 2 * np.pi, 101)
    assert own.guide.status == "cut"
    assert own.guide.rho(phi) == pytest.approx(air.guide.rho(phi), rel=1e-9)
    assert own.verdict.margin == pytest.approx(air.verdict.margin, rel=1e-9)
    assert own.check.speed_ripple < 1e-8


@pytest.mark.parametrize("line", [
    "check CASE", "hinge CASE --set trials.turns=4", "guide CASE --sheet sheet.svg", "simulate CASE",
    "sweep CASE --of hinge --over rho0=0.75,0.8 --jobs 1", "sweep CASE --of guides --over rho0=0.75,0.8 --jobs 1",
    "sweep CASE --of hinge --over rho0=0.8 --show retune --jobs 1", "export CASE --to c --out c",
    "fmu CASE --platforms none --out machine.fmu",
])  # fmt: skip
def test_every_command_takes_it(case, line):
    done(line.replace("CASE", case))


@pytest.mark.slow
@pytest.mark.parametrize("line", ["report CASE --out report.html", "page CASE --out page.html"])
def test_page_and_report_take_it(case, line):
    done(line.replace("CASE", case))


def test_the_sheet_has_its_words(case):
    assert spring_text(cases.load(case).need("spring")).startswith("gas at one temperature, A = ")


def codesigned(case, **changes):
    """A small co-design of two speeds, verified."""
    case = cases.load(
        case, {"codesign.speeds": ["75 rpm", "120 rpm"], "codesign.knots": 24, "codesign.angles": 90} | changes
    )
    design = solve(codesign_task(case))
    return design, verify(design)


def test_a_co_design_takes_it_as_the_polytrope_of_index_one(case):
    own, verified = codesigned(case)
    air, _ = codesigned("zotov-89", **{"spring.law": "air_gauge", "spring.n": 1.0})
    assert own.status == air.status == "optimal" and own.flywheel > 500
    assert own.flywheel == pytest.approx(air.flywheel, rel=1e-5)
    assert own.tracks[0].p0 == pytest.approx(air.tracks[0].p0, rel=1e-5)
    assert verified.broken == () and verified.time_ripple == pytest.approx(verified.steady_ripple, rel=1e-4)
    # no wall is known of this law: friction takes its share, the gas gives back what it takes
    lost = losses(own, HingeLosses())
    assert [at.gas for at in lost] == [0.0, 0.0] and min(at.seal for at in lost) > 0


def test_a_co_design_takes_a_coil_and_refuses_a_state():
    coil = {"spring.law": "coil", "spring.F0": "90 kN", "spring.H": "1 m", "spring.k": "600 kN/m"}
    design, verified = codesigned("zotov-89", **coil)
    assert design.status == "optimal" and verified.contacts[0].pressure_max is None
    assert "spring_pressure" not in verified.used and verified.broken == ()
    with pytest.raises(BadInput, match="takes a spring whose force follows from its closing alone"):
        codesigned("zotov-89", **{"spring.law": "air_thermal", "spring.tau": 1.0})


@pytest.mark.slow
@pytest.mark.parametrize("line", [
    "sweep CASE --of codesign --over codesign.ripple=0.05,0.08 --set codesign.speeds=8.9,9.32 --jobs 1",
    "codesign CASE --speeds 75,120 --ripple 5% --losses inside --json",
    "codesign CASE --speeds 75,120 --ripple 5% --realise bearing_loss --free A,rho0 --out run",
])  # fmt: skip
def test_a_co_design_by_command_takes_it(case, line):
    done(line.replace("CASE", case))


def test_nobody_asks_which_spring_it_is():
    kinds = "Spring|Polytrope|AirGauge|AirAbsolute|AirThermal|Coil"
    asked = re.compile(rf"isinstance\([^)]*\b({kinds})\b|type\((?:\w+\.)?spring\) (?:is|==)")
    assert {str(p) for p in ROOT.rglob("*.py") if asked.search(p.read_text(encoding="utf-8"))} == set()
