"""A real hinge on a shaft that a gear turns: virtual work, energy and losses of the run in time, by other ways."""

import dataclasses
from types import SimpleNamespace as Made

import casadi as ca
import numpy as np
import pytest
from hinges import engine

from mechsym import periodic
from mechsym.hinge import trials
from mechsym.hinge.choices import GuideParameters
from mechsym.hinge.guide import Guide
from mechsym.hinge.limits import at_angles
from mechsym.hinge.price import friction
from mechsym.hinge.rollers import HingeLosses, RollerParameters
from mechsym.hinge.springs.air import AirAbsolute
from mechsym.hinge.trials import RealHinge, _friction, _inertia, _losses, _over_crank, _stored, _torque
from mechsym.machine.loads import ConstantLoad
from mechsym.simulate.engine import problem

RATIO, RHO0, OMEGA, MASS = 0.5, 0.7, 12.0, 80.0
ROLLERS = RollerParameters(radius=0.1, width=0.08, moving_mass=MASS, friction="rolling", rolling_arm=2e-5)
LOSSES = HingeLosses(bearing_mu=0.003, seal_mu=0.02, guide_mu=0.04)
PHI = np.linspace(0.0, 4 * np.pi, 97)[:-1]  # a turn of the guide is two of the crank


@pytest.fixture(scope="module")
def hinge():
    path = periodic.fit(lambda theta: 0.6 + 0.04 * np.cos(theta) + 0.01 * np.sin(2 * theta), (), 2 * np.pi, 1e-13)
    parameters = GuideParameters(arrangement="two_tracks", rho0=RHO0, shaft_ratio=RATIO)
    spring = AirAbsolute(A=0.031, H=1.0, p0=5e6, n=1.25)
    guide = Guide(
        parameters=parameters, spring=spring, omega=OMEGA, status="cut", reason="", rho=path, closure=0.0
    )  # fmt: skip
    return RealHinge(guide=guide, rollers=ROLLERS, losses=LOSSES)


@pytest.fixture(scope="module")
def over_crank(hinge):
    return _over_crank(hinge.guide.rho, RATIO)


def along(function, over_crank, u=OMEGA):
    """A part of the run in time at angles of the crank, from symbols as the run takes it."""
    speed, curves = ca.SX.sym("u"), ca.SX.sym("rho", 3)
    of = ca.Function("part", [speed, curves], [function((speed,), ca.vertsplit(curves), ())])
    values = np.array([over_crank(PHI), over_crank.derivative()(PHI), over_crank.derivative(2)(PHI)])
    return np.asarray(of.map(PHI.size)(np.full((1, PHI.size), u), values).full()).ravel()


def test_the_path_over_the_crank_is_that_over_the_shaft_stretched(hinge, over_crank):
    rho = hinge.guide.rho
    assert over_crank.x[-1] - over_crank.x[0] == pytest.approx(4 * np.pi)
    for order in range(3):
        of, at = (p.derivative(order) if order else p for p in (over_crank, rho))
        assert of(PHI) == pytest.approx(RATIO**order * at(RATIO * PHI), abs=1e-12)
    assert _over_crank(rho, 1.0) is rho


def test_the_torque_is_what_the_spring_gives_back(hinge, over_crank):
    step = 1e-5
    energy = [_stored(hinge, (OMEGA,), (over_crank(PHI + by),), ()) for by in (-step, step)]
    slope = (energy[1] - energy[0]) / (2 * step)
    assert along(_torque(hinge).function, over_crank) == pytest.approx(-slope, abs=1e-5 * np.abs(slope).max())


def test_what_moves_with_the_rollers_has_their_energy(hinge, over_crank):
    value, rise = _inertia("phi", hinge, over_crank)
    rho, outwards = over_crank(PHI), over_crank.derivative()(PHI)
    speed_squared = (RATIO * OMEGA * rho) ** 2 + (OMEGA * outwards) ** 2
    assert value.value(PHI) * OMEGA**2 / 2 == pytest.approx(2 * MASS / 2 * speed_squared, rel=1e-12)
    step = 1e-5
    slope = (value.value(PHI + step) - value.value(PHI - step)) / (2 * step)
    assert rise.value(PHI) == pytest.approx(slope, abs=1e-5 * np.abs(slope).max())
    assert value.period == pytest.approx(4 * np.pi)


