"""`mechsym eval`: the numbers that the project promises, to their printed digits."""

import json

import casadi as ca
import pytest
from click.testing import CliRunner

from mechsym.cli import mechsym
from mechsym.errors import BadInput
from mechsym.mechanisms import constraints, loops
from mechsym.mechanisms.record import Mechanism


def run(*words):
    result = CliRunner().invoke(mechsym, ["eval", *words, "--json"], catch_exceptions=False)
    assert result.exit_code == 0, result.output
    return json.loads(result.output)


def sets(**values):
    return [word for name, value in values.items() for word in ("--set", f"{name}={value}")]


def test_crosshead_at_one_radian():
    outputs = run("crosshead", "--case", "zotov-89", *sets(phi=1.0))["outputs"]
    assert f"{outputs['inertia']:.9f}" == "179.541596065"
    assert f"{outputs['dinertia_dphi']:.9f}" == "113.073677067"
    assert f"{outputs['dx_dphi']:.11f}" == "0.49692654381"


def test_crosshead_acceleration():
    given = sets(phi=1.0, phid=9.32, F=1e5, M_r=9000, M_h=-20000, g=9.81)
    assert f"{run('crosshead', '--case', 'zotov-89', *given)['acceleration'][0]:.10f}" == "86.3564288685"


def test_crankshaft_flywheel_acceleration():
    data = sets(I0=0.26, I2=0.58, r=0.06, l=0.26, m0=1.1, k1=6500)
    found = run("crankshaft_flywheel", *data, *sets(phi0=1, phi2=0.99, phi0d=50, phi2d=51, M=1.5))
    assert [f"{a:.9f}" for a in found["acceleration"]] == ["-256.786541504", "112.068965517"]


def test_lists_even_for_one_coordinate():
    found = run("hypocycloid", *sets(e="13 mm", I1=1e-3, m2=0.1, I2=1e-5, m3=0.25, alpha_n="25 deg", theta=1, F=1000))
    assert len(found["mass_matrix"]) == len(found["mass_matrix"][0]) == len(found["bias"]) == 1
    assert found["outputs"]["tooth_force"] > 0


def test_a_crank_train_from_numbers_for_all():
    numbers = sets(r=0.05, l1=0.05, l2=0.1, m_rod=0.6, m_piston=0.5, I_rod=2e-3, I0=0.01, I_f=0.3, k=5e5, phase=0)
    with pytest.raises(BadInput, match="no value for throw"):
        run("crank_train", *numbers)


def test_what_the_rank_leaves_open_is_null():
    found = run("rodless_constraints", *sets(r=0.05, I1=0.02, m_link=1, I_link=1e-3, m_a=2, m_b=2, alpha=1, F_a=-1e4))
    assert found["outputs"]["force_guide_a"] is None
    assert found["outputs"]["constraint_rank"] == 3
    assert found["outputs"]["constraint_count"] == 4


def test_an_unknown_letter_is_named():
    with pytest.raises(BadInput, match="--set phu: crosshead has no such letter; letters are phi, F"):
        run("crosshead", "--case", "zotov-89", *sets(phu=1))


def nested():
    """theta is one more than phi; with theta below phi a loop in closed form within it is open."""
    names = ["phi", "theta", "phid", "thetad"]
    letters = [ca.SX.sym(n) for n in names]
    q = ca.vertcat(*letters[:2])
    gap = ca.sqrt(q[1] - q[0]) - 1
    jacobian = ca.jacobian(gap, q)
    closing = ca.Function("constraints", letters, [gap, jacobian, ca.SX(1, 1)], names, ["gap", "jacobian", "bias"])
    return Mechanism(
        name="nested", coordinates=("phi", "theta"), inputs=(), parameters={}, functions={"constraints": closing},
        dependents={"theta": 1.2},
    )  # fmt: skip


def test_a_pose_far_from_the_guess_is_followed_from_the_start():
    assert constraints.close(nested(), {"phi": 3.0})["theta"] == pytest.approx(4.0, abs=1e-12)
    assert loops.close(nested(), {"phi": 3.0}, {"theta": 1.2}) is None  # no number comes of it


def test_a_loop_that_does_not_close_is_refused_without_a_number():
    with pytest.raises(BadInput, match="nested: the loop does not close with phi, theta given; give another pose"):
        constraints.close(nested(), {"phi": 3.0, "theta": 2.0})
