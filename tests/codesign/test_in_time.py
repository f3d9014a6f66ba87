"""The equation of a machine over time: two integrators, and the energy that a machine without losses keeps."""

import numpy as np
import pytest
import scipy

from mechsym import periodic
from mechsym.codesign import running
from mechsym.codesign.task import Hardware, roller_inertia
from mechsym.hinge.springs.air import AirAbsolute

SPRING = AirAbsolute(A=0.03, H=1.0, n=1.3, p0=2e5)
HARDWARE = Hardware(spring=SPRING, rho0=0.6, count=2, shaft_ratio=0.5, radius=0.1, width=0.1,
                    moving_mass=80.0, roller_inertia=0.4)  # fmt: skip


def turning(load=(0.0, 0.0, 1.0), speed=12.0, turns=1.5, **changes):
    period, nothing = 2 * np.pi, scipy.interpolate.PPoly([[0.0]], [0.0, 2 * np.pi], "periodic")
    z = periodic.fit(lambda phi: 0.2 - 0.15 * np.cos(phi), [], period)
    inertia = periodic.fit(lambda phi: 500 + 60 * np.cos(2 * phi), [], period)
    given = {
        "rates": running.equation((AirAbsolute,)),
        "tables": (nothing, nothing, inertia, inertia.derivative(), z, z.derivative(), z.derivative(2)),
        "held": (100.0, *load, *running.of_track(HARDWARE, 3e5)), "kinks": np.array([1.0]), "period": period,
        "start": (0.0, speed, 0.0, 0.0), "turned": turns * period, "stalled": 1.0, "longest": 100.0,
    }  # fmt: skip
    return running.Turning(**given | changes)


def energy(machine, phi, omega):
    z, dz, h = machine.tables[4](phi), machine.tables[5](phi), HARDWARE
    rollers = roller_inertia(h.rho0 - z / 2, dz / (2 * 0.5), h.moving_mass, h.roller_inertia, h.radius, 2)
    inertia = machine.tables[2](phi) + machine.held[0] + 0.25 * rollers
    return inertia * omega**2 / 2 + h.charged(3e5).energy(z)


def compiled(machine):
    """The run in C, which must not be taken from scipy where no compiler is at hand."""
    with pytest.MonkeyPatch.context() as patch:
        patch.delattr(running, "_by_scipy")
        return running.turn(machine)


@pytest.mark.parametrize("integrator", [compiled, running._by_scipy])
def test_a_machine_without_losses_keeps_its_energy(integrator):
    machine = turning()
    t, states, stalled = integrator(machine)
    phi, omega, gained, taken = states(np.linspace(0, t, 50))
    assert not stalled and phi[-1] == pytest.approx(machine.turned, rel=1e-12) and np.ptp(omega) > 0.5
    np.testing.assert_allclose(energy(machine, phi, omega), energy(machine, 0.0, 12.0), rtol=1e-8)
    assert np.abs([gained, taken]).max() == 0


@pytest.mark.parametrize("load", [(300.0, 0.0, 1.0), (0.0, 300.0, 12.0)])
def test_a_load_takes_its_work_and_both_integrators_agree(load):
    machine = turning(load)
    (t, states, _), (t_other, others, _) = compiled(machine), running._by_scipy(machine)
    assert t == pytest.approx(t_other, rel=1e-9)
    y, other = states(np.linspace(0, t, 30)), others(np.linspace(0, t_other, 30))
    np.testing.assert_allclose(y[:2], other[:2], rtol=1e-8)
    np.testing.assert_allclose(energy(machine, *y[:2]) + y[3] - y[2], energy(machine, 0.0, 12.0), rtol=1e-8)
    if load[0]:
        np.testing.assert_allclose(y[3], load[0] * y[0], rtol=1e-8)


def test_a_machine_that_is_braked_stalls_and_without_a_compiler_too(monkeypatch):
    machine = turning((4e4, 0.0, 1.0))
    t, states, stalled = running.turn(machine)
    y = states(np.linspace(0, t, 20))
    assert stalled and y[1, -1] == pytest.approx(1.0, rel=1e-9)

    def no_compiler(*_):
        raise running.NoCompiler("none here")

    monkeypatch.setattr(running, "integrate", no_compiler)
    t, states, stalled = running.turn(machine)
    assert stalled
    np.testing.assert_allclose(states(np.linspace(0, t, 20)), y, rtol=1e-7, atol=1e-6)


def test_what_is_read_of_a_motion_reaches_its_end():
    for speed in np.linspace(8.0, 16.0, 9):
        machine = turning(speed=speed)
        t, states, _ = compiled(machine)
        phi, omega = states(np.linspace(0, t, 90))[:2]
        assert phi[-1] == pytest.approx(machine.turned, rel=1e-12)
        np.testing.assert_allclose(energy(machine, phi[-1], omega[-1]), energy(machine, 0.0, speed), rtol=1e-8)


def test_more_steps_than_were_thought_are_kept_all_the_same(monkeypatch):
    machine = turning(turns=6)
    t, states, _ = compiled(machine)
    monkeypatch.setattr(running, "_KEPT", 10)
    again, others, _ = compiled(machine)
    times = np.linspace(0, t, 90)
    assert again == t
    np.testing.assert_array_equal(states(times), others(times))
