"""The crosshead drive's rules against hand calculations, limits and the numerical squeeze film."""

import dataclasses
import json
import math

import numpy as np
import pytest
from click.testing import CliRunner
from hypothesis import given
from hypothesis import strategies as st
from scipy import sparse
from scipy.integrate import solve_ivp
from scipy.sparse.linalg import spsolve

from mechsym.cli import mechsym
from mechsym.errors import BadInput
from mechsym.sizing.rules.crankshaft import rectangle_stress, specific_pressure, squeeze_time, wear_index
from mechsym.sizing.slider_crank import CrossheadLoads, CrossheadPart, checks, wear

PART = CrossheadPart(
    pin_diameter=0.22, pin_length=0.3, crank_pin_diameter=0.22, crank_pin_length=0.2, shoe_width=0.25, shoe_length=0.4,
    rod_diameter=0.12, rod_length=1.2, web_width=0.4, web_thickness=0.14, web_arm=0.12,
)  # fmt: skip
PHI = np.linspace(0, 2 * math.pi, 1441)


def loads(**changed):
    thrust = 2e5 + 3e5 * np.cos(PHI / 2) ** 8
    base = {"phi": PHI, "omega": 10.0, "rod": thrust, "pin": thrust, "crank_pin": thrust, "side": 4e4 * np.sin(PHI),
            "dx_dphi": 0.5 * np.sin(PHI), "dpsi_dphi": 0.32 * np.cos(PHI)}  # fmt: skip
    return CrossheadLoads(**(base | changed))


def rectangle(length, width, n=120):
    """Integral of u over a rectangle where u_xx + u_yy = -1, u = 0 at the rim, by differences of second order."""
    one = [sparse.diags([1.0, -2.0, 1.0], [-1, 0, 1], (n - 1, n - 1)) / (size / n) ** 2 for size in (length, width)]
    unit = sparse.identity(n - 1)
    u = spsolve((sparse.kron(one[0], unit) + sparse.kron(unit, one[1])).tocsc(), -np.ones((n - 1) ** 2))
    return float(u.sum()) * length * width / n**2


@pytest.mark.parametrize("length", [0.1, 0.2, 0.3])
def test_squeeze_time_is_what_reynolds_equation_integrates_to(length):
    # F = 12 mu (-h')/h^3 I, with the integral I of the rectangle
    F, d, arc, mu = 4e5, 0.2, 2.0, 0.03
    t = squeeze_time(F, length, d, arc, mu, 50e-6, 5e-6)
    share = 12 * mu * rectangle(length, d * arc / 2)
    film = solve_ivp(lambda _, h: -F * h**3 / share, (0, t), [50e-6], rtol=1e-10, atol=1e-14).y[0, -1]
    assert film == pytest.approx(5e-6, rel=3e-4)


def test_long_and_square_films():
    def time(length):
        return squeeze_time(1e5 * length, length, 0.2, 2.0, 0.03, 50e-6, 5e-6)

    long = 0.03 * 0.2**3 / 2e5 * (1 / 5e-6**2 - 1 / 50e-6**2)
    assert time(200.0) == pytest.approx(long, rel=1e-3)
    assert time(0.2) / long == pytest.approx(0.4217, abs=1e-4)  # of a square plate, in every textbook


def test_web_stress_is_the_sum_of_bending_and_pressure():
    assert rectangle_stress(0.0, 1e5, 0.4, 0.1) == pytest.approx(1e5 / 0.04)
    section = 0.4 * 0.1**2 / 6
    assert rectangle_stress(2e4, 0.0, 0.4, 0.1) == pytest.approx(2e4 / section)


@given(st.floats(1e3, 1e7), st.floats(0.01, 1), st.floats(0.01, 1), st.floats(0.1, 10))
def test_pressure_scales_with_load_and_area(F, length, width, k):
    assert specific_pressure(k * F, length, width) == pytest.approx(k * specific_pressure(F, length, width))
    assert specific_pressure(F, k * length, width) == pytest.approx(specific_pressure(F, length, width) / k)


def test_wear_of_a_harmonic_pair_has_a_closed_form():
    # p = P |sin|, v = V |sin|: the mean is P V / 2
    assert wear_index(3.0 * np.sin(PHI), 2.0 * np.sin(PHI), PHI) == pytest.approx(3.0, rel=1e-6)


def test_factors_follow_the_sizes():
    found = {(c.component, c.quantity): c for c in checks(PART, loads())}
    assert found["crosshead pin", "specific pressure"].value == pytest.approx(5e5 / (0.3 * 0.22), rel=1e-6)
    assert found["guide shoe", "specific pressure"].safety_factor == pytest.approx(0.6e6 * 0.1 / 4e4, rel=1e-5)
    stout = dataclasses.replace(PART, rod_diameter=0.24, web_thickness=0.28, pin_diameter=0.44, crank_pin_length=0.4,
                                shoe_length=0.8)  # fmt: skip
    for before, after in zip(checks(PART, loads()), checks(stout, loads()), strict=True):
        assert after.safety_factor > before.safety_factor
    slow = {(c.component, c.quantity): c for c in checks(PART, loads(omega=5.0))}
    film = ("crosshead pin", "time of the squeezed film")
    assert slow[film].safety_factor == pytest.approx(found[film].safety_factor / 2)


def test_wear_grows_with_speed_and_is_nothing_where_nothing_slides():
    fast, slow = wear(PART, loads(omega=20.0)), wear(PART, loads())
    for name, value in slow.items():
        assert fast[name] == pytest.approx(2 * value)
    assert wear(PART, loads(dx_dphi=0 * PHI))["guide shoe"] == 0


def test_bad_sizes_are_refused():
    with pytest.raises(BadInput, match="film h_2"):
        squeeze_time(1e5, 0.3, 0.2, 2.0, 0.03, 5e-6, 6e-6)
    with pytest.raises(BadInput, match="width"):
        specific_pressure(1e5, 0.3, 0.0)


def test_command_on_the_marine_engine():
    sizes = {name: f"{getattr(PART, name)}" for name in (
        "pin_diameter", "pin_length", "crank_pin_diameter", "crank_pin_length", "shoe_width", "shoe_length",
        "rod_diameter", "rod_length", "web_width", "web_thickness", "web_arm")}  # fmt: skip
    options = [text for name, value in sizes.items() for text in ("--set", f"part_crosshead.{name}={value}")]
    found = CliRunner().invoke(mechsym, ["size", "zotov-89", "--as-printed", "--json", *options])
    rows = {(row["component"], row["quantity"]): row for row in json.loads(found.stdout)}
    pin = rows["crosshead pin", "specific pressure"]
    assert pin["value"] == pytest.approx(7.46e6, rel=0.01)  # 492 kN on 0.3 m x 0.22 m
    assert rows["piston rod", "buckling load"]["safety_factor"] > 4
    assert rows["guide shoe", "pressure times sliding speed"]["value"] > 0
    assert found.exit_code == (1 if any(row["holds"] is False for row in rows.values()) else 0)


def test_the_marine_case_names_its_drive_and_holds_its_rules():
    found = CliRunner().invoke(mechsym, ["size", "moroianu", "--json"])
    rows = json.loads(found.stdout)
    assert found.exit_code == 0 and {row["holds"] for row in rows if row["limit"]} == {True}
    assert {row["component"] for row in rows} >= {"crosshead pin", "crank pin", "guide shoe", "piston rod", "crank web"}
