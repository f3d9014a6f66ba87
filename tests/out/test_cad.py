"""The guide for the workshop: curves within tolerance, files read again by other code, walls that cross are refused."""

import io
import json
import math
import os
import re
import subprocess
import sys

import numpy as np
import pytest
from built_in import needed
from click.testing import CliRunner
from matplotlib.figure import Figure
from matplotlib.text import Text
from scipy.interpolate import PPoly

from mechsym import cases
from mechsym.cli import mechsym
from mechsym.errors import BadInput
from mechsym.jobs.hinge import workshop
from mechsym.out.cad import track
from mechsym.out.cad.curve import cubic, nurbs, offset

ezdxf = pytest.importorskip("ezdxf", reason="the extra cad is not installed")

from ezdxf import bbox  # noqa: E402

from mechsym.out.cad import check  # noqa: E402
from mechsym.out.cad.check import measured  # noqa: E402
from mechsym.out.cad.dxf import text, write  # noqa: E402
from mechsym.out.cad.sheet import periodic, plain, sheet, spring_text  # noqa: E402

WITH_GUIDE = ("zotov-89", "zotov-142", "generator")


@pytest.fixture(scope="module")
def shops():
    made = {}

    def get(name):
        if name not in made:
            made[name] = workshop(cases.load(name, needed(name)))
        return made[name]

    return get


@pytest.mark.slow
@pytest.mark.parametrize("tolerance", [1e-5, 1e-6, 1e-7])
@pytest.mark.parametrize("name", WITH_GUIDE)
def test_a_file_read_again_keeps_its_tolerance(shops, tmp_path, name, tolerance):
    shop = shops(name)
    curves = track(shop.guide, shop.rollers, tolerance, shop.kinks)
    rows, errors = measured(write(curves, tmp_path / "g.dxf", 0.02, ["a"]), shop.guide.rho, shop.rollers.radius)
    assert errors == 0
    assert sorted(r.layer for r in rows) == ["CENTRES", "CENTRES_2", "INNER", "INNER_2", "OUTER", "OUTER_2"]
    for row in rows:
        assert row.gap == 0.0
        assert row.deviation <= tolerance
        assert row.area_error * row.area <= tolerance * row.length
        assert row.stated_error * row.length < 0.6e-6


@pytest.mark.slow
def test_a_fine_drawing_has_area_and_length_to_nine_digits(shops, tmp_path):
    shop = shops("zotov-89")
    path = write(track(shop.guide, shop.rollers, 1e-9, shop.kinks), tmp_path / "g.dxf", 0.06, [])
    for row in measured(path, shop.guide.rho, shop.rollers.radius)[0]:
        assert row.area_error < 1e-9 and row.length_error < 1e-9


def test_a_spoiled_file_is_noticed(shops, tmp_path):
    """The measuring must see a tenth of a micrometre, or it would prove nothing."""
    shop = shops("zotov-89")
    path = write(track(shop.guide, shop.rollers, 1e-7, shop.kinks), tmp_path / "g.dxf", 0.06, [])
    document = ezdxf.readfile(path)
    spline = next(iter(document.modelspace().query('SPLINE[layer=="OUTER"]')))
    points = np.array(spline.control_points)
    points[40] *= 1 + 1e-6
    spline.control_points = points
    document.saveas(path)
    found = {r.layer: r.deviation for r in measured(path, shop.guide.rho, shop.rollers.radius)[0]}
    assert found["OUTER"] > 1.5e-7 >= found["INNER"]


def test_a_file_states_length_and_area_of_the_exact_curves(shops):
    """At any tolerance: what the text says is not what the splines enclose."""
    shop = shops("zotov-89")
    document = ezdxf.read(io.StringIO(text(track(shop.guide, shop.rollers, 1e-5, shop.kinks), 0.06, ["a"])))
    stated = check.stated([e.dxf.text for e in document.modelspace().query("TEXT")])
    assert stated.keys() == {"CENTRES", "INNER", "OUTER"}
    for layer, side in {"CENTRES": 0.0, "INNER": -1.0, "OUTER": 1.0}.items():
        true = check.true_size(shop.guide.rho, side * shop.rollers.radius)
        assert stated[layer] == pytest.approx(true, abs=0.6e-6)


