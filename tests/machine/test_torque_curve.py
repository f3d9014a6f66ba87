"""A torque on the shaft from a file: inertia taken out, speeds and loads between, what is refused."""

import numpy as np
import pytest

from mechsym.errors import BadInput
from mechsym.machine.torque_curve import read_torque, torque_at

PHI = np.radians(np.arange(0, 360, 2.0))


def works(phi, load, omega):
    return -load * (20 + 5 * np.sin(phi)) * (1 + omega / 100)


def dinertia(phi):
    return 0.003 * np.sin(2 * np.asarray(phi))


def written(tmp_path, head, rows):
    path = tmp_path / "curve.csv"
    path.write_text("\n".join([head, *(",".join(f"{v:.17g}" for v in row) for row in rows)]) + "\n")
    return str(path)


def table(tmp_path, with_inertia, end=False):
    phi = np.append(PHI, 2 * np.pi) if end else PHI
    head = "phi [deg],torque_with_inertia [N*m],speed [rad/s],load [-]" if with_inertia else (
        "phi [deg],torque [N*m],speed [rad/s],load [-]")  # fmt: skip
    rows = [
        (np.degrees(a), works(a, q, w) - (dinertia(a) * w**2 / 2 if with_inertia else 0), w, q)
        for w in (50.0, 100.0) for q in (0.5, 1.0) for a in phi
    ]  # fmt: skip
    return read_torque(written(tmp_path, head, rows))


@pytest.mark.parametrize("end", [False, True])
@pytest.mark.parametrize("with_inertia", [False, True])
def test_the_torque_that_works_comes_out_whether_inertia_is_in_the_file_or_not(tmp_path, with_inertia, end):
    found = table(tmp_path, with_inertia, end)
    assert found.period == 2 * np.pi and found.with_inertia == with_inertia
    phi = np.linspace(-3, 9, 100)
    for omega, load in ((50.0, 0.5), (100.0, 1.0), (60.0, 0.8)):  # linear in both, so exact between
        between = torque_at(found, omega, load, dinertia)(phi)
        np.testing.assert_allclose(between, works(phi, load, omega), atol=2e-5)  # of the spline


def test_a_four_stroke_curve_has_two_turns(tmp_path):
    phi = np.arange(0, 720, 5.0)
    found = read_torque(
        written(tmp_path, "phi [deg],torque [kN*m]", zip(phi, np.sin(np.radians(phi / 2)), strict=True))
    )
    assert found.period == 4 * np.pi and found.speeds == ()
    assert torque_at(found, 3.0, 1.0, dinertia)(np.pi) == pytest.approx(1000.0, rel=1e-6)


FULL = [(a, -1.0) for a in range(0, 360, 5)]
BAD = {
    "phi [deg],force [N]\n0,1\n": "column 'force",
    "phi [deg],speed [rpm]\n0,1\n": "has the columns phi",
    "phi [deg],torque [N*m]\n0,1\n90,1\n180,1\n": "leaves a gap of 180 deg",
    "phi [deg],torque [N*m]\n10,1\n5,1\n": "must rise row by row",
    "phi [deg],torque [N*m]\n0,x\n": "is not a number",
    "phi [deg],torque_with_inertia [N*m]\n" + "".join(f"{a},{m}\n" for a, m in FULL): "depends on the speed",
    "phi [deg],torque [N*m]\n" + "".join(f"{a},{a}\n" for a in range(0, 361, 5)): "does not repeat",
}


@pytest.mark.parametrize("text", BAD)
def test_a_bad_file_is_refused_in_one_line(tmp_path, text):
    path = tmp_path / "bad.csv"
    path.write_text(text)
    with pytest.raises(BadInput, match=BAD[text]) as refused:
        read_torque(str(path))
    assert str(refused.value).startswith(str(path)) and "\n" not in str(refused.value)


def test_no_speed_or_load_is_made_up(tmp_path):
    found = table(tmp_path, with_inertia=False)
    with pytest.raises(BadInput, match="speed = 120 rad/s is outside the file's 50 to 100 rad/s"):
        torque_at(found, 120.0, 1.0, dinertia)
    with pytest.raises(BadInput, match="load = 0.2 is outside the file's 0.5 to 1;"):
        torque_at(found, 60.0, 0.2, dinertia)


def test_every_load_is_wanted_at_every_speed(tmp_path):
    rows = [(a, -1.0, w, q) for w, q in ((50, 0.5), (50, 1), (100, 1)) for a in range(0, 360, 5)]
    with pytest.raises(BadInput, match="no rows for speed = 100 rad/s with load = 0.5"):
        read_torque(written(tmp_path, "phi [deg],torque [N*m],speed [rad/s],load [-]", rows))
