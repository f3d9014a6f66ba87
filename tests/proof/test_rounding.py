"""Bounds of rounding: closed forms, no sample beyond them, near what is seen; broken machine code is found."""

import itertools
import json
import math
import subprocess
import sys

import casadi as ca
import numpy as np
import pytest
from click.testing import CliRunner

from mechsym import cases
from mechsym.cli import main, mechsym
from mechsym.errors import BadInput
from mechsym.native import source

pytest.importorskip("flint")

from mechsym.jobs.prove import GUIDES, ranges_of, subjects_of, usual_case  # noqa: E402
from mechsym.native.evaluate import compiled  # noqa: E402
from mechsym.native.source import prepared  # noqa: E402
from mechsym.proof import sampled  # noqa: E402
from mechsym.proof.balls import arb, outward  # noqa: E402
from mechsym.proof.outputs import Subject, of_mechanism, prove, rounding  # noqa: E402
from mechsym.proof.rounding import bounds  # noqa: E402
from mechsym.proof.sampled import errors, farthest, points_in  # noqa: E402

MECHANISMS = ("crank_throw", "crankshaft_flywheel", "crankshaft_flywheel_printed", "crosshead", "hypocycloid")
LINKS = ("rodless", "rodless_constraints")
U = 2.0**-53
x, y, z = ca.SX.sym("x"), ca.SX.sym("y"), ca.SX.sym("z")


def bound_of(value, letters, box):
    tape = prepared(ca.Function("f", letters, [value], [s.name() for s in letters], ["value"]), "strict")
    return bounds(tape, box)[0][0].error


# half a unit in the last place by hand: results below 4, 2, 4; the second term is the first's error on its way
@pytest.mark.parametrize(("value", "expected"), [
    (x + y, 2 * U), (x * y, 2 * U), (x / y, U), (ca.sqrt(x), U), (2 * x, 0), (-x, 0), (ca.fabs(x), 0),
    ((x + y) * x, 1.9 * 2 * U + 4 * U), ((x + y) - x, 2 * U + 2 * U), (ca.sin(x), 4 * U / 2), (ca.exp(-x), 3 * U / 4),
    (x * x * x, 1.9 * 2 * U + 4 * U),
])  # fmt: skip
def test_a_bound_is_half_a_unit_an_operation(value, expected):
    assert bound_of(value, [x, y], [(1.0, 1.9), (1.0, 1.9)]) == pytest.approx(expected, rel=1e-6)


def test_what_is_carried_twice_may_cancel():
    # (x y) z - (x y) z' loses what x y lost by z - z' only
    product = x * y
    wide = bound_of(product * z - product * 1.5, [x, y, z], [(1.0, 1.9), (1.0, 1.9), (1.499, 1.501)])
    # by hand: 2 U of x y times 0.001, 4 U of either product, and half a unit of a difference below 2^-8
    assert wide == pytest.approx(2 * U * 0.001 + 2 * 4 * U + U / 256, rel=1e-3)


def test_a_comparison_that_may_come_out_either_way_has_no_bound():
    assert bound_of(ca.if_else(x < 1.5, x, y), [x, y], [(1.0, 1.4), (3.0, 4.0)]) == 0
    assert math.isinf(bound_of(ca.if_else(x < 1.5, x, y), [x, y], [(1.0, 1.9), (3.0, 4.0)]))


def subject(value, pieces=8):
    edges = np.linspace(-3.0, 3.0, pieces + 1).tolist()
    function = ca.Function("f", [x], [value], ["phi"], ["value"])
    boxes = tuple((pair,) for pair in itertools.pairwise(edges))
    return Subject(name="f", function=function, boxes=boxes, along=(0,))


def test_singular_places_are_told_and_not_hidden():
    (row,) = prove(subject(1 / ca.sin(x)), 200)
    assert row.absolute > 0 and len(row.singular) > 0
    for place in row.singular:
        low, high = map(float, place.partition(" = ")[2].split(".."))
        assert low <= 0 <= high and high - low < 0.01
    assert row.seen <= row.absolute


@pytest.mark.parametrize(
    "value", [ca.sin(x), ca.cos(x), ca.tan(x / 3), ca.exp(x), ca.log(x + 4), ca.asin(x / 4), (x + 4) ** 1.3]
)
def test_elementary_functions_keep_their_stated_bounds(value):
    (row,) = prove(subject(value), 500)
    assert 0 < row.seen <= row.absolute and not row.singular


@pytest.fixture
def small():
    """One function of a mechanism: the crosshead's kinematics."""
    ranges = ranges_of("crosshead", cases.load("zotov-89"))
    return of_mechanism("crosshead", ranges)[0]