def test_a_circle_is_an_arc_of_known_error():
    """A cubic over the angle h misses a circle by r h^4 / 384 of the radius, a constant that is not ours."""
    circle = offset(PPoly([[2.0]], [0.0, 2 * math.pi], extrapolate="periodic"), 0.5)
    found = cubic("circle", circle, np.linspace(0, 2 * math.pi, 13), 1e-3)
    h = 2 * math.pi / 12
    assert found.deviation == pytest.approx(2.5 * h**4 / 384, rel=0.05)
    assert found.length == pytest.approx(5 * math.pi, rel=1e-14) and found.area == pytest.approx(
        6.25 * math.pi, rel=1e-14
    )
    points, knots = nurbs(found)
    assert len(knots) == len(points) + 4 and np.allclose(np.hypot(*found.points.T), 2.5, rtol=1e-15)


def test_second_track_is_the_first_turned_by_half_a_turn(shops):
    assert track(shops("zotov-89").guide, shops("zotov-89").rollers, 1e-5).turned == (0.0, math.pi)


@pytest.mark.parametrize("wall, radius", [("inner", "700 mm"), ("inner", "400 mm")])
def test_a_crossing_wall_is_refused_with_its_angle(tmp_path, wall, radius):
    words = ["guide", "zotov-89", "--dxf", str(tmp_path / "g.dxf"), "--set", f"rollers.radius={radius}"]
    done = CliRunner().invoke(mechsym, words)
    assert isinstance(done.exception, BadInput)
    assert f"the {wall} wall crosses itself at theta = " in str(done.exception)
    assert not list(tmp_path.iterdir())


def test_the_same_drawing_is_the_same_text(shops):
    shop = shops("zotov-89")
    curves = track(shop.guide, shop.rollers, 1e-5, shop.kinks)
    assert text(curves, 0.06, ["a"]) == text(curves, 0.06, ["a"])


def test_the_same_command_writes_the_same_bytes(tmp_path):
    """Two processes, whose sets have another order."""
    files = [tmp_path / f"{seed}.dxf" for seed in (1, 2)]
    for seed, file in enumerate(files, 1):
        words = [sys.executable, "-m", "mechsym", "guide", "zotov-89", "--dxf", str(file), "--tolerance", "10 um"]
        subprocess.run(words, env={**os.environ, "PYTHONHASHSEED": str(seed)}, check=True, capture_output=True)
    assert files[0].read_bytes() == files[1].read_bytes()


def test_layers_units_and_title(shops):
    shop = shops("zotov-89")
    content = text(track(shop.guide, shop.rollers, 1e-5, shop.kinks), 0.06, ["guide of zotov-89"])
    document = ezdxf.read(io.StringIO(content))
    kinds = {(e.dxf.layer, e.dxftype()) for e in document.modelspace()}
    assert {("HOLES", "CIRCLE"), ("ROLLERS", "CIRCLE"), ("AXES", "LINE"), ("TEXT", "TEXT")} <= kinds
    (hole,) = document.modelspace().query('CIRCLE[layer=="HOLES"]')
    assert hole.dxf.radius == pytest.approx(30.0) and document.units == ezdxf.units.MM


def test_sheet_and_answer_of_the_command(tmp_path):
    svg, dxf = tmp_path / "g.svg", tmp_path / "g.dxf"
    words = ["guide", "zotov-89", "--sheet", str(svg), "--dxf", str(dxf), "--tolerance", "10 um", "--json"]
    done = CliRunner().invoke(mechsym, words)
    assert done.exit_code == 0, done.output
    answer = json.loads(done.output)
    assert answer["written"] == [str(dxf), str(svg)]
    assert answer["checks"]["feasible"] and answer["checks"]["deviation_outer"] <= 1e-5
    assert svg.read_text().startswith("<?xml") and "</svg>" in svg.read_text()
    first = svg.read_bytes()
    assert CliRunner().invoke(mechsym, words).exit_code == 0 and svg.read_bytes() == first


def test_words_of_two_arrows_do_not_meet(shops, monkeypatch):
    """Arrows near the axis, to opposite sides."""
    shop = shops("zotov-89")
    monkeypatch.setattr(periodic, "extremes", lambda path: (0.63, 3.05, 0.79, 0.09))
    figure = sheet(shop, track(shop.guide, shop.rollers, 1e-5, shop.kinks), 0.06)
    figure.draw_without_rendering()
    low, high = (t.get_window_extent() for t in figure.axes[1].texts if " rho " in t.get_text())
    assert not low.overlaps(high)


