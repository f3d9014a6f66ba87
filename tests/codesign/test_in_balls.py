"""The bound in balls: integrals against closed forms, doubles beside them; laws that are none are no proof."""

import dataclasses
import json
import math
from pathlib import Path

import casadi as ca
import numpy as np
import pytest
from click.testing import CliRunner

from mechsym import cases, codesign
from mechsym.cli import mechsym
from mechsym.codesign.certificate import Terms, enclosed, proofs
from mechsym.codesign.points import sample
from mechsym.errors import BadInput
from mechsym.jobs.codesign import settings_of, task_of
from mechsym.jobs.machine import machine
from mechsym.native.tape import read

pytest.importorskip("flint")

from mechsym.proof.work import integrals  # noqa: E402

EXAMPLES = Path(__file__).parents[2] / "examples/mechanisms"
x = ca.SX.sym("x")


def piece(low, high, value):
    return low, high, read(ca.Function("law", [x], [value]))


@pytest.mark.parametrize(("value", "integral"), [
    (ca.sin(x), lambda a, b: math.cos(a) - math.cos(b)), (ca.exp(-x), lambda a, b: math.exp(-a) - math.exp(-b)),
    (x**1.3, lambda a, b: (b**2.3 - a**2.3) / 2.3), (ca.SX(2.5) + 0 * x, lambda a, b: 2.5 * (b - a)),
    (ca.fmax(x, 0.0) ** 1.5, lambda a, b: (b**2.5 - a**2.5) / 2.5),
])  # fmt: skip
def test_an_integral_holds_its_closed_form(value, integral):
    start = 0.0
    for angle, ball in zip((0.3, 1.0), integrals([piece(start, 1.2, value)], [0.3, 1.0]), strict=True):
        low, high, exact = float(ball.lower()), float(ball.upper()), integral(start, angle)
        assert low - 1e-15 <= exact <= high + 1e-15 and high - low < 1e-6 * max(exact, 1e-3)


def test_pieces_follow_each_other():
    both = integrals([piece(0.0, 1.0, ca.sin(x)), piece(1.0, 2.0, ca.cos(x))], [1.5, 2.0])
    exact = 1 - math.cos(1.0) + math.sin(1.5) - math.sin(1.0)
    assert float(both[0].mid()) == pytest.approx(exact, abs=1e-6) and both[0].contains(both[0].mid())


@pytest.mark.parametrize("value", [ca.fabs(x - 0.5), ca.fmax(x, 0.5), 1 / (x - 0.5), ca.if_else(x < 0.5, x, 1)])
def test_a_law_that_is_not_smooth_is_refused(value):
    with pytest.raises(BadInput, match="cannot be enclosed"):
        integrals([piece(0.1, 1.0, value)], [1.0])


@pytest.fixture(scope="module")
def points():
    case = cases.load("zotov-89")
    settings = settings_of(case)
    return task_of(case, dataclasses.replace(settings, speeds=(settings.speeds[0], settings.speeds[-1]))).points


@pytest.mark.parametrize("law", ["constant", "propeller"])
def test_balls_hold_what_doubles_prove_and_no_more(points, law):
    phi, terms = sample(points, 180).phi, Terms(rollers=5.0, ambient=100.0)
    at = [dataclasses.replace(p, law=law) for p in points]
    (proof,) = proofs(at, phi, 0.05, terms, 1)
    proven = enclosed(at, phi, 0.05, terms, proof.points)
    assert (1 - 1e-4) * proof.total_inertia < proven <= proof.total_inertia * (1 + 1e-12)


def test_other_formulas_than_those_of_the_work_are_no_proof(points):
    phi = sample(points, 180).phi
    (proof,) = proofs(points, phi, 0.05, Terms(), 1)
    pieces = tuple((a, b, ca.Function("torque", [x], [1.001 * f(x)])) for a, b, f in points[0].formulas)
    with pytest.raises(BadInput, match="not those of the work"):
        enclosed([dataclasses.replace(points[0], formulas=pieces), *points[1:]], phi, 0.05, Terms(), proof.points)
    with pytest.raises(BadInput, match="no formula"):
        enclosed([dataclasses.replace(p, inertia_formula=None) for p in points], phi, 0.05, Terms(), proof.points)


def point_of(name, faster=1.0):
    at = machine(cases.load(name))
    return codesign.point(dataclasses.replace(at, omega=faster * at.omega), 0.0, "constant")


OWN = (*(str(EXAMPLES / f"{name}.toml") for name in ("compressor", "scotch-yoke", "v-twin")), "generator")


@pytest.mark.parametrize("name", ["zotov-89", *OWN])
def test_formulas_are_the_torque(name, points):
    for point in points if name == "zotov-89" else [point_of(name)]:
        assert point.formulas[0][0] <= 0 < point.formulas[-1][1]  # every angle of a period has one
        for low, high, formula in point.formulas:
            angles = np.linspace(low, high, 7)[1:-1]
            assert [float(formula(a)) for a in angles] == pytest.approx(point.torque(angles), rel=1e-9, abs=1e-6)


@pytest.mark.parametrize("name", OWN)
def test_balls_hold_other_gases_and_several_pistons(name):
    # at another speed the shape is another, which one spring cannot follow
    at = [point_of(name), point_of(name, 1.4)]
    phi = sample(at, 180).phi
    (proof,) = proofs(at, phi, 0.02, Terms(), 1)
    proven = enclosed(at, phi, 0.02, Terms(), proof.points)
    assert 0 < proven <= proof.total_inertia * (1 + 1e-12) and proven > (1 - 1e-3) * proof.total_inertia


@pytest.mark.slow
@pytest.mark.parametrize(("words", "proven"), [((), True), (("--set", "cycle.kind=two-stroke-zone"), False)])
def test_the_command_says_proven_of_what_balls_prove_alone(words, proven):
    done = CliRunner().invoke(
        mechsym, ["codesign", "zotov-89", "--speeds", "75,105", "--losses", "none", "--json", *words]
    )
    bound = json.loads(done.stdout)["bound"]
    assert bound["total_inertia"][0] > 0
    assert bound["proven"] is proven and (bound["kind"] == "proven") is proven
    assert proven or "not proven" in bound["kind"]
