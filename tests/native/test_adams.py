"""Steps that look back, along arc lengths: series, order, tolerance, levels, wanted times, and where they are taken."""

import shutil
from fractions import Fraction

import casadi as ca
import numpy as np
import pytest
from native.models import functions, rhs

from mechsym import native
from mechsym.errors import BadInput
from mechsym.native import adams, arc
from mechsym.native import integrate as integration
from mechsym.native.integrate import integrate
from mechsym.native.runs import Breaks, Level, Runs

compiled = pytest.mark.skipif(not any(map(shutil.which, ("gcc", "clang", "cc"))), reason="no C compiler")
slow = pytest.mark.slow


def disc() -> ca.Function:
    """A disc with masses on skew tracks: inertia with sines and cosines; drive, weight, damping; work and heat."""

    def rates(t, y, p):
        q, u = y[0], y[1]
        inertia = 2 + p[1] * (0.1 * ca.sin(q) + 0.1 * ca.cos(2 * q) + 0.05 * ca.sin(2 * q))
        torque = p[0] - 3 * ca.sin(q) - 0.01 * u + 0.1 * ca.cos(t)
        return u, (torque - ca.gradient(inertia, q) * u**2 / 2) / inertia, p[0] * u, 0.01 * u**2

    return rhs("disc", 4, 2, rates)


def flywheel() -> ca.Function:
    acceleration = functions("crankshaft_flywheel")["acceleration"]
    return rhs("flywheel", 4, 1, lambda t, y, p: (y[2], y[3], acceleration(*y, p[0], 0)))


def discs(count: int = 9, **changed) -> Runs:
    rng = np.random.default_rng(5)
    held = np.stack([rng.uniform(2, 4, count), rng.uniform(0.2, 1.2, count)], axis=1)[:, None].repeat(2, axis=1)
    held[:, 1, 0] *= -0.2
    start = np.zeros((count, 4))
    start[:, 1] = rng.uniform(8, 20, count)
    until = np.stack([rng.uniform(80, 120, count), np.full(count, 300.0)], axis=1)
    return Runs(**{"rhs": disc(), "start": start, "until": until, "held": held, **changed})


def test_weights_integrate_polynomials():
    nodes = [1 - j for j in range(4)]
    once, twice = adams.integrals(adams.lagrange(nodes))
    for power in range(4):
        values = [x**power for x in nodes]
        assert sum(v * sum(row) for v, row in zip(values, once, strict=True)) == Fraction(1, power + 1)
        by_hand = Fraction(1, (power + 1) * (power + 2))
        assert sum(v * sum(row) for v, row in zip(values, twice, strict=True)) == by_hand


@pytest.mark.parametrize("strength", [0.3, 1.2])
def test_series_of_an_arc_length(strength):
    form = arc.form(disc().serialize())
    found = arc.arcs(form, np.array([[[2.0, strength]]]).tobytes(), (1, 1, 2))
    assert not found.even
    assert found.turns
    x = np.linspace(0, 6, 50)
    both = [np.polynomial.polynomial.polyval(np.cos(x), found.series[0, j, :, 0]) for j in range(6)]
    slope, q, bend = (both[2 * j] + np.sin(x) * both[2 * j + 1] for j in range(3))
    inertia = 2 + strength * (0.1 * np.sin(x + q) + 0.1 * np.cos(2 * (x + q)) + 0.05 * np.sin(2 * (x + q)))
    np.testing.assert_allclose(slope**2 * inertia * found.scale[0, 0], 1, atol=1e-13)
    step = 1e-5
    near = [np.polynomial.polynomial.polyval(np.cos(x + s), found.series[0, j, :, 0]) for s in (step, -step)
            for j in range(2)]  # fmt: skip
    ahead, behind = near[0] + np.sin(x + step) * near[1], near[2] + np.sin(x - step) * near[3]
    np.testing.assert_allclose(bend, (ahead - behind) / (2 * step), atol=1e-9)


def test_what_has_no_form():
    coupled = rhs("coupled", 4, 0, lambda t, y, p: (y[2], y[3], -(y[2] ** 2) / (2 + ca.cos(y[0] - y[1])), -y[1]))
    assert arc.form(coupled.serialize()) is None
    # a term in the square of the speed that is not that of the inertia, by a hundredth of its half
    wrong = rhs("wrong", 2, 0, lambda t, y, p: (y[1], (1.0 + 0.505 * ca.sin(y[0]) * y[1] ** 2) / (3 + ca.cos(y[0]))))
    assert arc.arcs(arc.form(wrong.serialize()), np.ones((1, 1, 0)).tobytes(), (1, 1, 0)) is None
    right = rhs("right", 2, 0, lambda t, y, p: (y[1], (1.0 + 0.5 * ca.sin(y[0]) * y[1] ** 2) / (3 + ca.cos(y[0]))))
    assert arc.arcs(arc.form(right.serialize()), np.ones((1, 1, 0)).tobytes(), (1, 1, 0)).even
    # nor is that of the printed model, beside a stiff spring
    printed = functions("crankshaft_flywheel_printed")["acceleration"]
    wrong = rhs("wrong", 4, 1, lambda t, y, p: (y[2], y[3], printed(*y, p[0])))
    assert arc.arcs(arc.form(wrong.serialize()), np.ones((1, 1, 1)).tobytes(), (1, 1, 1)) is None
    # the crosshead's inertia varies fourfold within a turn: too many terms
    acceleration = functions("crosshead")["acceleration"]
    long = arc.form(rhs("long", 2, 0, lambda t, y, p: (y[1], acceleration(*y, 1.0, 0, 0))).serialize())
    assert arc.arcs(long, np.ones((1, 1, 0)).tobytes(), (1, 1, 0)) is None
    bumpy = rhs("bumpy", 2, 0, lambda t, y, p: (y[1], -ca.fabs(y[0])))
    assert arc.form(bumpy.serialize()) is None


