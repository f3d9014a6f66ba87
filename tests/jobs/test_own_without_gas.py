"""Machines of the user's own that no gas turns: a torque curve, a drive, weights, springs, inertia alone."""

from pathlib import Path

import numpy as np
import pytest
from one_turn import turned

from mechsym import cases
from mechsym.cases.check import check_file
from mechsym.cases.settings import settings_of
from mechsym.codesign.machines import point
from mechsym.errors import BadInput
from mechsym.hinge.shown import html, pictures
from mechsym.hinge.summary import HingeNumbers, hinge_columns
from mechsym.hinge.torque import torque
from mechsym.jobs.flywheel import flywheel
from mechsym.jobs.hinge import hinge
from mechsym.jobs.machine import machine
from mechsym.jobs.problem import problem_of
from mechsym.machine.record import shaft_torque
from mechsym.quantities.results import tell
from mechsym.simulate import simulate

EXAMPLES = Path(__file__).parents[2] / "examples" / "mechanisms"
TEXT = (EXAMPLES / "compressor.toml").read_text().replace("./compressor.py", str(EXAMPLES / "compressor.py"))
START, END = TEXT.index("[cycle]"), TEXT.index("[spring]")


def compressor(tmp_path, acting="", more=""):
    path = tmp_path / "machine.toml"
    path.write_text(TEXT[:START] + acting + "\n" + TEXT[END:] + more)
    return cases.load(str(path))


@pytest.fixture
def curve(tmp_path):
    """The torque of the compressor's own cycle, as a file with the inertia in it."""
    built = machine(cases.load(str(EXAMPLES / "compressor.toml")))
    phi = np.radians(np.arange(0, 360, 0.25))
    kinematics = dict(zip(*_curves(built.mechanism, phi), strict=True))
    rows = [
        f"{np.degrees(a):.12g},{m - d * w**2 / 2:.17g},{w:.17g}"
        for w in (80.0, 100.0)
        for a, m, d in zip(phi, shaft_torque(built, "drive", phi), kinematics["dinertia_dphi"], strict=True)
    ]
    (tmp_path / "curve.csv").write_text("phi [deg],torque_with_inertia [N*m],speed [rad/s]\n" + "\n".join(rows))
    return '[torque]\nfile = "curve.csv"\n'


def _curves(mechanism, phi):
    function = mechanism.functions["kinematics"]
    return function.name_out(), [np.asarray(v).ravel() for v in function(phi[None, :])]


@pytest.mark.slow
def test_a_torque_curve_stands_for_the_cycle(tmp_path, curve):
    case, phi = compressor(tmp_path, curve), np.linspace(0, 2 * np.pi, 500)
    wanted = torque(machine(cases.load(str(EXAMPLES / "compressor.toml"))))
    found = torque(machine(case))
    assert found.load_torque == pytest.approx(wanted.load_torque, rel=1e-5)
    # the valves of the cycle are kinks, which the file's cubics round
    np.testing.assert_allclose(found.torque(phi), wanted.torque(phi), atol=2e-3 * wanted.torque_max)
    run = simulate(problem_of(case), settings_of(case))
    assert abs(run.energy.residual) < 1e-8
    one = turned(case)
    assert one.columns["driving_torque"].mean() == pytest.approx(-found.load_torque, rel=1e-3)  # of 720 points


@pytest.mark.slow
def test_codesign_takes_the_curve_too(tmp_path, curve):
    found = point(machine(compressor(tmp_path, curve)), 1.0)
    assert found.law == "constant" and found.load_torque < 0 and found.misfire is None


@pytest.mark.slow
def test_a_hinge_without_gas_balances_inertia_alone(tmp_path):
    design = hinge(compressor(tmp_path))
    phi = np.linspace(0, 2 * np.pi, 100)
    (q,) = design.machine.mechanism.coordinates
    names, values = _curves(design.machine.mechanism, phi)
    slope = dict(zip(names, values, strict=True))[f"dinertia_d{q}"]
    np.testing.assert_allclose(design.hinge.torque(phi), design.machine.omega**2 / 2 * slope, atol=1e-9)
    assert design.check.speed_ripple < 1e-9 and abs(design.check.result.energy.residual) < 1e-8
    told = tell(HingeNumbers(judged=design))
    assert told["p_max_bar"] is None and told["losses"]["share"] is None
    assert told["losses"]["speed_ripple"] is not None  # what is driven is driven harder
    assert "pressure" not in hinge_columns(design)


