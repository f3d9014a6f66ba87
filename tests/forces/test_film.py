"""The oil film of a journal against quadrature, Ocvirk's steady bearing and the energy that it takes."""

import cmath
import dataclasses
import json
import math

import numpy as np
import pytest
import scipy
from click.testing import CliRunner
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad
from scipy.optimize import brentq

from mechsym.cli import mechsym
from mechsym.forces.mains import (
    Journal,
    MainShaft,
    beyond,
    finite_velocity,
    impedance,
    orbit,
    rotation,
    squeeze,
    velocity,
)

SHAFT = MainShaft(journal_diameter=0.05, bearing_width=0.02, clearance=25e-6, oil_viscosity=0.01)
OMEGA, N = 300.0, 360
PHI = np.arange(N) * 2 * math.pi / N
#: mu omega R L^3 / c^2 [N]
UNIT = 0.01 * OMEGA * 0.025 * 0.02**3 / 25e-6**2


def steady(e: float) -> float:
    """Ocvirk's load of a journal that stays where it is, over `UNIT`."""
    return e / (4 * (1 - e * e) ** 2) * math.sqrt(16 * e * e + math.pi**2 * (1 - e * e))


@settings(max_examples=40, deadline=None)
@given(st.floats(0, 0.95), st.floats(-math.pi, math.pi))
def test_impedance_by_quadrature(e: float, a: float) -> None:
    def pressed(psi: float, part: float) -> float:
        return math.cos(psi - a) * math.cos(psi - part) / (1 - e * math.cos(psi)) ** 3

    low, high = a - math.pi / 2, a + math.pi / 2
    thin = [at for at in (-2 * math.pi, 0.0, 2 * math.pi) if low < at < high]
    along, across = (
        quad(pressed, low, high, args=(part,), epsabs=1e-11, epsrel=1e-11, points=thin or None, limit=400)[0]
        for part in (0.0, math.pi / 2)
    )
    assert impedance(e, a) == pytest.approx(complex(along, across), rel=1e-9, abs=1e-9 * abs(complex(along, across)))


@settings(max_examples=60, deadline=None)
@given(st.floats(0, 0.97), st.floats(-math.pi, math.pi), st.floats(-math.pi, math.pi), st.floats(0.01, 100))
def test_velocity_gives_the_load_back(e: float, at: float, towards: float, size: float) -> None:
    eccentricity, load = cmath.rect(e, at), cmath.rect(size, towards)
    v = velocity(eccentricity, load)
    turned = cmath.rect(1.0, at) if e else 1.0
    seen = v / turned
    back = abs(seen) * impedance(e, cmath.phase(seen)) * turned
    assert back == pytest.approx(load, rel=1e-9)
    assert (v * load.conjugate()).real > 0  # a film takes energy


@pytest.mark.parametrize("sense", [1.0, -1.0])
@pytest.mark.parametrize("e", [0.2, 0.6, 0.85])
def test_a_steady_load_rests_where_ocvirk_says(e: float, sense: float) -> None:
    journal = Journal(z=0.0, sense=sense, x=np.full(N, steady(e) * UNIT), y=np.zeros(N))
    found = orbit(journal, SHAFT, OMEGA, PHI, 2 * math.pi)
    assert found.settled
    assert np.abs(found.eccentricity) == pytest.approx(np.full(N, e), abs=1e-4)
    # the attitude angle stands ahead of the load in the sense of rotation
    attitude = math.atan(math.pi * math.sqrt(1 - e * e) / (4 * e))
    assert np.angle(found.eccentricity) == pytest.approx(np.full(N, sense * attitude), abs=2e-4)
    assert found.thinnest == pytest.approx(25e-6 * (1 - e), rel=1e-3)


def test_a_load_that_turns_with_the_shaft() -> None:
    """Seen from the load the bearing turns, and half the speed difference is the same the other way round."""
    e = 0.6
    load = steady(e) * UNIT * np.exp(1j * PHI)
    found = orbit(Journal(z=0.0, sense=1.0, x=load.real, y=load.imag), SHAFT, OMEGA, PHI, 2 * math.pi)
    assert np.abs(found.eccentricity) == pytest.approx(np.full(N, e), abs=3e-4)
    assert np.angle(found.eccentricity * np.exp(-1j * PHI)).max() < 0


def test_power_of_a_steady_bearing() -> None:
    """Shear of a full film, and what the load does on the turning squeeze: W e sin(attitude) omega/2."""
    e = brentq(lambda one: steady(one) * UNIT - 2000.0, 0.01, 0.99)
    found = orbit(Journal(z=0.0, sense=1.0, x=np.full(N, 2000.0), y=np.zeros(N)), SHAFT, OMEGA, PHI, 2 * math.pi)
    attitude = math.atan(math.pi * math.sqrt(1 - e * e) / (4 * e))
    shear = 2 * math.pi * 0.01 * OMEGA**2 * 0.025**3 * 0.02 / 25e-6 / math.sqrt(1 - e * e)
    turned = 2000.0 * e * 25e-6 * math.sin(attitude) * OMEGA / 2
    assert found.power == pytest.approx(shear + turned, rel=1e-3)


