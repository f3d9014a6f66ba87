"""Other hardware for the same works: where the search starts it is the design, and what it weighs has closed forms."""

import dataclasses
import math
from types import SimpleNamespace as Made

import numpy as np
import pytest
from codesigns import design, task

from mechsym.codesign import realise as realised
from mechsym.codesign.realise import GOALS, _margins, check_goal, chosen, realise
from mechsym.codesign.task import fine_path
from mechsym.errors import BadInput
from mechsym.hinge.rollers import bearing_torque
from mechsym.hinge.springs.coil import Coil


def fastest(track, points):
    """The guide at its highest pressure and the highest speed, at even angles."""
    h, period = track.hardware, points[0].period
    _, path = fine_path(track, period)
    return h.station(path, h.charged(float(track.p0.max())), max(p.omega for p in points))


def at_start(monkeypatch, moved=(), success=True, fun=1.0):
    """A search that ends where it begins, or a step away: what it was asked to make small there, and its bounds."""
    asked = {}

    def minimize(goal, start, bounds, constraints, **options):
        x = start.copy()
        for k, by in moved:
            x[k] += by
        asked.update(goal=goal(x), first=goal(start), least=constraints["fun"](x).min(), bounds=bounds)
        return Made(x=x, success=success, fun=fun, message="Stopped")

    monkeypatch.setattr(realised.scipy.optimize, "minimize", minimize)
    return asked


@pytest.mark.parametrize("goal", GOALS)
def test_the_search_starts_at_the_design(monkeypatch, goal):
    asked = at_start(monkeypatch, fun=0.75)
    made, (track,) = realise(design(), goal), design().tracks
    at = fastest(track, design().task.points)
    h = track.hardware
    expected = {
        "roller_reaction": at.reaction.max(), "spring_pressure": at.pressure.max(),
        "gas_volume": h.spring.A * h.spring.H,
        "bearing_loss": bearing_torque(at.reaction, at.rho, at.drho, 0.0018, h.radius / 2, h.radius, h.count).mean(),
    }  # fmt: skip
    assert asked["first"] == pytest.approx(1.0)
    assert made.before == pytest.approx((expected[goal],), rel=2e-3) and made.after[0] == pytest.approx(
        0.75 * made.before[0]
    )
    (new,) = made.design.tracks
    phi = np.linspace(0.0, 2 * math.pi, 50)
    assert new.z(phi) == pytest.approx(track.z(phi), abs=2e-4 * h.spring.H)
    assert new.p0 == pytest.approx(track.p0, rel=1e-3) and new.hardware.spring.A == h.spring.A
    # each by a factor of three at most, and the least closing by thirty
    ends = [(-math.log(3), math.log(3))] * 6 + [(0.0, math.log(30))]
    assert np.array(asked["bounds"]) == pytest.approx(np.array(ends))


def test_each_number_is_moved_by_its_factor(monkeypatch):
    (track,) = design().tracks
    h = track.hardware
    at_start(monkeypatch, [(k, math.log(1 + 0.1 * k)) for k in range(1, 6)])
    made = realise(design(), "roller_reaction").design.tracks[0].hardware
    # A, H, p0, rho0, radius, width in this order
    assert made.spring.A == h.spring.A and made.spring.H == pytest.approx(1.1 * h.spring.H)
    numbers = (made.rho0, made.radius, made.width)
    assert numbers == pytest.approx((1.3 * h.rho0, 1.4 * h.radius, 1.5 * h.width))
    shown = chosen(made)
    assert (shown.A, shown.H, shown.p0) == (made.spring.A, made.spring.H, made.spring.p0)
    # a longer column at a higher pressure stores the same with a pressure of its own
    assert made.spring.p0 == pytest.approx(1.2 * track.p0.max(), rel=0.2)


def test_a_deeper_start_of_the_spring_is_its_least_closing(monkeypatch):
    (track,) = design().tracks
    at_start(monkeypatch, [(6, math.log(2.0))])
    (made,) = realise(design(), "roller_reaction").design.tracks
    least = max(track.hardware.z_margin, 1e-3 * track.hardware.spring.H)
    assert made.z(np.linspace(0, 2 * math.pi, 7201)).min() == pytest.approx(2 * least, rel=1e-3)


def test_what_a_search_could_not_do_is_said(monkeypatch):
    at_start(monkeypatch, success=False)
    assert realise(design(), "roller_reaction").status == "stopped"
    # a third of the distance between the rollers leaves no room for the gas
    asked = at_start(monkeypatch, [(3, -math.log(3.0))])
    assert realise(design(), "roller_reaction").status == "stopped" and asked["least"] < 0
    with pytest.raises(BadInput, match="beauty"):
        check_goal("beauty")
    coil = dataclasses.replace(design(), task=dataclasses.replace(
        task(), hardware=dataclasses.replace(task().hardware, spring=Coil(F0=1e5, k=1e6, H=1.0))))  # fmt: skip
    with pytest.raises(BadInput, match="asks for gas"):
        realise(coil, "gas_volume")


def test_margins_are_what_is_left_of_each_limit():
    (track,) = design().tracks
    at, bounds, h = fastest(track, design().task.points), design().task.bounds, track.hardware
    shares = {
        "pressure": at.pressure.max() / bounds.spring_pressure,
        "closing": at.z.max() / h.spring.H / bounds.closing_share,
        "slope": np.abs(at.drho / at.rho).max() / math.tan(bounds.pressure_angle),
        "bulge": (-at.curvature * (h.radius + bounds.profile_radius)).max(),
        "reaction": at.reaction.max() / bounds.roller_reaction,
        "centre": (h.radius / at.rho).max(),
        "reach": (at.rho + h.radius).max() / design().task.widest,
    }
    margins = _margins(design(), at)
    for name, share in shares.items():
        assert np.abs(margins - (1 - share)).min() < 1e-9, name
    # the track can only push, and the rollers leave room for the gas
    assert np.abs(margins - at.reaction.min() / bounds.roller_reaction).min() < 1e-9
    assert margins[-1] == pytest.approx((h.rho0 - h.spring.H / 2 - h.radius) / h.rho0)
    alone = dataclasses.replace(at, count=1)
    assert _margins(design(), alone)[-1] == 1.0
