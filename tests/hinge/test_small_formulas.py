"""Formulas of a line or two that designs stand on, by other ways."""

from types import SimpleNamespace

import numpy as np
import pytest

from mechsym.hinge.limits import _closure_check
from mechsym.hinge.springs.air import AirAbsolute
from mechsym.hinge.springs.coil import Coil
from mechsym.hinge.springs.face import affine_energy
from mechsym.hinge.steady import _or_more

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


def test_where_the_crank_stops_the_missing_work_counts():
    parts = SimpleNamespace(
        inertia=np.array([3.0, 5.0]), omega=4.0, work_wanted=np.array([0.0, 70.0]), work_0=np.zeros(2),
        work_1=np.array([0.0, -3.0]),
    )  # fmt: skip
    assert _or_more(0.3, parts, 2.0) == 0.3
    # 70 + 2 * 3 by the energy of the heaviest moment, 5 * 4^2 / 2
    assert _or_more(None, parts, 2.0) == pytest.approx(10 + 76 / 40)
