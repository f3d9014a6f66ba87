"""Worked examples of textbooks, reproduced within their printed digits."""

import numpy as np
import pytest

from mechsym.sizing.rules import bearings, gears, turning_shaft

LBF, INCH, PSI, HP, FPM = 4.4482216, 0.0254, 6894.757, 745.69987, 0.00508


class TestShigley144:
    """Budynas and Nisbett, Shigley's Mechanical Engineering Design, example 14-4: 17/52 teeth, 10 teeth/in, 4 hp."""

    d, b, m = 1.7 * INCH, 1.5 * INCH, INCH / 10
    speed = np.pi * 1.7 / 12 * 1800 * FPM
    load = 4 * HP / speed

    def factors(self, size):
        align = gears.mesh_alignment_factor(self.b, "commercial")
        assert align == pytest.approx(0.15, abs=0.005)
        return gears.LoadFactors(
            K_v=float(gears.dynamic_factor(self.speed, 11.0)),
            K_s=size,
            K_m=gears.load_distribution_factor(self.b, self.d, 1.0, "commercial"),
        )

    def test_load_and_factors(self):
        assert self.load / LBF == pytest.approx(164.8, abs=0.05)
        found = self.factors(1.043)
        assert found.K_v == pytest.approx(1.377, abs=1e-3)  # AGMA prints the exponent as 0.667, he takes 2/3
        assert round(found.K_m, 2) == 1.22
        assert round(gears.reliability_factor(0.9), 2) == pytest.approx(0.83, abs=0.03)  # he rounds it to 0.85

    @pytest.mark.parametrize(("size", "J", "stress", "cycles", "strength", "factor"), [
        (1.043, 0.30, 6417, 1e8, 31350, 5.62), (1.052, 0.40, 4854, 1e8 * 17 / 52, 28260, 6.82),
    ])  # fmt: skip
    def test_bending(self, size, J, stress, cycles, strength, factor):
        found = gears.face_width_bending(self.load, self.m, J, 1.0, self.factors(size)) / self.b
        assert found / PSI == pytest.approx(stress, rel=1.5e-3)  # he rounds every factor to four digits
        limit = gears.bending_limit(strength, gears.life_factor_bending(cycles, "250 HB"), K_R=0.85)
        assert limit / (found / PSI) == pytest.approx(factor, abs=0.02)

    def test_wear(self):
        Z_E = 2300 * PSI**0.5
        widths = (gears.face_width_contact(self.load, self.d, 0.121, Z_E, 1.0, self.factors(s)) for s in (1.043, 1.052))
        pinion, gear = (np.sqrt(width / self.b) for width in widths)
        assert pinion / PSI == pytest.approx(70360, rel=1.5e-3)
        assert gear / PSI == pytest.approx(70660, rel=1.5e-3)
        limit = gears.contact_limit(106400, gears.life_factor_contact(1e8, "steel"), K_R=0.85)
        assert limit == pytest.approx(118667, rel=1e-3)

    def test_exact_factor_chain_gives_the_printed_stress(self):
        """With his own rounded factors the formula gives his stress to all four printed digits."""
        rounded = gears.LoadFactors(K_v=1.377, K_s=1.043, K_m=1.22)
        found = gears.face_width_bending(164.8 * LBF, self.m, 0.30, 1.0, rounded) / self.b / PSI
        assert round(found) == 6417


def test_elastic_coefficient_of_steel_on_steel():
    """Shigley, table 14-8: 2300 psi^0.5 and 191 MPa^0.5 for steel."""
    assert gears.elastic_coefficient(2e11, 0.3, 2e11, 0.3) / 1e3 == pytest.approx(187, abs=0.5)
    assert gears.elastic_coefficient(30e6, 0.3, 30e6, 0.3) == pytest.approx(2291, abs=0.5)


@pytest.mark.parametrize(("load", "hours", "rpm", "kind", "rating"), [
    (10.279, 50000, 480, "roller", 91.1),  # Shigley, 8th ed., solution of problem 11-3
    (13.92, 40000, 520, "roller", 118.2),  # 10th ed., problem 11-3 without its reliability factor
])  # fmt: skip
def test_bearing_rating_for_a_wanted_life(load, hours, rpm, kind, rating):
    revolutions = hours * 60 * rpm
    assert bearings.required_rating(load, revolutions, kind) == pytest.approx(rating, abs=0.06)
    omega = rpm * np.pi / 30
    found = bearings.life_hours(bearings.life_revolutions(rating, load, kind), omega)
    assert found == pytest.approx(hours, rel=2e-3)


def test_equivalent_load_of_a_sinusoid():
    """Closed form: mean of |sin|^3 over a turn is 4/(3 pi)."""
    F = 1000 * np.sin(np.arange(20000) * 2 * np.pi / 20000)
    assert bearings.equivalent_load(F, "ball") == pytest.approx(1000 * (4 / (3 * np.pi)) ** (1 / 3), rel=1e-7)


def test_shaft_after_goodman():
    """Shigley, 8th ed., problem 7-1 (d): 1.073 in."""
    d = turning_shaft.shaft_diameter_goodman((600, 500, 400, 300), 30e3, 100e3, 2.0, K_f=2.2, K_fs=1.8)
    assert round(float(d), 3) == 1.073


def test_marin_factors():
    """Shigley, 8th ed., problem 7-2, first trial: 1226 MPa, 22 mm, machined: 375 MPa."""
    assert turning_shaft.endurance_limit(1226e6, 0.022, "machined") / 1e6 == pytest.approx(375, abs=0.5)
