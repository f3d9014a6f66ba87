"""Ripple from missing work: against the integrated equation of motion, limits, the crank that stops."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline

from mechsym.hinge.balance import constant_load_speed, mean_speed, propeller_load_speed, ripple
from mechsym.machine.loads import ConstantLoad, PropellerLoad
from mechsym.periodic import even_angles
from mechsym.simulate.angle import ReducedMachine, tabulate
from mechsym.simulate.steady import steady_state

TURN = 2 * np.pi
OMEGA, LOAD = 10.0, 900.0
PHI = even_angles(TURN)


def inertia(phi):
    return 12 - 4 * np.cos(2 * phi)


def missing(phi):
    return 20 * np.sin(phi) + 8 * np.cos(3 * phi)


def integrated(exponent, omega_0, turns):
    """Speed around the last turn of d(I (w^2 - omega^2)/2)/dphi = -missing' - M_r ((w/omega)^exponent - 1)."""

    def rate(phi, energy):
        square = OMEGA**2 + 2 * energy / inertia(phi)
        lost = 20 * np.cos(phi) - 24 * np.sin(3 * phi)
        return -lost - LOAD * ((square / OMEGA**2) ** (exponent / 2) - 1)

    start = [inertia(0.0) * (omega_0**2 - OMEGA**2) / 2]
    at = TURN * (turns - 1) + PHI
    run = solve_ivp(rate, (0, at[-1]), start, t_eval=at, rtol=1e-11, atol=1e-9, method="DOP853")
    return np.sqrt(OMEGA**2 + 2 * run.y[0] / inertia(PHI))


@pytest.mark.parametrize("share", [0.02, 0.1, 1.0])
def test_a_propeller_load_is_followed_the_same_by_sums_and_step_by_step(monkeypatch, share):
    """Up to the lightest shaft that sums can follow; of a lighter one powers overflow."""
    work, light = share * missing(PHI), share * inertia(PHI)
    quick = propeller_load_speed(work, light, OMEGA, LOAD, TURN)
    assert quick is not None
    monkeypatch.setattr("mechsym.hinge.balance._FADES", 0.0)
    assert propeller_load_speed(work, light, OMEGA, LOAD, TURN) == pytest.approx(quick, rel=1e-12)


def test_propeller_load_is_what_a_run_settles_to():
    expected = propeller_load_speed(missing(PHI), inertia(PHI), OMEGA, LOAD, TURN)
    assert expected == pytest.approx(integrated(2, 10.4, 12), rel=2e-6)


def test_constant_load_is_the_run_with_that_start():
    expected = constant_load_speed(missing(PHI), inertia(PHI), OMEGA)
    assert expected == pytest.approx(integrated(0, expected[0], 3), rel=1e-8)
    assert mean_speed(expected) == pytest.approx(OMEGA, rel=1e-12)


def test_nothing_missing_no_ripple():
    for phid in (
        constant_load_speed(np.zeros_like(PHI), inertia(PHI), OMEGA),
        propeller_load_speed(np.zeros_like(PHI), inertia(PHI), OMEGA, LOAD, TURN),
    ):
        assert ripple(phid) == 0


def test_small_ripple_of_constant_inertia_is_the_textbook_formula():
    swing = 0.02
    phid = constant_load_speed(swing / 2 * np.sin(PHI), np.full_like(PHI, 5.0), OMEGA)
    assert ripple(phid) == pytest.approx(swing / (5.0 * OMEGA**2), rel=1e-6)


def test_a_crank_that_would_stop_is_no_number():
    much = 1e5 * np.sin(PHI)
    assert ripple(propeller_load_speed(much, inertia(PHI), OMEGA, LOAD, TURN)) is None
    # a tooth in the missing work: before it the crank turns so fast that no mean speed as low as omega is left
    tooth = np.where(np.abs(PHI - 3) < 0.002, 1e6, 0.0)
    assert ripple(constant_load_speed(tooth, inertia(PHI), OMEGA)) is None


def test_heavy_load_follows_without_overflow():
    phid = propeller_load_speed(missing(PHI), inertia(PHI), OMEGA, 1e8, TURN)
    assert ripple(phid) < 1e-3


CLOSED = {
    "constant": (ConstantLoad(torque=LOAD), constant_load_speed(missing(PHI), inertia(PHI), OMEGA)),
    "propeller": (
        PropellerLoad(torque=LOAD, speed=OMEGA),
        propeller_load_speed(missing(PHI), inertia(PHI), OMEGA, LOAD, TURN),
    ),
}


@pytest.mark.parametrize(("load", "phid"), CLOSED.values(), ids=CLOSED)
def test_closed_forms_are_the_steady_turn_of_that_machine(load, phid):
    def torque(phi):
        wanted = LOAD + OMEGA**2 * 4 * np.sin(2 * phi)  # keeps the speed: M_r + omega^2 I'/2
        return wanted - 20 * np.cos(phi) + 24 * np.sin(3 * phi)

    found = steady_state(tabulate(ReducedMachine(inertia=inertia, torque=torque, load=load)), OMEGA)
    # both are sampled; a spline between the points of the panels keeps their digits
    again = CubicSpline(*np.unique([found.phi, found.omega], axis=1))(PHI)
    assert again == pytest.approx(phid, rel=2e-6)
    assert found.speed_mean == pytest.approx(mean_speed(phid), rel=1e-6)
    assert found.speed_ripple == pytest.approx(ripple(phid), rel=1e-4)