@pytest.mark.slow
def test_the_report_shows_what_there_is(tmp_path):
    design = hinge(compressor(tmp_path))
    assert [picture.name for picture in pictures(design)][:2] == ["mechanism", "torque"]
    figures = dict.fromkeys(("mechanism", "torque", "speeds", "track", "contact"), "<svg/>")
    text = html(design, HingeNumbers(judged=design), figures)
    assert "Cylinder pressure" not in text and "Torque of the hinge" in text
    assert "one misfire" not in text.lower() and "nan" not in text.lower().split()


def test_check_knows_what_runs_without_gas(tmp_path):
    compressor(tmp_path, '[torque]\nfile = "curve.csv"\n')
    lacks = check_file(str(tmp_path / "machine.toml"), trust=True).commands
    assert all(lacks[name] == [] for name in ("hinge", "flywheel", "forces", "simulate", "guide", "size"))


def test_a_flywheel_without_gas(tmp_path):
    found = flywheel(compressor(tmp_path), 0.002)
    assert found.status == "found"
    assert found.trial.speed_ripple == pytest.approx(0.002, rel=1e-3)


def test_a_drive_is_carried_by_the_load(tmp_path):
    case = compressor(tmp_path, '[drive]\ninput = "M_r"\ntorque = "-5 N*m"\n')
    phi = np.linspace(0, 6, 50)
    np.testing.assert_allclose(torque(machine(case)).torque(phi), torque(machine(compressor(tmp_path))).torque(phi))


def test_a_drive_without_an_input_drives_and_the_load_takes_its_mean(tmp_path):
    # the only torque on this shaft is the load's, which counts against the motion
    for name in ("constant", "propeller"):
        case = compressor(tmp_path, f'[drive]\ntorque = "30 N*m"\n[load]\nlaw = "{name}"\ntorque = "30 N*m"\n')
        assert torque(machine(case)).load_torque == pytest.approx(30.0, rel=1e-12)
        found = flywheel(case, 0.002)
        assert found.status == "found" and found.torque_mean == pytest.approx(30.0, rel=1e-12)
        assert found.trial.speed_ripple == pytest.approx(0.002, rel=1e-5)


def test_a_load_that_nothing_drives_is_told_so(tmp_path):
    found = flywheel(compressor(tmp_path, '[load]\nlaw = "propeller"\ntorque = "5 N*m"\n'), 0.02)
    assert found.status == "none" and found.reason.endswith("the load takes 5 N*m: nothing drives it")


def test_rounding_is_no_load(tmp_path):
    """A torque without a mean leaves a load of 1e-15 N m: no share of it is told, and losses have to be driven."""
    angles = np.arange(0, 360, 5.0)
    rows = "\n".join(f"{a:g},{40 * np.sin(np.radians(a) + 0.3):.17g},900" for a in angles)
    (tmp_path / "swing.csv").write_text(f"phi [deg],torque [N*m],speed [rpm]\n{rows}\n")
    for law in ("constant", "propeller"):
        design = hinge(compressor(tmp_path, f'[torque]\nfile = "swing.csv"\n[load]\nlaw = "{law}"\n'))
        assert design.hinge.load_torque == 0.0
        lost = tell(HingeNumbers(judged=design))["losses"]
        assert lost["share"] is None and set(lost["shares"].values()) == {None}
        assert lost["total"] > 0 and lost["speed_ripple"] is not None


def test_torque_and_cycle_are_one_too_many(tmp_path, curve):
    with pytest.raises(BadInput, match="in place of"):
        machine(compressor(tmp_path, curve + TEXT[START:END]))
