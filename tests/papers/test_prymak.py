"""Prymak (undated): claims on rodless engines that need forces over a turn. Formulas and text: the audit."""

import dataclasses
import math

import numpy as np
import pytest
from small_machines import machine, smooth_gas, turn_of

from mechsym.forces.loads import loads
from mechsym.mechanisms.closing import RodlessFaces
from mechsym.mechanisms.rodless import CrankFreeRadially, RodlessParameters, Stiffnesses
from mechsym.papers.sources import sources

M = 1.1  # reciprocating mass of a rod journal; two journals on each axis
LINK = RodlessParameters(r=0.03, I1=0.1, u1=0.0, m_link=0.7, I_link=1e-3, m_a=2 * M, m_b=2 * M)
FACES = RodlessFaces(
    sides=("a+", "b+", "a-", "b-"), areas=(0.01,) * 4, firing=(0.0, math.pi / 2, math.pi, 3 * math.pi / 2)
)
RULES = (CrankFreeRadially(), Stiffnesses(k_a=2e8, k_b=2e8, k_c=1e8))


def rodless(parameters=LINK, rule=RULES[0], speed=300.0):
    return turn_of(machine("rodless", parameters, speed, closing=rule, faces=FACES), smooth_gas(0.12, bore=0.1128))


def test_eqs_4_and_5_the_resultant_is_4_m_r_omega_squared_and_turns_with_the_crank():
    one = rodless(dataclasses.replace(LINK, m_link=0.0))
    force = -(one.momentum["momentum_rate_x"] + 1j * one.momentum["momentum_rate_y"])
    assert np.abs(force) == pytest.approx(np.full(720, 4 * M * 0.03 * one.omega**2), rel=1e-12)
    assert np.abs(np.angle(force * np.exp(-1j * one.phi))).max() < 1e-12
    # conclusion 3, "always along the rod": it is along rod a at its dead centres only
    assert np.abs(force.imag).max() == pytest.approx(np.abs(force).max(), rel=1e-12)


def test_the_link_adds_its_share():
    one = rodless()
    force = np.hypot(one.momentum["momentum_rate_x"], one.momentum["momentum_rate_y"])
    assert force == pytest.approx(np.full(720, (4 * M + 0.7) * 0.03 * one.omega**2), rel=1e-12)


@pytest.mark.parametrize("rule", RULES)
def test_eq_1_load_of_a_rod_journal(rule):
    one = rodless(rule=rule)
    for axis in "ab":
        x_dd = one.kinematics[f"d2x_{axis}_dalpha2"] * one.omega**2
        P = one.inputs[f"F_{axis}"] - 2 * M * x_dd  # gas and inertia, outwards
        X = one.reactions[f"X_{axis}"]
        journal = np.hypot(one.reactions[f"journal_force_{axis}_along"], one.reactions[f"journal_force_{axis}_across"])
        assert journal == pytest.approx(np.hypot(P, X), rel=1e-10, abs=1e-6)


def test_conclusion_2_the_side_force_goes_from_the_pistons_to_the_guides():
    """No piston is pressed on its cylinder, but the two guides together carry what a slider crank's pistons do not."""
    for rule in RULES:
        one = rodless(rule=rule)
        found = loads(one)
        roll = -2 * LINK.r * one.reactions["guide_combination"]
        # the frame must take the torque: some guide force is there whatever the closing rule
        assert roll == pytest.approx(-one.torque, rel=1e-9, abs=1e-6)
        assert (
            max(np.abs(found.guides[f"side_force_{axis}"]).max() for axis in "ab")
            > 0.1 * np.abs(one.inputs["F_a"]).max()
        )


def test_the_reason_for_another_scheme_has_a_number_and_the_scheme_has_none():
    (source,) = sources("prymak")
    said = {r["item"]: r for r in source.rows() if r["item"].startswith("introduction")}
    (force,) = (r for item, r in said.items() if "10 um" in item)
    # crank and guides in series: 1e8 N/m and, in any position, 2e8 N/m
    assert force["computed"] == pytest.approx(10e-6 / (1 / 1e8 + 1 / 2e8), rel=1e-9)
    assert "; 0 N with as much radial play" in force["note"]
    assert len(said) == 3 and all(r["verdict"] == "not computable" for r in said.values())
