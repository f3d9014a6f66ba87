"""Formulas of a line or two that designs stand on, by other ways."""

import numpy as np
import pytest
from codesigns import constant_load

from mechsym.hinge.balance import least_ripple, or_stopped
from mechsym.hinge.limits import _closure_check
from mechsym.hinge.springs.air import AirAbsolute
from mechsym.hinge.springs.coil import Coil
from mechsym.hinge.springs.face import affine_energy

Z = np.array([0.0, 0.2, 0.5])


def test_the_energy_of_a_spring_is_affine_in_its_setting():
    fixed, by = affine_energy(Coil(k=4e5, F0=7e3, H=1.0), Z)
    assert fixed == pytest.approx(4e5 * Z**2 / 2) and by == pytest.approx(Z)
    air = AirAbsolute(A=0.03, H=1.0, n=1.3, p0=2e5)
    fixed, by = affine_energy(air, Z)
    # a gas at p0 + pa against pa: the work of the polytrope for each pascal of p0
    assert by == pytest.approx(0.03 * ((1 - Z) ** -0.3 - 1) / 0.3)
    assert fixed + 2e5 * by == pytest.approx(air.energy(Z))


@pytest.mark.parametrize(("gap", "kept"), [(0.0, True), (0.99e-9, True), (1.01e-9, False)])
def test_a_path_closes_within_a_billionth_of_its_radius(gap, kept):
    check = _closure_check(0.6 * gap, 0.6)
    assert check.kept is kept and check.margin == pytest.approx(1 - gap / 1e-9)


def test_a_shaft_that_stops_is_worse_than_any_that_turns_and_the_worse_the_more_it_misses():
    assert or_stopped(0.3, 5.0) == 0.3
    # the ripple of a shaft that all but stops, see test_points_closed_form
    assert or_stopped(None) > 3 * constant_load(200.0, 1.001)[1]
    assert or_stopped(None, 1.9) == or_stopped(None) + 1.9


def test_a_search_that_sees_nothing_but_stops_looks_again():
    assert least_ripple(lambda share: 0.03 + abs(share - 0.9), 0.8, 1.3) == pytest.approx((0.9, 0.03), abs=2e-4)
    # an eighth of the range is all in which it turns
    narrow = lambda share: None if abs(share - 0.86) > 0.03 else 0.05 + (share - 0.86) ** 2  # noqa: E731
    assert least_ripple(narrow, 0.8, 1.3) == pytest.approx((0.86, 0.05), abs=2e-3)
    assert least_ripple(lambda share: None, 0.8, 1.3)[1] is None
