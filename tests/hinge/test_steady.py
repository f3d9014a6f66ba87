"""Angle domain against closed forms, and against runs in time."""

import dataclasses

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from simulated import oscillator, shaft

from mechsym import mechanisms
from mechsym.errors import BadInput
from mechsym.machine import Machine
from mechsym.machine.loads import ConstantLoad, PropellerLoad, TableLoad, load_torque
from mechsym.machine.record import AngleForce
from mechsym.mechanisms.record import curves
from mechsym.simulate import Settings, simulate
from mechsym.simulate.angle import ReducedMachine, lowest_energy, speeds, stop_angle, tabulate, turn
from mechsym.simulate.engine import problem, reduced
from mechsym.simulate.result import speed_ripple
from mechsym.simulate.steady import (
    flywheel_for_ripple,
    mean_inertia,
    mean_torque,
    smallest_flywheel_that_turns,
    steady_state,
)


def test_the_mean_inertia_weighs_panels_by_their_width():
    # a scotch yoke, I + m r^2 sin^2: half of m r^2 in the mean, wherever its torque has kinks
    yoke = ReducedMachine(
        inertia=lambda phi: 5 + 3 * np.sin(phi) ** 2, torque=np.cos, load=ConstantLoad(torque=0.0), period=2 * np.pi,
        kinks=(1.3, 1.31, 1.35, 1.4, 1.45),
    )  # fmt: skip
    panels = tabulate(yoke)
    assert mean_inertia(panels) == pytest.approx(6.5, rel=1e-13)
    assert np.mean(panels.inertia) > 6.6


def ideal(inertia=100.0, swing=300.0, mean=50.0, load=None, order=1):
    """Constant inertia, torque mean + swing cos(order phi): T = T0 + swing sin(order phi) / order at constant load."""
    return ReducedMachine(
        inertia=lambda phi: np.full(len(phi), inertia),
        torque=lambda phi: mean + swing * np.cos(order * phi),
        load=load or ConstantLoad(torque=mean),
    )


def test_energy_of_a_turn_in_closed_form():
    panels = tabulate(ideal())
    found = turn(panels, 0.0, 1000.0)
    np.testing.assert_allclose(found.energy, 1000.0 + 300.0 * np.sin(panels.phi), rtol=1e-13)
    assert lowest_energy(found) == pytest.approx(700.0, rel=1e-4)
    assert stop_angle(panels, found) is None
    phi, omega, time = speeds(panels, 20.0, found)
    np.testing.assert_allclose(omega, np.sqrt(2 * (1000.0 + 300.0 * np.sin(phi)) / 120.0), rtol=1e-13)
    fine = 2 * np.pi * np.arange(4096) / 4096
    expected = 2 * np.pi * np.mean(1 / np.sqrt(2 * (1000.0 + 300.0 * np.sin(fine)) / 120.0))
    assert time == pytest.approx(expected, rel=1e-12)


def test_stop_angle_in_closed_form():
    panels = tabulate(ideal())
    # T = 200 + 300 sin phi reaches 0 at sin phi = -2/3
    assert stop_angle(panels, turn(panels, 0.0, 200.0)) == pytest.approx(np.pi + np.arcsin(2 / 3), abs=1e-4)


@given(
    st.floats(20, 500), st.floats(1, 10), st.floats(0.05, 0.8), st.floats(2, 20), st.integers(1, 3), st.floats(0, 300)
)
def test_propeller_turn_agrees_with_an_ode_solver(inertia, speed, share, reference, order, flywheel):
    # dT/dphi = Q - M (2 T / I) / omega0^2, linear in T
    load = PropellerLoad(torque=50.0, speed=reference)
    total = inertia + flywheel
    energy = 0.5 * total * speed**2
    panels = tabulate(ideal(inertia=inertia, swing=share * energy * order, load=load, order=order))
    found = turn(panels, flywheel, energy)

    def slope(phi, kinetic):
        drive = 50.0 + share * energy * order * np.cos(order * phi)
        return drive - 50.0 * (2 * kinetic / total) / reference**2

    exact = solve_ivp(slope, (0, 2 * np.pi), [energy], rtol=1e-12, atol=1e-9 * energy, t_eval=[2 * np.pi]).y[0, -1]
    if lowest_energy(found) > 0:
        assert found.energy_edges[-1] == pytest.approx(exact, rel=1e-9)
        assert found.multiplier == pytest.approx(np.exp(-4 * np.pi * 50.0 / reference**2 / total), rel=1e-9)


