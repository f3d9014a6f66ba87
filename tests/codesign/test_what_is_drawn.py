"""What the pictures of a co-design draw, and the words and columns beside them, are the numbers of the design."""

import math
from types import SimpleNamespace as Made

import numpy as np
import pytest
from codesigns import design

from mechsym.codesign import plots, shown
from mechsym.codesign.front import Rival
from mechsym.codesign.loss import Lossy
from mechsym.codesign.rank import Count
from mechsym.codesign.scenarios import Scenario
from mechsym.hinge.result import Target
from mechsym.hinge.rollers import HingeLosses, LossTorques

RPM = 30 / math.pi


def line(axis, label):
    """A line by its label as two columns."""
    (one,) = [drawn for drawn in axis.lines if drawn.get_label() == label]
    return np.column_stack([np.asarray(one.get_xdata(), float), np.asarray(one.get_ydata(), float)])


def _point(omega, load_torque=-1e3, load=5e5):
    return Made(omega=omega, load_torque=load_torque, load=load, period=2 * math.pi, inertia=lambda phi: 0 * phi + 7.0)


SLOW, FAST = _point(8.0), _point(16.0, load_torque=4e3, load=2e6)


def _design(flywheel, ripple, points=(SLOW, FAST), springs=1):
    task = Made(points=points, ripple=ripple, springs=springs, losses=None)
    tracks = [Made(p0=np.array([2e6, 3e6])) for _ in range(springs)]
    return Made(
        flywheel=flywheel, task=task, tracks=tracks, status="optimal", reason="", ripple=np.array([0.01, 0.015])
    )


def test_the_works_and_what_one_shape_leaves():
    phi = np.array([0.0, 1.0, 2.0])
    wanted = np.array([[1.0, 4.0, 2.0], [2.0, 5.0, 1.0]])
    best = Made(shares=np.array([[2.0], [3.0]]), shapes=np.array([[0.5, 1.0, 0.25]]), swing=2.5)
    made = Made(design=_design(1.0, 0.02), bound=Made(phi=phi, wanted=wanted, best=[best]))
    left, right = plots.works(made).axes
    for k, (share, color) in enumerate(((2.0, plots.SERIES[0]), (3.0, plots.SERIES[1]))):
        assert left.lines[k].get_xdata() == pytest.approx(np.degrees(phi)) and left.lines[k].get_color() == color
        assert left.lines[k].get_ydata() == pytest.approx(wanted[k])
        assert right.lines[k].get_ydata() == pytest.approx(wanted[k] - share * best.shapes[0])
    alone = Made(design=_design(1.0, 0.02, (SLOW,)), bound=Made(phi=phi, wanted=wanted[:1], best=[best]))
    assert len(plots.works(alone).axes) == 1


@pytest.mark.parametrize("bare", [80.0, 4000.0])
def test_flywheels_over_the_ripple(bare):
    peers = (
        Rival(name="plain flywheel", ripple=0.02, flywheel_inertia=bare, about="", swing=None),
        Rival(name="two springs", ripple=0.02, flywheel_inertia=None, about="", swing=None),
    )
    lossy = Lossy(ripple=0.031, time_ripple=None, energy_residual=None, fill=1.0)
    stopped = Lossy(ripple=None, time_ripple=None, energy_residual=None, fill=1.0)
    made = Made(
        design=_design(20.0, 0.02), front=(_design(5.0, 0.05), _design(50.0, 0.01)), bare=bare, taken="beside",
        cut=Made(flywheel=33.0), lossy=(lossy, stopped), misfire_floor=12.0, peers=peers,
        bound=Made(swing=np.array([0.6, 0.2, 0.1])),
    )  # fmt: skip
    (axis,) = plots.front(made).axes
    assert line(axis, "co-designed, one spring") == pytest.approx(np.array([[1, 50], [2, 20], [5, 5]]))
    assert line(axis, "without a hinge") == pytest.approx(np.array([[2, bare]]))
    assert line(axis, "guide cut for one speed") == pytest.approx(np.array([[2, 33]]))
    assert line(axis, "co-designed, with its losses") == pytest.approx(np.array([[3.1, 20]]))
    assert line(axis, "plain flywheel") == pytest.approx(np.array([[2, bare]]))
    # a swing by the ripple, less what turns already
    assert line(axis, "estimate (massless)") == pytest.approx(np.array([[1, 53], [2, 23], [5, 5]]))
    assert axis.get_yscale() == ("symlog" if bare > 100 else "linear") and axis.get_ylim()[1] > bare
    drawn = {one.get_label() for one in axis.lines}
    assert "two springs" not in drawn and any("half the speed" in label for label in drawn)
    without = Made(**{**vars(made), "taken": "inside", "misfire_floor": None, "cut": Made(flywheel=None)})
    fewer = {one.get_label() for one in plots.front(without).axes[0].lines}
    assert not fewer & {"guide cut for one speed", "co-designed, with its losses"} and len(fewer) == len(drawn) - 3


