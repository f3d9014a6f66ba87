"""What is told of critical speeds and of a run that has not settled, and where the picture of orders has its dots."""

from types import SimpleNamespace

import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.colors import to_hex

from mechsym.page.finding import LOOK_AT, NOT_MET
from mechsym.style import RED
from mechsym.torsion import shown


def told_of(away, torque, rigid=100.0):
    critical = SimpleNamespace(away=away, torque=torque, order=2.0, speed=100.0, natural=200.0)
    return [f.rank for f in shown.criticals(SimpleNamespace(criticals=[critical], torque_rigid=rigid))]


def test_a_critical_speed_is_told_by_its_distance_and_its_torque(monkeypatch):
    monkeypatch.setattr(shown, "critical_words", lambda one: f"order {one.order:g}")
    assert list(shown.criticals(None)) == []
    assert told_of(0.11, 500.0) == told_of(-0.11, 500.0) == []
    assert told_of(0.09, 99.0) == told_of(-0.09, 99.0) == [LOOK_AT]
    assert told_of(0.09, 101.0) == [NOT_MET]  # it swings the shaft more than a rigid one bears
    assert told_of(0.019, 99.0) == told_of(-0.02, 99.0) == [NOT_MET]  # it is run at
    assert told_of(0.021, 99.0) == [LOOK_AT]
    assert told_of(0.019, 1.01) == [NOT_MET] and told_of(0.019, 0.99) == []  # it swings nothing


@pytest.mark.parametrize(
    ("means", "words"),
    [
        ([100.0, 101.0], "too short"),
        ([100.0, 101.0, 101.0 * (1 + 0.9e-4)], None),
        ([100.0, 101.0, 101.0 * (1 - 0.9e-4)], None),
        ([100.0, 101.0, 101.0 * (1 + 1.1e-4)], "still rises, 954.93 rpm to 964.59 rpm"),
        ([100.0, 101.0, 101.0 * (1 - 1.1e-4)], "still falls, 954.93 rpm to 964.37 rpm"),
    ],
)
def test_a_run_has_settled_when_its_mean_speed_stays(means, words, monkeypatch):
    monkeypatch.setattr(shown, "period_means", lambda *_: np.array(means))
    engine = SimpleNamespace(coordinate="phi", period=2 * np.pi)
    run = SimpleNamespace(engine=engine, result=SimpleNamespace(as_planned=True))
    finding = shown.drift(run)
    assert finding is None if words is None else words in finding.words
    for other in ({"engine": None}, {"result": SimpleNamespace(as_planned=False)}):
        assert shown.drift(SimpleNamespace(**vars(run) | other)) is None


def test_dots_lie_where_orders_meet_the_natural_frequency():
    natural = 60.0  # rad/s
    criticals = [SimpleNamespace(order=k, speed=natural / k) for k in (1.0, 2.0, 4.0, 5.0)]
    captures = [SimpleNamespace(critical=criticals[1], t_start=1.0)]
    figure = shown.campbell(SimpleNamespace(natural=natural, criticals=criticals, captures=captures))
    (axes,) = figure.axes
    rpm, dots = 30 / np.pi, [line for line in axes.lines if line.get_marker() == "o" and len(line.get_xdata())]
    assert [line.get_xydata()[0] for line in dots] == [
        pytest.approx([c.speed * rpm, natural * rpm])
        for c in criticals[:3]  # higher orders crowd at the left
    ]
    assert [to_hex(line.get_markerfacecolor()) == to_hex(RED) for line in dots] == [False, True, False]
    rays = [line for line in axes.lines if line.get_xydata().tolist()[:1] == [[0, 0]]]
    assert [y / x for x, y in (ray.get_xydata()[1] for ray in rays)] == pytest.approx([1.0, 2.0, 4.0])
    assert axes.get_ylim() == pytest.approx((0, 1.45 * natural * rpm))
    assert axes.get_xlim() == pytest.approx((0, 1.08 * 1.1 * natural * rpm))
    plt.close(figure)
