"""Claims on friction and loads: the verdicts follow the numbers of the comparison, whichever way they point."""

from dataclasses import replace

import pytest
from small_machines import machine, smooth_gas, turn_of

from mechsym.forces.friction import Friction, NoRings
from mechsym.forces.result import ComparisonSettings, claims, compare, equal_loss_coefficient, left_out
from mechsym.mechanisms.crosshead import CrossheadParameters

CRANK = CrossheadParameters(r1=0, r2=0.3, l1=0.4, l2=0.5, m1=0, m2=0, m3=3, m4=2, m5=4, I01=2, IC2=0, g=0)
SOME = Friction(mu_guide=0.04, mu_pin=0.01, mu_main=0.008, mu_mesh=0.05, radius_piston_pin=0.05, radius_crank_pin=0.06,
                radius_main=0.07, module=0.01)  # fmt: skip


def compared(friction):
    one = turn_of(machine("crosshead", CRANK), smooth_gas(0.6))
    return compare(one, friction, NoRings(), ComparisonSettings(lam=1 / 3))


@pytest.fixture(scope="module")
def rows():
    return compared(SOME)


def verdicts(rows):
    return {row["claim"].split(" engine ")[-1]: row["verdict"] for row in claims(rows)}


def test_less_friction_is_not_supported_with_equal_coefficients(rows):
    found = verdicts(rows)
    assert found["loses less by friction than one with rods"] == "unsupported claim"
    less = replace(rows[0].friction, friction_per_piston=0.5 * rows[0].friction.friction_per_piston)
    changed = [replace(row, friction=less) if row.mechanism.startswith("rodless") else row for row in rows]
    assert verdicts(changed)["loses less by friction than one with rods"] == "supported claim"


def test_guide_coefficient_of_equal_losses(rows):
    """With that coefficient on its guides the rodless engine loses as much as the slider crank: losses are linear."""
    rod = rows[0]
    for row in rows:
        guides = row.friction.friction_places["guides"]
        mu = equal_loss_coefficient(rod, row, SOME.mu_guide) if guides else None
        if mu is not None:
            total = row.friction.friction_per_piston - guides + guides * mu / SOME.mu_guide
            assert total == pytest.approx(rod.friction.friction_per_piston, rel=1e-12)
    assert equal_loss_coefficient(rod, rod, SOME.mu_guide) == pytest.approx(SOME.mu_guide, rel=1e-12)


def test_without_coefficients_no_claim_on_friction(rows):
    bare = compared(None)
    assert len(claims(bare)) == 2 and len(claims(rows)) == 4
    assert not any("friction" in row["claim"] for row in claims(bare))


@pytest.mark.parametrize(("weight", "efficiency", "supported"), [(0.01, 0.96, True), (0.2, 0.96, False),
                                                                 (0.01, 0.8, False), (0.01, None, True)])  # fmt: skip
def test_what_a_chain_may_leave_out(weight, efficiency, supported):
    found = left_out({"N": weight, "T": 0.001}, efficiency)
    assert (found["verdict"] == "supported claim") == supported
    assert "N" in found["note"]