def test_the_points_by_three_ways():
    verified = Made(
        programme_ripple=np.array([0.01, 0.02]),
        steady_ripple=np.array([0.011, 0.021]),
        time_ripple=np.array([0.012, 0.022]),
    )
    left, right = plots.points(Made(design=_design(1.0, 0.02, springs=2), verified=verified)).axes
    speeds = [8 * RPM, 16 * RPM]
    for label, values in (("programme", (1.0, 2.0)), ("over the angle", (1.1, 2.1)), ("run in time", (1.2, 2.2))):
        assert line(left, label) == pytest.approx(np.column_stack([speeds, values]))
    assert left.lines[3].get_ydata() == pytest.approx([2.0, 2.0]) and left.get_ylim()[0] == right.get_ylim()[0] == 0
    for spring in (1, 2):
        assert line(right, f"spring {spring}") == pytest.approx(np.column_stack([speeds, [2.0, 3.0]]))  # MPa


def test_losses_stand_on_each_other():
    at = (
        LossTorques(bearing=100.0, seal=50.0, guide=0.0, rolling=0.0, gas=20.0),
        LossTorques(bearing=40.0, seal=0.0, guide=0.0, rolling=0.0, gas=80.0),
    )
    (axis,) = plots.losses(Made(design=_design(1.0, 0.02), losses=at)).axes
    drawn = {c.get_label(): [(bar.get_y(), bar.get_height()) for bar in c] for c in axis.containers}
    assert set(drawn) == {"bearing", "seal", "gas"}
    assert np.array(drawn["bearing"]) == pytest.approx(np.array([(0, 10), (0, 1)]))
    assert np.array(drawn["seal"]) == pytest.approx(np.array([(10, 5), (1, 0)]))
    assert np.array(drawn["gas"]) == pytest.approx(np.array([(15, 2), (1, 2)]))
    assert [tick.get_text().partition("\n")[0] for tick in axis.get_xticklabels()] == ["76.39", "152.8"]


def _scenario(name, point, run, outcome=""):
    return Scenario(name=name, about="", point=point, speed_min=None, speed_max=None, run=run, outcome=outcome)


def test_scenarios_have_a_panel_each():
    run = Made(phi=np.array([math.pi, 3 * math.pi, 7 * math.pi]), omega=np.array([8.0, 7.0, 4.0]))
    rows = [_scenario("misfire", 0, run), _scenario("misfire", 1, run), _scenario("burst", 1, run)]
    rows += [_scenario("leak", 0, run), _scenario("astern", 0, None)]
    figure = plots.scenarios(Made(design=_design(1.0, 0.02), scenarios=rows))
    panels = [axis for axis in figure.axes if axis.get_visible()]
    assert [len(axis.lines) for axis in panels] == [2, 1, 1]
    slow, fast = panels[0].lines
    assert slow.get_xdata() == pytest.approx([0, 1, 3]) and slow.get_ydata() == pytest.approx([1, 7 / 8, 0.5])
    assert fast.get_ydata() == pytest.approx([0.5, 7 / 16, 0.25]) and slow.get_color() != fast.get_color()
    many = plots.scenarios(Made(design=_design(1.0, 0.02), scenarios=[_scenario(str(k), 0, run) for k in range(4)]))
    assert sum(axis.get_visible() for axis in many.axes) == 4 and len(many.axes) == 6


