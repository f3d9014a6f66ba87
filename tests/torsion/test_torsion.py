"""Torsional analysis of the crankshaft with flywheel against closed forms and against a direct solution."""

import dataclasses

import casadi as ca
import numpy as np
import pytest
from simulated import mechanism as build

from mechsym import mechanisms
from mechsym.errors import BadInput
from mechsym.mechanisms import crank_train, crankshaft_flywheel
from mechsym.simulate import Part, Problem, Settings, Steps, simulate
from mechsym.torsion import modes as torsion


def series_of_piston(p):
    """m0 x0' x0'' over a turn from the exact travel, by finite Fourier sums of the closed form."""
    phi = 2 * np.pi * np.arange(4096) / 4096
    lam = p.r / p.l
    root = np.sqrt(1 - (lam * np.sin(phi)) ** 2)
    first = p.r * (np.sin(phi) + lam * np.sin(phi) * np.cos(phi) / root)
    second = np.real(np.fft.ifft(1j * np.fft.fftfreq(4096, 1 / 4096) * np.fft.fft(first)))
    return p.m0 * first * second, p.m0 * np.mean(first**2)


def test_bare_natural_frequency(chmielewski):
    p = chmielewski
    bare = torsion.matrices(crankshaft_flywheel.build(dataclasses.replace(p, m0=0.0)))
    found = torsion.modes(bare.mass, bare.stiffness).frequencies
    assert found[0] == 0
    assert found[1] == pytest.approx(np.sqrt(p.k1 * (1 / p.I0 + 1 / p.I2)), rel=1e-12)
    assert found[1] == pytest.approx(190.281, abs=5e-4)  # stated in the problem, rad/s


def test_mean_reciprocating_inertia(chmielewski):
    p = dataclasses.replace(chmielewski, c1=0.7)
    found = torsion.matrices(crankshaft_flywheel.build(p))
    mean = series_of_piston(p)[1]
    np.testing.assert_allclose(found.mass, [[p.I0 + mean, 0], [0, p.I2]], atol=1e-14)
    np.testing.assert_allclose(found.stiffness, p.k1 * np.array([[1, -1], [-1, 1]]), atol=1e-9)
    np.testing.assert_allclose(found.damping, p.c1 * np.array([[1, -1], [-1, 1]]), atol=1e-12)


def test_shapes_are_mass_normalised():
    rng = np.random.default_rng(7)
    root = rng.normal(size=(4, 4))
    mass = root @ root.T + 4 * np.eye(4)
    chain = np.array([[1, -1, 0, 0], [-1, 3, -2, 0], [0, -2, 5, -3], [0, 0, -3, 3]]) * 1e4
    found = torsion.modes(mass, chain)
    np.testing.assert_allclose(found.shapes.T @ mass @ found.shapes, np.eye(4), atol=1e-12)
    np.testing.assert_allclose(found.shapes.T @ chain @ found.shapes, np.diag(found.frequencies**2), atol=1e-7)
    assert found.frequencies[0] == 0


def test_orders_of_the_reciprocating_inertia(chmielewski):
    torque, _ = series_of_piston(chmielewski)
    expected = 2 * np.fft.rfft(-torque)[1:9] / 4096
    found = torsion.orders(crankshaft_flywheel.build(chmielewski), count=8)
    np.testing.assert_allclose(found.inertia[:, 0], expected, atol=1e-15)
    np.testing.assert_array_equal(found.inertia[:, 1], 0)
    np.testing.assert_array_equal(found.order, np.arange(1, 9))
    # leading terms of the usual series: 1/4 lam, 1/2, 3/4 lam of m r^2
    p, lam = chmielewski, chmielewski.r / chmielewski.l
    np.testing.assert_allclose(np.abs(found.inertia[:3, 0]) / (p.m0 * p.r**2), [lam / 4, 1 / 2, 3 / 4 * lam], rtol=0.03)


def test_orders_of_a_four_stroke_gas_force(chmielewski):
    mechanism = crankshaft_flywheel.build(chmielewski)
    found = torsion.orders(mechanism, count=3, gas={"F": lambda phi: 100 * np.cos(phi / 2)}, period=4 * np.pi)
    np.testing.assert_array_equal(found.order, [0.5, 1, 1.5, 2, 2.5, 3])
    # 100 cos(phi/2) r sin(phi) has the half orders 0.5 and 1.5 of equal size, to the first order in r/l
    sizes = np.abs(found.gas[:, 0])
    assert sizes[0] == pytest.approx(50 * chmielewski.r, rel=0.2) and sizes[2] == pytest.approx(
        50 * chmielewski.r, rel=0.2
    )
    np.testing.assert_allclose(sizes[[1, 3, 5]], 0, atol=1e-12)