@pytest.mark.slow
@pytest.mark.parametrize("name", WITH_GUIDE)
def test_no_line_of_the_track_crosses_words_and_none_leave_the_frame(shops, name):
    shop = shops(name)
    figure = sheet(shop, track(shop.guide, shop.rollers, 1e-5, shop.kinks), 0.02)
    figure.draw_without_rendering()
    frame, drawing, *_ = figure.axes
    around = frame.get_window_extent()
    for axis in figure.axes:
        for text_of in axis.texts:
            where = text_of.get_window_extent()
            if text_of.get_text():
                inside = around.contains(where.x0, where.y0) and around.contains(where.x1, where.y1)
                assert inside, text_of.get_text()
    for words in (t for t in drawing.texts if t.get_text()):
        turned, words_at = math.radians(words.get_rotation()), words.get_transform().transform(words.get_position())
        words.set_rotation(0)
        box = Text.get_window_extent(words)  # without the arrow of an annotation
        for line in drawing.lines[:5]:  # the three curves, the hole, the roller
            off = (line.get_transform().transform(line.get_xydata()) - words_at) @ [
                [math.cos(turned), -math.sin(turned)],
                [math.sin(turned), math.cos(turned)],
            ] + words_at
            assert not box.count_contains(off), (words.get_text(), line)


@pytest.mark.slow
@pytest.mark.parametrize("name", WITH_GUIDE)
def test_another_program_draws_the_file_and_no_line_crosses_its_words(shops, name):
    """The drawing add-on of ezdxf, which renders what is in the file."""
    matplotlib, drawing = pytest.importorskip("ezdxf.addons.drawing.matplotlib"), ezdxf.addons.drawing
    shop = shops(name)
    lines = [f"guide of {name}", plain(spring_text(shop.guide.spring))]
    content = text(track(shop.guide, shop.rollers, 1e-6, shop.kinks), 0.02, lines)
    document = ezdxf.read(io.StringIO(content))
    space, axis = document.modelspace(), Figure().add_subplot()
    drawing.Frontend(drawing.RenderContext(document), matplotlib.MatplotlibBackend(axis)).draw_layout(space)
    assert not document.audit().errors and len(axis.get_children()) > 12
    words = space.query("TEXT")
    assert all(ord(letter) >= 32 and letter != "^" for one in words for letter in one.dxf.text)
    drawn = bbox.extents(e for e in space if e.dxftype() != "TEXT")
    tops = [one.dxf.insert.y + one.dxf.height for one in words]
    assert max(tops) < drawn.extmin.y  # below all lines
    assert all(re.search(r"\d\.\d{3} mm, area \d+\.\d{3} mm²$", w.dxf.text) for w in words if "exact" in w.dxf.text)


@pytest.mark.parametrize(("paper", "text"), [("A = 3 cm^2", "A = 3 cm²"), ("1 kg*m^2, 2 m^3", "1 kg*m², 2 m³")])
def test_no_text_of_a_drawing_has_a_control_character(paper, text):
    assert plain(paper) == text and "^" not in plain("10^6")


def test_sheet_says_what_errors_cost(shops):
    """One per cent of pressure against what the design itself reports."""
    shop = shops("zotov-89")
    told = {by.name: (by.low, by.high) for by in shop.tolerances}
    assert told["p0"][0] == pytest.approx(0.0490, abs=5e-4)
    assert 0 < told["track"][0] < told["p0"][0]


@pytest.mark.parametrize(
    "words, said",
    [
        ([], "nothing to write"),
        (["--sheet", "g.png"], "ends in .svg or .pdf; write g.svg"),
        (["--dxf", "g.dxf", "--tolerance", "1 kg"], "--tolerance"),
        (["--dxf", "g.dxf", "--tolerance", "1 m"], "from 1e-10 m to 1e-3 m"),
        (["--dxf", "g.dxf", "--bore", "2 m"], "the track leaves a hole of"),
    ],
)
def test_bad_input_is_one_line(tmp_path, monkeypatch, words, said):
    monkeypatch.chdir(tmp_path)
    done = CliRunner().invoke(mechsym, ["guide", "zotov-89", *words])
    assert isinstance(done.exception, BadInput) and said in str(done.exception)
    assert not list(tmp_path.iterdir())


@pytest.mark.slow
def test_without_the_extra_one_line_names_it(tmp_path):
    code = "import sys; sys.modules['ezdxf'] = None; from mechsym.cli import main; main()"
    words = ["guide", "zotov-89", "--dxf", str(tmp_path / "g.dxf")]
    done = subprocess.run([sys.executable, "-c", code, *words], capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert done.stderr.strip() == "mechsym: a DXF file needs the extra cad: pip install 'mechsym[cad]'"