def test_the_map_is_of_every_speed_and_load():
    omega, load = np.array([8.0, 12.0, 16.0]), np.array([5e5, 2e6])
    ripple = np.array([[0.01, 0.02], [0.015, 0.04], [0.9, 0.05]])
    p0 = np.array([[1e6, 2e6], [2e6, 4e6], [3e6, 6e6]])
    figure = plots.ripple_map(Made(map=Made(omega=omega, load=load, ripple=ripple, p0=p0), design=_design(1.0, 0.02)))
    left, right = figure.axes[:2]
    for axis in (left, right):
        marked = np.column_stack(axis.lines[0].get_data())
        assert marked == pytest.approx(np.array([[8 * RPM, 0.5], [16 * RPM, 2.0]]))
        assert axis.get_xlim() == pytest.approx((8 * RPM, 16 * RPM)) and axis.get_ylim() == pytest.approx((0.5, 2.0))
    assert left.collections[0].zmax == 30 and right.collections[0].get_array().max() <= 6.5  # MPa


def test_errors_stand_by_what_they_move():
    alone = {"n": (0.018, 0.03), "p0": (0.019, 0.022)}
    made = Made(
        spread=Made(samples=np.array([0.02, 0.021, 0.024]), p95=0.024, alone=alone, errors={"n": 0.005, "p0": 0.01}),
        verified=Made(programme_ripple=np.array([0.015, 0.02])),
    )
    left, right = plots.spread(made).axes
    assert sum(bar.get_height() for bar in left.patches) == 3 and line(left, "19 of 20 keep this")[
        0, 0
    ] == pytest.approx(2.4)
    ends = [(bar.get_x() + bar.get_width(), bar.get_y() + bar.get_height() / 2) for bar in right.patches]
    assert np.array(ends) == pytest.approx(np.array([(1.9, 0.17), (2.2, -0.17), (1.8, 1.17), (3.0, 0.83)]))
    assert [tick.get_text().rpartition("±")[2].strip() for tick in right.get_yticklabels()] == ["2 %", "1 %"]


def test_cylinders_stand_side_by_side():
    rows = [
        Count(cylinders=n, flywheel_inertia_bare=bare, flywheel_inertia_estimate=least, swing=0.0)
        for n, bare, least in ((1, 400.0, 90.0), (2, 80.0, -3.0))
    ]
    (axis,) = plots.cylinders(rows).axes
    bars = {c.get_label(): [(b.get_x() + b.get_width() / 2, b.get_height()) for b in c] for c in axis.containers}
    assert np.array(bars["without a hinge"]) == pytest.approx(np.array([(0.8, 400), (1.8, 80)]))
    assert np.array(bars["one hinge, at least"]) == pytest.approx(np.array([(1.2, 90), (2.2, 0)]))


def _result(**changes):
    contact = Made(rho_min=0.4, rho_max=0.7, z_min=0.05, z_max=0.3)
    losses = (LossTorques(bearing=60.0, seal=0.0, guide=0.0, rolling=0.0, gas=10.0),
              LossTorques(bearing=120.0, seal=0.0, guide=0.0, rolling=0.0, gas=0.0))  # fmt: skip
    made = {
        "name": "zotov-89", "design": _design(20.0, 0.02), "bare": 4000.0, "losses": losses, "taken": "beside",
        "verified": Made(broken=(), contacts=[contact], programme_ripple=np.array([0.01, 0.02]),
                         steady_ripple=np.array([0.011, 0.021]), time_ripple=np.array([0.012, 0.0225])),
        "target": Target(ripple=0.02, with_losses=(0.018, 0.019), held=True, losses=True), "answer": "said",
        "bound": Made(wanted=np.array([[0.0, 30.0], [5.0, 45.0]]), best=[Made(swing=2.5)]), "scenarios": (),
        "spread": None, "map": None, "misfire": (0.7, None), "assumed": HingeLosses(),
    }  # fmt: skip
    return Made(**{**made, **changes})


