"""Zotov et al. (2024): the printed numbers and claims, each with its verdict; the data of the captions."""

import numpy as np
import pytest

from mechsym.cases import load
from mechsym.papers.sources import sources
from mechsym.papers.zotov2024 import rows as zotov2024

PHI = np.linspace(0, 2 * np.pi, 721)


@pytest.fixture(scope="module")
def found():
    return {row["item"]: row for row in sources("zotov2024")[0].rows()}


def one(found, start):
    (row,) = [row for item, row in found.items() if item.startswith(start)]
    return row


def test_caption_of_fig_4_is_the_case():
    p = load("zotov-89").need("parameters")
    masses, lengths = (p.m1, p.m2, p.m3, p.m4, p.m5), (p.r1, p.r2, p.l1, p.l2)
    assert masses == (80, 150, 150, 200, 110) and lengths == (0.2, 0.3, 0.8, 0.75)
    assert (p.I01, p.IC2) == (30, 50)
    assert [load(n).need("operation").speed * 30 / np.pi for n in ("zotov-89", "zotov-142")] == pytest.approx([89, 142])


def test_caption_of_fig_5_is_the_case():
    spring, guide = load("zotov-89").need("spring"), load("zotov-89").need("guide")
    assert (spring.A, spring.H, spring.n, guide.rho0) == (0.031, 1.0, 1.25, 0.8)
    assert spring.p0 == 5e6


@pytest.mark.parametrize("option", "ab")
def test_integral_of_the_torque_vanishes(found, option):
    row = one(found, f"integral of M_h over a turn, option {option}")
    assert row["verdict"] == "reproduced" and row["computed"] < 1e-12


def test_the_printed_torque_is_near_the_exact_one_and_not_the_same():
    wanted = zotov2024.engines().hinges[0]
    off = np.abs(zotov2024.printed_torque(0, PHI) - wanted.torque(PHI)).max() / zotov2024.peak(wanted)
    assert 1e-3 < off < 0.05


def test_the_text_contradicts_itself_twice_is_not_the_square(found):
    row = one(found, "factor of (8)")
    assert row["verdict"] == "not reproduced" and row["computed"] == pytest.approx((142 / 89) ** 2)
    assert one(found, "M_h proportional")["computed"] == pytest.approx(0.11, abs=0.01)


def test_fig_4_and_fig_6_need_the_force_that_is_not_printed(found):
    ratio, pressure = one(found, "Fig. 4: largest"), one(found, "Fig. 6: p0")
    assert ratio["verdict"] == pressure["verdict"] == "not computable"
    assert ratio["computed"] == pytest.approx(2.4, abs=0.06) and pressure["computed"] == pytest.approx(12.5, abs=0.1)
    assert pressure["rel_error"] == pytest.approx(pressure["computed"] / 9.5 - 1)


def test_factor_of_pressure(found):
    assert one(found, "factor of p0")["verdict"] == "arithmetic of the source"


def test_14_is_proportional_for_the_printed_law_only(found):
    row = one(found, "(14)")
    assert row["verdict"] == "reproduced" and row["computed"] < 1e-12
    assert "absolute pressure 1.9e-03" in row["note"]


def test_speed_is_constant_with_the_hinge_and_far_from_it_when_retuned(found):
    assert one(found, "speed ripple at 89 rpm")["computed"] < 1e-8
    retuned = one(found, "speed ripple at 142")
    assert retuned["computed"] == pytest.approx(0.158, abs=5e-4)
    assert "8.1 %" in retuned["note"] and "6.1 %" in retuned["note"] and "the engine stops" in retuned["note"]


def test_fig_5_the_roundest_guides(found):
    assert one(found, "Fig. 5: option closest")["verdict"] == "reproduced"
    assert one(found, "Fig. 5: a larger p0")["verdict"] == "reproduced"
    # at one rho0 a longer spring closes more: the advice on H holds only because rho0 grows with it
    assert one(found, "Fig. 5: a larger H")["verdict"] == "not reproduced"
    guides = {m.label: zotov2024.departure(m.guide) for m in zotov2024.guides() if m.start == "as_printed"}
    assert len(guides) == 12 and min(guides, key=guides.get) == "a3"


def test_a_circle_has_no_departure():
    cut = zotov2024.engines().cut
    assert zotov2024.departure(cut) > 0.2
    assert np.ptp(zotov2024.distances(cut)) == pytest.approx(
        zotov2024.departure(cut) * (zotov2024.distances(cut).max() + zotov2024.distances(cut).min()) / 2
    )
