"""Main bearings at their places: statics, both limits of the continuous shaft, and an independent beam."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mechsym.errors import BadInput
from mechsym.forces.mains import MainShaft, beam, determinate, journals, supports
from mechsym.forces.turn import Turn, crank_drive, turn
from mechsym.mechanisms.crank_train import CrankTrainParameters

SPANS = np.array([0.0, 1.0, 2.0])
HALVES = np.array([0.5, 1.5])


def test_two_bays_on_rigid_supports() -> None:
    shares = beam(SPANS, HALVES, flexibility=1.0, compliance=0.0).sum(axis=1)
    assert shares == pytest.approx([5 / 16, 22 / 16, 5 / 16], rel=1e-12)


def test_two_bays_with_hinges() -> None:
    assert determinate(SPANS, HALVES).sum(axis=1) == pytest.approx([0.5, 1.0, 0.5], rel=1e-15)


def test_limits_of_stiffness() -> None:
    """EI/(k a^3) from 0 to infinity: from rigid supports to a rigid shaft on springs, straight by the lever about its
    middle."""
    rigid = beam(SPANS, np.array([0.5]), flexibility=0.0, compliance=1.0)[:, 0]
    assert rigid == pytest.approx([1 / 3 + 0.25, 1 / 3, 1 / 3 - 0.25], rel=1e-12)
    soft, stiff = (beam(SPANS, HALVES, 1.0, ratio).sum(axis=1) for ratio in (1e-9, 1e9))
    assert soft == pytest.approx([5 / 16, 22 / 16, 5 / 16], rel=1e-7)
    assert stiff == pytest.approx(np.full(3, 2 / 3), rel=1e-7)


places = st.lists(st.floats(0.1, 2.0), min_size=2, max_size=7)


@settings(max_examples=60, deadline=None)
@given(places, st.lists(st.floats(-0.5, 14.0), min_size=1, max_size=5), st.floats(-8, 8))
def test_force_and_moment(gaps: list[float], z: list[float], exponent: float) -> None:
    at, loads = np.concatenate([[0.0], np.cumsum(gaps)]), np.array(z)
    for shares in (determinate(at, loads), beam(at, loads, 1.0, 10.0**exponent)):
        size = np.abs(shares).max()
        assert shares.sum(axis=0) == pytest.approx(np.ones(len(z)), abs=1e-9 * size)
        assert at @ shares == pytest.approx(loads, abs=1e-8 * size * at[-1])


def _elements(at: np.ndarray, z: float, stiffness: float, support: float, count: int = 7) -> np.ndarray:
    """Reactions by cubic elements: exact at nodes, and load and supports stand on nodes."""
    nodes = np.unique(np.concatenate([np.linspace(at[0], at[-1], count), at, [z]]))
    matrix = np.zeros((2 * len(nodes), 2 * len(nodes)))
    for i, h in enumerate(np.diff(nodes)):
        own = np.array([[12, 6 * h, -12, 6 * h], [6 * h, 4 * h**2, -6 * h, 2 * h**2],
                        [-12, -6 * h, 12, -6 * h], [6 * h, 2 * h**2, -6 * h, 4 * h**2]])  # fmt: skip
        matrix[2 * i : 2 * i + 4, 2 * i : 2 * i + 4] += stiffness / h**3 * own
    held = 2 * np.searchsorted(nodes, at)
    matrix[held, held] += support
    load = np.zeros(2 * len(nodes))
    load[2 * np.searchsorted(nodes, z)] = 1.0
    return support * np.linalg.solve(matrix, load)[held]


@pytest.mark.parametrize("support", [0.5, 20.0, 1e3])
@pytest.mark.parametrize("z", [0.3, 1.1, 2.9])
def test_against_elements(z: float, support: float) -> None:
    at = np.array([0.0, 0.7, 1.9, 3.0])
    shares = beam(at, np.array([z]), 1 / 2.5, 1 / support)[:, 0]
    assert shares == pytest.approx(_elements(at, z, 2.5, support), abs=1e-7)


def _three(z_rod: float = 0.0) -> Turn:
    parameters = CrankTrainParameters(
        throw=(1, 2, 3), phase=tuple(np.radians([0, 240, 120])), r=0.0375, l1=0.04, l2=0.09, m_rod=0.36, m_piston=0.32,
        I_rod=1e-3, z_rod=z_rod, I0=5e-3, m0=1.2, u0=0.01, u_phase=0.3, z=(0.0, 0.09, 0.18), I_f=0.1, k=1e5, g=9.81,
    )  # fmt: skip
    return turn(crank_drive("crank_train", parameters), None, 300.0)


@pytest.mark.parametrize("z_rod", [0.0, 0.012])
@pytest.mark.parametrize("shaft", [MainShaft(), MainShaft(mains="beam", bending_stiffness=2e4)])
def test_sum_of_mains(shaft: MainShaft, z_rod: float) -> None:
    """All journals together carry what all throws press on, at every angle."""
    one = _three(z_rod)
    found = journals(one, shaft)
    assert [journal.z for journal in found] == pytest.approx([-0.045, 0.045, 0.135, 0.225])
    for axis in "xy":
        throws = -sum(one.reactions[f"main_bearing_force_{axis}_{k}"] for k in (1, 2, 3))
        total = sum(getattr(journal, axis) for journal in found)
        assert np.abs(total - throws).max() <= 1e-12 * np.abs(throws).max() + 1e-9


def test_rods_side_by_side_load_at_their_own_places() -> None:
    moments = []
    for z_rod in (0.0, 0.012):
        one = _three(z_rod)
        moments.append(sum(journal.z * journal.x for journal in journals(one)))
    pins = -sum(_three().reactions[f"pin_force_x_{k}"] for k in (1, 2, 3))
    assert moments[1] - moments[0] == pytest.approx(0.012 * pins, abs=1e-9 * np.abs(pins).max())


def test_places_by_default_and_by_hand() -> None:
    assert supports([0.0, 0.1, 0.3]) == pytest.approx([-0.05, 0.05, 0.2, 0.4])
    assert supports([0.0, 0.1], (0.2, -0.1)) == pytest.approx([-0.1, 0.2])
    assert len(supports([0.0])) == 0


def test_stiffness_of_sizes() -> None:
    """Round parts of 25 mm each side of two webs of 20 mm that bend over the crank radius."""
    sizes = {"journal_diameter": 0.05, "web_width": 0.08, "web_thickness": 0.02, "mains": "beam"}
    with pytest.raises(BadInput, match=r"shaft\.pin_diameter"):
        journals(_three(), MainShaft(**sizes))
    found = journals(_three(), MainShaft(pin_diameter=0.04, **sizes))
    bends = 64 * 0.025 / math.pi * (0.05**-4 + 0.04**-4) + 2 * 0.0375 * 12 / (0.08 * 0.02**3)
    plain = journals(_three(), MainShaft(mains="beam", bending_stiffness=206e9 * 0.09 / bends))
    for one, other in zip(found, plain, strict=True):
        assert one.x == pytest.approx(other.x, rel=1e-9, abs=1e-6)
