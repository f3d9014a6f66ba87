"""A compression ratio, rod or stroke that is not the engine's bends the line of a record, by how much is told."""

import math

import numpy as np
import pytest
from simulated_engine import DEG, records
from slider_crank import slider_crank

from mechsym.cycle.measured.alignment import from_compression, from_motored
from mechsym.cycle.measured.joint_fit import ChargeShape, Prior, by_clearance, clearance_asked, log_pressure

LINE = (-90 * DEG, -15 * DEG)
LIMIT, SHEET = 2.25, 0.03  # standard deviations, and what data sheets leave, as of the doubt


def asked(r, k, ratio=1.0, rod=1.0, stroke=1.0):
    """Change of the clearance that the line of one record asks for, in standard deviations [-]."""
    e = r.engines
    cylinder = slider_crank(
        stroke * e.stroke[k, 0] / 2, rod * e.rod[k, 0], e.bore[k, 0], 1 + ratio * (float(r.ratio[k]) - 1)
    )
    inside = (r.file_angle > -4) & (r.file_angle < 2.3)
    angle, mean = r.file_angle[inside], r.rows[k].mean(axis=0)[inside]
    # what a case says of its fuel: mixture of a spark engine, air of a diesel
    prior = Prior(n0=((1.30 if r.ratio[k] < 13 else 1.34) + 0.03, 0.045))
    burns = np.any(e.burn_heat > 0)
    fit = (from_compression(angle, mean, cylinder, LINE, prior) if burns else
           from_motored(angle, mean, cylinder, prior, ""))[1]  # fmt: skip
    change, spread = clearance_asked(fit, angle, mean, cylinder, prior)
    return change / math.hypot(spread, SHEET)


RATIO = {"as built": {}, "ratio up": {"ratio": 1.27}, "ratio down": {"ratio": 0.77}}
ROD = {"rod up": {"rod": 1.3}, "rod down": {"rod": 0.7}, "stroke up": {"stroke": 1.2}}


def shares(count, seed, fired, wrong):
    """Share of records that are doubted as they are, and with a wrong geometry."""
    r = records(np.random.default_rng(seed), count, 3, fired=fired)
    return {name: np.mean([abs(asked(r, k, **by)) > LIMIT for k in range(count)]) for name, by in wrong.items()}


def test_slope_by_the_clearance_is_that_of_another_cylinder():
    phi, shape, by = np.linspace(-1.6, 1.0, 9), ChargeShape(n0=1.34, n1=0.04, loss=0.1, sharpness=1.3), 1e-4
    # a larger clearance of the same stroke: compression ratio less 1 goes down by as much
    low, high = (slider_crank(0.0275, 0.0842, 0.0677, 1 + 7.5 * math.exp(-s * by)) for s in (-1, 1))
    difference = (log_pressure(high, phi, shape)[0] - log_pressure(low, phi, shape)[0]) / (2 * by)
    assert by_clearance(slider_crank(0.0275, 0.0842, 0.0677, 8.5), phi, shape) == pytest.approx(difference, abs=1e-6)


@pytest.mark.slow
def test_some_records_with_a_wrong_compression_ratio():
    fired, motored = shares(10, 41, True, RATIO), shares(10, 42, False, RATIO)
    assert fired["as built"] <= 0.1 and motored["as built"] <= 0.1
    assert min(motored["ratio up"], motored["ratio down"]) == 1.0
    assert min(fired["ratio up"], fired["ratio down"]) >= 0.5


@pytest.mark.slow
@pytest.mark.heavy
def test_sixty_records_with_a_wrong_geometry():
    """A rod of 0.7 or 1.3 bends a line as a clearance that is little further off than data sheets leave it."""
    fired, motored = shares(60, 901, True, RATIO | ROD), shares(60, 902, False, RATIO | ROD)
    print(f"fired {fired}\nmotored {motored}")
    assert max(fired["as built"], motored["as built"]) <= 0.03
    assert min(motored["ratio up"], motored["ratio down"]) >= 0.98
    assert min(fired["ratio up"], fired["ratio down"]) >= 0.6
    assert max(motored["rod up"], motored["rod down"]) > 0