def test_the_pictures_say_their_own_numbers():
    pictures = {p.name: p.see for p in shown._pictures(_result())}
    assert list(pictures) == ["points", "guides", "front", "works", "losses"]
    assert "at most 2.25 % at 2 points" in pictures["points"] and "2 MPa to 3 MPa" in pictures["points"]
    assert "400 mm to 700 mm" in pictures["guides"] and "50 mm to 300 mm" in pictures["guides"]
    assert "20 kg" in pictures["front"] and "4000 kg" in pictures["front"]
    assert (
        "up to 40 kg" in pictures["works"]
        and pictures["works"].startswith("Left: works")
        and "2.5 kg" in pictures["works"]
    )
    assert "take 3 % to 7 % of" in pictures["losses"]
    alone = Made(points=(SLOW,), ripple=0.02, springs=1, losses=None)
    one = _result(design=Made(**{**vars(_design(20.0, 0.02)), "task": alone}), losses=_result().losses[:1],
                  bound=Made(wanted=np.array([[0.0, 30.0]]), best=[Made(swing=2.5)]),
                  spread=Made(p95=0.024), map=object(), scenarios=(_scenario("misfire", 0, object()),))  # fmt: skip
    pictures = {p.name: p.see for p in shown._pictures(one)}
    assert list(pictures) == ["guides", "front", "works", "losses", "scenarios", "spread", "map"]
    assert (
        pictures["works"].startswith("Works") and "up to 30 kg" in pictures["works"] and "2.4 %" in pictures["spread"]
    )


@pytest.mark.parametrize(
    ("held", "losses", "value", "mark"), [(True, (0.018, 0.019), "kept", "yes"), (True, (0.018, 0.03), "missed", "no"),
                                          (False, (None, None), "no design", "no")]
)  # fmt: skip
def test_the_cards_of_a_design(held, losses, value, mark):
    target = Target(ripple=0.02, with_losses=losses, held=held, losses=True)
    cards = {c.name: c for c in shown.codesign_view(_result(target=target)).cards}
    assert (cards["target"].value, cards["target"].mark) == (value, mark) and cards["target"].about == "said"
    assert cards["limits"].value == ("kept" if held else "NOT kept") and cards["speed ripple"].value == "0.015"
    assert cards["losses of the hinge"].value == "7 %" and cards["flywheel"].value.startswith("20 kg")
    broken = _result(target=Target(ripple=0.02, with_losses=(), held=False, losses=True))
    broken.verified.broken, broken.design.reason = ("too fast", "too hot"), "no reason"
    assert {c.name: c.about for c in shown.codesign_view(broken).cards}["limits"] == "too fast; too hot"


def test_what_has_to_be_known_first():
    met = list(shown.of_codesign(_result()))
    assert [f.rank for f in met][-1] == shown.LEAST_SURE and met[-1].value == pytest.approx(0.07)
    assert any("76.39 rpm" in f.words for f in met)  # of two points the one that is slowed most
    missed = list(
        shown.of_codesign(_result(target=Target(ripple=0.02, with_losses=(0.05, None), held=True, losses=True)))
    )
    assert missed[0].rank == shown.NOT_MET and missed[0].value == pytest.approx(0.05)
    without = list(shown.of_codesign(_result(taken="none", misfire=(None, None))))
    assert without == []


def test_columns_of_points_and_of_a_guide():
    made = Made(design=design())
    columns = shown.point_columns(made)
    points = design().task.points
    assert list(columns) == ["omega [rad/s]", "load [Pa]", "load_torque [N*m]", "ripple [-]", "p0_1 [Pa]"]
    assert columns["omega [rad/s]"] == [p.omega for p in points] and columns["p0_1 [Pa]"] is design().tracks[0].p0
    track = design().tracks[0]
    guide = shown.guide_columns(made, track)
    angle, rho = guide["theta [rad]"], guide["rho [m]"]
    assert angle[0] == 0 and angle[-1] < 2 * math.pi * track.hardware.shaft_ratio <= angle[-1] + 2 * angle[1]
    # the spring closes by what the roller comes in, on as many sides as it has rollers
    spring = track.hardware.charged(float(track.p0[-1]))
    assert np.ptp(guide["z [m]"] + track.hardware.count * rho) == pytest.approx(0, abs=1e-9)
    assert guide["pressure [Pa]"] == pytest.approx(spring.pressure(guide["z [m]"]))
