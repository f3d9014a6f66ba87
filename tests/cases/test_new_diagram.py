"""A case of a measured pressure: written from the file and four sizes, it runs at once; what does not fit is said."""

import json
from pathlib import Path

import numpy as np
import pytest
import shipped_record
from click.testing import CliRunner

from mechsym.cases.check import check_file
from mechsym.cli.cycle import cycle
from mechsym.cli.new import new
from mechsym.cycle.measured.file import has_angles, read_diagram
from mechsym.errors import BadInput

SIZES = {"bore": "67.7 mm", "stroke": "55 mm", "rod": "84.2 mm", "compression": "8.5"}
TABLE = np.array([[float(x) for x in line.split(",")] for line in shipped_record.text().splitlines()[4:]]).T
ANGLE, TIME, BAR = TABLE


def table(path: Path, head: str, *columns, separator: str = ",", comma: bool = False) -> str:
    rows = [separator.join(f"{value:.7g}" for value in row) for row in zip(*columns, strict=True)]
    path.write_text("\n".join([head, *(row.replace(".", ",") if comma else row for row in rows)]) + "\n")
    return str(path)


def written(trace, out, **changes):
    """What `new diagram` says of a file, and the case."""
    sizes = [word for name, value in {**SIZES, **changes}.items() if value for word in (f"--{name}", value)]
    arguments = ["diagram", "--trace", str(trace), *sizes, "--out", str(out), "--json"]
    told = json.loads(CliRunner().invoke(new, arguments, catch_exceptions=False).stdout)
    return {doubt["code"] for doubt in told["doubts"]}, told["written"][0]


def test_it_runs_at_once_and_has_nothing_left_to_say(tmp_path):
    codes, case = written(table(tmp_path / "p.csv", "crank_angle_deg,time_s,pressure_bar", *TABLE), tmp_path)
    assert codes == set() and Path(case).name == "p.toml"
    found = json.loads(CliRunner().invoke(cycle, [case, "--json"], catch_exceptions=False).stdout)
    low, high = found["dead_centre"]["interval_deg"]
    assert low < shipped_record.TRUE_DEAD_CENTRE - 360 < high and found["speed_rpm"] == pytest.approx(3000, abs=1)
    low, high = found["imep_interval_bar"]
    assert low < found["imep_bar"] < high
    checked = check_file(case, trust=False)
    assert not checked.problems and not checked.commands["cycle"]
    with pytest.raises(BadInput, match="exists"):
        written(tmp_path / "p.csv", tmp_path)


@pytest.mark.parametrize("form", ["comma", "units below", "times"])
def test_other_ways_to_write_the_same_record(tmp_path, form):
    path, even = tmp_path / "p.csv", np.arange(ANGLE.size) * TIME[-1] / (ANGLE.size - 1)
    if form == "comma":
        table(path, "Winkel [°KW];Druck [bar]", ANGLE, BAR, separator=";", comma=True)
    elif form == "units below":
        table(path, "angle;p1\n[deg];[kPa]", ANGLE, 100 * BAR, separator=";")
    else:
        table(path, "time_ms\tpressure_MPa", 1e3 * even, BAR / 10, separator="\t")
        assert not has_angles(path)
    speed = None if form != "times" else 2 * np.pi * 50
    read = read_diagram(path, 4 * np.pi, omega=speed)
    assert np.allclose(read.pressure, 1e5 * BAR, atol=50) and np.allclose(read.angle, np.radians(ANGLE), atol=1e-3)
    codes, case = written(path, tmp_path, speed="3000 rpm")
    assert codes == set() and "3000 rpm" in Path(case).read_text()


def test_a_file_without_its_speed_is_refused(tmp_path):
    for head, columns in (("angle_deg,p_bar", (ANGLE, BAR)), ("time_s,p_bar", (TIME, BAR))):
        with pytest.raises(BadInput, match="speed"):
            written(table(tmp_path / "p.csv", head, *columns), tmp_path)


def test_what_does_not_fit_is_refused_with_the_way_out(tmp_path):
    swapped = table(tmp_path / "swapped.csv", "pressure_bar,crank_angle_deg", ANGLE, BAR)
    with pytest.raises(BadInput, match="columns swapped.*exchange"):
        written(swapped, tmp_path, speed="3000 rpm")
    clipped = table(tmp_path / "clipped.csv", "angle_deg,p_bar", ANGLE, np.minimum(BAR, 0.7 * BAR.max()))
    with pytest.raises(BadInput, match="saturated at .* wider range"):
        written(clipped, tmp_path, speed="3000 rpm")
    with pytest.raises(BadInput, match="longer than the crank radius"):
        written(swapped, tmp_path, rod="20 mm")
    assert not list(tmp_path.glob("*.toml"))


@pytest.mark.parametrize(
    ("changes", "code"),
    [
        ({"speed": "1200 rpm"}, "speed"),
        ({"compression": "6"}, "compression_exponent"),
        ({"compression": "14"}, "compression_exponent"),
        ({"compression": None}, "compression"),
    ],
)
def test_another_engine_or_speed_is_doubted(tmp_path, changes, code):
    record = table(tmp_path / "p.csv", "crank_angle_deg,time_s,pressure_bar", *TABLE)
    assert code in written(record, tmp_path, **changes)[0]


def test_options_of_the_other_kinds_are_refused():
    for arguments in (["diagram", "--kind", "inline"], ["engine", "--trace", "p.csv"], ["diagram"]):
        with pytest.raises(BadInput, match="belong to an engine|only a diagram has|needs --trace"):
            CliRunner().invoke(new, arguments, catch_exceptions=False)