@pytest.mark.parametrize("inertia", [1.0, 30.0, 1000.0])
@pytest.mark.parametrize("start", [0.0, 40.0, 4000.0])
def test_turn_under_a_table_solves_its_equations(inertia, start):
    # the smallest inertia stops on the way, where the table has a kink of its slope over the energy
    load = TableLoad(speeds=(0.0, 2.0, 5.0, 9.0), torques=(0.0, 30.0, 60.0, 200.0))
    panels = tabulate(ideal(inertia=inertia, load=load))
    found = turn(panels, 0.0, start)
    omega = np.sqrt(2 * np.maximum(found.energy, 0.0) / panels.inertia)
    net, half = panels.torque - load_torque(load, omega), np.diff(panels.edges)[:, None] / 2
    nodes, weights = np.polynomial.legendre.leggauss(net.shape[1])
    size = np.abs(found.energy).max()
    np.testing.assert_allclose(np.diff(found.energy_edges), (half * net) @ weights, atol=1e-13 * size)
    for panel in range(0, len(half), 7):
        torque = np.polynomial.Polynomial.fit(nodes, net[panel], len(nodes) - 1, domain=(-1, 1))
        gained = half[panel] * (torque.integ(lbnd=-1)(nodes))
        np.testing.assert_allclose(found.energy[panel] - found.energy_edges[panel], gained, atol=1e-11 * size)


def test_constant_load_is_neutral():
    found = steady_state(tabulate(ideal()), 5.0)
    assert (found.status, found.multiplier) == ("neutral", 1.0)
    assert found.speed_mean == pytest.approx(5.0, rel=1e-12)
    # the conserved quantity: T - swing sin phi
    constant = 0.5 * 100.0 * found.omega**2 - 300.0 * np.sin(found.phi)
    np.testing.assert_allclose(constant, constant[0], rtol=1e-12)


def test_constant_load_out_of_balance_has_no_steady_motion():
    found = steady_state(tabulate(ideal(load=ConstantLoad(torque=49.0))), 5.0)
    assert found.status == "none" and "gains speed" in found.reason
    assert f"{2 * np.pi:.6g} J" in found.reason
    found = steady_state(tabulate(ideal(load=ConstantLoad(torque=51.0))), 5.0)
    assert found.status == "none" and "slows down" in found.reason


def test_propeller_load_finds_its_speed():
    panels = tabulate(ideal(inertia=1000.0, load=PropellerLoad(torque=200.0, speed=10.0)))
    found = steady_state(panels, 20.0)
    assert found.status == "steady" and 0 < found.multiplier < 1
    # mean torques balance: 200 mean(omega^2) / 100 = 50, the mean over the angle
    once = turn(panels, 0.0, 0.5 * 1000.0 * found.omega[0] ** 2)
    assert once.energy_edges[-1] == pytest.approx(once.energy_edges[0], rel=1e-11)
    assert found.speed_mean == pytest.approx(5.0, rel=1e-2)


def test_rising_drive_of_a_table_is_unstable():
    # a load that falls with speed: the balance exists but does not hold
    load = TableLoad(speeds=(0.0, 5.0, 10.0), torques=(100.0, 50.0, 0.0))
    found = steady_state(tabulate(ideal(inertia=1000.0, swing=20.0, load=load)), 5.0)
    assert found.status == "unstable" and found.multiplier > 1


def test_weak_engine_stops_and_says_where():
    panels = tabulate(ideal(load=PropellerLoad(torque=50.0, speed=1.0)))
    found = steady_state(panels, 1.0)
    assert found.status == "none" and found.omega.size == 0 and found.speed_ripple is None
    # after some turns or in the first: the sine stops it beyond half a turn
    assert "it stops after" in found.reason and "add a flywheel" in found.reason


def test_mean_torque_is_the_balance():
    assert mean_torque(tabulate(ideal(mean=50.0))) == pytest.approx(50.0, rel=1e-13)


