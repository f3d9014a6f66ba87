"""The crank trains among the built-in cases: alpha-Stirling and opposed pistons, and what they promise."""

import dataclasses
import json
import math

import numpy as np
import pytest
from click.testing import CliRunner

from mechsym import cases
from mechsym.cli import mechsym
from mechsym.errors import BadInput
from mechsym.jobs.machine import turn
from mechsym.mechanisms import crankshaft_flywheel, shaft
from mechsym.mechanisms.crank_train import build, build_rigid
from mechsym.mechanisms.crankshaft_flywheel import CrankshaftFlywheelParameters
from mechsym.mechanisms.state import state


def parameters(name):
    return cases.load(name).need("parameters")


def test_one_piston_of_the_stirling_engine_is_the_sources_machine(chmielewski):
    """Without the second piston the crank train is the crankshaft_flywheel, whose M drives where F of a piston does."""
    stirling = parameters("alpha-stirling")
    one = dataclasses.replace(stirling, throw=(1,), phase=0.0, c=0.0)  # the source has no damper
    here = state(build(one), {"phi1": 1.0, "phi_f": 0.99, "phi1d": 50.0, "phi_fd": 51.0, "F1": 300.0})
    source = CrankshaftFlywheelParameters(
        **{f.name: getattr(chmielewski, f.name) for f in dataclasses.fields(chmielewski)}
    )
    there = state(
        crankshaft_flywheel.build(source), {"phi0": 1.0, "phi2": 0.99, "phi0d": 50.0, "phi2d": 51.0, "F": 300.0}
    )
    assert here.acceleration == pytest.approx(there.acceleration, rel=1e-12)


def test_two_pistons_in_quadrature_have_almost_constant_inertia():
    one, two = (dataclasses.replace(parameters("alpha-stirling"), **c) for c in ({"throw": (1,), "phase": 0.0}, {}))
    phi = np.linspace(0, 2 * np.pi, 400, endpoint=False).reshape(1, -1)

    def second_order(p):
        dynamics = build_rigid(p).functions["dynamics"]
        given = {n: 0.0 for n in dynamics.name_in()} | {"phi": phi}
        inertia = np.asarray(dynamics(**given)["mass_matrix"]).ravel()
        return abs(np.fft.rfft(inertia)[2]) / inertia.size

    # 2 phi of one and 2 (phi + pi/2) of the other cancel
    assert second_order(two) < 1e-12
    assert second_order(one) > 1e-4


def test_the_hot_piston_leads_and_the_engine_gives_work():
    case = cases.load("alpha-stirling")
    forward = turn(case)
    assert forward.torque.mean() > 0
    p = case.need("parameters")
    turned = dataclasses.replace(p, phase=p.phase[::-1])
    backward = turn(dataclasses.replace(case, sections={**case.sections, "parameters": turned}))
    assert backward.torque.mean() == pytest.approx(-forward.torque.mean(), rel=1e-9)


def test_opposed_pistons_shake_nothing():
    p = parameters("opposed-pistons")
    phi = np.linspace(0, 6, 50).reshape(1, -1)
    found = build_rigid(p).functions["momentum"](phi=phi, phid=200.0, phidd=0.0)
    size = 0.9 * 0.04 * 200**2
    assert max(np.abs(np.asarray(found[f"momentum_rate_{a}"])).max() for a in "xy") < 1e-10 * size
    # cranks that turn against each other balance along the cylinder only
    against = build_rigid(dataclasses.replace(p, sense=(1.0, -1.0))).functions["momentum"](
        phi=phi, phid=200.0, phidd=0.0
    )
    assert np.abs(np.asarray(against["momentum_rate_x"])).max() < 1e-10 * size
    assert np.abs(np.asarray(against["momentum_rate_y"])).max() > 0.1 * size


def test_opposed_cranks_share_the_gas_torque():
    case = cases.load("opposed-pistons")
    found = turn(case)
    assert found.reactions["shaft_torque_2"] == pytest.approx(2 * found.reactions["shaft_torque_1"], abs=1e-9 * 800)
    assert found.torque.mean() == pytest.approx(found.gas_power.mean() / found.omega, rel=1e-9)


def test_a_leading_exhaust_crank_is_allowed_a_wrong_one_is_explained():
    case = cases.load("opposed-pistons")
    p = case.need("parameters")

    def with_phase(degrees):
        changed = dataclasses.replace(p, phase=(0.0, math.radians(180 + degrees)))
        return turn(dataclasses.replace(case, sections={**case.sections, "parameters": changed}))

    assert with_phase(10).torque.mean() > 0
    with pytest.raises(BadInput, match="firing of cylinder 2 = 0 deg is 90 deg off its top dead centre"):
        with_phase(90)


def test_eval_reads_a_crank_train_case():
    words = ["eval", "crank_train", "--case", "opposed-pistons", "--set", "phi1=0.3", "--set", "F1=1000", "--json"]
    result = CliRunner().invoke(mechsym, words, catch_exceptions=False)
    found = json.loads(result.output)
    assert result.exit_code == 0
    assert len(found["acceleration"]) == 3
    assert found["outputs"]["shaft_torque_1"] == pytest.approx(0.3 * 2e5)


def test_torsion_matrices_of_the_cases_are_those_of_the_data():
    found = shaft.matrices("crank_train", parameters("alpha-stirling"))
    assert math.sqrt(max(np.linalg.eigvals(np.linalg.solve(found.inertia, found.stiffness)).real)) == pytest.approx(
        190.281, abs=5e-4
    )