@compiled
@slow
def test_errors_against_a_run_at_the_tightest_tolerance():
    times = np.linspace(1.0, 299.0, 60)
    exact = integrate(discs(times=times, rtol=1e-13, atol=1e-13), "dop853")
    errors = {}
    for tolerance in (1e-7, 1e-9, 1e-11):
        for method in ("dop853", "adams"):
            found = integrate(discs(times=times, rtol=tolerance, atol=tolerance), method)
            assert (found.status == 0).all()
            np.testing.assert_array_equal(found.t, exact.t)
            errors[method, tolerance] = np.max(np.abs(found.samples - exact.samples) / (1 + np.abs(exact.samples)))
        assert errors["adams", tolerance] < 3 * errors["dop853", tolerance]
    assert found.steps.max() > 1.5 * integrate(discs(times=times, rtol=1e-11, atol=1e-11), "dop853").steps.max()
    again = integrate(discs(times=times, rtol=1e-11, atol=1e-11), "adams")
    np.testing.assert_array_equal(again.samples, found.samples)


@compiled
@slow
def test_runs_end_on_surfaces():
    # slowed down to rest in the second segment
    surfaces = (Level(state=1, level=0.5, direction=-1), Level(state=0, level=1e6))
    exact = integrate(discs(surfaces=surfaces, rtol=1e-13, atol=1e-13), "dop853")
    found = integrate(discs(surfaces=surfaces, rtol=1e-10, atol=1e-10), "adams")
    np.testing.assert_array_equal(found.met, exact.met)
    np.testing.assert_allclose(found.t, exact.t, rtol=1e-8)
    np.testing.assert_allclose(found.y, exact.y, rtol=1e-6, atol=1e-6)
    met = found.met == 0
    assert met.any()
    np.testing.assert_allclose(found.y[met, 1], 0.5, atol=1e-12)


@compiled
@slow
def test_start_ups_balance_their_energy_and_keep_the_tolerance():
    start = np.zeros((16, 4))
    start[:, :2] = np.linspace(0, 0.4, 16)[:, None]
    common = dict(rhs=flywheel(), start=start, until=np.array([60.0]), held=np.array([[1.5]]))
    exact = integrate(Runs(**common, rtol=1e-13, atol=1e-13), "dop853").y
    before = native.compiled(functions("crankshaft_flywheel")["energy"]).batch(*start.T).sum(axis=0)
    errors, steps = [], []
    for tolerance in (1e-8, 1e-10):
        found = integrate(Runs(**common, rtol=tolerance, atol=tolerance))
        there = integrate(Runs(**common, rtol=tolerance, atol=tolerance), "dop853")
        # `auto` took them
        assert found.steps.min() > 2 * there.steps.max()
        errors.append(np.max(np.abs(found.y - exact)))
        steps.append(found.steps.mean())
        assert errors[-1] < 2 * np.max(np.abs(there.y - exact))
        energy = native.compiled(functions("crankshaft_flywheel")["energy"]).batch(*found.y.T).sum(axis=0)
        residual = (1.5 * (found.y[:, 0] - start[:, 0]) - (energy - before)) / energy
        assert np.max(np.abs(residual)) < {1e-8: 1e-6, 1e-10: 1e-8}[tolerance]
    # errors fall with a high power of the steps
    assert np.log(errors[0] / errors[1]) / np.log(steps[1] / steps[0]) > 8


def test_where_it_is_not_taken():
    kinks = (Breaks(state=0, angles=np.array([1.0]), period=6.0),)
    with pytest.raises(BadInput, match="method 'adams' takes"):
        integrate(discs(kinks=kinks), "adams")
    with pytest.raises(BadInput, match="surfaces are of angles"):
        integrate(discs(surfaces=(Level(state=2, level=1.0),)), "adams")
    batch = integration._spread(discs(), "fast")
    assert integration._chosen(batch, "fast") == "adams"
    assert integration._chosen(batch, "strict") == "dop853"
    assert integration._chosen(integration._spread(discs(kinks=kinks), "fast"), "fast") == "dop853"