def test_losses_in_time_are_those_over_the_angle_of_the_shaft(hinge, over_crank):
    contact = at_angles(hinge.guide, ROLLERS, RATIO * PHI)
    over_angle = friction(contact, hinge.guide, ROLLERS, LOSSES)
    in_time = _friction(hinge)
    assert in_time.keys() == over_angle.keys()
    for kind, part in in_time.items():
        assert -along(part.function, over_crank) == pytest.approx(over_angle[kind], rel=1e-9, abs=1e-9), kind
        assert over_angle[kind].mean() > 0
    # at another speed the mass presses otherwise
    faster = -along(in_time["bearing"].function, over_crank, 2 * OMEGA)
    assert not np.allclose(faster, over_angle["bearing"], rtol=1e-3)
    none = RealHinge(guide=hinge.guide, rollers=RollerParameters(radius=0.1, width=0.08))
    assert _friction(none) == {} and not trials.is_real(none)


def test_a_mean_loss_is_the_work_of_the_last_period_over_its_angle():
    q = np.linspace(0.0, 5 * np.pi, 501)
    columns = {"phi": q, "work_bearing": -np.where(q < np.pi, 900.0 * q, 900.0 * np.pi + 30.0 * (q - np.pi))}
    lost = _losses(Made(columns=columns), "phi", 4 * np.pi)
    assert lost == pytest.approx({"bearing": 30.0, "seal": 0.0, "guide": 0.0, "rolling": 0.0, "gas": 0.0})
    # a run shorter than a period is taken as it is
    short = {name: column[:101] for name, column in columns.items()}
    assert _losses(Made(columns=short), "phi", 4 * np.pi)["bearing"] == pytest.approx(900.0)


def test_a_run_knows_every_angle_at_which_rollers_turn_back_or_the_gas_bends(hinge):
    machine = dataclasses.replace(engine(), load=ConstantLoad(torque=1e3))
    twice = dataclasses.replace(hinge.guide, parameters=dataclasses.replace(hinge.guide.parameters, shaft_ratio=2.0))
    made = trials.with_real_hinge(
        problem(machine, machine.omega, 1), machine, dataclasses.replace(hinge, guide=twice)
    )  # fmt: skip
    (kinks,) = made.kinks
    fine = np.linspace(0.0, 2 * np.pi, 200_001)
    slope = twice.rho.derivative()(2.0 * fine)
    back = fine[:-1][np.diff(np.sign(slope)) != 0]
    # the shaft turns twice in a turn of the crank, and what is not smooth in the one half may be so in the other
    gas = [(k % np.pi) + turn for k in machine.gas.pressure.kinks for turn in (0.0, np.pi)]
    wanted = np.sort([*back, *gas])
    assert len(back) == 4 and kinks.period == pytest.approx(2 * np.pi)
    assert np.all(np.diff(kinks.angles) > 1e-9)
    away = np.abs(np.asarray(kinks.angles)[:, None] - wanted[None, :])
    assert away.min(axis=0).max() < 1e-4 and away.min(axis=1).max() < 1e-4


@pytest.mark.parametrize(
    ("event", "status", "turned"),
    [(None, "converged", True), (None, "failed", False), ("stopped", "converged", False)],
)
def test_of_a_run_that_did_not_get_through_nothing_is_said(monkeypatch, hinge, event, status, turned):
    machine = Made(mechanism=Made(coordinates=("phi",)))
    monkeypatch.setattr(trials, "problem", lambda *a: "problem")
    monkeypatch.setattr(trials, "with_real_hinge", lambda what, machine, real: f"{what} with losses")
    monkeypatch.setattr(trials, "period_of", lambda machine: 2.0)
    monkeypatch.setattr(
        trials, "speed_ripple", lambda result, angle, period: 0.02 if (angle, period) == ("phi", 2.0) else 9
    )
    monkeypatch.setattr(trials, "_losses", lambda result, angle, period: {"seal": 1.0})
    asked = []
    monkeypatch.setattr(trials, "simulate", lambda what, settings: asked.append((what, settings.check)) or Made(
        event=event, status=status))  # fmt: skip
    made = trials.run("name", "about", machine, OMEGA, 3.0, real=hinge)
    assert asked == [("problem with losses", "none")]
    assert (made.speed_ripple, made.losses) == ((0.02, {"seal": 1.0}) if turned else (None, None))
    ideal = trials.run("name", "about", machine, OMEGA, 3.0)
    assert asked[1][0] == "problem" and ideal.losses is None
