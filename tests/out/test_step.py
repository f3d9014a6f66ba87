"""STEP files read again by the kernel: valid, volumes, boxes, walls. Run by `make test-step`, which has the kernel."""

import json

import numpy as np
import pytest
from built_in import needed
from click.testing import CliRunner

pytest.importorskip("OCP", reason="the extra step is not installed")

from mechsym import cases
from mechsym.cli import mechsym
from mechsym.jobs.hinge import workshop
from mechsym.jobs.size import size
from mechsym.out.cad import track
from mechsym.out.cad.check import true_size
from mechsym.out.cad.check_step import main, read, wall_deviation
from mechsym.out.cad.curve import tracks_of
from mechsym.out.cad.solids import bodies, volume
from mechsym.out.cad.step import guide_bodies, write

pytestmark = pytest.mark.slow
WITH_GUIDE = ("zotov-89", "zotov-142", "generator")


@pytest.fixture(scope="module")
def shops():
    made = {}

    def get(name, **settings):
        key = (name, *settings.items())
        if key not in made:
            made[key] = workshop(cases.load(name, needed(name) | settings))
        return made[key]

    return get


def disc_volume(disc, rho):
    """Volume from the path alone: by Steiner a groove of radius r along a path of length L has the area 2 r L [m^3]."""
    groove = 2 * disc.track.roller_radius * true_size(rho, 0.0)[0] * disc.depth
    around = np.pi * (disc.radius**2 - (disc.bore / 2) ** 2) * disc.thickness
    return around - len(disc.track.turned) * groove


def walls_of(shop, disc):
    return wall_deviation(disc, shop.guide.rho, shop.rollers.radius, tracks_of(shop.guide))


@pytest.mark.parametrize("name", WITH_GUIDE)
def test_walls_keep_the_tolerance_and_volume_is_that_of_the_path(shops, tmp_path, name):
    shop = shops(name)
    curves = track(shop.guide, shop.rollers, 1e-7, shop.kinks)
    made = guide_bodies(curves, shop.guide.rollers, 0.02, shop.rollers)
    disc, *rollers = read(write(tmp_path / "g.step", made))
    assert disc.valid and disc.name == "guide" and [r.name for r in rollers] == ["roller 1", "roller 2"]
    walls, deviation = walls_of(shop, disc)
    assert walls == 4 and deviation <= 1e-7
    # a wall that is off by the tolerance everywhere changes the volume by no more
    off = 1e-7 * sum(np.sum(np.hypot(*np.diff(c.points, axis=0).T)) for c in (curves.inner, curves.outer))
    assert abs(disc.volume - disc_volume(made[0], shop.guide.rho)) <= 2 * off * made[0].depth
    for roller, wanted in zip(rollers, made[1:], strict=True):
        assert roller.valid and roller.volume == pytest.approx(volume(wanted), rel=1e-12)
    wide = np.array(disc.high) - disc.low
    np.testing.assert_allclose(wide, [2 * made[0].radius, 2 * made[0].radius, made[0].thickness], rtol=1e-6)


def test_a_fine_disc_has_its_volume_to_nine_digits(shops, tmp_path):
    shop = shops("zotov-89")
    made = guide_bodies(track(shop.guide, shop.rollers, 1e-9, shop.kinks), 2, 0.06, shop.rollers)
    disc = read(write(tmp_path / "g.step", made))[0]
    assert disc.volume == pytest.approx(disc_volume(made[0], shop.guide.rho), rel=1e-9)
    assert walls_of(shop, disc)[1] <= 1e-9


def test_one_roller_has_one_track(shops, tmp_path):
    shop = shops("zotov-89", **{"guide.arrangement": "one_roller"})
    made = guide_bodies(track(shop.guide, shop.rollers, 1e-6, shop.kinks), 1, 0.06, shop.rollers)
    disc, roller = read(write(tmp_path / "g.step", made))
    assert walls_of(shop, disc)[0] == 2
    assert disc.high[2] == pytest.approx(2 * shop.rollers.width, abs=1e-9)
    assert roller.low[2] == pytest.approx(shop.rollers.width, abs=1e-9)


@pytest.mark.parametrize("name", ["nunes-hypocycloid", "nunes-slider-crank"])
def test_sized_parts_are_valid_solids_with_their_volumes(tmp_path, name):
    made = bodies(size(cases.load(name)))
    found = read(write(tmp_path / "p.step", made))
    assert [f.name for f in found] == [body.name for body in made]
    for solid, body in zip(found, made, strict=True):
        assert solid.valid and solid.volume == pytest.approx(volume(body), rel=1e-9)


def test_the_same_bodies_give_the_same_file(shops, tmp_path):
    shop = shops("zotov-89")
    made = guide_bodies(track(shop.guide, shop.rollers, 1e-5, shop.kinks), 2, 0.06, shop.rollers)
    first, again = (write(tmp_path / f"{n}.step", made).read_bytes() for n in "ab")
    assert first == again and b"/tmp" not in first


def test_the_commands_write_and_the_check_reads(tmp_path, capsys):
    file = tmp_path / "g.step"
    words = ["guide", "zotov-89", "--step", str(file), "--tolerance", "0.1 um", "--thickness", "250 mm", "--json"]
    done = CliRunner().invoke(mechsym, words)
    assert done.exit_code == 0, done.output
    assert json.loads(done.output)["written"] == [str(file)]
    assert main([str(file), "zotov-89"]) == 0
    said = capsys.readouterr().out
    assert "guide: valid" in said and "4 walls" in said
    done = CliRunner().invoke(mechsym, ["size", "nunes-slider-crank", "--step", str(tmp_path / "p.step")])
    assert done.exit_code == 0 and "p.step" in done.output and (tmp_path / "p.step").exists()