def test_holding_torque_is_the_power_at_resonance(chmielewski):
    """The mean power into the damper, from the linear equations solved at the critical speed without modes."""
    p = dataclasses.replace(chmielewski, c1=0.4)
    mechanism = crankshaft_flywheel.build(p)
    linear = torsion.matrices(mechanism)
    excitation = torsion.orders(mechanism)
    criticals = torsion.critical_speeds(torsion.modes(linear.mass, linear.stiffness), excitation, linear.damping)
    assert [c.order for c in criticals] == sorted(c.order for c in criticals)
    for critical in criticals[:4]:
        frequency = critical.order * critical.speed
        force = excitation.inertia[int(critical.order) - 1] * critical.speed**2
        dynamic = linear.stiffness - frequency**2 * linear.mass + 1j * frequency * linear.damping
        twist_rate = 1j * frequency * np.array([1, -1]) @ np.linalg.solve(dynamic, force)
        power = p.c1 * abs(twist_rate) ** 2 / 2
        assert critical.holding_torque == pytest.approx(power / critical.speed, rel=1e-3)
        back = torsion.holding_damping(critical, critical.holding_torque, critical.damping / p.c1)
        assert back == pytest.approx(p.c1, rel=1e-12)


def test_no_damping_no_holding_torque(chmielewski):
    linear = torsion.matrices(crankshaft_flywheel.build(chmielewski))
    excitation = torsion.orders(crankshaft_flywheel.build(chmielewski))
    modes = torsion.modes(linear.mass, linear.stiffness)
    assert {c.holding_torque for c in torsion.critical_speeds(modes, excitation, linear.damping)} == {None}


def test_three_discs_with_two_modes():
    inertias, springs = [0.3, 0.2, 0.9], [5000.0, 8000.0]

    def potential(q):
        return springs[0] * (q[0] - q[1]) ** 2 / 2 + springs[1] * (q[1] - q[2]) ** 2 / 2

    chain = build(
        ["a", "b", "c"],
        ["M"],
        mass=lambda q: ca.diag(ca.DM(inertias)),
        bias=lambda q, u: ca.SX.zeros(3, 1),
        force=lambda q, u, w: ca.vertcat(w[0], 0, 0) - ca.gradient(potential(q), ca.vertcat(*q)),
        kinetic=lambda q, u: sum(i * v**2 for i, v in zip(inertias, u, strict=True)) / 2,
        potential=potential,
    )
    linear = torsion.matrices(chain)
    found = torsion.modes(linear.mass, linear.stiffness).frequencies
    # the two non-zero roots of the frequency equation of three discs
    i1, i2, i3 = inertias
    k1, k2 = springs
    b = k1 * (1 / i1 + 1 / i2) + k2 * (1 / i2 + 1 / i3)
    c = k1 * k2 * (i1 + i2 + i3) / (i1 * i2 * i3)
    np.testing.assert_allclose(found[1:] ** 2, np.sort(np.roots([1, -b, c])), rtol=1e-12)


def test_balanced_in_line_six_keeps_orders_three_and_six():
    degrees = np.pi / 180
    six = crank_train.build(
        crank_train.CrankTrainParameters(
            throw=(1, 2, 3, 4, 5, 6), phase=tuple(degrees * a for a in (0, 240, 120, 120, 240, 0)),
            r=0.05, l1=0.05, l2=0.1, m_rod=0.6, m_piston=0.5, I_rod=0.003, I0=0.02, I_f=0.3, k=1e5, c=2.0,
        )
    )  # fmt: skip
    linear = torsion.matrices(six)
    found = torsion.modes(linear.mass, linear.stiffness).frequencies
    assert len(found) == 7 and found[0] == 0 and np.all(np.diff(found) > 0)
    sums = np.abs(torsion.orders(six, count=8).inertia.sum(axis=1))
    np.testing.assert_array_equal(np.flatnonzero(sums > 1e-12) + 1, [3, 6])
    load = Part(name="load", input="M", role="load", value=Steps(values=(5.0,)))
    result = simulate(Problem(mechanism=six, parts=(load,), q0=(0.0,) * 7, u0=(100.0,) * 7, t_end=0.1), Settings())
    assert result.status == "converged" and abs(result.energy.residual) < 1e-9


def test_model_without_energies_is_refused(chmielewski):
    with pytest.raises(BadInput, match="has no energies"):
        torsion.matrices(mechanisms.build("crankshaft_flywheel_printed", chmielewski))
