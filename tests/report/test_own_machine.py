"""A machine of one's own that is no engine: its run shows coordinates and outputs, no word of engines stands beside."""

import json
import math
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from mechsym import cases
from mechsym.cli import mechsym
from mechsym.jobs.export import drawing
from mechsym.jobs.run import run
from mechsym.mechanisms.drawn_parts import Circle
from mechsym.quantities.display import figure
from mechsym.report import case_report, html

OWN = Path(__file__).parents[1] / "plausible" / "own"


@pytest.fixture(scope="module")
def thrown():
    return run(cases.load(str(OWN / "trebuchet.toml")), check="none")


def test_outputs_of_a_declaration_stand_beside_the_coordinates(thrown):
    """Height of the stone, q cos(theta) + s cos(sigma); its slopes are no curves of a run."""
    columns = thrown.result.columns
    finely = thrown.result.dense(np.linspace(thrown.result.t[0], thrown.result.t[-1], 200_001))
    y = 8.0 * np.cos(finely["theta"]) + 7.0 * np.cos(finely["sigma"])
    assert thrown.outputs["y"] == pytest.approx({"min": y.min(), "max": y.max(), "end": columns["y"][-1]}, rel=1e-7)
    assert columns["y"] == pytest.approx(8.0 * np.cos(columns["theta"]) + 7.0 * np.cos(columns["sigma"]), abs=1e-12)
    assert thrown.result.units["y"] == "m"


def test_a_sweep_tells_the_ends_of_outputs(tmp_path):
    case = str(OWN / "trebuchet.toml")
    words = ["sweep", case, "--over", "parameters.s=7 m", "--show", "outputs.y", "--json", "--trust"]
    swept = json.loads(CliRunner().invoke(mechsym, words, catch_exceptions=False).stdout)
    ends = run(cases.load(case), check="none").outputs["y"]
    assert {k: v[0] for k, v in swept["data"].items()} == pytest.approx({f"outputs.y.{k}": v for k, v in ends.items()})
    assert set(swept["units"].values()) == {"m"}


def test_a_run_draws_each_coordinate_its_speed_and_the_outputs(thrown):
    (picture,) = thrown.view.pictures
    figure = picture.draw()
    labels = [axis.get_ylabel() for axis in figure.axes if axis.get_visible()]
    assert labels == ["theta [deg]", "speed of theta [rpm]", "sigma [deg]", "speed of sigma [rpm]", "y [mm]"]
    assert [card.name for card in thrown.view.cards] == ["run", "speed of theta", "speed of sigma", "y"]


def test_a_report_says_nothing_of_engines_that_it_has_not_to(thrown):
    text = html([case_report(cases.load(str(OWN / "trebuchet.toml")))])
    for word in ("dead centre", "propeller", "ripple", "<dt>engine</dt>", "/plausible/"):
        assert word not in text, word
    assert "<dt>machine</dt>" in text
    assert (
        text.count("coordinates of trebuchet.py are free") == 2
    )  # of forces, which may have a [motion], and of the others


def test_bodies_without_links_are_drawn_where_their_centres_are():
    """A crane: its trolley goes along the rail, its load hangs p below; the picture tells the time of the run."""
    case = cases.load(str(OWN / "crane.toml"))
    shapes, course = drawing(case)
    trolley, load = (shape.centre for shape in shapes(0.0) if isinstance(shape, Circle))
    assert trolley == pytest.approx((0.0, 0.0), abs=1e-12)
    assert math.dist(trolley, load) == pytest.approx(6.0)
    assert math.atan2(load[0], -load[1]) == pytest.approx(math.radians(5.0))
    assert (course.starts, course.lasts, course.back) == (0.0, pytest.approx(10.0), False)


def test_of_many_turns_the_picture_shows_the_last_two():
    """A washer's drum; its laundry turns with it, so that two turns go round it twice."""
    case = cases.load(str(OWN / "washer.toml"))
    shapes, course = drawing(case)
    result = run(case, check="none").result
    then = np.interp(result.columns["phi"][-1] - 4 * math.pi, result.columns["phi"], result.t)
    step = float(np.diff(result.t).max())  # the picture begins with a result
    ends = pytest.approx(then, abs=step), pytest.approx(result.t[-1])
    assert (course.starts, course.starts + course.lasts) == ends


def test_dots_along_a_line_are_no_picture():
    assert drawing(cases.load(str(OWN / "suspension.toml"))) is None


LOWERED = """from mechsym.derive import Mechanism


def hoist():
    m = Mechanism("hoist", about="A load on a rope.")
    z = m.coordinates("z", "m")
    mass, F = m.parameters("mass", "kg", above=0), m.inputs("F", "N")
    m.weight(0, -9.81)
    m.body("load", mass=mass, at=(0, -z))
    m.force(F, along=z)
    return m
"""


def test_the_answer_of_a_motion_is_the_largest_force_of_each_drive_either_way(tmp_path):
    """A load that is lowered by a cycloid holds its rope: the drive pushes up all the way, m (g + 2 pi h/T^2)."""
    (tmp_path / "hoist.py").write_text(LOWERED)
    (tmp_path / "hoist.toml").write_text(
        'mechanism = "./hoist.py"\n[parameters]\nmass = 2.0\n[motion]\nz = "cycloid 300 mm"\nduration = "2 s"\n'
    )
    (part,) = (one for one in case_report(cases.load(str(tmp_path / "hoist.toml"))).parts if one.name == "forces")
    assert f"{figure(2.0 * (9.81 + 2 * math.pi * 0.3 / 4), 4)} N along z" in part.verdict
