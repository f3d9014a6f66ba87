"""The oil film of a journal against quadrature, Ocvirk's steady bearing and the energy that it takes."""

import cmath
import json
import math

import numpy as np
import pytest
from click.testing import CliRunner
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad
from scipy.optimize import brentq

from mechsym.cli import mechsym
from mechsym.forces.film import beyond, impedance, orbit, velocity
from mechsym.forces.mains import Journal, MainShaft

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