def test_flywheel_for_a_ripple():
    panels = tabulate(ideal())
    found = flywheel_for_ripple(panels, 5.0, 0.02)
    assert found.status == "found"
    # two-sided swing of 600 J: (omega_max^2 - omega_min^2) (I + J) / 2 = 600, omega_max - omega_min = 0.02 omega_mean
    steady = steady_state(panels, 5.0, found.inertia)
    assert steady.speed_ripple == pytest.approx(0.02, rel=1e-9)
    assert found.inertia + 100.0 == pytest.approx(600.0 / (0.02 * 25.0), rel=1e-3)
    assert flywheel_for_ripple(panels, 5.0, 20.0).status == "not needed"
    braked = tabulate(ideal(load=ConstantLoad(torque=51.0)))
    nothing = flywheel_for_ripple(braked, 5.0)
    assert nothing.status == "none" and nothing.inertia is None and "slows down" in nothing.reason


def test_smallest_flywheel_in_closed_form():
    # from phi = 0: T0 = 300 J exactly carries it over the dip of 300 J at phi = 270 degrees
    found = smallest_flywheel_that_turns(tabulate(ideal(inertia=10.0)), 5.0)
    assert found.inertia == pytest.approx(2 * 300.0 / 25.0 - 10.0, rel=1e-3)
    assert smallest_flywheel_that_turns(tabulate(ideal()), 5.0).status == "not needed"
    # from 90 degrees the dip is 600 J
    late = smallest_flywheel_that_turns(tabulate(ideal(inertia=10.0), np.pi / 2), 5.0)
    assert late.inertia == pytest.approx(2 * 600.0 / 25.0 - 10.0, rel=1e-3)
    hopeless = smallest_flywheel_that_turns(tabulate(ideal(mean=0.0, load=ConstantLoad(torque=1e6))), 5.0)
    assert hopeless.status in ("found", "none") and (hopeless.inertia is None or hopeless.inertia > 1e4)


def test_panels_end_at_kinks():
    square = ReducedMachine(
        inertia=lambda phi: np.full(len(phi), 100.0),
        torque=lambda phi: np.where(phi % (2 * np.pi) < 2.0, 30.0, 0.0),
        load=ConstantLoad(torque=0.0),
        kinks=(0.0, 2.0),
    )
    assert mean_torque(tabulate(square)) == pytest.approx(60.0 / (2 * np.pi), rel=1e-13)
    assert mean_torque(tabulate(square, phi_start=1.234)) == pytest.approx(60.0 / (2 * np.pi), rel=1e-13)


def test_bad_machines_are_refused():
    with pytest.raises(BadInput, match="torque = nan"):
        tabulate(dataclasses.replace(ideal(), torque=lambda phi: np.full(len(phi), np.nan)))
    with pytest.raises(BadInput, match="inertia = -1"):
        tabulate(dataclasses.replace(ideal(), inertia=lambda phi: np.full(len(phi), -1.0)))
    with pytest.raises(BadInput, match="has dampers"):
        reduced(Machine(mechanism=oscillator(damping=1.0), load=ConstantLoad(torque=0.0), load_input="M"))
    with pytest.raises(BadInput, match="no input 'M_x'"):
        Machine(mechanism=shaft(), load=ConstantLoad(torque=0.0), load_input="M_x")


SPEED = 9.32


def gas(phi):
    """A smooth force on the piston that drives on the way down."""
    return 2e4 * (1 + np.cos(phi)) ** 2 + 1.2e5 * np.exp(-((np.sin(phi / 2) / 0.5) ** 2)) * (1 + np.sin(phi))


def engine_of(parameters, load, hinge=False):
    """The crosshead engine with that gas, and the exact hinge torque at SPEED."""
    mechanism = mechanisms.build("crosshead", parameters)
    forces = [AngleForce(name="gas", input="F", value=gas)]
    engine = Machine(mechanism=mechanism, forces=tuple(forces), load=ConstantLoad(torque=0.0))
    bare = reduced(engine)
    mean = mean_torque(tabulate(bare))

    def torque(phi):
        return 0.5 * SPEED**2 * curves(mechanism, phi)["dinertia_dphi"] - bare.torque(phi) + mean

    if hinge:
        forces.append(AngleForce(name="hinge", input="M_h", role="store", value=torque))
    law = load(mean)
    return dataclasses.replace(engine, forces=tuple(forces), load=law)


def constant(torque):
    return ConstantLoad(torque=torque)


def propeller(torque):
    return PropellerLoad(torque=torque, speed=SPEED)


