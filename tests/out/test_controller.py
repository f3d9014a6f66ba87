"""The pressure controller as an FMU: the standard, beside the machine's FMU, and against a least-squares of its own."""

import io
import zipfile

import numpy as np
import pytest
from click.testing import CliRunner

from mechsym import cases
from mechsym.cli import mechsym
from mechsym.errors import BadInput
from mechsym.jobs.export import controlled
from mechsym.out.fmi import controller, fmu, write

pytest.importorskip("fmpy", reason="the extra fmu is not installed")
validation = pytest.importorskip("fmpy.validation")

from mechsym.out.fmi.compare import driven  # noqa: E402

SAMPLES = 180  # of a period


@pytest.fixture(scope="module")
def control(tmp_path_factory):
    def get(version, name="zotov-89", **settings):
        case = cases.load(name, settings)
        block, code = controller(name, *controlled(case))
        return write(fmu(block, version, code=code), tmp_path_factory.mktemp("control") / f"{version}.fmu")

    return get


@pytest.mark.slow
@pytest.mark.parametrize("version", [2, 3])
def test_the_standard_is_kept_and_only_steps_are_offered(control, version):
    path = control(version)
    assert validation.validate_fmu(str(path)) == []
    with zipfile.ZipFile(io.BytesIO(path.read_bytes())) as archive:
        text = archive.read("modelDescription.xml").decode()
    assert "<CoSimulation" in text and "<ModelExchange" not in text


def together(machine, own, periods, speed, start, leak=0.0):
    """Errors of the pressure by the design's, one a period, and the ripple of each; a leak takes a share off."""
    p0, step = own.references["p0"], 2 * np.pi / speed / SAMPLES
    design = own.get([own.references["p0_design"]])[0]
    own.set([own.references["p0_start"]], [start * design])
    errors, ripples, speeds, t, over = [], [], [], 0.0, 0.0
    while len(errors) < periods:
        phi, phid = machine.states()
        own.set(own.inputs, [phi, phid])
        own.step(t, step)
        (pressure,), (done,) = own.get([p0]), own.get([own.references["periods"]])
        pressure *= 1 - leak
        machine.set([machine.references["p0"]], [pressure])
        machine.step(t, step)
        t, speeds = t + step, [*speeds, phid]
        if done > over:
            errors, ripples = [*errors, pressure / design - 1], [*ripples, np.ptp(speeds) / np.mean(speeds)]
            over, speeds = done, []
    return np.array(errors), np.array(ripples)


@pytest.mark.slow
@pytest.mark.parametrize("version", [2, 3])
def test_it_brings_a_wrong_pressure_back(unit, control, version):
    """The machine runs by its own FMU: nothing of the controller knows how the pressure acts but the guide's curve."""
    speed = cases.load("zotov-89").sections["operation"].speed
    with driven(unit("zotov-89", version), "cs") as machine, driven(control(version), "cs") as own:
        errors, ripples = together(machine, own, 8, speed, 1.10)
    assert ripples[0] > 0.3  # ten per cent of pressure
    assert abs(errors[-1]) < 2e-3 and ripples[-1] < 0.02
    assert np.all(np.diff(np.abs(errors[:4])) < 0)


@pytest.mark.slow
def test_it_makes_up_for_a_leak(unit, control):
    speed = cases.load("zotov-89").sections["operation"].speed
    with driven(unit("zotov-89", 2), "cs") as machine, driven(control(2), "cs") as own:
        errors, ripples = together(machine, own, 10, speed, 1.0, leak=0.04)
    assert abs(errors[0]) > 0.005 and abs(errors[-1]) < 2e-3 and ripples[-1] < 0.02


@pytest.mark.slow
def test_the_error_is_that_of_a_least_squares_over_the_turn(control):
    """One turn of a made-up speed; the same regression by numpy from the guide and the hinge, on its own samples."""
    wanted, guide, load = controlled(cases.load("zotov-89"))
    phi = np.linspace(0.0, 2 * np.pi, 721)
    omega = wanted.omega * (1 + 0.02 * np.cos(phi - 0.4) + 0.01 * np.sin(2 * phi))
    with driven(control(2), "cs") as own:
        for i, (angle, speed) in enumerate(zip(phi, omega, strict=True)):
            own.set(own.inputs, [angle, speed])
            own.step(0.01 * i, 0.01)
        (found,) = own.get([own.references["p0_error"]])
    from mechsym.hinge.guide import closing, path

    spring = guide.spring
    z = closing(guide, path(guide)(phi))
    # energy for each pascal: A times the integral of (H/(H - s))^n over the closing
    unit = spring.A * spring.H / (spring.n - 1) * ((spring.H / (spring.H - z)) ** (spring.n - 1) - 1)
    torque = load.torque * (omega / load.speed) ** 2
    taken = np.concatenate([[0], np.cumsum((torque[1:] + torque[:-1]) / 2 * np.diff(phi))])
    seen = -wanted.inertia(phi) * (omega**2 - np.trapezoid(omega**2, phi) / (2 * np.pi)) / 2 - taken
    weight = np.sqrt(np.where((phi == 0) | (phi == phi[-1]), 0.5, 1.0))
    matrix = np.column_stack([unit, np.ones_like(phi), phi]) * weight[:, None]
    (error, *_), *_ = np.linalg.lstsq(matrix, seen * weight, rcond=None)
    assert found == pytest.approx(error, rel=1e-6) and abs(error) > 1e4


def test_what_it_cannot_control_is_refused(tmp_path):
    words = ["fmu", "nunes-hypocycloid", "--part", "controller", "--out", str(tmp_path / "c.fmu")]
    done = CliRunner().invoke(mechsym, words)
    assert isinstance(done.exception, BadInput) and not list(tmp_path.iterdir())
    done = CliRunner().invoke(mechsym, ["fmu", "zotov-89", "--part", "controller", "--compare"])
    assert isinstance(done.exception, BadInput) and "--compare is for the machine" in str(done.exception)
