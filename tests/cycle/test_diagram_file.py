"""Diagram files: what is read, and every way in which a file is refused: file, line, reason, way out."""

import math

import numpy as np
import pytest

from mechsym.cycle.measured.file import read_diagram
from mechsym.errors import BadInput

TURN, CYCLE = 2 * math.pi, 4 * math.pi


def bump(angle_deg):
    return 1.0 + 49.0 * np.exp(-((np.asarray(angle_deg) % 360 - 180) ** 2) / 500.0)


def table(angle, pressure, header="crank_angle_deg,pressure_bar", sep=","):
    return "\n".join([header, *(f"{a:.10g}{sep}{p:.10g}" for a, p in zip(angle, pressure, strict=True))]) + "\n"


@pytest.fixture
def read(tmp_path):
    def read(text, period=TURN, **columns):
        path = tmp_path / "diagram.csv"
        path.write_text(text, encoding="utf-8")
        return read_diagram(path, period, **columns)

    return read


ONE = np.arange(0.0, 360.0)


@pytest.mark.parametrize(
    ("header", "to_angle", "to_pressure"),
    [
        ("crank_angle_deg,pressure_bar", 1.0, 1.0),
        ("phi_rad,p_kPa", math.pi / 180, 100.0),
        ("angle [deg],cylinder pressure [MPa]", 1.0, 0.1),
        ("CA (deg),p (Pa)", 1.0, 1e5),
        ("turn_rev,p_bar", 1 / 360, 1.0),
    ],
)
def test_units_come_from_the_header(read, header, to_angle, to_pressure):
    recording = read(table(ONE * to_angle, bump(ONE) * to_pressure, header))
    assert np.allclose(recording.angle, np.radians(ONE), atol=1e-9)
    assert np.allclose(recording.pressure, bump(ONE) * 1e5, rtol=1e-8)


@pytest.mark.parametrize("sep", [";", "\t", ","])
def test_delimiters_comments_blank_lines_and_extra_columns(read, sep):
    rows = [f"{a:g}{sep}note{sep}{p:.8g}" for a, p in zip(ONE, bump(ONE), strict=True)]
    text = "\n".join(["# engine: a test", "", sep.join(["phi_deg", "remark", "p_bar"]), *rows, "# end", ""])
    recording = read(text)
    assert recording.comments == ("engine: a test", "end") and recording.columns == ("phi_deg", "p_bar")
    assert recording.angle.size == 360 and recording.lines[0] == 4


@pytest.mark.parametrize("angle", [np.arange(720.0), np.arange(720.0) % 360, (np.arange(720.0) % 720) - 360])
def test_angle_may_go_on_or_start_again(read, angle):
    recording = read(table(angle, bump(angle)), CYCLE)
    assert np.allclose(np.diff(recording.angle), math.pi / 180, rtol=1e-9)


def test_any_spacing(read):
    angle = np.concatenate([np.arange(0, 150, 5.0), np.arange(150, 210, 0.25), np.arange(210, 360, 5.0)])
    assert read(table(angle, bump(angle))).angle.size == angle.size


def test_a_column_can_be_named(read):
    rows = [f"{a:g},{p:.8g},{2 * p:.8g}" for a, p in zip(ONE, bump(ONE), strict=True)]
    text = "\n".join(["phi_deg,p1_bar,p2_bar", *rows])
    assert read(text, pressure_column="p2_bar").pressure.max() == pytest.approx(100e5)


def good_rows():
    return table(ONE, bump(ONE)).splitlines()


def with_row(index, row):
    rows = good_rows()
    rows[index] = row
    return "\n".join(rows)


def without_rows(start, stop):
    rows = good_rows()
    return "\n".join(rows[:start] + rows[stop:])


BAD = {
    "empty": ("", "holds no data"),
    "comments only": ("# nothing\n# here\n", "holds no data"),
    "header only": ("crank_angle_deg,pressure_bar\n", "line 1"),
    "no header": ("\n".join(good_rows()[1:]), "line 1.*header"),
    "no unit": (table(ONE, bump(ONE), "crank_angle,pressure"), "line 1.*unit of a crank angle"),
    "no pressure column": (table(ONE, bump(ONE), "crank_angle_deg,torque_Nm"), "line 1.*unit of a pressure"),
    "wrong unit": (table(ONE, bump(ONE), "crank_angle_mm,pressure_bar"), "line 1.*unit of a crank angle"),
    "unknown unit": (table(ONE, bump(ONE), "crank_angle_deg,pressure_psi"), "line 1.*Pa, kPa, MPa, bar"),
    "two pressures": (
        "\n".join(["phi_deg,p1_bar,p2_bar", *(f"{a:g},1,2" for a in ONE)]),
        "line 1.*p1_bar, p2_bar.*pressure_column",
    ),
    "not a number": (with_row(101, "100,n/a"), "line 102.*'n/a' is not a number"),
    "missing value": (with_row(101, "100,"), "line 102.*not a number"),
    "nan": (with_row(101, "100,NaN"), "line 102.*not finite"),
    "infinite": (with_row(101, "100,inf"), "line 102.*not finite"),
    "short row": (with_row(101, "100"), "line 102.*1 values for 2 columns"),
    "decimal comma": (with_row(101, "100,1,5"), "line 102.*decimal comma"),
    "unbalanced quote": (with_row(101, '"100,1.5'), "line 102"),
    "repeated angle": (with_row(101, "99,1.5"), "line 102.*repeats"),
    "backwards": (with_row(101, "90,1.5"), "line 102.*falls behind"),
    "descending": (table(ONE[::-1], bump(ONE)), "line 3.*falls behind"),
    "gap": (without_rows(100, 110), "line 101.*gap of 11 deg after line 100"),
    "one sample lost": (without_rows(100, 101), "line 101.*gap of 2 deg"),
    "too coarse": (table(ONE[::20], bump(ONE[::20])), "line 3.*too coarse"),
    "radians said to be degrees": (table(np.radians(ONE), bump(ONE)), "not a full period.*unit"),
    "degrees said to be radians": (table(ONE, bump(ONE), "phi_rad,p_bar"), "too coarse.*unit"),
    "not a full turn": ("\n".join(good_rows()[:300]), "covers 298 deg, not a full period of 360 deg"),
    "dead sensor": (table(ONE, np.ones(360)), "swings by 0 bar"),
    "pascal said to be bar": (table(ONE, bump(ONE) * 1e5), "swings by.*unit"),
}


@pytest.mark.parametrize("kind", BAD)
def test_bad_file_is_refused_with_line_and_reason(read, kind):
    text, message = BAD[kind]
    with pytest.raises(BadInput, match=message) as caught:
        read(text)
    assert "diagram.csv" in str(caught.value) and "\n" not in str(caught.value)


def test_one_turn_is_not_enough_for_a_four_stroke(read):
    with pytest.raises(BadInput, match="full period of 720 deg.*working_cycle"):
        read(table(ONE, bump(ONE)), CYCLE)


def test_missing_file_and_binary_file_are_refused(tmp_path):
    with pytest.raises(BadInput, match="nowhere.csv.*cannot be read"):
        read_diagram(tmp_path / "nowhere.csv", TURN)
    (tmp_path / "binary.csv").write_bytes(b"\x89\xff\x00")
    with pytest.raises(BadInput, match="binary.csv.*not UTF-8"):
        read_diagram(tmp_path / "binary.csv", TURN)


def test_named_column_must_exist(read):
    with pytest.raises(BadInput, match="no column 'p9_bar'.*pressure_column"):
        read(table(ONE, bump(ONE)), pressure_column="p9_bar")