def test_where_a_short_bearing_ends() -> None:
    journal = Journal(z=0.0, sense=1.0, x=np.full(N, steady(0.9) * UNIT), y=np.zeros(N))
    found = orbit(journal, SHAFT, OMEGA, PHI, 2 * math.pi)
    assert "eccentricity of 0.9" in beyond(SHAFT, found)
    wide = MainShaft(journal_diameter=0.05, bearing_width=0.04, clearance=25e-6, oil_viscosity=0.01)
    assert "0.8 diameters" in beyond(wide, found)


@pytest.mark.slow
def test_command(tmp_path: object, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(str(tmp_path))
    new = ["new", "engine", "three", "--kind", "inline", "--bore", "74 mm", "--stroke", "75 mm", "--cylinders", "3"]
    assert CliRunner().invoke(mechsym, new, catch_exceptions=False).exit_code == 0
    oil = {"journal_diameter": "44 mm", "bearing_width": "20 mm", "clearance": "25 um", "oil_viscosity": "0.01 Pa*s"}
    options = [word for key, value in oil.items() for word in ("--set", f"shaft.{key}={value}")]
    done = CliRunner().invoke(mechsym, ["forces", "three.toml", *options, "--json"], catch_exceptions=False)
    rows = json.loads(done.output)["journals"]
    assert len(rows) == 4
    assert all(0 < row["film_min"] < 25e-6 and 0 < row["eccentricity_max"] < 1 for row in rows)
    # firing 1-3-2 is the same from both ends
    assert rows[0]["film_min"] == pytest.approx(rows[3]["film_min"], rel=1e-3)


def reynolds(e: float, width: float, squeezed: bool, around: int = 240, along: int = 12) -> complex:
    """Sommerfeld number and angle of a full bearing, by differences over half its width: pressures and their residuals
    both are at least 0, and one of them is. Along the line of centres from the widest gap, and across it."""
    at, step = np.arange(around) * 2 * math.pi / around, 2 * math.pi / around
    ahead = (1 + e * np.cos(at + step / 2)) ** 3 / step**2
    behind, here = np.roll(ahead, 1), np.arange(around)
    places = np.r_[here, here, here], np.r_[here, (here + 1) % around, (here - 1) % around]
    turning = scipy.sparse.csr_matrix((np.r_[ahead + behind, -ahead, -behind], places))
    main = np.r_[1.0, np.full(along - 2, 2.0), 3.0]  # mirrored in the middle, 0 at the end
    across = scipy.sparse.diags([main, -np.ones(along - 1), -np.ones(along - 1)], [0, 1, -1])
    sides = scipy.sparse.diags((1 + e * np.cos(at)) ** 3 * (along / width) ** 2)
    matrix = (scipy.sparse.kron(turning, scipy.sparse.eye(along)) + scipy.sparse.kron(sides, across)).tocsr()
    right = np.repeat(-12 * np.cos(at) if squeezed else 6 * e * np.sin(at), along)
    free = np.ones(len(right), dtype=bool)
    for _ in range(60):
        p = np.zeros(len(right))
        p[free] = scipy.sparse.linalg.spsolve(matrix[free][:, free].tocsc(), right[free])
        now = np.where(free, p >= 0, matrix @ p < right)
        if (now == free).all():
            break
        free = now
    rows = p.reshape(around, along).sum(axis=1) * step / along / 2
    return complex(rows @ np.cos(at), rows @ np.sin(at))


@pytest.mark.slow
@pytest.mark.parametrize("width", [0.25, 0.5, 1.0])
@pytest.mark.parametrize("e", [0.3, 0.6, 0.9])
def test_the_fits_of_a_finite_bearing(e: float, width: float) -> None:
    so, attitude = rotation(e, width)
    load = reynolds(e, width, squeezed=False)
    assert e * so == pytest.approx(abs(load), rel=0.07)
    assert attitude == pytest.approx(math.atan2(load.imag, -load.real), abs=math.radians(5))
    assert squeeze(e, width) == pytest.approx(abs(reynolds(e, width, squeezed=True)), rel=0.06)


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_a_steady_load_rests_where_the_fits_say(sense: float) -> None:
    shaft = dataclasses.replace(SHAFT, film="finite", bearing_width=0.03)
    e, width = 0.7, 0.6
    so, attitude = rotation(e, width)
    load = e * so * 0.03 * 0.05 * 0.01 * OMEGA * (0.025 / 25e-6) ** 2
    found = orbit(Journal(z=0.0, sense=sense, x=np.full(N, load), y=np.zeros(N)), shaft, OMEGA, PHI, 2 * math.pi)
    assert found.settled and beyond(shaft, found) == ""
    assert np.abs(found.eccentricity) == pytest.approx(np.full(N, e), abs=1e-4)
    assert np.angle(found.eccentricity) == pytest.approx(np.full(N, sense * attitude), abs=2e-4)


@given(st.floats(0, 0.95), st.floats(-math.pi, math.pi), st.floats(0.25, 1))
def test_a_finite_film_gives_the_load_back(e: float, towards: float, width: float) -> None:
    load = cmath.rect(1.0, towards)
    v = finite_velocity(complex(e, 0), load, width)
    so, attitude = rotation(e, width)
    turning = 2 * abs(v.imag) * so * cmath.rect(1.0, math.copysign(attitude, v.imag))
    back = turning + squeeze(math.copysign(e, v.real), width) * v.real
    assert back == pytest.approx(2 * width**2 * load, rel=1e-9)
