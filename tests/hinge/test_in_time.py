"""Runs in time with a real hinge: every loss against a sum over the angle, mass against the closed form, the balance.

The sums over the angle are written out here, from the path of the guide and the speed of the run.
"""

import dataclasses

import numpy as np
import pytest

from mechsym import cases, jobs
from mechsym.errors import BadInput
from mechsym.hinge.balance import propeller_load_speed, ripple
from mechsym.hinge.guide import gas_turn, path
from mechsym.mechanisms.record import curves
from mechsym.simulate.problem import Along, Problem, State

AIR_THERMAL = {"spring.law": "air_thermal", "spring.tau": 0.139, "spring.gamma": 1.4}
FRICTION = {"losses.bearing_mu": 0.002, "losses.bearing_radius": 0.03, "losses.seal_mu": 0.02, "losses.guide_mu": 0.04}
MASS = {"rollers.moving_mass": 100, "rollers.friction": "rolling", "rollers.rolling_arm": 2e-5}


def run_of(name="zotov-89", **changes):
    return jobs.hinge(cases.load(name, {"trials.turns": 5, **changes}))


def thermal(tmp_path, **changes):
    text = cases.text("zotov-89")
    start, end = text.index("[spring]"), text.index("[guide]")
    file = tmp_path / "warm.toml"
    spring = '[spring]\nlaw = "air_thermal"\nA = 0.031\nH = 1.0\np0 = "5 MPa"\ntau = 0.139\n\n'
    file.write_text(text[:start] + spring + text[end:])
    return jobs.hinge(cases.load(str(file), {"trials.turns": 5, **changes}))


def last_turn(found, count=7200):
    """Angles of the last turn, the speed there, and the path with its derivatives by the crank."""
    columns = found.check.result.columns
    end = columns["phi"][-1]
    phi = end - 2 * np.pi + np.arange(count) * 2 * np.pi / count
    rho = path(found.guide)
    speed = np.interp(phi, columns["phi"], columns["phid"])
    return phi, speed, rho(phi), rho.derivative()(phi), rho.derivative(2)(phi)


@pytest.fixture(scope="module")
def heavy():
    return run_of(**FRICTION, **MASS)


def test_each_loss_in_time_is_its_sum_over_the_angle(heavy):
    phi, u, rho, slope, bend = last_turn(heavy)
    F = heavy.guide.spring.force(2 * (heavy.guide.parameters.rho0 - rho))
    alpha = np.arctan(slope / rho)
    N = (F + 100 * u**2 * (rho - bend)) / np.cos(alpha)
    way, r = np.sqrt(rho**2 + slope**2), heavy.rollers.radius
    # the piston's guide carries the track's torque less what turns the mass: d(m rho^2 u)/dt, half for each roller
    side = N * np.sin(alpha) - 2 * 100 * u**2 * slope
    expected = {
        "bearing": np.mean(2 * 0.002 * N * 0.03 * (way / r + 1)),
        "seal": np.mean(2 * 0.02 * np.abs(F * slope)),
        "guide": np.mean(2 * 0.04 * np.abs(side * slope)),
        "rolling": np.mean(2 * 2e-5 * N / r * way),
        "gas": 0.0,
    }
    assert heavy.check.losses == pytest.approx(expected, rel=2e-4)


def test_the_balance_with_all_losses_closes(heavy):
    energy = heavy.check.result.energy
    assert set(energy.losses) == {"bearing", "seal", "guide", "rolling"}
    assert all(lost > 0 for lost in energy.losses.values())
    assert abs(energy.residual) < 1e-9
    assert heavy.check.result.status == "converged"


def test_a_balance_that_forgets_one_loss_would_not_close(heavy):
    energy = heavy.check.result.energy
    for lost in energy.losses.values():
        assert abs(lost / energy.work_in) > 1e-4


def test_losses_in_time_are_those_of_the_price_where_speed_does_not_matter():
    found = run_of(**FRICTION)
    for kind in ("bearing", "seal", "guide"):
        assert found.check.losses[kind] == pytest.approx(getattr(found.price.losses, kind), rel=1e-4)