@pytest.mark.parametrize("load", [constant, propeller])
def test_exact_hinge_keeps_the_speed(zotov, load):
    engine = engine_of(zotov, load, hinge=True)
    result = simulate(problem(engine, SPEED, 5), Settings())
    assert result.status == "converged" and result.end == "turns"
    assert np.ptp(result.columns["phid"]) / SPEED < 1e-9
    assert abs(result.energy.residual) < 1e-9
    assert steady_state(tabulate(reduced(engine)), SPEED).speed_ripple < 1e-12


def test_start_one_per_cent_off_keeps_its_ripple_at_constant_load(zotov):
    engine = engine_of(zotov, constant, hinge=True)
    result = simulate(problem(engine, 1.01 * SPEED, 12), Settings())
    phi, phid = result.columns["phi"], result.columns["phid"]
    inertia = curves(engine.mechanism, phi)["inertia"]
    conserved = inertia * (phid**2 - SPEED**2)
    # a small difference of large numbers
    np.testing.assert_allclose(conserved, conserved[0], rtol=0, atol=2e-8 * inertia.max() * SPEED**2)
    first = result.t < 2 * np.pi / SPEED
    assert speed_ripple(result, "phi") == pytest.approx(np.ptp(phid[first]) / SPEED, rel=1e-2)
    assert 0.006 < speed_ripple(result, "phi") < 0.01


def test_start_one_per_cent_off_dies_out_under_propeller_load(zotov):
    engine = engine_of(zotov, propeller, hinge=True)
    result = simulate(problem(engine, 1.01 * SPEED, 12), Settings())
    assert np.abs(result.columns["phid"][-100:] / SPEED - 1).max() < 1e-8


@pytest.mark.parametrize("load", [constant, propeller])
def test_flywheel_is_right_when_run_in_time(zotov, load):
    engine = engine_of(zotov, load)
    found = flywheel_for_ripple(tabulate(reduced(engine)), SPEED, 0.02)
    steady = steady_state(tabulate(reduced(engine)), SPEED, found.inertia)
    heavy = mechanisms.build("crosshead", dataclasses.replace(zotov, I01=zotov.I01 + found.inertia))
    result = simulate(problem(dataclasses.replace(engine, mechanism=heavy), float(steady.omega[0]), 3), Settings())
    assert result.status == "converged" and abs(result.energy.residual) < 1e-8
    assert speed_ripple(result, "phi") == pytest.approx(0.02, rel=1e-3)
    assert result.columns["phid"][-1] == pytest.approx(steady.omega[0], rel=1e-8)
    # the speed around the turn agrees with the angle domain point by point
    around = np.interp(result.columns["phi"][:300], steady.phi, steady.omega)
    np.testing.assert_allclose(result.columns["phid"][:300], around, rtol=1e-5)


def test_engine_without_hinge_stalls_where_the_angle_domain_says(zotov):
    engine = engine_of(zotov, propeller)
    panels = tabulate(reduced(engine))
    result = simulate(problem(engine, SPEED, 5), Settings())
    assert result.event.name == "stall"
    energy = 0.5 * panels.inertia_edges[0] * SPEED**2
    expected = stop_angle(panels, turn(panels, 0.0, energy))
    assert result.event.state["phi"] == pytest.approx(expected, abs=2e-3)
    least = smallest_flywheel_that_turns(panels, SPEED, turns=3).inertia
    for factor, end in ((0.99, "stall"), (1.01, "turns")):
        heavy = mechanisms.build("crosshead", dataclasses.replace(zotov, I01=zotov.I01 + factor * least))
        assert simulate(problem(dataclasses.replace(engine, mechanism=heavy), SPEED, 3), Settings()).end == end


def test_four_stroke_period(zotov):
    engine = dataclasses.replace(
        engine_of(zotov, constant),
        forces=(AngleForce(name="gas", input="F", value=lambda phi: gas(phi) * (1 + 0.5 * np.cos(phi / 2))),),
        period=4 * np.pi,
    )
    panels = tabulate(reduced(engine))
    panels = dataclasses.replace(panels, load=ConstantLoad(torque=mean_torque(panels)))
    steady = steady_state(panels, SPEED, 3e5)
    assert steady.phi[-1] == pytest.approx(4 * np.pi)
    assert steady.speed_mean == pytest.approx(SPEED, rel=1e-12)
    assert steady.omega[-1] == pytest.approx(steady.omega[0], rel=1e-12)
    middle = np.interp(2 * np.pi, steady.phi, steady.omega)
    assert abs(middle - steady.omega[0]) > 1e-4 * SPEED  # one turn alone does not repeat
