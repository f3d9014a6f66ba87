"""Orders of a crank train that balance, matrices of its shaft, and its firing order."""

import ast
import itertools
import math
import re

import numpy as np
import pytest
from trains import FOUR_STROKE, in_line_six, v_eight

from mechsym.errors import BadInput
from mechsym.mechanisms import shaft
from mechsym.mechanisms.crank_train import assembly, build, build_rigid
from mechsym.mechanisms.crank_train.firing import firing_angles, refuse_wrong_firing
from mechsym.mechanisms.crank_train.parameters import CrankTrainParameters, each
from mechsym.mechanisms.state import state


def orders(values):
    return np.abs(np.fft.rfft(np.asarray(values).ravel())) / np.asarray(values).size * 2


def test_balance_of_first_and_second_order_is_the_textbooks():
    """In-line six: forces and moments vanish. Cross-plane V-8: forces vanish, a first-order couple is left."""
    phi = np.linspace(0, 2 * np.pi, 64, endpoint=False).reshape(1, -1)
    for p, couple in ((in_line_six(), 0.0), (v_eight(), 1.0)):
        assert len({round(math.degrees(a)) % 360 for a in each(p, "phase")}) == (3 if couple == 0 else 4)
        found = build_rigid(p).functions["momentum"](phi=phi, phid=100.0, phidd=0.0)
        size = 0.5 * 0.05 * 100**2
        for name in ("momentum_rate_x", "momentum_rate_y", "rocking_rate_x", "rocking_rate_y"):
            first, second = orders(found[name])[1:3]
            assert second < 1e-10 * size, name
            assert (first > 0.1 * size) if couple and name.startswith("rocking") else (first < 1e-10 * size), name


def test_shaft_matrices_have_the_right_two_disc_frequency(chmielewski):
    found = shaft.matrices("crankshaft_flywheel", chmielewski)
    squares = np.linalg.eigvals(np.linalg.solve(found.inertia, found.stiffness))
    assert math.sqrt(max(squares.real)) == pytest.approx(190.281, abs=5e-4)
    assert min(abs(squares)) < 1e-8
    extra = found.inertia_mean - found.inertia
    assert 0 < extra[0, 0] < 1.1 * 0.06**2 and abs(extra[1, 1]) < 1e-12


def test_shaft_matrices_of_the_six_are_the_springs_between_equal_throws():
    found = shaft.matrices("crank_train", in_line_six())
    assert found.coordinates[0] == "phi1" and found.coordinates[-1] == "phi_f"
    assert np.abs(found.stiffness.sum(axis=1)).max() == 0
    assert np.diag(found.inertia_mean)[:6] == pytest.approx(np.diag(found.inertia_mean)[0], rel=1e-12)
    small = np.array([1e-3, 0, 0, 0, 0, 0, 0])
    force = state(build(in_line_six()), dict(zip(found.coordinates, small, strict=True))).generalized_force
    assert force == pytest.approx(-found.stiffness @ small, rel=1e-12)


def firing_gaps(p, period):
    angles = np.sort(np.mod(each(p, "firing"), period))
    return np.diff(angles, append=angles[0] + period)


def test_firing_orders_are_even_and_meet_the_dead_centres():
    for p in (in_line_six(), v_eight()):
        gaps = firing_gaps(p, FOUR_STROKE)
        assert gaps == pytest.approx([FOUR_STROKE / len(p.throw)] * len(p.throw), rel=1e-12)
        refuse_wrong_firing(p, FOUR_STROKE)


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"l2": 0.0}, "rod too short: l1 \\+ l2 = 0.05 m"),
        ({"throw": (1, 2, 4, 4, 5, 6)}, "each at least once"),
        ({"z": (0.0, 1.0)}, "z has 2 values; give one number for all, or one a throw: 6"),
        ({"phase": (0.0,)}, "phase has 1 values; give one number for all, or one a cylinder: 6"),
        ({"sense": 0.5}, "sense = 0.5"),
        ({"m_rod": (0.6, -1.0, 0.6, 0.6, 0.6, 0.6)}, "m_rod = -1 kg"),
    ],
)
def test_impossible_trains_are_refused(wrong, message):
    with pytest.raises(BadInput, match=message):
        in_line_six(**wrong)


def test_a_cylinder_that_fires_off_its_dead_centre_is_explained():
    p = in_line_six(firing=tuple(itertools.repeat(0.0, 6)))
    with pytest.raises(BadInput, match="firing of cylinder 2 = 0 deg is 120 deg off its top dead centre") as refused:
        refuse_wrong_firing(p, FOUR_STROKE)
    offered = re.search(r"firing = (\[.*\])", str(refused.value))[1]
    angles = [math.radians(float(angle.split()[0])) for angle in ast.literal_eval(offered)]
    assert firing_gaps(in_line_six(firing=tuple(angles)), FOUR_STROKE) == pytest.approx([FOUR_STROKE / 6] * 6)
    refuse_wrong_firing(in_line_six(firing=tuple(angles)), FOUR_STROKE)
    with pytest.raises(BadInput, match="firing order"):
        firing_angles((1, 1, 2), FOUR_STROKE)


def test_functions_are_built_when_asked_for(monkeypatch):
    asked = []
    monkeypatch.setattr(assembly, "_throw", lambda group, throw=assembly._throw: asked.append(group) or throw(group))
    found = build(
        CrankTrainParameters(
            throw=(1,), phase=0.0, r=0.05, l1=0.1, l2=0.1, m_rod=1.0, m_piston=1.0, I_rod=0.01, I0=0.1, I_f=1.0, k=1e3
        )
    )
    assert "dynamics" in found.functions
    assert not asked
    assert found.functions["dynamics"] is found.functions["dynamics"]
    assert asked == ["dynamics"]
