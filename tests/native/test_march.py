"""Marching in lanes against a plain loop."""

import casadi as ca
import numpy as np
import pytest

from mechsym.errors import BadInput
from mechsym.native.march import marcher, separated
from mechsym.native.source import program


def step(records: bool = True) -> ca.Function:
    """A cooling gas with a broken exponent, driven by the stage's volume."""
    x, s, z = ca.SX.sym("x", 2), ca.SX.sym("s", 2), ca.SX.sym("z", 1)
    p = x[0] * (s[0] / s[1]) ** 1.3 * ca.exp(-0.01 * z)
    following = ca.vertcat(p, ca.fmax(x[1], p))
    outputs = [following, ca.vertcat(p * s[1])] if records else [following]
    return ca.Function("gas", [x, s, z], outputs)


def data(lanes: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    volume = 1 + 0.5 * np.cos(np.linspace(0, 6, 41))
    start = np.stack([np.linspace(1, 2, lanes), np.zeros(lanes)])
    return start, np.stack([volume[:-1], volume[1:]], axis=1), np.linspace(0, 1, lanes)[None]


def by_hand(start, stages, lanes):
    p, top, record = start[0].copy(), start[1].copy(), []
    for before, after in stages:
        p = p * (before / after) ** 1.3 * np.exp(-0.01 * lanes[0])
        top = np.maximum(top, p)
        record.append(p * after)
    return np.stack([p, top]), np.array(record)[:, None]


@pytest.mark.parametrize("route", ["strict", "fast", "numpy"])
@pytest.mark.parametrize("lanes", [1, 63, 64, 200])
def test_against_a_plain_loop(route, lanes, monkeypatch, tmp_path):
    if route == "numpy":
        monkeypatch.setenv("CC", "no-such-compiler")
    given = data(lanes)
    state, record = marcher(step(), "fast" if route == "numpy" else route)(*given)
    wanted, wanted_record = by_hand(*given)
    np.testing.assert_allclose(state, wanted, rtol=1e-12)
    np.testing.assert_allclose(record, wanted_record, rtol=1e-12)


def test_start_is_left_alone_and_records_are_optional():
    start, stages, lanes = data(5)
    kept = start.copy()
    state, record = marcher(step(records=False))(start, stages, lanes)
    np.testing.assert_array_equal(start, kept)
    assert record.shape == (40, 0, 5)
    np.testing.assert_allclose(state, by_hand(start, stages, lanes)[0], rtol=1e-12)


def test_shapes_are_checked():
    start, stages, lanes = data(5)
    with pytest.raises(BadInput, match="takes 2 states, 2 stage values and 1 lane values"):
        marcher(step())(start[:1], stages, lanes)
    with pytest.raises(BadInput, match="is no step"):
        marcher(ca.Function("f", [ca.SX.sym("x")], [1]))


def test_what_a_lane_decides_alone_is_computed_once():
    once, turn = separated(program(step(), "strict").tape, (2, 2, 1))
    assert {op for op, _ in once.nodes} == {"input", "constant", "mul", "exp"}
    assert "exp" not in {op for op, _ in turn.nodes}
    assert len(turn.inputs) == len(once.inputs) + 1


@pytest.mark.parametrize("route", ["fast", "numpy"])
def test_lanes_that_decide_nothing_or_everything_alone(route, monkeypatch):
    if route == "numpy":
        monkeypatch.setenv("CC", "no-such-compiler")
    x, s, z = (ca.SX.sym(n) for n in "xsz")
    start, stages, lanes = np.ones((1, 3)), np.ones((4, 1)), np.array([[1.0, 4.0, 9.0]])
    plain = marcher(ca.Function("plain", [x, s, z], [x + s * z]))
    np.testing.assert_array_equal(plain(start, stages, lanes)[0], start + 4 * lanes)
    alone = marcher(ca.Function("alone", [x, s, z], [ca.sqrt(z), ca.sqrt(z)]))
    state, record = alone(start, stages, lanes)
    np.testing.assert_array_equal(state, np.sqrt(lanes))
    np.testing.assert_array_equal(record, np.sqrt([lanes] * 4))
    erf = marcher(ca.Function("erf", [x, s, z], [x * ca.erf(z / z)])) if route == "fast" else None
    assert erf is None or erf(start, stages, lanes)[0] == pytest.approx(np.full((1, 3), 0.8427007929497149**4))
