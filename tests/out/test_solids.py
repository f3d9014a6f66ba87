"""Turned bodies and plates as numbers: volumes against other ways, the sized parts, and what the commands refuse."""

import math
import subprocess
import sys

import numpy as np
import pytest
from click.testing import CliRunner
from scipy.spatial import ConvexHull

from mechsym import cases
from mechsym.cli import mechsym
from mechsym.errors import BadInput
from mechsym.jobs.size import size
from mechsym.out.cad.solids import Plate, Turned, bodies, hull_area, tangents, tube, volume
from mechsym.sizing.rows import Sizing


def test_volumes_of_turned_bodies_are_those_of_the_books():
    assert volume(tube("t", (0.1, 0.3), (-1.0, 2.0), (0.0, 0.0, 0.0), "y")) == pytest.approx(math.pi * 0.08 * 3)
    cone = Turned(name="c", profile=((0.0, 0.0), (0.2, 0.0), (0.0, 0.5)))
    assert volume(cone) == pytest.approx(math.pi * 0.04 * 0.5 / 3)


@pytest.mark.parametrize("ends", [((0, 0, 2), (5, 0, 1)), ((1, 2, 0.3), (-2, 4, 0.9)), ((0, 0, 1), (0, 3, 1))])
def test_area_of_a_plate_is_that_of_the_hull_of_many_points(ends):
    around = np.exp(1j * np.linspace(0, 2 * math.pi, 20001))
    points = np.concatenate([x + 1j * z + r * around for x, z, r in ends])
    hull = ConvexHull(np.stack([points.real, points.imag], axis=-1))
    assert hull_area(*ends) == pytest.approx(hull.volume, rel=1e-7)
    plate = Plate(name="p", ends=ends, holes=((0.0, 0.0, 0.1),), low=1.0, high=3.0)
    assert volume(plate) == pytest.approx(2 * (hull.volume - math.pi * 0.01), rel=1e-7)
    corners = np.array(tangents(*ends))
    for (x, z, r), pair in zip(ends, (corners[[0, 3]], corners[[1, 2]]), strict=True):
        np.testing.assert_allclose(np.hypot(*(pair - (x, z)).T), r)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["nunes-hypocycloid", "nunes-slider-crank"])
def test_sized_parts_stand_where_the_engine_has_them(name):
    sized = size(cases.load(name))
    found = {body.name: body for body in bodies(sized)}
    crank, bore = sized.parts.crank, sized.forces.bore
    pin, web = found["crankpin"], found["web"]
    assert volume(pin) == pytest.approx(math.pi / 4 * (crank.pin**2 - crank.pin_bore**2) * crank.pin_length)
    assert web.low == pytest.approx(crank.pin_length / 2) and web.high - web.low == pytest.approx(crank.web)
    assert max(r for r, _ in found["piston and rod"].profile) == pytest.approx(bore / 2)
    throw = getattr(sized.forces, "e", None) or sized.forces.r
    assert found["shaft"].place[0] - pin.place[0] == pytest.approx(throw)
    for body in found.values():
        if ", far" in body.name and isinstance(body, Turned):
            near = found[body.name.replace(", far", "")]
            assert volume(body) == pytest.approx(volume(near)) and {z for _, z in body.profile} == {
                -z for _, z in near.profile
            }


def test_what_has_no_sized_parts_is_refused():
    loads = Sizing(checked=[], failing=[], converged=True, rounds=0, parts=None, forces=None, stock=None)
    with pytest.raises(BadInput, match="only engines that are sized have parts"):
        bodies(loads)


def test_bad_thickness_is_refused_before_the_kernel_is_asked(tmp_path):
    words = ["guide", "zotov-89", "--step", str(tmp_path / "g.step"), "--thickness", "100 mm"]
    done = CliRunner().invoke(mechsym, words)
    assert isinstance(done.exception, BadInput) and "--thickness = 100 mm" in str(done.exception)


@pytest.mark.slow
def test_without_the_extra_one_line_names_it(tmp_path):
    code = "import sys; sys.modules['OCP'] = None; from mechsym.cli import main; main()"
    words = ["guide", "zotov-89", "--step", str(tmp_path / "g.step")]
    done = subprocess.run([sys.executable, "-c", code, *words], capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert done.stderr.strip() == "mechsym: a STEP file needs the extra step: pip install 'mechsym[step]'"
    assert not list(tmp_path.iterdir())