def test_no_sample_is_beyond_its_bound(small):
    rows = prove(small, 300)
    assert all(0 < row.seen <= row.absolute and row.factor < 30 for row in rows)


def test_of_many_points_those_that_are_farthest_off_are_held_against_60_digits(small, monkeypatch):
    code, tape = compiled(small.function, "strict").batch, prepared(small.function, "strict")
    points = points_in(small.boxes, 4_000, 1)
    assert farthest(code, tape, points) is points  # few are held all
    monkeypatch.setattr(sampled, "ALL", 100)
    monkeypatch.setattr(sampled, "_CHUNK", 500)
    far = farthest(code, tape, points)
    assert far.shape[1] < 0.4 * 4_000
    every, some = (errors(code, small.exact, these)[0].max(axis=1) for these in (points, far))
    assert every.tolist() == some.tolist() and every.max() > 0


def beyond(subject, code):
    return any(row.seen > row.absolute for row in prove(subject, 100, code=code))


def test_a_changed_sign_is_found(small):
    right = compiled(small.function, "strict").batch
    signs = np.ones((small.function.n_out(), 1))
    signs[2] = -1
    assert beyond(small, lambda *columns: signs * right(*columns)) and not beyond(small, right)


@pytest.mark.slow
@pytest.mark.parametrize(("right", "wrong"), [
    ("-1.66666666666666324348e-01", "-1.66666666666366324348e-01"),  # in the sine's polynomial
    ("fma(-n, 0x1.0b4611a626331p-34, ", "("),  # a piece of pi/2
    ("1.66666666666666657415e-01 + z", "1.66666666661666657415e-01 + z"),  # in the arcsine
    ("const double t", "const float t"),
])  # fmt: skip
def test_broken_machine_code_is_found(small, right, wrong, monkeypatch):
    text = source.evaluation
    assert right in text([source.program(small.function, "strict")])
    monkeypatch.setattr(source, "evaluation", lambda programs: text(programs).replace(right, wrong))
    assert beyond(small, compiled(small.function, "strict").batch)


@pytest.mark.slow
@pytest.mark.parametrize("name", (*MECHANISMS, *LINKS, pytest.param(GUIDES, marks=pytest.mark.heavy)))
def test_bounds_are_near_what_is_seen(name):
    case = cases.load(usual_case(name))
    subjects, words = subjects_of(name, case, {})
    found = rounding(name, subjects, 10_000, words)
    assert found.holds
    for row in found.outputs:
        assert not row.singular and row.seen <= row.absolute
        assert row.factor is None or row.factor < 10, row


def test_the_command(tmp_path):
    words = ["prove", "crankshaft_flywheel_printed", "--samples", "20", "--range", "M=0..2", "--json"]
    done = CliRunner().invoke(mechsym, words)
    told = json.loads(done.output)
    assert done.exit_code == 0 and told["holds"] and "M = 0..2" in told["statement"]
    assert {"name", "absolute", "relative", "where"} <= set(told["outputs"][0])


@pytest.mark.parametrize(("words", "said"), [
    (["crosshead", "--mode", "fast"], "fast contracts"), (["crosshead", "--range", "q=0..1"], "no such letter"),
    (["crosshead", "--range", "phid=3"], "two ascending"), (["crosshead", "--samples", "0"], "at least 1"),
    (["nothing"], "is not known"), (["crosshead", "--case", "chmielewski"], "no value for"),
])  # fmt: skip
def test_bad_input_is_one_line(words, said, capsys, monkeypatch):
    monkeypatch.setattr(sys, "argv", ["mechsym", "prove", *words])
    with pytest.raises(SystemExit) as ended:
        main()
    assert ended.value.code == 2 and said in capsys.readouterr().err


def test_without_python_flint_it_is_one_line():
    code = "import sys; sys.modules['flint'] = None; from mechsym.cli import main; main()"
    words = ["prove", "crosshead", "--samples", "10"]
    done = subprocess.run([sys.executable, "-c", code, *words], capture_output=True, text=True, check=False)
    assert done.returncode == 2 and "pip install 'mechsym[proof]'" in done.stderr and done.stderr.count("\n") == 1


@pytest.mark.parametrize(("value", "digits", "up", "text"), [
    (3.1768e-14, 2, True, "3.2e-14"), (3.1001, 2, True, "3.2"), (-68.02381, 6, False, "-68.0239"), (0.0, 2, True, "0"),
    (-68.02381, 6, True, "-68.0238"),
])  # fmt: skip
def test_a_bound_is_printed_outwards(value, digits, up, text):
    assert outward(value, digits, up) == text


def test_an_operator_without_a_bound_is_refused():
    with pytest.raises(BadInput, match="no bound of rounding is stated for erf"):
        bound_of(ca.erf(x), [x], [(0.0, 1.0)])
    assert arb(1) == 1
