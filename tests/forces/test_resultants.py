"""Gears that close after several turns: orders between whole ones, and resultants of joints, by closed forms."""

import json

import numpy as np
import pytest
from click.testing import CliRunner

from mechsym import cases
from mechsym.cli import mechsym
from mechsym.forces.balance import amplitudes
from mechsym.forces.plots import balance_orders
from mechsym.forces.result import angle_of_largest
from mechsym.jobs.forces import balance, forces
from mechsym.mechanisms.roles import resultants

SUN, PLANET, MASS, BRAKE, SPEED_RPM = 0.03, 0.02, 0.4, 20.0, 1500.0
DECLARATION = """
from mechsym.derive import Mechanism

def epicyclic():
    m = Mechanism("epicyclic", about="A sun, a planet, a ring that is held.")
    phi = m.coordinates("phi")
    sun = m.link("sun", turns=phi, inertia="1e-3 kg*m^2")
    carrier, planet = m.link("carrier", inertia="5e-3 kg*m^2"), m.link("planet", mass="0.4 kg", inertia="2e-4 kg*m^2")
    m.pin("O", m.frame, sun)
    m.pin("Q", m.frame, carrier)
    m.pin("P", carrier.at("50 mm"), planet)
    m.gear("inner", sun, planet, radii=("30 mm", "20 mm"))
    m.gear("outer", planet, m.frame, radii=("20 mm", "70 mm"), inside=True)
    m.torque(m.inputs("T_s", "N*m"), along=phi)
    m.torque(m.inputs("T_c", "N*m"), along=carrier.angle)
    return m
"""
CASE = 'mechanism = "./epicyclic.py"\n[inputs]\nT_c = "-20 N*m"\n[operation]\nspeed = "1500 rpm"\n'
# Willis: the carrier turns by s/(s + r) of the sun, r = s + 2 p the ring that is held
RATIO = SUN / (2 * SUN + 2 * PLANET)
ARM, OMEGA = SUN + PLANET, SPEED_RPM * np.pi / 30
CENTRIFUGAL = MASS * ARM * (RATIO * OMEGA) ** 2


@pytest.fixture(scope="module")
def train(tmp_path_factory):
    folder = tmp_path_factory.mktemp("epicyclic")
    (folder / "epicyclic.py").write_text(DECLARATION)
    (folder / "case.toml").write_text(CASE)
    return folder / "case.toml"


def test_a_planet_shakes_the_frame_as_fast_as_its_carrier_turns(train):
    one = balance(cases.load(str(train)), weights="none")
    least = one.before.rounding * one.turn.omega**2
    left = {order: size for order, size in amplitudes(one.before.force, one.turn, least).items() if size}
    assert left == {RATIO: pytest.approx(CENTRIFUGAL, rel=1e-9)}
    text = CliRunner().invoke(mechsym, ["balance", str(train)]).stdout
    assert f"largest left: force of order 0.3, {CENTRIFUGAL:.4g} N" in text and "nothing is left" not in text


def test_the_picture_of_balance_has_that_order(train):
    one = balance(cases.load(str(train)), weights="none")
    (axis,) = balance_orders(one).axes
    tall = [bar for bar in axis.patches if bar.get_height() > 0.5 * CENTRIFUGAL]
    assert len(tall) == 2 and all(abs(bar.get_x() + bar.get_width() / 2 - RATIO) < 0.3 for bar in tall)


def test_joints_bear_what_their_resultants_say(train):
    result = forces(cases.load(str(train)))
    tooth = BRAKE / (2 * ARM)  # two equal tooth forces hold the planet, and the torque of the carrier
    for name, size in (("R_O", tooth), *((name, np.hypot(2 * tooth, CENTRIFUGAL)) for name in ("R_P", "R_Q"))):
        assert result.columns[name] == pytest.approx(np.full(result.turn.phi.shape, size), rel=1e-9)
        assert result.columns.units[name] == "N"
        assert angle_of_largest(result.turn.phi, result.columns[name]) == 0.0  # what is constant but for rounding
    rows = json.loads(CliRunner().invoke(mechsym, ["size", str(train), "--json"]).stdout)
    borne = {row["component"]: row["value"] for row in rows if row["quantity"] == "load, largest"}
    assert borne["R_P"] == pytest.approx(np.hypot(2 * tooth, CENTRIFUGAL), rel=1e-9)


def test_a_train_without_swing_says_so(train, tmp_path):
    def said(*words):
        return CliRunner().invoke(mechsym, [*words, str(train)], catch_exceptions=False).stdout

    assert "work that swings 0 J" in said("flywheel") and "ripple below 1e-07 %" in said("flywheel")
    said("forces", "--out", str(tmp_path))
    page = (tmp_path / "report.html").read_text()
    assert "the torque swings in none" in page and "top dead centre" not in page
    assert "torque from outside [N m]" in page and "force from outside" not in page


def test_a_resultant_needs_two_components():
    names = ["R_x_A", "R_y_A", "R_n_G", "M_x_H", "M_y_H", "M_z_H", "M_K", "pin_force_x_2", "pin_force_y_2", "R_x_alone"]
    assert resultants(names) == {
        "R_A": ["R_x_A", "R_y_A"],
        "M_H": ["M_x_H", "M_y_H", "M_z_H"],
        "pin_force_2": ["pin_force_x_2", "pin_force_y_2"],
    }


def test_half_orders_of_the_roll_of_a_four_stroke_are_told():
    one = balance(cases.load("generator"), weights="none")
    told = amplitudes(one.before.roll, one.turn)
    assert list(told) == [k / 2 for k in range(1, 25)]
    series = 2 * np.abs(np.fft.rfft(one.before.roll)) / len(one.before.roll)  # over two turns
    assert [told[k / 2] for k in range(1, 25)] == pytest.approx(series[1:25], rel=1e-9)


def test_gears_of_any_teeth_close_after_as_many_turns(tmp_path):
    """8 and 18 teeth: the carrier turns by 8/52 of the sun, 2/13, so that all is as before after 13 turns."""
    text = DECLARATION.replace('radii=("30 mm", "20 mm")', 'radii=("8 mm", "18 mm")').replace("50 mm", "26 mm")
    (tmp_path / "epicyclic.py").write_text(text.replace('radii=("20 mm", "70 mm")', 'radii=("18 mm", "44 mm")'))
    (tmp_path / "case.toml").write_text(CASE)
    one = balance(cases.load(str(tmp_path / "case.toml")), weights="none")
    assert one.turn.period == pytest.approx(13 * 2 * np.pi)
    (order,) = (k for k, size in amplitudes(one.before.force, one.turn, 1e-9).items() if size)
    assert order == pytest.approx(8 / 52)
    told = json.loads(CliRunner().invoke(mechsym, ["balance", str(tmp_path / "case.toml"), "--json"]).stdout)
    assert "0.153846" in told["before"]["force"]