def test_mass_on_the_rollers_ripples_as_the_closed_form_says():
    found = run_of(**{"rollers.moving_mass": 100, "trials.turns": 6})
    count = 3600
    phi = np.arange(count) * 2 * np.pi / count
    rho = path(found.guide)
    mass = 2 * 100 * (rho(phi) ** 2 + rho.derivative()(phi) ** 2)
    inertia = curves(found.machine.mechanism, phi)["inertia"] + mass
    omega = found.machine.omega
    missing = omega**2 / 2 * (mass - mass[0])  # the guide was cut for massless rollers
    expected = ripple(propeller_load_speed(missing, inertia, omega, found.hinge.load_torque, 2 * np.pi))
    run = next(t for t in found.trials if t.name == "hinge_propeller")
    assert run.speed_ripple == pytest.approx(expected, rel=2e-3)
    assert abs(run.result.energy.residual) < 1e-9


@pytest.mark.slow
def test_a_gas_with_a_wall_loses_in_time_what_its_steady_turn_loses(tmp_path):
    found = thermal(tmp_path)
    run = found.check
    steady = gas_turn(dataclasses.replace(found.guide, omega=found.machine.omega))
    assert run.losses["gas"] == pytest.approx(steady.loss / (2 * np.pi), rel=1e-4)
    assert run.losses["gas"] > 0.05 * found.hinge.load_torque  # 8 % of the load: no rounding
    assert run.speed_ripple < 1e-4
    energy = run.result.energy
    assert abs(energy.residual) < 1e-9
    assert set(energy.losses) == {"spring_heat"}
    # what the hinge keeps of the crank's work went into the wall: the gas comes back to its state
    assert -energy.work["hinge"] == pytest.approx(energy.losses["spring_heat"], rel=1e-4)


@pytest.mark.slow
def test_a_gas_with_all_other_losses_balances(tmp_path):
    found = thermal(tmp_path, **FRICTION, **MASS)
    energy = found.check.result.energy
    assert set(energy.losses) == {"bearing", "seal", "guide", "rolling", "spring_heat"}
    # the path of such a spring is made of cubics: the inertia's slope has small jumps, which cost more than a digit
    assert abs(energy.residual) < 5e-8


@pytest.mark.parametrize("spring", [{"law": "air_absolute"}, {"law": "coil", "F0": 6e4, "k": 4e5}], ids=["air", "coil"])
def test_losses_act_on_every_spring(tmp_path, spring):
    text = cases.text("zotov-89")
    start, end = text.index("[spring]"), text.index("[guide]")
    own = {"H": 1.0} | ({"A": 0.031, "p0": 5e6, "n": 1.25} if spring["law"] == "air_absolute" else {}) | spring
    lines = [f'{key} = "{value}"' if isinstance(value, str) else f"{key} = {value}" for key, value in own.items()]
    file = tmp_path / "own.toml"
    file.write_text(text[:start] + "[spring]\n" + "\n".join(lines) + "\n\n" + text[end:])
    found = jobs.hinge(cases.load(str(file), {"trials.turns": 4, **FRICTION}))
    assert found.usable, found.guide.reason
    assert abs(found.check.result.energy.residual) < 1e-9
    assert found.check.losses["seal"] == pytest.approx(found.price.losses.seal, rel=1e-4)


def test_without_losses_the_run_is_the_ideal_one():
    found = run_of(**{"trials.turns": 4})
    assert found.check.losses is None
    assert set(found.check.result.energy.work) == {"gas", "hinge", "load"}


def test_states_need_one_coordinate():
    from mechsym import mechanisms

    shaft = mechanisms.build("crankshaft_flywheel", cases.load("chmielewski").need("parameters"))
    state = State(name="warmth", unit="-", start=1.0, rate=Along(function=lambda u, curves, states: 0.0))
    with pytest.raises(BadInput, match="one coordinate"):
        Problem(mechanism=shaft, parts=(), q0=(0.0, 0.0), u0=(0.0, 0.0), t_end=1.0, states=(state,))
